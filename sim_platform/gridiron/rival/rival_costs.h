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
    {  308.1,   202.1,   346.5,   87.61,    0.00,   80.36,   24.89,    6.36},  // tile_start
    {  171.6,   154.0,   288.0,  139.50,    0.00,  133.79,    2.00,    0.81},  // packet_start
    {   46.1,    54.0,    90.0,   36.00,    0.00,   54.00,    0.00,    0.00},  // mixed_start
    {  121.2,   111.5,   149.4,  110.00,    0.00,   37.08,    1.04,    0.08},  // node_step
    {  168.9,   159.4,   211.6,  158.00,    0.00,   51.56,    1.04,    0.08},  // mixed_node_step
    {   60.4,    34.7,    69.9,   25.99,    0.00,   27.76,    4.00,    0.38},  // children
    {   36.8,    18.9,    38.6,    7.17,    0.00,   10.80,    5.03,    0.45},  // stack_pop
    {   37.7,    20.2,    42.3,   14.77,    0.00,    8.37,    2.38,    0.30},  // cache_lookup
    {   78.9,    40.4,    90.9,   38.85,    0.00,   27.76,    4.14,    0.09},  // miss
    {  107.7,    82.3,   119.9,   25.65,    0.00,   41.90,    9.61,    2.24},  // switch
    {   31.4,    24.0,    35.5,   24.00,    0.00,    3.00,    1.00,    0.00},  // leaf_visit
    {    9.7,     8.2,    10.5,    2.56,    0.00,    1.54,    1.23,    0.31},  // leaf_triangle
    {   91.4,    58.0,   109.9,   56.20,    0.00,   23.22,    1.43,    0.10},  // reach
}};

}  // namespace gridiron::rival
