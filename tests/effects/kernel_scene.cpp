// Scenes for the kernel: see the header. SPDX-License-Identifier: Apache-2.0
#include "effects/kernel_scene.h"

#include <glm/trigonometric.hpp>

namespace gridiron::test {

KernelScene build_kernel_scene(const tool::SceneDescription& description, const KernelOptions& options) {
  KernelScene scene;
  tool::SceneDescription copy = description;
  const tool::SceneEffects effects = tool::take_scene_effects(copy);
  const EffectsView view = effects.view();
  scene.called_for = effects_called_for(view);
  const MeshView mesh = tool::mesh_view(copy);
  const GridParameters parameters{
      .lambda = options.lambda,
      .macro_width = options.macro_width,
      .format = options.accuracy == Accuracy::kCompact ? TriangleFormat::kLattice : TriangleFormat::kVertices};
  GridNeed need;
  scene.status = count_scene_image(mesh, parameters, need, &view);
  if (scene.status != Status::kOk) return scene;
  scene.memory.resize(need.image_bytes + kLineBytes);
  std::vector<std::byte> scratch(need.scratch_bytes + 16);
  const std::span<std::byte> image(scene.image(), need.image_bytes);
  scene.status = build_scene_image(mesh, parameters, need, image, scratch, &view);
  if (scene.status != Status::kOk) return scene;
  SceneImageError error;
  scene.status = open_scene_image(image, scene.view, error);
  return scene;
}

Camera camera_of(const tool::SceneView& view) {
  return {.eye = view.from,
          .at = view.at,
          .up = view.up,
          .tan_half_fov = static_cast<float>(std::tan(glm::radians(double{view.angle_degrees}) / 2))};
}

KernelFrame make_kernel_frame(KernelScene& scene, const Camera& camera, std::uint32_t width, std::uint32_t height,
                              std::uint32_t tile_width, const KernelOptions& options) {
  KernelFrame frame;
  frame.status = scene.status;
  if (frame.status != Status::kOk) return frame;
  const std::uint64_t image_bytes = scene.view.header.image_bytes;
  const std::uint64_t plane = round_up(output_plane_bytes(width, height, tile_width), std::uint64_t{4096});
  frame.spill.bytes = options.spill_bytes == ~0ull ? spill_bytes(scene.view.effects.recursion_depth)
                                                   : options.spill_bytes;
  std::uint64_t end = 4096;
  const auto place = [&](std::uint64_t bytes) {
    const std::uint64_t begin = end;
    end += round_up(bytes, std::uint64_t{4096});
    return begin;
  };
  const std::uint64_t image = place(image_bytes);
  frame.frame_address = place(sizeof(FrameRecord));
  frame.color = place(plane);
  if (options.wants_planes) {
    frame.depth = place(plane);
    frame.ids = place(plane);
  }
  frame.spill.address = MainAddress{place(frame.spill.bytes + options.spill_shift) + options.spill_shift};
  frame.memory.resize(end + 2 * 4096);
  std::byte* const base = const_cast<std::byte*>(kernel_memory(frame));
  std::memcpy(base + image, scene.image(), image_bytes);
  const FrameSettings settings{.camera = camera,
                               .width = width,
                               .height = height,
                               .tile_width = tile_width,
                               .accuracy = options.accuracy,
                               .shading = options.shading,
                               .engine = options.engine,
                               .techniques = kUseMailbox | kUseCornerCulling | kUseEmptySkip | kUseSubpackets,
                               .macro_depth = options.macro_depth,
                               .triangle_depth = options.triangle_depth,
                               .fetch_depth = options.fetch_depth,
                               .color = MainAddress{frame.color},
                               .depth = MainAddress{frame.depth},
                               .ids = MainAddress{frame.ids}};
  FrameRecord record;
  frame.status = make_frame_record(settings, scene.view, MainAddress{image}, record);
  if (frame.status != Status::kOk) return frame;
  if (options.alter != nullptr) options.alter(record);
  std::memcpy(base + frame.frame_address, &record, sizeof(record));
  frame.tile_count = record.tiles_x * record.tiles_y;
  return frame;
}

const std::byte* kernel_memory(const KernelFrame& frame) {
  const auto start = reinterpret_cast<std::uintptr_t>(frame.memory.data());
  return frame.memory.data() + (4096 - start % 4096) % 4096;
}

void read_kernel_planes(const KernelFrame& frame, std::byte* base, std::uint32_t width, std::uint32_t height,
                        std::uint32_t tile_width, KernelPicture& picture) {
  const auto read = [&]<class Word>(std::uint64_t plane, std::vector<Word>& words) {
    if (plane == 0) return;
    words.resize(std::size_t{width} * height);
    for (std::uint32_t y = 0; y < height; ++y) {
      for (std::uint32_t x = 0; x < width; ++x) {
        const std::uint64_t index = output_plane_index(width, tile_width, x, y);
        std::memcpy(&words[std::size_t{y} * width + x], base + plane + 4 * index, 4);
      }
    }
  };
  read(frame.color, picture.color);
  read(frame.depth, picture.depth);
  read(frame.ids, picture.ids);
}

}  // namespace gridiron::test
