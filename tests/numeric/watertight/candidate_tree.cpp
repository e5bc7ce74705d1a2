// Candidates: see the header. SPDX-License-Identifier: Apache-2.0
#include "numeric/watertight/candidate_tree.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <numeric>
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
  [[nodiscard]] std::uint32_t touching(const Box& box, std::uint32_t mask) const {
    double to_low[3], to_high[3];
    for (int axis = 0; axis < 3; ++axis) {
      to_low[axis] = double{box.low[axis]} - origin[axis];
      to_high[axis] = double{box.high[axis]} - origin[axis];
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
    : order_(std::move(triangles)) {
  std::vector<Box> boxes(mesh.triangles.size());
  for (const std::uint32_t id : order_) {
    const UVec3& t = mesh.triangles[id];
    for (int axis = 0; axis < 3; ++axis) {
      const auto [low, high] =
          std::minmax({mesh.vertices[t.x][axis], mesh.vertices[t.y][axis], mesh.vertices[t.z][axis]});
      boxes[id].low[axis] = low;
      boxes[id].high[axis] = high;
    }
  }
  if (order_.empty()) return;
  nodes_.reserve(2 * order_.size());
  build(0, static_cast<std::uint32_t>(order_.size()), boxes);
  boxes_.reserve(order_.size());
  places_.resize(mesh.triangles.size());
  for (std::uint32_t i = 0; i < order_.size(); ++i) {
    boxes_.push_back(boxes[order_[i]]);
    places_[order_[i]] = i;
  }
}

std::uint32_t CandidateTree::build(std::uint32_t first, std::uint32_t count, const std::vector<Box>& boxes) {
  const auto node = static_cast<std::uint32_t>(nodes_.size());
  Box box = boxes[order_[first]];
  double low[3], high[3];  // of the middles, times 2
  const auto middle = [&](std::uint32_t id, int axis) {
    return double{boxes[id].low[axis]} + double{boxes[id].high[axis]};
  };
  for (int axis = 0; axis < 3; ++axis) low[axis] = high[axis] = middle(order_[first], axis);
  for (std::uint32_t i = first; i < first + count; ++i) {
    const Box& other = boxes[order_[i]];
    for (int axis = 0; axis < 3; ++axis) {
      box.low[axis] = std::min(box.low[axis], other.low[axis]);
      box.high[axis] = std::max(box.high[axis], other.high[axis]);
      low[axis] = std::min(low[axis], middle(order_[i], axis));
      high[axis] = std::max(high[axis], middle(order_[i], axis));
    }
  }
  nodes_.push_back({box, 0, first, count});
  if (count <= kLeafTriangles) return node;
  nodes_[node].count = 0;
  int axis = 0;
  for (int other = 1; other < 3; ++other) {
    if (high[other] - low[other] > high[axis] - low[axis]) axis = other;
  }
  const std::uint32_t half = count / 2;
  const auto begin = order_.begin() + first;
  std::nth_element(begin, begin + half, begin + count, [&](std::uint32_t a, std::uint32_t b) {
    return std::pair(middle(a, axis), a) < std::pair(middle(b, axis), b);
  });
  build(first, half, boxes);
  const std::uint32_t second = build(first + half, count - half, boxes);
  nodes_[node].second = second;
  return node;
}

template <class Touches, class Visit>
void CandidateTree::walk(std::uint32_t index, std::uint32_t mask, const Touches& touches, const Visit& visit) const {
  const Node& node = nodes_[index];
  const std::uint32_t touching = touches(node.box, mask);
  if (touching == 0) return;
  if (node.count == 0) {
    walk(index + 1, touching, touches, visit);
    walk(node.second, touching, touches, visit);
    return;
  }
  for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
    if (touches(boxes_[i], touching) != 0) visit(order_[i]);
  }
}

void CandidateTree::find(const watertight::Shot& shot, std::vector<std::uint32_t>& found) const {
  if (nodes_.empty()) return;
  const Rays rays(shot);
  walk(
      0, shot.active, [&](const Box& box, std::uint32_t mask) { return rays.touching(box, mask); },
      [&](std::uint32_t id) { found.push_back(id); });
}

void CandidateTree::find(const Vec3& point, std::vector<std::uint32_t>& found) const {
  if (nodes_.empty()) return;
  const auto holds = [&](const Box& box, std::uint32_t) {
    bool is_inside = true;
    for (int axis = 0; axis < 3; ++axis) {
      is_inside = is_inside && box.low[axis] <= point[axis] && point[axis] <= box.high[axis];
    }
    return is_inside ? 1u : 0u;
  };
  walk(0, 1u, holds, [&](std::uint32_t id) { found.push_back(id); });
}

}  // namespace gridiron::test
