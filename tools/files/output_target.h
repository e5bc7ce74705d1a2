// Output target: where the bytes of an output really go.
// Memory: its paths. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace gridiron::tool {

struct OutputTarget {
  std::filesystem::path name;  ///< as asked for: the one that messages show
  std::filesystem::path file;  ///< links followed; empty where there is a descriptor
  int descriptor = -1;         ///< of this process, opened by whoever started it; -1: none
  bool is_special = false;     ///< a device, a pipe or a descriptor: written through, since it cannot be replaced
};

/// Follows links, also one that points at nothing yet. `-` is standard output, and so are /dev/stdout and /dev/fd/1.
///
/// Errors: Failure (kBadInput) where no file of that name could be made, before the work for it is done: it is a
/// folder, its folder is missing or closed, it is write-protected, its name is too long, its links form a loop.
[[nodiscard]] OutputTarget resolve_output(const std::filesystem::path& name);

/// @returns whether a path ends so, in capitals or not. @param ending  small letters, with its dot.
[[nodiscard]] bool has_ending(const std::filesystem::path& path, std::string_view ending);

/// @returns whether what is written there goes to a terminal.
[[nodiscard]] bool is_terminal(const OutputTarget& target);

/// @returns a text that two names of one file have in common, whether the file exists or not; empty for what any number
/// of readers and writers may share: a character device or a socket.
[[nodiscard]] std::string identity_of(const OutputTarget& target);
[[nodiscard]] std::string identity_of_input(const std::filesystem::path& path);

}  // namespace gridiron::tool
