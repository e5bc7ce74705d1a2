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

/// The nearest triangle that the hither plane would cut or hide, and its least depth.
struct HitherCut {
  std::size_t triangle = 0;
  double depth = 0;  ///< least depth of its visible part, along the view
};

/// @param aspect  width over height of the picture. @param hither  distance along at - eye before which nothing is
///                visible.
/// @returns the nearest triangle with a part inside the view pyramid, edges included, at a depth in (0, hither); the
/// first of equally near ones.
[[nodiscard]] std::optional<HitherCut> find_hither_cut(const Camera& camera, double aspect, double hither,
                                                       const MeshView& mesh);

/// Errors: Failure (kBadInput), `file:line: reason`, if the hither plane of a text scene would cut something visible.
/// Other scenes have none.
void check_hither(const SceneInput& input, const Camera& camera, std::uint32_t width, std::uint32_t height);

}  // namespace gridiron::tool
