// The MasterBoard (master.h): wakes workers, and sleeps until one of them wakes the master or some time has passed.
// Memory: registers. Threads: hart 0. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "clint.h"
#include "master.h"

namespace gridiron::port {

class VirtMaster {
 public:
  void start_core(std::uint32_t core_index) { wake_hart(1 + core_index); }
  void take_part() {}
  void pause() {
    set_alarm(0, clock_ticks() + 20 * kTicksPerMillisecond);
    sleep_hart(true);
    hush_hart(0);
  }
  [[nodiscard]] std::uint64_t milliseconds() { return clock_ticks() / kTicksPerMillisecond; }
  // Workers copied by their own stores, before they reported that they have finished.
  void take_results() {}

 private:
  static constexpr std::uint64_t kTicksPerMillisecond = 10'000;
};

static_assert(MasterBoard<VirtMaster>);

}  // namespace gridiron::port
