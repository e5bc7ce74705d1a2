// Odd models that their formats allow: each has the triangles that its format says, wound as it says.
// SPDX-License-Identifier: Apache-2.0
#include <glm/geometric.hpp>

#include "gltf_writer.h"
#include "model_files.h"
#include "support/test_headers.h"
#include "temporary_folder.h"

namespace gridiron::test {
namespace {

using tool::ImportedModel;
using Corners = std::array<std::array<float, 3>, 3>;

struct File {
  std::string name, content;
};

struct Odd {
  std::string name, content;
  std::vector<float> triangles;  ///< nine numbers each, in any order, from any corner on
  std::vector<File> beside{};
  std::string ignored{};  ///< words that must be reported
};

// From its least corner on, so that only the winding counts.
Corners turned(Corners triangle) {
  std::rotate(triangle.begin(), std::ranges::min_element(triangle), triangle.end());
  return triangle;
}

std::vector<Corners> triangles_of(const tool::Mesh& mesh) {
  std::vector<Corners> list;
  for (const UVec3& t : mesh.triangles) {
    Corners triangle;
    for (int i = 0; i < 3; ++i) {
      const Vec3 corner = mesh.vertices.at(t[i]) + 0.0f;  // no -0
      triangle[static_cast<std::size_t>(i)] = {corner.x, corner.y, corner.z};
    }
    list.push_back(turned(triangle));
  }
  std::ranges::sort(list);
  return list;
}

std::vector<Corners> triangles_of(const std::vector<float>& numbers) {
  std::vector<Corners> list(numbers.size() / 9);
  for (std::size_t i = 0; i < 9 * list.size(); ++i) list[i / 9][i % 9 / 3][i % 3] = numbers[i];
  for (Corners& triangle : list) triangle = turned(triangle);
  std::ranges::sort(list);
  return list;
}

void expect_triangles(const std::vector<Corners>& got, const std::vector<Corners>& expected) {
  ASSERT_EQ(got.size(), expected.size()) << testing::PrintToString(got);
  for (std::size_t i = 0; i < got.size(); ++i) {
    for (std::size_t k = 0; k < 9; ++k) {
      EXPECT_NEAR(got[i][k / 3][k % 3], expected[i][k / 3][k % 3], 1e-5f) << testing::PrintToString(got);
    }
  }
}

void check(const Odd& odd) {
  SCOPED_TRACE(odd.name);
  const TemporaryFolder folder(odd.name, odd.content);
  for (const File& file : odd.beside) folder.write(file.name, file.content);
  const ImportedModel model = import_file(folder.path(odd.name));
  expect_triangles(triangles_of(model.mesh), triangles_of(odd.triangles));
  const std::string ignored = tool::words_of_list(model.report.ignored);
  if (odd.ignored.empty()) {
    EXPECT_EQ(ignored, "");
  } else {
    EXPECT_NE(ignored.find(odd.ignored), std::string::npos) << ignored;
  }
}

// The usual triangle, and its mirror image.
const std::vector<float> kOne = {0, 0, 0, 1, 0, 0, 0, 1, 0};
constexpr const char* kVertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

TEST(OddModels, Obj) {
  const std::string vertices = kVertices;
  const Odd cases[] = {
      {"negative.obj", vertices + "f -3 -2 -1\n", kOne},
      {"negative_later.obj", "v 9 9 9\n" + vertices + "f -3 -2 -1\nv 7 7 7\nv 8 8 8\n", kOne},
      {"negative_parts.obj", vertices + "vt 0 0\nvn 0 0 1\nf -3/-1/-1 -2/-1/-1 -1/-1/-1\n", kOne},
      {"parts.obj",
       vertices + "vt 0 0\nvn 0 0 1\nf 1//1 2//1 3//1\nf 1/1 2/1 3/1\n",
       {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0}},
      {"continued.obj", "v 0 \\\n0 0\nv 1 0 0\nv 0 1 0\nf 1 \\\n2 3\n", kOne},
      {"crlf.obj", "# x\r\nv 0 0 0\r\nv 1 0 0\r\nv 0 1 0\r\n\r\nf 1 2 3\r\n", kOne},
      {"blanks.obj", "  v\t0   0 0 \n\tv 1\t0\t0\n v 0 1 0\t\n\n   f  1\t 2  3 \n", kOne},
      {"comment.obj", vertices + "f 1 2 3 # the only one\n", kOne},
      {"numbers.obj", "v 0.0e0 -0 +0\nv 1.E0 .0 0.\nv 0 10e-1 0\nf 1 2 3\n", kOne},
      {"weight.obj", "v 0 0 0 1\nv 1 0 0 1.0\nv 0 1 0 1\nf 1 2 3\n", kOne},
      {"no_end.obj", vertices + "f 1 2 3", kOne},
      {"groups.obj",
       vertices + "o first thing\ng a b\ns 1\nf 1 2 3\no second\ns off\nv 5 0 0\nf 1 4 3\n",
       {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 5, 0, 0, 0, 1, 0}},
      {"twice.obj", vertices + "f 1 2 3\nf 1 1 2\n", {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0}},
      {"lines.obj", vertices + "l 1 2 3\np 1\n", {}, {}, "2 lines"},
      {"points.obj", vertices + "p 1 2 3\n", {}, {}, "point"},
      {"lost.obj", "mtllib lost.mtl\nusemtl red\n" + vertices + "f 1 2 3\n", kOne, {}, "the missing file"},
      {"unknown.obj", "usemtl nowhere\n" + vertices + "f 1 2 3\n", kOne},
      {"returns.obj", "v 0 0 0\rv 1 0 0 # one\r  v 0 1 0\rf 1 2 3\r", kOne},
      {"blanks_continued.obj", "v 0 0 0\n v 1 \\\n  0 0\nv 0 1 0\n  f 1 2 \\\r\n 3 # x\r\n", kOne},
      {"hash.obj", "usemtl a#b\n v 0 0 0\nv 1 0 0\nv 0 1 0\ng #1\nf 1 2 3\n", kOne},
      {"curves.obj", vertices + "vp 0 0\nvp 1 \\\n 1\ncstype bezier\ndeg 3\nparm u 0 1\nlod 1\nend\nf 1 2 3\n", kOne},
      {"points_first.obj", " v .0 .0 .0#\nv 1 .0 0\nv 0 1 .0\nf 1 2 3\n", kOne},
  };
  for (const Odd& odd : cases) check(odd);
}

// Assimp takes another vertex, or none, and only warns of it.
TEST(OddModels, WrongIndicesAreReported) {
  const std::string vertices = "OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  check({"right.off", vertices + "3 0 1 2\n", {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0}});
  check({"wrong.off",
         vertices + "3 0 1 7\n",
         {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0},
         {},
         "wrong indices ('OFF: Vertex index is out of range')"});
}

TEST(OddModels, ObjMaterialsHaveNamesWithSpaces) {
  const TemporaryFolder folder("a.obj", "mtllib my materials.mtl\n" + std::string(kVertices) +
                                            "usemtl dark red\nf 1 2 3\nusemtl dark blue\nf 1 3 2\n");
  folder.write("my materials.mtl",
               "\tnewmtl dark red\r\n  Kd 0.5 0 0\r\nTr 0.25\r\n\r\nnewmtl dark blue\r\nKd 0 0 0.5\r\n"
               "d 0.5\r\nillum 10\r\nKs 1 1 1\r\n");
  const ImportedModel model = import_file(folder.path("a.obj"));
  const auto material = [&](std::size_t triangle) {
    return model.mesh.surface.materials.at(model.mesh.surface.triangle_materials.at(triangle));
  };
  ASSERT_EQ(model.mesh.triangles.size(), 2u);
  EXPECT_EQ(material(0).color, Vec3(0.5f, 0, 0));
  EXPECT_NEAR(material(0).transmittance, 0.25f, 1e-6f);
  EXPECT_EQ(material(1).color, Vec3(0, 0, 0.5f));
  EXPECT_EQ(material(1).transmittance, 0.5f);
  EXPECT_EQ(material(1).ks, 0.0f) << "model of illumination 10 has no mirror";
}

// A polygon's area, on the side that its corners say, whatever triangles it is cut into.
TEST(OddModels, PolygonsKeepTheirAreaAndSide) {
  const struct {
    const char* name;
    std::string content;
    std::size_t triangles;
    Vec3 area;
  } cases[] = {
      {"quad.obj", "v 0 0 0\nv 2 0 0\nv 2 3 0\nv 0 3 0\nf 1 2 3 4\n", 2, {0, 0, 6}},
      {"turned.obj", "v 0 0 0\nv 2 0 0\nv 2 3 0\nv 0 3 0\nf 4 3 2 1\n", 2, {0, 0, -6}},
      {"arrow.obj", "v 0 0 0\nv 4 1 0\nv 0 2 0\nv 3 1 0\nf 1 2 3 4\n", 2, {0, 0, 1}},
      {"arrow_2.obj", "v 0 0 0\nv 4 1 0\nv 0 2 0\nv 3 1 0\nf 2 3 4 1\n", 2, {0, 0, 1}},
      {"hexagon.obj", "v 0 0 0\nv 2 0 0\nv 3 1 0\nv 2 2 0\nv 0 2 0\nv -1 1 0\nf 1 2 3 4 5 6\n", 4, {0, 0, 6}},
      {"letter.obj", "v 0 0 0\nv 3 0 0\nv 3 1 0\nv 1 1 0\nv 1 3 0\nv 0 3 0\nf 1 2 3 4 5 6\n", 4, {0, 0, 5}},
      {"letter.off", "OFF\n# x\n6 1 0\n0 0 0\n3 0 0\n3 1 0\n1 1 0\n1 3 0\n0 3 0\n6 0 1 2 3 4 5\n", 4, {0, 0, 5}},
  };
  for (const auto& each : cases) {
    SCOPED_TRACE(each.name);
    const tool::Mesh mesh = model_of(each.name, each.content).mesh;
    EXPECT_EQ(mesh.triangles.size(), each.triangles);
    Vec3 sum(0);
    for (const UVec3& t : mesh.triangles) {
      const Vec3 area =
          0.5f * glm::cross(mesh.vertices[t.y] - mesh.vertices[t.x], mesh.vertices[t.z] - mesh.vertices[t.x]);
      EXPECT_GE(glm::dot(area, each.area), 0.0f);
      sum += area;
    }
    EXPECT_EQ(sum, each.area);
  }
}

std::string stl_record(const std::vector<float>& corners, std::uint16_t attribute = 0) {
  const float normal[] = {0, 0, 1};
  std::string bytes(reinterpret_cast<const char*>(normal), sizeof normal);
  bytes.append(reinterpret_cast<const char*>(corners.data()), 36);
  return bytes.append(reinterpret_cast<const char*>(&attribute), 2);
}

std::string binary_stl(std::string head, const std::string& records) {
  head.resize(80, ' ');
  const auto count = static_cast<std::uint32_t>(records.size() / 50);
  return head.append(reinterpret_cast<const char*>(&count), 4) + records;
}

TEST(OddModels, Stl) {
  const std::vector<float> two = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 5, 1, 0, 5, 0, 1, 5};
  const std::string facet =
      "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";
  const std::string other =
      "facet normal 0 0 1\nouter loop\nvertex 0 0 5\nvertex 1 0 5\nvertex 0 1 5\nendloop\nendfacet\n";
  const Odd cases[] = {
      {"blanks.stl",
       "  solid\t x y\r\n\r\n\tfacet   normal\t0 0 1\r\n  outer \t loop\r\nvertex\t0  0 0\r\n vertex 1.0e+00 0 "
       "-0\r\n\t\tvertex +0 1 0 \r\nendloop\r\nendfacet\r\nendsolid\r\n",
       kOne},
      {"no_name.stl", "solid\n" + facet + "endsolid\n", kOne},
      {"two_solids.stl", "solid a\n" + facet + "endsolid a\nsolid b\n" + other + "endsolid b\n", two},
      {"no_end.stl", "solid a\n" + facet, kOne},
      {"solid.stl", binary_stl("solid block made by some program", stl_record(kOne)), kOne},
      {"capital_solid.stl",
       binary_stl("SOLID BLOCK", stl_record({0, 0, 0, 12, 0, 0, 0, 1, 0})),
       {0, 0, 0, 12, 0, 0, 0, 1, 0}},
      {"attributes.stl", binary_stl("x", stl_record(kOne, 0x8FFF)), kOne},
      {"colors.stl", binary_stl("COLOR=\x10\x20\x30\xFF,MATERIAL=", stl_record(kOne, 0x0010)), kOne},
      {"longer.stl", binary_stl("x", stl_record(kOne)) + "and more", kOne},
  };
  for (const Odd& odd : cases) check(odd);
  EXPECT_TRUE(model_of("colors.stl", cases[7].content).mesh.surface.is_empty()) << "colours of attributes are not kept";
}

TEST(OddModels, StlInCapitals) {
  check({"capitals.stl",
         "SOLID X\nFACET NORMAL 0 0 1\nOUTER LOOP\nVERTEX 0 0 0\nVERTEX 1 0 0\nVERTEX 0 1 0\nENDLOOP\n"
         "ENDFACET\nENDSOLID X\n",
         kOne});
}

// Meshes of one triangle, and nodes around it.
std::string gltf_of(const std::string& nodes, const std::string& roots = "0") {
  GltfWriter writer;
  (void)writer.add_floats(kOne, "VEC3", 3);
  return writer.text("\"scenes\":[{\"nodes\":[" + roots + "]}],\"nodes\":[" + nodes +
                     "],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}]");
}

TEST(OddModels, GltfNodes) {
  const std::vector<float> mirrored = {0, 0, 0, 0, 1, 0, -1, 0, 0};
  const Odd cases[] = {
      {"mirrored.gltf", gltf_of("{\"mesh\":0,\"scale\":[-1,1,1]}"), mirrored},
      {"mirrored_matrix.gltf", gltf_of("{\"mesh\":0,\"matrix\":[-1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]}"), mirrored},
      {"mirrored_twice.gltf", gltf_of("{\"children\":[1],\"scale\":[-1,1,1]},{\"mesh\":0,\"scale\":[-1,1,1]}"), kOne},
      {"mirrored_child.gltf",
       gltf_of("{\"children\":[1],\"translation\":[3,0,0]},{\"mesh\":0,\"scale\":[-1,1,1]}"),
       {3, 0, 0, 3, 1, 0, 2, 0, 0}},
      {"mirrored_parent.gltf",
       gltf_of("{\"children\":[1],\"scale\":[-1,1,1]},{\"mesh\":0,\"translation\":[3,0,0]}"),
       {-3, 0, 0, -3, 1, 0, -4, 0, 0}},
      {"inside_out.gltf", gltf_of("{\"mesh\":0,\"scale\":[-1,-1,-1]}"), {0, 0, 0, 0, -1, 0, -1, 0, 0}},
      {"flat.gltf", gltf_of("{\"mesh\":0,\"scale\":[1,0,1]}"), {0, 0, 0, 1, 0, 0, 0, 0, 0}},
      {"instances.gltf",
       gltf_of("{\"children\":[1,2]},{\"mesh\":0},{\"mesh\":0,\"translation\":[0,0,5]}"),
       {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 5, 1, 0, 5, 0, 1, 5}},
      {"roots.gltf",
       gltf_of("{\"mesh\":0},{\"mesh\":0,\"translation\":[0,0,5]}", "1,0"),
       {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 5, 1, 0, 5, 0, 1, 5}},
      {"empty_node.gltf", gltf_of("{\"children\":[1,2]},{},{\"mesh\":0}"), kOne},
      {"unused.gltf", gltf_of("{\"mesh\":0},{\"mesh\":0,\"translation\":[9,9,9]}"), kOne},
      {"translated.gltf",
       gltf_of("{\"mesh\":0,\"matrix\":[1,0,0,0,0,1,0,0,0,0,1,0,7,8,9,1]}"),
       {7, 8, 9, 8, 8, 9, 7, 9, 9}},
      // A quarter turn around z after a scale of its own: T R S.
      {"order.gltf",
       gltf_of("{\"mesh\":0,\"translation\":[1,0,0],\"rotation\":[0,0,0.70710678,0.70710678],\"scale\":"
               "[2,3,1]}"),
       {1, 0, 0, 1, 2, 0, -2, 0, 0}},
  };
  for (const Odd& odd : cases) check(odd);
}

TEST(OddModels, GltfPrimitives) {
  const auto file = [](const std::string& primitive, const std::vector<std::uint8_t>& indices = {}) {
    GltfWriter writer;
    (void)writer.add_floats({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0}, "VEC3", 3);
    if (!indices.empty()) (void)writer.add(indices, kGltfUnsignedByte, "SCALAR", indices.size());
    return writer.binary("\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}],\"meshes\":[{\"primitives\":[" +
                         primitive + "]}]");
  };
  const std::string own = "{\"attributes\":{\"POSITION\":0}", indexed = own + ",\"indices\":1";
  const std::vector<float> strip = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0};
  const std::vector<float> fan = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 1, 1, 0, 0, 0, 0, 1, 1, 0, 0, 2, 0};
  const Odd cases[] = {
      {"bytes.glb", file(indexed + "}", {0, 1, 2}), kOne},
      {"no_indices.glb", file(own + "}"), kOne},
      {"strip.glb", file(own + ",\"mode\":5}"), strip},
      {"strip_indexed.glb", file(indexed + ",\"mode\":5}", {0, 1, 2, 3, 4}), strip},
      {"fan.glb", file(own + ",\"mode\":6}"), fan},
      {"points.glb", file(own + ",\"mode\":0}"), {}, {}, "5 points"},
      {"lines.glb", file(indexed + ",\"mode\":1}", {0, 1, 2, 3}), {}, {}, "2 lines"},
      {"loop.glb", file(own + ",\"mode\":2}"), {}, {}, "5 lines"},
      {"mixed.glb", file(own + ",\"mode\":0}," + indexed + "}", {0, 1, 2}), kOne, {}, "5 points"},
      {"two.glb",
       file(indexed + "}," + own + ",\"mode\":5}", {0, 1, 2}),
       {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0}},
  };
  for (const Odd& odd : cases) check(odd);
}

TEST(OddModels, GltfFiles) {
  GltfWriter writer;
  (void)writer.add_floats(kOne, "VEC3", 3);
  const std::string scene =
      "\"nodes\":[{\"mesh\":0}],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}]";
  const std::string scenes = "\"scenes\":[{\"nodes\":[0]}]," + scene;
  std::string chunk = writer.binary(scenes);
  chunk += std::string("\x04\0\0\0XTRAabcd", 12);  // a chunk of a kind that nobody knows
  chunk[8] = static_cast<char>(chunk.size() & 0xFF);
  chunk[9] = static_cast<char>(chunk.size() >> 8);
  std::string bytes(reinterpret_cast<const char*>(kOne.data()), 36);
  const std::string outside =
      gltf_text({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}, {.buffer_uri = "my%20buffer.bin"});
  const std::string beside = gltf_buffer({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}});
  std::string several = writer.text(scenes);
  several.replace(several.find("{\"nodes\":[0]}"), 13, "{\"nodes\":[0]},{\"nodes\":[0]}");
  std::string second = writer.text(scenes);
  second.replace(second.find("\"scene\":0"), 9, "\"scene\":1");
  second.replace(second.find("{\"nodes\":[0]}"), 13, "{\"nodes\":[]},{\"nodes\":[0]}");
  std::string unnamed = writer.text(scenes);
  unnamed.erase(unnamed.find("\"scene\":0,"), 10);
  std::string spaced = writer.text(scenes);
  spaced.insert(1, "\n\t  \r\n");
  std::string media = writer.text(scenes);
  media.replace(media.find("application/octet-stream"), 24, "application/gltf-buffer");
  const Odd cases[] = {
      {"chunk.glb", chunk, kOne},
      {"buffer.gltf", outside, kOne, {{"my buffer.bin", beside}}},
      {"several.gltf", several, kOne, {}, "1 other scene"},
      {"second.gltf", second, kOne, {}, "1 other scene"},
      {"unnamed.gltf", unnamed, kOne},
      {"spaced.gltf", spaced, kOne},
      {"media.gltf", media, kOne},
  };
  for (const Odd& odd : cases) check(odd);
}

std::string collada(const std::string& asset, const std::string& primitives, const std::string& node = "") {
  return "<?xml version=\"1.0\"?>\n<COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" version=\"1.4.1\">"
         "<asset>" +
         asset +
         "</asset><library_geometries><geometry id=\"g\"><mesh><source id=\"p\">"
         "<float_array id=\"a\" count=\"12\">0 0 0 1 0 0 1 1 0 0 1 0</float_array><technique_common>"
         "<accessor source=\"#a\" count=\"4\" stride=\"3\"><param name=\"X\" type=\"float\"/>"
         "<param name=\"Y\" type=\"float\"/><param name=\"Z\" type=\"float\"/></accessor></technique_common></source>"
         "<vertices id=\"v\"><input semantic=\"POSITION\" source=\"#p\"/></vertices>" +
         primitives +
         "</mesh></geometry></library_geometries><library_visual_scenes><visual_scene id=\"s\"><node id=\"n\">" + node +
         "<instance_geometry url=\"#g\"/></node></visual_scene></library_visual_scenes><scene>"
         "<instance_visual_scene url=\"#s\"/></scene></COLLADA>";
}

// Assimp converts Collada to metres with y up.
TEST(OddModels, Collada) {
  const std::string input = "<input semantic=\"VERTEX\" source=\"#v\" offset=\"0\"/>";
  const std::string triangle = "<triangles count=\"1\">" + input + "<p>0 1 3</p></triangles>";
  const std::string quad = "<polylist count=\"1\">" + input + "<vcount>4</vcount><p>0 1 2 3</p></polylist>";
  const std::string inches = "<unit name=\"inch\" meter=\"0.0254\"/><up_axis>Z_UP</up_axis>";
  const Odd cases[] = {
      {"plain.dae", collada("", triangle), kOne},
      {"y_up.dae", collada("<up_axis>Y_UP</up_axis>", triangle), kOne},
      {"z_up.dae", collada("<up_axis>Z_UP</up_axis>", triangle), {0, 0, 0, 1, 0, 0, 0, 0, -1}},
      {"x_up.dae", collada("<up_axis>X_UP</up_axis>", triangle), {0, 0, 0, 0, 1, 0, -1, 0, 0}},
      {"inches.dae", collada(inches, triangle), {0, 0, 0, 0.0254f, 0, 0, 0, 0, -0.0254f}},
      {"moved.dae",
       collada(inches, triangle, "<translate>0 0 10</translate>"),
       {0, 0.254f, 0, 0.0254f, 0.254f, 0, 0, 0.254f, -0.0254f}},
  };
  for (const Odd& odd : cases) check(odd);
  const ImportedModel model = model_of("a.dae", collada(inches, quad));
  EXPECT_EQ(model.mesh.triangles.size(), 2u);
  EXPECT_EQ(tool::words_of_frame(model.report), "in metres, y up");
}

// Units and axes are reported and nothing is converted.
TEST(OddModels, Fbx) {
  const auto file = [](const std::string& axis, const std::string& sign, const std::string& unit) {
    return "; FBX 7.3.0 project file\nFBXHeaderExtension:  {\n\tFBXHeaderVersion: 1003\n\tFBXVersion: 7300\n}\n"
           "GlobalSettings:  {\n\tVersion: 1000\n\tProperties70:  {\n\t\tP: \"UpAxis\", \"int\", \"Integer\", \"\"," +
           axis + "\n\t\tP: \"UpAxisSign\", \"int\", \"Integer\", \"\"," + sign +
           "\n\t\tP: \"UnitScaleFactor\", \"double\", \"Number\", \"\"," + unit +
           "\n\t}\n}\nDefinitions:  {\n\tVersion: 100\n"
           "\tCount: 2\n}\nObjects:  {\n\tGeometry: 1001, \"Geometry::g\", \"Mesh\" {\n\t\tVertices: *9 {\n\t\t\ta: "
           "0,0,0,1,0,0,0,1,0\n\t\t}\n\t\tPolygonVertexIndex: *3 {\n\t\t\ta: 0,1,-3\n\t\t}\n\t\tGeometryVersion: "
           "124\n\t}\n"
           "\tModel: 1002, \"Model::m\", \"Mesh\" {\n\t\tVersion: 232\n\t\tProperties70:  {\n\t\t\tP: \"Lcl "
           "Translation\", "
           "\"Lcl Translation\", \"\", \"A\",5,0,0\n\t\t}\n\t}\n}\nConnections:  {\n\tC: \"OO\",1002,0\n"
           "\tC: \"OO\",1001,1002\n}\n";
  };
  check({"inches.fbx", file("2", "1", "2.54"), {5, 0, 0, 6, 0, 0, 5, 1, 0}});
  const auto frame = [&](const std::string& axis, const std::string& sign, const std::string& unit) {
    return tool::words_of_frame(model_of("a.fbx", file(axis, sign, unit)).report);
  };
  EXPECT_EQ(frame("2", "1", "2.54"), "in inches, z up");
  EXPECT_EQ(frame("1", "-1", "1"), "in centimetres, -y up");
  EXPECT_EQ(frame("0", "1", "100"), "in metres, x up");
  EXPECT_EQ(frame("1", "1", "7"), "in units of 0.07 m, y up");
}

// This program's own reader and Assimp's agree.
TEST(OddModels, Ply) {
  const std::string text =
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 2\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n"
      "3 0 1 2\n3 0 2 3\n";
  const TemporaryFolder folder("a.ply", text);
  tool::InputReader reader(folder.path("a.ply"), "expected a mesh");
  const ImportedModel model = tool::import_model(reader.read_all(), {.path = folder.path("a.ply"), .ending = "ply"});
  expect_triangles(triangles_of(model.mesh), triangles_of({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 0, 0, 1, 1, 0, 0, 1, 0}));
}

}  // namespace
}  // namespace gridiron::test
