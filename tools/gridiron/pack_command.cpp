// pack: a mesh becomes a scene image. SPDX-License-Identifier: Apache-2.0
#include <gridiron/build/tree/tree_builder.h>
#include <gridiron/sim/host_team.h>

#include <cstdio>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "base/failure.h"
#include "base/numbers.h"
#include "base/progress.h"
#include "base/words.h"
#include "commands.h"
#include "files/atomic_file.h"
#include "files/command_files.h"
#include "gridiron/device/layout_choice.h"
#include "gridiron/device/store_facts.h"
#include "gridiron/frame/requested_frame.h"
#include "gridiron/scene/image_structures.h"
#include "gridiron/scene/scene_input.h"

namespace gridiron::tool {
namespace {

constexpr const char* kExpectedScene = "pack takes a mesh (PLY, OBJ, STL, glTF) or a text scene (NFF)";

// The scene with the named configuration, or with the default one for its triangles.
SceneRequest completed(const PackRequest& request, const KnownScene& known) {
  const bool has_projection = request.format == TriangleFormat::kProjection;
  SceneRequest scene = request.scene;
  const sim::MachineProfile& machine = *scene.machine;
  const auto is_built = [](const sim::LayoutChoice& layout) { return find_store_facts(layout).has_value(); };
  if (scene.configuration == nullptr) {
    scene.configuration =
        &default_configuration({.has_projection = has_projection,
                                .has_kernel = has_best_kernel(machine, std::nullopt, known.has_effects, is_built),
                                .has_prices = !sim::counts_instructions(machine)});
  }
  const GridOption grid_options[] = {{"--lambda", scene.lambda.has_value()},
                                     {"--macro-width", scene.macro_width.has_value()}};
  require_grid_for(*scene.configuration, grid_options, has_projection ? "--format projection" : nullptr);
  return scene;
}

// Puts the scene into its look. @returns the view that the look is made for; nothing without a look.
std::optional<ViewRequest> give_look(const PackRequest& request, PictureRequest picture, SceneInput& input) {
  if (!request.scene.look.is_given()) return std::nullopt;
  picture = complete_request(std::move(picture), input.text ? input.text->view : SceneView{});
  ViewRequest view = join_view(picture.view, *picture.camera);
  give_look(request.scene.look, input, static_cast<double>(picture.size->x) / picture.size->y, nullptr, view);
  return view;
}

// "--eye 1,2,3 --at 0,0,0 --up 0,1,0 --fov 30"
std::string options_of(const ViewRequest& view) {
  const auto words = [](const Vec3& v) {
    return shortest_text(v.x) + "," + shortest_text(v.y) + "," + shortest_text(v.z);
  };
  return "--eye " + words(*view.eye) + " --at " + words(*view.at) + " --up " + words(*view.up) + " --fov " +
         shortest_text(view.fov_degrees.value_or(kDefaultFovDegrees));
}

// An image without effects holds triangles alone.
void tell_surface(const std::filesystem::path& file, const MeshSurface& surface) {
  std::vector<std::string> lost;
  if (!surface.materials.empty()) lost.push_back(words_of_count(surface.materials.size(), "material"));
  if (!surface.triangle_normals.empty()) lost.emplace_back("normals");
  if (!surface.triangle_colors.empty()) lost.emplace_back("colours");
  if (lost.empty()) return;
  std::fprintf(stderr, "%s: not packed: %s; --look studio or a part of it packs them\n", file.c_str(),
               words_of_list(lost).c_str());
}

// Of a frame of the usual layout in the machine's largest store.
StoreFacts store_of(const sim::MachineProfile& machine, const Configuration& configuration, const SceneInput& input) {
  const sim::StoreSize store = largest_store(machine);
  return input.effects ? effect_store_facts(store, configuration.packet_width)
                       : usual_store_facts(store, configuration.packet_width);
}

}  // namespace

void run_command(const PackRequest& request) {
  (void)completed(request, foreseen_scene(request.scene));
  declare_outputs({{"-o", request.output, OutputKind::kBinary}});
  const StageLines stages(!request.scene.quiet);
  PictureRequest picture{request.view, std::nullopt, std::nullopt};
  if (request.camera) picture.camera = read_camera_file(*request.camera);
  SceneInput input =
      read_scene_input(request.scene.input, request.scene.tolerance, picture, kExpectedScene, request.scene.model);
  const Mesh* mesh = std::get_if<Mesh>(&input.content);
  if (mesh == nullptr) {
    input_error(input.path, std::string("is a scene image already; ") + kExpectedScene);
  }

  const std::optional<ViewRequest> view = give_look(request, std::move(picture), input);
  if (input.effects && request.format == TriangleFormat::kProjection) {
    throw Failure(ExitCode::kUsage,
                  "--format projection is for a mesh alone; lights and materials need triangles as vertices");
  }
  const SceneRequest scene = completed(request, known_scene(input));
  if (!scene.quiet) {
    tell_notes(input);
    if (!input.effects) tell_surface(input.path, mesh->surface);
  }

  // The budget for an ordinary picture, so that render chooses the same grid.
  const sim::MachineProfile& machine = *scene.machine;
  constexpr std::uint32_t kUsualTileWidth = 32;
  const std::uint64_t spill_bytes = spill_bytes_of(machine.core_count, recursion_depth(input));
  const StoreFacts store = store_of(machine, *scene.configuration, input);
  const ImageLimits limits = {.format = request.format,
                              .budget_bytes = image_budget_bytes(machine, 1, 1, 1, kUsualTileWidth, spill_bytes),
                              .engine = store.engine,
                              .leaf_triangles = store.leaf_triangles};
  const EffectsView of_text = input.effects ? input.effects->view() : EffectsView{};
  const EffectsView* effects = input.effects ? &of_text : nullptr;
  sim::HostTeam team(mesh->triangles.size() < kManyTreeTriangles ? 1 : std::thread::hardware_concurrency());
  const WorkSharing sharing = team.sharing();
  const GridChoice choice = choose_grid(input, *mesh, scene, limits, effects, sharing);
  require_fit(choice, scene, input);

  const AlignedBytes storage =
      name_in_shortage(input.path, "build its scene image", [&] { return allocate_aligned(choice.need.image_bytes); });
  const std::span<std::byte> memory(storage.get(), choice.need.image_bytes);
  const SceneImageView built = build_image(input, *mesh, choice, memory, effects, sharing);
  const std::span<std::byte> image = memory.first(built.header.image_bytes);

  AtomicFiles files;
  files.add(request.output, image);
  files.commit_at_end();
  if (scene.quiet) return;
  std::string triangles = words_of_count(mesh->triangles.size()) + " triangles";
  if (choice.need.dropped_triangle_count != 0) {
    triangles += " (" + words_of_count(choice.need.dropped_triangle_count) + " of zero area dropped)";
  }
  std::printf("%s: %s, %s", target_of(request.output).name.c_str(), words_of_bytes(image.size()).c_str(),
              triangles.c_str());
  if (built.has_grid) {
    std::printf(", %s references, lambda %g", words_of_count(built.grid.reference_count).c_str(),
                static_cast<double>(built.grid.lambda));
  }
  std::printf("\nholds: %s\n", words_of_structures(structures_of(built)).c_str());
  if (view) std::printf("seen as render shows its look: %s\n", options_of(*view).c_str());
}

}  // namespace gridiron::tool
