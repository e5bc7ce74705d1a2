// Scene points. SPDX-License-Identifier: Apache-2.0
#include "scene_points.h"

#include <gridiron/build/triangle_records.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <vector>

namespace gridiron::tool {
namespace {

using Corners = std::array<Vec3, 3>;

// Passes points on in groups, so that few calls are needed.
class Groups {
 public:
  explicit Groups(const PointVisitor& visitor) : visitor_(visitor) { points_.reserve(kMostPoints); }

  void add(const Vec3& point) {
    points_.push_back(point);
    if (points_.size() == kMostPoints) hand_on();
  }
  void hand_on() {
    if (!points_.empty()) visitor_(points_);
    points_.clear();
  }

 private:
  static constexpr std::size_t kMostPoints = 1024;

  const PointVisitor& visitor_;
  std::vector<Vec3> points_;
};

Corners corners_of(const VertexTriangle& triangle) {
  Corners corners;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    corners[i] = Vec3(triangle.v[i][0], triangle.v[i][1], triangle.v[i][2]);
  }
  return corners;
}

Corners corners_of(const LatticeTriangle& triangle, const Lattice& lattice) {
  Corners corners;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      corners[i][axis] = static_cast<float>(triangle.v[i][axis]) * lattice.step + lattice.origin[axis];
    }
  }
  return corners;
}

// The corners are where (beta, gamma) is (0, 0), (1, 0) and (0, 1). For slivers whose equations are dominated by
// rounding, the corners are clamped to the scene's bounds.
Corners corners_of(const ProjectionTriangle& triangle, const GridRecord& grid) {
  const double determinant = double{triangle.b_u} * triangle.c_v - double{triangle.b_v} * triangle.c_u;
  const int axes[3] = {static_cast<int>(triangle.axis_k + 1) % 3, static_cast<int>(triangle.axis_k + 2) % 3,
                       static_cast<int>(triangle.axis_k)};
  constexpr double kPlaces[3][2] = {{0, 0}, {1, 0}, {0, 1}};
  Corners corners;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const double beta = kPlaces[i][0] - triangle.b_d, gamma = kPlaces[i][1] - triangle.c_d;
    const double u = (beta * triangle.c_v - gamma * triangle.b_v) / determinant;
    const double v = (gamma * triangle.b_u - beta * triangle.c_u) / determinant;
    const double place[3] = {u, v, triangle.n_d - triangle.n_u * u - triangle.n_v * v};
    for (int j = 0; j < 3; ++j) {
      const double least = grid.bounds_minimum[axes[j]], most = grid.bounds_maximum[axes[j]];
      corners[i][axes[j]] = static_cast<float>(std::isfinite(place[j]) ? std::clamp(place[j], least, most) : least);
    }
  }
  return corners;
}

template <class Record>
Record read_record(std::span<const std::byte> image, std::uint64_t offset) {
  Record record;
  std::memcpy(&record, image.data() + offset, sizeof record);
  return record;
}

}  // namespace

void visit_points(const MeshView& mesh, const PointVisitor& visitor) {
  std::vector<bool> is_known(mesh.vertices.size());
  Groups groups(visitor);
  for (const UVec3& triangle : mesh.triangles) {
    if (is_known[triangle.x] && is_known[triangle.y] && is_known[triangle.z]) continue;
    if (has_zero_area(mesh.vertices[triangle.x], mesh.vertices[triangle.y], mesh.vertices[triangle.z])) continue;
    for (int corner = 0; corner < 3; ++corner) {
      if (is_known[triangle[corner]]) continue;
      is_known[triangle[corner]] = true;
      groups.add(mesh.vertices[triangle[corner]]);
    }
  }
  groups.hand_on();
}

void visit_points(const SceneImageView& view, std::span<const std::byte> image, const PointVisitor& visitor,
                  std::uint32_t end) {
  const GridRecord& grid = view.grid;  // without one the tree's bounds, format and lattice
  const auto format = static_cast<TriangleFormat>(grid.triangle_format);
  const std::uint64_t records_offset = view.has_grid ? view.triangles_offset_bytes : view.tree.triangles_offset_bytes;
  const std::uint64_t record_count = view.has_grid ? grid.reference_count : view.tree.triangle_count;
  // Most triangles are in several cells. An image may name more of them than it has.
  std::vector<bool> is_known(std::min(std::uint64_t{view.header.triangle_count}, std::uint64_t{8} * record_count));
  Groups groups(visitor);
  const auto visit = [&](std::uint64_t record) {
    const std::uint64_t offset = records_offset + record * grid.triangle_bytes;
    const auto id = read_record<std::uint32_t>(image, offset + grid.triangle_bytes - sizeof(std::uint32_t));
    if (id >= end) return;
    if (id < is_known.size()) {
      if (is_known[id]) return;
      is_known[id] = true;
    }
    Corners corners;
    switch (format) {
      case TriangleFormat::kVertices:
        corners = corners_of(read_record<VertexTriangle>(image, offset));
        break;
      case TriangleFormat::kProjection:
        corners = corners_of(read_record<ProjectionTriangle>(image, offset), grid);
        break;
      case TriangleFormat::kLattice:
        corners = corners_of(read_record<LatticeTriangle>(image, offset), grid.lattice);
        break;
    }
    for (const Vec3& corner : corners) groups.add(corner);
  };
  // Records are ordered by place. Samples from everywhere come first, since most of the others lie between those.
  constexpr std::uint64_t kRun = 32, kRuns = 64;
  for (std::uint64_t first = 0; first < kRuns; ++first) {
    for (std::uint64_t run = first * kRun; run < record_count; run += kRun * kRuns) {
      const std::uint64_t run_end = std::min(run + kRun, record_count);
      for (std::uint64_t record = run; record < run_end; ++record) visit(record);
    }
  }
  groups.hand_on();
}

}  // namespace gridiron::tool
