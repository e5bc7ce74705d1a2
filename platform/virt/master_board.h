// The MasterBoard (master.h): wakes workers, and sleeps until one of them wakes the master or a while has passed.
// Memory: registers. Threads: hart 0. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "hart.h"
#include "master.h"

namespace gridiron::port {

class VirtMaster {
 public:
  void start_core(std::uint32_t core_index) { wake(1 + core_index); }
  void take_part() {}
  void pause() { sleep_until(ticks() + 5 * kTicksPerMillisecond); }
  [[nodiscard]] std::uint64_t milliseconds() { return ticks() / kTicksPerMillisecond; }
  // Workers copied by their own stores, before they told that they have finished.
  void take_results() {}
};

static_assert(MasterBoard<VirtMaster>);

}  // namespace gridiron::port
