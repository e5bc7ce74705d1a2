// Frame pictures: planes of a frame as pictures, of the whole frame or of one tile.
// Memory: std::vector. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/records.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>

#include "base/numbers.h"
#include "files/image_files.h"

namespace gridiron::tool {

/// Reads a plane of a frame, or one tile of it: colours 0xAABBGGRR, bits of distances, triangle ids.
///
/// @param plane  tile-major, output_plane_bytes() of the frame; one 32-bit word a pixel.
/// @param tile   column and row of the tile to read, clipped to the frame; nothing: the whole frame.
[[nodiscard]] Picture<std::uint32_t> words_of_plane(const FrameRecord& frame, std::span<const std::byte> plane,
                                                    std::optional<CountPair> tile = std::nullopt);

/// @param words  of a plane of distances. @returns them as floats, +inf without a hit.
[[nodiscard]] Picture<float> depth_picture(const Picture<std::uint32_t>& words);

/// @param words  of a plane of triangle ids. @returns them as floats, -1 without a hit.
[[nodiscard]] Picture<float> id_picture(const Picture<std::uint32_t>& words);

/// Hashes of the planes of a frame; 0 for a plane that it does not have.
struct PlaneHashes {
  std::uint64_t color = 0, depth = 0, ids = 0;

  friend bool operator==(const PlaneHashes&, const PlaneHashes&) = default;
};

/// Errors: Failure (kCheckFailed) if a repeated frame has other planes than the first one. @param repeat  its number,
/// from 1.
void require_same_planes(const PlaneHashes& first, const PlaneHashes& again, std::uint32_t repeat);

/// Errors: Failure (kBadInput) if a scene has more triangles than the floats of a PFM file can distinguish.
void require_exact_ids(const std::filesystem::path& input, std::uint64_t triangle_count);

}  // namespace gridiron::tool
