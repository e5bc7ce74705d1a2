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
    {  746.6,   736.6,   931.2,  450.56,   44.00,  190.67,    7.00,    1.22},  // tile_view
    {   10.5,     9.8,    17.9,    8.04,    0.00,    9.49,    0.06,    0.02},  // cleared_block
    {   70.3,    69.2,    99.3,   69.25,    0.00,   29.50,    0.45,    0.00},  // box_group
    {  143.8,   109.9,   182.4,   96.86,    0.00,   44.85,    8.63,    0.72},  // child
    {  169.6,   184.1,   191.1,   40.07,   24.00,    7.00,    0.00,    0.00},  // leaf
    {  174.0,   168.1,   256.7,  162.49,    0.00,   88.57,    1.24,    0.31},  // corner_group
    {   74.6,    70.4,    99.5,   26.57,    0.00,   65.38,    3.05,    0.28},  // kept_group
    {  174.4,   112.6,   199.0,   80.68,    0.00,   39.69,    3.29,    1.77},  // normal_group
    {  279.8,   272.0,   330.5,  265.01,    0.00,   56.99,    3.81,    0.39},  // function_group
    {   38.8,    39.5,    45.6,   29.77,    0.00,    6.03,    1.26,    0.54},  // tiny_place
    {   52.5,    46.1,    64.8,   36.94,    0.00,   16.25,    3.34,    0.51},  // tiny_pixel
    {   81.6,    77.3,   107.0,   73.21,    0.00,   29.69,    1.22,    0.22},  // drawn
    {   54.9,    47.2,    58.1,   35.69,    0.00,    4.14,    1.60,    0.64},  // block_group
    {  103.3,   102.1,   121.5,   88.55,    0.00,   18.14,    2.56,    0.75},  // block
    {  123.2,   101.8,   155.4,   83.29,    0.00,   36.24,    4.25,    1.03},  // covered_block
    {  148.2,   142.6,   191.4,  130.79,    0.00,   48.75,    2.78,    0.66},  // facing_block
    {  420.6,   398.0,   485.8,  360.48,    0.00,   73.12,   27.33,    2.09},  // open_pixel
    {   61.3,    50.1,    74.3,   39.90,    0.00,   14.84,    1.14,    0.57},  // changed_block
}};

}  // namespace gridiron::sim
