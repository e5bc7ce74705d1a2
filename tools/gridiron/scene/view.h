// View: where the picture is taken from; what is not asked for is framed automatically.
// Memory: plain values. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/math.h>
#include <gridiron/frame/frame_setup.h>

#include <filesystem>
#include <optional>
#include <string_view>

#include "framing.h"

namespace gridiron::tool {

/// The parts of a view that somebody asked for, in world space; fov in degrees between top and bottom edge.
struct ViewRequest {
  std::optional<Vec3> eye, at, up;
  std::optional<float> fov_degrees;
  std::optional<ViewAngles> from{};  ///< side to frame the scene from; eye and at of others do not count then
};

inline constexpr float kDefaultFovDegrees = 45.0f;

/// Neighbouring rays of narrower views round to the same floats.
inline constexpr float kLeastFovDegrees = 0.001f;

/// @returns true for a field of view that a camera can have: kLeastFovDegrees <= fov < 180.
[[nodiscard]] bool fov_is_possible(float fov_degrees);

/// @returns why no camera can look like that, nullptr where it can: eye on at, up of length 0 or along the view.
[[nodiscard]] const char* view_defect(const Vec3& eye, const Vec3& at, const Vec3& up);

/// @returns the direction of "x,y,z", or of an axis alone: "z", "-x".
[[nodiscard]] std::optional<Vec3> parse_up(std::string_view text);

/// @returns the angles of "front", "back", "left", "right", "top", "bottom", "iso" or "AZIMUTH,ELEVATION" in degrees,
/// with an elevation from -90 to 90.
[[nodiscard]] std::optional<ViewAngles> parse_view_angles(std::string_view text);

/// @returns `base` with the parts that `parts` has. Where `parts` says from which side, eye and at of `base` are gone.
[[nodiscard]] ViewRequest join_view(const ViewRequest& parts, ViewRequest base);

/// Completes a view: up = y, fov = 45; without an eye the points are framed (framing.h), with `at` in the middle of the
/// picture if it was asked for; an eye alone looks at the middle of the points' bounds.
///
/// @param aspect  width over height of the picture.
/// @param points  asked only where eye or at is missing.
/// Errors: Failure (kUsage) where the request has a defect.
[[nodiscard]] Camera complete_view(const ViewRequest& request, double aspect, const PointSource& points);

/// Reads a camera file: lines `eye x y z`, `at x y z`, `up x y z`, `fov degrees`, each at most once, eye and at
/// required; # opens a comment. Errors: Failure (kBadInput), `file:line: reason`.
[[nodiscard]] ViewRequest read_camera_file(const std::filesystem::path& path);

}  // namespace gridiron::tool
