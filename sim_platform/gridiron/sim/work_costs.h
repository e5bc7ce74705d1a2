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
    {  159.4,    99.2,   167.2,   54.92,    0.00,   27.51,    9.86,    2.46},  // macro_slice_step
    {   75.5,    65.2,    80.0,   49.64,    0.00,    7.63,    4.98,    0.86},  // macro_cell_step
    {  185.3,   132.7,   194.9,   32.90,    0.00,   25.83,   13.77,    5.55},  // macro_cell_visit
    {   98.9,    64.9,   114.8,   48.86,    0.00,   26.63,    7.82,    0.89},  // slice_step
    {   39.8,    28.4,    41.5,   17.12,    0.00,    3.84,    2.13,    0.63},  // cell_step
    {   71.8,    41.3,    80.8,   32.67,    0.00,   19.31,    5.52,    0.48},  // cell_visit
    {   88.7,    60.7,    93.2,   24.88,    0.00,   12.23,   10.70,    1.99},  // triangle_batch
    {   39.6,    27.2,    46.7,   15.84,    0.00,   14.28,    2.38,    0.63},  // mailbox_probe
    {   88.9,    44.7,    99.1,   37.86,    0.00,   19.19,    1.53,    0.38},  // cull_test
    {  106.0,   107.5,   141.2,  105.51,    0.00,   33.61,    0.37,    0.11},  // pixel_box
    {  126.4,    96.5,   164.3,   95.59,    0.00,   55.94,    6.61,    0.05},  // triangle_setup
    {   57.3,    39.0,    78.8,   31.82,    0.00,   28.50,    3.63,    0.40},  // subpacket_setup
    {   64.3,    54.2,    82.6,   43.67,    0.00,   18.63,    1.69,    0.59},  // subpacket_group
    {   53.1,    39.8,    58.5,   34.40,    0.00,    8.36,    3.80,    0.30},  // group_test_standard
    {   99.5,    44.0,   108.5,   43.19,    0.00,   20.07,    2.99,    0.04},  // group_test_paper
    {  118.8,    70.3,   129.6,   44.75,    0.00,   18.32,    5.18,    1.42},  // hit_group
    {  207.9,   183.4,   252.0,  177.74,    0.00,   49.18,    5.75,    0.32},  // hit_subpacket
    {   63.3,    44.1,    73.1,   24.06,    0.00,   20.87,    6.42,    1.11},  // hit_group_paper
    {  562.8,   563.5,   568.8,   97.64,   76.00,    3.71,    1.55,    0.55},  // hit_setup
    {  513.1,   510.1,   539.1,  127.73,   61.05,   27.41,    3.08,    0.89},  // double_sign
    { 3022.7,  2281.1,  3855.8, 2237.48,    0.00, 1211.62,   55.00,    2.42},  // exact_sign
    {42293.9, 21784.5, 49459.2, 17219.05,    0.00, 19288.69, 4070.06,  138.66},  // exact_distance
    {   14.1,    12.3,    20.3,   11.35,    0.00,    6.94,    0.35,    0.05},  // reach_group
    {    8.7,    12.9,    15.5,   12.86,    0.00,    2.63,    0.12,    0.00},  // shaded_group
    {   38.6,    41.5,    49.7,   41.46,    0.00,    8.23,    0.05,    0.00},  // shaded_simple_group
    {   26.3,    26.3,    29.3,   26.26,    0.00,    3.01,    0.00,    0.00},  // depth_group
    {   10.3,    10.3,    11.3,   10.26,    0.00,    1.00,    0.00,    0.00},  // id_group
    {   38.7,    38.2,    48.1,   36.57,    0.00,    9.89,    0.48,    0.09},  // footprint_group
    {   48.7,    35.3,    64.6,   28.00,    0.00,   20.26,    1.00,    0.41},  // row_group
    {  125.7,    80.8,   145.5,   72.64,    0.00,   61.93,    2.00,    0.45},  // estimate_setup
    {  114.6,    56.0,   117.9,   56.00,    0.00,    6.09,    1.00,    0.00},  // normal_setup
    {  289.2,   217.0,   314.5,   74.10,   23.00,   29.81,    2.06,    0.27},  // hit_half
    {      0,       0,       0,       0,       0,       0,       0,       0},  // get_issue
    {      0,       0,       0,       0,       0,       0,       0,       0},  // put_issue
    {      0,       0,       0,       0,       0,       0,       0,       0},  // wait
}};

}  // namespace gridiron::sim
