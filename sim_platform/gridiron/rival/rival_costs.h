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
    {  323.6,   200.0,   362.9,   87.50,    0.00,   82.11,   24.83,    6.25},  // tile_start
    {  169.6,   157.0,   292.2,  142.50,    0.00,  134.46,    2.00,    0.81},  // packet_start
    {   45.0,    54.0,    90.0,   36.00,    0.00,   54.00,    0.00,    0.00},  // mixed_start
    {  121.2,   111.5,   149.2,  110.00,    0.00,   36.93,    1.04,    0.08},  // node_step
    {  168.9,   159.3,   212.1,  158.00,    0.00,   52.15,    1.04,    0.07},  // mixed_node_step
    {   60.3,    34.6,    69.8,   25.99,    0.00,   27.77,    4.00,    0.38},  // children
    {   36.4,    18.7,    38.1,    7.03,    0.00,   10.70,    5.00,    0.45},  // stack_pop
    {   37.9,    20.2,    42.5,   14.79,    0.00,    8.38,    2.37,    0.30},  // cache_lookup
    {   75.1,    40.4,    88.3,   38.82,    0.00,   26.79,    4.14,    0.09},  // miss
    {  107.4,    82.0,   119.5,   25.56,    0.00,   41.88,    9.59,    2.23},  // switch
    {   26.2,    23.0,    29.3,   23.00,    0.00,    1.00,    0.00,    0.00},  // leaf_visit
    {   11.5,    11.5,    13.6,    6.22,    0.00,    1.08,    0.78,    0.30},  // leaf_triangle
    {   85.4,    57.0,   103.7,   55.20,    0.00,   23.05,    1.43,    0.10},  // reach
}};

}  // namespace gridiron::rival
