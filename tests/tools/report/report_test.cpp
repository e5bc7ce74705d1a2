// Report: the documented keys, no more and no fewer, with the values that were put in.
// Memory: std::string. Threads: one. SPDX-License-Identifier: Apache-2.0
#include "report/report.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace gridiron::tool {
namespace {

using Json = nlohmann::ordered_json;

ReportInput sample() {
  ReportInput input;
  input.triangle_count = 69451;
  input.vertex_count = 35947;
  input.dropped_triangle_count = 3;
  input.grid.cell_count[0] = 2048;
  input.grid.cell_count[1] = 2047;
  input.grid.cell_count[2] = 2046;
  input.grid.macro_cell_count[0] = 342;
  input.grid.macro_cell_count[1] = 342;
  input.grid.macro_cell_count[2] = 341;
  input.grid.reference_count = 4000000000u;
  input.grid_bytes = 5000000000u;
  input.machine = *sim::find_machine_profile("cell-ps3");
  input.timing.frame_cycles = 1000.5;
  input.timing.seconds = 0.25;
  for (std::uint32_t core = 0; core < 2; ++core) {
    sim::CoreTiming timing;
    timing.tiles = 10 + core;
    timing.init_cycles = 100;
    timing.compute_cycles = 500.25;
    timing.dma_wait_cycles[static_cast<std::size_t>(sim::WaitLevel::kTile)] = 1;
    timing.dma_wait_cycles[static_cast<std::size_t>(sim::WaitLevel::kMacroCell)] = 20;
    timing.dma_wait_cycles[static_cast<std::size_t>(sim::WaitLevel::kTriangle)] = 300;
    timing.dma_wait_cycles[static_cast<std::size_t>(sim::WaitLevel::kSetup)] = 4;
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
  const auto add = [&paths](const std::string& path) {
    for (const std::string& known : paths) {
      if (known == path) return;
    }
    paths.push_back(path);
  };
  if (json.is_object()) {
    for (const auto& [key, value] : json.items())
      collect_paths(value, prefix.empty() ? key : prefix + "." + key, paths);
  } else if (json.is_array()) {
    for (const Json& value : json) collect_paths(value, prefix + "[]", paths);
  } else {
    add(prefix);
  }
}

TEST(Report, HasExactlyTheDocumentedKeysInOrder) {
  std::vector<std::string> expected = {"version",
                                       "mode",
                                       "scene.triangles",
                                       "scene.vertices",
                                       "scene.dropped_triangles",
                                       "scene.grid.cells",
                                       "scene.grid.macrocells",
                                       "scene.grid.references",
                                       "scene.grid.bytes",
                                       "scene.grid.lambda",
                                       "scene.grid.wanted_lambda",
                                       "machine.name",
                                       "machine.cores",
                                       "machine.clock_hz",
                                       "frame.cycles",
                                       "frame.seconds",
                                       "frame.fps",
                                       "cores[].tiles",
                                       "cores[].init_cycles",
                                       "cores[].compute_cycles",
                                       "cores[].dma_wait_cycles.tile",
                                       "cores[].dma_wait_cycles.macrocell",
                                       "cores[].dma_wait_cycles.triangle",
                                       "cores[].dma_wait_cycles.setup",
                                       "cores[].idle_cycles",
                                       "cores[].dma.gets",
                                       "cores[].dma.puts",
                                       "cores[].dma.bytes_in",
                                       "cores[].dma.bytes_out",
                                       "cores[].dma.line_bytes_in",
                                       "cores[].dma.line_bytes_out"};
  // clang-format off
  for (const char* name :
       {"tile_start",       "ray_generated",   "packet_start",     "pass_group",          "pass_square",
        "macro_slice_step", "macro_cell_step", "macro_cell_visit", "slice_step",          "cell_step",
        "cell_visit",       "triangle_batch",  "mailbox_probe",    "cull_test",           "pixel_box_group",
        "triangle_setup",   "subpacket_setup", "subpacket_group",  "group_test_standard", "group_test_paper",
        "hit_group",        "hit_subpacket",   "hit_group_paper",  "hit_setup",           "double_sign",
        "exact_sign",       "exact_distance",  "reach_group",      "shaded_group",        "shaded_simple_group",
        "depth_group",      "id_group",        "footprint_group",  "row_group",           "estimate_setup",
        "normal_setup",     "hit_half",        "exact_order",      "lattice_triangle",    "cell_bound_step",
        "wave_ray", "queued_ray", "walk_pass", "shaft_group", "ray_triangle_setup", "ray_group_test",
        "ray_distance", "surface_point", "smooth_normal", "shadow_ray", "light_sample",
        "highlight", "occlusion_ray", "mirror_ray", "refracted_ray", "environment_lookup",
        "color_added", "color_group",
        "get_issue",        "put_issue",       "wait"}) {
    expected.push_back(std::string("work.") + name);
  }
  // clang-format on
  for (const char* path : {"effects.called_for[]",
                           "effects.rays.primary",
                           "local_store.arena_bytes",
                           "local_store.regions[].name",
                           "local_store.regions[].offset",
                           "local_store.regions[].bytes",
                           "local_store.code_bytes",
                           "local_store.stack_bytes",
                           "host.load_seconds",
                           "host.build_seconds",
                           "host.render_seconds",
                           "host.load_processor_seconds",
                           "host.build_processor_seconds",
                           "host.render_processor_seconds",
                           "host.threads",
                           "host.lanes",
                           "host.repeats",
                           "host.trace_bytes",
                           "image_hash",
                           "depth_hash",
                           "ids_hash"}) {
    expected.push_back(path);
  }
  std::vector<std::string> paths;
  collect_paths(Json::parse(report_json(sample())), "", paths);
  EXPECT_EQ(paths, expected);
}

TEST(Report, ValuesAreTheOnesPutIn) {
  const Json report = Json::parse(report_json(sample()));
  EXPECT_EQ(report["version"], 1);
  EXPECT_EQ(report["scene"]["triangles"], 69451);
  EXPECT_EQ(report["scene"]["vertices"], 35947);
  EXPECT_EQ(report["scene"]["dropped_triangles"], 3);
  EXPECT_EQ(report["scene"]["grid"]["cells"], 2048ull * 2047 * 2046);
  EXPECT_EQ(report["scene"]["grid"]["macrocells"], 342ull * 342 * 341);
  EXPECT_EQ(report["scene"]["grid"]["references"], 4000000000u);
  EXPECT_EQ(report["scene"]["grid"]["bytes"], 5000000000u);
  EXPECT_EQ(report["machine"]["name"], "cell-ps3");
  EXPECT_EQ(report["machine"]["cores"], 2);  // as replayed, not as built
  EXPECT_EQ(report["machine"]["clock_hz"], 3.2e9);
  EXPECT_EQ(report["frame"]["cycles"], 1000.5);
  EXPECT_EQ(report["frame"]["seconds"], 0.25);
  EXPECT_EQ(report["frame"]["fps"], 4);
  ASSERT_EQ(report["cores"].size(), 2u);
  const Json& core = report["cores"][1];
  EXPECT_EQ(core["tiles"], 11);
  EXPECT_EQ(core["init_cycles"], 100);
  EXPECT_EQ(core["compute_cycles"], 500.25);
  EXPECT_EQ(core["dma_wait_cycles"]["tile"], 1);
  EXPECT_EQ(core["dma_wait_cycles"]["macrocell"], 20);
  EXPECT_EQ(core["dma_wait_cycles"]["triangle"], 300);
  EXPECT_EQ(core["dma_wait_cycles"]["setup"], 4);
  EXPECT_EQ(core["idle_cycles"], 75.25);
  EXPECT_EQ(core["dma"], Json::parse(R"({"gets": 7, "puts": 8, "bytes_in": 9, "bytes_out": 10,
                                         "line_bytes_in": 11, "line_bytes_out": 12})"));
  for (std::uint32_t kind = 0; kind < kWorkKindCount; ++kind) {
    EXPECT_EQ(report["work"][std::string(work_name(static_cast<Work>(kind)))], 1000 + kind) << kind;
  }
  EXPECT_EQ(report["effects"], Json::parse(R"({"called_for": ["hard_shadows"], "rays": {"primary": 1048576}})"));
  EXPECT_EQ(report["local_store"]["arena_bytes"], 262144);
  EXPECT_EQ(report["local_store"]["regions"], Json::parse(R"([{"name": "frame", "offset": 0, "bytes": 384},
                                                 {"name": "cell_blocks", "offset": 384, "bytes": 3584}])"));
  EXPECT_EQ(report["local_store"]["code_bytes"], 40000);
  EXPECT_EQ(report["local_store"]["stack_bytes"], 4096);
  EXPECT_EQ(report["host"], Json::parse(R"({"load_seconds": 0.125, "build_seconds": 0.5, "render_seconds": 2.0,
                                            "load_processor_seconds": 0.25, "build_processor_seconds": 0.75,
                                            "render_processor_seconds": 4.0, "threads": 6, "lanes": 4,
                                            "repeats": 3, "trace_bytes": 5000})"));
  EXPECT_EQ(report["image_hash"], "0123456789abcdef");
  EXPECT_EQ(report["depth_hash"], "1123456789abcdef");
  EXPECT_EQ(report["ids_hash"], "2123456789abcdef");
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
  const auto work = [&input](Work kind) { return input.work[static_cast<std::size_t>(kind)]; };
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
  for (std::uint32_t kind = 0; kind < kWorkKindCount; ++kind) {
    const std::string name(work_name(static_cast<Work>(kind)));
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
