// Frustum: which cells of a slice the rays of a packet can touch. Cell space, one origin, one march axis.
// Source: Wald, Ize, Kensler, Knoll, Parker 2006, section 3.2; slices are recomputed here, never accumulated.
// Memory: values. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/lanes.h>
#include <gridiron/base/records.h>
#include <gridiron/base/work_counters.h>
#include <gridiron/engine/grid/grid_work.h>
#include <gridiron/ray/packet.h>
#include <gridiron/ray/places.h>

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
/// arithmetic the ray is at o_u + s x after marching x. Every quantity below carries at most a handful of roundings: o
/// has 2, s has 4, x has 1 on |x| and 2 on |o_k|, the product and the sum one each. Their sum is at most e (6 |o_u| +
/// |s| (9 |o_k| + 9 N_k)) with e = 2^-23, one unit in any rounding mode, including the addition of the pad. A slope may
/// have a further absolute error of 2^-25: what its numerator loses below the least normal float, 2^-148, over a march
/// of at least 2^-123 (kLeastCellsPerUnit, directions of length 1 or more). pad_u covers both; pad_k likewise.
struct Frustum {
  static constexpr float kReachFactor = 1.0f + 0x1p-20f;  ///< covers the roundings of a reach

  std::uint32_t axis_k, axis_u, axis_v;
  std::int32_t cells_u, cells_v, cells_k;
  bool reverse;    ///< the rays march towards smaller k
  float origin_k;  ///< cell space
  // One lane per bound: u low, u high, v low, v high.
  alignas(16) float start[4];       ///< o_u - pad_u, o_u + pad_u, o_v - pad_v, o_v + pad_v
  alignas(16) float slope_near[4];  ///< slope of the bound while it is reached at the slab's entry, else 0
  alignas(16) float slope_far[4];   ///< the same at the slab's exit
  alignas(16) float limit[4];       ///< cells_u, cells_u, cells_v, cells_v
  float pad_k;

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
    return slab.entry > reach * kReachFactor + pad_k;
  }

  /// Cells of the plane u, v that rays touch between the slab's two ends.
  [[nodiscard]] GRIDIRON_INLINE CellRect rect_of(const Slab& slab) const {
    using Four = Lanes<4>;
    using Float = Four::Float;
    const float far = slab.exit > 0.0f ? slab.exit : 0.0f;
    // One of the two slopes is 0, so that this is start + slope * distance.
    const Float bound =
        Float::load(start) + (Float::load(slope_near) * Float(slab.entry) + Float::load(slope_far) * Float(far));
    const Float cells = Float::load(limit);
    static constexpr std::uint32_t kLowBounds = 0b0101, kHighBounds = 0b1010;
    const std::uint32_t below = (bound < Float(0.0f)).bits() & kHighBounds;
    const std::uint32_t above = (cells < bound).bits() & kLowBounds;
    if ((below | above) != 0) return {1, 0, 1, 0};
    const Float inside = Four::min(Four::max(bound, Float(0.0f)), cells - Float(0.5f));
    const Four::Int cell = Four::truncate(inside);
    return {cell[0], cell[1], cell[2], cell[3]};
  }
  /// The interface that the slice walk expects of any bound; the step's own count includes this work.
  [[nodiscard]] GRIDIRON_INLINE CellRect rect_of(const Slab& slab, WorkCounters&) const { return rect_of(slab); }
};

/// March axis and the two others, and the factors from directions along them to cells; the march's is signed.
struct PassAxes {
  std::uint32_t k, u, v;
  float march_scale, u_scale, v_scale;
};

/// Takes the rays of one square of 2x2 subpackets into a pass, ray by ray, and finds the bounds of their slopes and
/// their greatest march.
template <class L, class PacketType>
GRIDIRON_INLINE void take_square(const PassAxes& axes, std::uint32_t square, RaySet<PacketType::kRayCount>& waiting,
                                 PacketType& packet, WorkCounters& work) {
  using Float = typename L::Float;
  static constexpr std::uint32_t kSquareRays = PacketType::kRayCount / PacketType::kSquareCount;
  Float low_u(kFloatMax), high_u(-kFloatMax), low_v(kFloatMax), high_v(-kFloatMax), high_march(0.0f);
  work.add(GridWork::kPassGroup, kSquareRays / L::kCount);
  for (std::uint32_t base = square * kSquareRays; base < (square + 1) * kSquareRays; base += L::kCount) {
    const Float march = Float::load(packet.dir[axes.k] + base) * Float(axes.march_scale);
    const Float along_u = Float::load(packet.dir[axes.u] + base) * Float(axes.u_scale);
    const Float along_v = Float::load(packet.dir[axes.v] + base) * Float(axes.v_scale);
    const std::uint32_t bits = ((march > Float(0.0f)) & (march <= Float(0.5f * kFloatMax)) &
                                (L::abs(along_u) <= march + march) & (L::abs(along_v) <= march + march))
                                   .bits() &
                               waiting.template group<L>(base);
    packet.active.template set_group<L>(base, bits);
    waiting.template set_group<L>(base, waiting.template group<L>(base) & ~bits);
    const auto joined = L::mask_from_bits(bits);
    high_march = L::max(high_march, L::select(joined, march, Float(0.0f)));
    const Float slope_u = along_u / march;
    const Float slope_v = along_v / march;
    low_u = L::min(low_u, L::select(joined, slope_u, Float(kFloatMax)));
    high_u = L::max(high_u, L::select(joined, slope_u, Float(-kFloatMax)));
    low_v = L::min(low_v, L::select(joined, slope_v, Float(kFloatMax)));
    high_v = L::max(high_v, L::select(joined, slope_v, Float(-kFloatMax)));
  }
  packet.slope_low[0][square] = L::horizontal_min(low_u);
  packet.slope_high[0][square] = L::horizontal_max(high_u);
  packet.slope_low[1][square] = L::horizontal_min(low_v);
  packet.slope_high[1][square] = L::horizontal_max(high_v);
  packet.march_high[square] = L::horizontal_max(high_march);
}

/// The same for all rays of a square at once, from its corners, if all of them wait and surely join.
///
/// A direction is a linear function of the pixel within packet.linear_error. So march and slopes over the square lie
/// between those of its corners, but for the effect of that error on a quotient: with E its size in cells along an
/// axis, at most (E_u + 2 E_k) / (march - E_k) at slopes up to 2. @returns whether they were taken.
template <class PacketType>
[[nodiscard]] GRIDIRON_INLINE bool take_whole_square(const PassAxes& axes, std::uint32_t square,
                                                     RaySet<PacketType::kRayCount>& waiting, PacketType& packet,
                                                     WorkCounters& work) {
  using Four = Lanes<4>;
  using Float = Four::Float;
  static constexpr std::uint32_t kSquareRays = PacketType::kRayCount / PacketType::kSquareCount;
  if constexpr (kSquareRays != 64) return false;
  std::uint32_t* const waiting_words = waiting.words + 2 * square;
  if (!packet.is_linear || (waiting_words[0] & waiting_words[1]) != ~0u) return false;
  work.add(GridWork::kPassSquare);
  const Float column = Float(kSquareOrigins.column[square]) + Float::load(kLanePlaces.corner_column);
  const Float row = Float(kSquareOrigins.row[square]) + Float::load(kLanePlaces.corner_row);
  const auto cells_along = [&](std::uint32_t axis, float scale) GRIDIRON_INLINE_LAMBDA {
    return (Float(packet.first_dir[axis]) + (column * Float(packet.step_x[axis]) + row * Float(packet.step_y[axis]))) *
           Float(scale);
  };
  const Float march = cells_along(axes.k, axes.march_scale);
  const Float along_u = cells_along(axes.u, axes.u_scale);
  const Float along_v = cells_along(axes.v, axes.v_scale);
  const Float error_k(packet.linear_error * magnitude(axes.march_scale));
  const Float error_u(packet.linear_error * axes.u_scale);
  const Float error_v(packet.linear_error * axes.v_scale);
  const Float least_march = march - error_k;
  const Float twice = least_march + least_march;
  const std::uint32_t joining = ((least_march > Float(0.0f)) & (march + error_k <= Float(0.25f * kFloatMax)) &
                                 (Four::abs(along_u) + error_u <= twice) & (Four::abs(along_v) + error_v <= twice))
                                    .bits();
  if (joining != Four::kAllBits) return false;
  const Float inverse = Float(1.0f) / march;
  const Float slope_u = along_u * inverse;
  const Float slope_v = along_v * inverse;
  const Float errors = Four::max(error_u, error_v) + (error_k + error_k);
  const float slack = Four::horizontal_max(errors / least_march);
  packet.slope_low[0][square] = Four::horizontal_min(slope_u) - slack;
  packet.slope_high[0][square] = Four::horizontal_max(slope_u) + slack;
  packet.slope_low[1][square] = Four::horizontal_min(slope_v) - slack;
  packet.slope_high[1][square] = Four::horizontal_max(slope_v) + slack;
  packet.march_high[square] = Four::horizontal_max(march + error_k);
  for (std::uint32_t word = 0; word < 2; ++word) {
    packet.active.words[2 * square + word] = ~0u;
    waiting_words[word] = 0;
  }
  return true;
}

/// Takes a pass of rays out of `waiting`. The first waiting ray decides axis and sign. Every waiting ray that runs the
/// same way along that axis at a slope of at most 2 joins; a ray always joins on its own steepest axis, so six passes
/// empty any packet.
///
/// @param waiting  rays not traced yet; the rays taken leave it. @param packet  its `active` becomes this pass.
/// @returns false if no ray is waiting.
template <class L, class PacketType>
[[nodiscard]] bool take_pass(const GridRecord& grid, RaySet<PacketType::kRayCount>& waiting, PacketType& packet,
                             Frustum& frustum, WorkCounters& work) {
  work.charge_to(Work::kRaySetWord);
  std::uint32_t word = 0;
  while (word < waiting.kWordCount && waiting.words[word] == 0) ++word;
  work.add(Work::kRaySetWord, word);
  if (word == waiting.kWordCount) return false;
  const std::uint32_t leader = 32 * word + lowest_bit(waiting.words[word]);
  work.add(GridWork::kPacketStart);

  const auto size_of = [&](std::uint32_t axis, std::uint32_t ray) {
    return magnitude(packet.dir[axis][ray] * grid.cells_per_unit[axis]);
  };
  std::uint32_t k = 0;
  if (size_of(1, leader) > size_of(k, leader)) k = 1;
  if (size_of(2, leader) > size_of(k, leader)) k = 2;
  const std::uint32_t u = k == 2 ? std::uint32_t{0} : k + 1;
  const std::uint32_t v = u == 2 ? std::uint32_t{0} : u + 1;
  const bool reverse = packet.dir[k][leader] < 0.0f;

  const PassAxes axes{k,
                      u,
                      v,
                      reverse ? -grid.cells_per_unit[k] : grid.cells_per_unit[k],
                      grid.cells_per_unit[u],
                      grid.cells_per_unit[v]};
  for (std::uint32_t square = 0; square < PacketType::kSquareCount; ++square) {
    if (!take_whole_square(axes, square, waiting, packet, work)) take_square<L>(axes, square, waiting, packet, work);
  }
  work.charge_to(GridWork::kPacketStart);
  waiting.erase(leader);  // a direction that vanishes or overflows in cell space, or is not finite, is a miss
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
  static constexpr float kUnit = 0x1p-23f;
  static constexpr float kSlopeLoss = 0x1p-25f / (9.0f * kUnit);  // in units of march_bound * kUnit
  const float march_bound = 9.0f * (magnitude(frustum.origin_k) + static_cast<float>(frustum.cells_k));
  frustum.pad_k = kUnit * march_bound;
  const auto set_bounds = [&](std::uint32_t axis, std::uint32_t lane, float slope_min, float slope_max) {
    const float origin = in_cells(axis);
    const float steepest = larger(magnitude(slope_min), magnitude(slope_max));
    const float pad = kUnit * (6.0f * magnitude(origin) + (steepest + kSlopeLoss) * march_bound) + 0x1p-60f;
    frustum.start[lane] = origin - pad;
    frustum.start[lane + 1] = origin + pad;
    frustum.slope_near[lane] = slope_min < 0.0f ? 0.0f : slope_min;
    frustum.slope_far[lane] = slope_min < 0.0f ? slope_min : 0.0f;
    frustum.slope_near[lane + 1] = slope_max > 0.0f ? 0.0f : slope_max;
    frustum.slope_far[lane + 1] = slope_max > 0.0f ? slope_max : 0.0f;
    frustum.limit[lane] = frustum.limit[lane + 1] = static_cast<float>(grid.cell_count[axis]);
  };
  const auto least = [](const float* values) {
    float result = kFloatMax;
    for (std::uint32_t i = 0; i < PacketType::kSquareCount; ++i) result = values[i] < result ? values[i] : result;
    return result;
  };
  const auto greatest = [](const float* values) {
    float result = -kFloatMax;
    for (std::uint32_t i = 0; i < PacketType::kSquareCount; ++i) result = values[i] > result ? values[i] : result;
    return result;
  };
  work.add(GridWork::kPassSlope, PacketType::kSquareCount);
  const float low_u = least(packet.slope_low[0]), high_u = greatest(packet.slope_high[0]);
  const float low_v = least(packet.slope_low[1]), high_v = greatest(packet.slope_high[1]);
  work.charge_to(GridWork::kPacketStart);
  set_bounds(u, 0, low_u, high_u);
  set_bounds(v, 2, low_v, high_v);
  return true;
}

}  // namespace gridiron
