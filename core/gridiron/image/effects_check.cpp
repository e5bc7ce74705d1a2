// Checks of the sections of effects: see image_checker.h. SPDX-License-Identifier: Apache-2.0
#include <gridiron/base/lanes.h>
#include <gridiron/base/math.h>
#include <gridiron/build/lattice.h>
#include <gridiron/build/triangle_records.h>
#include <gridiron/image/image_checker.h>
#include <gridiron/scene/effect_rules.h>

namespace gridiron {
namespace {

bool all_within(const float* values, int count, float low, float high) {
  bool good = true;
  for (int i = 0; i < count; ++i) good = good && within(values[i], low, high);
  return good;
}

// --- Materials and lights -------------------------------------------------------------------------------------------

bool check_materials(ImageChecker& checker, const EffectsRecord& effects) {
  for (std::uint64_t i = 0; i < effects.material_count; ++i) {
    const std::uint64_t base = effects.materials_offset_bytes + i * sizeof(MaterialRecord);
    const auto material = checker.read<MaterialRecord>(base);
    const float other_shares = material.specular + material.transmittance;
    GRIDIRON_REQUIRE(within(material.specular, 0.0f, 1.0f), base, material, specular);
    GRIDIRON_REQUIRE(within(material.transmittance, 0.0f, 1.0f) && other_shares <= kMaxShareSum, base, material,
                     transmittance);
    GRIDIRON_REQUIRE(all_within(material.transmitted, 3, 0.0f, material.transmittance), base, material, transmitted);
    GRIDIRON_REQUIRE(all_within(material.diffuse, 3, 0.0f, kMaxShareSum - other_shares), base, material, diffuse);
    GRIDIRON_REQUIRE(within(material.shine, 0.0f, kMaxShine), base, material, shine);
    const bool index_ok =
        material.transmittance > 0.0f ? within(material.index, kLeastIndex, kGreatestIndex) : material.index == 1.0f;
    GRIDIRON_REQUIRE(index_ok, base, material, index);
    GRIDIRON_REQUIRE(material.is_smooth <= 1, base, material, is_smooth);
    GRIDIRON_REQUIRE(material.has_colors <= material.is_smooth, base, material, has_colors);
  }
  return true;
}

bool check_light(ImageChecker& checker, const LightRecord& light, std::uint64_t base, const GridRecord& grid) {
  GRIDIRON_REQUIRE(finite_fields(light.corner, 3), base, light, corner);
  const float none[3] = {0.0f, 0.0f, 0.0f};
  const bool edges_ok = light.samples == 0 ? same_bits(light.edge_u, none, 3) && same_bits(light.edge_v, none, 3)
                                           : finite_fields(light.edge_u, 3) && finite_fields(light.edge_v, 3);
  GRIDIRON_REQUIRE(edges_ok, base, light, edge_u);
  GRIDIRON_REQUIRE(light_has_place(light) && light_is_in_reach(light, grid), base, light, corner);
  GRIDIRON_REQUIRE(all_within(light.color, 3, 0.0f, kMaxLightColor), base, light, color);
  GRIDIRON_REQUIRE(light.is_near == light_is_near(light, grid), base, light, is_near);
  GRIDIRON_REQUIRE(light.reserved0 == 0, base, light, reserved0);
  GRIDIRON_REQUIRE(light.reserved1 == 0, base, light, reserved1);
  return true;
}

bool check_lights(ImageChecker& checker, const SceneImageView& view, EffectsCall& call) {
  const EffectsRecord& effects = view.effects;
  for (std::uint64_t i = 0; i < effects.light_count; ++i) {
    const std::uint64_t base = effects.lights_offset_bytes + i * sizeof(LightRecord);
    const auto light = checker.read<LightRecord>(base);
    GRIDIRON_REQUIRE(light.samples <= kMaxEffectSamples && (light.samples == 0) == (i < effects.point_light_count),
                     base, light, samples);
    if (!check_light(checker, light, base, view.grid)) return false;
    call.add_light(light);
  }
  return true;
}

// --- Surfaces and normals -------------------------------------------------------------------------------------------

// Whether the image's format can store the corners.
bool is_storable(const SurfaceRecord& surface, const GridRecord& grid) {
  for (const auto& corner : surface.v) {
    const Vec3 point(corner[0], corner[1], corner[2]);
    for (const float at : corner) {
      if (!(magnitude(at) <= kCoordinateLimit)) return false;
    }
    if (grid.triangle_format != static_cast<std::uint32_t>(TriangleFormat::kLattice)) continue;
    const Vec3 moved = snap(grid.lattice, point);
    const float places[3] = {moved.x, moved.y, moved.z};
    if (!same_bits(places, corner, 3)) return false;
  }
  return true;
}

bool check_normal(ImageChecker& checker, const EffectsRecord& effects, std::uint64_t index, bool has_colors) {
  const std::uint64_t base = effects.normals_offset_bytes + index * sizeof(NormalRecord);
  const auto normal = checker.read<NormalRecord>(base);
  GRIDIRON_REQUIRE(is_unit(normal.n[0]) && is_unit(normal.n[1]) && is_unit(normal.n[2]), base, normal, n);
  for (const PackedColor color : normal.colors) {
    GRIDIRON_REQUIRE(color >> (has_colors ? 3 * kColorBits : 0) == 0, base, normal, colors);
  }
  return true;
}

bool check_surfaces(ImageChecker& checker, const SceneImageView& view, EffectsCall& call) {
  const EffectsRecord& effects = view.effects;
  const ImageHeader& header = view.header;
  std::uint32_t dropped = 0;
  std::uint32_t normals = 0;
  std::uint32_t last_material = kNoTriangle;
  MaterialRecord material{};
  for (std::uint64_t i = 0; i < header.triangle_count; ++i) {
    const std::uint64_t base = effects.surfaces_offset_bytes + i * sizeof(SurfaceRecord);
    const auto surface = checker.read<SurfaceRecord>(base);
    GRIDIRON_REQUIRE(is_storable(surface, view.grid), base, surface, v);
    const auto corner = [&](int k) { return Vec3(surface.v[k][0], surface.v[k][1], surface.v[k][2]); };
    const bool is_dropped = has_zero_area(corner(0), corner(1), corner(2));
    dropped += is_dropped ? 1u : 0u;
    const bool place_ok =
        is_dropped ? surface.tree_place == kNoTriangle : surface.tree_place < view.tree.triangle_count;
    GRIDIRON_REQUIRE(place_ok, base, surface, tree_place);
    GRIDIRON_REQUIRE(surface.material < effects.material_count, base, surface, material);
    if (surface.material != last_material) {
      last_material = surface.material;
      material = checker.read<MaterialRecord>(effects.materials_offset_bytes +
                                              std::uint64_t{last_material} * sizeof(MaterialRecord));
      call.add_material(material);
    }
    const bool is_smooth = material.is_smooth != 0;
    GRIDIRON_REQUIRE(surface.normals == (is_smooth ? normals : kNoNormals), base, surface, normals);
    if (!is_smooth) continue;
    GRIDIRON_REQUIRE(normals < effects.smooth_triangle_count, view.effects_offset_bytes, effects,
                     smooth_triangle_count);
    if (!check_normal(checker, effects, normals++, material.has_colors != 0)) return false;
  }
  GRIDIRON_REQUIRE(dropped == header.dropped_triangle_count, 0, header, dropped_triangle_count);
  GRIDIRON_REQUIRE(normals == effects.smooth_triangle_count, view.effects_offset_bytes, effects, smooth_triangle_count);
  return true;
}

// The surface of every triangle in a cell must have that triangle's corners, so that shading sees what was hit.
bool check_corners(ImageChecker& checker, const SceneImageView& view) {
  const GridRecord& grid = view.grid;
  for (std::uint64_t i = 0; i < grid.reference_count; ++i) {
    const VertexTriangle triangle = checker.read_triangle(view.triangles_offset_bytes + i * grid.triangle_bytes, grid);
    const std::uint64_t base =
        view.effects.surfaces_offset_bytes + std::uint64_t{triangle.triangle_id} * sizeof(SurfaceRecord);
    const auto surface = checker.read<SurfaceRecord>(base);
    GRIDIRON_REQUIRE(same_bits(&surface.v[0][0], &triangle.v[0][0], 9), base, surface, v);
  }
  return true;
}

// --- Environment ----------------------------------------------------------------------------------------------------

// Texels must be in their range, and those that a block shares with its neighbours, or repeats, must be the same
// everywhere.
bool check_environment(ImageChecker& checker, const EffectsRecord& effects) {
  if (effects.environment_width == 0) return true;
  const std::uint32_t last = effects.environment_width - 1;
  const std::uint32_t blocks = environment_blocks(effects.environment_width);
  const auto texel_at = [&](std::uint64_t block, std::uint32_t row, std::uint32_t column) {
    return effects.environment_offset_bytes + block * sizeof(EnvironmentBlock) +
           (std::uint64_t{row} * 8 + column) * sizeof(EnvironmentBlock::texels[0][0]);
  };
  // Where a row or column of a face begins a patch, or is the face's last: block, and index in it.
  struct Home {
    std::uint32_t block, place;
  };
  const auto home_of = [&](std::uint32_t at) {
    const std::uint32_t inside = at < last ? at : last;
    const std::uint32_t block = inside / kEnvironmentPatches < blocks ? inside / kEnvironmentPatches : blocks - 1;
    return Home{block, inside - kEnvironmentPatches * block};
  };
  struct Texel {
    float color[3];
  };
  static_assert(sizeof(Texel) == sizeof(EnvironmentBlock::texels[0][0]));
  for (std::uint64_t block = 0; block < 6ull * blocks * blocks; ++block) {
    const auto i = static_cast<std::uint32_t>(block % blocks);
    const auto j = static_cast<std::uint32_t>(block / blocks % blocks);
    const std::uint64_t face_block = block - (std::uint64_t{j} * blocks + i);
    for (std::uint32_t y = 0; y < 8; ++y) {
      for (std::uint32_t x = 0; x < 8; ++x) {
        const std::uint64_t place = texel_at(block, y, x);
        const auto texel = checker.read<Texel>(place);
        const Home row = home_of(kEnvironmentPatches * j + y), column = home_of(kEnvironmentPatches * i + x);
        const auto first = checker.read<Texel>(
            texel_at(face_block + std::uint64_t{row.block} * blocks + column.block, row.place, column.place));
        const bool good = all_within(texel.color, 3, 0.0f, kFloatMax) && same_bits(texel.color, first.color, 3);
        if (!checker.require(good, place, "environment.texels")) return false;
      }
    }
  }
  return true;
}

}  // namespace

bool check_effect_sections(ImageChecker& checker, const SceneImageView& view) {
  if (!view.has_effects) return true;
  const EffectsRecord& effects = view.effects;
  const std::uint64_t base = view.effects_offset_bytes;
  if (!check_effect_measures(checker, base, effects)) return false;
  GRIDIRON_REQUIRE(effects.occlusion_samples == 0 || radius_is_in_reach(effects.occlusion_radius, view.grid), base,
                   effects, occlusion_radius);
  EffectsCall call;
  if (!check_materials(checker, effects) || !check_lights(checker, view, call) ||
      !check_surfaces(checker, view, call) || !check_corners(checker, view) || !check_environment(checker, effects)) {
    return false;
  }
  GRIDIRON_REQUIRE(effects.called_for == call.called_for(effects), base, effects, called_for);
  return true;
}

}  // namespace gridiron
