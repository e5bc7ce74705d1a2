// Shared frame: the frame that rank 0 has planned and prepared, given to all ranks.
// Memory: the scene image lies once on each node. Threads: one. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "base/value_bytes.h"
#include "frame_memory.h"
#include "render_plan.h"

namespace gridiron::tool {

/// What a plan says besides the request, as bytes.
void add_plan(ByteWriter& writer, const RenderPlan& plan);
/// @returns the plan of another rank with the threads of this one. It names no outputs.
[[nodiscard]] RenderPlan take_plan(ByteReader& reader, const RenderRequest& request);

/// Gives all ranks, which all call it, the prepared frame of rank 0: the same main memory, of which the image is
/// read-only. On other ranks `frame` is made anew. Errors: those of Ranks; Failure if a host has too little memory.
void share_frame(std::optional<FrameMemory>& frame);

}  // namespace gridiron::tool
