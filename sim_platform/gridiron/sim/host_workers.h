// Host workers: runs code on several host threads, all of which have ended when the call returns.
// Memory: an error a worker. Threads: starts its own and joins them. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <exception>
#include <functional>
#include <thread>

namespace gridiron::sim {

/// How workers ended.
struct WorkersEnd {
  std::uint32_t started = 0;      ///< workers 0 to started - 1 ran, the others did not; 0: none did any work
  std::exception_ptr error = {};  ///< of the lowest worker that threw; null if none did
};

/// Starts a thread. Errors: throws if the host has no more threads or memory.
using StartThread = std::function<std::thread(std::function<void()> run)>;

/// Runs work(0) on the calling thread, and work(1) to work(count - 1) each on a thread of its own. No work begins
/// before all threads have been started. A thread that the host cannot start is left out, and so are those after it.
///
/// @param least  workers that must run: if fewer can be started, no work is done at all.
/// @param stop   called by each worker that ends with an exception, so that the others end soon; must not throw.
/// @param start  for tests; empty: std::thread.
/// Errors: std::bad_alloc, before any thread is started. Exceptions of workers are in the result.
[[nodiscard]] WorkersEnd run_workers(std::uint32_t count, std::uint32_t least,
                                     const std::function<void(std::uint32_t worker)>& work,
                                     const std::function<void()>& stop, const StartThread& start = {});

}  // namespace gridiron::sim
