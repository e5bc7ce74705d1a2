// Effects of a scene: see the headers. SPDX-License-Identifier: Apache-2.0
#include <gridiron/base/lanes.h>
#include <gridiron/base/one_lane.h>
#include <gridiron/scene/effect_rules.h>
#include <gridiron/scene/effects.h>

#include <cstddef>

namespace gridiron {
namespace {

bool is_finite(float value) {
  return value - value == 0.0f;
}

bool is_finite(const Vec3& v) {
  return is_finite(v.x) && is_finite(v.y) && is_finite(v.z);
}

bool all_within(const Vec3& v, float low, float high) {
  return within(v.x, low, high) && within(v.y, low, high) && within(v.z, low, high);
}

void copy(float out[3], const Vec3& v) {
  for (int axis = 0; axis < 3; ++axis) out[axis] = v[axis];
}

// The light without the fields that depend on the grid.
LightRecord placed_light(const Light& light) {
  LightRecord record{};
  copy(record.corner, light.corner);
  record.samples = light.samples;
  copy(record.color, light.color);
  if (light.samples == 0) return record;
  for (float& color : record.color) color = color / static_cast<float>(light.samples);
  copy(record.edge_u, light.edge_u);
  copy(record.edge_v, light.edge_v);
  return record;
}

constexpr int corner_count(const LightRecord& light) {
  return light.samples == 0 ? 1 : 4;
}

// Exact but for one rounding to double, or none.
double corner_of(const LightRecord& light, int corner, int axis) {
  const double u = (corner & 1) != 0 ? double{light.edge_u[axis]} : 0.0;
  const double v = (corner & 2) != 0 ? double{light.edge_v[axis]} : 0.0;
  return double{light.corner[axis]} + (u + v);
}

// The largest |coordinate|; if one is not a finite float, that one.
double farthest_coordinate(const LightRecord& light) {
  double farthest = 0.0;
  for (int corner = 0; corner < corner_count(light); ++corner) {
    for (int axis = 0; axis < 3; ++axis) {
      const double distance = magnitude(corner_of(light, corner, axis));
      if (!(distance <= double{kFloatMax})) return distance;
      farthest = distance > farthest ? distance : farthest;
    }
  }
  return farthest;
}

// Products of floats are exact in double.
bool are_parallel(const float u[3], const float v[3]) {
  return double{u[1]} * double{v[2]} == double{u[2]} * double{v[1]} &&
         double{u[2]} * double{v[0]} == double{u[0]} * double{v[2]} &&
         double{u[0]} * double{v[1]} == double{u[1]} * double{v[0]};
}

bool material_is_in_range(const Material& material) {
  const bool index_ok =
      material.transmittance > 0.0f ? within(material.index, kLeastIndex, kGreatestIndex) : is_finite(material.index);
  return all_within(material.color, 0.0f, 1.0f) && within(material.kd, 0.0f, 1.0f) && within(material.ks, 0.0f, 1.0f) &&
         within(material.transmittance, 0.0f, 1.0f) && within(material.shine, 0.0f, kMaxShine) && index_ok &&
         (material.smooth_normals || !material.vertex_colors);
}

Status check_lights(const EffectsView& effects) {
  bool area_seen = false;
  for (const Light& light : effects.lights) {
    const bool is_area = light.samples != 0;
    const bool finite = is_finite(light.corner) && is_finite(light.edge_u) && is_finite(light.edge_v);
    if (!finite || light.samples > kMaxEffectSamples || (area_seen && !is_area) ||
        !all_within(light.color, 0.0f, kMaxLightColor) || !light_has_place(placed_light(light))) {
      return Status::kBadEffects;
    }
    area_seen = is_area;
  }
  return Status::kOk;
}

// Whether a triangle has three indices below `count` where it must have them, and else none.
Status check_corners(const UVec3& indices, bool must_have, std::size_t count) {
  if ((indices == UVec3(kNoNormals)) == must_have) return Status::kBadEffects;
  for (int corner = 0; corner < 3 && must_have; ++corner) {
    if (indices[corner] >= count) return Status::kBadIndex;
  }
  return Status::kOk;
}

// Materials must exist; normals and colours must be there exactly if the material says so.
Status check_triangles(const MeshView& mesh, const EffectsView& effects) {
  const auto corners = [](std::span<const UVec3> indices, std::size_t i) {
    return indices.empty() ? UVec3(kNoNormals) : indices[i];
  };
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const std::uint32_t material = effects.triangle_materials[i];
    if (material >= effects.materials.size()) return Status::kBadIndex;
    const Material& surface = effects.materials[material];
    GRIDIRON_TRY(check_corners(corners(effects.triangle_normals, i), surface.smooth_normals, effects.normals.size()));
    GRIDIRON_TRY(check_corners(corners(effects.triangle_colors, i), surface.vertex_colors, effects.colors.size()));
  }
  return Status::kOk;
}

bool environment_is_in_range(const EffectsView& effects) {
  const std::uint64_t texel_count = std::uint64_t{effects.environment_width} * effects.environment_width;
  for (const std::span<const Vec3>& face : effects.environment_faces) {
    if (face.size() != texel_count) return false;
    bool good = true;
    for (const Vec3& texel : face) good &= all_within(texel, 0.0f, kFloatMax);
    if (!good) return false;
  }
  return true;
}

}  // namespace

MaterialRecord scaled_material(const Material& material) {
  const float sum = (material.kd + material.ks) + material.transmittance;
  const float divisor = sum > 1.0f ? sum : 1.0f;
  const float kd = material.kd / divisor;
  MaterialRecord record{};
  record.specular = material.ks / divisor;
  record.transmittance = material.transmittance / divisor;
  for (int channel = 0; channel < 3; ++channel) {
    record.diffuse[channel] = kd * material.color[channel];
    record.transmitted[channel] = record.transmittance * material.color[channel];
  }
  record.shine = material.shine;
  record.index = record.transmittance > 0.0f ? material.index : 1.0f;
  record.is_smooth = material.smooth_normals ? 1 : 0;
  record.has_colors = material.vertex_colors ? 1 : 0;
  return record;
}

std::uint32_t light_is_near(const LightRecord& light, const GridRecord& grid) {
  float scene = 0.0f;
  for (int axis = 0; axis < 3; ++axis) {
    const float low = magnitude(grid.bounds_minimum[axis]), high = magnitude(grid.bounds_maximum[axis]);
    scene = low > scene ? low : scene;
    scene = high > scene ? high : scene;
  }
  return farthest_coordinate(light) <= double{kNearLightFactor} * double{scene} ? 1 : 0;
}

LightRecord light_record(const Light& light, const GridRecord& grid) {
  LightRecord record = placed_light(light);
  record.is_near = light_is_near(record, grid);
  return record;
}

bool light_has_place(const LightRecord& light) {
  return farthest_coordinate(light) <= double{kCoordinateLimit} &&
         (light.samples == 0 || !are_parallel(light.edge_u, light.edge_v));
}

bool light_is_in_reach(const LightRecord& light, const GridRecord& grid) {
  for (int corner = 0; corner < corner_count(light); ++corner) {
    for (int axis = 0; axis < 3; ++axis) {
      const double distance = magnitude(corner_of(light, corner, axis) - double{grid.minimum[axis]});
      if (!(distance * double{grid.cells_per_unit[axis]} <= kCellSpaceLimit)) return false;
    }
  }
  return true;
}

bool radius_is_in_reach(float radius, const GridRecord& grid) {
  for (const float scale : grid.cells_per_unit) {
    if (!(double{radius} * double{scale} <= kCellDirectionLimit)) return false;
  }
  return true;
}

PackedColor packed_color(const Vec3& color) {
  PackedColor word = 0;
  for (std::uint32_t channel = 0; channel < 3; ++channel) {
    const float steps = square_root(color[static_cast<int>(channel)]) * static_cast<float>(kColorSteps) + 0.5f;
    word |= static_cast<std::uint32_t>(static_cast<std::int32_t>(steps)) << (kColorBits * channel);
  }
  return word;
}

bool is_unit(const float normal[3]) {
  constexpr double kLeast = 1.0 - 0x1p-10, kMost = 1.0 + 0x1p-10;
  double square = 0.0;
  for (int axis = 0; axis < 3; ++axis) square += double{normal[axis]} * double{normal[axis]};
  return square >= kLeast * kLeast && square <= kMost * kMost;
}

void EffectsCall::add_light(const LightRecord& light) {
  if (light.color[0] == 0.0f && light.color[1] == 0.0f && light.color[2] == 0.0f) return;
  (light.samples == 0 ? point_light : area_light) = true;
}

void EffectsCall::add_material(const MaterialRecord& material) {
  reflects |= material.specular > 0.0f || material.transmittance > 0.0f;  // glass reflects by Fresnel
  refracts |= material.transmittance > 0.0f;
  shines |= material.specular > 0.0f && material.shine > 0.0f;
  smooth |= material.is_smooth != 0;
  colors |= material.has_colors != 0;
}

std::uint32_t EffectsCall::called_for(const EffectsRecord& scene) const {
  const auto bit = [](bool holds, std::uint32_t effect) { return holds ? effect : 0u; };
  const bool bounces = scene.recursion_depth > 1;
  return kSceneShading | counted_effects(scene) | bit(scene.has_shadows != 0 && point_light, kPointShadows) |
         bit(area_light, kAreaLights) | bit(bounces && reflects, kReflection) | bit(bounces && refracts, kRefraction) |
         bit(smooth, kSmoothNormals) | bit(colors, kVertexColors) |
         bit((point_light || area_light) && shines, kHighlights);
}

EffectsRecord scene_settings(const EffectsView& effects) {
  EffectsRecord record{};
  record.material_count = effects.materials.size() <= kMaxMaterials
                              ? static_cast<std::uint32_t>(effects.materials.size())
                              : kMaxMaterials + 1;
  record.light_count =
      effects.lights.size() <= kMaxLights ? static_cast<std::uint32_t>(effects.lights.size()) : kMaxLights + 1;
  for (const Light& light : effects.lights.first(record.light_count <= kMaxLights ? record.light_count : 0)) {
    if (light.samples == 0) ++record.point_light_count;
  }
  record.recursion_depth = effects.recursion_depth;
  record.samples_per_pixel = effects.samples_per_pixel;
  record.occlusion_samples = effects.occlusion_samples;
  record.occlusion_radius = effects.occlusion_samples != 0 ? effects.occlusion_radius : 0.0f;
  copy(record.background, effects.background);
  record.has_shadows = effects.has_shadows ? 1 : 0;
  record.environment_width = effects.environment_width;
  record.levels = static_cast<std::uint32_t>(effects.levels);
  return record;
}

std::uint32_t effects_called_for(const EffectsView& effects) {
  EffectsCall call;
  for (const Light& light : effects.lights) call.add_light(placed_light(light));
  std::uint32_t last = kNoTriangle;  // triangles of a material are often contiguous
  for (const std::uint32_t index : effects.triangle_materials) {
    if (index == last || index >= effects.materials.size()) continue;
    call.add_material(scaled_material(effects.materials[index]));
    last = index;
  }
  return call.called_for(scene_settings(effects));
}

Status check_effects(const MeshView& mesh, const EffectsView& effects) {
  const EffectsRecord settings = scene_settings(effects);
  if (!check_effect_counts(AnyFault{}, 0, settings) || !check_effect_measures(AnyFault{}, 0, settings) ||
      !is_finite(effects.occlusion_radius)) {
    return Status::kBadEffects;
  }
  const std::size_t triangle_count = mesh.triangles.size();
  if (effects.triangle_materials.size() != triangle_count ||
      (!effects.triangle_normals.empty() && effects.triangle_normals.size() != triangle_count) ||
      (!effects.triangle_colors.empty() && effects.triangle_colors.size() != triangle_count)) {
    return Status::kBadEffects;
  }
  for (const Material& material : effects.materials) {
    if (!material_is_in_range(material)) return Status::kBadEffects;
  }
  for (const Vec3& normal : effects.normals) {
    const float components[3] = {normal.x, normal.y, normal.z};
    if (!is_unit(components)) return Status::kBadEffects;
  }
  for (const Vec3& color : effects.colors) {
    if (!all_within(color, 0.0f, 1.0f)) return Status::kBadEffects;
  }
  GRIDIRON_TRY(check_lights(effects));
  if (!environment_is_in_range(effects)) return Status::kBadEffects;
  return check_triangles(mesh, effects);
}

}  // namespace gridiron
