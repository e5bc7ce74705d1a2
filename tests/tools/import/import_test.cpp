// Models of all formats: the same triangles as their PLY, transforms, materials, colours, normals, reports.
// SPDX-License-Identifier: Apache-2.0
#include <glm/geometric.hpp>

#include "import/srgb.h"
#include "model_files.h"
#include "temporary_folder.h"

namespace gridiron::test {
namespace {

using Corner = std::array<std::uint32_t, 3>;
using Triangle = std::array<Corner, 3>;

std::vector<Triangle> triangles_of(const MeshView& mesh) {
  std::vector<Triangle> list;
  for (const UVec3& t : mesh.triangles) {
    Triangle triangle;
    for (int i = 0; i < 3; ++i) {
      for (int axis = 0; axis < 3; ++axis) {
        triangle[static_cast<std::size_t>(i)][static_cast<std::size_t>(axis)] =
            std::bit_cast<std::uint32_t>(mesh.vertices[t[i]][axis]);
      }
    }
    list.push_back(triangle);
  }
  return list;
}

struct Read {
  tool::Mesh mesh;
  tool::ImportReport report;

  [[nodiscard]] const tool::MeshSurface& surface() const { return mesh.surface; }
  [[nodiscard]] bool ignores(const std::string& words) const {
    return std::ranges::find(report.ignored, words) != report.ignored.end();
  }
};

Read read(const TemporaryFolder& folder, const std::string& name) {
  tool::ImportedModel model = import_file(folder.path(name));
  return {std::move(model.mesh), std::move(model.report)};
}

Read read_file_of(const std::string& name, const std::string& content) {
  return read(TemporaryFolder(name, content), name);
}

const TestMesh& torus() {
  static const TestMesh mesh = rounded(make_torus(12, 8, 1.0f, 0.4f));
  return mesh;
}

// Two triangles of a square, corners at 0 and 1.
const TestMesh& square() {
  static const TestMesh mesh = {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}};
  return mesh;
}

// Twice the area of a triangle, on its front side.
Vec3 side_of(const tool::Mesh& mesh, std::size_t triangle) {
  const UVec3 t = mesh.triangles[triangle];
  return glm::cross(mesh.vertices[t.y] - mesh.vertices[t.x], mesh.vertices[t.z] - mesh.vertices[t.x]);
}

void expect_near(const Vec3& a, const Vec3& b, float most = 1e-4f) {
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], most) << i;
}

TEST(Import, AllFormatsHaveTheTrianglesOfThePly) {
  const std::vector<Triangle> expected = triangles_of(torus().view());
  const struct { const char* name; std::string content; const char* format; } cases[] = {
      {"a.obj", obj_text(torus()), "OBJ"},   {"a.stl", stl_text(torus()), "STL"},
      {"b.stl", stl_bytes(torus()), "STL"},  {"a.gltf", gltf_text(torus()), "glTF"},
      {"a.glb", glb_bytes(torus()), "glTF"}, {"no_ending", obj_text(torus()), "OBJ"},
      {"A.GLB", glb_bytes(torus()), "glTF"}, {"wrong.obj", glb_bytes(torus()), "glTF"}};
  for (const auto& each : cases) {
    const Read got = read_file_of(each.name, each.content);
    EXPECT_EQ(triangles_of(got.mesh.view()), expected) << each.name;
    // Corners at one place are one vertex, which files of unconnected triangles cannot say.
    EXPECT_EQ(got.mesh.vertices.size(), std::size_t{96}) << each.name;
    EXPECT_EQ(got.report.format, each.format) << each.name;
    EXPECT_EQ(got.report.meshes, 1u) << each.name;
    EXPECT_TRUE(got.surface().is_empty()) << each.name;
  }
}

TEST(Import, NodesMoveAndMirrorTheirMeshes) {
  const auto moved = [](const std::string& node) {
    return read_file_of("a.gltf", gltf_text(square(), {.node = "\"mesh\":0," + node})).mesh;
  };
  const tool::Mesh shifted = moved("\"translation\":[1,2,3],\"scale\":[2,2,2]");
  expect_near(shifted.vertices[shifted.triangles[0].z], Vec3(3, 4, 3));
  const tool::Mesh mirrored = moved("\"scale\":[-1,1,1]");
  ASSERT_EQ(mirrored.triangles.size(), 2u);
  for (const tool::Mesh* mesh : {&shifted, &mirrored}) {
    for (const std::size_t i : {0u, 1u}) EXPECT_GT(side_of(*mesh, i).z, 0.5f);  // still the same side in front
  }
}

TEST(Import, NodesOfAllDepthsAndMeshesShownTwice) {
  const std::string nodes = "\"children\":[1,2],\"translation\":[10,0,0]},{\"mesh\":0},"
                            "{\"mesh\":0,\"translation\":[0,5,0]";
  const Read got = read_file_of("a.gltf", gltf_text(square(), {.node = nodes}));
  EXPECT_EQ(got.report.meshes, 2u);
  ASSERT_EQ(got.mesh.triangles.size(), 4u);
  expect_near(got.mesh.vertices[got.mesh.triangles[0].x], Vec3(10, 0, 0));
  expect_near(got.mesh.vertices[got.mesh.triangles[2].x], Vec3(10, 5, 0));
}

TEST(Import, GltfMaterialsAreMapped) {
  const auto material = [](const std::string& words) {
    const std::string more = ",\"extensionsUsed\":[\"KHR_materials_transmission\"]";
    return read_file_of("a.glb", glb_bytes(square(), {.material = words, .more = more})).surface().materials.at(0);
  };
  const tool::SceneMaterial rough =
      material("\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.25,0.5,1,1],\"metallicFactor\":0,"
               "\"roughnessFactor\":1}");
  expect_near(rough.color, Vec3(0.25f, 0.5f, 1));
  EXPECT_EQ(rough.kd, 1.0f);
  EXPECT_EQ(rough.ks, 0.0f);
  EXPECT_FALSE(rough.smooth_normals);
  const tool::SceneMaterial mirror =
      material("\"pbrMetallicRoughness\":{\"metallicFactor\":1,\"roughnessFactor\":0.1}");
  EXPECT_NEAR(mirror.ks, 0.81f, 1e-4f);
  EXPECT_NEAR(mirror.kd, 0.19f, 1e-4f);
  EXPECT_GT(mirror.shine, 1000.0f);
  const tool::SceneMaterial glass =
      material("\"extensions\":{\"KHR_materials_transmission\":{\"transmissionFactor\":0.9}},"
               "\"pbrMetallicRoughness\":{\"metallicFactor\":0,\"roughnessFactor\":0}");
  EXPECT_NEAR(glass.transmittance, 0.9f, 1e-4f);
  EXPECT_EQ(glass.index_of_refraction, 1.5f);
  const tool::SceneMaterial veil = material(
      "\"alphaMode\":\"BLEND\",\"pbrMetallicRoughness\":{\"baseColorFactor\":[1,1,1,0.25],\"metallicFactor\":0}");
  EXPECT_NEAR(veil.transmittance, 0.75f, 1e-4f);
  EXPECT_EQ(veil.index_of_refraction, 1.0f);
}

TEST(Import, MtlMaterialsAreMapped) {
  const TemporaryFolder folder("a.obj", "mtllib some.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nusemtl red\nf 1 2 3\n"
                                        "usemtl glass\nf 1 2 4\nusemtl mirror\nf 2 3 4\n");
  folder.write("some.mtl", "newmtl red\nKd 0.5 0.25 0\nKs 0.5 0.5 0.5\nNs 100\nillum 2\n"
                           "newmtl glass\nKd 1 1 1\nd 0.25\nNi 1.5\n"
                           "newmtl mirror\nKd 1 1 1\nKs 0.6 0.6 0.6\nNs 50\nillum 3\n");
  const Read got = read(folder, "a.obj");
  const auto of = [&](std::size_t triangle) {
    return got.surface().materials.at(got.surface().triangle_materials.at(triangle));
  };
  ASSERT_EQ(got.mesh.triangles.size(), 3u);
  expect_near(of(0).color, Vec3(0.5f, 0.25f, 0));
  EXPECT_EQ(of(0).ks, 0.0f);
  EXPECT_TRUE(got.ignores("highlights without mirrors of 1 material"));
  EXPECT_NEAR(of(1).transmittance, 0.75f, 1e-6f);
  EXPECT_EQ(of(1).index_of_refraction, 1.5f);
  EXPECT_NEAR(of(2).ks, 0.6f, 1e-6f);
  EXPECT_EQ(of(2).shine, 50.0f);
}

TEST(Import, MissingFilesAreReported) {
  const Read got = read_file_of("a.obj", "mtllib lost.mtl\n" + obj_text(square()));
  EXPECT_EQ(got.mesh.triangles.size(), 2u);
  const auto names_it = [](const std::string& words) { return words.find("lost.mtl") != std::string::npos; };
  EXPECT_TRUE(std::ranges::any_of(got.report.ignored, names_it));
}

TEST(Import, NormalsAreKeptAndTurnedWithTheirNode) {
  const GltfParts parts = {.node = "\"mesh\":0,\"rotation\":[0.70710678,0,0,0.70710678],\"scale\":[1,-1,2]",
                           .normals = {{0, 0, 2}, {0, 0, 1}, {0, 0, 1}, {0, 0, 1}}};
  const Read got = read_file_of("a.glb", glb_bytes(square(), parts));
  ASSERT_EQ(got.surface().triangle_normals.size(), 2u);
  const Vec3 normal = got.surface().normals.at(got.surface().triangle_normals[0].x);
  expect_near(normal, Vec3(0, -1, 0));
  EXPECT_GT(glm::dot(side_of(got.mesh, 0), normal), 0.0f);
  EXPECT_TRUE(got.surface().materials.empty());
}

TEST(Import, VertexColoursAreKept) {
  const std::vector<Vec3> colors = {{1, 0, 0}, {0, 0.5f, 0}, {0, 0, 1}, {1, 1, 1}};
  const Read linear = read_file_of("a.glb", glb_bytes(square(), {.colors = colors}));
  ASSERT_EQ(linear.surface().triangle_colors.size(), 2u);
  expect_near(linear.surface().colors.at(linear.surface().triangle_colors[0].y), Vec3(0, 0.5f, 0));
  const Read encoded = read_file_of("a.obj", "v 0 0 0 1 0 0\nv 1 0 0 0 0.5 0\nv 0 1 0 0 0 1\nf 1 2 3\n");
  ASSERT_EQ(encoded.surface().triangle_colors.size(), 1u);
  expect_near(encoded.surface().colors.at(encoded.surface().triangle_colors[0].y),
              Vec3(0, tool::linear_of_srgb(0.5f), 0));
}

// A picture of four texels on a square: each corner shows its own.
TEST(Import, TexturesGiveColoursToCorners) {
  const std::string picture = png_bytes(2, 2, {{255, 0, 0}, {0, 255, 0}, {0, 0, 255}, {128, 128, 128}});
  const std::vector<std::array<float, 2>> uvs = {{0.25f, 0.25f}, {0.75f, 0.25f}, {0.75f, 0.75f}, {0.25f, 0.75f}};
  const std::string material = "\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0},"
                               "\"baseColorFactor\":[1,1,0.5,1]}";
  const float grey = tool::linear_of_srgb(128.0f / 255.0f);
  const auto check = [&](const Read& got) {
    ASSERT_EQ(got.surface().triangle_colors.size(), 2u);
    const UVec3 corners = got.surface().triangle_colors[0];
    expect_near(got.surface().colors.at(corners.x), Vec3(1, 0, 0));
    expect_near(got.surface().colors.at(corners.y), Vec3(0, 1, 0));
    expect_near(got.surface().colors.at(corners.z), Vec3(grey, grey, grey * 0.5f));
  };
  check(read_file_of("a.glb", glb_bytes(square(), {.material = material, .uvs = uvs, .picture = picture})));
  const TemporaryFolder folder("a picture.png", picture);
  const std::string more = ",\"textures\":[{\"source\":0}],\"images\":[{\"uri\":\"a%20picture.png\"}]";
  folder.write("a.gltf", gltf_text(square(), {.material = material, .more = more, .uvs = uvs}));
  check(read(folder, "a.gltf"));
  // OBJ counts v upwards.
  folder.write("a.mtl", "newmtl one\nKd 1 1 0.5\nmap_Kd a picture.png\n");
  folder.write("a.obj", "mtllib a.mtl\nusemtl one\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0.25 0.75\nvt 0.75 0.75\n"
                        "vt 0.75 0.25\nvt 0.25 0.25\nf 1/1 2/2 3/3\nf 1/1 3/3 4/4\n");
  check(read(folder, "a.obj"));
}

TEST(Import, UnreadableTexturesAreReported) {
  const std::string material = "\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0}}";
  const std::string more = ",\"textures\":[{\"source\":0}],\"images\":[{\"uri\":\"lost.png\"}]";
  const Read got = read_file_of(
      "a.gltf", gltf_text(square(), {.material = material, .more = more, .uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}}}));
  EXPECT_TRUE(got.ignores("the texture 'lost.png', which is missing")) << testing::PrintToString(got.report.ignored);
  const TemporaryFolder folder("a.mtl", "newmtl one\nmap_Kd a.tga\n");
  folder.write("a.tga", "no picture");
  folder.write("a.obj", "mtllib a.mtl\nusemtl one\nv 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0 0\nf 1/1 2/1 3/1\n");
  const Read there = read(folder, "a.obj");
  EXPECT_TRUE(there.ignores("the texture 'a.tga', which is no PNG or JPEG, damaged, or too large"))
      << testing::PrintToString(there.report.ignored);
}

// Of what nobody would see an exporter means the opposite.
TEST(Import, WhatIsWhollyClearIsOpaque) {
  const TemporaryFolder folder("a.mtl", "newmtl one\nKd 1 0 0\nd 0\nnewmtl two\nKd 1 0 0\nd 0.25\n");
  folder.write("a.obj", "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nusemtl one\nf 1 2 3\nusemtl two\nf 1 3 2\n");
  const Read got = read(folder, "a.obj");
  EXPECT_TRUE(got.ignores("full transparency of 1 material")) << testing::PrintToString(got.report.ignored);
  ASSERT_EQ(got.mesh.surface.materials.size(), 2u);
  EXPECT_EQ(got.mesh.surface.materials[0].transmittance, 0.0f);
  EXPECT_EQ(got.mesh.surface.materials[1].transmittance, 0.75f);
}

TEST(Import, LinesAndPointsAreReported) {
  const Read got = read_file_of("a.obj", obj_text(square()) + "l 1 2 3\n");
  EXPECT_EQ(got.mesh.triangles.size(), 2u);
  EXPECT_TRUE(got.ignores("2 lines")) << testing::PrintToString(got.report.ignored);
}

// Assimp leaves out the faces, and only warns of it.
TEST(Import, WrongIndicesOfGltfAreReported) {
  TestMesh mesh = square();
  mesh.triangles.emplace_back(0, 1, 99);
  const Read got = read_file_of("a.gltf", gltf_text(mesh));
  EXPECT_EQ(got.mesh.triangles.size(), 2u);
  EXPECT_TRUE(got.ignores("wrong indices ('Some faces had out-of-range indices. Those faces were dropped.')"))
      << testing::PrintToString(got.report.ignored);
}

TEST(Import, PolygonsAreCutIntoTriangles) {
  const Read got = read_file_of("a.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n");
  EXPECT_EQ(got.mesh.triangles.size(), 2u);
}

TEST(Import, AnimationsMoveNodes) {
  // Times 0 and 1, translations 0 and (4, 0, 0).
  std::string extra;
  for (const float value : {0.0f, 1.0f, 0.0f, 0.0f, 0.0f, 4.0f, 0.0f, 0.0f}) {
    extra.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  GltfParts parts = {.extra = extra};
  std::string json = gltf_text(square(), parts);
  const auto add = [&json](const std::string& list, const std::string& words) {
    const std::size_t begin = json.find("\"" + list + "\":[") + list.size() + 4;
    std::size_t end = json.find("}]", begin) + 1;
    json.insert(end, "," + words);
  };
  const std::size_t place = gltf_buffer(square(), parts).size() - extra.size();
  add("bufferViews", "{\"buffer\":0,\"byteOffset\":" + std::to_string(place) + ",\"byteLength\":8}");
  add("bufferViews", "{\"buffer\":0,\"byteOffset\":" + std::to_string(place + 8) + ",\"byteLength\":24}");
  add("accessors", "{\"bufferView\":7,\"componentType\":5126,\"count\":2,\"type\":\"SCALAR\",\"min\":[0],\"max\":[1]}");
  add("accessors", "{\"bufferView\":8,\"componentType\":5126,\"count\":2,\"type\":\"VEC3\"}");
  json.pop_back();
  json += ",\"animations\":[{\"channels\":[{\"sampler\":0,\"target\":{\"node\":0,\"path\":\"translation\"}}],"
          "\"samplers\":[{\"input\":2,\"output\":3}]}]}";
  const TemporaryFolder folder("a.gltf", json);
  for (const double moment : {0.0, 0.25, 1.0}) {
    const tool::ImportedModel model = import_file(folder.path("a.gltf"), {.moment = moment});
    ASSERT_EQ(model.report.animations.size(), 1u);
    EXPECT_EQ(model.report.animations[0].seconds, 1.0);
    const tool::Mesh& mesh = model.mesh;
    expect_near(mesh.vertices[mesh.triangles[0].x], Vec3(4.0f * static_cast<float>(moment), 0, 0));
  }
}

}  // namespace
}  // namespace gridiron::test
