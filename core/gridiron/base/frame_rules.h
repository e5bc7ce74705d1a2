// The rules of a frame's fields, for set-up, simulator, firmware and kernel. What a layout of the kernel lacks (another
// engine, effects) is TileRenderer's; that addresses fit the memory is checked by set-up, simulator and firmware.
// Memory: none. Threads: any; integers only. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/accuracies.h>
#include <gridiron/base/records.h>
#include <gridiron/platform/contract.h>

#include <bit>
#include <cstddef>
#include <cstdint>

namespace gridiron {

/// The first rule that a frame breaks.
struct FrameFault {
  Status status = Status::kOk;  ///< why the frame is rejected
  std::uint16_t place = 0;      ///< offset of the field in the frame record, bytes
  const char* field = "";       ///< its name in that record
};

/// The limits of checkers that accept any layout. A renderer takes those of its layout, which have the same names.
struct AnyLayout {
  static constexpr std::uint32_t kLeastTileWidth = 1;
  static constexpr std::uint32_t kMostTileWidth = kMaxPictureWidth;
  static constexpr std::uint32_t kMaxOutputDepth = 0xFFFFFFFFu;
  static constexpr std::uint32_t kMaxFetchDepth = 0xFFFFFFFFu;
  static constexpr std::uint32_t kMaxMacroDepth = 0xFFFFFFFFu;
  static constexpr std::uint32_t kMaxTriangleDepth = 0xFFFFFFFFu;
  static constexpr Status kBeyond = Status::kBadFrame;  ///< why a frame beyond these is rejected
  // The rules of the image limit the grid's sizes.
  static constexpr std::uint32_t kMaxMacroWidth = 0xFFFFFFFFu;
  static constexpr std::uint32_t kMaxCellBlockBytes = 0xFFFFFFFFu;
};

[[nodiscard]] constexpr bool is_in_range(std::uint32_t value, std::uint32_t least, std::uint32_t most) {
  return value >= least && value <= most;
}

/// @returns tiles along an edge of a picture.
[[nodiscard]] constexpr std::uint32_t tiles_across(std::uint32_t pixels, std::uint32_t tile_width) {
  return (pixels + tile_width - 1) / tile_width;
}

// The functions below are inlined always, so that a kernel, which needs the status alone, holds no places and names.
#define GRIDIRON_FRAME_RULE(holds, status, base, record, member) \
  if (!(holds)) return FrameFault {                              \
      status, (base) + offsetof(record, member), #member         \
    }
#define GRIDIRON_HEAD_RULE(holds, status, member) GRIDIRON_FRAME_RULE(holds, status, 0, FrameHead, member)
#define GRIDIRON_ENGINE_RULE(holds, status, member) \
  GRIDIRON_FRAME_RULE(holds, status, sizeof(FrameHead), GridFrame, member)

/// @returns the first fault in the fields that every frame uses.
template <class Limits>
[[nodiscard, gnu::always_inline]] constexpr FrameFault find_picture_fault(const FrameHead& frame) {
  constexpr Status kBad = Status::kBadFrame, kBeyond = Limits::kBeyond;
  GRIDIRON_HEAD_RULE(frame.magic == kFrameMagic, kBad, magic);
  GRIDIRON_HEAD_RULE(frame.version == kFrameVersion, kBad, version);
  GRIDIRON_HEAD_RULE(is_in_range(frame.width, 1, kMaxPictureWidth), kBad, width);
  GRIDIRON_HEAD_RULE(is_in_range(frame.height, 1, kMaxPictureWidth), kBad, height);
  GRIDIRON_HEAD_RULE(is_in_range(frame.tile_width, Limits::kLeastTileWidth, Limits::kMostTileWidth), kBeyond,
                     tile_width);
  GRIDIRON_HEAD_RULE(frame.tiles_x == tiles_across(frame.width, frame.tile_width), kBad, tiles_x);
  GRIDIRON_HEAD_RULE(frame.tiles_y == tiles_across(frame.height, frame.tile_width), kBad, tiles_y);
  GRIDIRON_HEAD_RULE(is_in_range(frame.output_depth, 1, Limits::kMaxOutputDepth), kBeyond, output_depth);
  // As bits: above 0, infinity at most, no NaN.
  GRIDIRON_HEAD_RULE(is_in_range(std::bit_cast<std::uint32_t>(frame.t_far), 1, 0x7F800000u), kBad, t_far);
  GRIDIRON_HEAD_RULE(frame.color_address != 0, kBad, color_address);
  GRIDIRON_HEAD_RULE(frame.accuracy < kAccuracyCount, Status::kUnsupportedFrame, accuracy);
  GRIDIRON_HEAD_RULE(frame.shading <= static_cast<std::uint32_t>(Shading::kScene), Status::kUnsupportedFrame, shading);
  return {};
}

/// @returns the first fault in the fields of Shading::kScene. Precondition: find_picture_fault finds none.
template <class Limits>
[[nodiscard, gnu::always_inline]] constexpr FrameFault find_scene_fault(const FrameHead& frame) {
  if (frame.shading != static_cast<std::uint32_t>(Shading::kScene)) return {};
  GRIDIRON_HEAD_RULE(frame.effects_address != 0, Status::kBadFrame, effects_address);
  GRIDIRON_HEAD_RULE(frame.image_address != 0, Status::kBadFrame, image_address);
  GRIDIRON_HEAD_RULE(frame.tree_address != 0, Status::kBadFrame, tree_address);
  GRIDIRON_HEAD_RULE(is_in_range(frame.fetch_depth, 1, Limits::kMaxFetchDepth), Limits::kBeyond, fetch_depth);
  GRIDIRON_HEAD_RULE(accuracy_traits(frame.accuracy).has_scene_shading, Status::kUnsupportedFrame, accuracy);
  return {};
}

/// @returns the first fault in what the tree needs for eye rays. Precondition: find_picture_fault finds none.
template <class Limits>
[[nodiscard, gnu::always_inline]] constexpr FrameFault find_tree_fault(const FrameHead& frame) {
  GRIDIRON_HEAD_RULE(frame.image_address != 0, Status::kBadFrame, image_address);
  GRIDIRON_HEAD_RULE(frame.tree_address != 0, Status::kBadFrame, tree_address);
  GRIDIRON_HEAD_RULE(is_in_range(frame.fetch_depth, 1, Limits::kMaxFetchDepth), Limits::kBeyond, fetch_depth);
  return {};
}

/// @returns the first fault in the grid's part of a frame. Precondition: find_picture_fault finds none.
template <class Limits>
[[nodiscard, gnu::always_inline]] constexpr FrameFault find_grid_fault(const FrameRecord& frame) {
  constexpr Status kImage = Status::kUnsupportedImage;
  const GridFrame& engine = frame.engine;
  GRIDIRON_ENGINE_RULE(is_in_range(engine.macro_depth, 1, Limits::kMaxMacroDepth), Limits::kBeyond, macro_depth);
  GRIDIRON_ENGINE_RULE(is_in_range(engine.triangle_depth, 1, Limits::kMaxTriangleDepth), Limits::kBeyond,
                       triangle_depth);
  GRIDIRON_HEAD_RULE(reads_format(frame.accuracy, engine.grid.triangle_format), kImage, accuracy);
  GRIDIRON_ENGINE_RULE(is_in_range(engine.grid.macro_width, 1, Limits::kMaxMacroWidth), kImage, grid.macro_width);
  GRIDIRON_ENGINE_RULE(engine.grid.cell_block_bytes <= Limits::kMaxCellBlockBytes, kImage, grid.cell_block_bytes);
  return {};
}

#undef GRIDIRON_ENGINE_RULE
#undef GRIDIRON_HEAD_RULE
#undef GRIDIRON_FRAME_RULE

}  // namespace gridiron
