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
    {  148.3,   113.9,   188.3,   99.75,    0.00,   44.96,    9.69,    0.79},  // child
    {  170.2,   184.1,   191.1,   40.07,   24.00,    7.00,    0.00,    0.00},  // leaf
    {  174.7,   168.1,   256.7,  162.49,    0.00,   88.57,    1.24,    0.31},  // corner_group
    {   73.5,    70.4,    99.5,   26.57,    0.00,   65.38,    3.05,    0.28},  // kept_group
    {  174.4,   112.6,   199.0,   80.68,    0.00,   39.69,    3.29,    1.77},  // normal_group
    {  278.3,   272.0,   330.6,  265.01,    0.00,   56.99,    3.81,    0.39},  // function_group
    {   38.7,    39.5,    45.6,   29.77,    0.00,    6.03,    1.26,    0.54},  // tiny_place
    {   52.4,    46.1,    64.8,   36.94,    0.00,   16.24,    3.34,    0.51},  // tiny_pixel
    {   59.4,    55.1,    84.0,   55.06,    0.00,   28.93,    1.00,    0.00},  // drawn
    {  125.9,   125.8,   129.9,  102.82,    0.00,    4.13,    1.27,    1.27},  // large_triangle
    {   54.9,    47.2,    58.1,   35.69,    0.00,    4.14,    1.60,    0.64},  // block_group
    {   70.2,    70.1,    76.6,   65.05,    0.00,    5.61,    1.59,    0.28},  // block
    {   92.2,    89.7,   123.4,   65.90,    0.00,   32.84,    2.70,    1.32},  // taken_block
    {  123.3,   101.8,   155.4,   83.31,    0.00,   36.25,    4.25,    1.03},  // covered_block
    {  138.5,   132.5,   181.0,  123.24,    0.00,   48.46,    2.51,    0.52},  // facing_block
    {  440.4,   414.0,   513.9,  371.28,    0.00,   83.51,   27.84,    2.37},  // open_pixel
    {   61.3,    50.1,    74.3,   39.90,    0.00,   14.84,    1.14,    0.57},  // changed_block
}};

}  // namespace gridiron::sim
