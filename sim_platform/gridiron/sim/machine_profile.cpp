// The built-in machine profiles and where their figures come from.
// Memory: constants. Threads: any. SPDX-License-Identifier: Apache-2.0
#include <gridiron/sim/build_costs.h>
#include <gridiron/sim/instruction_costs.h>
#include <gridiron/sim/machine_profile.h>
#include <gridiron/sim/tile_costs.h>
#include <gridiron/sim/work_costs.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace gridiron::sim {

namespace {

constexpr std::uint64_t kMegabyte = std::uint64_t{1} << 20;

/// Cycles per unit of work on an in-order core with two pipes and 4 lanes: counted on the kernel itself, scheduled by
/// published pipeline rules; see work_costs.h. Commands and waits are charged where they happen:
/// MachineProfile::issue_cycles and wait_cycles.
constexpr std::array<double, kWorkKindCount> two_pipe_work_cycles() {
  std::array<double, kWorkKindCount> cycles{};
  for (std::size_t kind = 0; kind < kWorkCosts.size(); ++kind) cycles[kind] = kWorkCosts[kind].cycles;
  return cycles;
}

constexpr std::array<double, kTileWorkCount> two_pipe_tile_work_cycles() {
  std::array<double, kTileWorkCount> cycles{};
  for (std::size_t kind = 0; kind < kTileCosts.size(); ++kind) cycles[kind] = kTileCosts[kind].cycles;
  return cycles;
}

/// The general core: 3.2 GHz, in order, two instructions a cycle at best, 512 KB of cache before the same memory. Both
/// builders' own code, executed through a model of this core; see build_costs.h.
constexpr MasterProfile in_order_master() {
  static_assert(kBuildCosts.size() == kBuildStepCount);
  MasterProfile master{.clock_hz = 3.2e9, .step_cycles = {}};
  for (std::size_t step = 0; step < kBuildCosts.size(); ++step) master.step_cycles[step] = kBuildCosts[step].cycles;
  return master;
}

// Six cores of a games console: 3.2 GHz, 256 KB local stores, 256 MB of main memory at 25.6 GB/s.
constexpr MachineProfile kCellPs3 = {
    .name = "cell-ps3",
    .description = "6 cores at 3.2 GHz, 256 KB local stores, 256 MB main memory at 25.6 GB/s, 90 % of it usable",
    .core_count = 6,
    .clock_hz = 3.2e9,
    .main_memory_bytes = 256 * kMegabyte,
    .local_store_bytes = 256 * 1024,
    .line_bytes = 128,      // a partial line is a bus request like a whole one
    .queue_depth = 16,      // commands of one core's transfer engine; published
    .lines_in_flight = 16,  // 16 * 128 bytes per 518 cycles = 12.7 GB/s for one core; about 10 in practice
    .issue_cycles = 24,     // 6 channel writes at 6 cycles, partly overlapped, and the address arithmetic
    .wait_cycles = 14,      // write the mask, read the status
    .latency_cycles = 500,  // "several hundred" published; report 300, 500 and 1,000
    .latency_seed = 1,
    .channel_bytes_per_cycle = 7.2,   // 25.6 GB/s = 8 bytes a cycle, 90 % of it usable: 23 GB/s; 20-23 in practice
    .core_line_interval_cycles = 16,  // 8 bytes a cycle into one local store
    .claim_cycles = 300,              // a mailbox round trip to the general core; estimate
    .pass_start_cycles = 500,         // the general core reads the count (a latency) and writes mailboxes; estimate
    .pass_barrier_cycles = 700,       // a mailbox to the general core, which looks at all cores in turn; estimate
    .work_cycles = two_pipe_work_cycles(),
    .tile_work_cycles = two_pipe_tile_work_cycles(),
    .master = in_order_master(),
};

constexpr MachineProfile with_two_gigabytes(MachineProfile machine) {
  machine.name = "cell-ps3-2gb";
  machine.description = "cell-ps3 with 2 GB of main memory, for scenes that outgrow 256 MB";
  machine.main_memory_bytes = 2048 * kMegabyte;
  return machine;
}

// The same mean, spread as a memory of banks and pages spreads it. ESTIMATES: nine lines of ten find their page open
// (390 cycles), the others wait for a page, a refresh or another line (1,490).
constexpr MachineProfile with_banks(MachineProfile machine) {
  machine.name = "cell-ps3-dram";
  machine.description = "cell-ps3 with a latency of 390 cycles for 90 % of the lines and 1490 for the others";
  machine.latency_cycles = {{390, 0.9}, {1490, 0.1}};
  return machine;
}

// The same mean, with addresses that are sometimes not translated yet. ESTIMATES: the general core walks its tables for
// 2 % of the lines, which takes 5,400 cycles.
constexpr MachineProfile with_translation_misses(MachineProfile machine) {
  machine.name = "cell-ps3-tlb";
  machine.description = "cell-ps3 with a latency of 400 cycles for 98 % of the lines and 5400 for the others";
  machine.latency_cycles = {{400, 0.98}, {5400, 0.02}};
  return machine;
}

// Eight cores of the same kind at 2.4 GHz. Costs of the memory keep their time, so they take fewer cycles; costs of the
// core keep their cycles. The size of its main memory is an assumption, and so is the same general core at 2.4 GHz; the
// steps of that core are not split into memory and computing.
constexpr MachineProfile eight_cores_of_2006(MachineProfile machine) {
  machine.name = "cell-2006";
  machine.description = "8 cores at 2.4 GHz, 256 KB local stores, 512 MB main memory at 25.6 GB/s, 90 % of it usable";
  machine.core_count = 8;
  machine.clock_hz = 2.4e9;
  machine.main_memory_bytes = 512 * kMegabyte;
  machine.latency_cycles = 375;           // 500 cycles at 3.2 GHz = 156 ns
  machine.channel_bytes_per_cycle = 9.6;  // 90 % of 25.6 GB/s
  machine.claim_cycles = 225;
  machine.pass_start_cycles = 375;  // of bus and memory, as claims are
  machine.pass_barrier_cycles = 525;
  machine.master.clock_hz = 2.4e9;
  return machine;
}

/// Instructions of a scalar core that executes 4 lanes one after the other: counted in an emulator, see
/// instruction_costs.h. Commands and waits are charged where they happen.
constexpr std::array<double, kWorkKindCount> scalar_instructions() {
  static_assert(kInstructionCosts.size() == kWorkCosts.size() - 3);
  std::array<double, kWorkKindCount> instructions{};
  for (const InstructionCost& cost : kInstructionCosts) {
    instructions[cost.kind.number()] = cost.instructions;
  }
  return instructions;
}

// Four scalar cores, each with scratchpad memory and a copy engine, as platform/sifive_u drives them. Cycles of this
// profile are INSTRUCTIONS: it predicts what an emulator counts, where a transfer has ended when its command has been
// given. It does not predict seconds.
constexpr MachineProfile counted_fu540(MachineProfile machine) {
  machine.name = "fu540";
  machine.description = "4 scalar cores, 256 KB local stores; counts instructions: transfers take none but their own";
  machine.core_count = 4;
  machine.clock_hz = 1e9;  // of the board's; no instruction takes exactly a cycle
  machine.main_memory_bytes = 8192 * kMegabyte;
  machine.issue_cycles = kCommandInstructions;  // with its end in the wait
  machine.wait_cycles = kWaitInstructions;
  machine.latency_cycles = 1;
  machine.channel_bytes_per_cycle = 65536;
  machine.core_line_interval_cycles = 0;
  machine.claim_cycles = kClaimInstructions;
  // GUESSES, as no firmware runs passes yet: the worker fetches a record and calls a kernel, then tells that it is
  // done; each like two claims. What the master executes meanwhile is not counted.
  machine.pass_start_cycles = 2 * kClaimInstructions;
  machine.pass_barrier_cycles = 2 * kClaimInstructions;
  machine.work_cycles = scalar_instructions();
  machine.tile_work_cycles = {};  // not known
  return machine;
}

template <std::size_t Count>
constexpr std::array<double, Count> times(std::array<double, Count> prices, double factor) {
  for (double& price : prices) price *= factor;
  return prices;
}

// One microcontroller core with memories of its own for code and data and no engine: it copies by itself, as
// platform/mps2 does. ESTIMATES: prices of work are those of the two pipes times one factor, so that the frames of
// platform/mps2/README.md take as many cycles as an emulated Cortex-M7 executes instructions; no price was counted, and
// no instruction takes exactly a cycle. The model hides copies behind computing, which a core that copies cannot do.
constexpr MachineProfile microcontroller(MachineProfile machine) {
  constexpr double kFactor = 4.7;
  machine.name = "cortex-m7";
  machine.description =
      "1 core at 25 MHz, 16 KB data and 32 KB code memory, 16 MB main memory; estimates, copies in software";
  machine.core_count = 1;
  machine.clock_hz = 25e6;  // of the FPGA board
  machine.main_memory_bytes = 16 * kMegabyte;
  machine.local_store_bytes = 16 * 1024;
  machine.line_bytes = 16;
  machine.lines_in_flight = 1;
  machine.issue_cycles = 40;
  machine.wait_cycles = 60;
  machine.latency_cycles = 1;
  machine.channel_bytes_per_cycle = 1;
  machine.core_line_interval_cycles = 0;
  machine.claim_cycles = 60;
  machine.work_cycles = times(two_pipe_work_cycles(), kFactor);
  machine.tile_work_cycles = times(two_pipe_tile_work_cycles(), kFactor);
  machine.master.clock_hz = 25e6;
  return machine;
}

constexpr std::array kProfiles = {kCellPs3,
                                  eight_cores_of_2006(kCellPs3),
                                  with_two_gigabytes(kCellPs3),
                                  with_banks(kCellPs3),
                                  with_translation_misses(kCellPs3),
                                  counted_fu540(kCellPs3),
                                  microcontroller(kCellPs3)};

}  // namespace

std::span<const MachineProfile> machine_profiles() {
  return kProfiles;
}

const MachineProfile* find_machine_profile(std::string_view name) {
  for (const MachineProfile& machine : kProfiles) {
    if (machine.name == name) return &machine;
  }
  return nullptr;
}

bool counts_instructions(const MachineProfile& machine) {
  return machine.work_cycles == find_machine_profile("fu540")->work_cycles;
}

}  // namespace gridiron::sim
