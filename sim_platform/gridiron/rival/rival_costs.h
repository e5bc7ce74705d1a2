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
    {  326.1,   202.1,   365.5,   87.61,    0.00,   82.36,   24.89,    6.36},  // tile_start
    {  168.5,   154.0,   289.2,  139.50,    0.00,  134.46,    2.00,    0.81},  // packet_start
    {   45.0,    54.0,    90.0,   36.00,    0.00,   54.00,    0.00,    0.00},  // mixed_start
    {  121.2,   111.5,   149.2,  110.00,    0.00,   36.92,    1.04,    0.08},  // node_step
    {  168.8,   159.4,   211.3,  158.00,    0.00,   51.24,    1.04,    0.08},  // mixed_node_step
    {   60.4,    34.7,    69.9,   25.99,    0.00,   27.76,    4.00,    0.38},  // children
    {   36.4,    18.8,    38.1,    7.03,    0.00,   10.68,    5.00,    0.45},  // stack_pop
    {   37.8,    20.2,    42.4,   14.77,    0.00,    8.37,    2.38,    0.30},  // cache_lookup
    {   78.9,    40.4,    90.9,   38.85,    0.00,   27.76,    4.14,    0.09},  // miss
    {  107.7,    82.3,   119.9,   25.65,    0.00,   41.90,    9.61,    2.24},  // switch
    {   28.0,    23.0,    31.5,   23.00,    0.00,    2.00,    0.00,    0.00},  // leaf_visit
    {   11.9,    11.9,    14.0,    6.28,    0.00,    1.11,    0.80,    0.31},  // leaf_triangle
    {   85.4,    57.0,   103.7,   55.20,    0.00,   23.05,    1.43,    0.10},  // reach
}};

}  // namespace gridiron::rival
