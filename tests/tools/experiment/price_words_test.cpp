// Price list and its words: measured on small frames, reported correctly. SPDX-License-Identifier: Apache-2.0
#include "experiment/price_words.h"

#include <gridiron/base/records.h>

#include <glm/geometric.hpp>
#include <initializer_list>

#include "experiment/edge_points.h"
#include "experiment/price_book.h"
#include "experiment/price_list.h"
#include "gridiron/device/accuracies.h"
#include "support/test_headers.h"

namespace gridiron::test {
namespace {

using namespace experiment;

Range range_of(std::initializer_list<double> values) {
  Range range;
  for (const double value : values) range.add(value);
  return range;
}

TEST(PriceWords, ChangesHaveADirection) {
  EXPECT_EQ(change_words(range_of({3, 4.04}), 1), "3.0 to 4.0 % more");
  EXPECT_EQ(change_words(range_of({-3, -4}), 1), "3.0 to 4.0 % fewer");
  EXPECT_EQ(change_words(range_of({-50}), 0), "50 % fewer");
  EXPECT_EQ(change_words(range_of({-1.2, 0, 2}), 1), "from 1.2 % fewer to 2.0 % more");
  EXPECT_EQ(change_words(range_of({0, 2}), 1), "0.0 to 2.0 % more");
  EXPECT_EQ(change_words(Range{}, 1), "none");
}

TEST(PriceWords, TargetsAreMetInEveryViewOrNot) {
  Target target{"cycles", "a", "b", "grid", 15, {3, 15, std::nan("")}};
  EXPECT_EQ(target.worst_percent(), 15);
  EXPECT_TRUE(target.is_met());
  EXPECT_EQ(target.limit_words(), "at most 15 % more");
  target.percents[0] = 15.01;
  EXPECT_FALSE(target.is_met());
  Target less{"bytes", "a", "b", "grid", -45, {-50, -45}};
  EXPECT_TRUE(less.is_met());
  EXPECT_EQ(less.limit_words(), "at least 45 % fewer");
  less.percents.push_back(-44.9);
  EXPECT_FALSE(less.is_met());
  EXPECT_EQ(less.worst_percent(), -44.9);
  less.percents = {std::nan("")};
  EXPECT_FALSE(less.is_met()) << "what was not measured is not met";
}

std::vector<View> small_views() {
  std::vector<View> views;
  for (const std::uint32_t count : {600u, 1000u}) views.push_back(make_knot_view(count));
  return views;
}

// One list for all cases: collecting is most of the time.
class SmallPriceList : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    list_ = new PriceList(small_views(), 96, 64);
    steps_ = 0;
    list_->collect(1, [] { ++steps_; });
  }
  static void TearDownTestSuite() {
    delete list_;
    list_ = nullptr;
  }

  static PriceList* list_;
  static std::size_t steps_;
};
PriceList* SmallPriceList::list_ = nullptr;
std::size_t SmallPriceList::steps_ = 0;

TEST_F(SmallPriceList, HasEveryProfileInEveryConfiguration) {
  EXPECT_EQ(steps_, list_->step_count());
  EXPECT_EQ(list_->profiles().size(), tool::accuracies().size());
  ASSERT_EQ(list_->prices().size(), 2 * 3 * list_->profiles().size());
  for (const Price& price : list_->prices()) {
    EXPECT_EQ(&list_->price(price.view, price.configuration, price.profile), &price);
    const bool has_grid = price.variant.configuration.has_grid();
    ASSERT_EQ(price.is_possible(), has_grid || list_->profiles()[price.profile].key != "paper");
    if (!price.is_possible()) {
      EXPECT_TRUE(list_->frame(price).failed());
      EXPECT_FALSE(price.errors || price.at_edges);
      continue;
    }
    ASSERT_FALSE(list_->frame(price).failed()) << list_->frame(price).failure;
    ASSERT_TRUE(price.errors);
    EXPECT_EQ(price.errors->hits.rays, 96u * 64u);
    ASSERT_EQ(price.at_edges.has_value(), has_grid);
    if (has_grid) {
      EXPECT_EQ(price.at_edges->rays, 6u * CloseLook::kWidth * CloseLook::kWidth) << "as many as pixels";
    }
    EXPECT_TRUE(price.same_picture);
    EXPECT_GT(list_->with_distances(price).timing.frame_cycles, list_->frame(price).timing.frame_cycles);
    EXPECT_GE(list_->on_starved(price).timing.frame_cycles, list_->frame(price).timing.frame_cycles);
    const std::string& profile = list_->profiles()[price.profile].key;
    // Others may trace a ray again where estimates leave it open.
    if (!has_grid || (profile != "paper" && profile != "fast")) continue;
    EXPECT_EQ(list_->with_distances(price).moved_bytes() - list_->frame(price).moved_bytes(), 3u * 2u * 32u * 32u * 4u)
        << "one more plane, no other transfers";
  }
}

// The machine behind the figures is the one that the page names: six cores, and an eighth of the bandwidth.
TEST_F(SmallPriceList, RunsOnTheMachinesItNames) {
  EXPECT_EQ(list_->machine().profile.channel_bytes_per_cycle, 8 * list_->starved().profile.channel_bytes_per_cycle);
  EXPECT_EQ(list_->machine().profile.name, "cell-ps3");
  for (const Price& price : list_->prices()) {
    if (price.is_possible()) {
      EXPECT_EQ(list_->frame(price).timing.cores.size(), 6u);
    }
  }
}

TEST_F(SmallPriceList, ExactIsTheTruthAndStandardHitsIt) {
  for (const Price& price : list_->prices()) {
    if (!price.is_possible()) continue;
    const std::string& profile = list_->profiles()[price.profile].key;
    const HitCounts at_edges = price.at_edges.value_or(HitCounts{});
    SCOPED_TRACE(profile + " in " + kPricedConfigurations[price.configuration]);
    if (profile == "exact") {
      EXPECT_EQ(price.errors->hits.wrong_rays() + at_edges.wrong_rays(), 0u);
      EXPECT_EQ(price.errors->all_ulps.greatest, 0);
      EXPECT_EQ(price.errors->picture.differing_pixels, 0u);
    } else if (profile == "standard") {
      EXPECT_EQ(price.errors->hits.leaks() + price.errors->hits.false_hits, 0u);
      EXPECT_EQ(at_edges.leaks() + at_edges.false_hits, 0u);
      EXPECT_EQ(price.errors->all_ulps.greatest, 0);
    } else {
      EXPECT_GT(price.errors->all_ulps.greatest, 0) << "floats, or another geometry";
    }
    if (profile == "paper") {
      EXPECT_GT(at_edges.leaks(), 0u) << "what the rays at edges are there for";
    }
  }
}

TEST_F(SmallPriceList, DoesNotDependOnThreads) {
  PriceList other(small_views(), 96, 64);
  other.collect(3, [] {});
  for (std::size_t view = 0; view < 2; ++view) {
    EXPECT_EQ(csv_text(view_costs(*list_, view)), csv_text(view_costs(other, view)));
    EXPECT_EQ(csv_text(view_errors(*list_, view, true)), csv_text(view_errors(other, view, true)));
  }
}

TEST_F(SmallPriceList, AStepToTheSameProfileIsNone) {
  for (std::size_t profile = 0; profile < list_->profiles().size(); ++profile) {
    const std::string words = step_words(*list_, 0, profile, profile);
    EXPECT_TRUE(words.starts_with("It buys nothing. It costs nothing. The same: cycles a frame;")) << words;
  }
}

// What one direction buys the other one costs.
TEST_F(SmallPriceList, AStepBackIsTheOpposite) {
  const std::size_t fast = *list_->find_profile("fast"), exact = *list_->find_profile("exact");
  const std::string up = step_words(*list_, 0, fast, exact), down = step_words(*list_, 0, exact, fast);
  EXPECT_NE(up.find("ulp at most"), std::string::npos) << up;
  EXPECT_LT(up.find("ulp at most"), up.find("It costs:")) << up;
  EXPECT_GT(down.find("ulp at most"), down.find("It costs:")) << down;
  EXPECT_GT(up.find("more cycles of a frame with distances"), up.find("It costs:")) << up;
  EXPECT_LT(down.find("fewer cycles of a frame with distances"), down.find("It costs:")) << down;
}

TEST_F(SmallPriceList, TargetsAreMeasuredOnItsFrames) {
  bool seen = false;
  for (const Target& target : price_targets(*list_)) {
    ASSERT_EQ(target.percents.size(), 2u);
    const std::string words = target_words(*list_, target);
    EXPECT_EQ(words.find("met in every view") != std::string::npos, target.is_met()) << words;
    EXPECT_EQ(words.find("missed in") == std::string::npos, target.is_met()) << words;
    if (target.from != "paper" || target.configuration != "reference" || target.what != "cycles a frame") continue;
    seen = true;
    const std::size_t paper = *list_->find_profile("paper"), standard = *list_->find_profile("standard");
    for (std::size_t view = 0; view < 2; ++view) {
      const double was = list_->frame(list_->price(view, 1, paper)).timing.frame_cycles;
      const double is = list_->frame(list_->price(view, 1, standard)).timing.frame_cycles;
      EXPECT_DOUBLE_EQ(target.percents[view], 100 * (is - was) / was);
    }
  }
  EXPECT_TRUE(seen);
}

// Half the bytes a triangle, and words for both bandwidths.
TEST_F(SmallPriceList, CompactIsHeldAgainstStandard) {
  const std::size_t compact = *list_->find_profile("compact"), standard = *list_->find_profile("standard");
  const RunResult &small = list_->frame(list_->price(0, 0, compact)),
                  &large = list_->frame(list_->price(0, 0, standard));
  EXPECT_EQ(small.facts.triangle_bytes / small.facts.grid->reference_count, 24u);
  EXPECT_EQ(large.facts.triangle_bytes / large.facts.grid->reference_count, 48u);
  EXPECT_LT(small.facts.fetched_triangle_bytes, large.facts.fetched_triangle_bytes);
  EXPECT_LT(large.facts.fetched_triangle_bytes, large.bytes_in());
  EXPECT_NE(starved_words(*list_).find("In configuration reference compact takes"), std::string::npos);
  EXPECT_NE(lattice_words(*list_, compact).find("600 "), std::string::npos) << lattice_words(*list_, compact);
  EXPECT_EQ(lattice_words(*list_, standard), "");
}

// A look's rays pass the point within a few roundings: what they hit lies there or, at an outline, behind it.
TEST(CloseLook, LooksAtItsPoint) {
  const View view = make_knot_view(600);
  GridVariant variant = grid_variant("grid");
  variant.accuracy = Accuracy::kExact;
  const Answers picture = render_answers(variant, view, {.width = 64, .height = 64, .shading = Shading::kNone});
  const std::vector<Vec3> points = edge_points(view.mesh().view(), picture.ids, 20);
  ASSERT_EQ(points.size(), 20u);
  CloseLook look(variant, view);
  int met = 0, split = 0;
  for (const Vec3& point : points) {
    Answers answers;
    look.look_at(point, answers);
    ASSERT_EQ(answers.ids.size(), CloseLook::kWidth * CloseLook::kWidth);
    ASSERT_EQ(answers.depth.size(), answers.ids.size());
    EXPECT_TRUE(answers.color.empty());
    const double distance = glm::length(DVec3(point) - DVec3(*view.camera.eye));
    met +=
        std::ranges::any_of(answers.depth, [&](float t) { return std::fabs(t - distance) < 1e-4 * distance; }) ? 1 : 0;
    // Several triangles meet in an edge: a look that missed it would see one.
    std::vector<std::uint32_t> seen = answers.ids;
    std::ranges::sort(seen);
    seen.erase(std::unique(seen.begin(), seen.end()), seen.end());
    split += seen.size() >= 2 ? 1 : 0;
  }
  EXPECT_GE(met, 15) << "the others are hidden by something nearer";
  EXPECT_GE(split, 15);
}

}  // namespace
}  // namespace gridiron::test
