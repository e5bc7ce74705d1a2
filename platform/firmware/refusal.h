// Prints why a job is refused.
// Memory: none. Threads: the master. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "console.h"

namespace gridiron::port {

/// Prints the reason, as pieces of print().
/// @returns false
template <class... Pieces>
bool refuse(const Pieces&... reason) {
  print("job refused: ", reason..., "\n");
  return false;
}

}  // namespace gridiron::port
