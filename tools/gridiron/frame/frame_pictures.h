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

/// The words of a plane as they stand: colours 0xAABBGGRR, bits of distances, triangle ids. Parameters: those of
/// untile().
[[nodiscard]] Picture<std::uint32_t> words_of_plane(const FrameRecord& frame, std::span<const std::byte> plane,
                                                    std::optional<CountPair> tile = std::nullopt);

/// @param words  of a plane of distances. @returns them as floats, +inf where nothing is hit.
[[nodiscard]] Picture<float> depth_picture(const Picture<std::uint32_t>& words);

/// @param words  of a plane of triangle ids. @returns them as floats, -1 where nothing is hit.
[[nodiscard]] Picture<float> id_picture(const Picture<std::uint32_t>& words);

/// Of the planes of a frame; 0 of one that it does not have.
struct PlaneHashes {
  std::uint64_t color = 0, depth = 0, ids = 0;

  friend bool operator==(const PlaneHashes&, const PlaneHashes&) = default;
};

/// Errors: Failure (kCheckFailed) where a frame that was rendered again has other planes than the first time.
/// @param repeat  which time, from 1.
void require_same_planes(const PlaneHashes& first, const PlaneHashes& again, std::uint32_t repeat);

/// Errors: Failure (kBadInput) where a scene has more triangles than floats of a PFM file tell apart.
void require_exact_ids(const std::filesystem::path& input, std::uint64_t triangle_count);

}  // namespace gridiron::tool
