// Sections of effects in an image: every hostile word is refused or harmless. SPDX-License-Identifier: Apache-2.0
#include "core/image/effects_oracle.h"
#include "core/image/image_damage.h"
#include "core/image/tree_oracle.h"
#include "core/scene/test_effects.h"

namespace gridiron::test {
namespace {

BuiltImage build(const TestEffects& scene, TriangleFormat format = TriangleFormat::kVertices) {
  const EffectsView view = scene.view();
  return build_image(scene.mesh(), {4.0f, 2, format}, std::byte{0xCD}, &view);
}

// --- Valid --------------------------------------------------------------------------------------------------------

TEST(EffectsOfAnImage, PassWithEverySubsetOfWhatMayBeMissing) {
  for (std::uint32_t subset = 0; subset < 64; ++subset) {
    TestEffects scene = all_effects((subset & 1) != 0 ? 9 : 0);
    if ((subset & 2) != 0) scene.lights.clear();
    if ((subset & 4) != 0) scene.triangle_materials.assign(4, 0);
    if ((subset & 4) != 0) scene.triangle_normals.clear(), scene.triangle_colors.clear();
    if ((subset & 8) != 0) scene.settings.recursion_depth = 1;
    if ((subset & 16) != 0) scene.settings.occlusion_samples = 0;
    const BuiltImage built = build(scene, (subset & 32) != 0 ? TriangleFormat::kVertices : TriangleFormat::kLattice);
    ASSERT_FALSE(HasFailure()) << subset;
    EXPECT_EQ(built.view.effects.called_for, effects_called_for(scene.view()));
    EXPECT_STREQ(broken_effects(built.image.bytes(), built.view), nullptr) << subset;
  }
}

TEST(EffectsOfAnImage, MaterialsPassHoweverTheirSharesRound) {
  TestEffects scene = all_effects(0);
  scene.materials.clear();
  for (int i = 0; i < 1000; ++i) {
    Material material;
    material.kd = static_cast<float>(1 + i % 10) / 10.0f;
    material.ks = static_cast<float>(1 + i / 10 % 10) / 10.0f;
    material.transmittance = static_cast<float>(1 + i / 100) / 10.0f;
    scene.materials.push_back(material);
  }
  scene.triangle_materials.assign(4, 999);
  scene.triangle_normals.clear();
  scene.triangle_colors.clear();
  const BuiltImage built = build(scene);
  EXPECT_FALSE(HasFailure());
}

// --- Errors by name -----------------------------------------------------------------------------------------------

#define EFFECTS_DAMAGE(label, member, statement) \
  DAMAGE_IN(label, "effects." #member, EffectsRecord, member, view.effects_offset_bytes, statement)
#define MATERIAL_DAMAGE(label, member, statement) \
  DAMAGE_IN(label, "material." #member, MaterialRecord, member, view.effects.materials_offset_bytes + 48, statement)
#define POINT_DAMAGE(label, member, statement) \
  DAMAGE_IN(label, "light." #member, LightRecord, member, view.effects.lights_offset_bytes, statement)
#define AREA_DAMAGE(label, member, statement) \
  DAMAGE_IN(label, "light." #member, LightRecord, member, view.effects.lights_offset_bytes + 64, statement)
#define SURFACE_DAMAGE(label, index, member, statement)                                                          \
  DAMAGE_IN(label, "surface." #member, SurfaceRecord, member, view.effects.surfaces_offset_bytes + 48 * (index), \
            statement)
#define NORMAL_DAMAGE(label, member, statement) \
  DAMAGE_IN(label, "normal." #member, NormalRecord, member, view.effects.normals_offset_bytes + 48, statement)
// One texel, its place in the section in bytes.
#define TEXEL_DAMAGE(label, place, statement)                                        \
  Damage {                                                                           \
    label, "environment.texels", [](LineBuffer& image, const SceneImageView& view) { \
      const std::uint64_t offset = view.effects.environment_offset_bytes + (place);  \
      edit<Vec3>(image, offset, [&](Vec3& r) { statement; });                        \
      return offset;                                                                 \
    }                                                                                \
  }

const Damage kDamages[] = {
    EFFECTS_DAMAGE("calls_for_more", called_for, r.called_for |= 1u << kEffectCount),
    EFFECTS_DAMAGE("calls_for_less", called_for, r.called_for &= ~kRefraction),
    EFFECTS_DAMAGE("no_materials", material_count, r.material_count = 0),
    EFFECTS_DAMAGE("too_many_materials", material_count, r.material_count = kMaxMaterials + 1),
    EFFECTS_DAMAGE("too_many_lights", light_count, r.light_count = kMaxLights + 1),
    EFFECTS_DAMAGE("too_many_point_lights", point_light_count, r.point_light_count = 3),
    EFFECTS_DAMAGE("no_depth", recursion_depth, r.recursion_depth = 0),
    EFFECTS_DAMAGE("too_deep", recursion_depth, r.recursion_depth = 9),
    EFFECTS_DAMAGE("odd_samples", samples_per_pixel, r.samples_per_pixel = 3),
    EFFECTS_DAMAGE("too_many_occlusion_samples", occlusion_samples, r.occlusion_samples = 65),
    EFFECTS_DAMAGE("occlusion_off_with_radius", occlusion_radius, r.occlusion_samples = 0),
    EFFECTS_DAMAGE("occlusion_radius_zero", occlusion_radius, r.occlusion_radius = 0.0f),
    EFFECTS_DAMAGE("occlusion_radius_nan", occlusion_radius, r.occlusion_radius = kNan),
    EFFECTS_DAMAGE("occlusion_radius_infinite", occlusion_radius, r.occlusion_radius = kInfinity),
    EFFECTS_DAMAGE("background", background, r.background[2] = 1.25f),
    EFFECTS_DAMAGE("background_nan", background, r.background[0] = kNan),
    EFFECTS_DAMAGE("shadows", has_shadows, r.has_shadows = 2),
    EFFECTS_DAMAGE("environment_too_wide", environment_width, r.environment_width = 1025),
    EFFECTS_DAMAGE("no_environment", environment_offset_bytes, r.environment_width = 0),
    EFFECTS_DAMAGE("more_smooth_triangles_than_none", normals_offset_bytes, r.smooth_triangle_count = 0),
    EFFECTS_DAMAGE("no_lights", lights_offset_bytes, r.light_count = r.point_light_count = 0),
    EFFECTS_DAMAGE("materials_offset", materials_offset_bytes, r.materials_offset_bytes += 128),
    EFFECTS_DAMAGE("materials_nowhere", materials_offset_bytes, r.materials_offset_bytes = 0),
    EFFECTS_DAMAGE("lights_offset", lights_offset_bytes, r.lights_offset_bytes -= 128),
    EFFECTS_DAMAGE("surfaces_offset", surfaces_offset_bytes, r.surfaces_offset_bytes = ~std::uint64_t{127}),
    EFFECTS_DAMAGE("normals_offset", normals_offset_bytes, r.normals_offset_bytes += 1),
    EFFECTS_DAMAGE("environment_offset", environment_offset_bytes, r.environment_offset_bytes += 768),
    EFFECTS_DAMAGE("effects_reserved", reserved, r.reserved[6] = 1),
    EFFECTS_DAMAGE("levels", levels, r.levels = 2),

    MATERIAL_DAMAGE("diffuse_negative", diffuse, r.diffuse[1] = -0.125f),
    MATERIAL_DAMAGE("diffuse_nan", diffuse, r.diffuse[2] = kNan),
    MATERIAL_DAMAGE("diffuse_too_much_with_others", diffuse, r.diffuse[0] = 0.5f),
    MATERIAL_DAMAGE("specular_negative", specular, r.specular = -0.125f),
    MATERIAL_DAMAGE("specular_above", specular, r.specular = 1.125f),
    MATERIAL_DAMAGE("transmittance_nan", transmittance, r.transmittance = kNan),
    MATERIAL_DAMAGE("transmittance_too_much_with_others", transmittance, r.transmittance = 0.75f),
    MATERIAL_DAMAGE("transmitted_above", transmitted, r.transmitted[0] = r.transmittance * 1.001f),
    MATERIAL_DAMAGE("transmitted_negative", transmitted, r.transmitted[2] = -1.0f),
    MATERIAL_DAMAGE("shine_above", shine, r.shine = 1.5e5f),
    MATERIAL_DAMAGE("shine_nan", shine, r.shine = kNan),
    MATERIAL_DAMAGE("index_small", index, r.index = 0.0625f),
    MATERIAL_DAMAGE("index_great", index, r.index = kInfinity),
    MATERIAL_DAMAGE("smooth_two", is_smooth, r.is_smooth = 2),
    MATERIAL_DAMAGE("flat_with_colors", has_colors, r.is_smooth = 0),
    MATERIAL_DAMAGE("colors_two", has_colors, r.has_colors = 2),

    POINT_DAMAGE("point_becomes_area", samples, r.samples = 4),
    POINT_DAMAGE("point_nan", corner, r.corner[1] = kNan),
    POINT_DAMAGE("point_beyond", corner, r.corner[1] = 0x1.1p120f),
    POINT_DAMAGE("point_too_many_cells_away", corner, r.corner[1] = kCoordinateLimit),
    POINT_DAMAGE("point_color", color, r.color[2] = -1.0f),
    POINT_DAMAGE("point_color_above", color, r.color[0] = 2e6f),
    POINT_DAMAGE("point_near_two", is_near, r.is_near = 2),
    POINT_DAMAGE("point_is_near_indeed", is_near, r.is_near = 0),
    POINT_DAMAGE("point_edge", edge_u, r.edge_v[0] = 1.0f),
    POINT_DAMAGE("point_reserved0", reserved0, r.reserved0 = 1),
    POINT_DAMAGE("point_reserved1", reserved1, r.reserved1 = 1),
    AREA_DAMAGE("area_becomes_point", samples, r.samples = 0),
    AREA_DAMAGE("area_samples", samples, r.samples = 65),
    AREA_DAMAGE("area_edge_nan", edge_u, r.edge_u[2] = kNan),
    AREA_DAMAGE("area_edges_parallel", corner, std::memcpy(r.edge_u, r.edge_v, sizeof(r.edge_u))),
    AREA_DAMAGE("area_corner_beyond", corner, r.edge_v[0] = kFloatMax),
    AREA_DAMAGE("area_near", is_near, r.is_near = 1),

    SURFACE_DAMAGE("surface_nan", 3, v, r.v[2][2] = kNan),
    SURFACE_DAMAGE("dropped_surface_infinite", 2, v, r.v[0][0] = kInfinity),
    SURFACE_DAMAGE("surface_of_another_triangle", 1, v, r.v[1][1] += 0.5f),
    SURFACE_DAMAGE("surface_material", 0, material, r.material = 3),
    SURFACE_DAMAGE("surface_material_far", 0, material, r.material = 0xFFFFFFFFu),
    SURFACE_DAMAGE("surface_of_smooth_material", 0, normals, r.material = 1),
    SURFACE_DAMAGE("smooth_surface_without_normals", 1, normals, r.normals = kNoNormals),
    SURFACE_DAMAGE("flat_surface_with_normals", 3, normals, r.normals = 0),
    SURFACE_DAMAGE("normals_of_another", 2, normals, r.normals = 0),
    SURFACE_DAMAGE("normals_beyond", 2, normals, r.normals = 2),
    SURFACE_DAMAGE("surface_without_a_place", 1, tree_place, r.tree_place = kNoTriangle),
    SURFACE_DAMAGE("surface_with_a_place_beyond", 1, tree_place, r.tree_place = 3),
    SURFACE_DAMAGE("surface_with_the_place_of_another", 1, tree_place, r.tree_place = (r.tree_place + 1) % 3),
    SURFACE_DAMAGE("dropped_surface_with_a_place", 2, tree_place, r.tree_place = 0),
    NORMAL_DAMAGE("normal_long", n, r.n[2][0] = 1.0f),
    NORMAL_DAMAGE("normal_zero", n, std::memset(r.n[1], 0, sizeof(r.n[1]))),
    NORMAL_DAMAGE("normal_nan", n, r.n[0][1] = kNan),
    NORMAL_DAMAGE("color_beyond_its_bits", colors, r.colors[2] |= 1u << 30),
    TEXEL_DAMAGE("texel_negative", 0, r.x = -1.0f),
    TEXEL_DAMAGE("texel_infinite", 12, r.y = kInfinity),
    TEXEL_DAMAGE("texel_nan_in_the_last_block", 768 * 5 + 96 + 12, r.z = kNan),
    TEXEL_DAMAGE("texel_of_the_apron", 768 + 96 * 7 + 12 * 7, r.z += 1.0f),
    SECTION_DAMAGE("effects_count", SectionKind::kEffects, element_count, r.element_count = 0),
    SECTION_DAMAGE("effects_bytes", SectionKind::kEffects, element_bytes, r.element_bytes = 64),
    SECTION_DAMAGE("materials_count", SectionKind::kMaterials, element_count, r.element_count = 2),
    SECTION_DAMAGE("lights_bytes", SectionKind::kLights, element_bytes, r.element_bytes = 32),
    SECTION_DAMAGE("surfaces_count", SectionKind::kSurfaces, element_count, r.element_count = 3),
    SECTION_DAMAGE("normals_count", SectionKind::kNormals, element_count, r.element_count = 1),
    SECTION_DAMAGE("environment_count", SectionKind::kEnvironmentMap, element_count, r.element_count = 5),
};

class Damages : public ::testing::TestWithParam<Damage> {};

TEST_P(Damages, AreNamedWithTheirPlace) {
  expect_named(GetParam(), build(all_effects()));
}
// A record of normals whose material has no colours.
TEST(EffectsOfAnImage, ColorsAreThereOnlyWhereTheMaterialHasThem) {
  TestEffects scene = all_effects(0);
  for (Material& material : scene.materials) material.vertex_colors = false;
  scene.triangle_colors.clear();
  for (const int corner : {0, 2}) {
    BuiltImage built = build(scene);
    const std::uint64_t offset = built.view.effects.normals_offset_bytes;
    edit<NormalRecord>(built.image, offset, [corner](NormalRecord& record) { record.colors[corner] = 1; });
    expect_refused(built.image, "normal.colors", offset + offsetof(NormalRecord, colors));
  }
}

INSTANTIATE_TEST_SUITE_P(All, Damages, ::testing::ValuesIn(kDamages), [](const auto& test) { return test.param.name; });

// --- Parts that are missing -----------------------------------------------------------------------------------------

TEST(PartsOfEffects, StandAllOrNone) {
  const SectionKind kinds[] = {SectionKind::kEffects,  SectionKind::kMaterials, SectionKind::kLights,
                               SectionKind::kSurfaces, SectionKind::kNormals,   SectionKind::kEnvironmentMap,
                               SectionKind::kTree,     SectionKind::kTreeNodes, SectionKind::kTreeTriangles};
  const char* const fields[] = {"section.kind",
                                "effects.materials_offset_bytes",
                                "effects.lights_offset_bytes",
                                "effects.surfaces_offset_bytes",
                                "effects.normals_offset_bytes",
                                "effects.environment_offset_bytes",
                                "header.section_count",
                                "tree.nodes_offset_bytes",
                                "tree.triangles_offset_bytes"};
  for (int i = 0; i < 9; ++i) {
    BuiltImage built = build(all_effects());
    edit<SectionEntry>(built.image, entry_offset(kinds[i]), [](SectionEntry& entry) { entry.kind = 1000; });
    expect_refused(built.image, fields[i]);
  }
  // None of them: geometry alone.
  BuiltImage built = build(all_effects());
  for (const SectionKind kind : kinds) {
    edit<SectionEntry>(built.image, entry_offset(kind), [](SectionEntry& entry) { entry.kind += 1000; });
  }
  renew_check_value(built.image);
  const OpenedImage opened = open_image(built.image.bytes());
  EXPECT_EQ(opened.status, Status::kOk);
  EXPECT_FALSE(opened.view.has_effects);
  EXPECT_STREQ(broken_effects(built.image.bytes(), opened.view), nullptr);
  EXPECT_FALSE(opened.view.has_tree);
  // A part of the tree does not stand alone.
  const std::uint64_t tree = built.view.tree_offset_bytes;
  for (int i = 6; i < 9; ++i) {
    edit<SectionEntry>(built.image, entry_offset(kinds[i]), [](SectionEntry& entry) { entry.kind -= 1000; });
    if (kinds[i] == SectionKind::kTree) {
      expect_refused(built.image, "tree.triangles_offset_bytes", tree + offsetof(TreeRecord, triangles_offset_bytes));
    } else {
      expect_refused(built.image, "section.kind", entry_offset(kinds[i]));
    }
    edit<SectionEntry>(built.image, entry_offset(kinds[i]), [](SectionEntry& entry) { entry.kind += 1000; });
  }
}

// Without effects there is no surface to compare a record with.
TEST(PartsOfEffects, ATreeStandsWithoutThem) {
  GridParameters parameters{4.0f, 2};
  parameters.has_tree = true;
  for (const TriangleFormat format : {TriangleFormat::kVertices, TriangleFormat::kLattice}) {
    parameters.format = format;
    BuiltImage built = build_image(all_effects().mesh(), parameters);
    ASSERT_TRUE(built.view.has_tree);
    EXPECT_FALSE(built.view.has_effects);
    EXPECT_EQ(built.view.tree.triangle_count,
              built.view.header.triangle_count - built.view.header.dropped_triangle_count);
    const std::uint64_t record = built.view.tree.triangles_offset_bytes, bytes = built.view.tree.triangle_bytes;
    const std::uint64_t id = record + bytes - sizeof(std::uint32_t);
    edit<std::uint32_t>(built.image, id, [&](std::uint32_t& number) { number += built.view.header.triangle_count; });
    expect_refused(built.image, "tree_triangle.triangle_id", id);
    edit<std::uint32_t>(built.image, id, [&](std::uint32_t& number) { number -= built.view.header.triangle_count; });
    if (format != TriangleFormat::kVertices) continue;
    for (const float value : {1e9f, -1e9f, std::numeric_limits<float>::quiet_NaN()}) {
      BuiltImage other = build_image(all_effects().mesh(), parameters);
      edit<float>(other.image, record + 4, [value](float& coordinate) { coordinate = value; });
      expect_refused(other.image, "tree_triangle.v", record);
    }
  }
  parameters.format = TriangleFormat::kProjection;
  GridNeed need;
  EXPECT_EQ(count_scene_image(all_effects().mesh(), parameters, need), Status::kBadParameter);
}

TEST(PartsOfEffects, StandBesideTrianglesThatHaveVertices) {
  // A projection image whose section table is the one of an image with effects.
  BuiltImage built = build(all_effects());
  const BuiltImage projections = build_image(all_effects().mesh(), {4.0f, 2, TriangleFormat::kProjection});
  ASSERT_EQ(built.view.grid.reference_count, projections.view.grid.reference_count);
  const std::uint64_t bytes = std::uint64_t{built.view.grid.reference_count} * sizeof(ProjectionTriangle);
  std::memcpy(built.image.bytes().data() + built.view.triangles_offset_bytes,
              projections.image.bytes().data() + projections.view.triangles_offset_bytes, bytes);
  const auto grid = read_record<SectionEntry>(built.image.bytes(), entry_offset(SectionKind::kGrid));
  edit<GridRecord>(built.image, grid.offset_bytes, [](GridRecord& record) {
    record.triangle_format = static_cast<std::uint32_t>(TriangleFormat::kProjection);
  });
  expect_refused(built.image, "section.kind", entry_offset(SectionKind::kEffects));
}

// --- Every word -----------------------------------------------------------------------------------------------------

class Words : public ::testing::TestWithParam<TriangleFormat> {};

// Each bit of each word is flipped, and each word is set to the worst values for floats and counts.
TEST_P(Words, ThatAreChangedAreRefusedOrHarmless) {
  BuiltImage built = build(all_effects(1), GetParam());
  ASSERT_FALSE(HasFailure());
  const std::span<std::byte> bytes = built.image.bytes();
  const std::uint64_t table_end = kTableOffset + 13 * sizeof(SectionEntry);
  const std::uint32_t worst[] = {0u,          1u,          0x7F800000u, 0xFF800000u, 0x7FC00000u,
                                 0xFFFFFFFFu, 0x7F7FFFFFu, 0x80000000u, 0x3F800001u, 256u};
  std::uint64_t opened = 0, refused = 0;
  const auto try_words = [&](std::uint64_t begin, std::uint64_t end) {
    for (std::uint64_t at = begin; at < end; at += 4) {
      const auto word = read_record<std::uint32_t>(bytes, at);
      for (std::uint32_t i = 0; i < 32 + std::size(worst); ++i) {
        const std::uint32_t changed = i < 32 ? word ^ (1u << i) : worst[i - 32];
        std::memcpy(bytes.data() + at, &changed, sizeof(changed));
        renew_check_value(built.image);
        const OpenedImage image = open_image(bytes);
        if (image.status != Status::kOk) {
          ++refused;
          continue;
        }
        ++opened;
        ASSERT_STREQ(broken_effects(bytes, image.view), nullptr) << "word at " << at << ", " << std::hex << changed;
        ASSERT_STREQ(broken_tree(bytes, image.view), nullptr) << "word at " << at << ", " << std::hex << changed;
      }
      std::memcpy(bytes.data() + at, &word, sizeof(word));
    }
  };
  try_words(entry_offset(SectionKind::kEffects), table_end);
  ASSERT_FALSE(HasFailure());
  try_words(built.view.effects_offset_bytes, bytes.size());
  EXPECT_GT(refused, opened);
  EXPECT_GT(opened, 100u);
}
INSTANTIATE_TEST_SUITE_P(All, Words, ::testing::Values(TriangleFormat::kVertices, TriangleFormat::kLattice));

// --- Layout ---------------------------------------------------------------------------------------------------------

// The offsets that core/SPEC.md prints.
TEST(EffectsLayout, FieldsStandWhereTheSpecificationSays) {
  EXPECT_EQ(offsetof(EffectsRecord, occlusion_radius), 28u);
  EXPECT_EQ(offsetof(EffectsRecord, background), 32u);
  EXPECT_EQ(offsetof(EffectsRecord, has_shadows), 44u);
  EXPECT_EQ(offsetof(EffectsRecord, smooth_triangle_count), 52u);
  EXPECT_EQ(offsetof(EffectsRecord, materials_offset_bytes), 56u);
  EXPECT_EQ(offsetof(EffectsRecord, environment_offset_bytes), 88u);
  EXPECT_EQ(offsetof(EffectsRecord, levels), 96u);
  EXPECT_EQ(offsetof(EffectsRecord, reserved), 100u);
  EXPECT_EQ(offsetof(MaterialRecord, transmitted), 16u);
  EXPECT_EQ(offsetof(MaterialRecord, shine), 32u);
  EXPECT_EQ(offsetof(MaterialRecord, is_smooth), 40u);
  EXPECT_EQ(offsetof(LightRecord, color), 16u);
  EXPECT_EQ(offsetof(LightRecord, edge_u), 32u);
  EXPECT_EQ(offsetof(LightRecord, edge_v), 48u);
  EXPECT_EQ(offsetof(SurfaceRecord, material), 36u);
  EXPECT_EQ(offsetof(SurfaceRecord, normals), 40u);
  EXPECT_EQ(offsetof(SurfaceRecord, tree_place), 44u);
  EXPECT_EQ(offsetof(MaterialRecord, has_colors), 44u);
  EXPECT_EQ(offsetof(NormalRecord, colors), 36u);
  EXPECT_EQ(offsetof(FrameHead, effects_address), 136u);
  EXPECT_EQ(offsetof(FrameHead, image_address), 144u);
  EXPECT_EQ(offsetof(FrameHead, tree_address), 152u);
  EXPECT_EQ(offsetof(FrameHead, fetch_depth), 44u);
}

}  // namespace
}  // namespace gridiron::test
