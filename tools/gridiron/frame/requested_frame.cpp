// Requested frame. SPDX-License-Identifier: Apache-2.0
#include "requested_frame.h"

#include <cstdio>
#include <string>
#include <utility>

#include "base/words.h"
#include "gridiron/device/store_facts.h"
#include "gridiron/scene/hither.h"
#include "gridiron/scene/scene_points.h"
#include "view_bounds.h"

namespace gridiron::tool {
namespace {

// Notes that a named configuration is reduced to the store's buffers.
void tell_fewer_buffers(const RenderRequest& request, const RenderPlan& plan) {
  if (request.scene.configuration == nullptr) return;
  const BufferDepths wanted = request.layout.depths.value_or(request.scene.configuration->depths);
  const auto facts = find_store_facts(plan.layout);
  if (plan.depths == wanted || (facts && facts->packet_width == 0)) return;  // without packets the grid is not used
  const auto blocks = [](const BufferDepths& depths) {
    return words_of_count(depths.macro, "cell block") + " and " + words_of_count(depths.triangle, "triangle buffer");
  };
  std::fprintf(stderr, "%s: configuration %s has %s; a local store of %u KB holds %s for it\n",
               request.scene.input.c_str(), std::string(request.scene.configuration->name).c_str(),
               blocks(wanted).c_str(), sim::arena_bytes(plan.layout.store) >> 10, blocks(plan.depths).c_str());
}

// Another viewpoint does not use the scene's near plane.
void check_scene_view(const RenderRequest& request, const RequestedFrame& frame) {
  const SceneInput& input = frame.input;
  const RenderPlan& plan = frame.plan;
  if (!input.text || !input.text->view.is_given() || request.camera || request.view.eye || frame.view.from) return;
  const PointSource no_points = [](const PointVisitor&) {};  // nothing is left to be framed
  const double aspect = static_cast<double>(plan.width) / plan.height;
  check_hither(input, complete_view(frame.view, aspect, no_points), plan.width, plan.height);
}

}  // namespace

void give_look(const LookRequest& look, SceneInput& input, double aspect, const LookBounds* bounds, ViewRequest& view) {
  check_look(look, known_scene(input).kind);
  const PointSource points = [&input](const PointVisitor& visitor) {
    visit_points(std::get<Mesh>(input.content).view(), visitor);
  };
  require_renderable(input);
  view = look_view(look, view);
  const Camera camera = complete_view(view, aspect, points);
  const Vec3 up = view.up.value_or(kUsualUp);
  apply_look(input, look, camera, bounds != nullptr ? *bounds : look_bounds_of(points, up));
  view.eye = camera.eye;
  view.at = camera.at;
  view.up = camera.up;
  view.from.reset();
}

void take_grid_without_bounds(const RenderRequest& request, RequestedFrame& frame, std::span<const ViewRequest> views) {
  if (request.scene.configuration != nullptr || frame.plan.engine != EngineId::kTree) return;
  const PackedScene* const packed = std::get_if<PackedScene>(&frame.input.content);
  if (packed != nullptr && !packed->view.has_grid) return;
  if (!find_view_without_bounds(frame.input, frame.plan, views)) return;
  KnownScene known = known_scene(frame.input);
  known.has_bounds = false;
  frame.plan = resolve(request, known, this_host());
  if (request.scene.quiet) return;
  std::fprintf(stderr,
               "%s: pixels too small or a scene too large or small for the bounds of configuration best; rendered by "
               "grid\n",
               request.scene.input.c_str());
}

void tell_frame_notes(const RenderRequest& request, const RequestedFrame& frame) {
  if (request.scene.quiet) return;
  tell_notes(frame.input);
  tell_fewer_buffers(request, frame.plan);
}

RequestedFrame complete_frame(const RenderRequest& request, SceneInput input, const std::optional<ViewRequest>& camera,
                              const LookBounds* bounds) {
  RequestedFrame frame;
  frame.input = std::move(input);
  const PictureRequest picture =
      complete_request({request.view, camera, request.size}, frame.input.text ? frame.input.text->view : SceneView{});
  frame.view = join_view(picture.view, *picture.camera);
  if (request.scene.look.is_given()) {
    give_look(request.scene.look, frame.input, static_cast<double>(picture.size->x) / picture.size->y, bounds,
              frame.view);
  }
  frame.plan = resolve(request, known_scene(frame.input), this_host());
  check_scene_view(request, frame);
  take_grid_without_bounds(request, frame, std::span(&frame.view, 1));
  return frame;
}

RequestedFrame read_requested_frame(const RenderRequest& request, const std::vector<Output>& outputs) {
  const KnownScene foreseen = foreseen_scene(request.scene);
  if (foreseen.kind != SceneKind::kUnknown) (void)resolve(request, foreseen, this_host());
  declare_outputs(outputs);
  PictureRequest picture{request.view, std::nullopt, request.size};
  if (request.camera) picture.camera = read_camera_file(*request.camera);
  RequestedFrame frame = complete_frame(
      request,
      read_scene_input(request.scene.input, request.scene.tolerance, picture, kSceneExpected, request.scene.model),
      picture.camera);
  tell_frame_notes(request, frame);
  return frame;
}

}  // namespace gridiron::tool
