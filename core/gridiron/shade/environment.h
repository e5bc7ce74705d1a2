// The environment: which texels a direction sees, and their colour.
// Source: core/EFFECTS.md, "Environment". Memory: values; blocks are borrowed. Threads: any.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/effect_records.h>
#include <gridiron/base/lanes.h>
#include <gridiron/shade/vectors.h>

#include <cstdint>

namespace gridiron {

/// A bilinear patch of four texels, and a place in it.
struct EnvironmentPlace {
  std::uint32_t face;                     ///< 0..5: +x -x +y -y +z -z
  std::uint32_t block_column, block_row;  ///< below environment_blocks(width)
  std::uint32_t column, row;              ///< where the patch begins in its block, below kEnvironmentPatches
  float column_part, row_part;            ///< the place between its texels, [0, 1]
};

/// @returns a place along a face's edge in texels, from the middle of the first to that of the last.
/// @param ratio  of the edge, -1..1. @param width  texels, 1..kMaxEnvironmentWidth.
[[nodiscard]] inline float face_texel(float ratio, std::uint32_t width) {
  const float count = static_cast<float>(static_cast<std::int32_t>(width));
  const float place = (ratio + 1.0f) * 0.5f * count - 0.5f;
  const float from_first = place > 0.0f ? place : 0.0f;
  return from_first < count - 1.0f ? from_first : count - 1.0f;
}

/// @param direction  of any length; the zero vector sees the middle of face 0. Precondition: no component is NaN or
///                   infinite. Where a core flushes denormals, such components count as 0.
/// @param width      texels of a face's edge, 1..kMaxEnvironmentWidth.
/// @returns a place whose four texels are in its block.
[[nodiscard]] inline EnvironmentPlace environment_place(Vector3 direction, std::uint32_t width) {
  const float x = direction.x, y = direction.y, z = direction.z;
  const float size_x = magnitude(x), size_y = magnitude(y), size_z = magnitude(z);
  const bool is_x = size_x >= size_y && size_x >= size_z;
  const bool is_y = !is_x && size_y >= size_z;
  const float along = is_x ? x : is_y ? y : z;
  const bool is_negative = along < 0.0f;
  // right: z -z x x -x x; up: y y z -z y y.
  const float across = is_x ? z : x;
  const float right = is_y || (is_x != is_negative) ? across : -across;
  const float up = is_y ? (is_negative ? -z : z) : y;
  const float size = magnitude(along);
  const float to_face = size > 0.0f ? size : 1.0f;

  const float column = face_texel(right / to_face, width);
  const float row = face_texel(-(up / to_face), width);
  // The last texel is the end of the patch before it.
  const std::int32_t last_patch = width >= 2 ? static_cast<std::int32_t>(width) - 2 : std::int32_t{0};
  const auto truncated_column = static_cast<std::int32_t>(column), truncated_row = static_cast<std::int32_t>(row);
  const std::int32_t patch_column = truncated_column < last_patch ? truncated_column : last_patch;
  const std::int32_t patch_row = truncated_row < last_patch ? truncated_row : last_patch;

  EnvironmentPlace place;
  place.face = (is_x ? 0u : is_y ? 2u : 4u) + (is_negative ? 1u : 0u);
  place.block_column = static_cast<std::uint32_t>(patch_column) / kEnvironmentPatches;
  place.block_row = static_cast<std::uint32_t>(patch_row) / kEnvironmentPatches;
  place.column = static_cast<std::uint32_t>(patch_column) - place.block_column * kEnvironmentPatches;
  place.row = static_cast<std::uint32_t>(patch_row) - place.block_row * kEnvironmentPatches;
  place.column_part = column - static_cast<float>(patch_column);
  place.row_part = row - static_cast<float>(patch_row);
  return place;
}

/// Index of a place's block among all of the environment's. @param blocks  environment_blocks(width).
[[nodiscard]] inline std::uint32_t environment_block_index(const EnvironmentPlace& place, std::uint32_t blocks) {
  return (place.face * blocks + place.block_row) * blocks + place.block_column;
}

/// The bilinear colour at a place of this block: between those of its four texels, to rounding.
[[nodiscard]] inline Vector3 lookup(const EnvironmentBlock& block, const EnvironmentPlace& place) {
  const auto along_row = [&](std::uint32_t row) {
    const auto& texels = block.texels[row];
    return (1.0f - place.column_part) * vector_of(texels[place.column]) +
           place.column_part * vector_of(texels[place.column + 1]);
  };
  return (1.0f - place.row_part) * along_row(place.row) + place.row_part * along_row(place.row + 1);
}

}  // namespace gridiron
