// animate with a camera that moves: each frame is that of render, and the scene is built once.
// SPDX-License-Identifier: Apache-2.0
#include "animation_table.h"
#include "gridiron/scene/camera_path.h"
#include "gridiron/scene/scene_points.h"
#include "run_program.h"
#include "temporary_folder.h"

namespace gridiron::test {
namespace {

const Words kSize = {"--size", "48x32"};

std::string text_of(const Vec3& v, const char* separator) {
  char text[96];
  std::snprintf(text, sizeof text, "%.9g%s%.9g%s%.9g", double(v.x), separator, double(v.y), separator, double(v.z));
  return text;
}

// Compares each frame's hash and cycles with a render from its view.
void expect_renders(const TemporaryFolder& folder, const std::string& table, const Words& render,
                    const std::vector<tool::ViewRequest>& views) {
  const std::vector<Row> rows = read_table(folder.path(table));
  ASSERT_EQ(rows.size(), views.size());
  for (std::size_t i = 0; i < views.size(); ++i) {
    char fov[32];
    std::snprintf(fov, sizeof fov, "%.9g", double(*views[i].fov_degrees));
    const Words view = {"--eye", text_of(*views[i].eye, ","), "--at",  text_of(*views[i].at, ","),
                        "--up",  text_of(*views[i].up, ","),  "--fov", fov};
    const ProgramResult result = run(folder, render + view + Words{"-o", "one.png", "--timeline", "t.json"});
    EXPECT_NE(result.out.find("hash " + rows[i].at("hash")), std::string::npos) << i << "\n" << result.out;
    EXPECT_EQ(rows[i].at("build_cycles"), "0");
    EXPECT_EQ(rows[i].at("build_seconds"), "0");
    EXPECT_EQ(rows[i].at("seconds"), rows[i].at("render_seconds"));
    char picture[32];
    std::snprintf(picture, sizeof picture, "out/frame%04zu.png", i);
    EXPECT_EQ(read_file(folder.path(picture)), read_file(folder.path("one.png")));
  }
}

TEST(CameraMove, ATurntableGoesAroundAMesh) {
  const TemporaryFolder folder;
  const TestMesh mesh = moved(make_torus(24, 16, 1.0f, 0.4f), 1.0f, Vec3(2, 0, 0));
  folder.write_ply("a.ply", mesh);
  const std::vector<tool::ViewRequest> views = tool::views_of_turntable(
      {.eye = {}, .at = {}, .up = Vec3(0, 0, 1), .fov_degrees = {}}, 3, 1.5,
      [&mesh](const tool::PointVisitor& visitor) { tool::visit_points(mesh.view(), visitor); });
  const Words turn = Words{"animate", "a.ply", "-o", "out", "--turntable", "3", "--up", "z"} + kSize;
  const Words render = Words{"render", "a.ply"} + kSize;
  ProgramResult result = run(folder, turn);
  EXPECT_NE(result.out.find(" cycles of the cores, and nothing per frame\n"),
            std::string::npos)
      << result.out;
  expect_renders(folder, "out/animation.csv", render, views);
  result = run(folder, turn + Words{"--build", "master"});
  EXPECT_NE(result.out.find("the tree is built once, in "), std::string::npos) << result.out;
  EXPECT_NE(result.out.find(" cycles of the general core, and nothing per frame\n"), std::string::npos);

  result = run(folder, with_reference(turn));
  EXPECT_NE(result.out.find("the grid is built once, in "), std::string::npos) << result.out;
  EXPECT_NE(result.out.find(" cycles of the general core, and nothing per frame\n"), std::string::npos);
  expect_renders(folder, "out/animation.csv", with_reference(render), views);

  const std::string table = read_file(folder.path("out/animation.csv"));
  (void)run(folder, {"pack", "a.ply", "-o", "a.ply.gri", "--configuration", "reference"});
  std::filesystem::rename(folder.path("a.ply.gri"), folder.path("a.ply"));  // what a file holds counts
  result = run(folder, with_reference(turn));
  EXPECT_NE(result.out.find("; the camera alone moves, nothing is built\n"), std::string::npos) << result.out;
  EXPECT_EQ(read_file(folder.path("out/animation.csv")), table);
}

TEST(CameraMove, APathLeadsThroughATextScene) {
  const TemporaryFolder folder;
  folder.write(
      "a.nff",
      "v from 1 2 6 at 0 0 0 up 0 1 0 angle 30 hither 5.5 resolution 40 24\nl 3 5 4\nf 0.9 0.5 0.3 0.7 0.3 40 0 "
      "0\ns 0 0 0 1\ns 1 1 0 0.4\n");
  folder.write("a.path", "frame 0\neye 0 1 6\nat 0 0 0\nframe 3\neye 5 1 3\nfov 30\n");
  const std::vector<tool::ViewRequest> views = tool::views_of_path(tool::read_camera_path(folder.path("a.path")), {});
  EXPECT_EQ(run(folder, {"animate", "a.nff", "-o", "out", "--path", "a.path"}).err, "");
  expect_renders(folder, "out/animation.csv", {"render", "a.nff"}, views);
}

TEST(CameraMove, NotesNameTheFrame) {
  const TemporaryFolder folder("a.ply", make_sphere(10, 14, 1.0f));
  folder.write("a.path", "frame 0\neye 0 0 6\nat 0 0 0\nframe 1\ndirection 0 0 1\nframe 2\neye 0 0 6.1\n");
  const Words path = Words{"animate", "a.ply", "-o", "out", "--path", "a.path"} + kSize;
  EXPECT_EQ(run(folder, path).err,
            "a.ply: note: frame 1: no pixel shows the scene: it lies behind the camera\n"
            "a.ply: note: frame 2: no pixel shows the scene: it lies behind the camera\n");
  EXPECT_EQ(run(folder, path + Words{"--quiet"}).err, "");
}

// One configuration renders all frames, so that their cycles can be compared.
TEST(CameraMove, AViewWithoutBoundsIsRenderedByTheGridAndSoAreAllOthers) {
  const TemporaryFolder folder("a.ply", make_sphere(10, 14, 1.0f));
  folder.write("a.path", "frame 0\neye 3 2 6\nat 0 0.5 0\nframe 1\nfov 0.001\n");
  const ProgramResult result =
      run(folder, Words{"animate", "a.ply", "-o", "out", "--path", "a.path", "--store", "64"} + kSize);
  EXPECT_NE(result.err.find("a.ply: pixels too small"), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("rendered by grid\n"), std::string::npos) << result.err;
  EXPECT_EQ(read_table(folder.path("out/animation.csv")).at(0).at("lambda"), "0.4");
}

TEST(CameraMove, WhatCannotBeDoneIsTold) {
  const TemporaryFolder folder("a.ply", make_sphere(8, 12, 1.0f));
  folder.write("a.path", "frame 0\neye 0 0 6\nat 0 0 0\nframe 4\neye 0 0 -6\n");
  folder.write("bad.path", "frame 0\neye 0 0 6\nat 0 0 0\nframe 4\neye 0 0\n");
  folder.write("a.camera", "eye 0 0 6\nat 0 0 0\n");
  const struct {
    Words arguments;
    int exit_code;
    const char* words;
  } cases[] = {
      {{"a.ply", "--path", "a.path", "--turntable", "3"}, 2, "--path and --turntable: both move the camera"},
      {{"a.ply", "--path", "a.path", "--camera", "a.camera"}, 2, "--path and --camera: both are views"},
      {{"a.ply", "--path", "a.path", "--from", "top"}, 2, "--path and --from: both say where the eye is"},
      {{"a.ply", "a.ply", "--path", "a.path"}, 2, "--path: moves the camera around one mesh or scene; these are 2"},
      {{"a.ply", "--turntable", "0"}, 2, "a whole number from 1 to 1000000"},
      {{"a.ply", "--path", "bad.path"}, 1, "bad.path:5: 'eye' takes 3 numbers, not 2"},
      {{"a.ply", "--path", "nowhere"}, 1, "nowhere: No such file"},
      {{"a.ply", "--path", "a.ply"}, 1, "a.ply: is a PLY mesh; expected a camera path"},
      {{"a.ply", "--path", "a.path"}, 1, "a.path:1: frame 2, between this key and the next: eye and at are the same"},
      {{"nowhere.ply", "--turntable", "3"}, 1, "nowhere.ply: No such file"},
      {{"a.camera", "--turntable", "3"}, 1, "a.camera: "},
  };
  for (const auto& bad : cases) {
    expect_failure(folder, Words{"animate", "-o", "out"} + bad.arguments, bad.exit_code, bad.words);
  }
}

}  // namespace
}  // namespace gridiron::test
