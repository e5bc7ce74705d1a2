// Whether a firmware can do a job that it was given.
// Memory: reads the job. Threads: the master. SPDX-License-Identifier: Apache-2.0
#include "job_check.h"

#include <gridiron/base/check_value.h>
#include <gridiron/base/effect_records.h>
#include <gridiron/base/records.h>

#include <cstddef>
#include <cstdint>

#include "console.h"

namespace gridiron::port {

namespace {

template <class... Pieces>
bool refuse(const Pieces&... reason) {
  print("job refused: ", reason..., "\n");
  return false;
}

bool is_equal(const char* what, std::uint64_t value, std::uint64_t wanted) {
  return value == wanted || refuse(what, " ", Hex{value}, ", this firmware wants ", Hex{wanted});
}

// As the job's maker computes it, with the field itself taken as 0.
std::uint64_t check_value_of(const FrameJob& job) {
  FrameJob head = job;
  head.check_value = 0;
  CheckValue check;
  check.add({reinterpret_cast<const std::byte*>(&head), sizeof head});
  check.add({reinterpret_cast<const std::byte*>(&job) + sizeof head, job.loaded_bytes - sizeof head});
  return check.value();
}

// Whether [address, address + bytes) lies within the job's memory, behind the job itself.
bool is_inside(const FrameJob& job, const char* what, std::uint64_t address, std::uint64_t bytes,
               std::uint64_t alignment) {
  const std::uint64_t offset = address - job.base_address;
  const bool fits = offset >= sizeof(FrameJob) && offset <= job.memory_bytes && bytes <= job.memory_bytes - offset;
  if (!fits) return refuse(what, " at ", Hex{address}, " of ", bytes, " bytes is outside the job's memory");
  return address % alignment == 0 || refuse(what, " at ", Hex{address}, " is not a multiple of ", alignment);
}

bool is_plane_inside(const FrameJob& job, const char* what, std::uint64_t address) {
  if (!is_inside(job, what, address, job.plane_bytes, kLineBytes)) return false;
  const std::uint64_t header = sizeof(FrameResult) + std::uint64_t{job.tile_count} * sizeof(TileResult);
  const std::uint64_t offset = address - job.result_address;
  return (offset >= header && offset <= job.result_bytes && job.plane_bytes <= job.result_bytes - offset) ||
         refuse(what, " at ", Hex{address}, " is outside the result");
}

}  // namespace

bool check_job(const FrameJob& job, const FirmwareFacts& facts) {
  if (!is_equal("magic", job.magic, kFrameJobMagic) || !is_equal("version", job.version, kFrameJobVersion)) {
    return false;
  }
  // 1. Its place.
  const std::uint64_t here = reinterpret_cast<std::uintptr_t>(&job);
  if (!is_equal("base address", job.base_address, here)) return false;
  if (here >= facts.memory_end || job.memory_bytes > facts.memory_end - here) {
    return refuse(job.memory_bytes, " bytes from ", Hex{here}, " on, but main memory ends at ", Hex{facts.memory_end});
  }
  if (job.loaded_bytes > job.memory_bytes || job.loaded_bytes < sizeof job || job.loaded_bytes % 64 != 0) {
    return refuse(job.loaded_bytes, " loaded bytes of ", job.memory_bytes);
  }
  if (!is_equal("check value", check_value_of(job), job.check_value)) return false;

  // 2. What it is about.
  if (!is_equal("tile width", job.tile_width, facts.tile_width)) return false;
  if (job.store_bytes > facts.store_bytes) {
    return refuse("made for cores of ", job.store_bytes, " bytes, these have ", facts.store_bytes);
  }
  if (job.packet_width != facts.packet_width) {
    print("job made for packets of ", job.packet_width, ", these are of ", facts.packet_width, "\n");
  }
  const std::uint32_t missing = job.effects & ~facts.effects;
  if (missing != 0) return refuse("effects ", Hex{missing}, " are not built into this firmware");
  if (job.width == 0 || job.height == 0 || job.width > kMaxPictureWidth || job.height > kMaxPictureWidth) {
    return refuse("picture of ", job.width, " x ", job.height);
  }
  const std::uint32_t tiles_x = (job.width + job.tile_width - 1) / job.tile_width;
  const std::uint32_t tiles_y = (job.height + job.tile_width - 1) / job.tile_width;
  if (job.tile_count != tiles_x * tiles_y) return refuse(job.tile_count, " tiles, of ", tiles_x, " x ", tiles_y);
  if (job.tile_count > facts.most_tiles) {
    return refuse(job.tile_count, " tiles, this board has room for the results of ", facts.most_tiles);
  }

  // 3. Where its parts are.
  const std::uint64_t plane_bytes = std::uint64_t{job.tile_count} * job.tile_width * job.tile_width * 4;
  if (!is_equal("plane bytes", job.plane_bytes, plane_bytes)) return false;
  if (!is_inside(job, "frame record", job.frame_address, sizeof(FrameRecord), kLineBytes) ||
      !is_inside(job, "scene image", job.image_address, job.image_bytes, kLineBytes) ||
      !is_inside(job, "result", job.result_address, job.result_bytes, 64) ||
      !is_plane_inside(job, "colour plane", job.color_address) ||
      (job.depth_address != 0 && !is_plane_inside(job, "depth plane", job.depth_address)) ||
      (job.ids_address != 0 && !is_plane_inside(job, "plane of ids", job.ids_address))) {
    return false;
  }
  if (job.spill_address == 0) {
    const std::uint32_t waiting = job.effects & (kReflection | kRefraction);
    return waiting == 0 || refuse("no memory for rays that wait");
  }
  if (job.spill_cores < facts.core_count) {
    return refuse("memory for waiting rays of ", job.spill_cores, " cores, this board has ", facts.core_count);
  }
  if (job.spill_bytes > job.memory_bytes) return refuse("waiting rays of ", job.spill_bytes, " bytes a core");
  return is_inside(job, "memory for waiting rays", job.spill_address, job.spill_bytes * job.spill_cores,
                   kSpillAlignment);
}

}  // namespace gridiron::port
