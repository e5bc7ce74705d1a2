// Progress: a bar on a terminal with the time that is left, nothing anywhere else.
// Memory: small. Threads: update() is called by one at a time. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <thread>

#include "stopwatch.h"

namespace gridiron::tool {

/// Estimates when something will be done. Parts may differ in cost: the estimate follows the rate of the last few
/// seconds, and what is told runs down with the clock and is drawn to the estimate slowly, so that it does not jump.
class TimeLeft {
 public:
  /// @param seconds  since the start, never less than before. @param share  that is done, 0..1.
  void update(double seconds, double share);

  /// @returns seconds; nothing before there is enough to go by.
  [[nodiscard]] std::optional<double> seconds() const { return told_; }

 private:
  double last_seconds_ = 0, last_share_ = 0;
  double rate_ = 0;  // share a second, smoothed
  std::optional<double> told_;
};

/// @returns "5 s", "1 min 20 s", "2 h 5 min".
[[nodiscard]] std::string words_of_seconds(double seconds);

/// Draws on standard error while it lives and wipes the line when it dies.
class Progress {
 public:
  /// @param wanted  false, or a standard error that is no terminal: nothing is ever drawn.
  /// @param noun    what is counted, in the plural.
  explicit Progress(bool wanted, const char* noun = "tiles");
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void update(std::uint64_t done, std::uint64_t total);

 private:
  bool drawing_;
  const char* noun_;
  Stopwatch stopwatch_;
  TimeLeft left_;
  double drawn_seconds_ = -1;
  std::uint64_t drawn_percent_ = ~0ull;
};

/// While one lives, stages are drawn, where they are `wanted` and standard error is a terminal.
class StageLines {
 public:
  explicit StageLines(bool wanted);
  ~StageLines();
  StageLines(const StageLines&) = delete;
  StageLines& operator=(const StageLines&) = delete;
};

/// What the command is busy with while it lives, where nobody can say how much of it is done: "a.ply: reading, 3 s". It
/// is drawn by a thread of its own once it takes longer than a second, and wiped at the end.
class Stage {
 public:
  Stage(const std::filesystem::path& input, const char* doing);
  ~Stage();
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;

 private:
  std::jthread thread_;
};

}  // namespace gridiron::tool
