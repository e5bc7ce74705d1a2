// Look: gives a mesh lights, a ground, a colour, smooth normals and a background, so that its picture is worth showing.
// Memory: owns what it adds. Threads: one. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/effect_records.h>
#include <gridiron/base/math.h>

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "look_request.h"
#include "scene_input.h"
#include "view.h"

namespace gridiron::tool {

inline constexpr Vec3 kUsualUp = {0, 1, 0};

/// Where an object lies: the box around it, or around all frames of a series, and its lowest place.
struct LookBounds {
  DVec3 low{0.0}, high{0.0};
  DVec3 up{kUsualUp};  ///< unit: away from the ground
  double lowest = 0;   ///< the least product of a point and up
};

/// @returns the bounds of the points. @param up  away from the ground; not zero. Precondition: there are some points.
[[nodiscard]] LookBounds look_bounds_of(const PointSource& points, const Vec3& up);

/// @returns the colour of "RRGGBB", "#RRGGBB", sRGB, or of a name of color_names(): linear, 0..1 each.
[[nodiscard]] std::optional<Vec3> parse_color(std::string_view text);

/// Names that parse_color() knows: "white", "grey", "black", "clay", ...
[[nodiscard]] std::span<const std::string_view> color_names();

/// @returns the lights of "none", or of a list of "head", "key", "area" with commas.
[[nodiscard]] std::optional<LookLights> parse_lights(std::string_view text);

/// Puts a mesh into its look: triangles of the ground behind its own, effects beside it. For a text scene replaces
/// background, samples, occlusion and levels of its own.
///
/// Directions: the lights stand still, where the first view has its left and its up. The key light, a small square,
/// shines from the left over the viewer's shoulder; the area light, a large one, from the right; both from so far away
/// that the ground is lit evenly. The background has the colour of the lit ground, so that the ground seems to have no
/// end.
/// @param view  with eye and at. @param bounds  the mesh's own, or of a series. Precondition: check_look() accepts
/// request and scene. Errors: Failure (kBadInput) if there are too many materials for a ground, or the lights would be
/// too far away.
void apply_look(SceneInput& input, const LookRequest& request, const Camera& view, const LookBounds& bounds);

/// @returns the view with the studio's field of view, 30 degrees, if it is a studio's and leaves eye and field open.
[[nodiscard]] ViewRequest look_view(const LookRequest& request, ViewRequest view);

/// Throws Failure (kUsage) if a look cannot be had for this kind of scene.
void check_look(const LookRequest& request, SceneKind kind);

}  // namespace gridiron::tool
