// Sets frames up for the counted kernel and the kernel, and runs them: see the header.
// SPDX-License-Identifier: Apache-2.0
#include <counted_frame.h>
#include <gridiron/build/grid/grid_builder.h>
#include <gridiron/bvh/bvh_core.h>
#include <gridiron/bvh/bvh_renderer.h>
#include <gridiron/image/scene_image.h>
#include <gridiron/render/tile_renderer.h>
#include <gridiron/sim/engine_work.h>

#include <cstring>
#include <new>
#include <numeric>

namespace gridiron::calibrate {

namespace {

constexpr std::uint32_t kWordsOfTile = 32 * 32;
static_assert(bvh::kTilePixels == kWordsOfTile);

CountedProgram program_of(const CountedFrame& frame) {
  if (frame.ring_size != 0) return CountedProgram::kBvh;
  if (frame.effects != nullptr) return CountedProgram::kEffects;
  if (!frame.configuration->has_grid()) return CountedProgram::kTree;
  return frame.configuration->packet_width == 32 ? CountedProgram::kPackets32 : CountedProgram::kPackets8;
}

}  // namespace

FrameInMemory::FrameInMemory(const CountedFrame& frame) : program_(program_of(frame)) {
  if (program_ == CountedProgram::kBvh) {
    set_up_bvh(frame);
  } else {
    set_up_grid(frame);
  }
}

void FrameInMemory::set_up_picture(const CountedFrame& frame, std::uint64_t begin, std::uint32_t plane_count) {
  const std::uint32_t tiles_x = (frame.width + 31) / 32;
  all_tiles_.resize(std::size_t{tiles_x} * tiles_x);
  std::iota(all_tiles_.begin(), all_tiles_.end(), 0u);
  picture_address_ = begin;
  plane_bytes_ = all_tiles_.size() * kWordsOfTile * sizeof(std::uint32_t);
  plane_count_ = plane_count;
}

FrameSettings FrameInMemory::settings_of(const CountedFrame& frame) const {
  FrameSettings settings;
  settings.camera = frame.camera;
  settings.width = settings.height = frame.width;
  settings.shading = frame.shading;
  settings.color = MainAddress{picture_address_};
  return settings;
}

void FrameInMemory::set_up_grid(const CountedFrame& frame) {
  const tool::Configuration& configuration = *frame.configuration;
  const MeshView mesh{frame.vertices, frame.triangles};
  GridParameters grid;
  grid.lambda = configuration.lambda;
  grid.macro_width = configuration.macro_width;
  grid.format = format_of(frame.accuracy);
  grid.has_tree = program_ == CountedProgram::kTree;
  grid.has_grid = !grid.has_tree;
  if (grid.has_tree) grid.leaf_triangles = kMaxTreeLeaf;
  GridNeed need;
  require(count_scene_image(mesh, grid, need, frame.effects));
  set_up_picture(frame, 512, frame.has_planes ? 3 : 1);
  const std::uint64_t image_address = picture_address_ + plane_count_ * plane_bytes_;
  std::uint64_t end = image_address + need.image_bytes;
  if (frame.effects != nullptr) {
    spill_.address.value = round_up<std::uint64_t>(end, kSpillAlignment);
    spill_.bytes = spill_bytes(frame.effects->recursion_depth);
    end = spill_.address.value + spill_.bytes;
  }
  bytes_ = LineBytes(end);
  const std::span<std::byte> image = bytes_.bytes().subspan(image_address, need.image_bytes);
  std::vector<std::byte> scratch(need.scratch_bytes);
  require(build_scene_image(mesh, grid, need, image, scratch, frame.effects));
  SceneImageView view;
  SceneImageError error;
  require(open_scene_image(image, view, error));
  FrameSettings settings = settings_of(frame);
  settings.accuracy = frame.accuracy;
  settings.techniques = configuration.techniques;
  settings.macro_depth = configuration.depths.macro;
  settings.triangle_depth = configuration.depths.triangle;
  if (frame.effects != nullptr) settings.fetch_depth = 8;
  if (program_ == CountedProgram::kTree) settings.engine = EngineId::kTree;
  if (frame.has_planes) {
    settings.depth = MainAddress{picture_address_ + plane_bytes_};
    settings.ids = MainAddress{picture_address_ + 2 * plane_bytes_};
  }
  require(make_frame_record(settings, view, MainAddress{image_address}, *new (at(0)) FrameRecord));
}

void FrameInMemory::set_up_bvh(const CountedFrame& frame) {
  bvh::Bvh bvh;
  require(bvh::build_bvh({frame.vertices, frame.triangles}, {}, bvh));
  set_up_picture(frame, round_up<std::uint64_t>(sizeof(bvh::BvhFrameRecord), kLineBytes), 1);
  const std::uint64_t nodes_address = picture_address_ + plane_bytes_;
  const std::size_t node_bytes = bvh.nodes.size() * sizeof(bvh::BvhNode);
  const std::uint64_t triangles_address = nodes_address + node_bytes;
  const std::size_t triangle_bytes = bvh.triangles.size() * sizeof(VertexTriangle);
  bytes_ = LineBytes(triangles_address + triangle_bytes);
  std::memcpy(at(nodes_address), bvh.nodes.data(), node_bytes);
  std::memcpy(at(triangles_address), bvh.triangles.data(), triangle_bytes);
  bvh::RenderOptions options;
  options.hyper_threading = frame.ring_size > 1;
  options.ring_size = frame.ring_size;
  require(bvh::make_bvh_record(bvh, settings_of(frame), options, {nodes_address}, {triangles_address},
                               *new (at(0)) bvh::BvhFrameRecord{}));
}

std::vector<std::uint32_t> FrameInMemory::pixels_of(std::span<const std::uint32_t> tiles) const {
  std::vector<std::uint32_t> pixels(tiles.size() * plane_count_ * kWordsOfTile);
  std::uint32_t* to = pixels.data();
  for (const std::uint32_t tile : tiles) {
    for (std::uint32_t plane = 0; plane < plane_count_; ++plane, to += kWordsOfTile) {
      const std::uint64_t offset = plane * plane_bytes_ + std::uint64_t{tile} * kWordsOfTile * sizeof *to;
      std::memcpy(to, at(picture_address_ + offset), kWordsOfTile * sizeof *to);
    }
  }
  return pixels;
}

template <class Store>
WorkCounters FrameInMemory::render(std::span<const std::uint32_t> tiles) const {
  const LineBytes bytes(sizeof(Store));
  Store& store = *::new (static_cast<void*>(bytes.bytes().data())) Store;
  CopyCore core(bytes_.bytes(), tiles);
  require(render_tiles<Lanes<4>>(store, core, MainAddress{0}, spill_));
  return store.work;
}

CountedPicture FrameInMemory::count(const Branches& usual, std::span<const std::uint32_t> tiles,
                                    const PipeRules& rules) const {
  if (tiles.empty()) tiles = all_tiles_;
  const auto work_of = [&]() -> WorkCounters {
    switch (program_) {
      case CountedProgram::kBvh:
        return render<bvh::BvhStore>(tiles);
      case CountedProgram::kEffects:
        return render<LocalStore<EffectLayout256K<kAllEffects, 32>>>(tiles);
      case CountedProgram::kTree:
        return render<LocalStore<TreeLayout256K<32>>>(tiles);
      case CountedProgram::kPackets32:
        return render<LocalStore<StoreLayout256K<32>>>(tiles);
      default:
        return render<LocalStore<StoreLayout256K<8>>>(tiles);
    }
  };
  const WorkCounters work = work_of();
  const std::vector<std::uint32_t> plain = pixels_of(tiles);
  CountedPicture picture{run_counted(run_of(tiles), usual, rules), {}};
  picture.pixels = pixels_of(tiles);
  if (picture.pixels != plain) throw std::runtime_error("calibration: the counted picture is another one");
  for (std::uint32_t kind = 0; kind < kWorkKindCount; ++kind) {
    if (!sim::is_charged_as_event(WorkId(kind)) && picture.counts.totals[kind].units != work.counts[kind]) {
      throw std::runtime_error("calibration: the counted kernel did other work");
    }
  }
  return picture;
}

}  // namespace gridiron::calibrate
