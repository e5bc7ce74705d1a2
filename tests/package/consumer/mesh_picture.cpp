// From a mesh in memory to a picture, on the simulated chip.
//   mesh_picture [PICTURE.ppm]
// Memory: SimMemory stands for the chip's main memory. Threads: one per simulated core.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/build/grid/grid_builder.h>
#include <gridiron/frame/frame_setup.h>
#include <gridiron/image/scene_image.h>
#include <gridiron/sim/sim_chip.h>
#include <gridiron/version.h>

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <new>
#include <vector>

#include "hills.h"
#include "picture.h"

#if GRIDIRON_VERSION < 200
#error "gridiron 0.2 or later is needed"
#endif

using namespace gridiron;

int main(int argc, char** argv) {
  const Hills hills;
  const MeshView mesh{hills.vertices, hills.triangles};
  sim::SimMemory memory(std::uint64_t{1} << 26);

  // 1. The scene image: count what it needs, build it in memory that the cores can reach.
  GridNeed need;
  if (count_scene_image(mesh, {}, need) != Status::kOk) return 1;
  const sim::MemoryRegion image = memory.allocate(need.image_bytes).value();
  std::vector<std::byte> scratch(need.scratch_bytes);
  if (build_scene_image(mesh, {}, need, image.bytes, scratch) != Status::kOk) return 1;
  SceneImageView view;
  SceneImageError error;
  if (open_scene_image(image.bytes, view, error) != Status::kOk) return 1;

  // 2. The frame: what to see, and where its planes go.
  FrameSettings settings = Hills::settings();
  const std::uint64_t plane_bytes = output_plane_bytes(settings.width, settings.height, settings.tile_width);
  const sim::MemoryRegion color = memory.allocate(plane_bytes).value(), depth = memory.allocate(plane_bytes).value();
  settings.color = color.address;
  settings.depth = depth.address;
  const sim::MemoryRegion frame = memory.allocate(sizeof(FrameRecord)).value();
  if (make_frame_record(settings, view, image.address, *::new (frame.bytes.data()) FrameRecord) != Status::kOk) {
    return 1;
  }

  // 3. Every core renders tiles until none is left.
  const sim::ChipResult result = sim::render_frame(memory, frame.address, {.threads = 2});
  for (const sim::Violation& violation : result.violations) std::fprintf(stderr, "%s\n", violation.detail.c_str());
  if (result.status != Status::kOk) return 1;

  print_hashes(settings, color.bytes, depth.bytes);
  return argc < 2 || write_ppm(argv[1], settings, color.bytes) ? 0 : 1;
}
