// A worker core's part of a frame: renders tiles until none is left, and records what it did.
// Memory: its local store and slot; borrows the port. Threads: one core. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/work_counters.h>
#include <gridiron/firmware/frame_job.h>
#include <gridiron/platform/contract.h>
#include <gridiron/render/tile_renderer.h>
#include <gridiron/store/local_store.h>

#include <concepts>
#include <cstdint>

#include "run_control.h"
#include "stack_paint.h"

namespace gridiron::port {

static_assert(kWorkKindCount <= kMostWorkKinds);

/// A port that counts the instructions of its core; without one a board's results have 0.
template <class P>
concept InstructionCounter = requires(P& port) {
  { port.instructions() } -> std::same_as<std::uint64_t>;
};

/// Passes every call on to a port and counts transfers and bytes, in all and for each tile.
template <Platform P>
class CountingPort {
 public:
  /// @param tiles  one result for each tile of the frame; only those of this core are written.
  CountingPort(P& port, CoreSlot& slot, TileResult* tiles, std::uint32_t core_index)
      : port_(port), slot_(slot), tiles_(tiles), core_index_(core_index) {}

  [[nodiscard]] PlatformLimits limits() const { return port_.limits(); }

  Status get(void* local, MainAddress address, std::uint32_t bytes, Tag tag) {
    return count(bytes, port_.get(local, address, bytes, tag));
  }
  Status put(const void* local, MainAddress address, std::uint32_t bytes, Tag tag) {
    return count(bytes, port_.put(local, address, bytes, tag));
  }
  Status wait(TagMask tags) { return port_.wait(tags); }

  ItemClaim claim_item() {
    finish_tile();
    const std::uint64_t before = instructions();  // a tile's claim is its own
    const ItemClaim claim = port_.claim_item();
    if (claim.kind == ItemClaim::Kind::kItem) {
      has_tile_ = true;
      tile_id_ = claim.item;
      transfers_before_ = transfers_;
      instructions_before_ = before;
      ++claimed_;
    }
    return claim;
  }

  /// Records the last tile, unless it has been recorded.
  void finish_tile() {
    if (!has_tile_) return;
    has_tile_ = false;
    tiles_[tile_id_] = {core_index_, transfers_ - transfers_before_, instructions() - instructions_before_};
    __atomic_store_n(&slot_.tiles_done, claimed_, __ATOMIC_RELEASE);
  }

  [[nodiscard]] std::uint32_t claimed() const { return claimed_; }
  [[nodiscard]] std::uint32_t transfers() const { return transfers_; }
  [[nodiscard]] std::uint64_t transfer_bytes() const { return transfer_bytes_; }

  [[nodiscard]] std::uint64_t instructions() {
    if constexpr (InstructionCounter<P>) {
      return port_.instructions();
    } else {
      return 0;
    }
  }

 private:
  Status count(std::uint32_t bytes, Status status) {
    if (status == Status::kOk) {
      ++transfers_;
      transfer_bytes_ += bytes;
    }
    return status;
  }

  P& port_;
  CoreSlot& slot_;
  TileResult* tiles_;
  std::uint32_t core_index_;
  std::uint32_t tile_id_ = 0;
  std::uint32_t claimed_ = 0;
  std::uint32_t transfers_ = 0;
  std::uint32_t transfers_before_ = 0;
  std::uint64_t transfer_bytes_ = 0;
  std::uint64_t instructions_before_ = 0;
  bool has_tile_ = false;
};

/// Renders the core's share of the frame that the master has put into `control`.
///
/// @tparam L      lanes, as of render_tiles.
/// @param store   start of the core's arena, its bytes need not be cleared.
/// @param port    the core's own; if it has instructions(), they are counted.
/// @param tiles   control.tile_count results.
/// @param stack   of this core alone. It is painted before the frame, and measured afterwards.
/// Errors: in the slot's result. The slot is finished when this returns; the board then notifies the master.
template <class L, class Layout, Platform P>
void run_worker(LocalStore<Layout>& store, P& port, RunControl& control, TileResult* tiles, std::uint32_t core_index,
                StackArea stack) {
  CoreSlot& slot = control.cores[core_index];
  paint_stack(stack);
  set_state(slot, CoreState::kWorking);
  const SpillRegion spill =
      control.spill_address == 0
          ? SpillRegion{}
          : SpillRegion{MainAddress{control.spill_address + core_index * control.spill_bytes}, control.spill_bytes};
  CountingPort<P> counting(port, slot, tiles, core_index);
  store.work = WorkCounters{};  // not left as it was where the frame's record never came
  const std::uint64_t before = counting.instructions();
  const Status status = render_tiles<L>(store, counting, MainAddress{control.frame_address}, spill);
  const std::uint64_t after = counting.instructions();
  counting.finish_tile();

  CoreResult& result = slot.result;
  result.status = static_cast<std::uint32_t>(status);
  if (status == Status::kMissingEffect) result.missing_effects = missing_effects(store);
  result.tiles = counting.claimed();
  result.transfers = counting.transfers();
  result.transfer_bytes = counting.transfer_bytes();
  result.instructions = after - before;
  for (std::uint32_t kind = 0; kind < kWorkKindCount; ++kind) result.work[kind] = store.work.counts[kind];
  result.stack_bytes = used_stack_bytes(stack);
  set_state(slot, CoreState::kFinished);
}

}  // namespace gridiron::port
