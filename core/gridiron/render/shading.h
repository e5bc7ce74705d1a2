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
  const bool simple = frame.shading == static_cast<std::uint32_t>(Shading::kSimple);
  const bool wants_depth = frame.depth_address != 0;
  work.add(simple ? Work::kShadedSimpleGroup : Work::kShadedGroup, PacketType::kRayCount / L::kCount);

  for (std::uint32_t first = 0; first < PacketType::kRayCount; first += kSubpacketRays) {
    alignas(64) float length[kSubpacketRays] = {};
    if (simple || wants_depth) {
      for (std::uint32_t i = 0; i < kSubpacketRays; ++i) {
        const float d_x = packet.dir[0][first + i], d_y = packet.dir[1][first + i], d_z = packet.dir[2][first + i];
        length[i] = square_root((d_x * d_x + d_y * d_y) + d_z * d_z);
      }
    }
    const std::uint32_t first_pixel =
        (y + PacketType::row_of(first)) * frame.tile_width + x + PacketType::column_of(first);
    for (std::uint32_t i = 0; i < kSubpacketRays; ++i) {
      const std::uint32_t ray = first + i;
      const std::uint32_t pixel = first_pixel + i / kSubpacketWidth * frame.tile_width + i % kSubpacketWidth;
      const bool hit = packet.id[ray] != kNoTriangle;
      const std::uint32_t lit = simple ? grey(packet.facing[ray] / length[i]) : 0xFFFFFFFFu;
      output.color[pixel] = hit ? lit : frame.background_rgba;
      if (wants_depth) output.depth[pixel] = hit ? packet.t[ray] * length[i] : kFloatMax;
      if (frame.id_address != 0) output.id[pixel] = packet.id[ray];
    }
  }
}

}  // namespace gridiron
