// The Utah teapot from its control points: 24 patches of revolution given by a profile, 8 of two tubes by stations.
// Source: M. Newell's data set, 1975; F. Crow, "The Origins of the Teapot", 1987.
// Memory: std::vector. Threads: any. SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <span>

#include "scene_makers/shapes.h"

namespace gridiron::scene_makers {
namespace {

struct Profile2 {
  double radius, height;
};

// Cubics from the knob's top to the middle of the bottom; neighbours share their end points, except lid and rim.
constexpr Profile2 kPotProfile[6][4] = {
    {{0, 3.15}, {0.8, 3.15}, {0, 2.85}, {0.2, 2.7}},                 // knob
    {{0.2, 2.7}, {0.4, 2.55}, {1.3, 2.55}, {1.3, 2.4}},              // lid
    {{1.4, 2.4}, {1.3375, 2.53125}, {1.4375, 2.53125}, {1.5, 2.4}},  // rim
    {{1.5, 2.4}, {1.75, 1.875}, {2, 1.35}, {2, 0.9}},                // upper body
    {{2, 0.9}, {2, 0.45}, {1.5, 0.225}, {1.5, 0.15}},                // lower body
    {{1.5, 0.15}, {1.5, 0.075}, {1.425, 0}, {0, 0}},                 // bottom
};

// Newell's quarter circle: inner control points at 0.56 of the radius (0.5523 for a true circle).
constexpr double kQuarterArc = 0.56;

// A tube's cross-section is two mirrored cubics between an inner and an outer point of the plane of symmetry.
struct Station {
  double inner_x, inner_height;
  double outer_x, outer_height;
  double half_width;
};

// Two cubics along each tube; the middle station belongs to both.
constexpr Station kHandle[7] = {
    {-1.6, 2.025, -1.5, 2.25, 0.3}, {-2.3, 2.025, -2.5, 2.25, 0.3}, {-2.7, 2.025, -3, 2.25, 0.3},
    {-2.7, 1.8, -3, 1.8, 0.3},      {-2.7, 1.575, -3, 1.35, 0.3},   {-2.5, 1.125, -2.65, 0.9375, 0.3},
    {-2, 0.9, -1.9, 0.6, 0.3},
};
constexpr Station kSpout[7] = {
    {1.7, 1.425, 1.7, 0.6, 0.66}, {2.6, 1.425, 3.1, 0.825, 0.66},     {2.3, 2.1, 2.4, 2.025, 0.25},
    {2.7, 2.4, 3.3, 2.4, 0.25},   {2.8, 2.475, 3.525, 2.49375, 0.25}, {2.9, 2.475, 3.45, 2.5125, 0.15},
    {2.8, 2.4, 3.2, 2.4, 0.15},
};

// Cubic Bernstein sum; exact at both ends.
double cubic(double p0, double p1, double p2, double p3, std::uint32_t step, std::uint32_t step_count) {
  if (step == 0) return p0;
  if (step == step_count) return p3;
  const double t = static_cast<double>(step) / static_cast<double>(step_count);
  const double s = 1 - t;
  return ((s * s * s) * p0 + (3 * s * s * t) * p1) + ((3 * s * t * t) * p2 + (t * t * t) * p3);
}

// One row of vertices around a part: a closed ring, or a single pole.
using VertexRing = std::vector<std::uint32_t>;

// Joins two rings; `above` lies to the left of the direction in which the rings run, seen from outside.
void join(Mesh& mesh, const VertexRing& above, const VertexRing& below) {
  const std::size_t count = above.size() > below.size() ? above.size() : below.size();
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t next = (i + 1) % count;
    if (above.size() == 1) {
      mesh.triangles.push_back({above[0], below[i], below[next]});
    } else if (below.size() == 1) {
      mesh.triangles.push_back({above[i], below[0], above[next]});
    } else {
      mesh.triangles.push_back({above[i], below[i], below[next]});
      mesh.triangles.push_back({above[i], below[next], above[next]});
    }
  }
}

VertexRing pot_ring(Mesh& mesh, double radius, double height, std::uint32_t segments) {
  if (radius == 0) return {mesh.add_vertex({0, height, 0})};
  VertexRing ring;
  // Counter-clockwise seen from above: with y up, from x towards -z.
  constexpr double kCos[4] = {1, 0, -1, 0};
  constexpr double kSin[4] = {0, 1, 0, -1};
  for (std::size_t quadrant = 0; quadrant < 4; ++quadrant) {
    for (std::uint32_t i = 0; i < segments; ++i) {
      const double along = cubic(radius, radius, radius * kQuarterArc, 0, i, segments);
      const double across = cubic(0, radius * kQuarterArc, radius, radius, i, segments);
      ring.push_back(mesh.add_vertex({along * kCos[quadrant] - across * kSin[quadrant], height,
                                      -(along * kSin[quadrant] + across * kCos[quadrant])}));
    }
  }
  return ring;
}

void add_pot(Mesh& mesh, std::uint32_t segments) {
  VertexRing above;
  const Profile2* last_end = nullptr;
  for (const auto& curve : kPotProfile) {
    // A new row starts only if the curve does not begin at the last one's end.
    const bool connected =
        last_end != nullptr && last_end->radius == curve[0].radius && last_end->height == curve[0].height;
    for (std::uint32_t i = connected ? 1 : 0; i <= segments; ++i) {
      const double radius = cubic(curve[0].radius, curve[1].radius, curve[2].radius, curve[3].radius, i, segments);
      const double height = cubic(curve[0].height, curve[1].height, curve[2].height, curve[3].height, i, segments);
      VertexRing ring = pot_ring(mesh, radius, height, segments);
      if (!above.empty()) join(mesh, above, ring);
      above = std::move(ring);
    }
    last_end = &curve[3];
  }
}

VertexRing tube_ring(Mesh& mesh, std::span<const Station, 4> curve, std::uint32_t step, std::uint32_t segments) {
  const auto along = [&](auto member) {
    return cubic(curve[0].*member, curve[1].*member, curve[2].*member, curve[3].*member, step, segments);
  };
  const double inner_x = along(&Station::inner_x);
  const double inner_height = along(&Station::inner_height);
  const double outer_x = along(&Station::outer_x);
  const double outer_height = along(&Station::outer_height);
  const double half_width = along(&Station::half_width);
  VertexRing ring;
  for (std::uint32_t side = 0; side < 2; ++side) {
    for (std::uint32_t i = 0; i < segments; ++i) {
      const std::uint32_t place = side == 0 ? i : segments - i;
      const double x = cubic(inner_x, inner_x, outer_x, outer_x, place, segments);
      const double height = cubic(inner_height, inner_height, outer_height, outer_height, place, segments);
      const double width = cubic(0, half_width, half_width, 0, place, segments);
      ring.push_back(mesh.add_vertex({x, height, side == 0 ? -width : width}));
    }
  }
  return ring;
}

VertexRing middle_of(Mesh& mesh, const VertexRing& ring) {
  Point sum{};
  for (const std::uint32_t index : ring) {
    for (std::size_t axis = 0; axis < 3; ++axis) sum[axis] += mesh.vertices[index][axis];
  }
  for (double& coordinate : sum) coordinate /= static_cast<double>(ring.size());
  return {mesh.add_vertex(sum)};
}

void add_tube(Mesh& mesh, std::span<const Station, 7> stations, std::uint32_t segments) {
  VertexRing last = tube_ring(mesh, stations.first<4>(), 0, segments);
  join(mesh, middle_of(mesh, last), last);
  for (std::uint32_t step = 1; step <= 2 * segments; ++step) {
    VertexRing ring = step <= segments ? tube_ring(mesh, stations.first<4>(), step, segments)
                                       : tube_ring(mesh, stations.last<4>(), step - segments, segments);
    join(mesh, last, ring);
    last = std::move(ring);
  }
  join(mesh, last, middle_of(mesh, last));
}

}  // namespace

Mesh make_teapot(std::uint32_t segments) {
  Mesh mesh;
  add_pot(mesh, segments);
  add_tube(mesh, kHandle, segments);
  add_tube(mesh, kSpout, segments);
  return mesh;
}

}  // namespace gridiron::scene_makers
