// Scene input: a PLY mesh, a text scene or a packed scene, distinguished by content, read and checked, and the grid
// that fits a machine.
// Memory: owns mesh or file. Threads: one. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/records.h>
#include <gridiron/build/grid/grid_builder.h>
#include <gridiron/build/work_sharing.h>
#include <gridiron/image/scene_image.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "base/stopwatch.h"
#include "files/file_kind.h"
#include "files/input_file.h"
#include "import/mesh.h"
#include "import/model_import.h"
#include "scene_request.h"
#include "scene_text/scene_description.h"
#include "scene_text/scene_effects.h"
#include "scene_text/scene_reader.h"
#include "view.h"

namespace gridiron::tool {

/// A scene image as read and validated.
struct PackedScene {
  InputFile file;
  SceneImageView view;
};

/// The parts of a text scene besides its triangles.
struct TextScene {
  SceneView view;
  std::vector<SceneNote> notes;
  std::uint64_t note_count = 0;
  SceneRoundness roundness;
};

struct SceneInput {
  std::filesystem::path path;
  std::variant<Mesh, PackedScene> content;
  HostSeconds load_seconds{};                ///< of reading and checking
  std::optional<SceneEffects> effects{};     ///< beside a Mesh: of a text scene, or of a look
  std::optional<TextScene> text{};           ///< beside a Mesh and its effects
  std::optional<ImportReport> model{};       ///< of a Mesh of no text scene
  std::uint64_t colorless_triangles = 0;     ///< whose colours a look has no material for
  std::vector<std::string> look_notes{};     ///< why a look may disappoint
  std::uint32_t ground_begin = kNoTriangle;  ///< triangles from here on are of a look's ground
};

inline constexpr const char* kSceneExpected =
    "expected a scene: a mesh (PLY, OBJ, STL, glTF), a text scene (NFF) or a packed scene (made by 'gridiron pack')";

/// A command's settings of a picture; the others come from a text scene with a view.
struct PictureRequest {
  ViewRequest view{};                   ///< parts that replace those of any other view
  std::optional<ViewRequest> camera{};  ///< replaces the scene's own view
  std::optional<CountPair> size{};      ///< in place of the scene's own
};

/// @returns the picture for a scene with the view `own`, or without one; `camera` and `size` are always set.
[[nodiscard]] PictureRequest complete_request(PictureRequest request, const SceneView& own);

/// @returns the kind of a scene before it is read: by the file's first bytes; by its ending if it cannot be opened, so
/// that the command line is still checked; kUnknown for a stream, which can be read only once.
[[nodiscard]] SceneKind foreseen_kind(const std::filesystem::path& path);

/// @returns what is known of a command's scene before it is read. Errors: Failure (kUsage) if it cannot use the
/// tolerance.
[[nodiscard]] KnownScene foreseen_scene(const SceneRequest& request);

/// @returns what is known of a scene once it is read.
[[nodiscard]] KnownScene known_scene(const SceneInput& input);

/// Throws Failure (kBadInput) if a mesh or text scene cannot be rendered at all.
void require_renderable(const SceneInput& input);

/// @returns the depth of recursion of a scene's rays, 1 without effects.
[[nodiscard]] std::uint32_t recursion_depth(const SceneInput& input);

/// Reads the scene. @param tolerance  of round shapes in a text scene; nothing: the reader's own, which uses `picture`,
/// completed by complete_request(), if given. @param expected  of the file, for messages.
/// Errors: Failure (kBadInput), `file:line: reason`, `file:byte N: reason`, or `file: ` with its kind and the expected
/// one; kUsage if a tolerance is given for another kind of scene, or `picture` has no camera. @param model_options  how
/// one is read with Assimp.
[[nodiscard]] SceneInput read_scene_input(const std::filesystem::path& path,
                                          std::optional<float> tolerance = std::nullopt,
                                          const std::optional<PictureRequest>& picture = std::nullopt,
                                          const char* expected = kSceneExpected,
                                          const ImportOptions& model_options = {});

/// @returns "glTF, 4 meshes, 2 materials, 5,120 triangles, normals; in metres, y up; read with Assimp 5.2.4".
/// @param triangles  nothing: not said.
[[nodiscard]] std::string words_of_model(const ImportReport& report, const Mesh& mesh,
                                         std::optional<std::uint64_t> triangles);

/// Prints notes of a text scene on standard error: `file:line: note: text`, one line each; and the tolerance that the
/// picture has chosen. Of a mesh: what a look leaves out, and, unless tells_model is false, what was read and ignored.
void tell_notes(const SceneInput& input, bool tells_model = true);

/// @returns the mesh of a PLY file. Errors as read_scene_input. @param path  what messages call the bytes.
[[nodiscard]] Mesh read_ply_mesh(const std::filesystem::path& path);
[[nodiscard]] Mesh read_ply_mesh(std::span<const std::byte> bytes, const std::filesystem::path& path);

/// @returns the lines of a PLY mesh that was read, which are no part of it: rows of the element "edge".
[[nodiscard]] std::uint64_t count_ply_lines(std::span<const std::byte> bytes);

/// Limits of a scene image.
struct ImageLimits {
  TriangleFormat format = TriangleFormat::kVertices;
  std::uint64_t budget_bytes = 0;                   ///< of main memory
  std::uint32_t most_macro_width = kMaxMacroWidth;  ///< of the local store; a configuration's width is limited to it
  EngineId engine = EngineId::kGrid;                ///< of eye rays: an image is built with what it reads
  std::uint32_t leaf_triangles = 8;                 ///< of a leaf of the tree, at most
};

/// The image that a mesh will get: its grid, or that it has none.
struct GridChoice {
  GridParameters parameters;
  GridNeed need;
  float wanted_lambda = 0;  ///< of the configuration or the command line; no matter without a grid
  std::uint64_t budget_bytes = 0;

  [[nodiscard]] bool fits() const { return need.image_bytes <= budget_bytes; }
  [[nodiscard]] bool is_reduced() const { return parameters.has_grid && parameters.lambda != wanted_lambda; }
};

/// Bytes of main memory for the waiting rays of all cores, including losses by alignment.
[[nodiscard]] std::uint64_t spill_bytes_of(std::uint32_t core_count, std::uint32_t recursion_depth);

/// Bytes of main memory for a scene image.
///
/// @param spill_bytes  of all cores, reserved for waiting rays.
/// @param planes  output planes of the frame, 1..3. The space of a picture of 1024x1024 with three planes is always
///                reserved, or half of the main memory if that is less, so that pack and render choose the same grid
///                for every picture that fits there.
/// Errors: Failure (kBadInput) if the picture alone does not fit.
[[nodiscard]] std::uint64_t image_budget_bytes(const sim::MachineProfile& machine, std::uint32_t width,
                                               std::uint32_t height, std::uint32_t planes,
                                               std::uint32_t tile_width = 32, std::uint64_t spill_bytes = 0);

/// Errors: Failure (kBadInput) if a packed scene has another triangle format.
void require_format(const SceneInput& input, const PackedScene& packed, TriangleFormat format);

/// Chooses the grid of a mesh: the wanted lambda, halved until the image fits the budget unless the command line fixed
/// it. If nothing fits, the choice says so and has the least need found.
/// @param effects  for the image; null: none. Errors: Failure (kBadInput) if there is nothing to trace; kUsage for
/// options of a grid where there is none.
/// @param sharing  threads of the host.
[[nodiscard]] GridChoice choose_grid(const SceneInput& input, const Mesh& mesh, const SceneRequest& request,
                                     const ImageLimits& limits, const EffectsView* effects = nullptr,
                                     const WorkSharing& sharing = {});

/// @returns "0.00018", or "0.00018 to 0.0021" if objects have tolerances of their own.
[[nodiscard]] std::string words_of_tolerance(const SceneRoundness& roundness);

/// Prints a line on standard error if the grid was reduced, unless quiet. Errors: Failure (kBadInput) if the choice
/// does not fit; for a text scene with a tolerance that would.
void require_fit(const GridChoice& choice, const SceneRequest& request, const SceneInput& input);

/// Builds the image of a mesh. @param image  kLineBytes-aligned, choice.need.image_bytes. @param effects  the choice's.
/// @param sharing  threads of the host. @returns its validated view. Errors: Failure.
[[nodiscard]] SceneImageView build_image(const SceneInput& input, const Mesh& mesh, const GridChoice& choice,
                                         std::span<std::byte> image, const EffectsView* effects = nullptr,
                                         const WorkSharing& sharing = {});

/// Throws Failure (kBadInput) if a packed scene cannot be used as requested: another format, without what the engine
/// reads, other grid parameters than the command line fixes, or larger than the budget.
void check_packed(const SceneInput& input, const PackedScene& packed, const SceneRequest& request,
                  const ImageLimits& limits);

}  // namespace gridiron::tool
