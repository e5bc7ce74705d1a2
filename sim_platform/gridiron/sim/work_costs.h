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
    {  114.0,    57.3,   132.7,   53.07,    0.00,   25.74,    9.89,    0.24},  // tile_start
    {  183.5,   178.8,   289.4,  178.83,    0.00,  110.54,    1.00,    0.00},  // ray_packet
    {  770.7,   784.0,   872.0,  160.00,  104.00,   88.00,    1.00,    0.00},  // pixel_projection
    {   24.8,    24.8,    46.8,   24.44,    0.00,   21.95,    0.08,    0.02},  // ray_generated
    {    6.4,     5.8,     7.9,    2.23,    0.00,    1.95,    0.71,    0.20},  // ray_set_word
    {    2.1,     4.1,     4.1,    0.00,    0.00,    4.09,    0.00,    0.00},  // recent_slot
    {   68.5,    47.6,    81.8,   39.33,    0.00,   18.36,    3.00,    0.46},  // cull_test
    {  203.5,   202.4,   283.4,  201.73,    0.00,   80.82,    0.71,    0.04},  // pixel_box_group
    {   39.0,    39.7,    44.3,   38.68,    0.00,    4.59,    0.63,    0.06},  // open_triangle
    {    4.2,     4.3,     4.6,    2.56,    0.00,    0.29,    0.28,    0.09},  // listed_triangle
    {   90.9,    69.6,   117.5,   69.10,    0.07,   38.42,    4.00,    0.00},  // triangle_setup
    {   53.4,    36.0,    66.6,   36.00,    0.00,   24.00,    3.00,    0.00},  // slope_setup
    {   90.9,    66.3,   113.1,   34.95,    0.00,   30.24,    4.33,    1.74},  // subpacket_setup
    {   64.2,    53.9,    82.7,   42.18,    0.00,   18.68,    1.65,    0.65},  // subpacket_group
    {   25.9,    23.1,    40.0,   22.98,    0.00,   15.30,    2.52,    0.01},  // triangle_test
    {   51.8,    35.2,    56.0,   25.45,    0.00,    8.97,    2.96,    0.54},  // subpacket_pick
    {   22.4,    20.7,    29.1,   20.02,    0.00,    7.39,    6.50,    0.04},  // subpacket_visit
    {   38.6,    26.9,    42.0,   26.93,    0.00,    5.93,    1.93,    0.00},  // group_test_standard
    {   19.0,    19.0,    19.0,    1.00,    0.00,    0.00,    0.00,    1.00},  // group_skip
    {   58.3,    45.6,    58.8,    9.36,    0.00,    4.14,    3.05,    2.01},  // inside_test
    {   52.3,    41.0,    58.1,   41.00,    0.00,    6.88,    4.00,    0.00},  // row_visit
    {   71.8,    58.6,    75.7,   29.31,    0.00,    5.31,    1.31,    1.63},  // row_test
    {    0.9,     1.0,     1.0,    1.00,    0.00,    0.00,    0.00,    0.00},  // row_skip
    {   18.5,     9.9,    20.0,    9.41,    0.00,    4.16,    3.05,    0.02},  // row_inside_test
    {  166.1,    77.9,   178.0,   53.85,    0.00,   34.09,    7.20,    1.34},  // cull_test_paper
    {  100.2,    43.5,   109.3,   43.21,    0.00,   20.12,    3.04,    0.01},  // group_test_paper
    {   49.2,    24.3,    57.6,   24.12,    0.00,   12.41,    2.48,    0.01},  // hit_group
    {   80.5,    63.8,    83.8,   12.24,    0.00,    8.21,    4.81,    2.86},  // open_hit_group
    {   48.3,    46.2,    51.3,    5.19,    0.00,    4.28,    3.28,    2.28},  // settled_group
    {   75.4,    70.0,    94.9,   70.00,    0.00,   19.15,    1.00,    0.00},  // hit_subpacket
    {   44.4,    41.0,    56.4,   41.00,    0.00,   15.05,    2.00,    0.00},  // taken_subpacket
    {   16.3,    11.2,    19.1,   11.20,    0.00,    3.54,    0.87,    0.00},  // facing_group
    {   85.7,    61.7,    94.9,   24.10,    0.00,   22.83,    8.10,    2.09},  // hit_group_paper
    {  562.2,   563.1,   568.3,   97.58,   76.00,    3.66,    1.53,    0.53},  // hit_setup
    {  532.9,   529.2,   558.6,  127.26,   61.08,   27.24,    2.99,    1.97},  // double_sign
    { 2961.1,  2271.8,  3823.8, 2237.48,    0.00, 1211.62,   55.00,    1.91},  // exact_sign
    {42322.8, 21793.8, 49483.5, 17219.05,    0.00, 19288.69, 4070.06,  139.17},  // exact_distance
    {    3.1,     3.1,     5.0,    3.00,    0.00,    1.94,    0.00,    0.00},  // shaded_group
    {   30.9,    33.7,    42.6,   33.72,    0.00,    8.87,    0.00,    0.00},  // shaded_simple_group
    {   17.1,    17.6,    23.6,   17.50,    0.00,    6.00,    0.00,    0.00},  // depth_group
    {    2.2,     2.2,     3.6,    1.49,    0.00,    2.01,    0.06,    0.01},  // id_group
    {   54.7,    46.0,    71.7,   28.00,    0.00,   20.12,    1.00,    1.00},  // row_group
    {  140.4,    98.0,   162.7,   72.82,    0.00,   61.77,    2.00,    1.40},  // estimate_setup
    {  129.7,    74.0,   133.7,   56.00,    0.00,    6.06,    1.00,    1.00},  // normal_setup
    {  306.7,   231.4,   331.9,   74.13,   23.00,   30.61,    2.86,    1.07},  // hit_half
    {41187.0, 32341.2, 55569.1, 30018.03,    0.00, 18704.69, 1320.88,  129.06},  // exact_order
    {   16.2,    17.3,    29.8,   16.09,    0.00,   12.53,    0.12,    0.07},  // lattice_triangle
    {  113.8,    92.8,   133.6,   33.43,    0.00,   56.56,    8.26,    2.01},  // wave_ray
    {   83.2,    91.7,    95.2,    3.25,    0.00,   91.32,    1.09,    0.02},  // queued_ray
    {   54.0,    44.1,    71.9,   44.08,    0.00,   20.50,    1.01,    0.00},  // list_ray
    {  292.0,   193.5,   340.5,  152.77,    0.00,   81.47,   15.38,    2.26},  // list_child
    {    5.0,     3.8,     7.0,    3.30,    0.00,    2.67,    0.00,    0.03},  // list_entry
    {  364.1,   294.5,   422.0,  212.60,    0.00,   92.30,   13.47,    4.55},  // list_node
    {   82.7,    56.1,    98.7,   52.71,    0.00,   24.13,    1.16,    0.19},  // list_ray_node
    {   76.2,    55.0,    86.8,   51.07,    0.00,   16.75,    1.20,    0.22},  // list_box_quad
    {  296.1,   235.5,   366.2,  190.29,    0.00,  106.14,   10.50,    2.51},  // list_leaf
    {   95.9,    76.9,   107.7,   70.99,    0.00,   16.97,    2.00,    0.33},  // list_triangle_group
    {   57.7,    47.2,    64.0,   15.00,    0.00,   10.94,    5.30,    1.79},  // list_candidate
    {  767.1,   745.6,   790.8,  151.84,   98.85,   32.50,    2.00,    0.04},  // ray_distance
    {  870.3,   644.7,   981.3,  583.93,    0.00,  188.03,   18.45,    3.37},  // surface_point
    {  322.4,   152.0,   355.7,  124.74,    0.00,   58.23,    6.66,    1.51},  // smooth_normal
    {  267.4,   145.5,   296.9,  117.29,    0.00,   53.49,    5.24,    1.57},  // shadow_ray
    {  105.3,    59.7,   117.9,   55.04,    0.00,   13.11,    2.00,    0.26},  // light_sample
    {  295.4,   111.7,   303.3,  111.74,    0.00,    9.00,    0.00,    0.00},  // highlight
    {  261.4,   231.2,   311.7,  224.41,    0.00,   54.18,    2.39,    0.38},  // occlusion_ray
    {   43.0,    41.8,    55.9,   41.52,    0.00,    4.69,    1.00,    0.01},  // mirror_ray
    {  213.3,   128.8,   230.9,  109.22,    0.00,   11.62,    2.17,    1.09},  // refracted_ray
    {  615.3,   413.8,   651.2,  346.42,    0.00,   55.48,    5.06,    3.75},  // environment_lookup
    {   41.8,    37.8,    56.4,   35.96,    0.00,   16.64,    0.16,    0.10},  // color_added
    {  123.2,   120.2,   148.3,  120.23,    0.00,   28.08,    0.01,    0.00},  // color_group
    {      0,       0,       0,       0,       0,       0,       0,       0},  // get_issue
    {      0,       0,       0,       0,       0,       0,       0,       0},  // put_issue
    {      0,       0,       0,       0,       0,       0,       0,       0},  // wait
    {  126.2,   123.4,   155.6,   99.00,    0.00,   23.44,    4.04,    1.35},  // packet_start
    {   14.8,    14.1,    17.0,   14.12,    0.00,    2.88,    0.00,    0.00},  // pass_slope
    {    1.2,     1.3,     1.4,    0.00,    0.00,    1.03,    0.00,    0.02},  // mailbox_group
    {   60.1,    60.2,    73.9,   59.06,    0.00,   13.69,    0.00,    0.06},  // pass_group
    {  115.9,    90.5,   160.6,   90.48,    0.00,   57.41,    2.48,    0.00},  // pass_square
    {  154.6,    94.1,   163.1,   57.13,    0.00,   26.94,    8.39,    2.06},  // macro_slice_step
    {   18.3,    14.5,    18.5,    2.35,    0.00,    1.67,    1.67,    0.67},  // macro_row
    {   35.1,    19.7,    35.7,   19.23,    0.00,    4.58,    2.62,    0.03},  // macro_cell_step
    {  202.8,   150.2,   216.3,   49.45,    0.00,   29.75,   15.37,    5.60},  // macro_cell_visit
    {  111.9,    71.9,   124.9,   44.29,    0.00,   25.67,    6.78,    1.53},  // slice_step
    {   15.9,    13.9,    16.4,    2.29,    0.00,    1.64,    1.64,    0.64},  // cell_row
    {   22.3,     8.4,    23.5,    8.43,    0.00,    3.48,    1.71,    0.00},  // cell_step
    {   21.3,    22.4,    24.5,    2.10,    0.00,    4.39,    2.90,    1.00},  // cell_visit
    {  153.5,    98.3,   165.9,   56.38,    0.00,   28.63,   15.40,    2.33},  // triangle_batch
    {   16.1,    10.6,    23.1,   10.46,    0.00,   10.27,    0.07,    0.01},  // mailbox_probe
    {    5.8,     4.8,     7.5,    4.58,    0.00,    1.87,    0.05,    0.01},  // reach_group
    {   18.9,    16.2,    27.0,   15.92,    0.00,    9.35,    0.58,    0.01},  // reach_test
    {   46.0,    41.9,    56.8,   38.41,    0.00,   11.42,    1.31,    0.20},  // footprint_group
    {   21.0,     9.1,    22.5,    9.13,    0.00,    3.44,    1.56,    0.00},  // cell_bound_step
}};

}  // namespace gridiron::sim
