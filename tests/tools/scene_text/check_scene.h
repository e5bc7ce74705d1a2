// What holds for every scene that the reader accepts, and for shapes made of triangles.
// Memory: none kept. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/math.h>

#include <span>
#include <string>
#include <string_view>

#include "scene_text/scene_description.h"
#include "scene_text/scene_reader.h"

namespace gridiron::test {

/// A view, so that a test's own lines begin on line 2.
inline constexpr std::string_view kView = "v from 0 0 9 at 0 0 0 up 0 1 0 angle 40 hither 0 resolution 8 6 ";
inline constexpr std::string_view kViewAndFill =
    "v from 0 0 9 at 0 0 0 up 0 1 0 angle 40 hither 0 resolution 8 6 f 1 1 1 1 0 0 0 0 ";

/// Reads a text that must be right; a test failure with the reader's complaint otherwise.
[[nodiscard]] tool::SceneDescription read_good(std::string_view text, const tool::SceneOptions& options = {},
                                               const std::string& path = "test.nff");

/// @returns what the reader says to a text that must be wrong; a test failure where it accepts it.
[[nodiscard]] std::string complaint(std::string_view text, const tool::SceneOptions& options = {},
                                    const std::string& path = "test.nff");

/// Checks indices, counts, ranges and unit normals of a description; every material in use, smooth ones with normals.
void expect_sound(const tool::SceneDescription& scene);

/// @returns the number of edges along which no triangle runs in the opposite direction; vertices are compared by index.
[[nodiscard]] std::size_t count_open_edges(std::span<const UVec3> triangles);

/// @returns the volume inside closed triangles that are turned outwards; negative where they are turned inwards.
[[nodiscard]] double signed_volume(std::span<const Vec3> vertices, std::span<const UVec3> triangles);

/// @returns twice the area vectors of triangles, added.
[[nodiscard]] DVec3 doubled_area(std::span<const Vec3> vertices, std::span<const UVec3> triangles);

}  // namespace gridiron::test
