// The order of claims: cores take turns by their own clocks, each as if it were alone with its memory. So the machine's
// profile alone decides which core gets which tile, not host threads, and not the contention that depends on it.
// Memory: std::vector. Threads: one per core; all calls may come at once. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/sim/replay.h>
#include <gridiron/sim/sim_core.h>

#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <utility>
#include <vector>

namespace gridiron::bvh {

using sim::CoreClock;

/// Lets one core run at a time: the one whose clock is least, ties by number.
class ClaimOrder {
 public:
  explicit ClaimOrder(std::uint32_t cores) : turns_(cores) {}

  /// Blocks until every other core waits too or has left, and none is behind `now`.
  void wait_for_turn(std::uint32_t core, CoreClock::Ticks now);
  /// The core makes no more claims.
  void leave(std::uint32_t core);

 private:
  enum class State : std::uint8_t { kRunning, kWaiting, kLeft };
  struct Turn {
    State state = State::kRunning;
    CoreClock::Ticks now = 0;
  };
  [[nodiscard]] bool is_next(std::uint32_t core) const;

  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<Turn> turns_;
};

/// A simulated core that claims in order. All other calls go straight to it.
class OrderedCore {
 public:
  /// @param core_of_tile  out: element [tile] is written when the tile is claimed.
  OrderedCore(sim::SimCore& inner, std::uint32_t index, ClaimOrder& order, CoreClock clock,
              std::vector<std::uint32_t>& core_of_tile)
      : inner_(inner), index_(index), order_(order), clock_(std::move(clock)), core_of_tile_(core_of_tile) {}
  ~OrderedCore() { order_.leave(index_); }
  OrderedCore(const OrderedCore&) = delete;
  OrderedCore& operator=(const OrderedCore&) = delete;

  [[nodiscard]] PlatformLimits limits() const { return inner_.limits(); }
  Status get(void* local, MainAddress address, std::uint32_t bytes, Tag tag) {
    return inner_.get(local, address, bytes, tag);
  }
  Status put(const void* local, MainAddress address, std::uint32_t bytes, Tag tag) {
    return inner_.put(local, address, bytes, tag);
  }
  Status wait(TagMask tags) { return inner_.wait(tags); }
  void note_work(const std::uint32_t* counts, std::uint32_t count) { inner_.note_work(counts, count); }
  ItemClaim claim_item();

 private:
  sim::SimCore& inner_;
  std::uint32_t index_;
  ClaimOrder& order_;
  CoreClock clock_;
  std::vector<std::uint32_t>& core_of_tile_;
  bool in_tile_ = false;
  std::uint32_t tiles_ = 0;
};

static_assert(Platform<OrderedCore>);
static_assert(WorkObserver<OrderedCore>);

}  // namespace gridiron::bvh
