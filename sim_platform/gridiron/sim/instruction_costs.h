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
  WorkId kind;
  double instructions;
};

/// All kinds but commands and waits.
inline constexpr auto kInstructionCosts = std::to_array<InstructionCost>({
    {WorkId( 0),    89.4},  // tile_start
    {WorkId( 1),   264.0},  // ray_generated
    {WorkId( 2),   354.0},  // cull_test
    {WorkId( 3),  1562.4},  // pixel_box_group, not in `dense`
    {WorkId( 4),   792.3},  // triangle_setup
    {WorkId( 5),   315.9},  // subpacket_setup, not in `dense`
    {WorkId( 6),   403.6},  // subpacket_group, not in `dense`
    {WorkId( 7),   300.0},  // group_test_standard
    {WorkId( 8),   406.2},  // group_test_paper, not in `dense`
    {WorkId( 9),   365.6},  // hit_group
    {WorkId(10),  1111.0},  // hit_subpacket, not in `dense`
    {WorkId(11),   182.8},  // hit_group_paper, not in `dense`
    {WorkId(12),   255.6},  // hit_setup
    {WorkId(13),   178.3},  // double_sign
    {WorkId(14),  2430.8},  // exact_sign, of 64 decisions
    {WorkId(15), 66091.2},  // exact_distance, of 64 decisions
    {WorkId(16),    26.2},  // shaded_group, not in `dense`
    {WorkId(17),   178.2},  // shaded_simple_group
    {WorkId(18),   107.3},  // depth_group, not in `dense`
    {WorkId(19),    18.0},  // id_group
    {WorkId(20),   297.0},  // row_group, not in `dense`
    {WorkId(21),   356.1},  // estimate_setup
    {WorkId(22),   228.0},  // normal_setup
    {WorkId(23),   351.4},  // hit_half
    {WorkId(24), 27547.3},  // exact_order, of 64 decisions
    {WorkId(25),   123.1},  // lattice_triangle, not in `dense`
    {WorkId(26),   147.1},  // wave_ray, of effects
    {WorkId(27),   105.0},  // queued_ray, of effects
    {WorkId(28),   274.6},  // ray_triangle_setup, of effects
    {WorkId(29),  1722.3},  // ray_group_test, of effects
    {WorkId(30),   350.0},  // ray_distance, of effects
    {WorkId(31),  1489.4},  // surface_point, of effects
    {WorkId(32),   268.8},  // smooth_normal, of effects
    {WorkId(33),   148.4},  // shadow_ray, of effects
    {WorkId(34),    67.0},  // light_sample, of effects
    {WorkId(35),   153.2},  // highlight, of effects
    {WorkId(36),   188.6},  // occlusion_ray, of effects
    {WorkId(37),    57.1},  // mirror_ray, of effects
    {WorkId(38),   131.8},  // refracted_ray, of effects
    {WorkId(39),   380.3},  // environment_lookup, of effects
    {WorkId(40),    84.2},  // color_added, of effects
    {WorkId(41),   193.1},  // color_group, of effects
    {WorkId(45),  1059.6},  // packet_start
    {WorkId(46),   412.4},  // pass_group, not in `dense`
    {WorkId(47),   408.9},  // pass_square
    {WorkId(48),   242.5},  // macro_slice_step
    {WorkId(49),    68.2},  // macro_cell_step
    {WorkId(50),   277.4},  // macro_cell_visit
    {WorkId(51),   260.7},  // slice_step
    {WorkId(52),    12.5},  // cell_step
    {WorkId(53),   153.3},  // cell_visit
    {WorkId(54),   387.1},  // triangle_batch
    {WorkId(55),    38.8},  // mailbox_probe
    {WorkId(56),    25.6},  // reach_group
    {WorkId(57),   359.8},  // footprint_group, not in `dense`
    {WorkId(58),    15.0},  // cell_bound_step, not in `dense`
    {WorkId(59),  5255.5},  // walk_pass, of effects
    {WorkId(60),   314.1},  // shaft_group, of effects
});

/// A command: from where core counts it to the next kind of work, and its end in a wait.
inline constexpr double kCommandInstructions = 254.6;
/// A wait: from where core counts it to the next kind of work, without the ends of commands.
inline constexpr double kWaitInstructions = 91.2;
/// A claim: from asking for a tile to the tile's first work.
inline constexpr double kClaimInstructions = 61.8;

}  // namespace gridiron::sim
