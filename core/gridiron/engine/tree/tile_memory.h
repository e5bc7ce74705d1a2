// What a tile of eye rays is made in: nearest hits, block by block, triangles that wait for their pixels, children that
// wait to be visited. Nothing here grows with the number of triangles that survive.
// Source: own; core/TREE.md. Memory: is the memory. Threads: one core. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/records.h>
#include <gridiron/base/tree_records.h>

#include <cstdint>

namespace gridiron {

inline constexpr std::uint32_t kBlockWidth = 4;  ///< pixels along a block's edge
inline constexpr std::uint32_t kBlockPixels = kBlockWidth * kBlockWidth;

/// Triangles of the queue, word by word.
enum TileWord : unsigned {
  kCornerX,  ///< three corners: column w, row w, w
  kCornerY = 3,
  kCornerW = 6,
  kCornerError = 9,  ///< of a corner's coordinate
  kPixelBox,         ///< first column and row, last column and row, a byte each
  kRecord,           ///< number of its record in the tree
  kTriangleId,
  kNormal,                ///< unit normal, with Shading::kSimple
  kVertex = kNormal + 3,  ///< three vertices in world space, where distances are asked for
  kTileWords = kVertex + 9
};

/// Functions of the pixel of triangles that are drawn: value at the offset, then per column and per row.
enum TileFunction : unsigned {
  kEdgeValue,  ///< three edges: not negative where the triangle may be
  kEdgeX = 3,
  kEdgeY = 6,
  kNearValue = 9,  ///< 1 / t or a little less
  kNearX,
  kNearY,
  kOffsetX,  ///< pixel of the tile that functions are relative to
  kOffsetY,
  kEdgeSpan,  ///< above it an edge's value is surely positive
  kNearSpan,  ///< 1 / t is less than this above its function
  kTileFunctions
};

/// @tparam Width      pixels along a tile's edge: 8, 16, 32, 64.
/// @tparam MostLanes  that work in it: 4, 8, 16.
template <std::uint32_t Width, std::uint32_t MostLanes = 16>
struct alignas(128) TileMemory {
  static constexpr std::uint32_t kWidth = Width;
  static constexpr std::uint32_t kBlocksPerRow = Width / kBlockWidth;
  static constexpr std::uint32_t kBlocks = kBlocksPerRow * kBlocksPerRow;
  static constexpr std::uint32_t kMostLanes = MostLanes;
  static constexpr std::uint32_t kQueueEntries = 2 * MostLanes;
  static constexpr std::uint32_t kStackEntries = (kTreeWidth - 1) * kMaxTreeDepth + 1;

  alignas(64) float near[kBlocks][kBlockPixels];            ///< 1 / t of the nearest hit so far, or a little less
  alignas(64) std::uint32_t id[kBlocks][kBlockPixels];      ///< its triangle
  alignas(64) std::uint32_t record[kBlocks][kBlockPixels];  ///< and where this lies in the tree
  alignas(64) float facing[kBlocks][kBlockPixels];          ///< |normal . direction| of the hit, with Shading::kSimple
  alignas(64) float distance[kBlocks][kBlockPixels];        ///< t of the hit, rounded, where distances are asked for
  alignas(64) float least_near[kBlocks];                    ///< least of a block's pixels
  alignas(64) float span[kBlocks];  ///< 1 / t of a block's hits is less than this above what stands there

  // Directions of pixels are sums of a term of their column and one of their row, as FrameHead rounds them.
  alignas(64) float column_direction[3][Width];
  alignas(64) float row_direction[3][Width];

  alignas(64) std::uint32_t queue[kTileWords][kQueueEntries];
  alignas(64) float functions[kTileFunctions][kMostLanes];
  alignas(64) std::uint32_t boxes[kMostLanes];
  alignas(64) std::uint32_t records[kMostLanes];
  alignas(64) std::uint32_t ids[kMostLanes];

  std::uint32_t stack[kStackEntries];  ///< TreeChild::bits
  float stack_w[kStackEntries];        ///< no corner in it has a lesser w
  float stack_size[kStackEntries];     ///< largest extent of its box
};

}  // namespace gridiron
