// Worker 0 builds the scene of an animated frame on the device.
// Memory: the workshop. Threads: worker 0. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/build/grid/grid_builder.h>
#include <gridiron/image/scene_image.h>
#include <gridiron/platform/status.h>

#include <cstdint>

#include "scene_workshop.h"
#include "wave_mesh.h"

namespace gridiron::port {

/// Makes the mesh and its scene image, and points the workshop's frame record, a copy of the job's, to them. Camera and
/// settings stay.
///
/// Errors: those of count_scene_image and build_scene_image; kMemoryTooSmall if the workshop is too small.
[[nodiscard]] inline Status build_wave_scene(SceneWorkshop& workshop, std::uint32_t animation_frame) {
  for (std::uint32_t i = 0; i < kWaveVertexCount; ++i) workshop.vertices[i] = wave_vertex(i, animation_frame);
  for (std::uint32_t i = 0; i < kWaveTriangleCount; ++i) workshop.triangles[i] = wave_triangle(i);
  const MeshView mesh{workshop.vertices, workshop.triangles};
  FrameRecord& frame = workshop.frame;
  GridParameters parameters;
  parameters.lambda = frame.engine.grid.lambda;
  parameters.macro_width = frame.engine.grid.macro_width;
  parameters.format = static_cast<TriangleFormat>(frame.engine.grid.triangle_format);
  GridNeed need;
  GRIDIRON_TRY(count_scene_image(mesh, parameters, need));
  if (need.image_bytes > sizeof workshop.image || need.scratch_bytes > sizeof workshop.scratch) {
    return Status::kMemoryTooSmall;
  }
  GRIDIRON_TRY(build_scene_image(mesh, parameters, need, workshop.image, workshop.scratch));
  SceneImageView view;
  SceneImageError error;
  GRIDIRON_TRY(open_scene_image({workshop.image, static_cast<std::size_t>(need.image_bytes)}, view, error));
  const std::uint64_t image = reinterpret_cast<std::uintptr_t>(workshop.image);
  frame.engine.macro_table_address = image + view.macro_table_offset_bytes;
  frame.engine.cell_blocks_address = image + view.cell_blocks_offset_bytes;
  frame.engine.triangles_address = image + view.triangles_offset_bytes;
  frame.engine.grid = view.grid;
  return Status::kOk;
}

}  // namespace gridiron::port
