// The scaling model against cases whose answers follow by hand. SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <string>

#include "base/failure.h"
#include "base/ranks.h"
#include "scaling_model.h"

namespace gridiron::scaling {
namespace {

const Network kFree{};

Costs even(std::size_t pieces, double seconds, double bytes = 0) {
  Costs costs;
  costs.name = "even";
  costs.pieces.assign(pieces, {seconds, bytes});
  return costs;
}

TEST(ScalingModel, EvenPiecesWithoutOtherCostsScaleFully) {
  for (const std::uint32_t ranks : {1u, 2u, 4u, 64u, 4096u}) {
    const Prediction at = predict(even(4096, 0.5), kFree, ranks);
    EXPECT_DOUBLE_EQ(at.seconds, 2048.0 / ranks);
    EXPECT_DOUBLE_EQ(at.speed_up, ranks);
    EXPECT_DOUBLE_EQ(at.efficiency, 1);
    EXPECT_EQ(at.limit, "none");
  }
}

TEST(ScalingModel, SerialWorkAloneDoesNotScale) {
  Costs costs = even(64, 0);
  costs.start_seconds = 2;
  costs.end_seconds = 1;
  const Prediction at = predict(costs, kFree, 64);
  EXPECT_DOUBLE_EQ(at.speed_up, 1);
  EXPECT_EQ(at.limit, "start of rank 0");
  costs.end_seconds = 3;
  EXPECT_EQ(predict(costs, kFree, 64).limit, "end of rank 0");
}

TEST(ScalingModel, AmdahlsLaw) {
  Costs costs = even(1024, 0.125);  // 128 s that are divided, 32 s that are not
  costs.end_seconds = 32;
  for (const std::uint32_t ranks : {2u, 16u, 1024u}) {
    EXPECT_DOUBLE_EQ(predict(costs, kFree, ranks).speed_up, 160.0 / (32 + 128.0 / ranks));
  }
}

TEST(ScalingModel, PiecesThatAreTooFewOrUneven) {
  const Prediction few = predict(even(10, 1), kFree, 16);
  EXPECT_DOUBLE_EQ(few.seconds, 1);
  EXPECT_EQ(few.limit, "too few pieces");
  Costs costs = even(8, 1);
  costs.pieces[5].seconds = 5;  // rank 1 of 2 has 1, 2, 5, 6
  const Prediction uneven = predict(costs, kFree, 2);
  EXPECT_DOUBLE_EQ(uneven.seconds, 8);
  EXPECT_EQ(uneven.limit, "uneven shares");
}

// A message: its head, then, once rank 0 looks for it, the bytes.
TEST(ScalingModel, LatencyAlone) {
  const Network slow{.latency_seconds = 0.25, .bytes_per_second = 0};
  const Prediction at = predict(even(2, 1, 1), slow, 2);
  EXPECT_DOUBLE_EQ(at.seconds, 1.5);
  EXPECT_EQ(at.limit, "latency");
}

// The second message of rank 1 leaves when rank 0 has received the first.
TEST(ScalingModel, OneMessageAhead) {
  Costs costs = even(5, 1, 1);
  costs.pieces[0].seconds = 10;
  costs.pieces[2].seconds = costs.pieces[4].seconds = 0;
  const Network link{.latency_seconds = 0, .bytes_per_second = 0.25};
  // Rank 0 looks at 10 s; two messages of 4 s each follow one another.
  EXPECT_DOUBLE_EQ(simulate(costs, link, 2), 18);
}

TEST(ScalingModel, MessagesOfAllRanksComeThroughOneLink) {
  const Network link{.latency_seconds = 0, .bytes_per_second = 8};
  const Prediction at = predict(even(5, 1, 8), link, 5);
  EXPECT_DOUBLE_EQ(at.seconds, 1 + 4);
  EXPECT_EQ(at.limit, "bandwidth");
}

TEST(ScalingModel, RankZeroTakesPieces) {
  Costs costs = even(16, 1);
  costs.take_seconds = 0.5;
  const Prediction at = predict(costs, kFree, 16);
  EXPECT_DOUBLE_EQ(at.seconds, 1 + 15 * 0.5);
  EXPECT_EQ(at.limit, "rank 0 takes pieces");
  costs.own_take_seconds = 2;
  EXPECT_DOUBLE_EQ(simulate(costs, kFree, 16), 3 + 15 * 0.5);
  EXPECT_DOUBLE_EQ(simulate(costs, kFree, 1), 16 * 3);
}

TEST(ScalingModel, MessagesHoldPiecesUpToANumberOrATime) {
  Costs costs = even(8, 1);
  costs.take_seconds = 1;
  const auto seconds = [&costs](double pieces, double most) {
    costs.message_pieces = pieces;
    costs.message_seconds = most;
    return simulate(costs, kFree, 2);
  };
  EXPECT_DOUBLE_EQ(seconds(1, 0), 8);    // taken between own pieces and after them
  EXPECT_DOUBLE_EQ(seconds(100, 0), 8);  // one message of four, at 4 s
  costs.pieces.assign(2, {0, 0});
  costs.pieces.resize(8, {1, 0});
  for (std::size_t i = 0; i < 8; ++i) {  // rank 0 waits; rank 1 works 3 s
    if (tool::rank_of_piece(i, 2) == 0) costs.pieces[i].seconds = 0;
  }
  EXPECT_DOUBLE_EQ(seconds(1, 0), 4);    // the last comes at 3 s
  EXPECT_DOUBLE_EQ(seconds(100, 0), 7);  // all come at 3 s
  EXPECT_DOUBLE_EQ(seconds(2, 0), 5);    // two of them
  EXPECT_DOUBLE_EQ(seconds(100, 2), 6);  // three at 2 s keep it busy until 5
}

TEST(ScalingModel, TheEndIsDividedToo) {
  Costs costs = even(1, 0);
  costs.end_divided_seconds = 12;
  costs.end_pieces = 6;
  const Network link{.latency_seconds = 0.125, .bytes_per_second = 8};
  EXPECT_DOUBLE_EQ(simulate(costs, link, 1), 12);
  EXPECT_DOUBLE_EQ(simulate(costs, link, 2), 6 + 0.125);
  EXPECT_DOUBLE_EQ(simulate(costs, link, 4), 4 + 3 * 0.125) << "two ranks have two pieces";
  EXPECT_DOUBLE_EQ(simulate(costs, link, 100), 2 + 5 * 0.125);
  costs.scatter_bytes = 24;
  costs.scatter_seconds = 3;
  EXPECT_DOUBLE_EQ(simulate(costs, link, 1), 12);
  EXPECT_DOUBLE_EQ(simulate(costs, link, 4), 4 + 3 * 0.125 + 0.75 * (3 + 3));
  EXPECT_EQ(predict(costs, link, 6).limit, "encoding");
}

TEST(ScalingModel, BroadcastIsATree) {
  Costs costs = even(1024, 0);
  costs.broadcast_bytes = 100;
  const Network link{.latency_seconds = 0, .bytes_per_second = 50};
  EXPECT_DOUBLE_EQ(simulate(costs, link, 1), 0);
  EXPECT_DOUBLE_EQ(simulate(costs, link, 2), 2);
  EXPECT_DOUBLE_EQ(simulate(costs, link, 1024), 20);
  EXPECT_EQ(predict(costs, link, 5).limit, "broadcast");
}

TEST(ScalingModel, MoreCostNeverTakesLessTime) {
  Costs costs;
  for (std::size_t i = 0; i < 500; ++i) costs.pieces.push_back({0.001 * static_cast<double>(i * 7 % 11), 1000.0});
  const Network fast{1e-6, 1e10}, slow{1e-3, 1e6};
  for (const std::uint32_t ranks : {2u, 3u, 16u, 499u, 501u}) {
    const double seconds = simulate(costs, fast, ranks);
    EXPECT_LE(seconds, simulate(costs, slow, ranks)) << ranks;
    Costs more = costs;
    more.end_seconds = 1;
    EXPECT_DOUBLE_EQ(seconds + 1, simulate(more, fast, ranks)) << ranks;
    EXPECT_EQ(seconds, simulate(costs, fast, ranks)) << ranks;
  }
}

TEST(ScalingCosts, AreRead) {
  const Costs costs = read_costs(
      "a.csv", "# words\nname,mesh\nstart_seconds,1.5\nbroadcast_bytes,1e6\n\npiece,0.25,12\npiece,1,0");
  EXPECT_EQ(costs.name, "mesh");
  EXPECT_EQ(costs.start_seconds, 1.5);
  EXPECT_EQ(costs.broadcast_bytes, 1e6);
  ASSERT_EQ(costs.pieces.size(), 2u);
  EXPECT_EQ(costs.pieces[0].seconds, 0.25);
  EXPECT_EQ(costs.pieces[0].bytes, 12);
}

TEST(ScalingCosts, BadLinesAreRefusedByNumber) {
  const std::pair<std::string, std::string> cases[] = {
      {"name,a\npiece,1\n", "a.csv:2: 'piece' needs 2 values"},
      {"name,a\npiece,1,x\n", "a.csv:2: 'x' is no number of 0 or more"},
      {"name,a\n#\npiece,-1,0\n", "a.csv:3: '-1' is no number of 0 or more"},
      {"name,a\npiece,inf,0\n", "a.csv:2: 'inf' is no number of 0 or more"},
      {"name,a\npiece,nan,0\n", "a.csv:2: 'nan' is no number of 0 or more"},
      {"name,a\npiece,,0\n", "a.csv:2: '' is no number of 0 or more"},
      {"name,a\nstart_second,1\n", "a.csv:2: unknown key 'start_second'"},
      {"name,a\nname,b\n", "a.csv:2: 'name' comes twice"},
      {"start_seconds\n", "a.csv:1: 'start_seconds' needs 1 value"},
      {"piece,1,1\n", "a.csv:1: there is no name"},
      {"name,a\n", "a.csv:1: there is no piece"},
  };
  for (const auto& [text, words] : cases) {
    try {
      (void)read_costs("a.csv", text);
      ADD_FAILURE() << text;
    } catch (const tool::Failure& failure) {
      EXPECT_EQ(failure.what(), words);
    }
  }
}

}  // namespace
}  // namespace gridiron::scaling
