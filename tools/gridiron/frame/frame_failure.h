// Frame failure: what went wrong on the simulated chip, in words.
// Memory: strings. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/sim/sim_chip.h>

#include <filesystem>
#include <optional>

#include "base/failure.h"

namespace gridiron::tool {

/// @returns nothing for a frame that went well; else how the command ends: every violation on a line of its own (at
/// most 20) and what the renderer said. kCheckFailed, or kUsage where the build cannot render what the options ask for,
/// or kBadInput where it cannot use the scene image or the host has not enough memory or threads.
/// @param input  what was rendered, for people; empty: nothing that has a name.
[[nodiscard]] std::optional<Failure> frame_failure(const sim::ChipResult& result,
                                                   const std::filesystem::path& input = {});

}  // namespace gridiron::tool
