// Reach: how far each subpacket of a packet still has to look.
// Memory: values. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/lanes.h>
#include <gridiron/base/work_counters.h>
#include <gridiron/ray/frustum.h>
#include <gridiron/ray/packet.h>

#include <cstdint>

namespace gridiron {

/// Per subpacket, the largest march distance of its active rays' nearest hits: beyond it nothing can be nearer.
template <class PacketType>
struct SubpacketReach {
  static constexpr std::uint32_t kCount = PacketType::kSubpacketCount;
  alignas(64) float reach[kCount];

  /// Measures anew the subpackets whose hits changed. @returns the largest reach of the packet.
  template <class L>
  GRIDIRON_INLINE float update(const PacketType& packet, const Frustum& frustum, SubpacketSet changed,
                               WorkCounters& work) {
    using Float = typename L::Float;
    const Float scale(frustum.depth_per_t);
    for_each_subpacket<kCount>(changed, [&](std::uint32_t subpacket) GRIDIRON_INLINE_LAMBDA {
      const std::uint32_t first_ray = subpacket * kSubpacketRays;
      Float farthest(0.0f);
      for (std::uint32_t base = first_ray; base < first_ray + kSubpacketRays; base += L::kCount) {
        work.add(Work::kReachGroup);
        const auto active = L::mask_from_bits(packet.active.template group<L>(base));
        const Float distance =
            Float::load(packet.t + base) * (L::abs(Float::load(packet.dir[frustum.axis_k] + base)) * scale);
        farthest = L::max(farthest, L::select(active, distance, Float(0.0f)));
      }
      reach[subpacket] = L::horizontal_max(farthest);
    });
    float largest = 0.0f;
    if constexpr (kCount < L::kCount) {
      for (const float value : reach) largest = value > largest ? value : largest;
    } else {
      Float farthest(0.0f);
      for (std::uint32_t base = 0; base < kCount; base += L::kCount) {
        work.add(Work::kReachGroup);
        farthest = L::max(farthest, Float::load(reach + base));
      }
      largest = L::horizontal_max(farthest);
    }
    return largest;
  }

  /// @returns those of the `wanted` subpackets that still look beyond the march distance `entry`.
  template <class L>
  [[nodiscard]] GRIDIRON_INLINE SubpacketSet open(const Frustum& frustum, float entry, SubpacketSet wanted,
                                                  WorkCounters& work) const {
    if constexpr (kCount < L::kCount) {
      return wanted;
    } else {
      using Float = typename L::Float;
      SubpacketSet result = 0;
      for (std::uint32_t base = 0; base < kCount; base += L::kCount) {
        if ((wanted >> base & L::kAllBits) == 0) continue;
        work.add(Work::kReachGroup);
        const Float limit = Float::load(reach + base) * Float(Frustum::kReachFactor) + Float(frustum.pad_k);
        result |= SubpacketSet{(Float(entry) <= limit).bits()} << base;
      }
      return result & wanted;
    }
  }
};

}  // namespace gridiron
