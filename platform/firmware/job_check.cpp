// Checks whether a firmware can run a job.
// Memory: reads the job. Threads: the master. SPDX-License-Identifier: Apache-2.0
#include "job_check.h"

#include <gridiron/base/check_value.h>
#include <gridiron/base/image_rules.h>

#include <cstddef>
#include <cstdint>

#include "job_rules.h"
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
  check.add({reinterpret_cast<const std::byte*>(&job) + sizeof head,
             static_cast<std::size_t>(job.loaded_bytes - sizeof head)});
  return check.value();
}

// A rule that does not hold is printed.
struct RefuseUnless {
  template <class... Pieces>
  bool operator()(bool holds, std::uint64_t, const Pieces&... reason) const {
    return holds || refuse(reason...);
  }
};

template <class Record>
const Record& record_at(std::uint64_t address) {
  return *reinterpret_cast<const Record*>(static_cast<std::uintptr_t>(address));
}

// The image of a job, for the rules of images. The job's check value has vouched for that of the image.
struct ImageReader {
  std::uint64_t address;

  template <class Record>
  [[nodiscard]] const Record& read(std::uint64_t offset) const {
    return record_at<Record>(address + offset);
  }
  [[nodiscard]] static bool require(bool holds, std::uint64_t offset, const char* field, std::uint64_t value) {
    return holds || refuse("scene image: ", field, " ", value, " at byte ", Hex{offset});
  }
  [[nodiscard]] static bool is_intact(const ImageHeader&) { return true; }
};

// Checks the fields that workers and transfers rely on. The contents of the image's sections are not checked: the board
// limits what they can cause.
bool check_record(const FrameJob& job) {
  constexpr RefuseUnless kRequire;
  const auto& frame = record_at<FrameRecord>(job.frame_address);
  const ImageReader checker{job.image_address};
  ImageHead head;
  if (!check_picture(job, frame, kRequire) || !check_open_parts(job, kRequire) ||
      !check_image_head(checker, job.image_bytes, head) || !check_scene(job, frame, view_of(head), kRequire)) {
    return false;
  }
  const std::uint32_t counted = counted_effects(head.effects);
  return (head.effects.called_for & kCountedEffects) == counted ||
         refuse("scene image: effects.called_for ", Hex{head.effects.called_for}, ", its counts call for ",
                Hex{counted});
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
  if (!check_loaded_parts(job, RefuseUnless{})) return false;
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
  if (job.tile_count > facts.most_tiles) {
    return refuse(job.tile_count, " tiles, this board can store the results of ", facts.most_tiles);
  }

  if (job.spill_address != 0 && job.spill_cores < facts.core_count) {
    return refuse("memory for waiting rays of ", job.spill_cores, " cores, this board has ", facts.core_count);
  }

  // 3. The frame record and the head of the scene image, which the workers use.
  if (!check_record(job)) return false;
  return is_equal("engine of eye rays", record_at<FrameRecord>(job.frame_address).engine_id, facts.engine);
}

}  // namespace gridiron::port
