// Packet driver: takes one packet through the grid. It fetches ahead what the walks will need (cell blocks of the next
// macrocells, triangles of the next cells) and tests the triangles that have arrived.
// Source: Cho, Kim, Han 2012, section 5, macrocell and triangle level. Memory: the local store. Threads: one core.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/lanes.h>
#include <gridiron/base/records.h>
#include <gridiron/dma/buffer_ring.h>
#include <gridiron/dma/transfers.h>
#include <gridiron/engine/grid/footprint.h>
#include <gridiron/engine/grid/frustum.h>
#include <gridiron/engine/grid/grid_store.h>
#include <gridiron/engine/grid/grid_work.h>
#include <gridiron/engine/grid/reach.h>
#include <gridiron/engine/grid/slice_walk.h>
#include <gridiron/engine/grid/triangle_run.h>
#include <gridiron/platform/contract.h>
#include <gridiron/ray/intersect_projection.h>
#include <gridiron/ray/intersect_standard.h>
#include <gridiron/ray/lattice_run.h>

#include <cstdint>

namespace gridiron {

/// Traces the active rays of store.packet: one pass, one frustum.
///
/// Two pipelines, each a ring of buffers. The front of the macrocell ring is the block being walked, the rest are in
/// flight. The triangle ring holds runs of triangles on their way; the front one is tested next. With a depth of 1 a
/// buffer is fetched, waited for and used before the next get; with 2 the next one travels meanwhile (the paper's
/// double buffering); deeper rings look farther ahead.
template <class L, class Store, Platform P>
class PacketDriver {
 public:
  using Layout = typename Store::Layout;

  PacketDriver(Store& store, Transfers<P>& transfers, const Frustum& frustum)
      : store_(store),
        transfers_(transfers),
        frustum_(frustum),
        macro_ring_(store.frame.engine.macro_depth),
        triangle_ring_(store.frame.engine.triangle_depth) {}

  [[nodiscard]] Status run() {
    store_.work.charge_to(GridWork::kPacketStart);
    macro_walk_.begin(store_.frame.engine.grid, frustum_);
    reach_ = reaches_.template update<L>(store_.packet, StorePacket::kAllSubpackets, store_.work);
    for (;;) {
      while (!triangle_ring_.full() && !cells_done_) GRIDIRON_TRY(fetch_next_run());
      if (triangle_ring_.empty()) break;
      GRIDIRON_TRY(test_front_run());
    }
    return Status::kOk;
  }

 private:
  using StorePacket = typename Store::EyeStore;
  static constexpr std::uint32_t kRunTriangles = Layout::kTrianglesPerBuffer;

  struct TriangleRun {
    std::uint32_t count;
    std::uint32_t first_byte;  ///< where the run starts in its buffer
    float entry;               ///< march distance of its cell's slice
    std::uint32_t touching;    ///< squares of subpackets that may touch the cell
  };

  // Starts the get of the next run of triangles, or sets cells_done_.
  [[nodiscard]] Status fetch_next_run() {
    if (frustum_.beyond(Slab{cell_.entry, cell_.entry}, reach_)) cell_.triangle_count = 0;
    while (cell_.triangle_count == 0) {
      if (walking_ && find_next_cell()) {
        touching_ = squares_that_see(cell_);
        if (touching_ != 0) break;
        cell_.triangle_count = 0;
        continue;
      }
      walking_ = false;
      GRIDIRON_TRY(enter_next_macro_cell());
      if (cells_done_) return Status::kOk;
    }
    store_.work.charge_to(GridWork::kTriangleBatch);
    const std::uint32_t count = cell_.triangle_count < kRunTriangles ? cell_.triangle_count : kRunTriangles;
    const RunPlace place = run_place(store_.frame, cell_.first_triangle, count);
    const std::uint32_t slot = triangle_ring_.push();
    runs_[slot] = {count, place.first_byte, cell_.entry, touching_};
    cell_.first_triangle += count;
    cell_.triangle_count -= count;
    return transfers_.get(store_.packet.triangles[slot].bytes + (place.first_byte - place.slack), place.begin,
                          place.bytes, static_cast<std::uint8_t>(kFirstTriangleTag + slot));
  }

  [[nodiscard]] bool find_next_cell() {
    const std::byte* const block = store_.packet.cell_blocks[macro_ring_.front()].bytes;
    if (is_on_lattice(store_.frame)) {
      return cell_walk_.next(frustum_, reinterpret_cast<const CellBound*>(block), reach_, cell_, store_.work);
    }
    return cell_walk_.next(frustum_, reinterpret_cast<const CellRecord*>(block), reach_, cell_, store_.work);
  }

  // Leaves the macrocell that was walked, keeps the ring filled, and waits for the next block; or sets cells_done_.
  [[nodiscard]] Status enter_next_macro_cell() {
    store_.work.charge_to(GridWork::kMacroCellVisit);
    if (entered_) macro_ring_.pop();
    entered_ = false;
    while (!macro_ring_.full() && !macro_cells_done_) GRIDIRON_TRY(fetch_next_macro_cell());
    if (macro_ring_.empty()) {
      cells_done_ = true;
      return Status::kOk;
    }
    const std::uint32_t slot = macro_ring_.front();
    GRIDIRON_TRY(transfers_.wait(static_cast<std::uint8_t>(kFirstMacroTag + slot)));
    store_.work.add(GridWork::kMacroCellVisit);
    cell_walk_.begin(store_.frame.engine.grid, frustum_, visits_[slot]);
    entered_ = true;
    walking_ = true;
    return Status::kOk;
  }

  // Starts the get of the next macrocell's block, or sets macro_cells_done_.
  [[nodiscard]] GRIDIRON_OUTLINE Status fetch_next_macro_cell() {
    const bool skip_empty = (store_.frame.engine.techniques & kUseEmptySkip) != 0;
    MacroVisit visit;
    WalkStep step = macro_walk_.next(frustum_, store_.engine.table, reach_, skip_empty, visit, store_.work);
    while (step == WalkStep::kNeedsChunk) {
      GRIDIRON_TRY(fetch_chunk(store_, transfers_, macro_walk_.needed_chunk()));
      step = macro_walk_.next(frustum_, store_.engine.table, reach_, skip_empty, visit, store_.work);
    }
    if (step == WalkStep::kDone) {
      macro_cells_done_ = true;
      return Status::kOk;
    }
    store_.work.charge_to(GridWork::kMacroCellVisit);
    const std::uint32_t slot = macro_ring_.push();
    visits_[slot] = visit;
    const std::uint32_t block_bytes = store_.frame.engine.grid.cell_block_bytes;
    const MainAddress address{store_.frame.engine.cell_blocks_address + std::uint64_t{visit.block} * block_bytes};
    return transfers_.get(store_.packet.cell_blocks[slot].bytes, address, block_bytes,
                          static_cast<std::uint8_t>(kFirstMacroTag + slot));
  }

  // Subpackets with a ray that has no hit in front of a run's cell yet; of the squares that the cell does not touch,
  // all subpackets or none.
  [[nodiscard]] SubpacketSet open_subpackets(const TriangleRun& run) {
    if ((store_.frame.engine.techniques & kUseSubpackets) == 0) return StorePacket::kAllSubpackets;
    if constexpr (StorePacket::kSquareCount >= 4) {
      return reaches_.open(frustum_, run.entry, run.touching, store_.work);
    } else {
      return reaches_.template open<L>(frustum_, run.entry, store_.work);
    }
  }

  // Squares of subpackets that may touch a cell and have a ray with no hit in front of it yet.
  [[nodiscard]] std::uint32_t squares_that_see(const CellVisit& cell) {
    static constexpr std::uint32_t kAllSquares = (1u << StorePacket::kSquareCount) - 1u;
    if ((store_.frame.engine.techniques & kUseSubpackets) == 0) return kAllSquares;
    const std::uint32_t open = reaches_.open_squares(frustum_, cell.entry, store_.work);
    if (open == 0) return 0;
    return squares_touching<L>(store_.packet, frustum_, Slab{cell.entry, cell.exit}, cell.u, cell.v, open, store_.work);
  }

  // Waits for the oldest run and tests it, unless every ray has meanwhile hit something in front of it.
  [[nodiscard]] Status test_front_run() {
    store_.work.charge_to(GridWork::kTriangleBatch);
    const std::uint32_t slot = triangle_ring_.front();
    GRIDIRON_TRY(transfers_.wait(static_cast<std::uint8_t>(kFirstTriangleTag + slot)));
    const TriangleRun& run = runs_[slot];
    if (!frustum_.beyond(Slab{run.entry, run.entry}, reach_)) {
      store_.work.add(GridWork::kTriangleBatch);
      const SubpacketSet open = open_subpackets(run);
      SubpacketSet changed = 0;
      // The other open subpackets are tested too, so that no triangle has to be fetched again for them by a later cell.
      if ((open & subpackets_of_squares(run.touching)) != 0) {
        changed = test_run(store_.packet.triangles[slot].bytes, run.first_byte, run.count, open);
      }
      if (changed != 0) reach_ = reaches_.template update<L>(store_.packet, changed, store_.work);
    }
    store_.work.charge_to(GridWork::kTriangleBatch);
    triangle_ring_.pop();
    return Status::kOk;
  }

  // Tests a run, `first_byte` into its buffer, against the rays of the open subpackets. @returns the subpackets of
  // which a hit changed.
  [[nodiscard]] SubpacketSet test_run(std::byte* buffer, std::uint32_t first_byte, std::uint32_t count,
                                      SubpacketSet open) {
    const std::byte* const records = buffer + first_byte;
    const bool facing = store_.frame.shading == static_cast<std::uint32_t>(Shading::kSimple);
    if (store_.frame.accuracy == static_cast<std::uint32_t>(Accuracy::kPaper)) {
      return test_each_projection(reinterpret_cast<const ProjectionTriangle*>(records), count, open, facing);
    }
    const auto* triangles = reinterpret_cast<const VertexTriangle*>(records);
    if (is_on_lattice(store_.frame)) {
      store_.work.add(Work::kLatticeTriangle, count);
      triangles = spread_lattice_run(store_.frame.engine.grid.lattice, buffer, first_byte, count);
    }
    return facing ? test_each<true>(triangles, count, open) : test_each<false>(triangles, count, open);
  }

  template <bool kWantFacing>
  [[nodiscard]] SubpacketSet test_each(const VertexTriangle* triangles, std::uint32_t count, SubpacketSet wanted) {
    const Culling culling{.corner_rays = (store_.frame.engine.techniques & kUseCornerCulling) != 0,
                          .subpackets = (store_.frame.engine.techniques & kUseSubpackets) != 0};
    OpenTriangle open[kRunTriangles];
    const std::uint32_t open_count = keep_untested(triangles, count, wanted, culling, open);
    return intersect_standard_batch<L, kWantFacing>(store_.packet, open, open_count, culling, store_.work);
  }

  // Finds the triangles of a run that subpackets have to test. The mailbox is asked only after the boxes, so triangles
  // that appear elsewhere take no slot. @returns how many these are.
  [[nodiscard]] GRIDIRON_OUTLINE std::uint32_t keep_untested(const VertexTriangle* triangles, std::uint32_t count,
                                                             SubpacketSet wanted, Culling culling, OpenTriangle* open) {
    std::uint32_t open_count = 0;
    for (std::uint32_t first = 0; first < count; first += L::kCount) {
      std::uint32_t in_batch = count - first;
      if (in_batch > L::kCount) in_batch = L::kCount;
      open_count += open_triangles<L>(store_.packet, triangles + first, in_batch, wanted, culling, open + open_count,
                                      store_.work);
    }
    if ((store_.frame.engine.techniques & kUseMailbox) == 0) return open_count;
    store_.work.add(GridWork::kMailboxProbe, open_count);
    std::uint32_t untested_count = 0;
    for (std::uint32_t i = 0; i < open_count; ++i) {
      open[untested_count] = open[i];
      const SubpacketSet untested = store_.packet.mailbox.untested(open[i].triangle->triangle_id, open[i].subpackets);
      open[untested_count].subpackets = untested;
      untested_count += untested != 0 ? 1u : 0u;
    }
    return untested_count;
  }

  [[nodiscard]] SubpacketSet test_each_projection(const ProjectionTriangle* triangles, std::uint32_t count,
                                                  SubpacketSet wanted, bool want_facing) {
    const bool use_mailbox = (store_.frame.engine.techniques & kUseMailbox) != 0;
    const bool use_corner_rays = (store_.frame.engine.techniques & kUseCornerCulling) != 0;
    SubpacketSet changed = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
      SubpacketSet untested = wanted;
      if (use_mailbox) {
        store_.work.add(GridWork::kMailboxProbe);
        untested = store_.packet.mailbox.untested(triangles[i].triangle_id, wanted);
      }
      store_.work.charge_to(Work::kCullTestPaper);
      if (untested == 0) continue;
      changed |=
          intersect_projection<L>(store_.packet, triangles[i], untested, use_corner_rays, want_facing, store_.work);
    }
    return changed;
  }

  Store& store_;
  Transfers<P>& transfers_;
  const Frustum& frustum_;
  BufferRing macro_ring_;
  BufferRing triangle_ring_;
  MacroWalk macro_walk_{};
  CellWalk cell_walk_{};
  MacroVisit visits_[Layout::kMaxMacroDepth];
  TriangleRun runs_[Layout::kMaxTriangleDepth];
  CellVisit cell_{};            ///< the rest of the cell whose triangles are being fetched
  std::uint32_t touching_ = 0;  ///< squares of subpackets that may touch it
  SubpacketReach<StorePacket> reaches_;
  float reach_ = 0.0f;    ///< the largest of them
  bool entered_ = false;  ///< the macrocell ring's front has been waited for
  bool walking_ = false;  ///< cell_walk_ has cells left
  bool macro_cells_done_ = false;
  bool cells_done_ = false;
};

}  // namespace gridiron
