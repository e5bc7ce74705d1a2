// Timeline: a frame as a Chrome trace, one row per core, for a browser's trace viewer.
// Memory: std::string. Threads: any, no shared state. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/sim/machine_profile.h>
#include <gridiron/sim/pass_timing.h>
#include <gridiron/sim/replay.h>

#include <cstddef>
#include <span>
#include <string>

namespace gridiron::tool {

inline constexpr int kTimelineVersion = 1;
inline constexpr std::size_t kMaxTimelineBytes = 50'000'000;  ///< beyond it trace viewers become unusable

/// Writes the spans of a frame as complete events ("ph": "X"), times in microseconds of the machine's clock.
///
/// Spans are named init, compute, "wait tile|macrocell|triangle|setup"; each tile's spans lie inside one named "tile".
/// Only if the text would exceed max_bytes, neighbouring spans of one tile that are each shorter than a threshold
/// become one span named "mixed", with its parts in its arguments. The threshold is the first of 64, 256, 1024, ...
/// cycles that suffices, and is stored in otherData.merged_below_cycles (0: nothing was merged). If no threshold
/// suffices, the text is as short as possible.
///
/// @param timing  of a replay with ReplayOptions::timeline.
/// @returns       JSON text. Format: the Trace Event Format's JSON object form.
[[nodiscard]] std::string timeline_json(const sim::FrameTiming& timing, const sim::MachineProfile& machine,
                                        std::size_t max_bytes = kMaxTimelineBytes);

/// The same of a list of passes, each behind the one before it. What a core has in its hands is named "item"; in a pass
/// that an engine of core renders, "tile". A row "passes" has each pass under its name, and in it "start" and
/// "barrier".
///
/// @param passes  with timelines; one without cores is what the general core does between two.
[[nodiscard]] std::string passes_timeline_json(std::span<const sim::PassTiming> passes,
                                               const sim::MachineProfile& machine,
                                               std::size_t max_bytes = kMaxTimelineBytes);

}  // namespace gridiron::tool
