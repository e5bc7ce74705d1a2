// Whole tiles by the kernel itself under every order in which its transfers can end: the same calls, the same bytes in
// the store at every call, the same picture; and a port that drops a wait is found, whichever it drops.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/render/tile_renderer.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "core/render/test_frame.h"
#include "protocol/order_platform.h"
#include "support/test_mesh.h"

namespace gridiron::test {
namespace {

struct Layout {
  static constexpr std::uint32_t kEffects = 0;
  static constexpr std::uint32_t kArenaBytes = 64 * 1024;
  static constexpr std::uint32_t kCodeBudgetBytes = 32 * 1024;
  static constexpr std::uint32_t kStackBudgetBytes = 6 * 1024;
  static constexpr std::uint32_t kTileWidth = 8;
  static constexpr std::uint32_t kPacketWidth = 8;
  static constexpr std::uint32_t kMailboxSlots = 64;
  static constexpr std::uint32_t kTableEntries = 16;
  static constexpr std::uint32_t kMaxMacroWidth = 2;
  static constexpr std::uint32_t kMaxMacroDepth = 4;
  static constexpr std::uint32_t kTrianglesPerBuffer = 2;
  static constexpr std::uint32_t kMaxTriangleDepth = 4;
  static constexpr std::uint32_t kMaxOutputDepth = 4;
  static constexpr std::uint32_t kRecentTriangles = 2;
};
using Store = LocalStore<Layout>;

constexpr std::uint64_t kFrame = 4096, kPicture = 8192, kImage = 16384;

struct Depths {
  std::uint32_t output = 1, macro = 1, triangle = 1, queue = 5;
};

struct Outcome {
  Status status = Status::kOk;
  std::vector<std::uint64_t> calls;
  std::vector<std::uint32_t> open_after;
  std::vector<std::byte> picture;
  std::string violation;
  bool is_idle = false;
  std::uint32_t most_pending = 0;

  [[nodiscard]] bool is_as(const Outcome& other) const {
    return status == other.status && calls == other.calls && picture == other.picture && violation.empty() && is_idle;
  }
};

// A scene in main memory and a frame of `tiles` tiles in a row; rendered anew for each schedule.
class Bench {
 public:
  Bench(const TestMesh& mesh, float lambda, std::uint32_t tiles, const Depths& depths)
      : scene_(mesh.view(), {lambda, 2, TriangleFormat::kVertices}), depths_(depths), tiles_(tiles) {
    FrameSettings settings;
    settings.camera.eye = {0.3f, 0.2f, 3.0f};
    settings.width = 8 * tiles;
    settings.height = 8;
    settings.tile_width = 8;
    settings.output_depth = depths.output;
    settings.macro_depth = depths.macro;
    settings.triangle_depth = depths.triangle;
    settings.color = {kPicture};
    FrameRecord record;
    EXPECT_EQ(make_frame_record(settings, scene_.view, {kImage}, record), Status::kOk);
    pages_.resize((kImage + scene_.bytes.size()) / sizeof(Page) + 2);
    std::memcpy(at(kFrame), &record, sizeof(record));
    std::memcpy(at(kImage), scene_.bytes.data(), scene_.bytes.size());
  }

  [[nodiscard]] Outcome run(OrderPlatform::Schedule schedule, std::uint32_t dropped_wait = ~0u) {
    std::memset(at(kPicture), 0x11, 256 * tiles_);
    std::memset(static_cast<void*>(store_.get()), 0xC3, sizeof(Store));
    OrderPlatform platform({at(0), pages_.size() * sizeof(Page)},
                           std::as_writable_bytes(std::span(store_.get(), 1)), depths_.queue, std::move(schedule));
    platform.tile_count = tiles_;
    platform.dropped_wait = dropped_wait;
    Outcome outcome;
    outcome.status = render_tiles<Lanes<4>>(*store_, platform, MainAddress{kFrame});
    outcome.calls = platform.calls;
    outcome.open_after = platform.open_after;
    outcome.violation = platform.violation;
    outcome.is_idle = platform.is_idle();
    outcome.most_pending = platform.most_pending;
    outcome.picture.assign(at(kPicture), at(kPicture) + 256 * tiles_);
    return outcome;
  }
  // Everything as late as it may be.
  [[nodiscard]] Outcome late(std::uint32_t dropped_wait = ~0u) {
    return run([](std::uint32_t, std::uint32_t) { return 0u; }, dropped_wait);
  }

 private:
  struct alignas(4096) Page {
    std::byte bytes[4096];
  };
  [[nodiscard]] std::byte* at(std::uint64_t address) { return pages_[0].bytes + address; }

  BuiltScene scene_;
  Depths depths_;
  std::uint32_t tiles_;
  std::vector<Page> pages_;
  std::unique_ptr<Store> store_ = std::make_unique<Store>();
};

// Counts through all answers of a schedule, the last question fastest.
class Odometer {
 public:
  [[nodiscard]] std::uint32_t ask(std::uint32_t open) {
    if (position_ == digits_.size()) digits_.push_back({0, 1u << open});
    return digits_[position_++].value;
  }
  [[nodiscard]] bool advance() {
    position_ = 0;
    while (!digits_.empty() && digits_.back().value + 1 == digits_.back().count) digits_.pop_back();
    if (digits_.empty()) return false;
    ++digits_.back().value;
    return true;
  }

 private:
  struct Digit {
    std::uint32_t value, count;
  };
  std::vector<Digit> digits_;
  std::size_t position_ = 0;
};

TestMesh few_triangles() { return make_random_soup(4, 0.8f, 3); }
TestMesh more_triangles() { return make_random_soup(14, 0.6f, 7); }

std::string name_of(const Depths& depths) {
  return std::to_string(depths.output) + "/" + std::to_string(depths.macro) + "/" + std::to_string(depths.triangle) +
         " in a queue of " + std::to_string(depths.queue);
}

// Every order: each answer to each question, one whole frame for each sequence of answers.
TEST(CompletionOrders, EveryOrderOfASmallTileGivesTheSame) {
  constexpr std::uint64_t kMost = 2000000;  // beyond, the scene is too large for this test
  for (std::uint32_t depth = 1; depth <= 4; ++depth) {
    Bench bench(few_triangles(), 0.5f, 1, {1, depth, depth, 5});
    const Outcome reference = bench.late();
    ASSERT_EQ(reference.status, Status::kOk) << reference.violation;
    Odometer odometer;
    std::uint64_t orders = 0;
    do {
      const Outcome outcome = bench.run([&](std::uint32_t, std::uint32_t open) { return odometer.ask(open); });
      ++orders;
      ASSERT_TRUE(outcome.is_as(reference)) << "depth " << depth << ", order " << orders << ": " << outcome.violation;
      ASSERT_LT(orders, kMost);
    } while (odometer.advance());
    std::printf("depth %u: %zu calls, up to %u pending, %llu orders\n", depth, reference.calls.size(),
                reference.most_pending, static_cast<unsigned long long>(orders));
    EXPECT_GT(orders, 1u);
  }
}

// After each call every set of transfers that may have ended by then, in a whole frame each.
std::uint64_t try_every_set(Bench& bench, const Outcome& reference, const std::string& name) {
  std::uint64_t runs = 0;
  for (std::uint32_t call = 0; call < reference.calls.size(); ++call) {
    const std::uint32_t sets = 1u << reference.open_after[call];
    for (std::uint32_t set = 1; set < sets; ++set, ++runs) {
      const Outcome outcome =
          bench.run([&](std::uint32_t at, std::uint32_t) { return at == call ? set : 0u; });
      EXPECT_TRUE(outcome.is_as(reference)) << name << ", call " << call << ", set " << set << ": "
                                            << outcome.violation;
      if (testing::Test::HasFailure()) return runs;
    }
  }
  return runs;
}

TEST(CompletionOrders, EverySetThatMayHaveEndedAtEachCallGivesTheSame) {
  std::uint64_t runs = 0, calls = 0;
  for (std::uint32_t depth = 1; depth <= 4; ++depth) {
    for (const Depths& depths : {Depths{1, 1, depth, 5}, Depths{1, depth, 1, 5}, Depths{depth, 1, 1, 16},
                                 Depths{depth, depth, depth, 5}, Depths{1, depth, depth, depth}}) {
      Bench bench(more_triangles(), 2.0f, 3, depths);
      const Outcome reference = bench.late();
      ASSERT_EQ(reference.status, Status::kOk) << reference.violation;
      ASSERT_TRUE(reference.is_idle);
      runs += try_every_set(bench, reference, name_of(depths));
      calls += reference.calls.size();
      ASSERT_FALSE(HasFailure());
    }
  }
  std::printf("%llu calls, %llu frames\n", static_cast<unsigned long long>(calls),
              static_cast<unsigned long long>(runs));
}

// A wait that something was pending for cannot be dropped unseen: what was waited for ends late, or never.
TEST(CompletionOrders, EveryDroppedWaitIsFound) {
  std::uint32_t dropped = 0;
  for (std::uint32_t depth = 1; depth <= 4; ++depth) {
    Bench bench(more_triangles(), 2.0f, 3, {depth, depth, depth, 16});
    const Outcome reference = bench.late();
    ASSERT_EQ(reference.status, Status::kOk) << reference.violation;
    for (std::uint32_t call = 1; call < reference.calls.size(); ++call) {
      // A wait that ended something leaves fewer open than the call before it.
      if (reference.open_after[call] >= reference.open_after[call - 1]) continue;
      ++dropped;
      EXPECT_FALSE(bench.late(call).is_as(reference)) << "depth " << depth << ", call " << call;
    }
  }
  std::printf("%u waits dropped\n", dropped);
  EXPECT_GT(dropped, 40u);
}

}  // namespace
}  // namespace gridiron::test
