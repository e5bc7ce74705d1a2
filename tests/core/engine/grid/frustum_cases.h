// Grids and packets that are hard for a frustum: far origins, cell faces, parallel and almost parallel rays.
// Memory: values. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/engine/grid/frustum.h>

#include "core/ray/exact_ray.h"
#include "support/test_mesh.h"

namespace gridiron::test {

/// A float of either sign with an exponent from [low, high].
inline float random_scale(TestRandom& random, int low, int high) {
  const int exponent = low + static_cast<int>(random.below(static_cast<std::uint32_t>(high - low + 1)));
  return std::ldexp(1.0f + random.unit(), exponent);
}

/// A grid of up to `max_cells` cells per axis, of any proportions, anywhere.
inline GridRecord random_grid(TestRandom& random, std::uint32_t max_cells, std::uint32_t macro_width) {
  GridRecord grid{};
  const float base = random_scale(random, -20, 20);
  const bool cubic = random.below(3) == 0;
  for (int axis = 0; axis < 3; ++axis) {
    const std::uint32_t kind = random.below(4);
    grid.cell_count[axis] = kind == 0 ? 1 : kind == 1 ? max_cells : 1 + random.below(max_cells);
    grid.cells_per_unit[axis] = cubic ? base : base * random_scale(random, -1, 1);
    const float extent = static_cast<float>(grid.cell_count[axis]) / grid.cells_per_unit[axis];
    grid.minimum[axis] = random.below(3) == 0 ? 0.0f : extent * random.between(-100.0f, 100.0f);
    grid.macro_cell_count[axis] = (grid.cell_count[axis] + macro_width - 1) / macro_width;
  }
  grid.macro_width = macro_width;
  return grid;
}

/// A grid of `cells` cells of size 1 per axis, each a macrocell.
inline GridRecord unit_grid(std::uint32_t cells) {
  GridRecord grid{};
  for (int axis = 0; axis < 3; ++axis) {
    grid.cells_per_unit[axis] = 1.0f;
    grid.cell_count[axis] = grid.macro_cell_count[axis] = cells;
  }
  grid.macro_width = 1;
  return grid;
}

/// The rectangle's cells, to be compared: first and last along u, first and last along v.
inline std::array<std::int32_t, 4> ends_of(const CellRect& rect) {
  return {rect.u_first, rect.u_last, rect.v_first, rect.v_last};
}

/// @returns whether a rectangle lies around a box.
inline bool holds(const CellRect& rect, const CellBox& box) {
  return rect.u_first <= box.u.first && rect.u_last >= box.u.last && rect.v_first <= box.v.first &&
         rect.v_last >= box.v.last;
}
/// @returns whether a rectangle is at most a cell larger than a box on every side.
inline bool is_tight(const CellRect& rect, const CellBox& box) {
  return rect.u_first >= box.u.first - 1 && rect.u_last <= box.u.last + 1 && rect.v_first >= box.v.first - 1 &&
         rect.v_last <= box.v.last + 1;
}

/// World position of a point of cell space, rounded.
inline float world_of(const GridRecord& grid, std::uint32_t axis, double cell) {
  return static_cast<float>(double{grid.minimum[axis]} + cell / double{grid.cells_per_unit[axis]});
}

/// A coordinate from a little outside of an axis to a little outside on the other end, often a face of cells.
inline double random_cell(TestRandom& random, const GridRecord& grid, std::uint32_t axis) {
  const auto count = static_cast<double>(grid.cell_count[axis]);
  if (random.below(2) == 0) return static_cast<double>(random.below(grid.cell_count[axis] + 1));
  return count * double{random.between(-0.1f, 1.1f)};
}

/// Fills origin and directions of a packet with a bundle of rays that is hard for the grid.
template <class PacketType>
void random_packet(TestRandom& random, const GridRecord& grid, PacketType& packet) {
  const std::uint32_t place = random.below(4);
  for (std::uint32_t axis = 0; axis < 3; ++axis) {
    const auto count = static_cast<double>(grid.cell_count[axis]);
    double cell = random_cell(random, grid, axis);  // inside, or on a face
    if (place == 1) cell = count * double{random.between(-3.0f, 4.0f)};
    if (place == 2) cell = double{random.between(-1e6f, 1e6f)};
    packet.origin[axis] = world_of(grid, axis, cell);
  }
  const std::uint32_t aim = random.below(6);
  float common[3];
  for (std::uint32_t axis = 0; axis < 3; ++axis) common[axis] = random.between(-1, 1) / grid.cells_per_unit[axis];
  if (aim == 5) common[random.below(3)] = 0.0f;
  const float length = random.below(4) == 0 ? random_scale(random, -20, 20) : 1.0f;
  for (std::uint32_t ray = 0; ray < PacketType::kRayCount; ++ray) {
    for (std::uint32_t axis = 0; axis < 3; ++axis) {
      float value = 0.0f;
      if (aim <= 2) {  // at points of the grid, many on faces: bounds hit integers to the last digit
        value = world_of(grid, axis, random_cell(random, grid, axis)) - packet.origin[axis];
      } else if (aim == 3) {  // anywhere
        value = random.between(-1, 1) / grid.cells_per_unit[axis];
      } else {  // side by side
        value = common[axis] * (1.0f + 0.05f * random.unit());
      }
      packet.dir[axis][ray] = value * length;
    }
    const std::uint32_t special = random.below(8);
    if (special <= 2) packet.dir[random.below(3)][ray] = special == 0 ? 0.0f : special == 1 ? -0.0f : 0x1p-140f;
    if (special == 3) {  // parallel to an axis
      const std::uint32_t axis = random.below(3);
      packet.dir[(axis + 1) % 3][ray] = random.below(2) != 0 ? 0.0f : -0x1p-149f;
      packet.dir[(axis + 2) % 3][ray] = -0.0f;
    }
    packet.t[ray] = kFloatMax;
  }
}

}  // namespace gridiron::test
