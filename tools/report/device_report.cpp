// Device report: see device_report.h.
// Memory: std::string. Threads: any, no shared state. SPDX-License-Identifier: Apache-2.0
#include "report/device_report.h"

#include <nlohmann/json.hpp>
#include <utility>

#include "report/report.h"

namespace gridiron::tool {
namespace {

using Json = nlohmann::ordered_json;

template <class Counts>
Json work_json(const Counts& counts, const sim::EngineWork& engine) {
  Json json = Json::object();
  for (std::uint32_t kind = 0; kind < engine.kind_count(); ++kind) {
    json[std::string(sim::work_kind(WorkId(kind), engine).name)] = counts[kind];
  }
  return json;
}

}  // namespace

sim::WorkTotals sum_of_work(std::span<const port::CoreResult> cores) {
  sim::WorkTotals sum{};
  for (const port::CoreResult& core : cores) {
    for (std::uint32_t kind = 0; kind < kWorkKindCount; ++kind) sum[kind] += core.work[kind];
  }
  return sum;
}

std::string device_report_json(const DeviceReportInput& input) {
  Json cores = Json::array();
  std::uint64_t instructions = 0;
  for (const port::CoreResult& core : input.cores) {
    instructions += core.instructions;
    cores.push_back(Json{{"tiles", core.tiles},
                         {"instructions", core.instructions},
                         {"stack_bytes", core.stack_bytes},
                         {"dma", {{"transfers", core.transfers}, {"bytes", core.transfer_bytes}}},
                         {"work", work_json(core.work, *input.engine)}});
  }
  Json tiles = Json::array();
  for (std::size_t i = 0; i < input.tiles.size(); ++i) {
    const port::TileResult& tile = input.tiles[i];
    tiles.push_back(Json{{"core", tile.core}, {"instructions", tile.instructions}, {"transfers", tile.transfers}});
    if (!input.predicted_tiles.empty()) tiles.back()["predicted_instructions"] = input.predicted_tiles[i];
  }
  Json report;
  report["version"] = kReportVersion;
  report["picture"] = {{"width", input.width}, {"height", input.height}, {"tile_width", input.tile_width}};
  report["machine"] = {{"cores", input.cores.size()}};
  report["frame"] = {{"instructions", instructions}};
  report["cores"] = std::move(cores);
  report["work_of_cores"] = work_json(sum_of_work(input.cores), *input.engine);
  if (input.tile_work) report["work"] = work_json(*input.tile_work, *input.engine);
  report["tiles"] = std::move(tiles);
  report["image_hash"] = hash_text(input.image_hash);
  if (input.depth_hash) report["depth_hash"] = hash_text(*input.depth_hash);
  if (input.ids_hash) report["ids_hash"] = hash_text(*input.ids_hash);
  return report.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace gridiron::tool
