// Progress. SPDX-License-Identifier: Apache-2.0
#include "progress.h"

#include <unistd.h>

#include <cstdio>
#include <string>

namespace gridiron::tool {

Progress::Progress(bool wanted, const char* noun)
    : drawing_(wanted && ::isatty(STDERR_FILENO) == 1), noun_(noun) {}

Progress::~Progress() {
  if (drawing_ && drawn_percent_ != ~0u) std::fputs("\r\033[K", stderr);
}

void Progress::update(std::uint32_t done, std::uint32_t total) {
  if (!drawing_ || total == 0) return;
  const auto percent = static_cast<std::uint32_t>(std::uint64_t{done} * 100 / total);
  if (percent == drawn_percent_) return;
  drawn_percent_ = percent;
  constexpr std::uint32_t kBarWidth = 40;
  const std::uint32_t filled = percent * kBarWidth / 100;
  const std::string bar = std::string(filled, '#') + std::string(kBarWidth - filled, '.');
  std::fprintf(stderr, "\r[%s] %3u %%  %s %u of %u", bar.c_str(), percent, noun_, done, total);
  std::fflush(stderr);
}

}  // namespace gridiron::tool
