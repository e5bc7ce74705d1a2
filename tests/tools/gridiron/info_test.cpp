// info: counts, memory, store map. SPDX-License-Identifier: Apache-2.0
#include <gridiron/build/grid/grid_builder.h>

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

Json info_json(const TemporaryFolder& folder, const Words& arguments) {
  return Json::parse(run(folder, Words{"info"} + arguments + Words{"--json"}).out, nullptr, false);
}

TEST(Info, ANameThatIsNoUtf8IsWrittenWithReplacements) {
  const TemporaryFolder folder("bad\xff.ply", make_scene());
  EXPECT_EQ(info_json(folder, {"bad\xff.ply"})["input"], "bad\xEF\xBF\xBD.ply");
}

TEST(Info, TellsWhatTheBuilderCounts) {
  const TemporaryFolder folder;
  const TestMesh mesh = make_scene();
  folder.write_ply("a.ply", mesh);
  GridNeed need{};
  ASSERT_EQ(count_scene_image(mesh.view(), {}, need), Status::kOk);

  const Json info = info_json(folder, with_reference({"a.ply"}));
  EXPECT_EQ(info["version"], 1);
  EXPECT_EQ(info["configuration"], "reference");
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

// Bytes of each structure, which together with header and section table are the image.
TEST(Info, TellsWhatAnImageHolds) {
  const TemporaryFolder folder("a.ply", make_scene());
  for (const char* configuration : {"grid", "best"}) {
    run(folder, {"pack", "a.ply", "-o", "a.gri", "--configuration", configuration});
    const bool is_tree = std::string_view(configuration) == "best";
    for (const char* input : {"a.gri", "a.ply"}) {
      const Json info = info_json(folder, {input, "--configuration", configuration});
      const Json& memory = info["main_memory"];
      EXPECT_EQ(info["grid"].is_null(), is_tree);
      EXPECT_EQ(info["tree"].is_null(), !is_tree);
      EXPECT_EQ(info["loop_bounds"].is_null(), is_tree);
      EXPECT_EQ(memory["grid_bytes"] == 0, is_tree);
      EXPECT_EQ(memory["tree_bytes"] == 0, !is_tree);
      EXPECT_EQ(memory["effect_bytes"], 0);
      EXPECT_EQ(memory["grid_bytes"].get<std::uint64_t>() + memory["tree_bytes"].get<std::uint64_t>() + 256,
                memory["image_bytes"].get<std::uint64_t>());
      EXPECT_EQ(memory["image_bytes"], std::filesystem::file_size(folder.path("a.gri")));
      EXPECT_LT(info["scene"]["bounds"]["maximum"][0], 2.0);
    }
  }
}

// By default: the tree and its layout; a tile of eye rays through it has a bound for a camera alone.
TEST(Info, TellsTheTreeOfBest) {
  const TemporaryFolder folder("a.ply", make_scene());
  const Json info = info_json(folder, {"a.ply"});
  EXPECT_EQ(info["configuration"], "best");
  EXPECT_EQ(info["tree"]["triangles"], info["scene"]["triangles"].get<int>() - 2);
  EXPECT_EQ(info["effects"]["renderer"], "TreeLayout256K<>");
  EXPECT_TRUE(info["worst_tile"].is_null());
  EXPECT_TRUE(info_json(folder, with_reference({"a.ply"}))["tree"].is_null());
  EXPECT_NE(run(folder, {"info", "a.ply"}).out.find("\nconfiguration  best\n"), std::string::npos);
}

// With a camera: the bound of each tile of its view, in both stores.
TEST(Info, TellsTheWorstTileOfAView) {
  const TemporaryFolder folder("a.ply", make_scene());
  folder.write("a.camera", "eye 0 1 3\nat 0 0 0\n");
  const Words view = {"a.ply", "--camera", "a.camera", "--size", "200x100", "--shading", "none"};
  const Json info = info_json(folder, view);
  const Json& worst = info["worst_tile"];
  EXPECT_EQ(worst["accuracy"], "standard");
  EXPECT_EQ(worst["tile_width"], 64);
  EXPECT_EQ(worst["tiles"].size(), 4 * 2);
  const std::size_t tile = worst["tile"][1].get<std::size_t>() * 4 + worst["tile"][0].get<std::size_t>();
  EXPECT_EQ(worst["tiles"][tile], worst["cycles"]["total"]);
  for (const Json& cycles : worst["tiles"]) EXPECT_LE(cycles, worst["cycles"]["total"]);
  EXPECT_GT(worst["work"]["leaf"], 0);
  EXPECT_GT(worst["work"]["shaded_group"], 0);
  EXPECT_FALSE(worst["work"].contains("packet_start"));
  EXPECT_GT(worst["dma"]["get_bytes"], 512);
  for (const Json& loop : info["loops"]) {
    const bool is_known = loop["kind"] == "constant" || loop["kind"] == "build";
    EXPECT_EQ(loop["most_turns"].is_null(), !is_known) << "tiles have no bound for every camera: " << loop;
  }

  const Json simple = info_json(folder, {"a.ply", "--camera", "a.camera", "--size", "200x100"})["worst_tile"];
  EXPECT_GT(simple["work"]["facing_block"], 0);
  EXPECT_GT(simple["cycles"]["work"], worst["cycles"]["work"]);
  EXPECT_EQ(info_json(folder, view + Words{"--store", "64"})["worst_tile"]["tiles"].size(), 13 * 7);
  EXPECT_NE(run(folder, Words{"info"} + view).out.find("\nworst tile     for this camera at most "), std::string::npos);
}

TEST(Info, HasNoBoundOfAViewWhereThereIsNone) {
  const TemporaryFolder folder("a.ply", make_scene());
  folder.write("a.camera", "eye 0 1 3\nat 0 0 0\n");
  const Words cases[] = {{"--configuration", "grid"}, {"--depth"}, {"--accuracy", "compact"}, {"--machine", "fu540"}};
  for (const Words& words : cases) {
    expect_failure(folder, Words{"info", "a.ply", "--camera", "a.camera"} + words, 2,
                   "--camera: tiles have no bound for a view with ");
  }
}

// The bound of a tile, on the counts that it is made of, and each loop's.
TEST(Info, TellsTheWorstTileAndEveryLoop) {
  const TemporaryFolder folder("a.ply", make_scene());
  const Json info = info_json(folder, with_reference({"a.ply"}));
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
  EXPECT_GT(loops.size(), 50u);
  std::uint64_t found = 0;
  for (const Json& loop : loops) {
    const std::string kind = loop["kind"];
    EXPECT_TRUE(kind == "constant" || kind == "layout" || kind == "frame" || kind == "scene" ||
                kind == "build") << loop;
    EXPECT_EQ(loop["most_turns"].is_null(), kind == "build") << "an image without a tree: " << loop;
    if (kind == "constant") {
      EXPECT_GT(loop["most_turns"], 0) << loop;
    }
    if (loop["file"] == "engine/grid/packet_driver.h" && loop["function"] == "run" && kind == "scene") {
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

// With a tree: the bounds of the passes that build it, for either store.
TEST(Info, TellsTheLoopsThatBuildATree) {
  const TemporaryFolder folder("a.ply", make_scene());
  run(folder, {"pack", "a.ply", "-o", "a.gri", "--configuration", "best"});
  const auto turns = [&](const Words& words, const char* file, const char* bound) {
    const Json info = info_json(folder, words);
    for (const Json& loop : info["loops"]) {
      if (loop["file"] == file && loop["bound"] == bound) return loop["most_turns"];
    }
    return Json();
  };
  const int triangles = info_json(folder, {"a.ply"})["scene"]["triangles"];
  for (const char* input : {"a.ply", "a.gri"}) {
    EXPECT_EQ(turns({input}, "build/passes/top_pass.h", "build_triangles"), triangles);
    EXPECT_EQ(turns({input}, "build/passes/subtrees_pass.h", "bucket_triangles"), triangles);
    EXPECT_EQ(turns({input, "--store", "64"}, "build/passes/subtrees_pass.h", "bucket_triangles"), 432);
  }
  EXPECT_TRUE(info_json(folder, {"a.ply", "--accuracy", "compact"})["loops"].is_null()) << "no core builds it";
  const Json both = info_json(folder, {GRIDIRON_SCENE_FILES "/glass.nff", "--configuration", "grid"});
  for (const Json& loop : both["loops"]) EXPECT_FALSE(loop["most_turns"].is_null()) << "a grid and a tree: " << loop;
}

// Another accuracy is another bound, of its own format; and the default is that of the format.
TEST(Info, TheWorstTileIsOfTheAccuracyAskedFor) {
  const TemporaryFolder folder("a.ply", make_scene());
  const Json usual = info_json(folder, with_reference({"a.ply"}));
  const Json standard = info_json(folder, with_reference({"a.ply", "--accuracy", "standard"}));
  EXPECT_EQ(usual, standard);
  const Json exact = info_json(folder, with_reference({"a.ply", "--accuracy", "exact"}));
  EXPECT_EQ(exact["grid"], usual["grid"]);
  EXPECT_EQ(exact["local_store"], usual["local_store"]);
  EXPECT_EQ(exact["worst_tile"]["accuracy"], "exact");
  // Once more for each ray alone: a tile of 32x32.
  EXPECT_EQ(exact["worst_tile"]["work"]["packet_start"],
            usual["worst_tile"]["work"]["packet_start"].get<std::uint64_t>() + 32 * 32);
  EXPECT_TRUE(exact["worst_tile"]["work"].contains("exact_order"));
  EXPECT_FALSE(usual["worst_tile"]["work"].contains("exact_order"));
  for (const auto& [accuracy, format] :
       {std::pair{"paper", "projection"}, {"fast", "vertices"}, {"compact", "lattice"}}) {
    const Json info = info_json(folder, with_reference({"a.ply", "--accuracy", accuracy}));
    EXPECT_EQ(info["worst_tile"]["accuracy"], accuracy);
    EXPECT_EQ(info["grid"]["triangle_format"], format);
    if (info["grid"]["triangle_format"] == "vertices") continue;
    EXPECT_EQ(info, info_json(folder, with_reference({"a.ply", "--format", format})))
        << "each is the only one of its format";
  }
}

TEST(Info, AnAccuracyThatAPackedSceneDoesNotServeIsRefused) {
  const TemporaryFolder folder("a.ply", make_scene());
  run(folder, with_reference({"pack", "a.ply", "-o", "a.gri"}));
  const Json packed = info_json(folder, with_reference({"a.gri", "--accuracy", "exact"}))["worst_tile"];
  EXPECT_FALSE(packed.is_null());
  EXPECT_EQ(packed, info_json(folder, with_reference({"a.ply", "--accuracy", "exact"}))["worst_tile"]);
  expect_failure(folder, {"info", "a.gri", "--accuracy", "paper"}, 1,
                 "was packed with --format vertices, which --accuracy fast, standard, exact read; this needs --format "
                 "projection");
}

// The map, the bound and the loops are of the same layout.
TEST(Info, TheLayoutFollowsThePackets) {
  const TemporaryFolder folder("a.ply", make_scene());
  const auto packet_bytes = [](const Json& info) {
    for (const Json& region : info["local_store"]["regions"]) {
      if (region["name"] == "packet") return region["bytes"].get<int>();
    }
    return 0;
  };
  int last_bytes = 0;
  for (const int width : {4, 8, 16, 32}) {
    const Json info = info_json(folder, with_reference({"a.ply", "--packet", std::to_string(width)}));
    EXPECT_EQ(info["worst_tile"]["packet_width"], width);
    const int across = 32 / width;
    EXPECT_EQ(info["worst_tile"]["work"]["packet_start"], across * across * 6 * 2 + 2);
    EXPECT_EQ(info["effects"]["renderer"], "StoreLayout256K<" + std::to_string(width) + ">");
    EXPECT_GT(packet_bytes(info), last_bytes);
    last_bytes = packet_bytes(info);
    bool found = false;
    for (const Json& loop : info["loops"]) {
      if (loop["bound"] != "parts(packet_rays, 32)") continue;
      EXPECT_EQ(loop["most_turns"], (width * width + 31) / 32);
      found = true;
    }
    EXPECT_TRUE(found);
  }
  EXPECT_EQ(info_json(folder, with_reference({"a.ply", "--packet", "8"})),
            info_json(folder, with_reference({"a.ply"})));
  // A default store is one with a kernel for the packets, as for render.
  folder.write("big.machine", "based_on cell-ps3\nlocal_store_bytes 524288\n");
  const Json smaller = info_json(folder, with_reference({"a.ply", "--packet", "4", "--machine", "big.machine"}));
  EXPECT_EQ(smaller["local_store"]["arena_bytes"], 262144);
}

TEST(Info, APlaneOfDistancesCountsItsBytesAndItsWork) {
  const TemporaryFolder folder("a.ply", make_scene());
  const Json without = info_json(folder, with_reference({"a.ply"}));
  const Json with = info_json(folder, with_reference({"a.ply", "--depth"}));
  EXPECT_EQ(with["local_store"], without["local_store"]);
  EXPECT_EQ(without["worst_tile"]["depth"], false);
  EXPECT_EQ(with["worst_tile"]["depth"], true);
  EXPECT_EQ(with["worst_tile"]["dma"]["put_bytes"], 2 * 32 * 32 * 4);
  EXPECT_EQ(with["worst_tile"]["work"]["depth_group"], 32 * 32 / 4);
  EXPECT_EQ(with["main_memory"]["picture_bytes"],
            without["main_memory"]["picture_bytes"].get<std::uint64_t>() + 1024 * 1024 * 4);
  EXPECT_FALSE(without["worst_tile"]["work"].contains("depth_group"));
}

// What there is no image to count of is null, not missing.
TEST(Info, WithoutAnImageThatFitsThereIsNoWorstTile) {
  const TemporaryFolder folder("a.ply", make_torus(100, 100, 1.0f, 0.4f));
  folder.write("small.machine", "based_on cell-ps3\nmain_memory_bytes 1048576\n");
  const Json info =
      info_json(folder, with_reference({"a.ply", "--machine", "small.machine", "--lambda", "8", "--size", "64x64"}));
  EXPECT_EQ(info["main_memory"]["fits"], false);
  ASSERT_TRUE(info.contains("worst_tile") && info.contains("loops"));
  EXPECT_TRUE(info["worst_tile"].is_null());
  EXPECT_TRUE(info["loops"].is_null());
  EXPECT_GT(info["loop_bounds"]["cells_per_pass"], 0);
}

// A machine whose prices are instructions says so, and one that is based on it.
TEST(Info, WhatIsCountedInInstructionsIsCalledSo) {
  const TemporaryFolder folder("a.ply", make_scene());
  folder.write("board.machine", "based_on fu540\ncore_count 2\n");
  const auto worst_line = [&folder](const std::string& machine) {
    const ProgramResult result = run(folder, with_reference({"info", "a.ply", "--machine", machine}));
    const std::size_t begin = result.out.find("\nworst tile");
    EXPECT_NE(begin, std::string::npos) << result.out;
    return begin == std::string::npos ? "" : result.out.substr(begin);
  };
  for (const auto& [machine, unit, other] : {std::tuple{"cell-ps3", "cycles", "instructions"},
                                             {"fu540", "instructions", "cycles"},
                                             {"board.machine", "instructions", "cycles"}}) {
    EXPECT_NE(worst_line(machine).find(std::string(unit) + " of work"), std::string::npos) << machine;
    EXPECT_EQ(worst_line(machine).find(other), std::string::npos) << machine;
    EXPECT_EQ(info_json(folder, with_reference({"a.ply", "--machine", machine}))["worst_tile"]["cycles_are"], unit);
  }
}

TEST(Info, EachStoreHasItsMap) {
  const TemporaryFolder folder("a.ply", make_scene());
  folder.write("big.machine", "based_on cell-ps3\nlocal_store_bytes 524288\n");
  const Words command = {"a.ply", "--machine", "big.machine"};
  for (const Words& words : {command, with_reference(command)}) {
    EXPECT_EQ(info_json(folder, words)["local_store"]["arena_bytes"], 524288) << "the largest there is room for";
  }
  for (const int kilobytes : {64, 128, 256, 512}) {
    const Words store_options = {"--store", std::to_string(kilobytes), "--configuration", "grid"};
    const Json store = info_json(folder, command + store_options)["local_store"];
    EXPECT_EQ(store["arena_bytes"], kilobytes * 1024);
    const Json& last = store["regions"].back();
    EXPECT_EQ(last["name"], "output");
    EXPECT_LE(last["offset"].get<int>() + last["bytes"].get<int>() + store["code_bytes"].get<int>() +
                  store["stack_bytes"].get<int>(),
              kilobytes * 1024);
  }
}

TEST(Info, APackedSceneTellsTheSameScene) {
  const TemporaryFolder folder("a.ply", make_scene());
  run(folder, {"pack", "a.ply", "-o", "a.gri"});
  Json mesh = info_json(folder, {"a.ply"});
  Json packed = info_json(folder, {"a.gri"});
  EXPECT_EQ(packed["packed"], true);
  for (const char* key : {"scene", "configuration", "grid", "tree", "loop_bounds", "local_store"})
    EXPECT_EQ(mesh[key], packed[key]) << key;
  EXPECT_EQ(packed["main_memory"]["image_bytes"], mesh["main_memory"]["image_bytes"]);
  EXPECT_EQ(packed["main_memory"]["image_bytes"], std::filesystem::file_size(folder.path("a.gri")));
}

TEST(Info, ParametersReachTheGrid) {
  const TemporaryFolder folder("a.ply", make_scene());
  const Json info = info_json(folder, {"a.ply", "--lambda", "0.5", "--macro-width", "3", "--format", "projection"});
  EXPECT_EQ(info["configuration"], "reference") << "the one for --format projection";
  EXPECT_EQ(info["grid"]["lambda"], 0.5);
  EXPECT_EQ(info["grid"]["macro_width"], 3);
  EXPECT_EQ(info["grid"]["triangle_format"], "projection");
}

TEST(Info, PeopleReadTheSameNumbers) {
  const TemporaryFolder folder("a.ply", make_scene());
  const ProgramResult result = run(folder, {"info", "a.ply"});
  EXPECT_NE(result.out.find("770 triangles (2 of zero area dropped)"), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("256.0 KB"), std::string::npos) << result.out;
}

}  // namespace
}  // namespace gridiron::test
