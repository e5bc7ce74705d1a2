// Steps of counting and building a scene image with its grid or its tree, and a mark of where each begins in the code.
// Internal header. Memory: none. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace gridiron {

/// Steps that a machine's general core takes time for. A cost model has a price for each.
enum class GridStep : std::uint8_t {
  kBuildOnce,        ///< what is done once a build: checks of parameters, resolution, header and directory
  kVertexCheck,      ///< vertices checked for NaN and infinity
  kTriangleSurvey,   ///< triangles read: indices, zero area, bounds
  kCellBox,          ///< triangles swept: zero area, box of cells, once per sweep
  kCellRow,          ///< rows of cells met in all sweeps
  kSquareTest,       ///< of the triangles swept, those in a square of 2 x 2 cells: which of the four they touch
  kOutline,          ///< outlines of larger triangles prepared to be cut: one for two axes, two for three
  kSlabCut,          ///< slabs of one cell that such an outline was cut into, of two axes
  kPolygonCut,       ///< the same of three axes: the slab's part is a polygon
  kPolygonRow,       ///< rows of cells that such a polygon was cut into
  kReferenceInsert,  ///< references listed as (cell, triangle)
  kReferenceSort,    ///< references sorted by cell
  kTriangleWrite,    ///< triangle records written, one a reference
  kProjectionSetup,  ///< of these, records of the paper's projected form
  kCellSum,          ///< cells of blocks summed
  kMacroWord,        ///< words of the macrocell table
  kClearedLine,      ///< 128-byte lines of the image before its triangles, cleared and later added to the check value
  kCheckedLine,      ///< 128-byte lines of triangles added to the check value
  kLatticeSurvey,    ///< triangles read to find the lattice
  kLatticeBox,       ///< lattice: triangles moved to it, surveyed or swept
  kLatticeSort,      ///< lattice: references sorted by cell, in the cells' bounds
  kLatticeWrite,     ///< lattice: triangle records written
  kLatticeCellSum,   ///< lattice: cells of blocks summed
  kCount
};

/// The same of a tree and its image.
enum class TreeStep : std::uint8_t {
  kOnce = static_cast<std::uint8_t>(GridStep::kCount),  ///< what is done once a build
  kVertexBound,     ///< vertices bounded, once when an image is counted and once when its tree is built
  kTriangleSurvey,  ///< triangles read when an image is counted: indices, zero area, bounds
  kTriangleCode,    ///< triangles read: indices, zero area, bounds, code
  kDigitValue,      ///< values of digits of codes: the counts of each, cleared and summed
  kKeySorted,       ///< keys moved by a digit of 10 bits, three times each
  kKeyScattered,    ///< the same by one of 15 bits, twice each
  kLeafSplit,       ///< leaves of nodes that have leaves alone
  kNodeSplit,       ///< other nodes
  kCrowd,           ///< crowds: triangles of one code that a leaf does not hold
  kCrowdKey,        ///< of crowds of more than 32, triangles that are coded again and sorted
  kTriangleWrite,   ///< triangle records written
  kTriangleArea,    ///< the same, where children are ordered by their areas
  kNodeWrite,       ///< nodes written: boxes of their children
  kNodeOrder,       ///< the same, where children are ordered
  kCheckedLine,     ///< 128-byte lines of an image added to its check value
  kCount
};

/// The code behind it belongs to the step. It does nothing: a tool that prices the steps compiles the builder with a
/// header of its own in this one's place.
template <auto kStep>
constexpr void enter_step() {}

/// For arguments of templates: where steps are priced, code is compiled anew for each of them, else once.
template <auto kStep>
inline constexpr auto kPricedStep = TreeStep::kOnce;

}  // namespace gridiron
