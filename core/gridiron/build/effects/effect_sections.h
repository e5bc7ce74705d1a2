// The sections of a scene image that hold effects: their number, places and contents.
// Source: own; core/SPEC.md. Memory: caller's. Threads: one. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/effect_records.h>
#include <gridiron/base/records.h>
#include <gridiron/platform/status.h>
#include <gridiron/scene/effects.h>
#include <gridiron/scene/mesh.h>

#include <cstddef>
#include <cstdint>

namespace gridiron {

inline constexpr std::uint32_t kMaxEffectSections = 6;

/// The sections of effects of one image. Without effects section_count is 0 and begin_bytes = end_bytes.
struct EffectSections {
  EffectsRecord record;                      ///< complete, as it will stand in the image
  SectionEntry entries[kMaxEffectSections];  ///< in the order in which they lie, without gaps
  std::uint32_t section_count;
  std::uint64_t begin_bytes, end_bytes;  ///< multiples of kLineBytes, from the image's first byte
};

/// @returns the record that the scene needs, complete but for its offsets.
/// Precondition: check_effects returns kOk. Cost: linear in triangles.
[[nodiscard]] EffectsRecord count_effects(const EffectsView& effects);

/// @returns how many sections there will be.
[[nodiscard]] std::uint32_t effect_section_count(const EffectsRecord& counted);

/// Places the sections from begin_bytes, a multiple of kLineBytes. @param counted  from count_effects.
[[nodiscard]] EffectSections place_effect_sections(const EffectsRecord& counted, std::uint32_t triangle_count,
                                                   std::uint64_t begin_bytes);

/// Whether every light, and the radius of ambient occlusion, is within the ranges of traversal in this grid.
/// Errors: kBadEffects.
[[nodiscard]] Status check_reach(const EffectsView& effects, const GridRecord& grid);

/// Writes [begin_bytes, end_bytes) of the image. With lattice triangles the surfaces' vertices are moved like those of
/// the triangles, and have no place in the tree yet (link_surfaces). Precondition: mesh and effects are those that were
/// counted. Cost: linear.
void write_effect_sections(const MeshView& mesh, const EffectsView& effects, const GridRecord& grid,
                           const EffectSections& sections, std::byte* image);

}  // namespace gridiron
