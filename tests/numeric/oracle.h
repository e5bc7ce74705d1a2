// The oracle: which triangles of a mesh a ray hits, the nearest of them, and at what distance, decided exactly.
// Source: own; signs and fractions of integers, shares no code with core. README.md says what it promises.
// Memory: std::vector, 100 to 150 bytes a triangle. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/math.h>
#include <gridiron/scene/mesh.h>

#include "numeric/exact_distance.h"
#include "support/median_tree.h"
#include "support/test_headers.h"

namespace gridiron::test {

/// Points origin + t * direction with t_min < t <= t_max. A ray with a component that is not finite hits nothing, nor
/// does one without direction.
struct OracleRay {
  float origin[3];
  float direction[3];
  float t_min = 0.0f;  ///< not negative
  float t_max = kFloatMax;  ///< finite
};

/// How the oracle works; the answers are the same whatever the switches say.
struct OracleSettings {
  Reading reading = Reading::kExact;
  bool use_filter = true;  ///< doubles with a bound of their error first, integers only where these leave it open
  bool use_boxes = true;   ///< a tree of boxes around the triangles instead of every triangle for every ray
};

/// What it took, so that a test can see that the filter filters.
struct OracleCounts {
  std::uint64_t rays = 0;
  std::uint64_t pairs = 0;            ///< (ray, triangle) pairs decided
  std::uint64_t hits = 0;             ///< of them inside and between the limits
  std::uint64_t exact_sides = 0;      ///< edges decided in integers
  std::uint64_t exact_distances = 0;  ///< fractions computed

  void add(const OracleCounts& other);
};

/// One triangle that a ray hits: bounds of its distance, which lies between them.
struct OracleHit {
  std::uint32_t triangle_id;
  double low, high;
};

/// The nearest triangles of a ray.
struct NearestHit {
  std::vector<std::uint32_t> ties;        ///< all triangles at exactly the least distance, ascending; empty: a miss
  std::vector<std::uint32_t> float_ties;  ///< all whose distance rounds to the same float as theirs, ascending
  float t = kFloatMax;                    ///< that float; kFloatMax for a miss

  friend bool operator==(const NearestHit&, const NearestHit&) = default;
};

/// A mesh to shoot exact rays at.
///
/// Hit: the ray's line meets the closed triangle in one point, and that point's distance is between the limits. So a
/// triangle of no area is never hit, nor is one by a ray in its plane. A triangle with a vertex that is not finite is
/// not there.
class Oracle {
 public:
  /// @param mesh  borrowed for the object's life; indices in range.
  explicit Oracle(const MeshView& mesh, OracleSettings settings = {});

  /// All triangles hit, by ascending id.
  [[nodiscard]] std::vector<OracleHit> hits(const OracleRay& ray, OracleCounts* counts = nullptr) const;

  /// The nearest of them, with ties.
  [[nodiscard]] NearestHit nearest(const OracleRay& ray, OracleCounts* counts = nullptr) const;
  /// The same for many rays. @param threads  how many are started, 1 or more; the answer does not depend on it.
  [[nodiscard]] std::vector<NearestHit> nearest(std::span<const OracleRay> rays, unsigned threads,
                                                OracleCounts* counts = nullptr) const;

  /// Distance of a triangle that `hits` or `nearest` has named for this ray.
  [[nodiscard]] ExactDistance distance(const OracleRay& ray, std::uint32_t triangle_id) const;

 private:
  struct RayDoubles;
  enum class Side { kNegative = -1, kZero = 0, kPositive = 1, kUnsure = 2 };

  // Calls visit(triangle) for a superset of the triangles hit at a distance up to `limit`, which it may lower.
  template <class Visit>
  void visit_candidates(const RayDoubles& doubles, double& limit, Visit&& visit) const;
  bool test(const OracleRay& ray, const RayDoubles& doubles, std::uint32_t triangle, OracleHit& hit,
            OracleCounts& counts) const;
  bool is_within_limits(const OracleRay& ray, OracleHit& hit, OracleCounts& counts) const;
  // Ties and float of the nearest of some hits.
  void settle(const OracleRay& ray, std::vector<OracleHit>& found, NearestHit& result, OracleCounts& counts) const;
  [[nodiscard]] float rounded_distance(const OracleRay& ray, const OracleHit& hit, OracleCounts& counts) const;

  MeshView mesh_;
  OracleSettings settings_;
  MedianTree tree_;
};

}  // namespace gridiron::test
