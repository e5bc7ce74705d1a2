// The Cell's rules of floating point, in software: rounding to zero, no denormals, no infinity, no NaN, zeros positive.
// SPDX-License-Identifier: Apache-2.0
#include "numeric/hard_cases/cell_numbers.h"

#include <gridiron/build/triangle_records.h>
#include <gridiron/build/lattice.h>

#include "core/ray/packet_cases.h"
#include "numeric/exact_cells.h"
#include "numeric/hard_cases/cell_walk.h"
#include "numeric/hard_cases/judge.h"
#include "numeric/hard_cases/shapes.h"
#include "numeric/hard_cases/trial.h"
#include "numeric/watertight/shot.h"

namespace gridiron_cell {
void shoot(const watertight::Shot& shot, std::uint32_t accuracy_value, watertight::Hits& hits);
}

namespace gridiron::test::hard {
namespace {

// A target's triangles as a shot takes them.
struct ShotTriangles {
  std::vector<VertexTriangle> vertices;
  std::vector<ProjectionTriangle> projections;
  std::vector<LatticeTriangle> places;

  explicit ShotTriangles(const Target& target) {
    const TestMesh& mesh = target.mesh();
    for (std::uint32_t id = 0; id < mesh.triangles.size(); ++id) {
      if (!target.has_area(id)) continue;
      const UVec3& t = mesh.triangles[id];
      const Vec3 corners[3] = {mesh.vertices[t.x], mesh.vertices[t.y], mesh.vertices[t.z]};
      vertices.push_back(vertex_triangle(corners[0], corners[1], corners[2], id));
      make_projection_triangle(corners[0], corners[1], corners[2], id, projections.emplace_back());
      LatticeTriangle& stored = places.emplace_back();
      stored = {};
      stored.triangle_id = id;
      if (target.profile().accuracy != Accuracy::kCompact) continue;
      for (int corner = 0; corner < 3; ++corner) {
        const LatticePoint point = lattice_point(target.grid().lattice, corners[corner]);
        for (int axis = 0; axis < 3; ++axis) stored.v[corner][axis] = point.place[axis];
      }
    }
  }
};

std::vector<Answer> shoot_cell(const Target& target, const ShotTriangles& triangles, const Rays& rays,
                               bool with_distances) {
  std::vector<Answer> answers;
  for (std::size_t first = 0; first < rays.directions.size(); first += watertight::kShotRays) {
    watertight::Shot shot{};
    const std::size_t count = std::min<std::size_t>(watertight::kShotRays, rays.directions.size() - first);
    for (int axis = 0; axis < 3; ++axis) {
      shot.origin[axis] = rays.origin[axis];
      for (std::size_t i = 0; i < count; ++i) shot.dir[axis][i] = rays.directions[first + i][axis];
    }
    shot.active = (1u << count) - 1u;
    shot.with_distances = with_distances;
    shot.vertices = reinterpret_cast<const watertight::VertexRecord*>(triangles.vertices.data());
    shot.projections = reinterpret_cast<const watertight::ProjectionRecord*>(triangles.projections.data());
    shot.places = reinterpret_cast<const watertight::LatticeRecord*>(triangles.places.data());
    std::memcpy(shot.lattice, &target.grid().lattice, sizeof shot.lattice);
    shot.triangle_count = static_cast<std::uint32_t>(triangles.vertices.size());
    watertight::Hits hits;
    gridiron_cell::shoot(shot, static_cast<std::uint32_t>(target.profile().accuracy), hits);
    for (std::size_t i = 0; i < count; ++i) answers.push_back({hits.id[i], hits.t[i]});
  }
  return answers;
}

// The intersector: as everywhere, the oracle's triangle and distance; no hole. The walks: every cell touched. Overflow,
// where there is no infinity to tell of it, in a scene of 1e19.
TEST(HardCase40, CellNumbers) {
  std::uint64_t checked = 0;
  for (const float scale : {1.0f, 0x1p-40f, 1e19f}) {
    for (const Solid& solid : solids()) {
      SCOPED_TRACE(std::string(solid.name) + " times " + std::to_string(scale));
      for (const Profile& profile : kProfiles) {
        const Target target(moved(solid.mesh, scale), {}, profile);
        ASSERT_EQ(target.status(), Status::kOk);
        const Oracle oracle(target.mesh().view(), {.reading = Reading::kStandard});
        const ShotTriangles triangles(target);
        Judge judge(target, Grade::kClosed);
        bool with_distances = true;
        for (const Rays& rays : with_unit_directions(salvo(target.mesh(), scale * solid.middle, scale * solid.room,
                                                           {{Aim::kEdge, Aim::kVertex}, times(2), 32, 0}, 40))) {
          std::vector<OracleRay> asked;
          for (std::size_t i = 0; i < rays.directions.size(); ++i) asked.push_back(oracle_ray(rays, i));
          const std::vector<NearestHit> truth = oracle.nearest(asked, 1);
          judge.set_truth(truth);
          judge.check(rays, shoot_cell(target, triangles, rays, with_distances), {},
                      with_distances && profile.is_exact ? Judge::Form::kDistance : Judge::Form::kTriangle,
                      "the Cell's numbers");
          with_distances = !with_distances;
        }
        EXPECT_EQ(judge.failures(), 0u) << profile.name;
        checked += judge.checked();
      }
    }
  }
  EXPECT_GT(checked, 5000u);

  std::uint64_t touched_count = 0;
  const GridRecord grids[] = {
      grid_of(Vec3(0.0f), Vec3(1.0f), {8, 8, 8}, 1), grid_of({-16, 0, 4}, {0.5f, 2, 1}, {16, 5, 9}, 3),
      grid_of({0x1p20f, -0x1p20f, 0}, Vec3(8.0f), {32, 24, 40}, 6),
      grid_of({1e-20f, 0, -3e-20f}, Vec3(7e20f), {30, 1, 17}, 4), grid_of(Vec3(-1e19f), Vec3(3e-18f), {60, 60, 60}, 8)};
  for (const GridRecord& grid : grids) {
    TestRandom random(40);
    for (std::uint32_t i = 0; i < times(300); ++i) {
      // From inside the grid or next to it, often from faces; along axes, in faces, anywhere, and with invalid
      // directions.
      float origin[3], dir[3];
      for (std::uint32_t axis = 0; axis < 3; ++axis) {
        const auto cells = static_cast<float>(grid.cell_count[axis]);
        float place = random.between(-0.5f, 1.5f) * cells;
        if (random.below(2) == 0) place = std::floor(place);
        origin[axis] = grid.minimum[axis] + place / grid.cells_per_unit[axis];
        dir[axis] = (random.below(4) == 0 ? 0.0f : random.between(-1, 1)) / grid.cells_per_unit[axis];
        if (i % 7 == 0) dir[axis] = static_cast<float>(random.below(3)) - 1.0f;
      }
      std::uint64_t steps = 0;
      std::vector<std::uint64_t> visited =
          hard_cell::visited_cells(reinterpret_cast<const unsigned char*>(&grid), origin, dir, steps);
      std::sort(visited.begin(), visited.end());
      ASSERT_TRUE(std::adjacent_find(visited.begin(), visited.end()) == visited.end());
      const std::uint64_t cells = std::uint64_t{grid.cell_count[0]} * grid.cell_count[1] * grid.cell_count[2];
      ASSERT_LE(steps, 8 * cells);
      if (dir[0] == 0.0f && dir[1] == 0.0f && dir[2] == 0.0f) {
        ASSERT_TRUE(visited.empty());
        continue;
      }
      OracleRay ray{};
      std::memcpy(ray.origin, origin, sizeof origin);
      std::memcpy(ray.direction, dir, sizeof dir);
      for (const CellIndex& cell : touched_cells(grid, ray)) {
        const std::uint64_t id =
            (static_cast<std::uint64_t>(cell[2]) * grid.cell_count[1] + static_cast<std::uint64_t>(cell[1])) *
                grid.cell_count[0] +
            static_cast<std::uint64_t>(cell[0]);
        ASSERT_TRUE(std::binary_search(visited.begin(), visited.end(), id))
            << "grid " << &grid - grids << ", ray " << i << " touches " << cell[0] << ", " << cell[1] << ", " << cell[2]
            << " from " << std::hexfloat << origin[0] << ", " << origin[1] << ", " << origin[2] << " along " << dir[0]
            << ", " << dir[1] << ", " << dir[2];
        ++touched_count;
      }
    }
  }
  EXPECT_GT(touched_count, 5000u);
}

}  // namespace
}  // namespace gridiron::test::hard
