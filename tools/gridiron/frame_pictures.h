// Frame pictures: planes of a frame as pictures, of the whole frame or of one tile.
// Memory: std::vector. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/records.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>

#include "image_files.h"
#include "numbers.h"

namespace gridiron::tool {

/// The words of a plane as they stand: colours 0xAABBGGRR, bits of distances, triangle ids. Parameters: those of
/// untile().
[[nodiscard]] Picture<std::uint32_t> words_of_plane(const FrameRecord& frame, std::span<const std::byte> plane,
                                                    std::optional<CountPair> tile = std::nullopt);

/// @param words  of a plane of distances. @returns them as floats, +inf where nothing is hit.
[[nodiscard]] Picture<float> depth_picture(const Picture<std::uint32_t>& words);

/// @param words  of a plane of triangle ids. @returns them as floats, -1 where nothing is hit.
[[nodiscard]] Picture<float> id_picture(const Picture<std::uint32_t>& words);

/// Errors: Failure (kBadInput) where a scene has more triangles than floats of a PFM file tell apart.
void require_exact_ids(const std::filesystem::path& input, std::uint64_t triangle_count);

}  // namespace gridiron::tool
