// Text scenes that are right: what each line becomes. SPDX-License-Identifier: Apache-2.0
#include <clocale>

#include "check_scene.h"
#include "failure_of.h"
#include "support/test_headers.h"
#include "temporary_folder.h"

namespace gridiron::test {
namespace {

using tool::SceneDescription;
using tool::SceneMaterial;

std::string scene(std::string_view rest) {
  return std::string(kViewAndFill) + std::string(rest);
}

TEST(SceneReader, ReadsEveryLineOfTheFormat) {
  const SceneDescription read = read_good(R"(# A scene as people write them.
b 0.1 0.2 0.3
v
from 1 2 3
at 0 0.5 0
up 0 1 0
angle 35.5
hither 0.01
resolution 640 480
l 3 4 5
l -3 4 5 0.5 0.25 1
f 1 0.75 0.5 0.8 0.2 30 0.5 1.33
p 4
-1 0 -1
-1 0 1
1 0 1
1 0 -1
pp 3
0 0 0  0 0 2
1 0 0  0 0 3
0 1 0  1 0 0
s 0 1 0 0.5
c
0 0 0 0.5
0 2 0 0.25
)");
  expect_sound(read);
  EXPECT_EQ(read.view.from, Vec3(1, 2, 3));
  EXPECT_EQ(read.view.at, Vec3(0, 0.5f, 0));
  EXPECT_EQ(read.view.up, Vec3(0, 1, 0));
  EXPECT_EQ(read.view.angle_degrees, 35.5f);
  EXPECT_EQ(read.view.hither, 0.01f);
  EXPECT_EQ(read.view.width, 640u);
  EXPECT_EQ(read.view.height, 480u);
  EXPECT_EQ(read.background, Vec3(0.1f, 0.2f, 0.3f));
  ASSERT_EQ(read.point_lights.size(), 2u);
  EXPECT_EQ(read.point_lights[0].position, Vec3(3, 4, 5));
  EXPECT_EQ(read.point_lights[0].color, Vec3(std::sqrt(0.5f))) << "1 / sqrt(number of lights)";
  EXPECT_EQ(read.point_lights[1].color, Vec3(0.5f, 0.25f, 1));
  ASSERT_EQ(read.materials.size(), 2u);
  SceneMaterial expected{Vec3(1, 0.75f, 0.5f), 0.8f, 0.2f, 30, 0.5f, 1.33f, false};
  EXPECT_EQ(read.materials[0], expected) << "of the polygon";
  expected.smooth_normals = true;
  EXPECT_EQ(read.materials[1], expected) << "of patch, sphere and cone";
  EXPECT_EQ(read.counts.polygons, 1u);
  EXPECT_EQ(read.counts.patches, 1u);
  EXPECT_EQ(read.counts.spheres, 1u);
  EXPECT_EQ(read.counts.cones, 1u);
  EXPECT_EQ(read.counts.meshes, 0u);
  EXPECT_EQ(read.geometry.vertices[2], Vec3(1, 0, 1));
  const std::uint32_t normal = read.geometry.triangle_normals[2].y;
  EXPECT_EQ(read.geometry.normals[normal], Vec3(0, 0, 1)) << "made unit";
}

TEST(SceneReader, ReadsTheLinesThatThisProjectAdds) {
  const SceneDescription read =
      read_good(scene("la 1 2 3 4 0 0 0 0 5 0.5 0.25 100 9 ao 32 2.5 ms 16 d 8 sh off s 0 0 0 1"));
  expect_sound(read);
  ASSERT_EQ(read.area_lights.size(), 1u);
  EXPECT_EQ(read.area_lights[0].corner, Vec3(1, 2, 3));
  EXPECT_EQ(read.area_lights[0].edge_u, Vec3(4, 0, 0));
  EXPECT_EQ(read.area_lights[0].edge_v, Vec3(0, 0, 5));
  EXPECT_EQ(read.area_lights[0].color, Vec3(0.5f, 0.25f, 100));
  EXPECT_EQ(read.area_lights[0].samples, 9u);
  ASSERT_TRUE(read.ambient_occlusion);
  EXPECT_EQ(read.ambient_occlusion->samples, 32u);
  EXPECT_EQ(read.ambient_occlusion->radius, 2.5f);
  EXPECT_EQ(read.samples_per_pixel, 16u);
  EXPECT_EQ(read.recursion_depth, 8u);
  EXPECT_FALSE(read.shadows);
}

TEST(SceneReader, AssumesWhatIsNotSaid) {
  const SceneDescription read = read_good(scene("s 0 0 0 1"));
  EXPECT_EQ(read.background, Vec3(0));
  EXPECT_TRUE(read.point_lights.empty());
  EXPECT_TRUE(read.area_lights.empty());
  EXPECT_FALSE(read.environment);
  EXPECT_FALSE(read.ambient_occlusion);
  EXPECT_EQ(read.samples_per_pixel, 1u);
  EXPECT_EQ(read.recursion_depth, 5u);
  EXPECT_TRUE(read.shadows);
}

TEST(SceneReader, TakesAllFormsOfWhiteSpaceCommentsAndNumbers) {
  const SceneDescription plain = read_good(
      "v from 0 0 9 at 0 0 0 up 0 1 0 angle 40 hither 0.5 resolution 8 6 "
      "f 1 1 1 1 0 0 0 0 p 3 0 0 0 1 0 0 0 1 0");
  const SceneDescription odd = read_good(
      "\xEF\xBB\xBF# opens\r\nv\r from\t+0 -0.\v+9 \f# a comment ends with its line\r"
      "hither .5 at 0 0 0#\nup\n0\n1\n0\n\n\nangle 4e1 resolution 8 6.0 f 1 1 1 1 0 0 0\n"
      "0 p\r\n3\r\n0 0 0 10e-1 0 0 0 1 0");
  EXPECT_EQ(odd.geometry.vertices, plain.geometry.vertices);
  EXPECT_EQ(odd.geometry.triangles, plain.geometry.triangles);
  EXPECT_EQ(odd.view.hither, 0.5f);
  EXPECT_EQ(odd.view.angle_degrees, 40.0f);
}

TEST(SceneReader, DoesNotAskTheLocale) {
  const std::string before = std::setlocale(LC_ALL, nullptr);
  for (const char* name : {"de_DE.UTF-8", "fr_FR.UTF-8", "C.UTF-8"}) static_cast<void>(std::setlocale(LC_ALL, name));
  const SceneDescription read = read_good(scene("s 0 0 0 1.5"));
  std::setlocale(LC_ALL, before.c_str());
  EXPECT_EQ(read.geometry.vertices, read_good(scene("s 0 0 0 1.5")).geometry.vertices);
}

TEST(SceneReader, TakesAnIndexOfRefractionOfNothingWhereNoLightGoesThrough) {
  const SceneDescription read =
      read_good(std::string(kView) + "f 1 1 1 1 0 0 0 0 s 0 0 0 1 f 1 0 0 1 0 0 0 1.5 s 0 0 0 2");
  for (const SceneMaterial& material : read.materials) EXPECT_EQ(material.index_of_refraction, 1.0f);
}

TEST(SceneReader, KeepsEachMaterialOnceAndOnlyThoseInUse) {
  const SceneDescription read = read_good(std::string(kView) +
                                          "f 1 0 0 1 0 0 0 0 s 0 0 0 1 f 0 1 0 1 0 0 0 0 f 1 0 0 1 0 0 0 0 s 3 0 0 1 "
                                          "sn on f 1 0 0 1 0 0 0 0 s 6 0 0 1 f 0 0 1 1 0 0 0 0 s 9 0 0 1");
  expect_sound(read);
  ASSERT_EQ(read.materials.size(), 2u);
  EXPECT_EQ(read.materials[0].color, Vec3(1, 0, 0));
  EXPECT_EQ(read.materials[1].color, Vec3(0, 0, 1));
  const std::vector<std::uint16_t>& of = read.geometry.triangle_materials;
  ASSERT_EQ(of.size() % 4, 0u);
  for (std::size_t i = 0; i < of.size(); ++i) ASSERT_EQ(of[i], i < of.size() / 4 * 3 ? 0 : 1) << "triangle " << i;
}

TEST(SceneReader, SmoothNormalsFollowTheSwitch) {
  const TemporaryFolder folder;
  const TestMesh tetrahedron{{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)},
                             {UVec3(0, 2, 1), UVec3(0, 1, 3), UVec3(0, 3, 2), UVec3(1, 2, 3)}};
  folder.write_ply("t.ply", tetrahedron);
  const std::string path = folder.path("a.nff").string();
  const std::string shapes = "f 1 1 1 1 0 0 0 0 s 0 0 0 1 m t.ply pp 3 0 0 0 0 0 1 1 0 0 0 0 1 0 1 0 0 0 1 ";
  const auto smooth_triangles = [&](const std::string& text) {
    const SceneDescription read = read_good(text, {}, path);
    expect_sound(read);
    std::size_t count = 0;
    for (const std::uint16_t material : read.geometry.triangle_materials) {
      count += read.materials[material].smooth_normals;
    }
    return std::pair(count, read.geometry.triangles.size());
  };
  const auto [curved, all] = smooth_triangles(std::string(kView) + shapes);
  EXPECT_EQ(curved + 4, all) << "all but the mesh";
  EXPECT_EQ(smooth_triangles(std::string(kView) + "sn on " + shapes).first, all);
  EXPECT_EQ(smooth_triangles(std::string(kView) + "sn off " + shapes).first, 0u);
  const auto [late, more] = smooth_triangles(std::string(kView) + shapes + "sn off s 0 0 0 1");
  EXPECT_EQ(late + 4, more) << "the switch is the material's: it waits for the next f";
}

TEST(SceneReader, MovesAMeshByItsMatrixAndKeepsItTurnedOutwards) {
  const TemporaryFolder folder;
  const TestMesh tetrahedron{{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)},
                             {UVec3(0, 2, 1), UVec3(0, 1, 3), UVec3(0, 3, 2), UVec3(1, 2, 3)}};
  folder.write_ply("t.ply", tetrahedron);
  std::filesystem::create_directory(folder.path("sub"));
  const std::string path = folder.path("sub/a.nff").string();
  const SceneDescription plain = read_good(scene("m ../t.ply"), {}, path);
  EXPECT_EQ(plain.geometry.vertices, tetrahedron.vertices);
  EXPECT_NEAR(signed_volume(plain.geometry.vertices, plain.geometry.triangles), 1.0 / 6, 1e-12);
  const SceneDescription moved = read_good(scene("m ../t.ply 0 2 0 10  1 0 0 20  0 0 3 30"), {}, path);
  EXPECT_EQ(moved.geometry.vertices[1], Vec3(10, 21, 30));
  EXPECT_EQ(moved.geometry.vertices[2], Vec3(12, 20, 30));
  EXPECT_EQ(moved.geometry.vertices[3], Vec3(10, 20, 33));
  EXPECT_NEAR(signed_volume(moved.geometry.vertices, moved.geometry.triangles), 1, 1e-9) << "the matrix mirrors";
  EXPECT_EQ(count_open_edges(moved.geometry.triangles), 0u);
}

TEST(SceneReader, NormalsOfAMeshAreThoseOfASphereWhereItIsOne) {
  // The tessellated sphere as a mesh: each vertex on the sphere, so each normal is its direction.
  const SceneDescription sphere = read_good(scene("s 0 0 0 2"));
  const TemporaryFolder folder("s.ply", {sphere.geometry.vertices, sphere.geometry.triangles});
  const SceneDescription read =
      read_good(std::string(kView) + "sn on f 1 1 1 1 0 0 0 0 m s.ply", {}, folder.path("a.nff").string());
  ASSERT_EQ(read.geometry.normals.size(), read.geometry.vertices.size());
  double worst = 0;
  for (std::size_t i = 0; i < read.geometry.vertices.size(); ++i) {
    const DVec3 off = DVec3(read.geometry.normals[i]) - DVec3(read.geometry.vertices[i]) * 0.5;
    worst = std::max({worst, std::fabs(off.x), std::fabs(off.y), std::fabs(off.z)});
  }
  EXPECT_LT(worst, 1e-5);
}

TEST(SceneReader, BothSidesOfASheetHaveNormals) {
  const TemporaryFolder folder(
      "sheet.ply", {{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)}, {UVec3(0, 1, 2), UVec3(0, 2, 1), UVec3(0, 0, 1)}});
  const SceneDescription read =
      read_good(std::string(kView) + "sn on f 1 1 1 1 0 0 0 0 m sheet.ply", {}, folder.path("a.nff").string());
  expect_sound(read);
  const auto& geometry = read.geometry;
  EXPECT_EQ(geometry.normals[geometry.triangle_normals[0].x], Vec3(0, 0, 1));
  EXPECT_EQ(geometry.normals[geometry.triangle_normals[1].x], Vec3(0, 0, -1));
}

TEST(SceneReader, NotesWhatIsOdd) {
  const SceneDescription read = read_good(std::string(kView) +
                                          " l 0 9 0\nf 1 1 1 1 0 0 0 0\np 3 0 0 0 1 1 1 2 2 2\n"
                                          "p 4 0 0 0 1 0 0 1 1 0.5 0 1 0\n" +
                                          "s 0 0 0 1");
  ASSERT_EQ(read.notes.size(), 2u);
  EXPECT_EQ(read.notes[0].line, 3u);
  EXPECT_EQ(read.notes[0].text, "polygon without area left out");
  EXPECT_EQ(read.notes[1].line, 4u);
  EXPECT_NE(read.notes[1].text.find("polygon is not planar: a corner is 0.1"), std::string::npos) << read.notes[1].text;
  EXPECT_EQ(read.counts.non_planar_polygons, 1u);
  const SceneDescription dark = read_good(std::string(kViewAndFill) + "s 0 0 0 1");
  ASSERT_EQ(dark.notes.size(), 1u);
  EXPECT_EQ(dark.notes[0].text,
            "the scene has no light: shaded by it, surfaces show only what they reflect or let through");
  std::string many = std::string(kViewAndFill) + "l 0 9 0 ";
  for (int i = 0; i < 30; ++i) many += "p 3 0 0 0 1 1 1 2 2 2 ";
  const SceneDescription noted = read_good(many + "s 0 0 0 1");
  EXPECT_EQ(noted.notes.size(), tool::kMostSceneNotes);
  EXPECT_EQ(noted.note_count, 30u);
}

TEST(SceneReader, ReadsAFile) {
  const TemporaryFolder folder;
  const auto path = folder.write("a.nff", scene("s 0 0 0 1"));
  expect_sound(tool::read_scene_text(path));
  EXPECT_EQ(failure_of([&] { return tool::read_scene_text(folder.path("none.nff")); }),
            folder.path("none.nff").string() + ": No such file or directory");
}

}  // namespace
}  // namespace gridiron::test
