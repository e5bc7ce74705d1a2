// Software cache: which lines of main memory lie in a core's local store. 4-way set-associative, least recently used.
// Source: Benthin, Wald, Scherbaum, Friedrich 2006, section 4. Memory: inside the local store; the lines' bytes lie
// beside it. Threads: one core. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/lanes.h>
#include <gridiron/bvh/cache_counts.h>
#include <gridiron/bvh/four_words.h>

#include <cstdint>

namespace gridiron::bvh {

inline constexpr std::uint32_t kCacheWays = 4;  ///< also the most lines that may be on their way at once
inline constexpr std::uint32_t kNoSlot = 0xFFFFFFFFu;

/// Directory of a cache. Slot s holds one line; set i is slots [4 i, 4 i + 4); line l belongs to set l % (sets).
///
/// A line on its way is never replaced. With at most kCacheWays fetches at once there is always a line to replace. A
/// line that has arrived may be replaced before the packet that fetched it continues; the packet then fetches it again.
/// @tparam MaxLines  the most slots, a power of two, at least kCacheWays.
template <std::uint32_t MaxLines>
class alignas(128) SoftCache {
 public:
  static_assert(MaxLines >= kCacheWays && (MaxLines & (MaxLines - 1)) == 0);

  /// Empties the cache. @param line_count  slots in use, a power of two, kCacheWays..MaxLines.
  void reset(std::uint32_t line_count) {
    set_mask_ = line_count / kCacheWays - 1u;
    counts_ = CacheCounts{};
    for (std::uint32_t slot = 0; slot < MaxLines; ++slot) {
      lines_[slot] = kNoLine;
      last_use_[slot] = 0;
    }
  }

  /// @param line  below 2^27. @param now  grows from call to call, below 2^31. @returns its slot, kNoSlot if it is not
  ///              cached.
  [[nodiscard]] GRIDIRON_INLINE std::uint32_t find(std::uint32_t line, std::uint32_t now) {
    ++counts_.lookups;
    const std::uint32_t first = (line & set_mask_) * kCacheWays;
    const auto found = FourWords::load(lines_ + first).equal(FourWords::splat(line));
    const std::uint32_t ways = found.bits();
    if (ways == 0) return kNoSlot;
    ++counts_.hits;
    FourWords::select(found, FourWords::splat(now), FourWords::load(last_use_ + first)).store(last_use_ + first);
    return first + lowest_bit(ways);
  }

  /// The slot of a line that find() did not return.
  struct Claim {
    std::uint32_t slot;
    bool is_on_its_way;  ///< another packet fetches it; else the caller does
  };
  /// @param filler  number of the fetching packet, below kCacheWays.
  [[nodiscard]] Claim claim(std::uint32_t line, std::uint32_t now, std::uint32_t filler) {
    const std::uint32_t first = (line & set_mask_) * kCacheWays;
    const FourWords lines = FourWords::load(lines_ + first);
    const std::uint32_t pending =
        (lines & FourWords::splat(kOnItsWay | kLineBits)).equal(FourWords::splat(kOnItsWay | line)).bits();
    if (pending != 0) {
      ++counts_.pending_hits;
      return {first + lowest_bit(pending), true};
    }
    ++counts_.misses;
    const FourWords last_use = FourWords::load(last_use_ + first);
    const auto stays = lines.less(FourWords::splat(0u));
    const FourWords ages = FourWords::select(stays, FourWords::splat(kNever), last_use);
    const std::uint32_t way = lowest_bit(ages.equal(least_of(ages)).bits());
    lines_[first + way] = kOnItsWay | filler << kFillerShift | line;
    last_use_[first + way] = now;
    return {first + way, false};
  }

  /// State of a line that a packet was suspended for.
  enum class Arrival : std::uint8_t { kOnItsWay, kThere, kReplaced };
  [[nodiscard]] Arrival arrival(std::uint32_t slot, std::uint32_t line) const {
    const std::uint32_t word = lines_[slot];
    if (word == line) return Arrival::kThere;
    return (word & (kOnItsWay | kLineBits)) == (kOnItsWay | line) ? Arrival::kOnItsWay : Arrival::kReplaced;
  }
  /// The filler of a slot whose line is on its way.
  [[nodiscard]] std::uint32_t filler_of(std::uint32_t slot) const { return lines_[slot] >> kFillerShift & 3u; }
  /// Marks the line as arrived.
  void end_fill(std::uint32_t slot) { lines_[slot] = lines_[slot] & kLineBits; }

  [[nodiscard]] const CacheCounts& counts() const { return counts_; }

 private:
  // A directory word: the line; while it is on its way, also the top bit and its filler.
  static constexpr std::uint32_t kLineBits = 0x0FFFFFFFu;
  static constexpr std::uint32_t kFillerShift = 28;
  static constexpr std::uint32_t kOnItsWay = 0x80000000u;
  static constexpr std::uint32_t kNoLine = 0x0FFFFFFFu;
  static constexpr std::uint32_t kNever = 0x7FFFFFFFu;

  // The least of four words, in all of them.
  [[nodiscard]] static GRIDIRON_INLINE FourWords least_of(FourWords words) {
    using Four = Lanes<4>;
    const FourWords pairs = FourWords::of(Four::shuffle_quads<2, 3, 0, 1>(words.floats()));
    const FourWords low = FourWords::select(words.less(pairs), words, pairs);
    const FourWords other = FourWords::of(Four::shuffle_quads<1, 0, 3, 2>(low.floats()));
    return FourWords::select(low.less(other), low, other);
  }

  alignas(16) std::uint32_t lines_[MaxLines];
  alignas(16) std::uint32_t last_use_[MaxLines];
  std::uint32_t set_mask_ = 0;
  CacheCounts counts_;
};

}  // namespace gridiron::bvh
