// Trees built by the passes on the simulated chip: how long it takes, and what binds.
// Memory: owned while it runs. Threads: starts its own. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/math.h>

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

namespace gridiron::calibrate {

/// @returns, as tables, how long the passes of build_passes.h take on `cell-ps3` for the scans of the experiment, files
/// as they are: for 1, 6 and 16 cores, of 6 cores pass by pass, and for 6 cores of 64 KB.
///
/// @param scenes  folder of the scans. Errors: Failure where a scene cannot be read, std::runtime_error where a tree
/// cannot be built or is not that of build_tree().
[[nodiscard]] std::string build_times_text(const std::filesystem::path& scenes);

}  // namespace gridiron::calibrate
