// What edges.h and distance.h compute once per triangle, and their exact decisions. SPDX-License-Identifier: Apache-2.0
#include <gridiron/base/exact_sum.h>
#include <gridiron/ray/distance.h>
#include <gridiron/ray/edges.h>

#include <bit>

namespace gridiron {
namespace {

// normal = (b - a) x (c - a) with, per component, the sum of the magnitudes of its two products.
template <class Real>
void normal_of(const VertexTriangle& triangle, Real normal[3], Real products[3]) {
  Real e1[3], e2[3];
  for (int i = 0; i < 3; ++i) {
    e1[i] = Real{triangle.v[1][i]} - Real{triangle.v[0][i]};
    e2[i] = Real{triangle.v[2][i]} - Real{triangle.v[0][i]};
  }
  for (int i = 0; i < 3; ++i) {
    const int j = i == 2 ? 0 : i + 1;
    const int k = j == 2 ? 0 : j + 1;
    const Real first = e1[j] * e2[k];
    const Real second = e1[k] * e2[j];
    normal[i] = first - second;
    products[i] = magnitude(first) + magnitude(second);
  }
}

// A triangle's plane as an origin sees it, in double.
struct Plane {
  double normal[3];
  double volume;                      // normal . (corner - origin)
  double normal_error, volume_error;  // bounds; the first one of normal . direction, for directions of at most 1
};
GRIDIRON_OUTLINE Plane plane_of(const float origin[3], const VertexTriangle& triangle) {
  Plane plane{};
  double products[3];
  normal_of(triangle, plane.normal, products);
  for (int i = 0; i < 3; ++i) {
    const double a = double{triangle.v[0][i]} - double{origin[i]};
    plane.volume += a * plane.normal[i];
    plane.volume_error += magnitude(a) * products[i];
  }
  plane.volume_error *= kDistanceError;
  plane.normal_error = kDistanceError * (products[0] + products[1] + products[2]);
  return plane;
}

// Compares the bits: where denormals are flushed, they compare equal to zero and to each other.
bool is_same(float a, float b) {
  const std::uint32_t bits_a = std::bit_cast<std::uint32_t>(a);
  const std::uint32_t bits_b = std::bit_cast<std::uint32_t>(b);
  return bits_a == bits_b;
}

}  // namespace

void set_up_distance(const float origin[3], float dir_max, const VertexTriangle& triangle, DistanceSetup& setup) {
  const Plane plane = plane_of(origin, triangle);
  for (int i = 0; i < 3; ++i) setup.normal[i] = plane.normal[i];
  setup.numerator = plane.volume;
  // A numerator of 0 makes these NaN or infinite, that is unsure, which is correct.
  setup.relative_error = plane.volume_error / magnitude(plane.volume) + 0x1p-50;
  setup.relative_error_per_t = double{dir_max} * plane.normal_error / magnitude(plane.volume);
}

void set_up_plane_normal(const VertexTriangle& triangle, PlaneNormal& plane) {
  normal_of(triangle, plane.normal, plane.products);
}

DistanceInterval distance_interval(const float origin[3], float dir_max, const float dir[3],
                                   const VertexTriangle& triangle) {
  const Plane plane = plane_of(origin, triangle);
  double denominator = 0.0;
  for (int i = 0; i < 3; ++i) denominator += double{dir[i]} * plane.normal[i];
  // The errors of DistanceSetup with one division: the quotient has one rounding more.
  const double inverse = 1.0 / denominator;
  const double quotient = plane.volume * inverse;
  const double size = magnitude(quotient);
  const double error =
      (plane.volume_error + size * (double{dir_max} * plane.normal_error)) * magnitude(inverse) + 0x1p-49 * size;
  // False for NaN too; the distance is unknown then.
  if (!(size > 0.0 && error < 0x1p-10 * size)) return {0.0, static_cast<double>(kInfinity)};
  return {quotient - error, quotient + error};
}

DistanceEstimate set_up_estimate(const float origin[3], float dir_max, const VertexTriangle& triangle) {
  DistanceEstimate estimate;
  float size[3];
  normal_of(triangle, estimate.normal, size);
  float numerator = 0.0f, numerator_size = 0.0f, distance_size = 0.0f;
  for (int i = 0; i < 3; ++i) {
    const float from_origin = triangle.v[0][i] - origin[i];
    numerator += from_origin * estimate.normal[i];
    numerator_size += magnitude(from_origin) * size[i];
    distance_size += magnitude(from_origin);
  }
  const float normal_size = size[0] + size[1] + size[2];
  const float denominator_size = dir_max * normal_size;
  estimate.numerator = magnitude(numerator);
  if (numerator < 0.0f) {
    for (float& component : estimate.normal) component = -component;
  }
  estimate.least_denominator = kUncertain * denominator_size;
  const bool is_close = normal_size < 0x1p40f && distance_size < 0x1p40f && dir_max < 0x1p40f &&
                        denominator_size > 0x1p-60f && magnitude(numerator) > 0x1p-40f &&
                        magnitude(numerator) > kUncertain * numerator_size;
  if (!is_close) estimate.least_denominator = kInfinity;
  return estimate;
}

bool in_one_plane(const VertexTriangle& first, const VertexTriangle& second) {
  for (int axis = 0; axis < 3; ++axis) {
    const float place = first.v[0][axis];
    bool is_across = true;
    for (int i = 0; i < 3; ++i) {
      is_across = is_across && is_same(first.v[i][axis], place) && is_same(second.v[i][axis], place);
    }
    if (is_across) return true;
  }
  std::uint32_t equal_count = 0;
  for (const float(&a)[3] : first.v) {
    for (const float(&b)[3] : second.v) {
      equal_count += is_same(a[0], b[0]) && is_same(a[1], b[1]) && is_same(a[2], b[2]) ? 1u : 0u;
    }
  }
  return equal_count == 3;
}

bool surely_in_one_plane(const VertexTriangle& first, const VertexTriangle& second, WorkCounters& work) {
  for (const float(&corner)[3] : second.v) {
    bool is_shared = false;
    for (const float(&other)[3] : first.v) {
      is_shared =
          is_shared || (is_same(corner[0], other[0]) && is_same(corner[1], other[1]) && is_same(corner[2], other[2]));
    }
    if (!is_shared && volume_sign(corner, first, work) != 0) return false;
  }
  return true;
}

void set_up_normal(const VertexTriangle& triangle, float normal[3]) {
  float size[3];
  normal_of(triangle, normal, size);
  const float squared = normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2];
  const float normal_size = size[0] + size[1] + size[2];
  // The error of a component is below 4 e normal_size: 2^-17 of a length of at least normal_size / 16.
  if (normal_size > 0x1p-40f && normal_size < 0x1p40f && squared > 0x1p-8f * (normal_size * normal_size)) {
    const float scale = 1.0f / square_root(squared);
    for (int i = 0; i < 3; ++i) normal[i] *= scale;
    return;
  }
  double sure[3], products[3];
  normal_of(triangle, sure, products);
  const double sure_size = products[0] + products[1] + products[2];
  double squared_length = sure[0] * sure[0] + sure[1] * sure[1] + sure[2] * sure[2];
  // The error of a component is below 2^-50 of that size: if it exceeds 2^-20 of the length, only integers can decide.
  if (!(squared_length > 0x1p-60 * (sure_size * sure_size))) {
    exact_normal(triangle.v[0], triangle.v[1], triangle.v[2], sure);
    squared_length = sure[0] * sure[0] + sure[1] * sure[1] + sure[2] * sure[2];
  }
  const double scale = squared_length > 0.0 ? 1.0 / square_root(squared_length) : 0.0;
  for (int i = 0; i < 3; ++i) normal[i] = static_cast<float>(sure[i] * scale);
}

// The float test's form and bound with u = 2^-52 in the place of 2^-23; nothing here can leave the range of a double.
std::int32_t edge_sign(const float origin[3], const float dir[3], const float a[3], const float b[3],
                       WorkCounters& work) {
  work.add(Work::kDoubleSign);
  double sum[3], edge[3];
  double size_sum = 0.0, size_edge = 0.0, size_dir = 0.0;
  for (int i = 0; i < 3; ++i) {
    const double from_a = double{a[i]} - double{origin[i]};
    const double from_b = double{b[i]} - double{origin[i]};
    sum[i] = from_a + from_b;
    edge[i] = double{b[i]} - double{a[i]};
    size_sum += magnitude(from_a) + magnitude(from_b);
    size_edge = magnitude(edge[i]) > size_edge ? magnitude(edge[i]) : size_edge;
    size_dir = magnitude(double{dir[i]}) > size_dir ? magnitude(double{dir[i]}) : size_dir;
  }
  const double value = (sum[1] * edge[2] - sum[2] * edge[1]) * dir[0] + (sum[2] * edge[0] - sum[0] * edge[2]) * dir[1] +
                       (sum[0] * edge[1] - sum[1] * edge[0]) * dir[2];
  const double error = 0x1p-47 * size_sum * size_edge * size_dir;
  if (value > error) return 1;
  if (value < -error) return -1;
  work.add(Work::kExactSign);
  return exact_edge_sign(origin, dir, a, b);
}

std::int32_t volume_sign(const float origin[3], const VertexTriangle& triangle, WorkCounters& work) {
  const Plane plane = plane_of(origin, triangle);
  if (plane.volume > plane.volume_error) return 1;
  if (plane.volume < -plane.volume_error) return -1;
  work.add(Work::kExactSign);
  return exact_volume_sign(origin, triangle.v[0], triangle.v[1], triangle.v[2]);
}

}  // namespace gridiron
