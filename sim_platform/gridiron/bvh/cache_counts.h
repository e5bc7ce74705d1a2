// Look-ups of a software cache and their outcomes, for reports; they cost a core no time.
// Memory: values. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace gridiron::bvh {

/// Look-ups of one cache and their outcomes.
struct CacheCounts {
  std::uint64_t lookups = 0;
  std::uint64_t hits = 0;          ///< the line was there
  std::uint64_t pending_hits = 0;  ///< the line was on its way for another packet
  std::uint64_t misses = 0;        ///< the line was fetched

  CacheCounts& operator+=(const CacheCounts& other) {
    lookups += other.lookups;
    hits += other.hits;
    pending_hits += other.pending_hits;
    misses += other.misses;
    return *this;
  }
  /// Share of look-ups that started no fetch. 1 if there were none.
  [[nodiscard]] double hit_rate() const {
    const std::uint64_t answered = hits + pending_hits + misses;
    return answered == 0 ? 1.0 : 1.0 - static_cast<double>(misses) / static_cast<double>(answered);
  }
};

}  // namespace gridiron::bvh
