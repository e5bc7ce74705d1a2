// Reach: how far each subpacket of a packet still has to look.
// Memory: values. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/lanes.h>
#include <gridiron/base/work_counters.h>
#include <gridiron/ray/frustum.h>
#include <gridiron/ray/packet.h>

#include <cstdint>

namespace gridiron {

/// Per subpacket, the largest march distance of its active rays' nearest hits, were they as far as estimates may err:
/// beyond it nothing can be nearer.
template <class PacketType>
struct SubpacketReach {
  static constexpr std::uint32_t kCount = PacketType::kSubpacketCount;
  static constexpr std::uint32_t kSquareCount = PacketType::kSquareCount;
  alignas(64) float reach[kCount];
  alignas(16) float square_reach[kSquareCount < 4 ? 4 : kSquareCount];  ///< the largest of each square's subpackets

  /// Measures anew the subpackets whose hits changed. @returns the largest reach of the packet.
  template <class L>
  GRIDIRON_INLINE float update(const PacketType& packet, const Frustum& frustum, SubpacketSet changed,
                               WorkCounters& work) {
    using Float = typename L::Float;
    const float scale = frustum.depth_per_t * (1.0f + 2.0f * kEstimateError);
    for_each_subpacket<kCount>(changed, [&](std::uint32_t subpacket) GRIDIRON_INLINE_LAMBDA {
      const std::uint32_t first_ray = subpacket * kSubpacketRays;
      const bool is_whole = packet.active.subpacket(subpacket) == kAllSubpacketRays;
      work.add(Work::kReachGroup, kSubpacketRays / L::kCount);
      Float farthest(0.0f);
      for (std::uint32_t base = first_ray; base < first_ray + kSubpacketRays; base += L::kCount) {
        Float distance = Float::load(packet.t + base) * L::abs(Float::load(packet.dir[frustum.axis_k] + base));
        if (!is_whole) [[unlikely]] {
          const auto active = L::mask_from_bits(packet.active.template group<L>(base));
          distance = L::select(active, distance, Float(0.0f));
        }
        farthest = L::max(farthest, distance);
      }
      reach[subpacket] = L::horizontal_max(farthest) * scale;
    });
    if constexpr (kCount < 4) {
      return reach[0];
    } else {
      using Four = Lanes<4>;
      for (std::uint32_t square = 0; square < kSquareCount; ++square) {
        if ((changed >> (4 * square) & 0xFu) == 0) continue;
        work.add(Work::kReachGroup);
        square_reach[square] = Four::horizontal_max(Four::Float::load(reach + 4 * square));
      }
      if constexpr (kSquareCount == 1) return square_reach[0];
      work.add(Work::kReachGroup);
      Four::Float farthest = Four::Float::load(square_reach);
      for (std::uint32_t base = 4; base < kSquareCount; base += 4) {
        farthest = Four::max(farthest, Four::Float::load(square_reach + base));
      }
      return Four::horizontal_max(farthest);
    }
  }

  /// @returns a bit for each square of which a subpacket still looks beyond the march distance `entry`.
  [[nodiscard]] GRIDIRON_OUTLINE std::uint32_t open_squares(const Frustum& frustum, float entry,
                                                            WorkCounters& work) const {
    using Four = Lanes<4>;
    using Float = Four::Float;
    if constexpr (kSquareCount < 4) return (1u << kSquareCount) - 1u;
    std::uint32_t result = 0;
    for (std::uint32_t base = 0; base < kSquareCount; base += 4) {
      work.add(Work::kReachGroup);
      const Float limit = Float::load(square_reach + base) * Float(Frustum::kReachFactor) + Float(frustum.pad_k);
      result |= (Float(entry) <= limit).bits() << base;
    }
    return result;
  }

  /// @returns the subpackets that still look beyond the march distance `entry`: of the squares `exactly`, those that
  /// do; of the others, all of a square where one of them does.
  [[nodiscard]] GRIDIRON_INLINE SubpacketSet open(const Frustum& frustum, float entry, std::uint32_t exactly,
                                                  WorkCounters& work) const {
    using Four = Lanes<4>;
    using Float = Four::Float;
    const std::uint32_t squares = open_squares(frustum, entry, work);
    SubpacketSet result = subpackets_of_squares(squares);
    for (std::uint32_t rest = squares & exactly; rest != 0; rest &= rest - 1) {
      const std::uint32_t square = lowest_bit(rest);
      work.add(Work::kReachGroup);
      const Float limit = Float::load(reach + 4 * square) * Float(Frustum::kReachFactor) + Float(frustum.pad_k);
      const std::uint32_t behind = ~(Float(entry) <= limit).bits() & 0xFu;
      result &= ~(SubpacketSet{behind} << (4 * square));
    }
    return result;
  }

  /// @returns the subpackets that still look beyond the march distance `entry`.
  template <class L>
  [[nodiscard]] GRIDIRON_INLINE SubpacketSet open(const Frustum& frustum, float entry, WorkCounters& work) const {
    if constexpr (kCount < L::kCount) {
      return PacketType::kAllSubpackets;
    } else {
      using Float = typename L::Float;
      SubpacketSet result = 0;
      for (std::uint32_t base = 0; base < kCount; base += L::kCount) {
        work.add(Work::kReachGroup);
        const Float limit = Float::load(reach + base) * Float(Frustum::kReachFactor) + Float(frustum.pad_k);
        result |= SubpacketSet{(Float(entry) <= limit).bits()} << base;
      }
      return result;
    }
  }
};

}  // namespace gridiron
