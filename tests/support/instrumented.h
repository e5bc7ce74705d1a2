// Frames of tests, rendered by the instrumented kernel too where the environment asks for it: every load and store is
// then checked against the arena and the transfers in flight. tools/check --full asks.
// Memory: that of the frame. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/sim/sim_chip.h>
#include <gridiron/sim/sim_memory.h>

#include <cstdint>

namespace gridiron::test {

/// Whether GRIDIRON_TEST_INSTRUMENTED is set, and not empty.
[[nodiscard]] bool is_instrumented();

/// Frames that were rendered twice, so far.
[[nodiscard]] std::uint64_t instrumented_frames();
/// Counts one.
void note_instrumented_frame();

/// As sim::render_frame; where is_instrumented(), the instrumented kernel renders the same frame before, with 4 lanes
/// and else the same options. The running test fails where that ends in another status, breaks a rule or does other
/// work. Not rendered twice: layouts that are not built with instrumentation, frames that are told of or aborted while
/// they go on.
[[nodiscard]] sim::ChipResult render_in_test(sim::SimMemory& memory, MainAddress frame,
                                             const sim::ChipOptions& options);

}  // namespace gridiron::test
