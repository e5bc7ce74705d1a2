// Scene facts: the values that `info` prints about a scene.
// Memory: plain values. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/effect_records.h>
#include <gridiron/base/records.h>
#include <gridiron/base/tree_records.h>

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "gridiron/scene/image_structures.h"
#include "gridiron/scene/scene_input.h"
#include "info_plan.h"
#include "scene_text/scene_description.h"
#include "worst_of_view.h"
#include "worst_tile.h"

namespace gridiron::tool {

/// The most iterations of the kernel's loops for this scene; the input of a worst-case analysis.
struct LoopBounds {
  std::uint32_t passes_per_packet = 0;      ///< three axes, two directions: of one round
  std::uint32_t macro_slices_per_pass = 0;  ///< macrocells along the longest axis
  std::uint64_t macro_cells_per_pass = 0;
  std::uint32_t slices_per_pass = 0;  ///< cells along the longest axis
  std::uint64_t cells_per_pass = 0;
  std::uint64_t triangle_tests_per_pass = 0;  ///< references
};

/// A section of a scene image for effects.
struct EffectSectionFact {
  std::string_view name;    ///< "materials"
  std::uint64_t bytes = 0;  ///< in main memory
};

/// The effects that a scene calls for; all empty without any.
struct EffectFacts {
  bool has_effects = false;
  EffectsRecord record{};  ///< without its offsets
  std::vector<EffectSectionFact> sections;
  std::uint64_t section_bytes = 0;         ///< of all of them
  std::uint64_t spill_bytes_per_core = 0;  ///< for rays that wait

  [[nodiscard]] std::uint64_t bytes_of(std::string_view section) const;
};

struct SceneFacts {
  std::uint64_t vertices = 0, triangles = 0, dropped_triangles = 0;
  bool has_grid = false;
  GridRecord grid{};  ///< as SceneImageView's
  float wanted_lambda = 0;
  SceneRoundness roundness;  ///< of a text scene
  bool is_packed = false;
  TreeRecord tree{};                ///< of an image that was built or packed; all zero if it has none
  StructureBytes structures;        ///< of an image that was built or packed
  std::uint64_t image_bytes = 0;    ///< of the image, or what building it needs where it does not fit
  std::uint64_t scratch_bytes = 0;  ///< of the builder, free again afterwards; 0 for a packed scene
  std::uint64_t picture_bytes = 0;  ///< requested planes and frame record
  bool fits = false;                ///< in the machine's main memory
  LoopBounds bounds;                ///< with a grid
  EffectFacts effects;
  std::optional<WorstTile> worst;            ///< where the image fits, of eye rays through the grid
  std::optional<WorstOfView> worst_of_view;  ///< where it fits and a view is given, of eye rays through the tree
};

/// Counts the scene; builds an image that fits, to count its contents too. Errors: Failure.
///
/// @param view  whose tiles are bounded; nothing: none are.
[[nodiscard]] SceneFacts collect_scene_facts(const InfoPlan& plan, const SceneInput& input,
                                             const std::optional<ViewRequest>& view);

}  // namespace gridiron::tool
