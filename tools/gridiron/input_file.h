// Input files as bytes.
// Memory: owns the bytes. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <limits>
#include <memory>
#include <new>
#include <span>

namespace gridiron::tool {

inline constexpr std::align_val_t kImageAlignment{128};

struct AlignedDelete {
  void operator()(std::byte* bytes) const { ::operator delete[](bytes, kImageAlignment); }
};
using AlignedBytes = std::unique_ptr<std::byte[], AlignedDelete>;

/// @returns bytes aligned as a scene image must be, uninitialised.
[[nodiscard]] inline AlignedBytes allocate_aligned(std::size_t bytes) {
  return AlignedBytes(new (kImageAlignment) std::byte[bytes]);
}

/// A file's bytes, aligned so that a scene image may be read in place.
struct InputFile {
  AlignedBytes storage;
  std::span<const std::byte> bytes;
};

/// Reads a whole file. Errors: Failure (kBadInput) that names the file and the reason, also where it is larger than
/// `most_bytes`; where a scan that tools/fetch_scenes gets is missing, the message says so. A pipe is read to its end;
/// a signal ends the wait for it as stop_if_interrupted() does. Errors of note_input() too.
[[nodiscard]] InputFile read_input_file(const std::filesystem::path& path,
                                        std::size_t most_bytes = std::numeric_limits<std::size_t>::max());

}  // namespace gridiron::tool
