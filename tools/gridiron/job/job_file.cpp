// Job files. SPDX-License-Identifier: Apache-2.0
#include "job_file.h"

#include <gridiron/base/check_value.h>
#include <gridiron/base/math.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <sstream>
#include <string>

#include "base/failure.h"
#include "base/words.h"
#include "files/byte_reader.h"
#include "files/file_kind.h"
#include "gridiron/scene/image_damage.h"
#include "job_rules.h"

namespace gridiron::tool {
namespace {

using port::FrameJob;

// Transfers cross no multiple of it, and job and spill memory begin on one.
constexpr std::uint64_t kPageBytes = 4096;
static_assert(kPageBytes % kPortableBoundaryBytes == 0 && kPageBytes % kSpillAlignment == 0);
static_assert(kPageBytes % kLineBytes == 0 && kLineBytes % CheckValue::kGroupBytes == 0);
static_assert(kWorkKindCount <= port::kMostWorkKinds);

// FrameJob and FrameRecord share the first page; the image follows.
constexpr std::uint64_t kRecordOffset = 256;
static_assert(kRecordOffset >= sizeof(FrameJob) && kRecordOffset % kLineBytes == 0);
static_assert(kRecordOffset + sizeof(FrameRecord) <= kPageBytes);

std::uint64_t result_head_bytes(std::uint32_t tile_count) {
  return sizeof(port::FrameResult) + std::uint64_t{tile_count} * sizeof(port::TileResult);
}

// The offsets of a job's parts from its base.
FrameJob plan_job(const FrameMemory& frame, const RenderPlan& plan) {
  FrameJob job{};
  job.magic = port::kFrameJobMagic;
  job.version = port::kFrameJobVersion;
  job.frame_address = kRecordOffset;
  job.image_address = kPageBytes;
  job.image_bytes = frame.image.header.image_bytes;
  job.loaded_bytes = job.image_address + job.image_bytes;
  job.width = frame.record.width;
  job.height = frame.record.height;
  job.tile_width = frame.record.tile_width;
  job.tile_count = frame.record.tiles_x * frame.record.tiles_y;
  job.effects = frame.settings.shading == Shading::kScene ? frame.image.effects.called_for : 0;
  job.packet_width = plan.layout.packet_width;
  job.store_bytes = sim::arena_bytes(plan.layout.store);

  // The device's own stores and the planes share no page, so that they share no cache line.
  job.result_address = round_up(job.loaded_bytes, kPageBytes);
  const std::uint64_t head_end = round_up(job.result_address + result_head_bytes(job.tile_count), kPageBytes);
  const auto plane_address = [&](const sim::MemoryRegion& plane) {
    if (plane.bytes.empty()) return std::uint64_t{0};
    return head_end + frame.color.address.value % kPageBytes + (plane.address.value - frame.color.address.value);
  };
  job.plane_bytes = frame.color.bytes.size();
  job.color_address = plane_address(frame.color);
  job.depth_address = plane_address(frame.depth);
  job.ids_address = plane_address(frame.ids);
  const std::uint64_t end = std::max({job.color_address, job.depth_address, job.ids_address}) + job.plane_bytes;
  job.result_bytes = end - job.result_address;
  job.memory_bytes = round_up(end, kPageBytes);
  if (frame.spill_bytes_per_core != 0) {
    job.spill_address = job.memory_bytes;
    job.spill_bytes = frame.spill_bytes_per_core;
    job.spill_cores = plan.cores;
    job.memory_bytes += job.spill_bytes * job.spill_cores;
  }
  return job;
}

void move_job(FrameJob& job, std::uint64_t base_address) {
  job.base_address = base_address;
  for (std::uint64_t* address : {&job.frame_address, &job.image_address, &job.result_address}) *address += base_address;
  for (std::uint64_t* address : {&job.color_address, &job.depth_address, &job.ids_address, &job.spill_address}) {
    if (*address != 0) *address += base_address;
  }
}

FrameRecord make_record(const FrameMemory& frame, const FrameJob& job) {
  FrameSettings settings = frame.settings;
  settings.color = {job.color_address};
  settings.depth = {job.depth_address};
  settings.ids = {job.ids_address};
  FrameRecord record{};
  const Status status = make_frame_record(settings, frame.image, {job.image_address}, record);
  if (status != Status::kOk) throw Failure(ExitCode::kBadInput, words_of(status));  // it was made before
  return record;
}

// The pieces that the rules of a job have as their reason.
std::string words_of_piece(const char* piece) {
  return piece;
}
std::string words_of_piece(std::uint64_t number) {
  return std::to_string(number);
}
std::string words_of_piece(port::Hex number) {
  std::ostringstream words;
  words << "0x" << std::hex << number.value;
  return words.str();
}
std::string words_of_piece(port::StatusNumber number) {
  return words_of(static_cast<Status>(number.value));
}

void check_size(const ByteReader& reader, const FrameJob& job, std::span<const std::byte> file) {
  reader.require(job.version == port::kFrameJobVersion, offsetof(FrameJob, version),
                 "version " + std::to_string(job.version) + " of frame jobs; this program knows version " +
                     std::to_string(port::kFrameJobVersion));
  reader.require(
      job.loaded_bytes == file.size() && job.loaded_bytes % CheckValue::kGroupBytes == 0,
      offsetof(FrameJob, loaded_bytes),
      "loaded_bytes is " + words_of_count(job.loaded_bytes) + ", the file's size " + words_of_count(file.size()));
}

void check_head(const ByteReader& reader, const FrameJob& job) {
  reader.require(job.base_address % kPageBytes == 0, offsetof(FrameJob, base_address),
                 "base_address is no multiple of 4096");
  reader.require(job.memory_bytes <= std::numeric_limits<std::uint64_t>::max() - job.base_address,
                 offsetof(FrameJob, memory_bytes), "memory_bytes is out of range");
  reader.require(find_store(job.store_bytes).has_value(), offsetof(FrameJob, store_bytes),
                 "store_bytes is not 16, 64, 128, 256 or 512 KB");
}

// Everything but the check value.
void check_parts(const ByteReader& reader, OpenJob& open) {
  const FrameJob& job = open.job;
  const std::span<std::byte> file = open.file.bytes;
  check_head(reader, job);
  const auto require = [&reader](bool holds, std::uint64_t place, const auto&... pieces) {
    if (!holds) reader.require(false, place, (words_of_piece(pieces) + ...));
    return true;
  };
  static_cast<void>(check_loaded_parts(job, require));
  open.record = reader.read<FrameRecord>(job.frame_address - job.base_address);
  static_cast<void>(check_picture(job, open.record, require) && check_open_parts(job, require));
  const std::uint64_t image_place = job.image_address - job.base_address;
  const std::span<std::byte> image_bytes = file.subspan(image_place, job.image_bytes);
  SceneImageError error;
  if (open_scene_image(image_bytes, open.image, error) != Status::kOk) {
    const ImageDamage damage = find_image_damage(image_bytes, error);
    reader.require(false, image_place + damage.byte_offset,
                   damage.reason + ", in the scene image that begins at byte " + std::to_string(image_place));
  }
  static_cast<void>(check_scene(job, open.record, open.image, require));
}

}  // namespace

std::vector<std::byte> make_job_file(FrameMemory& frame, const RenderPlan& plan, std::uint64_t base_address) {
  FrameJob job = plan_job(frame, plan);
  if (job.memory_bytes > std::numeric_limits<std::uint64_t>::max() - base_address) {
    usage_error("--base: the job would end behind the last address");
  }
  move_job(job, base_address);
  const FrameRecord record = make_record(frame, job);

  std::vector<std::byte> file;
  file.reserve(job.loaded_bytes);
  file.resize(kPageBytes);
  append_moved(file, frame.memory.bytes_at(frame.image_address, job.image_bytes));
  const auto put = [&file](std::uint64_t place, const void* bytes, std::size_t count) {
    std::memcpy(file.data() + place, bytes, count);
  };
  put(0, &job, sizeof job);
  put(kRecordOffset, &record, sizeof record);
  job.check_value = job_check_value(file);
  put(0, &job, sizeof job);
  return file;
}

sim::LayoutChoice OpenJob::layout() const {
  return {*find_store(job.store_bytes), job.tile_width, job.packet_width,
          record.shading == static_cast<std::uint32_t>(Shading::kScene)};
}

OpenJob read_job_file(const std::filesystem::path& path) {
  OpenJob open;
  InputReader input(path, "expected a job, as 'gridiron job' makes it");
  if (!starts_with_word(input.head(), port::kFrameJobMagic)) input.refuse_content();
  open.file = input.read_all();
  const ByteReader reader(path, open.file.bytes);
  reader.require(open.file.bytes.size() >= sizeof(FrameJob), open.file.bytes.size(),
                 "the file ends inside its first record, which has " + words_of_count(sizeof(FrameJob), "byte"));
  open.job = reader.read<FrameJob>(0);
  check_size(reader, open.job, open.file.bytes);
  // A wrong check value only shows that something is wrong; the other checks may find the place.
  const bool is_damaged = open.job.check_value != job_check_value(open.file.bytes);
  try {
    check_parts(reader, open);
  } catch (const Failure& failure) {
    if (!is_damaged) throw;
    throw Failure(failure.code(), std::string(failure.what()) + "; the job's check_value differs too");
  }
  const std::uint64_t image_place = open.job.image_address - open.job.base_address;
  const std::uint64_t image_end = image_place + open.job.image_bytes;
  std::string places = "in front of byte " + std::to_string(image_place) + ", in the job's head or the frame record,";
  if (image_end < open.file.bytes.size()) places += " or from byte " + std::to_string(image_end) + " on";
  reader.require(!is_damaged, offsetof(FrameJob, check_value),
                 "check_value differs from that of the file's bytes: some number " + places +
                     " has changed, and no other check finds which");
  return open;
}

std::optional<sim::StoreSize> find_store(std::uint32_t store_bytes) {
  for (const sim::StoreSize store : sim::kEveryStoreSize) {
    if (sim::arena_bytes(store) == store_bytes) return store;
  }
  return std::nullopt;
}

std::uint64_t job_check_value(std::span<const std::byte> file) {
  std::vector<std::byte> head(file.begin(), file.begin() + sizeof(FrameJob));
  std::memset(head.data() + offsetof(FrameJob, check_value), 0, sizeof(FrameJob::check_value));
  CheckValue value;
  value.add(head);
  value.add(file.subspan(sizeof(FrameJob)));
  return value.value();
}

}  // namespace gridiron::tool
