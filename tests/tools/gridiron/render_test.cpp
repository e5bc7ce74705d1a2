// render: pictures, planes and reports of the whole program. SPDX-License-Identifier: Apache-2.0
#include <report/report.h>

#include <nlohmann/json.hpp>

#include "gridiron/scene/scene_points.h"
#include "gridiron/scene/view.h"
#include "run_program.h"
#include "support/picture.h"
#include "support/render_mesh.h"
#include "temporary_folder.h"

namespace gridiron::test {
namespace {

using Json = nlohmann::json;

const std::filesystem::path kScenes = GRIDIRON_SCENE_FILES;

// Runs a render that must succeed.
ProgramResult render(const TemporaryFolder& folder, const Words& arguments) {
  return run(folder, Words{"render"} + arguments);
}

Json render_report(const TemporaryFolder& folder, const Words& arguments) {
  (void)render(folder, arguments + Words{"--report", "report.json", "--quiet"});
  return Json::parse(read_file(folder.path("report.json")), nullptr, false);
}

// The planes that the simulated chip leaves for the program's default view.
RenderedFrame expected_frame(const TestMesh& mesh, std::uint32_t width, std::uint32_t height) {
  SceneInMemory scene(mesh.view(), {});
  FrameSettings settings;
  settings.camera =
      tool::complete_view({}, static_cast<double>(width) / height,
                          [&mesh](const tool::PointVisitor& visitor) { tool::visit_points(mesh.view(), visitor); });
  settings.width = width;
  settings.height = height;
  return scene.render(settings, {});
}

// A view in which `best` would seem to hang, and a scene of such a size.
TEST(Render, WithoutBoundsGridIsTheDefault) {
  const TestMesh torus = make_torus(40, 24, 1.0f, 0.4f);
  const struct { TestMesh mesh; Words view; } cases[] = {
      {make_box({0, 0, 0}, {1, 1, 1}),
       {"--eye", "300,200,100", "--at", "0.9,0.9,0.9", "--fov", "0.001", "--size", "200x170"}},
      {moved(torus, 1e25f), {"--size", "9x7"}}, {moved(torus, 1e-25f), {"--size", "9x7"}}};
  for (const auto& tested : cases) {
    const TemporaryFolder folder("a.ply", tested.mesh);
    const Words arguments = Words{"a.ply", "-o", "a.png", "--report", "r.json"} + tested.view;
    const ProgramResult plain = render(folder, arguments);
    EXPECT_NE(plain.err.find("for the bounds of configuration best; rendered by grid"), std::string::npos) << plain.err;
    const Json grid = Json::parse(read_file(folder.path("r.json")), nullptr, false);
    EXPECT_EQ(grid["configuration"], "grid");
    const ProgramResult named = render(folder, arguments + Words{"--configuration", "best"});
    EXPECT_NE(named.err.find("--configuration grid does not"), std::string::npos) << named.err;
    const Json best = Json::parse(read_file(folder.path("r.json")), nullptr, false);
    EXPECT_EQ(best["configuration"], "best");
    EXPECT_EQ(best["image_hash"], grid["image_hash"]);
    EXPECT_EQ(render(folder, arguments + Words{"--quiet"}).err, "");
  }
  const TemporaryFolder folder("a.ply", torus);
  const ProgramResult usual = render(folder, {"a.ply", "-o", "a.png", "--size", "9x7"});
  EXPECT_EQ(usual.err.find("bounds"), std::string::npos) << usual.err;
}

TEST(Render, FilesHoldThePlanesOfTheChip) {
  const TestMesh mesh = make_torus(40, 24, 1.0f, 0.4f);
  const struct { std::uint32_t width, height; } sizes[] = {{96, 64}, {33, 17}, {1, 1}, {1, 300}, {300, 1}};
  for (const auto& size : sizes) {
    const TemporaryFolder folder("a.ply", mesh);
    const std::string text = std::to_string(size.width) + "x" + std::to_string(size.height);
    (void)render(folder, {"a.ply", "-o", "a.png", "--depth", "d.pfm", "--ids", "i.pfm", "--size", text});
    const RenderedFrame expected = expected_frame(mesh, size.width, size.height);
    ASSERT_EQ(expected.result.status, Status::kOk);

    const auto color = load_picture(folder.path("a.png"));
    const auto depth = load_picture(folder.path("d.pfm"));
    const auto ids = load_picture(folder.path("i.pfm"));
    ASSERT_TRUE(color && depth && ids) << text;
    for (const Picture* picture : {&*color, &*depth, &*ids}) {
      ASSERT_EQ(picture->width, size.width) << text;
      ASSERT_EQ(picture->height, size.height) << text;
    }
    for (std::size_t i = 0; i < expected.planes.color.size(); ++i) {
      for (std::uint32_t channel = 0; channel < 4; ++channel) {
        ASSERT_EQ(color->values[4 * i + channel], static_cast<float>(expected.planes.color[i] >> (8 * channel) & 0xFFu))
            << text << ", pixel " << i;
      }
      const bool is_hit = expected.planes.ids[i] != kNoTriangle;
      ASSERT_EQ(ids->values[i], is_hit ? static_cast<float>(expected.planes.ids[i]) : -1.0f) << text << ", pixel " << i;
      ASSERT_EQ(depth->values[i], is_hit ? expected.planes.depth[i] : INFINITY) << text << ", pixel " << i;
    }
  }
}

TEST(Render, TheDefaultPictureIsNamedAfterTheInput) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.path("scenes"));
  folder.write_ply("scenes/tetra.box.ply", make_box(Vec3(0), Vec3(1)));
  (void)render(folder, {"scenes/tetra.box.ply", "--size", "8x8"});
  EXPECT_EQ(folder.names(), (Words{"scenes", "tetra.box.png"}));
}

TEST(Render, QuietPrintsNothing) {
  const TemporaryFolder folder("a.ply", make_box(Vec3(0), Vec3(1)));
  const ProgramResult quiet = render(folder, {"a.ply", "--size", "8x8", "--quiet"});
  EXPECT_EQ(quiet.out + quiet.err, "");
  const ProgramResult loud = render(folder, {"a.ply", "--size", "8x8"});
  EXPECT_NE(loud.out.find("hash "), std::string::npos) << loud.out;
  EXPECT_EQ(loud.err, "") << "no progress bar where standard error is no terminal";
  EXPECT_NE(loud.out.find(" cycles, "), std::string::npos) << loud.out;
  const ProgramResult counted = render(folder, {"a.ply", "--size", "8x8", "--machine", "fu540"});
  EXPECT_NE(counted.out.find(" instructions\n"), std::string::npos) << counted.out;
  EXPECT_EQ(counted.out.find("cycles"), std::string::npos) << counted.out;
}

TEST(Render, SaysThatNoPixelShowsTheSceneAndWhy) {
  const TemporaryFolder folder("a.ply", make_torus(40, 24, 1.0f, 0.2f));
  folder.write("a.nff", "b 0 0 0\nl 0 0 9\nf 0 0 0 0 0 0 0 0\ns 0 0 0 1\n");  // black in front of black
  folder.write("sky.nff",
               "v from 0 0 9 at 0 0 0 up 0 1 0 angle 40 hither 0 resolution 8 8\n"
               "e " +
                   (kScenes / "sky_px.pfm").string() + " " + (kScenes / "sky_nx.pfm").string() + " " +
                   (kScenes / "sky_py.pfm").string() + " " + (kScenes / "sky_ny.pfm").string() + " " +
                   (kScenes / "sky_pz.pfm").string() + " " + (kScenes / "sky_nz.pfm").string() +
                   "\nl 0 0 9\nf 1 1 1 1 0 0 0 0\ns 0 0 0 1\n");
  const struct {
    Words view;
    std::string reason;
  } cases[] = {
      {{"a.ply", "--eye", "0,0,9", "--at", "0,0,20"}, "it lies behind the camera"},
      {{"a.ply", "--eye", "0,0,9", "--at", "-30,0,0"}, "it lies to the right of the picture"},
      {{"a.ply", "--eye", "0,0,9", "--at", "30,0,0"}, "it lies to the left of the picture"},
      {{"a.ply", "--eye", "0,0,9", "--at", "0,30,0"}, "it lies below the picture"},
      {{"a.ply", "--eye", "0,0,9", "--at", "0,-30,0", "--depth", "d.pfm"}, "it lies above the picture"},
      {{"a.ply", "--eye", "0,0,90000", "--at", "0,0,0"}, "it is smaller than a pixel"},
      {{"a.ply", "--eye", "0,9,0", "--at", "0,0,0", "--up", "z", "--fov", "1", "--ids", "i.pfm"},
       "all rays miss its triangles"},
      {{"a.ply", "--eye", "0,0,9", "--at", "0,0,20", "--mode", "plain"}, "it lies behind the camera"},
      {{"sky.nff", "--at", "0,0,20"}, "it lies behind the camera"},
      {{"sky.nff", "--at", "0,0,20", "--mode", "plain"}, "it lies behind the camera"},
      {{"sky.nff", "--eye", "30,0,0", "--at", "30,0,-9"}, "it lies to the left of the picture"},
      {{"a.nff", "--eye", "0,0,9", "--at", "0,0,20"}, "it lies behind the camera"},
      {{"a.ply"}, ""},
      {{"a.ply", "--tile", "0,0", "--size", "512x512"}, ""},
      {{"a.nff"}, ""},
      {{"a.nff", "--mode", "plain"}, ""},
      {{"sky.nff"}, ""},
  };
  for (const auto& tested : cases) {
    Words arguments = tested.view + Words{"-o", "a.png"};
    if (std::ranges::find(arguments, "--size") == arguments.end()) arguments = arguments + Words{"--size", "8x8"};
    const std::string expected =
        tested.reason.empty() ? "" : tested.view[0] + ": note: no pixel shows the scene: " + tested.reason + "\n";
    EXPECT_EQ(render(folder, arguments).err, expected) << &tested - cases;
    EXPECT_EQ(render(folder, arguments + Words{"--quiet"}).err, "") << &tested - cases;
  }
}

TEST(Render, AnySideAndUpShowTheWholeScene) {
  const TemporaryFolder folder("a.ply", make_random_soup(400, 0.15f, 11));
  std::set<std::string> pictures;
  for (const char* from : {"front", "back", "left", "right", "top", "bottom", "iso", "-20,75.5"}) {
    for (const char* up : {"y", "-z", "0.5,1,0"}) {
      (void)render(folder, {"a.ply", "-o", "a.png", "--ids", "i.pfm", "--size", "60x40", "--from", from, "--up", up});
      const auto ids = load_picture(folder.path("i.pfm"));
      ASSERT_TRUE(ids);
      std::uint32_t least = 40, most = 0;
      for (std::uint32_t i = 0; i < ids->values.size(); ++i) {
        const std::uint32_t x = i % 60, y = i / 60;
        if (ids->values[i] < 0) continue;
        EXPECT_TRUE(x >= 2 && x < 58 && y >= 1 && y < 39) << from << ", up " << up << ", pixel " << x << "," << y;
        least = std::min(least, y);
        most = std::max(most, y);
      }
      EXPECT_GE(most + 1 - least, 30u) << from << ", up " << up;
      pictures.insert(read_file(folder.path("a.png")));
    }
  }
  EXPECT_GE(pictures.size(), 20u) << "the top of y is the front of -z, and so on";
}

// All formats: the packed scene is framed as the mesh is that a frame stores so.
TEST(Render, APackedSceneIsSeenAsItsMesh) {
  const TemporaryFolder folder("a.ply", make_random_soup(400, 0.15f, 11));
  const struct {
    const char *accuracy, *format;
  } cases[] = {{"standard", "vertices"}, {"paper", "projection"}, {"compact", "lattice"}};
  for (const auto& tested : cases) {
    const Words frame = {"--accuracy", tested.accuracy, "--configuration", "reference", "--size", "60x40", "--up", "z"};
    (void)render(folder, Words{"a.ply", "-o", "a.png"} + frame);
    const ProgramResult packed = run_program(
        folder.folder(), {"pack", "a.ply", "-o", "a.gri", "--format", tested.format, "--configuration", "reference"});
    ASSERT_EQ(packed.exit_code, 0) << packed.err;
    (void)render(folder, Words{"a.gri", "-o", "b.png"} + frame);
    EXPECT_EQ(read_file(folder.path("a.png")), read_file(folder.path("b.png"))) << tested.format;
  }
}

TEST(Render, PlainModeReportsItsHost) {
  const TemporaryFolder folder("a.ply", make_torus(40, 24, 1.0f, 0.4f));
  const Json checked = render_report(folder, {"a.ply", "--size", "96x64"});
  EXPECT_EQ(checked["mode"], "checked");
  EXPECT_EQ(checked["host"]["lanes"], 4);
  EXPECT_EQ(checked["host"]["repeats"], 1);
  const Words plain[] = {{"--mode", "plain", "--lanes", "4"}, {"--mode", "plain", "--repeat", "3"}};
  for (const Words& options : plain) {
    const Json report = render_report(folder, Words{"a.ply", "--size", "96x64", "--threads", "2"} + options);
    EXPECT_EQ(report["mode"], "plain");
    EXPECT_EQ(report["image_hash"], checked["image_hash"]);
    EXPECT_EQ(report["scene"], checked["scene"]);
    EXPECT_EQ(report["host"]["threads"], 2);
    EXPECT_GE(report["host"]["lanes"], 4);
    EXPECT_EQ(report["host"]["repeats"], options.back() == "3" ? 3 : 1);
    for (const char* part : {"load", "build", "render"}) {
      EXPECT_GT(report["host"][std::string(part) + "_seconds"], 0) << part;
      EXPECT_GE(report["host"][std::string(part) + "_processor_seconds"], 0) << part;
    }
    for (const char* key : {"machine", "frame", "cores", "work"}) EXPECT_FALSE(report.contains(key)) << key;
  }
  const Json tile = render_report(folder, {"a.ply", "--size", "96x64", "--tile", "1,0"});
  EXPECT_FALSE(tile.contains("frame")) << "time is not told of one tile";
}

TEST(Render, RepeatedFramesAreTheSame) {
  const TemporaryFolder folder("a.ply", make_torus(40, 24, 1.0f, 0.4f));
  ASSERT_EQ(run_program(folder.folder(), {"pack", "a.ply", "-o", "a.gri", "--quiet"}).out, "");
  Json once = render_report(folder, {"a.ply", "--size", "96x64"});
  once.erase("host");
  for (const char* input : {"a.ply", "a.gri"}) {
    Json report = render_report(folder, {input, "--size", "96x64", "--repeat", "3"});
    EXPECT_EQ(report["host"]["repeats"], 3);
    report.erase("host");
    EXPECT_EQ(report, once) << input;
  }
  const ProgramResult loud = render(folder, {"a.ply", "--size", "96x64", "--repeat", "3"});
  EXPECT_NE(loud.out.find(", the least of 3\n"), std::string::npos) << loud.out;
}

TEST(Render, TheReportHoldsWhatWasRendered) {
  const TemporaryFolder folder;
  const TestMesh mesh = make_torus(40, 24, 1.0f, 0.4f);
  folder.write_ply("a.ply", mesh);
  const Json report =
      render_report(folder, with_reference({"a.ply", "-o", "a.png", "--size", "96x64", "--timeline", "t.json"}));
  EXPECT_EQ(report["configuration"], "reference");
  EXPECT_EQ(report["scene"]["triangles"], mesh.triangles.size());
  EXPECT_EQ(report["scene"]["grid"]["lambda"], 4.0);
  EXPECT_EQ(report["machine"]["name"], "cell-ps3");
  EXPECT_EQ(report["cores"].size(), 6u);
  EXPECT_GT(report["frame"]["cycles"], 0);
  EXPECT_EQ(report["effects"]["rays"]["primary"], 96 * 64);
  EXPECT_EQ(report["work"]["tile_start"], 6);
  EXPECT_EQ(report["local_store"]["arena_bytes"], 262144);
  EXPECT_EQ(report["image_hash"], tool::hash_text(tool::image_hash(expected_frame(mesh, 96, 64).planes.color)));
  const Json timeline = Json::parse(read_file(folder.path("t.json")), nullptr, false);
  EXPECT_GT(timeline["traceEvents"].size(), 6u);
}

// What the command line does not say is decided so that the frame can be rendered.
// The worst tile beside its bound for the camera, printed and in the report.
TEST(Render, BoundsTheTilesOfAView) {
  const TemporaryFolder folder("a.ply", make_torus(40, 30, 1.0f, 0.4f));
  for (const char* const store : {"64", "256"}) {
    const Words words = {"render", "a.ply", "--size", "150x100", "--store", store, "--report", "a.json"};
    const std::string out = run(folder, words + Words{"--bound"}).out;
    EXPECT_NE(out.find("\nworst tile: "), std::string::npos) << out;
    const Json report = Json::parse(read_file(folder.path("a.json")));
    const Json &measured = report["worst_tile"]["measured"], &bound = report["worst_tile"]["bound"];
    for (const char* const key : {"cycles", "gets", "get_bytes"}) {
      EXPECT_GT(measured[key], 0);
      EXPECT_LE(measured[key], bound[key]);
      EXPECT_LE(bound[key].get<double>(), 10 * measured[key].get<double>()) << key << ", " << store << " KB";
    }
    run(folder, words);
    EXPECT_FALSE(Json::parse(read_file(folder.path("a.json"))).contains("worst_tile"));
  }
  expect_failure(folder, {"render", "a.ply", "--bound", "--configuration", "grid"}, 2,
                 "--bound: tiles have no bound for a view with a configuration other than best");
  expect_failure(folder, {"render", "a.ply", "--bound", "--mode", "plain"}, 2, "--bound: is compared with the cycles");
}

TEST(Render, TheDefaultConfigurationIsTheBestThatCanRender) {
  const TemporaryFolder folder("a.ply", make_torus(40, 24, 1.0f, 0.4f));
  run(folder, with_reference({"pack", "a.ply", "-o", "reference.gri"}));
  run(folder, {"pack", "a.ply", "-o", "best.gri"});
  folder.write("board.machine", "based_on fu540\ncore_count 2\n");
  folder.write("small.machine", "based_on cell-ps3\nlocal_store_bytes 131072\n");
  const struct {
    Words frame;
    const char* configuration;
  } cases[] = {
      {{"a.ply"}, "best"},
      {{"best.gri"}, "best"},
      {{"a.ply", "--mode", "plain"}, "best"},
      {{"a.ply", "--accuracy", "exact", "--buffering", "single", "--depth", "d.pfm"}, "best"},
      {{"a.ply", "--accuracy", "compact"}, "best"},
      {{"a.ply", "--machine", "board.machine", "--mode", "plain"}, "best"},
      {{"a.ply", "--accuracy", "paper"}, "reference"},
      {{"reference.gri"}, "grid"},
      {{"a.ply", "--store", "64"}, "best"},
      {{"a.ply", "--store", "128"}, "best"},
      {{"a.ply", "--machine", "small.machine"}, "best"},
      {{"a.ply", "--machine", "board.machine"}, "grid"},
  };
  const std::string hash =
      tool::hash_text(tool::image_hash(expected_frame(make_torus(40, 24, 1.0f, 0.4f), 96, 64).planes.color));
  for (const auto& each : cases) {
    const Json report = render_report(folder, each.frame + Words{"--size", "96x64", "-o", "a.png"});
    EXPECT_EQ(report["configuration"], each.configuration) << each.frame.back();
    const bool is_compact = each.frame.back() == "compact";
    EXPECT_EQ(report["image_hash"] == hash, !is_compact) << each.frame.back();
  }
}

// Everything but host times.
Json without_host(Json report) {
  report.erase("host");
  return report;
}

TEST(Render, OptionsOfTheHostChangeNothing) {
  const TemporaryFolder folder("a.ply", make_random_soup(400, 0.15f, 11));
  const Words scene = {"a.ply", "-o", "a.png", "--size", "100x70"};
  const Json reference = without_host(render_report(folder, scene + Words{"--threads", "1"}));
  const Words variants[] = {{"--threads", "3"},
                            {"--completion", "late"},
                            {"--completion", "random", "--seed", "5"},
                            {"--configuration", "best", "--machine", "cell-ps3"}};
  for (const Words& variant : variants) {
    EXPECT_EQ(without_host(render_report(folder, scene + variant)), reference) << variant[0] << " " << variant[1];
  }
  EXPECT_EQ(without_host(render_report(folder, with_reference(scene + Words{"--buffering", "double"}))),
            without_host(render_report(folder, with_reference(scene))));
}

TEST(Render, TechniquesChangeTheWorkAndNotThePicture) {
  const TemporaryFolder folder("a.ply", make_torus(60, 40, 1.0f, 0.3f));
  const Words scene = {"a.ply", "-o", "a.png", "--size", "100x70"};
  const Json reference = render_report(folder, with_reference(scene));
  const Words variants[] = {{"--no-mailbox"},
                            {"--no-culling"},
                            {"--no-empty-skip"},
                            {"--buffering", "single"},
                            {"--configuration", "deep"},
                            {"--configuration", "best"},
                            {"--configuration", "best", "--buffering", "single"},
                            {"--packet", "4"},
                            {"--packet", "16"},
                            {"--store", "64"},
                            {"--store", "128", "--configuration", "grid"},
                            {"--tile-width", "8"},
                            {"--tile-width", "64", "--configuration", "grid"},
                            {"--lambda", "1"},
                            {"--macro-width", "4"},
                            {"--cores", "2"},
                            {"--machine", "cell-2006"}};
  for (const Words& variant : variants) {
    const Json report = render_report(folder, with_reference(scene + variant));
    EXPECT_EQ(report["image_hash"], reference["image_hash"]) << variant[0];
    EXPECT_NE(report["frame"]["cycles"], reference["frame"]["cycles"]) << variant[0];
  }
  EXPECT_EQ(render_report(folder, with_reference(scene + Words{"--no-mailbox"}))["work"]["mailbox_probe"], 0);
  EXPECT_EQ(render_report(folder, with_reference(scene + Words{"--no-culling"}))["work"]["cull_test"], 0);
  EXPECT_EQ(render_report(folder, with_reference(scene + Words{"--cores", "2"}))["cores"].size(), 2u);
  EXPECT_EQ(render_report(folder, with_reference(scene + Words{"--store", "64"}))["local_store"]["arena_bytes"], 65536);
  EXPECT_EQ(render_report(folder, with_reference(scene + Words{"--store", "128"}))["local_store"]["arena_bytes"],
            131072);
  folder.write("big.machine", "based_on cell-ps3\nlocal_store_bytes 600000\n");
  const Words big = scene + Words{"--machine", "big.machine"};
  EXPECT_EQ(render_report(folder, with_reference(big))["local_store"]["arena_bytes"], 524288)
      << "the largest that there is room for";
  EXPECT_EQ(render_report(folder, with_reference(big + Words{"--packet", "4"}))["local_store"]["arena_bytes"], 262144)
      << "the largest that is built for what was asked";
  const Json paper = render_report(folder, with_reference(scene + Words{"--accuracy", "paper"}));
  EXPECT_EQ(paper["work"]["group_test_standard"], 0);
  EXPECT_GT(paper["work"]["group_test_paper"], 0);
  const Json flat = render_report(folder, with_reference(scene + Words{"--shading", "none"}));
  EXPECT_NE(flat["image_hash"], reference["image_hash"]);
  EXPECT_EQ(flat["work"]["shaded_simple_group"], 0);
}

// Cycles that all cores wait at one level.
double wait_cycles(const Json& report, const char* level) {
  double cycles = 0;
  for (const Json& core : report["cores"]) cycles += core["dma_wait_cycles"][level].get<double>();
  return cycles;
}

TEST(Render, BufferingHidesWaitsAtEachLevel) {
  const TemporaryFolder folder("a.ply", make_torus(60, 40, 1.0f, 0.3f));
  const Words scene = {"a.ply", "-o", "a.png", "--size", "200x200", "--cores", "1"};
  const Json twice = render_report(folder, with_reference(scene));
  const Json once = render_report(folder, with_reference(scene + Words{"--buffering", "single"}));
  const Json deep = render_report(folder, with_reference(scene + Words{"--configuration", "deep"}));
  for (const char* level : {"tile", "macrocell", "triangle"}) {
    EXPECT_LT(wait_cycles(twice, level), wait_cycles(once, level)) << level;
  }
  EXPECT_LT(wait_cycles(deep, "triangle"), 0.5 * wait_cycles(twice, "triangle"));
  const Json both =
      render_report(folder, with_reference(scene + Words{"--configuration", "deep", "--buffering", "single"}));
  EXPECT_EQ(both["frame"], once["frame"]) << "--buffering replaces what the configuration says";
}

TEST(Render, ModesAndLanesMakeTheSamePicture) {
  const TemporaryFolder folder("a.ply", make_random_soup(400, 0.15f, 13));
  const Words scene = {"a.ply", "-o", "a.png", "--size", "50x40"};
  (void)render(folder, scene);
  const std::string reference = read_file(folder.path("a.png"));
  std::vector<Words> variants = {{"--mode", "plain"}, {"--mode", "plain", "--lanes", "4"}};
  if (sim::has_instrumented_mode()) variants.push_back({"--mode", "instrumented"});
  for (std::uint32_t lanes = 8; lanes <= sim::widest_lanes(); lanes *= 2) {
    variants.push_back({"--lanes", std::to_string(lanes)});
  }
  for (const Words& variant : variants) {
    std::filesystem::remove(folder.path("a.png"));
    (void)render(folder, scene + variant);
    EXPECT_EQ(read_file(folder.path("a.png")), reference) << variant[0] << " " << variant[1];
  }
}

TEST(Render, OneTileIsThatPartOfThePicture) {
  const TemporaryFolder folder("a.ply", make_torus(40, 24, 1.0f, 0.4f));
  const Words scene = with_reference({"a.ply", "--size", "100x70"});
  (void)render(folder, scene + Words{"-o", "a.png", "--depth", "a.pfm"});
  (void)render(folder, scene + Words{"-o", "b.png", "--depth", "b.pfm", "--tile", "3,1"});
  for (const char* extension : {".png", ".pfm"}) {
    const auto whole = load_picture(folder.path(std::string("a") + extension));
    const auto tile = load_picture(folder.path(std::string("b") + extension));
    ASSERT_TRUE(whole && tile);
    // Columns 96 to 99 of the picture, rows 32 to 63.
    ASSERT_EQ(tile->width, 4u);
    ASSERT_EQ(tile->height, 32u);
    for (std::uint32_t y = 0; y < 32; ++y) {
      for (std::uint32_t i = 0; i < 4 * tile->channels; ++i) {
        ASSERT_EQ(tile->values[y * 4 * tile->channels + i], whole->values[((y + 32) * 100 + 96) * tile->channels + i]);
      }
    }
  }
}

// A tile of best has 64 pixels along its edge.
TEST(Render, OneTileOfBestIsThatPartOfThePicture) {
  const TemporaryFolder folder("a.ply", make_torus(40, 24, 1.0f, 0.4f));
  const Words scene = {"a.ply", "--size", "100x70"};
  (void)render(folder, scene + Words{"-o", "a.png"});
  (void)render(folder, scene + Words{"-o", "b.png", "--tile", "1,0"});
  const auto whole = load_picture(folder.path("a.png")), tile = load_picture(folder.path("b.png"));
  ASSERT_TRUE(whole && tile);
  ASSERT_EQ(tile->width, 36u);
  ASSERT_EQ(tile->height, 64u);
  for (std::uint32_t y = 0; y < 64; ++y) {
    for (std::uint32_t i = 0; i < 36 * tile->channels; ++i) {
      ASSERT_EQ(tile->values[y * 36 * tile->channels + i], whole->values[(y * 100 + 64) * tile->channels + i]);
    }
  }
}

TEST(Render, ACameraFileIsAView) {
  const TemporaryFolder folder("a.ply", make_torus(40, 24, 1.0f, 0.4f));
  folder.write("a.camera", "eye -1 2 3\nat 0 0.5 0\nup 0 0 1\nfov 30\n");
  const Words scene = {"a.ply", "-o", "a.png", "--size", "64x48"};
  const Words spelled = {"--eye", "-1,2,3", "--at", "0,0.5,0", "--up", "0,0,1"};
  const Json framed = render_report(folder, scene);
  const Json from_file = render_report(folder, scene + Words{"--camera", "a.camera"});
  EXPECT_NE(from_file["image_hash"], framed["image_hash"]);
  EXPECT_EQ(render_report(folder, scene + spelled + Words{"--fov", "30"})["image_hash"], from_file["image_hash"]);
  EXPECT_EQ(render_report(folder, scene + Words{"--camera", "a.camera", "--fov", "40"})["image_hash"],
            render_report(folder, scene + spelled + Words{"--fov", "40"})["image_hash"]);
}

TEST(Render, ReducesLambdaToFitTheMachineAndSaysSo) {
  // Large triangles in many cells: far more references than the 256 MB of cell-ps3 hold at lambda 4.
  const TemporaryFolder folder("a.ply", make_random_soup(30000, 3.0f, 14));
  const Words scene = with_reference({"a.ply", "-o", "a.png", "--size", "8x8"});
  const ProgramResult result = run_program(folder.folder(), Words{"render"} + scene + Words{"--report", "r.json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err.find("a.ply: lambda reduced from 4 to "), 0u) << result.err;
  const Json grid = Json::parse(read_file(folder.path("r.json")))["scene"]["grid"];
  EXPECT_EQ(grid["wanted_lambda"], 4.0);
  EXPECT_LT(grid["lambda"], 4.0);
  EXPECT_LT(grid["bytes"], std::uint64_t{256} << 20);

  expect_failure(folder, Words{"render"} + scene + Words{"--lambda", "4"}, 1, "cell-ps3 has");
}

}  // namespace
}  // namespace gridiron::test
