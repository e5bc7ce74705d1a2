// What a unit of each kind of work takes in instructions of a riscv64 core, 4 lanes, and what commands,
// waits and claims take on the port of platform/sifive_u. Written by tools/calibrate/second_opinion/run from
// the kernel in an emulator; do not edit: tools/calibrate/README.md. Of the frame `dense`; kinds that it has
// none of, of the others.
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
    {WorkId( 1),   464.6},  // ray_packet
    {WorkId( 2),   337.6},  // pixel_projection, not in `dense`
    {WorkId( 3),   232.0},  // ray_generated
    {WorkId( 4),    19.2},  // ray_set_word
    {WorkId( 5),     3.5},  // recent_slot
    {WorkId( 6),   358.6},  // cull_test
    {WorkId( 7),  1613.4},  // pixel_box_group, not in `dense`
    {WorkId( 8),   160.8},  // open_triangle, not in `dense`
    {WorkId( 9),    14.1},  // listed_triangle
    {WorkId(10),   595.5},  // triangle_setup
    {WorkId(11),   330.5},  // slope_setup, not in `dense`
    {WorkId(12),   337.1},  // subpacket_setup, not in `dense`
    {WorkId(13),   391.7},  // subpacket_group, not in `dense`
    {WorkId(14),   227.0},  // triangle_test
    {WorkId(15),    70.3},  // subpacket_pick, not in `dense`
    {WorkId(16),   108.5},  // subpacket_visit
    {WorkId(17),   287.7},  // group_test_standard
    {WorkId(18),    11.7},  // group_skip, not in `dense`
    {WorkId(19),   197.2},  // inside_test
    {WorkId(20),    83.1},  // row_visit, not in `dense`
    {WorkId(21),   284.3},  // row_test, not in `dense`
    {WorkId(22),    11.0},  // row_skip, not in `dense`
    {WorkId(23),   211.2},  // row_inside_test, not in `dense`
    {WorkId(24),   528.8},  // cull_test_paper, not in `dense`
    {WorkId(25),   405.0},  // group_test_paper, not in `dense`
    {WorkId(26),   211.4},  // hit_group
    {WorkId(27),   159.2},  // open_hit_group
    {WorkId(28),    95.5},  // settled_group
    {WorkId(29),   609.0},  // hit_subpacket, not in `dense`
    {WorkId(30),   123.0},  // taken_subpacket, not in `dense`
    {WorkId(31),    95.6},  // facing_group
    {WorkId(32),   180.5},  // hit_group_paper, not in `dense`
    {WorkId(33),   287.6},  // hit_setup
    {WorkId(34),   181.2},  // double_sign
    {WorkId(35),  2430.8},  // exact_sign, of 64 decisions
    {WorkId(36), 66091.2},  // exact_distance, of 64 decisions
    {WorkId(37),    26.2},  // shaded_group, not in `dense`
    {WorkId(38),   178.3},  // shaded_simple_group
    {WorkId(39),   107.3},  // depth_group, not in `dense`
    {WorkId(40),    18.0},  // id_group
    {WorkId(41),   300.0},  // row_group, not in `dense`
    {WorkId(42),   356.1},  // estimate_setup
    {WorkId(43),   229.0},  // normal_setup
    {WorkId(44),   351.4},  // hit_half
    {WorkId(45), 27547.3},  // exact_order, of 64 decisions
    {WorkId(46),    95.6},  // lattice_triangle, not in `dense`
    {WorkId(47),   161.6},  // wave_ray, of effects
    {WorkId(48),    92.1},  // queued_ray, of effects
    {WorkId(49),   189.8},  // list_ray, of effects
    {WorkId(50),  5246.8},  // list_beam, of effects
    {WorkId(51),  1728.6},  // list_beam_node, of effects
    {WorkId(52),   310.5},  // list_child, of effects
    {WorkId(53),    39.9},  // list_entry, of effects
    {WorkId(54),  1330.3},  // list_node, of effects
    {WorkId(55),   153.4},  // list_run, of effects
    {WorkId(56),   454.9},  // list_ray_node, of effects
    {WorkId(57),   457.7},  // list_box_quad, of effects
    {WorkId(58),   391.3},  // list_shared_box, of effects
    {WorkId(59),  2190.2},  // list_leaf, of effects
    {WorkId(60),   941.5},  // list_triangle_group, of effects
    {WorkId(61),  3062.0},  // list_shared_leaf, of effects
    {WorkId(62),   611.5},  // list_shared_group, of effects
    {WorkId(63),   285.9},  // list_candidate, of effects
    {WorkId(64),   326.4},  // ray_distance, of effects
    {WorkId(65),  1412.9},  // surface_point, of effects
    {WorkId(66),   325.7},  // smooth_normal, of effects
    {WorkId(67),    47.0},  // jitter_seed, of effects
    {WorkId(68),   123.1},  // shadow_ray, of effects
    {WorkId(69),    86.7},  // area_place, of effects
    {WorkId(70),    67.0},  // light_sample, of effects
    {WorkId(71),   151.2},  // highlight, of effects
    {WorkId(72),   184.5},  // occlusion_ray, of effects
    {WorkId(73),   159.9},  // mirror_ray, of effects
    {WorkId(74),   159.4},  // refracted_ray, of effects
    {WorkId(75),   386.3},  // environment_lookup, of effects
    {WorkId(76),    70.4},  // color_added, of effects
    {WorkId(77),   193.1},  // color_group, of effects
    {WorkId(78),   120.2},  // vertex_color, of effects
    {WorkId(79),    27.8},  // srgb_level, of effects
    {WorkId(83),   387.8},  // packet_start
    {WorkId(84),    23.0},  // pass_slope
    {WorkId(85),    15.7},  // mailbox_group
    {WorkId(86),   422.6},  // pass_group, not in `dense`
    {WorkId(87),   407.9},  // pass_square
    {WorkId(88),   239.0},  // macro_slice_step
    {WorkId(89),    13.9},  // macro_row
    {WorkId(90),    28.8},  // macro_cell_step
    {WorkId(91),   337.7},  // macro_cell_visit
    {WorkId(92),   241.4},  // slice_step
    {WorkId(93),    23.7},  // cell_row
    {WorkId(94),     7.9},  // cell_step
    {WorkId(95),    22.0},  // cell_visit
    {WorkId(96),   368.9},  // triangle_batch
    {WorkId(97),    39.2},  // mailbox_probe
    {WorkId(98),    25.6},  // reach_group
    {WorkId(99),   121.8},  // reach_test, not in `dense`
    {WorkId(100),   357.5},  // footprint_group, not in `dense`
    {WorkId(101),    10.6},  // cell_bound_step, not in `dense`
});

/// A command: from where core counts it to the next kind of work, and its end in a wait.
inline constexpr double kCommandInstructions = 254.4;
/// A wait: from where core counts it to the next kind of work, without the ends of commands.
inline constexpr double kWaitInstructions = 91.2;
/// A claim: from asking for a tile to the tile's first work.
inline constexpr double kClaimInstructions = 68.4;

}  // namespace gridiron::sim
