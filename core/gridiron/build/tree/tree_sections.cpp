// Sections of the tree: see the header. SPDX-License-Identifier: Apache-2.0
#include <gridiron/base/math.h>
#include <gridiron/base/triangle_formats.h>
#include <gridiron/build/tree/tree_builder.h>
#include <gridiron/build/tree/tree_sections.h>

namespace gridiron {
namespace {

// Appends a section. @returns its offset.
std::uint64_t append(TreeSections& sections, SectionKind kind, std::uint64_t element_bytes,
                     std::uint64_t element_count) {
  const std::uint64_t begin = sections.end_bytes;
  const std::uint64_t bytes = round_up<std::uint64_t>(element_bytes * element_count, kLineBytes);
  sections.entries[sections.section_count++] = {static_cast<std::uint32_t>(kind),
                                                static_cast<std::uint32_t>(element_bytes), begin, element_count, bytes};
  sections.end_bytes = begin + bytes;
  return begin;
}

template <class Record, class Mesh>
Status write(const Mesh& mesh, std::span<std::byte> scratch, TreeSections& sections, std::byte* image,
             const WorkSharing& sharing) {
  TreeRecord& record = sections.record;
  SectionEntry& triangles = sections.entries[1];
  SectionEntry& nodes = sections.entries[2];
  TreeSize size{};
  const Status status = build_tree(
      mesh, record.leaf_triangles,
      {reinterpret_cast<Record*>(image + triangles.offset_bytes), std::size_t{record.triangle_count}},
      {reinterpret_cast<TreeNode*>(image + nodes.offset_bytes), static_cast<std::size_t>(nodes.element_count)}, scratch,
      size, sections.order, sharing);
  if (status != Status::kOk || size.triangle_count != record.triangle_count) return Status::kBadParameter;

  nodes.element_count = size.node_count;
  nodes.section_bytes = std::uint64_t{size.node_count} * sizeof(TreeNode);
  sections.end_bytes = nodes.offset_bytes + nodes.section_bytes;
  record.node_count = size.node_count;
  record.depth = size.depth;
  for (int axis = 0; axis < 3; ++axis) {
    record.bounds_minimum[axis] = size.low[axis] + 0.0f;  // no negative zero, as in the grid
    record.bounds_maximum[axis] = size.high[axis] + 0.0f;
  }
  __builtin_memcpy(image + sections.begin_bytes, &record, sizeof record);
  const std::uint64_t used = triangles.element_bytes * triangles.element_count;
  __builtin_memset(image + triangles.offset_bytes + used, 0, static_cast<std::size_t>(triangles.section_bytes - used));
  return Status::kOk;
}

}  // namespace

TreeSections place_tree_sections(TriangleFormat format, std::uint64_t triangle_count, std::uint32_t leaf_triangles,
                                 TreeOrder order, std::uint64_t begin_bytes) {
  TreeSections sections{};
  sections.order = order;
  sections.begin_bytes = begin_bytes;
  sections.end_bytes = begin_bytes;
  TreeRecord& record = sections.record;
  record.triangle_count = static_cast<std::uint32_t>(triangle_count);
  record.leaf_triangles = leaf_triangles;
  record.triangle_format = static_cast<std::uint32_t>(format);
  record.triangle_bytes = triangle_bytes_of(format);
  static_cast<void>(append(sections, SectionKind::kTree, sizeof(TreeRecord), 1));
  record.triangles_offset_bytes = append(sections, SectionKind::kTreeTriangles, record.triangle_bytes, triangle_count);
  record.nodes_offset_bytes =
      append(sections, SectionKind::kTreeNodes, sizeof(TreeNode), most_tree_nodes(triangle_count, leaf_triangles));
  return sections;
}

Status write_tree_sections(const MeshView& mesh, std::span<std::byte> scratch, TreeSections& sections, std::byte* image,
                           const WorkSharing& sharing) {
  return write<VertexTriangle>(mesh, scratch, sections, image, sharing);
}

Status write_tree_sections(const LatticeMesh& mesh, std::span<std::byte> scratch, TreeSections& sections,
                           std::byte* image, const WorkSharing& sharing) {
  sections.record.lattice = mesh.vertices.lattice;
  return write<LatticeTriangle>(mesh, scratch, sections, image, sharing);
}

void link_surfaces(const TreeSections& sections, const EffectsRecord& effects, std::byte* image) {
  const TreeRecord& record = sections.record;
  const std::byte* id_place = image + record.triangles_offset_bytes + record.triangle_bytes - sizeof(std::uint32_t);
  for (std::uint32_t place = 0; place < record.triangle_count; ++place) {
    std::uint32_t id;
    __builtin_memcpy(&id, id_place, sizeof id);
    std::byte* const surface = image + effects.surfaces_offset_bytes + std::uint64_t{id} * sizeof(SurfaceRecord);
    __builtin_memcpy(surface + offsetof(SurfaceRecord, tree_place), &place, sizeof place);
    id_place += record.triangle_bytes;
  }
}

}  // namespace gridiron
