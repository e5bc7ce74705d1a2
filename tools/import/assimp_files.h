// Assimp files: the model's bytes under its name, and the files beside it that it names, which are listed.
// Memory: borrows the model's bytes, owns the others. Threads: one. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <assimp/IOSystem.hpp>
#include <cstddef>
#include <cstdint>
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
  AssimpFiles(std::string name, std::span<const std::byte> bytes);

  bool Exists(const char* path) const override;
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char* path, const char* mode) override;
  void Close(Assimp::IOStream* file) override;

  /// @returns the bytes of a file beside the model, kept until this object dies; nothing if there is no plain file.
  /// A name is tried as it is, and with its %20 as blanks and the like. Bytes are those of readable_bytes().
  std::optional<std::span<const std::byte>> read(const std::string& path);

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] std::vector<NeighbourFile> neighbours() const;
  /// Names that were looked for and not found.
  [[nodiscard]] const std::set<std::string>& missing() const { return missing_; }

 private:
  struct File {
    std::vector<std::byte> bytes;
    std::uint64_t content = 0;  ///< content_hash() of the file's own bytes
  };

  std::string name_;
  std::optional<std::vector<std::byte>> readable_;  // in place of the model's own bytes
  std::span<const std::byte> bytes_;
  std::map<std::string, File> files_;
  std::set<std::string> missing_;
};

/// "%20" as the byte it stands for.
[[nodiscard]] std::string without_percents(const std::string& text);

}  // namespace gridiron::tool
