// Floats as chips have them: rounding modes, flushed denormals, estimated reciprocals, vertices of few bits.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/base/lanes.h>
#include <gridiron/build/lattice.h>
#include <gridiron/ray/lattice_run.h>

#include <tuple>

#include "core/build/grid/built_image.h"
#include "numeric/hard_cases/shapes.h"
#include "numeric/hard_cases/trial.h"
#include "numeric/rounding_scope.h"

namespace gridiron::test::hard {
namespace {

// Every rounding mode, denormals kept and flushed, from the builder to the pixels.
TEST(HardCase39, RoundingModesAndFlushing) {
  for (const int mode : kRoundingModes) {
    for (const bool flush : {false, true}) {
      SCOPED_TRACE("mode " + std::to_string(mode) + (flush ? ", flushed" : ""));
      for (const Solid& solid : solids()) {
        SCOPED_TRACE(solid.name);
        const Tally tally =
            shoot({.mesh = solid.mesh,
                   .grade = Grade::kClosed,
                   .aim = salvo_at(solid.middle, solid.room, {{Aim::kEdge, Aim::kVertex}, times(1), 24, 1}, 39),
                   .rounding = mode,
                   .flush = flush});
        EXPECT_EQ(tally.hits, tally.rays);
      }
    }
  }
}

// The estimate of every float of a few powers of two, in every rounding mode: less than 2^-12 of itself off, and a
// Newton step makes that less than 2^-22.
template <class L>
void check_estimates(int mode) {
  using Float = typename L::Float;
  const RoundingScope scope(mode, false);
  double worst = 0.0, worst_refined = 0.0;
  for (const int exponent : {-100, 0, 100}) {
    for (std::uint32_t mantissa = 0; mantissa < 1u << 23; mantissa += L::kCount) {
      alignas(64) float values[L::kCount], estimates[L::kCount], refined[L::kCount];
      for (std::uint32_t i = 0; i < L::kCount; ++i) {
        const std::uint32_t sign = (mantissa + i) << 31;
        values[i] = std::bit_cast<float>(sign | static_cast<std::uint32_t>(exponent + 127) << 23 | (mantissa + i));
      }
      const Float a = Float::load(values);
      const Float estimate = L::reciprocal_estimate(a);
      estimate.store(estimates);
      (estimate + estimate * (Float(1.0f) - a * estimate)).store(refined);
      for (std::uint32_t i = 0; i < L::kCount; ++i) {
        // Products of two floats are doubles without rounding.
        worst = std::fmax(worst, std::fabs(double{estimates[i]} * double{values[i]} - 1.0));
        worst_refined = std::fmax(worst_refined, std::fabs(double{refined[i]} * double{values[i]} - 1.0));
      }
    }
  }
  EXPECT_LT(worst, 0x1p-12);
  EXPECT_GT(worst, 0x1p-14);
  EXPECT_LT(worst_refined, 0x1p-22);
}

TEST(HardCase41, ReciprocalEstimate) {
  check_estimates<Lanes<4>>(FE_TONEAREST);
  check_estimates<Lanes<4>>(FE_TOWARDZERO);
  // Nobody who promises a closed mesh to be closed estimates.
  for (const Solid& solid : solids()) {
    const Tally tally =
        shoot({.mesh = solid.mesh,
               .grade = Grade::kClosed,
               .aim = salvo_at(solid.middle, solid.room, {{Aim::kEdge, Aim::kVertex}, times(4), 32, 1}, 41)});
    EXPECT_EQ(tally.hits, tally.rays);
  }
}

// A vertex on the lattice is the same floats in every triangle and every cell that has it, and what was closed is.
TEST(HardCase44, QuantisedVertices) {
  std::uint64_t copies = 0;
  for (const Solid& solid : solids()) {
    for (const Vec3& offset : {Vec3(0.0f), Vec3(1000.25f, -3000.5f, 7.0f)}) {
      SCOPED_TRACE(solid.name);
      const TestMesh mesh = moved(solid.mesh, 1.0f, offset);
      GridParameters grid{.lambda = 64.0f, .format = TriangleFormat::kLattice};
      const BuiltImage built = build_image(mesh.view(), grid);
      const GridRecord& record = built.view.grid;
      const std::span<const std::byte> bytes = built.image.bytes();
      std::map<std::tuple<float, float, float>, std::uint32_t> seen;
      for (std::uint32_t i = 0; i < record.reference_count; ++i) {
        // As the kernel reads it: from its place in a transfer.
        alignas(16) std::byte buffer[96] = {};
        const std::uint32_t first_byte = 8 * (i % 4);
        std::memcpy(buffer + first_byte, bytes.data() + built.view.triangles_offset_bytes + i * sizeof(LatticeTriangle),
                    sizeof(LatticeTriangle));
        const VertexTriangle triangle = *spread_lattice_run(record.lattice, buffer, first_byte, 1);
        ASSERT_LT(triangle.triangle_id, mesh.triangles.size());
        for (int corner = 0; corner < 3; ++corner) {
          const Vec3 wanted = snap(record.lattice, mesh.vertices[mesh.triangles[triangle.triangle_id][corner]]);
          for (int axis = 0; axis < 3; ++axis) ASSERT_EQ(triangle.v[corner][axis], wanted[axis]);
          ++seen[{wanted.x, wanted.y, wanted.z}];
          ++copies;
        }
      }
      std::size_t used = 0;
      std::vector<bool> is_used(mesh.vertices.size());
      for (const UVec3& t : mesh.triangles) is_used[t.x] = is_used[t.y] = is_used[t.z] = true;
      for (const bool one : is_used) used += one;
      EXPECT_EQ(seen.size(), used) << "vertices were split or joined";
      const Tally tally = shoot(
          {.mesh = mesh,
           .grade = Grade::kClosed,
           .aim = salvo_at(solid.middle + offset, 0.5f * solid.room, {{Aim::kEdge, Aim::kVertex}, times(3), 32, 1}, 44),
           .grid = grid});
      EXPECT_EQ(tally.hits, tally.rays);
    }
  }
  EXPECT_GT(copies, 10000u);
}

}  // namespace
}  // namespace gridiron::test::hard
