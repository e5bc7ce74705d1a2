// Where rays that leave a surface begin: inside its triangle, lifted off it by no more than rounding requires.
// Source: own. Memory: values. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/lanes.h>
#include <gridiron/base/math.h>
#include <gridiron/base/records.h>
#include <gridiron/base/work_counters.h>
#include <gridiron/ray/distance.h>
#include <gridiron/ray/edges.h>

#include <bit>
#include <cstdint>

namespace gridiron {

/// The point at which secondary rays of a hit begin, and how far from the exact hit it may lie.
///
/// With e = 2^-23, one unit in any rounding mode, M the largest component of the triangle's vertices and L that of its
/// edges, E = e (M + 8 L):
/// - The point is v0 + r, r = w1 (v1 - v0) + w2 (v2 - v0) + lift * normal. The weights are those of the hit by edge
///   functions in floats, made non-negative with a sum of 1: however grazing the ray and wrong the weights, r lies in
///   the triangle but for its own rounding, 2 e L for either edge's part, e L for either sum, less than 7 e L in all;
///   e M is the last sum's. So each component is within E of a point of the triangle, lifted.
/// - lift = 4 E, and a vector whose components are within E is shorter than sqrt(3) E: the point is above the plane by
///   2 E at least, and by 6 E at most. A ray that leaves a convex body from there cannot meet it again.
/// - inset = 16 E: the weights are moved towards their middle, all by the share that takes a point of an edge that far
///   from it.
///   Where another face meets an edge at an angle a on this side, the point is away from it by
///   16 E sin a - 4 E cos a - 2 E > 0 from a = 22 degrees on: no ray begins behind the neighbouring face.
/// - M + 8 L is at least 2^-126: below it E would be less than the least float.
/// - A triangle lower than 48 E has no such point. Its middle is taken, and nothing is promised about neighbouring
///   faces.
struct SecondaryOrigin {
  float point[3];
  float lift;   ///< above the triangle's plane
  float error;  ///< E
};

/// The same on both sides of the surface, and what shading needs in addition.
struct SurfacePoint {
  float before[3];    ///< on the side that the ray comes from
  float behind[3];    ///< on the other
  float normal[3];    ///< unit, by the winding of the corners
  float weights[2];   ///< of corners 1 and 2
  bool enters;        ///< the ray runs against the normal
  float lift, error;  ///< as above
};

namespace secondary_origin_detail {

/// @returns the power of two that scales a normal float into [1, 2), or near it.
[[nodiscard]] inline float scale_to_one(float size) {
  const std::uint32_t exponent = std::bit_cast<std::uint32_t>(size) >> 23;
  if (exponent == 0 || exponent >= 254) return exponent == 0 ? 0x1p126f : 0x1p-127f;
  return std::bit_cast<float>((254 - exponent) << 23);
}

[[nodiscard]] inline float largest(const float v[3]) {
  const float xy = magnitude(v[0]) > magnitude(v[1]) ? magnitude(v[0]) : magnitude(v[1]);
  return magnitude(v[2]) > xy ? magnitude(v[2]) : xy;
}

}  // namespace secondary_origin_detail

/// @param origin, dir  the ray that hits. Precondition: the triangle has an area, the ray hits it (`standard`).
/// @param least_size   a lower limit of M: the greatest coordinate of the points that rays to here come from.
[[nodiscard]] inline SurfacePoint surface_point(const VertexTriangle& triangle, const float origin[3],
                                                const float dir[3], float least_size, WorkCounters& work) {
  using secondary_origin_detail::largest;
  using secondary_origin_detail::scale_to_one;
  // Edges from v0, and the sizes that bound all rounding.
  float e1[3], e2[3], e3[3], seen[3][3];
  float vertex_size = least_size, seen_size = 0.0f;
  for (int i = 0; i < 3; ++i) {
    e1[i] = triangle.v[1][i] - triangle.v[0][i];
    e2[i] = triangle.v[2][i] - triangle.v[0][i];
    e3[i] = triangle.v[2][i] - triangle.v[1][i];
    const float size = largest(triangle.v[i]);
    vertex_size = size > vertex_size ? size : vertex_size;
    for (int k = 0; k < 3; ++k) seen[i][k] = triangle.v[i][k] - origin[k];
    const float distance = largest(seen[i]);
    seen_size = distance > seen_size ? distance : seen_size;
  }
  float edge_size = largest(e1);
  edge_size = largest(e2) > edge_size ? largest(e2) : edge_size;
  edge_size = largest(e3) > edge_size ? largest(e3) : edge_size;
  SurfacePoint result;
  result.error = 0x1p-23f * (vertex_size + 8.0f * edge_size);
  result.lift = 4.0f * result.error;

  // Weights by the volumes that the ray spans with each edge. All sizes are scaled near 1, so that nothing overflows
  // and underflow is harmless.
  const float near_one = scale_to_one(seen_size), dir_to_one = scale_to_one(largest(dir));
  float volume[3];
  float sum = 0.0f;
  for (int k = 0; k < 3; ++k) {
    const float* const a = seen[k == 2 ? 0 : k + 1];
    const float* const b = seen[k == 0 ? 2 : k - 1];
    float value = 0.0f;
    for (int i = 0; i < 3; ++i) {
      const int j = i == 2 ? 0 : i + 1;
      const int l = j == 2 ? 0 : j + 1;
      value += ((a[j] + b[j]) * near_one * ((b[l] - a[l]) * near_one) -
                (a[l] + b[l]) * near_one * ((b[j] - a[j]) * near_one)) *
               (dir[i] * dir_to_one);
    }
    volume[k] = value;
    sum += value;
  }
  // For a hit, all volumes have the sign of their sum.
  float total = 0.0f;
  for (float& value : volume) {
    value = sum < 0.0f ? -value : value;
    value = value > 0.0f ? value : 0.0f;
    total += value;
  }
  const bool has_weights = total > 0x1p-100f;
  const float third = 1.0f / 3.0f;
  float weight1 = has_weights ? volume[1] / total : third;
  float weight2 = has_weights ? volume[2] / total : third;

  // The triangle's least height is at least |e1 x e2| / (sqrt(3) * edge_size); below 2^-18 of its size it is rounding
  // error.
  const float edge_to_one = scale_to_one(edge_size);
  float squared = 0.0f;
  for (int i = 0; i < 3; ++i) {
    const int j = i == 2 ? 0 : i + 1;
    const int l = j == 2 ? 0 : j + 1;
    const float component = e1[j] * edge_to_one * (e2[l] * edge_to_one) - e1[l] * edge_to_one * (e2[j] * edge_to_one);
    squared += component * component;
  }
  const float cross = square_root(squared);  // in units of edge_size squared, between 1 and 4 times
  const float inset = 16.0f * result.error * edge_to_one;
  const float needed = 3.0f * 1.75f * 2.0f * inset;  // 2: edge_size by edge_to_one is below that
  const float drawn = cross > 0x1p-18f && needed < cross ? needed / cross : 1.0f;
  weight1 += (third - weight1) * drawn;
  weight2 += (third - weight2) * drawn;

  set_up_normal(triangle, result.normal);
  float facing = 0.0f;
  for (int i = 0; i < 3; ++i) facing += result.normal[i] * (dir[i] * dir_to_one);
  // The normal has an error of at most 2^-14, so the sum of three such products below 2 has one of at most 2^-11.
  // Grazing rays need a better decision.
  bool leads_along = facing > 0.0f;
  if (magnitude(facing) < 0x1p-10f) leads_along = volume_sign(origin, triangle, work) > 0;
  result.enters = !leads_along;
  result.weights[0] = weight1;
  result.weights[1] = weight2;
  const float lift = leads_along ? -result.lift : result.lift;
  for (int i = 0; i < 3; ++i) {
    const float in_triangle = weight1 * e1[i] + weight2 * e2[i];
    result.before[i] = triangle.v[0][i] + (in_triangle + lift * result.normal[i]);
    result.behind[i] = triangle.v[0][i] + (in_triangle - lift * result.normal[i]);
  }
  return result;
}

/// @param through  whether to begin on the far side of the surface, as refracted rays do.
[[nodiscard]] inline SecondaryOrigin secondary_origin(const VertexTriangle& triangle, const float origin[3],
                                                      const float dir[3], bool through, WorkCounters& work) {
  const SurfacePoint found = surface_point(triangle, origin, dir, 0.0f, work);
  const float* const point = through ? found.behind : found.before;
  return {{point[0], point[1], point[2]}, found.lift, found.error};
}

}  // namespace gridiron
