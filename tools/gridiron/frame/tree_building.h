// Tree building: the cores of the simulated chip build the tree of a frame's scene image.
// Memory: in the frame's main memory, free again afterwards. Threads: starts the chip's.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/build/grid/grid_builder.h>
#include <gridiron/image/scene_image.h>
#include <gridiron/sim/passes.h>
#include <gridiron/sim/sim_memory.h>

#include <cstdint>
#include <optional>
#include <vector>

#include "gridiron/scene/scene_input.h"
#include "render_plan.h"
#include "vertex_order.h"

namespace gridiron::tool {

/// What the cores did to build a tree.
struct CoresBuild {
  std::vector<sim::PassRun> passes;
  std::uint32_t piece_count = 0;  ///< check values of the image's pieces, which the master puts together
};

/// @returns whether the cores can build what a mesh's frame needs: a tree of vertices as they are, on a machine whose
/// prices are cycles.
[[nodiscard]] bool cores_can_build(const RenderPlan& plan);

/// Builds the image of a mesh whose plan has Builder::kCores. All of it is the work of the cores, but for a scene with
/// effects, whose other sections are written by prepare.
///
/// @param image    in `memory`, choice.need.image_bytes.
/// @param order    of vertices in main memory, found anew if it is not of this mesh; null: that of the mesh.
/// @param effects  the choice's.
/// @returns its validated view, whose bytes are those of build_image(). Errors: Failure.
[[nodiscard]] SceneImageView build_on_cores(sim::SimMemory& memory, const SceneInput& input, const Mesh& mesh,
                                            const RenderPlan& plan, const GridChoice& choice,
                                            const sim::MemoryRegion& image, std::optional<VertexOrder>* order,
                                            const EffectsView* effects, CoresBuild& build);

}  // namespace gridiron::tool
