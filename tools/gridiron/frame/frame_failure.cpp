// Frame failure. SPDX-License-Identifier: Apache-2.0
#include "frame_failure.h"

#include <gridiron/sim/sim_core.h>

#include <algorithm>
#include <string>

#include "base/words.h"

namespace gridiron::tool {
namespace {

std::string words_of_place(std::uint32_t core, std::uint32_t tile_id) {
  const std::string words = "core " + std::to_string(core);
  return tile_id == sim::kNoTile ? words + ", outside tiles" : words + ", tile " + std::to_string(tile_id);
}

}  // namespace

std::optional<Failure> frame_failure(const sim::ChipResult& result, const std::filesystem::path& input) {
  if (result.status == Status::kOk && result.violations.empty()) return std::nullopt;
  const std::string name = input.empty() ? "" : input.string() + ": ";
  if (result.host_shortage == sim::HostShortage::kMemory) {
    return Failure(ExitCode::kBadInput,
                   name + "this host has not enough memory to render the frame; fewer --threads need less");
  }
  if (result.host_shortage == sim::HostShortage::kThreads) {
    return Failure(ExitCode::kBadInput, name + "this host cannot start a thread for each core of the machine");
  }
  if (result.status == Status::kUnsupportedFrame) return Failure(ExitCode::kUsage, words_of(result.status));
  if (result.status == Status::kUnsupportedImage) return Failure(ExitCode::kBadInput, name + words_of(result.status));

  constexpr std::size_t kMostLines = 20;
  const std::size_t lines = std::min(result.violations.size(), kMostLines);
  std::string message;
  for (std::size_t i = 0; i < lines; ++i) {
    const sim::Violation& violation = result.violations[i];
    message.append(words_of_place(violation.core, violation.tile_id)).append(": ");
    message.append(words_of(violation.rule)).append(": ").append(violation.detail).append("\n");
  }
  if (lines < result.violations.size()) {
    message.append("... and ").append(words_of_count(result.violations.size() - lines)).append(" more\n");
  }
  if (result.status != Status::kOk) {
    message.append("the frame failed on ").append(words_of_place(result.failed_core, result.failed_tile));
    message.append(": ").append(words_of(result.status));
  } else {
    message.append("rules of the machine broken: ").append(words_of_count(result.violations.size()));
  }
  return Failure(ExitCode::kCheckFailed, message);
}

}  // namespace gridiron::tool
