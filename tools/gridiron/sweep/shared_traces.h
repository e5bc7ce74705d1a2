// Shared traces: the traces of a frame, which lie once in the memory of each node.
// Memory: all packed traces; where a rank is alone on its node its own. Threads: reading by any.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/sim/replay.h>
#include <gridiron/sim/sim_memory.h>
#include <gridiron/sim/trace.h>

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace gridiron::tool {

class SharedTraces {
 public:
  /// All ranks call it. @param trace  of rank 0, whose tiles are taken; of other ranks nothing.
  /// Errors: those of Ranks; std::bad_alloc.
  explicit SharedTraces(sim::FrameTrace& trace);

  /// @returns what sim::replay() does of the trace.
  [[nodiscard]] sim::FrameTiming replay(const sim::MachineProfile& machine) const;

 private:
  sim::FrameTrace head_;             // all but the tiles
  std::vector<std::uint64_t> ends_;  // of the tiles' bytes in region_
  std::optional<sim::SimMemory> memory_;
  sim::MemoryRegion region_{};
};

}  // namespace gridiron::tool
