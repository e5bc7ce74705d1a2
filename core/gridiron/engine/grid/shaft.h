// Shafts: bounds of rays with origins of their own that march through the grid along one axis.
// Memory: inside the local store. Threads: one core. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/lanes.h>
#include <gridiron/base/math.h>
#include <gridiron/base/records.h>
#include <gridiron/base/work_counters.h>
#include <gridiron/engine/grid/frustum.h>
#include <gridiron/ray/walk_rays.h>

#include <cstdint>

namespace gridiron {

/// Conservative bound of a pass of rays: which cells of a slab they can touch.
///
/// The march coordinate is the cell coordinate along axis k, or its negative if the rays run towards smaller k.
/// Roundings as in frustum.h, with each ray's own origin: o has 2, s has 4, the march from a ray's start 2 |o_k| and
/// one more, the product and the sum one each: e (3 |o_u| + |s| (9 |o_k| + 7 N_k)) is below what a frustum is charged;
/// e and the loss of slopes are frustum.h's too. The end of a ray along the march, start + march t, has an error of 6 e
/// (|o_k| + N_k) if it lies in the grid: pad_k covers it.
struct Shaft {
  std::uint32_t axis_k, axis_u, axis_v;
  std::int32_t cells_u, cells_v, cells_k;
  bool reverse;
  float least_start;  ///< of the active rays
  float pad_k, pad_u, pad_v;
  alignas(64) float start[kWalkRays];  ///< march coordinate of the origin
  alignas(64) float end[kWalkRays];    ///< and of the farthest place to look at; -kFloatMax: not in the pass any more
  alignas(64) float march[kWalkRays];  ///< cells along the march per unit of t
  alignas(64) float place[2][kWalkRays];  ///< cell coordinates of the origin along u and v
  alignas(64) float slope[2][kWalkRays];  ///< cells along u and v per cell along the march

  [[nodiscard]] GRIDIRON_INLINE Slab slab_of(std::int32_t first, std::int32_t last) const {
    const float low = static_cast<float>(first);
    const float high = static_cast<float>(last + 1);
    return reverse ? Slab{-high, -low} : Slab{low, high};
  }
  [[nodiscard]] GRIDIRON_INLINE bool behind(const Slab& slab) const { return slab.exit < least_start - pad_k; }
  /// @param reach  the largest end of all rays.
  [[nodiscard]] GRIDIRON_INLINE bool beyond(const Slab& slab, float reach) const { return slab.entry > reach + pad_k; }

  /// Cells of the plane u, v that rays touch between the slab's two ends.
  template <class L>
  [[nodiscard]] GRIDIRON_OUTLINE CellRect rect_of(const Slab& slab, WorkCounters& work) const {
    using Float = typename L::Float;
    work.add(Work::kShaftGroup, kWalkRays / L::kCount);
    Float low_u(kFloatMax), high_u(-kFloatMax), low_v(kFloatMax), high_v(-kFloatMax);
    for (std::uint32_t base = 0; base < kWalkRays; base += L::kCount) {
      const Float from = Float::load(start + base);
      const auto present = (Float::load(end + base) >= Float(slab.entry - pad_k)) & (from <= Float(slab.exit + pad_k));
      const Float near = L::max(Float(slab.entry) - from, Float(0.0f));
      const Float far = L::max(Float(slab.exit) - from, Float(0.0f));
      const auto widen = [&](std::uint32_t axis, Float& low, Float& high) GRIDIRON_INLINE_LAMBDA {
        const Float first = Float::load(place[axis] + base), along = Float::load(slope[axis] + base);
        const Float a = first + along * near, b = first + along * far;
        low = L::min(low, L::select(present, L::min(a, b), Float(kFloatMax)));
        high = L::max(high, L::select(present, L::max(a, b), Float(-kFloatMax)));
      };
      widen(0, low_u, high_u);
      widen(1, low_v, high_v);
    }
    const float u0 = L::horizontal_min(low_u) - pad_u, u1 = L::horizontal_max(high_u) + pad_u;
    const float v0 = L::horizontal_min(low_v) - pad_v, v1 = L::horizontal_max(high_v) + pad_v;
    const float most_u = static_cast<float>(cells_u), most_v = static_cast<float>(cells_v);
    if (u0 > most_u || u1 < 0.0f || v0 > most_v || v1 < 0.0f) return {1, 0, 1, 0};
    const auto cell_of = [](float value, float cells) {
      const float below = value < cells - 0.5f ? value : cells - 0.5f;
      return static_cast<std::int32_t>(below > 0.0f ? below : 0.0f);
    };
    return {cell_of(u0, most_u), cell_of(u1, most_u), cell_of(v0, most_v), cell_of(v1, most_v)};
  }

  /// @returns the rays that may touch cell (u, v) of a slab, bit i = ray i.
  template <class L>
  [[nodiscard]] GRIDIRON_OUTLINE std::uint32_t rays_touching(const Slab& slab, std::int32_t u, std::int32_t v,
                                                             WorkCounters& work) const {
    using Float = typename L::Float;
    work.add(Work::kShaftGroup, kWalkRays / L::kCount);
    const Float first_u(static_cast<float>(u) - pad_u), last_u(static_cast<float>(u + 1) + pad_u);
    const Float first_v(static_cast<float>(v) - pad_v), last_v(static_cast<float>(v + 1) + pad_v);
    std::uint32_t touching = 0;
    for (std::uint32_t base = 0; base < kWalkRays; base += L::kCount) {
      const Float from = Float::load(start + base);
      const Float near = L::max(Float(slab.entry) - from, Float(0.0f));
      const Float far = L::max(Float(slab.exit) - from, Float(0.0f));
      const auto meets = [&](std::uint32_t axis, Float first, Float last) GRIDIRON_INLINE_LAMBDA {
        const Float begin = Float::load(place[axis] + base), along = Float::load(slope[axis] + base);
        const Float a = begin + along * near, b = begin + along * far;
        return (L::min(a, b) <= last) & (L::max(a, b) >= first);
      };
      const auto present = (Float::load(end + base) >= Float(slab.entry - pad_k)) & (from <= Float(slab.exit + pad_k));
      touching |= (present & meets(0, first_u, last_u) & meets(1, first_v, last_v)).bits() << base;
    }
    return touching;
  }

  /// @returns the largest end of the rays in `active`, -kFloatMax where there is none.
  template <class L>
  [[nodiscard]] GRIDIRON_INLINE float reach() const {
    using Float = typename L::Float;
    Float farthest(-kFloatMax);
    for (std::uint32_t base = 0; base < kWalkRays; base += L::kCount) {
      farthest = L::max(farthest, Float::load(end + base));
    }
    return L::horizontal_max(farthest);
  }
  /// Sets how far a ray now has to look.
  GRIDIRON_INLINE void shorten(std::uint32_t ray, float t) { end[ray] = start[ray] + march[ray] * t; }
  /// Ends a ray's search.
  GRIDIRON_INLINE void drop(std::uint32_t ray) { end[ray] = -kFloatMax; }
};

/// A shaft with the interface that walks expect of any bound. @tparam L  lane type; affects only speed.
template <class L>
struct ShaftBound {
  const Shaft& shaft;
  std::uint32_t axis_k = shaft.axis_k, axis_u = shaft.axis_u, axis_v = shaft.axis_v;
  std::int32_t cells_u = shaft.cells_u, cells_v = shaft.cells_v, cells_k = shaft.cells_k;
  bool reverse = shaft.reverse;

  [[nodiscard]] GRIDIRON_INLINE Slab slab_of(std::int32_t first, std::int32_t last) const {
    return shaft.slab_of(first, last);
  }
  [[nodiscard]] GRIDIRON_INLINE bool behind(const Slab& slab) const { return shaft.behind(slab); }
  [[nodiscard]] GRIDIRON_INLINE bool beyond(const Slab& slab, float reach) const { return shaft.beyond(slab, reach); }
  [[nodiscard]] GRIDIRON_INLINE CellRect rect_of(const Slab& slab, WorkCounters& work) const {
    return shaft.rect_of<L>(slab, work);
  }
};

/// Rays travel together if their origins are at most this many cells apart and their slopes differ by no more.
inline constexpr float kTogetherCells = 4.0f;
inline constexpr float kTogetherSlope = 0.5f;

/// Takes a pass of rays out of `waiting`. The first waiting ray decides axis and sign. Rays that start nearby and run
/// the same way along that axis at slopes of at most 2 join; if there are none, it goes alone.
///
/// @param waiting  rays not traced yet, bit i = ray i; those taken leave it. @returns the rays of this pass; 0: none
///                 left.
template <class L>
[[nodiscard]] GRIDIRON_OUTLINE std::uint32_t take_walk_pass(const GridRecord& grid, WalkRays& rays,
                                                            std::uint32_t& waiting, Shaft& shaft, WorkCounters& work) {
  using Float = typename L::Float;
  while (waiting != 0) {
    work.add(Work::kWalkPass);
    const std::uint32_t leader = lowest_bit(waiting);
    waiting &= waiting - 1;
    const auto size_of = [&](std::uint32_t axis) {
      return magnitude(rays.dir[axis][leader] * grid.cells_per_unit[axis]);
    };
    std::uint32_t k = 0;
    if (size_of(1) > size_of(k)) k = 1;
    if (size_of(2) > size_of(k)) k = 2;
    const std::uint32_t u = k == 2 ? 0 : k + 1;
    const std::uint32_t v = u == 2 ? 0 : u + 1;
    const bool reverse = rays.dir[k][leader] < 0.0f;
    // A direction that vanishes or overflows in cell space, or is not finite, is a miss.
    if (!(size_of(k) > 0.0f && size_of(k) <= 0.5f * kFloatMax)) continue;
    shaft.axis_k = k;
    shaft.axis_u = u;
    shaft.axis_v = v;
    shaft.reverse = reverse;
    shaft.cells_k = static_cast<std::int32_t>(grid.cell_count[k]);
    shaft.cells_u = static_cast<std::int32_t>(grid.cell_count[u]);
    shaft.cells_v = static_cast<std::int32_t>(grid.cell_count[v]);
    const float march_scale = reverse ? -grid.cells_per_unit[k] : grid.cells_per_unit[k];
    const auto in_cells = [&](std::uint32_t axis) {
      return (rays.origin[axis][leader] - grid.minimum[axis]) * grid.cells_per_unit[axis];
    };
    const float march_of_leader = rays.dir[k][leader] * march_scale;
    const float leader_place[3] = {reverse ? -in_cells(k) : in_cells(k), in_cells(u), in_cells(v)};
    const float leader_slope[2] = {rays.dir[u][leader] * grid.cells_per_unit[u] / march_of_leader,
                                   rays.dir[v][leader] * grid.cells_per_unit[v] / march_of_leader};
    std::uint32_t active = 0;
    Float least_start(kFloatMax), most_k(0.0f), most_u(0.0f), most_v(0.0f), steepest_u(0.0f), steepest_v(0.0f);
    for (std::uint32_t base = 0; base < kWalkRays; base += L::kCount) {
      const auto cells_of = [&](std::uint32_t axis) GRIDIRON_INLINE_LAMBDA {
        return (Float::load(rays.origin[axis] + base) - Float(grid.minimum[axis])) * Float(grid.cells_per_unit[axis]);
      };
      const Float d_k = Float::load(rays.dir[k] + base), d_u = Float::load(rays.dir[u] + base),
                  d_v = Float::load(rays.dir[v] + base);
      const Float march = d_k * Float(march_scale);
      const Float along_u = d_u * Float(grid.cells_per_unit[u]), along_v = d_v * Float(grid.cells_per_unit[v]);
      const Float slope_u = along_u / march, slope_v = along_v / march;
      const Float from_k = reverse ? -cells_of(k) : cells_of(k);
      const Float from_u = cells_of(u), from_v = cells_of(v);
      const Float apart(kTogetherCells), turned(kTogetherSlope);
      const auto joins =
          (march > Float(0.0f)) & (march <= Float(0.5f * kFloatMax)) & (L::abs(along_u) <= march + march) &
          (L::abs(along_v) <= march + march) & (L::abs(from_k - Float(leader_place[0])) <= apart) &
          (L::abs(from_u - Float(leader_place[1])) <= apart) & (L::abs(from_v - Float(leader_place[2])) <= apart) &
          (L::abs(slope_u - Float(leader_slope[0])) <= turned) & (L::abs(slope_v - Float(leader_slope[1])) <= turned);
      const std::uint32_t candidates = (waiting | 1u << leader) >> base & L::kAllBits;
      const std::uint32_t bits = joins.bits() & candidates;
      active |= bits << base;
      const auto joined = L::mask_from_bits(bits);
      const auto keep = [&](Float value, Float other)
                            GRIDIRON_INLINE_LAMBDA { return L::select(joined, value, other); };
      march.store(shaft.march + base);
      from_k.store(shaft.start + base);
      from_u.store(shaft.place[0] + base);
      from_v.store(shaft.place[1] + base);
      slope_u.store(shaft.slope[0] + base);
      slope_v.store(shaft.slope[1] + base);
      keep(from_k + march * Float::load(rays.t + base), Float(-kFloatMax)).store(shaft.end + base);
      L::max(L::max(L::abs(d_k), L::abs(d_u)), L::abs(d_v)).store(rays.dir_max + base);
      least_start = L::min(least_start, keep(from_k, Float(kFloatMax)));
      most_k = L::max(most_k, keep(L::abs(from_k), Float(0.0f)));
      most_u = L::max(most_u, keep(L::abs(from_u), Float(0.0f)));
      most_v = L::max(most_v, keep(L::abs(from_v), Float(0.0f)));
      steepest_u = L::max(steepest_u, keep(L::abs(slope_u), Float(0.0f)));
      steepest_v = L::max(steepest_v, keep(L::abs(slope_v), Float(0.0f)));
    }
    waiting &= ~active;
    if (active == 0) continue;  // the values of the leader are not used then
    shaft.least_start = L::horizontal_min(least_start);
    constexpr float kUnit = 0x1p-23f;
    constexpr float kSlopeLoss = 0x1p-25f / (9.0f * kUnit);
    const float march_bound = 9.0f * (L::horizontal_max(most_k) + static_cast<float>(shaft.cells_k));
    shaft.pad_k = kUnit * march_bound;
    const auto pad = [&](Float place, Float slope) {
      return kUnit * (6.0f * L::horizontal_max(place) + (L::horizontal_max(slope) + kSlopeLoss) * march_bound) +
             0x1p-60f;
    };
    shaft.pad_u = pad(most_u, steepest_u);
    shaft.pad_v = pad(most_v, steepest_v);
    return active;
  }
  return 0;
}

}  // namespace gridiron
