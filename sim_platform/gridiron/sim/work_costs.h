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
    {   37.4,    33.2,    64.3,   32.15,    0.18,   31.05,    0.04,    0.00},  // ray_generated
    {  276.6,   219.1,   328.8,  139.30,    0.00,   91.48,   14.91,    4.43},  // packet_start
    {   59.3,    57.7,    71.8,   55.42,    0.00,   13.76,    2.00,    0.12},  // pass_group
    {  159.3,    99.5,   167.0,   54.15,    0.00,   27.39,    9.80,    2.52},  // macro_slice_step
    {   73.5,    63.9,    78.3,   50.36,    0.00,    7.70,    4.99,    0.75},  // macro_cell_step
    {  185.2,   132.6,   194.8,   32.89,    0.00,   25.78,   13.74,    5.54},  // macro_cell_visit
    {   98.1,    64.2,   114.0,   48.76,    0.00,   26.60,    7.79,    0.86},  // slice_step
    {   39.9,    28.4,    41.6,   17.13,    0.00,    3.84,    2.14,    0.63},  // cell_step
    {   71.1,    41.0,    80.0,   32.39,    0.00,   19.10,    5.54,    0.48},  // cell_visit
    {   89.2,    60.9,    93.7,   25.01,    0.00,   12.31,   10.75,    1.99},  // triangle_batch
    {   39.8,    27.3,    46.9,   15.88,    0.00,   14.32,    2.38,    0.63},  // mailbox_probe
    {   89.7,    44.6,    99.7,   37.91,    0.00,   19.22,    1.52,    0.37},  // cull_test
    {  104.8,   106.4,   139.9,  104.45,    0.00,   33.50,    0.36,    0.11},  // pixel_box
    {  125.6,    96.6,   163.8,   95.79,    0.00,   55.19,    5.90,    0.04},  // triangle_setup
    {   62.6,    41.1,    84.0,   33.03,    0.00,   29.24,    3.90,    0.45},  // subpacket_setup
    {   65.1,    54.8,    83.9,   41.91,    0.00,   18.87,    1.69,    0.72},  // subpacket_group
    {   53.3,    39.8,    58.4,   34.33,    0.00,    8.16,    3.62,    0.31},  // group_test_standard
    {   99.2,    43.8,   108.3,   43.19,    0.00,   20.04,    2.96,    0.03},  // group_test_paper
    {  119.6,    71.6,   130.1,   43.19,    0.00,   17.80,    5.07,    1.58},  // hit_group
    {   65.1,    45.7,    75.1,   24.56,    0.00,   21.16,    6.52,    1.17},  // hit_group_paper
    {  562.8,   563.5,   568.8,   97.64,   76.00,    3.71,    1.55,    0.55},  // hit_setup
    {  511.3,   508.2,   537.2,  127.71,   61.00,   27.45,    3.06,    0.81},  // double_sign
    { 3022.7,  2281.1,  3855.8, 2237.48,    0.00, 1211.62,   55.00,    2.42},  // exact_sign
    {42293.9, 21784.5, 49459.2, 17219.05,    0.00, 19288.69, 4070.06,  138.66},  // exact_distance
    {   13.2,    11.3,    19.6,   10.33,    0.00,    7.16,    0.36,    0.06},  // reach_group
    {    8.7,    12.9,    15.5,   12.86,    0.00,    2.63,    0.12,    0.00},  // shaded_group
    {   37.5,    41.6,    49.9,   41.56,    0.00,    8.33,    0.07,    0.00},  // shaded_simple_group
    {   26.3,    26.3,    29.3,   26.26,    0.00,    3.01,    0.00,    0.00},  // depth_group
    {   10.3,    10.3,    11.3,   10.26,    0.00,    1.00,    0.00,    0.00},  // id_group
    {   38.8,    38.2,    48.1,   36.58,    0.00,    9.88,    0.49,    0.09},  // footprint_group
    {   36.6,    28.0,    52.0,   28.00,    0.00,   18.75,    0.00,    0.00},  // row_group
    {  125.9,    80.9,   145.6,   72.62,    0.00,   61.93,    2.00,    0.46},  // estimate_setup
    {  115.4,    56.0,   118.7,   56.00,    0.00,    6.09,    1.00,    0.00},  // normal_setup
    {  289.2,   217.0,   314.6,   74.10,   23.00,   29.81,    2.06,    0.27},  // hit_half
    {      0,       0,       0,       0,       0,       0,       0,       0},  // get_issue
    {      0,       0,       0,       0,       0,       0,       0,       0},  // put_issue
    {      0,       0,       0,       0,       0,       0,       0,       0},  // wait
}};

}  // namespace gridiron::sim
