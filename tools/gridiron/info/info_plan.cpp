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
sim::LayoutChoice layout_of(const InfoRequest& request, StoreSize store, bool has_effects) {
  if (has_effects && store != StoreSize::k64KB) store = StoreSize::k256KB;
  return layout_with(request.layout, *request.scene.configuration, store, has_effects);
}

StoreFacts require_layout(const InfoRequest& request, const sim::LayoutChoice& layout) {
  const std::optional<StoreFacts> facts = find_store_facts(layout);
  require_built(layout, facts.has_value());
  require_distances(layout, request.has_depth);
  return *facts;
}

}  // namespace

InfoPlan resolve(const InfoRequest& request, const KnownScene& scene) {
  InfoPlan plan{.scene = request.scene,
                .format = triangle_format_of(request),
                .accuracy = request.accuracy,
                .has_depth = request.has_depth,
                .size = request.size.value_or(scene.size.value_or(kUsualPictureSize)),
                .json = request.json};
  // A packed scene uses the store that a mesh would get.
  const bool is_text = scene.kind == SceneKind::kText;
  if (is_text) require_effects_of(request.accuracy);
  plan.store = choose_store(*request.scene.machine, request.layout.store, [&](StoreSize store) {
    return find_store_facts(layout_of(request, store, is_text)).has_value();
  });
  (void)require_layout(request, layout_of(request, plan.store, is_text));
  plan.layout = layout_of(request, plan.store, scene.has_effects);
  plan.local_store = require_layout(request, plan.layout);
  plan.depths = request.scene.configuration->depths.within(plan.local_store.most_depths);
  if (is_text && plan.store == StoreSize::k64KB) plan.most_macro_width = plan.local_store.max_macro_width;
  return plan;
}

}  // namespace gridiron::tool
