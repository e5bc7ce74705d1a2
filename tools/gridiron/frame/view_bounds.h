// Whether eye rays through the tree have bounds of their errors in a view (core/TREE.md, "Cameras without bounds").
// Memory: none. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "gridiron/scene/scene_input.h"
#include "render_plan.h"

namespace gridiron::tool {

/// @returns the first of the views without bounds. What no frame can be made of counts as one with bounds.
/// @param plan  with EngineId::kTree. Errors: Failure (kUsage) if a view has a defect.
[[nodiscard]] std::optional<std::size_t> find_view_without_bounds(const SceneInput& input, const RenderPlan& plan,
                                                                  std::span<const ViewRequest> views);

/// @returns whether a frame of an image with a tree has bounds.
[[nodiscard]] bool has_bounds(const FrameHead& frame, const TreeRecord& tree, const RenderPlan& plan);

}  // namespace gridiron::tool
