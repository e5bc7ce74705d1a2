// Packing of traces: whatever steps go in come out, and a tile's bytes depend on its steps alone.
// Memory: std::vector. Threads: one. SPDX-License-Identifier: Apache-2.0
#include <gridiron/sim/trace_packing.h>

#include "replay_cases.h"
#include "support/trace_steps.h"

namespace gridiron::sim {
namespace {

/// Steps with the work that they name.
struct StepList {
  std::vector<TraceEvent> events;
  std::vector<std::vector<WorkAmount>> work;
};

/// Draws numbers of any length, the least and the greatest too.
class Extremes {
 public:
  explicit Extremes(std::uint32_t seed) : random_(seed) {}

  std::uint32_t below(std::uint32_t end) { return static_cast<std::uint32_t>(random_() % end); }
  std::uint64_t any() {
    switch (below(8)) {
      case 0:
        return 0;
      case 1:
        return ~std::uint64_t{0};
      case 2:
        return std::uint64_t{1} << below(64);
      case 3:
        return ~std::uint64_t{0} >> below(64);
      case 4:
        return 48 * std::uint64_t{below(1000)};
      default:
        return random_() >> below(64);
    }
  }
  std::uint32_t any32() { return static_cast<std::uint32_t>(any()); }

 private:
  std::mt19937_64 random_;
};

/// @param kinds  that have work in some step, of all kinds; @param tags  of transfers.
StepList random_steps(Extremes& draw, std::uint32_t count, std::uint32_t kinds, std::uint32_t tags) {
  StepList steps;
  for (std::uint32_t i = 0; i < count; ++i) {
    TraceEvent event{.kind = static_cast<EventKind>(draw.below(5))};
    std::vector<WorkAmount> work;
    switch (event.kind) {
      case EventKind::kWork:
        for (std::uint32_t kind = 0; kind < kWorkKindCount; ++kind) {
          const std::uint32_t amount = draw.below(8) == 0 ? draw.any32() : draw.below(40);
          if (draw.below(kWorkKindCount) < kinds && amount != 0) work.push_back({WorkId(kind), amount});
        }
        if (work.empty()) work.push_back({WorkId(draw.below(kWorkKindCount)), ~0u});
        break;
      case EventKind::kGet:
      case EventKind::kPut:
        event.tag = static_cast<std::uint8_t>(draw.below(tags));
        event.rotating = draw.below(4) == 0;
        event.bytes = draw.any32();
        event.address = draw.below(2) == 0 ? draw.any() : 4096 + 48 * std::uint64_t{draw.below(64)};
        break;
      case EventKind::kWait:
        event.tags = draw.below(2) == 0 ? 1u << draw.below(32) : draw.any32();
        event.rotating_tags = draw.below(2) == 0 ? 0 : draw.any32();
        break;
      case EventKind::kStage:
        event.stage = static_cast<Stage>(draw.below(256));
        break;
    }
    steps.work.push_back(work);
    steps.events.push_back(event);
  }
  for (std::size_t i = 0; i < steps.events.size(); ++i) steps.events[i].work = steps.work[i];
  return steps;
}

void expect_same_steps(const TileTrace& trace, const StepList& steps, const std::string& what) {
  const test::UnpackedTrace unpacked(trace);
  ASSERT_EQ(unpacked.events.size(), steps.events.size()) << what;
  for (std::size_t i = 0; i < steps.events.size(); ++i) {
    ASSERT_TRUE(test::is_same_step(unpacked.events[i], steps.events[i])) << what << ", step " << i;
  }
}

TEST(TracePacking, AnyStepsComeOutAsTheyWentIn) {
  TraceWriter writer;
  for (std::uint32_t seed = 0; seed < 300; ++seed) {
    Extremes draw(seed);
    // Few tags and kinds are predicted, many overflow every table.
    const std::uint32_t kinds = seed % 3 == 0 ? kWorkKindCount : 1 + draw.below(6);
    const StepList steps = random_steps(draw, 1 + draw.below(400), kinds, seed % 2 == 0 ? 256 : 12);
    for (const TraceEvent& event : steps.events) writer.add(event);
    const TileTrace trace = writer.finish(seed);
    EXPECT_EQ(trace.tile_id, seed);
    expect_same_steps(trace, steps, "seed " + std::to_string(seed));
  }
}

TEST(TracePacking, ATilesBytesDependOnItsStepsAlone) {
  TraceWriter writer;
  Extremes draw(1);
  const StepList steps = random_steps(draw, 200, 5, 12);
  const TileTrace alone = test::packed_trace(7, steps.events);
  for (std::uint32_t before = 0; before < 20; ++before) {
    for (const TraceEvent& event : random_steps(draw, before * 10, 5, 12).events) writer.add(event);
    static_cast<void>(writer.finish(0));
    for (const TraceEvent& event : steps.events) writer.add(event);
    EXPECT_EQ(writer.finish(7).packed, alone.packed) << before;
  }
}

TEST(TracePacking, AReaderGoesToAnotherTileAtAnyStep) {
  Extremes draw(2);
  const StepList first = random_steps(draw, 100, 5, 12), second = random_steps(draw, 100, 5, 12);
  const TileTrace a = test::packed_trace(0, first.events), b = test::packed_trace(1, second.events);
  TraceReader reader;
  EXPECT_EQ(reader.next(), nullptr);
  for (std::size_t taken = 0; taken < 100; taken += 9) {
    reader.open(a);
    for (std::size_t i = 0; i < taken; ++i) ASSERT_NE(reader.next(), nullptr);
    reader.open(b);
    for (const TraceEvent& event : second.events) {
      const TraceEvent* const read = reader.next();
      ASSERT_NE(read, nullptr);
      ASSERT_TRUE(test::is_same_step(*read, event));
    }
    EXPECT_EQ(reader.next(), nullptr);
    EXPECT_EQ(reader.next(), nullptr);
  }
}

TEST(TracePacking, WorkOfNothingIsNoStep) {
  TraceWriter writer;
  EXPECT_TRUE(writer.finish(0).packed.empty());
  const WorkAmount nothing[] = {{GridWork::kCellStep, 0}};
  writer.add({.kind = EventKind::kWork, .work = nothing});
  writer.add({.kind = EventKind::kWork});
  EXPECT_TRUE(writer.finish(0).packed.empty());
  // One kind twice is one amount; kinds come out in order.
  const WorkAmount mixed[] = {{GridWork::kSliceStep, 2}, {Work::kTileStart, 1}, {GridWork::kSliceStep, 3}};
  writer.add({.kind = EventKind::kWork, .work = mixed});
  const test::UnpackedTrace unpacked(writer.finish(0));
  ASSERT_EQ(unpacked.events.size(), 1u);
  ASSERT_EQ(unpacked.events[0].work.size(), 2u);
  EXPECT_EQ(unpacked.events[0].work[0], (WorkAmount{Work::kTileStart, 1}));
  EXPECT_EQ(unpacked.events[0].work[1], (WorkAmount{GridWork::kSliceStep, 5}));
}

TEST(TracePacking, RepetitionsComeOutFromNearAndFar) {
  Extremes draw(3);
  const StepList different = random_steps(draw, 2500, 6, 12);
  const WorkAmount work[] = {{GridWork::kCellStep, 3}};
  std::vector<TraceEvent> events;
  // The same again a whole list later, and one step so often that its count has several bytes.
  for (std::uint32_t round = 0; round < 3; ++round) {
    events.insert(events.end(), different.events.begin(), different.events.end());
    events.insert(events.end(), 40000 * round, {.kind = EventKind::kWork, .work = work});
  }
  const TileTrace once = test::packed_trace(0, different.events), trace = test::packed_trace(0, events);
  EXPECT_GT(once.packed.size(), 17000u) << "so that the list is far away";
  EXPECT_LT(trace.packed.size(), once.packed.size() * 2);
  const test::UnpackedTrace unpacked(trace);
  ASSERT_EQ(unpacked.events.size(), events.size());
  for (std::size_t i = 0; i < events.size(); ++i) ASSERT_TRUE(test::is_same_step(unpacked.events[i], events[i])) << i;
}

// Repetitions cost little: a loop of gets and waits, in which a step took 48 bytes as a struct.
TEST(TracePacking, RepeatedStepsTakeBits) {
  Steps steps;
  for (std::uint32_t i = 0; i < 2000; ++i) {
    const auto tag = static_cast<std::uint8_t>(kTriangleTag + i % 2);
    steps.work(1 + i % 3).get(480, tag, 4096 + i % 50 * 480).wait(bit(tag));
  }
  const TileTrace trace = steps;
  EXPECT_LT(trace.packed.size(), 6000 / 8) << "bytes for 6000 steps";
}

}  // namespace
}  // namespace gridiron::sim
