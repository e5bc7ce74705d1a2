// Lattice: see the header. SPDX-License-Identifier: Apache-2.0
#include <gridiron/base/lanes.h>
#include <gridiron/build/lattice.h>

#include <bit>

namespace gridiron {
namespace {

constexpr double kLastPlace = kLatticePlaces - 1;

// The least power of two that is not below `value`. value > 0, normal, far from the ends of double.
double power_of_two_from(double value) {
  constexpr std::uint64_t kMantissa = (std::uint64_t{1} << 52) - 1;
  const std::uint64_t bits = std::bit_cast<std::uint64_t>(value);
  return std::bit_cast<double>((bits + kMantissa) & ~kMantissa);
}

// Whole part, downwards; |value| below 2^62.
double floor_of(double value) {
  const double whole = static_cast<double>(static_cast<std::int64_t>(value));
  return whole > value ? whole - 1.0 : whole;
}

}  // namespace

Status find_lattice(const MeshView& mesh, Lattice& lattice) {
  Vec3 low{kFloatMax, kFloatMax, kFloatMax};
  Vec3 high{-kFloatMax, -kFloatMax, -kFloatMax};
  for (const UVec3& triangle : mesh.triangles) {
    for (int corner = 0; corner < 3; ++corner) {
      if (triangle[corner] >= mesh.vertices.size()) return Status::kBadIndex;
      const Vec3& vertex = mesh.vertices[triangle[corner]];
      for (int axis = 0; axis < 3; ++axis) {
        if (!(magnitude(vertex[axis]) <= kCoordinateLimit)) return Status::kBadVertex;
        low[axis] = vertex[axis] < low[axis] ? vertex[axis] : low[axis];
        high[axis] = vertex[axis] > high[axis] ? vertex[axis] : high[axis];
      }
    }
  }
  // One place is left for an origin that is moved down to a whole number of steps.
  double step = double{kLeastLatticeStep};
  for (int axis = 0; axis < 3 && !mesh.triangles.empty(); ++axis) {
    const double by_extent = (double{high[axis]} - double{low[axis]}) / (kLastPlace - 1.0);
    const double farthest = magnitude(low[axis]) > magnitude(high[axis]) ? magnitude(low[axis]) : magnitude(high[axis]);
    const double by_distance = farthest / double{kMostStepsFromZero};
    step = by_extent > step ? by_extent : step;
    step = by_distance > step ? by_distance : step;
  }
  step = power_of_two_from(step);
  lattice = Lattice{};
  lattice.step = static_cast<float>(step);
  for (int axis = 0; axis < 3 && !mesh.triangles.empty(); ++axis) {
    lattice.origin[axis] = static_cast<float>(floor_of(double{low[axis]} / step) * step);
  }
  return Status::kOk;
}

LatticePoint lattice_point(const Lattice& lattice, const Vec3& point) {
  LatticePoint result;
  for (int axis = 0; axis < 3; ++axis) {
    const double steps = (double{point[axis]} - double{lattice.origin[axis]}) / double{lattice.step};
    const double inside = steps > 0.0 ? (steps < kLastPlace ? steps : kLastPlace) : 0.0;
    result.place[axis] = static_cast<std::uint16_t>(inside + 0.5);
  }
  return result;
}

Vec3 snap(const Lattice& lattice, const Vec3& point) {
  const LatticePoint at = lattice_point(lattice, point);
  Vec3 snapped;
  for (int axis = 0; axis < 3; ++axis) {
    snapped[axis] = static_cast<float>(at.place[axis]) * lattice.step + lattice.origin[axis];
  }
  return snapped;
}

}  // namespace gridiron
