// Untile: pictures out of the chip's tile-major output planes.
// Memory: std::vector. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/records.h>
#include <gridiron/frame/frame_setup.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>

#include "base/numbers.h"
#include "files/image_files.h"

namespace gridiron::tool {

/// Reads a plane of a frame, or one tile of it.
///
/// @param plane    tile-major, output_plane_bytes() of the frame; one 32-bit word a pixel.
/// @param tile     column and row of the tile to read, clipped to the frame; nothing: the whole frame.
/// @param convert  turns the 32 bits of a pixel into its value.
template <class Pixel, class Convert>
[[nodiscard]] Picture<Pixel> untile(const FrameRecord& frame, std::span<const std::byte> plane,
                                    std::optional<CountPair> tile, Convert convert) {
  const std::uint32_t first_x = tile ? tile->x * frame.tile_width : 0;
  const std::uint32_t first_y = tile ? tile->y * frame.tile_width : 0;
  Picture<Pixel> picture;
  picture.width = tile ? std::min(frame.tile_width, frame.width - first_x) : frame.width;
  picture.height = tile ? std::min(frame.tile_width, frame.height - first_y) : frame.height;
  picture.pixels.reserve(std::size_t{picture.width} * picture.height);
  for (std::uint32_t y = first_y; y < first_y + picture.height; ++y) {
    for (std::uint32_t x = first_x; x < first_x + picture.width; ++x) {
      std::uint32_t word = 0;
      const std::uint64_t index = output_plane_index(frame.width, frame.tile_width, x, y);
      std::memcpy(&word, plane.data() + index * sizeof word, sizeof word);
      picture.pixels.push_back(convert(word));
    }
  }
  return picture;
}

}  // namespace gridiron::tool
