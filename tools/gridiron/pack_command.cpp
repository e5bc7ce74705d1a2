// pack: a mesh becomes a scene image. SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <new>

#include "base/failure.h"
#include "base/progress.h"
#include "base/words.h"
#include "commands.h"
#include "files/atomic_file.h"
#include "files/command_files.h"
#include "gridiron/scene/scene_input.h"

namespace gridiron::tool {
namespace {

constexpr const char* kExpected = "pack takes a PLY mesh or a text scene (NFF)";

}  // namespace

void run_command(const PackArguments& arguments) {
  declare_outputs({{"-o", arguments.output, OutputKind::kBinary}});
  const StageLines stages(!arguments.scene.quiet);
  const SceneInput input =
      read_scene_input(arguments.scene.input, arguments.scene.tolerance, PictureRequest{}, kExpected);
  const Mesh* mesh = std::get_if<Mesh>(&input.content);
  if (mesh == nullptr) {
    throw Failure(ExitCode::kBadInput, input.path.string() + ": is a scene image already; " + kExpected);
  }

  if (!arguments.scene.quiet) tell_notes(input);

  // The budget of an ordinary picture, so that render would choose the same grid.
  const sim::MachineProfile& machine = *arguments.scene.machine;
  constexpr std::uint32_t kUsualTileWidth = 32;
  const std::uint32_t depth = input.text ? input.text->effects.recursion_depth : 1;
  const std::uint64_t budget_bytes =
      image_budget_bytes(machine, 1, 1, 1, kUsualTileWidth, spill_bytes_of(machine.core_count, depth));
  const EffectsView view = input.text ? input.text->effects.view() : EffectsView{};
  const EffectsView* effects = input.text ? &view : nullptr;
  const GridChoice choice = choose_grid(input, *mesh, arguments.scene, arguments.format, budget_bytes, effects);
  require_fit(choice, arguments.scene, input);

  const AlignedBytes storage =
      name_in_shortage(input.path, "build its scene image", [&] { return allocate_aligned(choice.need.image_bytes); });
  const std::span<std::byte> image(storage.get(), choice.need.image_bytes);
  (void)build_image(input, *mesh, choice, image, effects);

  AtomicFiles files;
  files.add(arguments.output, image);
  files.commit_at_end();
  if (arguments.scene.quiet) return;
  std::string triangles = words_of_count(mesh->triangles.size()) + " triangles";
  if (choice.need.dropped_triangle_count != 0) {
    triangles += " (" + words_of_count(choice.need.dropped_triangle_count) + " of zero area dropped)";
  }
  std::printf("%s: %s, %s, %s references, lambda %g\n", target_of(arguments.output).name.c_str(),
              words_of_bytes(image.size()).c_str(), triangles.c_str(),
              words_of_count(choice.need.grid.reference_count).c_str(), static_cast<double>(choice.parameters.lambda));
}

}  // namespace gridiron::tool
