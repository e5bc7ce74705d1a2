// Info plan. SPDX-License-Identifier: Apache-2.0
#include "info_plan.h"

#include <gridiron/base/triangle_formats.h>

#include <string>

#include "base/failure.h"
#include "base/words.h"
#include "gridiron/device/accuracies.h"

namespace gridiron::tool {
namespace {

using sim::StoreSize;

TriangleFormat triangle_format_of(const InfoRequest& request) {
  if (!request.accuracy) return request.format.value_or(TriangleFormat::kVertices);
  const TriangleFormat format = format_of(*request.accuracy);
  if (request.format.value_or(format) != format) {
    usage_error("--accuracy " + std::string(accuracy_name(*request.accuracy)) + ": reads --format " + word_of(format));
  }
  return format;
}

// The described layout, built or not.
sim::LayoutChoice layout_of(const InfoRequest& request, const Configuration& configuration, StoreSize store,
                            bool has_effects) {
  if (has_effects && store != StoreSize::k64KB) store = StoreSize::k256KB;
  return layout_with(request.layout, configuration, store, has_effects);
}

// The named configuration, or the one that a frame would have in Mode::kChecked.
const Configuration& configuration_of(const InfoRequest& request, const KnownScene& scene, const InfoPlan& plan) {
  if (request.scene.configuration != nullptr) return *request.scene.configuration;
  const sim::MachineProfile& machine = *request.scene.machine;
  const auto is_built = [](const sim::LayoutChoice& layout) { return find_store_facts(layout).has_value(); };
  return default_configuration(
      {.has_projection = plan.format == TriangleFormat::kProjection || scene.has_projection,
       .has_tree = scene.has_tree,
       .has_kernel = has_best_kernel(machine, request.layout.store, scene.has_effects, is_built),
       .has_prices = !sim::counts_instructions(machine)});
}

StoreFacts require_layout(const InfoRequest& request, const Configuration& configuration,
                          const sim::LayoutChoice& layout) {
  const std::optional<StoreFacts> facts = find_store_facts(layout);
  require_built(layout, configuration, facts.has_value());
  require_distances(layout, request.has_depth);
  return *facts;
}

// A view's tiles have bounds, in cycles.
void require_bound(const InfoPlan& plan) {
  const auto accuracy =
      plan.accuracy.value_or(plan.format == TriangleFormat::kLattice ? Accuracy::kCompact : Accuracy::kStandard);
  require_view_bound("--camera", plan.local_store.engine, plan.layout, accuracy, plan.has_depth);
  const sim::MachineProfile& machine = *plan.scene.machine;
  if (sim::counts_instructions(machine)) {
    usage_error("--machine " + std::string(machine.name) + ": counts instructions; a bound for a view is in cycles");
  }
}

// The option that requires triangles of Accuracy::kPaper.
const char* projection_option(const InfoRequest& request) {
  if (request.accuracy == Accuracy::kPaper) return "--accuracy paper";
  return request.format == TriangleFormat::kProjection ? "--format projection" : nullptr;
}

}  // namespace

InfoPlan resolve(const InfoRequest& request, const KnownScene& scene) {
  InfoPlan plan{.scene = request.scene,
                .format = triangle_format_of(request),
                .accuracy = request.accuracy,
                .has_depth = request.has_depth,
                .shading = request.shading,
                .size = request.size.value_or(scene.size.value_or(kUsualPictureSize)),
                .json = request.json};
  // A packed scene uses the store that a mesh would get.
  const bool is_text = scene.kind == SceneKind::kText;
  if (is_text) require_effects_of(request.accuracy);
  const Configuration& configuration = configuration_of(request, scene, plan);
  plan.scene.configuration = &configuration;
  const GridOption grid_options[] = {{"--packet", request.layout.packet_width.has_value()},
                                     {"--lambda", request.scene.lambda.has_value()},
                                     {"--macro-width", request.scene.macro_width.has_value()}};
  require_grid_for(configuration, grid_options, projection_option(request));
  plan.store = choose_store(*request.scene.machine, request.layout.store, [&](StoreSize store) {
    return find_store_facts(layout_of(request, configuration, store, is_text)).has_value();
  });
  (void)require_layout(request, configuration, layout_of(request, configuration, plan.store, is_text));
  plan.layout = layout_of(request, configuration, plan.store, scene.has_effects);
  plan.local_store = require_layout(request, configuration, plan.layout);
  plan.depths = configuration.depths.within(plan.local_store.most_depths);
  if (request.camera) require_bound(plan);
  if (is_text && plan.store == StoreSize::k64KB) plan.most_macro_width = plan.local_store.max_macro_width;
  return plan;
}

}  // namespace gridiron::tool
