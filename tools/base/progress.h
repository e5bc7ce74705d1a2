// Progress: a bar on a terminal with the time that is left. Elsewhere nothing, but of many processes, whose launcher
// keeps the terminal to itself, a line now and then.
// Memory: small. Threads: update() is called by one at a time. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <thread>

#include "stopwatch.h"

namespace gridiron::tool {

/// Estimates the time that is left. Parts may differ in cost, so the estimate follows the rate of the last few seconds.
/// The shown time runs down with the clock and approaches the estimate slowly, so that it does not jump.
class TimeLeft {
 public:
  /// @param seconds  since the start, never decreasing. @param share  of the work that is done, 0..1.
  void update(double seconds, double share);

  /// @returns seconds; nothing while too little is known.
  [[nodiscard]] std::optional<double> seconds() const { return told_; }

 private:
  double last_seconds_ = 0, last_share_ = 0;
  double rate_ = 0;  // share a second, smoothed
  std::optional<double> told_;
};

/// @returns "5 s", "1 min 20 s", "2 h 5 min".
[[nodiscard]] std::string words_of_seconds(double seconds);

/// Draws on standard error, and wipes the line at its end.
class Progress {
 public:
  /// @param wanted  false: nothing is drawn. Where standard error is no terminal, ranks print a line every 10 seconds.
  /// @param noun    the items that are counted, in the plural.
  explicit Progress(bool wanted, const char* noun = "tiles");
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// @param part  of the next item, 0..1.
  void update(std::uint64_t done, std::uint64_t total, double part = 0);

  /// Wipes the line for other text; the next update draws it again.
  void wipe();

 private:
  bool drawing_;
  bool lines_;  ///< instead
  const char* noun_;
  Stopwatch stopwatch_;
  TimeLeft left_;
  double drawn_seconds_ = -1;
  std::uint64_t drawn_percent_ = ~0ull;
};

/// Stages are drawn while one exists, if they are `wanted` and standard error is a terminal.
class StageLines {
 public:
  explicit StageLines(bool wanted);
  ~StageLines();
  StageLines(const StageLines&) = delete;
  StageLines& operator=(const StageLines&) = delete;
};

/// Shows a step whose share cannot be measured: "a.ply: reading, 3 s". A thread draws it once it takes longer than a
/// second, and wipes it at the end.
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
