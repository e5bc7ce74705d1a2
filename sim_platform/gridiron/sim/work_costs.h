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
  double least_cycles;  ///< bound: the fuller pipe never idle
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
    {  258.1,   208.8,   303.6,  129.03,    0.00,   82.75,   11.91,    4.43},  // packet_start
    {   54.4,    54.4,    62.1,   54.42,    0.00,    7.64,    0.00,    0.00},  // pass_group
    {  159.3,    99.5,   167.0,   54.15,    0.00,   27.39,    9.80,    2.52},  // macro_slice_step
    {   73.5,    63.9,    78.3,   50.36,    0.00,    7.70,    4.99,    0.75},  // macro_cell_step
    {  185.1,   132.6,   194.8,   32.89,    0.00,   25.78,   13.74,    5.54},  // macro_cell_visit
    {   98.1,    64.2,   114.0,   48.76,    0.00,   26.60,    7.79,    0.86},  // slice_step
    {   40.0,    28.4,    41.7,   17.13,    0.00,    3.85,    2.14,    0.63},  // cell_step
    {   62.0,    39.0,    71.4,   29.61,    0.00,   13.55,    4.10,    0.52},  // cell_visit
    {   79.3,    60.3,    84.8,   24.58,    0.00,   12.26,    8.88,    1.98},  // triangle_batch
    {   41.6,    29.0,    48.8,   15.49,    0.00,   14.33,    2.27,    0.75},  // mailbox_probe
    {   89.8,    43.5,   100.4,   37.63,    0.00,   19.10,    1.40,    0.33},  // cull_test
    {  110.3,    78.6,   144.3,   78.62,    0.00,   55.70,    4.74,    0.00},  // triangle_setup
    {  110.1,   104.4,   123.7,   95.57,    0.00,   15.00,    3.16,    0.49},  // subpacket_setup
    {   45.3,    44.0,    65.6,   41.56,    0.00,   20.61,    0.49,    0.14},  // subpacket_group
    {   43.3,    36.0,    48.8,   33.51,    0.00,    7.02,    2.42,    0.14},  // group_test_standard
    {   99.2,    43.8,   108.3,   43.19,    0.00,   20.04,    2.96,    0.03},  // group_test_paper
    {  536.8,   527.6,   598.6,  178.25,   56.19,   67.11,    2.85,    0.68},  // hit_group
    {   65.0,    45.6,    75.0,   24.53,    0.00,   21.16,    6.52,    1.17},  // hit_group_paper
    {  735.7,   742.0,   758.9,  130.00,  102.00,   16.93,    0.00,    0.00},  // hit_setup
    {  511.1,   509.2,   537.2,  128.71,   61.00,   26.61,    3.06,    0.81},  // double_sign
    { 3022.7,  2281.1,  3855.8, 2237.48,    0.00, 1211.62,   55.00,    2.42},  // exact_sign
    {42293.9, 21784.5, 49459.2, 17219.05,    0.00, 19288.69, 4070.06,  138.66},  // exact_distance
    {   11.3,     9.8,    17.0,    9.11,    0.00,    6.30,    0.17,    0.04},  // reach_group
    {   83.8,    50.7,    96.7,   50.73,    0.00,   29.64,    8.25,    0.00},  // shaded_group
    {  215.3,   170.7,   258.8,  170.75,    0.00,   53.47,    8.25,    0.00},  // shaded_simple_group
    {      0,       0,       0,       0,       0,       0,       0,       0},  // get_issue
    {      0,       0,       0,       0,       0,       0,       0,       0},  // put_issue
    {      0,       0,       0,       0,       0,       0,       0,       0},  // wait
}};

}  // namespace gridiron::sim
