// From a packed scene to a picture with the scene's lights and materials, on the simulated chip.
//   gridiron pack scene.nff --configuration grid -o scene.gri
//   packed_picture scene.gri [PICTURE.ppm]
// Memory: SimMemory stands for the chip's main memory. Threads: one per simulated core.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/base/effect_records.h>
#include <gridiron/frame/frame_setup.h>
#include <gridiron/image/scene_image.h>
#include <gridiron/sim/sim_chip.h>

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <glm/geometric.hpp>
#include <new>

#include "picture.h"

using namespace gridiron;

namespace {

// Before the middle of the visible part. Printed on standard error as options of the gridiron program.
Camera camera_before(const GridRecord& grid) {
  const DVec3 low(grid.bounds_minimum[0], grid.bounds_minimum[1], grid.bounds_minimum[2]);
  const DVec3 high(grid.bounds_maximum[0], grid.bounds_maximum[1], grid.bounds_maximum[2]);
  const DVec3 middle = 0.5 * (low + high);
  const DVec3 eye = middle + 1.05 * glm::length(high - low) * glm::normalize(DVec3(0.35, 0.25, 1.0));
  const Vec3 from(eye), at(middle);
  std::fprintf(stderr, "--eye=%.9g,%.9g,%.9g --at=%.9g,%.9g,%.9g\n", from.x, from.y, from.z, at.x, at.y, at.z);
  return {.eye = from, .at = at};
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) return 2;
  sim::SimMemory memory(std::uint64_t{1} << 28);
  constexpr std::uint32_t kCores = 2;

  // 1. The scene image is loaded as it is; opening it checks every byte that the cores will rely on.
  std::ifstream file(argv[1], std::ios::binary);
  std::error_code no_file;
  const std::uint64_t file_bytes = std::filesystem::file_size(argv[1], no_file);
  if (!file || no_file) return 1;
  const sim::MemoryRegion image = memory.allocate(file_bytes).value();
  file.read(reinterpret_cast<char*>(image.bytes.data()), static_cast<std::streamsize>(file_bytes));
  SceneImageView view;
  SceneImageError error;
  if (!file || open_scene_image(image.bytes, view, error) != Status::kOk) {
    std::fprintf(stderr, "%s: byte %llu: %s\n", argv[1], static_cast<unsigned long long>(error.byte_offset),
                 error.field);
    return 1;
  }

  // 2. The frame. A scene with reflection wants memory for rays that wait, of each core's own.
  FrameSettings settings{.camera = camera_before(view.grid), .width = 96, .height = 64};
  settings.shading = view.has_effects ? Shading::kScene : Shading::kSimple;
  const sim::MemoryRegion color =
      memory.allocate(output_plane_bytes(settings.width, settings.height, settings.tile_width)).value();
  settings.color = color.address;
  sim::ChipOptions options{.threads = kCores};
  if (view.has_effects) {
    options.spill.bytes_per_core = spill_bytes(view.effects.recursion_depth);
    options.spill.address = memory.allocate(kCores * options.spill.slice_bytes(), kSpillAlignment).value().address;
  }
  const sim::MemoryRegion frame = memory.allocate(sizeof(FrameRecord)).value();
  if (make_frame_record(settings, view, image.address, *::new (frame.bytes.data()) FrameRecord) != Status::kOk) {
    return 1;
  }

  // 3. Render, and look.
  if (sim::render_frame(memory, frame.address, options).status != Status::kOk) return 1;
  print_hashes(settings, color.bytes);
  return argc < 3 || write_ppm(argv[2], settings, color.bytes) ? 0 : 1;
}
