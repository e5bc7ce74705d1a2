// Round shapes. SPDX-License-Identifier: Apache-2.0
#include "scene_text/round_shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <utility>

namespace gridiron::tool {
namespace {

constexpr std::uint32_t kCornerCount = 12;

using Corners = std::array<DVec3, kCornerCount>;

// Corners of the icosahedron: (0, +-1, +-g) and its cyclic shifts, g the golden ratio, at distance 1.
Corners icosahedron_corners() {
  const double golden = 0.5 * (1.0 + std::sqrt(5.0));
  const double scale = 1.0 / std::sqrt(1.0 + golden * golden);
  const double one = scale, far = scale * golden;
  return {DVec3(0, one, far), DVec3(0, one, -far), DVec3(0, -one, far), DVec3(0, -one, -far),
          DVec3(far, 0, one), DVec3(-far, 0, one), DVec3(far, 0, -one), DVec3(-far, 0, -one),
          DVec3(one, far, 0), DVec3(one, -far, 0), DVec3(-one, far, 0), DVec3(-one, -far, 0)};
}

// The faces are the triples of corners that are all neighbours, turned outwards.
std::vector<UVec3> icosahedron_faces(const Corners& corners) {
  // Neighbours are 63.4 degrees apart, others at least 116.6.
  const auto are_neighbours = [&corners](std::uint32_t a, std::uint32_t b) {
    return glm::dot(corners[a], corners[b]) > 0;
  };
  std::vector<UVec3> faces;
  for (std::uint32_t a = 0; a < kCornerCount; ++a) {
    for (std::uint32_t b = a + 1; b < kCornerCount; ++b) {
      for (std::uint32_t c = b + 1; c < kCornerCount; ++c) {
        if (!are_neighbours(a, b) || !are_neighbours(b, c) || !are_neighbours(c, a)) continue;
        const double side = glm::dot(glm::cross(corners[a], corners[b]), corners[c]);
        faces.push_back(side > 0 ? UVec3(a, b, c) : UVec3(a, c, b));
      }
    }
  }
  return faces;
}

DVec3 between(const DVec3& a, const DVec3& b, std::uint32_t step, std::uint32_t steps) {
  return (a * static_cast<double>(steps - step) + b * static_cast<double>(step)) / static_cast<double>(steps);
}

// Point (i, j), i + j <= n, of a face: i steps of n towards b, j towards c. Not yet on the sphere.
DVec3 place_on_face(const DVec3& a, const DVec3& b, const DVec3& c, std::uint32_t i, std::uint32_t j, std::uint32_t n) {
  return (a * static_cast<double>(n - i - j) + b * static_cast<double>(i) + c * static_cast<double>(j)) /
         static_cast<double>(n);
}

// Index of point (i, j) among all points of a face, row by row.
std::size_t place_index(std::uint32_t i, std::uint32_t j, std::uint32_t n) {
  return std::size_t{j} * (n + 1) - std::size_t{j} * (std::size_t{j} - 1) / 2 + i;
}

// Calls emit(place, place, place) for the n^2 triangles of a face, turned as the face.
template <class Emit>
void for_each_facet(std::uint32_t n, Emit emit) {
  for (std::uint32_t j = 0; j < n; ++j) {
    for (std::uint32_t i = 0; i + j < n; ++i) {
      emit(place_index(i, j, n), place_index(i + 1, j, n), place_index(i, j + 1, n));
      if (i + j + 1 < n) emit(place_index(i + 1, j, n), place_index(i + 1, j + 1, n), place_index(i, j + 1, n));
    }
  }
}

UnitSphere make_sphere(std::uint32_t n) {
  const Corners corners = icosahedron_corners();
  UnitSphere sphere;
  sphere.vertices.assign(corners.begin(), corners.end());
  // Each edge's inner vertices are made once, from its lower corner to its higher one, so that both faces share them.
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> first_on_edge;
  const auto edge_vertex = [&](std::uint32_t from, std::uint32_t to, std::uint32_t step) {
    if (from > to) {
      std::swap(from, to);
      step = n - step;
    }
    const auto [entry, is_new] =
        first_on_edge.try_emplace({from, to}, static_cast<std::uint32_t>(sphere.vertices.size()));
    if (is_new) {
      for (std::uint32_t k = 1; k < n; ++k) {
        sphere.vertices.push_back(glm::normalize(between(corners[from], corners[to], k, n)));
      }
    }
    return entry->second + step - 1;
  };
  std::vector<std::uint32_t> indices;
  for (const UVec3& face : icosahedron_faces(corners)) {
    indices.clear();
    for (std::uint32_t j = 0; j <= n; ++j) {
      for (std::uint32_t i = 0; i + j <= n; ++i) {
        if (i == 0 && j == 0) {
          indices.push_back(face.x);
        } else if (i == n) {
          indices.push_back(face.y);
        } else if (j == n) {
          indices.push_back(face.z);
        } else if (j == 0) {
          indices.push_back(edge_vertex(face.x, face.y, i));
        } else if (i == 0) {
          indices.push_back(edge_vertex(face.x, face.z, j));
        } else if (i + j == n) {
          indices.push_back(edge_vertex(face.y, face.z, j));
        } else {
          const DVec3 place = place_on_face(corners[face.x], corners[face.y], corners[face.z], i, j, n);
          indices.push_back(static_cast<std::uint32_t>(sphere.vertices.size()));
          sphere.vertices.push_back(glm::normalize(place));
        }
      }
    }
    for_each_facet(n, [&](std::size_t a, std::size_t b, std::size_t c) {
      sphere.triangles.emplace_back(indices[a], indices[b], indices[c]);
    });
  }
  return sphere;
}

// Cosine of half the angle between neighbours of a regular polygon; 1 minus it is the distance of chords from the
// circle.
struct CircleFineness {
  std::uint32_t segments;
  double cosine;       // of the angle from one corner to the next
  double half_cosine;  // of half of it

  void bisect() {
    segments *= 2;
    cosine = half_cosine;
    half_cosine = std::sqrt(0.5 * (1.0 + cosine));
  }
};

}  // namespace

double RoundShapes::sphere_deviation(std::uint32_t frequency) {
  const auto known = deviations_.find(frequency);
  if (known != deviations_.end()) return known->second;
  // All faces are alike, so one is enough.
  const Corners corners = icosahedron_corners();
  const UVec3 face = icosahedron_faces(corners)[0];
  std::vector<DVec3> places;
  for (std::uint32_t j = 0; j <= frequency; ++j) {
    for (std::uint32_t i = 0; i + j <= frequency; ++i) {
      places.push_back(
          glm::normalize(place_on_face(corners[face.x], corners[face.y], corners[face.z], i, j, frequency)));
    }
  }
  double deviation = 0;
  for_each_facet(frequency, [&](std::size_t a, std::size_t b, std::size_t c) {
    const DVec3 normal = glm::cross(places[b] - places[a], places[c] - places[a]);
    // No point of the facet is nearer to the centre than its plane.
    deviation = std::max(deviation, 1.0 - glm::dot(normal, places[a]) / glm::length(normal));
  });
  deviations_[frequency] = deviation;
  return deviation;
}

std::uint32_t RoundShapes::sphere_frequency(double deviation) {
  std::uint32_t high = 1;
  while (sphere_deviation(high) > deviation) {
    if (high == kMostSphereFrequency) return 0;
    high *= 2;
  }
  std::uint32_t low = high / 2;  // too coarse, or 0
  while (high - low > 1) {
    const std::uint32_t middle = low + (high - low) / 2;
    (sphere_deviation(middle) > deviation ? low : high) = middle;
  }
  return high;
}

const UnitSphere& RoundShapes::sphere(std::uint32_t frequency) {
  const auto known = spheres_.find(frequency);
  if (known != spheres_.end()) return known->second;
  return spheres_.emplace(frequency, make_sphere(frequency)).first->second;
}

std::uint32_t RoundShapes::circle_segments(double deviation) {
  CircleFineness threes{3, -0.5, 0.5}, fours{4, 0.0, std::sqrt(0.5)};
  while (threes.segments <= kMostCircleSegments) {
    // 1 - c is (1 - c^2) / (1 + c), without cancellation.
    const auto holds = [deviation](const CircleFineness& circle) {
      const double c = circle.half_cosine;
      return 0.5 * (1.0 - circle.cosine) / (1.0 + c) <= deviation;
    };
    if (holds(threes)) return threes.segments;
    if (holds(fours)) return fours.segments;
    threes.bisect();
    fours.bisect();
  }
  return 0;
}

const std::vector<DVec3>& RoundShapes::circle(std::uint32_t segments) {
  const auto known = circles_.find(segments);
  if (known != circles_.end()) return known->second;
  std::vector<DVec3> points;
  if (segments % 3 == 0) {
    const double half_root = 0.5 * std::sqrt(3.0);
    points = {DVec3(1, 0, 0), DVec3(-0.5, half_root, 0), DVec3(-0.5, -half_root, 0)};
  } else {
    points = {DVec3(1, 0, 0), DVec3(0, 1, 0), DVec3(-1, 0, 0), DVec3(0, -1, 0)};
  }
  while (points.size() < segments) {
    std::vector<DVec3> finer;
    finer.reserve(points.size() * 2);
    for (std::size_t i = 0; i < points.size(); ++i) {
      finer.push_back(points[i]);
      finer.push_back(glm::normalize(points[i] + points[(i + 1) % points.size()]));
    }
    points = std::move(finer);
  }
  return circles_.emplace(segments, std::move(points)).first->second;
}

}  // namespace gridiron::tool
