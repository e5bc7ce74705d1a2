// Job files. SPDX-License-Identifier: Apache-2.0
#include "job_file.h"

#include <gridiron/base/check_value.h>
#include <gridiron/base/math.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <string>

#include "base/failure.h"
#include "base/words.h"
#include "files/byte_reader.h"
#include "gridiron/scene/image_damage.h"

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

struct Part {
  std::uint64_t begin = 0, bytes = 0;
};

bool lies_in(const Part& part, const Part& whole) {
  return part.begin >= whole.begin && part.bytes <= whole.bytes && part.begin - whole.begin <= whole.bytes - part.bytes;
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
  reader.require(job.memory_bytes >= job.loaded_bytes &&
                     job.memory_bytes <= std::numeric_limits<std::uint64_t>::max() - job.base_address,
                 offsetof(FrameJob, memory_bytes), "memory_bytes is out of range");
  const auto is_whole = [&job] {
    for (const std::uint32_t word : job.reserved) {
      if (word != 0) return false;
    }
    return true;
  };
  reader.require(is_whole(), offsetof(FrameJob, reserved), "reserved is not 0");
  reader.require(find_store(job.store_bytes).has_value(), offsetof(FrameJob, store_bytes),
                 "store_bytes is not 64, 128, 256 or 512 KB");
}

// Results and spill memory lie after the loaded bytes, apart from one another.
void check_places(const ByteReader& reader, const FrameJob& job, const FrameRecord& record) {
  const Part behind{job.base_address + job.loaded_bytes, job.memory_bytes - job.loaded_bytes};
  const Part result{job.result_address, job.result_bytes};
  reader.require(result.begin % kLineBytes == 0 && lies_in(result, behind), offsetof(FrameJob, result_address),
                 "the result does not lie behind what is loaded, in front of memory_bytes");
  const std::uint64_t head_bytes = result_head_bytes(job.tile_count);
  reader.require(head_bytes <= result.bytes, offsetof(FrameJob, result_bytes),
                 "result_bytes does not hold the results of all tiles");
  const Part planes{result.begin + head_bytes, result.bytes - head_bytes};
  reader.require(job.plane_bytes == output_plane_bytes(job.width, job.height, job.tile_width),
                 offsetof(FrameJob, plane_bytes), "plane_bytes is not that of the picture");
  const struct {
    std::uint64_t address, in_record;
    std::size_t place;
    const char* name;
  } wanted[] = {{job.color_address, record.color_address, offsetof(FrameJob, color_address), "color_address"},
                {job.depth_address, record.depth_address, offsetof(FrameJob, depth_address), "depth_address"},
                {job.ids_address, record.id_address, offsetof(FrameJob, ids_address), "ids_address"}};
  std::uint64_t previous_end = 0;
  for (const auto& plane : wanted) {
    reader.require(plane.address == plane.in_record, plane.place,
                   std::string(plane.name) + " is not that of the frame record");
    if (plane.address == 0 && plane.place != offsetof(FrameJob, color_address)) continue;
    reader.require(plane.address % kLineBytes == 0 && lies_in({plane.address, job.plane_bytes}, planes) &&
                       plane.address >= previous_end,
                   plane.place, std::string(plane.name) + " does not lie in the result, behind what is there already");
    previous_end = plane.address + job.plane_bytes;
  }
  if (job.spill_address == 0) {
    reader.require(job.spill_bytes == 0 && job.spill_cores == 0, offsetof(FrameJob, spill_bytes),
                   "spill memory without an address");
    return;
  }
  reader.require(job.spill_cores >= 1 && job.spill_cores <= port::kMostBoardCores, offsetof(FrameJob, spill_cores),
                 "spill_cores is not 1 to 16");
  reader.require(job.spill_bytes % kSpillAlignment == 0 && job.spill_bytes <= behind.bytes / job.spill_cores,
                 offsetof(FrameJob, spill_bytes), "spill_bytes is out of range");
  const Part spill{job.spill_address, job.spill_bytes * job.spill_cores};
  const bool is_apart = spill.begin >= result.begin + result.bytes || spill.begin + spill.bytes <= result.begin;
  reader.require(spill.begin % kSpillAlignment == 0 && lies_in(spill, behind) && is_apart,
                 offsetof(FrameJob, spill_address),
                 "spill memory does not lie behind what is loaded, apart from the result");
}

void check_record(const ByteReader& reader, const FrameJob& job, const FrameRecord& record,
                  const SceneImageView& image) {
  const std::uint64_t place = job.frame_address - job.base_address;
  const auto require = [&](bool holds, std::size_t field, const char* reason) {
    reader.require(holds, place + field, reason);
  };
  require(record.magic == kFrameMagic && record.version == kFrameVersion, offsetof(FrameHead, magic),
          "no frame record of this version");
  const auto in_picture = [](std::uint32_t pixels) { return pixels >= 1 && pixels <= kMaxPictureWidth; };
  require(in_picture(record.width) && in_picture(record.height) && in_picture(record.tile_width),
          offsetof(FrameHead, width), "the picture's or the tiles' size is out of range");
  const auto tiles = [&record](std::uint32_t pixels) { return (pixels + record.tile_width - 1) / record.tile_width; };
  require(record.tiles_x == tiles(record.width) && record.tiles_y == tiles(record.height), offsetof(FrameHead, tiles_x),
          "the counts of tiles are not those of the picture");
  reader.require(job.width == record.width && job.height == record.height && job.tile_width == record.tile_width &&
                     job.tile_count == record.tiles_x * record.tiles_y,
                 offsetof(FrameJob, tile_count), "size or tiles are not those of the frame record");
  require(record.engine.macro_table_address == job.image_address + image.macro_table_offset_bytes &&
              record.engine.cell_blocks_address == job.image_address + image.cell_blocks_offset_bytes &&
              record.engine.triangles_address == job.image_address + image.triangles_offset_bytes,
          (sizeof(FrameHead) + offsetof(GridFrame, macro_table_address)),
          "the addresses are not those of the scene image's parts");
  require(std::memcmp(&record.engine.grid, &image.grid, sizeof record.engine.grid) == 0,
          (sizeof(FrameHead) + offsetof(GridFrame, grid)), "the grid is not that of the scene image");
  const bool is_scene = record.shading == static_cast<std::uint32_t>(Shading::kScene);
  require(!is_scene || image.has_effects, offsetof(FrameHead, shading), "the scene image has no effects");
  require(record.effects_address == (is_scene ? job.image_address + image.effects_offset_bytes : 0) &&
              record.image_address == (is_scene ? job.image_address : 0),
          offsetof(FrameHead, effects_address), "the addresses are not those of the scene image's effects");
  reader.require(job.effects == (is_scene ? image.effects.called_for : 0), offsetof(FrameJob, effects),
                 "effects are not those that the scene calls for");
}

// Everything but the check value.
void check_parts(const ByteReader& reader, OpenJob& open) {
  const FrameJob& job = open.job;
  const std::span<std::byte> file = open.file.bytes;
  check_head(reader, job);
  const Part loaded{job.base_address, job.loaded_bytes};
  const Part frame{job.frame_address, sizeof(FrameRecord)};
  const Part image{job.image_address, job.image_bytes};
  reader.require(frame.begin % kLineBytes == 0 && lies_in(frame, loaded), offsetof(FrameJob, frame_address),
                 "the frame record does not lie in the file");
  reader.require(image.begin % kLineBytes == 0 && lies_in(image, loaded), offsetof(FrameJob, image_address),
                 "the scene image does not lie in the file");
  const std::uint64_t image_place = image.begin - job.base_address;
  const std::span<std::byte> image_bytes = file.subspan(image_place, image.bytes);
  SceneImageError error;
  if (open_scene_image(image_bytes, open.image, error) != Status::kOk) {
    const ImageDamage damage = find_image_damage(image_bytes, error);
    reader.require(false, image_place + damage.byte_offset,
                   damage.reason + ", in the scene image that begins at byte " + std::to_string(image_place));
  }
  reader.require(open.image.header.image_bytes == job.image_bytes, offsetof(FrameJob, image_bytes),
                 "image_bytes is not that of the scene image");
  open.record = reader.read<FrameRecord>(frame.begin - job.base_address);
  check_record(reader, job, open.record, open.image);
  check_places(reader, job, open.record);
}

bool starts_with(std::span<const std::byte> bytes, std::uint32_t magic) {
  return bytes.size() >= sizeof(FrameJob::magic) && std::memcmp(bytes.data(), &magic, sizeof(FrameJob::magic)) == 0;
}

}  // namespace

std::vector<std::byte> make_job_file(FrameMemory& frame, const RenderPlan& plan, std::uint64_t base_address) {
  FrameJob job = plan_job(frame, plan);
  if (job.memory_bytes > std::numeric_limits<std::uint64_t>::max() - base_address) {
    throw Failure(ExitCode::kUsage, "--base: the job would end behind the last address");
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
  if (!starts_with(input.head(), port::kFrameJobMagic)) input.refuse_content();
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
  for (const sim::StoreSize store : sim::kStoreSizes) {
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
