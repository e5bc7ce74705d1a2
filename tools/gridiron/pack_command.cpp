// pack: a mesh becomes a scene image. SPDX-License-Identifier: Apache-2.0
#include <gridiron/build/tree/tree_builder.h>
#include <gridiron/sim/host_team.h>

#include <cstdio>
#include <thread>

#include "base/failure.h"
#include "base/progress.h"
#include "base/words.h"
#include "commands.h"
#include "files/atomic_file.h"
#include "files/command_files.h"
#include "gridiron/device/layout_choice.h"
#include "gridiron/device/store_facts.h"
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
  const SceneInput input = read_scene_input(request.scene.input, request.scene.tolerance, PictureRequest{},
                                            kExpectedScene, request.scene.model);
  const Mesh* mesh = std::get_if<Mesh>(&input.content);
  if (mesh == nullptr) {
    input_error(input.path, std::string("is a scene image already; ") + kExpectedScene);
  }

  const SceneRequest scene = completed(request, known_scene(input));
  if (!scene.quiet) tell_notes(input);

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
}

}  // namespace gridiron::tool
