// Import child: the process that reads a model with Assimp, within limits that it sets itself before it reads a byte.
// Memory: limited. Threads: one. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "import/model_import.h"

namespace gridiron::tool {

/// What the parent passes on the command line. The model is standard input, the answer standard output.
struct ChildSettings {
  std::filesystem::path path;
  std::string ending;
  std::uint64_t memory_bytes = 0;
  std::uint32_t cpu_seconds = 0;
  pid_t parent = 0;
  std::optional<double> moment;  ///< of an animation, 0..1
  std::string animation;         ///< as ImportOptions has it
};

/// The arguments behind the command's name.
[[nodiscard]] std::vector<std::string> words_of(const ChildSettings& settings);
/// @returns nothing if the words are not those of words_of().
[[nodiscard]] std::optional<ChildSettings> settings_of(std::span<const char* const> words);

/// Reads the model and writes the answer. @returns the exit code.
[[nodiscard]] int run_import_child(const ChildSettings& settings);

/// Reads a model with Assimp. Errors: ImportError, std::bad_alloc.
/// @param name  of the model for Assimp: its folder and an ending that tells the format.
[[nodiscard]] ImportedModel read_with_assimp(std::span<const std::byte> bytes, const ChildSettings& settings);

}  // namespace gridiron::tool
