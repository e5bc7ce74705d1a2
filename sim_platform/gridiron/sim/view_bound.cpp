// View bound: see the header. SPDX-License-Identifier: Apache-2.0
#include <gridiron/sim/engine_work.h>
#include <gridiron/sim/view_bound.h>
#include <gridiron/sim/view_tile.h>
#include <gridiron/store/local_store.h>

#include <algorithm>

namespace gridiron::sim {

struct ViewBound::State {
  explicit State(const ViewFrame& frame) : scene(frame), large(scene), small(scene), store(frame.store) {}

  view::Scene scene;
  view::TileBounder<TreeLayout256K<64>::kEyeTileWidth> large;
  view::TileBounder<TreeLayout64K::kEyeTileWidth> small;
  StoreSize store;

  template <class Bounder>
  void add_eyes(Bounder& bounder, std::uint32_t eye_width, std::uint32_t left, std::uint32_t top, TileBound& bound) {
    const FrameHead& head = scene.head;
    const std::uint32_t right = std::min(left + head.tile_width, head.width);
    const std::uint32_t bottom = std::min(top + head.tile_width, head.height);
    for (std::uint32_t y = top; y < bottom; y += eye_width) {
      for (std::uint32_t x = left; x < right; x += eye_width) bounder.add({x, y, 0.0f, 0.0f}, bound);
    }
  }
};

bool has_view_bound(const FrameHead& head, StoreSize store) {
  const bool is_layout = (store == StoreSize::k256KB && head.tile_width == TreeLayout256K<64>::kTileWidth) ||
                         (store == StoreSize::k64KB && head.tile_width == TreeLayout64K::kTileWidth);
  return is_layout && head.engine_id == static_cast<std::uint32_t>(EngineId::kTree) && head.depth_address == 0 &&
         head.shading != static_cast<std::uint32_t>(Shading::kScene) &&
         head.accuracy != static_cast<std::uint32_t>(Accuracy::kCompact);
}

ViewBound::ViewBound(const ViewFrame& frame) : state_(std::make_unique<State>(frame)) {}
ViewBound::~ViewBound() = default;
ViewBound::ViewBound(ViewBound&&) noexcept = default;

TileBound ViewBound::of(std::uint32_t tile_id) {
  const FrameHead& head = state_->scene.head;
  const std::uint32_t width = head.tile_width;
  const std::uint32_t left = tile_id % head.tiles_x * width, top = tile_id / head.tiles_x * width;
  TileBound bound;
  const auto count = [&](WorkId kind, std::uint64_t amount) { bound.work[kind.number()] += amount; };
  if (state_->store == StoreSize::k64KB) {
    state_->add_eyes(state_->small, TreeLayout64K::kEyeTileWidth, left, top, bound);
  } else {
    state_->add_eyes(state_->large, TreeLayout256K<64>::kEyeTileWidth, left, top, bound);
  }
  // A command waits for room in the queue, if that.
  count(Work::kWait, bound[Work::kGetIssue]);
  // TileRenderer's own.
  const std::uint64_t pixels = std::uint64_t{width} * width;
  const bool is_simple = head.shading == static_cast<std::uint32_t>(Shading::kSimple);
  count(Work::kTileStart, 1);
  if (left + width > head.width || top + width > head.height) count(Work::kIdGroup, (is_simple ? 2 : 1) * pixels / 4);
  count(is_simple ? Work::kShadedSimpleGroup : Work::kShadedGroup, pixels / view::kLanes);
  count(Work::kWait, 2);
  for (const std::uint64_t plane : {head.color_address, head.id_address}) {
    if (plane == 0) continue;
    const view::Transfer transfer =
        view::transfer_of(plane + tile_id * pixels * 4, static_cast<std::uint32_t>(pixels * 4));
    count(Work::kPutIssue, transfer.commands);
    count(Work::kWait, transfer.commands);
    bound.put_bytes += transfer.bytes;
  }
  return bound;
}

TileCycles view_tile_cycles(const TileBound& bound, const MachineProfile& machine, std::uint32_t output_depth) {
  const auto prices = work_prices(machine, kTreeEngine);
  TileCycles cycles;
  for (std::uint32_t kind = 0; kind < kTreeEngine.kind_count(); ++kind) {
    cycles.work += static_cast<double>(bound.work[kind]) * prices[kind];
  }
  const double gets = static_cast<double>(bound[Work::kGetIssue]), puts = static_cast<double>(bound[Work::kPutIssue]);
  cycles.commands =
      (gets + puts) * machine.issue_cycles + static_cast<double>(bound[Work::kWait]) * machine.wait_cycles;
  const double line_bytes = machine.line_bytes, in_flight = machine.lines_in_flight;
  const double turn = machine.channel_bytes_per_cycle > 0 ? line_bytes / machine.channel_bytes_per_cycle : 0.0;
  const double way = machine.latency_cycles.longest() + machine.core_count * in_flight * turn;
  // Lines of a command behind its first one.
  const auto under_way = [&](double commands, double bytes, double most_bytes) {
    const double further = bytes / line_bytes + commands;
    const double most_lines = most_bytes / line_bytes + 2;
    const double ways = commands + (most_lines > in_flight ? further / in_flight : 0.0);
    return ways * way + further * machine.core_line_interval_cycles;
  };
  cycles.transfers = under_way(gets, static_cast<double>(bound.get_bytes), kMaxTreeLeaf * sizeof(VertexTriangle)) +
                     (1 + output_depth) * under_way(puts, static_cast<double>(bound.put_bytes), kPortableBoundaryBytes);
  return cycles;
}

}  // namespace gridiron::sim
