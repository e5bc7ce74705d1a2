// Runs the counted kernel and the kernel: see the header. SPDX-License-Identifier: Apache-2.0
#include <copy_core.h>
#include <counted_frame.h>
#include <gridiron/build/grid/grid_builder.h>
#include <gridiron/frame/frame_setup.h>
#include <gridiron/image/scene_image.h>
#include <gridiron/platform/contract.h>
#include <gridiron/render/tile_renderer.h>
#include <gridiron_counted/render/tile_renderer.h>

#include <cstddef>
#include <cstring>
#include <new>

namespace gridiron::calibrate {

namespace {

// Frame record, picture, planes and scene image, one behind the other.
struct MainMemory {
  LineBytes bytes;
  std::uint32_t tile_count;
  std::size_t word_count;  ///< of picture and planes
  SpillRegion spill;
};
constexpr std::uint64_t kPictureAddress = 512;

MainMemory make_memory(const CountedFrame& frame) {
  const MeshView mesh{frame.vertices, frame.triangles};
  GridParameters grid;
  grid.format = format_of(frame.accuracy);
  GridNeed need;
  require(count_scene_image(mesh, grid, need, frame.effects));
  const std::uint32_t tiles = (frame.width + 31) / 32 * ((frame.width + 31) / 32);
  const std::size_t plane_bytes = std::size_t{tiles} * 32 * 32 * 4;
  const std::size_t output_bytes = plane_bytes * (frame.has_planes ? 3 : 1);
  const std::uint64_t image_address = kPictureAddress + output_bytes;
  // Behind the image, what waits of secondary rays.
  SpillRegion spill;
  if (frame.effects != nullptr) {
    spill.address.value = (image_address + need.image_bytes + kSpillAlignment - 1) / kSpillAlignment * kSpillAlignment;
    spill.bytes = spill_bytes(frame.effects->recursion_depth);
  }
  const std::uint64_t end = spill.bytes != 0 ? spill.address.value + spill.bytes : image_address + need.image_bytes;
  MainMemory memory{LineBytes(end), tiles, output_bytes / 4, spill};
  const std::span<std::byte> image = memory.bytes.bytes().subspan(image_address, need.image_bytes);
  std::vector<std::byte> scratch(need.scratch_bytes);
  require(build_scene_image(mesh, grid, need, image, scratch, frame.effects));
  SceneImageView view;
  SceneImageError error;
  require(open_scene_image(image, view, error));
  FrameSettings settings;
  settings.camera.eye = frame.eye;
  settings.camera.at = frame.at;
  settings.camera.tan_half_fov = frame.tan_half_fov;
  settings.width = settings.height = frame.width;
  settings.accuracy = frame.accuracy;
  settings.shading = frame.shading;
  settings.techniques = frame.techniques;
  if (frame.effects != nullptr) settings.walk_depth = 8;
  settings.color = MainAddress{kPictureAddress};
  if (frame.has_planes) {
    settings.depth = MainAddress{kPictureAddress + plane_bytes};
    settings.ids = MainAddress{kPictureAddress + 2 * plane_bytes};
  }
  require(
      make_frame_record(settings, view, MainAddress{image_address}, *new (memory.bytes.bytes().data()) FrameRecord));
  return memory;
}

std::vector<std::uint32_t> pixels_of(const MainMemory& memory) {
  std::vector<std::uint32_t> pixels(memory.word_count);
  std::memcpy(pixels.data(), memory.bytes.bytes().data() + kPictureAddress, pixels.size() * 4);
  return pixels;
}

// The counted kernel on a model of its own. noinline: what it puts on the stack is below `stack_base`.
template <class Layout>
__attribute__((noinline)) Totals run_counted(MainMemory& memory, PipeModel& model) {
  namespace twin = gridiron_counted;
  using Store = twin::LocalStore<Layout>;
  LineBytes bytes(sizeof(Store));
  Store& store = *::new (static_cast<void*>(bytes.bytes().data())) Store;
  model.set_store(&store, sizeof(store));
  CopyCore core(memory.bytes.bytes(), memory.tile_count);
  require(twin::render_tiles<twin::Lanes<4>>(store, core, twin::MainAddress{0},
                                             {twin::MainAddress{memory.spill.address.value}, memory.spill.bytes}));
  return model.finish();
}

// Twice: what the branches usually do, then what everything costs.
template <class Layout>
Totals run_twice(MainMemory& memory, std::uint32_t superblock_branches) {
  const int stack_base = 0;
  PipeModel first(nullptr);
  first.set_stack(&stack_base);
  (void)run_counted<Layout>(memory, first);
  PipeModel second(&first.branches(), superblock_branches);
  second.set_stack(&stack_base);
  return run_counted<Layout>(memory, second);
}

template <class Layout>
Totals run_plain(MainMemory& memory) {
  using Store = LocalStore<Layout>;
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
  namespace twin = gridiron_counted;
  MainMemory memory = make_memory(frame);
  Totals totals;
  if (frame.effects != nullptr) {
    totals = run_twice<twin::EffectLayout256K<kAllEffects, 32>>(memory, superblock_branches);
  } else if (frame.packet_width == 32) {
    totals = run_twice<twin::StoreLayout256K<32>>(memory, superblock_branches);
  } else {
    totals = run_twice<twin::StoreLayout256K<8>>(memory, superblock_branches);
  }
  return {totals, pixels_of(memory)};
}

std::vector<std::byte> main_memory_of(const CountedFrame& frame) {
  const MainMemory memory = make_memory(frame);
  const std::span<std::byte> bytes = memory.bytes.bytes();
  return {bytes.begin(), bytes.end()};
}

CountedPicture render_plain(const CountedFrame& frame) {
  MainMemory memory = make_memory(frame);
  Totals totals;
  if (frame.effects != nullptr) {
    totals = run_plain<EffectLayout256K<kAllEffects, 32>>(memory);
  } else if (frame.packet_width == 32) {
    totals = run_plain<StoreLayout256K<32>>(memory);
  } else {
    totals = run_plain<StoreLayout256K<8>>(memory);
  }
  return {totals, pixels_of(memory)};
}

}  // namespace gridiron::calibrate
