// Sets frames up for the counted kernel and the kernel, and runs them: see the header.
// SPDX-License-Identifier: Apache-2.0
#include <copy_core.h>
#include <counted_frame.h>
#include <counted_kernel.h>
#include <gridiron/build/grid/grid_builder.h>
#include <gridiron/bvh/bvh_core.h>
#include <gridiron/bvh/bvh_renderer.h>
#include <gridiron/frame/frame_setup.h>
#include <gridiron/image/scene_image.h>
#include <gridiron/render/tile_renderer.h>

#include <cstring>
#include <new>

namespace gridiron::calibrate {

namespace {

// Frame record, picture, planes and scene, one behind the other; in the end what waits of secondary rays.
struct MainMemory {
  LineBytes bytes;
  std::uint32_t tile_count;
  std::uint64_t picture_address;
  std::size_t word_count;  ///< of picture and planes
  SpillRegion spill;

  [[nodiscard]] std::byte* at(std::uint64_t address) const { return bytes.bytes().data() + address; }
};

FrameSettings settings_of(const CountedFrame& frame, std::uint64_t picture_address) {
  FrameSettings settings;
  settings.camera.eye = frame.eye;
  settings.camera.at = frame.at;
  settings.camera.tan_half_fov = frame.tan_half_fov;
  settings.width = settings.height = frame.width;
  settings.shading = frame.shading;
  settings.color = MainAddress{picture_address};
  return settings;
}

MainMemory make_grid_memory(const CountedFrame& frame) {
  constexpr std::uint64_t kPictureAddress = 512;
  const MeshView mesh{frame.vertices, frame.triangles};
  GridParameters grid;
  grid.format = format_of(frame.accuracy);
  GridNeed need;
  require(count_scene_image(mesh, grid, need, frame.effects));
  const std::uint32_t tiles = (frame.width + 31) / 32 * ((frame.width + 31) / 32);
  const std::size_t plane_bytes = std::size_t{tiles} * 32 * 32 * 4;
  const std::size_t output_bytes = plane_bytes * (frame.has_planes ? 3 : 1);
  const std::uint64_t image_address = kPictureAddress + output_bytes;
  SpillRegion spill;
  if (frame.effects != nullptr) {
    spill.address.value = round_up<std::uint64_t>(image_address + need.image_bytes, kSpillAlignment);
    spill.bytes = spill_bytes(frame.effects->recursion_depth);
  }
  const std::uint64_t end = spill.bytes != 0 ? spill.address.value + spill.bytes : image_address + need.image_bytes;
  MainMemory memory{LineBytes(end), tiles, kPictureAddress, output_bytes / 4, spill};
  const std::span<std::byte> image = memory.bytes.bytes().subspan(image_address, need.image_bytes);
  std::vector<std::byte> scratch(need.scratch_bytes);
  require(build_scene_image(mesh, grid, need, image, scratch, frame.effects));
  SceneImageView view;
  SceneImageError error;
  require(open_scene_image(image, view, error));
  FrameSettings settings = settings_of(frame, kPictureAddress);
  settings.accuracy = frame.accuracy;
  settings.techniques = frame.techniques;
  if (frame.effects != nullptr) settings.walk_depth = 8;
  if (frame.has_planes) {
    settings.depth = MainAddress{kPictureAddress + plane_bytes};
    settings.ids = MainAddress{kPictureAddress + 2 * plane_bytes};
  }
  require(make_frame_record(settings, view, MainAddress{image_address}, *new (memory.at(0)) FrameRecord));
  return memory;
}

MainMemory make_bvh_memory(const CountedFrame& frame) {
  constexpr std::uint64_t kPictureAddress = round_up<std::uint64_t>(sizeof(bvh::BvhFrameRecord), kLineBytes);
  bvh::Bvh bvh;
  require(bvh::build_bvh({frame.vertices, frame.triangles}, {}, bvh));
  const std::uint32_t tiles_x = (frame.width + bvh::kTileWidth - 1) / bvh::kTileWidth;
  const std::size_t pixel_count = std::size_t{tiles_x} * tiles_x * bvh::kTilePixels;
  const std::uint64_t nodes_address = kPictureAddress + pixel_count * sizeof(std::uint32_t);
  const std::size_t node_bytes = bvh.nodes.size() * sizeof(bvh::BvhNode);
  const std::uint64_t triangles_address = nodes_address + node_bytes;
  const std::size_t triangle_bytes = bvh.triangles.size() * sizeof(VertexTriangle);
  MainMemory memory{LineBytes(triangles_address + triangle_bytes), tiles_x * tiles_x, kPictureAddress, pixel_count, {}};
  std::memcpy(memory.at(nodes_address), bvh.nodes.data(), node_bytes);
  std::memcpy(memory.at(triangles_address), bvh.triangles.data(), triangle_bytes);
  bvh::RenderOptions options;
  options.hyper_threading = frame.ring_size > 1;
  options.ring_size = frame.ring_size;
  require(bvh::make_bvh_record(bvh, settings_of(frame, kPictureAddress), options, {nodes_address}, {triangles_address},
                               *new (memory.at(0)) bvh::BvhFrameRecord{}));
  return memory;
}

MainMemory make_memory(const CountedFrame& frame) {
  return frame.ring_size != 0 ? make_bvh_memory(frame) : make_grid_memory(frame);
}

CountedPicture picture_of(const MainMemory& memory, const Totals& totals) {
  std::vector<std::uint32_t> pixels(memory.word_count);
  std::memcpy(pixels.data(), memory.at(memory.picture_address), pixels.size() * 4);
  return {totals, std::move(pixels)};
}

CountedProgram program_of(const CountedFrame& frame) {
  if (frame.ring_size != 0) return CountedProgram::kBvh;
  if (frame.effects != nullptr) return CountedProgram::kEffects;
  return frame.packet_width == 32 ? CountedProgram::kPackets32 : CountedProgram::kPackets8;
}

template <class Store>
Totals run_plain(const MainMemory& memory) {
  LineBytes bytes(sizeof(Store));
  Store& store = *::new (static_cast<void*>(bytes.bytes().data())) Store;
  CopyCore core(memory.bytes.bytes(), memory.tile_count);
  require(render_tiles<Lanes<4>>(store, core, MainAddress{0}, memory.spill));
  Totals totals{};
  for (std::size_t kind = 0; kind < kWorkKindCount; ++kind) totals[kind].units = store.work.counts[kind];
  return totals;
}

}  // namespace

CountedPicture render_counted(const CountedFrame& frame, std::uint32_t superblock_branches) {
  const MainMemory memory = make_memory(frame);
  const CountedRun run{memory.bytes.bytes(), memory.tile_count, memory.spill.address.value, memory.spill.bytes,
                       program_of(frame)};
  return picture_of(memory, run_counted(run, superblock_branches));
}

std::vector<std::byte> main_memory_of(const CountedFrame& frame) {
  const MainMemory memory = make_memory(frame);
  const std::span<std::byte> bytes = memory.bytes.bytes();
  return {bytes.begin(), bytes.end()};
}

CountedPicture render_plain(const CountedFrame& frame) {
  const MainMemory memory = make_memory(frame);
  switch (program_of(frame)) {
    case CountedProgram::kBvh:
      return picture_of(memory, run_plain<bvh::BvhStore>(memory));
    case CountedProgram::kEffects:
      return picture_of(memory, run_plain<LocalStore<EffectLayout256K<kAllEffects, 32>>>(memory));
    case CountedProgram::kPackets32:
      return picture_of(memory, run_plain<LocalStore<StoreLayout256K<32>>>(memory));
    default:
      return picture_of(memory, run_plain<LocalStore<StoreLayout256K<8>>>(memory));
  }
}

}  // namespace gridiron::calibrate
