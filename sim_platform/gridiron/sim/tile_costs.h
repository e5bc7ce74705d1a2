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
    { 2270.7,  2256.9,  2504.6,  650.89,  255.00,  240.67,   10.00,    4.22},  // tile_view
    {   28.4,    27.8,    35.0,    6.91,    0.00,   13.51,    4.08,    0.79},  // cleared_block
    {   85.9,    84.2,   113.9,   84.23,    0.00,   29.49,    0.45,    0.00},  // box_group
    {  199.7,   138.4,   240.9,  103.27,    0.00,   65.59,   12.41,    1.95},  // child
    {  170.4,   184.2,   190.2,   40.18,   24.00,    6.00,    0.00,    0.00},  // leaf
    {  208.0,   200.2,   287.9,  191.76,    0.00,   87.74,    1.73,    0.47},  // corner_group
    {  118.7,   113.7,   178.6,   64.33,    0.00,  104.04,    3.69,    0.54},  // kept_group
    {  203.0,   141.5,   249.0,  104.05,    0.00,   63.34,    4.02,    2.08},  // normal_group
    {  370.3,   360.0,   414.1,  336.91,    0.00,   49.84,    6.32,    1.28},  // function_group
    {   69.8,    64.6,    78.5,   43.63,    0.00,    9.45,    3.97,    1.17},  // tiny_place
    {   44.9,    43.0,    58.5,   33.84,    0.00,   14.48,    2.36,    0.51},  // tiny_pixel
    {  105.2,   103.8,   141.7,   97.74,    0.00,   36.55,    1.84,    0.34},  // drawn
    {   78.9,    76.7,    84.5,   66.82,    0.00,    6.12,    1.51,    0.55},  // block_group
    {  158.0,   141.8,   181.2,  112.72,    0.00,   24.91,    6.54,    1.62},  // block
    {  178.9,   150.1,   221.9,  114.08,    0.00,   45.27,    8.20,    2.00},  // covered_block
    {  155.0,   151.8,   203.1,  122.58,    0.00,   51.21,    2.77,    1.63},  // facing_block
    {  444.8,   413.7,   507.7,  376.67,    0.00,   73.80,   28.26,    2.05},  // open_pixel
    {   64.5,    51.9,    77.4,   40.01,    0.00,   15.01,    1.17,    0.66},  // changed_block
}};

}  // namespace gridiron::sim
