// The kernel compiled for a chip of one's own, here one that has no engine (copy_port.h): a whole program, from a mesh
// to a picture. Shows what mesh_picture shows.
// Memory: static, for no chip has a heap. Threads: one core. SPDX-License-Identifier: Apache-2.0
#include <gridiron/base/lanes.h>
#include <gridiron/build/grid/grid_builder.h>
#include <gridiron/frame/frame_setup.h>
#include <gridiron/image/scene_image.h>
#include <gridiron/render/tile_renderer.h>
#include <gridiron/store/local_store.h>

#include <cstddef>
#include <cstdint>
#include <new>
#include <span>

#include "copy_port.h"
#include "hills.h"
#include "picture.h"

using namespace gridiron;

namespace {

// Main memory, handed out in lines.
alignas(4096) std::byte main_memory[std::size_t{1} << 23];
std::size_t used_bytes = 0;
std::span<std::byte> allocate(std::uint64_t bytes) {
  const std::span<std::byte> piece(main_memory + used_bytes, bytes);
  used_bytes += round_up(static_cast<std::size_t>(bytes), std::size_t{kLineBytes});
  return piece;
}
MainAddress address_of(std::span<std::byte> bytes) { return {reinterpret_cast<std::uintptr_t>(bytes.data())}; }

LocalStore<StoreLayout256K<8>> local_store;

}  // namespace

int main() {
  const Hills hills;
  const MeshView mesh{hills.vertices, hills.triangles};
  GridNeed need;
  if (count_scene_image(mesh, {}, need) != Status::kOk) return 1;
  FrameSettings settings = Hills::settings();
  const std::uint64_t plane_bytes = output_plane_bytes(settings.width, settings.height, settings.tile_width);
  if (need.image_bytes + need.scratch_bytes + 2 * plane_bytes + 4096 > sizeof main_memory) return 1;
  const std::span<std::byte> image = allocate(need.image_bytes), scratch = allocate(need.scratch_bytes),
                             color = allocate(plane_bytes), depth = allocate(plane_bytes),
                             record = allocate(sizeof(FrameRecord));
  SceneImageView view;
  SceneImageError error;
  if (build_scene_image(mesh, {}, need, image, scratch) != Status::kOk ||
      open_scene_image(image, view, error) != Status::kOk) {
    return 1;
  }
  settings.color = address_of(color);
  settings.depth = address_of(depth);
  FrameRecord& frame = *::new (record.data()) FrameRecord;
  if (make_frame_record(settings, view, address_of(image), frame) != Status::kOk) return 1;

  // [render]
  example::CopyPort port(frame.tiles_x * frame.tiles_y);
  if (render_tiles<Lanes<4>>(local_store, port, address_of(record)) != Status::kOk) return 1;
  // [render]
  print_hashes(settings, color, depth);
  return 0;
}
