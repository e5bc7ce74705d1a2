// What a unit of each step of a build takes on the general core, in cycles of its clock. Written by
// tools/calibrate/general_core/run from the builders' own code in an emulator, through a model of the core and its
// caches; do not edit: tools/calibrate/README.md.
// Memory: constants. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

namespace gridiron::sim {

/// Per unit.
struct BuildCost {
  double cycles;         ///< charged
  double instructions;   ///< of riscv64
  double branch_misses;  ///< branches that were not guessed
  double lines;          ///< lines from memory, asked for or fetched ahead
};

/// By BuildStep.
inline constexpr auto kBuildCosts = std::to_array<BuildCost>({
    {  8060.6,   2071.0,  110.62,  63.500},  // build_once
    {    21.3,     15.0,    0.00,   0.095},  // vertex_check
    {   577.4,    217.9,    1.31,   0.136},  // triangle_survey
    {   905.4,    250.1,    2.65,   0.133},  // cell_box
    {   123.1,     52.9,    0.28,   0.000},  // cell_row
    {   451.4,    167.0,    1.09,   0.000},  // square_test
    {   349.2,     66.5,    0.40,   0.000},  // outline
    {   632.9,    100.6,    3.14,   0.000},  // slab_cut
    {  1178.8,    244.1,    6.23,   0.000},  // polygon_cut
    {  1010.7,    211.1,    7.29,   0.000},  // polygon_row
    {    66.8,     32.8,    0.48,   0.094},  // reference_insert
    {    73.8,     42.1,    0.13,   0.282},  // reference_sort
    {   156.8,    135.0,    1.00,   0.551},  // triangle_write
    {  1419.4,    446.6,    1.09,   0.434},  // projection_setup
    {     8.4,      6.0,    0.01,   0.058},  // cell_sum
    {    85.6,     44.6,    0.69,   0.164},  // macro_word
    {   747.5,    328.1,    4.01,   1.940},  // cleared_line
    {   688.0,    310.2,    4.03,   0.000},  // checked_line
    {   552.3,    130.0,    2.02,   0.141},  // lattice_survey
    {  3529.9,    688.7,    2.22,   0.141},  // lattice_box
    {    75.6,     39.9,    0.11,   0.272},  // lattice_sort
    {  4766.9,    925.0,    2.01,   0.386},  // lattice_write
    {     7.3,      6.0,    0.01,   0.029},  // lattice_cell_sum
    {   484.8,      0.0,    0.00,   1.000},  // far_line
    {   350.8,    218.0,   11.00,  25.000},  // bvh_once
    {    80.3,     20.0,    0.00,   0.094},  // bvh_vertex_check
    {   538.9,    211.3,    1.59,   0.871},  // bvh_triangle_survey
    {   307.0,     72.2,    1.29,   0.084},  // bin_update
    {   270.5,     99.8,    2.17,   0.003},  // bin_swept
    {   249.7,     65.4,    0.40,   0.083},  // triangle_moved
    {    40.5,     14.8,    0.17,   0.001},  // triangle_halved
    {   274.4,     93.1,    1.07,   0.215},  // box_bound
    {   755.5,    309.9,    2.40,   0.906},  // node_made
    {   613.4,    279.3,    3.35,   1.426},  // node_merged
    {  4452.5,   1402.2,   34.57,   0.911},  // node_placed
    {  1694.7,    661.9,    2.96,   5.888},  // node_written
    {   452.4,    269.2,    1.00,   2.184},  // bvh_triangle_write
    {   858.6,      0.0,    0.00,   1.000},  // bvh_far_line
});

}  // namespace gridiron::sim
