// Kinds of work that only tiles of eye rays through the tree have. Memory: none. Threads: any.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/work_counters.h>

#include <cstdint>

namespace gridiron {

/// Counted like Work, and numbered behind it.
enum class TileWork : std::uint8_t {
  kFirst = kSharedWorkCount,
  kView = kFirst,  ///< tiles whose projection was set up (initialisation)
  kClearedBlock,   ///< blocks of pixels cleared (initialisation)
  kBoxGroup,       ///< SIMD groups of a node's boxes tested against the tile
  kChild,          ///< children put in order, and visited or left out behind all hits
  kLeaf,           ///< leaves visited: their first corner projected in double
  kCornerGroup,    ///< SIMD groups of triangles projected, and culled by boxes of pixels
  kKeptGroup,      ///< of these, groups with triangles that wait for their pixels
  kNormalGroup,    ///< of these, groups whose unit normals were computed
  kFunctionGroup,  ///< SIMD groups of triangles whose edges and 1 / t became functions of the pixel
  kTinyPlace,      ///< pixels of groups of tiny triangles tested, one of each triangle at once
  kTinyPixel,      ///< pixels of tiny triangles that were hit, compared with what was there
  kDrawn,          ///< triangles drawn block by block
  kLargeTriangle,  ///< of these, triangles whose blocks were tested in groups first
  kBlockGroup,     ///< SIMD groups of blocks tested against a large triangle
  kBlock,          ///< blocks tested pixel by pixel
  kTakenBlock,     ///< of these, blocks with pixels that the triangle may be first in
  kCoveredBlock,   ///< blocks inside a triangle, of which only 1 / t was compared
  kFacingBlock,    ///< blocks whose hits' angle to the triangle was computed
  kOpenPixel,      ///< pixels that floats left open, decided exactly
  kChangedBlock,   ///< blocks whose least 1 / t was sought again
  kEnd
};

inline constexpr std::uint32_t kTileWorkCount =
    static_cast<std::uint32_t>(TileWork::kEnd) - static_cast<std::uint32_t>(TileWork::kFirst);

}  // namespace gridiron
