// What a unit of each kind of work costs on a core of two in-order pipes. Written by gridiron_calibrate from
// counted operations of the kernel itself; do not edit. tools/calibrate/README.md says how, and where each constant
// comes from.
// Memory: constants. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/work_counters.h>

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

/// By kind of work. Commands and waits are charged where they happen, see MachineProfile.
inline constexpr std::array<WorkCost, kWorkKindCount> kWorkCosts = {{
    //  cycles    least     most     even  doubles      odd branches   misses
    {   58.8,    56.4,    87.1,   54.44,    0.00,   18.56,    6.89,    0.11},  // tile_start
    {   35.0,    33.2,    63.4,   30.20,    0.20,   31.91,    0.04,    0.00},  // ray_generated
    {  372.4,   291.2,   435.0,  187.61,    0.00,  123.89,   20.65,    5.75},  // packet_start
    {   58.9,    58.8,    73.9,   58.75,    0.00,   15.12,    0.00,    0.00},  // pass_group
    {  111.0,    90.5,   157.6,   90.49,    0.00,   57.37,    2.49,    0.00},  // pass_square
    {  159.4,    99.2,   167.3,   54.92,    0.00,   27.51,    9.86,    2.46},  // macro_slice_step
    {   75.5,    65.2,    80.0,   49.64,    0.00,    7.63,    4.98,    0.86},  // macro_cell_step
    {  194.5,   134.7,   204.5,   34.90,    0.00,   28.43,   14.77,    5.55},  // macro_cell_visit
    {   99.0,    64.9,   114.9,   48.85,    0.00,   26.63,    7.81,    0.89},  // slice_step
    {   39.9,    28.4,    41.6,   17.12,    0.00,    3.85,    2.13,    0.63},  // cell_step
    {   66.8,    41.8,    78.3,   33.19,    0.00,   19.38,    6.47,    0.48},  // cell_visit
    {  140.3,   109.2,   155.0,   49.27,    0.00,   27.07,   17.41,    3.33},  // triangle_batch
    {   17.4,    11.4,    24.8,   11.13,    0.00,   10.63,    0.11,    0.02},  // mailbox_probe
    {   89.0,    44.2,    99.1,   37.84,    0.00,   19.23,    1.66,    0.35},  // cull_test
    {  202.9,   200.1,   279.9,  200.06,    0.00,   79.81,    0.00,    0.00},  // pixel_box_group
    {  165.0,   138.4,   209.4,  135.90,    0.00,   60.05,    7.22,    0.14},  // triangle_setup
    {   58.6,    39.6,    80.0,   31.99,    0.00,   28.59,    3.67,    0.42},  // subpacket_setup
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
    {   10.7,     8.5,    14.4,    7.96,    0.00,    4.51,    0.25,    0.03},  // reach_group
    {    8.6,    12.9,    15.5,   12.86,    0.00,    2.63,    0.12,    0.00},  // shaded_group
    {   38.6,    41.5,    49.7,   41.46,    0.00,    8.23,    0.05,    0.00},  // shaded_simple_group
    {   26.3,    26.3,    29.3,   26.26,    0.00,    3.01,    0.00,    0.00},  // depth_group
    {   10.3,    10.3,    11.3,   10.26,    0.00,    1.00,    0.00,    0.00},  // id_group
    {   47.8,    43.4,    58.7,   38.71,    0.00,   11.66,    1.51,    0.26},  // footprint_group
    {   48.6,    35.3,    64.5,   28.00,    0.00,   20.26,    1.00,    0.40},  // row_group
    {  122.6,    81.0,   145.6,   72.61,    0.00,   61.93,    2.00,    0.46},  // estimate_setup
    {  111.9,    56.0,   115.8,   56.00,    0.00,    6.07,    1.00,    0.00},  // normal_setup
    {  293.3,   217.1,   318.2,   74.14,   23.00,   30.62,    2.86,    0.28},  // hit_half
    {41187.0, 32341.2, 55569.1, 30018.03,    0.00, 18704.69, 1320.88,  129.06},  // exact_order
    {   19.3,    18.8,    33.0,   17.23,    0.00,   14.20,    0.31,    0.08},  // lattice_triangle
    {   34.3,    26.5,    36.4,   17.93,    0.00,    3.62,    2.02,    0.48},  // cell_bound_step
    {   60.0,    60.0,    60.0,   60.00,    0.00,    0.00,    0.00,    0.00},  // wave_ray
    {   60.0,    60.0,    60.0,   60.00,    0.00,    0.00,    0.00,    0.00},  // queued_ray
    {  300.0,   300.0,   300.0,  300.00,    0.00,    0.00,    0.00,    0.00},  // walk_pass
    {   60.0,    60.0,    60.0,   60.00,    0.00,    0.00,    0.00,    0.00},  // shaft_group
    {  130.0,   130.0,   130.0,  130.00,    0.00,    0.00,    0.00,    0.00},  // ray_group_test
    {  600.0,   600.0,   600.0,  600.00,    0.00,    0.00,    0.00,    0.00},  // ray_distance
    {  500.0,   500.0,   500.0,  500.00,    0.00,    0.00,    0.00,    0.00},  // surface_point
    {  150.0,   150.0,   150.0,  150.00,    0.00,    0.00,    0.00,    0.00},  // smooth_normal
    {   60.0,    60.0,    60.0,   60.00,    0.00,    0.00,    0.00,    0.00},  // shadow_ray
    {  120.0,   120.0,   120.0,  120.00,    0.00,    0.00,    0.00,    0.00},  // light_sample
    {  150.0,   150.0,   150.0,  150.00,    0.00,    0.00,    0.00,    0.00},  // highlight
    {  200.0,   200.0,   200.0,  200.00,    0.00,    0.00,    0.00,    0.00},  // occlusion_ray
    {   80.0,    80.0,    80.0,   80.00,    0.00,    0.00,    0.00,    0.00},  // mirror_ray
    {  120.0,   120.0,   120.0,  120.00,    0.00,    0.00,    0.00,    0.00},  // refracted_ray
    {  100.0,   100.0,   100.0,  100.00,    0.00,    0.00,    0.00,    0.00},  // environment_lookup
    {   20.0,    20.0,    20.0,   20.00,    0.00,    0.00,    0.00,    0.00},  // color_added
    {   20.0,    20.0,    20.0,   20.00,    0.00,    0.00,    0.00,    0.00},  // color_group
    {      0,       0,       0,       0,       0,       0,       0,       0},  // get_issue
    {      0,       0,       0,       0,       0,       0,       0,       0},  // put_issue
    {      0,       0,       0,       0,       0,       0,       0,       0},  // wait
}};

}  // namespace gridiron::sim
