// pack: a mesh becomes a scene image. SPDX-License-Identifier: Apache-2.0
#include <cstdio>

#include "base/failure.h"
#include "base/progress.h"
#include "base/words.h"
#include "commands.h"
#include "files/atomic_file.h"
#include "files/command_files.h"
#include "gridiron/scene/image_structures.h"
#include "gridiron/scene/scene_input.h"

namespace gridiron::tool {
namespace {

constexpr const char* kExpected = "pack takes a PLY mesh or a text scene (NFF)";

}  // namespace

void run_command(const PackRequest& request) {
  (void)foreseen_scene(request.scene);
  declare_outputs({{"-o", request.output, OutputKind::kBinary}});
  const StageLines stages(!request.scene.quiet);
  const SceneInput input = read_scene_input(request.scene.input, request.scene.tolerance, PictureRequest{}, kExpected);
  const Mesh* mesh = std::get_if<Mesh>(&input.content);
  if (mesh == nullptr) {
    input_error(input.path, std::string("is a scene image already; ") + kExpected);
  }

  if (!request.scene.quiet) tell_notes(input);

  // The budget for an ordinary picture, so that render chooses the same grid.
  const sim::MachineProfile& machine = *request.scene.machine;
  constexpr std::uint32_t kUsualTileWidth = 32;
  const std::uint64_t spill_bytes = spill_bytes_of(machine.core_count, recursion_depth(input));
  const ImageLimits limits = {.format = request.format,
                              .budget_bytes = image_budget_bytes(machine, 1, 1, 1, kUsualTileWidth, spill_bytes),
                              .engine = engine_of(*request.scene.configuration)};
  const EffectsView of_text = input.text ? input.text->effects.view() : EffectsView{};
  const EffectsView* effects = input.text ? &of_text : nullptr;
  const GridChoice choice = choose_grid(input, *mesh, request.scene, limits, effects);
  require_fit(choice, request.scene, input);

  const AlignedBytes storage =
      name_in_shortage(input.path, "build its scene image", [&] { return allocate_aligned(choice.need.image_bytes); });
  const std::span<std::byte> memory(storage.get(), choice.need.image_bytes);
  const SceneImageView built = build_image(input, *mesh, choice, memory, effects);
  const std::span<std::byte> image = memory.first(built.header.image_bytes);

  AtomicFiles files;
  files.add(request.output, image);
  files.commit_at_end();
  if (request.scene.quiet) return;
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
