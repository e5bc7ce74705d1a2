// Requested frame: what a command line, the scene it names and the host say of a frame together.
// Memory: owns the scene. Threads: one. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "files/command_files.h"
#include "gridiron/command_line/arguments.h"
#include "gridiron/scene/scene_input.h"
#include "gridiron/scene/view.h"

namespace gridiron::tool {

/// All that prepare_frame() wants to know.
struct RequestedFrame {
  SceneInput input;
  RenderArguments arguments;  ///< nothing is left to the scene or the host
  ViewRequest view;
};

/// Reads scene and camera and completes the arguments by them. Unless quiet it says on standard error what is odd in
/// the scene, and where the store has fewer buffers than the configuration.
///
/// @param outputs  of the command; they are declared first: nobody should wait for what cannot be written.
/// Errors: Failure.
[[nodiscard]] RequestedFrame read_requested_frame(const RenderArguments& asked, const std::vector<Output>& outputs);

}  // namespace gridiron::tool
