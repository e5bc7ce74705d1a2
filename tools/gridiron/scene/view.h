// View: the camera of a picture; missing parts are framed automatically.
// Memory: plain values. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/math.h>
#include <gridiron/frame/frame_setup.h>

#include <filesystem>
#include <optional>
#include <string_view>

#include "framing.h"

namespace gridiron::tool {

/// The given parts of a view, in world space; fov in degrees between top and bottom edge.
struct ViewRequest {
  std::optional<Vec3> eye, at, up;
  std::optional<float> fov_degrees;
  std::optional<ViewAngles> from{};  ///< side to frame the scene from; eye and at of others do not count then
};

inline constexpr float kDefaultFovDegrees = 45.0f;

/// Neighbouring rays of narrower views round to the same floats.
inline constexpr float kLeastFovDegrees = 0.001f;

/// @returns whether a camera can have a field of view: kLeastFovDegrees <= fov < 180.
[[nodiscard]] bool fov_is_possible(float fov_degrees);

/// @returns why a camera is impossible (eye at `at`, up of length 0 or along the view), nullptr if it is possible.
[[nodiscard]] const char* view_defect(const Vec3& eye, const Vec3& at, const Vec3& up);

/// @returns the direction of "x,y,z", or of an axis alone: "z", "-x".
[[nodiscard]] std::optional<Vec3> parse_up(std::string_view text);

/// @returns the angles of "front", "back", "left", "right", "top", "bottom", "iso" or "AZIMUTH,ELEVATION" in degrees,
/// with an elevation from -90 to 90.
[[nodiscard]] std::optional<ViewAngles> parse_view_angles(std::string_view text);

/// @returns `base` with the parts that `parts` has. If `parts` has a side, eye and at of `base` are dropped.
[[nodiscard]] ViewRequest join_view(const ViewRequest& parts, ViewRequest base);

/// Completes a view: up = y, fov = 45. Without an eye the points are framed (framing.h), with a given `at` in the
/// middle of the picture; an eye alone looks at the middle of the points' bounds.
///
/// @param aspect  width over height of the picture. @param points  used only if eye or at is missing.
/// Errors: Failure (kUsage) if the request has a defect.
[[nodiscard]] Camera complete_view(const ViewRequest& request, double aspect, const PointSource& points);

/// Reads a camera file: lines `eye x y z`, `at x y z`, `up x y z`, `fov degrees`, each at most once, eye and at
/// required; # opens a comment. Errors: Failure (kBadInput), `file:line: reason`.
[[nodiscard]] ViewRequest read_camera_file(const std::filesystem::path& path);

}  // namespace gridiron::tool
