// What a unit of each of the rival's kinds of work costs on a core of two in-order pipes. Written by
// gridiron_calibrate from counted operations of the rival itself; do not edit. tools/calibrate/README.md says how.
// Memory: constants. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/rival/rival_work.h>
#include <gridiron/sim/work_costs.h>

#include <array>

namespace gridiron::rival {

/// By kind of work of the rival.
inline constexpr std::array<sim::WorkCost, kRivalWorkCount> kRivalCosts = {{
    //  cycles    least     most     even  doubles      odd branches   misses
    {  342.1,   180.0,   365.6,  126.11,    0.00,   46.98,   14.72,    2.99},  // cache_lookup
    {  152.3,    84.5,   162.0,   42.36,    0.00,   30.57,    6.09,    2.34},  // refill
    {  162.2,    87.9,   167.9,   41.40,    0.00,   21.99,    4.94,    2.58},  // switch
    {  111.9,    89.8,   165.8,   88.69,    0.00,   69.02,    1.94,    0.06},  // node_step
    {   39.7,    27.9,    44.5,   11.54,    0.00,   18.62,    3.53,    0.52},  // child_push
    {   40.8,    28.3,    44.8,    4.16,    0.00,   26.42,    5.04,    0.10},  // stack_pop
    {    1.8,     2.5,     2.6,    0.08,    0.00,    2.49,    0.18,    0.00},  // reciprocal_group
    {   28.5,    29.0,    38.6,   29.00,    0.00,    8.94,    1.00,    0.00},  // box_setup
    {   58.2,    46.4,    70.8,   40.99,    0.00,   15.87,    2.06,    0.30},  // box_group
    {   47.5,    52.4,    56.7,   34.42,    0.00,    3.28,    2.28,    1.00},  // leaf_visit
    {  102.1,    46.7,   112.6,   44.67,    0.00,   19.56,    6.89,    0.11},  // tile_start
    {  775.6,   675.1,  1126.1,  625.45,    0.00,  369.73,   13.51,    2.76},  // packet_start
    {   19.0,    12.3,    25.3,   10.84,    0.00,    8.19,    0.90,    0.08},  // reach
}};

}  // namespace gridiron::rival
