// Software cache: which lines of main memory lie in a core's local store. 4-way set-associative, least recently used.
// Source: Benthin, Wald, Scherbaum, Friedrich 2006, section 4. Memory: inside the local store; the lines' bytes lie
// beside it. Threads: one core. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/rival/cache_counts.h>

#include <cstdint>

namespace gridiron::rival {

inline constexpr std::uint32_t kCacheWays = 4;

/// Directory of a cache. Slot s holds one line; set i is slots [4 i, 4 i + 4); line l belongs to set l % (sets).
///
/// A line that a packet waits for is pinned: it stays until every such packet has gone on. A pending line is pinned.
/// @tparam MaxLines  the most slots, a multiple of kCacheWays.
template <std::uint32_t MaxLines>
class alignas(128) SoftCache {
 public:
  static_assert(MaxLines % kCacheWays == 0);
  static constexpr std::uint32_t kMaxLines = MaxLines;

  enum class Answer : std::uint8_t {
    kHit,      ///< slot holds the line
    kPending,  ///< slot will hold it when its tag has been waited for
    kMiss,     ///< slot was emptied for it; the caller fetches it
    kFull,     ///< all lines of the set are pinned
  };
  struct Found {
    Answer answer;
    std::uint32_t slot;
  };

  /// Forgets everything. @param line_count  slots in use, a multiple of kCacheWays, 4..MaxLines.
  void reset(std::uint32_t line_count) {
    set_count_ = line_count / kCacheWays;
    counts_ = CacheCounts{};
    for (std::uint32_t slot = 0; slot < MaxLines; ++slot) {
      lines_[slot] = kNoLine;
      state_[slot] = {slot % kCacheWays, 0, kNoTag};
    }
  }

  /// Looks for a line and makes it the most recently used of its set. On kMiss the slot is the line's from now on.
  [[nodiscard]] Found find(std::uint32_t line) {
    ++counts_.lookups;
    const std::uint32_t first = line % set_count_ * kCacheWays;
    std::uint32_t victim = kNoSlot;
    for (std::uint32_t slot = first; slot < first + kCacheWays; ++slot) {
      if (lines_[slot] == line) {
        touch(first, slot);
        const bool pending = state_[slot].tag != kNoTag;
        ++(pending ? counts_.pending_hits : counts_.hits);
        return {pending ? Answer::kPending : Answer::kHit, slot};
      }
      if (state_[slot].pins != 0) continue;
      if (victim == kNoSlot || state_[slot].age > state_[victim].age) victim = slot;
    }
    if (victim == kNoSlot) {
      ++counts_.refusals;
      return {Answer::kFull, kNoSlot};
    }
    ++counts_.misses;
    lines_[victim] = line;
    touch(first, victim);
    return {Answer::kMiss, victim};
  }

  /// The slot's line is on its way under `tag`.
  void begin_fill(std::uint32_t slot, std::uint32_t tag) { state_[slot].tag = tag; }
  void end_fill(std::uint32_t slot) { state_[slot].tag = kNoTag; }
  [[nodiscard]] bool is_pending(std::uint32_t slot) const { return state_[slot].tag != kNoTag; }
  [[nodiscard]] std::uint32_t tag_of(std::uint32_t slot) const { return state_[slot].tag; }

  void pin(std::uint32_t slot) { ++state_[slot].pins; }
  void unpin(std::uint32_t slot) { --state_[slot].pins; }

  [[nodiscard]] const CacheCounts& counts() const { return counts_; }

 private:
  static constexpr std::uint32_t kNoLine = 0xFFFFFFFFu;
  static constexpr std::uint32_t kNoSlot = 0xFFFFFFFFu;
  static constexpr std::uint32_t kNoTag = 0xFF;

  struct SlotState {
    std::uint32_t age;   ///< place of the slot in its set, 0 = most recently used
    std::uint32_t pins;  ///< packets that wait for the line
    std::uint32_t tag;   ///< that the line is on its way under
  };

  void touch(std::uint32_t first, std::uint32_t slot) {
    for (std::uint32_t other = first; other < first + kCacheWays; ++other) {
      if (state_[other].age < state_[slot].age) ++state_[other].age;
    }
    state_[slot].age = 0;
  }

  std::uint32_t lines_[MaxLines];
  SlotState state_[MaxLines];
  std::uint32_t set_count_ = 1;
  CacheCounts counts_;
};

}  // namespace gridiron::rival
