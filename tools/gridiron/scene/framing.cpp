// Framing: see the header. SPDX-License-Identifier: Apache-2.0
#include "framing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <limits>
#include <numbers>
#include <vector>

namespace gridiron::tool {
namespace {

// Take a direction of view. A point has the place u across it and the depth z along it. An eye at (e, d) sees the point
// at the slope (u - e) / (z - d). Slopes up to s are in the picture: u - s z <= e - s d and -u - s z <= -e - s d. So
// all points are in the picture if A = max(u - s z) and B = max(-u - s z) do not exceed these. The sum gives the
// nearest eye: d = -(A + B) / (2 s), e = (A - B) / 2. Width and height each have such a d; the lesser one suits both.
// In the other direction, the slope s at which d = -(A(s) + B(s)) / (2 s) centres the points. Only corners of the
// convex hull of all (u, z) decide A and B. Source: own.

using DVec2 = glm::dvec2;

// Greater than 0 if c lies to the left of the line from a to b.
double turn(const DVec2& a, const DVec2& b, const DVec2& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

// Points of a plane. Points that are no corner of their convex hull are dropped from time to time.
class Hull {
 public:
  void add(const DVec2& point) {
    if (is_surely_inside(point)) return;
    bool has_grown = false;
    for (std::size_t i = 0; i < kRingCorners; ++i) {
      const double reach = glm::dot(kDirections[i], point);
      if (!(reach > reaches_[i])) continue;
      reaches_[i] = reach;
      ring_[i] = point;
      has_grown = true;
    }
    if (has_grown) place_sides();
    points_.push_back(point);
    if (points_.size() >= most_points_) reduce();
  }

  // The corners, counterclockwise. Precondition: a point was added.
  [[nodiscard]] const std::vector<DVec2>& corners() {
    reduce();
    return points_;
  }

 private:
  static constexpr std::size_t kRingCorners = 8;
  static constexpr double kNone = -std::numeric_limits<double>::infinity();
  static constexpr std::array<DVec2, kRingCorners> kDirections = {
      {{0, -1}, {1, -1}, {1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}}};

  // Whether a point lies inside the ring of the points that are extreme in eight directions, counterclockwise.
  [[nodiscard]] bool is_surely_inside(const DVec2& point) const {
    bool is_inside = true;
    for (std::size_t i = 0; i < kRingCorners; ++i) {
      is_inside &= side_x_[i] * point.x + side_y_[i] * point.y > side_reaches_[i];
    }
    return is_inside;
  }

  // The sides of the ring, moved inwards a little, so that rounding never takes a corner of the hull for an inner
  // point.
  void place_sides() {
    constexpr double kSlack = 1e-12;
    std::size_t sides = 0;
    for (std::size_t i = 0; i < kRingCorners; ++i) {
      const DVec2& from = ring_[i];
      const DVec2& to = ring_[(i + 1) % kRingCorners];
      const DVec2 inwards(from.y - to.y, to.x - from.x);
      const DVec2 largest = glm::max(glm::abs(from), glm::abs(to));
      side_x_[i] = inwards.x;
      side_y_[i] = inwards.y;
      side_reaches_[i] = from == to ? kNone : glm::dot(inwards, from) + kSlack * glm::dot(glm::abs(inwards), largest);
      if (from != to) ++sides;
    }
    if (sides < 3) side_reaches_.fill(-kNone);
  }

  // Andrew's monotone chain, 1979: the lower side from left to right, then the upper side back.
  void reduce() {
    const auto precedes = [](const DVec2& a, const DVec2& b) { return a.x < b.x || (a.x == b.x && a.y < b.y); };
    std::ranges::sort(points_, precedes);
    points_.erase(std::unique(points_.begin(), points_.end()), points_.end());
    if (points_.size() > 2) {
      std::vector<DVec2> hull;
      const auto append = [&hull](const DVec2& point, std::size_t first) {
        while (hull.size() >= first + 2 && turn(hull[hull.size() - 2], hull.back(), point) <= 0) hull.pop_back();
        hull.push_back(point);
      };
      for (const DVec2& point : points_) append(point, 0);
      const std::size_t upper = hull.size() - 1;
      for (std::size_t i = points_.size() - 1; i-- > 0;) append(points_[i], upper);
      hull.pop_back();  // the first corner again
      points_ = std::move(hull);
    }
    most_points_ = 2 * points_.size() + 4096;
  }

  std::vector<DVec2> points_;
  std::size_t most_points_ = 4096;
  std::array<DVec2, kRingCorners> ring_{};
  std::array<double, kRingCorners> reaches_{kNone, kNone, kNone, kNone, kNone, kNone, kNone, kNone};
  std::array<double, kRingCorners> side_x_{}, side_y_{}, side_reaches_{};  // inside: x X + y Y > reach
};

// The corners at opposite edges of a picture: A and B of the comment at the top, and the depths of these corners.
struct Support {
  double positive = 0, negative = 0;
  double positive_depth = 0, negative_depth = 0;
};

Support support_of(const std::vector<DVec2>& corners, double slope) {
  constexpr double kLeast = -std::numeric_limits<double>::infinity();
  Support support{kLeast, kLeast};
  for (const DVec2& corner : corners) {
    const double positive = corner.x - slope * corner.y, negative = -corner.x - slope * corner.y;
    if (positive > support.positive) support.positive = positive, support.positive_depth = corner.y;
    if (negative > support.negative) support.negative = negative, support.negative_depth = corner.y;
  }
  return support;
}

// The greatest depth of an eye that has all corners within the slope, at any place or at a given one.
double depth_of_eye(const std::vector<DVec2>& corners, double slope, const std::optional<double>& place) {
  const Support support = support_of(corners, slope);
  if (!place) return -(support.positive + support.negative) / (2 * slope);
  return std::min(*place - support.positive, -*place - support.negative) / slope;
}

// The place of an eye at a depth that sees the corners at opposite slopes. Newton's iteration finds the slope at which
// A + B + 2 s d = 0; the function is convex, decreasing and piecewise linear, so few steps reach its root.
double centre_of(const std::vector<DVec2>& corners, double slope, double depth) {
  constexpr int kMostSteps = 32;
  Support support = support_of(corners, slope);
  for (int i = 0; i < kMostSteps; ++i) {
    const double value = support.positive + support.negative + 2 * slope * depth;
    const double rise = 2 * depth - support.positive_depth - support.negative_depth;
    const double next = slope - value / rise;
    if (!(rise < 0) || next == slope) break;
    slope = next;
    support = support_of(corners, slope);
  }
  return 0.5 * (support.positive - support.negative);
}

// Orthonormal; `back` points from the scene to the eye.
struct Axes {
  DVec3 right, up, back;
};

Axes axes_of(const ViewAngles& from, const DVec3& up) {
  // The smallest rotation that takes y to up; half a turn about x if up is -y.
  const DVec3 to = glm::normalize(up);
  DVec3 x(1, 0, 0), y(0, -1, 0), z(0, 0, -1);
  if (to.y > -1 + 1e-9) {
    const double share = 1 / (1 + to.y);
    x = {1 - to.x * to.x * share, -to.x, -to.x * to.z * share};
    y = to;
    z = {-to.x * to.z * share, -to.z, 1 - to.z * to.z * share};
  }
  const double azimuth = from.azimuth * std::numbers::pi / 180, elevation = from.elevation * std::numbers::pi / 180;
  const DVec3 level = std::sin(azimuth) * x + std::cos(azimuth) * z;
  const DVec3 right = std::cos(azimuth) * x - std::sin(azimuth) * z;
  const DVec3 back = glm::normalize(std::cos(elevation) * level + std::sin(elevation) * y);
  return {right, glm::cross(back, right), back};
}

double largest_of(const DVec3& v) {
  return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

// A place rounded to the floats of a camera. GCC 12's vectorizer drops conversions of neighbours to float and back;
// volatile prevents that.
DVec3 rounded(const DVec3& place) {
  DVec3 result;
  for (int axis = 0; axis < 3; ++axis) {
    const volatile float held = static_cast<float>(place[axis]);
    result[axis] = held;
  }
  return result;
}

// The slopes at which a camera sees the points; nothing if one of them lies beside or behind the eye.
struct Outline {
  DVec2 least{std::numeric_limits<double>::infinity()}, most{-std::numeric_limits<double>::infinity()};
};

std::optional<Outline> outline_of(const PointSource& points, const DVec3& eye, const Axes& axes) {
  Outline outline;
  bool is_in_front = true;
  points([&](std::span<const Vec3> some) {
    for (const Vec3& point : some) {
      const DVec3 offset = DVec3(point) - eye;
      const double depth = -glm::dot(axes.back, offset);
      is_in_front = is_in_front && depth > 0;
      const DVec2 slope(glm::dot(axes.right, offset) / depth, glm::dot(axes.up, offset) / depth);
      outline.least = {std::min(outline.least.x, slope.x), std::min(outline.least.y, slope.y)};
      outline.most = {std::max(outline.most.x, slope.x), std::max(outline.most.y, slope.y)};
    }
  });
  return is_in_front ? std::optional(outline) : std::nullopt;
}

double middle_slope(double least, double most) {
  return std::tan(0.5 * (std::atan(least) + std::atan(most)));
}

Axes looking_along(const DVec3& back, const DVec3& up) {
  const DVec3 right = glm::normalize(glm::cross(up, back));
  return {right, glm::cross(back, right), back};
}

Axes turned(const Axes& axes, const DVec2& slope, const DVec3& up) {
  return looking_along(glm::normalize(axes.back - slope.x * axes.right - slope.y * axes.up), up);
}

// Moves an eye to a place that floats can hold and from which the whole scene is visible. Turns the axes to `at`, or to
// the scene's middle as seen from there. The first step back is a twentieth of `depth`. `up` is the camera's.
DVec3 settle(const PointSource& points, const std::optional<Vec3>& at, const DVec2& slopes, double depth, DVec3 eye,
             const DVec3& up, Axes& axes) {
  constexpr int kMostTurns = 4;
  const int most_places = at ? 16 : 10;
  const Axes wanted = axes;
  for (int place = 0;; ++place) {
    const DVec3 held = rounded(eye);
    const bool is_apart = !at || held != DVec3(*at);
    axes = at && is_apart ? looking_along(glm::normalize(held - DVec3(*at)), up) : wanted;
    std::optional<Outline> outline = outline_of(points, held, axes);
    for (int i = 1; i < kMostTurns && outline && !at; ++i) {
      const DVec2 middle(middle_slope(outline->least.x, outline->most.x),
                         middle_slope(outline->least.y, outline->most.y));
      axes = turned(axes, middle, up);
      outline = outline_of(points, held, axes);
    }
    // Half of the margin may be lost. The direction to a given `at` may change by less than four degrees, and so may
    // the picture's rotation.
    const bool is_whole = outline && std::max(outline->most.x, -outline->least.x) <= 0.95 * slopes.x &&
                          std::max(outline->most.y, -outline->least.y) <= 0.95 * slopes.y;
    const bool is_straight =
        !at || (is_apart && glm::dot(axes.back, wanted.back) > 0.998 && glm::dot(axes.right, wanted.right) > 0.998);
    if ((is_whole && is_straight) || place == most_places) return held;
    eye += wanted.back * (0.05 * depth * (1 << place));
  }
}

}  // namespace

Camera frame_points(const FramingRequest& request, const PointSource& points) {
  Axes axes = axes_of(request.from, DVec3(request.up));

  // Places and depths are relative to one of the points, so that they are exact far from the origin too.
  std::optional<DVec3> origin;
  Hull across, along;
  points([&](std::span<const Vec3> some) {
    for (const Vec3& point : some) {
      if (!origin) origin = DVec3(point);
      const DVec3 offset = DVec3(point) - *origin;
      const double depth = -glm::dot(axes.back, offset);
      across.add({glm::dot(axes.right, offset), depth});
      along.add({glm::dot(axes.up, offset), depth});
    }
  });
  const std::vector<DVec2>& columns = across.corners();
  const std::vector<DVec2>& rows = along.corners();
  const auto [left, right] = std::ranges::minmax(columns, {}, [](const DVec2& corner) { return corner.x; });
  const auto [low, high] = std::ranges::minmax(rows, {}, [](const DVec2& corner) { return corner.x; });
  const auto [nearest, farthest] = std::ranges::minmax(columns, {}, [](const DVec2& corner) { return corner.y; });
  double extent = std::max({right.x - left.x, high.x - low.x, farthest.y - nearest.y});
  if (!(extent > 0)) extent = std::max(largest_of(*origin), 1.0);

  const DVec2 slopes(request.tan_half_fov * request.aspect, request.tan_half_fov);
  const DVec2 inner = (1 - 2 * kFramingMargin) * slopes;
  std::optional<double> column, row;
  // The nearest point stays a little away from the eye, even if it is the only visible part of the scene.
  double depth = nearest.y - 1e-3 * extent;
  double middle_depth = 0.5 * (nearest.y + farthest.y);
  if (request.at) {
    const DVec3 offset = DVec3(*request.at) - *origin;
    column = glm::dot(axes.right, offset);
    row = glm::dot(axes.up, offset);
    middle_depth = -glm::dot(axes.back, offset);
    depth = std::min(depth, middle_depth - 1e-3 * extent);
  }
  depth = std::min({depth, depth_of_eye(columns, inner.x, column), depth_of_eye(rows, inner.y, row)});
  if (!column) column = centre_of(columns, inner.x, depth);
  if (!row) row = centre_of(rows, inner.y, depth);

  Camera camera;
  const bool is_along_up = glm::length(glm::cross(axes.back, glm::normalize(DVec3(request.up)))) < 1e-3;
  camera.up = is_along_up ? Vec3(axes.up) : request.up;
  camera.tan_half_fov = static_cast<float>(request.tan_half_fov);
  DVec3 eye = *origin + *column * axes.right + *row * axes.up - depth * axes.back;
  const double least_slope = std::min(slopes.x, slopes.y);
  constexpr double kMostTurn = 1e-4;  // of half the picture, by rounding
  const double rounding = glm::length(rounded(eye) - eye);
  const double least_depth = std::min(nearest.y, request.at ? middle_depth : nearest.y) - depth;
  if (!(rounding < kMostTurn * least_slope * least_depth)) {
    const double reach = std::max(middle_depth - depth, request.at ? largest_of(eye) * 0x1p-24 / least_slope : 0.0);
    eye = settle(points, request.at, slopes, reach, eye, DVec3(camera.up), axes);
  }
  // Far from the origin `at` is placed farther away, so that its own rounding does not turn the camera.
  const double least_reach = largest_of(eye) * 0x1p-23 / (kMostTurn * least_slope);
  const double reach = std::max(middle_depth - depth, least_reach);
  camera.eye = Vec3(eye);
  camera.at = request.at ? *request.at : Vec3(eye - reach * axes.back);
  return camera;
}

DVec3 middle_of(const PointSource& points) {
  DVec3 least(std::numeric_limits<double>::infinity()), most(-std::numeric_limits<double>::infinity());
  points([&least, &most](std::span<const Vec3> some) {
    for (const Vec3& point : some) {
      least = glm::min(least, DVec3(point));
      most = glm::max(most, DVec3(point));
    }
  });
  return 0.5 * (least + most);
}

std::vector<Vec3> swept_points(const PointSource& points, const DVec3& place, const DVec3& axis) {
  const Axes axes = axes_of({}, axis);
  const DVec3 along = glm::normalize(axis);
  Hull profile;  // radius and height; only its corners touch the solid's convex hull
  points([&](std::span<const Vec3> some) {
    for (const Vec3& point : some) {
      const DVec3 offset = DVec3(point) - place;
      const double height = glm::dot(along, offset);
      profile.add({glm::length(offset - height * along), height});
    }
  });
  // Each circle is replaced by the corners of a polygon around it.
  constexpr int kCorners = 64;
  constexpr double kTurn = 2 * std::numbers::pi / kCorners;
  const DVec3 across = glm::cross(along, axes.right);
  std::vector<Vec3> swept;
  for (const DVec2& corner : profile.corners()) {
    const double radius = corner.x / std::cos(0.5 * kTurn);
    for (int i = 0; i < kCorners; ++i) {
      const DVec3 outwards = std::cos(i * kTurn) * axes.right + std::sin(i * kTurn) * across;
      swept.emplace_back(place + corner.y * along + radius * outwards);
    }
  }
  return swept;
}

}  // namespace gridiron::tool
