// Sections of effects: see the header. SPDX-License-Identifier: Apache-2.0
#include <gridiron/base/image_rules.h>
#include <gridiron/build/effects/effect_sections.h>
#include <gridiron/build/lattice.h>
#include <gridiron/scene/effect_rules.h>

namespace gridiron {
namespace {

template <class Record>
void store(std::byte* image, std::uint64_t offset, const Record& record) {
  __builtin_memcpy(image + offset, &record, sizeof(Record));
}

// Appends a section unless it is empty. @returns its offset, or 0.
std::uint64_t append(EffectSections& sections, SectionKind kind, std::uint64_t element_bytes,
                     std::uint64_t element_count) {
  if (element_count == 0) return 0;
  const std::uint64_t begin = sections.end_bytes;
  const std::uint64_t bytes = round_up<std::uint64_t>(element_bytes * element_count, kLineBytes);
  sections.entries[sections.section_count++] = {static_cast<std::uint32_t>(kind),
                                                static_cast<std::uint32_t>(element_bytes), begin, element_count, bytes};
  sections.end_bytes = begin + bytes;
  return begin;
}

void copy(float out[3], const Vec3& v) {
  for (int axis = 0; axis < 3; ++axis) out[axis] = v[axis];
}

void write_surfaces(const MeshView& mesh, const EffectsView& effects, const GridRecord& grid,
                    const EffectsRecord& record, std::byte* image) {
  const bool lattice = grid.triangle_format == static_cast<std::uint32_t>(TriangleFormat::kLattice);
  std::uint64_t surface_at = record.surfaces_offset_bytes;
  std::uint64_t normals_at = record.normals_offset_bytes;
  std::uint32_t normals = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    SurfaceRecord surface{};
    surface.material = effects.triangle_materials[i];
    surface.normals = kNoNormals;
    surface.tree_place = kNoTriangle;  // until the tree is there
    for (int corner = 0; corner < 3; ++corner) {
      const Vec3& vertex = mesh.vertices[mesh.triangles[i][corner]];
      copy(surface.v[corner], lattice ? snap(grid.lattice, vertex) : vertex);
    }
    if (effects.materials[surface.material].smooth_normals) {
      NormalRecord normal{};
      for (int corner = 0; corner < 3; ++corner) {
        copy(normal.n[corner], effects.normals[effects.triangle_normals[i][corner]]);
        if (effects.materials[surface.material].vertex_colors) {
          normal.colors[corner] = packed_color(effects.colors[effects.triangle_colors[i][corner]]);
        }
      }
      store(image, normals_at, normal);
      normals_at += sizeof(NormalRecord);
      surface.normals = normals++;
    }
    store(image, surface_at, surface);
    surface_at += sizeof(SurfaceRecord);
  }
}

void write_environment(const EffectsView& effects, std::uint64_t offset, std::byte* image) {
  const std::uint32_t width = effects.environment_width;
  const std::uint32_t blocks = environment_blocks(width);
  for (const std::span<const Vec3>& face : effects.environment_faces) {
    for (std::uint32_t j = 0; j < blocks; ++j) {
      for (std::uint32_t i = 0; i < blocks; ++i, offset += sizeof(EnvironmentBlock)) {
        EnvironmentBlock block;
        for (std::uint32_t y = 0; y < 8; ++y) {
          for (std::uint32_t x = 0; x < 8; ++x) {
            const std::uint32_t row = kEnvironmentPatches * j + y, column = kEnvironmentPatches * i + x;
            const std::size_t last = width - 1;
            copy(block.texels[y][x], face[(row < last ? row : last) * width + (column < last ? column : last)]);
          }
        }
        store(image, offset, block);
      }
    }
  }
}

}  // namespace

EffectsRecord count_effects(const EffectsView& effects) {
  EffectsRecord record = scene_settings(effects);
  record.called_for = effects_called_for(effects);
  for (const std::uint16_t material : effects.triangle_materials) {
    record.smooth_triangle_count += effects.materials[material].smooth_normals ? 1u : 0u;
  }
  return record;
}

std::uint32_t effect_section_count(const EffectsRecord& counted) {
  std::uint32_t count = 1;
  for_each_effect_part(counted, 1,
                       [&count](const CountedPart& part) { return count += part.element_count != 0 ? 1 : 0, true; });
  return count;
}

EffectSections place_effect_sections(const EffectsRecord& counted, std::uint32_t triangle_count,
                                     std::uint64_t begin_bytes) {
  EffectSections sections{};
  EffectsRecord& record = sections.record;
  record = counted;
  sections.begin_bytes = begin_bytes;
  sections.end_bytes = begin_bytes;
  static_cast<void>(append(sections, SectionKind::kEffects, sizeof(EffectsRecord), 1));
  for_each_effect_part(counted, triangle_count, [&](const CountedPart& part) {
    const std::uint64_t offset = append(sections, part.kind, part.element_bytes, part.element_count);
    store(reinterpret_cast<std::byte*>(&record), part.place, offset);
    return true;
  });
  return sections;
}

Status check_reach(const EffectsView& effects, const GridRecord& grid) {
  for (const Light& light : effects.lights) {
    if (!light_is_in_reach(light_record(light, grid), grid)) return Status::kBadEffects;
  }
  const bool occlusion_ok = effects.occlusion_samples == 0 || radius_is_in_reach(effects.occlusion_radius, grid);
  return occlusion_ok ? Status::kOk : Status::kBadEffects;
}

void write_effect_sections(const MeshView& mesh, const EffectsView& effects, const GridRecord& grid,
                           const EffectSections& sections, std::byte* image) {
  const EffectsRecord& record = sections.record;
  for (std::uint32_t i = 0; i < sections.section_count; ++i) {
    const SectionEntry& entry = sections.entries[i];
    const std::uint64_t used = entry.element_bytes * entry.element_count;
    __builtin_memset(image + entry.offset_bytes + used, 0, static_cast<std::size_t>(entry.section_bytes - used));
  }
  store(image, sections.begin_bytes, record);
  std::uint64_t at = record.materials_offset_bytes;
  for (const Material& material : effects.materials) {
    store(image, at, scaled_material(material));
    at += sizeof(MaterialRecord);
  }
  at = record.lights_offset_bytes;
  for (const Light& light : effects.lights) {
    store(image, at, light_record(light, grid));
    at += sizeof(LightRecord);
  }
  write_surfaces(mesh, effects, grid, record, image);
  if (record.environment_width != 0) write_environment(effects, record.environment_offset_bytes, image);
}

}  // namespace gridiron
