// Shading: turns the hits of a packet into pixels of a tile.
// Source: Cho, Kim, Han 2012, section 6.1 (no shading, simple shading). Memory: the local store. Threads: one core.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/lanes.h>
#include <gridiron/base/records.h>
#include <gridiron/base/work_counters.h>
#include <gridiron/ray/packet.h>

#include <cstdint>

namespace gridiron {

/// Opaque grey of brightness [0, 1] as 0xAABBGGRR.
[[nodiscard]] GRIDIRON_INLINE std::uint32_t grey(float brightness) {
  const float scaled = brightness * 255.0f + 0.5f;
  const std::uint32_t level = scaled < 255.0f ? static_cast<std::uint32_t>(scaled) : 255u;
  return 0xFF000000u | (level << 16) | (level << 8) | level;
}

/// Writes a packet's pixels into a tile.
///
/// @param x, y    the packet's first pixel inside the tile.
/// @param output  a LocalStore::TileOutput. Depth and ids are written only where the frame wants them.
template <class L, class PacketType, class TileOutput>
void shade_packet(const FrameRecord& frame, const PacketType& packet, std::uint32_t x, std::uint32_t y,
                  TileOutput& output, WorkCounters& work) {
  constexpr std::uint32_t kWidth = PacketType::kWidth;
  const bool simple = frame.shading == static_cast<std::uint32_t>(Shading::kSimple);
  work.add(simple ? Work::kShadedSimpleGroup : Work::kShadedGroup, PacketType::kRayCount / L::kCount);

  alignas(64) float length[PacketType::kRayCount];
  if (simple || frame.depth_address != 0) {
    for (std::uint32_t i = 0; i < PacketType::kRayCount; ++i) {
      length[i] = square_root((packet.dir[0][i] * packet.dir[0][i] + packet.dir[1][i] * packet.dir[1][i]) +
                              packet.dir[2][i] * packet.dir[2][i]);
    }
  }
  for (std::uint32_t row = 0; row < kWidth; ++row) {
    const std::uint32_t first_ray = row * kWidth;
    const std::uint32_t first_pixel = (y + row) * frame.tile_width + x;
    for (std::uint32_t i = 0; i < kWidth; ++i) {
      const std::uint32_t ray = first_ray + i;
      const bool hit = packet.id[ray] != kNoTriangle;
      const std::uint32_t lit = simple ? grey(packet.facing[ray] / length[ray]) : 0xFFFFFFFFu;
      output.color[first_pixel + i] = hit ? lit : frame.background_rgba;
    }
    if (frame.depth_address != 0) {
      for (std::uint32_t i = 0; i < kWidth; ++i) {
        const std::uint32_t ray = first_ray + i;
        output.depth[first_pixel + i] = packet.id[ray] != kNoTriangle ? packet.t[ray] * length[ray] : kFloatMax;
      }
    }
    if (frame.id_address != 0) {
      for (std::uint32_t i = 0; i < kWidth; ++i) output.id[first_pixel + i] = packet.id[first_ray + i];
    }
  }
}

}  // namespace gridiron
