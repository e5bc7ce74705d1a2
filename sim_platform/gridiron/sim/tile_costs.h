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
    { 1395.2,  1381.3,  1439.2,  265.33,  174.00,   50.89,    9.00,    4.00},  // tile_view
    {   28.4,    27.8,    35.0,    6.91,    0.00,   13.51,    4.08,    0.79},  // cleared_block
    {   78.6,    77.2,   105.9,   77.24,    0.00,   28.48,    0.45,    0.00},  // box_group
    {  235.3,   168.4,   277.3,  119.30,    0.00,   66.75,   17.26,    2.73},  // child
    {  168.0,   179.2,   185.2,   35.18,   24.00,    6.00,    0.00,    0.00},  // leaf
    {  244.2,   236.5,   323.5,  231.40,    0.00,   87.01,    1.00,    0.28},  // corner_group
    {  113.0,   107.9,   171.1,   62.63,    0.00,  102.24,    2.79,    0.31},  // kept_group
    {  196.3,   135.0,   242.0,  102.17,    0.00,   62.78,    3.00,    1.82},  // normal_group
    {  357.5,   343.2,   393.0,  329.97,    0.00,   45.38,    5.23,    0.74},  // function_group
    {   76.8,    70.9,    87.4,   48.32,    0.00,   12.03,    4.99,    1.25},  // tiny_place
    {   43.7,    41.7,    56.1,   32.23,    0.00,   12.92,    1.88,    0.53},  // tiny_pixel
    {   79.0,    77.5,   111.8,   71.43,    0.00,   32.98,    1.84,    0.34},  // drawn
    {   83.5,    76.0,    91.8,   65.97,    0.00,   11.33,    1.51,    0.55},  // block_group
    {  209.2,   183.9,   234.2,  141.35,    0.00,   32.65,   10.76,    2.36},  // block
    {  271.1,   209.2,   315.8,  107.10,    0.00,   57.75,   11.36,    5.67},  // covered_block
    {  193.3,   130.3,   225.1,   77.47,    0.00,   52.49,    6.60,    2.94},  // facing_block
    {  458.6,   425.6,   522.1,  385.33,    0.00,   74.69,   29.17,    2.24},  // open_pixel
    {   60.2,    53.6,    76.2,   41.31,    0.00,   15.08,    1.36,    0.68},  // changed_block
}};

}  // namespace gridiron::sim
