// Interrupt: SIGINT, SIGTERM and SIGHUP as a flag that the renderer looks at between two tiles.
// Memory: flags in static storage. Threads: the flag may be read by any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>

namespace gridiron::tool {

/// Lets SIGINT, SIGTERM and SIGHUP set the flag from now on, but for those that the parent has ignored, and lets a
/// closed pipe (SIGPIPE) and a file that outgrows its limit (SIGXFSZ) be errors of the write instead of the end. Calls
/// that block end with EINTR when a signal comes; whoever repeats one calls stop_if_interrupted() first.
void watch_for_interrupt();

/// @returns the flag: true once a signal has come.
[[nodiscard]] const std::atomic<bool>& interrupt_flag();

/// Throws Failure (kInterrupted, kTerminated, kHungUp) once a signal has come. main adds what became of the files.
void stop_if_interrupted();

}  // namespace gridiron::tool
