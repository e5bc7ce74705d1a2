// Runs the counted BVH and the cached BVH: see the header. SPDX-License-Identifier: Apache-2.0
#include <bvh_frame.h>
#include <copy_core.h>
#include <gridiron/bvh/bvh_core.h>
#include <gridiron/bvh/bvh_renderer.h>
#include <gridiron/frame/frame_setup.h>
#include <gridiron/render/tile_renderer.h>
#include <gridiron_counted/bvh/bvh_core.h>
#include <gridiron_counted/render/tile_renderer.h>

#include <cstddef>
#include <cstring>
#include <new>
#include <vector>

namespace gridiron::calibrate {

namespace {

// Frame record, picture, nodes and triangles, one behind the other.
struct BvhMemory {
  LineBytes bytes;
  std::uint32_t tile_count;
  std::size_t pixel_count;
};
constexpr std::uint64_t kPictureAddress = (sizeof(bvh::BvhFrameRecord) + kLineBytes - 1) / kLineBytes * kLineBytes;

BvhMemory make_memory(const BvhCountedFrame& frame) {
  bvh::Bvh bvh;
  require(bvh::build_bvh({frame.vertices, frame.triangles}, {}, bvh));
  const std::uint32_t tiles_x = (frame.width + bvh::kTileWidth - 1) / bvh::kTileWidth;
  const std::size_t pixel_count = std::size_t{tiles_x} * tiles_x * bvh::kTilePixels;
  const std::uint64_t nodes_address = kPictureAddress + pixel_count * sizeof(std::uint32_t);
  const std::size_t node_bytes = bvh.nodes.size() * sizeof(bvh::BvhNode);
  const std::uint64_t triangles_address = nodes_address + node_bytes;
  const std::size_t triangle_bytes = bvh.triangles.size() * sizeof(VertexTriangle);
  BvhMemory memory{LineBytes(triangles_address + triangle_bytes), tiles_x * tiles_x, pixel_count};
  std::byte* const bytes = memory.bytes.bytes().data();
  std::memcpy(bytes + nodes_address, bvh.nodes.data(), node_bytes);
  std::memcpy(bytes + triangles_address, bvh.triangles.data(), triangle_bytes);

  FrameSettings settings;
  settings.camera.eye = frame.eye;
  settings.camera.at = frame.at;
  settings.camera.tan_half_fov = frame.tan_half_fov;
  settings.width = settings.height = frame.width;
  settings.shading = Shading::kSimple;
  settings.color = MainAddress{kPictureAddress};
  bvh::RenderOptions options;
  options.hyper_threading = frame.ring_size > 1;
  options.ring_size = frame.ring_size;
  auto& record = *new (bytes) bvh::BvhFrameRecord{};
  require(bvh::make_bvh_record(bvh, settings, options, {nodes_address}, {triangles_address}, record));
  return memory;
}

// On a model of its own. noinline: what it puts on the stack is below the stack base.
__attribute__((noinline)) Totals run_counted(BvhMemory& memory, PipeModel& model) {
  namespace twin = gridiron_counted;
  LineBytes bytes(sizeof(twin::bvh::BvhStore));
  auto& store = *::new (static_cast<void*>(bytes.bytes().data())) twin::bvh::BvhStore;
  model.set_store(&store, sizeof(store));
  CopyCore core(memory.bytes.bytes(), memory.tile_count);
  require(twin::render_tiles<twin::Lanes<4>>(store, core, twin::MainAddress{0}));
  return model.finish();
}

CountedPicture picture_of(const BvhMemory& memory, const Totals& totals) {
  std::vector<std::uint32_t> pixels(memory.pixel_count);
  std::memcpy(pixels.data(), memory.bytes.bytes().data() + kPictureAddress, pixels.size() * sizeof(std::uint32_t));
  return {totals, std::move(pixels)};
}

}  // namespace

// Twice: what the branches usually do, then what everything costs.
CountedPicture render_bvh_counted(const BvhCountedFrame& frame, std::uint32_t superblock_branches) {
  BvhMemory memory = make_memory(frame);
  const int stack_base = 0;
  PipeModel first(nullptr);
  first.set_stack(&stack_base);
  (void)run_counted(memory, first);
  PipeModel second(&first.branches(), superblock_branches);
  second.set_stack(&stack_base);
  return picture_of(memory, run_counted(memory, second));
}

CountedPicture render_bvh_plain(const BvhCountedFrame& frame) {
  BvhMemory memory = make_memory(frame);
  LineBytes bytes(sizeof(bvh::BvhStore));
  auto& store = *::new (static_cast<void*>(bytes.bytes().data())) bvh::BvhStore;
  CopyCore core(memory.bytes.bytes(), memory.tile_count);
  require(render_tiles<Lanes<4>>(store, core, MainAddress{0}));
  Totals totals{};
  for (std::size_t kind = 0; kind < kWorkKindCount; ++kind) totals[kind].units = store.work.counts[kind];
  return picture_of(memory, totals);
}

}  // namespace gridiron::calibrate
