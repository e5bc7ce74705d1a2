// Output target: the actual destination of an output.
// Memory: its paths. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace gridiron::tool {

struct OutputTarget {
  std::filesystem::path name;  ///< as given; shown in messages
  std::filesystem::path file;  ///< links followed; empty where there is a descriptor
  int descriptor = -1;         ///< of this process, inherited from its parent; -1: none
  bool is_special = false;     ///< a device, a pipe or a descriptor: written through, since it cannot be replaced
};

/// Follows links, including one whose target does not exist yet. `-` is standard output, and so are /dev/stdout and
/// /dev/fd/1.
///
/// Errors: Failure (kBadInput) if no file of that name could be made, before any work is done for it: it is a folder,
/// its folder is missing or closed, it is write-protected, its name is too long, its links form a loop.
[[nodiscard]] OutputTarget resolve_output(const std::filesystem::path& name);

/// @returns whether a path has an ending, ignoring case. @param ending  lower case, with its dot.
[[nodiscard]] bool has_ending(const std::filesystem::path& path, std::string_view ending);

/// @returns whether output to it goes to a terminal.
[[nodiscard]] bool is_terminal(const OutputTarget& target);

/// @returns a text that is equal for all names of one file, whether it exists or not; empty for a character device or a
/// socket, which any number of readers and writers may share.
[[nodiscard]] std::string identity_of(const OutputTarget& target);
[[nodiscard]] std::string identity_of_input(const std::filesystem::path& path);

}  // namespace gridiron::tool
