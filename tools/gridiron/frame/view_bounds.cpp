// Bounds of a view. SPDX-License-Identifier: Apache-2.0
#include "view_bounds.h"

#include <gridiron/engine/tree/tile_projection.h>
#include <gridiron/frame/frame_setup.h>

#include <algorithm>
#include <cmath>

#include "gridiron/scene/scene_points.h"

namespace gridiron::tool {
namespace {

float largest_of(const Mesh& mesh) {
  float largest = 0.0f;
  for (const Vec3& vertex : mesh.vertices) {
    for (int axis = 0; axis < 3; ++axis) largest = std::max(largest, std::abs(vertex[axis]));
  }
  return largest;
}

float largest_of(const TreeRecord& tree) {
  float largest = 0.0f;
  for (int axis = 0; axis < 3; ++axis) {
    largest = std::max({largest, std::abs(tree.bounds_minimum[axis]), std::abs(tree.bounds_maximum[axis])});
  }
  return largest;
}

bool has_bounds(const FrameHead& frame, float largest, const RenderPlan& plan) {
  const EyeProjection eye = project_eye(frame, largest);
  return plan.layout.store <= sim::StoreSize::k64KB ? eye.is_trusted : eye.has_bounds;
}

}  // namespace

bool has_bounds(const FrameHead& frame, const TreeRecord& tree, const RenderPlan& plan) {
  return has_bounds(frame, largest_of(tree), plan);
}

std::optional<std::size_t> find_view_without_bounds(const SceneInput& input, const RenderPlan& plan,
                                                    std::span<const ViewRequest> views) {
  const PackedScene* const packed = std::get_if<PackedScene>(&input.content);
  const Mesh* const mesh = std::get_if<Mesh>(&input.content);
  const float largest = packed != nullptr ? largest_of(packed->view.tree) : largest_of(*mesh);
  const PointSource points = [&](const PointVisitor& visitor) {
    if (packed != nullptr) {
      visit_points(packed->view, packed->file.bytes, visitor);
    } else {
      visit_points(mesh->view(), visitor);
    }
  };
  bool has_points = false;
  points([&](const auto&) { has_points = true; });
  if (!has_points) return std::nullopt;
  FrameSettings settings;
  settings.width = plan.width;
  settings.height = plan.height;
  settings.tile_width = plan.layout.tile_width;
  settings.color = MainAddress{kLineBytes};
  for (std::size_t i = 0; i < views.size(); ++i) {
    settings.camera = complete_view(views[i], static_cast<double>(plan.width) / plan.height, points);
    FrameHead frame{};
    if (make_frame_head(settings, frame) == Status::kOk && !has_bounds(frame, largest, plan)) return i;
  }
  return std::nullopt;
}

}  // namespace gridiron::tool
