// Writes the hits of a packet into the planes of its tile.
// Memory: borrowed, inside the local store. Threads: one core. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/lanes.h>
#include <gridiron/base/records.h>
#include <gridiron/base/work_counters.h>
#include <gridiron/ray/hits.h>
#include <gridiron/ray/packet.h>

#include <cstdint>

namespace gridiron {

/// @returns the lengths of the directions of the group of rays that begins at `base`.
template <class L, class PacketType>
[[nodiscard]] GRIDIRON_INLINE typename L::Float direction_lengths(const PacketType& packet, std::uint32_t base) {
  using Float = typename L::Float;
  const Float x = Float::load(packet.dir[0] + base);
  const Float y = Float::load(packet.dir[1] + base);
  const Float z = Float::load(packet.dir[2] + base);
  return L::square_root((x * x + y * y) + z * z);
}

/// @param x, y        the packet's first pixel inside the tile.
/// @param tile_width  pixels of a row of the planes.
template <class L, class PacketType>
void store_hits(const PacketType& packet, std::uint32_t x, std::uint32_t y, std::uint32_t tile_width, const Hits& hits,
                WorkCounters& work) {
  using Float = typename L::Float;
  using Int = typename L::Int;
  constexpr std::uint32_t kGroups = PacketType::kRayCount / L::kCount;
  // A group of lanes is one or several rows of a subpacket: quads of pixels, one below the other.
  const auto for_each_group = [&](auto&& write) GRIDIRON_INLINE_LAMBDA {
    for (std::uint32_t first = 0; first < PacketType::kRayCount; first += kSubpacketRays) {
      const std::uint32_t first_pixel = (y + PacketType::row_of(first)) * tile_width + x + PacketType::column_of(first);
      for (std::uint32_t i = 0; i < kSubpacketRays; i += L::kCount) {
        write(first + i, first_pixel + i / kSubpacketWidth * tile_width);
      }
    }
  };
  work.add(Work::kIdGroup, kGroups);
  work.charge_to(Work::kIdGroup);
  for_each_group([&](std::uint32_t base, std::uint32_t pixel) GRIDIRON_INLINE_LAMBDA {
    L::store_quads(Int::load(packet.id + base), hits.id + pixel, tile_width);
  });
  if (hits.distance != nullptr) {
    work.add(Work::kDepthGroup, kGroups);
    work.charge_to(Work::kDepthGroup);
    for_each_group([&](std::uint32_t base, std::uint32_t pixel) GRIDIRON_INLINE_LAMBDA {
      const Float distance = Float::load(packet.t + base) * direction_lengths<L>(packet, base);
      const auto missed = L::equal(kNoTriangle, packet.id + base);
      L::store_quads(L::select(missed, Float(kFloatMax), distance), hits.distance + pixel, tile_width);
    });
  }
  if (hits.facing != nullptr) {
    work.charge_to(Work::kShadedSimpleGroup);
    for_each_group([&](std::uint32_t base, std::uint32_t pixel) GRIDIRON_INLINE_LAMBDA {
      L::store_quads(Float::load(packet.facing + base) / direction_lengths<L>(packet, base), hits.facing + pixel,
                     tile_width);
    });
  }
}

}  // namespace gridiron
