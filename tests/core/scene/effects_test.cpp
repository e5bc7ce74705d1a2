// Effects of a scene: which ones it calls for, and what is rejected. SPDX-License-Identifier: Apache-2.0
#include <gridiron/base/records.h>
#include <gridiron/scene/effect_rules.h>
#include <gridiron/scene/effects.h>
#include <gridiron/shade/vectors.h>

#include "core/scene/test_effects.h"
#include "support/test_headers.h"

namespace gridiron::test {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinite = std::numeric_limits<float>::infinity();

Status check(const TestEffects& scene) {
  return check_effects(scene.mesh(), scene.view());
}

// --- Refusals -----------------------------------------------------------------------------------------------------

struct Change {
  const char* name;
  Status status;
  std::function<void(TestEffects&)> apply;
};

#define CHANGE(name, status, ...) \
  Change { name, Status::status, [](TestEffects& s) { __VA_ARGS__; } }

const Change kChanges[] = {
    CHANGE("nothing", kOk, (void)s),
    // Counts.
    CHANGE("no_materials", kBadEffects, s.materials.clear()),
    CHANGE("most_materials", kOk, s.materials.resize(kMaxMaterials)),
    CHANGE("too_many_materials", kBadEffects, s.materials.resize(kMaxMaterials + 1)),
    CHANGE("too_few_triangle_materials", kBadEffects, s.triangle_materials.pop_back()),
    CHANGE("too_many_triangle_materials", kBadEffects, s.triangle_materials.push_back(0)),
    CHANGE("too_few_triangle_normals", kBadEffects, s.triangle_normals.pop_back()),
    CHANGE("no_lights", kOk, s.lights.clear()),
    CHANGE("most_lights", kOk, s.lights.resize(kMaxLights, s.lights[1])),
    CHANGE("too_many_lights", kBadEffects, s.lights.resize(kMaxLights + 1, s.lights[1])),
    CHANGE("point_light_behind_area_light", kBadEffects, s.lights.push_back(s.lights[0])),
    // Settings.
    CHANGE("no_depth", kBadEffects, s.settings.recursion_depth = 0),
    CHANGE("least_depth", kOk, s.settings.recursion_depth = 1),
    CHANGE("greatest_depth", kOk, s.settings.recursion_depth = kMaxRecursionDepth),
    CHANGE("too_deep", kBadEffects, s.settings.recursion_depth = kMaxRecursionDepth + 1),
    CHANGE("no_samples", kBadEffects, s.settings.samples_per_pixel = 0),
    CHANGE("two_samples", kBadEffects, s.settings.samples_per_pixel = 2),
    CHANGE("sixteen_samples", kOk, s.settings.samples_per_pixel = 16),
    CHANGE("no_occlusion", kOk, s.settings.occlusion_samples = 0),
    CHANGE("no_occlusion_radius_nan", kBadEffects, s.settings.occlusion_samples = 0;
           s.settings.occlusion_radius = kNan),
    CHANGE("most_occlusion", kOk, s.settings.occlusion_samples = kMaxEffectSamples),
    CHANGE("too_much_occlusion", kBadEffects, s.settings.occlusion_samples = kMaxEffectSamples + 1),
    CHANGE("radius_zero", kBadEffects, s.settings.occlusion_radius = 0),
    CHANGE("radius_nan", kBadEffects, s.settings.occlusion_radius = kNan),
    CHANGE("radius_infinite", kBadEffects, s.settings.occlusion_radius = kInfinite),
    CHANGE("background_above", kBadEffects, s.settings.background.z = 1.5f),
    CHANGE("background_below", kBadEffects, s.settings.background.x = -0.5f),
    CHANGE("background_nan", kBadEffects, s.settings.background.y = kNan),
    CHANGE("environment_none", kOk, s.set_environment(0)),
    CHANGE("environment_short", kBadEffects, s.faces[5].pop_back()),
    CHANGE("environment_long", kBadEffects, s.faces[0].push_back({})),
    CHANGE("environment_without_width", kBadEffects, s.settings.environment_width = 0),
    CHANGE("environment_too_wide", kBadEffects, s.set_environment(kMaxEnvironmentWidth + 1)),
    CHANGE("texel_negative", kBadEffects, s.faces[3][8].y = -1),
    CHANGE("texel_infinite", kBadEffects, s.faces[3][8].y = kInfinite),
    CHANGE("texel_nan", kBadEffects, s.faces[5][0].z = kNan),
    CHANGE("texel_great", kOk, s.faces[5][0].z = kFloatMax),
    // Materials, in use or not.
    CHANGE("color_above", kBadEffects, s.materials[2].color.y = 1.25f),
    CHANGE("color_nan", kBadEffects, s.materials[0].color.x = kNan),
    CHANGE("kd_above", kBadEffects, s.materials[0].kd = 1.25f),
    CHANGE("kd_negative", kBadEffects, s.materials[0].kd = -0.25f),
    CHANGE("ks_above", kBadEffects, s.materials[2].ks = 1.25f),
    CHANGE("ks_nan", kBadEffects, s.materials[2].ks = kNan),
    CHANGE("transmittance_above", kBadEffects, s.materials[1].transmittance = 1.25f),
    CHANGE("all_shares_one", kOk, s.materials[1].transmittance = s.materials[1].kd = s.materials[1].ks = 1),
    CHANGE("shine_negative", kBadEffects, s.materials[1].shine = -1),
    CHANGE("shine_great", kOk, s.materials[1].shine = 1e5f),
    CHANGE("shine_above", kBadEffects, s.materials[1].shine = 1.1e5f),
    CHANGE("index_small", kBadEffects, s.materials[1].index = 0.05f),
    CHANGE("index_great", kBadEffects, s.materials[1].index = 11),
    CHANGE("index_nobody_needs", kOk, s.materials[0].index = 11),
    CHANGE("index_nan", kBadEffects, s.materials[0].index = kNan),
    // Triangles and normals.
    CHANGE("material_not_there", kBadIndex, s.triangle_materials[3] = 3),
    CHANGE("normal_not_there", kBadIndex, s.triangle_normals[1].z = 3),
    CHANGE("normal_of_one_corner_missing", kBadIndex, s.triangle_normals[1].y = kNoNormals),
    CHANGE("smooth_without_normals", kBadEffects, s.triangle_normals[1] = UVec3(kNoNormals)),
    CHANGE("smooth_without_any_normals", kBadEffects, s.triangle_normals.clear()),
    CHANGE("flat_with_normals", kBadEffects, s.triangle_normals[0] = {0, 1, 2}),
    CHANGE("flat_without_any_normals", kOk, s.triangle_normals.clear(); s.triangle_colors.clear();
           s.triangle_materials.assign(4, 0)),
    CHANGE("color_not_there", kBadIndex, s.triangle_colors[1].z = 2),
    CHANGE("color_of_one_corner_missing", kBadIndex, s.triangle_colors[1].y = kNoNormals),
    CHANGE("colored_without_colors", kBadEffects, s.triangle_colors[1] = UVec3(kNoNormals)),
    CHANGE("colored_without_any_colors", kBadEffects, s.triangle_colors.clear()),
    CHANGE("colors_too_few", kBadEffects, s.triangle_colors.pop_back()),
    CHANGE("colors_of_no_colored_material", kBadEffects, s.triangle_colors[0] = {0, 1, 0}),
    CHANGE("colored_and_flat", kBadEffects, s.materials[2].smooth_normals = false),
    CHANGE("uncolored", kOk, s.triangle_colors.clear(); s.materials[1].vertex_colors = false),
    CHANGE("vertex_color_above", kBadEffects, s.colors[1].y = 1.001f),
    CHANGE("vertex_color_nan", kBadEffects, s.colors[0].z = kNan),
    CHANGE("normal_short", kBadEffects, s.normals[1] *= 0.998f),
    CHANGE("normal_nearly_unit", kOk, s.normals[1] *= 0.9995f),
    CHANGE("normal_long", kBadEffects, s.normals[1] *= 1.002f),
    CHANGE("normal_nan", kBadEffects, s.normals[2].x = kNan),
    CHANGE("normal_infinite", kBadEffects, s.normals[2].x = kInfinite),
    // Lights.
    CHANGE("light_color_negative", kBadEffects, s.lights[0].color.x = -1),
    CHANGE("light_color_greatest", kOk, s.lights[0].color.x = kMaxLightColor),
    CHANGE("light_color_above", kBadEffects, s.lights[0].color.x = 1.1e6f),
    CHANGE("light_color_nan", kBadEffects, s.lights[1].color.z = kNan),
    CHANGE("light_at_the_limit", kOk, s.lights[0].corner.y = -kCoordinateLimit),
    CHANGE("light_beyond", kBadEffects, s.lights[0].corner.y = -1.001f * kCoordinateLimit),
    CHANGE("light_nan", kBadEffects, s.lights[0].corner.z = kNan),
    CHANGE("light_nan_at_first", kBadEffects, s.lights[1].corner.x = kNan),
    CHANGE("light_edge_of_point_nan", kBadEffects, s.lights[0].edge_u.x = kNan),
    CHANGE("light_edge_of_point", kOk, s.lights[0].edge_u.x = 1),
    CHANGE("light_edge_beyond", kBadEffects, s.lights[1].edge_u.x = 1.001f * kCoordinateLimit),
    CHANGE("light_far_corner_beyond", kBadEffects,
           s.lights[1].edge_u = s.lights[1].edge_v = Vec3(0.6f * kCoordinateLimit);
           s.lights[1].edge_v.x = 0),
    CHANGE("light_edge_nan", kBadEffects, s.lights[1].edge_v.y = kNan),
    CHANGE("light_edge_zero", kBadEffects, s.lights[1].edge_v = Vec3(0)),
    CHANGE("light_edges_parallel", kBadEffects, s.lights[1].edge_u = {1, 2, 3}; s.lights[1].edge_v = {-2, -4, -6}),
    CHANGE("light_edges_nearly_parallel", kOk, s.lights[1].edge_u = {1, 2, 3}; s.lights[1].edge_v = {2, 4, 6.000001f}),
    CHANGE("light_of_most_samples", kOk, s.lights[1].samples = kMaxEffectSamples),
    CHANGE("light_of_too_many_samples", kBadEffects, s.lights[1].samples = kMaxEffectSamples + 1),
};

class Changes : public ::testing::TestWithParam<Change> {};

TEST_P(Changes, AreAnsweredAsDocumented) {
  TestEffects scene = all_effects();
  GetParam().apply(scene);
  EXPECT_EQ(check(scene), GetParam().status);
}
INSTANTIATE_TEST_SUITE_P(All, Changes, ::testing::ValuesIn(kChanges), [](const auto& test) { return test.param.name; });

// --- What a scene calls for ---------------------------------------------------------------------------------------

struct Call {
  const char* name;
  std::uint32_t without;  // of all effects
  std::function<void(TestEffects&)> apply;
};

#define CALL(name, without, ...) \
  Call { name, without, [](TestEffects& s) { __VA_ARGS__; } }

const Call kCalls[] = {
    CALL("all", 0, (void)s),
    CALL("no_shadows", kPointShadows, s.settings.has_shadows = false),
    CALL("dark_point_light", kPointShadows, s.lights[0].color = Vec3(0)),
    CALL("no_area_light", kAreaLights, s.lights.pop_back()),
    CALL("dark_area_light", kAreaLights, s.lights[1].color = Vec3(0)),
    CALL("area_light_dark_by_division", kAreaLights, s.lights[1].color = Vec3(1e-45f)),
    CALL("no_light", kPointShadows | kAreaLights | kHighlights, s.lights.clear()),
    CALL("depth_one", kReflection | kRefraction, s.settings.recursion_depth = 1),
    CALL("opaque", kRefraction, s.materials[1].transmittance = 0),
    CALL("transparent_only", kHighlights, s.materials[1].ks = 0),
    CALL("neither", kReflection | kRefraction | kHighlights, s.materials[1].ks = s.materials[1].transmittance = 0),
    CALL("unused", kReflection | kRefraction | kHighlights | kSmoothNormals | kVertexColors,
         s.triangle_materials.assign(4, 0)),
    CALL("used_last", 0, s.triangle_materials = (std::vector<std::uint16_t>{0, 0, 0, 1})),
    CALL("no_occlusion", kAmbientOcclusion, s.settings.occlusion_samples = 0),
    CALL("no_environment", kEnvironment, s.set_environment(0)),
    CALL("flat", kSmoothNormals | kVertexColors, s.materials[1].smooth_normals = s.materials[1].vertex_colors = false),
    CALL("uncolored", kVertexColors, s.materials[1].vertex_colors = false),
    CALL("no_shine", kHighlights, s.materials[1].shine = 0),
    CALL("one_sample", kMultisampling, s.settings.samples_per_pixel = 1),
};

class Calls : public ::testing::TestWithParam<Call> {};

TEST_P(Calls, NameTheEffects) {
  TestEffects scene = all_effects();
  GetParam().apply(scene);
  EXPECT_EQ(effects_called_for(scene.view()), kAllEffects & ~GetParam().without);
}
INSTANTIATE_TEST_SUITE_P(All, Calls, ::testing::ValuesIn(kCalls), [](const auto& test) { return test.param.name; });

// --- Scaling ------------------------------------------------------------------------------------------------------

TEST(ScaledMaterial, IsDividedWhereItsSharesExceedOne) {
  const TestEffects scene = all_effects();
  const MaterialRecord matte = scaled_material(scene.materials[0]);
  EXPECT_EQ(matte.diffuse[0], 0.375f);
  EXPECT_EQ(matte.diffuse[1], 0.1875f);
  EXPECT_EQ(matte.diffuse[2], 0.75f);
  EXPECT_EQ(matte.transmittance, 0.0f);
  EXPECT_EQ(matte.index, 1.0f);
  EXPECT_EQ(matte.is_smooth, 0u);
  EXPECT_EQ(matte.has_colors, 0u);

  const MaterialRecord glass = scaled_material(scene.materials[1]);
  const float sum = (0.7f + 0.6f) + 0.9f;
  EXPECT_EQ(glass.specular, 0.6f / sum);
  EXPECT_EQ(glass.transmittance, 0.9f / sum);
  EXPECT_EQ(glass.diffuse[1], 0.7f / sum * 0.5f);
  EXPECT_EQ(glass.transmitted[2], 0.9f / sum * 0.25f);
  EXPECT_EQ(glass.index, 1.5f);
  EXPECT_EQ(glass.shine, 20.0f);
  EXPECT_EQ(glass.is_smooth, 1u);
  EXPECT_EQ(glass.has_colors, 1u);
}

// Every value comes back within half a step of its root, and what can be held comes back exactly.
TEST(PackedColors, HoldTheRootOfAColor) {
  EXPECT_EQ(packed_color({0, 0, 0}), 0u);
  EXPECT_EQ(packed_color({1, 1, 1}), (1u << 30) - 1);
  EXPECT_EQ(packed_color({1, 0, 0}), 1023u);
  EXPECT_EQ(packed_color({0, 0, 1}), 1023u << 20);
  for (std::uint32_t steps = 0; steps <= kColorSteps; ++steps) {
    const PackedColor word = steps | (kColorSteps - steps) << 10 | (steps / 2) << 20;
    EXPECT_EQ(packed_color({unpacked_channel(word, 0), unpacked_channel(word, 1), unpacked_channel(word, 2)}), word);
  }
  for (int i = 0; i <= 1000; ++i) {
    const float value = static_cast<float>(i) / 1000.0f;
    const PackedColor word = packed_color({0, value, 0});
    EXPECT_NEAR(std::sqrt(unpacked_channel(word, 1)), std::sqrt(value), 0.51 / 1023) << value;
    EXPECT_EQ(unpacked_channel(word, 0), 0.0f);
    EXPECT_EQ(unpacked_channel(word, 2), 0.0f);
  }
}

TEST(ScaledMaterial, NeverReflectsMoreThanComes) {
  Material material;
  for (int i = 0; i < 27'000; ++i) {
    material.kd = static_cast<float>(i % 30) / 29.0f;
    material.ks = static_cast<float>(i / 30 % 30) / 29.0f;
    material.transmittance = static_cast<float>(i / 900) / 29.0f;
    const MaterialRecord record = scaled_material(material);
    const double sum = double{record.diffuse[0]} + double{record.specular} + double{record.transmittance};
    EXPECT_LE(sum, 1.0 + 0x1p-22);
  }
}

TEST(Lights, AreNearByTheFarthestOfTheirCorners) {
  GridRecord grid{};
  grid.bounds_minimum[1] = -2.0f;
  grid.bounds_maximum[0] = 1.0f;
  Light light;
  light.corner = {0, 0, -8};
  EXPECT_EQ(light_record(light, grid).is_near, 1u);
  light.corner.z = -8.001f;
  EXPECT_EQ(light_record(light, grid).is_near, 0u);
  light = {};
  light.samples = 4;
  light.corner = Vec3(1);
  light.edge_u = {4, 1, 0};
  light.edge_v = {3, 0, 1};
  EXPECT_EQ(light_record(light, grid).is_near, 1u);
  light.edge_v.x = 3.001f;
  EXPECT_EQ(light_record(light, grid).is_near, 0u);
}

}  // namespace
}  // namespace gridiron::test
