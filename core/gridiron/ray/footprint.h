// Footprint: which subpackets of a packet may touch a cell.
// Source: the frustum's bound (frustum.h), for each subpacket by itself. Memory: values. Threads: any.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/lanes.h>
#include <gridiron/base/work_counters.h>
#include <gridiron/ray/frustum.h>
#include <gridiron/ray/packet.h>

#include <cstdint>

namespace gridiron {

/// @returns those of the `wanted` subpackets of which an active ray may touch cell (u, v) of a slab; of packets with
/// fewer subpackets than lanes, all that are wanted. The frustum's pads cover each subpacket: its rays are among those
/// that the pads were made for.
template <class L, class PacketType>
[[nodiscard]] GRIDIRON_INLINE SubpacketSet subpackets_touching(const PacketType& packet, const Frustum& frustum,
                                                               const Slab& slab, std::int32_t u, std::int32_t v,
                                                               SubpacketSet wanted, WorkCounters& work) {
  if constexpr (PacketType::kSubpacketCount < L::kCount) return wanted;
  using Float = typename L::Float;
  const Float near(slab.entry);
  const Float far(slab.exit > 0.0f ? slab.exit : 0.0f);
  const Float first_u(static_cast<float>(u)), last_u(static_cast<float>(u + 1));
  const Float first_v(static_cast<float>(v)), last_v(static_cast<float>(v + 1));
  SubpacketSet touching = 0;
  for (std::uint32_t base = 0; base < PacketType::kSubpacketCount; base += L::kCount) {
    if (((wanted >> base) & L::kAllBits) == 0) continue;
    work.add(Work::kFootprintGroup);
    const auto low = [&](std::uint32_t axis) {
      const Float slope = Float::load(packet.slope_low[axis] + base);
      return Float(frustum.start[2 * axis]) + L::min(slope * near, slope * far);
    };
    const auto high = [&](std::uint32_t axis) {
      const Float slope = Float::load(packet.slope_high[axis] + base);
      return Float(frustum.start[2 * axis + 1]) + L::max(slope * near, slope * far);
    };
    const std::uint32_t outside =
        ((last_u < low(0)) | (high(0) < first_u) | (last_v < low(1)) | (high(1) < first_v)).bits();
    touching |= SubpacketSet{~outside & L::kAllBits} << base;
  }
  return touching & wanted;
}

}  // namespace gridiron
