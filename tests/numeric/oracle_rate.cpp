// How fast the oracle answers: CPU time on this machine. Not a test; README.md shows its table.
//   oracle_rate [RAYS]      RAYS: of each kind, default 100000
// SPDX-License-Identifier: Apache-2.0
#include <ctime>

#include "numeric/exact_cells.h"
#include "numeric/hard_rays.h"
#include "numeric/oracle.h"
#include "support/test_mesh.h"

namespace gridiron::test {
namespace {

// CPU time, so that other programs on the machine do not count.
class Clock {
 public:
  [[nodiscard]] double seconds() const { return static_cast<double>(std::clock() - start_) / CLOCKS_PER_SEC; }

 private:
  std::clock_t start_ = std::clock();
};

double share(std::uint64_t part, std::uint64_t whole) {
  return static_cast<double>(part) / static_cast<double>(whole);
}

void measure_mesh(const char* name, const TestMesh& mesh, Aim aim, std::size_t count) {
  TestRandom random(1);
  std::vector<OracleRay> rays;
  Vec3 low = mesh.vertices[0], high = low;
  for (const Vec3& v : mesh.vertices) {
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = std::fmin(low[axis], v[axis]);
      high[axis] = std::fmax(high[axis], v[axis]);
    }
  }
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 place(random.unit(), random.unit(), random.unit());
    rays.push_back(ray_at(mesh, low + place * (high - low), aim, random));
  }
  const Clock building;
  const Oracle oracle(mesh.view());
  const double built = building.seconds();
  OracleCounts counts;
  const Clock tracing;
  (void)oracle.nearest(rays, 1, &counts);
  const double seconds = tracing.seconds();
  const char* const aims[] = {"vertices", "edges", "insides", "along axes", "edge to edge"};
  std::printf("| %s | %zu | %s | %.1f | %.1f | %.3f | %.3f | %.2f |\n", name, mesh.triangles.size(),
              aims[static_cast<std::size_t>(aim)], 1e6 * seconds / static_cast<double>(count),
              share(counts.pairs, counts.rays), share(counts.exact_sides, counts.rays),
              share(counts.exact_distances, counts.rays), built);
}

void measure_cells(std::uint32_t cells, bool is_diagonal, std::size_t count) {
  TestRandom random(1);
  GridRecord grid{};
  for (int axis = 0; axis < 3; ++axis) {
    grid.cells_per_unit[axis] = static_cast<float>(cells) / 2.0f;
    grid.minimum[axis] = -1.0f;
    grid.cell_count[axis] = cells;
  }
  std::vector<OracleRay> rays(count);
  for (OracleRay& ray : rays) {
    for (int axis = 0; axis < 3; ++axis) {
      ray.origin[axis] = is_diagonal ? -2.0f : random.between(-2, 2);
      ray.direction[axis] = is_diagonal ? 1.0f : random.between(-1, 1) - ray.origin[axis];
    }
  }
  CellCounts counts;
  const Clock tracing;
  for (const OracleRay& ray : rays) (void)touched_cells(grid, ray, true, &counts);
  const double seconds = tracing.seconds();
  std::printf("| %u^3 | %s | %.1f | %.0f | %.0f | %.3f |\n", cells, is_diagonal ? "diagonal" : "random",
              1e6 * seconds / static_cast<double>(count), share(counts.cells, count),
              1e9 * seconds / static_cast<double>(counts.cells), share(counts.exact_orders, count));
}

int run(std::size_t count) {
  const std::pair<const char*, TestMesh> meshes[] = {{"sphere", make_sphere(72, 71, 1.0f)},
                                                     {"height field", make_height_field(224, 0.1f, 1)},
                                                     {"sliver fan", make_sliver_fan(200, 1e-5f)}};
  std::printf("| mesh | triangles | rays at | us a ray | pairs a ray | exact sides | exact distances | build s |\n");
  std::printf("|---|---|---|---|---|---|---|---|\n");
  for (const auto& [name, mesh] : meshes) {
    for (const Aim aim : {Aim::kInside, Aim::kEdge, Aim::kVertex, Aim::kAxis}) measure_mesh(name, mesh, aim, count);
  }
  std::printf("\n| cells | rays | us a ray | cells a ray | ns a cell | exact orders |\n|---|---|---|---|---|---|\n");
  measure_cells(64, false, count);
  measure_cells(512, false, count / 10);
  measure_cells(64, true, count / 100);
  return 0;
}

}  // namespace
}  // namespace gridiron::test

int main(int argc, char** argv) {
  return gridiron::test::run(argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 100000);
}
