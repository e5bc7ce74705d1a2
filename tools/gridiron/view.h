// View: where the picture is taken from; what is not asked for is framed automatically.
// Memory: plain values. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/math.h>
#include <gridiron/frame/frame_setup.h>

#include <filesystem>
#include <optional>

namespace gridiron::tool {

/// The parts of a view that somebody asked for, in world space; fov in degrees between top and bottom edge.
struct ViewRequest {
  std::optional<Vec3> eye, at, up;
  std::optional<float> fov_degrees;
};

inline constexpr float kDefaultFovDegrees = 45.0f;

/// @returns true for a field of view that a pinhole camera can have: 0 < fov < 180.
[[nodiscard]] bool fov_is_possible(float fov_degrees);

/// @returns why no camera can look like that, nullptr where it can: eye on at, up of length 0 or along the view.
[[nodiscard]] const char* view_defect(const Vec3& eye, const Vec3& at, const Vec3& up);

/// @returns `base` with the parts that `parts` has.
[[nodiscard]] ViewRequest join_view(const ViewRequest& parts, ViewRequest base);

/// Completes a view: at = centre of the bounds, eye = at + 1.05 diagonal (0.35, 0.25, 1) / |...|, up = y, fov = 45.
///
/// @param bounds_minimum, bounds_maximum  of the triangles that can be hit: zero-area ones do not move the camera, so
///        that a mesh and the image packed from it are framed alike.
/// Errors: Failure (kUsage) where the request has a defect.
[[nodiscard]] Camera frame_view(const ViewRequest& request, const float bounds_minimum[3],
                                const float bounds_maximum[3]);

/// Reads a camera file: lines `eye x y z`, `at x y z`, `up x y z`, `fov degrees`, each at most once, eye and at
/// required; # opens a comment. Errors: Failure (kBadInput), `file:line: reason`.
[[nodiscard]] ViewRequest read_camera_file(const std::filesystem::path& path);

}  // namespace gridiron::tool
