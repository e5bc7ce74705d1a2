// Ground truth of accuracies `standard` and `exact`: every ray against every triangle. No grid, packet or transfer
// code. Memory: std::vector, 96 bytes a triangle. Threads: starts its own. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/records.h>
#include <gridiron/scene/mesh.h>

#include "support/test_headers.h"

namespace gridiron::test {

/// Which of two triangles at the same rounded distance is a ray's hit.
enum class TieRule : std::uint8_t {
  kLeastId,     ///< that of the lower id: `standard`
  kExactOrder,  ///< that which is nearer before rounding, of equals that of the lower id: `exact`
};

/// Nearest hit of a ray: least (distance, triangle_id).
struct TrueHit {
  std::uint32_t triangle_id = kNoTriangle;
  float distance = kFloatMax;  ///< in units of the ray's direction, correctly rounded; kFloatMax where nothing is hit

  friend bool operator==(const TrueHit&, const TrueHit&) = default;
};

/// What the filtered search did, so that a test can see that its filter filters.
struct BruteForceCounts {
  std::uint64_t pairs = 0;            ///< (ray, triangle) pairs decided
  std::uint64_t candidates = 0;       ///< pairs that the filter did not reject
  std::uint64_t exact_signs = 0;      ///< edge signs decided in integers
  std::uint64_t exact_distances = 0;  ///< distances rounded in integers
};

/// Triangles of one filter step. Edge e of triangle i has its plane through the origin at normal[e][..][i]; a ray's
/// side of it, dot(direction, normal), is sure where it exceeds bound[e][i] * (largest component of the direction).
struct alignas(64) FilterGroup {
  static constexpr std::size_t kWidth = 8;
  double normal[3][3][kWidth];  ///< [edge][axis][triangle]
  double bound[3][kWidth];
};

/// The triangles of a mesh as seen from the one origin that all rays of a frame leave.
class BruteForce {
 public:
  /// @param mesh    borrowed for the object's life; finite vertices, indices in range.
  /// @param origin  finite.
  BruteForce(const MeshView& mesh, Vec3 origin, TieRule ties = TieRule::kLeastId);

  /// Nearest hits of rays origin + t * direction, 0 < t <= t_far. A filter in double precision with a proven error
  /// bound rejects most pairs; integers decide wherever doubles are unsure.
  ///
  /// @param directions  finite. @returns one hit per direction, whatever the number of threads.
  std::vector<TrueHit> trace(std::span<const Vec3> directions, float t_far, unsigned threads,
                             BruteForceCounts* counts = nullptr) const;

  /// The same for one ray by integers alone: no filter, no floating-point number.
  [[nodiscard]] TrueHit trace_in_integers(Vec3 direction, float t_far) const;

 private:
  void trace_range(std::span<const Vec3> directions, float t_far, std::span<TrueHit> hits,
                   BruteForceCounts& counts) const;
  void settle_candidate(std::size_t triangle, Vec3 direction, float t_far, TrueHit& best,
                        BruteForceCounts& counts) const;
  void merge(TrueHit& best, std::size_t triangle, float distance, Vec3 direction, float t_far) const;
  float rounded_distance(const UVec3& triangle, Vec3 direction, BruteForceCounts& counts) const;

  MeshView mesh_;
  Vec3 origin_;
  TieRule ties_;
  std::vector<FilterGroup> groups_;
};

/// Direction of the ray through the centre of pixel (x, y) as FrameRecord defines it.
Vec3 pixel_direction(const FrameRecord& frame, std::uint32_t x, std::uint32_t y);

/// Value of the depth plane: distance along the unit direction, kFloatMax where nothing is hit.
float depth_value(const TrueHit& hit, Vec3 direction);

}  // namespace gridiron::test
