// What a unit of each kind of work costs on a core of two in-order pipes. Written by gridiron_calibrate from
// counted operations of the kernel itself; do not edit. tools/calibrate/README.md says how, and where each constant
// comes from.
// Memory: constants. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/sim/engine_work.h>

#include <array>

namespace gridiron::sim {

/// Means over the units of the counted frames.
struct WorkCost {
  double cycles;        ///< charged: superblock schedule, branch misses included
  double least_cycles;  ///< the fuller pipe never idle; too much where these operations fill the gaps of a neighbour
  double most_cycles;   ///< bound: nothing issued together
  double even;          ///< operations of the even pipe, and of these:
  double doubles;       ///< in double precision
  double odd;           ///< operations of the odd pipe, and of these:
  double branches;
  double misses;        ///< branches that go the rarer way
};

/// By kind of work of core and of the grid. Commands and waits are charged where they happen, see MachineProfile.
inline constexpr std::array<WorkCost, kGridEngine.kind_count()> kWorkCosts = {{
    //  cycles    least     most     even  doubles      odd branches   misses
    {  124.2,    67.8,   142.6,   63.81,    0.00,   25.69,    9.89,    0.22},  // tile_start
    {   36.6,    34.4,    65.7,   31.36,    0.20,   32.40,    0.19,    0.04},  // ray_generated
    {   89.0,    44.2,    99.1,   37.84,    0.00,   19.23,    1.66,    0.35},  // cull_test
    {  202.9,   200.1,   279.9,  200.06,    0.00,   79.81,    0.00,    0.00},  // pixel_box_group
    {  164.9,   138.4,   209.3,  135.90,    0.00,   60.03,    7.22,    0.14},  // triangle_setup
    {   58.6,    39.6,    79.9,   31.99,    0.00,   28.59,    3.67,    0.42},  // subpacket_setup
    {   64.4,    54.3,    82.7,   43.57,    0.00,   18.65,    1.70,    0.59},  // subpacket_group
    {   53.1,    39.6,    58.4,   34.28,    0.00,    8.18,    3.80,    0.29},  // group_test_standard
    {   99.6,    43.9,   108.6,   43.21,    0.00,   20.12,    3.04,    0.04},  // group_test_paper
    {  116.5,    80.3,   131.0,   47.77,    0.00,   21.49,    6.57,    1.81},  // hit_group
    {  227.8,   206.6,   272.2,  200.86,    0.00,   50.21,    6.73,    0.32},  // hit_subpacket
    {   67.7,    43.7,    76.9,   24.10,    0.00,   22.83,    8.10,    1.09},  // hit_group_paper
    {  562.7,   563.4,   568.7,   97.62,   76.00,    3.68,    1.54,    0.54},  // hit_setup
    {  513.4,   510.3,   539.4,  127.87,   61.05,   27.51,    3.10,    0.90},  // double_sign
    { 2970.4,  2281.1,  3833.0, 2237.48,    0.00, 1211.62,   55.00,    2.42},  // exact_sign
    {42313.5, 21784.5, 49474.2, 17219.05,    0.00, 19288.69, 4070.06,  138.66},  // exact_distance
    {    3.0,     3.0,     4.9,    3.00,    0.00,    1.94,    0.00,    0.00},  // shaded_group
    {   31.5,    33.7,    42.4,   33.68,    0.00,    8.68,    0.00,    0.00},  // shaded_simple_group
    {   17.0,    17.5,    23.5,   17.50,    0.00,    6.00,    0.00,    0.00},  // depth_group
    {    2.0,     2.0,     3.4,    1.44,    0.00,    1.97,    0.06,    0.00},  // id_group
    {   48.6,    35.3,    64.5,   28.00,    0.00,   20.26,    1.00,    0.40},  // row_group
    {  122.6,    81.0,   145.6,   72.61,    0.00,   61.93,    2.00,    0.46},  // estimate_setup
    {  112.0,    56.0,   115.9,   56.00,    0.00,    6.07,    1.00,    0.00},  // normal_setup
    {  293.3,   217.1,   318.2,   74.14,   23.00,   30.62,    2.86,    0.28},  // hit_half
    {41187.0, 32341.2, 55569.1, 30018.03,    0.00, 18704.69, 1320.88,  129.06},  // exact_order
    {   19.3,    18.8,    33.0,   17.23,    0.00,   14.20,    0.31,    0.08},  // lattice_triangle
    {  122.4,    99.6,   141.4,   32.15,    0.00,   53.18,    7.41,    2.58},  // wave_ray
    {   86.0,    92.1,    96.1,    3.22,    0.00,   92.08,    1.01,    0.00},  // queued_ray
    {   62.7,    58.6,    66.6,   58.61,    0.00,    8.00,    0.00,    0.00},  // ray_triangle_setup
    {  174.8,   166.6,   212.5,  144.35,    0.00,   41.97,    6.02,    1.24},  // ray_group_test
    {  794.7,   776.0,   822.2,  173.03,   99.00,   37.06,    5.36,    0.50},  // ray_distance
    {  874.6,   645.7,   977.8,  582.77,    0.00,  183.52,   18.33,    3.49},  // surface_point
    {  332.0,   151.4,   361.3,  124.13,    0.00,   58.47,    6.66,    1.51},  // smooth_normal
    {  230.9,   122.7,   250.3,  100.14,    0.00,   53.67,    4.97,    1.25},  // shadow_ray
    {  110.5,    59.7,   124.3,   55.04,    0.00,   14.41,    2.00,    0.26},  // light_sample
    {  311.6,   111.7,   318.9,  111.74,    0.00,    8.01,    0.00,    0.00},  // highlight
    {  254.6,   216.9,   302.7,  210.27,    0.00,   54.27,    2.29,    0.37},  // occlusion_ray
    {   36.2,    25.1,    45.3,   25.10,    0.00,    4.32,    1.00,    0.00},  // mirror_ray
    {  193.4,    90.9,   207.6,   89.31,    0.00,   10.35,    2.17,    0.09},  // refracted_ray
    {  610.0,   440.5,   647.0,  409.11,    0.00,   54.83,    5.06,    1.75},  // environment_lookup
    {   40.2,    36.5,    54.8,   36.47,    0.00,   16.42,    0.00,    0.00},  // color_added
    {  123.2,   120.2,   148.3,  120.23,    0.00,   28.06,    0.01,    0.00},  // color_group
    {      0,       0,       0,       0,       0,       0,       0,       0},  // get_issue
    {      0,       0,       0,       0,       0,       0,       0,       0},  // put_issue
    {      0,       0,       0,       0,       0,       0,       0,       0},  // wait
    {  301.4,   236.3,   357.3,  153.65,    0.00,  108.71,   14.84,    4.59},  // packet_start
    {   58.9,    58.8,    73.9,   58.75,    0.00,   15.12,    0.00,    0.00},  // pass_group
    {  115.8,    90.5,   160.6,   90.49,    0.00,   57.37,    2.49,    0.00},  // pass_square
    {  159.4,    99.2,   167.2,   54.92,    0.00,   27.51,    9.86,    2.46},  // macro_slice_step
    {   75.7,    65.2,    80.1,   49.64,    0.00,    7.63,    4.98,    0.86},  // macro_cell_step
    {  192.7,   134.7,   203.1,   34.90,    0.00,   28.43,   14.77,    5.55},  // macro_cell_visit
    {   99.0,    64.9,   114.9,   48.85,    0.00,   26.63,    7.81,    0.89},  // slice_step
    {   39.9,    28.4,    41.6,   17.12,    0.00,    3.85,    2.13,    0.63},  // cell_step
    {   63.2,    41.8,    74.3,   33.19,    0.00,   17.46,    6.47,    0.48},  // cell_visit
    {  144.2,   109.2,   158.1,   49.27,    0.00,   27.52,   17.41,    3.33},  // triangle_batch
    {   17.3,    11.4,    24.7,   11.13,    0.00,   10.63,    0.11,    0.02},  // mailbox_probe
    {   10.7,     8.5,    14.4,    7.96,    0.00,    4.54,    0.25,    0.03},  // reach_group
    {   47.8,    43.4,    58.7,   38.71,    0.00,   11.66,    1.51,    0.26},  // footprint_group
    {   34.3,    26.5,    36.4,   17.93,    0.00,    3.62,    2.02,    0.48},  // cell_bound_step
    {  924.9,   707.1,  1184.0,  582.56,    0.00,  362.35,   43.21,    6.92},  // walk_pass
    {   56.4,    54.3,    68.1,   51.91,    0.00,   12.50,    0.49,    0.13},  // shaft_group
}};
static_assert(kWorkCosts.back().cycles > 0, "a kind of work lacks its row");

}  // namespace gridiron::sim
