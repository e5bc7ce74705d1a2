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

/// Opaque grey of brightness [0, 1] as 0xAABBGGRR; brighter is white.
template <class L>
[[nodiscard]] GRIDIRON_INLINE typename L::Int grey(typename L::Float brightness) {
  using Float = typename L::Float;
  const Float scaled = brightness * Float(255.0f) + Float(0.5f);
  const typename L::Int level = L::truncate(L::min(scaled, Float(255.0f)));
  return level | (level << 8) | (level << 16) | L::Int::splat(0xFF000000u);
}

/// @returns the lengths of the directions of the group of rays that begins at `base`.
template <class L, class PacketType>
[[nodiscard]] GRIDIRON_INLINE typename L::Float direction_lengths(const PacketType& packet, std::uint32_t base) {
  using Float = typename L::Float;
  const Float x = Float::load(packet.dir[0] + base);
  const Float y = Float::load(packet.dir[1] + base);
  const Float z = Float::load(packet.dir[2] + base);
  return L::square_root((x * x + y * y) + z * z);
}

/// Writes a packet's pixels into a tile; colours of frames that the scene shades are not among them.
///
/// @param x, y    the packet's first pixel inside the tile.
/// @param output  a LocalStore::TileOutput. Depth and ids are written only where the frame wants them.
template <class L, class PacketType, class TileOutput>
void shade_packet(const FrameRecord& frame, const PacketType& packet, std::uint32_t x, std::uint32_t y,
                  TileOutput& output, WorkCounters& work) {
  using Float = typename L::Float;
  using Int = typename L::Int;
  constexpr std::uint32_t kGroups = PacketType::kRayCount / L::kCount;
  // A group of lanes is one row of a subpacket, or several: one quad of pixels beneath the other.
  const auto for_each_group = [&](auto&& write) GRIDIRON_INLINE_LAMBDA {
    for (std::uint32_t first = 0; first < PacketType::kRayCount; first += kSubpacketRays) {
      const std::uint32_t first_pixel =
          (y + PacketType::row_of(first)) * frame.tile_width + x + PacketType::column_of(first);
      for (std::uint32_t i = 0; i < kSubpacketRays; i += L::kCount) {
        write(first + i, first_pixel + i / kSubpacketWidth * frame.tile_width);
      }
    }
  };
  const Int background = Int::splat(frame.background_rgba);
  if (frame.shading == static_cast<std::uint32_t>(Shading::kSimple)) {
    work.add(Work::kShadedSimpleGroup, kGroups);
    for_each_group([&](std::uint32_t base, std::uint32_t pixel) GRIDIRON_INLINE_LAMBDA {
      const Int lit = grey<L>(Float::load(packet.facing + base) / direction_lengths<L>(packet, base));
      const auto missed = L::equal(kNoTriangle, packet.id + base);
      L::store_quads(L::select(missed, background, lit), output.color + pixel, frame.tile_width);
    });
  } else if (frame.shading == static_cast<std::uint32_t>(Shading::kNone)) {
    work.add(Work::kShadedGroup, kGroups);
    const Int lit = Int::splat(0xFFFFFFFFu);
    for_each_group([&](std::uint32_t base, std::uint32_t pixel) GRIDIRON_INLINE_LAMBDA {
      const auto missed = L::equal(kNoTriangle, packet.id + base);
      L::store_quads(L::select(missed, background, lit), output.color + pixel, frame.tile_width);
    });
  }
  if (frame.depth_address != 0) {
    work.add(Work::kDepthGroup, kGroups);
    for_each_group([&](std::uint32_t base, std::uint32_t pixel) GRIDIRON_INLINE_LAMBDA {
      const Float depth = Float::load(packet.t + base) * direction_lengths<L>(packet, base);
      const auto missed = L::equal(kNoTriangle, packet.id + base);
      L::store_quads(L::select(missed, Float(kFloatMax), depth), output.depth + pixel, frame.tile_width);
    });
  }
  if (frame.id_address != 0) {
    work.add(Work::kIdGroup, kGroups);
    for_each_group([&](std::uint32_t base, std::uint32_t pixel) GRIDIRON_INLINE_LAMBDA {
      L::store_quads(Int::load(packet.id + base), output.id + pixel, frame.tile_width);
    });
  }
}

/// Writes the triangles that a packet's rays hit into a tile of ids.
template <class PacketType>
void keep_hits(const PacketType& packet, std::uint32_t x, std::uint32_t y, std::uint32_t tile_width, std::uint32_t* ids,
               WorkCounters& work) {
  using Four = Lanes<4>;
  work.add(Work::kIdGroup, PacketType::kRayCount / 4);
  work.charge_to(Work::kIdGroup);
  for (std::uint32_t ray = 0; ray < PacketType::kRayCount; ray += 4) {
    const std::uint32_t place = (y + PacketType::row_of(ray)) * tile_width + x + PacketType::column_of(ray);
    Four::store_quads(Four::Int::load(packet.id + ray), ids + place, tile_width);
  }
}

}  // namespace gridiron
