// What floats leave open about a ray with an origin of its own and a triangle: doubles decide, then integers. Every
// decision equals that of exact arithmetic.
// Source: own; bounds as derived at edges.h and distance.h. Memory: values. Threads: one core.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/lanes.h>
#include <gridiron/base/records.h>
#include <gridiron/base/work_counters.h>
#include <gridiron/ray/distance.h>
#include <gridiron/ray/edges.h>
#include <gridiron/ray/ray_batch.h>

#include <bit>
#include <cstdint>

namespace gridiron {

/// @returns the sign of det[dir, a - o, b - o], or 0 if floats leave it open. The bound is that of EdgeBatch.
[[nodiscard]] GRIDIRON_OUTLINE inline std::int32_t float_edge_sign(const BatchRay& ray, const float a[3],
                                                                   const float b[3]) {
  float sum[3], edge[3], size_sum = 0.0f, size_edge = 0.0f;
  for (int i = 0; i < 3; ++i) {
    const float from_a = a[i] - ray.origin[i], from_b = b[i] - ray.origin[i];
    sum[i] = from_a + from_b;
    edge[i] = b[i] - a[i];
    size_sum += magnitude(from_a) + magnitude(from_b);
    size_edge = magnitude(edge[i]) > size_edge ? magnitude(edge[i]) : size_edge;
  }
  const float value = (sum[1] * edge[2] - sum[2] * edge[1]) * ray.dir[0] +
                      (sum[2] * edge[0] - sum[0] * edge[2]) * ray.dir[1] +
                      (sum[0] * edge[1] - sum[1] * edge[0]) * ray.dir[2];
  const float range = ray.dir_max > 1.0f ? ray.dir_max : 1.0f;
  const float scale = size_sum * size_edge;
  const float error = scale * (kEdgeErrorFactor * ray.dir_max) + kUnderflow * range;
  if (!(scale * range < kEdgeRangeLimit)) return 0;
  return value > error ? 1 : value < -error ? -1 : 0;
}

/// Decides whether the line of a ray passes through a triangle, boundary included.
[[nodiscard]] GRIDIRON_RARE inline bool passes_through(const BatchRay& ray, const VertexTriangle& triangle,
                                                       WorkCounters& work) {
  bool is_above = false, is_below = false;
  for (int k = 0; k < 3; ++k) {
    const float *const a = triangle.v[k], *const b = triangle.v[k == 2 ? 0 : k + 1];
    std::int32_t sign = float_edge_sign(ray, a, b);
    if (sign == 0) sign = edge_sign(ray.origin, ray.dir, a, b, work);
    is_above = is_above || sign > 0;
    is_below = is_below || sign < 0;
    if (is_above && is_below) return false;
  }
  // Neither: the ray lies in the triangle's plane and hits nothing.
  return is_above || is_below;
}

/// The distance of a ray to a triangle inside which it crosses the plane, rounded to the nearest float; 0 if that is
/// no hit. Doubles, or integers if doubles leave the rounding open.
[[nodiscard]] GRIDIRON_OUTLINE inline float ray_distance(const BatchRay& ray, const VertexTriangle& triangle,
                                                         WorkCounters& work) {
  work.add(Work::kRayDistance);
  const DistanceInterval interval = distance_interval(ray.origin, ray.dir_max, ray.dir, triangle);
  if (interval.high < 0.0) return 0.0f;  // surely behind the origin
  const std::int64_t half_step = std::int64_t{1} << 28;
  const std::int64_t low = (std::bit_cast<std::int64_t>(interval.low) + half_step) >> 29;
  const std::int64_t high = (std::bit_cast<std::int64_t>(interval.high) + half_step) >> 29;
  const std::int64_t rebias = std::int64_t{1023 - 127} << 23;
  const std::int64_t pattern = low - rebias;
  if (low == high && pattern >= 0x00800000 && pattern <= 0x7F7FFFFF) {
    return std::bit_cast<float>(static_cast<std::uint32_t>(pattern));
  }
  work.add(Work::kExactDistance);
  return exact_distance(ray.origin, ray.dir, triangle.v[0], triangle.v[1], triangle.v[2]);
}

}  // namespace gridiron
