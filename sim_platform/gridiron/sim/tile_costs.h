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
    {  723.6,   721.6,   903.2,  435.56,   44.00,  181.67,    5.00,    1.22},  // tile_view
    {   10.6,     9.8,    18.0,    8.04,    0.00,    9.51,    0.06,    0.02},  // cleared_block
    {   69.7,    69.2,    99.1,   69.25,    0.00,   29.50,    0.45,    0.00},  // box_group
    {  148.0,   113.9,   188.2,   99.75,    0.00,   44.96,    9.69,    0.79},  // child
    {  170.2,   184.1,   191.1,   40.07,   24.00,    7.00,    0.00,    0.00},  // leaf
    {  175.1,   168.1,   256.7,  162.49,    0.00,   88.57,    1.24,    0.31},  // corner_group
    {   73.2,    70.4,    99.6,   26.57,    0.00,   65.38,    3.05,    0.28},  // kept_group
    {  171.1,   112.6,   199.1,   80.68,    0.00,   39.69,    3.29,    1.77},  // normal_group
    {  309.2,   301.8,   390.9,  286.27,    0.00,   85.54,    4.29,    0.86},  // function_group
    {   38.3,    39.1,    45.2,   29.46,    0.00,    6.10,    1.25,    0.54},  // tiny_place
    {   58.0,    48.9,    74.7,   42.37,    0.00,   21.84,    4.06,    0.36},  // tiny_pixel
    {   53.7,    47.7,    77.8,   47.65,    0.00,   30.14,    1.00,    0.00},  // drawn
    {  125.9,   125.8,   129.9,  102.82,    0.00,    4.13,    1.27,    1.27},  // large_triangle
    {   55.7,    47.2,    58.6,   35.68,    0.00,    4.07,    1.60,    0.64},  // block_group
    {   79.8,    79.8,    86.3,   65.14,    0.00,    5.80,    1.59,    0.81},  // block
    {   74.9,    71.7,   106.1,   65.90,    0.00,   32.84,    2.70,    0.32},  // taken_block
    {   91.5,    86.2,   124.7,   83.31,    0.00,   36.25,    4.25,    0.16},  // covered_block
    {  138.5,   132.5,   181.0,  123.24,    0.00,   48.46,    2.51,    0.52},  // facing_block
    {  440.2,   414.0,   513.6,  371.25,    0.00,   83.49,   27.84,    2.37},  // open_pixel
    {   61.3,    50.1,    74.3,   39.90,    0.00,   14.84,    1.14,    0.57},  // changed_block
}};

}  // namespace gridiron::sim
