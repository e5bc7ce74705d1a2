// Compares core's `standard` test with the oracle: every ray's triangle and distance, bit for bit.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/ray/intersect_standard.h>

#include "core/lane_types.h"
#include "core/ray/packet_cases.h"
#include "core/seeds.h"
#include "numeric/hard_rays.h"
#include "numeric/oracle.h"
#include "support/test_mesh.h"

namespace gridiron::test {
namespace {

std::vector<VertexTriangle> records_of(const TestMesh& mesh) {
  std::vector<VertexTriangle> records;
  for (std::uint32_t id = 0; id < mesh.triangles.size(); ++id) records.push_back(triangle_of(mesh, id));
  return records;
}

struct Differences {
  std::uint64_t rays = 0, hits = 0, ties = 0, differences = 0;
};

// Shoots the rays of one origin as a packet at every triangle, and asks the oracle.
template <class L, class PacketType>
void compare(const Oracle& oracle, const std::vector<VertexTriangle>& triangles, const std::vector<OracleRay>& rays,
             Differences& sum) {
  PacketType packet{};
  packet.active.clear();
  for (std::uint32_t ray = 0; ray < rays.size(); ++ray) {
    for (int axis = 0; axis < 3; ++axis) {
      packet.origin[axis] = rays[ray].origin[axis];
      packet.dir[axis][ray] = rays[ray].direction[axis];
    }
    packet.active.insert(ray);
  }
  set_direction_bounds(packet);
  for (std::uint32_t ray = 0; ray < PacketType::kRayCount; ++ray) {
    packet.t[ray] = kFloatMax;
    packet.id[ray] = kNoTriangle;
  }
  WorkCounters work;
  for (const VertexTriangle& triangle : triangles) {
    (void)intersect_standard<L, false>(packet, triangle, false, work);
  }
  for (std::uint32_t ray = 0; ray < rays.size(); ++ray) {
    const NearestHit wanted = oracle.nearest(rays[ray]);
    const std::uint32_t id = wanted.float_ties.empty() ? kNoTriangle : wanted.float_ties.front();
    ++sum.rays;
    sum.hits += id != kNoTriangle;
    sum.ties += wanted.float_ties.size() > 1;
    if (packet.id[ray] == id && std::bit_cast<std::uint32_t>(packet.t[ray]) == std::bit_cast<std::uint32_t>(wanted.t)) {
      continue;
    }
    if (sum.differences++ == 0) {
      ADD_FAILURE() << "ray " << ray << ": triangle " << packet.id[ray] << " at " << std::hexfloat << packet.t[ray]
                    << " instead of " << id << " at " << wanted.t;
    }
  }
}

template <class L>
class OracleStandardTest : public testing::Test {};
TYPED_TEST_SUITE(OracleStandardTest, LaneTypes, LaneNames);

TYPED_TEST(OracleStandardTest, ClosedMeshesFromInside) {
  struct Solid {
    const char* name;
    TestMesh mesh;
    Vec3 middle;
    float room;  // of origins around it
  };
  const Vec3 away(148376.0f, 1234.0f, -223423.0f);
  Solid solids[] = {{"sphere", make_sphere(10, 13, 1.0f), Vec3(0.0f), 0.5f},
                    {"torus", make_torus(12, 9, 1.0f, 0.5f), Vec3(1, 0, 0), 0.2f},
                    {"box", make_box({-1, -1, -1}, {1, 1, 1}), Vec3(0.0f), 0.9f},
                    {"sphere, small", make_sphere(10, 13, 0x1p-50f), Vec3(0.0f), 0x1p-51f},
                    {"sphere, large", make_sphere(10, 13, 0x1p50f), Vec3(0.0f), 0x1p49f},
                    {"sphere, far off", make_sphere(10, 13, 1.0f), away, 0.25f}};
  solids[5].mesh.transform(1.0f, away);
  Differences sum;
  for (const Solid& solid : solids) {
    const Oracle oracle(solid.mesh.view(), {.reading = Reading::kStandard});
    const std::vector<VertexTriangle> triangles = records_of(solid.mesh);
    Differences own;
    for_each_seed(80, [&](std::uint64_t seed) {
      SCOPED_TRACE(solid.name);
      TestRandom random(seed);
      const Vec3 origin = solid.middle + random_vec(random, solid.room);
      std::vector<OracleRay> rays;
      for (std::uint32_t i = 0; i < Packet<16>::kRayCount; ++i) {
        rays.push_back(ray_at(solid.mesh, origin, i % 2 == 0 ? Aim::kVertex : Aim::kEdge, random));
      }
      compare<TypeParam, Packet<16>>(oracle, triangles, rays, own);
    });
    EXPECT_EQ(own.differences, 0u) << solid.name;
    EXPECT_EQ(own.hits, own.rays) << solid.name << ": a ray leaves a closed mesh";
    sum.rays += own.rays;
    sum.ties += own.ties;
  }
  if (std::getenv("GRIDIRON_TEST_SEED") != nullptr) return;
  EXPECT_GE(sum.rays, 100000u);
  EXPECT_GT(sum.ties, 20000u);
}

TYPED_TEST(OracleStandardTest, HardTriangles) {
  Differences sum;
  for_each_seed(5000, [&](std::uint64_t seed) {
    HardCase hard = make_hard_case(300000 + seed);
    for (OracleRay& ray : hard.rays) {
      ray.t_min = 0.0f;
      ray.t_max = kFloatMax;
    }
    const Oracle oracle(hard.mesh.view(), {.reading = Reading::kStandard});
    compare<TypeParam, Packet<4>>(oracle, records_of(hard.mesh), hard.rays, sum);
  });
  EXPECT_EQ(sum.differences, 0u);
  if (std::getenv("GRIDIRON_TEST_SEED") != nullptr) return;
  EXPECT_GT(sum.rays, 79000u);
  EXPECT_GT(sum.hits, 20000u);
  EXPECT_GT(sum.ties, 5000u);
}

}  // namespace
}  // namespace gridiron::test
