// What a unit of each kind of work of eye rays through the tree costs on a core of two in-order pipes. Written
// by gridiron_calibrate from counted operations of the kernel itself; do not edit. tools/calibrate/README.md says how.
// Memory: constants. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/engine/tree/tile_work.h>
#include <gridiron/sim/work_cost.h>

#include <array>

namespace gridiron::sim {

/// By kind of TileWork, from kFirst on.
inline constexpr std::array<WorkCost, kTileWorkCount> kTileCosts = {{
    //  cycles    least     most     even  doubles      odd branches   misses
    {  723.6,   721.6,   902.2,  435.56,   44.00,  180.67,    5.00,    1.22},  // tile_view
    {   10.5,     9.8,    17.9,    8.03,    0.00,    9.48,    0.06,    0.02},  // cleared_block
    {   69.7,    69.2,    99.1,   69.25,    0.00,   29.50,    0.45,    0.00},  // box_group
    {  148.2,   113.9,   188.2,   99.75,    0.00,   44.96,    9.69,    0.79},  // child
    {  170.1,   184.1,   191.1,   40.07,   24.00,    7.00,    0.00,    0.00},  // leaf
    {  174.7,   168.1,   256.7,  162.49,    0.00,   88.57,    1.24,    0.31},  // corner_group
    {   73.5,    70.4,    99.5,   26.57,    0.00,   65.38,    3.05,    0.28},  // kept_group
    {  174.4,   112.6,   199.1,   80.68,    0.00,   39.69,    3.29,    1.77},  // normal_group
    {  278.3,   272.0,   330.6,  265.01,    0.00,   56.99,    3.81,    0.39},  // function_group
    {   38.7,    39.5,    45.6,   29.77,    0.00,    6.03,    1.26,    0.54},  // tiny_place
    {   52.4,    46.1,    64.8,   36.94,    0.00,   16.24,    3.34,    0.51},  // tiny_pixel
    {   81.6,    77.3,   106.9,   73.21,    0.00,   29.66,    1.22,    0.22},  // drawn
    {  100.0,   100.0,   100.0,   70.00,    0.00,   30.00,    1.00,    0.20},  // large_triangle
    {   54.9,    47.2,    58.1,   35.69,    0.00,    4.14,    1.60,    0.64},  // block_group
    {  103.3,   102.1,   121.5,   88.56,    0.00,   18.14,    2.56,    0.75},  // block
    {   40.0,    40.0,    40.0,   30.00,    0.00,   10.00,    1.00,    0.20},  // taken_block
    {  123.3,   101.8,   155.4,   83.29,    0.00,   36.24,    4.25,    1.03},  // covered_block
    {  148.2,   142.6,   191.4,  130.79,    0.00,   48.74,    2.78,    0.66},  // facing_block
    {  440.4,   414.0,   513.9,  371.28,    0.00,   83.51,   27.84,    2.37},  // open_pixel
    {   61.3,    50.1,    74.3,   39.90,    0.00,   14.84,    1.14,    0.57},  // changed_block
}};

}  // namespace gridiron::sim
