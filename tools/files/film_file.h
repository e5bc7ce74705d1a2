// Film file: pictures become a film, which ffmpeg encodes if this host has it.
// Memory: owns the process until its end. Threads: one. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "atomic_file.h"

namespace gridiron::tool {

/// Throws Failure (kBadInput) if no folder of PATH has ffmpeg. @param film  output, for the message.
void require_ffmpeg(const std::filesystem::path& film);

/// An ffmpeg that runs. It writes into the film's temporary file through a descriptor, so that it cannot leave a file
/// behind; it ends with this object, and with this process.
class FilmMaker {
 public:
  /// @param file  of an output of kind OutputKind::kFilm; its ending decides the format: H.264 in MP4, VP9 in WebM,
  /// GIF. Errors: Failure (kBadInput).
  FilmMaker(const AtomicFile& file, float frames_per_second);
  ~FilmMaker();
  FilmMaker(const FilmMaker&) = delete;
  FilmMaker& operator=(const FilmMaker&) = delete;

  /// Appends a frame. @param png  all frames have one size. Errors: Failure (kBadInput) with ffmpeg's own words, or
  /// stop_if_interrupted()'s.
  void add(std::span<const std::byte> png);

  /// Waits until the film is whole. The same errors.
  void finish();

 private:
  void start(int film);
  /// @returns ffmpeg's status, once it has ended. Errors: stop_if_interrupted()'s.
  [[nodiscard]] int wait();
  [[noreturn]] void fail(const std::string& reason) const;
  [[noreturn]] void fail_as_ffmpeg(int status) const;

  std::filesystem::path name_;
  std::string program_;
  std::vector<std::string> words_;
  pid_t process_ = -1;
  int pictures_ = -1;  ///< its standard input
  int messages_ = -1;  ///< its standard error
};

/// @returns the bytes of a regular file that this program wrote; nothing if there is none or it cannot be read.
[[nodiscard]] std::optional<std::vector<std::byte>> read_back(const std::filesystem::path& path);

}  // namespace gridiron::tool
