// Input files as bytes.
// Memory: owns the bytes. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <new>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/failure.h"

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
  std::span<std::byte> bytes;
};

inline constexpr std::size_t kAnySize = std::numeric_limits<std::size_t>::max();

/// One input, opened once and read from its start to its end: a file, a pipe, or standard input.
class InputReader {
 public:
  /// Opens the input and reads its first kHeadBytes. A signal ends the wait for a pipe as stop_if_interrupted() does.
  ///
  /// @param expected  what the command reads here, for messages: "expected a PLY mesh".
  /// Errors: Failure (kBadInput) that names the file and the reason. For a missing scan that tools/fetch_scenes gets,
  /// the message says so. Errors of note_input() too.
  InputReader(std::filesystem::path path, std::string expected);
  ~InputReader();
  InputReader(const InputReader&) = delete;
  InputReader& operator=(const InputReader&) = delete;

  /// The first bytes, all of them if there are fewer than kHeadBytes.
  [[nodiscard]] std::span<const std::byte> head() const { return head_; }

  /// Size of a regular file.
  [[nodiscard]] std::optional<std::uint64_t> file_bytes() const { return file_bytes_; }

  /// Reads to the end, which uses the reader up. Errors: Failure (kBadInput) if it cannot be read, or is larger than
  /// `most_bytes` or than the memory of this host.
  [[nodiscard]] InputFile read_all(std::size_t most_bytes = kAnySize);

  /// Throws Failure (kBadInput) with the file's content and what was expected.
  [[noreturn]] void refuse_content() const;

 private:
  [[nodiscard]] std::size_t read_some(std::span<std::byte> target) const;
  [[nodiscard]] InputFile read_rest(std::size_t most_bytes) const;

  std::filesystem::path path_;
  std::string expected_;
  int descriptor_ = -1;
  std::optional<std::uint64_t> file_bytes_;  ///< of a regular file
  std::vector<std::byte> head_;
};

/// While one exists, the bytes of all inputs that are read to their end are combined into one number, by which another
/// command can see whether they have changed.
class InputHash {
 public:
  InputHash();
  ~InputHash();
  InputHash(const InputHash&) = delete;
  InputHash& operator=(const InputHash&) = delete;

  [[nodiscard]] std::uint64_t value() const { return value_; }

 private:
  friend class InputReader;
  friend void note_read_file(const std::filesystem::path& path, std::uint64_t content);

  std::uint64_t value_ = 0;
};

/// Notes a file that another process has read for this one. @param content  its content_hash(). Errors: those of
/// note_input().
void note_read_file(const std::filesystem::path& path, std::uint64_t content);

[[nodiscard]] InputFile read_input_file(const std::filesystem::path& path, const std::string& expected,
                                        std::size_t most_bytes = kAnySize);

/// The same for text that people write; rejects empty files, pictures, scenes and others with their kind.
[[nodiscard]] InputFile read_text_file(const std::filesystem::path& path, const std::string& expected,
                                       std::size_t most_bytes);

/// Copies bytes to another place and returns their memory to the host piece by piece, so that they exist once.
/// Afterwards the content of `from` is undefined; its owner still frees it.
void move_bytes(std::span<std::byte> from, std::byte* target);

/// The same to the end of a vector with sufficient capacity.
void append_moved(std::vector<std::byte>& target, std::span<std::byte> from);

/// @returns the path of an input of the command line: `-` is standard input.
[[nodiscard]] std::filesystem::path input_path(const std::filesystem::path& name);

/// @returns whether a path is standard input or a pipe that the shell made: /dev/stdin, /dev/fd/N, /proc/self/fd/N.
[[nodiscard]] bool is_descriptor(const std::filesystem::path& path);

/// @returns whether a path can be read only once: a descriptor or a pipe.
[[nodiscard]] bool is_stream(const std::filesystem::path& path);

/// @returns whether two inputs are the same stream, so that reading one takes bytes from the other.
[[nodiscard]] bool share_a_stream(const std::filesystem::path& a, const std::filesystem::path& b);

/// @returns the folder for files that an input names: its own, for a stream the current one.
[[nodiscard]] std::filesystem::path folder_of_input(const std::filesystem::path& path);

/// Runs an action; if this host has too little memory for it, the Failure (kBadInput) names the file.
/// @param purpose  use of the memory: "read it".
template <class Action>
auto name_in_shortage(const std::filesystem::path& path, const char* purpose, Action action) -> decltype(action()) {
  try {
    return action();
  } catch (const std::bad_alloc&) {
    input_error(path, std::string("this host has not enough memory to ") + purpose);
  }
}

}  // namespace gridiron::tool
