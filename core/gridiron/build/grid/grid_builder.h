// Builds the scene image from a mesh, in memory of the caller: grid (macrocells, sorted triangle references), wide
// tree, effects. Source: Cho, Kim, Han 2012, sections 3.1 and 3.2. Memory: caller's. Threads: one, or those that share
// the work.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/records.h>
#include <gridiron/build/work_sharing.h>
#include <gridiron/platform/status.h>
#include <gridiron/scene/effects.h>
#include <gridiron/scene/mesh.h>

#include <cstddef>
#include <cstdint>
#include <span>

namespace gridiron {

/// Parameters of the grid and of the tree, and which of them an image holds. An image needs what the engines of its
/// frames read: GridEngine the grid, TileEngine and the rays of effects the tree.
struct GridParameters {
  float lambda = 4.0f;                                ///< cells per triangle, Eq. (1); 1e-6..1e6
  std::uint32_t macro_width = 6;                      ///< m; 1..kMaxMacroWidth
  TriangleFormat format = TriangleFormat::kVertices;  ///< how triangles are stored
  std::uint32_t leaf_triangles = 8;                   ///< of a leaf of the tree, at most; 1..kMaxTreeLeaf
  bool has_tree = false;                              ///< a tree without effects too, for EngineId::kTree
  bool has_grid = true;                               ///< false: the tree alone, for EngineId::kTree; needs the tree
};

/// What had to be cut to know which cells triangles touch.
struct CellCuts {
  std::uint64_t square_count;       ///< triangles in 2 x 2 cells
  std::uint64_t outline_count;      ///< outlines of larger ones
  std::uint64_t slab_count;         ///< slabs of outlines of two axes
  std::uint64_t polygon_count;      ///< slabs of outlines of three axes
  std::uint64_t polygon_row_count;  ///< rows of those
};

/// Steps of counting and building that a GridNeed does not imply otherwise; a cost model multiplies them.
struct GridSteps {
  std::uint32_t sweep_count;      ///< sweeps over all triangles that counting took, at least 1; building takes one more
  std::uint64_t swept_row_count;  ///< rows of cells that those sweeps met, as for_each_cell_row counts them
  std::uint64_t row_count;        ///< rows of cells that building will meet
  CellCuts swept_cuts;            ///< of those sweeps
  CellCuts cuts;                  ///< of building
};

/// What a scene image of a mesh will hold and need. All is exact, but image_bytes with a tree.
struct GridNeed {
  GridRecord grid;                       ///< as it will stand in the image; without a grid resolve_empty_grid's
  std::uint32_t dropped_triangle_count;  ///< zero-area triangles (decided exactly)
  std::uint64_t image_bytes;  ///< memory to build the image in, a multiple of kLineBytes: the size of an image without
                              ///< a tree. A tree's nodes, its end, are counted while they are built; then
                              ///< this has room for the most that so many triangles can have (most_tree_nodes), and
                              ///< the size is ImageHeader::image_bytes.
  std::uint64_t scratch_bytes;  ///< working memory of build_scene_image, free again afterwards; tree_scratch_bytes of
                                ///< all triangles, 0 without a tree
  GridSteps steps;              ///< for those who keep time; 0 without a grid
};

inline constexpr std::uint64_t kAnyImageBytes = ~std::uint64_t{0};  ///< for an image whose size has no limit

/// Counts what build_scene_image will need. Takes a fixed stack frame, and `marks` if given.
///
/// @param effects           of the scene; null: the image holds no effects, and a tree only if parameters.has_tree.
/// @param most_image_bytes  ends the count of an image that needs more.
/// @param marks             working memory, a bit for each macrocell; empty: 16,384 of them on the stack.
/// @param sharing           threads; a grid is counted by one.
/// Errors: kBadEffects (check_effects; a light farther from the grid than an eye may be), kBadVertex, kBadIndex,
/// kBadParameter (also effects or a tree with TriangleFormat::kProjection), kNoTriangles, kTooManyTriangles (with a
/// tree more than kMaxTreeTriangles too); kMemoryTooSmall: need.image_bytes is then more than most_image_bytes, but
/// less than the image would take. Cost: linear in triangles + references that fit, once for each part of the
/// macrocells that `marks` holds at a time.
[[nodiscard]] Status count_scene_image(const MeshView& mesh, const GridParameters& parameters, GridNeed& need,
                                       const EffectsView* effects = nullptr,
                                       std::uint64_t most_image_bytes = kAnyImageBytes,
                                       std::span<std::uint64_t> marks = {}, const WorkSharing& sharing = {});

/// Counts as count_scene_image does. A grid gets the greatest lambda of parameters.lambda, its half, its quarter and so
/// on whose image fits; need.grid.lambda is that lambda. If none fits, `need` describes the last one tried, 1e-6 or a
/// grid of one cell, and need.image_bytes is more than most_image_bytes; so it is without a grid.
///
/// Errors: as count_scene_image; kTooManyTriangles only if the last lambda has too many references.
/// Cost: one count for each lambda that a bound of its references does not rule out.
[[nodiscard]] Status fit_scene_image(const MeshView& mesh, const GridParameters& parameters,
                                     std::uint64_t most_image_bytes, GridNeed& need,
                                     const EffectsView* effects = nullptr, std::span<std::uint64_t> marks = {},
                                     const WorkSharing& sharing = {});

/// Writes the scene image. Same bytes for the same input on every host.
///
/// @param need     from count_scene_image with the same mesh, parameters and effects, or from fit_scene_image; then
///                 parameters.lambda is need.grid.lambda.
/// @param image    kLineBytes-aligned, at least need.image_bytes. The image takes the first ImageHeader::image_bytes of
///                 them; the others, if any, are free again.
/// @param scratch  8-byte aligned, at least need.scratch_bytes.
/// @param sharing  threads; a grid and the sections of effects are made by one.
/// Errors: kMemoryTooSmall (nothing is touched), kBadParameter. Cost: linear.
[[nodiscard]] Status build_scene_image(const MeshView& mesh, const GridParameters& parameters, const GridNeed& need,
                                       std::span<std::byte> image, std::span<std::byte> scratch,
                                       const EffectsView* effects = nullptr, const WorkSharing& sharing = {});

}  // namespace gridiron
