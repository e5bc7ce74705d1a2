// Triangles of the reference: see the header. SPDX-License-Identifier: Apache-2.0
#include "effects/reference/reference_geometry.h"

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
double entry(const MedianTree::Node& box, const ReferenceRay& ray) {
  double enter = 0.0;
  double leave = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    if (ray.dir[axis] == 0.0) {
      if (ray.origin[axis] < box.low[axis] || ray.origin[axis] > box.high[axis]) return leave;
      continue;
    }
    const double a = (box.low[axis] - ray.origin[axis]) / ray.dir[axis];
    const double b = (box.high[axis] - ray.origin[axis]) / ray.dir[axis];
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
  const double margin = 1e-9 * size;
  std::vector<PlacedBox> boxes(triangles_.size());
  std::vector<std::uint32_t> places(triangles_.size());
  for (std::uint32_t i = 0; i < triangles_.size(); ++i) {
    const Triangle& triangle = triangles_[i];
    for (const glm::dvec3& v : triangle.v) {
      boxes[i].add(v - margin);
      boxes[i].add(v + margin);
      boxes[i].middle += v;
    }
    index_of_[triangle.id] = places[i] = i;
  }
  tree_ = MedianTree(boxes, std::move(places), /*leaf_count=*/4);
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
  const MedianTree::Node& node = tree_.nodes()[index];
  if (node.count == 0) {
    const double left = entry(tree_.nodes()[index + 1], ray);
    const double right = entry(tree_.nodes()[node.second], ray);
    const bool is_left_first = left <= right;
    const double far = is_left_first ? right : left;
    if (std::isfinite(std::min(left, right)) && std::min(left, right) <= ray.most_t &&
        !visit(is_left_first ? index + 1 : node.second, ray, take)) {
      return false;
    }
    // The nearer one may have brought the end nearer.
    return !std::isfinite(far) || far > ray.most_t || visit(is_left_first ? node.second : index + 1, ray, take);
  }
  for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
    if (!take(triangles_[tree_.order()[i]])) return false;
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
    if (!triangles_.empty()) visit(0, shortened, take);
  } else {
    for (const Triangle& triangle : triangles_) take(triangle);
  }
  return best;
}

bool ReferenceGeometry::is_any(const ReferenceRay& ray, ReferenceSearch search) const {
  const auto take = [&](const Triangle& triangle) { return !hit(triangle, ray); };
  if (search == ReferenceSearch::kBoxTree) {
    ReferenceRay asked = ray;
    return !triangles_.empty() && !visit(0, asked, take);
  }
  return !std::all_of(triangles_.begin(), triangles_.end(), take);
}

}  // namespace gridiron::test
