// Groups: a beam meets what one of its rays meets, a triangle that a ray hits stays open for it, and distances in lanes
// are those of single rays. Boxes here are the least around single points of rays: the boxes of a tree are grown, which
// would hide beams that are a little too narrow. SPDX-License-Identifier: Apache-2.0
#include <gridiron/engine/tree/ray_groups.h>
#include <gridiron/ray/intersect_rays.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/lane_types.h"
#include "numeric/rounding_scope.h"
#include "support/test_mesh.h"

namespace gridiron::test {
namespace {

template <class L>
class RayGroupsTest : public testing::Test {};
TYPED_TEST_SUITE(RayGroupsTest, LaneTypes, LaneNames);

struct Group {
  alignas(64) BatchRay rays[kBeamRays] = {};
  RayGroup lanes{};
  GroupBeam beam{};
  float reach = 0.0f;
  std::uint32_t axis = kNoBeam;
};

float around(double place, double size, TestRandom& random) {
  return static_cast<float>(place + size * (2.0 * random.unit() - 1.0));
}

// Rays from neighbouring places, or one place, to neighbouring places, or one place; along each axis and in every
// octant, some without end; a beam of all of them, or of a half.
template <class L>
void make_random_group(float scene, TestRandom& random, Group& group) {
  const double far = scene * std::exp2(13.0 * random.unit() - 3.0);
  const double spread = scene * std::exp2(-2.0 - static_cast<double>(random.next() % 20));
  const std::uint64_t kind = random.next() % 4, along = random.next() % 6;
  double starts[3], ends[3];
  for (std::uint64_t axis = 0; axis < 3; ++axis) {
    starts[axis] = far * (2.0 * random.unit() - 1.0);
    ends[axis] = along < 3 && axis != along ? starts[axis] : scene * (2.0 * random.unit() - 1.0);
  }
  for (BatchRay& ray : group.rays) {
    for (int axis = 0; axis < 3; ++axis) {
      ray.origin[axis] = around(starts[axis], kind == 0 ? 0 : spread, random);
      ray.dir[axis] = around(ends[axis], kind == 1 ? 0 : spread, random) - ray.origin[axis];
    }
    const float length = kind == 2 ? std::exp2(-static_cast<float>(random.next() % 10)) : 1.0f;
    for (float& component : ray.dir) component *= length;
    ray.t = random.next() % 2 == 0 ? 1.0f : kFloatMax;
    ray.id = no_hit(kNoTriangle);
  }
  const std::uint32_t usual = load_group<L>(group.rays, scene, group.lanes);
  const std::uint32_t lanes = random.next() % 3 == 0 ? usual & 0x0FF0u : usual;
  std::uint32_t octant = 0;
  group.axis = lanes == 0 ? kNoBeam
                          : make_group_beam<L>(group.lanes, lanes, scene, group.beam, group.reach, octant);
  if (group.axis == kNoBeam || random.next() % 2 == 0) return;
  // Hits that rays have found meanwhile.
  for (float& t : group.lanes.t) t *= static_cast<float>(random.next() % 4) * 0.25f;
  group.reach = group_reach<L>(group.lanes, group.beam, group.axis);
}

// Box i is the least that holds a point of ray i.
void set_boxes_on(const Group& group, float scene, TestRandom& random, TreeNode& node, ChildBoxes& boxes) {
  for (std::uint32_t i = 0; i < kBeamRays; ++i) {
    const BatchRay& ray = group.rays[i];
    const double size = std::fabs(double{ray.dir[group.axis]});
    const double most = (std::fabs(double{ray.origin[group.axis]}) + scene) / size;
    const double t = std::min(double{group.lanes.t[i]}, most) * (random.next() % 3 == 0 ? 1.0 : random.unit());
    for (int axis = 0; axis < 3; ++axis) {
      const double place = ray.origin[axis] + t * ray.dir[axis];
      const auto nearest = static_cast<float>(place);
      node.low[axis][i] = nearest > place ? std::nextafterf(nearest, -kFloatMax) : nearest;
      node.high[axis][i] = nearest < place ? std::nextafterf(nearest, kFloatMax) : nearest;
      boxes.low[axis][i] = grown_low(node.low[axis][i], tree_margin(scene));
      boxes.high[axis][i] = grown_high(node.high[axis][i], tree_margin(scene));
    }
  }
  node.child_count = kBeamRays;
}

TYPED_TEST(RayGroupsTest, BeamsMeetTheBoxesThatTheirRaysMeet) {
  if constexpr (TypeParam::kCount > 4) {
    for (const int exponent : {-12, 0, 39}) {
      const float scene = std::ldexp(1.0f, exponent);
      for (const int mode : kRoundingModes) {
        SCOPED_TRACE(testing::Message() << "scene of 2^" << exponent << ", rounding " << mode);
        TestRandom random(static_cast<std::uint64_t>(exponent + 1000));
        std::uint32_t beams = 0, missed = 0, missed_by_rays = 0;
        for (std::uint32_t i = 0; i < 4000; ++i) {
          alignas(64) Group group;
          {
            const RoundingScope scope(mode, true);
            make_random_group<TypeParam>(scene, random, group);
          }
          if (group.axis == kNoBeam) continue;
          ++beams;
          alignas(64) TreeNode node{};
          alignas(64) ChildBoxes boxes{};
          set_boxes_on(group, scene, random, node, boxes);
          const RoundingScope scope(mode, true);
          WorkCounters work;
          alignas(64) std::uint32_t list[16] = {beam_word(0, group.axis, 0)};
          const std::uint32_t met = mark_groups<TypeParam>(node, &group.beam, &group.reach, list, 1, work);
          missed += count_bits(group.beam.lanes & ~met);
          for (std::uint32_t ray = 0; ray < kBeamRays; ++ray) {
            const std::uint32_t base = ray / TypeParam::kCount * TypeParam::kCount;
            const std::uint32_t lanes = rays_in_box<TypeParam>(group.lanes, base, boxes, ray);
            missed_by_rays += (lanes >> (ray - base) & 1u) == 0 ? 1u : 0u;
          }
        }
        EXPECT_GT(beams, 500u);
        EXPECT_EQ(missed, 0u);
        EXPECT_EQ(missed_by_rays, 0u);
      }
    }
  }
}

// Rays at triangles, at their edges and corners, and past them.
template <class L>
void aim_at_triangle(const VertexTriangle& triangle, bool is_shared, TestRandom& random, Group& group) {
  Vec3 start(random.between(-1.0f, 1.0f), random.between(-1.0f, 1.0f), random.between(-1.0f, 1.0f));
  // Now and then so near to the plane that floats cannot tell on which side.
  const bool is_near = random.below(3) == 0;
  if (is_near) {
    const float away = std::ldexp(1.0f, -22 - static_cast<int>(random.below(8)));
    for (int axis = 0; axis < 3; ++axis) {
      start[axis] = 0.4f * triangle.v[0][axis] + 0.3f * triangle.v[1][axis] + 0.3f * triangle.v[2][axis] +
                    random.between(-away, away);
    }
  }
  const bool is_beside = random.below(4) == 0;
  for (BatchRay& ray : group.rays) {
    const float a = is_beside ? random.between(1.01f, 1.2f) : random.below(3) == 0 ? 0.0f : random.between(0.0f, 1.2f);
    const float b = random.below(3) == 0 ? 0.0f : random.between(0.0f, 1.0f - 0.8f * a);
    for (int axis = 0; axis < 3; ++axis) {
      const float target = triangle.v[0][axis] + a * (triangle.v[1][axis] - triangle.v[0][axis]) +
                           b * (triangle.v[2][axis] - triangle.v[0][axis]);
      ray.origin[axis] = start[axis] + (is_shared ? 0.0f : random.between(-1e-7f, 1e-7f));
      ray.dir[axis] = is_near ? random.between(-1.0f, 1.0f) : target - ray.origin[axis];
    }
    const std::uint32_t kind = random.below(3);
    ray.t = kind == 0 ? kFloatMax : kind == 1 ? 1.0f : 0.5f;
    ray.id = no_hit(random.below(8) == 0 ? triangle.triangle_id : std::uint32_t{kNoTriangle});
  }
  // One ray in all lanes: no other keeps the triangle open for it.
  if (random.below(2) == 0) std::fill(std::begin(group.rays) + 1, std::end(group.rays), group.rays[0]);
  (void)load_group<L>(group.rays, 2.0f, group.lanes);
  for (std::uint32_t i = 0; i < kBeamRays; ++i) group.rays[i].dir_max = group.lanes.dir_max[i];
}

TYPED_TEST(RayGroupsTest, TrianglesThatRaysHitStayOpenAndDistancesAreThoseOfRays) {
  if constexpr (TypeParam::kCount > 4) {
    constexpr std::uint32_t kCount = TypeParam::kCount;
    TestRandom random(7);
    std::uint32_t hits = 0, closed = 0, wrong = 0, closed_misses = 0, settled = 0, open = 0;
    for (std::uint32_t round = 0; round < 20000; ++round) {
      const bool is_shared = round % 2 == 0;
      VertexTriangle triangle{};
      const float size = std::ldexp(1.0f, -static_cast<int>(random.below(12)));
      for (int axis = 0; axis < 3; ++axis) {
        triangle.v[0][axis] = random.between(-1.0f, 1.0f);
        triangle.v[1][axis] = triangle.v[0][axis] + random.between(-size, size);
        triangle.v[2][axis] = triangle.v[0][axis] + random.between(-size, size);
      }
      triangle.triangle_id = 3;
      alignas(64) Group group;
      aim_at_triangle<TypeParam>(triangle, is_shared, random, group);
      alignas(64) TriangleLanes lanes{};
      alignas(64) GroupLeaf leaf{};
      set_up_leaf<TypeParam>(&triangle, 1, lanes, &leaf);
      leaf.own_ids[0] = no_hit(triangle.triangle_id);
      if (is_shared) set_up_origin<TypeParam>(group.rays[0].origin, 1, lanes);
      PlaneNormal plane;
      set_up_plane_normal(triangle, plane);
      for (std::uint32_t base = 0; base < kBeamRays; base += kCount) {
        const bool is_open = is_shared
                                 ? GroupTriangle<TypeParam, true>(lanes, leaf, 0).may_be_hit(group.lanes, base)
                                 : GroupTriangle<TypeParam, false>(lanes, leaf, 0).may_be_hit(group.lanes, base);
        alignas(64) float distance[kCount];
        const std::uint32_t unsure = group_distances<TypeParam>(group.lanes, base, triangle, plane, distance);
        bool has_hit = false;
        for (std::uint32_t i = 0; i < kCount; ++i) {
          const BatchRay& ray = group.rays[base + i];
          WorkCounters work;
          const float t = ray_distance(ray, triangle, work);
          ++((unsure >> i & 1u) != 0 ? open : settled);
          if ((unsure >> i & 1u) == 0 && distance[i] != t) ++wrong;
          const bool is_hit = passes_through(ray, triangle, work) && t > 0.0f && t <= ray.t;
          has_hit = has_hit || (is_hit && ray.id != leaf.own_ids[0]);
        }
        hits += has_hit ? 1 : 0;
        closed += has_hit && !is_open ? 1 : 0;
        closed_misses += !has_hit && !is_open ? 1 : 0;
      }
    }
    EXPECT_GT(hits, 1000u);
    EXPECT_EQ(closed, 0u);
    EXPECT_EQ(wrong, 0u);
    // Or the bounds would rule nothing out.
    EXPECT_GT(closed_misses, 100u);
    EXPECT_LT(open, settled / 4);
  }
}

// Hits next to the origin shorten a beam to less than a normal float: it still holds them.
TYPED_TEST(RayGroupsTest, ShortBeamsHoldTheirHits) {
  if constexpr (TypeParam::kCount > 4) {
    for (const int mode : kRoundingModes) {
      for (const bool flush : {false, true}) {
        const RoundingScope scope(mode, flush);
        for (std::uint32_t round = 0; round < 1000; ++round) {
          alignas(64) Group group;
          for (BatchRay& ray : group.rays) {
            ray.dir[2] = 0x1.ecbbd8p-15f;
            ray.t = 1e30f;
            ray.id = no_hit(kNoTriangle);
          }
          const std::uint32_t all = load_group<TypeParam>(group.rays, 1.0f, group.lanes);
          std::uint32_t octant = 0;
          const std::uint32_t axis =
              make_group_beam<TypeParam>(group.lanes, all, 1.0f, group.beam, group.reach, octant);
          ASSERT_EQ(axis, 2u);
          alignas(64) GroupLeaf leaf{};
          leaf.low[2][0] = leaf.high[2][0] = std::ldexp(1.0f + 0x1p-10f * static_cast<float>(round), -140);
          leaf.low[0][0] = leaf.low[1][0] = -1.0f;
          leaf.high[0][0] = leaf.high[1][0] = 1.0f;
          // A hit in this plane: its distance is rounded.
          const auto t = static_cast<float>(double{leaf.low[2][0]} / double{group.rays[0].dir[2]});
          for (float& nearest : group.lanes.t) nearest = t;
          const float reach = group_reach<TypeParam>(group.lanes, group.beam, axis);
          ASSERT_EQ(triangles_in_group<TypeParam>(group.beam, reach, axis, leaf, 1), 1u) << round;
        }
      }
    }
  }
}

// Rays that run apart make beams of their own, of those that lie together.
TYPED_TEST(RayGroupsTest, RaysBesideOneRunAsItDoes) {
  if constexpr (TypeParam::kCount > 4) {
    alignas(64) Group group;
    for (std::uint32_t i = 0; i < kBeamRays; ++i) {
      BatchRay& ray = group.rays[i];
      const float place = 0.001f * static_cast<float>(i);
      ray.origin[0] = place, ray.origin[1] = i == 5 ? 0.5f : 0.0f, ray.origin[2] = i % 3 == 2 ? 0.1f : 0.0f;
      ray.dir[0] = i == 9 ? -0.5f : 0.0f, ray.dir[1] = 0.0f, ray.dir[2] = i == 12 ? -1.0f : 1.0f;
      ray.t = 1.0f;
      ray.id = no_hit(kNoTriangle);
    }
    const std::uint32_t all = load_group<TypeParam>(group.rays, 1.0f, group.lanes);
    EXPECT_EQ(all, 0xFFFFu);
    EXPECT_EQ(lanes_beside<TypeParam>(group.lanes, all, 0, 1.0f), 0xFFFFu & ~(1u << 5 | 1u << 9 | 1u << 12));
    EXPECT_EQ(lanes_beside<TypeParam>(group.lanes, 0x00FFu, 0, 1.0f), 0x00FFu & ~(1u << 5));
    EXPECT_EQ(lanes_beside<TypeParam>(group.lanes, all, 12, 1.0f), 1u << 12);
  }
}

}  // namespace
}  // namespace gridiron::test
