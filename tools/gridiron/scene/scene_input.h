// Scene input: a PLY mesh, a text scene or a packed scene, told apart by what the file holds, read and checked, and the
// grid that fits a machine.
// Memory: owns mesh or file. Threads: one. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/build/grid/grid_builder.h>
#include <gridiron/image/scene_image.h>
#include <gridiron/scene/mesh.h>

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
#include "scene_request.h"
#include "scene_text/scene_description.h"
#include "scene_text/scene_effects.h"
#include "scene_text/scene_reader.h"
#include "view.h"

namespace gridiron::tool {

/// Triangles as read, in the input's order after fanning.
struct Mesh {
  std::vector<Vec3> vertices;
  std::vector<UVec3> triangles;

  [[nodiscard]] MeshView view() const { return {vertices, triangles}; }
};

/// A scene image as read and validated.
struct PackedScene {
  InputFile file;
  SceneImageView view;
};

/// What a text scene holds beside its triangles.
struct TextScene {
  SceneView view;
  SceneEffects effects;
  std::vector<SceneNote> notes;
  std::uint64_t note_count = 0;
  std::vector<std::filesystem::path> files;  ///< that the text names
  SceneRoundness roundness;
};

struct SceneInput {
  std::filesystem::path path;
  std::variant<Mesh, PackedScene> content;
  HostSeconds load_seconds{};       ///< of reading and checking
  std::optional<TextScene> text{};  ///< beside a Mesh
};

inline constexpr const char* kSceneExpected =
    "expected a scene: a PLY mesh, a text scene (NFF) or a packed scene (made by 'gridiron pack')";
inline constexpr const char* kMeshExpected = "expected a PLY mesh";

/// What a command asks of a picture. The rest is a text scene's own, where that brings a view.
struct PictureRequest {
  ViewRequest view{};                   ///< parts that replace those of any other view
  std::optional<ViewRequest> camera{};  ///< in place of the scene's own view
  std::optional<CountPair> size{};      ///< in place of the scene's own
};

/// @returns the picture of a scene that brings the view `own`, or none: `camera` and `size` are given.
[[nodiscard]] PictureRequest complete_request(PictureRequest request, const SceneView& own);

/// @returns the kind of a scene before it is read: that of the file's first bytes; of one that cannot be opened what
/// its ending promises, so that the command line is checked all the same; kUnknown of a stream, which is read once.
[[nodiscard]] SceneKind foreseen_kind(const std::filesystem::path& path);

/// @returns what that says of the scene of a command. Errors: Failure (kUsage) where it has no use for the tolerance.
[[nodiscard]] KnownScene foreseen_scene(const SceneRequest& request);

/// @returns what a scene is known to be once it is read.
[[nodiscard]] KnownScene known_scene(const SceneInput& input);

/// @returns the depth of recursion of a scene's rays, 1 where it has no effects.
[[nodiscard]] std::uint32_t recursion_depth(const SceneInput& input);

/// Reads the scene. @param tolerance  of round shapes in a text scene; nothing: the reader's own, which goes by
/// `picture`, completed by complete_request(), where that is given. @param expected  of the file, for messages.
/// Errors: Failure (kBadInput), `file:line: reason`, `file:byte N: reason`, or `file: ` what it is and what is
/// expected; kUsage where a tolerance is given of another kind of scene, or `picture` has no camera.
[[nodiscard]] SceneInput read_scene_input(const std::filesystem::path& path,
                                          std::optional<float> tolerance = std::nullopt,
                                          const std::optional<PictureRequest>& picture = std::nullopt,
                                          const char* expected = kSceneExpected);

/// Says on standard error what is odd in a text scene: `file:line: note: text`, one line each; and which tolerance was
/// chosen by the picture.
void tell_notes(const SceneInput& input);

/// @returns the mesh of a PLY file. Errors as read_scene_input. @param path  what messages call the bytes.
[[nodiscard]] Mesh read_ply_mesh(const std::filesystem::path& path);
[[nodiscard]] Mesh read_ply_mesh(std::span<const std::byte> bytes, const std::filesystem::path& path);

/// @returns every file that the scene was read from: itself, and those that a text names.
[[nodiscard]] std::vector<std::filesystem::path> files_of(const SceneInput& input);

/// What a scene image has to keep to.
struct ImageLimits {
  TriangleFormat format = TriangleFormat::kVertices;
  std::uint64_t budget_bytes = 0;                   ///< of main memory
  std::uint32_t most_macro_width = kMaxMacroWidth;  ///< that the local store holds: a configuration's is cut to it
};

/// The grid that a mesh will get, or that a packed scene has.
struct GridChoice {
  GridParameters parameters;
  GridNeed need;
  float wanted_lambda = 0;  ///< of the configuration or the command line
  std::uint64_t budget_bytes = 0;

  [[nodiscard]] bool fits() const { return need.image_bytes <= budget_bytes; }
  [[nodiscard]] bool is_reduced() const { return parameters.lambda != wanted_lambda; }
};

/// Bytes of main memory that waiting rays of all cores may take, what alignment may waste included.
[[nodiscard]] std::uint64_t spill_bytes_of(std::uint32_t core_count, std::uint32_t recursion_depth);

/// Bytes of main memory that a scene image may take.
///
/// @param spill_bytes  of all cores, kept for waiting rays.
/// @param planes  output planes of the frame, 1..3. Room for a picture of 1024x1024 with three planes is always kept,
///        or half of the main memory where that is less, so that pack and render choose the same grid for every
///        picture that this holds.
/// Errors: Failure (kBadInput) where the picture alone does not fit.
[[nodiscard]] std::uint64_t image_budget_bytes(const sim::MachineProfile& machine, std::uint32_t width,
                                               std::uint32_t height, std::uint32_t planes,
                                               std::uint32_t tile_width = 32, std::uint64_t spill_bytes = 0);

/// Errors: Failure (kBadInput) where a packed scene stores its triangles in another format.
void require_format(const SceneInput& input, const PackedScene& packed, TriangleFormat format);

/// Chooses the grid of a mesh: the wanted lambda, halved until the image fits the budget unless the command line fixed
/// it. Where nothing fits the choice says so and holds the least need found.
/// @param effects  that the image will hold; null: none.
/// Errors: Failure (kBadInput) where there is nothing to trace.
[[nodiscard]] GridChoice choose_grid(const SceneInput& input, const Mesh& mesh, const SceneRequest& request,
                                     const ImageLimits& limits, const EffectsView* effects = nullptr);

/// @returns "0.00018", or "0.00018 to 0.0021" where objects have tolerances of their own.
[[nodiscard]] std::string words_of_tolerance(const SceneRoundness& roundness);

/// Says in one line of standard error that the grid was reduced; nothing where it was not, or is not to be told.
/// Errors: Failure (kBadInput) where the choice does not fit; of a text scene with a tolerance that would.
void require_fit(const GridChoice& choice, const SceneRequest& request, const SceneInput& input);

/// Builds the image of a mesh. @param image  kLineBytes-aligned, choice.need.image_bytes. @param effects  the choice's.
/// @returns its validated view. Errors: Failure.
[[nodiscard]] SceneImageView build_image(const SceneInput& input, const Mesh& mesh, const GridChoice& choice,
                                         std::span<std::byte> image, const EffectsView* effects = nullptr);

/// Throws Failure (kBadInput) where a packed scene cannot be used as asked: stored in another format, made with other
/// grid parameters than the command line fixes, or larger than the budget.
void check_packed(const SceneInput& input, const PackedScene& packed, const SceneRequest& request,
                  const ImageLimits& limits);

}  // namespace gridiron::tool
