// Cells along a ray against rational numbers, cell by cell, and with the filter against without.
// SPDX-License-Identifier: Apache-2.0
#include "numeric/exact_cells.h"

#include "core/seeds.h"
#include "support/test_mesh.h"

namespace gridiron::test {
namespace {

struct GridCase {
  GridRecord grid{};
  OracleRay ray{};
};

// Grids of few cells, where every cell can be asked, or of many; rays from faces, edges and corners, at corners, along
// faces and diagonals, with zeros, with limits, at any size and offset.
GridCase make_case(std::uint64_t seed, std::uint32_t most_cells) {
  TestRandom random(seed);
  GridCase result;
  const bool is_even = random.below(2) == 0;  // cell boundaries are floats
  const float size = std::ldexp(1.0f, random.below(4) == 0 ? static_cast<int>(random.below(121)) - 60 : 0);
  const float offset = random.below(4) == 0 ? std::ldexp(size, static_cast<int>(random.below(20))) : 0.0f;
  for (int axis = 0; axis < 3; ++axis) {
    result.grid.cell_count[axis] = 1 + random.below(most_cells);
    const float unit = is_even ? 1.0f : random.between(0.5f, 2.0f);
    result.grid.cells_per_unit[axis] = unit / size;
    result.grid.minimum[axis] =
        offset + size * (is_even ? static_cast<float>(random.below(5)) - 2.0f : random.between(-2.0f, 2.0f));
  }
  const auto point = [&](int axis, float cells) {
    return result.grid.minimum[axis] + cells / result.grid.cells_per_unit[axis];
  };
  const bool is_diagonal = random.below(6) == 0;
  const float slope = random.between(0.25f, 2.0f);
  for (int axis = 0; axis < 3; ++axis) {
    const std::uint32_t count = result.grid.cell_count[axis];
    const auto place = [&](float beside) {  // in cells
      if (random.below(2) == 0) return static_cast<float>(random.below(count + 1));
      return random.between(-beside, static_cast<float>(count) + beside);
    };
    const float from = place(2.0f);
    result.ray.origin[axis] = point(axis, from);
    result.ray.direction[axis] = point(axis, place(0.0f)) - result.ray.origin[axis];
    if (is_diagonal) {
      result.ray.origin[axis] = point(axis, random.below(2) == 0 ? 0.0f : static_cast<float>(count));
      result.ray.direction[axis] = (result.ray.origin[axis] == point(axis, 0.0f) ? slope : -slope) * size;
    }
    if (random.below(6) == 0) result.ray.direction[axis] = random.below(2) == 0 ? 0.0f : -0.0f;
    if (random.below(20) == 0) result.ray.direction[axis] = (random.below(2) == 0 ? 1.0f : -1.0f) * 0x1p-140f;
  }
  if (random.below(3) == 0) result.ray.t_min = 0.25f * static_cast<float>(random.below(5));
  if (random.below(3) == 0) result.ray.t_max = result.ray.t_min + 0.25f * static_cast<float>(random.below(5));
  return result;
}

// Does the closed cell hold a point between the closed limits? The parameters that each axis allows, in rationals.
bool naive_touch(const GridCase& shown, const CellIndex& cell) {
  Rational low = exact_rational(shown.ray.t_min);
  Rational high = exact_rational(shown.ray.t_max);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Rational scale = exact_rational(shown.grid.cells_per_unit[axis]);
    const Rational minimum = exact_rational(shown.grid.minimum[axis]);
    const Rational below = minimum + Rational(cell[axis]) / scale - exact_rational(shown.ray.origin[axis]);
    const Rational above = minimum + Rational(cell[axis] + 1) / scale - exact_rational(shown.ray.origin[axis]);
    const Rational direction = exact_rational(shown.ray.direction[axis]);
    if (direction == 0) {
      if (below > 0 || above < 0) return false;
      continue;
    }
    const Rational a = below / direction, b = above / direction;
    low = std::max(low, std::min(a, b));
    high = std::min(high, std::max(a, b));
  }
  return low <= high;
}

TEST(ExactCells, AreThoseThatRationalNumbersSay) {
  std::uint64_t cell_count = 0, empty_count = 0, repeated = 0;
  for_each_seed(3000, [&](std::uint64_t seed) {
    const GridCase shown = make_case(seed, 5);
    const std::vector<CellIndex> found = touched_cells(shown.grid, shown.ray);
    const std::set<CellIndex> once(found.begin(), found.end());
    repeated += found.size() - once.size();
    std::set<CellIndex> wanted;
    for (int z = 0; z < static_cast<int>(shown.grid.cell_count[2]); ++z) {
      for (int y = 0; y < static_cast<int>(shown.grid.cell_count[1]); ++y) {
        for (int x = 0; x < static_cast<int>(shown.grid.cell_count[0]); ++x) {
          if (naive_touch(shown, {x, y, z})) wanted.insert({x, y, z});
        }
      }
    }
    ASSERT_EQ(once, wanted) << "seed " << seed;
    cell_count += wanted.size();
    empty_count += wanted.empty();
  });
  EXPECT_EQ(repeated, 0u);
  if (std::getenv("GRIDIRON_TEST_SEED") != nullptr) return;
  EXPECT_GT(cell_count, 6000u);
  EXPECT_GT(empty_count, 100u);
}

TEST(ExactCells, FilterChangesNothing) {
  CellCounts fast, slow;
  std::uint64_t rays = 0;
  const auto compare = [&](std::uint64_t seed, std::uint32_t most_cells) {
    const GridCase shown = make_case(seed, most_cells);
    const std::vector<CellIndex> filtered = touched_cells(shown.grid, shown.ray, true, &fast);
    ASSERT_EQ(filtered, touched_cells(shown.grid, shown.ray, false, &slow)) << "seed " << seed;
    ++rays;
  };
  for_each_seed(100000, [&](std::uint64_t seed) { compare(10000 + seed, 9); });
  for_each_seed(2000, [&](std::uint64_t seed) { compare(200000 + seed, 200); });
  if (std::getenv("GRIDIRON_TEST_SEED") != nullptr) return;
  EXPECT_EQ(rays, 102000u);
  EXPECT_EQ(fast.cells, slow.cells);
  EXPECT_LT(fast.exact_orders * 3, slow.exact_orders);
}

TEST(ExactCells, TiesThatDoublesMissAreTies) {
  // Cells of 1/3, 1/7 and 1/5, no floats, and a ray along their diagonal: it passes every corner on its way.
  constexpr std::uint32_t kCells = 100;
  const float minimum[3] = {0.1f, -3.7f, 1000.0f};
  const float scale[3] = {3.0f, 7.0f, 5.0f};
  GridRecord grid{};
  for (int axis = 0; axis < 3; ++axis) {
    grid.minimum[axis] = minimum[axis];
    grid.cells_per_unit[axis] = scale[axis];
    grid.cell_count[axis] = kCells;
  }
  const OracleRay ray = {{0.1f, -3.7f, 1000.0f}, {35.0f, 15.0f, 21.0f}};
  EXPECT_EQ(touched_cells(grid, ray).size(), 1u + 7u * (kCells - 1));
  EXPECT_EQ(touched_cells(grid, ray), touched_cells(grid, ray, false));
}

TEST(ExactCells, FacesEdgesAndCornersBelongToAllBeside) {
  GridRecord grid{};
  for (int axis = 0; axis < 3; ++axis) {
    grid.cells_per_unit[axis] = 1.0f;
    grid.cell_count[axis] = 2;
  }
  const auto count = [&](const OracleRay& ray) { return touched_cells(grid, ray).size(); };
  EXPECT_EQ(count({{0, 0, 0}, {1, 1, 1}}), 8u) << "through the middle corner";
  EXPECT_EQ(count({{0, 0, 0}, {1, 1, 1}, 0, 0.5f}), 1u);
  EXPECT_EQ(count({{0, 0, 0}, {1, 1, 1}, 0, std::nextafter(1.0f, 0.0f)}), 1u);
  EXPECT_EQ(count({{0, 0, 0}, {1, 1, 1}, 1, 1}), 8u) << "a single point";
  EXPECT_EQ(count({{1, 1, -1}, {0, 0, 1}}), 8u) << "along an edge";
  EXPECT_EQ(count({{1, 0.5f, -1}, {0, 0, 1}}), 4u) << "in a face";
  EXPECT_EQ(count({{2, 0.5f, -1}, {0, 0, 1}}), 2u) << "in a face of the grid";
  EXPECT_EQ(count({{std::nextafter(2.0f, 3.0f), 0.5f, -1}, {0, 0, 1}}), 0u);
  EXPECT_EQ(count({{2, 0.5f, 0.5f}, {1, 0, 0}}), 1u) << "away from the face it starts on";
  EXPECT_EQ(count({{2, 0.5f, 0.5f}, {-1, 0, 0}}), 2u);
  EXPECT_EQ(count({{3, 1, 0}, {-1, 1, 0}}), 1u) << "touches an edge of the grid";
  EXPECT_EQ(count({{-1, 0.5f, 0.5f}, {1, 0, 0}, 0, 1}), 1u) << "ends on the face";
  EXPECT_EQ(count({{1, 1, 1}, {0, 0, 0}}), 8u) << "no direction: a point";
  EXPECT_EQ(count({{-1, 1, 1}, {0, 0, 0}}), 0u);
}

}  // namespace
}  // namespace gridiron::test
