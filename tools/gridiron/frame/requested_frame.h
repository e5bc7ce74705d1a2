// Requested frame: the frame that a command line, its scene and the host define together.
// Memory: owns the scene. Threads: one. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "files/command_files.h"
#include "gridiron/scene/look.h"
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

/// Completes the frame of a scene that was read; prints no notes of the scene. @param camera  that the request names.
/// Errors: Failure.
/// @param bounds  of a look; null: that of the scene.
[[nodiscard]] RequestedFrame complete_frame(const RenderRequest& request, SceneInput input,
                                            const std::optional<ViewRequest>& camera,
                                            const LookBounds* bounds = nullptr);

/// Gives the scene its look, seen with `view`; completes eye, at and up of the view. The mesh is framed without its
/// ground.
/// @param bounds  null: those of the scene. Errors: Failure (kUsage) if this kind of scene cannot have the look; others
/// of apply_look().
void give_look(const LookRequest& look, SceneInput& input, double aspect, const LookBounds* bounds, ViewRequest& view);

/// Where `best` is the default but has no bounds in one of the views, the plan becomes that of `grid`, if the scene has
/// one; a note says so unless quiet.
void take_grid_without_bounds(const RenderRequest& request, RequestedFrame& frame, std::span<const ViewRequest> views);

/// Prints the notes of read_requested_frame() on standard error, unless quiet.
void tell_frame_notes(const RenderRequest& request, const RequestedFrame& frame);

}  // namespace gridiron::tool
