// Normals at corners, sharp at creases. SPDX-License-Identifier: Apache-2.0
#include "crease_normals.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <numbers>
#include <numeric>
#include <tuple>
#include <vector>

namespace gridiron::tool {
namespace {

// For each vertex the first one at its place; the zeros of both signs are one place.
std::vector<std::uint32_t> places_of(std::span<const Vec3> vertices) {
  std::vector<std::uint32_t> order(vertices.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto key = [&](std::uint32_t i) { return std::tuple(vertices[i].x, vertices[i].y, vertices[i].z); };
  std::ranges::sort(order,
                    [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b) || (key(a) == key(b) && a < b); });
  std::vector<std::uint32_t> places(vertices.size());
  std::uint32_t first = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (i == 0 || key(order[i]) != key(order[i - 1])) first = order[i];
    places[order[i]] = first;
  }
  return places;
}

// A corner of a triangle, of those around one place.
struct Corner {
  std::uint32_t triangle = 0, corner = 0;
  std::uint32_t group = 0;  ///< index of the corner, among those around the place, that stands for its group
};

// An edge of a corner's triangle from the place to another one.
struct Spoke {
  std::uint32_t end = 0, corner = 0;
  bool is_next = false;  ///< the end is the corner's next one, else the one before
};

class CreaseNormals {
 public:
  CreaseNormals(std::span<const Vec3> vertices, std::span<const UVec3> triangles, float degrees)
      : vertices_(vertices),
        triangles_(triangles),
        places_(places_of(vertices)),
        // A right angle's cosine is not 0 in doubles, and 0 joins nothing.
        least_cosine_(degrees > 0 ? std::cos(double{degrees} * std::numbers::pi / 180) - 1e-9 : 2.0) {}

  MeshNormals make() {
    faces_.reserve(triangles_.size());
    for (const UVec3& triangle : triangles_) {
      const DVec3 origin(vertices_[triangle.x]);
      faces_.push_back(
          unit_or_zero(glm::cross(DVec3(vertices_[triangle.y]) - origin, DVec3(vertices_[triangle.z]) - origin)));
    }
    result_.triangles.assign(triangles_.size(), UVec3(0));
    for_each_place([this](std::span<Corner> corners) {
      join(corners);
      give_normals(corners);
    });
    return std::move(result_);
  }

 private:
  // Counts the corners of each place, then lists them, place by place.
  template <class Visit>
  void for_each_place(const Visit& visit) {
    std::vector<std::uint64_t> begins(vertices_.size() + 1, 0);
    for (const UVec3& triangle : triangles_) {
      for (int k = 0; k < 3; ++k) ++begins[places_[triangle[k]] + 1];
    }
    std::partial_sum(begins.begin(), begins.end(), begins.begin());
    std::vector<Corner> corners(3 * triangles_.size());
    std::vector<std::uint64_t> next(begins.begin(), begins.end() - 1);
    for (std::uint32_t i = 0; i < triangles_.size(); ++i) {
      for (std::uint32_t k = 0; k < 3; ++k) {
        corners[next[places_[triangles_[i][static_cast<int>(k)]]]++] = {i, k, 0};
      }
    }
    for (std::size_t place = 0; place < vertices_.size(); ++place) {
      const auto count = static_cast<std::size_t>(begins[place + 1] - begins[place]);
      if (count != 0) visit(std::span(corners).subspan(static_cast<std::size_t>(begins[place]), count));
    }
  }

  [[nodiscard]] std::uint32_t place_of(const Corner& corner, std::uint32_t steps) const {
    return places_[triangles_[corner.triangle][static_cast<int>((corner.corner + steps) % 3)]];
  }

  static std::uint32_t group_of(std::span<Corner> corners, std::uint32_t i) {
    while (corners[i].group != i) {
      corners[i].group = corners[corners[i].group].group;
      i = corners[i].group;
    }
    return i;
  }

  void join(std::span<Corner> corners) {
    spokes_.clear();
    for (std::uint32_t i = 0; i < corners.size(); ++i) {
      corners[i].group = i;
      if (faces_[corners[i].triangle] == DVec3(0.0)) continue;
      spokes_.push_back({place_of(corners[i], 1), i, true});
      spokes_.push_back({place_of(corners[i], 2), i, false});
    }
    std::ranges::sort(spokes_, {},
                      [](const Spoke& spoke) { return std::tuple(spoke.end, spoke.corner, spoke.is_next); });
    for (std::size_t i = 1; i < spokes_.size(); ++i) {
      const Spoke &a = spokes_[i - 1], &b = spokes_[i];
      if (a.end != b.end || a.is_next == b.is_next) continue;
      const DVec3 &one = faces_[corners[a.corner].triangle], &other = faces_[corners[b.corner].triangle];
      if (glm::dot(one, other) < least_cosine_) continue;
      corners[group_of(corners, b.corner)].group = group_of(corners, a.corner);
    }
  }

  void give_normals(std::span<Corner> corners) {
    sums_.assign(corners.size(), DVec3(0.0));
    indices_.assign(corners.size(), kNone);
    for (std::uint32_t i = 0; i < corners.size(); ++i) {
      const UVec3& triangle = triangles_[corners[i].triangle];
      const auto vertex = [&](std::uint32_t steps) {
        return DVec3(vertices_[triangle[static_cast<int>((corners[i].corner + steps) % 3)]]);
      };
      const DVec3 a = vertex(1) - vertex(0), b = vertex(2) - vertex(0);
      const double weight = glm::dot(a, a) * glm::dot(b, b);
      if (weight > 0 && std::isfinite(weight)) sums_[group_of(corners, i)] += glm::cross(a, b) / weight;
    }
    for (std::uint32_t i = 0; i < corners.size(); ++i) {
      const std::uint32_t group = group_of(corners, i);
      if (indices_[group] == kNone) {
        const DVec3 mean = unit_or_zero(sums_[group]), own = faces_[corners[group].triangle];
        indices_[group] = static_cast<std::uint32_t>(result_.normals.size());
        result_.normals.emplace_back(mean != DVec3(0.0) ? mean : own != DVec3(0.0) ? own : DVec3(0, 0, 1));
      }
      result_.triangles[corners[i].triangle][static_cast<int>(corners[i].corner)] = indices_[group];
    }
  }

  static constexpr std::uint32_t kNone = 0xFFFFFFFFu;
  std::span<const Vec3> vertices_;
  std::span<const UVec3> triangles_;
  std::vector<std::uint32_t> places_;
  double least_cosine_;
  std::vector<DVec3> faces_;
  // Of the place at hand.
  std::vector<Spoke> spokes_;
  std::vector<DVec3> sums_;
  std::vector<std::uint32_t> indices_;
  MeshNormals result_;
};

}  // namespace

MeshNormals make_crease_normals(std::span<const Vec3> vertices, std::span<const UVec3> triangles, float degrees) {
  return CreaseNormals(vertices, triangles, degrees).make();
}

}  // namespace gridiron::tool
