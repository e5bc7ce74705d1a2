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
    {  317.4,   220.2,   372.3,   85.56,    0.00,   87.83,   26.80,    7.35},  // tile_start
    {  166.6,   152.2,   286.2,  139.50,    0.00,  133.24,    2.00,    0.70},  // packet_start
    {   46.7,    54.0,    90.0,   36.00,    0.00,   54.00,    0.00,    0.00},  // mixed_start
    {  119.4,   111.3,   144.4,  110.00,    0.00,   32.37,    1.07,    0.07},  // node_step
    {  186.4,   177.6,   225.4,  158.00,    0.00,   47.10,    1.09,    1.09},  // mixed_node_step
    {   61.9,    36.2,    71.2,   25.96,    0.00,   27.21,    4.00,    0.50},  // children
    {   47.3,    31.9,    48.8,    6.82,    0.00,   10.42,    4.86,    1.19},  // stack_pop
    {   35.5,    17.8,    39.8,   14.19,    0.00,    8.09,    2.50,    0.20},  // cache_lookup
    {  106.3,    68.5,   119.8,   40.17,    0.00,   28.83,    3.99,    1.57},  // miss
    {   80.8,    54.7,    91.9,   24.41,    0.00,   40.51,    9.19,    0.79},  // switch
    {   39.1,    30.9,    43.0,   24.00,    0.00,    3.00,    1.00,    0.38},  // leaf_visit
    {    2.3,     2.1,     2.9,    1.03,    0.00,    0.66,    0.60,    0.06},  // leaf_triangle
    {  108.8,    73.5,   126.9,   55.53,    0.00,   22.91,    1.28,    1.00},  // reach
}};

}  // namespace gridiron::bvh
