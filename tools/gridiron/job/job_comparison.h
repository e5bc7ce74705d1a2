// Job comparison: a job rendered on the simulated chip, and a device's answer held against it.
// Memory: a simulated main memory for the time of the frame. Threads: starts the chip's.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/sim/machine_profile.h>
#include <gridiron/sim/trace.h>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "job_file.h"
#include "result_file.h"

namespace gridiron::tool {

/// One thing that was compared.
struct ComparedItem {
  std::string name;  ///< "image", "depth", "ids", "work", "work.wait", "transfers", ...
  bool equal = false;
  std::string detail;  ///< how much was compared, or what differs first, for people
};

struct JobComparison {
  std::vector<ComparedItem> items;
  std::vector<double> predicted_tiles;  ///< busy_cycles of each tile on the machine asked for; else empty
  sim::WorkTotals tile_work{};          ///< what the device counted, less what its cores did outside of tiles

  [[nodiscard]] bool is_equal() const;
};

/// Renders the job's frame in checked mode, its addresses moved into simulated memory, and compares planes pixel by
/// pixel (of the picture: what edge tiles hold beside it is anything), work by kind, and transfers and bytes, of the
/// frame and of each tile, where the device counted them.
///
/// @param job  its bytes move into simulated memory, so that they are held once: it has no file afterwards.
/// @param path  of the job, for messages.
/// @param machine  for predicted_tiles; may be null. @param threads  host threads, above 0.
/// @param progress  of tiles; may be empty.
/// Errors: Failure where the simulator cannot render the job, kUsage where no kernel is built for its layout.
[[nodiscard]] JobComparison compare_with_simulator(
    OpenJob& job, const std::filesystem::path& path, const OpenResult& result, const sim::MachineProfile* machine,
    std::uint32_t threads, std::function<void(std::uint32_t done, std::uint32_t total)> progress);

}  // namespace gridiron::tool
