// Normals and colours of PLY inputs, for every format, type and chunking; and inputs whose attributes are incomplete.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/io/ply_reader.h>

#include "core/io/ply_run.h"

namespace gridiron::test {
namespace {

using Values = std::vector<std::array<float, 3>>;

const std::array<const char*, 6> kNames = {"nx", "ny", "nz", "red", "green", "blue"};

// Seven vertices; the normal of vertex i is (i, 2 i, 3), its colour (10 i, 20 i, 255) in steps of 255.
constexpr int kVertices = 7;

std::string attribute_file(PlyFormat format, std::string_view normal_type, std::string_view color_type,
                           double color_unit, bool colors_first = false) {
  PlyMaker maker(format);
  maker.line("element vertex " + std::to_string(kVertices));
  const auto declare = [&](std::size_t first) {
    for (std::size_t i = first; i < first + 3; ++i) {
      maker.line("property " + std::string(first == 0 ? normal_type : color_type) + " " + kNames[i]);
    }
  };
  if (colors_first) declare(3);
  maker.coordinates("float");
  maker.line("property uchar alpha");
  declare(0);
  if (!colors_first) declare(3);
  maker.end_header();
  for (int i = 0; i < kVertices; ++i) {
    const auto normal = [&] {
      for (const int value : {i, 2 * i, 3}) maker.value(normal_type, value);
    };
    const auto color = [&] {
      for (const int value : {10 * i, 20 * i, 127}) maker.value(color_type, value * color_unit);
    };
    if (colors_first) color();
    for (const int value : {i, i, i}) maker.value("float", value);
    maker.value("uchar", 200);
    normal();
    if (!colors_first) color();
    maker.end_row();
  }
  return maker.text();
}

TEST(PlyAttributes, OfEveryFormatAndType) {
  Values normals, colors;
  for (int i = 0; i < kVertices; ++i) {
    const auto f = [](int value) { return static_cast<float>(value); };
    normals.push_back({f(i), f(2 * i), 3.0f});
    colors.push_back({f(10 * i) / 255.0f, f(20 * i) / 255.0f, 127.0f / 255.0f});
  }
  for (const PlyFormat format : kPlyFormats) {
    for (const std::string_view type : kPlyTypes) {
      const bool is_float = type == "float" || type == "double";
      const double unit = is_float ? 1.0 / 255.0 : type == "ushort" ? 257.0 : 1.0;
      for (const bool colors_first : {false, true}) {
        const PlyOutcome got = run_ply_in_pieces(attribute_file(format, type, type, unit, colors_first));
        ASSERT_EQ(got.error, PlyError::kNone);
        EXPECT_EQ(got.normals, normals) << type;
        ASSERT_EQ(got.colors.size(), colors.size());
        for (std::size_t i = 0; i < colors.size(); ++i) {
          for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(got.colors[i][c], colors[i][c], 1e-6f) << type << i;
        }
      }
    }
  }
}

TEST(PlyAttributes, ValuesThatAreNoneBecomeZeroOrTheLimit) {
  const std::string input =
      "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n"
      "property float nx\nproperty float ny\nproperty float nz\nproperty float red\nproperty float green\n"
      "property float blue\nend_header\n1 2 3 nan inf 1e999 nan -3 7\n1 2 3 1 2 3 0.5 1 0\n";
  const PlyOutcome got = run_ply_in_pieces(input);
  ASSERT_EQ(got.error, PlyError::kNone);
  EXPECT_EQ(got.normals, (Values{{0, 0, 0}, {1, 2, 3}}));
  EXPECT_EQ(got.colors, (Values{{0, 0, 1}, {0.5f, 1, 0}}));
}

TEST(PlyAttributes, IncompleteOnesAreSkipped) {
  const Values none(1, {-77, -77, -77});
  for (const char* const lines : {"property float nx\nproperty float ny\nproperty uchar red\nproperty uchar green\n",
                                  "property float nx\nproperty list uchar float nz\nproperty uchar red\n"}) {
    const bool has_list = std::string_view(lines).find("list") != std::string_view::npos;
    const std::string input = std::string("ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\n"
                                          "property float y\nproperty float z\n") +
                              lines + "end_header\n" + (has_list ? "1 2 3 4 2 5 6 7\n" : "1 2 3 4 5 6 7\n");
    const PlyOutcome got = run_ply_in_pieces(input);
    ASSERT_EQ(got.error, PlyError::kNone) << describe(got);
    EXPECT_EQ(got.normals, none);
    EXPECT_EQ(got.colors, none);
  }
}

TEST(PlyAttributes, SpansAreFilledOrLeft) {
  for (const PlyFormat format : kPlyFormats) {
    const std::string input = attribute_file(format, "float", "uchar", 1.0);
    const auto bytes = std::as_bytes(std::span(input));
    const PlyResult counted = count_ply(bytes);
    EXPECT_TRUE(counted.header.has_normals && counted.header.has_colors);
    std::vector<Vec3> vertices(kVertices), normals(kVertices, Vec3(-1)), colors(kVertices, Vec3(-1));
    EXPECT_EQ(read_ply(bytes, {vertices, {}, {}, colors}).error, PlyError::kNone);
    EXPECT_EQ(colors[6], Vec3(60, 120, 127) / 255.0f);
    EXPECT_EQ(read_ply(bytes, {vertices, {}, normals, {}}).error, PlyError::kNone);
    EXPECT_EQ(normals[6], Vec3(6, 12, 3));
    EXPECT_EQ(read_ply(bytes, {vertices, {}, std::span(normals).first(6), {}}).error, PlyError::kVertexSpanTooSmall);
    EXPECT_EQ(read_ply(bytes, {vertices, {}, {}, std::span(colors).first(6)}).error, PlyError::kVertexSpanTooSmall);
  }
}

}  // namespace
}  // namespace gridiron::test
