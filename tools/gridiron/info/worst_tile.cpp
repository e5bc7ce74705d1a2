// Worst tile. SPDX-License-Identifier: Apache-2.0
#include "worst_tile.h"

#include <gridiron/base/accuracies.h>
#include <gridiron/sim/compiled_layouts.h>

namespace gridiron::tool {
namespace {

// The first accuracy for an image's format: `standard` if there are several.
Accuracy accuracy_of(const GridRecord& grid) {
  for (std::uint32_t number = 0; number < kAccuracyCount; ++number) {
    if (grid.triangle_format == static_cast<std::uint32_t>(accuracy_traits(number).format)) return Accuracy{number};
  }
  return Accuracy::kStandard;
}

}  // namespace

WorstTile find_worst_tile(const InfoPlan& plan, std::span<const std::byte> image, const SceneImageView& view) {
  const bool has_effects = plan.layout.has_effects;
  WorstTile worst;
  const auto take = [&]<class Layout>() { worst.layout = tile_layout_of<Layout>(4); };
  has_effects ? sim::visit_layout(sim::EffectLayouts{}, plan.layout, take)
              : sim::visit_layout(sim::CommonLayouts{}, plan.layout, take) ||
                    sim::visit_layout(sim::SweepLayouts{}, plan.layout, take);
  worst.frame.accuracy = plan.accuracy.value_or(accuracy_of(view.grid));
  worst.frame.shading = has_effects ? Shading::kScene : Shading::kSimple;
  worst.frame.techniques = plan.scene.configuration->techniques;
  worst.frame.output_depth = plan.depths.output;
  worst.frame.macro_depth = plan.depths.macro;
  worst.frame.triangle_depth = plan.depths.triangle;
  worst.frame.fetch_depth = plan.depths.fetch;
  worst.frame.has_depth = plan.has_depth;
  worst.frame.queue_depth = plan.scene.machine->queue_depth;
  worst.scene = count_tile_scene(image, view, worst.layout);
  worst.bound = worst_tile(worst.scene, worst.layout, worst.frame);
  worst.cycles = sim::worst_tile_cycles(worst.bound, *plan.scene.machine, worst.frame.output_depth);
  worst.are_instructions = sim::counts_instructions(*plan.scene.machine);
  return worst;
}

}  // namespace gridiron::tool
