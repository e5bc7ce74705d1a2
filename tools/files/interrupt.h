// Interrupt: SIGINT, SIGTERM and SIGHUP as a flag that the renderer checks between two tiles.
// Memory: flags in static storage. Threads: the flag may be read by any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>

namespace gridiron::tool {

/// From now on SIGINT, SIGTERM and SIGHUP set the flag, unless the parent has ignored them, and a closed pipe (SIGPIPE)
/// and a file that exceeds its limit (SIGXFSZ) are errors of the write instead of ending the program. A signal ends
/// blocked calls with EINTR; call stop_if_interrupted() before repeating one.
void watch_for_interrupt();

/// @returns the flag: true once a signal has come.
[[nodiscard]] const std::atomic<bool>& interrupt_flag();

/// Throws Failure (kInterrupted, kTerminated, kHungUp) once a signal has come. main adds the state of the files.
void stop_if_interrupted();

}  // namespace gridiron::tool
