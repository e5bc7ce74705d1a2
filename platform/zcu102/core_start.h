// Starts the application cores beyond the first.
// Memory: registers. Threads: core 0, as master. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace gridiron::port {

/// Lets a core run from _start (start.S): through the firmware that owns EL3, or without one by its reset.
///
/// @param core   [1, kCoreCount), not started before.
/// @returns      false if that firmware refuses.
[[nodiscard]] bool start_core(std::uint32_t core);

}  // namespace gridiron::port
