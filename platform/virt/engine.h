// The board has no DMA engine. What stands in its place is machine mode: a worker runs in user mode, where PMP gives it
// its arena, the code and what the cores share, and asks by a call for each copy to or from the job's memory.
// Memory: arenas and the job's memory. Threads: each hart serves its own worker. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace gridiron::port {

/// What a worker may ask machine mode for.
enum class Call : std::uint64_t {
  kCopy = 1,      ///< target, source, bytes: 1 when it was made, 0 when it was refused
  kFinished = 2,  ///< the frame is done; does not come back
};

extern "C" {

/// What hart 0 does, in firmware.cpp or contract.cpp.
[[noreturn]] void gridiron_master();
/// What worker `core_index` does once the master has woken it, in user mode; there too.
[[noreturn]] void gridiron_worker(std::uint64_t core_index);

/// A worker's call, in user mode.
std::uint64_t gridiron_call(std::uint64_t target, std::uint64_t source, std::uint64_t bytes, Call call);

/// User mode, with the worker's function (gridiron_worker) on that stack.
[[noreturn]] void gridiron_enter_worker(std::uint64_t core_index, std::uintptr_t stack_top);
}

/// The end of a worker's frame: tells the master, and does not come back.
[[noreturn]] inline void finish() {
  gridiron_call(0, 0, 0, Call::kFinished);
  __builtin_trap();
}

}  // namespace gridiron::port
