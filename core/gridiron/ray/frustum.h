// Frustum: which cells of a slice the rays of a packet can touch. Cell space, one origin, one march axis.
// Source: Wald, Ize, Kensler, Knoll, Parker 2006, section 3.2; slices are recomputed here, never accumulated.
// Memory: values. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/lanes.h>
#include <gridiron/base/records.h>
#include <gridiron/ray/packet.h>

#include <cstdint>

namespace gridiron {

/// Cells of one slice, bounds inclusive; empty when first > last on an axis.
struct CellRect {
  std::int32_t u_first, u_last, v_first, v_last;
  [[nodiscard]] GRIDIRON_INLINE bool empty() const { return u_first > u_last || v_first > v_last; }
};

/// Distances, in cells along the march axis from the origin, at which a range of slices begins and ends.
struct Slab {
  float entry, exit;
};

/// Conservative bound of a packet whose rays share origin, march axis and march sign.
///
/// Let o be the origin in cell space and s the slope of a ray (cells along u per cell along the march). In exact
/// arithmetic the ray is at o_u + s x after marching x. Every quantity below carries at most a handful of roundings:
/// o has 2, s has 3, x has 1 on |x| and 2 on |o_k|, the product and the sum one each. Their sum is at most
/// e (4 |o_u| + |s| (8 |o_k| + 8 N_k)) with e = 2^-23, one unit in any rounding mode; that is pad_u. pad_k likewise.
struct Frustum {
  std::uint32_t axis_k, axis_u, axis_v;
  std::int32_t cells_u, cells_v, cells_k;
  bool reverse;                        ///< the rays march towards smaller k
  float origin_k, origin_u, origin_v;  ///< cell space
  float slope_u_min, slope_u_max, slope_v_min, slope_v_max;
  float pad_k, pad_u, pad_v;
  float depth_per_t;  ///< factor |cells_per_unit_k|; times |dir_k| it turns t into march distance

  /// @param first, last  cells along k, inclusive.
  [[nodiscard]] GRIDIRON_INLINE Slab slab_of(std::int32_t first, std::int32_t last) const {
    const float low = static_cast<float>(first);
    const float high = static_cast<float>(last + 1);
    Slab slab = reverse ? Slab{origin_k - high, origin_k - low} : Slab{low - origin_k, high - origin_k};
    if (slab.entry < 0.0f) slab.entry = 0.0f;
    return slab;
  }

  /// @returns true where the slab lies behind the origin as a whole.
  [[nodiscard]] GRIDIRON_INLINE bool behind(const Slab& slab) const { return slab.exit < -pad_k; }

  /// @returns true where the slab begins farther than every ray's nearest hit; reach is their largest march distance.
  [[nodiscard]] GRIDIRON_INLINE bool beyond(const Slab& slab, float reach) const {
    return slab.entry > reach * (1.0f + 0x1p-20f) + pad_k;
  }

  /// Cells of the plane u, v that rays touch between the slab's two ends.
  [[nodiscard]] GRIDIRON_INLINE CellRect rect_of(const Slab& slab) const {
    CellRect rect;
    range_of(slab, origin_u, slope_u_min, slope_u_max, pad_u, cells_u, rect.u_first, rect.u_last);
    range_of(slab, origin_v, slope_v_min, slope_v_max, pad_v, cells_v, rect.v_first, rect.v_last);
    return rect;
  }

 private:
  static GRIDIRON_INLINE void range_of(const Slab& slab, float origin, float slope_min, float slope_max, float pad,
                                       std::int32_t cells, std::int32_t& first, std::int32_t& last) {
    const float far = slab.exit > 0.0f ? slab.exit : 0.0f;
    const float low = origin + slope_min * (slope_min < 0.0f ? far : slab.entry) - pad;
    const float high = origin + slope_max * (slope_max > 0.0f ? far : slab.entry) + pad;
    const float limit = static_cast<float>(cells);
    if (!(high >= 0.0f) || !(low <= limit)) {
      first = 1;
      last = 0;
      return;
    }
    first = low > 0.0f ? static_cast<std::int32_t>(low) : 0;
    last = high < limit ? static_cast<std::int32_t>(high) : cells;
    if (first > cells - 1) first = cells - 1;
    if (last > cells - 1) last = cells - 1;
  }
};

/// Takes a pass of rays out of `waiting`: the first waiting ray decides axis and sign, and every waiting ray that
/// runs the same way along that axis at a slope of at most 2 joins. A ray whose own steepest axis it is always joins,
/// so six passes empty any packet.
///
/// @param waiting  rays not traced yet; the rays taken leave it. @param packet  its `active` becomes this pass.
/// @returns false when no ray is waiting.
template <class L, class PacketType>
[[nodiscard]] bool take_pass(const GridRecord& grid, RaySet<PacketType::kRayCount>& waiting, PacketType& packet,
                             Frustum& frustum) {
  constexpr std::uint32_t kRays = PacketType::kRayCount;
  std::uint32_t leader = 0;
  while (leader < kRays && !waiting.contains(leader)) ++leader;
  if (leader == kRays) return false;

  const auto size_of = [&](std::uint32_t axis, std::uint32_t ray) {
    const float value = packet.dir[axis][ray] * grid.cells_per_unit[axis];
    return value < 0.0f ? -value : value;
  };
  std::uint32_t k = 0;
  if (size_of(1, leader) > size_of(k, leader)) k = 1;
  if (size_of(2, leader) > size_of(k, leader)) k = 2;
  const std::uint32_t u = k == 2 ? 0 : k + 1;
  const std::uint32_t v = u == 2 ? 0 : u + 1;
  const bool reverse = packet.dir[k][leader] < 0.0f;

  using Float = typename L::Float;
  const Float march_scale(reverse ? -grid.cells_per_unit[k] : grid.cells_per_unit[k]);
  const Float u_scale(grid.cells_per_unit[u]);
  const Float v_scale(grid.cells_per_unit[v]);
  Float low_u(kFloatMax), high_u(-kFloatMax), low_v(kFloatMax), high_v(-kFloatMax);
  for (std::uint32_t base = 0; base < kRays; base += L::kCount) {
    const Float march = Float::load(packet.dir[k] + base) * march_scale;
    const Float along_u = Float::load(packet.dir[u] + base) * u_scale;
    const Float along_v = Float::load(packet.dir[v] + base) * v_scale;
    const std::uint32_t bits =
        ((march > Float(0.0f)) & (L::abs(along_u) <= march + march) & (L::abs(along_v) <= march + march)).bits() &
        waiting.template group<L>(base);
    packet.active.template set_group<L>(base, bits);
    waiting.template set_group<L>(base, waiting.template group<L>(base) & ~bits);
    const auto joined = L::mask_from_bits(bits);
    const Float slope_u = along_u / march;
    const Float slope_v = along_v / march;
    low_u = L::min(low_u, L::select(joined, slope_u, Float(kFloatMax)));
    high_u = L::max(high_u, L::select(joined, slope_u, Float(-kFloatMax)));
    low_v = L::min(low_v, L::select(joined, slope_v, Float(kFloatMax)));
    high_v = L::max(high_v, L::select(joined, slope_v, Float(-kFloatMax)));
  }
  waiting.erase(leader);  // a direction that vanishes in cell space is a miss
  const float slope_u_min = L::horizontal_min(low_u);
  const float slope_u_max = L::horizontal_max(high_u);
  const float slope_v_min = L::horizontal_min(low_v);
  const float slope_v_max = L::horizontal_max(high_v);

  const auto magnitude = [](float value) { return value < 0.0f ? -value : value; };
  const auto larger = [](float a, float b) { return a > b ? a : b; };
  const auto in_cells = [&](std::uint32_t axis) {
    return (packet.origin[axis] - grid.minimum[axis]) * grid.cells_per_unit[axis];
  };
  frustum.axis_k = k;
  frustum.axis_u = u;
  frustum.axis_v = v;
  frustum.cells_k = static_cast<std::int32_t>(grid.cell_count[k]);
  frustum.cells_u = static_cast<std::int32_t>(grid.cell_count[u]);
  frustum.cells_v = static_cast<std::int32_t>(grid.cell_count[v]);
  frustum.reverse = reverse;
  frustum.origin_k = in_cells(k);
  frustum.origin_u = in_cells(u);
  frustum.origin_v = in_cells(v);
  frustum.slope_u_min = slope_u_min;
  frustum.slope_u_max = slope_u_max;
  frustum.slope_v_min = slope_v_min;
  frustum.slope_v_max = slope_v_max;
  constexpr float kUnit = 0x1p-23f;
  const float march_bound = 8.0f * (magnitude(frustum.origin_k) + static_cast<float>(frustum.cells_k));
  const float steep_u = larger(magnitude(slope_u_min), magnitude(slope_u_max));
  const float steep_v = larger(magnitude(slope_v_min), magnitude(slope_v_max));
  frustum.pad_k = kUnit * march_bound;
  frustum.pad_u = kUnit * (4.0f * magnitude(frustum.origin_u) + steep_u * march_bound) + 0x1p-60f;
  frustum.pad_v = kUnit * (4.0f * magnitude(frustum.origin_v) + steep_v * march_bound) + 0x1p-60f;
  frustum.depth_per_t = grid.cells_per_unit[k];
  return true;
}

/// @returns the largest march distance of the active rays' nearest hits: beyond it nothing can be nearer.
template <class L, class PacketType>
[[nodiscard]] GRIDIRON_INLINE float reach_of(const PacketType& packet, const Frustum& frustum) {
  using Float = typename L::Float;
  Float reach(0.0f);
  const Float scale(frustum.depth_per_t);
  for (std::uint32_t base = 0; base < PacketType::kRayCount; base += L::kCount) {
    const auto active = L::mask_from_bits(packet.active.template group<L>(base));
    const Float distance =
        Float::load(packet.t + base) * (L::abs(Float::load(packet.dir[frustum.axis_k] + base)) * scale);
    reach = L::max(reach, L::select(active, distance, Float(0.0f)));
  }
  return L::horizontal_max(reach);
}

}  // namespace gridiron
