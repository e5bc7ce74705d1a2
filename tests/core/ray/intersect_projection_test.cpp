// The `paper` test compared with the same geometry in double, where single precision is good enough to decide.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/build/triangle_records.h>
#include <gridiron/ray/intersect_projection.h>

#include <glm/geometric.hpp>

#include "core/lane_types.h"
#include "core/ray/packet_cases.h"
#include "core/seeds.h"
#include "support/test_mesh.h"

namespace gridiron::test {
namespace {

using SmallPacket = Packet<4>;
constexpr std::uint32_t kRays = SmallPacket::kRayCount;

using glm::cross, glm::dot;

// A ray against a triangle in double.
struct DoubleHit {
  double t;
  double margin;  ///< least barycentric coordinate: below 0 outside
  double cosine;  ///< |normal . direction|, normal of length 1
};

DoubleHit hit_in_double(const DVec3& origin, const DVec3& direction, const Vec3 corners[3]) {
  const DVec3 a(corners[0]), b(corners[1]), c(corners[2]);
  const DVec3 normal = cross(b - a, c - a);
  const double along = dot(normal, direction);
  const double t = dot(normal, a - origin) / along;
  const DVec3 p = origin + t * direction;
  const double area = dot(normal, normal);
  const double beta = dot(cross(p - a, c - a), normal) / area;
  const double gamma = dot(cross(b - a, p - a), normal) / area;
  return {t, std::fmin(std::fmin(beta, gamma), 1.0 - beta - gamma), std::fabs(along) / std::sqrt(area)};
}

template <class L>
class ProjectionTest : public testing::Test {
 protected:
  SmallPacket packet_{};
  Vec3 corners_[3];
  ProjectionTriangle triangle_;

  // A well-shaped triangle of size 1 and a packet of neighbouring rays that looks at it from a few units away.
  void draw(TestRandom& random) {
    do {
      for (Vec3& corner : corners_) corner = random_vec(random, 1.0f);
    } while (dot(cross(DVec3(corners_[1]) - DVec3(corners_[0]), DVec3(corners_[2]) - DVec3(corners_[0])),
                 cross(DVec3(corners_[1]) - DVec3(corners_[0]), DVec3(corners_[2]) - DVec3(corners_[0]))) < 0.25);
    make_projection_triangle(corners_[0], corners_[1], corners_[2], 5, triangle_);
    const Vec3 origin = random_vec(random, 3.0f);
    const Vec3 at = random_vec(random, 1.0f);
    const Vec3 right = random_vec(random, 0.25f), down = random_vec(random, 0.25f);
    packet_.active.words[0] = (1u << kRays) - 1;
    for (int axis = 0; axis < 3; ++axis) {
      packet_.origin[axis] = origin[axis];
      for (std::uint32_t ray = 0; ray < kRays; ++ray) {
        packet_.dir[axis][ray] =
            (at - origin)[axis] + static_cast<float>(ray % 4) * right[axis] + static_cast<float>(ray / 4) * down[axis];
      }
      packet_.corner_dir[axis][0] = packet_.dir[axis][0];
      packet_.corner_dir[axis][1] = packet_.dir[axis][3];
      packet_.corner_dir[axis][2] = packet_.dir[axis][12];
      packet_.corner_dir[axis][3] = packet_.dir[axis][15];
    }
    reset_hits(packet_);
  }
  // @returns the subpackets of which a ray hit.
  SubpacketSet intersect(const ProjectionTriangle& triangle, bool use_culling, bool wants_facing, WorkCounters& work) {
    return intersect_projection<L>(packet_, triangle, SmallPacket::kAllSubpackets, use_culling, wants_facing, work);
  }
  [[nodiscard]] DoubleHit in_double(std::uint32_t ray) const {
    return hit_in_double(DVec3(packet_.origin[0], packet_.origin[1], packet_.origin[2]),
                         DVec3(packet_.dir[0][ray], packet_.dir[1][ray], packet_.dir[2][ray]), corners_);
  }
};
TYPED_TEST_SUITE(ProjectionTest, LaneTypes, LaneNames);

TYPED_TEST(ProjectionTest, AgreesWithDoubleWhereTheCaseIsClear) {
  std::uint64_t hits = 0;
  std::uint64_t misses = 0;
  std::uint64_t culled = 0;
  for_each_seed(20000, [&](TestRandom& random) {
    this->draw(random);
    SmallPacket& packet = this->packet_;
    if (random.below(2) != 0) packet.active.erase(random.below(kRays));
    const bool use_culling = random.below(2) != 0;
    WorkCounters work;
    const bool changed = this->intersect(this->triangle_, use_culling, true, work) != 0;
    culled += work[Work::kGroupTestPaper] == 0 ? 1u : 0u;
    bool any = false;
    for (std::uint32_t ray = 0; ray < kRays; ++ray) {
      const bool hit = packet.id[ray] == 5;
      any = any || hit;
      if (!packet.active.contains(ray)) {
        ASSERT_FALSE(hit);
        ASSERT_EQ(packet.t[ray], kFloatMax);
        continue;
      }
      const DoubleHit expected = this->in_double(ray);
      if (expected.cosine < 0.05 || std::fabs(expected.margin) < 1e-4 || std::fabs(expected.t) < 1e-3) continue;
      const bool should_hit = expected.margin > 0.0 && expected.t > 0.0;
      ASSERT_EQ(hit, should_hit) << "ray " << ray;
      (should_hit ? hits : misses) += 1;
      if (!should_hit) continue;
      ASSERT_NEAR(packet.t[ray], expected.t, 2e-4 * std::fmax(1.0, expected.t)) << "ray " << ray;
      ASSERT_NEAR(packet.facing[ray], expected.cosine, 1e-5 * (1.0 + expected.cosine));
    }
    ASSERT_EQ(changed, any);
  });
  if (!all_seeds_run()) return;
  EXPECT_GT(hits, 20000u);
  EXPECT_GT(misses, 20000u);
  EXPECT_GT(culled, 1000u);
}

TYPED_TEST(ProjectionTest, LeastIdWinsATieAndTheLimitIsClosed) {
  std::uint64_t hits = 0;
  for_each_seed(2000, [&](TestRandom& random) {
    this->draw(random);
    SmallPacket& packet = this->packet_;
    WorkCounters work;
    (void)this->intersect(this->triangle_, false, false, work);
    const SmallPacket first = packet;
    ProjectionTriangle twin = this->triangle_;
    twin.triangle_id = 9;
    EXPECT_EQ(this->intersect(twin, false, false, work), 0u);
    twin.triangle_id = 3;
    (void)this->intersect(twin, false, false, work);
    for (std::uint32_t ray = 0; ray < kRays; ++ray) {
      ASSERT_EQ(packet.t[ray], first.t[ray]);
      ASSERT_EQ(packet.id[ray], first.id[ray] == 5 ? 3u : kNoTriangle);
    }
    // From t_far = t the same hits; from the float below none.
    reset_hits(packet);
    std::ranges::copy(first.t, packet.t);
    (void)this->intersect(this->triangle_, false, false, work);
    for (std::uint32_t ray = 0; ray < kRays; ++ray) {
      ASSERT_EQ(packet.id[ray], first.id[ray]);
      hits += first.id[ray] == 5 ? 1u : 0u;
      packet.id[ray] = kNoTriangle;
      packet.t[ray] = std::nextafter(first.t[ray], 0.0f);
    }
    EXPECT_EQ(this->intersect(this->triangle_, false, false, work), 0u);
  });
  if (!all_seeds_run()) return;
  EXPECT_GT(hits, 2000u);
}

}  // namespace
}  // namespace gridiron::test
