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

#include "output_target.h"
#include "overdue_exit.h"

namespace gridiron::tool {

/// Collects bytes for `path` in a file of the same folder that has no name, gets a temporary one by finish(), and is
/// renamed by commit(). Where the file system knows no nameless files, it has the temporary name from the beginning.
///
/// A target that is a device, a pipe or a descriptor is written through at commit, since renaming would replace it. A
/// replaced file keeps its rights. Errors: Failure (kBadInput) with path and reason, or stop_if_interrupted()'s if a
/// signal ends the wait for a pipe's reader; nothing is left behind then.
class AtomicFile {
 public:
  /// Opens the temporary file. target_of() resolves the path.
  explicit AtomicFile(const std::filesystem::path& path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  void write(std::span<const std::byte> bytes);
  void write(std::string_view text);

  /// Of the temporary file, for another program that writes it; -1 for a device or pipe.
  [[nodiscard]] int descriptor() const { return descriptor_; }

  /// Closes the temporary file. Nothing is written after that.
  void finish();

  /// Finishes and makes the file appear under its name.
  /// @param is_counted  among the written files that a failure's last line tells of.
  void commit(bool is_counted = true);

  [[nodiscard]] const OutputTarget& target() const { return target_; }

 private:
  void open_temporary();
  void name_temporary();
  void write_through();
  /// @param action  the failed step, with ": " at its end; empty: writing itself.
  [[noreturn]] void fail(const char* action);

  OutputTarget target_;
  std::string temporary_;            ///< empty: nothing to remove
  Leftover leftover_;                ///< the same, for an overdue exit
  std::vector<std::byte> deferred_;  ///< bytes for a device or pipe
  int descriptor_ = -1;
  bool is_nameless_ = false;  ///< written, but not yet under a temporary name
};

/// Outputs of one command: every file is complete under its temporary name before the first one appears.
class AtomicFiles {
 public:
  /// @param content  bytes or text. Errors: of AtomicFile, and stop_if_interrupted()'s.
  template <class Content>
  void add(const std::filesystem::path& path, const Content& content) {
    AtomicFile& file = begin(path);
    file.write(content);
    file.finish();
  }

  /// Adds a file whose content the caller writes before commit(). The same errors.
  AtomicFile& begin(const std::filesystem::path& path);

  /// Makes all files appear, devices and pipes first, because they may fail and a rename no longer does. No file
  /// appears if one of the targets can no longer be replaced. Errors: of check_again() too.
  void commit();
  /// Does so as the last step of the command; later interrupts have no effect.
  void commit_at_end();

 private:
  std::list<AtomicFile> files_;
};

}  // namespace gridiron::tool
