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
    {  314.4,   212.3,   370.2,  100.81,    0.00,   90.64,   27.72,    6.19},  // tile_start
    {  172.8,   154.0,   288.2,  139.50,    0.00,  133.54,    2.00,    0.81},  // packet_start
    {   46.4,    54.0,    90.0,   36.00,    0.00,   54.00,    0.00,    0.00},  // mixed_start
    {  121.1,   111.8,   148.4,  110.00,    0.00,   35.80,    1.05,    0.10},  // node_step
    {  169.2,   159.9,   210.9,  158.00,    0.00,   50.29,    1.05,    0.11},  // mixed_node_step
    {   60.6,    34.9,    70.1,   25.99,    0.00,   27.61,    4.00,    0.41},  // children
    {   37.4,    20.2,    39.2,    7.35,    0.00,   10.88,    5.05,    0.52},  // stack_pop
    {   38.3,    20.9,    42.9,   14.74,    0.00,    8.37,    2.42,    0.34},  // cache_lookup
    {   79.0,    40.9,    91.3,   39.26,    0.00,   28.10,    4.07,    0.09},  // miss
    {  102.0,    77.5,   113.8,   24.89,    0.00,   41.22,    9.40,    2.02},  // switch
    {   50.6,    38.8,    52.2,   24.00,    0.00,    3.00,    1.00,    0.82},  // leaf_visit
    {    4.6,     4.0,     5.3,    1.47,    0.00,    0.91,    0.77,    0.14},  // leaf_triangle
    {   93.4,    59.3,   111.7,   55.94,    0.00,   23.11,    1.38,    0.19},  // reach
}};
static_assert(kBvhCosts.back().cycles > 0, "a kind of work lacks its row");

}  // namespace gridiron::bvh
