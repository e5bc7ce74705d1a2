// Requested frame: the frame that a command line, its scene and the host define together.
// Memory: owns the scene. Threads: one. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "files/command_files.h"
#include "gridiron/scene/scene_input.h"
#include "render_plan.h"

namespace gridiron::tool {

/// All inputs of prepare_frame().
struct RequestedFrame {
  SceneInput input;
  RenderPlan plan;
  ViewRequest view;
};

/// Reads scene and camera and completes the frame. If the kind of scene can be foreseen, the frame is also completed
/// before the scene is read, to report errors early. Unless quiet it prints notes of the scene on standard error, and
/// whether the store has fewer buffers than the configuration.
///
/// @param outputs  of the command; they are declared first, so that an output that cannot be written is reported early.
/// Errors: Failure.
[[nodiscard]] RequestedFrame read_requested_frame(const RenderRequest& request, const std::vector<Output>& outputs);

}  // namespace gridiron::tool
