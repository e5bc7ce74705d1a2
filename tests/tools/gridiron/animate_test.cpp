// animate: a picture and a row for each mesh, builds included. SPDX-License-Identifier: Apache-2.0
#include <gridiron/build/grid/grid_builder.h>
#include <gridiron/sim/build_work.h>

#include <nlohmann/json.hpp>

#include "gridiron/scene/scene_points.h"
#include "gridiron/scene/view.h"
#include "run_program.h"
#include "temporary_folder.h"

namespace gridiron::test {
namespace {

using Json = nlohmann::json;
using Row = std::map<std::string, std::string>;

std::vector<Row> read_table(const std::filesystem::path& path) {
  std::istringstream text(read_file(path));
  const auto fields = [](const std::string& line) {
    std::vector<std::string> parts;
    std::istringstream stream(line);
    for (std::string part; std::getline(stream, part, ',');) parts.push_back(part);
    return parts;
  };
  std::string line;
  std::getline(text, line);
  const std::vector<std::string> names = fields(line);
  std::vector<Row> rows;
  while (std::getline(text, line)) {
    const std::vector<std::string> values = fields(line);
    EXPECT_EQ(values.size(), names.size()) << line;
    Row row;
    for (std::size_t i = 0; i < std::min(names.size(), values.size()); ++i) row[names[i]] = values[i];
    rows.push_back(row);
  }
  return rows;
}

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
  const struct {
    Words arguments;
    int exit_code;
    const char* words;
  } cases[] = {
      {{"nowhere.ply", "-o", "out"}, 1, "nowhere.ply: No such file"},
      {{"empty", "-o", "out"}, 1, "empty: holds no file that ends with .ply"},
      {{"a.nff", "-o", "out"}, 1, "a.nff: is a text scene; animate takes PLY meshes"},
      {{"a.ply", "twin", "-o", "out"}, 2, "two frames would be called a.png"},
      {{"a.ply", "bad.ply", "-o", "out"}, 1, "bad.ply:3: "},
      {{"a.ply", "-o", "no/where"}, 1, "no/where: cannot make the folder: No such file"},
      {{"a.ply", "-o", "a.nff"}, 1, "a.nff: cannot make the folder: a file of that name is there\n"},
      {{"a.ply", "-o", "link"}, 1, "link: cannot make the folder: it is a link to 'nowhere', which is not there\n"},
      {{"a.png", "-o", "out"}, 1, "a.png: is a PNG picture; animate takes PLY meshes and folders of .ply files\n"},
      {{"nested", "-o", "out"}, 1, "nested/b.ply: is a folder; animate takes PLY meshes and folders of .ply files\n"},
  };
  for (const auto& bad : cases) expect_failure(folder, Words{"animate"} + bad.arguments, bad.exit_code, bad.words);
}

}  // namespace
}  // namespace gridiron::test
