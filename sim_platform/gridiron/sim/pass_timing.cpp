// Pass timing: a replay a pass, with what the master adds. SPDX-License-Identifier: Apache-2.0
#include <gridiron/sim/pass_timing.h>

#include <algorithm>

namespace gridiron::sim {

namespace {

[[nodiscard]] double& limit_of(PassTiming& pass, PassLimit limit) {
  return pass.limits[static_cast<std::size_t>(limit)];
}

/// Adds up what the cores did. Sums are exact; only the division by their number rounds.
void find_limits(PassTiming& pass) {
  double busy = 0, waits = 0, end_idle = 0, longest = 0;
  for (const CoreTiming& core : pass.run.cores) {
    pass.bytes_in += core.bytes_in;
    pass.bytes_out += core.bytes_out;
    busy += core.init_cycles + core.compute_cycles + (core.idle_cycles - core.end_idle_cycles);
    for (const double wait : core.dma_wait_cycles) waits += wait;
    end_idle += core.end_idle_cycles;
    longest = std::max(longest, core.longest_tile_cycles);
  }
  const auto cores = static_cast<double>(pass.run.cores.size());
  limit_of(pass, PassLimit::kChannel) = pass.run.channel_busy_cycles;
  limit_of(pass, PassLimit::kCompute) = busy / cores;
  limit_of(pass, PassLimit::kWaiting) = waits / cores;
  limit_of(pass, PassLimit::kOneItem) = longest;
  limit_of(pass, PassLimit::kBarrier) = pass.start_cycles + end_idle / cores + pass.barrier_cycles;
  pass.binding = static_cast<PassLimit>(std::max_element(pass.limits.begin(), pass.limits.end()) - pass.limits.begin());
}

}  // namespace

std::string_view name_of(PassLimit limit) {
  constexpr std::array<std::string_view, kPassLimitCount> kNames = {"channel", "compute", "waiting", "one_item",
                                                                    "barrier"};
  return kNames[static_cast<std::size_t>(limit)];
}

PassesTiming replay_passes(std::span<const PassRun> passes, const MachineProfile& machine, std::uint32_t core_count,
                           bool timeline) {
  PassesTiming all;
  const std::uint32_t cores = std::max(1u, core_count != 0 ? core_count : machine.core_count);
  for (std::size_t i = 0; i < passes.size(); ++i) {
    PassTiming& pass = all.passes.emplace_back();
    pass.name = passes[i].name;
    pass.items = passes[i].items;
    pass.begin_cycles = all.cycles;
    pass.start_cycles = rounded_cycles(machine.pass_start_cycles);
    if (pass.items != 0) {
      MachineProfile of_pass = machine;
      of_pass.latency_seed += static_cast<std::uint32_t>(i);
      pass.run = replay(passes[i].result.trace, of_pass, {.core_count = cores, .timeline = timeline});
      pass.barrier_cycles = rounded_cycles(machine.pass_barrier_cycles);
    } else {
      pass.run.engine = passes[i].result.trace.engine;
      pass.run.cores.resize(cores);
    }
    pass.cycles = pass.start_cycles + pass.run.frame_cycles + pass.barrier_cycles;
    find_limits(pass);
    all.cycles += pass.cycles;
    if (pass.items == 1) all.one_item_cycles += pass.cycles;
  }
  all.seconds = machine.clock_hz > 0 ? all.cycles / machine.clock_hz : 0;
  return all;
}

PassTiming timing_of_pass(std::string_view name, const FrameTiming& run, const MachineProfile& machine) {
  PassTiming pass;
  pass.name = name;
  for (const CoreTiming& core : run.cores) pass.items += core.tiles;
  pass.start_cycles = rounded_cycles(machine.pass_start_cycles);
  pass.run = run;
  pass.barrier_cycles = rounded_cycles(machine.pass_barrier_cycles);
  pass.cycles = pass.start_cycles + run.frame_cycles + pass.barrier_cycles;
  find_limits(pass);
  return pass;
}

}  // namespace gridiron::sim
