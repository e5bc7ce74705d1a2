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

/// A pinhole camera in world space. make_frame_record() returns kBadFrame if it gives no view.
struct Camera {
  Vec3 eye{0, 0, 1};                 ///< where it stands, kCoordinateLimit at most on each axis
  Vec3 at{0, 0, 0};                  ///< the point in the middle of the picture; not `eye`
  Vec3 up{0, 1, 0};                  ///< of any length but 0, not along the view
  float tan_half_fov = 0.41421356f;  ///< tangent of half the angle between the top and the bottom edge; > 0, finite
};

/// Output planes start at multiples of this, in bytes; elsewhere transfers of their tiles would be refused.
inline constexpr std::uint32_t kPlaneAlignment = kPortableCongruenceBytes;

/// Everything of a frame that is not in the scene image. In brackets: what make_frame_record() returns for any other
/// value. Values that exceed the layout are rejected by TileRenderer::run() instead [kUnsupportedFrame].
///
/// `color`, `depth` and `ids` are the output planes: main memory of the caller that cores write and never read. Each
/// has output_plane_bytes(), starts at a multiple of kPlaneAlignment [kTransferAlignment], and overlaps neither another
/// plane nor the scene image or the record. A plane has a word of 4 bytes for each pixel: whole tiles, row after row
/// from the top left, and in each tile its pixels row by row from the top; see output_plane_index(). Tiles at the right
/// and lower edge are written whole; their words outside of the picture have no meaning.
struct FrameSettings {
  Camera camera;                  ///< in world space
  std::uint32_t width = 1024;     ///< pixels, 1..kMaxPictureWidth [kBadFrame]
  std::uint32_t height = 1024;    ///< likewise
  std::uint32_t tile_width = 32;  ///< pixels along a tile's edge, 1..kMaxPictureWidth [kBadFrame]; must be the layout's
  /// An enumerator [kUnsupportedFrame] that the image stores triangles for [kUnsupportedImage].
  Accuracy accuracy = Accuracy::kStandard;
  /// An enumerator [kUnsupportedFrame]; kScene: of images with effects, and not with Accuracy::kPaper
  /// [kUnsupportedImage].
  Shading shading = Shading::kSimple;
  /// What traces eye rays [kUnsupportedFrame]. kGrid: of images with a grid, kTree: with a tree, in the accuracy's
  /// triangle format [kUnsupportedImage].
  EngineId engine = EngineId::kGrid;
  /// TechniqueBits; they change the amount of work, not the picture.
  std::uint32_t techniques = kUseMailbox | kUseCornerCulling | kUseEmptySkip;
  // Depths: from 1 [kBadFrame] to the layout's limit.
  std::uint32_t output_depth = 2;    ///< tile buffers in rotation, at most kMaxOutputDepth
  std::uint32_t macro_depth = 2;     ///< cell blocks in rotation, at most kMaxMacroDepth
  std::uint32_t triangle_depth = 2;  ///< triangle buffers in rotation, at most kMaxTriangleDepth
  /// Children of a tree's node, or records for shading, under way at once: at most the engines' kMaxDepth. Only for
  /// EngineId::kTree and Shading::kScene.
  std::uint32_t fetch_depth = 2;
  std::uint32_t background_rgba = 0xFF000000u;  ///< 0xAABBGGRR, where nothing is hit
  /// Hits farther away do not count. Above 0 [kBadFrame], in units of the ray's direction, which has length 1 in the
  /// middle of the picture.
  float t_far = kFloatMax;
  MainAddress color{};  ///< plane of colours, 0xAABBGGRR; required: not 0 [kBadFrame]
  MainAddress depth{};  ///< plane of floats: world units along the ray, kFloatMax without a hit; 0: not requested
  MainAddress ids{};    ///< plane of triangle ids, kNoTriangle without a hit; 0: not requested
};

/// Bytes of one output plane (colour, depth or ids): 4 for each pixel of its whole tiles.
///
/// @param width, height  pixels of the picture.
/// @param tile_width     pixels along a tile's edge, above 0.
[[nodiscard]] std::uint64_t output_plane_bytes(std::uint32_t width, std::uint32_t height, std::uint32_t tile_width);

/// Index of pixel (x, y), y = 0 on top, in an output plane: in words of 4 bytes from its start.
[[nodiscard]] std::uint64_t output_plane_index(std::uint32_t width, std::uint32_t tile_width, std::uint32_t x,
                                               std::uint32_t y);

/// Fills the head of a frame, but for engine_id and the fields that only Shading::kScene has.
/// Errors: kBadFrame, kUnsupportedFrame, kTransferAlignment, as below; `frame` is unchanged then.
[[nodiscard]] Status make_frame_head(const FrameSettings& settings, FrameHead& frame);

/// Fills `frame`. Its directions have length between 1 and a few units, whatever the scale of the camera.
///
/// @param image          as open_scene_image() opened it.
/// @param image_address  where `image` lies in main memory: a multiple of kLineBytes, of Shading::kScene not 0.
/// @param frame          to be copied to a multiple of kLineBytes in main memory; unchanged on an error.
/// Errors: kBadFrame (sizes, t_far, depths; no plane of colours; image at 0 with Shading::kScene; camera degenerate,
/// not finite or so far away that its place in cells exceeds kCellSpaceLimit), kTransferAlignment (a plane or the image
/// is misaligned), kUnsupportedFrame (unknown accuracy, shading or engine), kUnsupportedImage (the image lacks what
/// the engine reads; the accuracy requires another triangle format; Shading::kScene requires an image with effects, and
/// an accuracy other than kPaper). The size of the memory for planes is not checked here.
[[nodiscard]] Status make_frame_record(const FrameSettings& settings, const SceneImageView& image,
                                       MainAddress image_address, FrameRecord& frame);

}  // namespace gridiron
