// Hither plane: whether the near plane of a text scene's view would hide something. The chip's cameras have none.
// Source: I. Sutherland, G. Hodgman, "Reentrant polygon clipping", 1974.
// Memory: fixed. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/frame/frame_setup.h>
#include <gridiron/scene/mesh.h>

#include <cstddef>
#include <optional>

#include "scene_input.h"

namespace gridiron::tool {

/// Of the triangles that the hither plane would cut or hide the nearest, and how near it comes.
struct HitherCut {
  std::size_t triangle = 0;
  double depth = 0;  ///< least, along the view, of what the picture shows of it
};

/// @param aspect  width over height of the picture.
/// @param hither  distance along at - eye before which nothing would be seen.
/// @returns the triangle that comes nearest of those with a part inside the view pyramid, edges included, at a depth in
///          (0, hither); of equally near ones the first.
[[nodiscard]] std::optional<HitherCut> find_hither_cut(const Camera& camera, double aspect, double hither,
                                                       const MeshView& mesh);

/// Errors: Failure (kBadInput), `file:line: reason`, where the hither plane of a text scene would cut what the camera
/// sees. Other scenes have none.
void check_hither(const SceneInput& input, const Camera& camera, std::uint32_t width, std::uint32_t height);

}  // namespace gridiron::tool
