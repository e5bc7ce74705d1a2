// Cells of single triangles against rational arithmetic. SPDX-License-Identifier: Apache-2.0
#include <gridiron/build/grid/cell_rows.h>

#include "core/build/grid/exact_overlap.h"
#include "support/test_mesh.h"

namespace gridiron::test {
namespace {

using Cell = std::array<int, 3>;

GridRecord make_grid(Vec3 minimum, Vec3 cells_per_unit, std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  GridRecord grid{};
  const std::uint32_t counts[3] = {x, y, z};
  for (int axis = 0; axis < 3; ++axis) {
    grid.minimum[axis] = minimum[axis];
    grid.cells_per_unit[axis] = cells_per_unit[axis];
    grid.cell_count[axis] = counts[axis];
  }
  return grid;
}

std::set<Cell> listed_cells(const GridRecord& grid, Vec3 a, Vec3 b, Vec3 c) {
  std::set<Cell> cells;
  for_each_cell_row(CellBox::of(CellSpace::of(grid), a, b, c), [&](int x0, int x1, int y, int z) {
    EXPECT_LE(x0, x1);
    for (int x = x0; x <= x1; ++x) EXPECT_TRUE(cells.insert({x, y, z}).second) << "listed twice";
  });
  return cells;
}

// Every touched cell listed, every listed cell all but touched.
void expect_right_cells(const GridRecord& grid, Vec3 a, Vec3 b, Vec3 c, const std::string& what) {
  const std::set<Cell> listed = listed_cells(grid, a, b, c);
  const std::array<RationalPoint, 3> triangle = {exact_cell_point(grid, a), exact_cell_point(grid, b),
                                                 exact_cell_point(grid, c)};
  const Rational grown = Rational(1, boost::multiprecision::cpp_int(1) << 34);
  for (int z = 0; z < static_cast<int>(grid.cell_count[2]); ++z) {
    for (int y = 0; y < static_cast<int>(grid.cell_count[1]); ++y) {
      for (int x = 0; x < static_cast<int>(grid.cell_count[0]); ++x) {
        const Cell cell = {x, y, z};
        if (listed.contains(cell)) {
          EXPECT_TRUE(touches_cell(triangle, cell, grown)) << what << ": extra cell " << x << ' ' << y << ' ' << z;
        } else {
          EXPECT_FALSE(touches_cell(triangle, cell, 0)) << what << ": lost cell " << x << ' ' << y << ' ' << z;
        }
      }
    }
  }
  for (const Cell& cell : listed) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      EXPECT_GE(cell[axis], 0) << what;
      EXPECT_LT(cell[axis], static_cast<int>(grid.cell_count[axis])) << what;
    }
  }
}

class RandomTriangles : public ::testing::TestWithParam<int> {};

// Corners anywhere, on a lattice of half cells (faces, edges and corners of cells), and close together.
TEST_P(RandomTriangles, TouchExactlyTheListedCells) {
  const auto seed = static_cast<std::uint64_t>(GetParam());
  TestRandom random(seed);
  const Vec3 scale(random.between(0.1f, 3.0f), random.between(0.1f, 3.0f), random.between(0.1f, 3.0f));
  const Vec3 minimum(random.between(-9.0f, 9.0f), random.between(-9.0f, 9.0f), random.between(-9.0f, 9.0f));
  const GridRecord skewed = make_grid(minimum, scale, 5, 4, 6);
  const GridRecord plain = make_grid(Vec3(0), Vec3(1), 4, 5, 4);
  for (int i = 0; i < 6; ++i) {
    const std::string what = "seed " + std::to_string(seed) + " triangle " + std::to_string(i);
    Vec3 p[3];
    const auto inside = [&](const GridRecord& grid, int axis, float unit) {
      const auto k = static_cast<std::size_t>(axis);
      return grid.minimum[k] + 0.999f * unit * static_cast<float>(grid.cell_count[k]) / grid.cells_per_unit[k];
    };
    for (Vec3& corner : p) {
      for (int axis = 0; axis < 3; ++axis) corner[axis] = inside(skewed, axis, random.unit());
    }
    expect_right_cells(skewed, p[0], p[1], p[2], what + " anywhere");
    for (Vec3& corner : p) {
      for (int axis = 0; axis < 3; ++axis) {
        const auto steps = 2 * plain.cell_count[static_cast<std::size_t>(axis)] + 1;
        corner[axis] = 0.5f * static_cast<float>(random.below(steps));
      }
    }
    expect_right_cells(plain, p[0], p[1], p[2], what + " lattice");
    const float size = i % 2 == 0 ? 0.7f : 1.6f;
    const Vec3 centre(random.between(size, 4.0f - size), random.between(size, 5.0f - size),
                      random.between(size, 4.0f - size));
    for (Vec3& corner : p) {
      corner = centre + size * Vec3(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1));
    }
    expect_right_cells(plain, p[0], p[1], p[2], what + " small");
  }
}
INSTANTIATE_TEST_SUITE_P(Seeds, RandomTriangles, ::testing::Range(0, 12));

TEST(CellRows, FlatTriangleOnAFaceOfCellsIsOnBothSides) {
  const GridRecord grid = make_grid(Vec3(0), Vec3(1), 4, 4, 4);
  for (int axis = 0; axis < 3; ++axis) {
    Vec3 a(0.25f, 0.25f, 0.25f), b(3.75f, 0.5f, 0.5f), c(0.5f, 3.75f, 3.5f);
    if (axis == 1) b = Vec3(0.5f, 0.5f, 3.75f);
    a[axis] = b[axis] = c[axis] = 2.0f;
    expect_right_cells(grid, a, b, c, "axis " + std::to_string(axis));
    const std::set<Cell> cells = listed_cells(grid, a, b, c);
    std::set<int> layers;
    for (const Cell& cell : cells) layers.insert(cell[static_cast<std::size_t>(axis)]);
    EXPECT_EQ(layers, (std::set<int>{1, 2})) << "axis " << axis;
  }
}

TEST(CellRows, TriangleTouchingACellAtItsCornerOnlyIsInIt) {
  const GridRecord grid = make_grid(Vec3(0), Vec3(1), 3, 3, 3);
  // x + y + z = 3 passes through (1, 1, 1), the corner of cell (0, 0, 0) and of cell (1, 1, 1).
  const std::set<Cell> cells = listed_cells(grid, {3, 0, 0}, {0, 3, 0}, {0, 0, 3});
  EXPECT_TRUE(cells.contains({0, 0, 0}));
  EXPECT_TRUE(cells.contains({1, 1, 1}));
  EXPECT_FALSE(cells.contains({2, 2, 2}));
  expect_right_cells(grid, {3, 0, 0}, {0, 3, 0}, {0, 0, 3}, "diagonal plane");
}

// Cell coordinate 1 + 2^-30 is a float's worth away from nothing, but it is not 1: the pad must not reach that far.
TEST(CellRows, ATriangleJustBeyondAFaceIsNotInTheCellBefore) {
  const GridRecord grid = make_grid(Vec3(-1), Vec3(1), 3, 3, 3);
  for (int axis = 0; axis < 3; ++axis) {
    for (const float gap : {0x1p-30f, 0x1p-33f}) {
      Vec3 a(gap), b(gap), c(gap);
      b[(axis + 1) % 3] = c[(axis + 2) % 3] = 1.5f;
      const std::string what = "axis " + std::to_string(axis) + " gap " + std::to_string(gap);
      expect_right_cells(grid, a, b, c, what);
      for (const Cell& cell : listed_cells(grid, a, b, c)) EXPECT_GE(cell[static_cast<std::size_t>(axis)], 1) << what;
    }
    Vec3 a(0), b(0), c(0);
    b[(axis + 1) % 3] = c[(axis + 2) % 3] = 1.5f;
    std::set<int> layers;
    for (const Cell& cell : listed_cells(grid, a, b, c)) layers.insert(cell[static_cast<std::size_t>(axis)]);
    EXPECT_EQ(layers, (std::set<int>{0, 1})) << "axis " << axis;
  }
}

TEST(CellRows, NeedleAlongTheDiagonalTakesItsCellsNotItsBox) {
  const GridRecord grid = make_grid(Vec3(0), Vec3(2048.0f), 2048, 2048, 2048);
  const std::set<Cell> cells = listed_cells(grid, {0, 0, 0}, {1, 1, 1}, {0.99999f, 1, 1});
  EXPECT_GE(cells.size(), 2048u);
  EXPECT_LT(cells.size(), 30u * 2048u);
}

TEST(CellRows, ScaledByPowersOfTenItStaysExact) {
  TestRandom random(77);
  for (const float scale : {1e30f, 1e-30f, 1e-38f, 1e37f}) {
    const GridRecord grid = make_grid(Vec3(-scale), Vec3(2.0f / scale * 0.999f), 4, 4, 4);
    for (int i = 0; i < 4; ++i) {
      Vec3 p[3];
      for (Vec3& corner : p) {
        corner = scale * Vec3(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1));
      }
      expect_right_cells(grid, p[0], p[1], p[2], "scale " + std::to_string(scale) + " triangle " + std::to_string(i));
    }
  }
}

}  // namespace
}  // namespace gridiron::test
