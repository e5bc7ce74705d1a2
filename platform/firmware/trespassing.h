// Shared by the boards' images in which core 1 makes forbidden accesses, which must be detected. The option trespass=N
// selects the access; each board has its own numbers.
// Memory: what is trespassed on. Threads: the master asks, core 1 acts. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "master.h"
#include "refusal.h"
#include "semihost.h"

namespace gridiron::port {

/// The selected trespass. A missing or unknown number ends the run with kJobRefused.
/// @param count  trespasses of the board, which are numbered from 1.
[[nodiscard]] inline std::uint64_t wanted_trespass(std::uint64_t count) {
  const std::uint64_t number = number_option("trespass=", 0);
  if (number == 0 || number > count) {
    refuse("trespass=", number, ", this board has 1 to ", count);
    exit_run(static_cast<std::uint32_t>(RunExit::kJobRefused));
  }
  return number;
}

inline void load_from(std::uint64_t address) {
  (void)*reinterpret_cast<const volatile std::uint32_t*>(static_cast<std::uintptr_t>(address));
}
inline void store_to(std::uint64_t address) {
  *reinterpret_cast<volatile std::uint32_t*>(static_cast<std::uintptr_t>(address)) = 0;
}
inline void execute(std::uint64_t address) { reinterpret_cast<void (*)()>(static_cast<std::uintptr_t>(address))(); }

}  // namespace gridiron::port
