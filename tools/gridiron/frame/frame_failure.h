// Frame failure: describes the failure of a frame on the simulated chip.
// Memory: strings. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/sim/sim_chip.h>

#include <filesystem>
#include <optional>

#include "base/failure.h"

namespace gridiron::tool {

/// @returns nothing for a successful frame; else the end of the command: every violation on a line of its own (at most
/// 20) and the renderer's status. kCheckFailed, or kUsage if the build cannot render with these options, or kBadInput
/// if it cannot use the scene image or the host has too little memory or threads.
/// @param input  the rendered file, for messages; empty: it has no name.
[[nodiscard]] std::optional<Failure> frame_failure(const sim::ChipResult& result,
                                                   const std::filesystem::path& input = {});

}  // namespace gridiron::tool
