// Prepares the FrameRecord of a frame: camera, outputs and the parts of the scene image.
// Memory: caller's. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/math.h>
#include <gridiron/base/records.h>
#include <gridiron/base/triangle_formats.h>
#include <gridiron/image/scene_image.h>
#include <gridiron/platform/contract.h>

#include <cstdint>

namespace gridiron {

/// A pinhole camera in world space.
struct Camera {
  Vec3 eye{0, 0, 1};                 ///< where it stands
  Vec3 at{0, 0, 0};                  ///< what lies in the middle of the picture
  Vec3 up{0, 1, 0};                  ///< of any length but 0, not along the view
  float tan_half_fov = 0.41421356f;  ///< tangent of half the angle between the top and the bottom edge; > 0
};

/// Everything of a frame that is not in the scene image.
struct FrameSettings {
  Camera camera;                       ///< in world space
  std::uint32_t width = 1024, height = 1024;  ///< pixels, 1..kMaxPictureWidth
  std::uint32_t tile_width = 32;       ///< must be the store layout's
  Accuracy accuracy = Accuracy::kStandard;  ///< one that the image stores triangles for
  Shading shading = Shading::kSimple;  ///< kScene: of images with effects
  /// TechniqueBits; they change how much is done, not what is seen.
  std::uint32_t techniques = kUseMailbox | kUseCornerCulling | kUseEmptySkip;
  std::uint32_t output_depth = 2, macro_depth = 2, triangle_depth = 2;  ///< buffers in rotation, at most the layout's
  std::uint32_t walk_depth = 2;        ///< walks of secondary rays under way at once, 1 or more; of Shading::kScene
  std::uint32_t background_rgba = 0xFF000000u;  ///< 0xAABBGGRR
  float t_far = kFloatMax;             ///< hits farther away do not count; in units of the ray's direction
  MainAddress color{}, depth{}, ids{}; ///< depth, ids: value 0 = not wanted
};

/// Bytes of one output plane (colour, depth or ids): tile-major, whole tiles.
[[nodiscard]] std::uint64_t output_plane_bytes(std::uint32_t width, std::uint32_t height, std::uint32_t tile_width);

/// Index of pixel (x, y), y = 0 on top, in an output plane.
[[nodiscard]] std::uint64_t output_plane_index(std::uint32_t width, std::uint32_t tile_width, std::uint32_t x,
                                               std::uint32_t y);

/// Fills `frame`. The directions it describes have length between 1 and a few units, whatever the scale of the camera.
///
/// @param image_address  where `image` lies in main memory, kLineBytes-aligned.
/// Errors: kBadFrame (size, camera degenerate, not finite or so far away that its place in cells exceeds
/// kCellSpaceLimit, t_far not above 0, walk_depth of Shading::kScene 0), kUnsupportedImage (accuracy needs
/// another triangle format; Shading::kScene an image with effects, and an accuracy other than kPaper).
[[nodiscard]] Status make_frame_record(const FrameSettings& settings, const SceneImageView& image,
                                       MainAddress image_address, FrameRecord& frame);

}  // namespace gridiron
