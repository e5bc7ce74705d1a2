// Job comparison: renders a job on the simulated chip and compares a device's result with it.
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

/// One compared item.
struct ComparedItem {
  std::string name;  ///< "image", "depth", "ids", "work", "work.wait", "transfers", ...
  bool equal = false;
  std::string detail;  ///< the amount that was compared, or the first difference, for messages
};

struct JobComparison {
  std::vector<ComparedItem> items;
  std::vector<double> predicted_tiles;  ///< busy_cycles of each tile on the requested machine; else empty
  sim::WorkTotals tile_work{};          ///< the device's counts, without the work of its cores outside of tiles

  [[nodiscard]] bool is_equal() const;
};

/// Renders the job's frame in checked mode, with its addresses moved into simulated memory, and compares planes pixel
/// by pixel (only inside the picture), work by kind, and transfers and bytes, of the frame and of each tile, if the
/// device counted them.
///
/// @param job  its bytes move into simulated memory, so that they exist once; it has no file afterwards.
/// @param path  of the job, for messages.
/// @param machine  for predicted_tiles; may be null. @param threads  host threads, above 0.
/// @param progress  of tiles; may be empty.
/// Errors: Failure if the simulator cannot render the job, kUsage if no kernel is built for its layout.
[[nodiscard]] JobComparison compare_with_simulator(
    OpenJob& job, const std::filesystem::path& path, const OpenResult& result, const sim::MachineProfile* machine,
    std::uint32_t threads, std::function<void(std::uint32_t done, std::uint32_t total)> progress);

}  // namespace gridiron::tool
