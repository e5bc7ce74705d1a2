// The sections of a scene image that hold the wide tree: their places and contents. Source: own; core/SPEC.md.
// Memory: caller's. Threads: one, or those that share the work. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/effect_records.h>
#include <gridiron/base/records.h>
#include <gridiron/base/tree_records.h>
#include <gridiron/build/lattice.h>
#include <gridiron/build/tree/tree_builder.h>
#include <gridiron/build/work_sharing.h>
#include <gridiron/platform/status.h>
#include <gridiron/scene/mesh.h>

#include <cstddef>
#include <cstdint>
#include <span>

namespace gridiron {

inline constexpr std::uint32_t kTreeSectionCount = 3;

/// The sections of one image's tree. Without one section_count is 0 and begin_bytes = end_bytes.
struct TreeSections {
  TreeRecord record;                        ///< placed: counts of triangles and offsets; written: complete
  SectionEntry entries[kTreeSectionCount];  ///< in the order in which they lie, without gaps, the nodes last
  std::uint32_t section_count;
  TreeOrder order;
  std::uint64_t begin_bytes, end_bytes;  ///< multiples of kLineBytes, from the image's first byte
};

/// Places the sections from begin_bytes, a multiple of kLineBytes, with room for the most nodes that so many triangles
/// can have.
///
/// @param format            of the records, kVertices or kLattice.
/// @param triangle_count    without dropped ones.
/// @param leaf_triangles    1..kMaxTreeLeaf.
/// @param order             kByNumber in an image without effects, which no ray for any hit is traced in.
[[nodiscard]] TreeSections place_tree_sections(TriangleFormat format, std::uint64_t triangle_count,
                                               std::uint32_t leaf_triangles, TreeOrder order,
                                               std::uint64_t begin_bytes);

/// Builds the tree in [begin_bytes, end_bytes) of the image. end_bytes, the last entry and the record then have the
/// real number of nodes.
///
/// @param mesh     the triangles as they are stored: a LatticeMesh if the format is kLattice.
/// @param scratch  8-byte aligned, at least tree_scratch_bytes() of the mesh's triangles.
/// @param sharing  threads, as of build_tree().
/// Errors: kBadParameter if the mesh is not the one that was counted; the sections' bytes are then undefined.
/// Cost: linear.
[[nodiscard]] Status write_tree_sections(const MeshView& mesh, std::span<std::byte> scratch, TreeSections& sections,
                                         std::byte* image, const WorkSharing& sharing);
[[nodiscard]] Status write_tree_sections(const LatticeMesh& mesh, std::span<std::byte> scratch, TreeSections& sections,
                                         std::byte* image, const WorkSharing& sharing);

/// Tells each surface where its triangle stands in the tree, so that a reader can check with no memory of its own that
/// each triangle is there once. Precondition: both kinds of sections are written. Cost: linear.
void link_surfaces(const TreeSections& sections, const EffectsRecord& effects, std::byte* image);

}  // namespace gridiron
