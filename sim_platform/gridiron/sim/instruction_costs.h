// What a unit of each kind of work takes in instructions of a riscv64 core, 4 lanes. Written by
// tools/calibrate/second_opinion/run from the kernel in an emulator; do not edit. tools/calibrate/README.md.
// Of the frame `dense`; kinds that it has none of, of the others.
// Memory: constants. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/work_counters.h>

#include <array>

namespace gridiron::sim {

/// A kind of work that the counted frames have units of.
struct InstructionCost {
  Work kind;
  double instructions;
};

inline constexpr auto kInstructionCosts = std::to_array<InstructionCost>({
    {Work{ 0},    67.4},  // tile_start
    {Work{ 1},   264.0},  // ray_generated
    {Work{ 2},  1114.6},  // packet_start
    {Work{ 3},   412.4},  // pass_group, not in `dense`
    {Work{ 4},   408.9},  // pass_square
    {Work{ 5},   238.8},  // macro_slice_step
    {Work{ 6},    67.8},  // macro_cell_step
    {Work{ 7},   275.9},  // macro_cell_visit
    {Work{ 8},   273.1},  // slice_step
    {Work{ 9},    16.2},  // cell_step
    {Work{10},   154.3},  // cell_visit
    {Work{11},   346.1},  // triangle_batch
    {Work{12},    37.9},  // mailbox_probe
    {Work{13},   353.6},  // cull_test
    {Work{14},  1562.4},  // pixel_box_group, not in `dense`
    {Work{15},   798.0},  // triangle_setup
    {Work{16},   315.9},  // subpacket_setup, not in `dense`
    {Work{17},   403.6},  // subpacket_group, not in `dense`
    {Work{18},   313.1},  // group_test_standard
    {Work{19},   406.2},  // group_test_paper, not in `dense`
    {Work{20},   367.1},  // hit_group
    {Work{21},  1122.8},  // hit_subpacket, not in `dense`
    {Work{22},   182.6},  // hit_group_paper, not in `dense`
    {Work{23},   255.6},  // hit_setup
    {Work{24},   178.3},  // double_sign
    {Work{27},    25.7},  // reach_group
    {Work{28},    38.7},  // shaded_group, not in `dense`
    {Work{29},   163.5},  // shaded_simple_group
    {Work{30},   107.1},  // depth_group, not in `dense`
    {Work{31},    18.9},  // id_group, not in `dense`
    {Work{32},   374.6},  // footprint_group, not in `dense`
    {Work{33},   297.0},  // row_group, not in `dense`
    {Work{34},   356.1},  // estimate_setup
    {Work{35},   230.0},  // normal_setup
    {Work{36},   351.4},  // hit_half
    {Work{38},   132.1},  // lattice_triangle, not in `dense`
    {Work{39},    20.4},  // cell_bound_step, not in `dense`
});

}  // namespace gridiron::sim
