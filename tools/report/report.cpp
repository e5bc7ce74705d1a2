// Report: see report.h.
// Memory: std::string. Threads: any, no shared state. SPDX-License-Identifier: Apache-2.0
#include "report/report.h"

#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace gridiron::tool {

namespace {

using Json = nlohmann::ordered_json;

Json scene_json(const ReportInput& input) {
  const GridRecord& grid = input.grid;
  const auto product = [](const std::uint32_t counts[3]) { return std::uint64_t{counts[0]} * counts[1] * counts[2]; };
  Json json = {{"triangles", input.triangle_count},
               {"vertices", input.vertex_count},
               {"dropped_triangles", input.dropped_triangle_count},
               {"grid",
                {{"cells", product(grid.cell_count)},
                 {"macrocells", product(grid.macro_cell_count)},
                 {"references", grid.reference_count},
                 {"bytes", input.grid_bytes},
                 {"lambda", grid.lambda},
                 {"wanted_lambda", input.wanted_lambda}}}};
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

Json core_json(const sim::CoreTiming& core) {
  Json waits = Json::object();
  for (std::size_t level = 0; level < sim::kWaitLevelCount; ++level) {
    waits[std::string(wait_level_name(static_cast<sim::WaitLevel>(level)))] = core.dma_wait_cycles[level];
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

Json work_json(const sim::WorkTotals& work) {
  Json json = Json::object();
  for (std::uint32_t kind = 0; kind < kWorkKindCount; ++kind) {
    json[std::string(work_name(static_cast<Work>(kind)))] = work[kind];
  }
  return json;
}

Json stages_json(const std::vector<sim::CoreTiming>& cores) {
  Json stages = Json::array();
  for (std::uint32_t stage = 0; stage < kStageCount; ++stage) {
    sim::StageTiming sum;
    for (const sim::CoreTiming& core : cores) {
      const sim::StageTiming& part = core.stages[stage];
      sum.compute_cycles += part.compute_cycles;
      sum.wait_cycles += part.wait_cycles;
      sum.bytes_in += part.bytes_in;
      sum.bytes_out += part.bytes_out;
    }
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
  const auto count = [&input](Work kind) { return input.work[static_cast<std::size_t>(kind)]; };
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
  for (const sim::CoreTiming& core : input.timing.cores) cores.push_back(core_json(core));

  const double seconds = input.timing.seconds;
  Json report;
  report["version"] = kReportVersion;
  report["mode"] = input.mode;
  report["scene"] = scene_json(input);
  if (input.is_timed) {
    report["machine"] = {{"name", std::string(input.machine.name)},
                         {"cores", input.timing.cores.size()},
                         {"clock_hz", input.machine.clock_hz}};
    report["frame"] = {
        {"cycles", input.timing.frame_cycles}, {"seconds", seconds}, {"fps", seconds > 0 ? 1 / seconds : 0.0}};
    report["cores"] = std::move(cores);
    report["work"] = work_json(input.work);
  }
  report["effects"] = effects_json(input);
  report["local_store"] = local_store_json(input);
  report["host"] = host_json(input);
  report["image_hash"] = hash_text(input.image_hash);
  if (input.depth_hash) report["depth_hash"] = hash_text(*input.depth_hash);
  if (input.ids_hash) report["ids_hash"] = hash_text(*input.ids_hash);
  return report.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

// A switch, so that the compiler misses a name when a kind of work is added.
std::string_view work_name(Work kind) {
  switch (kind) {
    case Work::kTileStart:
      return "tile_start";
    case Work::kRayGenerated:
      return "ray_generated";
    case Work::kPacketStart:
      return "packet_start";
    case Work::kPassGroup:
      return "pass_group";
    case Work::kPassSquare:
      return "pass_square";
    case Work::kMacroSliceStep:
      return "macro_slice_step";
    case Work::kMacroCellStep:
      return "macro_cell_step";
    case Work::kMacroCellVisit:
      return "macro_cell_visit";
    case Work::kSliceStep:
      return "slice_step";
    case Work::kCellStep:
      return "cell_step";
    case Work::kCellVisit:
      return "cell_visit";
    case Work::kTriangleBatch:
      return "triangle_batch";
    case Work::kMailboxProbe:
      return "mailbox_probe";
    case Work::kCullTest:
      return "cull_test";
    case Work::kPixelBoxGroup:
      return "pixel_box_group";
    case Work::kTriangleSetup:
      return "triangle_setup";
    case Work::kGroupTestStandard:
      return "group_test_standard";
    case Work::kSubpacketSetup:
      return "subpacket_setup";
    case Work::kSubpacketGroup:
      return "subpacket_group";
    case Work::kReachGroup:
      return "reach_group";
    case Work::kGroupTestPaper:
      return "group_test_paper";
    case Work::kHitGroup:
      return "hit_group";
    case Work::kHitSubpacket:
      return "hit_subpacket";
    case Work::kHitGroupPaper:
      return "hit_group_paper";
    case Work::kHitSetup:
      return "hit_setup";
    case Work::kDoubleSign:
      return "double_sign";
    case Work::kExactSign:
      return "exact_sign";
    case Work::kExactDistance:
      return "exact_distance";
    case Work::kShadedGroup:
      return "shaded_group";
    case Work::kShadedSimpleGroup:
      return "shaded_simple_group";
    case Work::kDepthGroup:
      return "depth_group";
    case Work::kIdGroup:
      return "id_group";
    case Work::kFootprintGroup:
      return "footprint_group";
    case Work::kRowGroup:
      return "row_group";
    case Work::kEstimateSetup:
      return "estimate_setup";
    case Work::kNormalSetup:
      return "normal_setup";
    case Work::kHitHalf:
      return "hit_half";
    case Work::kExactOrder:
      return "exact_order";
    case Work::kLatticeTriangle:
      return "lattice_triangle";
    case Work::kCellBoundStep:
      return "cell_bound_step";
    case Work::kWaveRay:
      return "wave_ray";
    case Work::kQueuedRay:
      return "queued_ray";
    case Work::kWalkPass:
      return "walk_pass";
    case Work::kShaftGroup:
      return "shaft_group";
    case Work::kRayTriangleSetup:
      return "ray_triangle_setup";
    case Work::kRayGroupTest:
      return "ray_group_test";
    case Work::kRayDistance:
      return "ray_distance";
    case Work::kSurfacePoint:
      return "surface_point";
    case Work::kSmoothNormal:
      return "smooth_normal";
    case Work::kShadowRay:
      return "shadow_ray";
    case Work::kLightSample:
      return "light_sample";
    case Work::kHighlight:
      return "highlight";
    case Work::kOcclusionRay:
      return "occlusion_ray";
    case Work::kMirrorRay:
      return "mirror_ray";
    case Work::kRefractedRay:
      return "refracted_ray";
    case Work::kEnvironmentLookup:
      return "environment_lookup";
    case Work::kColorAdded:
      return "color_added";
    case Work::kColorGroup:
      return "color_group";
    case Work::kGetIssue:
      return "get_issue";
    case Work::kPutIssue:
      return "put_issue";
    case Work::kWait:
      return "wait";
    case Work::kCount:
      break;
  }
  return "";
}

std::string_view stage_name(Stage stage) {
  switch (stage) {
    case Stage::kPrimary:
      return "primary";
    case Stage::kSurface:
      return "surface";
    case Stage::kShadow:
      return "shadow";
    case Stage::kOcclusion:
      return "occlusion";
    case Stage::kBounce:
      return "bounce";
    case Stage::kEnvironment:
      return "environment";
    case Stage::kOutput:
      return "output";
    case Stage::kCount:
      break;
  }
  return "";
}

std::string_view build_step_name(sim::BuildStep step) {
  switch (step) {
    case sim::BuildStep::kVertexCheck:
      return "vertex_check";
    case sim::BuildStep::kTriangleSurvey:
      return "triangle_survey";
    case sim::BuildStep::kCellBox:
      return "cell_box";
    case sim::BuildStep::kCellRow:
      return "cell_row";
    case sim::BuildStep::kReferenceInsert:
      return "reference_insert";
    case sim::BuildStep::kReferenceSort:
      return "reference_sort";
    case sim::BuildStep::kTriangleWrite:
      return "triangle_write";
    case sim::BuildStep::kProjectionSetup:
      return "projection_setup";
    case sim::BuildStep::kCellSum:
      return "cell_sum";
    case sim::BuildStep::kMacroWord:
      return "macro_word";
    case sim::BuildStep::kCheckedLine:
      return "checked_line";
    case sim::BuildStep::kBinUpdate:
      return "bin_update";
    case sim::BuildStep::kTriangleMoved:
      return "triangle_moved";
    case sim::BuildStep::kBinSwept:
      return "bin_swept";
    case sim::BuildStep::kNodeMade:
      return "node_made";
    case sim::BuildStep::kCount:
      break;
  }
  return "";
}

std::string_view wait_level_name(sim::WaitLevel level) {
  switch (level) {
    case sim::WaitLevel::kTile:
      return "tile";
    case sim::WaitLevel::kMacroCell:
      return "macrocell";
    case sim::WaitLevel::kTriangle:
      return "triangle";
    case sim::WaitLevel::kSetup:
      return "setup";
    case sim::WaitLevel::kCount:
      break;
  }
  return "";
}

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
