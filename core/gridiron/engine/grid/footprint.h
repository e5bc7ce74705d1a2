// Footprint: which squares of 2x2 subpackets of a packet may touch a cell.
// Source: the frustum's bound (frustum.h), for each square by itself. Memory: values. Threads: any.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/lanes.h>
#include <gridiron/base/work_counters.h>
#include <gridiron/engine/grid/frustum.h>
#include <gridiron/ray/packet.h>

#include <cstdint>
#include <type_traits>

namespace gridiron {

/// @returns the `wanted` squares of 2x2 subpackets that have an active ray which may touch cell (u, v) of a slab, a bit
/// each.
///
/// The frustum's pads cover each square: its rays are among those that the pads were made for.
template <class L, class PacketType>
[[nodiscard]] GRIDIRON_INLINE std::uint32_t squares_touching(const PacketType& packet, const Frustum& frustum,
                                                             const Slab& slab, std::int32_t u, std::int32_t v,
                                                             std::uint32_t wanted, WorkCounters& work) {
  constexpr std::uint32_t kSquares = PacketType::kSquareCount;
  if constexpr (kSquares < 4) return wanted;
  using S = std::conditional_t<(kSquares >= L::kCount), L, Lanes<4>>;
  using Float = typename S::Float;
  const Float near(slab.entry);
  const Float far(slab.exit > 0.0f ? slab.exit : 0.0f);
  const Float first[2] = {Float(static_cast<float>(u)), Float(static_cast<float>(v))};
  const Float last[2] = {Float(static_cast<float>(u + 1)), Float(static_cast<float>(v + 1))};
  std::uint32_t squares = 0;
  for (std::uint32_t base = 0; base < kSquares; base += S::kCount) {
    if ((wanted >> base & S::kAllBits) == 0) continue;
    work.add(Work::kFootprintGroup);
    std::uint32_t outside = 0;
    for (std::uint32_t axis = 0; axis < 2; ++axis) {
      const Float slope_low = Float::load(packet.slope_low[axis] + base);
      const Float slope_high = Float::load(packet.slope_high[axis] + base);
      const Float low = Float(frustum.start[2 * axis]) + S::min(slope_low * near, slope_low * far);
      const Float high = Float(frustum.start[2 * axis + 1]) + S::max(slope_high * near, slope_high * far);
      outside |= ((last[axis] < low) | (high < first[axis])).bits();
    }
    squares |= (~outside & S::kAllBits) << base;
  }
  return squares & wanted;
}

}  // namespace gridiron
