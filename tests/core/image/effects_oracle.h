// What a kernel may rely on in the effects of an opened image, checked independently: range by range, from the bytes.
// Source: core/SPEC.md. Memory: none. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/image/scene_image.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

namespace gridiron::test {

/// Reads every record of effects. @returns what is out of range, or null.
inline const char* broken_effects(std::span<const std::byte> bytes, const SceneImageView& view) {
  const EffectsRecord& e = view.effects;
  const auto bad = [](float value, float low, float high) { return !(value >= low && value <= high); };
  bool outside = false;
  const auto read = [&]<class Record>(std::uint64_t offset, std::uint64_t index, Record& record) {
    const std::uint64_t place = offset + index * sizeof(Record);
    outside |= offset < 256 || offset % kLineBytes != 0 || place + sizeof(Record) > bytes.size();
    if (!outside) std::memcpy(&record, bytes.data() + place, sizeof(Record));
    return !outside;
  };
  if (!view.has_effects) return e.called_for == 0 && view.effects_offset_bytes == 0 ? nullptr : "effects of none";
  EffectsRecord stored{};
  if (!read(view.effects_offset_bytes, 0, stored) || std::memcmp(&stored, &e, sizeof(e)) != 0) return "the record";
  if (e.material_count < 1 || e.material_count > kMaxMaterials) return "material_count";
  if (e.light_count > kMaxLights || e.point_light_count > e.light_count) return "light_count";
  if (e.recursion_depth < 1 || e.recursion_depth > kMaxRecursionDepth) return "recursion_depth";
  if (e.samples_per_pixel != 1 && e.samples_per_pixel != 4 && e.samples_per_pixel != 16) return "samples_per_pixel";
  if (e.occlusion_samples > kMaxEffectSamples) return "occlusion_samples";
  if (e.occlusion_samples != 0 && (!(e.occlusion_radius > 0) || !std::isfinite(e.occlusion_radius))) return "radius";
  for (const float channel : e.background) {
    if (bad(channel, 0, 1)) return "background";
  }
  if (e.has_shadows > 1) return "has_shadows";
  if (e.environment_width > kMaxEnvironmentWidth) return "environment_width";

  bool point = false, area = false;
  for (std::uint32_t i = 0; i < e.light_count; ++i) {
    LightRecord light{};
    if (!read(e.lights_offset_bytes, i, light)) return "lights_offset_bytes";
    if (light.samples > kMaxEffectSamples || (light.samples == 0) != (i < e.point_light_count)) return "samples";
    if (light.is_near > 1) return "is_near";
    bool dark = true;
    for (int axis = 0; axis < 3; ++axis) {
      if (bad(light.color[axis], 0, kMaxLightColor)) return "color";
      dark &= light.color[axis] == 0;
      for (int corner = 0; corner < 4; ++corner) {
        const double u = (corner & 1) * double{light.edge_u[axis]}, v = (corner / 2) * double{light.edge_v[axis]};
        const double place = light.corner[axis] + u + v;
        const double cells = (place - view.grid.minimum[axis]) * view.grid.cells_per_unit[axis];
        if (!(std::fabs(place) <= kCoordinateLimit * (1 + 1e-9)) ||
            !(std::fabs(cells) <= kCellSpaceLimit * (1 + 1e-9))) {
          return "a light's place";
        }
      }
    }
    (light.samples == 0 ? point : area) |= !dark;
  }

  std::uint32_t call = kSceneShading, smooth_count = 0;
  for (std::uint32_t i = 0; i < view.header.triangle_count; ++i) {
    SurfaceRecord surface{};
    MaterialRecord material{};
    if (!read(e.surfaces_offset_bytes, i, surface)) return "surfaces_offset_bytes";
    for (const auto& corner : surface.v) {
      for (const float coordinate : corner) {
        if (!std::isfinite(coordinate)) return "surface.v";
      }
    }
    if (surface.material >= e.material_count) return "surface.material";
    if (!read(e.materials_offset_bytes, surface.material, material)) return "materials_offset_bytes";
    const bool bounces = e.recursion_depth > 1;
    if (bounces && (material.specular > 0 || material.transmittance > 0)) call |= kReflection;
    if (bounces && material.transmittance > 0) call |= kRefraction;
    if ((point || area) && material.specular > 0 && material.shine > 0) call |= kHighlights;
    if (material.is_smooth != 0) call |= kSmoothNormals;
    if (material.has_colors != 0) call |= kVertexColors;
    if ((surface.normals != kNoNormals) != (material.is_smooth != 0)) return "surface.normals";
    if (surface.normals == kNoNormals) continue;
    ++smooth_count;
    NormalRecord normal{};
    if (surface.normals >= e.smooth_triangle_count) return "surface.normals";
    if (!read(e.normals_offset_bytes, surface.normals, normal)) return "normals_offset_bytes";
    for (const auto& n : normal.n) {
      const double length = std::sqrt(double{n[0]} * n[0] + double{n[1]} * n[1] + double{n[2]} * n[2]);
      if (!(std::fabs(length - 1) < 0.001)) return "normal.n";
    }
    for (const PackedColor color : normal.colors) {
      if (material.has_colors != 0 ? color >= 1u << 30 : color != 0) return "normal.colors";
    }
  }
  if (smooth_count != e.smooth_triangle_count) return "smooth_triangle_count";
  if (e.has_shadows != 0 && point) call |= kPointShadows;
  if (area) call |= kAreaLights;
  if (e.occlusion_samples != 0) call |= kAmbientOcclusion;
  if (e.environment_width != 0) call |= kEnvironment;
  if (e.samples_per_pixel > 1) call |= kMultisampling;
  if (call != e.called_for) return "called_for";

  for (std::uint32_t i = 0; i < e.material_count; ++i) {
    MaterialRecord material{};
    if (!read(e.materials_offset_bytes, i, material)) return "materials_offset_bytes";
    for (int channel = 0; channel < 3; ++channel) {
      if (bad(material.diffuse[channel], 0, 1.0001f) || bad(material.transmitted[channel], 0, 1)) return "colors";
      if (material.diffuse[channel] + material.specular + material.transmittance > 1.0001f) return "shares";
      if (material.transmitted[channel] > material.transmittance) return "transmitted";
    }
    if (bad(material.specular, 0, 1) || bad(material.transmittance, 0, 1)) return "shares";
    if (bad(material.shine, 0, 1e5f) || bad(material.index, 0.1f, 10) || material.is_smooth > 1) return "material";
    if (material.has_colors > material.is_smooth) return "material.has_colors";
  }
  const std::uint32_t blocks = environment_blocks(e.environment_width);
  for (std::uint32_t i = 0; e.environment_width != 0 && i < 6 * blocks * blocks; ++i) {
    EnvironmentBlock block{};
    if (!read(e.environment_offset_bytes, i, block)) return "environment_offset_bytes";
    for (const auto& row : block.texels) {
      for (const auto& texel : row) {
        for (const float channel : texel) {
          if (bad(channel, 0, 3.4028235e38f)) return "environment.texels";
        }
      }
    }
  }
  return nullptr;
}

}  // namespace gridiron::test
