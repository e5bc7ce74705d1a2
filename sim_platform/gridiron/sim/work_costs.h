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
    {   35.4,    33.4,    63.6,   30.17,    0.28,   31.69,    0.04,    0.00},  // ray_generated
    {  368.8,   286.6,   431.7,  183.03,    0.00,  125.95,   21.65,    5.75},  // packet_start
    {   55.7,    55.5,    70.2,   55.50,    0.00,   14.75,    0.00,    0.00},  // pass_group
    {  110.0,    85.5,   149.9,   85.49,    0.00,   51.76,    2.49,    0.00},  // pass_square
    {  159.4,    99.2,   167.3,   54.92,    0.00,   27.51,    9.86,    2.46},  // macro_slice_step
    {   75.5,    65.2,    80.0,   49.64,    0.00,    7.63,    4.98,    0.86},  // macro_cell_step
    {  185.3,   132.7,   194.9,   32.90,    0.00,   25.83,   13.77,    5.55},  // macro_cell_visit
    {   98.9,    64.9,   114.8,   48.86,    0.00,   26.63,    7.82,    0.89},  // slice_step
    {   39.8,    28.4,    41.5,   17.12,    0.00,    3.84,    2.13,    0.63},  // cell_step
    {   59.9,    37.2,    68.2,   28.55,    0.00,   16.16,    5.52,    0.48},  // cell_visit
    {   90.0,    60.7,    94.5,   24.88,    0.00,   12.23,   10.70,    1.99},  // triangle_batch
    {   39.5,    27.2,    46.6,   15.84,    0.00,   14.28,    2.38,    0.63},  // mailbox_probe
    {   88.9,    44.7,    99.1,   37.86,    0.00,   19.19,    1.53,    0.38},  // cull_test
    {  196.6,   198.0,   276.0,  198.00,    0.00,   78.00,    0.00,    0.00},  // pixel_box_group
    {  137.7,   108.0,   177.4,  106.27,    0.00,   57.29,    6.79,    0.10},  // triangle_setup
    {   58.2,    39.5,    79.6,   31.99,    0.00,   28.60,    3.67,    0.41},  // subpacket_setup
    {   64.1,    54.1,    82.4,   43.56,    0.00,   18.62,    1.68,    0.59},  // subpacket_group
    {   53.8,    40.1,    59.1,   34.45,    0.00,    8.21,    3.82,    0.32},  // group_test_standard
    {   99.5,    44.0,   108.5,   43.19,    0.00,   20.07,    2.99,    0.04},  // group_test_paper
    {  105.6,    73.3,   118.7,   46.37,    0.00,   18.34,    5.25,    1.50},  // hit_group
    {  208.4,   187.4,   252.5,  181.74,    0.00,   49.18,    5.75,    0.32},  // hit_subpacket
    {   63.3,    44.1,    73.1,   24.06,    0.00,   20.87,    6.42,    1.11},  // hit_group_paper
    {  562.8,   563.5,   568.8,   97.64,   76.00,    3.73,    1.55,    0.55},  // hit_setup
    {  513.4,   510.3,   539.4,  127.87,   61.05,   27.44,    3.10,    0.90},  // double_sign
    { 3022.7,  2281.1,  3855.8, 2237.48,    0.00, 1211.62,   55.00,    2.42},  // exact_sign
    {42293.9, 21784.5, 49459.2, 17219.05,    0.00, 19288.69, 4070.06,  138.66},  // exact_distance
    {   20.1,    16.2,    25.8,   14.76,    0.00,    7.15,    0.52,    0.08},  // reach_group
    {    8.7,    12.9,    15.5,   12.86,    0.00,    2.63,    0.12,    0.00},  // shaded_group
    {   38.6,    41.5,    49.7,   41.46,    0.00,    8.23,    0.05,    0.00},  // shaded_simple_group
    {   26.3,    26.3,    29.3,   26.26,    0.00,    3.01,    0.00,    0.00},  // depth_group
    {   10.3,    10.3,    11.3,   10.26,    0.00,    1.00,    0.00,    0.00},  // id_group
    {   38.7,    38.2,    48.1,   36.57,    0.00,    9.89,    0.48,    0.09},  // footprint_group
    {   48.2,    35.1,    64.2,   28.00,    0.00,   20.26,    1.00,    0.39},  // row_group
    {  122.8,    81.1,   145.7,   72.57,    0.00,   61.93,    2.00,    0.48},  // estimate_setup
    {  114.5,    56.0,   117.8,   56.00,    0.00,    6.10,    1.00,    0.00},  // normal_setup
    {  289.2,   217.0,   314.6,   74.10,   23.00,   29.81,    2.06,    0.27},  // hit_half
    {      0,       0,       0,       0,       0,       0,       0,       0},  // get_issue
    {      0,       0,       0,       0,       0,       0,       0,       0},  // put_issue
    {      0,       0,       0,       0,       0,       0,       0,       0},  // wait
}};

}  // namespace gridiron::sim
