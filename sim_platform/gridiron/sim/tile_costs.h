// What a unit of each kind of work of tiles of eye rays through the tree costs on a core of two in-order pipes. Written
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
    { 2289.2,  2258.9,  2506.4,  652.89,  255.00,  237.56,   10.00,    4.22},  // tile_view
    {   28.4,    27.8,    35.0,    6.91,    0.00,   13.51,    4.08,    0.79},  // cleared_block
    {   79.1,    77.2,   105.9,   77.23,    0.00,   28.49,    0.45,    0.00},  // box_group
    {  192.3,   137.4,   231.4,  102.27,    0.00,   57.44,   12.41,    1.95},  // child
    {  168.0,   179.2,   185.2,   35.18,   24.00,    6.00,    0.00,    0.00},  // leaf
    {  247.5,   241.2,   328.9,  232.76,    0.00,   87.74,    1.73,    0.47},  // corner_group
    {  118.3,   112.7,   177.6,   64.33,    0.00,  103.04,    3.69,    0.54},  // kept_group
    {  203.0,   141.5,   249.0,  104.05,    0.00,   63.38,    4.02,    2.08},  // normal_group
    {  367.7,   356.0,   408.1,  332.91,    0.00,   47.83,    6.32,    1.28},  // function_group
    {   71.4,    65.5,    81.5,   42.86,    0.00,   10.94,    4.97,    1.26},  // tiny_place
    {   44.1,    41.8,    56.8,   32.95,    0.00,   13.55,    1.91,    0.49},  // tiny_pixel
    {   86.0,    83.9,   121.3,   77.78,    0.00,   36.13,    1.84,    0.34},  // drawn
    {   70.9,    67.9,    75.7,   57.97,    0.00,    6.12,    1.51,    0.55},  // block_group
    {  168.8,   153.4,   195.5,  124.28,    0.00,   27.93,    6.54,    1.62},  // block
    {  180.2,   151.6,   230.8,  115.59,    0.00,   52.62,    8.20,    2.00},  // covered_block
    {  158.3,   118.8,   183.4,   65.73,    0.00,   40.32,    6.60,    2.95},  // facing_block
    {  442.8,   410.9,   505.7,  374.04,    0.00,   73.56,   28.05,    2.05},  // open_pixel
    {   64.5,    51.9,    77.4,   40.01,    0.00,   15.01,    1.17,    0.66},  // changed_block
}};

}  // namespace gridiron::sim
