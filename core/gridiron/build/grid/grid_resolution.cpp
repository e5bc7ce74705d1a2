// Resolution of a grid: see the header. SPDX-License-Identifier: Apache-2.0
#include <gridiron/build/grid/grid_resolution.h>

#include <bit>

namespace gridiron {
namespace {

// Both roots: Newton's iteration from a guess with an error of at most 6 % (the exponent divided, the mantissa bits
// carried along). Four steps bring it below 2^-53, the fifth settles rounding. x > 0, normal, far from the ends of
// double.
double square_root(double x) {
  double root = std::bit_cast<double>((std::bit_cast<std::uint64_t>(x) + (std::uint64_t{1023} << 52)) / 2);
  for (int i = 0; i < 5; ++i) root = 0.5 * (root + x / root);
  return root;
}

double cube_root(double x) {
  double root = std::bit_cast<double>((std::bit_cast<std::uint64_t>(x) + (std::uint64_t{2046} << 52)) / 3);
  for (int i = 0; i < 5; ++i) root = (2.0 * root + x / (root * root)) / 3.0;
  return root;
}

// N_axis = L_axis * (lambda n / product of L)^(1 / dimensions). An axis that would get less than one cell gets one and
// leaves the equation, which is applied again to the others.
void solve_resolution(const double extent[3], double wanted_cells, std::uint32_t cell_count[3]) {
  bool open[3];
  for (int axis = 0; axis < 3; ++axis) {
    open[axis] = extent[axis] > 0.0;
    cell_count[axis] = 1;
  }
  for (int round = 0; round < 3; ++round) {
    int dimensions = 0;
    double volume = 1.0;
    for (int axis = 0; axis < 3; ++axis) {
      if (!open[axis]) continue;
      ++dimensions;
      volume *= extent[axis];
    }
    if (dimensions == 0) return;
    const double density = wanted_cells / volume;
    const double per_unit = dimensions == 3 ? cube_root(density) : dimensions == 2 ? square_root(density) : density;
    bool closed_one = false;
    for (int axis = 0; axis < 3; ++axis) {
      if (!open[axis]) continue;
      const double cells = extent[axis] * per_unit;
      if (cells < 1.0) {
        open[axis] = false;
        closed_one = true;
        cell_count[axis] = 1;
      } else {
        cell_count[axis] = cells < double{kMaxCellsPerAxis} ? static_cast<std::uint32_t>(cells) : kMaxCellsPerAxis;
      }
    }
    if (!closed_one) return;
  }
}

// Cells per unit as a float, such that (maximum - minimum) * result <= cell_count as real numbers: the factor takes
// back the quotient's three roundings of 2^-53 at most, and the conversion to float rounds down. The result is at most
// `greatest`; an axis then gets fewer cells, and none of them is unused.
float cells_per_unit_of(double extent, float greatest, std::uint32_t& cell_count) {
  if (!(extent > 0.0)) return 1.0f;
  const double quotient = static_cast<double>(cell_count) / extent * (1.0 - 0x1p-50);
  if (quotient >= double{greatest}) {
    const double cells = extent * double{greatest} + 1.0;
    if (cells < static_cast<double>(cell_count)) cell_count = static_cast<std::uint32_t>(cells);
    return greatest;
  }
  const float nearest = static_cast<float>(quotient);
  if (double{nearest} <= quotient) return nearest;
  return std::bit_cast<float>(std::bit_cast<std::uint32_t>(nearest) - 1);
}

}  // namespace

void resolve_grid(std::uint64_t triangle_count, GridRecord& grid) {
  double extent[3];
  for (int axis = 0; axis < 3; ++axis) {
    grid.minimum[axis] = grid.bounds_minimum[axis];
    extent[axis] = double{grid.bounds_maximum[axis]} - double{grid.bounds_minimum[axis]};
  }
  solve_resolution(extent, double{grid.lambda} * static_cast<double>(triangle_count), grid.cell_count);
  // An axis of one cell is scaled like the others: a mesh that is almost flat leaves most of that cell empty.
  float greatest = 0.0f;
  for (int axis = 0; axis < 3; ++axis) {
    grid.cells_per_unit[axis] = 0.0f;
    if (grid.cell_count[axis] == 1) continue;
    grid.cells_per_unit[axis] = cells_per_unit_of(extent[axis], kGreatestCellsPerUnit, grid.cell_count[axis]);
    greatest = grid.cells_per_unit[axis] > greatest ? grid.cells_per_unit[axis] : greatest;
  }
  if (greatest == 0.0f) greatest = kGreatestCellsPerUnit;
  for (int axis = 0; axis < 3; ++axis) {
    if (grid.cells_per_unit[axis] == 0.0f) {
      grid.cells_per_unit[axis] = cells_per_unit_of(extent[axis], greatest, grid.cell_count[axis]);
    }
    grid.macro_cell_count[axis] = (grid.cell_count[axis] + grid.macro_width - 1) / grid.macro_width;
  }
}

// With 1e-6 cells wanted in all, every round of solve_resolution closes an axis.
void resolve_empty_grid(GridRecord& grid) {
  grid.lambda = kLeastLambda;
  grid.macro_width = 1;
  resolve_grid(1, grid);
}

}  // namespace gridiron
