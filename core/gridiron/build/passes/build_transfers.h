// A core's transfers in the passes of a build, which count work. Memory: borrowed. Threads: one core.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/lanes.h>
#include <gridiron/base/work_counters.h>
#include <gridiron/build/passes/build_work.h>
#include <gridiron/dma/transfers.h>
#include <gridiron/platform/contract.h>

#include <cstdint>

namespace gridiron {

/// A core's transfers, and the work between them.
template <Platform P>
class BuildTransfers : public Transfers<P> {
 public:
  BuildTransfers(P& platform, WorkCounters& work) : Transfers<P>(platform, work), counters_(work) {}

  /// Counts so many more of a kind of work.
  GRIDIRON_INLINE void add_work(WorkId kind, std::uint32_t amount = 1) { counters_.add(kind, amount); }
  /// The operations that follow belong to a kind.
  GRIDIRON_INLINE void charge_to(WorkId kind) const { counters_.charge_to(kind); }

 private:
  WorkCounters& counters_;
};

}  // namespace gridiron
