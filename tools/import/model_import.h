// Model import: files that Assimp reads (OBJ, STL, glTF and others) as meshes, read by a child process with limits.
// The child is this program again; what it sends is checked like a hostile file.
// Memory: owns what it returns. Threads: one. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "files/input_file.h"
#include "import/mesh.h"

namespace gridiron::tool {

/// How a model is read: the limits of the child, and what of an animation.
struct ImportOptions {
  std::uint64_t memory_bytes = 0;    ///< beside the program itself; 0: half of the host's memory, at least 1 GB
  std::uint32_t most_seconds = 300;  ///< of CPU time, and of time on the clock
  std::optional<double> moment{};    ///< of an animation, 0..1 of its length; nothing: the pose at rest
  std::string animation{};           ///< its name, or its number from 1 on; empty: the first
};

/// What to read of a model.
struct ImportRequest {
  std::filesystem::path path;  ///< for messages; its folder has the files that the model names
  std::string ending;          ///< "obj": the format, see model_ending()
  ImportOptions options{};
};

struct ImportedAnimation {
  std::string name;  ///< may be empty
  double seconds = 0;
};

/// What was read and what was not, in words for people.
struct ImportReport {
  std::string format;          ///< "OBJ", "glTF", "PLY"
  std::string reader;          ///< "Assimp 5.2.4"; empty: this program
  double unit_metres = 0;      ///< length of a unit, 0 if the file does not say
  std::string up;              ///< "y", "-z", or empty if the file does not say
  std::uint64_t meshes = 0;    ///< with triangles, each time that a node shows one
  std::uint64_t textures = 0;  ///< that gave colours
  std::vector<ImportedAnimation> animations;
  std::vector<std::string> ignored;  ///< "3 lines", "2 cameras"
};

/// @returns "in metres, y up"; empty if the file does not say.
[[nodiscard]] std::string words_of_frame(const ImportReport& report);

/// @returns "a, b and c".
[[nodiscard]] std::string words_of_list(const std::vector<std::string>& words);

/// A file beside the model that was read for it.
struct NeighbourFile {
  std::string path;
  std::uint64_t content = 0;  ///< content_hash()
};

struct ImportedModel {
  Mesh mesh;
  ImportReport report;
  std::vector<NeighbourFile> neighbours;
};

/// Name of the hidden command with which the program starts itself as the child.
inline constexpr const char* kImportCommand = "read-model-as-child";

/// @returns whether this program was built with Assimp.
[[nodiscard]] bool can_import();

/// Reads a model in a child process. Ctrl-C ends the child too.
///
/// @param file  the model's bytes; freed before the child's arrays arrive.
/// Errors: Failure (kBadInput) with the file and the reason, whatever happens to the child: a reason from Assimp, a
/// crash, too much memory or time, or an answer that is not a mesh.
[[nodiscard]] ImportedModel import_model(InputFile file, const ImportRequest& request);

/// The child's side: if the arguments are those of kImportCommand, reads the model and returns an exit code.
[[nodiscard]] std::optional<int> serve_import(int count, const char* const* values);

}  // namespace gridiron::tool
