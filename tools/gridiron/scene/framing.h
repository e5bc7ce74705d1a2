// Framing: the camera from which every point of a scene lies in the picture, with an equal margin on opposite sides.
// Memory: std::vector, a few thousand points. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/math.h>
#include <gridiron/frame/frame_setup.h>

#include <optional>
#include <vector>

#include "base/points.h"

namespace gridiron::tool {

/// Direction from a scene to the eye, in degrees. Azimuth 0 is the front and grows to the right; elevation -90..90
/// grows upwards. With up y the front is +z and the right is +x; with up z the front is -y.
struct ViewAngles {
  double azimuth = 0, elevation = 0;

  friend bool operator==(const ViewAngles&, const ViewAngles&) = default;
};
inline constexpr ViewAngles kDefaultViewAngles = {.azimuth = 30, .elevation = 25};

/// The share of the picture's width and height that stays free on each side of a framed scene.
inline constexpr double kFramingMargin = 0.05;

struct FramingRequest {
  ViewAngles from = kDefaultViewAngles;
  Vec3 up{0, 1, 0};         ///< of any length but 0
  double tan_half_fov = 0;  ///< between top and bottom edge
  double aspect = 1;        ///< width over height of the picture
  std::optional<Vec3> at;   ///< point that the middle of the picture shows; nothing: the scene is centred
};

/// @returns the camera nearest to the scene that looks from the requested side and leaves a margin of kFramingMargin.
/// Its `at` lies in front of the eye, at the depth of the middle of the scene. If the floats of a camera are too coarse
/// (a small scene or `at` far from the origin), it turns a little, and moves back, until the scene is whole and centred
/// again. Precondition: finite points. Cost: one pass over the points; up to 40 if the floats are too coarse.
[[nodiscard]] Camera frame_points(const FramingRequest& request, const PointSource& points);

/// @returns the middle of the points' bounds.
[[nodiscard]] DVec3 middle_of(const PointSource& points);

/// @returns points around the solid that the points sweep when they turn about an axis, at most 0.13 % of its radius
/// away from it: a scene that is framed by them stays whole while it, or the camera, turns.
/// @param place  a point of the axis. @param axis  of any length but 0.
[[nodiscard]] std::vector<Vec3> swept_points(const PointSource& points, const DVec3& place, const DVec3& axis);

}  // namespace gridiron::tool
