// animate: a picture and a row for each mesh, builds included. SPDX-License-Identifier: Apache-2.0
#include <gridiron/build/grid/grid_builder.h>
#include <gridiron/image/scene_image.h>
#include <gridiron/sim/build_work.h>
#include <gridiron/sim/tree_build_work.h>

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

TEST(Animate, BuildsOfTreesByTheMasterAreCounted) {
  const TestMesh mesh = make_sphere(10, 14, 1.0f);
  const TemporaryFolder folder("a.ply", mesh);
  const Words frames = {"a.ply", "-o", "out", "--size", "48x32", "--build", "master"};
  const ProgramResult result = animate(folder, frames);
  EXPECT_EQ(result.out.find("not counted"), std::string::npos) << result.out;
  EXPECT_NE(result.out.find(" frames/s with their builds\n"), std::string::npos) << result.out;
  const Row row = read_table(folder.path("out/animation.csv")).at(0);
  EXPECT_EQ(row.at("builder"), "master");
  // The image, as prepare builds it.
  const GridParameters parameters{.leaf_triangles = 16, .has_tree = true, .has_grid = false};
  GridNeed need{};
  ASSERT_EQ(count_scene_image(mesh.view(), parameters, need), Status::kOk);
  struct alignas(kLineBytes) Line {
    std::byte bytes[kLineBytes];
  };
  std::vector<Line> image(need.image_bytes / kLineBytes), scratch(need.scratch_bytes / kLineBytes + 1);
  const std::span bytes = std::as_writable_bytes(std::span(image));
  ASSERT_EQ(build_scene_image(mesh.view(), parameters, need, bytes, std::as_writable_bytes(std::span(scratch))),
            Status::kOk);
  SceneImageView view{};
  SceneImageError error;
  ASSERT_EQ(open_scene_image(bytes, view, error), Status::kOk);
  const auto* const nodes = reinterpret_cast<const TreeNode*>(bytes.data() + view.tree.nodes_offset_bytes);
  const sim::BuildWork work =
      sim::tree_image_work(mesh.view(),
                           {parameters.leaf_triangles, TreeOrder::kByNumber, {nodes, view.tree.node_count}},
                           view.header.image_bytes, sim::count_mesh_lines(mesh.view()));
  EXPECT_EQ(sim::build_cycles(sim::machine_profiles().front().master, work), std::stod(row.at("build_cycles")));
  EXPECT_NEAR(std::stod(row.at("seconds")), std::stod(row.at("build_seconds")) + std::stod(row.at("render_seconds")),
              1e-12);
  (void)animate(folder, with_reference(frames));
  EXPECT_EQ(read_table(folder.path("out/animation.csv")).at(0).at("hash"), row.at("hash"));
}

double number(const Row& row, const char* column) {
  return std::stod(row.at(column));
}

// The picture of a tree that the cores have built is that of prepare's, and takes as long; before it come the passes.
TEST(Animate, CoresBuildTheTreeOfEachFrame) {
  const TemporaryFolder folder;
  const TestMesh first = make_torus(70, 60, 1.0f, 0.4f);
  folder.write_ply("a.ply", first);
  folder.write_ply("b.ply", moved(first, 1.0f, Vec3(0.5f, 0, 0)));
  folder.write_ply("c.ply", make_sphere(30, 40, 1.0f));
  const Words frames = {"a.ply", "b.ply", "c.ply", "-o", "out", "--size", "64x48", "--cores", "3"};
  (void)animate(folder, frames + Words{"--build", "master"});
  const std::vector<Row> of_master = read_table(folder.path("out/animation.csv"));
  EXPECT_FALSE(std::filesystem::exists(folder.path("out/animation_passes.csv")));
  (void)animate(folder, frames + Words{"--keep-vertex-order"});
  const std::vector<Row> in_order = read_table(folder.path("out/animation.csv"));
  const ProgramResult result = animate(folder, frames + Words{"--build", "cores"});
  EXPECT_NE(result.out.find(" frames/s with their builds by the cores\n"), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("\nsubtrees "), std::string::npos) << result.out;
  const std::vector<Row> rows = read_table(folder.path("out/animation.csv"));
  const std::vector<Row> passes = read_table(folder.path("out/animation_passes.csv"));
  ASSERT_EQ(rows.size(), 3u);
  ASSERT_EQ(passes.size(), 3u * 12);
  const std::string names[] = {"bounds", "codes", "buckets", "cuts", "sort", "top", "subtrees", "join",
                               "numbers", "check", "check_value", "picture"};
  for (std::size_t i = 0; i < 3; ++i) {
    const Row& row = rows[i];
    EXPECT_EQ(row.at("hash"), of_master[i].at("hash"));
    EXPECT_EQ(row.at("render_cycles"), of_master[i].at("render_cycles"));
    EXPECT_EQ(row.at("builder"), "cores");
    EXPECT_EQ(of_master[i].at("builder"), "master");
    EXPECT_GT(number(of_master[i], "build_cycles"), 2 * number(row, "build_cycles"));
    EXPECT_EQ(row.at("hash"), in_order[i].at("hash"));
    double cycles = 0;
    for (std::size_t k = 0; k < 12; ++k) {
      const Row& pass = passes[12 * i + k];
      EXPECT_EQ(pass.at("frame"), std::to_string(i));
      EXPECT_EQ(pass.at("pass"), names[k]);
      EXPECT_NEAR(number(pass, "begin_cycles"), cycles, 0.01) << names[k];
      EXPECT_NEAR(number(pass, "cycles"),
                  number(pass, "start_cycles") + number(pass, "run_cycles") + number(pass, "barrier_cycles"), 0.01);
      const bool is_of_master = names[k] == "check_value";
      EXPECT_EQ(pass.at("binding") == "general_core", is_of_master);
      EXPECT_EQ(number(pass, "start_cycles"), is_of_master ? 0 : 500);
      EXPECT_GT(number(pass, "run_cycles"), 0);
      const bool is_alone = is_of_master || pass.at("items") == "1";
      EXPECT_EQ(number(pass, "one_core_cycles"), is_alone ? number(pass, "cycles") : 0) << names[k];
      cycles += number(pass, "cycles");
    }
    EXPECT_EQ(passes[12 * i + 7].at("items"), "1");
    EXPECT_NEAR(number(row, "total_cycles"), cycles, 0.01) << "nothing overlaps";
    EXPECT_NEAR(number(row, "build_cycles") + number(row, "render_cycles"), cycles, 0.01);
    EXPECT_NEAR(number(row, "fps") * cycles, 3.2e9, 1);
  }
  EXPECT_NE(rows[0].at("hash"), rows[1].at("hash"));
}

// Vertices in any order cost the same once they are in theirs; b.ply has the triangles of a.ply.
TEST(Animate, PutsVerticesInOrderOnce) {
  TestMesh mesh = make_torus(90, 80, 1.0f, 0.4f);
  TestMesh mixed = mesh;
  const std::size_t count = mesh.vertices.size();
  for (std::size_t i = 0; i < count; ++i) mixed.vertices[i * 3847 % count] = mesh.vertices[i];
  for (UVec3& triangle : mixed.triangles) {
    for (int corner = 0; corner < 3; ++corner) {
      triangle[corner] = static_cast<std::uint32_t>(triangle[corner] * 3847ull % count);
    }
  }
  ASSERT_NE(count % 3847, 0u);
  const TemporaryFolder folder("good.ply", mesh);
  folder.write_ply("mixed.ply", mixed);
  const auto rows_of = [&folder](const Words& more) {
    (void)animate(folder, Words{"good.ply", "mixed.ply", "-o", "out", "--size", "48x32"} + more);
    return read_table(folder.path("out/animation.csv"));
  };
  const std::vector<Row> kept = rows_of({"--keep-vertex-order"}), put = rows_of({});
  EXPECT_GT(number(kept[1], "build_cycles"), 1.1 * number(kept[0], "build_cycles"));
  EXPECT_LT(number(put[1], "build_cycles"), 1.03 * number(kept[0], "build_cycles"));
  EXPECT_LE(number(put[0], "build_cycles"), number(kept[0], "build_cycles"));
  for (const auto& rows : {kept, put}) EXPECT_EQ(rows[1].at("hash"), kept[0].at("hash"));
}

// Surfaces and lights come from prepare, the tree between them from the cores.
TEST(Animate, CoresBuildTheTreeOfEffects) {
  const TemporaryFolder folder;
  folder.write("a.nff",
               "v from 1 2 6 at 0 0 0 up 0 1 0 angle 30 hither 0 resolution 40 24\nl 3 5 4\nf 0.9 0.5 0.3 0.7 0.3 40 0 "
               "0\ns 0 0 0 1\n");
  (void)animate(folder, {"a.nff", "-o", "out", "--build", "master"});
  const Row one = read_table(folder.path("out/animation.csv")).at(0);
  (void)animate(folder, {"a.nff", "-o", "out"});
  const Row row = read_table(folder.path("out/animation.csv")).at(0);
  EXPECT_EQ(row.at("hash"), one.at("hash"));
  EXPECT_EQ(row.at("render_cycles"), one.at("render_cycles"));
  EXPECT_EQ(one.at("build_cycles"), "") << "sections of effects have no prices";
  EXPECT_GT(number(row, "build_cycles"), 0);
}

TEST(Animate, TellsWhatTheCoresCannotBuild) {
  const TemporaryFolder folder("a.ply", make_sphere(8, 12, 1.0f));
  const Words common = {"animate", "a.ply", "-o", "out", "--size", "16x16", "--build", "cores"};
  expect_failure(folder, with_reference(common), 2,
                 "--build cores: builds trees; configuration reference reads a grid, which the general core builds");
  expect_failure(folder, common + Words{"--accuracy", "compact"}, 2,
                 "--build cores: builds trees of vertices as they are, not of --accuracy compact");
  folder.write("small.machine", "based_on cell-ps3\nname small\nmain_memory_bytes 3145728\n");
  folder.write_ply("b.ply", make_torus(90, 80, 1.0f, 0.4f));
  const Words small = {"animate", "b.ply", "-o", "out", "--size", "16x16", "--machine", "small.machine"};
  expect_failure(folder, small, 1, "; --build master needs none");
  (void)animate(folder, {"a.ply", "-o", "out", "--size", "16x16", "--accuracy", "compact"});
  EXPECT_EQ(read_table(folder.path("out/animation.csv")).at(0).at("builder"), "");
}

// The same frame at 64 KB: another layout, the same tree but for the size of its leaves.
TEST(Animate, SmallCoresBuildToo) {
  const TemporaryFolder folder("a.ply", make_torus(40, 30, 1.0f, 0.4f));
  const Words small = {"a.ply", "-o", "out", "--size", "48x32", "--store", "64"};
  (void)animate(folder, small + Words{"--build", "master"});
  const Row one = read_table(folder.path("out/animation.csv")).at(0);
  (void)animate(folder, small);
  const Row row = read_table(folder.path("out/animation.csv")).at(0);
  EXPECT_EQ(row.at("hash"), one.at("hash"));
  EXPECT_EQ(row.at("render_cycles"), one.at("render_cycles"));
  EXPECT_EQ(row.at("builder"), "cores");
}

TEST(Animate, TimelineHasPassesAndPicture) {
  const TemporaryFolder folder("a.ply", make_sphere(30, 40, 1.0f));
  folder.write_ply("b.ply", make_sphere(8, 12, 1.0f));
  const Words frames = {"a.ply", "b.ply", "-o", "out", "--size", "64x64"};
  (void)animate(folder, frames + Words{"--timeline", "t.json"});
  const Row row = read_table(folder.path("out/animation.csv")).at(0);
  const Json trace = Json::parse(read_file(folder.path("t.json")), nullptr, false);
  double end = 0, items = 0, tiles = 0;
  for (const Json& event : trace["traceEvents"]) {
    if (event["ph"] != "X") continue;
    end = std::max(end, event["ts"].get<double>() + event["dur"].get<double>());
    items += event["name"] == "item" ? 1 : 0;
    tiles += event["name"] == "tile" ? 1 : 0;
  }
  EXPECT_NEAR(end, number(row, "total_cycles") / 3200, 0.001) << "microseconds of the whole frame";
  EXPECT_GT(items, 9);
  EXPECT_EQ(tiles, 1);
  (void)animate(folder, {"a.ply", "-o", "out", "--size", "64x64", "--turntable", "2", "--timeline", "t.json"});
  expect_failure(folder, Words{"animate"} + frames + Words{"--timeline", "t.json", "--resume"}, 2,
                 "--timeline: is not made again by --resume");
}

TEST(Animate, PlotsTheTimeOfEachFrame) {
  const TemporaryFolder folder("a.ply", make_sphere(10, 14, 1.0f));
  folder.write_ply("b.ply", make_sphere(8, 12, 1.0f));
  (void)animate(folder, {"a.ply", "b.ply", "-o", "out", "--size", "16x16"});
  const std::string plot = read_file(folder.path("out/animation.svg"));
  EXPECT_NE(plot.find("Time of each frame"), std::string::npos);
  EXPECT_NE(plot.find(">build<"), std::string::npos) << plot;
  EXPECT_NE(plot.find(">picture<"), std::string::npos);
  (void)animate(folder, {"a.ply", "-o", "turn", "--size", "16x16", "--turntable", "30"});
  const std::string turn = read_file(folder.path("turn/animation.svg"));
  EXPECT_NE(turn.find("<polyline"), std::string::npos);
  EXPECT_EQ(turn.find(">build<"), std::string::npos) << "nothing is built for a frame";
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

// A ground in the picture is not the mesh.
TEST(Animate, AGroundIsNotTheMesh) {
  const TemporaryFolder folder("a.ply", make_sphere(10, 14, 1.0f));
  const Words common = {"render", "a.ply", "--look", "studio", "--size", "24x24",
                        "--ao",   "0",     "--eye",  "0,6,0",  "--at"};
  const std::string note = "note: no pixel shows the scene: it lies ";
  for (const Words& more : {Words{}, Words{"--mode", "plain"}, Words{"--ids", "i.pfm"}}) {
    EXPECT_NE(run_program(folder.folder(), common + Words{"20,0,1"} + more).err.find(note), std::string::npos);
    EXPECT_EQ(run_program(folder.folder(), common + Words{"0,0,0.1"} + more).err.find(note), std::string::npos);
  }
}

// The pictures of the simulated chip, and no figure that would be of another command.
TEST(Animate, PlainModeHasPicturesAndNoTimes) {
  const TemporaryFolder folder("a.ply", make_sphere(10, 14, 1.0f));
  folder.write_ply("b.ply", make_torus(24, 16, 1.0f, 0.4f));
  const Words times = {"builder",     "build_cycles",   "render_cycles", "total_cycles",
                       "build_seconds", "render_seconds", "seconds",       "fps"};
  for (const Words& frames : {Words{"a.ply", "b.ply"}, Words{"a.ply", "--turntable", "2"}}) {
    const Words common = frames + Words{"-o", "out", "--size", "40x24"};
    (void)animate(folder, common);
    const std::vector<Row> checked = read_table(folder.path("out/animation.csv"));
    EXPECT_TRUE(std::filesystem::exists(folder.path("out/animation.svg")));
    const ProgramResult result = animate(folder, common + Words{"--mode", "plain"});
    EXPECT_NE(result.out.find("\n2 frames; --mode plain counts no cycles\n"), std::string::npos) << result.out;
    EXPECT_NE(result.out.find(" hash " + checked.at(0).at("hash") + "\n"), std::string::npos) << result.out;
    const std::vector<Row> plain = read_table(folder.path("out/animation.csv"));
    ASSERT_EQ(plain.size(), 2u);
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_EQ(plain[i].at("hash"), checked[i].at("hash"));
      EXPECT_EQ(plain[i].at("triangles"), checked[i].at("triangles"));
      for (const std::string& name : times) EXPECT_EQ(plain[i].at(name), "") << name;
    }
    for (const char* const name : {"out/animation.svg", "out/animation_passes.csv"}) {
      EXPECT_FALSE(std::filesystem::exists(folder.path(name))) << name << ": of the first command";
    }
    const std::string table = read_file(folder.path("out/animation.csv"));
    (void)animate(folder, common + Words{"--mode", "plain", "--resume"});
    EXPECT_EQ(read_file(folder.path("out/animation.csv")), table);
    EXPECT_EQ(run_program(folder.folder(), Words{"animate"} + common + Words{"--resume"}).exit_code, 1)
        << "frames without cycles are no part of a table with cycles";
  }
  const Words common = {"animate", "a.ply", "-o", "new", "--mode", "plain"};
  expect_failure(folder, common + Words{"--build", "cores"}, 2, "--build: --mode plain counts no builds");
  expect_failure(folder, common + Words{"--timeline", "t.json"}, 2, "--timeline: --mode plain does not record");
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
  const std::string takes = "; animate takes meshes (PLY, OBJ, STL, glTF), text scenes (NFF), and folders of either\n";
  const struct {
    Words arguments;
    int exit_code;
    std::string words;
  } cases[] = {
      {{"nowhere.ply", "-o", "out"}, 1, "nowhere.ply: No such file"},
      {{"empty", "-o", "out"}, 1, "empty: holds no mesh, no model and no text scene\n"},
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
