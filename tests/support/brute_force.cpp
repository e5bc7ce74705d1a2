// Ground truth by brute force: see the header. SPDX-License-Identifier: Apache-2.0
#include "support/brute_force.h"

#include <gridiron/base/exact_sum.h>

#include <thread>

// One copy of the filter per instruction set, picked at load time. Sanitizers come up after the picking, so that
// their builds keep to the baseline.
#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define GRIDIRON_TEST_SANITIZED
#endif
#endif
#if defined(__x86_64__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__) && \
    !defined(GRIDIRON_TEST_SANITIZED)
#define GRIDIRON_TEST_CLONES __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define GRIDIRON_TEST_CLONES
#endif

namespace gridiron::test {
namespace {

constexpr std::size_t kWidth = FilterGroup::kWidth;
constexpr std::size_t kRaysAtOnce = 4;
constexpr std::size_t kGroupsAtOnce = 8;
constexpr double kUnit = 0x1p-53;  // rounding unit of double

using Lanes = double __attribute__((vector_size(kWidth * sizeof(double))));
using LaneMask = long long __attribute__((vector_size(kWidth * sizeof(double))));

// Rays as the filter wants them; rows past the last ray repeat it.
struct RayBlock {
  double direction[kRaysAtOnce][3];
  double size;  // largest component of any direction of the frame
};

// Marks, per ray, whether any triangle of up to kGroupsAtOnce groups may be hit. A triangle may not be hit where one
// edge is surely passed on the positive and another surely on the negative side.
GRIDIRON_TEST_CLONES
void find_candidates(const FilterGroup* groups, std::size_t count, const RayBlock& rays, bool any[kRaysAtOnce]) {
  LaneMask kept[kRaysAtOnce] = {};
  for (std::size_t g = 0; g < count; ++g) {
    Lanes normal[3][3];
    Lanes bound[3];
    for (int edge = 0; edge < 3; ++edge) {
      for (int axis = 0; axis < 3; ++axis) {
        normal[edge][axis] = *reinterpret_cast<const Lanes*>(groups[g].normal[edge][axis]);
      }
      bound[edge] = *reinterpret_cast<const Lanes*>(groups[g].bound[edge]) * rays.size;
    }
    for (std::size_t r = 0; r < kRaysAtOnce; ++r) {
      const double* d = rays.direction[r];
      const Lanes e0 = normal[0][0] * d[0] + normal[0][1] * d[1] + normal[0][2] * d[2];
      const Lanes e1 = normal[1][0] * d[0] + normal[1][1] * d[1] + normal[1][2] * d[2];
      const Lanes e2 = normal[2][0] * d[0] + normal[2][1] * d[1] + normal[2][2] * d[2];
      // Sign bits replace comparisons, because compilers split those of wide vectors into scalars.
      const auto positive = reinterpret_cast<LaneMask>(bound[0] - e0) | reinterpret_cast<LaneMask>(bound[1] - e1) |
                            reinterpret_cast<LaneMask>(bound[2] - e2);
      const auto negative = reinterpret_cast<LaneMask>(bound[0] + e0) | reinterpret_cast<LaneMask>(bound[1] + e1) |
                            reinterpret_cast<LaneMask>(bound[2] + e2);
      kept[r] |= ~(positive & negative);
    }
  }
  for (std::size_t r = 0; r < kRaysAtOnce; ++r) {
    long long bits = 0;
    for (std::size_t lane = 0; lane < kWidth; ++lane) bits |= kept[r][lane];
    any[r] = bits < 0;
  }
}

// Side of edge `edge` of triangle `lane` on which the ray passes: +1, -1, or 0 if doubles cannot decide.
int filtered_side(const FilterGroup& group, std::size_t edge, std::size_t lane, const DVec3& d, double size) {
  const double e =
      group.normal[edge][0][lane] * d.x + group.normal[edge][1][lane] * d.y + group.normal[edge][2][lane] * d.z;
  const double bound = group.bound[edge][lane] * size;
  if (e > bound) return 1;
  return e < -bound ? -1 : 0;
}

double largest_component(Vec3 v) {
  return std::max({std::fabs(double{v.x}), std::fabs(double{v.y}), std::fabs(double{v.z})});
}

// A sum of products of three differences of floats, and a sure bound of its error. A term passes at most 3 roundings
// of differences, 2 of products and 3 of sums, so the error is below 9 units of the sum of magnitudes; the bound takes
// 16. Neither overflow nor underflow: a product of three floats or differences lies in 2^[-447, 387] or is zero.
struct BoundedDouble {
  double value;
  double error;
};

BoundedDouble determinant(const DVec3& a, const DVec3& b, const DVec3& c) {
  const double value = a.x * (b.y * c.z - b.z * c.y) + a.y * (b.z * c.x - b.x * c.z) + a.z * (b.x * c.y - b.y * c.x);
  const double magnitude = std::fabs(a.x) * (std::fabs(b.y * c.z) + std::fabs(b.z * c.y)) +
                           std::fabs(a.y) * (std::fabs(b.z * c.x) + std::fabs(b.x * c.z)) +
                           std::fabs(a.z) * (std::fabs(b.x * c.y) + std::fabs(b.y * c.x));
  return {value, 16 * kUnit * magnitude};
}

struct Corners {
  float v[3][3];
};

Corners corners_of(const MeshView& mesh, const UVec3& triangle) {
  Corners corners;
  for (int axis = 0; axis < 3; ++axis) {
    corners.v[0][axis] = mesh.vertices[triangle.x][axis];
    corners.v[1][axis] = mesh.vertices[triangle.y][axis];
    corners.v[2][axis] = mesh.vertices[triangle.z][axis];
  }
  return corners;
}

bool signs_mean_hit(int s0, int s1, int s2) {
  const bool some_positive = s0 > 0 || s1 > 0 || s2 > 0;
  const bool some_negative = s0 < 0 || s1 < 0 || s2 < 0;
  return some_positive != some_negative;
}

}  // namespace

BruteForce::BruteForce(const MeshView& mesh, Vec3 origin, TieRule ties) : mesh_(mesh), origin_(origin), ties_(ties) {
  groups_.resize((mesh.triangles.size() + kWidth - 1) / kWidth);
  const DVec3 o(origin);
  for (std::size_t i = 0; i < groups_.size() * kWidth; ++i) {
    FilterGroup& group = groups_[i / kWidth];
    const std::size_t lane = i % kWidth;
    for (std::size_t edge = 0; edge < 3; ++edge) {
      if (i >= mesh.triangles.size()) {
        // Padding: with a negative bound, zero is surely positive and surely negative.
        for (int axis = 0; axis < 3; ++axis) group.normal[edge][axis][lane] = 0.0;
        group.bound[edge][lane] = -1.0;
        continue;
      }
      const UVec3& t = mesh.triangles[i];
      const std::uint32_t from = edge == 0 ? t.x : edge == 1 ? t.y : t.z;
      const std::uint32_t to = edge == 0 ? t.y : edge == 1 ? t.z : t.x;
      const DVec3 a = DVec3(mesh.vertices[from]) - o;
      const DVec3 b = DVec3(mesh.vertices[to]) - o;
      double magnitude = 0.0;
      for (int axis = 0; axis < 3; ++axis) {
        const int u = (axis + 1) % 3;
        const int v = (axis + 2) % 3;
        group.normal[edge][axis][lane] = a[u] * b[v] - a[v] * b[u];
        magnitude += std::fabs(a[u] * b[v]) + std::fabs(a[v] * b[u]);
      }
      // dot(direction, normal): 7 roundings a term, see `determinant`.
      group.bound[edge][lane] = 16 * kUnit * magnitude;
    }
  }
}

std::vector<TrueHit> BruteForce::trace(std::span<const Vec3> directions, float t_far, unsigned threads,
                                       BruteForceCounts* counts) const {
  std::vector<TrueHit> hits(directions.size());
  const std::size_t thread_count = std::max<std::size_t>(1, std::min<std::size_t>(threads, directions.size()));
  std::vector<BruteForceCounts> thread_counts(thread_count);
  std::vector<std::thread> workers;
  for (std::size_t i = 0; i < thread_count; ++i) {
    const std::size_t begin = directions.size() * i / thread_count;
    const std::size_t end = directions.size() * (i + 1) / thread_count;
    workers.emplace_back([&, i, begin, end] {
      trace_range(directions.subspan(begin, end - begin), t_far, std::span(hits).subspan(begin, end - begin),
                  thread_counts[i]);
    });
  }
  for (std::thread& worker : workers) worker.join();
  if (counts != nullptr) {
    for (const BruteForceCounts& part : thread_counts) {
      counts->pairs += part.pairs;
      counts->candidates += part.candidates;
      counts->exact_signs += part.exact_signs;
      counts->exact_distances += part.exact_distances;
    }
  }
  return hits;
}

void BruteForce::trace_range(std::span<const Vec3> directions, float t_far, std::span<TrueHit> hits,
                             BruteForceCounts& counts) const {
  counts.pairs += directions.size() * mesh_.triangles.size();
  RayBlock rays{};
  for (const Vec3& direction : directions) rays.size = std::max(rays.size, largest_component(direction));

  // Blocks of triangles stay in the cache while all rays pass them.
  constexpr std::size_t kBlockGroups = 8 * kGroupsAtOnce;
  for (std::size_t block = 0; block < groups_.size(); block += kBlockGroups) {
    const std::size_t block_end = std::min(groups_.size(), block + kBlockGroups);
    for (std::size_t first_ray = 0; first_ray < directions.size(); first_ray += kRaysAtOnce) {
      const std::size_t ray_count = std::min(kRaysAtOnce, directions.size() - first_ray);
      for (std::size_t r = 0; r < kRaysAtOnce; ++r) {
        const Vec3& d = directions[first_ray + std::min(r, ray_count - 1)];
        for (int axis = 0; axis < 3; ++axis) rays.direction[r][axis] = double{d[axis]};
      }
      for (std::size_t g = block; g < block_end; g += kGroupsAtOnce) {
        const std::size_t count = std::min(kGroupsAtOnce, block_end - g);
        bool any[kRaysAtOnce];
        find_candidates(&groups_[g], count, rays, any);
        for (std::size_t r = 0; r < ray_count; ++r) {
          if (!any[r]) continue;
          const std::size_t end = std::min(mesh_.triangles.size(), (g + count) * kWidth);
          for (std::size_t i = g * kWidth; i < end; ++i) {
            settle_candidate(i, directions[first_ray + r], t_far, hits[first_ray + r], counts);
          }
        }
      }
    }
  }
}

void BruteForce::settle_candidate(std::size_t triangle, Vec3 direction, float t_far, TrueHit& best,
                                  BruteForceCounts& counts) const {
  const FilterGroup& group = groups_[triangle / kWidth];
  int side[3];
  for (std::size_t edge = 0; edge < 3; ++edge) {
    side[edge] = filtered_side(group, edge, triangle % kWidth, DVec3(direction), largest_component(direction));
  }
  const bool positive = side[0] > 0 || side[1] > 0 || side[2] > 0;
  const bool negative = side[0] < 0 || side[1] < 0 || side[2] < 0;
  if (positive && negative) return;
  ++counts.candidates;

  if (side[0] == 0 || side[1] == 0 || side[2] == 0) {
    const Corners p = corners_of(mesh_, mesh_.triangles[triangle]);
    const float o[3] = {origin_.x, origin_.y, origin_.z};
    const float d[3] = {direction.x, direction.y, direction.z};
    for (std::size_t edge = 0; edge < 3; ++edge) {
      if (side[edge] != 0) continue;
      side[edge] = exact_edge_sign(o, d, p.v[edge], p.v[(edge + 1) % 3]);
      ++counts.exact_signs;
    }
  }
  if (!signs_mean_hit(side[0], side[1], side[2])) return;
  merge(best, triangle, rounded_distance(mesh_.triangles[triangle], direction, counts), direction, t_far);
}

void BruteForce::merge(TrueHit& best, std::size_t triangle, float distance, Vec3 direction, float t_far) const {
  const auto triangle_id = static_cast<std::uint32_t>(triangle);
  if (!(distance > 0.0f) || !(distance <= t_far) || distance > best.distance) return;
  if (distance == best.distance && best.triangle_id != kNoTriangle) {
    int order = 0;
    if (ties_ == TieRule::kExactOrder) {
      const float o[3] = {origin_.x, origin_.y, origin_.z};
      const float d[3] = {direction.x, direction.y, direction.z};
      order = exact_distance_order(o, d, corners_of(mesh_, mesh_.triangles[triangle]).v,
                                   corners_of(mesh_, mesh_.triangles[best.triangle_id]).v);
    }
    if (order > 0 || (order == 0 && triangle_id > best.triangle_id)) return;
  }
  best = {triangle_id, distance};
}

float BruteForce::rounded_distance(const UVec3& triangle, Vec3 direction, BruteForceCounts& counts) const {
  const DVec3 a(mesh_.vertices[triangle.x]);
  const DVec3 b(mesh_.vertices[triangle.y]);
  const DVec3 c(mesh_.vertices[triangle.z]);
  const DVec3 o(origin_);
  const BoundedDouble numerator = determinant(a - o, b - o, c - o);
  const BoundedDouble denominator = determinant(DVec3(direction), b - a, c - a);

  // With relative errors up to 1/8 the quotient is off by at most twice their sum, and by a few roundings.
  const bool sure =
      std::fabs(numerator.value) > 8 * numerator.error && std::fabs(denominator.value) > 8 * denominator.error;
  if (sure) {
    const double quotient = numerator.value / denominator.value;
    if (quotient < 0.0) return 0.0f;
    const double relative =
        2 * (numerator.error / std::fabs(numerator.value) + denominator.error / std::fabs(denominator.value)) +
        8 * kUnit;
    const double low = quotient * (1.0 - relative);
    const double high = quotient * (1.0 + relative);
    if (low >= double{std::numeric_limits<float>::min()} && high <= double{kFloatMax}) {
      const auto rounded_low = static_cast<float>(low);
      if (rounded_low == static_cast<float>(high)) return rounded_low;
    }
  }
  ++counts.exact_distances;
  const Corners p = corners_of(mesh_, triangle);
  const float org[3] = {origin_.x, origin_.y, origin_.z};
  const float dir[3] = {direction.x, direction.y, direction.z};
  return exact_distance(org, dir, p.v[0], p.v[1], p.v[2]);
}

TrueHit BruteForce::trace_in_integers(Vec3 direction, float t_far) const {
  TrueHit best;
  const float o[3] = {origin_.x, origin_.y, origin_.z};
  const float d[3] = {direction.x, direction.y, direction.z};
  for (std::size_t i = 0; i < mesh_.triangles.size(); ++i) {
    const Corners p = corners_of(mesh_, mesh_.triangles[i]);
    const bool hit = signs_mean_hit(exact_edge_sign(o, d, p.v[0], p.v[1]), exact_edge_sign(o, d, p.v[1], p.v[2]),
                                    exact_edge_sign(o, d, p.v[2], p.v[0]));
    if (hit) merge(best, i, exact_distance(o, d, p.v[0], p.v[1], p.v[2]), direction, t_far);
  }
  return best;
}

Vec3 pixel_direction(const FrameRecord& frame, std::uint32_t x, std::uint32_t y) {
  Vec3 direction;
  const auto column = static_cast<float>(x);
  const auto row = static_cast<float>(y);
  for (int axis = 0; axis < 3; ++axis) {
    direction[axis] = (frame.corner[axis] + column * frame.step_x[axis]) + row * frame.step_y[axis];
  }
  return direction;
}

float depth_value(const TrueHit& hit, Vec3 direction) {
  if (hit.triangle_id == kNoTriangle) return kFloatMax;
  const Vec3& d = direction;
  return hit.distance * std::sqrt((d.x * d.x + d.y * d.y) + d.z * d.z);
}

}  // namespace gridiron::test
