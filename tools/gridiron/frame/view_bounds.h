// Whether eye rays through the tree have bounds of their errors in a view (core/TREE.md, "Cameras without bounds").
// Memory: none. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gridiron/scene/scene_input.h"
#include "render_plan.h"

namespace gridiron::tool {

/// @returns whether they have; true also of what no frame can be made of. @param plan  with EngineId::kTree.
/// Errors: Failure (kUsage) if the view has a defect.
[[nodiscard]] bool has_bounds(const SceneInput& input, const RenderPlan& plan, const ViewRequest& view);

/// The same of a frame of an image with a tree.
[[nodiscard]] bool has_bounds(const FrameHead& frame, const TreeRecord& tree, const RenderPlan& plan);

}  // namespace gridiron::tool
