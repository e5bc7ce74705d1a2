// Polygons to triangles: ear clipping, signs decided exactly.
// Memory: std::vector. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/math.h>

#include <cstdint>
#include <span>
#include <vector>

namespace gridiron::tool {

inline constexpr std::uint32_t kMostPolygonCorners = 1024;  ///< clipping costs up to their cube

enum class PolygonDefect : std::uint8_t {
  kNone,
  kNoArea,   ///< all corners on a line
  kCrosses,  ///< the outline crosses itself, or runs back on itself so that nothing is inside
};

/// The result of triangulate_polygon.
struct PolygonResult {
  PolygonDefect defect = PolygonDefect::kNone;
  double plane_distance = 0;  ///< largest distance of a corner from the plane through the corners' mean
};

/// Cuts a polygon into triangles that keep its direction.
///
/// The outline is projected along the axis that its normal (Newell's sum) is closest to; all signs are exact. Corners
/// on an edge stay corners of triangles; corners equal to the one before and spikes without area are dropped. An
/// outline may touch itself, for example around a hole.
/// @param corners    3..kMostPolygonCorners, finite.
/// @param triangles  appended to: indices into corners, each of positive area as seen.
/// Cost: corners^2, at worst corners^3 / 6 tests. Source: G. H. Meisters, "Polygons have ears", 1975.
[[nodiscard]] PolygonResult triangulate_polygon(std::span<const Vec3> corners, std::vector<UVec3>& triangles);

}  // namespace gridiron::tool
