// The `standard` test for rays with origins of their own: which of up to 16 rays a triangle stops, or is the nearest
// hit of. Floats with a bound of their error, then doubles, then integers: every decision equals that of exact
// arithmetic.
// Source: own; bounds as derived at edges.h and distance.h. Memory: values. Threads: one core.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/exact_sum.h>
#include <gridiron/base/lanes.h>
#include <gridiron/base/math.h>
#include <gridiron/base/records.h>
#include <gridiron/base/work_counters.h>
#include <gridiron/ray/distance.h>
#include <gridiron/ray/edges.h>
#include <gridiron/ray/walk_rays.h>

#include <bit>
#include <cstdint>

namespace gridiron {

/// A triangle, prepared for lanes.
struct RayTriangle {
  float edge[3][3];      ///< from vertex i to vertex i + 1
  float edge_size[3];    ///< largest |component|
  float normal[3];       ///< (b - a) x (c - a)
  float normal_size[3];  ///< sums of the magnitudes of its products
};

GRIDIRON_INLINE void set_up_ray_triangle(const VertexTriangle& triangle, RayTriangle& set) {
  for (int k = 0; k < 3; ++k) {
    const int next = k == 2 ? 0 : k + 1;
    float largest = 0.0f;
    for (int i = 0; i < 3; ++i) {
      set.edge[k][i] = triangle.v[next][i] - triangle.v[k][i];
      largest = magnitude(set.edge[k][i]) > largest ? magnitude(set.edge[k][i]) : largest;
    }
    set.edge_size[k] = largest;
  }
  for (int i = 0; i < 3; ++i) {
    const int j = i == 2 ? 0 : i + 1;
    const int l = j == 2 ? 0 : j + 1;
    // c - a is the last edge reversed.
    const float first = set.edge[0][l] * set.edge[2][j];
    const float second = set.edge[0][j] * set.edge[2][l];
    set.normal[i] = first - second;
    set.normal_size[i] = magnitude(first) + magnitude(second);
  }
}

/// Decides whether the line of one ray passes through a triangle, boundary included. The float test's sure signs are
/// given. @param above, below  bit k: surely on that side of edge k.
[[nodiscard]] GRIDIRON_RARE inline bool passes_through(const WalkRays& rays, std::uint32_t ray,
                                                       const VertexTriangle& triangle, std::uint32_t above,
                                                       std::uint32_t below, WorkCounters& work) {
  const float origin[3] = {rays.origin[0][ray], rays.origin[1][ray], rays.origin[2][ray]};
  const float dir[3] = {rays.dir[0][ray], rays.dir[1][ray], rays.dir[2][ray]};
  std::uint32_t known = above | below;
  for (int k = 0; k < 3; ++k) {
    if ((known >> k & 1u) != 0) continue;
    const int sign = edge_sign_in_double(origin, dir, triangle.v[k], triangle.v[k == 2 ? 0 : k + 1], work);
    if (sign > 0) above |= 1u << k;
    if (sign < 0) below |= 1u << k;
  }
  // Neither: the ray lies in the triangle's plane and hits nothing.
  return (above == 0) != (below == 0);
}

/// The distance of one ray to a triangle inside which it crosses the plane, rounded to the nearest float; 0 if that is
/// no hit. Doubles, or integers if doubles leave the rounding open.
[[nodiscard]] GRIDIRON_OUTLINE inline float ray_distance(const WalkRays& rays, std::uint32_t ray,
                                                         const VertexTriangle& triangle, WorkCounters& work) {
  work.add(Work::kRayDistance);
  const float origin[3] = {rays.origin[0][ray], rays.origin[1][ray], rays.origin[2][ray]};
  const float dir[3] = {rays.dir[0][ray], rays.dir[1][ray], rays.dir[2][ray]};
  const DistanceInterval interval = distance_interval(origin, rays.dir_max[ray], dir, triangle);
  const std::int64_t half_step = std::int64_t{1} << 28;
  const std::int64_t low = (std::bit_cast<std::int64_t>(interval.low) + half_step) >> 29;
  const std::int64_t high = (std::bit_cast<std::int64_t>(interval.high) + half_step) >> 29;
  const std::int64_t rebias = std::int64_t{1023 - 127} << 23;
  const std::int64_t pattern = low - rebias;
  if (low == high && pattern >= 0x00800000 && pattern <= 0x7F7FFFFF) {
    return std::bit_cast<float>(static_cast<std::uint32_t>(pattern));
  }
  work.add(Work::kExactDistance);
  return exact_distance(origin, dir, triangle.v[0], triangle.v[1], triangle.v[2]);
}

/// Tests a triangle against rays.
///
/// @param wanted   rays, bit i = ray i. @param settled  out: of these, rays that it surely stops at 0 < t <= rays.t.
/// @returns rays that it may stop, or be nearer to: ray_distance decides. With any_hit, only those that floats leave
/// open.
template <class L>
[[nodiscard]] GRIDIRON_OUTLINE std::uint32_t rays_near(const WalkRays& rays, std::uint32_t wanted,
                                                       const VertexTriangle& triangle, bool trusts_floats,
                                                       std::uint32_t& settled, WorkCounters& work) {
  using Float = typename L::Float;
  work.add(Work::kRayTriangleSetup);
  work.charge_to(Work::kRayTriangleSetup);
  RayTriangle set;
  set_up_ray_triangle(triangle, set);
  work.charge_to(Work::kRayGroupTest);
  std::uint32_t open = 0;
  settled = 0;
  for (std::uint32_t base = 0; base < kWalkRays; base += L::kCount) {
    const std::uint32_t active = wanted >> base & L::kAllBits;
    if (active == 0) continue;
    work.add(Work::kRayGroupTest);
    const Float d_x = Float::load(rays.dir[0] + base), d_y = Float::load(rays.dir[1] + base),
                d_z = Float::load(rays.dir[2] + base);
    const Float o_x = Float::load(rays.origin[0] + base), o_y = Float::load(rays.origin[1] + base),
                o_z = Float::load(rays.origin[2] + base);
    const Float dir_max = Float::load(rays.dir_max + base);
    const Float range = L::max(dir_max, Float(1.0f));
    const Float underflow = range * Float(kUnderflow);
    Float x[3], y[3], z[3], size[3];
    for (int k = 0; k < 3; ++k) {
      x[k] = Float(triangle.v[k][0]) - o_x;
      y[k] = Float(triangle.v[k][1]) - o_y;
      z[k] = Float(triangle.v[k][2]) - o_z;
      size[k] = L::abs(x[k]) + L::abs(y[k]) + L::abs(z[k]);
    }
    // Sides of the three edges, as in edges.h.
    std::uint32_t above[3], below[3];
    std::uint32_t in_range = L::kAllBits;
    for (int k = 0; k < 3; ++k) {
      const int next = k == 2 ? 0 : k + 1;
      const Float s_x = x[k] + x[next], s_y = y[k] + y[next], s_z = z[k] + z[next];
      const Float f_x(set.edge[k][0]), f_y(set.edge[k][1]), f_z(set.edge[k][2]);
      const Float side =
          (s_y * f_z - s_z * f_y) * d_x + (s_z * f_x - s_x * f_z) * d_y + (s_x * f_y - s_y * f_x) * d_z;
      const Float scale = (size[k] + size[next]) * Float(set.edge_size[k]);
      const Float error = scale * (dir_max * Float(kEdgeErrorFactor)) + underflow;
      in_range &= (scale * range < Float(kEdgeRangeLimit)).bits();
      const Float bound = trusts_floats ? Float(0.0f) : error;
      above[k] = (side > bound).bits();
      below[k] = (side < -bound).bits();
    }
    for (int k = 0; k < 3; ++k) {
      above[k] &= in_range;
      below[k] &= in_range;
    }
    const std::uint32_t any_above = above[0] | above[1] | above[2], any_below = below[0] | below[1] | below[2];
    std::uint32_t through = active & ~(any_above & any_below);
    if (through == 0) continue;
    const std::uint32_t sure = (above[0] & above[1] & above[2]) | (below[0] & below[1] & below[2]);
    std::uint32_t unsure = through & ~sure;
    if (unsure != 0) [[unlikely]] {
      for (; unsure != 0; unsure &= unsure - 1) {
        const std::uint32_t lane = lowest_bit(unsure);
        const auto bits_of = [&](const std::uint32_t* sides) {
          return (sides[0] >> lane & 1u) | (sides[1] >> lane & 1u) << 1 | (sides[2] >> lane & 1u) << 2;
        };
        const bool inside = trusts_floats && (in_range >> lane & 1u) != 0
                                ? ((any_above | any_below) >> lane & 1u) != 0
                                : passes_through(rays, base + lane, triangle, bits_of(above), bits_of(below), work);
        if (!inside) through &= ~(1u << lane);
      }
      work.charge_to(Work::kRayGroupTest);
      if (through == 0) continue;
    }
    // Where along the ray: numerator / denominator against 0 and t. Errors as in DistanceSetup, with e for u.
    const Float n_x(set.normal[0]), n_y(set.normal[1]), n_z(set.normal[2]);
    const Float numerator = x[0] * n_x + y[0] * n_y + z[0] * n_z;
    const Float numerator_error = (L::abs(x[0]) * Float(set.normal_size[0]) + L::abs(y[0]) * Float(set.normal_size[1]) +
                                   L::abs(z[0]) * Float(set.normal_size[2])) *
                                      Float(2.0f * kFloatError) +
                                  underflow;
    const Float denominator = d_x * n_x + d_y * n_y + d_z * n_z;
    const Float denominator_error =
        dir_max * Float((set.normal_size[0] + set.normal_size[1] + set.normal_size[2]) * (2.0f * kFloatError)) +
        underflow;
    const auto backwards = denominator < Float(0.0f);
    const Float ahead = L::flip_sign(backwards, numerator);
    const Float t = Float::load(rays.t + base);
    const Float limit = L::abs(denominator) * t;
    const Float limit_error = denominator_error * t + limit * Float(0x1p-22f) + numerator_error;
    // NaN and infinities make all of these false.
    const std::uint32_t sign_known = (L::abs(denominator) > denominator_error).bits() & in_range;
    const std::uint32_t in_front = (ahead > numerator_error).bits() & sign_known;
    const std::uint32_t behind = (ahead < -numerator_error).bits() & sign_known;
    const std::uint32_t beyond = (ahead - limit > limit_error).bits() & sign_known;
    const std::uint32_t within = (limit - ahead > limit_error).bits() & in_front;
    through &= ~(behind | beyond);
    settled |= (through & within) << base;
    open |= (through & ~within) << base;
  }
  return open;
}

}  // namespace gridiron
