// Report: see report.h.
// Memory: std::string. Threads: any, no shared state. SPDX-License-Identifier: Apache-2.0
#include "report/report.h"

#include <nlohmann/json.hpp>
#include <utility>

namespace gridiron::tool {

namespace {

using Json = nlohmann::ordered_json;

// A value of an enumeration that ends in kCount, and its name.
template <class Value>
struct Name {
  Value value;
  std::string_view name;
};

template <class Value, std::size_t kCount>
constexpr std::string_view name_in(const Name<Value> (&names)[kCount], Value value) {
  for (const Name<Value>& each : names) {
    if (each.value == value) return each.name;
  }
  return "";
}

// Whether a table names each value, so that adding a value without a name does not compile.
template <class Value, std::size_t kCount>
constexpr bool names_all(const Name<Value> (&names)[kCount]) {
  for (std::size_t i = 0; i < static_cast<std::size_t>(Value::kCount); ++i) {
    if (name_in(names, static_cast<Value>(i)).empty()) return false;
  }
  return kCount == static_cast<std::size_t>(Value::kCount);
}

Json scene_json(const ReportInput& input) {
  const GridRecord& grid = input.grid;
  const auto product = [](const std::uint32_t counts[3]) { return std::uint64_t{counts[0]} * counts[1] * counts[2]; };
  Json json = {{"triangles", input.triangle_count},
               {"vertices", input.vertex_count},
               {"dropped_triangles", input.dropped_triangle_count},
               {"image_bytes", input.image_bytes},
               {"grid", Json()}};
  if (input.has_grid) {
    json["grid"] = {{"cells", product(grid.cell_count)},
                    {"macrocells", product(grid.macro_cell_count)},
                    {"references", grid.reference_count},
                    {"bytes", input.image_bytes},
                    {"lambda", grid.lambda},
                    {"wanted_lambda", input.wanted_lambda}};
  }
  if (input.least_tolerance) json["least_tolerance"] = *input.least_tolerance;
  if (input.most_tolerance) json["most_tolerance"] = *input.most_tolerance;
  return json;
}

Json host_json(const ReportInput& input) {
  return {{"load_seconds", input.load.seconds},
          {"build_seconds", input.build.seconds},
          {"render_seconds", input.render.seconds},
          {"load_processor_seconds", input.load.processor_seconds},
          {"build_processor_seconds", input.build.processor_seconds},
          {"render_processor_seconds", input.render.processor_seconds},
          {"threads", input.host_threads},
          {"lanes", input.lanes},
          {"repeats", input.repeats},
          {"trace_bytes", input.trace_bytes}};
}

Json core_json(const sim::CoreTiming& core, const sim::EngineWork& engine) {
  Json waits = Json::object();
  for (std::size_t level = 0; level < sim::kWaitLevelCount; ++level) {
    waits[std::string(engine.wait_levels[level])] = core.dma_wait_cycles[level];
  }
  return {{"tiles", core.tiles},
          {"init_cycles", core.init_cycles},
          {"compute_cycles", core.compute_cycles},
          {"dma_wait_cycles", std::move(waits)},
          {"idle_cycles", core.idle_cycles},
          {"dma",
           {{"gets", core.gets},
            {"puts", core.puts},
            {"bytes_in", core.bytes_in},
            {"bytes_out", core.bytes_out},
            {"line_bytes_in", core.line_bytes_in},
            {"line_bytes_out", core.line_bytes_out}}}};
}

Json work_json(const sim::WorkTotals& work, const sim::EngineWork& engine) {
  Json json = Json::object();
  for (std::uint32_t kind = 0; kind < engine.kind_count(); ++kind) {
    json[std::string(sim::work_kind(WorkId(kind), engine).name)] = work[kind];
  }
  return json;
}

Json worst_json(const WorstTiles& worst) {
  const auto one = [](const std::uint32_t(&tile)[2], double cycles, std::uint64_t gets, std::uint64_t bytes) {
    return Json{{"tile", {tile[0], tile[1]}}, {"cycles", cycles}, {"gets", gets}, {"get_bytes", bytes}};
  };
  return {{"measured", one(worst.tile, worst.cycles, worst.gets, worst.get_bytes)},
          {"bound", one(worst.bound_tile, worst.bound_cycles, worst.bound_gets, worst.bound_get_bytes)},
          {"bound_seconds", worst.time.seconds},
          {"bound_processor_seconds", worst.time.processor_seconds}};
}

Json stages_json(const std::vector<sim::CoreTiming>& cores) {
  Json stages = Json::array();
  const std::array<sim::StageTiming, kStageCount> sums = stage_sums(cores);
  for (std::uint32_t stage = 0; stage < kStageCount; ++stage) {
    const sim::StageTiming& sum = sums[stage];
    stages.push_back(Json{{"name", std::string(stage_name(static_cast<Stage>(stage)))},
                          {"compute_cycles", sum.compute_cycles},
                          {"dma_wait_cycles", sum.wait_cycles},
                          {"bytes_in", sum.bytes_in},
                          {"bytes_out", sum.bytes_out}});
  }
  return stages;
}

Json effects_json(const ReportInput& input) {
  Json rays = Json::object();
  for (const RayCount& ray : input.rays) rays[ray.kind] = ray.count;
  Json effects = {{"called_for", input.effects_called_for}};
  if (!input.is_timed) return effects;
  if (!input.is_scene_shaded) {
    effects["rays"] = std::move(rays);
    return effects;
  }
  const auto count = [&input](WorkId kind) { return input.work[kind.number()]; };
  rays["shadow"] = count(Work::kShadowRay);
  rays["occlusion"] = count(Work::kOcclusionRay);
  rays["reflected"] = count(Work::kMirrorRay);
  rays["refracted"] = count(Work::kRefractedRay);
  effects["rays"] = std::move(rays);
  effects["environment_lookups"] = count(Work::kEnvironmentLookup);
  effects["stages"] = stages_json(input.timing.cores);
  return effects;
}

Json local_store_json(const ReportInput& input) {
  Json regions = Json::array();
  for (const LocalStoreRegion& region : input.regions) {
    regions.push_back(Json{{"name", region.name}, {"offset", region.offset_bytes}, {"bytes", region.bytes}});
  }
  return {{"arena_bytes", input.arena_bytes},
          {"regions", std::move(regions)},
          {"code_bytes", input.code_bytes},
          {"stack_bytes", input.stack_bytes}};
}

}  // namespace

std::string report_json(const ReportInput& input) {
  Json cores = Json::array();
  for (const sim::CoreTiming& core : input.timing.cores) cores.push_back(core_json(core, *input.timing.engine));

  const double seconds = input.timing.seconds;
  Json report;
  report["version"] = kReportVersion;
  report["mode"] = input.mode;
  report["configuration"] = input.configuration;
  report["scene"] = scene_json(input);
  if (input.is_timed) {
    report["machine"] = {{"name", std::string(input.machine.name)},
                         {"cores", input.timing.cores.size()},
                         {"clock_hz", input.machine.clock_hz}};
    report["frame"] = {
        {"cycles", input.timing.frame_cycles}, {"seconds", seconds}, {"fps", seconds > 0 ? 1 / seconds : 0.0}};
    report["cores"] = std::move(cores);
    report["work"] = work_json(input.work, *input.timing.engine);
    if (input.worst_tiles) report["worst_tile"] = worst_json(*input.worst_tiles);
  }
  report["effects"] = effects_json(input);
  report["local_store"] = local_store_json(input);
  report["host"] = host_json(input);
  report["image_hash"] = hash_text(input.image_hash);
  if (input.depth_hash) report["depth_hash"] = hash_text(*input.depth_hash);
  if (input.ids_hash) report["ids_hash"] = hash_text(*input.ids_hash);
  return report.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::array<sim::StageTiming, kStageCount> stage_sums(std::span<const sim::CoreTiming> cores) {
  std::array<sim::StageTiming, kStageCount> sums{};
  for (const sim::CoreTiming& core : cores) {
    for (std::size_t i = 0; i < kStageCount; ++i) {
      sim::StageTiming& sum = sums[i];
      const sim::StageTiming& part = core.stages[i];
      sum.compute_cycles += part.compute_cycles;
      sum.wait_cycles += part.wait_cycles;
      sum.gets += part.gets;
      sum.puts += part.puts;
      sum.bytes_in += part.bytes_in;
      sum.bytes_out += part.bytes_out;
    }
  }
  return sums;
}

double wait_cycles_of(const sim::FrameTiming& timing) {
  double cycles = 0;
  for (const sim::CoreTiming& core : timing.cores) {
    for (const double wait : core.dma_wait_cycles) cycles += wait;
  }
  return cycles;
}

double wait_percent_of(const sim::FrameTiming& timing) {
  const double core_cycles = timing.frame_cycles * static_cast<double>(timing.cores.size());
  return core_cycles > 0 ? 100 * wait_cycles_of(timing) / core_cycles : 0.0;
}

// clang-format off
std::string_view stage_name(Stage stage) {
  using enum Stage;
  static constexpr Name<Stage> kNames[] = {
      {kPrimary, "primary"}, {kSurface, "surface"}, {kShadow, "shadow"}, {kOcclusion, "occlusion"},
      {kBounce, "bounce"}, {kEnvironment, "environment"}, {kOutput, "output"}};
  static_assert(names_all(kNames));
  return name_in(kNames, stage);
}
// clang-format on

std::uint64_t image_hash(std::span<const std::uint32_t> pixels) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const std::uint32_t pixel : pixels) {
    for (std::uint32_t shift = 0; shift < 32; shift += 8) {
      hash ^= pixel >> shift & 0xFFu;
      hash *= 0x100000001b3u;
    }
  }
  return hash;
}

std::string hash_text(std::uint64_t hash) {
  std::string text(16, '0');
  for (std::size_t i = 0; i < text.size(); ++i) text[i] = "0123456789abcdef"[hash >> (60 - 4 * i) & 15u];
  return text;
}

}  // namespace gridiron::tool
