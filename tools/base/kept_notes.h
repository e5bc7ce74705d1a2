// Kept notes: what a rank that prints nothing says on standard error, for rank 0 to print.
// Memory: a file in memory. Threads: one. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace gridiron::tool {

/// From here on words for standard error are kept. @returns a descriptor of what standard error was.
int keep_notes();

/// @returns what was said since the last call, or since keep_notes(), without which there is nothing.
[[nodiscard]] std::string take_notes();

}  // namespace gridiron::tool
