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
    {  8565.2,   3042.9,  143.89,  80.444},  // build_once
    {    21.3,     15.0,    0.00,   0.095},  // vertex_check
    {   607.0,    226.9,    1.30,   0.136},  // triangle_survey
    {   905.8,    250.1,    2.66,   0.133},  // cell_box
    {   121.6,     52.7,    0.29,   0.000},  // cell_row
    {   452.5,    167.2,    1.12,   0.000},  // square_test
    {   346.9,     66.5,    0.36,   0.000},  // outline
    {   631.5,    100.6,    3.09,   0.000},  // slab_cut
    {  1169.2,    244.1,    5.81,   0.000},  // polygon_cut
    {  1006.6,    211.1,    7.11,   0.000},  // polygon_row
    {    66.8,     32.8,    0.48,   0.094},  // reference_insert
    {    74.2,     42.1,    0.13,   0.282},  // reference_sort
    {   157.1,    134.0,    1.00,   0.548},  // triangle_write
    {  1424.2,    447.6,    1.07,   0.433},  // projection_setup
    {     8.4,      6.0,    0.01,   0.058},  // cell_sum
    {    93.5,     44.6,    0.64,   0.131},  // macro_word
    {   665.8,    352.0,    0.05,   1.940},  // cleared_line
    {   606.6,    334.1,    0.06,   0.000},  // checked_line
    {   552.3,    130.0,    2.02,   0.141},  // lattice_survey
    {  3545.4,    698.7,    2.26,   0.141},  // lattice_box
    {    75.7,     39.9,    0.11,   0.272},  // lattice_sort
    {  4763.2,    926.0,    2.01,   0.387},  // lattice_write
    {     7.3,      6.0,    0.01,   0.029},  // lattice_cell_sum
    {  2765.4,    266.2,   18.80,  11.400},  // tree_once
    {   182.3,     66.0,    0.00,   0.094},  // tree_vertex_bound
    {   269.0,     68.0,    0.00,   0.141},  // tree_triangle_survey
    {   877.5,    312.0,    0.00,   0.201},  // tree_triangle_code
    {    12.1,      6.6,    0.00,   0.047},  // tree_digit_value
    {    48.7,     20.6,    0.00,   0.026},  // tree_key_sorted
    {    48.1,     21.1,    0.00,   0.519},  // tree_key_scattered
    {   504.4,    181.4,    3.69,   1.237},  // tree_leaf_split
    { 18779.5,   5676.8,  152.19,  22.901},  // tree_node_split
    {   853.7,    438.7,    3.00,   0.122},  // tree_crowd
    {  1357.3,    429.6,    0.37,   0.348},  // tree_crowd_key
    {   321.8,     89.0,    0.03,   0.006},  // tree_triangle_write
    {   255.5,     30.6,    0.18,   0.000},  // tree_triangle_area
    {  5894.2,   2178.5,   25.41,  33.207},  // tree_node_write
    {  2206.4,    558.0,    7.35,   0.037},  // tree_node_order
    {    70.9,     16.5,    0.01,   0.992},  // tree_checked_line
    {   483.3,      0.0,    0.00,   1.000},  // far_line
    {   414.6,      0.0,    0.00,   1.000},  // tree_survey_far_line
    {   116.8,      0.0,    0.00,   1.000},  // tree_far_line
    {   497.5,    218.0,   11.00,  24.000},  // bvh_once
    {    80.3,     20.0,    0.00,   0.094},  // bvh_vertex_check
    {   538.9,    211.3,    1.59,   0.870},  // bvh_triangle_survey
    {   307.0,     72.2,    1.30,   0.084},  // bin_update
    {   270.5,     99.8,    2.12,   0.002},  // bin_swept
    {   249.7,     65.4,    0.40,   0.083},  // triangle_moved
    {    40.5,     14.8,    0.17,   0.000},  // triangle_halved
    {   274.4,     93.1,    1.07,   0.215},  // box_bound
    {   780.8,    309.9,    3.45,   0.903},  // node_made
    {   616.7,    279.3,    3.37,   1.425},  // node_merged
    {  4440.8,   1402.2,   34.33,   0.906},  // node_placed
    {  1696.6,    661.9,    2.98,   5.847},  // node_written
    {   452.3,    269.2,    1.00,   2.183},  // bvh_triangle_write
    {   858.0,      0.0,    0.00,   1.000},  // bvh_far_line
});

}  // namespace gridiron::sim
