// The rules of a job that need no board: the places of its parts, and its frame record against the job and the scene
// image. Used by the firmware and by the program that reads a job back. Memory: borrowed. Threads: any;
// integers only. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/effect_records.h>
#include <gridiron/base/frame_rules.h>
#include <gridiron/base/records.h>
#include <gridiron/firmware/frame_job.h>
#include <gridiron/image/scene_image.h>

#include <cstddef>
#include <cstdint>
#include <cstring>

#include "console.h"

namespace gridiron::port {

// Each function calls require(holds, place, pieces...) for every rule: `place` is the field's offset in the job, in
// bytes; print() takes the `pieces`. require returns `holds`, or throws if it is false.

/// A range of main memory.
struct Part {
  std::uint64_t begin, bytes;

  [[nodiscard]] constexpr bool holds(const Part& other) const {
    const std::uint64_t offset = other.begin - begin;
    return offset <= bytes && other.bytes <= bytes - offset;
  }
};

template <class Require>
[[nodiscard]] bool lies_in(const Part& whole, const char* whole_name, const char* what, const Part& part,
                           std::uint64_t alignment, std::size_t place, const Require& require) {
  return require(whole.holds(part), place, what, " at ", Hex{part.begin}, " of ", part.bytes, " bytes is ",
                 whole_name) &&
         require(part.begin % alignment == 0, place, what, " at ", Hex{part.begin}, " is not a multiple of ",
                 alignment);
}

/// Checks the parts of the file after the job itself: covered by its check value, and changed by no transfer.
template <class Require>
[[nodiscard]] bool check_loaded_parts(const FrameJob& job, const Require& require) {
  const bool is_size_ok =
      job.loaded_bytes <= job.memory_bytes && job.loaded_bytes >= sizeof job && job.loaded_bytes % 64 == 0;
  if (!require(is_size_ok, offsetof(FrameJob, memory_bytes), job.loaded_bytes, " loaded bytes of ", job.memory_bytes)) {
    return false;
  }
  std::uint32_t any = 0;
  for (const std::uint32_t word : job.reserved) any |= word;
  if (!require(any == 0, offsetof(FrameJob, reserved), "reserved words that are not 0")) return false;
  const Part loaded{job.base_address + sizeof job, job.loaded_bytes - sizeof job};
  constexpr const char* kOutside = "outside the job's file";
  return lies_in(loaded, kOutside, "frame record", {job.frame_address, sizeof(FrameRecord)}, kLineBytes,
                 offsetof(FrameJob, frame_address), require) &&
         lies_in(loaded, kOutside, "scene image", {job.image_address, job.image_bytes}, kLineBytes,
                 offsetof(FrameJob, image_address), require);
}

/// @param place  of the frame record in the job.
template <class Require>
[[nodiscard]] bool has_no(FrameFault fault, const FrameRecord& frame, std::uint64_t place, const Require& require) {
  std::uint32_t value = 0;
  std::memcpy(&value, reinterpret_cast<const std::byte*>(&frame) + fault.place, sizeof value);
  return require(fault.status == Status::kOk, place + fault.place, "frame record: ", fault.field, " ", Hex{value},
                 " at byte ", std::uint32_t{fault.place}, ": ", StatusNumber{static_cast<std::uint32_t>(fault.status)});
}

/// Requires a field of the frame record at `place` to have the value that job or scene image have for it.
#define GRIDIRON_FIELD_IS(value, wanted, record_place, name, whose)                                                    \
  require((value) == (wanted), place + (record_place), "frame record: " name " ", Hex{value}, ", the " whose "'s is ", \
          Hex{wanted})
#define GRIDIRON_HEAD_IS(member, wanted, whose) \
  GRIDIRON_FIELD_IS(frame.member, wanted, offsetof(FrameHead, member), #member, whose)
#define GRIDIRON_ENGINE_IS(member, wanted, whose) \
  GRIDIRON_FIELD_IS(frame.engine.member, wanted, sizeof(FrameHead) + offsetof(GridFrame, member), #member, whose)

/// Checks the frame record's head, and its picture against the job's.
template <class Require>
[[nodiscard]] bool check_picture(const FrameJob& job, const FrameRecord& frame, const Require& require) {
  const std::uint64_t place = job.frame_address - job.base_address;
  return GRIDIRON_HEAD_IS(width, job.width, "job") && GRIDIRON_HEAD_IS(height, job.height, "job") &&
         GRIDIRON_HEAD_IS(tile_width, job.tile_width, "job") &&
         GRIDIRON_HEAD_IS(color_address, job.color_address, "job") &&
         GRIDIRON_HEAD_IS(depth_address, job.depth_address, "job") &&
         GRIDIRON_HEAD_IS(id_address, job.ids_address, "job") &&
         require(frame.engine_id == static_cast<std::uint32_t>(EngineId::kGrid) ||
                     frame.engine_id == static_cast<std::uint32_t>(EngineId::kTree),
                 place + offsetof(FrameHead, engine_id), "frame record: engine_id ", frame.engine_id,
                 ", no engine of core") &&
         has_no(find_picture_fault<AnyLayout>(frame), frame, place, require) &&
         has_no(find_scene_fault<AnyLayout>(frame), frame, place, require) &&
         require(job.tile_count == frame.tiles_x * frame.tiles_y, offsetof(FrameJob, tile_count), job.tile_count,
                 " tiles, of ", frame.tiles_x, " x ", frame.tiles_y);
}

/// Checks the memory after the file, which transfers may change: the result with the planes in it, and apart from it
/// the memory for waiting rays. Precondition: check_picture.
template <class Require>
[[nodiscard]] bool check_open_parts(const FrameJob& job, const Require& require) {
  const Part open{job.base_address + job.loaded_bytes, job.memory_bytes - job.loaded_bytes};
  constexpr const char* kOutside = "outside the job's memory behind its file";
  const Part result{job.result_address, job.result_bytes};
  const std::uint64_t head = sizeof(FrameResult) + std::uint64_t{job.tile_count} * sizeof(TileResult);
  const std::uint64_t plane_bytes = std::uint64_t{job.tile_count} * job.tile_width * job.tile_width * 4;
  if (!require(job.plane_bytes == plane_bytes, offsetof(FrameJob, plane_bytes), "plane bytes ", Hex{job.plane_bytes},
               ", the picture's are ", Hex{plane_bytes}) ||
      !lies_in(open, kOutside, "result", result, kLineBytes, offsetof(FrameJob, result_address), require) ||
      !require(result.bytes >= head, offsetof(FrameJob, result_bytes), "result of ", result.bytes,
               " bytes, too small for its head")) {
    return false;
  }
  const struct {
    const char* name;
    std::uint64_t address;
    std::size_t place;
  } planes[] = {{"colour plane", job.color_address, offsetof(FrameJob, color_address)},
                {"depth plane", job.depth_address, offsetof(FrameJob, depth_address)},
                {"plane of ids", job.ids_address, offsetof(FrameJob, ids_address)}};
  Part free{result.begin + head, result.bytes - head};
  for (const auto& plane : planes) {
    if (plane.address == 0) continue;  // never the colours', by the frame's rules
    if (!lies_in(free, "outside the result, or on what is there", plane.name, {plane.address, plane_bytes}, kLineBytes,
                 plane.place, require)) {
      return false;
    }
    const std::uint64_t end = plane.address + plane_bytes;
    free = {end, free.begin + free.bytes - end};
  }

  const std::size_t spill_place = offsetof(FrameJob, spill_address);
  if (job.spill_address == 0) {
    return require((job.effects & (kReflection | kRefraction)) == 0, spill_place, "no memory for rays that wait") &&
           require(job.spill_bytes == 0 && job.spill_cores == 0, offsetof(FrameJob, spill_bytes),
                   "memory for waiting rays without an address");
  }
  const Part spill{job.spill_address, job.spill_bytes * job.spill_cores};
  return require(job.spill_cores >= 1 && job.spill_cores <= kMostBoardCores, offsetof(FrameJob, spill_cores),
                 "memory for waiting rays of ", job.spill_cores, " cores") &&
         require(job.spill_bytes <= open.bytes / job.spill_cores && job.spill_bytes % kSpillAlignment == 0,
                 offsetof(FrameJob, spill_bytes), "waiting rays of ", job.spill_bytes, " bytes a core") &&
         lies_in(open, kOutside, "memory for waiting rays", spill, kSpillAlignment, spill_place, require) &&
         require(spill.begin >= result.begin + result.bytes || spill.begin + spill.bytes <= result.begin, spill_place,
                 "memory for waiting rays at ", Hex{spill.begin}, " is on the result");
}

/// Checks the engine's part of the frame record against the scene image's head.
template <class Require>
[[nodiscard]] bool check_engine(const FrameJob& job, const FrameRecord& frame, const SceneImageView& image,
                                const Require& require) {
  const std::uint64_t place = job.frame_address - job.base_address;
  if (frame.engine_id == static_cast<std::uint32_t>(EngineId::kTree)) {
    return require(image.has_tree, place + offsetof(FrameHead, engine_id), "frame record: engine_id ", frame.engine_id,
                   ", the scene image has no tree") &&
           require(reads_format(frame.accuracy, image.tree.triangle_format), place + offsetof(FrameHead, accuracy),
                   "frame record: accuracy ", frame.accuracy, ", the tree's triangles are of format ",
                   image.tree.triangle_format) &&
           has_no(find_tree_fault<AnyLayout>(frame), frame, place, require);
  }
  const std::uint64_t base = job.image_address;
  const auto* const grid = reinterpret_cast<const std::byte*>(&frame.engine.grid);
  return require(image.has_grid, place + offsetof(FrameHead, engine_id), "frame record: engine_id ", frame.engine_id,
                 ", the scene image has no grid") &&
         // Bit for bit: no floating point here.
         require(std::memcmp(grid, reinterpret_cast<const std::byte*>(&image.grid), sizeof(GridRecord)) == 0,
                 place + sizeof(FrameHead) + offsetof(GridFrame, grid),
                 "frame record: the grid is not the scene image's") &&
         has_no(find_grid_fault<AnyLayout>(frame), frame, place, require) &&
         GRIDIRON_ENGINE_IS(macro_table_address, base + image.macro_table_offset_bytes, "scene image") &&
         GRIDIRON_ENGINE_IS(cell_blocks_address, base + image.cell_blocks_offset_bytes, "scene image") &&
         GRIDIRON_ENGINE_IS(triangles_address, base + image.triangles_offset_bytes, "scene image");
}

/// Checks the frame record against the scene image's head, which is right, and the job's effects against both.
template <class Require>
[[nodiscard]] bool check_scene(const FrameJob& job, const FrameRecord& frame, const SceneImageView& image,
                               const Require& require) {
  const std::uint64_t place = job.frame_address - job.base_address;
  const bool is_scene = frame.shading == static_cast<std::uint32_t>(Shading::kScene);
  const bool uses_tree = is_scene || frame.engine_id == static_cast<std::uint32_t>(EngineId::kTree);
  const std::uint32_t called_for = is_scene ? image.effects.called_for : 0;
  const std::uint64_t base = job.image_address;
  return require(image.header.image_bytes == job.image_bytes, offsetof(FrameJob, image_bytes),
                 "scene image: ", job.image_bytes, " bytes in the job, its header has ", image.header.image_bytes) &&
         check_engine(job, frame, image, require) &&
         require(!is_scene || image.has_effects, place + offsetof(FrameHead, shading), "frame record: shading ",
                 frame.shading, ", the scene image has no effects") &&
         require(job.effects == called_for, offsetof(FrameJob, effects), "effects ", Hex{job.effects},
                 ", frame record and scene image call for ", Hex{called_for}) &&
         GRIDIRON_HEAD_IS(effects_address, (is_scene ? base + image.effects_offset_bytes : 0), "scene image") &&
         GRIDIRON_HEAD_IS(image_address, (uses_tree ? base : 0), "scene image") &&
         GRIDIRON_HEAD_IS(tree_address, (uses_tree ? base + image.tree_offset_bytes : 0), "scene image");
}

#undef GRIDIRON_ENGINE_IS
#undef GRIDIRON_HEAD_IS
#undef GRIDIRON_FIELD_IS

}  // namespace gridiron::port
