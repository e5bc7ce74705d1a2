// Job files: the input of a device for one frame (platform/gridiron/firmware/frame_job.h), made and read back.
// Memory: owns the file's bytes. Threads: one. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/records.h>
#include <gridiron/firmware/frame_job.h>
#include <gridiron/image/scene_image.h>
#include <gridiron/sim/sim_chip.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "files/input_file.h"
#include "gridiron/frame/frame_memory.h"

namespace gridiron::tool {

/// Makes the job of a prepared frame, whose image moves into the file: the frame has none afterwards. Image and planes
/// have the same addresses as in the frame's own memory, modulo 4,096 bytes, so that transfers are split alike and all
/// counters equal those of `gridiron render`.
///
/// @param plan  the one that the frame was prepared with; each of its cores gets memory for rays that wait.
/// @param base_address  of the job on the device, a multiple of 4,096.
/// Errors: Failure (kUsage) if the address space ends before the job does.
[[nodiscard]] std::vector<std::byte> make_job_file(FrameMemory& frame, const RenderPlan& plan,
                                                   std::uint64_t base_address);

/// A job as read; all its parts lie below memory_bytes.
struct OpenJob {
  InputFile file;  ///< loaded_bytes
  port::FrameJob job{};
  FrameRecord record{};
  SceneImageView image{};

  /// The layout of the job.
  [[nodiscard]] sim::LayoutChoice layout() const;
};

/// Errors: Failure (kBadInput), `file:byte N: reason`.
[[nodiscard]] OpenJob read_job_file(const std::filesystem::path& path);

/// @returns the store with that many bytes, or nothing.
[[nodiscard]] std::optional<sim::StoreSize> find_store(std::uint32_t store_bytes);

/// @returns the check value of a job's bytes, its own field taken as 0.
/// @param file  a multiple of 64 bytes, a FrameJob and more.
[[nodiscard]] std::uint64_t job_check_value(std::span<const std::byte> file);

}  // namespace gridiron::tool
