// Report: the documented keys, no more and no fewer, with the values that were put in.
// Memory: std::string. Threads: one. SPDX-License-Identifier: Apache-2.0
#include "report/report.h"

#include <nlohmann/json.hpp>

#include "support/test_headers.h"

namespace gridiron::tool {
namespace {

using Json = nlohmann::ordered_json;

ReportInput sample() {
  ReportInput input;
  input.triangle_count = 69451;
  input.vertex_count = 35947;
  input.dropped_triangle_count = 3;
  std::ranges::copy(std::array{2048u, 2047u, 2046u}, input.grid.cell_count);
  std::ranges::copy(std::array{342u, 342u, 341u}, input.grid.macro_cell_count);
  input.grid.reference_count = 4000000000u;
  input.image_bytes = 5000000000u;
  input.configuration = "reference";
  input.machine = *sim::find_machine_profile("cell-ps3");
  input.timing.frame_cycles = 1000.5;
  input.timing.seconds = 0.25;
  for (std::uint32_t core = 0; core < 2; ++core) {
    sim::CoreTiming timing;
    timing.tiles = 10 + core;
    timing.init_cycles = 100;
    timing.compute_cycles = 500.25;
    std::ranges::copy(std::array{1, 20, 300, 4}, timing.dma_wait_cycles);
    timing.idle_cycles = 75.25;
    timing.gets = 7;
    timing.puts = 8;
    timing.bytes_in = 9;
    timing.bytes_out = 10;
    timing.line_bytes_in = 11;
    timing.line_bytes_out = 12;
    input.timing.cores.push_back(timing);
  }
  for (std::uint32_t kind = 0; kind < kWorkKindCount; ++kind) input.work[kind] = 1000 + kind;
  input.effects_called_for = {"hard_shadows"};
  input.rays = {{"primary", 1048576}};
  input.arena_bytes = 262144;
  input.regions = {{"frame", 0, 384}, {"cell_blocks", 384, 3584}};
  input.code_bytes = 40000;
  input.stack_bytes = 4096;
  input.load = {0.125, 0.25};
  input.build = {0.5, 0.75};
  input.render = {2, 4};
  input.host_threads = 6;
  input.repeats = 3;
  input.trace_bytes = 5000;
  input.image_hash = 0x0123456789abcdef;
  input.depth_hash = 0x1123456789abcdef;
  input.ids_hash = 0x2123456789abcdef;
  return input;
}

/// Every path to a value, in order; elements of arrays all count as [].
void collect_paths(const Json& json, const std::string& prefix, std::vector<std::string>& paths) {
  if (json.is_object()) {
    for (const auto& [key, value] : json.items())
      collect_paths(value, prefix.empty() ? key : prefix + "." + key, paths);
  } else if (json.is_array()) {
    for (const Json& value : json) collect_paths(value, prefix + "[]", paths);
  } else if (std::ranges::find(paths, prefix) == paths.end()) {
    paths.push_back(prefix);
  }
}

/// What sample() becomes, keys in the documented order; but for its work.
constexpr const char* kReport = R"({
  "version": 1, "mode": "checked", "configuration": "reference",
  "scene": {"triangles": 69451, "vertices": 35947, "dropped_triangles": 3, "image_bytes": 5000000000,
            "grid": {"cells": 8577355776, "macrocells": 39884724, "references": 4000000000, "bytes": 5000000000,
                     "lambda": 0, "wanted_lambda": 0}},
  "machine": {"name": "cell-ps3", "cores": 2, "clock_hz": 3.2e9},
  "frame": {"cycles": 1000.5, "seconds": 0.25, "fps": 4},
  "cores": [{"tiles": 10, "init_cycles": 100, "compute_cycles": 500.25,
             "dma_wait_cycles": {"tile": 1, "macrocell": 20, "triangle": 300, "setup": 4}, "idle_cycles": 75.25,
             "dma": {"gets": 7, "puts": 8, "bytes_in": 9, "bytes_out": 10, "line_bytes_in": 11, "line_bytes_out": 12}},
            {"tiles": 11, "init_cycles": 100, "compute_cycles": 500.25,
             "dma_wait_cycles": {"tile": 1, "macrocell": 20, "triangle": 300, "setup": 4}, "idle_cycles": 75.25,
             "dma": {"gets": 7, "puts": 8, "bytes_in": 9, "bytes_out": 10, "line_bytes_in": 11, "line_bytes_out": 12}}],
  "work": {},
  "effects": {"called_for": ["hard_shadows"], "rays": {"primary": 1048576}},
  "local_store": {"arena_bytes": 262144,
                  "regions": [{"name": "frame", "offset": 0, "bytes": 384},
                              {"name": "cell_blocks", "offset": 384, "bytes": 3584}],
                  "code_bytes": 40000, "stack_bytes": 4096},
  "host": {"load_seconds": 0.125, "build_seconds": 0.5, "render_seconds": 2, "load_processor_seconds": 0.25,
           "build_processor_seconds": 0.75, "render_processor_seconds": 4, "threads": 6, "lanes": 4, "repeats": 3,
           "trace_bytes": 5000},
  "image_hash": "0123456789abcdef", "depth_hash": "1123456789abcdef", "ids_hash": "2123456789abcdef"})";

Json documented_report() {
  Json report = Json::parse(kReport);
  Json& work = report["work"];
  // clang-format off
  for (const char* name :
       {"tile_start", "ray_packet", "pixel_projection", "ray_generated",
        "ray_set_word", "recent_slot", "cull_test", "pixel_box_group",
        "open_triangle", "listed_triangle", "triangle_setup", "slope_setup",
        "subpacket_setup", "subpacket_group", "triangle_test", "subpacket_pick",
        "subpacket_visit", "group_test_standard", "group_skip", "inside_test",
        "row_visit", "row_test", "row_skip", "row_inside_test",
        "cull_test_paper", "group_test_paper", "hit_group", "open_hit_group",
        "settled_group", "hit_subpacket", "taken_subpacket", "facing_group",
        "hit_group_paper", "hit_setup", "double_sign", "exact_sign",
        "exact_distance", "shaded_group", "shaded_simple_group", "depth_group",
        "id_group", "row_group", "estimate_setup",
        "normal_setup", "hit_half", "exact_order", "lattice_triangle",
        "wave_ray", "queued_ray", "list_ray", "list_beam", "list_beam_node", "list_child",
        "list_entry", "list_node", "list_run", "list_ray_node", "list_box_quad", "list_shared_box",
        "list_leaf", "list_triangle_group", "list_shared_leaf", "list_shared_group", "list_candidate", "ray_distance",
        "surface_point", "smooth_normal", "jitter_seed", "shadow_ray",
        "area_place", "light_sample", "highlight", "occlusion_ray", "mirror_ray",
        "refracted_ray", "environment_lookup", "color_added", "color_group", "vertex_color", "srgb_level",
        "get_issue", "put_issue", "wait", "packet_start",
        "pass_slope", "mailbox_group", "pass_group", "pass_square",
        "macro_slice_step", "macro_row", "macro_cell_step", "macro_cell_visit",
        "slice_step", "cell_row", "cell_step", "cell_visit",
        "triangle_batch", "mailbox_probe", "reach_group", "reach_test",
        "footprint_group", "cell_bound_step"}) {
    work[name] = 1000 + work.size();
  }
  // clang-format on
  return report;
}

TEST(Report, HasExactlyTheDocumentedKeysInOrder) {
  std::vector<std::string> paths, expected;
  collect_paths(Json::parse(report_json(sample())), "", paths);
  collect_paths(documented_report(), "", expected);
  EXPECT_EQ(paths, expected);
}

TEST(Report, ValuesAreTheOnesPutIn) {
  const Json report = Json::parse(report_json(sample()));
  EXPECT_EQ(report, documented_report());
  for (std::uint32_t kind = 0; kind < sim::kGridEngine.kind_count(); ++kind) {
    EXPECT_EQ(report["work"][std::string(sim::work_kind(WorkId(kind)).name)], 1000 + kind) << kind;
  }
}

TEST(Report, AnImageWithoutAGridHasNone) {
  ReportInput input = sample();
  input.has_grid = false;
  const Json scene = Json::parse(report_json(input), nullptr, false)["scene"];
  EXPECT_TRUE(scene.contains("grid"));
  EXPECT_TRUE(scene["grid"].is_null());
  EXPECT_EQ(scene["image_bytes"], 5000000000u);
}

TEST(Report, CyclesOfACoreAddUpToTheFrame) {
  const Json report = Json::parse(report_json(sample()));
  for (const Json& core : report["cores"]) {
    double sum =
        core["init_cycles"].get<double>() + core["compute_cycles"].get<double>() + core["idle_cycles"].get<double>();
    for (const auto& [level, cycles] : core["dma_wait_cycles"].items()) sum += cycles.get<double>();
    EXPECT_EQ(sum, report["frame"]["cycles"].get<double>());
  }
}

TEST(Report, WithoutTimeTheHostIsTold) {
  ReportInput input = sample();
  input.is_timed = false;
  input.mode = "plain";
  Json timed = Json::parse(report_json(sample()));
  for (const char* key : {"machine", "frame", "cores", "work"}) timed.erase(key);
  timed["effects"].erase("rays");
  timed["mode"] = "plain";
  EXPECT_EQ(Json::parse(report_json(input)), timed);
}

TEST(Report, TolerancesAreThoseOfSceneWithRoundShapes) {
  ReportInput input = sample();
  input.least_tolerance = 0.25f;
  input.most_tolerance = 0.5f;
  const Json scene = Json::parse(report_json(input))["scene"];
  EXPECT_EQ(scene["least_tolerance"], 0.25);
  EXPECT_EQ(scene["most_tolerance"], 0.5);
}

/// A frame with effects; the other keys keep their values.
ReportInput effects_sample() {
  ReportInput input = sample();
  input.is_scene_shaded = true;
  for (std::uint32_t stage = 0; stage < kStageCount; ++stage) {
    input.timing.cores[0].stages[stage] = {
        .compute_cycles = 10.5 + stage, .wait_cycles = 0.25, .bytes_in = 16ull * stage, .bytes_out = 1};
    input.timing.cores[1].stages[stage] = {
        .compute_cycles = 100, .wait_cycles = 1.0 * stage, .bytes_in = 1000, .bytes_out = 16ull * stage};
  }
  return input;
}

TEST(Report, EffectsTellRaysAndStagesOverAllCores) {
  const ReportInput input = effects_sample();
  const Json report = Json::parse(report_json(input));
  Json effects = report["effects"];
  const auto work = [&input](WorkId kind) { return input.work[kind.number()]; };
  EXPECT_EQ(effects["rays"]["primary"], 1048576);
  EXPECT_EQ(effects["rays"]["shadow"], work(Work::kShadowRay));
  EXPECT_EQ(effects["rays"]["occlusion"], work(Work::kOcclusionRay));
  EXPECT_EQ(effects["rays"]["reflected"], work(Work::kMirrorRay));
  EXPECT_EQ(effects["rays"]["refracted"], work(Work::kRefractedRay));
  EXPECT_EQ(effects["rays"].size(), 5u);
  EXPECT_EQ(effects["environment_lookups"], work(Work::kEnvironmentLookup));
  const char* const names[] = {"primary", "surface", "shadow", "occlusion", "bounce", "environment", "output"};
  ASSERT_EQ(effects["stages"].size(), kStageCount);
  for (std::uint32_t stage = 0; stage < kStageCount; ++stage) {
    const Json& told = effects["stages"][stage];
    EXPECT_EQ(told["name"], names[stage]);
    EXPECT_EQ(told["compute_cycles"], 110.5 + stage);
    EXPECT_EQ(told["dma_wait_cycles"], 0.25 + stage);
    EXPECT_EQ(told["bytes_in"], 1000 + 16 * stage);
    EXPECT_EQ(told["bytes_out"], 1 + 16 * stage);
  }

  Json others = report;
  others.erase("effects");
  Json plain = Json::parse(report_json(sample()));
  plain.erase("effects");
  EXPECT_EQ(others, plain);
}

TEST(Report, CyclesSurviveTheText) {
  ReportInput input = sample();
  input.timing.frame_cycles = 8796093022207.9990234375;  // 2^43 - 1/1024
  input.timing.cores[0].compute_cycles = 123456789012.0009765625;
  const Json report = Json::parse(report_json(input));
  EXPECT_EQ(report["frame"]["cycles"].get<double>(), input.timing.frame_cycles);
  EXPECT_EQ(report["cores"][0]["compute_cycles"].get<double>(), input.timing.cores[0].compute_cycles);
}

TEST(Report, EmptyInputIsStillValid) {
  const Json report = Json::parse(report_json({}));
  EXPECT_EQ(report["frame"]["fps"], 0);
  EXPECT_TRUE(report["cores"].is_array());
  EXPECT_TRUE(report["effects"]["called_for"].is_array());
  EXPECT_TRUE(report["effects"]["rays"].is_object());
  EXPECT_TRUE(report["local_store"]["regions"].is_array());
  EXPECT_FALSE(report.contains("depth_hash"));
  EXPECT_FALSE(report.contains("ids_hash"));
}

TEST(Report, NamesOfWorkAreDistinctAndSnakeCase) {
  std::set<std::string> names;
  for (std::uint32_t kind = 0; kind < sim::kGridEngine.kind_count(); ++kind) {
    const std::string name(sim::work_kind(WorkId(kind)).name);
    EXPECT_FALSE(name.empty()) << kind;
    EXPECT_EQ(name.find_first_not_of("abcdefghijklmnopqrstuvwxyz_"), std::string::npos) << name;
    EXPECT_TRUE(names.insert(name).second) << name;
  }
}

TEST(Report, ImageHashIsFnv1aOverRgbaBytes) {
  EXPECT_EQ(hash_text(image_hash({})), "cbf29ce484222325");
  EXPECT_EQ(hash_text(image_hash(std::array<std::uint32_t, 1>{0x64636261u})), "fc179f83ee0724dd");  // "abcd"
  EXPECT_EQ(hash_text(image_hash(std::array<std::uint32_t, 2>{0x04030201u, 0xFF070605u})), "7eb4598b368941f8");
  EXPECT_EQ(hash_text(0), "0000000000000000");
}

/// The documentation names every key and every kind of work.
TEST(Report, EveryKeyIsDocumented) {
  std::ifstream file(GRIDIRON_TOOLS_README);
  ASSERT_TRUE(file) << GRIDIRON_TOOLS_README;
  std::stringstream text;
  text << file.rdbuf();
  const std::string readme = text.str();
  std::vector<std::string> paths;
  collect_paths(Json::parse(report_json(effects_sample())), "", paths);
  for (const std::string& path : paths) {
    const std::string key = path.starts_with("work.") ? path.substr(5) : path;
    EXPECT_NE(readme.find("`" + key + "`"), std::string::npos) << key;
  }
}

}  // namespace
}  // namespace gridiron::tool
