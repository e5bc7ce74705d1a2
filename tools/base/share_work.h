// Shared work: pieces of work done by host threads.
// Memory: one error a piece. Threads: starts its own. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>

namespace gridiron::tool {

/// Calls work(0) to work(count - 1), each once, the lowest first, on `threads` threads including the caller's, or on as
/// many as there are pieces or as the host can start. After an exception no further piece begins; that of the lowest
/// piece is thrown once all threads have ended.
void share_work(std::uint32_t threads, std::size_t count, const std::function<void(std::size_t)>& work);

}  // namespace gridiron::tool
