// Sets up a frame of the cached BVH in simulated main memory, runs its cores in turn, and replays their traces.
// Memory: owns main memory and traces for the time of a frame. Threads: see the header.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/bvh/bvh_core.h>
#include <gridiron/bvh/bvh_engine_work.h>
#include <gridiron/bvh/bvh_renderer.h>
#include <gridiron/bvh/claim_order.h>
#include <gridiron/render/tile_renderer.h>
#include <gridiron/sim/core_runner.h>

#include <bit>
#include <cstring>
#include <mutex>
#include <new>
#include <span>

namespace gridiron::bvh {

namespace {

/// Where the parts of a frame lie.
struct FrameInMemory {
  sim::MemoryRegion record, color, depth, ids;
  FrameHead frame{};
};

template <class Element>
[[nodiscard]] std::span<const std::byte> bytes_of(const std::vector<Element>& elements) {
  return std::as_bytes(std::span(elements));
}

template <class Element>
[[nodiscard]] std::vector<Element> untile(const FrameHead& frame, std::span<const std::byte> plane) {
  std::vector<Element> rows(std::size_t{frame.width} * frame.height);
  for (std::uint32_t y = 0; y < frame.height; ++y) {
    for (std::uint32_t x = 0; x < frame.width; ++x) {
      const std::uint64_t index = output_plane_index(frame.width, frame.tile_width, x, y);
      std::memcpy(&rows[std::size_t{y} * frame.width + x], plane.data() + index * sizeof(Element), sizeof(Element));
    }
  }
  return rows;
}

[[nodiscard]] Status make_frame(const Bvh& bvh, FrameSettings settings, const RenderOptions& options,
                                sim::SimMemory& memory, FrameInMemory& parts) {
  const std::uint64_t plane_bytes = output_plane_bytes(settings.width, settings.height, kTileWidth);
  const auto nodes = memory.allocate(bytes_of(bvh.nodes).size());
  const auto triangles = memory.allocate(bytes_of(bvh.triangles).size());
  const auto color = memory.allocate(plane_bytes);
  const auto depth = memory.allocate(options.all_planes ? plane_bytes : kLineBytes);
  const auto ids = memory.allocate(options.all_planes ? plane_bytes : kLineBytes);
  const auto record = memory.allocate(sizeof(BvhFrameRecord));
  if (!nodes || !triangles || !color || !depth || !ids || !record) return Status::kMemoryTooSmall;
  std::memcpy(nodes->bytes.data(), bvh.nodes.data(), nodes->bytes.size());
  std::memcpy(triangles->bytes.data(), bvh.triangles.data(), triangles->bytes.size());

  settings.color = color->address;
  settings.depth = options.all_planes ? depth->address : MainAddress{};
  settings.ids = options.all_planes ? ids->address : MainAddress{};
  BvhFrameRecord frame{};
  GRIDIRON_TRY(make_bvh_record(bvh, settings, options, nodes->address, triangles->address, frame));
  std::memcpy(record->bytes.data(), &frame, sizeof frame);
  parts = {*record, *color, *depth, *ids, frame};
  return Status::kOk;
}

// The record's settings. Precondition: a line's counts are powers of two.
[[nodiscard]] CoreSettings core_settings(const BvhParameters& bvh, const RenderOptions& options) {
  return {.packet_width = options.packet_width,
          .ring_size = options.hyper_threading ? options.ring_size : 1,
          .node_lines = options.caches.node_lines,
          .triangle_lines = options.caches.triangle_lines,
          .log_line_nodes = static_cast<std::uint32_t>(std::countr_zero(bvh.line_nodes)),
          .log_line_triangles = static_cast<std::uint32_t>(std::countr_zero(bvh.line_triangles)),
          .use_subpackets = options.use_subpackets ? 1u : 0u,
          .reserved = 0};
}

[[nodiscard]] bool are_options_valid(const Bvh& bvh, const RenderOptions& options) {
  if (!is_packet_width(options.packet_width)) return false;
  if (!std::has_single_bit(bvh.parameters.line_nodes) || !std::has_single_bit(bvh.parameters.line_triangles)) {
    return false;
  }
  const bool ring_ok =
      !options.hyper_threading || (options.ring_size >= 2 && options.ring_size <= ring_of(options.packet_width));
  return ring_ok && are_caches_valid(core_settings(bvh.parameters, options)) && !bvh.nodes.empty();
}

/// Leaves the order of claims even if the core cannot be made.
struct LeaveAtEnd {
  ClaimOrder& order;
  std::uint32_t core;
  ~LeaveAtEnd() { order.leave(core); }
};

// Calls visit(a layout) with that of a packet width.
template <class Visit>
auto with_layout(std::uint32_t packet_width, Visit&& visit) {
  if (packet_width == 8) return visit(BvhLayout<8>{});
  return packet_width == 16 ? visit(BvhLayout<16>{}) : visit(BvhLayout<32>{});
}

// Runs one core. @returns its status, and adds its caches' counts.
template <class Layout>
[[nodiscard]] Status run_core(std::span<std::byte> data, OrderedCore& platform, MainAddress record, std::mutex& mutex,
                              BvhFrame& result) {
  auto& store = *::new (static_cast<void*>(data.data())) LocalStore<Layout>;
  const Status status = render_tiles<Lanes<4>>(store, platform, record);
  const std::scoped_lock lock(mutex);
  result.node_cache += store.engine.node_cache.counts();
  result.triangle_cache += store.engine.triangle_cache.counts();
  return status;
}

}  // namespace

Status make_bvh_record(const Bvh& bvh, FrameSettings settings, const RenderOptions& options, MainAddress nodes,
                       MainAddress triangles, BvhFrameRecord& frame) {
  settings.tile_width = kTileWidth;
  settings.output_depth = kOutputDepth;
  GRIDIRON_TRY(make_frame_head(settings, frame));
  frame.engine_id = BvhEngine::kId;
  frame.engine = {nodes.value, triangles.value, core_settings(bvh.parameters, options)};
  return Status::kOk;
}

BvhFrame render_bvh_frame(const Bvh& bvh, const FrameSettings& settings, const sim::MachineProfile& machine,
                          const RenderOptions& options) {
  BvhFrame result;
  const auto refuse = [&](Status status) {
    result.status = status;
    return result;
  };
  if (settings.accuracy != Accuracy::kStandard || machine.local_store_bytes < BvhStore::Layout::kArenaBytes) {
    return refuse(Status::kUnsupportedFrame);
  }
  if (!are_options_valid(bvh, options)) return refuse(Status::kBadParameter);

  // 1. The frame in main memory.
  const std::uint64_t planes = options.all_planes ? 3 : 1;
  constexpr std::uint64_t kSlack = 64 * kLineBytes;
  if (settings.width < 1 || settings.height < 1 || settings.width > kMaxPictureWidth ||
      settings.height > kMaxPictureWidth) {
    return refuse(Status::kBadFrame);
  }
  result.main_memory_bytes = bytes_of(bvh.nodes).size() + bytes_of(bvh.triangles).size() +
                             planes * output_plane_bytes(settings.width, settings.height, kTileWidth) +
                             sizeof(BvhFrameRecord);
  if (result.main_memory_bytes > machine.main_memory_bytes) return refuse(Status::kMemoryTooSmall);
  sim::SimMemory memory(result.main_memory_bytes + sim::SimMemory::kFirstAddress + kSlack);
  FrameInMemory parts;
  const Status made = make_frame(bvh, settings, options, memory, parts);
  if (made != Status::kOk) return refuse(made);

  // 2. The cores, in turn.
  sim::ChipOptions chip;
  chip.threads = options.core_count != 0 ? options.core_count : machine.core_count;
  chip.completion = options.completion;
  chip.seed = options.seed;
  chip.abort = options.abort;
  sim::FrameShape shape(kBvhEngine);
  shape.tile_count = parts.frame.tiles_x * parts.frame.tiles_y;
  shape.cores_meet = true;
  shape.output_depth = kOutputDepth;
  shape.arena_bytes = BvhStore::Layout::kArenaBytes;
  shape.data_bytes = with_layout(options.packet_width, [](auto layout) {
    return static_cast<std::uint32_t>(sizeof(LocalStore<decltype(layout)>));
  });
  for (const sim::MemoryRegion* plane : {&parts.color, &parts.depth, &parts.ids}) {
    if (plane != &parts.color && !options.all_planes) continue;
    shape.writable.push_back({plane->address.value, plane->address.value + plane->bytes.size()});
  }
  result.core_of_tile.assign(shape.tile_count, 0);
  ClaimOrder order(chip.threads);
  std::mutex mutex;
  std::uint32_t cores_begun = 0;
  sim::ChipResult run = sim::run_cores(memory, shape, chip, [&](sim::SimCore& core, std::span<std::byte> data) {
    // Cores are alike until their first claim, so it does not matter which thread is called by which number.
    std::uint32_t index = 0;
    {
      const std::scoped_lock lock(mutex);
      index = cores_begun++;
    }
    // However this core ends, the others must not wait for its turn.
    const LeaveAtEnd leave{order, index};
    OrderedCore platform(core, index, order, CoreClock(machine, kBvhEngine, kOutputDepth), result.core_of_tile);
    return with_layout(options.packet_width, [&](auto layout) {
      return run_core<decltype(layout)>(data, platform, parts.record.address, mutex, result);
    });
  });
  result.status = run.status;
  result.host_shortage = run.host_shortage;
  result.violations = std::move(run.violations);
  if (result.status != Status::kOk) return result;

  // 3. Time with contention, work by kind, the picture.
  result.timing =
      sim::replay(run.trace, machine,
                  {.core_count = chip.threads, .timeline = options.timeline, .core_of_tile = result.core_of_tile});
  result.work = run.work;
  result.picture.color = untile<std::uint32_t>(parts.frame, parts.color.bytes);
  if (options.all_planes) {
    result.picture.depth = untile<float>(parts.frame, parts.depth.bytes);
    result.picture.ids = untile<std::uint32_t>(parts.frame, parts.ids.bytes);
  }
  return result;
}

}  // namespace gridiron::bvh
