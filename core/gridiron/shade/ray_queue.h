// Ray queue: secondary rays that wait for their turn. A stack with its top in the local store; when it is full, the
// oldest rays go to main memory in blocks, and come back when they are needed.
// Memory: EffectStore and the caller's SpillRegion. Threads: one core. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/effect_records.h>
#include <gridiron/dma/transfers.h>
#include <gridiron/platform/contract.h>
#include <gridiron/shade/effect_store.h>

#include <cstdint>

namespace gridiron {

/// @tparam Store  EffectStore.
template <class Store, Platform P>
class RayQueue {
 public:
  RayQueue(Store& store, Transfers<P>& transfers, MainAddress spill)
      : store_(store), transfers_(transfers), spill_(spill) {}

  [[nodiscard]] bool empty() const { return count_ == 0 && spilled_blocks_ == 0; }

  /// Puts a ray on top.
  [[nodiscard]] Status push(const QueuedRay& ray) {
    if (count_ == Store::kQueueRays) {
      GRIDIRON_TRY(transfers_.put(store_.queue + first_, spill_place(spilled_blocks_), kBlockBytes, kSetupTag));
      GRIDIRON_TRY(transfers_.wait(kSetupTag));
      ++spilled_blocks_;
      first_ = place_of(Store::kSpillBlockRays);
      count_ -= Store::kSpillBlockRays;
    }
    store_.queue[place_of(count_)] = ray;
    ++count_;
    return Status::kOk;
  }

  /// Takes up to kWaveRays rays off the top, the last pushed; calls take(i, ray) in the order in which they were
  /// pushed.
  template <class Take>
  [[nodiscard]] Status pop_wave(std::uint32_t& taken, Take&& take) {
    while (spilled_blocks_ != 0 && count_ < Store::kWaveRays && count_ + Store::kSpillBlockRays <= Store::kQueueRays) {
      --spilled_blocks_;
      first_ = first_ == 0 ? Store::kQueueRays - Store::kSpillBlockRays : first_ - Store::kSpillBlockRays;
      count_ += Store::kSpillBlockRays;
      GRIDIRON_TRY(transfers_.get(store_.queue + first_, spill_place(spilled_blocks_), kBlockBytes, kSetupTag));
      GRIDIRON_TRY(transfers_.wait(kSetupTag));
    }
    taken = count_ < Store::kWaveRays ? count_ : Store::kWaveRays;
    count_ -= taken;
    for (std::uint32_t i = 0; i < taken; ++i) take(i, store_.queue[place_of(count_ + i)]);
    return Status::kOk;
  }

 private:
  static constexpr std::uint32_t kBlockBytes = Store::kSpillBlockRays * static_cast<std::uint32_t>(sizeof(QueuedRay));
  static_assert(!Store::kHasQueue || Store::kQueueRays % Store::kSpillBlockRays == 0);

  // The i-th oldest ray here, in a ring.
  [[nodiscard]] std::uint32_t place_of(std::uint32_t i) const {
    const std::uint32_t place = first_ + i;
    return place < Store::kQueueRays ? place : place - Store::kQueueRays;
  }
  [[nodiscard]] MainAddress spill_place(std::uint32_t block) const {
    return spill_.offset_by(std::uint64_t{block} * kBlockBytes);
  }

  Store& store_;
  Transfers<P>& transfers_;
  MainAddress spill_;
  std::uint32_t first_ = 0;  ///< of the ring, a multiple of Store::kSpillBlockRays
  std::uint32_t count_ = 0;  ///< rays in it
  std::uint32_t spilled_blocks_ = 0;
};

}  // namespace gridiron
