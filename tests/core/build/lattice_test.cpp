// Lattices: their places, their steps, and images built on them. SPDX-License-Identifier: Apache-2.0
#include <gridiron/build/lattice.h>

#include "core/build/grid/built_image.h"
#include "support/test_mesh.h"

namespace gridiron::test {
namespace {

Lattice lattice_of(const TestMesh& mesh) {
  Lattice lattice{};
  EXPECT_EQ(find_lattice(mesh.view(), lattice), Status::kOk);
  return lattice;
}

struct Placed {
  const char* name;
  float scale;
  Vec3 offset;
};
const Placed kPlaces[] = {
    {"unit", 1.0f, {0, 0, 0}},          {"aside", 1.0f, {16, -16, 0.5f}},      {"far", 1.0f, {148376, 1234, -223423}},
    {"million", 1.0f, {1e6f, 1e6f, 0}}, {"tiny", 1e-30f, {0, 0, 0}},           {"huge", 1e30f, {0, 0, 0}},
    {"speck", 1e-37f, {0, 0, 0}},       {"limit", 0x1p119f, {0, 0, 0}},        {"speck_far", 1e-3f, {1e6f, 0, 0}},
    {"negative", 3.7f, {-50, -60, -7}}, {"flat_away", 1.0f, {0, 0x1p100f, 0}},
};

TEST(Lattice, HoldsEveryVertexWithinHalfAStepAsAFloat) {
  for (const Placed& place : kPlaces) {
    const TestMesh mesh = moved(make_random_soup(400, 0.3f, 11), place.scale, place.offset);
    const Lattice lattice = lattice_of(mesh);
    EXPECT_GE(lattice.step, kLeastLatticeStep);
    int exponent = 0;
    EXPECT_EQ(std::frexp(lattice.step, &exponent), 0.5f) << place.name << ": a power of two";
    for (const Vec3& vertex : mesh.vertices) {
      const Vec3 snapped = snap(lattice, vertex);
      const LatticePoint point = lattice_point(lattice, vertex);
      for (int axis = 0; axis < 3; ++axis) {
        // In double the sum is exact: it must be the float's very value.
        const double exact = double{lattice.origin[axis]} + double{lattice.step} * point.place[axis];
        EXPECT_EQ(double{snapped[axis]}, exact) << place.name;
        EXPECT_LE(std::fabs(double{snapped[axis]} - double{vertex[axis]}), 0.5 * double{lattice.step}) << place.name;
        EXPECT_LE(std::fabs(snapped[axis]), kCoordinateLimit) << place.name;
      }
      EXPECT_EQ(snap(lattice, snapped), snapped) << place.name;
    }
  }
}

TEST(Lattice, HasTheLeastStepThatSpansTheMesh) {
  // 65,534 steps and one for the origin: a mesh that wide has a step of one, a wider one of two.
  const auto step_of = [](float width, float from) {
    return lattice_of(make_triangle({from, 0, 0}, {from + width, 1, 0}, {from, 0, 1})).step;
  };
  EXPECT_EQ(step_of(65534.0f, 0.0f), 1.0f);
  EXPECT_EQ(step_of(65535.0f, 0.0f), 2.0f);
  EXPECT_EQ(step_of(32767.0f, 0.0f), 0.5f);
  EXPECT_EQ(step_of(1.0f, 0.0f), 0x1p-15f);
  EXPECT_EQ(step_of(65534.0f, 0.25f), 1.0f);
  EXPECT_EQ(step_of(1.0f, 0x1p23f), 1.0f) << "no finer than floats are there";
  EXPECT_EQ(step_of(1.0f, 0x1p22f), 0.5f);
  EXPECT_EQ(step_of(1.0f, 0x1p24f - 0x1p17f - 1.0f), 1.0f);
  EXPECT_EQ(step_of(2.0f, 0x1p24f - 0x1p17f), 2.0f);
}

TEST(Lattice, OfVerticesThatNoTriangleHasTakesNoNotice) {
  TestMesh mesh = make_triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  const Lattice lattice = lattice_of(mesh);
  mesh.vertices.emplace_back(1e9f, -1e9f, 5.0f);
  const Lattice same = lattice_of(mesh);
  EXPECT_EQ(same.step, lattice.step);
  EXPECT_EQ(snap(same, {1e9f, -1e9f, 5.0f}), (Vec3{65535 * 0x1p-15f, 0, 65535 * 0x1p-15f})) << "and they are clamped";
}

TEST(Lattice, OfBadMeshesIsRefused) {
  Lattice lattice{};
  TestMesh mesh = make_triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  mesh.triangles[0].y = 3;
  EXPECT_EQ(find_lattice(mesh.view(), lattice), Status::kBadIndex);
  for (const float bad :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), 0x1.8p120f}) {
    mesh = make_triangle({0, 0, 0}, {1, bad, 0}, {0, 1, 0});
    EXPECT_EQ(find_lattice(mesh.view(), lattice), Status::kBadVertex);
    GridNeed need{};
    EXPECT_EQ(count_scene_image(mesh.view(), {4.0f, 6, TriangleFormat::kLattice}, need), Status::kBadVertex);
  }
  EXPECT_EQ(find_lattice({}, lattice), Status::kOk);
}

// Every record is its triangle's vertices on the lattice, and the cells hold what they hold of the snapped mesh itself;
// where that has fewer triangles of an area, the resolution is that of the mesh before.
TEST(LatticeImage, IsTheSnappedMeshInHalfTheBytes) {
  int same_cells = 0, other_cells = 0;
  for (const Placed& place : kPlaces) {
    const TestMesh mesh =
        moved(joined(make_torus(24, 12, 1.0f, 0.4f), make_random_soup(30, 0.2f, 5)), place.scale, place.offset);
    TestMesh snapped = mesh;
    snapped.snap();
    GridNeed plain_need{};
    const Status status = count_scene_image(snapped.view(), {4.0f, 6, TriangleFormat::kVertices}, plain_need);
    GridNeed need{};
    ASSERT_EQ(count_scene_image(mesh.view(), {4.0f, 6, TriangleFormat::kLattice}, need), status) << place.name;
    if (status != Status::kOk) continue;  // on a lattice as coarse as the mesh nothing has an area
    const BuiltImage unmoved = build_image(mesh.view(), {4.0f, 6, TriangleFormat::kVertices});
    const BuiltImage plain = build_image(snapped.view(), {4.0f, 6, TriangleFormat::kVertices});
    const BuiltImage built = build_image(mesh.view(), {4.0f, 6, TriangleFormat::kLattice});
    ASSERT_FALSE(HasFailure()) << place.name;
    const GridRecord& grid = built.view.grid;
    EXPECT_EQ(grid.triangle_bytes, 24u);
    EXPECT_EQ(grid.cell_block_bytes, 896u) << "217 bounds";
    EXPECT_EQ(built.need.dropped_triangle_count, plain.need.dropped_triangle_count) << place.name;
    if (plain.need.dropped_triangle_count == unmoved.need.dropped_triangle_count) {
      ++same_cells;
      EXPECT_EQ(built.cells, plain.cells) << place.name;
    } else {
      ++other_cells;
      EXPECT_GE(2 * built.cells.size(), unmoved.cells.size()) << place.name;
    }
    for (std::uint64_t i = 0; i < grid.reference_count; ++i) {
      const auto record = read_record<LatticeTriangle>(built.image.bytes(), built.view.triangles_offset_bytes + i * 24);
      ASSERT_LT(record.triangle_id, snapped.triangles.size()) << place.name;
      const UVec3& vertices = snapped.triangles[record.triangle_id];
      EXPECT_EQ(record.reserved, 0);
      for (int corner = 0; corner < 3; ++corner) {
        for (int axis = 0; axis < 3; ++axis) {
          const double stored = double{grid.lattice.origin[axis]} + double{grid.lattice.step} * record.v[corner][axis];
          EXPECT_EQ(stored, double{snapped.vertices[vertices[corner]][axis]}) << place.name;
        }
      }
    }
  }
  EXPECT_GT(same_cells, 2);
  EXPECT_GT(other_cells, 0);
}

// The widest meshes there are: the lattice reaches beyond the limit of coordinates, its triangles do not.
TEST(LatticeImage, OfMeshesAsWideAsCoordinatesGoIsValid) {
  const float end = kCoordinateLimit;
  const TestMesh meshes[] = {
      make_triangle({0x1p118f, 0, 0}, {0x1p119f, 0, 0}, {0x1p118f, end, 0}),
      make_triangle({0x1p119f, 0, 0}, {end, 0, 0}, {0x1p119f, end, 1}),
      make_triangle({-end, 0, 0}, {end, 0, 0}, {0x1p119f, end, 0x1p110f}),
  };
  for (const TestMesh& mesh : meshes) {
    const BuiltImage built = build_image(mesh.view(), {4.0f, 6, TriangleFormat::kLattice});
    EXPECT_GE(built.view.grid.reference_count, 1u);
  }
}

// Mixed scales lose precision: a small object in a large room keeps few places.
TEST(LatticeImage, LosesWhatIsSmallerThanAStep) {
  const TestMesh mesh = joined(make_box({-100, -100, -100}, {100, 100, 100}), make_sphere(40, 80, 0.05f));
  const Lattice lattice = lattice_of(mesh);
  EXPECT_EQ(lattice.step, 0x1p-8f);
  std::set<float> places;
  for (const Vec3& vertex : mesh.vertices) {
    const Vec3 snapped = snap(lattice, vertex);
    if (std::fabs(snapped.x) < 1.0f) places.insert(snapped.x);
  }
  EXPECT_EQ(places.size(), 27u) << "0.1 units of 2^-8";
  GridNeed need{};
  ASSERT_EQ(count_scene_image(mesh.view(), {4.0f, 6, TriangleFormat::kLattice}, need), Status::kOk);
  EXPECT_GT(need.dropped_triangle_count, 0u);
}

}  // namespace
}  // namespace gridiron::test
