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
    {  427.9,   309.8,   528.6,  134.81,    0.00,  165.83,   36.83,    8.00},  // tile_start
    {  156.3,   150.4,   286.0,  143.25,    0.00,  135.19,    2.00,    0.40},  // packet_start
    {   45.0,    54.0,    90.0,   36.00,    0.00,   54.00,    0.00,    0.00},  // mixed_start
    {  123.2,   112.6,   147.7,  110.00,    0.00,   34.46,    1.07,    0.14},  // node_step
    {  170.5,   160.6,   208.0,  158.00,    0.00,   46.95,    1.07,    0.14},  // mixed_node_step
    {   58.0,    37.4,    67.5,   28.97,    0.00,   18.63,    4.00,    0.47},  // children
    {   37.1,    20.2,    39.2,    7.08,    0.00,    9.76,    4.99,    0.58},  // stack_pop
    {   38.5,    20.3,    43.1,   14.64,    0.00,    8.29,    2.44,    0.31},  // cache_lookup
    {   74.8,    39.9,    87.5,   37.85,    0.00,   26.27,    4.16,    0.11},  // miss
    {  105.8,    80.9,   116.7,   24.71,    0.00,   41.65,    9.44,    2.18},  // switch
    {   23.1,    15.0,    24.0,   15.00,    0.00,    1.00,    0.00,    0.00},  // leaf_visit
    {   13.0,    13.4,    14.6,    5.53,    0.00,    1.09,    1.09,    0.44},  // leaf_triangle
    {   39.0,    18.7,    45.0,   16.23,    0.00,   10.92,    1.37,    0.14},  // reach
}};

}  // namespace gridiron::rival
