// Progress. SPDX-License-Identifier: Apache-2.0
#include "progress.h"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <csignal>
#include <cstdio>
#include <mutex>
#include <system_error>

#include "ranks.h"
#include "words.h"

namespace gridiron::tool {
namespace {

std::atomic<bool> stages_are_drawn{false};

void draw_stage(const std::stop_token& stop, const std::string& words) {
  // Signals must go to the thread whose calls they end.
  sigset_t all;
  sigfillset(&all);
  (void)::pthread_sigmask(SIG_BLOCK, &all, nullptr);
  const Stopwatch stopwatch;
  std::mutex mutex;
  std::condition_variable_any ended;
  std::unique_lock lock(mutex);
  std::chrono::milliseconds patience{1000};
  while (!ended.wait_for(lock, stop, patience, [&stop] { return stop.stop_requested(); })) {
    std::fprintf(stderr, "\r%s, %s\033[K", words.c_str(), words_of_seconds(std::floor(stopwatch.seconds())).c_str());
    patience = std::chrono::milliseconds{250};
  }
  if (patience.count() < 1000) std::fputs("\r\033[K", stderr);
}

}  // namespace

void TimeLeft::update(double seconds, double share) {
  constexpr double kMemory = 5;    // seconds that the rate remembers
  constexpr double kPatience = 3;  // seconds in which the shown time follows an estimate
  constexpr double kLeastStep = 0.05;
  constexpr double kLeastSeconds = 1, kLeastShare = 0.01;
  const double step = seconds - last_seconds_;
  if (step < kLeastStep || share <= last_share_) return;
  const double now = (share - last_share_) / step;
  const double mean = share / seconds;
  // At first the mean of all is the better estimate, since the last seconds are unknown.
  const double weight = 1 - std::exp(-step / kMemory);
  rate_ = rate_ == 0 ? mean : rate_ + weight * (now - rate_);
  last_seconds_ = seconds;
  last_share_ = share;
  if (seconds < kLeastSeconds || share < kLeastShare) return;
  const double estimate = (1 - share) / (0.5 * (rate_ + mean));
  if (!told_) {
    told_ = estimate;
    return;
  }
  const double counted_down = std::max(0.0, *told_ - step);
  told_ = counted_down + (1 - std::exp(-step / kPatience)) * (estimate - counted_down);
}

std::string words_of_seconds(double seconds) {
  const auto whole = static_cast<std::uint64_t>(std::ceil(std::clamp(seconds, 0.0, 1e9)));
  if (whole < 60) return std::to_string(whole) + " s";
  if (whole < 3600) return std::to_string(whole / 60) + " min " + std::to_string(whole % 60) + " s";
  return std::to_string(whole / 3600) + " h " + std::to_string(whole % 3600 / 60) + " min";
}

Progress::Progress(bool wanted, const char* noun)
    : drawing_(wanted && ::isatty(STDERR_FILENO) == 1),
      lines_(wanted && !drawing_ && ranks().count() > 1),
      noun_(noun) {}

Progress::~Progress() {
  wipe();
}

void Progress::wipe() {
  if (drawing_ && drawn_percent_ != ~0ull) std::fputs("\r\033[K", stderr);
  drawn_percent_ = ~0ull;
}

void Progress::update(std::uint64_t done, std::uint64_t total, double part) {
  if ((!drawing_ && !lines_) || total == 0) return;
  const double share = (static_cast<double>(done) + part) / static_cast<double>(total);
  const double seconds = stopwatch_.seconds();
  left_.update(seconds, share);
  const auto percent = static_cast<std::uint64_t>(100 * share);
  const std::string left = left_.seconds() ? ", " + words_of_seconds(*left_.seconds()) + " left" : "";
  if (lines_) {
    constexpr double kSecondsBetweenLines = 10;
    if (seconds - std::max(drawn_seconds_, 0.0) < kSecondsBetweenLines) return;
    drawn_seconds_ = seconds;
    std::fprintf(stderr, "%u %%, %s of %s %s%s\n", static_cast<unsigned>(percent), words_of_count(done).c_str(),
                 words_of_count(total).c_str(), noun_, left.c_str());
    return;
  }
  constexpr double kRedraw = 0.25;  // seconds
  if (percent == drawn_percent_ && seconds - drawn_seconds_ < kRedraw) return;
  drawn_percent_ = percent;
  drawn_seconds_ = seconds;
  constexpr std::uint64_t kBarWidth = 30;
  const std::uint64_t filled = std::min(percent, std::uint64_t{100}) * kBarWidth / 100;
  const std::string bar = std::string(filled, '#') + std::string(kBarWidth - filled, '.');
  std::fprintf(stderr, "\r[%s] %3u %%  %s of %s %s%s\033[K", bar.c_str(), static_cast<unsigned>(percent),
               words_of_count(done).c_str(), words_of_count(total).c_str(), noun_, left.c_str());
  std::fflush(stderr);
}

StageLines::StageLines(bool wanted) {
  stages_are_drawn = wanted && ::isatty(STDERR_FILENO) == 1;
}

StageLines::~StageLines() {
  stages_are_drawn = false;
}

Stage::Stage(const std::filesystem::path& input, const char* doing) {
  if (!stages_are_drawn) return;
  try {
    thread_ = std::jthread(draw_stage, input.string() + ": " + doing);
  } catch (const std::system_error&) {  // a host without threads: nothing is drawn
  }
}

Stage::~Stage() = default;  // ends the thread and waits for it

}  // namespace gridiron::tool
