// Candidates: see the header. SPDX-License-Identifier: Apache-2.0
#include "numeric/watertight/candidate_tree.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <utility>

namespace gridiron::test {
namespace {

constexpr std::uint32_t kLeafTriangles = 2;
constexpr double kTolerance = 0x1p-48;

}  // namespace

struct CandidateTree::Rays {
  double origin[3];
  double reciprocal[3][watertight::kShotRays];
  const watertight::Shot& shot;

  explicit Rays(const watertight::Shot& rays) : shot(rays) {
    for (int axis = 0; axis < 3; ++axis) {
      origin[axis] = double{rays.origin[axis]};
      for (std::uint32_t ray = 0; ray < watertight::kShotRays; ++ray) {
        const double component = double{rays.dir[axis][ray]};
        reciprocal[axis][ray] = component == 0.0 ? 0.0 : 1.0 / component;
      }
    }
  }

  // The rays of `mask` that touch a box.
  [[nodiscard]] std::uint32_t touching(const auto& box, std::uint32_t mask) const {
    double to_low[3], to_high[3];
    for (int axis = 0; axis < 3; ++axis) {
      to_low[axis] = box.low[axis] - origin[axis];
      to_high[axis] = box.high[axis] - origin[axis];
    }
    std::uint32_t result = 0;
    for (std::uint32_t rest = mask; rest != 0; rest &= rest - 1) {
      const auto ray = static_cast<std::uint32_t>(std::countr_zero(rest));
      double near = 0.0, far = std::numeric_limits<double>::infinity();
      bool is_beside = false;
      for (int axis = 0; axis < 3; ++axis) {
        const double r = reciprocal[axis][ray];
        if (r == 0.0) {
          is_beside = is_beside || to_low[axis] > 0.0 || to_high[axis] < 0.0;
          continue;
        }
        const double first = to_low[axis] * r, last = to_high[axis] * r;
        near = std::max(near, std::min(first, last));
        far = std::min(far, std::max(first, last));
      }
      if (!is_beside && near * (1.0 - kTolerance) <= far * (1.0 + kTolerance)) result |= 1u << ray;
    }
    return result;
  }
};

CandidateTree::CandidateTree(const MeshView& mesh, std::vector<std::uint32_t> triangles)
    : places_(mesh.triangles.size()), boxes_(mesh.triangles.size()) {
  for (const std::uint32_t id : triangles) {
    const UVec3& t = mesh.triangles[id];
    for (const std::uint32_t corner : {t.x, t.y, t.z}) boxes_[id].add(DVec3(mesh.vertices[corner]));
    boxes_[id].middle = boxes_[id].low + boxes_[id].high;
  }
  tree_ = MedianTree(boxes_, std::move(triangles), kLeafTriangles);
  for (std::uint32_t i = 0; i < order().size(); ++i) places_[order()[i]] = i;
}

template <class Touches, class Visit>
void CandidateTree::walk(std::uint32_t index, std::uint32_t mask, const Touches& touches, const Visit& visit) const {
  const MedianTree::Node& node = tree_.nodes()[index];
  const std::uint32_t touching = touches(node, mask);
  if (touching == 0) return;
  if (node.count == 0) {
    walk(index + 1, touching, touches, visit);
    walk(node.second, touching, touches, visit);
    return;
  }
  for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
    if (touches(boxes_[order()[i]], touching) != 0) visit(order()[i]);
  }
}

void CandidateTree::find(const watertight::Shot& shot, std::vector<std::uint32_t>& found) const {
  if (order().empty()) return;
  const Rays rays(shot);
  walk(
      0, shot.active, [&](const auto& box, std::uint32_t mask) { return rays.touching(box, mask); },
      [&](std::uint32_t id) { found.push_back(id); });
}

void CandidateTree::find(const Vec3& point, std::vector<std::uint32_t>& found) const {
  if (order().empty()) return;
  const auto holds = [&](const auto& box, std::uint32_t) {
    bool is_inside = true;
    for (int axis = 0; axis < 3; ++axis) {
      is_inside = is_inside && box.low[axis] <= point[axis] && point[axis] <= box.high[axis];
    }
    return is_inside ? 1u : 0u;
  };
  walk(0, 1u, holds, [&](std::uint32_t id) { found.push_back(id); });
}

}  // namespace gridiron::test
