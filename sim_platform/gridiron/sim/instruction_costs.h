// What a unit of each kind of work takes in instructions of a riscv64 core, 4 lanes. Written by
// tools/calibrate/second_opinion/run from the kernel in an emulator; do not edit. tools/calibrate/README.md.
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
    {Work{ 1},   252.7},  // ray_generated
    {Work{ 2},  1609.7},  // packet_start
    {Work{ 3},   412.4},  // pass_group
    {Work{ 4},   410.9},  // pass_square
    {Work{ 5},   253.7},  // macro_slice_step
    {Work{ 6},    79.4},  // macro_cell_step
    {Work{ 7},   280.0},  // macro_cell_visit
    {Work{ 8},   271.3},  // slice_step
    {Work{ 9},    16.1},  // cell_step
    {Work{10},   145.3},  // cell_visit
    {Work{11},   291.2},  // triangle_batch
    {Work{12},    32.5},  // mailbox_probe
    {Work{13},   394.5},  // cull_test
    {Work{14},  1562.4},  // pixel_box_group
    {Work{15},   994.9},  // triangle_setup
    {Work{16},   315.9},  // subpacket_setup
    {Work{17},   403.6},  // subpacket_group
    {Work{18},   333.7},  // group_test_standard
    {Work{19},   406.2},  // group_test_paper
    {Work{20},   395.1},  // hit_group
    {Work{21},  1122.8},  // hit_subpacket
    {Work{22},   182.6},  // hit_group_paper
    {Work{23},   260.2},  // hit_setup
    {Work{24},   179.5},  // double_sign
    {Work{27},    55.3},  // reach_group
    {Work{28},    38.7},  // shaded_group
    {Work{29},   169.0},  // shaded_simple_group
    {Work{30},   107.1},  // depth_group
    {Work{31},    18.9},  // id_group
    {Work{32},   374.6},  // footprint_group
    {Work{33},   297.0},  // row_group
    {Work{34},   357.9},  // estimate_setup
    {Work{35},   227.3},  // normal_setup
    {Work{36},   312.6},  // hit_half
    {Work{38},   132.1},  // lattice_triangle
    {Work{39},    20.4},  // cell_bound_step
});

}  // namespace gridiron::sim
