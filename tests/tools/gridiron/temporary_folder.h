// Temporary folder of one test, and small scenes in it.
// Memory: owns the folder on disk. Threads: one. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "support/test_mesh.h"

namespace gridiron::test {

/// A new folder, empty or with one file, gone with everything in it when the object dies.
class TemporaryFolder {
 public:
  TemporaryFolder();
  TemporaryFolder(const std::string& name, const std::string& content) : TemporaryFolder() { write(name, content); }
  TemporaryFolder(const std::string& name, const TestMesh& mesh) : TemporaryFolder() { write_ply(name, mesh); }
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  [[nodiscard]] std::filesystem::path path(const std::string& name) const { return folder_ / name; }
  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }

  /// @returns the names in the folder, hidden ones too, sorted.
  [[nodiscard]] std::vector<std::string> names() const;

  /// Writes a file. @returns its path.
  std::filesystem::path write(const std::string& name, const std::string& content) const;

  /// Writes a binary little-endian PLY file. @returns its path.
  std::filesystem::path write_ply(const std::string& name, const TestMesh& mesh) const;

 private:
  std::filesystem::path folder_;
};

/// @returns a file's bytes; a test failure if there is none.
std::string read_file(const std::filesystem::path& path);

}  // namespace gridiron::test
