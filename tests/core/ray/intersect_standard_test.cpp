// The `standard` test against exact arithmetic: which rays hit, at which float, whose triangle it is.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/ray/camera.h>
#include <gridiron/ray/intersect_standard.h>

#include "core/lane_types.h"
#include "core/ray/packet_cases.h"
#include "core/seeds.h"
#include "support/test_mesh.h"

namespace gridiron::test {
namespace {

using SmallPacket = Packet<4>;
constexpr std::uint32_t kRays = SmallPacket::kRayCount;

template <class L>
class StandardTest : public testing::Test {};
TYPED_TEST_SUITE(StandardTest, LaneTypes, LaneNames);

TYPED_TEST(StandardTest, EveryRayHoldsTheLeastDistanceAndIdOfExactArithmetic) {
  std::uint64_t hits = 0;
  std::uint64_t ties = 0;
  for_each_seed(1500, [&](TestRandom& random) {
    const TriangleCase shown = random_triangles(random, 4);
    SmallPacket packet{};
    aim_at(random, shown, packet);
    packet.active.clear();
    for (std::uint32_t ray = 0; ray < kRays; ++ray) {
      if (random.below(8) != 0) packet.active.insert(ray);
    }
    std::vector<std::size_t> order(shown.triangles.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    WorkCounters work;
    SmallPacket first_result{};
    for (int round = 0; round < 2; ++round) {
      reset_hits(packet);
      for (const std::size_t i : order) {
        const SmallPacket before = packet;
        const bool changed = intersect_standard<TypeParam, false>(packet, shown.triangles[i], false, work);
        bool differs = false;
        for (std::uint32_t ray = 0; ray < kRays; ++ray) {
          differs = differs || packet.id[ray] != before.id[ray] || !same_bits(packet.t[ray], before.t[ray]);
        }
        ASSERT_EQ(changed, differs) << "triangle " << i;
      }
      if (round == 0) first_result = packet;
      std::reverse(order.begin(), order.end());
    }
    for (std::uint32_t ray = 0; ray < kRays; ++ray) {
      float best = kFloatMax;
      std::uint32_t best_id = kNoTriangle;
      if (packet.active.contains(ray)) {
        for (const VertexTriangle& triangle : shown.triangles) {
          const float t = true_distance(packet, ray, triangle);
          if (!(t > 0.0f)) continue;
          ++hits;
          ties += t == best && best_id != kNoTriangle ? 1u : 0u;
          if (t < best || (t == best && triangle.triangle_id < best_id)) {
            best = t;
            best_id = triangle.triangle_id;
          }
        }
      }
      ASSERT_TRUE(same_bits(packet.t[ray], best) && packet.id[ray] == best_id)
          << "ray " << ray << ": t " << std::hexfloat << packet.t[ray] << " of " << packet.id[ray] << " instead of "
          << best << " of " << best_id;
      ASSERT_TRUE(same_bits(first_result.t[ray], best) && first_result.id[ray] == best_id)
          << "the order of the triangles matters, ray " << ray;
      ASSERT_EQ(packet.facing[ray], -1.0f);
    }
  });
  if (!all_seeds_run()) return;
  EXPECT_GT(hits, 10000u);
  EXPECT_GT(ties, 1000u);
}

TYPED_TEST(StandardTest, ABatchIsItsTrianglesOneByOne) {
  constexpr std::uint32_t kBatch = EdgeBatch<TypeParam>::kTriangles;
  for_each_seed(3000, [&](TestRandom& random) {
    const TriangleCase shown = random_triangles(random, 6);
    SmallPacket single{};
    aim_at(random, shown, single);
    // Corner rays that bound nothing but themselves: culling has to be the same decision, right or wrong.
    for (auto& component : single.corner_dir) {
      for (float& value : component) value = random.between(-single.dir_max, single.dir_max);
    }
    single.corner_widening = 1.0f;
    SmallPacket batched = single;
    const bool use_culling = random.below(2) != 0;
    WorkCounters single_work, batch_work;
    const auto total = static_cast<std::uint32_t>(shown.triangles.size());
    for (std::uint32_t first = 0; first < total;) {
      const std::uint32_t count = std::min(1 + random.below(kBatch), total - first);
      OpenTriangle batch[kBatch] = {};
      bool changed = false;
      for (std::uint32_t i = 0; i < count; ++i) {
        batch[i] = {&shown.triangles[first + i], SmallPacket::kAllSubpackets, ~0u, false};
        changed |= intersect_standard<TypeParam, true>(single, *batch[i].triangle, use_culling, single_work);
      }
      const Culling culling{.corner_rays = use_culling, .subpackets = false};
      const SubpacketSet batch_changed =
          intersect_standard_batch<TypeParam, true>(batched, batch, count, culling, batch_work);
      ASSERT_EQ(batch_changed != 0, changed);
      first += count;
    }
    for (std::uint32_t ray = 0; ray < kRays; ++ray) {
      ASSERT_TRUE(same_bits(batched.t[ray], single.t[ray])) << "ray " << ray;
      ASSERT_EQ(batched.id[ray], single.id[ray]) << "ray " << ray;
      ASSERT_TRUE(same_bits(batched.facing[ray], single.facing[ray])) << "ray " << ray;
    }
    for (const Work kind : {Work::kTriangleSetup, Work::kCullTest, Work::kGroupTestStandard, Work::kHitSetup}) {
      ASSERT_EQ(batch_work[kind], single_work[kind]) << "kind " << static_cast<int>(kind);
    }
  });
}

TYPED_TEST(StandardTest, LimitIsClosed) {
  std::uint64_t hits = 0;
  for_each_seed(1500, [&](TestRandom& random) {
    TriangleCase shown = random_triangles(random, 1);
    shown.triangles.resize(1);
    const VertexTriangle& triangle = shown.triangles[0];
    SmallPacket packet{};
    aim_at(random, shown, packet);
    WorkCounters work;
    (void)intersect_standard<TypeParam, false>(packet, triangle, false, work);
    const SmallPacket free = packet;
    reset_hits(packet);
    std::ranges::copy(free.t, packet.t);
    (void)intersect_standard<TypeParam, false>(packet, triangle, false, work);
    for (std::uint32_t ray = 0; ray < kRays; ++ray) {
      ASSERT_EQ(packet.id[ray], free.id[ray]) << "a hit at t_far counts, ray " << ray;
      ASSERT_EQ(packet.t[ray], free.t[ray]) << "ray " << ray;
    }
    reset_hits(packet);
    for (std::uint32_t ray = 0; ray < kRays; ++ray) packet.t[ray] = std::nextafter(free.t[ray], 0.0f);
    EXPECT_FALSE((intersect_standard<TypeParam, false>(packet, triangle, false, work)));
    for (std::uint32_t ray = 0; ray < kRays; ++ray) {
      hits += free.id[ray] != kNoTriangle ? 1u : 0u;
      ASSERT_EQ(packet.id[ray], kNoTriangle) << "a hit behind t_far, ray " << ray;
    }
  });
  if (!all_seeds_run()) return;
  EXPECT_GT(hits, 2000u);
}

TYPED_TEST(StandardTest, OriginOnATriangleDoesNotHitIt) {
  const VertexTriangle triangle = vertex_triangle({0, 0, 0}, {4, 0, 0}, {0, 4, 0}, 7);
  const Vec3 origins[] = {{1, 1, 0}, {0, 0, 0}, {2, 2, 0}, {2, 0, 0}, {9, 9, 0}};
  for (const Vec3& origin : origins) {
    SmallPacket packet{};
    TestRandom random(1);
    for (int axis = 0; axis < 3; ++axis) {
      packet.origin[axis] = origin[axis];
      for (std::uint32_t ray = 0; ray < kRays; ++ray) packet.dir[axis][ray] = random.between(-1, 1);
    }
    start_all(packet);
    WorkCounters work;
    EXPECT_FALSE((intersect_standard<TypeParam, false>(packet, triangle, false, work)));
    for (const std::uint32_t id : packet.id) EXPECT_EQ(id, kNoTriangle);
  }
}

TYPED_TEST(StandardTest, FacingIsTheCosineOfTheUnitNormal) {
  for_each_seed(500, [&](TestRandom& random) {
    const float scale = random.below(2) == 0 ? 1.0f : 1e15f;
    const Vec3 a = random_vec(random, scale), b = random_vec(random, scale), c = random_vec(random, scale);
    const VertexTriangle triangle = vertex_triangle(a, b, c, 1);
    const DVec3 u = DVec3(b) - DVec3(a), v = DVec3(c) - DVec3(a);
    const DVec3 normal(u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x);
    const double length = std::sqrt(normal.x * normal.x + normal.y * normal.y + normal.z * normal.z);
    const TriangleCase shown{{0.1f * scale, -3.0f * scale, 2.0f * scale}, {triangle}};
    SmallPacket packet{};
    aim_at(random, shown, packet);
    WorkCounters work;
    (void)intersect_standard<TypeParam, true>(packet, triangle, false, work);
    for (std::uint32_t ray = 0; ray < kRays; ++ray) {
      if (packet.id[ray] == kNoTriangle) {
        ASSERT_EQ(packet.facing[ray], -1.0f);
        continue;
      }
      const double along =
          normal.x * packet.dir[0][ray] + normal.y * packet.dir[1][ray] + normal.z * packet.dir[2][ray];
      ASSERT_NEAR(packet.facing[ray], std::fabs(along) / length, 0x1p-15 * packet.dir_max);
    }
  });
}

TYPED_TEST(StandardTest, FilterDecidesOrdinaryRays) {
  // Integers are for the rare ray, or the test would be too slow to be of use.
  WorkCounters work;
  std::uint64_t rays = 0;
  for (std::uint64_t seed = 1; seed <= 2000; ++seed) {
    TestRandom random(seed);
    const Vec3 a = random_vec(random, 1), b = random_vec(random, 1), c = random_vec(random, 1);
    const VertexTriangle triangle = vertex_triangle(a, b, c, 1);
    SmallPacket packet{};
    packet.origin[2] = 4.0f;
    for (std::uint32_t ray = 0; ray < kRays; ++ray) {
      packet.dir[0][ray] = random.between(-0.25f, 0.25f);
      packet.dir[1][ray] = random.between(-0.25f, 0.25f);
      packet.dir[2][ray] = -1.0f;
    }
    start_all(packet);
    (void)intersect_standard<TypeParam, false>(packet, triangle, false, work);
    rays += kRays;
  }
  EXPECT_LT(work[Work::kExactSign], 3u);
  EXPECT_LT(work[Work::kExactDistance], 3u);
  EXPECT_LT(work[Work::kDoubleSign], rays / 1000);
}

// A frame whose pixels the packets of the tests below are.
FrameRecord random_frame(TestRandom& random) {
  FrameRecord frame{};
  frame.t_far = kFloatMax;
  const Vec3 eye = random_vec(random, std::ldexp(1.0f, static_cast<int>(random.below(8))));
  const float pixel = 1.0f / 64.0f / static_cast<float>(1 + random.below(32));
  Vec3 right = random_vec(random, 1.0f);
  Vec3 down = random_vec(random, 1.0f);
  if (random.below(3) == 0) {
    right = {1, 0, 0};
    down = {0, -1, 0};
  }
  const Vec3 forward(right.y * down.z - right.z * down.y, right.z * down.x - right.x * down.z,
                     right.x * down.y - right.y * down.x);
  for (int axis = 0; axis < 3; ++axis) {
    frame.eye[axis] = eye[axis];
    frame.step_x[axis] = right[axis] * pixel;
    frame.step_y[axis] = down[axis] * pixel;
    frame.corner[axis] = forward[axis] - right[axis] - down[axis];
  }
  frame.width = frame.height = static_cast<std::uint32_t>(2.0f / pixel);
  return frame;
}

// A triangle beside one side of a packet. Its near edge runs along that side, from within rounding to a packet away,
// and now and then overlaps it.
template <class PacketType>
VertexTriangle triangle_at_the_border(TestRandom& random, const PacketType& packet) {
  constexpr std::uint32_t kCorners[4] = {0, 1, 3, 2};
  const std::uint32_t side = random.below(4);
  const auto direction = [&](std::uint32_t corner) {
    const std::uint32_t i = kCorners[(side + corner) % 4];
    return Vec3(packet.corner_dir[0][i], packet.corner_dir[1][i], packet.corner_dir[2][i]);
  };
  const Vec3 origin = vec_of(packet.origin);
  const Vec3 outward = direction(1) - direction(2);
  const float gap =
      std::ldexp(random.unit() - (random.below(4) == 0 ? 0.5f : 0.0f), -static_cast<int>(random.below(20)));
  const float depth = 1.0f + 4.0f * random.unit();
  const float tilt = 1.0f + std::ldexp(random.unit(), -static_cast<int>(random.below(12)));
  const Vec3 from = origin + depth * (direction(0) + gap * outward);
  const Vec3 to = origin + depth * tilt * (direction(1) + gap * outward);
  // Longer than the side on both ends; shorter, now and then.
  const float longer = random.below(4) == 0 ? -0.3f : 2.0f * random.unit();
  const Vec3 a = from - longer * (to - from);
  const Vec3 b = to + longer * (to - from);
  return vertex_triangle(a, b, b + (1.0f + 9.0f * random.unit()) * outward, 5);
}

// A triangle with an edge along the border between two columns or rows of a packet's pixels, from within rounding of
// the rays beside it to some pixels away, or a small one anywhere.
template <class PacketType>
VertexTriangle triangle_at_a_row(TestRandom& random, const PacketType& packet) {
  constexpr std::uint32_t kWidth = PacketType::kWidth;
  const Vec3 origin = vec_of(packet.origin);
  const auto along = [&](float column, float row) {
    Vec3 direction;
    for (int axis = 0; axis < 3; ++axis) {
      direction[axis] = packet.first_dir[axis] + column * packet.step_x[axis] + row * packet.step_y[axis];
    }
    return direction;
  };
  const bool by_row = random.below(2) != 0;
  const auto pixel = [&](float across, float line) { return by_row ? along(across, line) : along(line, across); };
  const float off = std::ldexp(random.between(-1, 1), -static_cast<int>(random.below(24)));
  const float line = static_cast<float>(random.below(kWidth)) + off;
  const float slant = random.below(2) == 0 ? 0.0f : random.between(-4, 4);
  const float first = random.between(-4, static_cast<float>(kWidth));
  const float length = random.between(0.5f, static_cast<float>(kWidth));
  const float depth = 1.0f + 4.0f * random.unit();
  const float tilt = 1.0f + std::ldexp(random.unit(), -static_cast<int>(random.below(12)));
  const float side = (random.below(2) == 0 ? 1.0f : -1.0f) * random.between(0.25f, 9.0f);
  const Vec3 a = origin + depth * pixel(first, line);
  const Vec3 b = origin + depth * tilt * pixel(first + length, line + slant);
  return vertex_triangle(a, b, origin + depth * pixel(first + random.unit() * length, line + side), 5);
}

template <class L, class PacketType>
void expect_subpacket_culling_drops_no_hit() {
  std::uint64_t left_out = 0;
  std::uint64_t hit_count = 0;
  std::uint64_t untested_hits = 0;  // triangles with whole subpackets inside
  for_each_seed(400, [&](TestRandom& random) {
    const FrameRecord frame = random_frame(random);
    RaySet<PacketType::kRayCount> present;
    PacketType packet{};
    WorkCounters work;
    const std::uint32_t left = PacketType::kWidth * random.below(frame.width / PacketType::kWidth + 1);
    const std::uint32_t top = PacketType::kWidth * random.below(frame.height / PacketType::kWidth + 1);
    if (left >= frame.width || top >= frame.height) return;
    generate_packet<L>(frame, left, top, packet, present, work);
    packet.ask_for_distances(true);
    packet.active = present;
    const auto intersect = [&](const VertexTriangle& triangle, bool by_subpackets) {
      reset_hits(packet);
      work = WorkCounters{};
      const Culling culling{.corner_rays = false, .subpackets = by_subpackets};
      OpenTriangle open[1];
      const std::uint32_t count =
          open_triangles<L>(packet, &triangle, 1, PacketType::kAllSubpackets, culling, open, work);
      return intersect_standard_batch<L, false>(packet, open, count, culling, work);
    };
    for (int i = 0; i < 40; ++i) {
      const VertexTriangle triangle = triangle_at_a_row(random, packet);
      const SubpacketSet expected = intersect(triangle, false);
      const std::uint32_t all_tests = work[Work::kGroupTestStandard];
      const PacketType wanted = packet;
      const SubpacketSet found = intersect(triangle, true);
      ASSERT_EQ(found, expected) << "triangle " << i;
      ASSERT_TRUE(std::ranges::equal(packet.id, wanted.id)) << "triangle " << i;
      ASSERT_TRUE(std::ranges::equal(packet.t, wanted.t, same_bits)) << "triangle " << i;
      ASSERT_LE(work[Work::kRowTest], all_tests);
      untested_hits += work[Work::kHitGroup] > work[Work::kRowTest] ? 1u : 0u;
      left_out += all_tests - work[Work::kRowTest];
      hit_count += expected != 0 ? 1u : 0u;
    }
  });
  if (!all_seeds_run()) return;
  EXPECT_GT(left_out, 1000u);
  EXPECT_GT(hit_count, 1000u);
  EXPECT_GT(untested_hits, PacketType::kWidth / 8u);
}

TYPED_TEST(StandardTest, SubpacketCullingDropsNoHit) {
  expect_subpacket_culling_drops_no_hit<TypeParam, Packet<8>>();
  expect_subpacket_culling_drops_no_hit<TypeParam, Packet<16>>();
  expect_subpacket_culling_drops_no_hit<TypeParam, Packet<32>>();
}

TYPED_TEST(StandardTest, EstimatesAreAsCloseAsTheySay) {
  std::uint64_t close_count = 0;
  std::uint64_t open_count = 0;
  for_each_seed(4000, [&](TestRandom& random) {
    const TriangleCase shown = random_triangles(random, 2);
    SmallPacket packet{};
    aim_at(random, shown, packet);
    for (const VertexTriangle& triangle : shown.triangles) {
      const DistanceEstimate estimate = set_up_estimate(packet.origin, packet.dir_max, triangle);
      for (std::uint32_t ray = 0; ray < kRays; ++ray) {
        const float distance = true_distance(packet, ray, triangle);
        if (!(distance > 0.0f)) continue;
        const auto direction = direction_of(packet, ray);
        const float denominator =
            estimate.normal[0] * direction[0] + estimate.normal[1] * direction[1] + estimate.normal[2] * direction[2];
        if (!(std::fabs(denominator) > estimate.least_denominator)) {
          ++open_count;
          continue;
        }
        ASSERT_GT(denominator, 0.0f) << "in front, ray " << ray;
        ++close_count;
        const double error = double{estimate.numerator / denominator} - double{distance};
        ASSERT_LE(std::fabs(error), double{kEstimateError} * double{distance})
            << std::hexfloat << "ray " << ray << ": " << distance;
      }
    }
  });
  if (!all_seeds_run()) return;
  EXPECT_GT(close_count, 5000u);
  EXPECT_GT(open_count, 1000u);
}

// Estimates either find the exact winner or say that they cannot; then the exact pass finds it.
TYPED_TEST(StandardTest, EstimatesFindTheWinnerOrLeaveItOpen) {
  std::uint64_t hits = 0;
  std::uint64_t unsure_count = 0;
  std::uint64_t exact_groups = 0;
  for_each_seed(3000, [&](TestRandom& random) {
    const TriangleCase shown = random_triangles(random, 6);
    SmallPacket exact{};
    aim_at(random, shown, exact);
    SmallPacket packet = exact;
    WorkCounters work;
    for (const VertexTriangle& triangle : shown.triangles) {
      (void)intersect_standard<TypeParam, true>(exact, triangle, false, work);
    }
    packet.ask_for_distances(false);
    work = WorkCounters{};
    for (const VertexTriangle& triangle : shown.triangles) {
      (void)intersect_standard<TypeParam, true>(packet, triangle, false, work);
    }
    exact_groups += work[Work::kHitHalf];
    const auto unsure_before = packet.unsure;
    for (std::uint32_t ray = 0; ray < kRays; ++ray) {
      if (packet.unsure.contains(ray)) continue;
      hits += packet.id[ray] != kNoTriangle ? 1u : 0u;
      ASSERT_EQ(packet.id[ray], exact.id[ray]) << "ray " << ray;
      ASSERT_LE(std::fabs(double{packet.t[ray]} - double{exact.t[ray]}), double{kEstimateError} * double{exact.t[ray]})
          << "ray " << ray;
      ASSERT_TRUE(same_bits(packet.facing[ray], exact.facing[ray])) << "ray " << ray;
    }
    RaySet<kRays> again;
    if (!take_unsure_rays(packet, kFloatMax, again, work)) return;
    packet.active = again;
    for (const VertexTriangle& triangle : shown.triangles) {
      (void)intersect_standard<TypeParam, true>(packet, triangle, false, work);
    }
    for (std::uint32_t ray = 0; ray < kRays; ++ray) {
      ASSERT_EQ(again.contains(ray), unsure_before.contains(ray));
      if (!again.contains(ray)) continue;
      ++unsure_count;
      ASSERT_EQ(packet.id[ray], exact.id[ray]) << "ray " << ray;
      ASSERT_TRUE(same_bits(packet.t[ray], exact.t[ray])) << "ray " << ray;
      ASSERT_TRUE(same_bits(packet.facing[ray], exact.facing[ray])) << "ray " << ray;
    }
  });
  if (!all_seeds_run()) return;
  EXPECT_GT(hits, 10000u);
  EXPECT_GT(unsure_count, 100u);
  EXPECT_GT(exact_groups, 1000u);
}

TYPED_TEST(StandardTest, CornerCullingDropsNoHit) {
  using WidePacket = Packet<8>;
  std::uint64_t culled = 0;
  std::uint64_t hit = 0;
  for_each_seed(6000, [&](TestRandom& random) {
    const FrameRecord frame = random_frame(random);
    RaySet<WidePacket::kRayCount> present;
    WidePacket packet{};
    WorkCounters work;
    const std::uint32_t left = 8 * random.below(frame.width / 8);
    const std::uint32_t top = 8 * random.below(frame.height / 8);
    generate_packet<TypeParam>(frame, left, top, packet, present, work);
    packet.active = present;
    for (int i = 0; i < 100; ++i) {
      const VertexTriangle triangle = triangle_at_the_border(random, packet);
      reset_hits(packet);
      work = WorkCounters{};
      const bool with_culling = intersect_standard<TypeParam, false>(packet, triangle, true, work);
      if (work[Work::kGroupTestStandard] != 0) {  // not culled: the same code as without
        hit += with_culling ? 1u : 0u;
        continue;
      }
      ++culled;
      ASSERT_FALSE((intersect_standard<TypeParam, false>(packet, triangle, false, work)))
          << "culled, but hit, pair " << i;
    }
  });
  if (!all_seeds_run()) return;
  EXPECT_GT(culled, 40000u);
  EXPECT_GT(hit, 40000u);
}

TYPED_TEST(StandardTest, NoRayLeavesAClosedSphere) {
  using WidePacket = Packet<16>;
  const TestMesh sphere = make_sphere(10, 13, 1.0f);
  std::vector<VertexTriangle> triangles;
  for (std::uint32_t i = 0; i < sphere.triangles.size(); ++i) {
    const UVec3& t = sphere.triangles[i];
    triangles.push_back(vertex_triangle(sphere.vertices[t.x], sphere.vertices[t.y], sphere.vertices[t.z], i));
  }
  std::uint64_t rays = 0;
  WorkCounters work;
  for_each_seed(1350, [&](TestRandom& random) {
    WidePacket packet{};
    // From anywhere inside: the insphere of this tessellation has a radius above 0.9.
    const Vec3 origin = random_vec(random, 0.5f);
    for (int axis = 0; axis < 3; ++axis) packet.origin[axis] = origin[axis];
    for (std::uint32_t ray = 0; ray < WidePacket::kRayCount; ++ray) {
      const UVec3& t = sphere.triangles[random.below(static_cast<std::uint32_t>(sphere.triangles.size()))];
      const Vec3 a = sphere.vertices[t.x];
      const Vec3 b = sphere.vertices[t.y];
      const Vec3 p = ray % 2 == 0 ? a : a + random.unit() * (b - a);
      for (int axis = 0; axis < 3; ++axis) {
        packet.dir[axis][ray] = p[axis] - origin[axis];
      }
    }
    start_all(packet);
    for (const VertexTriangle& triangle : triangles) {
      (void)intersect_standard<TypeParam, false>(packet, triangle, false, work);
    }
    for (std::uint32_t ray = 0; ray < WidePacket::kRayCount; ++ray) {
      ASSERT_NE(packet.id[ray], kNoTriangle) << "ray " << ray;
      ASSERT_NEAR(packet.t[ray], 1.0f, 1e-5f) << "ray " << ray;
    }
    rays += WidePacket::kRayCount;
  });
  if (!all_seeds_run()) return;
  EXPECT_GT(rays * 3, 1000000u);  // over the three lane counts
  EXPECT_GT(work[Work::kExactSign], 10000u) << "the rays are not hard enough";
}

}  // namespace
}  // namespace gridiron::test
