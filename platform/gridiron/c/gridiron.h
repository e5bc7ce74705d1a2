// Gridiron for C: what a firmware calls, and the four functions that it defines for its chip. gridiron_c.cpp implements
// it over the kernel for one layout, which the firmware's build chooses; platform/README.md, "From C", says how.
// Memory: caller's, no heap. Threads: one core per store. C11 or C++20. SPDX-License-Identifier: Apache-2.0
#pragma once

// NOLINTBEGIN(modernize-deprecated-headers): the header is C
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
// NOLINTEND(modernize-deprecated-headers)

#ifdef __cplusplus
extern "C" {
#endif

/// Outcome of a call that can fail. Every value names one cause; kGridironOk is zero. The numbers are those of
/// gridiron::Status (gridiron/platform/status.h).
typedef enum GridironStatus {
  kGridironOk = 0,                  ///< no error
  kGridironTransferSize = 1,        ///< size is 0, above the limit, or not a multiple of the granule
  kGridironTransferAlignment = 2,   ///< an end is misaligned, or the two ends are not congruent
  kGridironTransferBoundary = 3,    ///< the main-memory side crosses a boundary
  kGridironTransferTag = 4,         ///< tag out of range
  kGridironTransferQueueFull = 5,   ///< more commands pending than the queue holds
  kGridironTransferLocalRange = 6,  ///< the local side is not inside the core's memory
  kGridironTransferMainRange = 7,   ///< the main-memory side is not inside memory that may be transferred
  kGridironTransferOverlap = 8,     ///< overlaps a pending transfer, at least one of the two writing
  kGridironTransferFailed = 9,      ///< the transfer was started and reported an error
  kGridironTransferTimedOut = 10,   ///< the transfer did not end within the port's bound
  kGridironTransferPending = 11,    ///< a transfer was never waited for (platforms that check)
  kGridironBadAccess = 12,          ///< a load or store touched bytes that it must not (platforms that check)
  kGridironBadFrame = 13,           ///< frame record or settings: wrong magic, version, size or range
  kGridironBadImage = 14,           ///< scene image: wrong magic, version, check value, offset or count
  kGridironUnsupportedImage = 15,   ///< the image is valid, but lacks what the layout or the accuracy reads
  kGridironUnsupportedFrame = 16,   ///< this layout was not built for such a frame
  kGridironAborted = 17,            ///< the frame was stopped between two tiles
  kGridironDeadline = 18,           ///< the frame's deadline passed between two tiles
  kGridironIncompleteFrame = 19,    ///< part of the picture was not written (platforms that check)
  kGridironMissingEffect = 20,      ///< the scene calls for effects that the layout was built without
  kGridironSpillTooSmall = 21,      ///< the memory for rays that wait is smaller than the scene requires
  kGridironMemoryTooSmall = 22,     ///< the caller's memory is smaller than the need; nothing was written
  kGridironTooManyTriangles = 23,   ///< more triangles or references than 32-bit counts can address
  kGridironNoTriangles = 24,        ///< the mesh has no triangle of non-zero area
  kGridironBadVertex = 25,          ///< a vertex coordinate is NaN, infinite or beyond +-2^120
  kGridironBadIndex = 26,           ///< a triangle names a vertex that does not exist
  kGridironBadParameter = 27,       ///< a parameter is outside its documented range, or a pointer is null or misaligned
  kGridironBadEffects = 28,         ///< a light, material, normal, texel or count is outside its documented range
} GridironStatus;

/// Limits of every transfer that the kernel starts; a port may rely on them.
enum {
  kGridironLineBytes = 128,               ///< alignment of store, image and frame record
  kGridironTransferGranuleBytes = 16,     ///< size and both addresses are multiples of this
  kGridironTransferCongruenceBytes = 32,  ///< both addresses are congruent modulo this
  kGridironTransferMostBytes = 4096,      ///< largest transfer
  kGridironTransferEdgeBytes = 4096,      ///< the main-memory side crosses no multiple of this
  kGridironTagCount = 32,                 ///< tags are 0..31
  kGridironPlaneAlignment = 32,           ///< of the planes of a picture
  kGridironSpillAlignment = 4096          ///< of the memory for rays that wait, and its size
};

// ---------------------------------------------------------------------------------------------------------------------
// What the firmware defines, by these names. platform/README.md has the rules of a transfer and the duties of a port.

/// Starts a copy from main to local memory. The destination is undefined until the wait.
///
/// @param core          the number that gridiron_render() was given.
/// @param local         destination, in the store; kGridironTransferGranuleBytes-aligned.
/// @param main_address  byte address in main memory, congruent with `local` modulo kGridironTransferCongruenceBytes.
/// @param bytes         16..kGridironTransferMostBytes, a multiple of 16.
/// @param tag           below kGridironTagCount; several pending transfers may share it.
/// @returns kGridironOk, or why nothing was started. gridiron_render() then ends with that status.
GridironStatus gridiron_dma_get(uint32_t core, void* local, uint64_t main_address, uint32_t bytes, uint32_t tag);

/// Starts a copy from local to main memory: the bytes stored before the call are sent. Parameters and errors as of
/// gridiron_dma_get(); the source does not change until the wait.
GridironStatus gridiron_dma_put(uint32_t core, const void* local, uint64_t main_address, uint32_t bytes, uint32_t tag);

/// Blocks until every transfer of the tags has ended, within a bound of the port's own; afterwards loads see the data.
///
/// @param tags  bit i: tag i. A tag without pending transfers ends at once.
/// @returns kGridironOk, kGridironTransferFailed or kGridironTransferTimedOut, once for each failed transfer.
GridironStatus gridiron_dma_wait(uint32_t core, uint32_t tags);

/// What a core has to do next.
typedef enum GridironClaim {
  kGridironClaimItem = 0,      ///< work on the item
  kGridironClaimNone = 1,      ///< no item is left
  kGridironClaimAborted = 2,   ///< the frame was asked to stop
  kGridironClaimDeadline = 3,  ///< the frame's deadline has passed
} GridironClaim;

/// Hands out the next tile of the frame. Each goes to exactly one core: an atomic increment where there are several.
///
/// @param item  written with kGridironClaimItem: 0..gridiron_tile_count() - 1, in any order. Another number, or none,
///              ends the frame with kGridironBadFrame. The kernel does not see whether all tiles are handed out.
/// @returns an enumerator. Any other value ends the frame with kGridironBadParameter.
GridironClaim gridiron_claim_item(uint32_t core, uint32_t* item);

// ---------------------------------------------------------------------------------------------------------------------
// Sizes of the layout that gridiron_c.cpp was compiled for.

/// The memory of a core, in bytes, and what its layout renders.
///
/// GRIDIRON_STORE_BYTES is `store_bytes` for a static array. The build defines it for firmware and gridiron_c.cpp, by
/// STORE_BYTES of gridiron_c_library() or -DGRIDIRON_STORE_BYTES=. gridiron_c.cpp does not compile with a number that
/// is not the layout's; the compiler's message has both. gridiron_render() cannot see the size of an array.
typedef struct GridironSizes {
  uint32_t store_bytes;         ///< local store, kGridironLineBytes-aligned, in the core's data memory
  uint32_t stack_budget_bytes;  ///< deepest stack of gridiron_render()
  uint32_t code_budget_bytes;   ///< most code and constants of it
  uint32_t arena_bytes;         ///< local memory that holds store and stack; with code_memory_bytes 0 code too
  uint32_t code_memory_bytes;   ///< memory of its own that holds the code; 0: code and data share one arena
  uint32_t frame_record_bytes;  ///< frame record, in main memory
  uint32_t tile_width;          ///< pixels along a tile's edge
  uint32_t effects;             ///< EffectBits that were built (gridiron/base/effect_records.h); 0: none
  bool has_grid_engine;         ///< eye rays go through the grid of an image, else through its tree
} GridironSizes;

/// @returns the sizes of the layout. Cost: constants.
GridironSizes gridiron_sizes(void);

// ---------------------------------------------------------------------------------------------------------------------
// Scene images.

/// Triangles in the caller's memory.
typedef struct GridironMesh {
  const float* vertices;    ///< [3 * vertex_count], x y z; finite, within +-2^120
  const uint32_t* indices;  ///< [3 * triangle_count], each below vertex_count
  uint32_t vertex_count;    ///< of `vertices`
  uint32_t triangle_count;  ///< of `indices`
} GridironMesh;

/// How triangles are stored in an image.
typedef enum GridironFormat {
  kGridironFormatVertices = 1,    ///< accuracies standard, exact, fast
  kGridironFormatProjection = 2,  ///< accuracy paper; images with a grid alone
  kGridironFormatLattice = 3,     ///< accuracy compact; half the bytes
} GridironFormat;

/// What to build. gridiron_usual_build() gives the layout's.
typedef struct GridironBuild {
  float lambda;             ///< cells of the grid for each triangle, 1e-6..1e6
  uint32_t macro_width;     ///< cells along the edge of a macrocell, at least 1, at most the layout's limit (mostly 6)
  GridironFormat format;    ///< an enumerator
  uint32_t leaf_triangles;  ///< of a leaf of the tree, 1..16, at most the layout's
  bool has_tree;            ///< build a tree
  bool has_grid;            ///< build a grid; one of the two is needed
} GridironBuild;

/// @returns what the layout reads: the tree alone, or the grid alone, with triangles as kGridironFormatVertices.
GridironBuild gridiron_usual_build(void);

/// What an image of a mesh needs.
typedef struct GridironNeed {
  uint64_t image_bytes;             ///< memory to build it in; with a tree an upper bound, else exact
  uint64_t scratch_bytes;           ///< working memory of the build, free again afterwards
  uint32_t dropped_triangle_count;  ///< triangles of zero area, decided exactly
  uint64_t internal[40];            ///< for gridiron_build_image()
} GridironNeed;

/// Counts what gridiron_build_image() will need.
///
/// @param mesh   not changed; read again by the build.
/// @param build  as gridiron_usual_build() gives it, or changed.
/// @param need   written on success.
/// Errors: kGridironBadVertex, kGridironBadIndex, kGridironBadParameter, kGridironNoTriangles,
/// kGridironTooManyTriangles. Cost: linear; 2 KB of stack besides the call's own, for a grid.
GridironStatus gridiron_count_image(const GridironMesh* mesh, const GridironBuild* build, GridironNeed* need);

/// Writes a scene image, the same bytes on every host.
///
/// @param need     of the same mesh and build.
/// @param image    kGridironLineBytes-aligned; the image takes the first GridironImage::image_bytes of it.
/// @param scratch  8-byte aligned.
/// Errors: kGridironMemoryTooSmall (image_bytes or scratch_bytes are less than the need; nothing is written),
/// kGridironBadParameter. Cost: linear.
GridironStatus gridiron_build_image(const GridironMesh* mesh, const GridironBuild* build, const GridironNeed* need,
                                    void* image, size_t image_bytes, void* scratch, size_t scratch_bytes);

/// An opened scene image.
typedef struct GridironImage {
  uint64_t image_bytes;     ///< its size, a multiple of kGridironLineBytes
  uint64_t spill_bytes;     ///< main memory for rays that wait, which each core needs; 0: none
  uint32_t triangle_count;  ///< of the scene
  uint32_t effects;         ///< EffectBits that the scene calls for; 0: none
  bool has_grid;            ///< it holds a grid, a tree or both
  bool has_tree;            ///< likewise
  uint64_t internal[112];   ///< for gridiron_make_frame()
} GridironImage;

/// What is wrong with an image, or with a frame.
typedef struct GridironFault {
  uint64_t byte_offset;  ///< place of the offending field in the image; in GridironFrame, or its size for a parameter
  const char* field;     ///< a constant: its name in core/SPEC.md, or of the member or parameter; "" without a fault
} GridironFault;

/// Checks every byte of an image that the kernel relies on, once for all frames.
///
/// @param bytes  kGridironLineBytes-aligned; may be longer than the image, never shorter.
/// @param image  written on success.
/// @param fault  written if not NULL.
/// Errors: kGridironBadImage, kGridironBadParameter (misaligned or NULL). Cost: linear in the image's size.
GridironStatus gridiron_open_image(const void* bytes, size_t byte_count, GridironImage* image, GridironFault* fault);

// ---------------------------------------------------------------------------------------------------------------------
// Frames.

/// How exactly hits are decided; core/README.md, "Accuracies".
typedef enum GridironAccuracy {
  kGridironAccuracyStandard = 0,  ///< the triangles of exact arithmetic
  kGridironAccuracyPaper = 1,     ///< of images in kGridironFormatProjection
  kGridironAccuracyExact = 2,     ///< of equal rounded distances the exact ones decide
  kGridironAccuracyFast = 3,      ///< floats alone
  kGridironAccuracyCompact = 4,   ///< of images in kGridironFormatLattice
} GridironAccuracy;

/// What a pixel shows.
typedef enum GridironShading {
  kGridironShadingNone = 0,    ///< hit or background
  kGridironShadingSimple = 1,  ///< facing ratio with the geometric normal
  kGridironShadingScene = 2,   ///< lights and materials of the image; layouts with effects
} GridironShading;

/// A frame. gridiron_usual_frame() gives the rest of what camera and planes leave open. A plane has a word of 4 bytes
/// for each pixel, tile by tile (gridiron_plane_index()). Planes and image do not overlap, which gridiron_make_frame()
/// checks. They do not overlap record, store and memory for waiting rays either. That is not checked: their places are
/// not known then.
typedef struct GridironFrame {
  float eye[3];               ///< where the camera stands, in world space
  float at[3];                ///< the point in the middle of the picture; not `eye`
  float up[3];                ///< not along the view
  float tan_half_fov;         ///< tangent of half the angle between the top and the bottom edge; above 0
  uint32_t width;             ///< pixels, 1..16384
  uint32_t height;            ///< likewise
  GridironAccuracy accuracy;  ///< an enumerator, for which the image stores triangles
  GridironShading shading;    ///< an enumerator
  uint32_t background_rgba;   ///< 0xAABBGGRR, where nothing is hit
  float t_far;                ///< hits farther away do not count; above 0
  uint32_t output_depth;      ///< tile buffers in rotation, from 1 to the layout's limit, 2
  uint32_t fetch_depth;       ///< nodes under way at once, from 1 to the layout's limit, 2 or more; not read by grids
  uint64_t color_address;     ///< main memory, plane of 0xAABBGGRR; required
  uint64_t depth_address;     ///< plane of floats, world units along the ray; 0: not requested
  uint64_t ids_address;       ///< plane of triangle numbers, 0xFFFFFFFF without a hit; 0: not requested
} GridironFrame;

/// @returns a frame of 64 x 64 pixels with simple shading, accuracy standard, a camera at (0, 0, 1) that looks at the
/// origin with 45 degrees, and no planes.
GridironFrame gridiron_usual_frame(void);

/// @returns bytes of one plane: 4 for each pixel of its whole tiles.
uint64_t gridiron_plane_bytes(uint32_t width, uint32_t height);

/// @returns index of pixel (x, y), y = 0 on top, in a plane, in words of 4 bytes.
uint64_t gridiron_plane_index(uint32_t width, uint32_t x, uint32_t y);

/// @returns how many tiles a picture has.
uint32_t gridiron_tile_count(uint32_t width, uint32_t height);

/// Writes the record of a frame, which all cores read.
///
/// @param image          opened.
/// @param image_address  where it lies in main memory, a multiple of kGridironLineBytes and not 0.
/// @param record         GridironSizes::frame_record_bytes in main memory, kGridironLineBytes-aligned.
/// @param fault          written if not NULL: the first member of GridironFrame that is refused, with its offset there,
///                       or the parameter `frame`, `image`, `image_address` or `record`, with sizeof(GridironFrame).
/// Errors, after which the record is unchanged: kGridironBadFrame (sizes, t_far, a depth of 0, no plane of colours,
/// image_address 0; planes that overlap each other or the image, or end beyond the last address; a camera without a
/// view: eye and at alike, up along the view, a number that is not finite or beyond 2^120), kGridironTransferAlignment
/// (a plane or the image is misaligned), kGridironUnsupportedFrame (an unknown enumerator; a depth beyond the layout's
/// limit; what the layout does not trace), kGridironUnsupportedImage (the image lacks what the layout or the accuracy
/// reads, or exceeds the layout's sizes), kGridironMissingEffect (the layout was built without effects that shading or
/// image call for), kGridironBadParameter (NULL, or the record is misaligned).
///
/// Address 0 means "none" in a frame's record. Where main memory begins at 0, image and planes begin behind its first
/// line.
GridironStatus gridiron_make_frame(const GridironFrame* frame, const GridironImage* image, uint64_t image_address,
                                   void* record, GridironFault* fault);

/// Renders every tile that this core can claim. All cores of a frame make this call.
///
/// @param core            passed on to the functions that the firmware defines.
/// @param store           GridironSizes::store_bytes of the core's data memory, kGridironLineBytes-aligned.
/// @param record_address  of the frame's record in main memory.
/// @param spill_address   of this core's memory for rays that wait, kGridironSpillAlignment-aligned; 0: none.
/// @param spill_bytes     of it, at least GridironImage::spill_bytes.
/// Errors: before the first tile kGridironBadFrame, kGridironUnsupportedFrame, kGridironUnsupportedImage,
/// kGridironMissingEffect, kGridironSpillTooSmall, kGridironBadParameter; between tiles kGridironAborted,
/// kGridironDeadline; at any time what the firmware's functions return. After kGridironOk no transfer is pending; after
/// an error transfers may be, so gridiron_dma_wait(core, 0xFFFFFFFF) comes before store or planes are used again.
GridironStatus gridiron_render(uint32_t core, void* store, uint64_t record_address, uint64_t spill_address,
                               uint64_t spill_bytes);

/// Work of the last frame by kind, in the order of WorkId (gridiron/base/work_counters.h), for reports.
///
/// @param store  that gridiron_render() was given.
/// @param count  written: number of kinds.
/// @returns the counts, in the store.
const uint32_t* gridiron_work(const void* store, uint32_t* count);

/// Checks one transfer against the limits above: size, tag, alignment, boundary. For ports that do not trust the
/// kernel.
///
/// @returns kGridironOk or the first rule that is broken. Ranges, queue and overlap are the port's own to check.
GridironStatus gridiron_check_transfer(const void* local, uint64_t main_address, uint32_t bytes, uint32_t tag);

/// @returns an English sentence about a status, a constant; "unknown status" for any other number. Its texts are in the
/// image only if this is called.
const char* gridiron_status_text(GridironStatus status);

#ifdef __cplusplus
}
#endif
