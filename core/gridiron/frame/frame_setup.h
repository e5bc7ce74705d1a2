// Prepares the FrameRecord of a frame: camera, outputs and the parts of the scene image.
// Memory: caller's. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/accuracies.h>
#include <gridiron/base/math.h>
#include <gridiron/base/records.h>
#include <gridiron/image/scene_image.h>
#include <gridiron/platform/contract.h>

#include <cstdint>

namespace gridiron {

/// A pinhole camera in world space. What make_frame_record() cannot make a view of is kBadFrame.
struct Camera {
  Vec3 eye{0, 0, 1};                 ///< where it stands, kCoordinateLimit at most on each axis
  Vec3 at{0, 0, 0};                  ///< what lies in the middle of the picture; another point than `eye`
  Vec3 up{0, 1, 0};                  ///< of any length but 0, not along the view
  float tan_half_fov = 0.41421356f;  ///< tangent of half the angle between the top and the bottom edge; > 0, finite
};

/// Output planes start at multiples of this, in bytes: transfers of their tiles are refused elsewhere.
inline constexpr std::uint32_t kPlaneAlignment = kPortableCongruenceBytes;

/// Everything of a frame that is not in the scene image. In brackets: what make_frame_record() says of anything else.
/// What a layout bounds is refused by its renderer instead, TileRenderer::run() [kUnsupportedFrame].
///
/// `color`, `depth` and `ids` are the output planes: main memory of the caller's that cores write and never read,
/// output_plane_bytes() each, at multiples of kPlaneAlignment [kTransferAlignment], apart from one another, from the
/// scene image and from the record. A plane has a word of 4 bytes for each pixel, tile by tile: whole tiles, row after
/// row of them from the top left, and in each the rows of its pixels from the top; output_plane_index() counts so.
/// Tiles at the right and lower edge are written whole: what lies beside the picture there means nothing.
struct FrameSettings {
  Camera camera;                 ///< in world space
  std::uint32_t width = 1024;    ///< pixels, 1..kMaxPictureWidth [kBadFrame]
  std::uint32_t height = 1024;   ///< likewise
  std::uint32_t tile_width = 32; ///< pixels along a tile's edge, above 0 [kBadFrame]; must be the store layout's
  Accuracy accuracy = Accuracy::kStandard;  ///< one that the image stores triangles for [kUnsupportedImage]
  /// kScene: of images with effects, and not with Accuracy::kPaper [kUnsupportedImage].
  Shading shading = Shading::kSimple;
  /// TechniqueBits; they change how much is done, not what is seen.
  std::uint32_t techniques = kUseMailbox | kUseCornerCulling | kUseEmptySkip;
  std::uint32_t output_depth = 2;    ///< tile buffers in rotation, 1 to the layout's kMaxOutputDepth
  std::uint32_t macro_depth = 2;     ///< cell blocks in rotation, 1 to the layout's kMaxMacroDepth
  std::uint32_t triangle_depth = 2;  ///< triangle buffers in rotation, 1 to the layout's kMaxTriangleDepth
  /// Walks of secondary rays under way at once, 1 or more [kBadFrame] to what the layout's engine has room for; of
  /// Shading::kScene.
  std::uint32_t walk_depth = 2;
  std::uint32_t background_rgba = 0xFF000000u;  ///< 0xAABBGGRR, where nothing is hit
  /// Hits farther away do not count; above 0 [kBadFrame], in units of the ray's direction, which has length 1 in the
  /// middle of the picture.
  float t_far = kFloatMax;
  MainAddress color{};  ///< plane of colours, 0xAABBGGRR; required: not 0 [kBadFrame]
  MainAddress depth{};  ///< plane of floats: world units along the ray, kFloatMax where nothing is hit; 0: not wanted
  MainAddress ids{};    ///< plane of triangle ids, kNoTriangle where nothing is hit; 0: not wanted
};

/// Bytes of one output plane (colour, depth or ids): 4 for each pixel of its whole tiles.
///
/// @param width, height  pixels of the picture.
/// @param tile_width     pixels along a tile's edge, above 0.
[[nodiscard]] std::uint64_t output_plane_bytes(std::uint32_t width, std::uint32_t height, std::uint32_t tile_width);

/// Index of pixel (x, y), y = 0 on top, in an output plane: in words of 4 bytes from its start.
[[nodiscard]] std::uint64_t output_plane_index(std::uint32_t width, std::uint32_t tile_width, std::uint32_t x,
                                               std::uint32_t y);

/// Fills what every engine reads of a frame, but for engine_id and for what frames of Shading::kScene have besides.
/// Errors: kBadFrame, kTransferAlignment, as below. `frame` is left alone then.
[[nodiscard]] Status make_frame_head(const FrameSettings& settings, FrameHead& frame);

/// Fills `frame` for the grid. The directions it describes have length between 1 and a few units, whatever the scale of
/// the camera.
///
/// @param image          as open_scene_image() opened it.
/// @param image_address  where `image` lies in main memory: a multiple of kLineBytes, of Shading::kScene not 0.
/// @param frame          for a multiple of kLineBytes in main memory; left alone where the frame is refused.
/// Errors: kBadFrame (size, t_far, walk_depth; no plane of colours; image at 0 of Shading::kScene; camera degenerate,
/// not finite or so far away that its place in cells exceeds kCellSpaceLimit), kTransferAlignment (a plane or the image
/// lies where transfers would be refused), kUnsupportedImage (accuracy needs another triangle format; Shading::kScene
/// an image with effects, and an accuracy other than kPaper). How much memory there is for planes is not seen here.
[[nodiscard]] Status make_frame_record(const FrameSettings& settings, const SceneImageView& image,
                                       MainAddress image_address, FrameRecord& frame);

}  // namespace gridiron
