// Frame memory: a machine's main memory with scene image, frame record and output planes.
// Memory: owns the simulated main memory. Threads: one before the frame. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/records.h>
#include <gridiron/build/grid/grid_builder.h>
#include <gridiron/frame/frame_setup.h>
#include <gridiron/image/scene_image.h>
#include <gridiron/sim/sim_memory.h>

#include <cstdint>

#include "base/stopwatch.h"
#include "gridiron/scene/scene_input.h"
#include "render_plan.h"
#include "tree_building.h"

namespace gridiron::tool {

/// Everything that a frame needs in main memory.
struct FrameMemory {
  explicit FrameMemory(std::uint64_t capacity_bytes) : memory(capacity_bytes) {}

  sim::SimMemory memory;
  SceneImageView image{};
  GridNeed need{};  ///< of the image; nothing where it was packed
  /// Where the cores build: of the last mesh, found anew if it is not of this one. Null: vertices lie as in the mesh.
  std::optional<VertexOrder>* vertex_order = nullptr;
  CoresBuild cores_build;  ///< empty where the general core builds
  FrameSettings settings{};
  FrameRecord record{};
  MainAddress image_address{}, record_address{};
  sim::MemoryRegion color, depth, ids;  ///< depth, ids: empty if not requested
  sim::MemoryRegion spill;              ///< for waiting rays of each host thread; no bytes without them
  std::uint64_t spill_bytes_per_core = 0;
  std::uint32_t ground_begin = kNoTriangle;  ///< as SceneInput's
  float wanted_lambda = 0;                   ///< the image's own is image.grid.lambda
  HostSeconds build_seconds{};               ///< of building the image, 0 for a packed scene
};

/// @returns bytes of a frame's memory: the machine's, and memory for waiting rays of host threads beyond its cores.
[[nodiscard]] std::uint64_t frame_memory_bytes(const SceneInput& input, const RenderPlan& plan);

/// @returns the points of a frame's scene image without a look's ground, once prepare_frame() has placed it.
[[nodiscard]] PointSource points_of(FrameMemory& frame);

/// Fills `frame` for a render; with Shading::kScene also memory for waiting rays of plan.threads cores.
/// @param view  requested parts of the view. Errors: Failure.
void prepare_frame(FrameMemory& frame, const SceneInput& input, const RenderPlan& plan, const ViewRequest& view);

/// The same. The bytes of a packed scene move into main memory, so that they exist once; the rest of `input` stays.
void prepare_frame(FrameMemory& frame, SceneInput&& input, const RenderPlan& plan, const ViewRequest& view);

/// Gives a prepared frame another camera. @param source  the scene, for messages. Errors: Failure (kUsage) if the frame
/// cannot have it.
void aim_camera(FrameMemory& frame, const Camera& camera, const std::filesystem::path& source = {});

}  // namespace gridiron::tool
