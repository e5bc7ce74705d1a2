// What a unit of each kind of work takes in instructions of a riscv64 core, 4 lanes, and what commands,
// waits and claims take on the port of platform/sifive_u. Written by tools/calibrate/second_opinion/run from
// the kernel in an emulator; do not edit: tools/calibrate/README.md. Of the frame `dense`; kinds that it has
// none of, of the others. Kinds do not tell the steps through the grid that walks of secondary rays take from
// those of packets: they have one cost, that of packets.
// Memory: constants. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/work_counters.h>

#include <array>

namespace gridiron::sim {

/// A kind of work.
struct InstructionCost {
  Work kind;
  double instructions;
};

/// All kinds but commands and waits.
inline constexpr auto kInstructionCosts = std::to_array<InstructionCost>({
    {Work{ 0},    89.4},  // tile_start
    {Work{ 1},   264.0},  // ray_generated
    {Work{ 2},  1059.6},  // packet_start
    {Work{ 3},   412.4},  // pass_group, not in `dense`
    {Work{ 4},   408.9},  // pass_square
    {Work{ 5},   242.5},  // macro_slice_step
    {Work{ 6},    68.2},  // macro_cell_step
    {Work{ 7},   277.4},  // macro_cell_visit
    {Work{ 8},   260.7},  // slice_step
    {Work{ 9},    12.5},  // cell_step
    {Work{10},   153.3},  // cell_visit
    {Work{11},   387.1},  // triangle_batch
    {Work{12},    38.8},  // mailbox_probe
    {Work{13},   354.0},  // cull_test
    {Work{14},  1562.4},  // pixel_box_group, not in `dense`
    {Work{15},   792.3},  // triangle_setup
    {Work{16},   315.9},  // subpacket_setup, not in `dense`
    {Work{17},   403.6},  // subpacket_group, not in `dense`
    {Work{18},   299.8},  // group_test_standard
    {Work{19},   406.2},  // group_test_paper, not in `dense`
    {Work{20},   365.6},  // hit_group
    {Work{21},  1111.0},  // hit_subpacket, not in `dense`
    {Work{22},   182.8},  // hit_group_paper, not in `dense`
    {Work{23},   255.6},  // hit_setup
    {Work{24},   178.3},  // double_sign
    {Work{25},  2430.8},  // exact_sign, of 64 decisions
    {Work{26}, 66091.2},  // exact_distance, of 64 decisions
    {Work{27},    25.6},  // reach_group
    {Work{28},    26.2},  // shaded_group, not in `dense`
    {Work{29},   178.2},  // shaded_simple_group
    {Work{30},   107.3},  // depth_group, not in `dense`
    {Work{31},    18.0},  // id_group
    {Work{32},   359.8},  // footprint_group, not in `dense`
    {Work{33},   297.0},  // row_group, not in `dense`
    {Work{34},   356.1},  // estimate_setup
    {Work{35},   228.0},  // normal_setup
    {Work{36},   351.4},  // hit_half
    {Work{37}, 27547.3},  // exact_order, of 64 decisions
    {Work{38},   123.1},  // lattice_triangle, not in `dense`
    {Work{39},    15.0},  // cell_bound_step, not in `dense`
    {Work{40},   147.1},  // wave_ray, of effects
    {Work{41},   105.0},  // queued_ray, of effects
    {Work{42},  5255.5},  // walk_pass, of effects
    {Work{43},   314.1},  // shaft_group, of effects
    {Work{44},   274.6},  // ray_triangle_setup, of effects
    {Work{45},  1722.3},  // ray_group_test, of effects
    {Work{46},   350.0},  // ray_distance, of effects
    {Work{47},  1489.4},  // surface_point, of effects
    {Work{48},   268.8},  // smooth_normal, of effects
    {Work{49},   148.4},  // shadow_ray, of effects
    {Work{50},    67.0},  // light_sample, of effects
    {Work{51},   153.2},  // highlight, of effects
    {Work{52},   188.6},  // occlusion_ray, of effects
    {Work{53},    57.1},  // mirror_ray, of effects
    {Work{54},   131.8},  // refracted_ray, of effects
    {Work{55},   380.3},  // environment_lookup, of effects
    {Work{56},    84.2},  // color_added, of effects
    {Work{57},   193.1},  // color_group, of effects
});

/// A command: from where core counts it to the next kind of work, and its end in a wait.
inline constexpr double kCommandInstructions = 254.6;
/// A wait: from where core counts it to the next kind of work, without the ends of commands.
inline constexpr double kWaitInstructions = 91.2;
/// A claim: from asking for a tile to the tile's first work.
inline constexpr double kClaimInstructions = 61.8;

}  // namespace gridiron::sim
