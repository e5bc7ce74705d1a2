// Sections of effects: their contents in the image of a scene with effects. SPDX-License-Identifier: Apache-2.0
#include <gridiron/build/effects/effect_sections.h>
#include <gridiron/build/lattice.h>
#include <gridiron/ray/lattice_run.h>
#include <gridiron/scene/effect_rules.h>

#include "core/build/grid/built_image.h"
#include "core/scene/test_effects.h"

namespace gridiron::test {
namespace {

BuiltImage build(const TestEffects& scene, TriangleFormat format = TriangleFormat::kVertices,
                 std::byte fill = std::byte{0xCD}) {
  const EffectsView view = scene.view();
  return build_image(scene.mesh(), {4.0f, 2, format}, fill, &view);
}

template <class Record>
Record read_at(const BuiltImage& built, std::uint64_t offset, std::uint64_t index) {
  return read_record<Record>(built.image.bytes(), offset + index * sizeof(Record));
}

std::vector<SectionEntry> entries_of(const BuiltImage& built) {
  std::vector<SectionEntry> entries;
  for (std::uint32_t i = 0; i < built.view.header.section_count; ++i) {
    entries.push_back(read_at<SectionEntry>(built, built.view.header.section_table_offset_bytes, i));
  }
  return entries;
}

TEST(EffectSections, StandBehindTheTrianglesWithoutGaps) {
  const BuiltImage built = build(all_effects(9));
  ASSERT_FALSE(HasFailure());
  EXPECT_TRUE(built.view.has_effects);
  const std::vector<SectionEntry> entries = entries_of(built);
  ASSERT_EQ(entries.size(), 13u);  // the last three are the tree's
  const std::uint64_t counts[] = {1, 3, 2, 4, 2, 24};
  const std::uint32_t bytes[] = {128, 48, 64, 48, 48, 768};
  for (std::uint32_t i = 0; i < 10; ++i) {
    EXPECT_EQ(entries[i].kind, i + 1);
    EXPECT_EQ(entries[i].offset_bytes % kLineBytes, 0u);
    EXPECT_EQ(entries[i].offset_bytes, i == 0 ? 640u : entries[i - 1].offset_bytes + entries[i - 1].section_bytes);
    if (i < 4) continue;
    EXPECT_EQ(entries[i].element_bytes, bytes[i - 4]);
    EXPECT_EQ(entries[i].element_count, counts[i - 4]);
    EXPECT_EQ(entries[i].section_bytes, (counts[i - 4] * bytes[i - 4] + 127) / 128 * 128);
  }

  const EffectsRecord& effects = built.view.effects;
  EXPECT_EQ(built.view.effects_offset_bytes, entries[4].offset_bytes);
  EXPECT_EQ(effects.materials_offset_bytes, entries[5].offset_bytes);
  EXPECT_EQ(effects.lights_offset_bytes, entries[6].offset_bytes);
  EXPECT_EQ(effects.surfaces_offset_bytes, entries[7].offset_bytes);
  EXPECT_EQ(effects.normals_offset_bytes, entries[8].offset_bytes);
  EXPECT_EQ(effects.environment_offset_bytes, entries[9].offset_bytes);
}

TEST(EffectSections, EmptyOnesAreLeftOut) {
  TestEffects scene = all_effects(0);
  scene.lights.clear();
  scene.triangle_materials.assign(4, 0);
  scene.triangle_normals.clear();
  scene.triangle_colors.clear();
  const BuiltImage built = build(scene);
  ASSERT_FALSE(HasFailure());
  EXPECT_EQ(built.view.header.section_count, 10u);
  const EffectsRecord& effects = built.view.effects;
  EXPECT_EQ(effects.lights_offset_bytes, 0u);
  EXPECT_EQ(effects.normals_offset_bytes, 0u);
  EXPECT_EQ(effects.environment_offset_bytes, 0u);
  EXPECT_NE(effects.materials_offset_bytes, 0u);
  EXPECT_NE(effects.surfaces_offset_bytes, 0u);
}

TEST(EffectSections, HoldTheSettings) {
  TestEffects scene = all_effects();
  const BuiltImage built = build(scene);
  ASSERT_FALSE(HasFailure());
  const EffectsRecord& effects = built.view.effects;
  EXPECT_EQ(effects.called_for, kAllEffects);
  EXPECT_EQ(effects.material_count, 3u);
  EXPECT_EQ(effects.light_count, 2u);
  EXPECT_EQ(effects.point_light_count, 1u);
  EXPECT_EQ(effects.recursion_depth, 3u);
  EXPECT_EQ(effects.samples_per_pixel, 4u);
  EXPECT_EQ(effects.occlusion_samples, 8u);
  EXPECT_EQ(effects.occlusion_radius, 0.5f);
  EXPECT_EQ(effects.background[0], 0.25f);
  EXPECT_EQ(effects.background[2], 0.75f);
  EXPECT_EQ(effects.has_shadows, 1u);
  EXPECT_EQ(effects.environment_width, 3u);
  EXPECT_EQ(effects.smooth_triangle_count, 2u);
  scene.settings.has_shadows = false;
  scene.settings.occlusion_samples = 0;
  const BuiltImage other = build(scene);
  EXPECT_EQ(other.view.effects.has_shadows, 0u);
  EXPECT_EQ(other.view.effects.occlusion_radius, 0.0f) << "without ambient occlusion there is no radius";
}

TEST(EffectSections, HoldMaterialsAndLights) {
  const TestEffects scene = all_effects();
  const BuiltImage built = build(scene);
  ASSERT_FALSE(HasFailure());
  const EffectsRecord& effects = built.view.effects;
  for (std::uint32_t i = 0; i < 3; ++i) {
    const auto material = read_at<MaterialRecord>(built, effects.materials_offset_bytes, i);
    const MaterialRecord expected = scaled_material(scene.materials[i]);
    EXPECT_EQ(std::memcmp(&material, &expected, sizeof(material)), 0) << i;
  }
  const auto point = read_at<LightRecord>(built, effects.lights_offset_bytes, 0);
  EXPECT_EQ(point.corner[2], 3.5f);
  EXPECT_EQ(point.samples, 0u);
  EXPECT_EQ(point.color[1], 0.5f);
  EXPECT_EQ(point.is_near, 1u);
  EXPECT_EQ(point.edge_u[0], 0.0f);
  const auto area = read_at<LightRecord>(built, effects.lights_offset_bytes, 1);
  EXPECT_EQ(area.corner[0], -1.0f);
  EXPECT_EQ(area.samples, 16u);
  EXPECT_EQ(area.color[0], 0.25f) << "of one sample";
  EXPECT_EQ(area.color[2], 0.75f);
  EXPECT_EQ(area.is_near, 0u);
  EXPECT_EQ(area.edge_u[0], 1.0f);
  EXPECT_EQ(area.edge_v[2], 100.0f);
}

TEST(EffectSections, HoldASurfaceForEveryTriangleAndNormalsForSmoothOnes) {
  const TestEffects scene = all_effects();
  const BuiltImage built = build(scene);
  ASSERT_FALSE(HasFailure());
  EXPECT_EQ(built.view.header.dropped_triangle_count, 1u);
  const EffectsRecord& effects = built.view.effects;
  const std::uint32_t normals[] = {kNoNormals, 0, 1, kNoNormals};
  for (std::uint32_t i = 0; i < 4; ++i) {
    const auto surface = read_at<SurfaceRecord>(built, effects.surfaces_offset_bytes, i);
    EXPECT_EQ(surface.material, scene.triangle_materials[i]);
    EXPECT_EQ(surface.normals, normals[i]);
    for (int corner = 0; corner < 3; ++corner) {
      const Vec3 vertex = scene.vertices[scene.triangles[i][corner]];
      EXPECT_EQ(std::memcmp(surface.v[corner], &vertex, sizeof(vertex)), 0) << i << " " << corner;
      if (normals[i] == kNoNormals) continue;
      const auto normal = read_at<NormalRecord>(built, effects.normals_offset_bytes, normals[i]);
      const Vec3 expected = scene.normals[scene.triangle_normals[i][corner]];
      EXPECT_EQ(std::memcmp(normal.n[corner], &expected, sizeof(expected)), 0) << i << " " << corner;
      EXPECT_EQ(normal.colors[corner], packed_color(scene.colors[scene.triangle_colors[i][corner]]));
    }
  }
}

// As cores make vertices of the triangles in the cells; dropped ones by the lattice itself.
TEST(EffectSections, HoldVerticesAsTheyWereMoved) {
  const TestEffects scene = all_effects();
  const BuiltImage built = build(scene, TriangleFormat::kLattice);
  ASSERT_FALSE(HasFailure());
  const EffectsRecord& effects = built.view.effects;
  const GridRecord& grid = built.view.grid;
  bool moved = false;
  for (std::uint32_t i = 0; i < grid.reference_count; ++i) {
    alignas(16) std::byte run[sizeof(VertexTriangle)];
    std::memcpy(run, built.image.bytes().data() + built.view.triangles_offset_bytes + i * sizeof(LatticeTriangle),
                sizeof(LatticeTriangle));
    const VertexTriangle* const triangle = spread_lattice_run(grid.lattice, run, 0, 1);
    const auto surface = read_at<SurfaceRecord>(built, effects.surfaces_offset_bytes, triangle->triangle_id);
    EXPECT_EQ(std::memcmp(surface.v, triangle->v, sizeof(surface.v)), 0) << triangle->triangle_id;
    moved |= surface.v[0][0] != scene.vertices[scene.triangles[triangle->triangle_id].x].x;
  }
  EXPECT_TRUE(moved);
  const auto dropped = read_at<SurfaceRecord>(built, effects.surfaces_offset_bytes, 2);
  const Vec3 corner = snap(grid.lattice, scene.vertices[2]);
  EXPECT_EQ(std::memcmp(dropped.v[2], &corner, sizeof(corner)), 0);
}

TEST(EffectSections, HoldPatchesOfTheEnvironment) {
  for (const std::uint32_t width : {1u, 2u, 3u, 7u, 8u, 9u, 15u, 16u, 30u}) {
    const TestEffects scene = all_effects(width);
    const BuiltImage built = build(scene);
    ASSERT_FALSE(HasFailure());
    const std::uint32_t blocks = environment_blocks(width);
    for (std::uint32_t face = 0; face < 6; ++face) {
      for (std::uint32_t row = 0; row < width; ++row) {
        for (std::uint32_t column = 0; column < width; ++column) {
          // The patch that begins at this texel, or the last one: all of it in one block.
          const auto begin = [&](std::uint32_t at) { return width < 2 ? 0 : std::min(at, width - 2); };
          const std::uint32_t j = begin(row) / 7, i = begin(column) / 7;
          const auto block = read_at<EnvironmentBlock>(built, built.view.effects.environment_offset_bytes,
                                                       (face * blocks + j) * blocks + i);
          for (std::uint32_t dy = 0; dy < 2; ++dy) {
            for (std::uint32_t dx = 0; dx < 2; ++dx) {
              const float* const texel = block.texels[begin(row) - 7 * j + dy][begin(column) - 7 * i + dx];
              EXPECT_EQ(texel[0], static_cast<float>(face));
              EXPECT_EQ(texel[1], static_cast<float>(std::min(begin(row) + dy, width - 1)));
              EXPECT_EQ(texel[2], static_cast<float>(std::min(begin(column) + dx, width - 1)));
            }
          }
        }
      }
    }
  }
}

TEST(EffectSections, AreTheSameBytesWhateverTheMemoryHeld) {
  for (const TriangleFormat format : {TriangleFormat::kVertices, TriangleFormat::kLattice}) {
    const BuiltImage one = build(all_effects(9), format, std::byte{0x00});
    const BuiltImage other = build(all_effects(9), format, std::byte{0xFF});
    ASSERT_FALSE(HasFailure());
    EXPECT_TRUE(std::ranges::equal(one.image.bytes(), other.image.bytes()));
  }
}

TEST(EffectSections, LeaveTheGeometryAsItIs) {
  const TestEffects scene = all_effects();
  const BuiltImage with = build(scene);
  const BuiltImage without = build_image(scene.mesh(), {4.0f, 2, TriangleFormat::kVertices});
  ASSERT_FALSE(HasFailure());
  EXPECT_FALSE(without.view.has_effects);
  EXPECT_EQ(without.view.header.section_count, 4u);
  EXPECT_EQ(with.cells, without.cells);
  EXPECT_EQ(std::memcmp(&with.view.grid, &without.view.grid, sizeof(GridRecord)), 0);
  const std::uint64_t geometry = without.need.image_bytes - without.view.macro_table_offset_bytes;
  EXPECT_EQ(std::memcmp(with.image.bytes().data() + with.view.macro_table_offset_bytes,
                        without.image.bytes().data() + without.view.macro_table_offset_bytes, geometry),
            0);
}

// --- Errors -------------------------------------------------------------------------------------------------------

Status count(const TestEffects& scene, TriangleFormat format = TriangleFormat::kVertices) {
  GridNeed need{};
  const EffectsView view = scene.view();
  return count_scene_image(scene.mesh(), {4.0f, 2, format}, need, &view);
}

TEST(EffectErrors, AreThoseOfTheCheck) {
  TestEffects scene = all_effects();
  EXPECT_EQ(count(scene), Status::kOk);
  EXPECT_EQ(count(scene, TriangleFormat::kProjection), Status::kBadParameter);
  scene.materials[2].ks = 2;
  EXPECT_EQ(count(scene), Status::kBadEffects);
  scene = all_effects();
  scene.triangle_materials[0] = 3;
  EXPECT_EQ(count(scene), Status::kBadIndex);
  scene = all_effects();
  scene.triangles[3].z = 6;
  EXPECT_EQ(count(scene), Status::kBadIndex);
}

TEST(EffectErrors, LightsTooFarInCells) {
  TestEffects scene = all_effects();
  for (Vec3& vertex : scene.vertices) vertex *= 0x1p-60f;  // about 2^60 cells a unit
  scene.lights[0].corner = Vec3(0x1p50f);
  EXPECT_EQ(count(scene), Status::kOk);
  scene.lights[0].corner.y = -0x1p70f;
  EXPECT_EQ(count(scene), Status::kBadEffects);
  scene.lights[0].corner.y = 1;
  scene.lights[1].edge_v.x = 0x1p70f;
  EXPECT_EQ(count(scene), Status::kBadEffects) << "a corner of an area light";
  scene.lights[1].edge_v.x = 1;
  scene.settings.occlusion_radius = 0x1p70f;
  EXPECT_EQ(count(scene), Status::kBadEffects) << "the radius";
  scene.settings.occlusion_samples = 0;
  EXPECT_EQ(count(scene), Status::kOk) << "a radius that nobody uses";
}

TEST(EffectErrors, BuildingRefusesWhatWasNotCounted) {
  const TestEffects scene = all_effects();
  const EffectsView view = scene.view();
  const GridParameters parameters{4.0f, 2, TriangleFormat::kVertices};
  GridNeed need{}, bare{};
  ASSERT_EQ(count_scene_image(scene.mesh(), parameters, need, &view), Status::kOk);
  ASSERT_EQ(count_scene_image(scene.mesh(), parameters, bare), Status::kOk);
  LineBuffer image(need.image_bytes);
  std::vector<std::uint64_t> words(need.scratch_bytes / 8);
  const std::span<std::byte> scratch = std::as_writable_bytes(std::span(words));
  EXPECT_EQ(build_scene_image(scene.mesh(), parameters, need, image.bytes(), scratch), Status::kBadParameter);
  EXPECT_EQ(build_scene_image(scene.mesh(), parameters, bare, image.bytes(), scratch, &view), Status::kBadParameter);
  const TestEffects other = all_effects(9);
  const EffectsView other_view = other.view();
  EXPECT_EQ(build_scene_image(scene.mesh(), parameters, need, image.bytes(), scratch, &other_view),
            Status::kBadParameter);
  EXPECT_EQ(build_scene_image(scene.mesh(), parameters, need, image.bytes(), scratch, &view), Status::kOk);
}

}  // namespace
}  // namespace gridiron::test
