// Build work of the tree: see the header. SPDX-License-Identifier: Apache-2.0
#include <gridiron/build/mesh_quads.h>
#include <gridiron/build/tree/tree_box.h>
#include <gridiron/build/tree/tree_builder.h>
#include <gridiron/build/tree/tree_curve.h>
#include <gridiron/sim/tree_build_work.h>

#include <algorithm>
#include <vector>

namespace gridiron::sim {
namespace {

// As the builder sorts: digits, values of each, keys of a crowd that are sorted by small digits.
constexpr std::uint64_t kDigits = 3, kDigitValues = 1u << 10, kLargeDigits = 2, kLargeDigitValues = 1u << 15;
constexpr std::size_t kFewSortedKeys = 1024;

std::vector<TreeKey> keys_of(const MeshView& mesh) {
  std::vector<TreeKey> keys;
  QuadBox vertices;
  if (!bound_points(mesh.vertices, vertices)) return keys;
  const TreeCurve curve({vertices.low + vertices.low, vertices.high + vertices.high});
  keys.reserve(mesh.triangles.size());
  (void)for_each_four(mesh, [&](std::uint32_t first, const FourTriangles& triangles, std::uint32_t kept) {
    const Lanes<4>::Int codes = curve.codes_of(triangles.boxes());
    for (std::uint32_t lane = 0; lane < 4; ++lane) {
      if ((kept >> lane & 1u) == 0) continue;
      keys.push_back(TreeKey::of(static_cast<std::uint32_t>(codes[static_cast<int>(lane)]), first + lane));
    }
  });
  return keys;
}

// The boxes of up to four triangles.
FourBoxes boxes_of(const MeshView& mesh, std::span<const TreeKey> keys) {
  CornerQuads corners[4];
  for (std::size_t k = 0; k < 4; ++k)
    corners[k] = corners_of(mesh, mesh.triangles[keys[std::min(k, keys.size() - 1)].id()]);
  return FourTriangles::of(corners).boxes();
}

// Gives a crowd other codes on a lattice of its own. @returns false where all are in one place.
bool code_again(const MeshView& mesh, std::span<TreeKey> keys) {
  FourBoxes middles = FourBoxes::none();
  for (std::size_t i = 0; i < keys.size(); i += 4) {
    const FourBoxes boxes = boxes_of(mesh, keys.subspan(i));
    const QuadRows middle = {boxes.low.x + boxes.high.x, boxes.low.y + boxes.high.y, boxes.low.z + boxes.high.z};
    middles.add({middle, middle});
  }
  const TreeCurve curve(QuadBox::around(middles));
  if (curve.is_flat()) return false;
  for (std::size_t i = 0; i < keys.size(); i += 4) {
    const Lanes<4>::Int codes = curve.codes_of(boxes_of(mesh, keys.subspan(i)));
    for (std::size_t k = 0; k < 4 && i + k < keys.size(); ++k) {
      keys[i + k] = TreeKey::of(static_cast<std::uint32_t>(codes[static_cast<int>(k)]), keys[i + k].id());
    }
  }
  return true;
}

// Crowds among keys, and crowds among those that are coded again, which are fewer each time.
void add_crowds(const MeshView& mesh, std::span<TreeKey> all, std::uint32_t leaf_triangles, BuildWork& work) {
  std::vector<std::span<TreeKey>> open = {all};
  while (!open.empty()) {
    const std::span<TreeKey> keys = open.back();
    open.pop_back();
    std::ranges::sort(keys, {}, [](TreeKey key) { return std::uint64_t{key.code()} << 32 | key.id(); });
    for (std::size_t begin = 0, end = 0; begin < keys.size(); begin = end) {
      while (end < keys.size() && keys[end].code() == keys[begin].code()) ++end;
      const std::span<TreeKey> crowd = keys.subspan(begin, end - begin);
      if (crowd.size() <= leaf_triangles) continue;
      work.add(BuildStep::kTreeCrowd, 1);
      if (crowd.size() <= kFewTreeTriangles) continue;
      work.add(BuildStep::kTreeCrowdKey, crowd.size());
      if (!code_again(mesh, crowd)) continue;
      if (crowd.size() > kFewSortedKeys) work.add(BuildStep::kTreeDigitValue, kDigits * kDigitValues);
      open.push_back(crowd);
    }
  }
}

}  // namespace

BuildWork tree_build_work(const MeshView& mesh, const BuiltTree& tree, const MeshLines& lines) {
  BuildWork work;
  std::vector<TreeKey> keys = keys_of(mesh);
  const std::uint64_t kept = keys.size();
  work.add(BuildStep::kTreeOnce, 1);
  work.add(BuildStep::kTreeVertexBound, mesh.vertices.size());
  work.add(BuildStep::kTreeTriangleCode, mesh.triangles.size());
  // Keys that a large digit scatters over more memory than the cache has.
  std::uint64_t scattered_lines = 0;
  if (mesh.triangles.size() < kManyTreeTriangles) {
    work.add(BuildStep::kTreeDigitValue, kDigits * kDigitValues);
    work.add(BuildStep::kTreeKeySorted, kDigits * kept);
  } else {
    work.add(BuildStep::kTreeDigitValue, kLargeDigits * kLargeDigitValues);
    work.add(BuildStep::kTreeKeyScattered, kLargeDigits * kept);
    const std::uint64_t bytes = 2 * sizeof(TreeKey) * kept;
    scattered_lines = bytes > kCachedBytes ? kLargeDigits * kept * (bytes - kCachedBytes) / bytes : 0;
  }
  for (const TreeNode& node : tree.nodes) {
    const auto children = std::span(node.children).first(node.child_count);
    if (std::ranges::all_of(children, &TreeChild::is_leaf)) {
      work.add(BuildStep::kTreeLeafSplit, node.child_count);
    } else {
      work.add(BuildStep::kTreeNodeSplit, 1);
    }
  }
  add_crowds(mesh, keys, tree.leaf_triangles, work);
  work.add(BuildStep::kTreeTriangleWrite, kept);
  work.add(BuildStep::kTreeNodeWrite, tree.nodes.size());
  if (tree.order == TreeOrder::kForAnyHit) {
    work.add(BuildStep::kTreeTriangleArea, kept);
    work.add(BuildStep::kTreeNodeOrder, tree.nodes.size());
  }
  // Coding meets vertices as the mesh has them, writing meets all by their place in space.
  work.add(BuildStep::kTreeFarLine,
           lines.vertices_in_order + lines.triangles_in_space + lines.vertices_in_space + scattered_lines);
  return work;
}

BuildWork tree_image_work(const MeshView& mesh, const BuiltTree& tree, std::uint64_t image_bytes,
                          const MeshLines& lines) {
  BuildWork work = tree_build_work(mesh, tree, lines);
  work.add(BuildStep::kBuildOnce, 1);
  work.add(BuildStep::kTreeVertexBound, mesh.vertices.size());
  work.add(BuildStep::kTreeTriangleSurvey, mesh.triangles.size());
  work.add(BuildStep::kTreeCheckedLine, image_bytes / kLineBytes);
  work.add(BuildStep::kTreeSurveyFarLine, lines.vertices_in_order);
  return work;
}

}  // namespace gridiron::sim
