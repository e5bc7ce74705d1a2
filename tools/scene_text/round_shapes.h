// Spheres, cones and cylinders as facets with corners on the true surface, within a given distance of it. Only the four
// operations and square roots: the same bits on every host.
// Memory: tables of unit shapes, kept. Threads: one. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/math.h>

#include <cstdint>
#include <map>
#include <vector>

namespace gridiron::tool {

/// A closed unit sphere around 0: the icosahedron, each edge cut into `frequency` parts, pushed out to the sphere.
/// 10 f^2 + 2 vertices, which are their own normals, and 20 f^2 triangles turned outwards.
struct UnitSphere {
  std::vector<DVec3> vertices;
  std::vector<UVec3> triangles;
};

inline constexpr std::uint32_t kMostSphereFrequency = 1024;
inline constexpr std::uint32_t kMostCircleSegments = 3u << 18;

/// Unit shapes by fineness, made on first use.
class RoundShapes {
 public:
  /// @returns the least frequency whose facets are within `deviation` (> 0) of the unit sphere, 0 if there is none.
  [[nodiscard]] std::uint32_t sphere_frequency(double deviation);

  /// @param frequency  1..kMostSphereFrequency.
  [[nodiscard]] const UnitSphere& sphere(std::uint32_t frequency);

  /// @returns the least of 3, 4, 6, 8, 12, 16, ... segments whose chords are within `deviation` of the unit circle, 0
  /// if there is none.
  [[nodiscard]] static std::uint32_t circle_segments(double deviation);

  /// @param segments  as circle_segments returns. @returns that many (x, y, 0) on the unit circle from (1, 0, 0) on,
  ///        counter-clockwise.
  [[nodiscard]] const std::vector<DVec3>& circle(std::uint32_t segments);

 private:
  [[nodiscard]] double sphere_deviation(std::uint32_t frequency);

  std::map<std::uint32_t, UnitSphere> spheres_;
  std::map<std::uint32_t, double> deviations_;
  std::map<std::uint32_t, std::vector<DVec3>> circles_;
};

}  // namespace gridiron::tool
