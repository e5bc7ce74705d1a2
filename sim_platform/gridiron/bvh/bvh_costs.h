// What a unit of each of the cached BVH's kinds of work costs on a core of two in-order pipes. Written by
// gridiron_calibrate from counted operations of the cached BVH itself; do not edit. tools/calibrate/README.md says how.
// Memory: constants. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/lanes.h>
#include <gridiron/bvh/bvh_work.h>
#include <gridiron/sim/work_costs.h>

#include <array>

namespace gridiron::bvh {

/// Of core's tile_start, as the cached BVH does it, and of each of its own kinds of work.
inline constexpr std::array<sim::WorkCost, kBvhWorkCount + 1> kBvhCosts = {{
    //  cycles    least     most     even  doubles      odd branches   misses
    {  325.5,   228.8,   379.6,   84.07,    0.00,   87.44,   26.81,    7.85},  // tile_start
    {  166.5,   152.2,   286.2,  139.50,    0.00,  133.24,    2.00,    0.70},  // packet_start
    {   46.9,    54.0,    90.0,   36.00,    0.00,   54.00,    0.00,    0.00},  // mixed_start
    {  119.6,   110.9,   145.9,  110.00,    0.00,   34.29,    1.05,    0.05},  // node_step
    {  185.8,   176.9,   226.2,  158.00,    0.00,   48.69,    1.05,    1.05},  // mixed_node_step
    {   61.3,    35.5,    70.7,   25.98,    0.00,   27.42,    4.00,    0.45},  // children
    {   38.2,    21.2,    39.8,    6.93,    0.00,   10.56,    4.96,    0.59},  // stack_pop
    {   34.3,    16.9,    38.9,   14.82,    0.00,    8.31,    2.44,    0.12},  // cache_lookup
    {  106.8,    69.1,   119.5,   38.86,    0.00,   27.78,    4.06,    1.68},  // miss
    {   91.2,    64.6,   102.6,   24.71,    0.00,   41.14,    9.41,    1.30},  // switch
    {   38.6,    27.0,    40.3,   24.00,    0.00,    3.00,    1.00,    0.17},  // leaf_visit
    {    5.8,     5.1,     6.5,    1.47,    0.00,    0.91,    0.77,    0.20},  // leaf_triangle
    {  108.3,    73.9,   126.6,   55.90,    0.00,   23.07,    1.37,    1.00},  // reach
}};

}  // namespace gridiron::bvh
