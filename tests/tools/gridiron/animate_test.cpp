// animate: a picture and a row for each mesh, builds included. SPDX-License-Identifier: Apache-2.0
#include <gridiron/build/grid/grid_builder.h>
#include <gridiron/sim/build_work.h>

#include <nlohmann/json.hpp>

#include "animation_table.h"
#include "gridiron/scene/scene_points.h"
#include "gridiron/scene/view.h"
#include "run_program.h"
#include "temporary_folder.h"

namespace gridiron::test {
namespace {

using Json = nlohmann::json;
ProgramResult animate(const TemporaryFolder& folder, const Words& arguments) {
  return run(folder, Words{"animate"} + arguments);
}

TEST(Animate, APictureAndARowForEachMesh) {
  const TemporaryFolder folder;
  const TestMesh ball = make_sphere(10, 14, 1.0f);
  std::filesystem::create_directory(folder.path("in"));
  folder.write_ply("in/b.ply", moved(ball, 1.0f, Vec3(2, 0, 0)));
  folder.write_ply("in/a.ply", ball);
  folder.write("in/notes.txt", "no mesh\n");
  folder.write_ply("last.ply", make_torus(24, 16, 1.0f, 0.4f));
  const ProgramResult result =
      animate(folder, with_reference({"in", "last.ply", "-o", "out", "--size", "40x24", "--cores", "2"}));
  EXPECT_NE(result.out.find("2 cores: 3 frames in "), std::string::npos) << result.out;
  EXPECT_NE(result.out.find(" frames/s with their builds\n"), std::string::npos) << result.out;
  const std::vector<Row> rows = read_table(folder.path("out/animation.csv"));
  ASSERT_EQ(rows.size(), 3u);
  const char* const names[] = {"a", "b", "last"};
  for (std::size_t i = 0; i < 3; ++i) {
    Row row = rows[i];
    EXPECT_EQ(row["frame"], std::to_string(i));
    EXPECT_EQ(row["mesh"], std::string(names[i]) + ".ply") << "folders by name";
    EXPECT_EQ(read_file(folder.path("out/" + std::string(names[i]) + ".png")).substr(1, 3), "PNG");
    const double seconds = std::stod(row["build_seconds"]) + std::stod(row["render_seconds"]);
    EXPECT_DOUBLE_EQ(std::stod(row["seconds"]), seconds);
    EXPECT_DOUBLE_EQ(std::stod(row["fps"]), 1 / seconds);
    EXPECT_NEAR(std::stod(row["total_cycles"]), std::stod(row["build_cycles"]) + std::stod(row["render_cycles"]), 1.0)
        << "clocks of this machine are the same";
  }
  EXPECT_NE(rows[0].at("hash"), rows[1].at("hash"));
  EXPECT_EQ(rows[0].at("triangles"), std::to_string(ball.triangles.size()));
}

// The same numbers as of one frame alone, seen from where all of them are seen.
TEST(Animate, FramesAreThoseOfRender) {
  const TemporaryFolder folder;
  const TestMesh first = make_sphere(10, 14, 1.0f), second = moved(first, 1.0f, Vec3(3, 1, 0));
  folder.write_ply("a.ply", first);
  folder.write_ply("b.ply", second);
  const TestMesh both = joined(first, second);
  folder.write_ply("both.ply", both);
  const auto common = [](const char* input) {
    return with_reference({"render", input, "--size", "48x32", "--report", "r.json", "-o", "a.png"});
  };
  (void)animate(folder, with_reference({"a.ply", "b.ply", "-o", "out", "--size", "48x32"}));
  const std::vector<Row> rows = read_table(folder.path("out/animation.csv"));
  ASSERT_EQ(rows.size(), 2u);

  // The view that frames both at once, as the report of a frame of both tells it: by its picture of one of them.
  const Camera camera = tool::complete_view(
      {}, 1.5, [&both](const tool::PointVisitor& visitor) { tool::visit_points(both.view(), visitor); });
  GridNeed need{};
  const auto text_of = [](const Vec3& v) {
    char text[96];
    std::snprintf(text, sizeof text, "%.9g,%.9g,%.9g", double(v.x), double(v.y), double(v.z));
    return std::string(text);
  };
  for (std::size_t i = 0; i < 2; ++i) {
    const Words view = {"--eye", text_of(camera.eye), "--at", text_of(camera.at)};
    const ProgramResult result = run(folder, common(i == 0 ? "a.ply" : "b.ply") + view);
    EXPECT_NE(result.out.find("hash " + rows[i].at("hash")), std::string::npos) << result.out;
    const Json report = Json::parse(read_file(folder.path("r.json")), nullptr, false);
    EXPECT_EQ(report["frame"]["cycles"].get<double>(), std::stod(rows[i].at("render_cycles")));

    const TestMesh& mesh = i == 0 ? first : second;
    ASSERT_EQ(count_scene_image(mesh.view(), {}, need), Status::kOk);
    const sim::BuildWork work =
        sim::grid_build_work(mesh.vertices.size(), mesh.triangles.size(), need, sim::count_mesh_lines(mesh.view()));
    EXPECT_EQ(sim::build_cycles(sim::machine_profiles().front().master, work), std::stod(rows[i].at("build_cycles")));
  }
}

// Nothing of the tree's build is counted, so nothing is said of it, and the sums are those of the frames alone.
TEST(Animate, BuildsThroughTheTreeAreNotCounted) {
  const TemporaryFolder folder("a.ply", make_sphere(10, 14, 1.0f));
  const Words frames = {"a.ply", "-o", "out", "--size", "48x32"};
  const ProgramResult result = animate(folder, frames);
  EXPECT_NE(result.out.find("  not counted"), std::string::npos) << result.out;
  EXPECT_NE(result.out.find(" frames/s without their builds; --configuration grid counts these too\n"),
            std::string::npos)
      << result.out;
  const Row row = read_table(folder.path("out/animation.csv")).at(0);
  EXPECT_EQ(row.at("build_cycles"), "");
  EXPECT_EQ(row.at("build_seconds"), "");
  EXPECT_EQ(row.at("seconds"), row.at("render_seconds"));
  EXPECT_EQ(std::stod(row.at("total_cycles")), std::stod(row.at("render_cycles")));
  EXPECT_DOUBLE_EQ(std::stod(row.at("fps")), 1 / std::stod(row.at("render_seconds")));
  (void)animate(folder, with_reference(frames));
  EXPECT_EQ(read_table(folder.path("out/animation.csv")).at(0).at("hash"), row.at("hash"));
}

constexpr const char* kSphere = "l 3 5 4\nf 0.9 0.5 0.3 0.7 0.3 40 0 0\ns 0 0 0 1\n";

std::string view_line(const char* eye, const char* size) {
  return std::string("v from ") + eye + " at 0 0 0 up 0 1 0 angle 30 hither 0 resolution " + size + "\n";
}

std::string hash_of_render(const TemporaryFolder& folder, const Words& arguments) {
  const std::string out = run(folder, Words{"render"} + arguments).out;
  return out.substr(out.find("hash ") + 5, 16);
}

// Effects and size too.
TEST(Animate, TextScenesHaveTheirOwnViews) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.path("in"));
  folder.write("in/a.nff", view_line("1 2 6", "40 24") + kSphere);
  folder.write("in/b.nff", view_line("-1 2 6", "40 24") + kSphere);
  EXPECT_EQ(animate(folder, {"in", "-o", "out"}).err, "");
  const std::vector<Row> rows = read_table(folder.path("out/animation.csv"));
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].at("hash"), hash_of_render(folder, {"in/a.nff"}));
  EXPECT_EQ(rows[1].at("hash"), hash_of_render(folder, {"in/b.nff"}));
  EXPECT_NE(rows[0].at("hash"), rows[1].at("hash"));
  EXPECT_EQ(rows[0].at("build_cycles"), "");
  (void)animate(folder, {"in", "-o", "out", "--eye", "0,3,5", "--tolerance", "0.1"});
  const Row seen = read_table(folder.path("out/animation.csv")).at(0);
  EXPECT_EQ(seen.at("hash"), hash_of_render(folder, {"in/a.nff", "--eye", "0,3,5", "--tolerance", "0.1"}));
  // The tree of effects is not counted, so a build of the grid alone would be too little.
  (void)animate(folder, {"in", "-o", "out", "--configuration", "grid"});
  EXPECT_EQ(read_table(folder.path("out/animation.csv")).at(0).at("build_cycles"), "");

  folder.write("in/b.nff", view_line("-1 2 6", "40 30") + kSphere);
  expect_failure(folder, {"animate", "in", "-o", "new"}, 1,
                 "in/b.nff: its picture has 40x30 pixels, those of other frames have 40x24; --size gives all frames");
  (void)animate(folder, {"in", "-o", "out", "--size", "16x16"});
}

TEST(Animate, ScenesWithoutViewsAreFramedTogether) {
  const TemporaryFolder folder("ball.ply", make_sphere(10, 14, 1.0f));
  folder.write("a.nff", "f 1 1 1 1 0 0 0 0\nm ball.ply\n");
  folder.write_ply("b.ply", moved(make_sphere(10, 14, 1.0f), 1.0f, Vec3(4, 0, 0)));
  const Words options = {"--size", "48x32", "--shading", "simple"};
  (void)animate(folder, Words{"ball.ply", "b.ply", "-o", "meshes"} + options);
  (void)animate(folder, Words{"a.nff", "b.ply", "-o", "mixed"} + options);
  const std::vector<Row> meshes = read_table(folder.path("meshes/animation.csv"));
  const std::vector<Row> mixed = read_table(folder.path("mixed/animation.csv"));
  for (std::size_t i = 0; i < 2; ++i) EXPECT_EQ(meshes.at(i).at("hash"), mixed.at(i).at("hash")) << i;
}

TEST(Animate, SaysWhichFrameShowsNothing) {
  const TemporaryFolder folder("a.ply", make_sphere(10, 14, 1.0f));
  folder.write_ply("b.ply", moved(make_sphere(10, 14, 1.0f), 1.0f, Vec3(0, 0, 40)));
  const Words common = {"animate", "a.ply", "b.ply", "-o", "out", "--size", "48x32"};
  EXPECT_EQ(run_program(folder.folder(), common + Words{"--eye", "0,0,9", "--at", "0,0,0"}).err,
            "b.ply: note: no pixel shows the scene: it lies behind the camera\n");
  EXPECT_EQ(run_program(folder.folder(), common).err, "") << "both frames are in the common view";
}

TEST(Animate, OptionsChangeCostOrPicture) {
  const TemporaryFolder folder("a.ply", make_sphere(20, 30, 1.0f));
  const auto row_of = [&folder](const Words& more) {
    const Words common = {"a.ply", "-o", "out", "--size", "64x64", "--quiet"};
    EXPECT_EQ(animate(folder, with_reference(common + more)).out, "");
    return read_table(folder.path("out/animation.csv")).at(0);
  };
  const Row usual = row_of({});
  const Row one_core = row_of({"--cores", "1"});
  EXPECT_GT(std::stod(one_core.at("render_cycles")), 2 * std::stod(usual.at("render_cycles")));
  EXPECT_EQ(one_core.at("build_cycles"), usual.at("build_cycles"));
  const Row coarse = row_of({"--lambda", "0.5"});
  EXPECT_EQ(coarse.at("lambda"), "0.5");
  EXPECT_LT(std::stod(coarse.at("build_cycles")), std::stod(usual.at("build_cycles")));
  EXPECT_EQ(coarse.at("hash"), usual.at("hash"));
  EXPECT_NE(row_of({"--configuration", "grid"}).at("render_cycles"), usual.at("render_cycles"));
  EXPECT_NE(row_of({"--fov", "30"}).at("hash"), usual.at("hash"));
  EXPECT_EQ(row_of({"--threads", "1"}), row_of({"--threads", "3"}));
}

TEST(Animate, WhatCannotBeDoneIsTold) {
  const TemporaryFolder folder("a.ply", make_sphere(8, 12, 1.0f));
  std::filesystem::create_directory(folder.path("empty"));
  std::filesystem::create_directory(folder.path("twin"));
  folder.write_ply("twin/a.ply", make_sphere(8, 12, 1.0f));
  folder.write("bad.ply", "ply\nformat ascii 1.0\nelement vertex many\n");
  folder.write("a.nff", "b 0 0 0\n");
  folder.write("a.png", "\x89PNG\r\n\x1a\n");
  std::filesystem::create_directories(folder.path("nested/b.ply"));
  std::filesystem::create_symlink("nowhere", folder.folder() / "link");
  const std::string takes = "; animate takes PLY meshes, text scenes (NFF), and folders of either\n";
  const struct {
    Words arguments;
    int exit_code;
    std::string words;
  } cases[] = {
      {{"nowhere.ply", "-o", "out"}, 1, "nowhere.ply: No such file"},
      {{"empty", "-o", "out"}, 1, "empty: holds no file that ends with .ply or .nff\n"},
      {{".", "-o", "out"}, 1, ".: holds files that end with .ply and with .nff; name the ones that are frames\n"},
      {{"a.ply", "twin", "-o", "out"}, 2, "two frames would be called a.png"},
      {{"a.ply", "bad.ply", "-o", "out"}, 1, "bad.ply:3: "},
      {{"a.ply", "-o", "no/where"}, 1, "no/where: cannot make the folder: No such file"},
      {{"a.ply", "-o", "a.nff"}, 1, "a.nff: cannot make the folder: a file of that name is there\n"},
      {{"a.ply", "-o", "link"}, 1, "link: cannot make the folder: it is a link to 'nowhere', which is not there\n"},
      {{"a.png", "-o", "out"}, 1, "a.png: is a PNG picture" + takes},
      {{"nested", "-o", "out"}, 1, "nested/b.ply: is a folder" + takes},
  };
  for (const auto& bad : cases) expect_failure(folder, Words{"animate"} + bad.arguments, bad.exit_code, bad.words);
}

}  // namespace
}  // namespace gridiron::test
