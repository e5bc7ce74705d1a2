// Model of a general core of 2006: in order, two instructions a cycle, two caches before a memory far away. Takes
// instructions one after the other, as they were executed, and says when each leaves.
// Memory: 100 KB, the caches' tags. Threads: one a model. SPDX-License-Identifier: Apache-2.0
#pragma once

// PUBLISHED of the general core of the Cell chip, and measured on it: two instructions a cycle of different units;
// latencies of fixed-point and float results; float divisions that hold their unit; a branch that was guessed wrong
// takes 23 cycles; 4,096 counters of 2 bits; 32 KB 4-way and 512 KB 8-way with lines of 128 bytes; loads go on behind a
// miss until a result is used, eight at once; the first cache writes through. ASSUMED, and marked so below: what was
// published as a range, or not at all.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace gridiron::general_core {

using Cycle = std::uint64_t;

inline constexpr std::uint32_t kIssueWidth = 2;
inline constexpr Cycle kFixedCycles = 2;          ///< until a fixed-point result can be used
inline constexpr Cycle kLoadCycles = 5;           ///< first cache to use; 4 to 5 published
inline constexpr Cycle kFloatCycles = 10;         ///< float and double alike, compares too
inline constexpr Cycle kVectorCycles = 4;         ///< of vectors: whole numbers, compares, lanes moved
inline constexpr Cycle kMultiplyCycles = 9;       ///< of 32 bits
inline constexpr Cycle kWideMultiplyCycles = 15;  ///< of 64 bits; published: 9 to 15
inline constexpr Cycle kFixedDivideCycles = 70;   ///< holds its unit; ASSUMED
inline constexpr Cycle kDivideCycles = 74;        ///< float, holds its unit
inline constexpr Cycle kRootCycles = 84;          ///< the same; ASSUMED
inline constexpr Cycle kBranchMissCycles = 23;
/// ASSUMED: a store's way to the second cache. A load of the same bytes waits for it; so does a number on its way
/// between fixed and float registers, which have no other way.
inline constexpr Cycle kStoreToLoadCycles = 40;
inline constexpr Cycle kSecondCacheCycles = 40;  ///< load to use; about 40 measured
inline constexpr Cycle kMemoryCycles = 500;      ///< the profile's latency of the accelerator cores too
inline constexpr std::uint32_t kFetches = 8;     ///< lines on their way from memory, loads on theirs from the 2nd cache
inline constexpr std::uint32_t kStoreQueue = 16;  ///< stores that wait for their line; ASSUMED
inline constexpr std::uint32_t kStreams = 8;      ///< followed at once; as many as the core's stream instructions have
/// ASSUMED: code that runs through memory asks for its lines ahead, as those instructions do; the model does it
/// unasked, from the second line on. With eight fetches of 500 cycles a stream brings a line in 62.5 cycles, 2 bytes a
/// cycle.
inline constexpr std::uint32_t kStreamAhead = 8;
inline constexpr std::uint32_t kLineShift = 7;  ///< lines of 128 bytes
inline constexpr std::uint32_t kFirstCacheLines = 32 * 1024 >> kLineShift, kFirstCacheWays = 4;
inline constexpr std::uint32_t kSecondCacheLines = 512 * 1024 >> kLineShift, kSecondCacheWays = 8;
inline constexpr std::uint32_t kPredictorEntries = 4096;
inline constexpr std::uint32_t kHistoryBits = 6;  ///< of the latest branches, in the place of a counter; ASSUMED
// ASSUMED besides: instructions are in their cache and addresses are translated, whole lines that are stored are
// fetched first, written-back lines take no time (the channel is four times as wide as a stream), a guessed branch is
// free.

/// What an instruction needs. One unit takes one instruction a cycle.
enum class Unit : std::uint8_t { kFixed, kMemory, kFloat, kBranch, kNone };

enum class Kind : std::uint8_t {
  kFixed,
  kMultiply,
  kWideMultiply,
  kFixedDivide,
  kFloat,
  kVector,  ///< of vectors, without floats
  kDivide,
  kRoot,
  kThroughMemory,  ///< between fixed and float registers
  kConvert,        ///< the same and a conversion
  kWiden,          ///< float to double: nothing, registers hold doubles
  kLoad,
  kStore,
  kBranch,   ///< conditional
  kJump,     ///< to where it always goes, or back to a caller
  kFarJump,  ///< to an address in a register
};

/// Registers are numbers below 96; 0 is no register.
struct Instruction {
  Kind kind = Kind::kFixed;
  std::uint8_t result = 0;
  std::array<std::uint8_t, 3> operands{};
  std::uint64_t address = 0;  ///< of the instruction
};

/// What happened when it was executed.
struct Event {
  std::uint64_t address = 0;  ///< of the bytes that it loaded or stored
  std::uint32_t bytes = 0;
  bool taken = false;
};

/// Tags of a cache with the line used longest ago replaced. A line may still be on its way.
template <std::uint32_t kLines, std::uint32_t kWays>
class Cache {
 public:
  struct Line {
    std::uint64_t number = ~std::uint64_t{0};
    Cycle ready = 0;
    std::uint64_t last_use = 0;
  };

  /// @returns nullptr where the line is missing.
  Line* find(std::uint64_t number) {
    for (Line& line : set_of(number)) {
      if (line.number == number) {
        line.last_use = ++uses_;
        return &line;
      }
    }
    return nullptr;
  }
  void insert(std::uint64_t number, Cycle ready) {
    auto& set = set_of(number);
    Line& oldest = *std::ranges::min_element(set, {}, &Line::last_use);
    oldest = {number, ready, ++uses_};
  }

 private:
  std::array<Line, kWays>& set_of(std::uint64_t number) { return sets_[number % (kLines / kWays)]; }

  std::array<std::array<Line, kWays>, kLines / kWays> sets_{};
  std::uint64_t uses_ = 0;
};

/// What a model has counted.
struct Counts {
  std::uint64_t instructions = 0;
  Cycle cycles = 0;
  std::uint64_t branch_misses = 0;
  std::uint64_t lines_waited = 0;    ///< lines from memory that an access asked for
  std::uint64_t lines_streamed = 0;  ///< lines from memory fetched ahead
};

class CoreModel {
 public:
  /// Takes the next instruction. Its cycles are those since the one before it left.
  void execute(const Instruction& instruction, const Event& event) {
    ++counts_.instructions;
    const Cycle before = now_;
    issue(instruction, event);
    counts_.cycles += now_ - before;
  }
  [[nodiscard]] const Counts& counts() const { return counts_; }
  /// When the last instruction left.
  [[nodiscard]] Cycle now() const { return now_; }

 private:
  static constexpr Unit unit_of(Kind kind) {
    switch (kind) {
      case Kind::kFixed:
      case Kind::kMultiply:
      case Kind::kWideMultiply:
      case Kind::kFixedDivide:
        return Unit::kFixed;
      case Kind::kFloat:
      case Kind::kVector:
      case Kind::kDivide:
      case Kind::kRoot:
        return Unit::kFloat;
      case Kind::kThroughMemory:
      case Kind::kConvert:
      case Kind::kLoad:
      case Kind::kStore:
        return Unit::kMemory;
      case Kind::kBranch:
      case Kind::kJump:
      case Kind::kFarJump:
        return Unit::kBranch;
      case Kind::kWiden:
        break;
    }
    return Unit::kNone;
  }

  void issue(const Instruction& instruction, const Event& event) {
    const Unit unit = unit_of(instruction.kind);
    Cycle ready = 0;
    for (const std::uint8_t operand : instruction.operands) ready = std::max(ready, ready_[operand]);
    if (unit == Unit::kNone) {
      ready_[instruction.result] = ready;
      return;
    }
    wait_until(std::max(ready, unit_free_[static_cast<std::size_t>(unit)]));
    if (issued_ == kIssueWidth || (units_taken_ >> static_cast<unsigned>(unit) & 1u) != 0) wait_until(now_ + 1);
    ++issued_;
    units_taken_ |= 1u << static_cast<unsigned>(unit);
    const Cycle result = result_of(instruction, event, unit);
    if (instruction.result != 0) ready_[instruction.result] = result;
  }

  // Goes on to a later cycle.
  void wait_until(Cycle cycle) {
    if (cycle <= now_) return;
    now_ = cycle;
    issued_ = 0;
    units_taken_ = 0;
  }

  Cycle hold(Unit unit, Cycle cycles) { return unit_free_[static_cast<std::size_t>(unit)] = now_ + cycles; }

  Cycle result_of(const Instruction& instruction, const Event& event, Unit unit) {
    switch (instruction.kind) {
      case Kind::kFixed:
        return now_ + kFixedCycles;
      case Kind::kMultiply:
        return now_ + kMultiplyCycles;
      case Kind::kWideMultiply:
        return now_ + kWideMultiplyCycles;
      case Kind::kFixedDivide:
        return hold(unit, kFixedDivideCycles);
      case Kind::kFloat:
        return now_ + kFloatCycles;
      case Kind::kVector:
        return now_ + kVectorCycles;
      case Kind::kDivide:
        return hold(unit, kDivideCycles);
      case Kind::kRoot:
        return hold(unit, kRootCycles);
      case Kind::kThroughMemory:
        return now_ + kStoreToLoadCycles;
      case Kind::kConvert:
        return now_ + kStoreToLoadCycles + kFloatCycles;
      case Kind::kLoad:
        return load(event);
      case Kind::kStore:
        store(event);
        break;
      case Kind::kBranch:
        branch(instruction.address, event.taken);
        break;
      case Kind::kFarJump:
        miss_branch();
        break;
      case Kind::kJump:
      case Kind::kWiden:
        break;
    }
    return now_ + kFixedCycles;
  }

  Cycle load(const Event& event) {
    Cycle result = now_ + kLoadCycles;
    for (const Stored& stored : recent_stores_) {
      if (stored.address < event.address + event.bytes && event.address < stored.address + stored.bytes) {
        result = std::max(result, stored.cycle + kStoreToLoadCycles);
      }
    }
    const std::uint64_t number = event.address >> kLineShift;
    if (const auto* line = first_.find(number)) return std::max(result, line->ready);
    // Behind the first cache so many loads may be on their way.
    Cycle& slot = *std::ranges::min_element(load_slots_);
    wait_until(slot);
    const Cycle arrival = std::max(result, line_ready(number) + kSecondCacheCycles);
    slot = arrival;
    first_.insert(number, arrival);
    return arrival;
  }

  // Stores leave one after the other; the core waits only where the queue is full.
  void store(const Event& event) {
    Cycle& left = store_left_[next_store_];
    wait_until(left);
    const Cycle last = store_left_[(next_store_ + kStoreQueue - 1) % kStoreQueue];
    left = std::max(last, line_ready(event.address >> kLineShift)) + 1;
    recent_stores_[next_store_] = {event.address, event.bytes, now_};
    next_store_ = (next_store_ + 1) % kStoreQueue;
  }

  // When a line is in the second cache; fetches it from memory.
  Cycle line_ready(std::uint64_t number) {
    follow_stream(number);
    if (const auto* line = second_.find(number)) return std::max(now_, line->ready);
    ++counts_.lines_waited;
    Cycle& slot = *std::ranges::min_element(fetch_slots_);
    slot = std::max(now_, slot) + kMemoryCycles;
    second_.insert(number, slot);
    return slot;
  }

  // Fetches ahead where lines are asked for one after the other, as far as fetches are free.
  void follow_stream(std::uint64_t number) {
    for (Stream& stream : streams_) {
      if (number == stream.last) return;
      if (number != stream.last + 1) continue;
      stream.last = number;
      stream.last_use = ++stream_uses_;
      stream.fetched = std::max(stream.fetched, number);
      while (stream.fetched < number + kStreamAhead) {
        const std::uint64_t next = stream.fetched + 1;
        if (second_.find(next) == nullptr) {
          Cycle& slot = *std::ranges::min_element(fetch_slots_);
          if (slot > now_) return;
          slot = now_ + kMemoryCycles;
          second_.insert(next, slot);
          ++counts_.lines_streamed;
        }
        stream.fetched = next;
      }
      return;
    }
    if (second_.find(number) != nullptr) return;
    Stream& oldest = *std::ranges::min_element(streams_, {}, &Stream::last_use);
    oldest = {number, number, ++stream_uses_};
  }

  void branch(std::uint64_t address, bool taken) {
    std::uint8_t& counter = counters_[(address >> 1 ^ std::uint64_t{history_} << kHistoryBits) % kPredictorEntries];
    if ((counter >= 2) != taken) miss_branch();
    counter = static_cast<std::uint8_t>(taken ? std::min(counter + 1, 3) : std::max(counter - 1, 0));
    history_ = (history_ << 1 | (taken ? 1u : 0u)) & ((1u << kHistoryBits) - 1);
  }

  void miss_branch() {
    ++counts_.branch_misses;
    wait_until(now_ + kBranchMissCycles);
  }

  struct Stored {
    std::uint64_t address = 0;
    std::uint32_t bytes = 0;
    Cycle cycle = 0;
  };
  struct Stream {
    std::uint64_t last = ~std::uint64_t{0} - 1, fetched = 0, last_use = 0;
  };

  Cycle now_ = 0;
  std::uint32_t issued_ = 0, units_taken_ = 0;  // in this cycle
  std::array<Cycle, 96> ready_{};
  std::array<Cycle, 5> unit_free_{};
  std::array<Cycle, kFetches> fetch_slots_{}, load_slots_{};
  std::array<Cycle, kStoreQueue> store_left_{};
  std::array<Stored, kStoreQueue> recent_stores_{};
  std::uint32_t next_store_ = 0;
  std::array<Stream, kStreams> streams_{};
  std::uint64_t stream_uses_ = 0;
  Cache<kFirstCacheLines, kFirstCacheWays> first_;
  Cache<kSecondCacheLines, kSecondCacheWays> second_;
  std::array<std::uint8_t, kPredictorEntries> counters_{};
  std::uint32_t history_ = 0;
  Counts counts_;
};

}  // namespace gridiron::general_core
