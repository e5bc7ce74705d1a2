// What tiles read and wrote in memory that cores may write: noted by SimCore, then compared across tiles.
// Memory: std::vector. Threads: one per core; the check runs alone. SPDX-License-Identifier: Apache-2.0
#include <gridiron/sim/byte_ranges.h>
#include <gridiron/sim/sim_core.h>

#include <algorithm>
#include <tuple>
#include <utility>

namespace gridiron::sim {

namespace {

void add_range(std::vector<MainRange>& ranges, std::uint64_t begin, std::uint64_t end) {
  if (!ranges.empty() && ranges.back().end == begin) {
    ranges.back().end = end;
  } else {
    ranges.push_back({begin, end});
  }
}

}  // namespace

bool SimCore::meets_writable(std::uint64_t address, std::uint32_t bytes) const {
  return std::any_of(frame_->writable.begin(), frame_->writable.end(), [&](const MainRange& range) {
    return overlap(range.begin, range.end - range.begin, address, bytes);
  });
}

void SimCore::note_footprint(std::uint64_t address, std::uint32_t bytes, bool is_get) {
  if (!meets_writable(address, bytes)) return;
  if (footprints.empty() || footprints.back().tile_id != tile_id_) footprints.push_back({tile_id_, core_, {}, {}});
  TileFootprint& footprint = footprints.back();
  add_range(is_get ? footprint.gets : footprint.puts, address, address + bytes);
}

std::vector<Violation> check_across_tiles(std::span<const TileFootprint> footprints) {
  struct Interval {
    std::uint64_t begin, end;
    std::uint64_t owner;  // tile, or the core for what lies outside any tile
    bool is_put;
    const TileFootprint* footprint;
  };
  std::vector<Interval> intervals;
  for (const TileFootprint& footprint : footprints) {
    const std::uint64_t owner =
        footprint.tile_id == kNoTile ? (std::uint64_t{1} << 32) + footprint.core : footprint.tile_id;
    for (const MainRange& range : footprint.gets)
      intervals.push_back({range.begin, range.end, owner, false, &footprint});
    for (const MainRange& range : footprint.puts)
      intervals.push_back({range.begin, range.end, owner, true, &footprint});
  }
  const auto key = [](const Interval& i) { return std::tuple(i.begin, i.end, i.owner, i.is_put); };
  std::sort(intervals.begin(), intervals.end(), [&](const Interval& a, const Interval& b) { return key(a) < key(b); });

  // Sweep over rising begins. Of the intervals seen, only the one that reaches furthest can matter, and, where that
  // belongs to the same owner, the one that reaches furthest among all other owners.
  struct Reach {
    const Interval* first = nullptr;
    const Interval* other = nullptr;

    void add(const Interval& interval) {
      if (first == nullptr || interval.owner == first->owner) {
        if (first == nullptr || interval.end > first->end) first = &interval;
      } else if (interval.end > first->end) {
        other = std::exchange(first, &interval);
      } else if (other == nullptr || interval.end > other->end) {
        other = &interval;
      }
    }
    [[nodiscard]] const Interval* hit(const Interval& interval) const {
      const Interval* candidate = first != nullptr && first->owner == interval.owner ? other : first;
      return candidate != nullptr && candidate->end > interval.begin ? candidate : nullptr;
    }
  };
  std::vector<Violation> violations;
  Reach puts, gets;
  for (const Interval& interval : intervals) {
    const Interval* clash = puts.hit(interval);
    if (clash == nullptr && interval.is_put) clash = gets.hit(interval);
    if (clash != nullptr && violations.size() < kMaxViolations) {
      const auto name = [](const Interval& i) {
        const std::string who = i.footprint->tile_id == kNoTile ? "core " + std::to_string(i.footprint->core)
                                                                : "tile " + std::to_string(i.footprint->tile_id);
        return who + (i.is_put ? " puts" : " gets") + " main " + hex(i.begin) + ".." + hex(i.end);
      };
      // Which core rendered a tile is chance, so it is not told.
      const bool in_tile = interval.footprint->tile_id != kNoTile;
      violations.push_back({Status::kTransferOverlap, in_tile ? 0 : interval.footprint->core,
                            interval.footprint->tile_id, name(interval) + ", " + name(*clash)});
    }
    (interval.is_put ? puts : gets).add(interval);
  }
  return violations;
}

}  // namespace gridiron::sim
