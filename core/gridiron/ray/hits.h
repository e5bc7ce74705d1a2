// The hits of the eye rays of a tile, pixel by pixel: engines write them, shading reads them.
// Memory: borrowed, inside the local store. Threads: one core. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace gridiron {

/// A tile of the picture, and the point of its pixels that rays go through.
struct TileView {
  std::uint32_t left, top;  ///< its first pixel
  float dx, dy;             ///< from the pixels' centres, in pixels: multiples of 1/32 within a half
};

/// Planes of a tile, row-major, tile_width pixels a row, 128-byte aligned. A null plane is not written.
/// facing may share its memory with the plane of colours.
struct Hits {
  std::uint32_t* id;  ///< triangle_id, kNoTriangle without a hit; never null
  float* distance;    ///< along the direction taken with length 1, kFloatMax where nothing is hit
  float* facing;      ///< |normal . direction|, both of length 1; any number of [0, 1] where nothing is hit
};

}  // namespace gridiron
