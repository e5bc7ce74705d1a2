// The board has no DMA engine; machine mode takes its place. A worker runs in user mode, where PMP opens its arena, the
// code and the shared memory, and calls machine mode for each copy to or from the job's memory.
// Memory: arenas and the job's memory. Threads: each hart serves its own worker. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace gridiron::port {

/// Services of machine mode for a worker.
enum class Call : std::uint64_t {
  kCopy = 1,      ///< target, source, bytes: 1 when it was made, 0 when it was refused
  kFinished = 2,  ///< its share is done: returns when the master wakes the worker again
};

extern "C" {

/// Hart 0, in firmware.cpp or contract.cpp.
[[noreturn]] void gridiron_master();
/// Worker `core_index` once the master has woken it, in user mode; in the same file. Works, finishes, and begins anew.
[[noreturn]] void gridiron_worker(std::uint64_t core_index);

/// A worker's call, in user mode.
std::uint64_t gridiron_call(std::uint64_t target, std::uint64_t source, std::uint64_t bytes, Call call);

/// Enters user mode, and calls the worker's function (gridiron_worker) on that stack.
[[noreturn]] void gridiron_enter_worker(std::uint64_t core_index, std::uintptr_t stack_top);
}

/// Ends a worker's share: notifies the master, and sleeps until that wakes the worker again.
inline void finish() {
  gridiron_call(0, 0, 0, Call::kFinished);
}

}  // namespace gridiron::port
