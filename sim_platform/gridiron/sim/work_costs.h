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
  double least_cycles;  ///< the fuller pipe never idle; a little too much where a neighbour fills gaps
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
    {   34.9,    33.0,    63.1,   30.06,    0.20,   31.75,    0.04,    0.00},  // ray_generated
    {  388.8,   289.7,   450.6,  186.14,    0.00,  125.01,   21.65,    5.75},  // packet_start
    {   55.7,    55.5,    70.2,   55.50,    0.00,   14.75,    0.00,    0.00},  // pass_group
    {  110.0,    85.5,   149.9,   85.49,    0.00,   51.76,    2.49,    0.00},  // pass_square
    {  159.4,    99.2,   167.2,   54.92,    0.00,   27.51,    9.86,    2.46},  // macro_slice_step
    {   75.5,    65.2,    80.0,   49.64,    0.00,    7.63,    4.98,    0.86},  // macro_cell_step
    {  185.3,   132.7,   194.9,   32.90,    0.00,   25.83,   13.77,    5.55},  // macro_cell_visit
    {   98.9,    64.9,   114.8,   48.86,    0.00,   26.63,    7.82,    0.89},  // slice_step
    {   39.8,    28.4,    41.5,   17.12,    0.00,    3.84,    2.13,    0.63},  // cell_step
    {   59.9,    37.2,    68.2,   28.55,    0.00,   16.16,    5.52,    0.48},  // cell_visit
    {   90.0,    60.7,    94.5,   24.88,    0.00,   12.23,   10.70,    1.99},  // triangle_batch
    {   39.7,    27.4,    46.9,   15.85,    0.00,   14.28,    2.38,    0.64},  // mailbox_probe
    {   88.9,    44.7,    99.1,   37.89,    0.00,   19.19,    1.53,    0.38},  // cull_test
    {  197.7,   198.0,   276.1,  198.00,    0.00,   78.14,    0.00,    0.00},  // pixel_box_group
    {  138.8,   109.6,   178.7,  107.46,    0.00,   57.21,    6.78,    0.12},  // triangle_setup
    {   58.5,    39.7,    80.0,   32.00,    0.00,   28.59,    3.67,    0.43},  // subpacket_setup
    {   64.7,    54.4,    83.0,   43.49,    0.00,   18.69,    1.71,    0.61},  // subpacket_group
    {   53.3,    39.7,    58.6,   34.29,    0.00,    8.18,    3.80,    0.30},  // group_test_standard
    {   99.5,    44.0,   108.5,   43.20,    0.00,   20.07,    2.99,    0.04},  // group_test_paper
    {  116.2,    80.1,   130.4,   47.76,    0.00,   21.07,    6.19,    1.80},  // hit_group
    {  227.7,   206.5,   272.2,  200.83,    0.00,   50.19,    6.75,    0.32},  // hit_subpacket
    {   68.2,    44.2,    77.4,   24.10,    0.00,   22.85,    8.09,    1.11},  // hit_group_paper
    {  562.8,   563.5,   568.8,   97.64,   76.00,    3.71,    1.55,    0.55},  // hit_setup
    {  513.4,   510.3,   539.4,  127.87,   61.05,   27.46,    3.10,    0.90},  // double_sign
    { 3022.7,  2281.1,  3855.8, 2237.48,    0.00, 1211.62,   55.00,    2.42},  // exact_sign
    {42293.9, 21784.5, 49459.2, 17219.05,    0.00, 19288.69, 4070.06,  138.66},  // exact_distance
    {   18.7,    14.5,    24.7,   13.01,    0.00,    7.22,    1.01,    0.08},  // reach_group
    {    8.7,    12.9,    15.5,   12.86,    0.00,    2.63,    0.12,    0.00},  // shaded_group
    {   38.6,    41.5,    49.7,   41.46,    0.00,    8.23,    0.05,    0.00},  // shaded_simple_group
    {   26.3,    26.3,    29.3,   26.26,    0.00,    3.01,    0.00,    0.00},  // depth_group
    {   10.3,    10.3,    11.3,   10.26,    0.00,    1.00,    0.00,    0.00},  // id_group
    {   38.7,    38.2,    48.1,   36.57,    0.00,    9.89,    0.48,    0.09},  // footprint_group
    {   48.4,    35.2,    64.3,   28.00,    0.00,   20.26,    1.00,    0.40},  // row_group
    {  122.5,    80.9,   145.5,   72.62,    0.00,   61.93,    2.00,    0.46},  // estimate_setup
    {  112.0,    56.0,   115.9,   56.00,    0.00,    6.09,    1.00,    0.00},  // normal_setup
    {  289.2,   217.0,   314.6,   74.10,   23.00,   29.81,    2.06,    0.27},  // hit_half
    {      0,       0,       0,       0,       0,       0,       0,       0},  // get_issue
    {      0,       0,       0,       0,       0,       0,       0,       0},  // put_issue
    {      0,       0,       0,       0,       0,       0,       0,       0},  // wait
}};

}  // namespace gridiron::sim
