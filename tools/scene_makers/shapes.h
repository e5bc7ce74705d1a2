// The shapes that make_mesh knows. All are closed: each edge belongs to two triangles that run along it in opposite
// directions, and no triangle has zero area.
// Memory: std::vector. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "scene_makers/mesh.h"

namespace gridiron::scene_makers {

/// The Utah teapot (M. Newell, 1975), y up, 6.4 units from handle to spout, from its 32 bicubic patches.
///
/// @param segments  >= 2: each patch becomes segments x segments quads. 64 s^2 + 8 s triangles.
/// Three closed parts that reach into each other: pot with lid, handle, spout. The patches leave gaps; a flat ring
/// joins lid and rim, and flat caps end handle and spout.
[[nodiscard]] Mesh make_teapot(std::uint32_t segments);

/// Three flat stars, one across each axis, whose rays are slivers that all meet in the stars' two centres.
///
/// @param rays  >= 8, a multiple of 4: rays of one star. 12 triangles a ray.
/// Made with the four operations only: the same bytes everywhere.
[[nodiscard]] Mesh make_needles(std::uint32_t rays);

inline constexpr std::uint32_t kMinKnotTriangles = 600;

/// A tube along the (2, 3) torus knot with exactly the number of triangles asked for.
///
/// @param triangle_count  even (a closed surface has no other count), >= kMinKnotTriangles.
[[nodiscard]] Mesh make_torus_knot(std::uint32_t triangle_count);

}  // namespace gridiron::scene_makers
