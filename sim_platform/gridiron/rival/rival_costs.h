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
    {  428.3,   309.4,   528.8,  134.81,    0.00,  165.92,   36.83,    7.97},  // tile_start
    {  156.3,   150.4,   286.0,  143.25,    0.00,  135.19,    2.00,    0.40},  // packet_start
    {   45.0,    54.0,    90.0,   36.00,    0.00,   54.00,    0.00,    0.00},  // mixed_start
    {  122.1,   112.6,   148.0,  110.00,    0.00,   34.49,    1.07,    0.15},  // node_step
    {  169.2,   160.7,   208.0,  158.00,    0.00,   46.67,    1.07,    0.15},  // mixed_node_step
    {   62.3,    36.0,    71.5,   25.97,    0.00,   27.53,    4.00,    0.47},  // children
    {   37.7,    21.3,    39.2,    7.08,    0.00,   10.75,    4.98,    0.58},  // stack_pop
    {   38.6,    20.3,    43.2,   14.62,    0.00,    8.29,    2.44,    0.32},  // cache_lookup
    {   74.9,    39.8,    87.6,   37.96,    0.00,   26.35,    4.16,    0.10},  // miss
    {  105.5,    80.7,   116.5,   24.82,    0.00,   41.67,    9.44,    2.17},  // switch
    {   23.0,    15.0,    23.9,   15.00,    0.00,    1.00,    0.00,    0.00},  // leaf_visit
    {   12.9,    13.3,    14.5,    5.52,    0.00,    1.09,    1.09,    0.43},  // leaf_triangle
    {   37.9,    18.8,    43.9,   16.23,    0.00,   10.92,    1.37,    0.14},  // reach
}};

}  // namespace gridiron::rival
