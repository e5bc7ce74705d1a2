// Frame log: the small file by which an animation goes on where it was interrupted. It holds the options, and a line
// for each complete picture: what it was made of, its bytes' hash, its figures.
// Memory: std::string. Threads: one. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "frame_figures.h"

namespace gridiron::tool {

/// What a frame is made of, as content hashes.
struct FrameSource {
  std::uint64_t content = 0;  ///< of all files of its scene
  std::uint64_t view = 0;     ///< of camera and size
};

struct LoggedFrame {
  std::uint64_t line = 0;  ///< of the log
  FrameSource source;
  std::uint64_t picture = 0;  ///< content hash of its file
  FrameFigures figures;
};

class FrameLog {
 public:
  /// @param path  declared as an output. @param options  of this command.
  FrameLog(std::filesystem::path path, std::map<std::string, std::string> options);
  ~FrameLog();
  FrameLog(const FrameLog&) = delete;
  FrameLog& operator=(const FrameLog&) = delete;

  /// @returns whether an earlier command left a log.
  [[nodiscard]] bool exists() const;

  /// Reads the frames of an earlier command; add() keeps them. A last line that is not whole does not count.
  /// Errors: Failure (kBadInput), `file:line: reason`, if this command has other options, or the file is no log.
  const std::map<std::size_t, LoggedFrame>& read();

  /// Drops a frame that was read. @param i  its place.
  void drop(std::size_t i) { frames_.erase(i); }

  /// Begins the log anew with the frames that were read, once: called before a picture changes. Errors: Failure
  /// (kBadInput).
  void begin();

  /// Appends a line. Precondition: begin(). Errors: Failure (kBadInput).
  void add(std::size_t i, const LoggedFrame& frame);

  /// Writes the log anew if its lines do not have the order of the frames. Errors: Failure (kBadInput).
  void put_in_order();

  /// Throws Failure (kBadInput): `file:line: cannot be resumed: reason`.
  [[noreturn]] void refuse(std::uint64_t line, const std::string& reason) const;

 private:
  std::filesystem::path path_;
  std::map<std::string, std::string> options_;
  std::map<std::size_t, LoggedFrame> frames_;
  int descriptor_ = -1;
  bool is_in_order_ = true;
};

}  // namespace gridiron::tool
