// Image structures: what a scene image holds for engines and effects, in bytes and in words.
// Memory: plain values. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/image/scene_image.h>

#include <cstdint>
#include <string>

namespace gridiron::tool {

/// Bytes of the sections of each structure; 0: the image does not hold it.
struct StructureBytes {
  std::uint64_t grid = 0, tree = 0, effects = 0;
};

/// @returns the bytes of a grid's sections.
[[nodiscard]] std::uint64_t bytes_of_grid(const GridRecord& grid);

[[nodiscard]] StructureBytes structures_of(const SceneImageView& view);

/// @returns "grid 1.20 MB (--configuration reference, deep, best), tree ..., effects ...", without those of 0 bytes.
[[nodiscard]] std::string words_of_structures(const StructureBytes& bytes);

}  // namespace gridiron::tool
