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
    {  8673.6,   2071.0,  101.25,  69.250},  // build_once
    {    21.2,     15.0,    0.00,   0.094},  // vertex_check
    {   577.4,    217.9,    1.31,   0.136},  // triangle_survey
    {   905.4,    250.1,    2.65,   0.133},  // cell_box
    {   123.1,     52.9,    0.28,   0.000},  // cell_row
    {   452.1,    167.0,    1.12,   0.000},  // square_test
    {   349.2,     66.5,    0.40,   0.000},  // outline
    {   632.9,    100.6,    3.14,   0.000},  // slab_cut
    {  1178.8,    244.1,    6.23,   0.000},  // polygon_cut
    {  1010.2,    211.1,    7.27,   0.000},  // polygon_row
    {    66.8,     32.8,    0.48,   0.094},  // reference_insert
    {    73.8,     42.1,    0.13,   0.282},  // reference_sort
    {   156.8,    135.0,    1.00,   0.551},  // triangle_write
    {  1419.4,    446.6,    1.09,   0.433},  // projection_setup
    {     8.4,      6.0,    0.01,   0.058},  // cell_sum
    {    98.4,     44.6,    0.73,   0.332},  // macro_word
    {   747.3,    328.1,    4.01,   1.940},  // cleared_line
    {   687.9,    310.2,    4.03,   0.000},  // checked_line
    {   552.3,    130.0,    2.02,   0.141},  // lattice_survey
    {  3529.9,    688.7,    2.22,   0.141},  // lattice_box
    {    75.6,     39.9,    0.11,   0.272},  // lattice_sort
    {  4766.9,    925.0,    2.01,   0.386},  // lattice_write
    {     7.3,      6.0,    0.01,   0.029},  // lattice_cell_sum
    {   484.7,      0.0,    0.00,   1.000},  // far_line
    {   619.7,    203.0,    7.00,  25.000},  // bvh_once
    {    80.3,     20.0,    0.00,   0.094},  // bvh_vertex_check
    {   542.8,    211.7,    1.59,   0.812},  // bvh_triangle_survey
    {   123.9,     46.7,    0.25,   0.086},  // center_bound
    {   360.1,     79.9,    0.71,   0.065},  // bin_update
    {   278.9,     89.3,    2.05,   0.002},  // bin_swept
    {   221.5,     42.6,    0.14,   0.085},  // triangle_moved
    {    40.8,     14.9,    0.17,   0.000},  // triangle_halved
    {   153.8,     48.6,    1.16,   0.082},  // box_bound
    {   511.2,    258.3,    2.75,   0.866},  // node_made
    {   570.3,    278.8,    3.35,   1.421},  // node_merged
    {  4411.8,   1406.2,   34.13,   0.886},  // node_placed
    {  1593.5,    666.2,    3.15,   5.875},  // node_written
    {   432.6,    269.9,    1.00,   2.182},  // bvh_triangle_write
    {   833.1,      0.0,    0.00,   1.000},  // bvh_far_line
});

}  // namespace gridiron::sim
