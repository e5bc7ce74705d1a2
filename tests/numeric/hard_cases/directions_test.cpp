// Directions, origins and limits of rays: zeros of either sign, denormal, of any length, not finite; on a triangle; as
// far as the hit; packets of all kinds of rays. SPDX-License-Identifier: Apache-2.0
#include "numeric/hard_cases/shapes.h"
#include "numeric/hard_cases/trial.h"

namespace gridiron::test::hard {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();

std::uint32_t count_of(const TestMesh& mesh) {
  return static_cast<std::uint32_t>(mesh.triangles.size());
}

// Along one axis, and in planes across one, from inside; along axes through features, from anywhere.
TEST(HardCase13, AxisParallelDirections) {
  Tally inside, outside;
  for (const Solid& solid : solids()) {
    SCOPED_TRACE(solid.name);
    const auto add = [&](std::vector<Rays>& all, std::uint32_t i, TestRandom& random, const TestMesh& mesh) {
      Rays rays = rays_at(mesh, solid.middle + random_vec(random, solid.room), Aim::kVertex, 30, random);
      if (i % 2 == 0) rays.origin = solid.middle;
      for (std::size_t k = 0; k < rays.directions.size(); ++k) {
        Vec3& d = rays.directions[k];
        const auto axis = static_cast<int>(k % 3);
        if (k % 2 == 0) d = Vec3(0.0f), d[axis] = k % 4 == 0 ? 1.0f : -1.0f;
        if (k % 2 == 1) d[axis] = 0.0f;
        if (d == Vec3(0.0f)) d[axis] = 1.0f;
      }
      all.push_back(rays);
      // A picture with the axis in its middle.
      const auto axis = static_cast<int>(i % 3);
      Vec3 forward(0.0f), right(0.0f), down(0.0f);
      forward[axis] = i % 2 == 0 ? 1.0f : -1.0f;
      right[(axis + 1) % 3] = 0x1p-6f;
      down[(axis + 2) % 3] = -0x1p-6f;
      all.push_back(picture(rays.origin, forward - 8.0f * right - 8.0f * down, right, down, 17, 17));
    };
    inside += shoot({.mesh = solid.mesh, .grade = Grade::kClosed, .aim = rounds(10, 13, add)});
    const auto add_along_axis = [](std::vector<Rays>& all, std::uint32_t, TestRandom& random, const TestMesh& mesh) {
      const OracleRay ray = ray_at(mesh, random_vec(random, 9.0f), Aim::kAxis, random);
      all.push_back(one_ray({ray.origin[0], ray.origin[1], ray.origin[2]},
                            {ray.direction[0], ray.direction[1], ray.direction[2]}));
    };
    outside += shoot({.mesh = solid.mesh, .aim = rounds(120, 14, add_along_axis)});
  }
  EXPECT_EQ(inside.hits, inside.rays);
  EXPECT_GT(inside.ties, inside.rays / 20);
  EXPECT_GT(outside.hits, outside.rays / 3);
}

// Every zero with either sign gives the same bits, in every profile.
TEST(HardCase14, NegativeZeros) {
  const TestMesh mesh = moved(make_cubes(6, 14), 1.0f, Vec3(-3.0f));
  std::uint64_t compared = 0;
  for (const Profile& profile : kProfiles) {
    SCOPED_TRACE(profile.name);
    Target target(mesh, {}, profile);
    TestRandom random(14);
    for (std::uint32_t i = 0; i < times(24); ++i) {
      // From points with zeros, at points with zeros.
      const auto lattice = [&](float step) {
        const auto one = [&] { return step * (static_cast<float>(random.below(5)) - 2.0f); };
        const float x = one(), y = one();
        return Vec3(x, y, one());
      };
      Rays rays{lattice(0.5f)};
      rays.origin[static_cast<int>(i % 3)] = 0.0f;
      while (rays.directions.size() < 16) {
        Vec3 d = lattice(1.0f);
        d[static_cast<int>(random.below(3))] = 0.0f;
        if (d != Vec3(0.0f)) rays.directions.push_back(d);
      }
      const PipelineWay& way = pipeline_ways()[i % pipeline_ways().size()];
      const IntersectorWay alone{4, 8, IntersectorWay::Order::kAscending};
      const std::vector<Answer> wanted[2] = {target.by_intersector(rays, alone), target.by_pipeline(rays, way)};
      for (std::uint32_t signs = 1; signs < 8; signs = 2 * signs + (signs == 4 ? 0 : 1)) {  // 1, 3, 7
        Rays turned = rays;
        const auto turn = [&](Vec3& v) {
          for (int axis = 0; axis < 3; ++axis) {
            if (v[axis] == 0.0f && (signs >> axis & 1u) != 0) v[axis] = -v[axis];
          }
        };
        turn(turned.origin);
        for (Vec3& d : turned.directions) turn(d);
        ASSERT_TRUE(target.by_intersector(turned, alone) == wanted[0]);
        ASSERT_TRUE(target.by_pipeline(turned, way) == wanted[1]);
        compared += 2 * rays.directions.size();
      }
    }
  }
  EXPECT_GT(compared, 5000u);
  // And they are the oracle's.
  const auto aim = [](const TestMesh&) {
    std::vector<Rays> all;
    for (const float zero : {0.0f, -0.0f}) {
      Rays rays{{zero, 0.25f, zero}};
      for (const float x : {-1.0f, -0.0f, 0.0f, 1.0f}) {
        for (const float y : {-1.0f, -0.0f, 0.0f, 0.5f}) {
          for (const float z : {-0.0f, 0.0f, 1.0f}) {
            if (x != 0.0f || y != 0.0f || z != 0.0f) rays.directions.push_back({x, y, z});
          }
        }
      }
      all.push_back(rays);
      all.push_back(picture(rays.origin, {-1, 0.125f, zero}, {0.125f, zero, -0.0f}, {-0.0f, 0.125f, zero}, 17, 9));
    }
    return all;
  };
  const Tally tally = shoot({.mesh = mesh, .grade = Grade::kClosed, .aim = aim});
  EXPECT_GT(tally.ties, 50u);
}

// Components from the least float to beyond the least normal one, next to ones of ordinary length.
TEST(HardCase15, DenormalDirectionComponents) {
  constexpr float kSmall[] = {0x1p-149f, 1e-40f, 0x1p-127f, 0x1p-126f, 1e-38f};
  for (const bool flush : {false, true}) {
    SCOPED_TRACE(flush ? "denormals flushed" : "denormals kept");
    for (const Solid& solid : solids()) {
      SCOPED_TRACE(solid.name);
      const auto add = [&](std::vector<Rays>& all, std::uint32_t i, TestRandom& random, const TestMesh& mesh) {
        Rays rays = rays_at(mesh, solid.middle + static_cast<float>(i % 2) * random_vec(random, solid.room),
                            Aim::kVertex, 32, random);
        for (std::size_t k = 0; k < rays.directions.size(); ++k) {
          Vec3& d = rays.directions[k];
          const auto axis = static_cast<int>(random.below(3));
          d[axis] = (k % 2 == 0 ? 1.0f : -1.0f) * kSmall[random.below(5)];
          if (k % 3 == 0) d[(axis + 1) % 3] = kSmall[random.below(5)];
          if (std::fabs(d.x) + std::fabs(d.y) + std::fabs(d.z) < 0.125f) d[(axis + 2) % 3] = 1.0f;
        }
        all.push_back(rays);
        const float small = kSmall[i % 5];
        all.push_back(picture(rays.origin, {-8 * small, 1.0f, -4 * small}, {small, 0, 0}, {0, 0, small}, 17, 9));
      };
      const Tally tally =
          shoot({.mesh = solid.mesh, .grade = Grade::kClosed, .aim = rounds(6, 15, add), .flush = flush});
      EXPECT_EQ(tally.hits, tally.rays);
    }
  }
}

// By 1e-18 and 1e18 the oracle says; by powers of two triangles and depths are the same bits.
TEST(HardCase16, LengthOfDirections) {
  for (const Solid& solid : solids()) {
    SCOPED_TRACE(solid.name);
    const auto aim = salvo_at(solid.middle, solid.room, {kFeatures, times(2), 32, 1}, 16);
    const auto stretched = [](std::vector<Rays> all, float factor) {
      for (Rays& rays : all) {
        for (Vec3* const vector : {&rays.corner, &rays.step_x, &rays.step_y}) *vector *= factor;
        for (Vec3& d : rays.directions) d *= factor;
        recompute_picture(rays);
      }
      return all;
    };
    for (const float factor : {1e-18f, 1e18f}) {
      const auto stretched_aim = [&](const TestMesh& mesh) { return stretched(aim(mesh), factor); };
      const Tally tally = shoot({.mesh = solid.mesh, .grade = Grade::kClosed, .aim = stretched_aim});
      EXPECT_EQ(tally.hits, tally.rays);
    }
    for (const Profile& profile : kProfiles) {
      if (!profile.is_exact) continue;
      Target target(solid.mesh, {}, profile);
      const std::vector<Rays> rays = aim(target.mesh());
      for (const float factor : {0x1p-40f, 0x1p40f}) {
        const std::vector<Rays> scaled = stretched(rays, factor);
        for (std::size_t i = 0; i < rays.size(); ++i) {
          const PipelineWay& way = pipeline_ways()[0];
          ASSERT_TRUE(target.by_pipeline(rays[i], way) == target.by_pipeline(scaled[i], way)) << profile.name;
          const IntersectorWay alone{4, 8, IntersectorWay::Order::kAscending};
          const std::vector<Answer> wanted = target.by_intersector(rays[i], alone);
          const std::vector<Answer> found = target.by_intersector(scaled[i], alone);
          for (std::size_t k = 0; k < wanted.size(); ++k) {
            ASSERT_EQ(found[k].id, wanted[k].id);
            ASSERT_EQ(found[k].t * factor, wanted[k].t);
          }
        }
      }
    }
  }
}

// An eye that is not finite makes no frame.
void refuse_eyes_not_finite() {
  const TestMesh mesh = make_sphere(10, 13, 1.0f);
  SceneInMemory scene(mesh.view(), {});
  for (const float odd : {kNaN, kInf, -kInf, 0x1p121f}) {
    for (int axis = 0; axis < 3; ++axis) {
      FrameSettings settings{.camera = {.eye = {0, 0, 4}}, .width = 4, .height = 4};
      EXPECT_EQ(scene.prepare(settings, {}).status(), Status::kOk);
      settings.camera.eye[axis] = odd;
      EXPECT_EQ(scene.prepare(settings, {}).status(), Status::kBadFrame);
    }
  }
}

// No direction, or one that is not finite: a miss, in bounded steps, alone and among rays that hit.
TEST(HardCase17, NoDirectionOrNotFinite) {
  const auto odd_rays = [](const TestMesh& mesh) {
    TestRandom random(17);
    std::vector<Rays> all;
    constexpr float kOdd[] = {kNaN, kInf, -kInf, 0.0f, -0.0f, 1.0f, kFloatMax};
    for (std::uint32_t i = 0; i < times(4); ++i) {
      Rays rays{random_vec(random, i % 2 == 0 ? 0.5f : 3.0f)};
      for (std::uint32_t k = 0; k < 7 * 7 * 7; ++k)
        rays.directions.push_back({kOdd[k % 7], kOdd[k / 7 % 7], kOdd[k / 49]});
      // What is finite is bounded by what a grid takes.
      for (Vec3& d : rays.directions) {
        for (int axis = 0; axis < 3; ++axis) {
          if (d[axis] == kFloatMax) d[axis] = 1e-30f;
        }
      }
      all.push_back(rays);
      all.push_back(rays_at(mesh, rays.origin, Aim::kVertex, 8, random));
    }
    const Vec3 inside(0.1f, 0.2f, 0.3f);
    all.push_back(picture(inside, Vec3(0.0f), Vec3(0.0f), Vec3(0.0f), 9, 5));
    all.push_back(picture(inside, Vec3(kNaN), Vec3(1.0f), Vec3(1.0f), 9, 5));
    all.push_back(picture(inside, {1, 0, 0}, {kInf, 0, 0}, {0, kNaN, 0}, 9, 5));
    // Columns 4 and on overflow, and where both steps do there is no number.
    all.push_back(picture(inside, {0, 0, 1e30f}, {1e38f, 0, 0}, {-1e38f, 1e30f, 0}, 9, 9));
    return all;
  };
  const Tally tally = shoot({.mesh = make_sphere(10, 13, 1.0f), .grade = Grade::kBounded, .aim = odd_rays});
  EXPECT_GT(tally.hits, 20u);
  EXPECT_LT(tally.hits, tally.rays / 4);
  refuse_eyes_not_finite();
}

// From points that lie exactly on triangles, edges and vertices: a hit has t > 0, so what the ray starts on is not hit,
// but all that lies in front of it is.
TEST(HardCase21, OriginOnATriangle) {
  Tally tally;
  for (const TestMesh& mesh :
       {on_lattice(make_sphere(8, 12, 1.0f), 0x1p-5f), make_cubes(6, 21), make_box({-1, -1, -1}, {1, 1, 1})}) {
    const auto add = [](std::vector<Rays>& all, std::uint32_t i, TestRandom& random, const TestMesh& stored) {
      const UVec3& t = stored.triangles[random.below(count_of(stored))];
      const Vec3 a = stored.vertices[t.x], b = stored.vertices[t.y], c = stored.vertices[t.z];
      Vec3 origin = a;
      if (i % 3 == 1) origin = 0.5f * a + 0.5f * b;
      if (i % 3 == 2) origin = a + (0.25f * (b - a) + 0.5f * (c - a));
      for (const Aim aim : {Aim::kVertex, Aim::kEdge, Aim::kInside})
        all.push_back(rays_at(stored, origin, aim, 16, random));
      Rays away{origin};
      for (std::uint32_t k = 0; k < 16; ++k) away.directions.push_back(random_vec(random, 1.0f));
      away.directions.push_back(b - a);
      away.directions.push_back(c - b);
      all.push_back(away);
      all.push_back(picture_at(stored, origin, Aim::kVertex, random));
    };
    tally += shoot({.mesh = mesh, .aim = rounds(20, 21, add)});
  }
  EXPECT_GT(tally.hits, tally.rays / 3);
  EXPECT_LT(tally.hits, tally.rays);
}

// t <= t_far: a limit at the very distance keeps the hit, one float below it loses it. And below the least normal float
// a distance is 0, which is none.
TEST(HardCase24, LimitAtTheHit) {
  Tally tally;
  for (const Solid& solid : solids()) {
    SCOPED_TRACE(solid.name);
    const auto limited_rays = [&](const TestMesh& mesh) {
      const Oracle oracle(mesh.view(), {.reading = Reading::kStandard});
      TestRandom random(24);
      std::vector<Rays> all;
      for (std::uint32_t i = 0; i < times(60); ++i) {
        const Aim aim = i % 3 == 0 ? Aim::kVertex : i % 3 == 1 ? Aim::kEdge : Aim::kInside;
        Rays rays = rays_at(mesh, solid.middle + random_vec(random, solid.room), aim, 1, random);
        const float t = oracle.nearest(oracle_ray(rays, 0)).t;
        for (const float limit : {t, std::nextafter(t, 0.0f), std::nextafter(t, kFloatMax)}) {
          rays.t_far = limit;
          all.push_back(rays);
        }
      }
      return all;
    };
    tally += shoot({.mesh = solid.mesh, .aim = limited_rays});
  }
  EXPECT_EQ(tally.hits * 3, tally.rays * 2);
  const auto near_rays = [](const TestMesh&) {
    std::vector<Rays> all;
    for (int exponent = -140; exponent <= -110; ++exponent) {
      Rays rays{{0.25f, 0.125f, std::ldexp(1.0f, exponent / 2)}};
      rays.directions = {{0, 0, -std::ldexp(1.0f, exponent / 2 - exponent)}};
      all.push_back(rays);
    }
    return all;
  };
  const Tally near = shoot({.mesh = make_box({-1, -1, -1}, {1, 1, 0}), .aim = near_rays});
  EXPECT_EQ(near.rays, 31u);
}

// Rays of all signs, some that are none, in one packet: each is answered as if it were alone. A dead packet but for
// one.
TEST(HardCase38, MixedPackets) {
  std::uint64_t compared = 0;
  const TestMesh mesh = make_sphere(10, 13, 1.0f);
  const IntersectorWay ways[] = {{4, 8, IntersectorWay::Order::kAscending}, {16, 8, IntersectorWay::Order::kAscending}};
  for (const Profile& profile : kProfiles) {
    SCOPED_TRACE(profile.name);
    Target target(mesh, {}, profile);
    TestRandom random(38);
    for (std::uint32_t i = 0; i < times(6); ++i) {
      Rays rays = rays_at(target.mesh(), random_vec(random, 0.5f), i % 2 == 0 ? Aim::kVertex : Aim::kEdge, 64, random);
      const std::size_t alive = random.below(64);
      for (std::size_t k = 0; k < 64; ++k) {
        const bool is_dead = i % 3 == 0 ? k != alive : k % 7 == 3;
        if (is_dead) rays.directions[k] = k % 2 == 0 ? Vec3(kNaN) : Vec3(0, kInf, 1);
      }
      const std::vector<Answer> together = target.by_intersector(rays, ways[i % 2]);
      for (std::size_t k = 0; k < 64; ++k) {
        Rays one = one_ray(rays.origin, rays.directions[k]);
        ASSERT_TRUE(target.by_intersector(one, ways[i % 2])[0] == together[k]) << "ray " << k;
        ++compared;
      }
    }
    if (!profile.is_exact) continue;
    // Through the pipeline: a view of all six sides, and one whose outer columns overflow.
    for (std::uint32_t i = 0; i < times(3); ++i) {
      const Vec3 origin = random_vec(random, 0.5f);
      const Rays views[] = {picture(origin, {-1, -1, 0.03125f}, {0.125f, 0, 0}, {0, 0.125f, -0.0078125f}, 17, 17),
                            picture(origin, {0, 0, 1e37f}, {1e38f, 0, 0}, {0, 1e37f, 0}, 8, 8)};
      for (const Rays& view : views) {
        for (const PipelineWay& way : pipeline_ways()) {
          const std::vector<Answer> together = target.by_pipeline(view, way);
          Rays list = view;
          list.columns = 0;
          const std::vector<Answer> alone = target.by_pipeline(list, way);
          for (std::size_t k = 0; k < alone.size(); ++k) ASSERT_EQ(alone[k].id, together[k].id) << "ray " << k;
          ASSERT_TRUE(!way.wants_distances || alone == together);
          compared += alone.size();
        }
      }
    }
  }
  EXPECT_GT(compared, 10000u);
}

}  // namespace
}  // namespace gridiron::test::hard
