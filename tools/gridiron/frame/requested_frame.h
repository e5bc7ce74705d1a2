// Requested frame: what a command line, the scene it names and the host say of a frame together.
// Memory: owns the scene. Threads: one. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "files/command_files.h"
#include "gridiron/scene/scene_input.h"
#include "render_plan.h"

namespace gridiron::tool {

/// All that prepare_frame() wants to know.
struct RequestedFrame {
  SceneInput input;
  RenderPlan plan;
  ViewRequest view;
};

/// Reads scene and camera and settles the frame. A scene whose kind can be foreseen has it settled before it is read
/// too: nobody should wait for what is refused then. Unless quiet it says on standard error what is odd in the scene,
/// and where the store has fewer buffers than the configuration.
///
/// @param outputs  of the command; they are declared first: nobody should wait for what cannot be written.
/// Errors: Failure.
[[nodiscard]] RequestedFrame read_requested_frame(const RenderRequest& request, const std::vector<Output>& outputs);

}  // namespace gridiron::tool
