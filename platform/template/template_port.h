// A port to start from: the contract over a DMA engine with one command slot, with a queue in software.
// Copy it, write a Board for your chip (template_board.h shows one), and run tests/contract against it.
// Memory: a few hundred bytes by value. Threads: one core per object. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/platform/contract.h>
#include <gridiron/platform/tile_order.h>
#include <gridiron/platform/transfer_rules.h>

#include <concepts>
#include <cstdint>

namespace gridiron::port {

/// One copy, as the engine sees it: addresses of the chip's bus.
struct EngineCommand {
  std::uint64_t target = 0;
  std::uint64_t source = 0;
  std::uint32_t bytes = 0;
};

/// What a port needs of a chip.
///
/// start              writes the engine's registers; the engine is idle when it is called.
/// is_busy, has_failed  read them. has_failed refers to the last command and is called once it is no longer busy. Where
/// software replaces the engine, is_busy may do the copy.
/// bus_address        of local memory, as the engine sees it.
/// holds              whether bytes lie in this core's local memory.
/// write_back         makes stored bytes visible to the engine (caches: clean), then orders them before start.
/// discard            makes later loads fetch what the engine wrote (caches: invalidate), ordered after is_busy.
/// next_tile          a number that no other core gets in this frame: an atomic add in memory that all cores share.
/// must_stop          the host's request to end the frame.
template <class B>
concept Board = requires(B& board, const B& constant, const EngineCommand& command, const void* local,
                         std::uint32_t bytes) {
  { board.start(command) } -> std::same_as<void>;
  { board.is_busy() } -> std::same_as<bool>;
  { board.has_failed() } -> std::same_as<bool>;
  { constant.bus_address(local) } -> std::same_as<std::uint64_t>;
  { constant.holds(local, bytes) } -> std::same_as<bool>;
  { board.write_back(local, bytes) } -> std::same_as<void>;
  { board.discard(local, bytes) } -> std::same_as<void>;
  { board.next_tile() } -> std::same_as<std::uint32_t>;
  { board.must_stop() } -> std::same_as<bool>;
  { constant.tile_count() } -> std::same_as<std::uint32_t>;
};

/// A Board that knows which main memory its core may transfer: a transfer that reaches() rejects is never started.
/// Without it, the engine or a guard before it must fail such a transfer.
template <class B>
concept BoundedBoard = Board<B> && requires(const B& constant, MainAddress address, std::uint32_t bytes) {
  { constant.reaches(address, bytes) } -> std::same_as<bool>;
};

/// The contract over a Board.
///
/// @tparam kQueueDepth   commands that may be pending; the engine works on one, the others wait here in order.
/// @tparam kPollBound    how often one command is polled before it counts as timed out.
template <Board B, std::uint32_t kQueueDepth = 16, std::uint32_t kPollBound = 1u << 20>
class TemplatePort {
 public:
  explicit TemplatePort(B& board) : board_(board) {}

  [[nodiscard]] PlatformLimits limits() const {
    PlatformLimits limits;
    limits.queue_depth = kQueueDepth;
    return limits;
  }

  Status get(void* local, MainAddress address, std::uint32_t bytes, Tag tag) {
    return enqueue({{board_.bus_address(local), address.value, bytes}, local, address, tag, true});
  }

  Status put(const void* local, MainAddress address, std::uint32_t bytes, Tag tag) {
    return enqueue({{address.value, board_.bus_address(local), bytes}, local, address, tag, false});
  }

  Status wait(TagMask tags) {
    // The engine takes commands in order, so waiting for the last one of the mask waits for all of them.
    std::uint32_t last = 0;
    for (std::uint32_t i = 0; i < count_; ++i) {
      if ((TagMask::of(at(i).tag).bits & tags.bits) != 0) last = i + 1;
    }
    for (std::uint32_t i = 0; i < last; ++i) finish_first();
    const Status status = errors_.of(tags);
    errors_.clear(tags);
    return status;
  }

  ItemClaim claim_item() {
    if (board_.must_stop()) return {ItemClaim::Kind::kAborted, 0};
    const std::uint32_t claim = board_.next_tile(), count = board_.tile_count();
    if (claim >= count) return {ItemClaim::Kind::kNone, 0};
    return {ItemClaim::Kind::kItem, middle_out(claim, count)};
  }

 private:
  struct Command {
    EngineCommand engine;
    const void* local = nullptr;
    MainAddress address;
    Tag tag;
    bool is_get = false;
  };

  /// Which tags have a failed or timed-out transfer that no wait has reported yet.
  struct Errors {
    std::uint32_t failed = 0;
    std::uint32_t timed_out = 0;

    [[nodiscard]] Status of(TagMask tags) const {
      if ((failed & tags.bits) != 0) return Status::kTransferFailed;
      return (timed_out & tags.bits) != 0 ? Status::kTransferTimedOut : Status::kOk;
    }
    void clear(TagMask tags) {
      failed &= ~tags.bits;
      timed_out &= ~tags.bits;
    }
  };

  Command& at(std::uint32_t index) { return queue_[(first_ + index) % kQueueDepth]; }

  // Not inlined: one copy for gets and puts saves local store.
  __attribute__((noinline)) Status enqueue(const Command& command) {
    GRIDIRON_TRY(check_transfer(limits(), command.engine.bytes == 0 ? 0 : board_.bus_address(command.local),
                                command.address, command.engine.bytes, command.tag));
    if (!board_.holds(command.local, command.engine.bytes)) return Status::kTransferLocalRange;
    if constexpr (BoundedBoard<B>) {
      if (!board_.reaches(command.address, command.engine.bytes)) return Status::kTransferMainRange;
    }
    if (count_ == kQueueDepth) return Status::kTransferQueueFull;
    if (is_stuck_) return Status::kTransferTimedOut;

    // Duties before a transfer: stored bytes must have left the cache, also in a get's destination, lest the cache
    // write an old line over the new bytes.
    board_.write_back(command.local, command.engine.bytes);
    at(count_) = command;
    ++count_;
    if (count_ == 1) board_.start(at(0).engine);
    return Status::kOk;
  }

  // Waits for the oldest command, within a bound, and starts the next one. After a timeout the engine is never started
  // again, because its state is unknown; all its commands count as timed out.
  void finish_first() {
    const Command& command = at(0);
    std::uint32_t polls = 0;
    while (!is_stuck_ && board_.is_busy()) is_stuck_ = ++polls == kPollBound;
    if (is_stuck_) {
      errors_.timed_out |= TagMask::of(command.tag).bits;
    } else if (board_.has_failed()) {
      errors_.failed |= TagMask::of(command.tag).bits;
    } else if (command.is_get) {
      // Duty after a get: no load may read a line that was fetched before the bytes arrived.
      board_.discard(command.local, command.engine.bytes);
    }
    first_ = (first_ + 1) % kQueueDepth;
    --count_;
    if (count_ != 0 && !is_stuck_) board_.start(at(0).engine);
  }

  B& board_;
  Command queue_[kQueueDepth];
  std::uint32_t first_ = 0;
  std::uint32_t count_ = 0;
  Errors errors_;
  bool is_stuck_ = false;
};

}  // namespace gridiron::port
