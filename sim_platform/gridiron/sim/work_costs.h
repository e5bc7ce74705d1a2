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
    {   35.5,    32.2,    62.0,   30.56,    0.28,   29.83,    0.04,    0.00},  // ray_generated
    {  288.1,   227.6,   343.4,  148.06,    0.00,   97.59,   15.76,    4.42},  // packet_start
    {   59.4,    57.7,    71.9,   55.41,    0.00,   13.88,    2.00,    0.12},  // pass_group
    {  159.5,    99.5,   167.3,   54.64,    0.00,   27.46,    9.85,    2.49},  // macro_slice_step
    {   73.2,    63.6,    78.0,   50.51,    0.00,    7.72,    4.99,    0.73},  // macro_cell_step
    {  185.3,   132.6,   194.9,   32.90,    0.00,   25.78,   13.74,    5.54},  // macro_cell_visit
    {   98.5,    64.5,   114.4,   48.87,    0.00,   26.64,    7.82,    0.87},  // slice_step
    {   40.0,    28.4,    41.7,   17.12,    0.00,    3.84,    2.13,    0.63},  // cell_step
    {   71.7,    41.3,    80.6,   32.62,    0.00,   19.25,    5.54,    0.48},  // cell_visit
    {   88.9,    60.8,    93.5,   24.92,    0.00,   12.26,   10.71,    1.99},  // triangle_batch
    {   39.8,    27.3,    46.9,   15.87,    0.00,   14.31,    2.38,    0.63},  // mailbox_probe
    {   89.6,    44.6,    99.7,   37.91,    0.00,   19.22,    1.52,    0.37},  // cull_test
    {  104.9,   106.5,   140.1,  104.49,    0.00,   33.61,    0.36,    0.11},  // pixel_box
    {  127.1,    97.1,   165.4,   96.16,    0.00,   56.12,    6.64,    0.05},  // triangle_setup
    {   57.3,    39.1,    78.8,   31.84,    0.00,   28.51,    3.64,    0.40},  // subpacket_setup
    {   64.3,    54.2,    82.6,   43.65,    0.00,   18.63,    1.69,    0.59},  // subpacket_group
    {   53.4,    40.0,    58.8,   34.49,    0.00,    8.38,    3.81,    0.31},  // group_test_standard
    {   99.2,    43.8,   108.3,   43.19,    0.00,   20.04,    2.96,    0.03},  // group_test_paper
    {  119.8,    71.0,   130.5,   44.89,    0.00,   18.31,    5.20,    1.45},  // hit_group
    {  208.0,   183.4,   252.0,  177.74,    0.00,   49.18,    5.75,    0.32},  // hit_subpacket
    {   65.1,    45.7,    75.1,   24.56,    0.00,   21.16,    6.52,    1.17},  // hit_group_paper
    {  562.8,   563.5,   568.8,   97.64,   76.00,    3.71,    1.55,    0.55},  // hit_setup
    {  512.3,   509.3,   538.3,  127.74,   61.05,   27.49,    3.08,    0.85},  // double_sign
    { 3022.7,  2281.1,  3855.8, 2237.48,    0.00, 1211.62,   55.00,    2.42},  // exact_sign
    {42293.9, 21784.5, 49459.2, 17219.05,    0.00, 19288.69, 4070.06,  138.66},  // exact_distance
    {   14.1,    12.3,    20.2,   11.35,    0.00,    6.93,    0.35,    0.05},  // reach_group
    {    8.7,    12.9,    15.5,   12.86,    0.00,    2.63,    0.12,    0.00},  // shaded_group
    {   38.8,    41.5,    49.7,   41.46,    0.00,    8.23,    0.05,    0.00},  // shaded_simple_group
    {   26.3,    26.3,    29.3,   26.26,    0.00,    3.01,    0.00,    0.00},  // depth_group
    {   10.3,    10.3,    11.3,   10.26,    0.00,    1.00,    0.00,    0.00},  // id_group
    {   38.7,    38.2,    48.1,   36.57,    0.00,    9.89,    0.48,    0.09},  // footprint_group
    {   48.6,    35.2,    64.5,   28.00,    0.00,   20.26,    1.00,    0.40},  // row_group
    {  125.7,    80.8,   145.5,   72.64,    0.00,   61.92,    2.00,    0.45},  // estimate_setup
    {  114.6,    56.0,   117.9,   56.00,    0.00,    6.09,    1.00,    0.00},  // normal_setup
    {  289.2,   217.0,   314.6,   74.10,   23.00,   29.81,    2.06,    0.27},  // hit_half
    {      0,       0,       0,       0,       0,       0,       0,       0},  // get_issue
    {      0,       0,       0,       0,       0,       0,       0,       0},  // put_issue
    {      0,       0,       0,       0,       0,       0,       0,       0},  // wait
}};

}  // namespace gridiron::sim
