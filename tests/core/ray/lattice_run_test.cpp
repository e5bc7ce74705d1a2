// Runs of lattice triangles spread where they have arrived. SPDX-License-Identifier: Apache-2.0
#include <gridiron/ray/lattice_run.h>

#include "support/test_mesh.h"

namespace gridiron::test {
namespace {

TEST(LatticeRun, GivesEveryTriangleWhereverTheRunStarts) {
  constexpr std::uint32_t kMostTriangles = 64;
  constexpr std::uint32_t kGuardBytes = 32;
  TestRandom random(3);
  for (std::uint32_t count = 1; count <= kMostTriangles; ++count) {
    for (std::uint32_t first_byte = 0; first_byte <= 24; first_byte += 8) {
      Lattice lattice{{0.0f, 0.0f, 0.0f}, 0x1p-9f};
      for (float& origin : lattice.origin) {
        origin = lattice.step *
                 (static_cast<float>(random.below((1u << 24) - (1u << 17))) * (random.below(2) == 0 ? 1.0f : -1.0f));
      }
      std::vector<LatticeTriangle> run(count);
      for (LatticeTriangle& triangle : run) {
        for (auto& corner : triangle.v) {
          for (std::uint16_t& place : corner) {
            place = static_cast<std::uint16_t>(random.below(4) == 0 ? 65535 * random.below(2) : random.below(65536));
          }
        }
        triangle.reserved = 0;
        triangle.triangle_id = static_cast<std::uint32_t>(random.next());
      }
      // Room for the spread run, or for what a transfer moves of a short one; then guards.
      const std::size_t room = std::max<std::size_t>(48 * count, 24 * count + first_byte);
      alignas(16) std::byte buffer[kMostTriangles * 48 + 64];
      std::memset(buffer, 0xA5, sizeof(buffer));
      std::memcpy(buffer + first_byte, run.data(), run.size() * sizeof(LatticeTriangle));
      const VertexTriangle* spread = spread_lattice_run(lattice, buffer, first_byte, count);
      ASSERT_EQ(static_cast<const void*>(spread), static_cast<const void*>(buffer));
      for (std::uint32_t i = 0; i < count; ++i) {
        VertexTriangle triangle;
        std::memcpy(&triangle, buffer + std::size_t{i} * 48, sizeof(triangle));
        ASSERT_EQ(triangle.triangle_id, run[i].triangle_id) << i << " of " << count << " from " << first_byte;
        for (int corner = 0; corner < 3; ++corner) {
          for (int axis = 0; axis < 3; ++axis) {
            const double exact = double{lattice.origin[axis]} + double{lattice.step} * run[i].v[corner][axis];
            ASSERT_EQ(double{triangle.v[corner][axis]}, exact) << i << " of " << count << " from " << first_byte;
          }
        }
      }
      for (std::size_t i = room; i < room + kGuardBytes; ++i) ASSERT_EQ(buffer[i], std::byte{0xA5});
    }
  }
}

}  // namespace
}  // namespace gridiron::test
