// Checks whether a firmware can run a job.
// Memory: reads the job. Threads: the master. SPDX-License-Identifier: Apache-2.0
#include "job_check.h"

#include <gridiron/base/check_value.h>
#include <gridiron/base/effect_records.h>
#include <gridiron/base/records.h>

#include <cstddef>
#include <cstdint>

#include "record_check.h"
#include "refusal.h"

namespace gridiron::port {

namespace {

bool is_equal(const char* what, std::uint64_t value, std::uint64_t wanted) {
  return value == wanted || refuse(what, " ", Hex{value}, ", this firmware requires ", Hex{wanted});
}

// Computed as by the job's maker, with the field itself taken as 0.
std::uint64_t check_value_of(const FrameJob& job) {
  FrameJob head = job;
  head.check_value = 0;
  CheckValue check;
  check.add({reinterpret_cast<const std::byte*>(&head), sizeof head});
  check.add({reinterpret_cast<const std::byte*>(&job) + sizeof head, job.loaded_bytes - sizeof head});
  return check.value();
}

struct Part {
  std::uint64_t begin, bytes;

  [[nodiscard]] bool holds(const Part& other) const {
    const std::uint64_t offset = other.begin - begin;
    return offset <= bytes && other.bytes <= bytes - offset;
  }
};

// The file after the job itself: covered by its check value, and changed by no transfer.
Part loaded_part(const FrameJob& job) {
  return {job.base_address + sizeof(FrameJob), job.loaded_bytes - sizeof(FrameJob)};
}

// Memory after the file, which transfers may change.
Part open_part(const FrameJob& job) {
  return {job.base_address + job.loaded_bytes, job.memory_bytes - job.loaded_bytes};
}

bool lies_in(const Part& whole, const char* whole_name, const char* what, const Part& part, std::uint64_t alignment) {
  if (!whole.holds(part)) return refuse(what, " at ", Hex{part.begin}, " of ", part.bytes, " bytes is ", whole_name);
  return part.begin % alignment == 0 || refuse(what, " at ", Hex{part.begin}, " is not a multiple of ", alignment);
}

bool is_loaded(const FrameJob& job, const char* what, std::uint64_t address, std::uint64_t bytes) {
  return lies_in(loaded_part(job), "outside the job's file", what, {address, bytes}, kLineBytes);
}

bool is_open(const FrameJob& job, const char* what, const Part& part, std::uint64_t alignment) {
  return lies_in(open_part(job), "outside the job's memory behind its file", what, part, alignment);
}

// Planes must lie in the result, after what it holds already.
bool are_planes_in_result(const FrameJob& job) {
  const struct {
    const char* name;
    std::uint64_t address;
  } planes[] = {
      {"colour plane", job.color_address}, {"depth plane", job.depth_address}, {"plane of ids", job.ids_address}};
  const std::uint64_t head = sizeof(FrameResult) + std::uint64_t{job.tile_count} * sizeof(TileResult);
  if (job.result_bytes < head) return refuse("result of ", job.result_bytes, " bytes, too small for its head");
  Part free{job.result_address + head, job.result_bytes - head};
  for (const auto& plane : planes) {
    if (plane.address == 0 && &plane != planes) continue;
    if (!lies_in(free, "outside the result, or on what is there", plane.name, {plane.address, job.plane_bytes},
                 kLineBytes)) {
      return false;
    }
    const std::uint64_t end = plane.address + job.plane_bytes;
    free = {end, free.begin + free.bytes - end};
  }
  return true;
}

bool is_spill_apart(const FrameJob& job, const FirmwareFacts& facts) {
  if (job.spill_address == 0) {
    const std::uint32_t waiting = job.effects & (kReflection | kRefraction);
    return waiting == 0 || refuse("no memory for rays that wait");
  }
  if (job.spill_cores < facts.core_count) {
    return refuse("memory for waiting rays of ", job.spill_cores, " cores, this board has ", facts.core_count);
  }
  if (job.spill_bytes > job.memory_bytes || job.spill_bytes % kSpillAlignment != 0) {
    return refuse("waiting rays of ", job.spill_bytes, " bytes a core");
  }
  const Part spill{job.spill_address, job.spill_bytes * job.spill_cores};
  if (!is_open(job, "memory for waiting rays", spill, kSpillAlignment)) return false;
  const bool is_apart =
      spill.begin >= job.result_address + job.result_bytes || spill.begin + spill.bytes <= job.result_address;
  return is_apart || refuse("memory for waiting rays at ", Hex{spill.begin}, " is on the result");
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

  // 2. Its settings.
  if (!is_equal("tile width", job.tile_width, facts.tile_width)) return false;
  if (job.store_bytes > facts.store_bytes) {
    return refuse("made for cores of ", job.store_bytes, " bytes, these have ", facts.store_bytes);
  }
  if (job.packet_width != facts.packet_width) {
    print("job made for packets of ", job.packet_width, ", these are of ", facts.packet_width, "\n");
  }
  const std::uint32_t missing = job.effects & ~facts.effects;
  if (missing != 0) return refuse("effects ", EffectSet{missing}, " are not built into this firmware");
  if (job.width == 0 || job.height == 0 || job.width > kMaxPictureWidth || job.height > kMaxPictureWidth) {
    return refuse("picture of ", job.width, " x ", job.height);
  }
  const std::uint32_t tiles_x = (job.width + job.tile_width - 1) / job.tile_width;
  const std::uint32_t tiles_y = (job.height + job.tile_width - 1) / job.tile_width;
  if (job.tile_count != tiles_x * tiles_y) return refuse(job.tile_count, " tiles, of ", tiles_x, " x ", tiles_y);
  if (job.tile_count > facts.most_tiles) {
    return refuse(job.tile_count, " tiles, this board can store the results of ", facts.most_tiles);
  }

  // 3. The places of its parts.
  const std::uint64_t plane_bytes = std::uint64_t{job.tile_count} * job.tile_width * job.tile_width * 4;
  if (!is_equal("plane bytes", job.plane_bytes, plane_bytes)) return false;
  const Part result{job.result_address, job.result_bytes};
  if (!is_loaded(job, "frame record", job.frame_address, sizeof(FrameRecord)) ||
      !is_loaded(job, "scene image", job.image_address, job.image_bytes) ||
      !is_open(job, "result", result, kLineBytes) || !are_planes_in_result(job) || !is_spill_apart(job, facts)) {
    return false;
  }

  // 4. The frame record, which the workers use.
  return check_record(job);
}

}  // namespace gridiron::port
