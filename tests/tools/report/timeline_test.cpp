// Timeline: valid Chrome trace, nothing lost, no overlaps, bounded size.
// Memory: std::string. Threads: one. SPDX-License-Identifier: Apache-2.0
#include "report/timeline.h"

#include <gridiron/sim/build_pass_work.h>

#include <nlohmann/json.hpp>

#include "support/test_headers.h"

namespace gridiron::tool {
namespace {

using nlohmann::json;
using sim::TimelineSpan;
using sim::WaitLevel;
using Kind = TimelineSpan::Kind;

sim::MachineProfile machine() {
  sim::MachineProfile profile = *sim::find_machine_profile("cell-ps3");
  profile.clock_hz = 2e9;  // half a nanosecond a cycle
  return profile;
}

TimelineSpan span(std::uint32_t core, Kind kind, std::uint32_t tile, double begin, double end,
                  WaitLevel level = WaitLevel::kTile) {
  return {.core = core, .kind = kind, .level = level, .tile_id = tile, .begin_cycles = begin, .end_cycles = end};
}

/// Two cores, the first with a prologue and a tile, the second with a tile of many short spans.
sim::FrameTiming sample(std::uint32_t short_span_count) {
  sim::FrameTiming timing;
  timing.cores.resize(2);
  timing.timeline = {span(0, Kind::kWait, sim::kNoTile, 0, 100, WaitLevel::kSetup),
                     span(0, Kind::kTile, 7, 400, 1000),
                     span(0, Kind::kInit, 7, 400, 500),
                     span(0, Kind::kCompute, 7, 500, 800),
                     span(0, Kind::kWait, 7, 800, 1000, WaitLevel::kTriangle),
                     span(1, Kind::kTile, 8, 300, 300 + 10.0 * short_span_count)};
  for (std::uint32_t i = 0; i < short_span_count; ++i) {
    const Kind kind = i % 3 == 0 ? Kind::kInit : i % 3 == 1 ? Kind::kCompute : Kind::kWait;
    timing.timeline.push_back(span(1, kind, 8, 300 + 10.0 * i, 310 + 10.0 * i, WaitLevel::kMacroCell));
  }
  timing.frame_cycles = std::max(1000.0, 300 + 10.0 * short_span_count);
  return timing;
}

std::vector<json> complete_events(const json& trace) {
  std::vector<json> events;
  for (const json& event : trace["traceEvents"]) {
    if (event["ph"] == "X") events.push_back(event);
  }
  return events;
}

TEST(Timeline, SpansBecomeEventsInMicroseconds) {
  const json trace = json::parse(timeline_json(sample(0), machine()));
  EXPECT_EQ(trace["otherData"]["version"], 1);
  EXPECT_EQ(trace["otherData"]["machine"], "cell-ps3");
  EXPECT_EQ(trace["otherData"]["merged_below_cycles"], 0);
  const std::vector<json> events = complete_events(trace);
  ASSERT_EQ(events.size(), 6u);
  EXPECT_EQ(events[0], json::parse(R"({"name": "wait setup", "ph": "X", "pid": 0, "tid": 0, "ts": 0.0, "dur": 0.05,
                                       "args": {}})"));
  EXPECT_EQ(events[1], json::parse(R"({"name": "tile", "ph": "X", "pid": 0, "tid": 0, "ts": 0.2, "dur": 0.3,
                                       "args": {"tile": 7}})"));
  EXPECT_EQ(events[2]["name"], "init");
  EXPECT_EQ(events[3]["name"], "compute");
  EXPECT_EQ(events[3]["ts"], 0.25);
  EXPECT_EQ(events[3]["dur"], 0.15);
  EXPECT_EQ(events[4]["name"], "wait triangle");
  EXPECT_EQ(events[5]["tid"], 1);
}

TEST(Timeline, EveryCoreHasANamedRow) {
  const json trace = json::parse(timeline_json(sample(0), machine()));
  std::map<int, std::string> rows;
  for (const json& event : trace["traceEvents"]) {
    if (event["name"] == "thread_name") rows[event["tid"]] = event["args"]["name"];
  }
  EXPECT_EQ(rows, (std::map<int, std::string>{{0, "core 0"}, {1, "core 1"}}));
}

TEST(Timeline, LevelsHaveNames) {
  sim::FrameTiming timing;
  timing.cores.resize(1);
  for (std::uint32_t level = 0; level < sim::kWaitLevelCount; ++level) {
    timing.timeline.push_back(span(0, Kind::kWait, 0, level, level + 1.0, static_cast<WaitLevel>(level)));
  }
  const std::vector<json> events = complete_events(json::parse(timeline_json(timing, machine())));
  ASSERT_EQ(events.size(), 4u);
  EXPECT_EQ(events[0]["name"], "wait tile");
  EXPECT_EQ(events[1]["name"], "wait macrocell");
  EXPECT_EQ(events[2]["name"], "wait triangle");
  EXPECT_EQ(events[3]["name"], "wait setup");
}

TEST(Timeline, NeighboursMeetWhateverTheClock) {
  sim::FrameTiming timing;
  timing.cores.resize(1);
  double time = 0;
  for (std::uint32_t i = 0; i < 1000; ++i) {
    const double end = time + 1 + (i * 37 % 101) / 7.0;
    timing.timeline.push_back(span(0, i % 2 ? Kind::kCompute : Kind::kInit, 0, time, end));
    time = end;
  }
  for (const double clock_hz : {3.2e9, 2.4e9, 7.77e8}) {
    sim::MachineProfile profile = machine();
    profile.clock_hz = clock_hz;
    const std::vector<json> events = complete_events(json::parse(timeline_json(timing, profile)));
    std::int64_t last_end = 0;
    for (const json& event : events) {
      const std::int64_t begin = std::llround(event["ts"].get<double>() * 1e4);
      ASSERT_EQ(begin, last_end) << "clock " << clock_hz;
      last_end = begin + std::llround(event["dur"].get<double>() * 1e4);
    }
    EXPECT_NEAR(static_cast<double>(last_end) * 1e-10, time / clock_hz, 1e-10) << "clock " << clock_hz;
  }
}

TEST(Timeline, ShortSpansMergeOnlyWhereTheTextIsTooLong) {
  const sim::FrameTiming timing = sample(3000);
  const std::string whole = timeline_json(timing, machine());
  EXPECT_EQ(complete_events(json::parse(whole)).size(), 3006u);
  EXPECT_EQ(timeline_json(timing, machine(), whole.size()), whole);

  const std::string merged = timeline_json(timing, machine(), whole.size() - 1);
  EXPECT_LT(merged.size(), whole.size());
  const json trace = json::parse(merged);
  EXPECT_EQ(trace["otherData"]["merged_below_cycles"], 64);
  const std::vector<json> events = complete_events(trace);
  ASSERT_EQ(events.size(), 7u);  // the long spans of core 0 are as they were
  EXPECT_EQ(events[3]["name"], "compute");
  EXPECT_EQ(events[6], json::parse(R"({"name": "mixed", "ph": "X", "pid": 0, "tid": 1, "ts": 0.15, "dur": 15.0,
                  "args": {"tile": 8, "spans": 3000, "init_us": 5.0, "compute_us": 5.0, "wait_us": 5.0}})"));
}

TEST(Timeline, MergingStopsAtTilesGapsAndLongSpans) {
  sim::FrameTiming timing;
  timing.cores.resize(1);
  timing.frame_cycles = 5000;
  timing.timeline = {span(0, Kind::kInit, 1, 0, 10),
                     span(0, Kind::kCompute, 1, 10, 20),
                     span(0, Kind::kInit, 2, 20, 30),
                     span(0, Kind::kCompute, 2, 40, 50),
                     span(0, Kind::kInit, 2, 50, 60),
                     span(0, Kind::kCompute, 2, 60, 4000),
                     span(0, Kind::kInit, 2, 4000, 4010),
                     span(0, Kind::kCompute, 2, 4010, 4020),
                     span(0, Kind::kInit, sim::kNoTile, 4020, 4030),
                     span(0, Kind::kCompute, sim::kNoTile, 4030, 4040)};
  const std::size_t whole_bytes = timeline_json(timing, machine()).size();
  const json trace = json::parse(timeline_json(timing, machine(), whole_bytes - 1));
  std::vector<std::string> names;
  for (const json& event : complete_events(trace)) names.push_back(event["name"]);
  // Merged events are longer than plain ones, so a small sample gets no shorter; the test is which ones merged.
  EXPECT_EQ(names, (std::vector<std::string>{"mixed", "init", "mixed", "compute", "mixed", "mixed"}));
}

TEST(Timeline, HopelessLimitEnds) {
  const json trace = json::parse(timeline_json(sample(300), machine(), 10));
  EXPECT_GT(trace["otherData"]["merged_below_cycles"].get<double>(), 3300.0);
  EXPECT_EQ(complete_events(trace).size(), 5u);  // two tiles, the prologue, one run a tile
}

TEST(Timeline, EmptyFrameIsValid) {
  EXPECT_TRUE(json::parse(timeline_json({}, machine())).is_object());
}

// Each pass begins where the one before it ends; on cores behind its start.
TEST(Timeline, PassesFollowOneAnother) {
  sim::PassTiming build, master, picture;
  build.name = "bounds";
  build.items = 9;
  build.start_cycles = 100;
  build.run = sample(0);
  build.run.engine = &sim::kBuildPassesWork;
  build.barrier_cycles = 60;
  build.cycles = 1160;
  master.name = "check_value";
  master.cycles = master.run.frame_cycles = 40;
  picture = build;
  picture.name = "picture";
  picture.run.engine = &sim::kTreeEngine;
  const std::array passes = {build, master, picture};
  const json trace = json::parse(passes_timeline_json(passes, machine()));
  const std::vector<json> events = complete_events(trace);
  const auto named = [&events](const char* name, unsigned row) {
    std::vector<json> found;
    for (const json& event : events) {
      if (event["name"] == name && event["tid"] == row) found.push_back(event);
    }
    return found;
  };
  const std::vector<json> item = named("item", 0), tile = named("tile", 0);
  ASSERT_EQ(item.size(), 1u);
  ASSERT_EQ(tile.size(), 1u);
  EXPECT_EQ(item[0]["args"], (json{{"item", 7}}));
  EXPECT_EQ(tile[0]["args"], (json{{"tile", 7}}));
  EXPECT_EQ(item[0]["ts"], 0.25) << "at 100 + 400 cycles";
  EXPECT_EQ(tile[0]["ts"], 0.85) << "1200 later";
  EXPECT_EQ(named("wait window", 0).size(), 0u);
  EXPECT_EQ(named("wait record", 0).size(), 1u) << "levels have the names of their pass";
  EXPECT_EQ(named("wait leaf", 0).size(), 1u);
  ASSERT_EQ(named("bounds", 2).size(), 1u);
  EXPECT_EQ(named("bounds", 2)[0]["args"], (json{{"items", 9}}));
  EXPECT_EQ(named("bounds", 2)[0]["dur"], 0.58);
  EXPECT_EQ(named("check_value", 2)[0]["ts"], 0.58);
  EXPECT_EQ(named("picture", 2)[0]["ts"], 0.6);
  ASSERT_EQ(named("start", 2).size(), 2u);
  ASSERT_EQ(named("barrier", 2).size(), 2u);
  EXPECT_EQ(named("barrier", 2)[1]["ts"], 1.15);
  EXPECT_EQ(named("barrier", 2)[1]["dur"], 0.03);
}

}  // namespace
}  // namespace gridiron::tool
