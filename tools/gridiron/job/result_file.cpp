// Result files. SPDX-License-Identifier: Apache-2.0
#include "result_file.h"

#include <gridiron/base/work_counters.h>
#include <gridiron/platform/status.h>
#include <gridiron/platform/status_name.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>

#include "base/failure.h"
#include "base/words.h"
#include "files/byte_reader.h"
#include "files/file_kind.h"
#include "gridiron/scene/effect_names.h"

namespace gridiron::tool {
namespace {

using port::CoreResult;
using port::FrameResult;
using port::TileResult;

// More than an engine has; the simulator searches its queue at every transfer.
constexpr std::uint32_t kMostQueueDepth = 1024;

std::uint64_t place_of_core(std::uint32_t core) {
  return offsetof(FrameResult, cores) + std::uint64_t{core} * sizeof(CoreResult);
}

bool is_zero(std::span<const std::uint32_t> words) {
  return std::ranges::all_of(words, [](std::uint32_t word) { return word == 0; });
}

std::string words_of_status(const CoreResult& core) {
  const std::uint32_t status = core.status;
  if (status == port::kNotRun) return "it never came back";
  const char* name = status_name(status);
  if (name == nullptr) return "status " + std::to_string(status);
  const std::string words = core.missing_effects != 0 ? words_of_missing_effects(core.missing_effects)
                                                      : words_of(static_cast<Status>(status));
  return words + " (" + name + ")";
}

void check_head(const ByteReader& reader, const FrameResult& frame) {
  reader.require(frame.version == port::kFrameJobVersion, offsetof(FrameResult, version),
                 "version " + std::to_string(frame.version) + " of frame results; this program knows version " +
                     std::to_string(port::kFrameJobVersion));
  reader.require(frame.core_count >= 1 && frame.core_count <= port::kMostBoardCores, offsetof(FrameResult, core_count),
                 "core_count is not 1 to 16");
  reader.require(frame.work_kinds == kWorkKindCount, offsetof(FrameResult, work_kinds),
                 "the firmware counts " + words_of_count(frame.work_kinds, "kind") + " of work, this program " +
                     std::to_string(kWorkKindCount) + ": they are of different versions");
  reader.require(frame.queue_depth <= kMostQueueDepth, offsetof(FrameResult, queue_depth),
                 "queue_depth is not 0 to " + std::to_string(kMostQueueDepth));
  reader.require(is_zero(frame.reserved), offsetof(FrameResult, reserved), "reserved is not 0");
}

// A device that reports a failed frame has not written a damaged file.
void check_statuses(const std::filesystem::path& path, const ByteReader& reader, const FrameResult& frame) {
  std::uint32_t first = 0;
  std::string message;
  for (std::uint32_t core = 0; core < frame.core_count; ++core) {
    const std::uint32_t status = frame.cores[core].status;
    if (status == 0) continue;
    if (first == 0) first = status;
    message += path.string() + ": core " + std::to_string(core) + ": " + words_of_status(frame.cores[core]) + "\n";
  }
  reader.require(frame.status == first, offsetof(FrameResult, status),
                 "the frame's status is " + std::to_string(frame.status) + ", the first of its cores that failed " +
                     std::to_string(first));
  if (first != 0) throw Failure(ExitCode::kCheckFailed, message + "the device's frame failed");
}

void check_cores(const ByteReader& reader, const OpenResult& result) {
  const FrameResult& frame = result.frame;
  std::vector<std::uint32_t> tiles(frame.core_count);
  for (std::uint32_t tile = 0; tile < result.tiles.size(); ++tile) {
    const std::uint32_t core = result.tiles[tile].core;
    const std::uint64_t place = sizeof(FrameResult) + std::uint64_t{tile} * sizeof(TileResult);
    reader.require(core != port::kNotRun, place, "no core claimed tile " + std::to_string(tile));
    reader.require(core < frame.core_count, place,
                   "tile " + std::to_string(tile) + " is of core " + std::to_string(core) + " of " +
                       std::to_string(frame.core_count));
    ++tiles[core];
  }
  for (std::uint32_t i = 0; i < port::kMostBoardCores; ++i) {
    const CoreResult& core = frame.cores[i];
    if (i >= frame.core_count) {
      constexpr CoreResult kNothing{};
      reader.require(std::memcmp(&core, &kNothing, sizeof core) == 0, place_of_core(i),
                     "core " + std::to_string(i) + " has a record, but there are " + std::to_string(frame.core_count));
      continue;
    }
    reader.require(core.tiles == tiles[i], place_of_core(i) + offsetof(CoreResult, tiles),
                   "core " + std::to_string(i) + " claimed " + words_of_count(core.tiles, "tile") +
                       ", by the tiles' own words " + std::to_string(tiles[i]));
    reader.require(core.missing_effects == 0, place_of_core(i) + offsetof(CoreResult, missing_effects),
                   "core " + std::to_string(i) + " was built without effects of the scene, and rendered it");
    reader.require(is_zero(std::span(core.work).subspan(kWorkKindCount)),
                   place_of_core(i) + offsetof(CoreResult, work) + kWorkKindCount * sizeof(std::uint32_t),
                   "core " + std::to_string(i) + " counts kinds of work that there are not");
  }
}

}  // namespace

OpenResult read_result_file(const std::filesystem::path& path, const OpenJob& open) {
  const port::FrameJob& job = open.job;
  OpenResult result;
  InputReader input(path, "expected the result of a job: the bytes that a device wrote");
  if (!starts_with_word(input.head(), port::kFrameResultMagic)) input.refuse_content();
  result.file = input.read_all();
  const std::span<const std::byte> file = result.file.bytes;
  const ByteReader reader(path, file);
  reader.require(file.size() == job.result_bytes, std::min<std::uint64_t>(file.size(), job.result_bytes),
                 words_of_count(file.size()) + " bytes; the job's result has " + words_of_count(job.result_bytes));
  result.frame = reader.read<FrameResult>(0);  // read_job_file has checked the space for it and the tiles
  check_head(reader, result.frame);
  check_statuses(path, reader, result.frame);
  result.tiles.reserve(job.tile_count);
  for (std::uint32_t tile = 0; tile < job.tile_count; ++tile) {
    result.tiles.push_back(reader.read<TileResult>(sizeof(FrameResult) + std::uint64_t{tile} * sizeof(TileResult)));
  }
  check_cores(reader, result);
  const auto plane = [&](std::uint64_t address) {
    return address == 0 ? std::span<const std::byte>{} : file.subspan(address - job.result_address, job.plane_bytes);
  };
  result.color = plane(job.color_address);
  result.depth = plane(job.depth_address);
  result.ids = plane(job.ids_address);
  return result;
}

}  // namespace gridiron::tool
