// A platform on which every transfer ends when a schedule says so: after any call between its own and its wait. A get's
// destination is poison until then, a put's source is read then.
// Memory: std::vector; borrows the local store. Threads: one. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/platform/contract.h>
#include <gridiron/platform/transfer_rules.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace gridiron::test {

class OrderPlatform {
 public:
  /// Asked at the end of every call how many of `open` transfers, the oldest is bit 0, end before the core goes on.
  using Schedule = std::function<std::uint32_t(std::uint32_t call, std::uint32_t open)>;

  OrderPlatform(std::span<std::byte> memory, std::span<std::byte> store, std::uint32_t queue_depth, Schedule schedule)
      : memory_(memory), store_(store), schedule_(std::move(schedule)) {
    limits_.queue_depth = queue_depth;
  }

  std::uint32_t tile_count = 0;
  std::uint32_t dropped_wait = ~0u;  ///< index of a call: that wait ends at once, as if nothing were pending

  [[nodiscard]] PlatformLimits limits() const { return limits_; }
  Status get(void* local, MainAddress address, std::uint32_t bytes, Tag tag) {
    return start(true, static_cast<std::byte*>(local), address.value, bytes, tag);
  }
  Status put(const void* local, MainAddress address, std::uint32_t bytes, Tag tag) {
    return start(false, const_cast<std::byte*>(static_cast<const std::byte*>(local)), address.value, bytes, tag);
  }
  Status wait(TagMask tags) {
    const bool is_dropped = calls.size() == dropped_wait;
    for (Transfer& transfer : transfers_) {
      if (!transfer.is_pending || (tags.bits >> transfer.tag & 1u) == 0) continue;
      ++waited_for;
      if (!is_dropped && !transfer.has_ended) end(transfer);
      transfer.is_pending = false;
    }
    return finish_call(tags.bits);
  }
  TileClaim claim_tile() {
    static_cast<void>(finish_call(0xC1A1Au));
    if (next_tile_ == tile_count) return {};
    return {TileClaim::Kind::kTile, next_tile_++};
  }

  /// What each call was and what the store held outside of pending gets.
  std::vector<std::uint64_t> calls;
  std::vector<std::uint32_t> open_after;  ///< transfers that have not ended before the schedule was asked, by call
  std::uint32_t most_pending = 0, waited_for = 0;
  std::string violation;

  [[nodiscard]] bool is_idle() const {
    for (const Transfer& transfer : transfers_) {
      if (transfer.is_pending || !transfer.has_ended) return false;
    }
    return true;
  }

 private:
  struct Transfer {
    bool is_get, is_pending, has_ended;
    std::uint8_t tag;
    std::byte* local;
    std::uint64_t address;
    std::uint32_t bytes;
    std::vector<std::byte> sent;
  };
  static constexpr std::byte kPoison{0xA5};

  Status start(bool is_get, std::byte* local, std::uint64_t address, std::uint32_t bytes, Tag tag) {
    const auto place = reinterpret_cast<std::uintptr_t>(local);
    if (check_transfer(limits_, place, MainAddress{address}, bytes, tag) != Status::kOk) return fail("form");
    if (address + bytes > memory_.size() || local < store_.data() || local + bytes > store_.data() + store_.size()) {
      return fail("range");
    }
    std::uint32_t pending = 0;
    for (const Transfer& other : transfers_) {
      if (!other.is_pending) continue;
      ++pending;
      const bool meets_here = local < other.local + other.bytes && other.local < local + bytes;
      const bool meets_there = address < other.address + other.bytes && other.address < address + bytes;
      if (meets_here && (is_get || other.is_get)) return fail("a buffer in flight");
      if (meets_there && (!is_get || !other.is_get)) return fail("main memory in flight");
    }
    if (pending >= limits_.queue_depth) return fail("queue depth");
    most_pending = pending + 1 > most_pending ? pending + 1 : most_pending;
    std::erase_if(transfers_, [](const Transfer& old) { return !old.is_pending && old.has_ended; });
    transfers_.push_back({is_get, true, false, tag.index, local, address, bytes, {}});
    if (is_get) {
      std::memset(local, static_cast<int>(kPoison), bytes);
    } else {
      transfers_.back().sent.assign(local, local + bytes);
    }
    return finish_call(address * 64 + tag.index * 2u + (is_get ? 1u : 0u));
  }

  void end(Transfer& transfer) {
    transfer.has_ended = true;
    std::byte* const main = memory_.data() + transfer.address;
    if (transfer.is_get) {
      for (std::uint32_t i = 0; i < transfer.bytes; ++i) {
        if (transfer.local[i] != kPoison) static_cast<void>(fail("a destination was written before its wait"));
      }
      std::memcpy(transfer.local, main, transfer.bytes);
    } else {
      if (std::memcmp(transfer.sent.data(), transfer.local, transfer.bytes) != 0) {
        static_cast<void>(fail("a source changed before its wait"));
      }
      std::memcpy(main, transfer.local, transfer.bytes);
    }
  }

  Status finish_call(std::uint64_t what) {
    std::uint64_t digest = what * 0x9E3779B97F4A7C15u + 1;
    const auto mix = [&](const std::byte* begin, const std::byte* stop) {
      for (; begin < stop; begin += 8) {
        std::uint64_t word = 0;
        std::memcpy(&word, begin, 8);
        digest = (digest ^ word) * 0x100000001B3u;
      }
    };
    // Pending destinations are left out; they are multiples of 16 bytes.
    const std::byte* begin = store_.data();
    const std::byte* const stop = begin + store_.size();
    while (begin < stop) {
      const Transfer* next = nullptr;
      for (const Transfer& transfer : transfers_) {
        if (!transfer.is_pending || !transfer.is_get || transfer.local < begin) continue;
        if (next == nullptr || transfer.local < next->local) next = &transfer;
      }
      mix(begin, next == nullptr ? stop : next->local);
      begin = next == nullptr ? stop : next->local + next->bytes;
    }
    const auto call = static_cast<std::uint32_t>(calls.size());
    calls.push_back(digest);
    std::uint32_t open = 0;
    for (const Transfer& transfer : transfers_) open += transfer.has_ended ? 0u : 1u;
    open_after.push_back(open);
    if (open != 0) {
      std::uint32_t ending = schedule_(call, open);
      for (Transfer& transfer : transfers_) {
        if (transfer.has_ended) continue;
        if ((ending & 1u) != 0) end(transfer);
        ending >>= 1;
      }
    }
    return violation.empty() ? Status::kOk : Status::kTransferOverlap;
  }

  Status fail(const char* what) {
    if (violation.empty()) violation = std::string(what) + ", call " + std::to_string(calls.size());
    return Status::kTransferOverlap;
  }

  PlatformLimits limits_;
  std::span<std::byte> memory_, store_;
  Schedule schedule_;
  std::vector<Transfer> transfers_;
  std::uint32_t next_tile_ = 0;
};

static_assert(Platform<OrderPlatform>);

}  // namespace gridiron::test
