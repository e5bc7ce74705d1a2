// info: counts, memory, store map. SPDX-License-Identifier: Apache-2.0
#include <gridiron/grid/grid_builder.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "run_program.h"
#include "temporary_folder.h"

namespace gridiron::test {
namespace {

using Json = nlohmann::json;

// A torus and two triangles without area, one of them far away.
TestMesh make_scene() {
  TestMesh mesh = make_torus(24, 16, 1.0f, 0.4f);
  mesh.append(make_triangle(Vec3(0, 0, 0), Vec3(50, 0, 0), Vec3(100, 0, 0)));
  mesh.append(make_triangle(Vec3(1, 1, 1), Vec3(1, 1, 1), Vec3(1, 1, 1)));
  return mesh;
}

Json info_json(const TemporaryFolder& folder, std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "info");
  arguments.emplace_back("--json");
  const ProgramResult result = run_program(folder.folder(), arguments);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  return Json::parse(result.out, nullptr, false);
}

TEST(Info, TellsWhatTheBuilderCounts) {
  const TemporaryFolder folder;
  const TestMesh mesh = make_scene();
  folder.write_ply("a.ply", mesh);
  GridNeed need{};
  ASSERT_EQ(count_scene_image(mesh.view(), {}, need), Status::kOk);

  const Json info = info_json(folder, {"a.ply"});
  EXPECT_EQ(info["version"], 1);
  EXPECT_EQ(info["packed"], false);
  EXPECT_EQ(info["scene"]["triangles"], mesh.triangles.size());
  EXPECT_EQ(info["scene"]["vertices"], mesh.vertices.size());
  EXPECT_EQ(info["scene"]["dropped_triangles"], 2);
  EXPECT_LT(info["scene"]["bounds"]["maximum"][0], 2.0) << "what cannot be hit has no bounds";
  EXPECT_EQ(info["grid"]["references"], need.grid.reference_count);
  EXPECT_EQ(info["grid"]["cell_count"],
            Json({need.grid.cell_count[0], need.grid.cell_count[1], need.grid.cell_count[2]}));
  EXPECT_EQ(info["main_memory"]["image_bytes"], need.image_bytes);
  EXPECT_EQ(info["main_memory"]["scratch_bytes"], need.scratch_bytes);
  EXPECT_EQ(info["main_memory"]["fits"], true);
  EXPECT_EQ(info["effects"]["called_for"], Json::array());
  EXPECT_EQ(info["loop_bounds"]["triangle_tests_per_pass"], need.grid.reference_count);
  EXPECT_EQ(info["local_store"]["arena_bytes"], 262144);
  EXPECT_EQ(info["local_store"]["regions"][0]["name"], "frame");
}

// The bound of a tile, on the counts that it is made of, and each loop's.
TEST(Info, TellsTheWorstTileAndEveryLoop) {
  const TemporaryFolder folder;
  folder.write_ply("a.ply", make_scene());
  const Json info = info_json(folder, {"a.ply"});
  const Json& worst = info["worst_tile"];
  EXPECT_EQ(worst["accuracy"], "standard");
  EXPECT_EQ(worst["tile_width"], 32);
  EXPECT_EQ(worst["occupied_macro_cells"], info["grid"]["cell_blocks"].get<std::uint64_t>() - 1);
  // 16 packets, six axes and signs, twice; and a ray without a direction, twice.
  const std::uint64_t passes = 16 * 6 * 2 + 2;
  EXPECT_EQ(worst["work"]["packet_start"], passes);
  EXPECT_EQ(worst["work"]["triangle_setup"], passes * info["grid"]["references"].get<std::uint64_t>());
  EXPECT_EQ(worst["work"]["tile_start"], 1);
  EXPECT_EQ(worst["dma"]["put_bytes"], 32 * 32 * 4);
  EXPECT_GT(worst["dma"]["get_bytes"], 0);
  EXPECT_GT(worst["cycles"]["total"], worst["cycles"]["work"]);
  EXPECT_FALSE(worst["work"].contains("wave_ray"));

  const Json& loops = info["loops"];
  EXPECT_GT(loops.size(), 200u);
  std::uint64_t found = 0;
  for (const Json& loop : loops) {
    const std::string kind = loop["kind"];
    EXPECT_TRUE(kind == "constant" || kind == "layout" || kind == "frame" || kind == "scene") << loop;
    if (kind == "constant") {
      EXPECT_GT(loop["most_turns"], 0) << loop;
    }
    if (loop["file"] == "store/packet_driver.h" && loop["function"] == "run" && kind == "scene") {
      EXPECT_EQ(loop["most_turns"], worst["triangle_runs"].get<std::uint64_t>() + 1);
      ++found;
    }
    if (loop["file"] == "render/tile_renderer.h" && loop["bound"] == "tiles") {
      EXPECT_EQ(loop["most_turns"], 32 * 32);
      ++found;
    }
  }
  EXPECT_EQ(found, 2u);
}

TEST(Info, EachStoreHasItsMap) {
  const TemporaryFolder folder;
  folder.write_ply("a.ply", make_scene());
  folder.write("big.machine", "based_on cell-ps3\nlocal_store_bytes 524288\n");
  const std::vector<std::string> command = {"a.ply", "--machine", "big.machine"};
  EXPECT_EQ(info_json(folder, command)["local_store"]["arena_bytes"], 524288) << "the largest there is room for";
  for (const int kilobytes : {64, 128, 256, 512}) {
    std::vector<std::string> with_store = command;
    with_store.insert(with_store.end(), {"--store", std::to_string(kilobytes), "--configuration", "best"});
    const Json store = info_json(folder, with_store)["local_store"];
    EXPECT_EQ(store["arena_bytes"], kilobytes * 1024);
    const Json& last = store["regions"].back();
    EXPECT_EQ(last["name"], "output");
    EXPECT_LE(last["offset"].get<int>() + last["bytes"].get<int>() + store["code_bytes"].get<int>() +
                  store["stack_bytes"].get<int>(),
              kilobytes * 1024);
  }
}

TEST(Info, APackedSceneTellsTheSameScene) {
  const TemporaryFolder folder;
  folder.write_ply("a.ply", make_scene());
  ASSERT_EQ(run_program(folder.folder(), {"pack", "a.ply", "-o", "a.gri"}).exit_code, 0);
  Json mesh = info_json(folder, {"a.ply"});
  Json packed = info_json(folder, {"a.gri"});
  EXPECT_EQ(packed["packed"], true);
  for (const char* key : {"scene", "grid", "loop_bounds", "local_store"}) EXPECT_EQ(mesh[key], packed[key]) << key;
  EXPECT_EQ(packed["main_memory"]["image_bytes"], mesh["main_memory"]["image_bytes"]);
  EXPECT_EQ(packed["main_memory"]["image_bytes"], std::filesystem::file_size(folder.path("a.gri")));
}

TEST(Info, ParametersReachTheGrid) {
  const TemporaryFolder folder;
  folder.write_ply("a.ply", make_scene());
  const Json info = info_json(folder, {"a.ply", "--lambda", "0.5", "--macro-width", "3", "--format", "projection"});
  EXPECT_EQ(info["grid"]["lambda"], 0.5);
  EXPECT_EQ(info["grid"]["macro_width"], 3);
  EXPECT_EQ(info["grid"]["triangle_format"], "projection");
}

TEST(Info, PeopleReadTheSameNumbers) {
  const TemporaryFolder folder;
  folder.write_ply("a.ply", make_scene());
  const ProgramResult result = run_program(folder.folder(), {"info", "a.ply"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_NE(result.out.find("770 triangles (2 of zero area dropped)"), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("256.0 KB"), std::string::npos) << result.out;
}

}  // namespace
}  // namespace gridiron::test
