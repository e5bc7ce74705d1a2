// A simulated core whose transfers move when a schedule says so: after any call between their own and their wait, in
// any order. Until then a get's destination is poison and a put's source unread. Logs what the kernel asks for.
// Memory: std::vector; borrows the simulated core. Threads: one. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/stages.h>
#include <gridiron/base/work_counters.h>
#include <gridiron/dma/tags.h>
#include <gridiron/sim/sim_core.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <span>
#include <vector>

namespace gridiron::test {

/// What a transfer is for.
enum class Purpose : char {
  kSetup = 'm',   ///< frame, table, materials, lights
  kBlock = 'b',   ///< cells of a macrocell, or a node
  kRun = 'r',     ///< triangles, or a leaf
  kRecord = 'g',  ///< a record that is gathered
  kSpill = 's',   ///< rays on their way to main memory or back
  kTile = 't',    ///< a finished tile
};

/// One transfer of a frame. Calls are counted from 0, transfers from 1.
struct LoggedTransfer {
  Purpose purpose;
  std::uint8_t tag;
  bool is_put;
  Stage stage;
  std::uint32_t start_call;
  std::uint32_t wait_call;  ///< that ended it; kNoCall: none has
};
inline constexpr std::uint32_t kNoCall = ~0u;

/// One wait.
struct LoggedWait {
  std::uint32_t call;
  std::uint32_t tags;  ///< bit i = tag i
  Stage stage;
};

/// A transfer's bytes have moved: after a call, or in a wait.
struct Completion {
  std::uint32_t number;
  std::uint32_t call;
};

/// Asked after every call, until it answers open.size(): which of the pending transfers that have not moved, the oldest
/// first, moves next. Empty: none before its wait.
using Schedule = std::function<std::size_t(std::uint32_t call, std::span<const std::uint32_t> open)>;

/// How one frame is run.
struct OrderPlan {
  Schedule schedule{};
  std::uint32_t dropped_wait = kNoCall;   ///< this call's wait ends at once, as if nothing were pending
  std::uint32_t swapped_transfer = 0;     ///< goes out under ...
  std::uint8_t swapped_tag = 0;           ///< ... this tag
  std::uint32_t held_transfer = 0;        ///< a get whose bytes are poison beyond its wait, and come at the end ...
  std::uint32_t held_until = kNoCall;     ///< ... of this call, unless another get took its place meanwhile
  bool reads_store = false;               ///< the store's bytes are part of every call
};

class OrderCore {
 public:
  OrderCore(sim::SimCore& core, std::span<const std::byte> store, const OrderPlan& plan)
      : core_(core), store_(store), plan_(plan) {}

  [[nodiscard]] PlatformLimits limits() const { return core_.limits(); }
  Status get(void* local, MainAddress address, std::uint32_t bytes, Tag tag) {
    const Status status = core_.get(local, address, bytes, sent_under(tag));
    if (status != Status::kOk) return status;
    return started(static_cast<const std::byte*>(local), address, bytes, tag, true);
  }
  Status put(const void* local, MainAddress address, std::uint32_t bytes, Tag tag) {
    const Status status = core_.put(local, address, bytes, sent_under(tag));
    if (status != Status::kOk) return status;
    return started(static_cast<const std::byte*>(local), address, bytes, tag, false);
  }
  Status wait(TagMask tags) {
    const auto call = static_cast<std::uint32_t>(calls.size());
    waits.push_back({call, tags.bits, stage_});
    if (call != plan_.dropped_wait) {
      const Status status = core_.wait(tags);
      if (status != Status::kOk) return status;
      const auto ends = [&](const Pending& pending) { return (tags.bits >> pending.tag & 1u) != 0; };
      for (const Pending& pending : pending_) {
        if (!ends(pending)) continue;
        transfers[pending.number - 1].wait_call = call;
        if (!pending.has_moved) completions.push_back({pending.number, call});
        if (pending.number == plan_.held_transfer && call < plan_.held_until) hold(pending);
      }
      std::erase_if(pending_, ends);
    }
    return finish_call(0x5741u ^ std::uint64_t{tags.bits} << 16);
  }
  ItemClaim claim_item() {
    const ItemClaim claim = core_.claim_item();
    static_cast<void>(finish_call(0xC1A1u));
    return claim;
  }
  void note_work(const std::uint32_t* counts, std::uint32_t count) {
    core_.note_work(counts, count);
    for (std::uint32_t i = 0; i < count; ++i) mix(work_, counts[i]);
  }
  void note_stage(std::uint8_t stage) {
    stage_ = static_cast<Stage>(stage);
    core_.note_stage(stage);
  }

  std::vector<std::uint64_t> calls;        ///< what each was, and all work until then
  std::vector<LoggedTransfer> transfers;   ///< in the order of their starts
  std::vector<LoggedWait> waits;
  std::vector<Completion> completions;     ///< in their order
  std::uint32_t most_pending = 0;

 private:
  struct Pending {
    std::uint32_t number;
    std::uint8_t tag;
    bool has_moved;
    const std::byte* begin;  ///< of a get's destination; a put's is empty
    std::uint32_t bytes;
  };

  static void mix(std::uint64_t& digest, std::uint64_t word) {
    digest = (digest ^ word) * 0x9E3779B97F4A7C15u;
    digest ^= digest >> 29;
  }
  [[nodiscard]] Tag sent_under(Tag tag) const {
    return transfers.size() + 1 == plan_.swapped_transfer ? Tag{plan_.swapped_tag} : tag;
  }
  [[nodiscard]] Purpose purpose_of(MainAddress address, Tag tag) const {
    if (tag.index >= kFirstOutputTag) return Purpose::kTile;
    if (tag.index >= kFirstTriangleTag) {
      return stage_ == Stage::kSurface || stage_ == Stage::kEnvironment ? Purpose::kRecord : Purpose::kRun;
    }
    if (tag.index >= kFirstMacroTag) return Purpose::kBlock;
    const SpillRegion spill = core_.spill();
    return address.value - spill.address.value < spill.bytes ? Purpose::kSpill : Purpose::kSetup;
  }

  Status started(const std::byte* local, MainAddress address, std::uint32_t bytes, Tag tag, bool is_get) {
    const auto call = static_cast<std::uint32_t>(calls.size());
    transfers.push_back({purpose_of(address, tag), tag.index, !is_get, stage_, call, kNoCall});
    const auto number = static_cast<std::uint32_t>(transfers.size());
    const std::uint8_t under = number == plan_.swapped_transfer ? plan_.swapped_tag : tag.index;
    const Pending made{number, under, false, local, is_get ? bytes : 0};
    pending_.push_back(made);
    if (made.begin < held_.begin + held_.bytes && held_.begin < made.begin + made.bytes) held_ = {};
    most_pending = std::max(most_pending, static_cast<std::uint32_t>(pending_.size()));
    std::uint64_t what = address.value;
    mix(what, bytes);
    mix(what, static_cast<std::uint64_t>(local - store_.data()));
    mix(what, tag.index * 2u + (is_get ? 1u : 0u));
    return finish_call(what);
  }

  // Takes the bytes of a get away that has just ended.
  void hold(const Pending& pending) {
    held_ = pending;
    held_bytes_.assign(pending.begin, pending.begin + pending.bytes);
    std::memset(in_store(held_), 0x5A, held_.bytes);
  }
  [[nodiscard]] static std::byte* in_store(const Pending& get) { return const_cast<std::byte*>(get.begin); }

  // Everything in the store but where gets are pending: those bytes are undefined. All are multiples of 16.
  void mix_store(std::uint64_t& digest) const {
    const std::byte* begin = store_.data();
    const std::byte* const end = begin + store_.size();
    while (begin < end) {
      const Pending* next = nullptr;
      for (const Pending& pending : pending_) {
        if (pending.bytes == 0 || pending.begin < begin) continue;
        if (next == nullptr || pending.begin < next->begin) next = &pending;
      }
      const std::byte* const stop = next == nullptr ? end : next->begin;
      for (; begin < stop; begin += 8) {
        std::uint64_t word = 0;
        std::memcpy(&word, begin, 8);
        digest = (digest ^ word) * 0x100000001B3u;
      }
      if (next != nullptr) begin = stop + next->bytes;
    }
  }

  Status finish_call(std::uint64_t what) {
    mix(what, work_);
    if (plan_.reads_store) mix_store(what);
    const auto call = static_cast<std::uint32_t>(calls.size());
    calls.push_back(what);
    if (call == plan_.held_until && held_.bytes != 0) std::memcpy(in_store(held_), held_bytes_.data(), held_.bytes);
    if (!plan_.schedule) return Status::kOk;
    for (;;) {
      std::uint32_t open[32];
      std::size_t count = 0;
      for (const Pending& pending : pending_) {
        if (!pending.has_moved && count < std::size(open)) open[count++] = pending.number;
      }
      if (count == 0) return Status::kOk;
      const std::size_t choice = plan_.schedule(call, std::span(open, count));
      if (choice >= count) return Status::kOk;
      for (Pending& pending : pending_) {
        if (pending.number == open[choice]) pending.has_moved = true;
      }
      completions.push_back({open[choice], call});
      static_cast<void>(core_.move_now(open[choice]));
    }
  }

  sim::SimCore& core_;
  std::span<const std::byte> store_;
  const OrderPlan& plan_;
  std::vector<Pending> pending_;
  Pending held_{};  ///< the get of held_bytes_; empty: none
  std::vector<std::byte> held_bytes_;
  std::uint64_t work_ = 0;
  Stage stage_ = Stage::kPrimary;
};

static_assert(Platform<OrderCore>);

}  // namespace gridiron::test
