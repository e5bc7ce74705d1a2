// Byte reader: records of a binary file, and errors that name the byte.
// Memory: borrows path and bytes. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <span>
#include <string>

#include "base/failure.h"

namespace gridiron::tool {

class ByteReader {
 public:
  ByteReader(const std::filesystem::path& path, std::span<const std::byte> bytes) : path_(path), bytes_(bytes) {}

  /// Errors: Failure (kBadInput), `file:byte N: reason`, unless `holds`.
  void require(bool holds, std::uint64_t place, const std::string& reason) const {
    if (!holds) throw Failure(ExitCode::kBadInput, path_.string() + ":byte " + std::to_string(place) + ": " + reason);
  }

  /// @returns the record at a place. Precondition: it lies inside the file.
  template <class Record>
  [[nodiscard]] Record read(std::uint64_t place) const {
    Record record{};
    std::memcpy(&record, bytes_.data() + place, sizeof record);
    return record;
  }

 private:
  const std::filesystem::path& path_;
  std::span<const std::byte> bytes_;
};

}  // namespace gridiron::tool
