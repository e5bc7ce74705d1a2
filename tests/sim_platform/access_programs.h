// Programs of a core that are compiled with instrumentation, as the kernel is: one right, the others wrong.
// Memory: the core's data. Threads: one core. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/sim/sim_core.h>

#include <cstddef>
#include <cstdint>

namespace gridiron::sim::access {

enum class Which : std::uint8_t {
  kRight,
  kLoadBeforeWait,
  kStoreToDestinationBeforeWait,  ///< of the value that arrives, so that no later comparison can detect it
  kStoreToSourceBeforeWait,       ///< of the value that is there
  kLoadBehindData,
  kLoadAcrossTheEnd,
  kStoreBeforeData,
  kLoadFromHeap,
  kStoreToGlobal,
  kLoadFromGlobal,
  kLoadFromMainMemory,
  kBlockCopyBehindData,
};

/// What a program needs to know. Has to lie in the core's data, since reading it is checked like any load.
struct Env {
  MainAddress input, output;
  std::uint32_t data_bytes = 0;
  std::uint32_t copy_bytes = 128;
  const std::uint32_t* heap = nullptr;
  std::uint32_t same_as_input = 0;  ///< first word of the input
  const std::byte* host_of_input = nullptr;
};

/// Runs one program. `data` has env.data_bytes up to the end of the core's data.
Status run(Which which, Env& env, SimCore& core, std::byte* data);

}  // namespace gridiron::sim::access
