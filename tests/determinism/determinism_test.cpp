// One frame, however it is made: the same picture, the same work, the same trace.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/sim/machine_profile.h>
#include <gridiron/sim/replay.h>

#include "determinism/trace_difference.h"
#include "sim_platform/replay_cases.h"
#include "support/render_mesh.h"
#include "support/test_mesh.h"
#include "support/views.h"

namespace gridiron::test {
namespace {

FrameSettings default_settings(Accuracy accuracy) {
  const Camera camera{{1.2f, 1.5f, 2.5f}, {0, 0, 0}, {0, 1, 0}, 0.5f};
  return {.camera = camera, .width = 150, .height = 110, .accuracy = accuracy};
}

// Frames of one accuracy share the scene and the frame that all others are compared with.
class Subject {
 public:
  explicit Subject(Accuracy accuracy)
      : accuracy_(accuracy), mesh_(make_mixed_mesh()), scene_(mesh_.view(), grid(accuracy)) {
    EXPECT_EQ(scene_.status(), Status::kOk);
    first_ = scene_.render(default_settings(accuracy), {});
    EXPECT_EQ(first_.result.status, Status::kOk);
  }

  static Subject& of(Accuracy accuracy) {
    static std::map<Accuracy, Subject> subjects;
    return subjects.try_emplace(accuracy, accuracy).first->second;
  }

  [[nodiscard]] const RenderedFrame& first() const { return first_; }
  [[nodiscard]] FrameSettings settings() const { return default_settings(accuracy_); }
  RenderedFrame render(const FrameSettings& settings, const sim::ChipOptions& chip) {
    return scene_.render(settings, chip);
  }

 private:
  static GridParameters grid(Accuracy accuracy) {
    return {.format = accuracy == Accuracy::kPaper ? TriangleFormat::kProjection : TriangleFormat::kVertices};
  }

  Accuracy accuracy_;
  TestMesh mesh_;
  SceneInMemory scene_;
  RenderedFrame first_;
};

// What a variation must leave alone.
enum class Keeps : std::uint8_t {
  kEverything,  // picture, work counters and trace
  kPicture,
};

struct Variation {
  std::string name;
  Keeps keeps;
  std::function<void(FrameSettings&, sim::ChipOptions&)> apply;
  // Accuracy `paper` promises its picture for every order, width, depth and store, but not without corner-ray culling:
  // the corners' test rounds like any other, so it may drop a triangle whose edge a ray of the packet just touches.
  bool changes_paper = false;
};

std::vector<Variation> make_variations() {
  using Settings = FrameSettings;
  using Chip = sim::ChipOptions;
  std::vector<Variation> variations;
  const auto add = [&variations](std::string name, Keeps keeps, std::function<void(Settings&, Chip&)> apply) {
    variations.push_back({std::move(name), keeps, std::move(apply)});
  };
  add("again", Keeps::kEverything, [](Settings&, Chip&) {});
  for (const std::uint32_t threads : {2u, 3u, 6u}) {
    add("threads_" + std::to_string(threads), Keeps::kEverything,
        [threads](Settings&, Chip& chip) { chip.threads = threads; });
  }
  add("completion_late", Keeps::kEverything, [](Settings&, Chip& chip) { chip.completion = sim::Completion::kLate; });
  add("completion_late_threads_6", Keeps::kEverything, [](Settings&, Chip& chip) {
    chip.completion = sim::Completion::kLate;
    chip.threads = 6;
  });
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    add("completion_seed_" + std::to_string(seed), Keeps::kEverything, [seed](Settings&, Chip& chip) {
      chip.completion = sim::Completion::kRandom;
      chip.seed = seed;
      chip.threads = seed % 2 == 0 ? 2 : 1;
    });
  }
  for (const std::uint32_t lanes : {4u, 8u, 16u}) {
    if (lanes > sim::widest_lanes()) continue;
    add("lanes_" + std::to_string(lanes), Keeps::kPicture, [lanes](Settings&, Chip& chip) { chip.lanes = lanes; });
    add("plain_lanes_" + std::to_string(lanes), Keeps::kPicture, [lanes](Settings&, Chip& chip) {
      chip.lanes = lanes;
      chip.mode = sim::Mode::kPlain;
      chip.threads = 2;
    });
  }
  for (const std::uint32_t width : {4u, 16u, 32u}) {
    for (const std::uint32_t lanes : {4u, 8u, 16u}) {
      if (lanes > sim::widest_lanes()) continue;
      add("packet_" + std::to_string(width) + "_lanes_" + std::to_string(lanes), Keeps::kPicture,
          [width, lanes](Settings&, Chip& chip) {
            chip.packet_width = width;
            chip.lanes = lanes;
          });
      add("subpackets_" + std::to_string(width) + "_lanes_" + std::to_string(lanes), Keeps::kPicture,
          [width, lanes](Settings& settings, Chip& chip) {
            settings.techniques |= kUseSubpackets;
            chip.packet_width = width;
            chip.lanes = lanes;
          });
    }
  }
  add("store_64KB", Keeps::kPicture, [](Settings&, Chip& chip) { chip.store = sim::StoreSize::k64KB; });
  add("store_64KB_packet_16_late", Keeps::kPicture, [](Settings&, Chip& chip) {
    chip.store = sim::StoreSize::k64KB;
    chip.packet_width = 16;
    chip.completion = sim::Completion::kLate;
  });
  // What only checked mode with 4 lanes is built for.
  struct Place {
    const char* name;
    sim::StoreSize store;
    std::uint32_t tile_width, packet_width;
  };
  for (const Place& place :
       {Place{"store_128KB", sim::StoreSize::k128KB, 32, 8},
        Place{"store_128KB_packet_32", sim::StoreSize::k128KB, 32, 32},
        Place{"store_512KB", sim::StoreSize::k512KB, 32, 8},
        Place{"store_512KB_packet_32", sim::StoreSize::k512KB, 32, 32},
        Place{"store_512KB_tile_64", sim::StoreSize::k512KB, 64, 8},
        Place{"store_512KB_tile_64_packet_32", sim::StoreSize::k512KB, 64, 32},
        Place{"tile_8", sim::StoreSize::k256KB, 8, 8}, Place{"tile_16", sim::StoreSize::k256KB, 16, 8},
        Place{"tile_16_packet_16", sim::StoreSize::k256KB, 16, 16}, Place{"tile_64", sim::StoreSize::k256KB, 64, 8},
        Place{"tile_64_packet_32", sim::StoreSize::k256KB, 64, 32}}) {
    for (const bool subpackets : {false, true}) {
      add(std::string(place.name) + (subpackets ? "_subpackets_late" : ""), Keeps::kPicture,
          [place, subpackets](Settings& settings, Chip& chip) {
            settings.tile_width = place.tile_width;
            if (subpackets) settings.techniques |= kUseSubpackets;
            if (subpackets) chip.completion = sim::Completion::kLate;
            chip.store = place.store;
            chip.packet_width = place.packet_width;
          });
    }
  }
  const auto buffering = [&add](std::string name, std::uint32_t output, std::uint32_t macro, std::uint32_t triangle) {
    for (const sim::Completion completion : {sim::Completion::kEarly, sim::Completion::kLate}) {
      add("buffering_" + name + (completion == sim::Completion::kEarly ? "" : "_late"), Keeps::kPicture,
          [=](Settings& settings, Chip& chip) {
            settings.output_depth = output;
            settings.macro_depth = macro;
            settings.triangle_depth = triangle;
            chip.completion = completion;
          });
    }
  };
  buffering("single", 1, 1, 1);
  buffering("single_tiles", 1, 2, 2);
  buffering("single_cells", 2, 1, 2);
  buffering("single_triangles", 2, 2, 1);
  buffering("deep_cells", 2, 4, 2);
  buffering("deep", 2, 4, 12);
  for (std::uint32_t off = 1; off < 8; ++off) {
    add("techniques_off_" + std::to_string(off), Keeps::kPicture,
        [off](Settings& settings, Chip&) { settings.techniques &= ~off; });
    variations.back().changes_paper = (off & kUseCornerCulling) != 0;
  }
  for (const std::uint32_t depth : {1u, 2u, 16u}) {
    add("queue_" + std::to_string(depth), Keeps::kPicture, [depth](Settings&, Chip& chip) {
      chip.limits.queue_depth = depth;
      chip.completion = sim::Completion::kLate;
    });
  }
  return variations;
}

std::vector<std::string> variation_names(Accuracy accuracy) {
  std::vector<std::string> names;
  for (const Variation& variation : make_variations()) {
    if (accuracy == Accuracy::kStandard || !variation.changes_paper) names.push_back(variation.name);
  }
  return names;
}

Variation variation_called(const std::string& name) {
  for (Variation& variation : make_variations()) {
    if (variation.name == name) return variation;
  }
  return {};
}

class StandardDeterminism : public testing::TestWithParam<std::string> {};
class PaperDeterminism : public testing::TestWithParam<std::string> {};

void expect_same_frame(Accuracy accuracy, const std::string& name) {
  const Variation variation = variation_called(name);
  Subject& subject = Subject::of(accuracy);
  FrameSettings settings = subject.settings();
  sim::ChipOptions chip;
  variation.apply(settings, chip);
  const RenderedFrame rendered = subject.render(settings, chip);
  ASSERT_EQ(rendered.result.status, Status::kOk);
  EXPECT_TRUE(rendered.result.violations.empty()) << rendered.result.violations.front().detail;
  EXPECT_EQ(test::first_difference(subject.first(), rendered), "");
  if (variation.keeps == Keeps::kEverything) {
    EXPECT_EQ(subject.first().result.work, rendered.result.work);
    const test::UnpackedTrace once(subject.first().result.trace.prologue);
    const auto gets = static_cast<std::uint64_t>(std::count_if(
        once.events.begin(), once.events.end(), [](const auto& e) { return e.kind == sim::EventKind::kGet; }));
    EXPECT_EQ(subject.first().result.transfers + (chip.threads - 1) * gets, rendered.result.transfers);
    EXPECT_EQ(first_difference(subject.first().result.trace, rendered.result.trace), "");
  }
}

TEST_P(StandardDeterminism, GivesTheSameFrame) {
  expect_same_frame(Accuracy::kStandard, GetParam());
}

TEST_P(PaperDeterminism, GivesTheSameFrame) {
  expect_same_frame(Accuracy::kPaper, GetParam());
}

const auto parameter_name = [](const auto& tested) { return tested.param; };
INSTANTIATE_TEST_SUITE_P(Variations, StandardDeterminism, testing::ValuesIn(variation_names(Accuracy::kStandard)),
                         parameter_name);
INSTANTIATE_TEST_SUITE_P(Variations, PaperDeterminism, testing::ValuesIn(variation_names(Accuracy::kPaper)),
                         parameter_name);

// The comparisons above could be blind; these are frames that must not compare equal.
TEST(DeterminismTest, SeesDifferences) {
  Subject& subject = Subject::of(Accuracy::kStandard);
  FrameSettings nudged = subject.settings();
  nudged.camera.eye.x = std::nextafter(nudged.camera.eye.x, 2.0f);
  const RenderedFrame other = subject.render(nudged, {});
  EXPECT_NE(test::first_difference(subject.first(), other), "");
  FrameSettings single = subject.settings();
  single.triangle_depth = 1;
  const RenderedFrame other_trace = subject.render(single, {});
  EXPECT_NE(first_difference(subject.first().result.trace, other_trace.result.trace), "");
}

// One trace, any number of cores: the same work, bytes and tiles, and every cycle of every core accounted for.
TEST(ReplayOfAFrame, SumsToTheSameWorkForAnyNumberOfCores) {
  const sim::FrameTrace& trace = Subject::of(Accuracy::kStandard).first().result.trace;
  const sim::MachineProfile* machine = sim::find_machine_profile("cell-ps3");
  ASSERT_NE(machine, nullptr);

  sim::CoreTiming of_tiles, once;  // once: what every core does whatever its tiles
  const auto add = [](const sim::TileTrace& part, sim::CoreTiming& sum) {
    sim::for_each_event(part, [&](const sim::TraceEvent& e) {
      sum.gets += e.kind == sim::EventKind::kGet ? 1 : 0;
      sum.puts += e.kind == sim::EventKind::kPut ? 1 : 0;
      sum.bytes_in += e.kind == sim::EventKind::kGet ? e.bytes : 0;
      sum.bytes_out += e.kind == sim::EventKind::kPut ? e.bytes : 0;
    });
  };
  for (const sim::TileTrace& tile : trace.tiles) add(tile, of_tiles);
  add(trace.prologue, once);
  add(trace.epilogue, once);
  ASSERT_GT(of_tiles.gets, 0u);
  ASSERT_GT(of_tiles.puts, 0u);

  double work_of_tiles = 0;  // computation and initialisation without the once-per-core part
  double work_per_core = 0;
  for (const std::uint32_t cores : {1u, 2u, 3u, 6u, 8u}) {
    const sim::FrameTiming timing = sim::replay(trace, *machine, {.core_count = cores, .timeline = true});
    ASSERT_EQ(timing.cores.size(), cores);
    const sim::CoreTiming sum = sim::sum_of(timing.cores);
    const double busy = sum.init_cycles + sum.compute_cycles;
    for (const sim::CoreTiming& core : timing.cores) {
      EXPECT_EQ(sim::accounted_cycles(core), timing.frame_cycles) << cores << " cores";
    }
    EXPECT_EQ(sum.tiles, trace.tiles.size()) << cores << " cores";
    EXPECT_EQ(sum.gets, of_tiles.gets + cores * once.gets) << cores << " cores";
    EXPECT_EQ(sum.puts, of_tiles.puts + cores * once.puts) << cores << " cores";
    EXPECT_EQ(sum.bytes_in, of_tiles.bytes_in + cores * once.bytes_in) << cores << " cores";
    EXPECT_EQ(sum.bytes_out, of_tiles.bytes_out + cores * once.bytes_out) << cores << " cores";

    // busy = tiles' work + cores * once-per-core work: two core counts determine both, the others must agree.
    if (cores == 1) {
      work_of_tiles = busy;
    } else if (cores == 2) {
      work_per_core = busy - work_of_tiles;
      work_of_tiles -= work_per_core;
    } else {
      EXPECT_EQ(busy, work_of_tiles + cores * work_per_core) << cores << " cores";
    }
    // Tiles go to whoever asks first, so at the end a core idles for no longer than one tile takes.
    double longest_tile = 0;
    for (const sim::TimelineSpan& span : timing.timeline) {
      if (span.kind != sim::TimelineSpan::Kind::kTile) continue;
      longest_tile = std::max(longest_tile, span.end_cycles - span.begin_cycles);
    }
    for (const sim::CoreTiming& core : timing.cores) {
      EXPECT_LE(core.idle_cycles, longest_tile + machine->claim_cycles * (core.tiles + 1)) << cores << " cores";
    }
  }
}

}  // namespace
}  // namespace gridiron::test
