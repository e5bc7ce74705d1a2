// A small animated mesh: a sheet with waves that run across it, the same floats on every device and host.
// Memory: caller's. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/math.h>

#include <cstdint>

namespace gridiron::port {

inline constexpr std::uint32_t kWaveQuads = 32;  ///< along an edge of the sheet
inline constexpr std::uint32_t kWaveVertexCount = (kWaveQuads + 1) * (kWaveQuads + 1);
inline constexpr std::uint32_t kWaveTriangleCount = 2 * kWaveQuads * kWaveQuads;
inline constexpr std::uint32_t kWaveFrames = 16;  ///< after which the animation begins anew

/// Place of a vertex: x and z in -1..1, y up to 1/2. Multiples of 2^-9, so nothing is rounded.
[[nodiscard]] inline Vec3 wave_vertex(std::uint32_t index, std::uint32_t frame) {
  const std::uint32_t column = index % (kWaveQuads + 1), row = index / (kWaveQuads + 1);
  // Parabolas, 16 columns long, moved by one column a frame and by one for every second row.
  const auto phase = static_cast<float>((column + row / 2 + frame) % kWaveFrames);
  constexpr float kHalf = kWaveQuads / 2.0f;
  return {static_cast<float>(column) / kHalf - 1.0f, phase * (16.0f - phase) / 128.0f,
          static_cast<float>(row) / kHalf - 1.0f};
}

/// Corners of a triangle, counter-clockwise seen from above.
[[nodiscard]] inline UVec3 wave_triangle(std::uint32_t index) {
  const std::uint32_t quad = index / 2;
  const std::uint32_t corner = quad / kWaveQuads * (kWaveQuads + 1) + quad % kWaveQuads;
  const std::uint32_t below = corner + kWaveQuads + 1;
  return index % 2 == 0 ? UVec3{corner, below, corner + 1} : UVec3{corner + 1, below, below + 1};
}

}  // namespace gridiron::port
