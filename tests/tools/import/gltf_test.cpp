// What glTF files hold beside triangles of floats: textures and their places, colours, integers, sparse and interleaved
// numbers, extensions. SPDX-License-Identifier: Apache-2.0
#include "gltf_writer.h"
#include "import/srgb.h"
#include "model_files.h"
#include "support/sanitizers.h"
#include "support/test_headers.h"

namespace gridiron::test {
namespace {

using tool::ImportedModel;

constexpr const char* kScene = "\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}]";

// A triangle whose corners lie at the given places of a picture with 4 x 4 texels. Columns differ in red, rows in
// green.
struct Textured {
  GltfWriter writer;
  std::string attributes;

  Textured() {
    attributes = "\"POSITION\":" + std::to_string(writer.add_floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3", 3));
  }

  void add_places(const std::vector<float>& places, int set) {
    attributes += ",\"TEXCOORD_" + std::to_string(set) + "\":" + std::to_string(writer.add_floats(places, "VEC2", 2));
  }
  [[nodiscard]] ImportedModel model(const std::string& texture, const std::string& sampler = "",
                                    const std::string& more = "", const std::string& factor = "") {
    std::vector<std::array<std::uint8_t, 3>> texels;
    for (int row = 0; row < 4; ++row) {
      for (int column = 0; column < 4; ++column) {
        texels.push_back({static_cast<std::uint8_t>(80 * column), static_cast<std::uint8_t>(80 * row), 0});
      }
    }
    const std::string picture = png_bytes(4, 4, texels);
    const std::size_t view = writer.add_view(picture.data(), picture.size());
    return model_of("a.glb",
                    writer.binary(std::string(kScene) + ",\"meshes\":[{\"primitives\":[{\"attributes\":{" + attributes +
                                  "},\"material\":0}]}],\"materials\":[{\"pbrMetallicRoughness\":{" + factor +
                                  "\"baseColorTexture\":{\"index\":0" + texture + "}}}],\"textures\":[{\"source\":0" +
                                  (sampler.empty() ? "" : ",\"sampler\":0") + "}],\"images\":[{\"bufferView\":" +
                                  std::to_string(view) + ",\"mimeType\":\"image/png\"}]" +
                                  (sampler.empty() ? "" : ",\"samplers\":[{" + sampler + "}]") + more));
  }
};

// The middle of a texel, counted from the left and from the top.
float middle(int index) {
  return (static_cast<float>(index) + 0.5f) / 4;
}

Vec3 texel(int column, int row) {
  const auto light = [](int level) { return tool::linear_of_srgb(static_cast<float>(80 * level) / 255); };
  return {light(column), light(row), 0};
}

// All corners at one place, so that the footprint is a point.
std::vector<float> thrice(float u, float v) {
  return {u, v, u, v, u, v};
}

TEST(GltfTextures, WrapModesAreThoseOfTheSampler) {
  constexpr const char *kClamp = "33071", *kMirror = "33648", *kRepeat = "10497";
  const auto color = [](const char* wrap_u, const char* wrap_v) {
    Textured file;
    file.add_places(thrice(middle(5), middle(-2)), 0);
    return file.model("", "\"wrapS\":" + std::string(wrap_u) + ",\"wrapT\":" + wrap_v).mesh;
  };
  expect_color(color(kRepeat, kRepeat), 0, 0, texel(1, 2));
  expect_color(color(kClamp, kRepeat), 0, 0, texel(3, 2));
  expect_color(color(kRepeat, kClamp), 0, 0, texel(1, 0));
  expect_color(color(kMirror, kMirror), 0, 0, texel(2, 1));
  Textured usual;
  usual.add_places(thrice(middle(5), middle(-2)), 0);
  expect_color(usual.model("").mesh, 0, 0, texel(1, 2));
}

TEST(GltfTextures, ASecondSetOfPlacesIsUsed) {
  Textured file;
  file.add_places(thrice(middle(0), middle(0)), 0);
  file.add_places(thrice(middle(2), middle(3)), 1);
  expect_color(file.model(",\"texCoord\":1").mesh, 0, 0, texel(2, 3));
}

TEST(GltfTextures, MissingPlacesAreReported) {
  Textured file;
  file.add_places(thrice(middle(0), middle(0)), 0);
  const ImportedModel model = file.model(",\"texCoord\":1");
  EXPECT_TRUE(model.mesh.surface.triangle_colors.empty());
  EXPECT_TRUE(ignores(model, "the texture of 1 mesh without texture coordinates"))
      << testing::PrintToString(model.report.ignored);
}

// Of the specification: offset, then rotation, then scale; a quarter turn shows the lower left quarter of the picture.
TEST(GltfTextures, PlacesAreTransformed) {
  const auto color = [](const std::string& transform, float u, float v) {
    Textured file;
    file.add_places(thrice(u, v), 0);
    file.add_places(thrice(middle(1), middle(1)), 1);
    const ImportedModel model = file.model(",\"extensions\":{\"KHR_texture_transform\":{" + transform + "}}", "",
                                           ",\"extensionsUsed\":[\"KHR_texture_transform\"]");
    EXPECT_TRUE(model.report.ignored.empty()) << testing::PrintToString(model.report.ignored);
    return model.mesh;
  };
  expect_color(color("", middle(1), middle(2)), 0, 0, texel(1, 2));
  expect_color(color("\"offset\":[0.25,-0.5]", middle(1), middle(3)), 0, 0, texel(2, 1));
  expect_color(color("\"scale\":[0.5,2]", 0.25f, middle(3) / 2), 0, 0, texel(0, 3), 0.06f);
  expect_color(color("\"scale\":[0.5,2]", middle(2) * 2, middle(3) / 2), 0, 0, texel(2, 3));
  expect_color(color("\"offset\":[0,1],\"scale\":[1,-1]", middle(1), middle(0)), 0, 0, texel(1, 3));
  // u' = v / 2 and v' = 1 - u / 2.
  const std::string quarter = "\"offset\":[0,1],\"rotation\":1.57079632679,\"scale\":[0.5,0.5]";
  expect_color(color(quarter, 0.25f, 0.75f), 0, 0, texel(1, 3));
  expect_color(color(quarter, 0.75f, 0.25f), 0, 0, texel(0, 2));
  expect_color(color("\"texCoord\":1", middle(3), middle(3)), 0, 0, texel(1, 1));
}

// Factor times texture times colour of the vertex, all linear.
TEST(GltfTextures, FactorsTexturesAndColoursAreMultiplied) {
  Textured file;
  file.add_places(thrice(middle(3), middle(3)), 0);
  const std::vector<std::uint16_t> colors = {65535, 32768, 65535, 65535, 65535, 65535,
                                             65535, 65535, 0,     65535, 65535, 65535};
  file.attributes +=
      ",\"COLOR_0\":" + std::to_string(file.writer.add(colors, kGltfUnsignedShort, "VEC4", 3, ",\"normalized\":true"));
  const ImportedModel model = file.model("", "", "", "\"baseColorFactor\":[0.5,1,1,1],");
  const float light = tool::linear_of_srgb(240.0f / 255);
  expect_color(model.mesh, 0, 0, Vec3(0.5f * light, 0.5f * light, 0));
  expect_color(model.mesh, 0, 1, Vec3(0.5f * light, light, 0));
  expect_color(model.mesh, 0, 2, Vec3(0, light, 0));
  EXPECT_EQ(model.report.textures, 1u);
}

TEST(GltfTextures, PlacesMayBeIntegers) {
  Textured file;
  const std::vector<std::uint16_t> places = {40959, 8192, 40959, 8192, 40959, 8192};  // 0.625, 0.125
  file.attributes += ",\"TEXCOORD_0\":" +
                     std::to_string(file.writer.add(places, kGltfUnsignedShort, "VEC2", 3, ",\"normalized\":true"));
  expect_color(file.model("").mesh, 0, 0, texel(2, 0));
}

TEST(Gltf, CoordinatesMayBeIntegers) {
  GltfWriter writer;
  const std::vector<std::int16_t> places = {0, 0, 0, 0, 100, 0, 0, 0, 0, 50, -7, 0};
  const std::size_t view = writer.add_view(places.data(), 2 * places.size(), ",\"byteStride\":8");
  const std::size_t position = writer.add_accessor(view, kGltfShort, "VEC3", 3);
  const std::vector<std::int8_t> normals = {0, 0, 127, 0, 0, 0, 127, 0, 0, 0, -127, 0};
  const std::size_t normal_view = writer.add_view(normals.data(), normals.size(), ",\"byteStride\":4");
  const std::size_t normal = writer.add_accessor(normal_view, kGltfByte, "VEC3", 3, ",\"normalized\":true");
  const std::string text = writer.text(
      "\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0,\"scale\":[0.01,0.01,0.01]}],\"extensionsUsed\":["
      "\"KHR_mesh_quantization\"],\"extensionsRequired\":[\"KHR_mesh_quantization\"],\"meshes\":[{\"primitives\":[{"
      "\"attributes\":{\"POSITION\":" +
      std::to_string(position) + ",\"NORMAL\":" + std::to_string(normal) + "}}]}]");
  const ImportedModel model = model_of("a.gltf", text);
  EXPECT_TRUE(model.report.ignored.empty());
  expect_corner(model.mesh, 0, 0, Vec3(0, 0, 0));
  expect_corner(model.mesh, 0, 1, Vec3(1, 0, 0));
  expect_corner(model.mesh, 0, 2, Vec3(0, 0.5f, -0.07f));
  const UVec3 corners = model.mesh.surface.triangle_normals.at(0);
  EXPECT_EQ(model.mesh.surface.normals.at(corners.x), Vec3(0, 0, 1));
  EXPECT_EQ(model.mesh.surface.normals.at(corners.z), Vec3(0, 0, -1));
}

// Positions and normals side by side, with two words between vertices; the second vertex is replaced.
TEST(Gltf, NumbersMayBeInterleavedAndSparse) {
#if defined(GRIDIRON_TEST_SANITIZED)
  GTEST_SKIP() << "Assimp 5.2 copies bytes behind the last of strided numbers, where the sanitizer ends it";
#endif
  GltfWriter writer;
  const std::vector<float> mixed = {0, 0, 0, 0, 0, 1, 99, 99, 9, 9, 9, 0, 0, 1, 99, 99, 0, 1, 0, 0, 0, 1, 99, 99};
  const std::size_t view = writer.add_view(mixed.data(), 4 * mixed.size(), ",\"byteStride\":32");
  const std::vector<std::uint16_t> places = {1};
  const std::size_t index_view = writer.add_view(places.data(), 2);
  const std::vector<float> values = {5, 0, 0};
  const std::size_t value_view = writer.add_view(values.data(), 12);
  const std::size_t position = writer.add_accessor(
      view, kGltfFloat, "VEC3", 3,
      ",\"sparse\":{\"count\":1,\"indices\":{\"bufferView\":" + std::to_string(index_view) +
          ",\"componentType\":5123},\"values\":{\"bufferView\":" + std::to_string(value_view) + "}}");
  const std::size_t normal = writer.add_accessor(view, kGltfFloat, "VEC3", 3, ",\"byteOffset\":12");
  const std::string text = writer.text(
      std::string(kScene) + ",\"meshes\":[{\"primitives\":[{\"attributes\":{\"NORMAL\":" + std::to_string(normal) +
      ",\"POSITION\":" + std::to_string(position) + "}}]}]");
  const ImportedModel model = model_of("a.gltf", text);
  expect_corner(model.mesh, 0, 0, Vec3(0, 0, 0));
  expect_corner(model.mesh, 0, 1, Vec3(5, 0, 0));
  expect_corner(model.mesh, 0, 2, Vec3(0, 1, 0));
  EXPECT_EQ(model.mesh.surface.normals.at(model.mesh.surface.triangle_normals.at(0).y), Vec3(0, 0, 1));
}

std::string with_extensions(const std::string& used, const std::string& required) {
  GltfWriter writer;
  (void)writer.add_floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3", 3);
  return writer.text(std::string(kScene) + ",\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}]" +
                     ",\"extensionsUsed\":[" + used + "]" +
                     (required.empty() ? "" : ",\"extensionsRequired\":[" + required + "]"));
}

TEST(Gltf, ExtensionsThatMakeNoDifferenceAreReported) {
  const ImportedModel model = model_of(
      "a.gltf",
      with_extensions("\"KHR_materials_sheen\",\"KHR_materials_ior\",\"VENDOR_x\"", "\"KHR_materials_sheen\""));
  EXPECT_EQ(model.mesh.triangles.size(), 1u);
  EXPECT_TRUE(ignores(model, "the extensions 'KHR_materials_sheen' and 'VENDOR_x'"))
      << testing::PrintToString(model.report.ignored);
}

TEST(Gltf, ExtensionsThatAreRequiredMustBeKnown) {
  const std::string reason =
      reason_of("a.gltf", with_extensions("\"EXT_meshopt_compression\"", "\"EXT_meshopt_compression\""));
  EXPECT_NE(reason.find("a.gltf: requires the glTF extension 'EXT_meshopt_compression', which is not read"),
            std::string::npos)
      << reason;
}

TEST(Gltf, SkinsWithoutMatricesAreRefused) {
  GltfWriter writer;
  (void)writer.add_floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3", 3);
  const std::string text = writer.text(
      "\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0,\"skin\":0}],\"skins\":[{\"joints\":[0]}],\"meshes\":[{"
      "\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}]");
  const std::string reason = reason_of("a.gltf", text);
  EXPECT_NE(reason.find("a.gltf: has a skin without inverseBindMatrices"), std::string::npos) << reason;
}

TEST(Gltf, WhatMaterialsLoseIsReported) {
  GltfWriter writer;
  (void)writer.add_floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3", 3);
  const std::string text = writer.text(
      std::string(kScene) +
      ",\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"material\":0}]}],\"materials\":[{"
      "\"alphaMode\":\"MASK\",\"emissiveFactor\":[1,0.5,0],\"normalTexture\":{\"index\":0},"
      "\"pbrMetallicRoughness\":{\"metallicRoughnessTexture\":{\"index\":0}}}],\"textures\":[{\"source\":0}],"
      "\"images\":[{\"uri\":\"a.png\"}]");
  const ImportedModel model = model_of("a.gltf", text);
  EXPECT_TRUE(ignores(model, "cut-outs of 1 material")) << testing::PrintToString(model.report.ignored);
  EXPECT_TRUE(ignores(model, "emission of 1 material"));
  EXPECT_TRUE(ignores(model, "1 texture of something other than base colour"));
}

TEST(Gltf, ColoursOfSpecularGlossinessAreUsed) {
  GltfWriter writer;
  (void)writer.add_floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3", 3);
  const std::string text = writer.text(
      std::string(kScene) +
      ",\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"material\":0}]}],\"materials\":[{"
      "\"extensions\":{"
      "\"KHR_materials_pbrSpecularGlossiness\":{\"diffuseFactor\":[0.25,0.5,0.75,1],\"specularFactor\":[0.8,0.8,0.8],"
      "\"glossinessFactor\":1}}}],\"extensionsUsed\":[\"KHR_materials_pbrSpecularGlossiness\"]");
  const ImportedModel model = model_of("a.gltf", text);
  const tool::SceneMaterial& material = model.mesh.surface.materials.at(0);
  EXPECT_EQ(material.color, Vec3(0.25f, 0.5f, 0.75f));
  EXPECT_NEAR(material.ks, 0.8f, 1e-5f);
}

}  // namespace
}  // namespace gridiron::test
