// What a packet can touch: its four quarters, each as slopes along the axes, against the four boxes of a node at once.
// Source: Wald, Boulos, Shirley 2007, section 3 (interval arithmetic); Benthin et al. 2006, section 4 (four boxes at
// once). Memory: inside the local store. Threads: one core. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/lanes.h>
#include <gridiron/base/math.h>
#include <gridiron/base/records.h>
#include <gridiron/base/work_counters.h>
#include <gridiron/bvh/bvh_node.h>
#include <gridiron/bvh/bvh_work.h>
#include <gridiron/bvh/four_words.h>
#include <gridiron/ray/packet.h>

#include <cstdint>

namespace gridiron::bvh {

/// A packet's quarters, in the order of its subpackets: with 8x8 rays its subpackets, with 16x16 its squares of them.
inline constexpr std::uint32_t kQuarterCount = 4;
inline constexpr std::uint32_t kAllQuarters = (1u << kQuarterCount) - 1u;

/// Columns and rows of the quarters, in quarters.
struct QuarterPlaces {
  alignas(16) float column[4];
  alignas(16) float row[4];
};
inline constexpr QuarterPlaces kQuarterPlaces = {{0, 1, 0, 1}, {0, 0, 1, 1}};

/// Which children of a node a packet meets.
struct ChildrenMet {
  Lanes<4>::Float entry;  ///< per child, no ray meets it at a t below this
  FourWords missed;       ///< per child, the quarters of which no ray meets it, a bit each
  Lanes<4>::Mask none;    ///< children that no quarter meets
};

/// Conservative bound of a packet of primary rays, by quarters.
///
/// Along an axis on which all rays run the same way, a ray meets the near side of a box at t >= (near - o) / d, with d
/// of the fastest ray of the quarter, and leaves it at t <= (far - o) / d, with d of the slowest; if either side is
/// behind the eye, the sign is still right. On an axis on which rays of the packet run both ways, rays that run up
/// reach the low side of a box in front at t >= (low - o) / d, d the greatest; rays that run down reach the high side
/// of one behind at t >= (high - o) / d, d the least. Then there is no bound for leaving. If no ray runs that way, d is
/// almost zero. Each operation of generate_packet is monotone in column and row, so a component's extremes over a
/// quarter are at its corners, and are computed here by the same operations. Difference, reciprocal, its widening and
/// product are 4 roundings, u = 2^-24 each, and OrderedChildren raises entries by less than 8 u; 16 u are charged.
template <std::uint32_t Width>
struct alignas(128) PacketBounds {
  // Per quarter and axis, the same in all four lanes.
  alignas(16) float enter[kQuarterCount][3][4];  ///< of the near side's distance: t of the earliest entry
  alignas(16) float leave[kQuarterCount][3][4];  ///< of the far side's distance: t of the latest exit
  // For mixed packets only.
  alignas(16) float enter_back[kQuarterCount][3][4];   ///< of the far side's distance: t of the earliest entry
  alignas(16) float never_leave[kQuarterCount][3][4];  ///< added to the latest exit: 0 or kFloatMax
  std::uint32_t near_side[3];                          ///< bound that rays meet first: 0 low, 1 high
  std::uint32_t far_side[3];
  std::uint32_t is_mixed;  ///< 1: along some axis rays of a quarter run both ways, or quarters apart

  /// @param left, top  the packet's first pixel. @param least  > 0, 2^-30 times the largest direction: rays run along
  ///                   an axis if their direction exceeds it.
  void set(const FrameHead& frame, std::uint32_t left, std::uint32_t top, float least, WorkCounters& work) {
    using Four = Lanes<4>;
    using Float = Four::Float;
    constexpr float kNarrow = 1.0f - 0x1p-20f;
    constexpr float kWiden = 1.0f + 0x1p-20f;
    constexpr float kQuarterWidth = Width / 2;
    const Float x_low = Float(static_cast<float>(left)) + Float::load(kQuarterPlaces.column) * Float(kQuarterWidth);
    const Float y_low = Float(static_cast<float>(top)) + Float::load(kQuarterPlaces.row) * Float(kQuarterWidth);
    const Float x_high = x_low + Float(kQuarterWidth - 1.0f);
    const Float y_high = y_low + Float(kQuarterWidth - 1.0f);
    const Float zero(0.0f), one(1.0f);
    Float low[3], high[3];
    Four::Mask one_way[3];
    std::uint32_t all_one_way = kAllQuarters;
    for (int axis = 0; axis < 3; ++axis) {
      const Float corner(frame.corner[axis]), step_x(frame.step_x[axis]), step_y(frame.step_y[axis]);
      const Float left_part = corner + x_low * step_x, right_part = corner + x_high * step_x;
      const Float top_part = y_low * step_y, bottom_part = y_high * step_y;
      low[axis] = Four::min(left_part, right_part) + Four::min(top_part, bottom_part);
      high[axis] = Four::max(left_part, right_part) + Four::max(top_part, bottom_part);
      const std::uint32_t backward = (high[axis] < Float(-least)).bits() == kAllQuarters ? kAllQuarters : 0u;
      const auto is_backward = Four::mask_from_bits(backward);
      near_side[axis] = backward & 1u;
      far_side[axis] = (backward & 1u) ^ 1u;
      one_way[axis] = (low[axis] > Float(least)) | is_backward;
      all_one_way &= one_way[axis].bits();
      const Float fastest = Four::select(is_backward, low[axis], Four::max(high[axis], Float(least)));
      const Float slowest = one / Four::select(is_backward, high[axis], low[axis]) * Float(kWiden);
      store(one / fastest * Float(kNarrow), enter, axis);
      store(Four::select(one_way[axis], slowest, zero), leave, axis);
    }
    is_mixed = 0;
    if (all_one_way == kAllQuarters) [[likely]]
      return;
    is_mixed = 1;
    work.add(carrier_of(BvhWork::kMixedStart));
    for (int axis = 0; axis < 3; ++axis) {
      const Float back = one / Four::min(low[axis], Float(-least)) * Float(kNarrow);
      store(Four::select(one_way[axis], zero, back), enter_back, axis);
      store(Four::select(one_way[axis], zero, Float(kFloatMax)), never_leave, axis);
    }
  }

  /// Tests the children of a node against the packet.
  /// @param reach  per quarter, the farthest hit that still matters. @tparam Mixed  is_mixed.
  template <bool Mixed>
  [[nodiscard]] GRIDIRON_INLINE ChildrenMet children_met(const BvhNode& node, const float* origin,
                                                         const float* reach) const {
    using Four = Lanes<4>;
    using Float = Four::Float;
    Float near[3], far[3];
    for (int axis = 0; axis < 3; ++axis) {
      const Float eye(origin[axis]);
      near[axis] = Float::load(node.bounds[near_side[axis]][axis]) - eye;
      far[axis] = Float::load(node.bounds[far_side[axis]][axis]) - eye;
    }
    ChildrenMet met{Float(kFloatMax), FourWords::splat(0u), {}};
    for (int quarter = 0; quarter < 4; ++quarter) {
      const auto along = [&](const Float* distance, const float(&scale)[kQuarterCount][3][4], int axis)
                             GRIDIRON_INLINE_LAMBDA { return distance[axis] * Float::load(scale[quarter][axis]); };
      Float entry = Four::max(Four::max(along(near, enter, 0), along(near, enter, 1)),
                              Four::max(along(near, enter, 2), Float(0.0f)));
      Float exits[3] = {along(far, leave, 0), along(far, leave, 1), along(far, leave, 2)};
      if constexpr (Mixed) {
        for (int axis = 0; axis < 3; ++axis) {
          entry = Four::max(entry, along(far, enter_back, axis));
          exits[axis] = exits[axis] + Float::load(never_leave[quarter][axis]);
        }
      }
      const Float exit = Four::min(Four::min(exits[0], exits[1]), Four::min(exits[2], Float(reach[quarter])));
      met.missed = met.missed | FourWords::where(entry > exit, 1u << quarter);
      met.entry = Four::min(met.entry, entry);
    }
    const auto absent = FourWords::load(&node.children[0].bits).equal(FourWords::splat(BvhChild::kNone));
    met.missed = FourWords::select(absent, FourWords::splat(kAllQuarters), met.missed);
    met.none = met.missed.equal(FourWords::splat(kAllQuarters));
    return met;
  }

 private:
  static GRIDIRON_INLINE void store(Lanes<4>::Float value, float (&target)[kQuarterCount][3][4], int axis) {
    using Four = Lanes<4>;
    Four::shuffle_quads<0, 0, 0, 0>(value).store(target[0][axis]);
    Four::shuffle_quads<1, 1, 1, 1>(value).store(target[1][axis]);
    Four::shuffle_quads<2, 2, 2, 2>(value).store(target[2][axis]);
    Four::shuffle_quads<3, 3, 3, 3>(value).store(target[3][axis]);
  }
};

}  // namespace gridiron::bvh
