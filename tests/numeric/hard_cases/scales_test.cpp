// Scales and places: tiny, huge, mixed, far from the origin, far from the eye, denormal.
// SPDX-License-Identifier: Apache-2.0
#include "numeric/hard_cases/cell_walk.h"
#include "numeric/hard_cases/shapes.h"
#include "numeric/hard_cases/trial.h"
#include "numeric/rounding_scope.h"

namespace gridiron::test::hard {
namespace {

// From inside of solids of a scale, with directions as long as the way and of length one.
Tally shoot_scaled(float scale, std::uint64_t seed) {
  Tally tally;
  for (const Solid& solid : solids()) {
    if (std::string_view(solid.name) == "box") continue;
    SCOPED_TRACE(std::string(solid.name) + " times " + std::to_string(std::log10(scale)));
    const Vec3 middle = scale * solid.middle;
    const float room = scale * solid.room;
    const auto aim = all_of({salvo_at(middle, room, {{Aim::kEdge, Aim::kInside}, times(2), 24, 0}, seed),
                             salvo_at(middle, room, {{Aim::kVertex}, times(1), 48, 1}, seed + 1)});
    const auto of_length_one = [&](const TestMesh& mesh) { return with_unit_directions(aim(mesh)); };
    tally += shoot({.mesh = moved(solid.mesh, scale), .grade = Grade::kClosed, .aim = all_of({aim, of_length_one})});
  }
  EXPECT_EQ(tally.hits, tally.rays);
  return tally;
}

TEST(HardCase08, AreaUnderflows) {
  for (const float scale : {1e-20f, 1e-30f}) {
    EXPECT_GT(shoot_scaled(scale, 8).rays, 2000u);
  }
}

TEST(HardCase09, ProductsOverflow) {
  for (const float scale : {1e13f, 1e15f, 1e19f, 1e30f}) {
    EXPECT_GT(shoot_scaled(scale, 9).rays, 2000u);
  }
}

// A sphere of two thousandths in a bowl of two thousand, from next to it and from the rim.
TEST(HardCase10, TeapotInAStadium) {
  TestMesh mesh = moved(make_sphere(8, 10, 1e-3f), 1.0f, {0, 300, 0});
  const auto small = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.append(moved(make_height_field(20, 0.2f, 10), 1000.0f));
  const auto add = [&](std::vector<Rays>& all, std::uint32_t i, TestRandom& random, const TestMesh& stored) {
    Rays near, far;
    near.origin = Vec3(0, 300, 0) + random_vec(random, i % 2 == 0 ? 5e-3f : 0.9e-3f);
    far.origin = stored.vertices[small + random.below(static_cast<std::uint32_t>(stored.vertices.size()) - small)] +
                 Vec3(0, 1, 0);
    for (std::uint32_t k = 0; k < 32; ++k) {
      const Vec3 at = stored.vertices[random.below(small)];
      near.directions.push_back(at - near.origin);
      far.directions.push_back(at - far.origin);
    }
    all.push_back(near);
    all.push_back(far);
    all.push_back(rays_at(stored, near.origin, Aim::kEdge, 16, random));
    all.push_back(picture_at(stored, far.origin, Aim::kVertex, random));
  };
  const Tally tally = shoot({.mesh = mesh, .aim = rounds(24, 10, add)});
  EXPECT_GT(tally.hits, tally.rays / 4);
}

TEST(HardCase11, FarFromTheOrigin) {
  for (const float offset : {1e3f, 1e5f, 1e6f, 1e7f}) {
    SCOPED_TRACE(offset);
    const Vec3 place = offset * Vec3(1.0f, -0.7f, 0.3f);
    const float size = offset > 2e6f ? 16.0f : 1.0f;
    TestMesh mesh = moved(make_sphere(10, 13, size), 1.0f, place);
    mesh.append(moved(make_torus(12, 9, 2.0f * size, 0.5f * size), 1.0f, place));
    const auto aim =
        all_of({salvo_at(place, 0.5f * size, {kFeatures, times(4), 24, 1}, 11),
                salvo_at(place + Vec3(0, 4.0f * size, 0), size, {{Aim::kEdge, Aim::kVertex}, times(4), 24, 1}, 12)});
    const Tally tally = shoot({.mesh = mesh, .aim = aim});
    EXPECT_GT(tally.hits, tally.rays / 2);
    for (const float lambda : {4.0f, 200.0f}) {
      const Target target(mesh, {.lambda = lambda}, kProfiles[0]);
      const WalkTally walked = walk(target.grid(), aim(mesh));
      EXPECT_GT(walked.touched, walked.rays);
    }
  }
}

TEST(HardCase12, FarEye) {
  const TestMesh mesh = joined(make_sphere(16, 20, 50.0f), make_torus(20, 9, 90.0f, 20.0f));
  const auto add = [](std::vector<Rays>& all, std::uint32_t i, TestRandom& random, const TestMesh& stored) {
    Vec3 away = random_vec(random, 1e7f);
    away[static_cast<int>(random.below(3))] = random.below(2) == 0 ? 1e7f : -1e7f;
    all.push_back(rays_at(stored, away, i % 2 == 0 ? Aim::kVertex : Aim::kEdge, 48, random));
    const float step = 0x1p-20f;
    const Vec3 to_middle = -1e-7f * away;
    all.push_back(
        picture(away, to_middle - Vec3(8.0f * step, 5.0f * step, 0), {step, 0, 0}, {0, step, 0.25f * step}, 17, 11));
  };
  const auto aim = rounds(8, 12, add);
  const Tally tally = shoot({.mesh = mesh, .aim = aim});
  EXPECT_GT(tally.hits, tally.rays / 4);
  EXPECT_LT(tally.hits, tally.rays);
  for (const float lambda : {4.0f, 200.0f}) {
    const Target target(mesh, {.lambda = lambda}, kProfiles[0]);
    EXPECT_GT(walk(target.grid(), aim(mesh)).touched, 1000u);
  }
}

// Meshes of denormal vertices, and of denormal thickness; with and without flushing the hits are those of the oracle,
// which never flushes.
TEST(HardCase33, DenormalVertices) {
  const TestMesh cloud = moved(make_sphere(8, 10, 1.0f), 1e-42f);
  for (const bool flush : {false, true}) {
    SCOPED_TRACE(flush ? "denormals flushed" : "denormals kept");
    // Directions of 2^-60: distances are floats above the least normal one.
    const auto short_rays = [](const TestMesh& stored) {
      std::vector<Rays> rays =
          with_unit_directions(salvo(stored, Vec3(0.0f), 0.4e-42f, {kFeatures, times(6), 32, 0}, 33));
      for (Rays& one : rays) {
        for (Vec3& direction : one.directions) direction *= 0x1p-60f;
      }
      return rays;
    };
    const Tally tiny =
        shoot({.mesh = cloud, .grade = Grade::kClosed, .aim = short_rays, .flush = flush, .flush_builder = false});
    EXPECT_EQ(tiny.hits, tiny.rays);
    {
      // A builder that flushes sees a point.
      const RoundingScope scope(FE_TONEAREST, flush);
      const volatile float denormal = 1e-42f;
      const Target target(cloud, {}, kProfiles[0]);
      EXPECT_EQ(target.status(), denormal == 0.0f ? Status::kNoTriangles : Status::kOk);
    }
    std::vector<AimAtMesh> aims;
    for (const float height : {-3.0f, 3.0f, 1e-20f, 0.0f}) {
      aims.push_back(salvo_at({0, 0, height}, 0x1p-60f, {kFeatures, times(2), 24, 1}, 34));
    }
    // A builder that flushes leaves out the box's thin sides.
    const Tally thin = shoot(
        {.mesh = make_box({-1, -1, 0}, {1, 1, 1e-40f}), .aim = all_of(aims), .flush = flush, .flush_builder = false});
    EXPECT_GT(thin.hits, thin.rays / 4);
  }
}

}  // namespace
}  // namespace gridiron::test::hard
