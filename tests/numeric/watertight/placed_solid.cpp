// A solid in its place: see the header. SPDX-License-Identifier: Apache-2.0
#include "numeric/watertight/placed_solid.h"

#include <gridiron/base/records.h>
#include <gridiron/build/triangle_records.h>
#include <gridiron/build/lattice.h>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <stdexcept>

namespace gridiron::test {
namespace {

TestMesh placed(const Solid& solid, const Placement& placement, Vertices vertices) {
  TestMesh mesh = solid.mesh;
  for (Vec3& vertex : mesh.vertices) {
    vertex = Vec3(DVec3(vertex) * std::ldexp(1.0, placement.exponent) + DVec3(placement.offset));
  }
  if (vertices == Vertices::kOnLattice) mesh.snap();
  return mesh;
}

// Those that have an area, by the rule of the grid's builder.
std::vector<std::uint32_t> kept_triangles(const TestMesh& mesh) {
  std::vector<std::uint32_t> kept;
  for (std::uint32_t id = 0; id < mesh.triangles.size(); ++id) {
    const UVec3& t = mesh.triangles[id];
    if (!has_zero_area(mesh.vertices[t.x], mesh.vertices[t.y], mesh.vertices[t.z])) kept.push_back(id);
  }
  return kept;
}

// det[a, b, c], and the sum of the magnitudes of its products. Of differences of floats its error is below 2^-49 times
// that: 3 roundings of differences, 2 of products, 3 of sums.
struct Determinant {
  double value, size;
  [[nodiscard]] int sure_sign() const {
    if (std::fabs(value) <= 0x1p-49 * size) return 0;
    return value > 0.0 ? 1 : -1;
  }
};
Determinant determinant(const DVec3& a, const DVec3& b, const DVec3& c) {
  const auto size = [](double p, double q) { return std::fabs(p) + std::fabs(q); };
  const DVec3 n = glm::cross(b, c);
  return {a.x * n.x + a.y * n.y + a.z * n.z, std::fabs(a.x) * size(b.y * c.z, b.z * c.y) +
                                                 std::fabs(a.y) * size(b.z * c.x, b.x * c.z) +
                                                 std::fabs(a.z) * size(b.x * c.y, b.y * c.x)};
}

}  // namespace

PlacedSolid::PlacedSolid(const Solid& solid, const Placement& placement, Vertices vertices)
    : mesh_(placed(solid, placement, vertices)),
      tree_(mesh_.view(), kept_triangles(mesh_)),
      oracle_(mesh_.view(), {.reading = Reading::kStandard}),
      vertices_(mesh_.triangles.size()),
      projections_(mesh_.triangles.size()),
      low_(mesh_.vertices.front()),
      high_(low_) {
  for (const std::uint32_t id : tree_.order()) {
    const UVec3& t = mesh_.triangles[id];
    watertight::VertexRecord& record = vertices_[id];
    record = {};
    const std::uint32_t corners[3] = {t.x, t.y, t.z};
    for (int corner = 0; corner < 3; ++corner) {
      for (int axis = 0; axis < 3; ++axis) record.v[corner][axis] = mesh_.vertices[corners[corner]][axis];
    }
    record.triangle_id = id;
    ProjectionTriangle projection;
    make_projection_triangle(mesh_.vertices[t.x], mesh_.vertices[t.y], mesh_.vertices[t.z], id, projection);
    static_assert(sizeof(projection) == sizeof(watertight::ProjectionRecord));
    std::memcpy(&projections_[id], &projection, sizeof(projection));
  }
  if (vertices == Vertices::kOnLattice) find_places();
  for (const Vec3& vertex : mesh_.vertices) {
    low_ = glm::min(low_, vertex);
    high_ = glm::max(high_, vertex);
  }
  const Vec3 extent = high_ - low_;
  width_ = std::fmax(extent.x, std::fmax(extent.y, extent.z));
}

bool PlacedSolid::may_be_on_surface(const Vec3& point) const {
  std::vector<std::uint32_t> around;
  tree_.find(point, around);
  return std::ranges::any_of(around, [&](std::uint32_t id) {
    const UVec3& t = mesh_.triangles[id];
    const DVec3 p(point);
    const DVec3 a = DVec3(mesh_.vertices[t.x]) - p, b = DVec3(mesh_.vertices[t.y]) - p,
                c = DVec3(mesh_.vertices[t.z]) - p;
    return determinant(a, b, c).sure_sign() == 0;
  });
}

Surroundings PlacedSolid::look_around(const Vec3& point, TestRandom& random) const {
  if (may_be_on_surface(point)) return {false, 0};
  for (int attempt = 0; attempt < 20; ++attempt) {
    OracleRay ray{{point.x, point.y, point.z}, {}};
    for (float& component : ray.direction) component = random.between(-1.0f, 1.0f);
    const DVec3 direction(ray.direction[0], ray.direction[1], ray.direction[2]);
    const std::vector<OracleHit> hits = oracle_.hits(ray);
    if (hits.empty()) return {false, 0};
    int winding = 0;
    bool is_sure = true;
    const OracleHit* nearest = &hits.front();
    for (const OracleHit& hit : hits) {
      const UVec3& t = mesh_.triangles[hit.triangle_id];
      const DVec3 p(point);
      const DVec3 corners[3] = {DVec3(mesh_.vertices[t.x]) - p, DVec3(mesh_.vertices[t.y]) - p,
                                DVec3(mesh_.vertices[t.z]) - p};
      for (int i = 0; i < 3; ++i) {
        is_sure = is_sure && determinant(direction, corners[i], corners[(i + 1) % 3]).sure_sign() != 0;
      }
      winding += determinant(direction, corners[0], corners[1]).sure_sign();
      if (hit.low < nearest->low) nearest = &hit;
    }
    if (is_sure) return {winding != 0, nearest->triangle_id};
  }
  return {false, 0};
}

// The lattice that the builder would find for the mesh as it is now: every vertex has a place on it.
void PlacedSolid::find_places() {
  if (find_lattice(mesh_.view(), lattice_) != Status::kOk) throw std::logic_error("a mesh without a lattice");
  places_.resize(mesh_.triangles.size());
  for (std::uint32_t id = 0; id < places_.size(); ++id) {
    const UVec3& t = mesh_.triangles[id];
    for (int corner = 0; corner < 3; ++corner) {
      const Vec3& vertex = mesh_.vertices[t[corner]];
      if (snap(lattice_, vertex) != vertex) throw std::logic_error("a vertex beside the lattice");
      const LatticePoint point = lattice_point(lattice_, vertex);
      for (int axis = 0; axis < 3; ++axis) places_[id].v[corner][axis] = point.place[axis];
    }
    places_[id].triangle_id = id;
  }
}

void PlacedSolid::add_candidates(watertight::Shot& shot, CandidateRecords& records) const {
  records.ids.clear();
  records.vertices.clear();
  records.projections.clear();
  records.places.clear();
  tree_.find(shot, records.ids);
  for (const std::uint32_t id : records.ids) {
    records.vertices.push_back(vertices_[id]);
    records.projections.push_back(projections_[id]);
    if (is_on_lattice()) records.places.push_back(places_[id]);
  }
  shot.vertices = records.vertices.data();
  shot.projections = records.projections.data();
  shot.places = records.places.data();
  static_assert(sizeof(shot.lattice) == sizeof(lattice_));
  std::memcpy(shot.lattice, &lattice_, sizeof(lattice_));
  shot.triangle_count = static_cast<std::uint32_t>(records.ids.size());
}

}  // namespace gridiron::test
