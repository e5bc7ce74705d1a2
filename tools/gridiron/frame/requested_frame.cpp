// Requested frame. SPDX-License-Identifier: Apache-2.0
#include "requested_frame.h"

#include <cstdio>
#include <string>

#include "base/words.h"
#include "chip_frame.h"
#include "gridiron/device/layout_choice.h"
#include "gridiron/scene/hither.h"

namespace gridiron::tool {
namespace {

// A named configuration that the store has too few buffers for is used with those that there are.
void tell_fewer_buffers(const RenderArguments& arguments) {
  if (arguments.depths == arguments.wanted_depths) return;
  const auto blocks = [](const BufferDepths& depths) {
    return words_of_count(depths.macro, "cell block") + " and " + words_of_count(depths.triangle, "triangle buffer");
  };
  std::fprintf(stderr, "%s: configuration %s has %s; a local store of %u KB holds %s for it\n",
               arguments.scene.input.c_str(), std::string(arguments.scene.configuration->name).c_str(),
               blocks(arguments.wanted_depths).c_str(), sim::arena_bytes(arguments.store) >> 10,
               blocks(arguments.depths).c_str());
}

// What the command line left to the scene and the host.
RenderArguments complete_arguments(const RenderArguments& asked, const PictureRequest& picture,
                                   const SceneInput& input) {
  RenderArguments arguments = asked;
  arguments.width = picture.width;
  arguments.height = picture.height;
  if (arguments.threads == 0) arguments.threads = host_threads();
  const PackedScene* packed = std::get_if<PackedScene>(&input.content);
  const bool has_effects = input.text || (packed != nullptr && packed->view.has_effects);
  if (!arguments.has_shading && has_effects) arguments.shading = Shading::kScene;
  settle_layout(arguments);
  return arguments;
}

// Another place to look from has no use for the scene's near plane.
void check_scene_view(const RenderArguments& arguments, const SceneInput& input, const ViewRequest& view) {
  if (!input.text || !input.text->view.is_given() || arguments.camera || arguments.view.eye || view.from) return;
  const PointSource no_points = [](const PointVisitor&) {};  // nothing is left to be framed
  const double aspect = static_cast<double>(arguments.width) / arguments.height;
  check_hither(input, complete_view(view, aspect, no_points), arguments.width, arguments.height);
}

}  // namespace

RequestedFrame read_requested_frame(const RenderArguments& asked, const std::vector<Output>& outputs) {
  declare_outputs(outputs);
  PictureRequest picture{asked.view, std::nullopt, asked.has_size, asked.width, asked.height};
  if (asked.camera) picture.camera = read_camera_file(*asked.camera);
  RequestedFrame request;
  request.input = read_scene_input(asked.scene.input, asked.scene.tolerance, picture);
  const SceneInput& input = request.input;
  picture = complete_request(picture, input.text ? input.text->view : SceneView{});
  request.arguments = complete_arguments(asked, picture, input);
  const RenderArguments& arguments = request.arguments;
  request.view = join_view(picture.view, *picture.camera);
  check_scene_view(arguments, input, request.view);
  if (!arguments.quiet) {
    tell_notes(input);
    tell_fewer_buffers(arguments);
  }
  return request;
}

}  // namespace gridiron::tool
