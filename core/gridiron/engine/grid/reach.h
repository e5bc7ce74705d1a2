// Reach: how far each subpacket of a packet still has to look.
// Memory: values. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/lanes.h>
#include <gridiron/base/work_counters.h>
#include <gridiron/engine/grid/frustum.h>
#include <gridiron/engine/grid/grid_work.h>
#include <gridiron/ray/packet.h>

#include <cstdint>

namespace gridiron {

/// Per subpacket, a march distance beyond which none of its active rays can have a nearer hit: the largest t of their
/// nearest hits, plus the greatest error of an estimate, times the largest march of the rays of its square.
template <class PacketType>
struct SubpacketReach {
  static constexpr std::uint32_t kCount = PacketType::kSubpacketCount;
  static constexpr std::uint32_t kSquareCount = PacketType::kSquareCount;
  static constexpr std::uint32_t kWholeQuads = (kSquareCount + 3) / 4 * 4;
  alignas(64) float reach[kCount];
  alignas(16) float square_reach[kWholeQuads];  ///< the largest of each square's subpackets

  /// Updates the subpackets whose hits changed, and their neighbours in a square.
  /// @returns the largest reach of the packet.
  template <class L>
  GRIDIRON_OUTLINE float update(const PacketType& packet, SubpacketSet changed, WorkCounters& work) {
    using Four = Lanes<4>;
    if constexpr (kCount < 4) {
      work.add(GridWork::kReachGroup, kSubpacketRays / L::kCount);
      reach[0] = L::horizontal_max(farthest_active<L>(packet, 0)) * scale_of(packet, 0);
      return reach[0];
    } else {
      for_each_square(changed, [&](std::uint32_t square) GRIDIRON_INLINE_LAMBDA {
        work.add(GridWork::kReachGroup, 4 * kSubpacketRays / L::kCount);
        const std::uint32_t first = 4 * square;
        const bool is_whole = (packet.active.words[2 * square] & packet.active.words[2 * square + 1]) == ~0u;
        typename L::Float farthest[4];
        for (std::uint32_t i = 0; i < 4; ++i) {
          farthest[i] = is_whole ? farthest_ray<L>(packet.t + (first + i) * kSubpacketRays)
                                 : farthest_active<L>(packet, first + i);
        }
        const Four::Float scaled = largest_of<L>(farthest) * Four::Float(scale_of(packet, square));
        scaled.store(reach + first);
        square_reach[square] = Four::horizontal_max(scaled);
      });
      if constexpr (kSquareCount == 1) return square_reach[0];
      work.add(GridWork::kReachGroup);
      Four::Float farthest = Four::Float::load(square_reach);
      for (std::uint32_t base = 4; base < kSquareCount; base += 4) {
        farthest = Four::max(farthest, Four::Float::load(square_reach + base));
      }
      return Four::horizontal_max(farthest);
    }
  }

  /// @returns a bit for each square that has a subpacket which still looks beyond the march distance `entry`.
  [[nodiscard]] GRIDIRON_OUTLINE std::uint32_t open_squares(const Frustum& frustum, float entry,
                                                            WorkCounters& work) const {
    using Four = Lanes<4>;
    using Float = Four::Float;
    if constexpr (kSquareCount < 4) return (1u << kSquareCount) - 1u;
    std::uint32_t result = 0;
    for (std::uint32_t base = 0; base < kSquareCount; base += 4) {
      work.add(GridWork::kReachTest);
      const Float limit = Float::load(square_reach + base) * Float(Frustum::kReachFactor) + Float(frustum.pad_k);
      result |= (Float(entry) <= limit).bits() << base;
    }
    return result;
  }

  /// @returns the subpackets that still look beyond the march distance `entry`. Only the squares in `exactly` are
  /// decided by subpacket; of any other square all subpackets are returned if one of them does.
  [[nodiscard]] GRIDIRON_INLINE SubpacketSet open(const Frustum& frustum, float entry, std::uint32_t exactly,
                                                  WorkCounters& work) const {
    using Four = Lanes<4>;
    using Float = Four::Float;
    const std::uint32_t squares = open_squares(frustum, entry, work);
    SubpacketSet result = subpackets_of_squares(squares);
    for (std::uint32_t rest = squares & exactly; rest != 0; rest &= rest - 1) {
      const std::uint32_t square = lowest_bit(rest);
      work.add(GridWork::kReachTest);
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
        work.add(GridWork::kReachTest);
        const Float limit = Float::load(reach + base) * Float(Frustum::kReachFactor) + Float(frustum.pad_k);
        result |= SubpacketSet{(Float(entry) <= limit).bits()} << base;
      }
      return result;
    }
  }

 private:
  /// Calls visit(i) for every square i of which a subpacket is in the set.
  template <class Visit>
  static GRIDIRON_INLINE void for_each_square(SubpacketSet set, Visit&& visit) {
    for (std::uint32_t base = 0; base < kSquareCount; base += 8) {
      const std::uint32_t half = static_cast<std::uint32_t>(set >> (4 * base));
      const std::uint32_t pairs = half | half >> 1;
      for (std::uint32_t rest = (pairs | pairs >> 2) & 0x11111111u; rest != 0; rest &= rest - 1) {
        visit(base + lowest_bit(rest) / 4);
      }
    }
  }
  [[nodiscard]] static GRIDIRON_INLINE float scale_of(const PacketType& packet, std::uint32_t square) {
    return packet.march_high[square] * (1.0f + 2.0f * kEstimateError);
  }
  /// @returns in its lanes the largest t of a subpacket's active rays.
  template <class L>
  [[nodiscard]] static GRIDIRON_INLINE typename L::Float farthest_active(const PacketType& packet,
                                                                         std::uint32_t subpacket) {
    using Float = typename L::Float;
    const std::uint32_t first_ray = subpacket * kSubpacketRays;
    Float farthest(0.0f);
    for (std::uint32_t base = first_ray; base < first_ray + kSubpacketRays; base += L::kCount) {
      const auto active = L::mask_from_bits(packet.active.template group<L>(base));
      farthest = L::max(farthest, L::select(active, Float::load(packet.t + base), Float(0.0f)));
    }
    return farthest;
  }
  /// The same where all are active. @param t  of its rays.
  template <class L>
  [[nodiscard]] static GRIDIRON_INLINE typename L::Float farthest_ray(const float* t) {
    using Float = typename L::Float;
    if constexpr (L::kCount == 16) {
      return Float::load(t);
    } else if constexpr (L::kCount == 8) {
      return L::max(Float::load(t), Float::load(t + 8));
    } else {
      return L::max(L::max(Float::load(t), Float::load(t + 4)), L::max(Float::load(t + 8), Float::load(t + 12)));
    }
  }
  /// @returns in lane i the largest lane of vector i.
  template <class L>
  [[nodiscard]] static GRIDIRON_INLINE Lanes<4>::Float largest_of(const typename L::Float* vectors) {
    if constexpr (L::kCount == 4) {
      const auto halves = [](typename L::Float low, typename L::Float high) GRIDIRON_INLINE_LAMBDA {
        return L::max(L::template shuffle_quads<0, 1, 4, 5>(low, high),
                      L::template shuffle_quads<2, 3, 6, 7>(low, high));
      };
      const typename L::Float ab = halves(vectors[0], vectors[1]), cd = halves(vectors[2], vectors[3]);
      return L::max(L::template shuffle_quads<0, 2, 4, 6>(ab, cd), L::template shuffle_quads<1, 3, 5, 7>(ab, cd));
    } else {
      alignas(16) float largest[4];
      for (std::uint32_t i = 0; i < 4; ++i) largest[i] = L::horizontal_max(vectors[i]);
      return Lanes<4>::Float::load(largest);
    }
  }
};

}  // namespace gridiron
