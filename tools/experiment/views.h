// Views: the scenes of an experiment, each with its camera.
// Memory: owns meshes, shared between views. Threads: any may read. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "gridiron/scene/scene_input.h"
#include "gridiron/scene/view.h"

namespace gridiron::experiment {

struct View {
  std::string key;                                ///< snake_case, unique
  std::string title;                              ///< for people
  std::shared_ptr<const tool::SceneInput> scene;  ///< a mesh
  tool::ViewRequest camera;                       ///< eye and at are set

  [[nodiscard]] const tool::Mesh& mesh() const { return std::get<tool::Mesh>(scene->content); }
};

/// The views of the paper that were found.
struct FoundViews {
  std::vector<View> views;           ///< never empty
  std::vector<std::string> missing;  ///< a sentence for each view that is not there
  bool generated = false;            ///< no scan was found: the views are a teapot and a torus knot
};

/// @returns the keys of all views that find_views() may find.
[[nodiscard]] std::vector<std::string> known_view_keys();

/// Looks for the scans of the paper's views in `folder`; an empty path finds none. A missing scan is reported in a
/// sentence, a wrong one is an error. Errors: Failure.
[[nodiscard]] FoundViews find_views(const std::filesystem::path& folder);

/// @returns a torus knot of `triangle_count` (even) triangles, with a published camera; key "knot_COUNT".
[[nodiscard]] View make_knot_view(std::uint32_t triangle_count);

/// Completes a view's camera as it was published: at = centre c of the bounds of the triangles that have an area, eye =
/// c + 1.05 diagonals (0.35, 0.25, 1) / |...|. Unlike the program's own framing, it may cut the mesh. Parts that are
/// set stay. Errors: Failure (kBadInput) if there is nothing to see.
[[nodiscard]] View with_published_camera(View view);

/// Triangle counts of Table 1: largest times 1/100, 1/50, 1/20, 1/10, 1/5, 1/2 and 1, even, without those below the
/// smallest knot.
[[nodiscard]] std::vector<std::uint32_t> growth_counts(std::uint32_t largest);

}  // namespace gridiron::experiment
