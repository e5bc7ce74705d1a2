// Result files: the result of a device for a job (platform/gridiron/firmware/frame_job.h), read and checked.
// Memory: owns the file's bytes. Threads: one. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/firmware/frame_job.h>

#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

#include "files/input_file.h"
#include "job_file.h"

namespace gridiron::tool {

/// A frame that every core finished, with each tile claimed by one of them.
struct OpenResult {
  InputFile file;
  port::FrameResult frame{};
  std::vector<port::TileResult> tiles;           ///< index = tile id
  std::span<const std::byte> color, depth, ids;  ///< planes; depth, ids: empty if the job has none

  [[nodiscard]] std::span<const port::CoreResult> cores() const { return {frame.cores, frame.core_count}; }
};

/// Errors: Failure, kBadInput with `file:byte N: reason`, kCheckFailed if the device reports that the frame failed.
[[nodiscard]] OpenResult read_result_file(const std::filesystem::path& path, const OpenJob& job);

}  // namespace gridiron::tool
