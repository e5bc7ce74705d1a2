// A scene image that holds nothing but a tree which the cores build: its head, which the join pass writes, and the last
// pass, which finds the check values of the pieces of any image. What is left to the master: finish_built_image().
// Memory: the pass's store. Threads: one core. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/check_value.h>
#include <gridiron/base/records.h>
#include <gridiron/base/tree_records.h>
#include <gridiron/build/passes/build_plan.h>
#include <gridiron/build/passes/pass_tools.h>

#include <cstddef>
#include <span>

namespace gridiron {

/// What stands before the records, in the bytes of build_scene_image().
struct alignas(128) TreeImageHead {
  ImageHeader header;
  std::byte header_padding[kLineBytes - sizeof(ImageHeader)];
  SectionEntry entries[3];  // tree, triangles, nodes
  std::byte table_padding[kLineBytes - 3 * sizeof(SectionEntry)];
  TreeRecord tree;
};
static_assert(sizeof(TreeImageHead) == kTreeImageHeadBytes);

/// Makes the head of an image with the tree of a plan; its check value is 0.
inline void make_image_head(const BuildPlan& plan, const TreeSize& size, TreeImageHead& head) {
  constexpr std::uint64_t kRecordBytes = sizeof(VertexTriangle);
  constexpr auto entry = [](SectionKind kind, std::uint64_t element_bytes, std::uint64_t begin, std::uint64_t count) {
    return SectionEntry{static_cast<std::uint32_t>(kind), static_cast<std::uint32_t>(element_bytes), begin, count,
                        round_up<std::uint64_t>(element_bytes * count, kLineBytes)};
  };
  const std::uint64_t tree_place = offsetof(TreeImageHead, tree);
  const std::uint64_t nodes_place = nodes_of(plan, size.triangle_count).value - plan.input.image.value;
  head = {};
  head.entries[0] = entry(SectionKind::kTree, sizeof(TreeRecord), tree_place, 1);
  head.entries[1] = entry(SectionKind::kTreeTriangles, kRecordBytes, kTreeImageHeadBytes, size.triangle_count);
  head.entries[2] = entry(SectionKind::kTreeNodes, sizeof(TreeNode), nodes_place, size.node_count);
  ImageHeader& header = head.header;
  header.magic = kImageMagic;
  header.version = kImageVersion;
  header.image_bytes = nodes_place + head.entries[2].section_bytes;
  header.section_count = 3;
  header.section_table_offset_bytes = offsetof(TreeImageHead, entries);
  header.triangle_count = plan.input.triangle_count;
  header.vertex_count = plan.input.vertex_count;
  header.dropped_triangle_count = size.dropped_triangle_count;
  TreeRecord& tree = head.tree;
  tree.node_count = size.node_count;
  tree.triangle_count = size.triangle_count;
  tree.depth = size.depth;
  tree.leaf_triangles = plan.input.leaf_triangles;
  tree.triangle_format = static_cast<std::uint32_t>(TriangleFormat::kVertices);
  tree.triangle_bytes = kRecordBytes;
  tree.nodes_offset_bytes = nodes_place;
  tree.triangles_offset_bytes = kTreeImageHeadBytes;
  for (int axis = 0; axis < 3; ++axis) {
    tree.bounds_minimum[axis] = size.low[axis] + 0.0f;  // no negative zero
    tree.bounds_maximum[axis] = size.high[axis] + 0.0f;
  }
}

struct CheckStore {
  struct Line {
    std::byte bytes[kLineBytes];
  };
  static constexpr std::uint32_t kWindow = 16;  // lines
  static_assert(ImageCheckValue::kPieceBytes % (kWindow * kLineBytes) == 0);

  alignas(128) std::byte lines[2 * window_bytes<Line>(kWindow)];
  alignas(128) Line head;
  alignas(128) PieceCheck check[8];  // one, congruent with its place
};

/// Writes piece_checks. Items: pieces of the image, whose header says how many there are.
template <class P>
[[nodiscard]] Status run_check_pass(BuildTransfers<P>& transfers, CheckStore& store, const BuildPlan& plan) {
  using Line = CheckStore::Line;
  constexpr std::uint32_t kPieceLines = ImageCheckValue::kPieceBytes / kLineBytes;
  GRIDIRON_TRY(fetch(transfers, store.head, plan.input.image));
  const std::uint64_t line_count = reinterpret_cast<const ImageHeader*>(&store.head)->image_bytes / kLineBytes;
  const auto check_piece = [&](std::uint32_t piece) -> Status {
    const std::uint64_t first = std::uint64_t{piece} * kPieceLines;
    if (first >= line_count) return Status::kOk;
    CheckValue value;
    GRIDIRON_TRY((for_each_window<Line, CheckStore::kWindow>(
        transfers, store.lines, plan.input.image, first,
        first + kPieceLines < line_count ? first + kPieceLines : line_count, kFirstMacroTag,
        [&](const Line* lines, std::uint64_t, std::uint32_t count) {
          value.add({lines->bytes, static_cast<std::size_t>(count * kLineBytes)});
          transfers.add_work(CheckWork::kCheckedLine, count);
          return Status::kOk;
        })));
    PieceCheck& check = store.check[piece % 8];
    check = {value.value(), 0};
    GRIDIRON_TRY(transfers.put(&check, plan.piece_checks.offset_by(std::uint64_t{piece} * sizeof(PieceCheck)),
                               sizeof(PieceCheck), kFirstOutputTag));
    return transfers.wait(kFirstOutputTag);
  };
  return for_each_item(transfers, plan.item_counts[static_cast<std::uint32_t>(BuildPass::kCheck)], check_piece);
}

/// What the master does when the last pass has ended: gives the image its check value.
///
/// @param header        of the image, whose check value is 0.
/// @param piece_checks  that the check pass has written.
/// Errors: kBadImage if the header does not fit them.
[[nodiscard]] inline Status finish_built_image(std::span<const PieceCheck> piece_checks, ImageHeader& header) {
  constexpr std::uint64_t kBytes = ImageCheckValue::kPieceBytes;
  const std::uint64_t pieces = (header.image_bytes + kBytes - 1) / kBytes;
  if (pieces > piece_checks.size() || header.check_value != 0) return Status::kBadImage;
  ImageCheckValue check;
  for (const PieceCheck& piece : piece_checks.first(static_cast<std::size_t>(pieces))) check.add_piece(piece.value);
  header.check_value = check.value();
  return Status::kOk;
}

}  // namespace gridiron
