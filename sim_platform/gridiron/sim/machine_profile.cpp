// The built-in machine profiles and where their figures come from.
// Memory: constants. Threads: any. SPDX-License-Identifier: Apache-2.0
#include <gridiron/sim/machine_profile.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace gridiron::sim {

namespace {

constexpr std::uint64_t kMegabyte = std::uint64_t{1} << 20;

/// Cycles per unit of work on an in-order core with two pipes (even: arithmetic, odd: loads, stores, shuffles,
/// branches), 4 single-precision lanes, 6 cycles of latency for loads and float arithmetic, and 18 cycles for a
/// mispredicted branch.
///
/// ESTIMATES, to be calibrated: instructions of each algorithm were counted by hand, not measured on compiled code. The
/// rule: even instructions plus the odd ones that find no even partner (two issue together in a quarter of the cycles),
/// plus half a branch miss where a branch goes either way, plus latency where a chain of dependent instructions is
/// longer than what can be put between. Expect +-30 % on each; ratios between machines with the same work are better.
constexpr std::array<double, kWorkKindCount> two_pipe_work_cycles() {
  std::array<double, kWorkKindCount> cycles{};
  const auto set = [&cycles](Work kind, double value) { cycles[static_cast<std::size_t>(kind)] = value; };

  // Initialisation. With kShadedGroup, an 8x8 packet costs 500 + 16 * (40 + 40) = 1,780, and a sixteenth of a 32x32
  // tile's start makes it 1,805: the 1,800 of a hand count of packet set-up and output as a whole.
  set(Work::kTileStart, 400);    // tile corner and buffer addresses, some 60 scalar instructions at their full latency
  set(Work::kRayGenerated, 40);  // 3 axes * (2 multiplications, 2 additions), 3 stores, |d| maximum: 17 even, 9 odd,
                                 // a chain of four float instructions
  set(Work::kPacketStart, 500);  // 4 corner rays, major axis and signs, slopes of 4 bounds (3 divisions of 4 lanes,
                                 // each estimate + Newton step, 30), 16 stores that empty the mailbox, loop set-up

  // Walking the grid. Scalar control that depends on itself: latency decides.
  set(Work::kMacroSliceStep, 70);  // overlap rectangle of a macro slice: 8 multiply-adds, floor, clamp, loop bounds
  set(Work::kMacroCellStep, 20);   // load the 32-bit word, test one bit, unpredictable branch
  set(Work::kMacroCellVisit, 40);  // block index by population count, buffer look-up, bounds of its slices
  set(Work::kSliceStep, 60);       // as a macro slice, the clamp being to the macrocell
  set(Work::kCellStep, 24);        // index, load of {first, count}, test, branch
  set(Work::kCellVisit, 30);       // set-up of the triangle loop, splitting the range into buffers
  set(Work::kTriangleBatch, 20);   // turn the buffer over, bounds of the loop inside it

  // Per triangle. Double precision: two lanes, and each instruction holds up everything for 6 cycles more: 7 each.
  set(Work::kMailboxProbe, 40);  // scalar load, compare, store: 14 even, 10 odd, half a branch miss
  // The four corner rays as one group test of the paper's kind: 30 even, 20 odd, bound by its chain, then a branch that
  // goes either way. The `standard` test has the edges already and needs about 65; the larger of the two is charged.
  set(Work::kCullTest, 90);
  // Vertices relative to the eye, three edges side by side in lanes: 18 additions and subtractions, 6 multiplications,
  // 3 subtractions, 15 for the filter's bounds, 13 for the orientation's sign, 3 to flip by it, and 6 compares: 64
  // even; 9 loads, 12 shuffles, 9 splats, 10 stores: 40 odd, of which 15 pair; a branch miss now and then, and latency
  // at the start, where nothing can be put between.
  set(Work::kTriangleSetup, 110);
  // 3 edges * (3 multiplications, 2 additions, 2 compares, negated bound) = 24, merging masks 11: 35 even, 10 odd, of
  // which 4 pair; a quarter of a miss.
  set(Work::kGroupTestStandard, 46);
  // Three linear forms for three edges at once 15, threshold 2, offsets of four subpackets 27: 44 even; 9 splats, 8
  // loads and stores, 7 shuffles: 24 odd, of which 10 pair.
  set(Work::kSubpacketSetup, 58);
  // A square: 3 edges * (2 multiplications, 3 additions, compare) = 18, merging 5 even, 12 splats and loads odd; four
  // subpackets: 3 * 2 + 5 even, 6 odd. There are about as many of one as of the other: 17 even, 9 odd, of which 4 pair.
  set(Work::kSubpacketGroup, 22);
  // Product of distance and scale, absolute value, select, maximum: 5 even, 4 odd, half of which pair.
  set(Work::kReachGroup, 7);
  // Distance (5, reciprocal estimate and Newton step 4), hit point 2, barycentrics 2 * 3, compares and selects 10: 27
  // even, 14 odd = 34; and 2 for its share of the loop (580 for 16 groups).
  set(Work::kGroupTestPaper, 36);
  set(Work::kHitGroup, 25);    // load, compares, selects, stores: 12 even, 10 odd, half a branch miss
  set(Work::kFarSetup, 60);    // edges 6, normal 9, numerator and sizes 17, range 5; a chain, hardly any pairs
  set(Work::kFarGroup, 20);    // denominator 5, product 2, widening, compare 3, 4 odd; half a branch miss
  // In double: 3 conversions, denominator 5, division 8 (estimate, three Newton steps), error 2, ends of the interval
  // 3, facing 2: 23 * 7, and 20 for rounding on bit patterns.
  set(Work::kHitHalf, 181);
  set(Work::kFootprintGroup, 27);  // 4 bounds * (2 multiplications, minimum, sum) and 4 compares: 23 even, 8 odd
  set(Work::kRowGroup, 26);        // 3 edges * (3 multiplications, 3 sums, compare): 21 even, 9 odd
  set(Work::kHitGroupPaper, 60);  // 2 lanes that merge at 30 each
  // In double: normal 18, numerator 6, error bounds 9, squared length 5, two divisions and a square root 30: 68, of
  // which 40 go two by two.
  set(Work::kHitSetup, 340);
  // In double: 6 + 3 + 3 differences and sums, their sizes 6, determinant 14, bound 3, and 12 conversions: 47, of which
  // 16 go two by two; compares and a branch that goes either way 20.
  set(Work::kDoubleSign, 290);

  // In integers, scalar, 27 limbs of 32 bits.
  set(Work::kExactSign, 1000);      // 18 products of three 24-bit mantissas at about 45 (two multiplications of 16-bit
                                    // parts, shift, 4 limb updates), carries over 27 limbs at 6
  set(Work::kExactDistance, 6000);  // 12 such products, then up to 31 comparisons of 27 limbs at 6 each

  // Pixels.
  set(Work::kShadedGroup, 40);         // compare, select, pack 4 pixels, store, tile address
  set(Work::kShadedSimpleGroup, 100);  // the same, |d| 5, square root to the nearest float 20, division 16, scale,
                                       // clamp and convert 6, pack 9; the cosine is part of kHitGroup

  // Commands and waits are charged where they happen: MachineProfile::issue_cycles and wait_cycles.
  set(Work::kGetIssue, 0);
  set(Work::kPutIssue, 0);
  set(Work::kWait, 0);
  return cycles;
}

/// The general core: 3.2 GHz, in order, two instructions a cycle at best, 512 KB of cache before the same memory.
///
/// ESTIMATES: instructions of the builder's loops counted by hand. The rules: an instruction costs 1.5 cycles (two
/// issue together now and then, results of float instructions take 10), a branch that goes either way 12 (half of 23),
/// streamed memory half a cycle a byte (128-byte lines, 8 under way, 500 cycles each), a line met at random that is not
/// in the cache 500, a conversion to integer 10 (through memory, 40, four in a row overlap).
constexpr MasterProfile in_order_master() {
  MasterProfile master{.clock_hz = 3.2e9, .step_cycles = {}};
  const auto set = [&master](BuildStep step, double value) {
    master.step_cycles[static_cast<std::size_t>(step)] = value;
  };
  set(BuildStep::kVertexCheck, 27);       // 14 instructions; 12 bytes streamed
  set(BuildStep::kTriangleSurvey, 140);   // 66 instructions (loads 12, checks 6, area 24, bounds 24); 12 bytes; 3
                                          // vertices met in the cache behind the first: 35
  set(BuildStep::kCellBox, 230);          // 78 instructions (loads 12, area 24, to cells 18, box 24); 6 conversions; a
                                          // branch; triangle and vertices as above: 41
  set(BuildStep::kCellRow, 100);          // 41 instructions (two edges cut, range, index); 2 conversions; 1.5 branches
  set(BuildStep::kReferenceInsert, 36);   // 12 instructions; 12 bytes streamed out; a branch
  set(BuildStep::kReferenceSort, 240);    // 27 instructions; 28 bytes; 3 random lines, each missed 1 time in 8
  set(BuildStep::kTriangleWrite, 315);    // 27 instructions; 48 bytes out; 4 random lines, each missed 1 time in 8
  set(BuildStep::kProjectionSetup, 340);  // 80 instructions; 3 divisions at 74
  set(BuildStep::kCellSum, 21);           // 6 instructions; 8 bytes cleared, read, written
  set(BuildStep::kMacroWord, 31);         // 18 instructions (bits counted and summed); 8 bytes
  set(BuildStep::kCheckedLine, 370);      // 16 multiplications of 64 bits at 15; 128 bytes cleared, then read
  set(BuildStep::kBinUpdate, 50);         // 27 instructions (bin 8, bounds 18, count 1); a conversion
  set(BuildStep::kTriangleMoved, 65);     // 16 instructions; 28 bytes read and written; a branch
  set(BuildStep::kNodeMade, 2000);        // 3 axes * 16 bins * 2 directions * 12 instructions: 1,728; the rest 270
  return master;
}

// Six cores of a games console: 3.2 GHz, 256 KB local stores, 256 MB of main memory at 25.6 GB/s.
constexpr MachineProfile kCellPs3 = {
    .name = "cell-ps3",
    .description = "6 cores at 3.2 GHz, 256 KB local stores, 256 MB main memory at 25.6 GB/s",
    .core_count = 6,
    .clock_hz = 3.2e9,
    .main_memory_bytes = 256 * kMegabyte,
    .local_store_bytes = 256 * 1024,
    .line_bytes = 128,                // a partial line is a bus request like a whole one
    .queue_depth = 16,                // commands of one core's transfer engine; published
    .lines_in_flight = 16,            // 16 * 128 bytes per 518 cycles = 12.7 GB/s for one core; about 10 in practice
    .issue_cycles = 24,               // 6 channel writes at 6 cycles, partly overlapped, and the address arithmetic
    .wait_cycles = 14,                // write the mask, read the status
    .latency_cycles = 500,            // "several hundred" published; report 300, 500 and 1,000
    .channel_bytes_per_cycle = 7.2,   // 25.6 GB/s = 8 bytes a cycle, 90 % of it usable: 23 GB/s; 20-23 in practice
    .core_line_interval_cycles = 16,  // 8 bytes a cycle into one local store
    .claim_cycles = 300,              // a mailbox round trip to the general core; estimate
    .work_cycles = two_pipe_work_cycles(),
    .master = in_order_master(),
};

constexpr MachineProfile with_two_gigabytes(MachineProfile machine) {
  machine.name = "cell-ps3-2gb";
  machine.description = "cell-ps3 with 2 GB of main memory, for scenes that outgrow 256 MB";
  machine.main_memory_bytes = 2048 * kMegabyte;
  return machine;
}

// Eight cores of the same make at 2.4 GHz. What belongs to the memory keeps its time, so it takes fewer cycles; what
// belongs to the core keeps its cycles. The size of its main memory is an assumption, and so is that its general core
// is the same at 2.4 GHz; the share of its steps that is memory is not taken apart.
constexpr MachineProfile eight_cores_of_2006(MachineProfile machine) {
  machine.name = "cell-2006";
  machine.description = "8 cores at 2.4 GHz, 256 KB local stores, 512 MB main memory at 25.6 GB/s";
  machine.core_count = 8;
  machine.clock_hz = 2.4e9;
  machine.main_memory_bytes = 512 * kMegabyte;
  machine.latency_cycles = 375;           // 500 cycles at 3.2 GHz = 156 ns
  machine.channel_bytes_per_cycle = 9.6;  // 90 % of 25.6 GB/s
  machine.claim_cycles = 225;
  machine.master.clock_hz = 2.4e9;
  return machine;
}

constexpr std::array<MachineProfile, 3> kProfiles = {kCellPs3, eight_cores_of_2006(kCellPs3),
                                                     with_two_gigabytes(kCellPs3)};

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

}  // namespace gridiron::sim
