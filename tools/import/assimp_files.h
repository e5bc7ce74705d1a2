// Assimp files: the model's bytes under its name, and the files beside it that it names, which are listed.
// Memory: borrows the bytes. Threads: one. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <assimp/IOSystem.hpp>
#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "import/model_import.h"

namespace gridiron::tool {

/// Opens files for reading; nothing is written, and what is no plain file is not there.
class AssimpFiles final : public Assimp::IOSystem {
 public:
  AssimpFiles(std::string name, std::span<const std::byte> bytes) : name_(std::move(name)), bytes_(bytes) {}

  bool Exists(const char* path) const override;
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char* path, const char* mode) override;
  void Close(Assimp::IOStream* file) override;

  /// @returns the bytes of a file beside the model, kept until this object dies; nothing if there is no plain file.
  std::optional<std::span<const std::byte>> read(const std::string& path);

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] std::vector<NeighbourFile> neighbours() const;
  /// Names that were looked for and not found.
  [[nodiscard]] const std::set<std::string>& missing() const { return missing_; }

 private:
  std::string name_;
  std::span<const std::byte> bytes_;
  std::map<std::string, std::vector<std::byte>> files_;
  std::set<std::string> missing_;
};

}  // namespace gridiron::tool
