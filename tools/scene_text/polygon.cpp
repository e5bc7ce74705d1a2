// Polygons. SPDX-License-Identifier: Apache-2.0
#include "scene_text/polygon.h"

#include <gridiron/base/exact_sum.h>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>

namespace gridiron::tool {
namespace {

// A corner, projected along the main axis of the normal, counter-clockwise.
struct Place {
  float x = 0, y = 0;
  friend bool operator==(const Place&, const Place&) = default;
};

// Sign of the area of a, b, c: +1 counter-clockwise. Exact.
int turn(const Place& a, const Place& b, const Place& c) {
  const double left = (double{a.x} - double{c.x}) * (double{b.y} - double{c.y});
  const double right = (double{a.y} - double{c.y}) * (double{b.x} - double{c.x});
  const double area = left - right;
  // Each factor and product has an error of at most half a unit, the difference too: 4 units of the sum are more than
  // enough.
  if (std::fabs(area) > 4 * DBL_EPSILON * (std::fabs(left) + std::fabs(right))) return area > 0 ? 1 : -1;
  ExactSum sum;
  sum.add_product(1, a.x, b.y, 1.0f);
  sum.add_product(-1, a.y, b.x, 1.0f);
  sum.add_product(1, b.x, c.y, 1.0f);
  sum.add_product(-1, b.y, c.x, 1.0f);
  sum.add_product(1, c.x, a.y, 1.0f);
  sum.add_product(-1, c.y, a.x, 1.0f);
  return sum.sign();
}

// How strictly other corners must stay out of an ear.
enum class Strictness : std::uint8_t { kBoundary, kInterior, kAnyConvex };

// The outline while ears are being cut off.
class Outline {
 public:
  Outline(std::vector<Place> places, std::vector<std::uint32_t> corners)
      : places_(std::move(places)), corners_(std::move(corners)) {}

  // Removes corners where the outline turns back on itself, and the repeated corners that this leaves.
  void remove_spikes() {
    std::size_t kept = 0;  // corners in a row that are no spikes
    for (std::size_t at = 0; corners_.size() > 2 && kept < corners_.size();) {
      if (place(at) == place(previous(at)) || is_spike(at)) {
        remove(at);
        at = at == 0 ? corners_.size() - 1 : at - 1;  // the corner before may be one now
        kept = 0;
      } else {
        at = following(at);
        ++kept;
      }
    }
  }

  // Cuts until nothing is left. @returns false if it gets stuck: the outline crosses itself.
  bool clip(std::vector<UVec3>& triangles) {
    Strictness strictness = Strictness::kBoundary;
    std::size_t at = 0, refused = 0;
    remove_spikes();
    if (corners_.size() < 3) return true;
    while (corners_.size() > 3) {
      if (is_ear(at, strictness)) {
        const std::size_t before = previous(at);
        triangles.emplace_back(corners_[before], corners_[at], corners_[following(at)]);
        remove(at);
        // Continues with the corner after the next one: fans around one corner make slivers.
        at = corners_.empty() ? 0 : (at + 1) % corners_.size();
        refused = 0;
        strictness = Strictness::kBoundary;
        continue;
      }
      at = following(at);
      if (++refused < corners_.size()) continue;
      refused = 0;
      if (strictness == Strictness::kBoundary) {
        strictness = Strictness::kInterior;
      } else if (remove_flat_corner()) {
        strictness = Strictness::kBoundary;
        at = 0;
      } else if (strictness == Strictness::kInterior) {
        // Triangles that all turn left add up to the outline's winding numbers: if these are 0 and 1, nothing overlaps,
        // in whatever order they are cut.
        strictness = Strictness::kAnyConvex;
      } else {
        return false;
      }
    }
    const int last = turn_at(1);
    if (last > 0) triangles.emplace_back(corners_[0], corners_[1], corners_[2]);
    return last >= 0;
  }

 private:
  [[nodiscard]] std::size_t previous(std::size_t at) const { return (at == 0 ? corners_.size() : at) - 1; }
  [[nodiscard]] std::size_t following(std::size_t at) const { return at + 1 == corners_.size() ? 0 : at + 1; }
  [[nodiscard]] const Place& place(std::size_t at) const { return places_[corners_[at]]; }
  [[nodiscard]] int turn_at(std::size_t at) const { return turn(place(previous(at)), place(at), place(following(at))); }

  void remove(std::size_t at) { corners_.erase(corners_.begin() + static_cast<std::ptrdiff_t>(at)); }

  // Removes a corner without area, if there is one: a spike, or a corner on the line of its neighbours.
  bool remove_flat_corner() {
    for (std::size_t at = 0; at < corners_.size(); ++at) {
      if (turn_at(at) == 0) {
        remove(at);
        return true;
      }
    }
    return false;
  }

  [[nodiscard]] bool is_spike(std::size_t at) const {
    const Place &a = place(previous(at)), &b = place(at), &c = place(following(at));
    const auto same_side = [](float from, float middle, float to) {
      return (from < middle && to < middle) || (from > middle && to > middle);
    };
    return turn(a, b, c) == 0 && (same_side(a.x, b.x, c.x) || same_side(a.y, b.y, c.y));
  }

  [[nodiscard]] bool is_ear(std::size_t at, Strictness strictness) const {
    const std::size_t before = previous(at), behind = following(at);
    const Place &a = place(before), &b = place(at), &c = place(behind);
    if (turn(a, b, c) <= 0) return false;
    if (strictness == Strictness::kAnyConvex) return true;
    const float low_x = std::min({a.x, b.x, c.x}), high_x = std::max({a.x, b.x, c.x});
    const float low_y = std::min({a.y, b.y, c.y}), high_y = std::max({a.y, b.y, c.y});
    const int outside = strictness == Strictness::kBoundary ? -1 : 0;
    for (std::size_t i = 0; i < corners_.size(); ++i) {
      if (i == before || i == at || i == behind) continue;
      const Place& p = place(i);
      if (p.x < low_x || p.x > high_x || p.y < low_y || p.y > high_y) continue;
      if (p == a || p == b || p == c) continue;  // the outline touches itself there
      if (turn(a, b, p) > outside && turn(b, c, p) > outside && turn(c, a, p) > outside) return false;
    }
    return true;
  }

  std::vector<Place> places_;
  std::vector<std::uint32_t> corners_;  // what is left, in order
};

// Whether two edges cross in a point inside both.
bool cross_inside(const Place& a, const Place& b, const Place& c, const Place& d) {
  if (std::max(a.x, b.x) < std::min(c.x, d.x) || std::max(c.x, d.x) < std::min(a.x, b.x) ||
      std::max(a.y, b.y) < std::min(c.y, d.y) || std::max(c.y, d.y) < std::min(a.y, b.y)) {
    return false;
  }
  return turn(a, b, c) * turn(a, b, d) < 0 && turn(c, d, a) * turn(c, d, b) < 0;
}

bool crosses_itself(const std::vector<Place>& places, const std::vector<std::uint32_t>& corners) {
  const std::size_t count = corners.size();
  if (count < 4) return false;
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = i + 1; j < count; ++j) {
      if (cross_inside(places[corners[i]], places[corners[(i + 1) % count]], places[corners[j]],
                       places[corners[(j + 1) % count]])) {
        return true;
      }
    }
  }
  return false;
}

// Twice the area vector, relative to the first corner, so that distance from the origin costs no precision.
DVec3 newell_normal(std::span<const Vec3> corners) {
  DVec3 sum(0.0);
  const DVec3 origin(corners[0]);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    sum += glm::cross(DVec3(corners[i]) - origin, DVec3(corners[(i + 1) % corners.size()]) - origin);
  }
  return sum;
}

bool are_on_a_line(std::span<const Vec3> corners, const std::vector<std::uint32_t>& kept) {
  const Vec3 &first = corners[kept[0]], &second = corners[kept[1]];
  return std::all_of(kept.begin(), kept.end(),
                     [&](std::uint32_t i) { return exact_zero_area(&first.x, &second.x, &corners[i].x); });
}

double largest_plane_distance(std::span<const Vec3> corners, const DVec3& unit_normal) {
  const DVec3 origin(corners[0]);
  double mean = 0;
  for (const Vec3& corner : corners) mean += glm::dot(DVec3(corner) - origin, unit_normal);
  mean /= static_cast<double>(corners.size());
  double largest = 0;
  for (const Vec3& corner : corners) {
    largest = std::max(largest, std::fabs(glm::dot(DVec3(corner) - origin, unit_normal) - mean));
  }
  return largest;
}

}  // namespace

PolygonResult triangulate_polygon(std::span<const Vec3> corners, std::vector<UVec3>& triangles) {
  std::vector<std::uint32_t> kept;
  kept.reserve(corners.size());
  for (std::uint32_t i = 0; i < corners.size(); ++i) {
    if (kept.empty() || corners[i] != corners[kept.back()]) kept.push_back(i);
  }
  while (kept.size() > 1 && corners[kept.front()] == corners[kept.back()]) kept.pop_back();
  if (kept.size() < 3) return {PolygonDefect::kNoArea, 0};

  const DVec3 normal = newell_normal(corners);
  const double length = glm::length(normal);
  if (are_on_a_line(corners, kept)) return {PolygonDefect::kNoArea, 0};
  if (!(length > 0)) return {PolygonDefect::kCrosses, 0};
  const DVec3 size = glm::abs(normal);
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const int x = (axis + (normal[axis] > 0 ? 1 : 2)) % 3, y = (axis + (normal[axis] > 0 ? 2 : 1)) % 3;
  std::vector<Place> places(corners.size());
  for (std::size_t i = 0; i < corners.size(); ++i) places[i] = {corners[i][x], corners[i][y]};

  PolygonResult result{PolygonDefect::kNone,
                       corners.size() == 3 ? 0 : largest_plane_distance(corners, normal / length)};
  const std::size_t first_triangle = triangles.size();
  if (crosses_itself(places, kept) || !Outline(std::move(places), std::move(kept)).clip(triangles)) {
    triangles.resize(first_triangle);
    result.defect = PolygonDefect::kCrosses;
  } else if (triangles.size() == first_triangle) {
    result.defect = PolygonDefect::kNoArea;
  }
  return result;
}

}  // namespace gridiron::tool
