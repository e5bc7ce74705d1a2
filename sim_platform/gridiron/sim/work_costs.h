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
    {   65.9,    56.4,    91.8,   54.44,    0.00,   20.67,    6.89,    0.11},  // tile_start
    {   31.4,    31.6,    57.7,   31.61,    0.00,   26.11,    0.04,    0.00},  // ray_generated
    {  263.3,   214.2,   313.5,  134.48,    0.00,   84.61,   11.91,    4.43},  // packet_start
    {   59.3,    57.7,    71.8,   55.42,    0.00,   13.79,    2.00,    0.12},  // pass_group
    {  159.3,    99.5,   167.1,   54.15,    0.00,   27.39,    9.80,    2.52},  // macro_slice_step
    {   73.5,    63.9,    78.3,   50.36,    0.00,    7.70,    4.99,    0.75},  // macro_cell_step
    {  185.2,   132.6,   194.8,   32.89,    0.00,   25.78,   13.74,    5.54},  // macro_cell_visit
    {   98.1,    64.2,   114.0,   48.76,    0.00,   26.60,    7.79,    0.86},  // slice_step
    {   39.9,    28.4,    41.6,   17.13,    0.00,    3.84,    2.14,    0.63},  // cell_step
    {   71.1,    41.0,    80.0,   32.39,    0.00,   19.10,    5.54,    0.48},  // cell_visit
    {   89.1,    60.9,    93.6,   25.01,    0.00,   12.31,   10.75,    1.99},  // triangle_batch
    {   42.2,    29.4,    49.2,   15.48,    0.00,   14.37,    2.28,    0.77},  // mailbox_probe
    {   86.0,    43.5,    96.7,   37.63,    0.00,   19.10,    1.40,    0.33},  // cull_test
    {  130.5,   100.9,   171.2,   99.42,    0.00,   59.28,    6.15,    0.08},  // triangle_setup
    {   46.3,    32.5,    66.6,   28.70,    0.00,   26.64,    2.95,    0.21},  // subpacket_setup
    {   59.4,    51.8,    78.1,   42.30,    0.00,   18.42,    1.64,    0.53},  // subpacket_group
    {   55.1,    41.7,    60.7,   36.72,    0.00,    8.52,    3.72,    0.28},  // group_test_standard
    {   99.2,    43.8,   108.3,   43.19,    0.00,   20.04,    2.96,    0.03},  // group_test_paper
    {   72.9,    53.7,    84.9,   31.69,    0.00,   17.67,    4.69,    1.22},  // hit_group
    {   65.0,    45.6,    75.0,   24.53,    0.00,   21.16,    6.52,    1.17},  // hit_group_paper
    {  756.6,   757.0,   774.1,  135.99,  102.00,   15.89,    1.50,    0.50},  // hit_setup
    {  511.4,   508.2,   537.6,  127.71,   61.00,   27.81,    3.06,    0.81},  // double_sign
    { 3022.7,  2281.1,  3855.8, 2237.48,    0.00, 1211.62,   55.00,    2.42},  // exact_sign
    {42293.9, 21784.5, 49459.2, 17219.05,    0.00, 19288.69, 4070.06,  138.66},  // exact_distance
    {   13.2,    11.3,    19.6,   10.33,    0.00,    7.16,    0.36,    0.06},  // reach_group
    {   83.8,    50.7,    96.7,   50.73,    0.00,   29.64,    8.25,    0.00},  // shaded_group
    {  215.3,   170.7,   258.8,  170.75,    0.00,   53.47,    8.25,    0.00},  // shaded_simple_group
    {   38.8,    38.2,    48.1,   36.58,    0.00,    9.88,    0.49,    0.09},  // footprint_group
    {   34.9,    27.0,    48.1,   27.00,    0.00,   17.13,    0.00,    0.00},  // row_group
    {   71.4,    66.0,    80.6,   66.00,    0.00,   13.88,    1.00,    0.00},  // far_setup
    {   87.1,    45.2,    92.6,   21.44,    0.00,   10.55,    3.29,    1.32},  // far_group
    {  292.9,   219.3,   315.0,   64.31,   25.00,   26.49,    0.48,    0.28},  // hit_half
    {      0,       0,       0,       0,       0,       0,       0,       0},  // get_issue
    {      0,       0,       0,       0,       0,       0,       0,       0},  // put_issue
    {      0,       0,       0,       0,       0,       0,       0,       0},  // wait
}};

}  // namespace gridiron::sim
