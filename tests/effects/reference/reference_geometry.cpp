// Triangles of the reference: see the header. SPDX-License-Identifier: Apache-2.0
#include "effects/reference/reference_geometry.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace gridiron::test {
namespace {

// A few times the relative error of three products of sums of doubles.
constexpr double kRounding = 1e-15;

// Distances as kernels compare them, then ids.
bool is_nearer(const ReferenceHit& a, const ReferenceHit& b) {
  const float at = static_cast<float>(a.t);
  const float bt = static_cast<float>(b.t);
  return at != bt ? at < bt : a.id < b.id;
}

// Two distances that are the same float differ by less than this share of them.
constexpr double kFloatShare = 1e-6;

// @returns where the ray enters a box; infinity where it misses it by more than rounding.
double entry(const glm::dvec3& low, const glm::dvec3& high, const ReferenceRay& ray) {
  double enter = 0.0;
  double leave = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    if (ray.dir[axis] == 0.0) {
      if (ray.origin[axis] < low[axis] || ray.origin[axis] > high[axis]) return leave;
      continue;
    }
    const double a = (low[axis] - ray.origin[axis]) / ray.dir[axis];
    const double b = (high[axis] - ray.origin[axis]) / ray.dir[axis];
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  return enter > leave + 1e-9 * std::abs(leave) ? std::numeric_limits<double>::infinity() : enter;
}

}  // namespace

ReferenceGeometry::ReferenceGeometry(const tool::SceneGeometry& geometry)
    : index_of_(geometry.triangles.size(), kReferenceNoTriangle) {
  double size = 0.0;
  for (std::uint32_t id = 0; id < geometry.triangles.size(); ++id) {
    Triangle triangle{};
    triangle.id = id;
    for (int k = 0; k < 3; ++k) {
      triangle.v[k] = glm::dvec3(geometry.vertices[geometry.triangles[id][k]]);
      for (int axis = 0; axis < 3; ++axis) size = std::max(size, std::abs(triangle.v[k][axis]));
    }
    const glm::dvec3 area = glm::cross(triangle.v[1] - triangle.v[0], triangle.v[2] - triangle.v[0]);
    if (area == glm::dvec3(0.0)) continue;
    triangle.normal = area / glm::length(area);
    triangles_.push_back(triangle);
  }
  margin_ = 1e-9 * size;
  nodes_.reserve(2 * triangles_.size() + 1);
  if (!triangles_.empty()) make_node(0, static_cast<std::uint32_t>(triangles_.size()));
  for (std::uint32_t i = 0; i < triangles_.size(); ++i) index_of_[triangles_[i].id] = i;
}

std::uint32_t ReferenceGeometry::make_node(std::uint32_t first, std::uint32_t count) {
  constexpr std::uint32_t kLeafTriangles = 4;
  Node node{triangles_[first].v[0], triangles_[first].v[0], first, count};
  for (std::uint32_t i = first; i < first + count; ++i) {
    for (const glm::dvec3& v : triangles_[i].v) {
      node.low = glm::min(node.low, v);
      node.high = glm::max(node.high, v);
    }
  }
  const glm::dvec3 extent = node.high - node.low;
  node.low -= margin_;
  node.high += margin_;
  const auto index = static_cast<std::uint32_t>(nodes_.size());
  nodes_.push_back(node);
  if (count <= kLeafTriangles) return index;

  // Half of the triangles on either side, along the longest edge of the box.
  int axis = extent.x >= extent.y ? 0 : 1;
  if (extent.z > extent[axis]) axis = 2;
  const auto begin = triangles_.begin() + first;
  std::nth_element(begin, begin + count / 2, begin + count, [axis](const Triangle& a, const Triangle& b) {
    return a.v[0][axis] + a.v[1][axis] + a.v[2][axis] < b.v[0][axis] + b.v[1][axis] + b.v[2][axis];
  });
  const std::uint32_t left = make_node(first, count / 2);
  const std::uint32_t right = make_node(first + count / 2, count - count / 2);
  nodes_[index].left = left;
  nodes_[index].right = right;
  return index;
}

std::optional<ReferenceHit> ReferenceGeometry::hit(const Triangle& triangle, const ReferenceRay& ray) const {
  if (triangle.id == ray.skipped) return std::nullopt;
  glm::dvec3 seen[3];
  for (int k = 0; k < 3; ++k) seen[k] = triangle.v[k] - ray.origin;
  // Volumes spanned with the edges, twice over: of an edge taken the other way round exactly the negative. Around a
  // corner not even that keeps rays from slipping through, so what is outside by rounding counts as inside.
  double volume[3];
  for (int k = 0; k < 3; ++k) {
    const glm::dvec3 edge = triangle.v[(k + 2) % 3] - triangle.v[(k + 1) % 3];
    volume[k] = glm::dot(glm::cross(seen[(k + 1) % 3] + seen[(k + 2) % 3], edge), ray.dir);
  }
  const auto is_inside = [&volume] {
    return !(std::max({volume[0], volume[1], volume[2]}) > 0.0 && std::min({volume[0], volume[1], volume[2]}) < 0.0);
  };
  for (int k = 0; k < 3 && !is_inside(); ++k) {
    const double sizes = glm::length(seen[(k + 1) % 3] + seen[(k + 2) % 3]) * glm::length(ray.dir) *
                         glm::length(triangle.v[(k + 2) % 3] - triangle.v[(k + 1) % 3]);
    if (std::abs(volume[k]) <= kRounding * sizes) volume[k] = 0.0;
  }
  const double sum = volume[0] + volume[1] + volume[2];
  const double along = glm::dot(triangle.normal, ray.dir);
  if (!is_inside() || sum == 0.0 || along == 0.0) return std::nullopt;
  ReferenceHit result;
  result.id = triangle.id;
  result.t = glm::dot(triangle.normal, seen[0]) / along;
  if (!(result.t > ray.least_t) || !(result.t <= ray.most_t)) return std::nullopt;
  for (int k = 0; k < 3; ++k) result.weights[k] = volume[k] / sum;
  return result;
}

template <class Take>
bool ReferenceGeometry::visit(std::uint32_t index, ReferenceRay& ray, const Take& take) const {
  const Node& node = nodes_[index];
  if (node.left != 0) {
    const double left = entry(nodes_[node.left].low, nodes_[node.left].high, ray);
    const double right = entry(nodes_[node.right].low, nodes_[node.right].high, ray);
    const bool is_left_first = left <= right;
    const double far = is_left_first ? right : left;
    if (std::isfinite(std::min(left, right)) && std::min(left, right) <= ray.most_t &&
        !visit(is_left_first ? node.left : node.right, ray, take)) {
      return false;
    }
    // The nearer one may have brought the end nearer.
    return !std::isfinite(far) || far > ray.most_t || visit(is_left_first ? node.right : node.left, ray, take);
  }
  for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
    if (!take(triangles_[i])) return false;
  }
  return true;
}

std::optional<ReferenceHit> ReferenceGeometry::nearest(const ReferenceRay& ray, ReferenceSearch search) const {
  std::optional<ReferenceHit> best;
  ReferenceRay shortened = ray;
  const auto take = [&](const Triangle& triangle) {
    const std::optional<ReferenceHit> found = hit(triangle, ray);
    if (found && (!best || is_nearer(*found, *best))) {
      best = found;
      shortened.most_t = std::min(ray.most_t, found->t * (1.0 + kFloatShare));
    }
    return true;
  };
  if (search == ReferenceSearch::kBoxTree) {
    if (!nodes_.empty()) visit(0, shortened, take);
  } else {
    for (const Triangle& triangle : triangles_) take(triangle);
  }
  return best;
}

bool ReferenceGeometry::is_any(const ReferenceRay& ray, ReferenceSearch search) const {
  const auto take = [&](const Triangle& triangle) { return !hit(triangle, ray); };
  if (search == ReferenceSearch::kBoxTree) {
    ReferenceRay asked = ray;
    return !nodes_.empty() && !visit(0, asked, take);
  }
  return !std::all_of(triangles_.begin(), triangles_.end(), take);
}

}  // namespace gridiron::test
