// The rules of a frame. Set-up, simulator, firmware and kernel find faults with these functions alone.
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
  std::uint16_t place = 0;      ///< of the field, in bytes of the frame record
};

/// The limits of a checker that does not render. A renderer takes those of its layout, which have the same names.
struct AnyLayout {
  static constexpr std::uint32_t kLeastTileWidth = 1;
  static constexpr std::uint32_t kMostTileWidth = kMaxPictureWidth;
  static constexpr std::uint32_t kMaxOutputDepth = 0xFFFFFFFFu;
  static constexpr std::uint32_t kMaxWalkDepth = 0xFFFFFFFFu;
  static constexpr Status kBeyond = Status::kBadFrame;  ///< why a frame beyond these four is rejected
  // Of the grid. The rules of the image limit its sizes.
  static constexpr std::uint32_t kMaxMacroDepth = 0xFFFFFFFFu;
  static constexpr std::uint32_t kMaxTriangleDepth = 0xFFFFFFFFu;
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

/// @returns the first fault in the fields that every frame uses.
template <class Limits>
[[nodiscard]] constexpr FrameFault find_picture_fault(const FrameHead& frame) {
  constexpr Status kBad = Status::kBadFrame;
  if (frame.magic != kFrameMagic) return {kBad, offsetof(FrameHead, magic)};
  if (frame.version != kFrameVersion) return {kBad, offsetof(FrameHead, version)};
  if (!is_in_range(frame.width, 1, kMaxPictureWidth)) return {kBad, offsetof(FrameHead, width)};
  if (!is_in_range(frame.height, 1, kMaxPictureWidth)) return {kBad, offsetof(FrameHead, height)};
  if (!is_in_range(frame.tile_width, Limits::kLeastTileWidth, Limits::kMostTileWidth)) {
    return {Limits::kBeyond, offsetof(FrameHead, tile_width)};
  }
  if (frame.tiles_x != tiles_across(frame.width, frame.tile_width)) return {kBad, offsetof(FrameHead, tiles_x)};
  if (frame.tiles_y != tiles_across(frame.height, frame.tile_width)) return {kBad, offsetof(FrameHead, tiles_y)};
  if (!is_in_range(frame.output_depth, 1, Limits::kMaxOutputDepth)) {
    return {Limits::kBeyond, offsetof(FrameHead, output_depth)};
  }
  // As bits: above 0, infinity at most, no NaN.
  if (!is_in_range(std::bit_cast<std::uint32_t>(frame.t_far), 1, 0x7F800000u))
    return {kBad, offsetof(FrameHead, t_far)};
  if (frame.color_address == 0) return {kBad, offsetof(FrameHead, color_address)};
  if (frame.accuracy >= kAccuracyCount) return {Status::kUnsupportedFrame, offsetof(FrameHead, accuracy)};
  if (frame.shading > static_cast<std::uint32_t>(Shading::kScene)) {
    return {Status::kUnsupportedFrame, offsetof(FrameHead, shading)};
  }
  return {};
}

/// @returns the first fault in the fields of Shading::kScene. Precondition: find_picture_fault finds none.
template <class Limits>
[[nodiscard]] constexpr FrameFault find_scene_fault(const FrameHead& frame) {
  if (frame.shading != static_cast<std::uint32_t>(Shading::kScene)) return {};
  if (frame.effects_address == 0) return {Status::kBadFrame, offsetof(FrameHead, effects_address)};
  if (frame.image_address == 0) return {Status::kBadFrame, offsetof(FrameHead, image_address)};
  if (!is_in_range(frame.walk_depth, 1, Limits::kMaxWalkDepth)) {
    return {Limits::kBeyond, offsetof(FrameHead, walk_depth)};
  }
  if (accuracy_traits(frame.accuracy).has_scene_shading) return {};
  return {Status::kUnsupportedFrame, offsetof(FrameHead, accuracy)};
}

/// @returns the first fault of the grid's part of a frame. Precondition: no fault in its head.
template <class Limits>
[[nodiscard]] constexpr FrameFault find_grid_fault(const FrameRecord& frame) {
  constexpr std::uint16_t kEngine = sizeof(FrameHead);
  constexpr std::uint16_t kGrid = kEngine + offsetof(GridFrame, grid);
  const GridFrame& engine = frame.engine;
  if (!is_in_range(engine.macro_depth, 1, Limits::kMaxMacroDepth)) {
    return {Status::kUnsupportedFrame, kEngine + offsetof(GridFrame, macro_depth)};
  }
  if (!is_in_range(engine.triangle_depth, 1, Limits::kMaxTriangleDepth)) {
    return {Status::kUnsupportedFrame, kEngine + offsetof(GridFrame, triangle_depth)};
  }
  if (!reads_format(frame.accuracy, engine.grid.triangle_format)) {
    return {Status::kUnsupportedImage, offsetof(FrameHead, accuracy)};
  }
  if (!is_in_range(engine.grid.macro_width, 1, Limits::kMaxMacroWidth)) {
    return {Status::kUnsupportedImage, kGrid + offsetof(GridRecord, macro_width)};
  }
  if (engine.grid.cell_block_bytes > Limits::kMaxCellBlockBytes) {
    return {Status::kUnsupportedImage, kGrid + offsetof(GridRecord, cell_block_bytes)};
  }
  return {};
}

}  // namespace gridiron
