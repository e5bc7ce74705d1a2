// The stream between the two processes of an import: what is written is read, and all else is refused.
// SPDX-License-Identifier: Apache-2.0
#include "import/model_stream.h"

#include "support/test_mesh.h"

namespace gridiron::test {
namespace {

using tool::ImportedModel;

ImportedModel example() {
  ImportedModel model;
  model.report = {.format = "OBJ", .reader = "a reader", .unit_metres = 0.01, .up = "y", .meshes = 2,
                  .textures = 3, .animations = {{"walk", 1.5}, {"", 0}}, .ignored = {"3 lines"}};
  model.neighbours = {{"a.mtl", 77}};
  model.mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  model.mesh.triangles = {{0, 1, 2}, {2, 1, 0}};
  model.mesh.surface.materials = {{.color = Vec3(0.5f, 0.25f, 1), .ks = 0.5f, .shine = 10}};
  model.mesh.surface.triangle_materials = {0, 0};
  model.mesh.surface.normals = {{0, 0, 1}};
  model.mesh.surface.triangle_normals = {{0, 0, 0}, UVec3(tool::kNoNormal)};
  model.mesh.surface.colors = {{0, 0.5f, 1}};
  model.mesh.surface.triangle_colors = {UVec3(tool::kNoNormal), {0, 0, 0}};
  return model;
}

std::string bytes_of(const ImportedModel& model) {
  std::string bytes;
  EXPECT_TRUE(tool::write_model(model, [&](std::span<const std::byte> more) {
    bytes.append(reinterpret_cast<const char*>(more.data()), more.size());
    return true;
  }));
  return bytes;
}

ImportedModel read(std::string_view bytes, std::uint64_t most_bytes = 1 << 20) {
  return tool::read_model(
      [&](std::span<std::byte> target) {
        if (target.size() > bytes.size()) return false;
        std::memcpy(target.data(), bytes.data(), target.size());
        bytes.remove_prefix(target.size());
        return true;
      },
      most_bytes);
}

bool is_refused(const ImportedModel& model) {
  try {
    (void)read(bytes_of(model));
    return false;
  } catch (const tool::ImportError&) {
    return true;
  }
}

TEST(ModelStream, WhatIsWrittenIsRead) {
  const ImportedModel got = read(bytes_of(example())), expected = example();
  EXPECT_EQ(bytes_of(got), bytes_of(expected));
  EXPECT_EQ(got.mesh.triangles, expected.mesh.triangles);
  EXPECT_EQ(got.mesh.surface.materials, expected.mesh.surface.materials);
  EXPECT_EQ(got.neighbours.at(0).content, 77u);
  EXPECT_EQ(got.report.animations.at(0).name, "walk");
  EXPECT_EQ(got.report.animations.at(0).seconds, 1.5);
  EXPECT_EQ(got.report.unit_metres, 0.01);
  EXPECT_EQ(got.report.up, "y");
  EXPECT_EQ(got.report.textures, 3u);
}

TEST(ModelStream, ReasonsAreThrown) {
  std::string bytes;
  ASSERT_TRUE(tool::write_reason("no \x1B[31m such thing", [&](std::span<const std::byte> more) {
    bytes.append(reinterpret_cast<const char*>(more.data()), more.size());
    return true;
  }));
  try {
    (void)read(bytes);
    ADD_FAILURE();
  } catch (const tool::ImportError& error) {
    EXPECT_STREQ(error.what(), "no ?[31m such thing");
  }
}

TEST(ModelStream, ShortStreamsAreRefused) {
  const std::string bytes = bytes_of(example());
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_THROW((void)read(std::string_view(bytes).substr(0, size)), tool::ImportError) << size;
  }
}

TEST(ModelStream, WrongNumbersAreRefused) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::function<void(ImportedModel&)> damages[] = {
      [](ImportedModel& m) { m.mesh.triangles[0].y = 3; },
      [](ImportedModel& m) { m.mesh.triangles[0] = UVec3(tool::kNoNormal); },
      [nan](ImportedModel& m) { m.mesh.vertices[1].x = nan; },
      [](ImportedModel& m) { m.mesh.surface.triangle_materials[1] = 1; },
      [](ImportedModel& m) { m.mesh.surface.triangle_materials.pop_back(); },
      [](ImportedModel& m) { m.mesh.surface.triangle_normals[0].z = 1; },
      [](ImportedModel& m) { m.mesh.surface.triangle_normals[1].z = 0; },
      [](ImportedModel& m) { m.mesh.surface.triangle_normals.pop_back(); },
      [](ImportedModel& m) { m.mesh.surface.normals[0] = {0, 0, 2}; },
      [nan](ImportedModel& m) { m.mesh.surface.normals[0].x = nan; },
      [](ImportedModel& m) { m.mesh.surface.triangle_colors[1].x = 1; },
      [](ImportedModel& m) { m.mesh.surface.triangle_colors.pop_back(); },
      [](ImportedModel& m) { m.mesh.surface.colors[0].x = 1.5f; },
      [nan](ImportedModel& m) { m.mesh.surface.colors[0].x = nan; },
      [](ImportedModel& m) { m.mesh.surface.materials[0].ks = -1; },
      [](ImportedModel& m) { m.mesh.surface.materials[0].color.y = 2; },
      [](ImportedModel& m) { m.mesh.surface.materials[0].shine = 1e9f; },
      [](ImportedModel& m) { m.mesh.surface.materials[0].index_of_refraction = 0; },
      [nan](ImportedModel& m) { m.report.animations[1].seconds = nan; },
      [](ImportedModel& m) { m.report.animations[0].seconds = -1; },
      [nan](ImportedModel& m) { m.report.unit_metres = nan; }};
  EXPECT_FALSE(is_refused(example()));
  for (std::size_t i = 0; i < std::size(damages); ++i) {
    ImportedModel model = example();
    damages[i](model);
    EXPECT_TRUE(is_refused(model)) << i;
  }
}

// A count that promises everything takes no memory, and any byte may be wrong.
TEST(ModelStream, DamagedBytesAreNoDanger) {
  const std::string good = bytes_of(example());
  for (std::size_t place = 0; place < good.size(); ++place) {
    for (const char byte : {'\xFF', '\x7F', '\0', '\1'}) {
      std::string bytes = good;
      bytes[place] = byte;
      try {
        (void)read(bytes);
      } catch (const tool::ImportError&) {
      }
    }
  }
  EXPECT_THROW((void)read(good, 10), tool::ImportError);
}

}  // namespace
}  // namespace gridiron::test
