// Command files: keeps the outputs of a command apart from its inputs and from one another.
// Memory: names. Threads: note_input() is called by any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "output_target.h"

namespace gridiron::tool {

/// The content of an output, which decides the ending of its name, and whether a terminal may show it.
enum class OutputKind {
  kPicture,  ///< .png or .pfm
  kFloats,   ///< .pfm
  kFilm,     ///< .mp4, .webm or .gif, a file
  kBinary,
  kText,
};

struct Output {
  std::string option;  ///< that names it; empty: a file of an output folder
  std::filesystem::path path;
  OutputKind kind = OutputKind::kText;
};

/// The files of the command that runs while this object exists. Without one, nothing is compared.
class CommandFiles {
 public:
  CommandFiles();
  /// Restores standard output if an output used it.
  ~CommandFiles();
  CommandFiles(const CommandFiles&) = delete;
  CommandFiles& operator=(const CommandFiles&) = delete;
};

/// Notes a file that the command reads, before it is opened. `-` is standard input. Errors: Failure (kUsage) if it is a
/// declared output, links followed.
void note_input(const std::filesystem::path& path);

/// Declares files that the command will write, before it works for them. If one is standard output, everything printed
/// from then on goes to standard error.
///
/// Errors: Failure, those of resolve_output(); kUsage if one is an input noted so far or another output, if the ending
/// of its name does not match its kind, or if bytes would go to a terminal.
void declare_outputs(const std::vector<Output>& outputs);

/// @returns where a declared output goes: where its links led when it was declared. Others are resolved now, with the
/// errors of resolve_output().
[[nodiscard]] OutputTarget target_of(const std::filesystem::path& path);

/// Throws Failure (kBadInput) if a target has become a folder or an input since it was declared.
void check_again(const OutputTarget& target);

/// Counts files that have got their names; later failures report the number.
void count_written_file();
[[nodiscard]] std::size_t written_file_count();

}  // namespace gridiron::tool
