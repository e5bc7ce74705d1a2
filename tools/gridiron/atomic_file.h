// AtomicFile: an output file that appears whole or not at all.
// Memory: owns a temporary file until commit or destruction. Threads: one. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <list>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace gridiron::tool {

/// Bytes on their way to `path`: written under another name in the same folder, renamed by commit().
///
/// A path that is a device or a pipe is written through at commit, since renaming over it would replace it. A symbolic
/// link is followed. Errors: Failure (kBadInput) with path and reason, or stop_if_interrupted()'s where a signal ends
/// the wait for a pipe's reader; nothing is left behind then.
class AtomicFile {
 public:
  /// Opens the temporary file.
  explicit AtomicFile(std::filesystem::path path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  void write(std::span<const std::byte> bytes);
  void write(std::string_view text);

  /// Closes and makes the file appear under its name.
  void commit();

  /// @returns whether the path is a device or a pipe, whose bytes can fail to arrive as late as at commit.
  [[nodiscard]] bool is_special() const { return is_special_; }

 private:
  [[noreturn]] void fail(const char* action);

  std::filesystem::path path_;       ///< as asked for: the one people are told
  std::filesystem::path target_;     ///< links followed
  std::string temporary_;            ///< empty: nothing to remove
  std::vector<std::byte> deferred_;  ///< bytes for a device or pipe
  bool is_special_ = false;
  int descriptor_ = -1;
};

/// Outputs of one command: every file is complete under its temporary name before the first one appears.
class AtomicFiles {
 public:
  /// @param content  bytes or text. Errors: of AtomicFile, and stop_if_interrupted()'s.
  template <class Content>
  void add(const std::filesystem::path& path, const Content& content) {
    open(path).write(content);
  }

  /// Makes all files appear, devices and pipes first: they may fail where a rename no longer does.
  void commit();

 private:
  AtomicFile& open(const std::filesystem::path& path);

  std::list<AtomicFile> files_;
};

/// @returns where bytes written to `path` really go: through symbolic links, also one that points at nothing yet.
[[nodiscard]] std::filesystem::path resolve_target(const std::filesystem::path& path);

/// @returns whether two names, which need not exist, mean one file: links, `.` and `..` are followed. A device takes
/// any number of outputs, and is never the same as another.
[[nodiscard]] bool is_same_file(const std::filesystem::path& a, const std::filesystem::path& b);

/// Throws Failure (kBadInput) where no file of that name could be made, before the work for it is done: the folder is
/// missing or closed, or the name is a folder.
void check_can_write(const std::filesystem::path& path);

}  // namespace gridiron::tool
