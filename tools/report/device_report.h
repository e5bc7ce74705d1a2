// Device report: a device's counts of a frame, as JSON. Keys and units: tools/README.md, "Devices".
// Memory: std::string. Threads: any, no shared state. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/firmware/frame_job.h>
#include <gridiron/sim/trace.h>

#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace gridiron::tool {

/// The contents of a device's report.
struct DeviceReportInput {
  std::uint32_t width = 0, height = 0, tile_width = 0;  ///< pixels
  const sim::EngineWork* engine = &sim::kGridEngine;    ///< of the frame
  std::span<const port::CoreResult> cores;              ///< those that took part
  std::span<const port::TileResult> tiles;              ///< index = tile id
  std::uint64_t image_hash = 0;                         ///< image_hash() of report.h
  std::optional<std::uint64_t> depth_hash, ids_hash;    ///< of planes that the frame has
  std::span<const double> predicted_tiles;              ///< instructions a tile by a machine profile; or empty
  std::optional<sim::WorkTotals> tile_work;             ///< work without the parts that belong to no tile, if known
};

/// @returns the sum of all cores' work, as they counted it.
[[nodiscard]] sim::WorkTotals sum_of_work(std::span<const port::CoreResult> cores);

/// @returns the report as JSON text, two spaces of indentation, keys in the documented order, newline at the end.
[[nodiscard]] std::string device_report_json(const DeviceReportInput& input);

}  // namespace gridiron::tool
