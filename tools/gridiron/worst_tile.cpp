// Worst tile. SPDX-License-Identifier: Apache-2.0
#include "worst_tile.h"

#include <gridiron/base/accuracies.h>
#include <gridiron/sim/compiled_layouts.h>

#include <algorithm>

#include "layout_choice.h"

namespace gridiron::tool {
namespace {

// The first that an image is for: `standard` where there are several.
Accuracy accuracy_of(const GridRecord& grid) {
  for (std::uint32_t number = 0; number < kAccuracyCount; ++number) {
    if (grid.triangle_format == static_cast<std::uint32_t>(accuracy_traits(number).format)) return Accuracy{number};
  }
  return Accuracy::kStandard;
}

}  // namespace

StoreFacts info_store_facts(const InfoArguments& arguments, bool has_effects) {
  return *find_store_facts(info_layout(arguments, has_effects));
}

WorstTile find_worst_tile(const InfoArguments& arguments, std::span<const std::byte> image,
                          const SceneImageView& view) {
  const Configuration& configuration = *arguments.scene.configuration;
  const bool has_effects = view.has_effects && view.effects.called_for != 0;
  const StoreFacts store = info_store_facts(arguments, has_effects);
  WorstTile worst;
  const auto take = [&]<class Layout>() { worst.layout = tile_layout_of<Layout>(4); };
  const sim::LayoutChoice choice = info_layout(arguments, has_effects);
  has_effects ? sim::visit_layout(sim::EffectLayouts{}, choice, take)
              : sim::visit_layout(sim::CommonLayouts{}, choice, take) ||
                    sim::visit_layout(sim::SweepLayouts{}, choice, take);
  worst.frame.accuracy = arguments.accuracy.value_or(accuracy_of(view.grid));
  worst.frame.shading = has_effects ? Shading::kScene : Shading::kSimple;
  worst.frame.techniques = configuration.techniques;
  worst.frame.output_depth = std::min(configuration.depths.output, store.max_output_depth);
  worst.frame.macro_depth = std::min(configuration.depths.macro, store.max_macro_depth);
  worst.frame.triangle_depth = std::min(configuration.depths.triangle, store.max_triangle_depth);
  worst.frame.walk_depth = std::min(configuration.depths.walks, store.max_walks);
  worst.frame.has_depth = arguments.has_depth;
  worst.frame.queue_depth = arguments.scene.machine->queue_depth;
  worst.scene = count_tile_scene(image, view, worst.layout);
  worst.bound = worst_tile(worst.scene, worst.layout, worst.frame);
  worst.cycles = sim::worst_tile_cycles(worst.bound, *arguments.scene.machine, worst.frame.output_depth);
  const sim::MachineProfile* const counted = sim::find_machine_profile("fu540");
  worst.are_instructions = arguments.scene.machine->work_cycles == counted->work_cycles;
  return worst;
}

}  // namespace gridiron::tool
