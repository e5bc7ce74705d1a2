// Hostile and damaged models: each ends with a mesh or with an error that names the file, within its limits.
// SPDX-License-Identifier: Apache-2.0
#include "base/failure.h"
#include "gltf_writer.h"
#include "model_files.h"
#include "support/sanitizers.h"
#include "temporary_folder.h"

namespace gridiron::test {
namespace {

const tool::ImportOptions kLimits = {.memory_bytes = std::uint64_t{512} << 20, .most_seconds = 3};

// @returns the error; empty: a mesh. Anything else ends the test.
std::string error_of(const TemporaryFolder& folder, const std::string& name,
                     const tool::ImportOptions& options = kLimits) {
  try {
    const tool::Mesh mesh = import_file(folder.path(name), options).mesh;
    for (const UVec3& t : mesh.triangles) {
      for (int i = 0; i < 3; ++i) EXPECT_LT(t[i], mesh.vertices.size());
    }
    return "";
  } catch (const tool::Failure& failure) {
    EXPECT_EQ(failure.code(), tool::ExitCode::kBadInput);
    const std::string words = failure.what(), path = folder.path(name).string();
    EXPECT_EQ(words.substr(0, path.size() + 2), path + ": ") << words;
    EXPECT_GT(words.size(), path.size() + 10) << words;
    return words;
  }
}

std::string error_of_file(const std::string& name, const std::string& content) {
  return error_of(TemporaryFolder(name, content), name);
}

const TestMesh& small() {
  static const TestMesh mesh = rounded(make_box({0, 0, 0}, {1, 1, 1}));
  return mesh;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t place = text.find(from);
  EXPECT_NE(place, std::string::npos) << from;
  return place == std::string::npos ? text : text.replace(place, from.size(), to);
}

std::string repeated(const std::string& text, std::size_t count) {
  std::string all;
  all.reserve(text.size() * count);
  for (std::size_t i = 0; i < count; ++i) all += text;
  return all;
}

// A chain of nodes, or children that are their own ancestors.
std::string gltf_of_nodes(const std::string& nodes) {
  return "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[" + nodes + "]}";
}

std::string chain_of_nodes(std::size_t count) {
  std::string nodes;
  for (std::size_t i = 0; i + 1 < count; ++i) nodes += "{\"children\":[" + std::to_string(i + 1) + "]},";
  return gltf_of_nodes(nodes + "{}");
}

struct Hostile {
  const char* name;
  std::string content;
  bool must_fail = true;
};

std::vector<Hostile> hostile_texts() {
  const std::string gltf = gltf_text(small()), stl = stl_bytes(small());
  std::string huge_stl = stl;
  huge_stl.replace(80, 4, "\xFF\xFF\xFF\xFF");
  std::string nan_stl = stl;
  nan_stl.replace(96, 4, std::string("\0\0\xC0\x7F", 4));
  return {
      {"index.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 99\n"},
      {"negative.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf -1 -2 -9\n"},
      {"zero.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 0 1 2\n"},
      {"large.obj", "v 0 0 0\nf 99999999999999999999 1 1\n"},
      {"nan.obj", "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"},
      {"infinite.obj", "v 1e999 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"},
      {"no_faces.obj", "v 0 0 0\nv 1 0 0\n", false},
      {"half.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2", false},
      {"empty_face.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf\nf 1 2 3\n", false},
      {"slashes.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1//// 2/// 3/\n", false},
      {"long_line.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf" + repeated(" 1 2 3", 20000) + "\n", false},
      {"own_library.obj", "mtllib own_library.obj\n" + obj_text(small()), false},
      {"device.obj", "mtllib /dev/zero\n" + obj_text(small()), false},
      {"folder.obj", "mtllib .\n" + obj_text(small()), false},
      {"words.obj", repeated("mtllib x\nusemtl y\no z\ng w\n", 2000) + obj_text(small()), false},
      {"bytes.obj", "v 0 0 0\n" + std::string(5000, '\xFF'), false},
      {"huge.stl", huge_stl},
      {"nan.stl", nan_stl},
      {"short.stl", stl.substr(0, 200)},
      {"header.stl", stl.substr(0, 84), false},
      {"words.stl", "solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0\n", false},
      {"endless.stl", "solid x\n" + repeated("facet normal 0 0 1\n", 5000), false},
      {"numbers.stl", "solid x\nfacet normal a b c\nouter loop\nvertex x y z\nvertex 1 2\nendloop\n", false},
      {"asset.gltf", "{\"asset\":{}}"},
      {"version.gltf", "{\"asset\":{\"version\":\"7.0\"}}"},
      {"empty.gltf", "{\"asset\":{\"version\":\"2.0\"}}", false},
      {"broken.gltf", gltf.substr(0, gltf.size() / 2)},
      {"self.gltf", gltf_of_nodes("{\"children\":[0]}"), false},
      {"ring.gltf", gltf_of_nodes("{\"children\":[1]},{\"children\":[0]}"), false},
      {"fan.gltf", gltf_of_nodes("{\"children\":[1,1,1,1]},{\"children\":[2,2,2,2]},{}"), false},
      {"lost_child.gltf", gltf_of_nodes("{\"children\":[77]}"), false},
      {"deep_nodes.gltf", chain_of_nodes(100000), false},
      {"deep_text.gltf", "{\"asset\":{\"version\":\"2.0\"},\"x\":" + repeated("[", 200000)},
      {"scene.gltf", replaced(gltf, "\"scene\":0", "\"scene\":9"), false},
      {"mesh.gltf", replaced(gltf, "\"mesh\":0", "\"mesh\":9"), false},
      {"accessor.gltf", replaced(gltf, "\"POSITION\":0", "\"POSITION\":99")},
      {"indices.gltf", replaced(gltf, "\"indices\":1", "\"indices\":99"), false},
      {"types.gltf", replaced(gltf, "\"VEC3\"", "\"MAT4\""), false},
      {"kind.gltf", replaced(gltf, "\"componentType\":5126", "\"componentType\":1"), false},
      {"words.gltf", replaced(gltf, "\"count\":8", "\"count\":\"many\""), false},
      {"count.gltf", replaced(gltf, "\"count\":8", "\"count\":4000000000"), false},
      {"minus.gltf", replaced(gltf, "\"count\":8", "\"count\":-1"), false},
      {"few.gltf", replaced(gltf, "\"count\":8", "\"count\":2")},
      {"view.gltf", replaced(gltf, "\"bufferView\":0", "\"bufferView\":50"), false},
      {"offset.gltf", replaced(gltf, "\"byteOffset\":0", "\"byteOffset\":4294967295"), false},
      {"length.gltf", replaced(gltf, "\"byteLength\":96", "\"byteLength\":18446744073709551615"), false},
      {"stride.gltf", replaced(gltf, "\"byteOffset\":0", "\"byteStride\":255,\"byteOffset\":0"), false},
      {"buffer.gltf", gltf_text(small(), {.buffer_uri = "lost.bin"})},
      {"own_buffer.gltf", gltf_text(small(), {.buffer_uri = "own_buffer.gltf"}), false},
      {"device.gltf", gltf_text(small(), {.buffer_uri = "/dev/zero"})},
      {"data.gltf", gltf_text(small(), {.buffer_uri = "data:application/octet-stream;base64,!!!!"}), false},
      {"short_data.gltf", gltf_text(small(), {.buffer_uri = "data:application/octet-stream;base64,AAAA"}), false},
      {"scale.gltf", gltf_text(small(), {.node = "\"mesh\":0,\"scale\":[1e38,1e38,1e38],"
                                                 "\"translation\":[3e38,3e38,3e38]"})},
      {"matrix.gltf", gltf_text(small(), {.node = "\"mesh\":0,\"matrix\":[1,2]"}), false},
      {"rotation.gltf", gltf_text(small(), {.node = "\"mesh\":0,\"rotation\":[0,0,0,0]"}), false},
      {"nothing.glb", "glTF"},
      {"length.glb", glb_of("{\"asset\":{\"version\":\"2.0\"}}", "").replace(8, 4, "\xFF\xFF\xFF\xFF"), false},
      {"json_length.glb", glb_bytes(small()).replace(12, 4, "\xFF\xFF\xFF\x7F")},
      {"version.glb", glb_bytes(small()).replace(4, 4, "\x09\x09\x09\x09")},
      {"no_buffer.glb", glb_of("{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"byteLength\":100}]}", ""), false},
      {"off.off", "OFF\n4000000000 4000000000 0\n"},
      {"faces.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 9\n", false},
      {"words.dae", "<?xml version=\"1.0\"?><COLLADA version=\"1.4.0\">" + repeated("<node>", 50000)},
      {"words.x3d", "<?xml version=\"1.0\"?><X3D>" + repeated("<Group>", 50000), false},
      {"fbx.fbx", "Kaydara FBX Binary  \0\x1A\0" + std::string(200, '\xFF')},
      {"3ds.3ds", std::string("MM") + std::string(100, '\xFF')},
      {"blend.blend", "BLENDER-v279" + std::string(300, '\x41')},
  };
}

TEST(HostileModels, EachEndsWithAMeshOrAnErrorThatNamesIt) {
  const std::vector<Hostile> files = hostile_texts();
  EXPECT_GE(files.size(), 60u);
  for (const Hostile& file : files) {
    SCOPED_TRACE(file.name);
    const std::string error = error_of_file(file.name, file.content);
    EXPECT_FALSE(file.must_fail && error.empty());
  }
}

// Cut at places all over the file, and with bytes replaced at random. The seed reruns a case.
TEST(HostileModels, DamagedTextsAreNamedByTheirLine) {
  std::string text = gltf_text(small());
  const std::string half = error_of_file("a.gltf", text.substr(0, text.size() - 9));
  EXPECT_NE(half.find("a.gltf: its JSON ends early"), std::string::npos) << half;
  text.insert(text.find('{') + 1, "\n\n,");
  EXPECT_NE(error_of_file("a.gltf", text).find("a.gltf: its JSON is wrong in line 3"), std::string::npos);
  EXPECT_NE(error_of_file("a.glb", std::string("glTF\1\0\0\0\24\0\0\0{}", 14)).find("version 2"), std::string::npos);
}

TEST(HostileModels, DamagedFilesAreNoDanger) {
  const std::vector<Vec3> normals(small().vertices.size(), Vec3(0, 0, 1));
  const std::vector<std::array<float, 2>> uvs(small().vertices.size(), {0.5f, 0.5f});
  const GltfParts parts = {.material = "\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0}}",
                           .normals = normals, .uvs = uvs,
                           .picture = png_bytes(2, 2, std::vector<std::array<std::uint8_t, 3>>(4))};
  const struct { const char* name; std::string content; } good[] = {
      {"a.obj", obj_text(small())}, {"a.stl", stl_bytes(small())}, {"b.stl", stl_text(small())},
      {"a.gltf", gltf_text(small(), parts)}, {"a.glb", glb_bytes(small(), parts)}};
  for (const auto& file : good) {
    for (std::uint64_t seed = 0; seed < 12; ++seed) {
      SCOPED_TRACE(std::string(file.name) + ", seed " + std::to_string(seed));
      TestRandom random(seed);
      std::string content = file.content;
      if (seed % 3 == 0) {
        content.resize(1 + random.below(static_cast<std::uint32_t>(content.size() - 1)));
      } else {
        for (std::uint64_t i = 0; i < seed; ++i) {
          content[random.below(static_cast<std::uint32_t>(content.size()))] = static_cast<char>(random.next());
        }
      }
      (void)error_of_file(file.name, content);
    }
  }
}

// Skin, morph targets, animation, integers, sparse numbers.
std::string moving_gltf() {
  GltfWriter writer;
  const std::vector<float> corners = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  const std::size_t place_view = writer.add_view("\1\0", 2), value_view = writer.add_view(corners.data(), 12);
  (void)writer.add(std::vector<std::int16_t>{0, 0, 0, 9, 0, 0, 0, 9, 0}, kGltfShort, "VEC3", 3);
  (void)writer.add_accessor(writer.add_view(corners.data(), 36), kGltfFloat, "VEC3", 3,
                            ",\"sparse\":{\"count\":1,\"indices\":{\"bufferView\":" + std::to_string(place_view) +
                                ",\"componentType\":5121},\"values\":{\"bufferView\":" + std::to_string(value_view) +
                                "}}");
  (void)writer.add(std::vector<std::uint8_t>(12, 0), kGltfUnsignedByte, "VEC4", 3);
  (void)writer.add(std::vector<std::uint8_t>(12, 60), kGltfUnsignedByte, "VEC4", 3, ",\"normalized\":true");
  (void)writer.add(std::vector<float>{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}, kGltfFloat, "MAT4", 1);
  (void)writer.add_floats({0, 1}, "SCALAR", 1);
  (void)writer.add_floats({0, 0, 0, 0, 1, 0}, "SCALAR", 1);
  (void)writer.add_floats({0, 0, 0, 1, 0, 0, 1, 0}, "VEC4", 4);
  return writer.text(
      "\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"children\":[1,2],\"mesh\":0},{\"mesh\":0,\"skin\":0},{}],\"skins\":[{"
      "\"joints\":[2],\"inverseBindMatrices\":4}],\"meshes\":[{\"weights\":[1],\"primitives\":[{\"attributes\":{"
      "\"POSITION\":0,\"JOINTS_0\":2,\"WEIGHTS_0\":3},\"targets\":[{\"POSITION\":1}]}]}],\"animations\":[{\"channels\":"
      "[{"
      "\"sampler\":0,\"target\":{\"node\":0,\"path\":\"weights\"}},{\"sampler\":1,\"target\":{\"node\":2,\"path\":"
      "\"rotation\"}}],\"samplers\":[{\"input\":5,\"output\":6,\"interpolation\":\"CUBICSPLINE\"},{\"input\":5,"
      "\"output\":7}]}]");
}

TEST(HostileModels, DamagedAnimationsAreNoDanger) {
  tool::ImportOptions options = kLimits;
  options.moment = 0.5;
  const std::string good = moving_gltf();
  EXPECT_EQ(error_of(TemporaryFolder("a.gltf", good), "a.gltf", options), "");
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    TestRandom random(seed);
    std::string content = good;
    for (std::uint64_t i = 0; i <= seed % 5; ++i) {
      // A digit, so that the text stays one of glTF.
      const std::size_t place =
          content.find_first_of("0123456789", random.below(static_cast<std::uint32_t>(good.size())));
      if (place != std::string::npos) content[place] = static_cast<char>('0' + random.below(10));
    }
    (void)error_of(TemporaryFolder("a.gltf", content), "a.gltf", options);
  }
}

// Nodes that show one mesh 4^12 times: more triangles than memory.
TEST(HostileModels, BombsOfMemoryEndAtTheLimit) {
#if defined(GRIDIRON_TEST_SANITIZED)
  GTEST_SKIP() << "not under sanitizers";
#endif
  std::string gltf = gltf_text(small()), nodes = "{\"children\":[1,2,3,4]}";
  constexpr int kLevels = 12;
  for (int level = 1; level <= kLevels; ++level) {
    for (int i = 0; i < 4; ++i) {
      const int first = 4 * level + 1;
      nodes += level == kLevels ? ",{\"mesh\":0}"
                                : ",{\"children\":[" + std::to_string(first) + "," + std::to_string(first + 1) + "," +
                                      std::to_string(first + 2) + "," + std::to_string(first + 3) + "]}";
    }
  }
  gltf = replaced(gltf, "\"nodes\":[{\"mesh\":0}]", "\"nodes\":[" + nodes + "]");
  const std::string error = error_of_file("bomb.gltf", gltf);
  EXPECT_NE(error.find("--import-"), std::string::npos) << error;
}

// A limit that has passed before any answer can come: how fast the machine is does not matter.
TEST(HostileModels, LimitsOfTimeHold) {
  const TemporaryFolder folder("late.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  EXPECT_EQ(error_of(folder, "late.obj"), "");
  const std::string error =
      error_of(folder, "late.obj", {.memory_bytes = std::uint64_t{512} << 20, .most_seconds = 0});
  EXPECT_NE(error.find("takes more than 0 s; --import-time allows more"), std::string::npos) << error;
}

}  // namespace
}  // namespace gridiron::test
