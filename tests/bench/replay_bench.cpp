// Replay of recorded frames for other machines: limit half a second each.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/sim/machine_profile.h>
#include <gridiron/sim/replay.h>
#include <gridiron/sim/trace_packing.h>

#include "bench/bench.h"
#include "support/ply_load.h"
#include "support/render_mesh.h"
#include "support/views.h"

namespace gridiron::bench {
namespace {

constexpr double kLimitSeconds = 0.5;

// Events of a frame, and its lines of 128 bytes as one core moves them.
std::pair<std::size_t, std::uint64_t> extent_of(const sim::FrameTrace& trace) {
  std::size_t events = 0;
  for (const sim::TileTrace& tile : trace.tiles) {
    sim::for_each_event(tile, [&events](const sim::TraceEvent&) { ++events; });
  }
  std::uint64_t line_bytes = 0;
  const sim::FrameTiming timing = sim::replay(trace, sim::machine_profiles().front(), {.core_count = 1});
  for (const sim::CoreTiming& core : timing.cores) line_bytes += core.line_bytes_in + core.line_bytes_out;
  return {events, line_bytes / 128};
}

// One frame of 1024x1024 in the reference configuration, whose packets of 8x8 move the most, on each machine.
bool bench_view(const BenchOptions& options, const test::SceneView& view) {
  const auto mesh = test::load_ply(options.scenes / view.file);
  if (!mesh) {
    std::printf("%s: %s cannot be read; left out\n", view.name, (options.scenes / view.file).c_str());
    return true;
  }
  test::SceneInMemory scene(mesh->view(), GridParameters{});
  const FrameSettings settings{.camera = view.camera ? *view.camera : test::framed_camera(mesh->view())};
  const test::RenderedFrame frame = scene.render(settings, {});
  if (frame.result.status != Status::kOk) {
    std::printf("%s: status %u\n", view.name, static_cast<unsigned>(frame.result.status));
    return false;
  }
  const sim::FrameTrace& trace = frame.result.trace;
  const auto [events, lines] = extent_of(trace);
  std::printf("%s: %ux%u, %zu events, %llu lines\n", view.name, settings.width, settings.height, events,
              static_cast<unsigned long long>(lines));

  sim::MachineProfile far_memory = sim::machine_profiles().front();
  far_memory.latency_cycles = 2000;
  const struct {
    const char* name;
    const sim::MachineProfile& machine;
    sim::ReplayOptions replay;
  } cases[] = {{"1 core", sim::machine_profiles().front(), {.core_count = 1}},
               {"6 cores", sim::machine_profiles().front(), {.core_count = 6}},
               {"6 cores, timeline", sim::machine_profiles().front(), {.core_count = 6, .timeline = true}},
               {"6 cores, 2000 cycles", far_memory, {.core_count = 6}},
               {"cell-2006", *sim::find_machine_profile("cell-2006"), {}},
               {"16 cores", sim::machine_profiles().front(), {.core_count = 16}},
               {"64 cores", sim::machine_profiles().front(), {.core_count = 64}}};
  std::vector<Candidate> candidates;
  for (const auto& each : cases) {
    candidates.push_back({each.name, [&] { (void)sim::replay(trace, each.machine, each.replay); }});
  }
  const std::vector<double> seconds = least_seconds(candidates, options.rounds);
  bool within = true;
  for (std::size_t i = 0; i < seconds.size(); ++i) {
    std::printf("  replay, %-22s %6.1f ms (limit %.0f)\n", cases[i].name, 1e3 * seconds[i], 1e3 * kLimitSeconds);
    within = seconds[i] < kLimitSeconds && within;
  }
  return within;
}

bool bench_replay(const BenchOptions& options) {
  if (options.scenes.empty()) {
    std::printf("GRIDIRON_SCENES is not set; left out\n");
    return true;
  }
  const bool bunny = bench_view(options, test::kBunnyView);
  return bench_view(options, test::kConferenceView) && bunny;
}

const Registration kRegistration("replay", bench_replay);

}  // namespace
}  // namespace gridiron::bench
