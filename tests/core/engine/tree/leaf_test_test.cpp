// Triangles of a leaf against rays: what floats say of them, and what doubles and integers decide of the rest, by the
// oracle's integers; no ray leaves a closed mesh. SPDX-License-Identifier: Apache-2.0
#include <gridiron/engine/tree/leaf_test.h>
#include <gridiron/engine/tree/list_rays.h>
#include <gridiron/ray/intersect_rays.h>

#include "core/lane_types.h"
#include "core/seeds.h"
#include "numeric/hard_rays.h"
#include "numeric/oracle.h"
#include "numeric/rounding_scope.h"
#include "support/test_mesh.h"

namespace gridiron::test {
namespace {

constexpr std::uint32_t kRays = 16;  // of a case

template <class L>
class LeafTest : public testing::Test {};
TYPED_TEST_SUITE(LeafTest, ListLaneTypes, LaneNames);

BatchRay batch_ray(const OracleRay& ray) {
  BatchRay made{};
  for (int axis = 0; axis < 3; ++axis) {
    made.origin[axis] = ray.origin[axis];
    made.dir[axis] = ray.direction[axis];
    made.dir_max = std::fmax(made.dir_max, std::fabs(ray.direction[axis]));
  }
  made.t = ray.t_max;
  made.id = kNoTriangle;
  return made;
}

float largest_of(const TestMesh& mesh) {
  float largest = 0.0f;
  for (const Vec3& v : mesh.vertices) {
    largest = std::fmax(largest, std::fmax(std::fabs(v.x), std::fmax(std::fabs(v.y), std::fabs(v.z))));
  }
  return largest;
}

// A ray as RayLists prepares it for a scene: leaves are tested against such rays alone. Its direction may be another by
// a power of two, and its t with it.
template <class L>
BatchRay list_ray(const OracleRay& ray, float largest) {
  BatchRay made = batch_ray(ray);
  set_up_list_ray<L>(made, largest);
  return made;
}

// The same ray for the oracle.
OracleRay oracle_ray(const BatchRay& ray) {
  OracleRay made{};
  for (int axis = 0; axis < 3; ++axis) {
    made.origin[axis] = ray.origin[axis];
    made.direction[axis] = ray.dir[axis];
  }
  made.t_max = kFloatMax;
  return made;
}

// What floats say of all triangles of a leaf; bit i = triangle i.
struct LeafBits {
  std::uint32_t inside = 0, unsure = 0, within = 0;
  float least_t[kMaxTreeLeaf];  // of those inside or unsure

  friend bool operator==(const LeafBits& a, const LeafBits& b) {
    return a.inside == b.inside && a.unsure == b.unsure && a.within == b.within;
  }
};

// A leaf as RayLists sets it up.
template <class L>
class Leaf {
 public:
  explicit Leaf(const std::vector<VertexTriangle>& triangles, bool trusts_floats = false)
      : count_(static_cast<std::uint32_t>(triangles.size())), trusts_floats_(trusts_floats) {
    // Lanes without a triangle must not matter.
    std::memset(static_cast<void*>(&lanes_), 0xFF, sizeof lanes_);
    set_up_leaf<L>(triangles.data(), count_, lanes_);
  }
  [[nodiscard]] LeafBits test(const BatchRay& ray) const {
    return bits_of([&](std::uint32_t base, std::uint32_t there) {
      return trusts_floats_ ? LeafLanes<L, false>(lanes_, base).test(ray, there)
                            : LeafLanes<L, true>(lanes_, base).test(ray, there);
    });
  }
  // As for a batch of which all rays have its origin, but for the ray's own triangle.
  [[nodiscard]] LeafBits test_shared(const BatchRay& ray, std::uint32_t own) const {
    TriangleLanes lanes = lanes_;
    set_up_origin<L>(ray.origin, count_, lanes);
    alignas(64) std::uint32_t own_ids[kMaxTreeLeaf] = {};
    own_ids[own] = ray.id;
    return bits_of([&](std::uint32_t base, std::uint32_t there) {
      return SharedLanes<L, true>(lanes, base, own_ids).test(ray, there);
    });
  }

 private:
  template <class Test>
  [[nodiscard]] LeafBits bits_of(const Test& test) const {
    LeafBits bits;
    for (std::uint32_t base = 0; base < count_; base += L::kCount) {
      const std::uint32_t rest = count_ - base;
      const std::uint32_t there = rest >= L::kCount ? std::uint32_t{L::kAllBits} : (1u << rest) - 1u;
      const LeafAnswer<L> answer = test(base, there);
      EXPECT_EQ(answer.inside & answer.unsure, 0u);
      EXPECT_EQ((answer.inside | answer.unsure) & ~there, 0u) << "a lane without a triangle";
      bits.inside |= answer.inside << base;
      bits.unsure |= answer.unsure << base;
      bits.within |= (answer.within & (answer.inside | answer.unsure)) << base;
      alignas(64) float least[L::kCount];
      answer.least_t().store(least);
      for (std::uint32_t lane = 0; lane < L::kCount && base + lane < kMaxTreeLeaf; ++lane) {
        bits.least_t[base + lane] = least[lane];
      }
    }
    return bits;
  }

  std::uint32_t count_;
  bool trusts_floats_;
  TriangleLanes lanes_;
};

// The triangles of a leaf that stop a ray, as RayLists decides it for any hit.
std::uint32_t stopping(const BatchRay& ray, const std::vector<VertexTriangle>& triangles, const LeafBits& bits,
                       WorkCounters& work) {
  std::uint32_t stopped = 0;
  for (std::uint32_t i = 0; i < triangles.size(); ++i) {
    const bool is_inside = (bits.inside >> i & 1u) != 0, is_within = (bits.within >> i & 1u) != 0;
    if (!is_inside && ((bits.unsure >> i & 1u) == 0 || !passes_through(ray, triangles[i], work))) continue;
    const float t = is_within ? 0.0f : ray_distance(ray, triangles[i], work);
    if (is_within || (t > 0.0f && t <= ray.t)) stopped |= 1u << i;
  }
  return stopped;
}

bool is_a_ray(const OracleRay& ray) {
  bool finite = true;
  for (int axis = 0; axis < 3; ++axis) finite = finite && is_finite(ray.origin[axis]) && is_finite(ray.direction[axis]);
  return finite;
}

// A hard case's rays, half of them with origins of their own: on vertices, on edges, in planes, in triangles, anywhere.
std::vector<OracleRay> hard_rays(const HardCase& hard, TestRandom& random) {
  std::vector<OracleRay> rays;
  while (rays.size() < kRays) {
    OracleRay ray{};
    if (!hard.rays.empty() && random.below(2) == 0) {
      ray = hard.rays[random.below(static_cast<std::uint32_t>(hard.rays.size()))];
    } else {
      const auto corner = [&] {
        return hard.mesh.vertices[random.below(static_cast<std::uint32_t>(hard.mesh.vertices.size()))];
      };
      const UVec3& t = hard.mesh.triangles[random.below(static_cast<std::uint32_t>(hard.mesh.triangles.size()))];
      const Vec3 a = hard.mesh.vertices[t.x], b = hard.mesh.vertices[t.y], c = hard.mesh.vertices[t.z];
      Vec3 origin = a;
      const std::uint32_t place = random.below(6);
      const float r = random.unit(), s = random.unit() * (1.0f - r);
      if (place == 1) origin = a + r * (b - a);
      if (place == 2) origin = a + r * (b - a) + s * (c - a);
      if (place == 3) origin = a + 3.0f * r * (b - a) - 2.0f * s * (c - a);
      if (place >= 4) origin = a + (2.0f * r - 0.5f) * (corner() - a) + (2.0f * s - 0.5f) * (corner() - b);
      ray = ray_at(hard.mesh, origin, static_cast<Aim>(random.below(static_cast<std::uint32_t>(Aim::kCount))), random);
      if (random.below(6) == 0) {
        for (float& value : ray.direction) value = -value;
      }
    }
    ray.t_min = 0.0f;
    ray.t_max = kFloatMax;
    if (!is_a_ray(ray)) continue;
    rays.push_back(ray);
  }
  return rays;
}

// Distances of a mesh's triangles along a ray, by id; 0 where it misses.
std::vector<float> true_distances(const Oracle& oracle, const OracleRay& ray, std::size_t count) {
  std::vector<float> result(count, 0.0f);
  for (const OracleHit& hit : oracle.hits(ray)) {
    result[hit.triangle_id] = oracle.distance(ray, hit.triangle_id).rounded(Reading::kStandard);
  }
  return result;
}

TYPED_TEST(LeafTest, DecidesAsTheOracleDoes) {
  std::uint64_t hits = 0, sure_hits = 0, unsure = 0, at_limit = 0, bounded = 0, pairs = 0, scaled = 0, boundless = 0;
  std::uint64_t unlimited = 0, shared_hits = 0;
  WorkCounters work;
  for_each_seed(1500, [&](std::uint64_t seed) {
    TestRandom random(seed * 7919);
    const HardCase hard = make_hard_case(seed);
    const Oracle oracle(hard.mesh.view(), {.reading = Reading::kStandard});
    const std::vector<OracleRay> shot = hard_rays(hard, random);
    const auto triangle_count = static_cast<std::uint32_t>(hard.mesh.triangles.size());
    // Up to 16 of the triangles, in any lanes, some of them several times.
    std::vector<VertexTriangle> triangles(1 + random.below(kMaxTreeLeaf));
    for (VertexTriangle& triangle : triangles) triangle = triangle_of(hard.mesh, random.below(triangle_count));
    const Leaf<TypeParam> leaf(triangles);
    const Leaf<Lanes<4>> other_leaf(triangles);
    const Leaf<TypeParam> fast_leaf(triangles, true);
    const Leaf<Lanes<4>> other_fast_leaf(triangles, true);
    const float largest = largest_of(hard.mesh);
    for (const OracleRay& shot_ray : shot) {
      BatchRay ray = list_ray<TypeParam>(shot_ray, largest);
      scaled += ray.t != shot_ray.t_max ? 1u : 0u;
      boundless += ray.dir_max == kInfinity ? 1u : 0u;
      const std::vector<float> distances = true_distances(oracle, oracle_ray(ray), triangle_count);
      // Limits: none, anywhere, at a hit or one float away from it.
      const float hit = distances[random.below(triangle_count)];
      const std::uint32_t limit = random.below(6);
      if (limit == 1) ray.t = 0.5f + random.unit();
      if (hit > 0.0f && limit == 2) ray.t = hit;
      if (hit > 0x1p-126f && limit == 3) ray.t = std::nextafter(hit, 0.0f);
      if (hit > 0.0f && limit == 4) ray.t = hit * 1.000001f < kFloatMax ? hit * 1.000001f : kFloatMax;
      if (limit == 5) ray.t = kInfinity;
      const LeafBits bits = leaf.test(ray);
      const std::uint32_t stopped = stopping(ray, triangles, bits, work);
      ASSERT_EQ(fast_leaf.test(ray), other_fast_leaf.test(ray)) << "other lanes, by floats alone";
      if constexpr (!TypeParam::kRoundsOnce) {
        ASSERT_EQ(other_leaf.test(ray), bits) << "other lanes";
      }
      const std::uint32_t own = random.below(static_cast<std::uint32_t>(triangles.size()));
      LeafBits shared = bits;
      if constexpr (TypeParam::kCount >= 4) shared = leaf.test_shared(ray, own);
      const std::uint32_t stopped_shared = stopping(ray, triangles, shared, work);
      for (std::uint32_t i = 0; i < triangles.size(); ++i) {
        const float truth = distances[triangles[i].triangle_id];
        if (truth == kFloatMax) continue;  // farther than all floats: may be a hit or none
        const bool is_hit = truth > 0.0f && truth <= ray.t;
        const bool is_inside = (bits.inside >> i & 1u) != 0, is_unsure = (bits.unsure >> i & 1u) != 0;
        const bool is_within = (bits.within >> i & 1u) != 0;
        ASSERT_EQ((stopped >> i & 1u) != 0, is_hit) << "lane " << i << " at " << truth << " of " << ray.t;
        const bool is_apart = TypeParam::kCount >= 4 && i == own;  // left out
        ASSERT_EQ((stopped_shared >> i & 1u) != 0, is_hit && !is_apart) << "lane " << i << ", one origin";
        if (((shared.inside & shared.within) >> i & 1u) != 0) {
          ASSERT_TRUE(is_hit) << "lane " << i << ", one origin";
        }
        shared_hits += is_hit && (shared.inside & shared.within) >> i & 1u;
        if (is_inside) {
          ASSERT_TRUE(passes_through(ray, triangles[i], work)) << "lane " << i;
        }
        if (is_inside && is_within) {
          ASSERT_TRUE(is_hit) << "lane " << i << " at " << truth << " of " << ray.t;
        }
        if (is_hit) {
          ASSERT_TRUE(is_inside || is_unsure) << "lane " << i;
          ASSERT_EQ(ray_distance(ray, triangles[i], work), truth) << "lane " << i;
          ASSERT_LE(bits.least_t[i], truth) << "lane " << i;
          bounded += bits.least_t[i] > 0.99f * truth ? 1u : 0u;
        }
        ++pairs;
        hits += is_hit ? 1u : 0u;
        sure_hits += is_inside && is_within ? 1u : 0u;
        unlimited += is_inside && is_within && ray.t == kInfinity ? 1u : 0u;
        unsure += is_unsure ? 1u : 0u;
        at_limit += truth == ray.t ? 1u : 0u;
      }
    }
  });
  if (testing::Test::HasFailure() || !all_seeds_run()) return;
  EXPECT_GT(pairs, 50'000u);
  EXPECT_GT(hits, 5'000u);
  EXPECT_GT(sure_hits, 1'000u);
  EXPECT_GT(shared_hits, 1'000u);
  EXPECT_GT(unlimited, 100u) << "rays without end";
  EXPECT_GT(unsure, 1'000u);
  EXPECT_GT(at_limit, 500u);
  EXPECT_GT(bounded, hits / 4) << "estimates say nothing";
  EXPECT_GT(scaled, 500u) << "rays of sizes that are brought to 1";
  EXPECT_GT(boundless, 500u) << "rays that floats say nothing of";
  EXPECT_GT(work[Work::kExactDistance], 0u);
}

// What is lost below the least normal number, times a long edge, is more than all other errors of a small ray near 0.
// Products of equal size cancel at edges: what floats call sure is right with all roundings to one side too.
TYPED_TEST(LeafTest, SidesThatCancelAreBounded) {
  TestRandom random(7);
  const auto place = [&] {
    const float size = 1.0f + 0x1p-12f * static_cast<float>(random.unit());
    return random.next() % 2 == 0 ? size : -size;
  };
  std::uint32_t passed = 0, sure = 0;
  for (std::uint32_t i = 0; i < 20000; ++i) {
    std::vector<VertexTriangle> triangles(1);
    VertexTriangle& triangle = triangles[0];
    for (auto& corner : triangle.v) {
      for (float& component : corner) component = place();
    }
    OracleRay ray{};
    const float along = static_cast<float>(random.unit());
    const std::uint64_t edge = random.next() % 3;
    const float beside = random.next() % 4 == 0 ? 0.1f : 0.0f;  // of the edge
    const auto &a = triangle.v[edge], &b = triangle.v[(edge + 1) % 3], &c = triangle.v[(edge + 2) % 3];
    for (int axis = 0; axis < 3; ++axis) {
      ray.origin[axis] = place();
      ray.direction[axis] = a[axis] + along * (b[axis] - a[axis]) + beside * (c[axis] - a[axis]) - ray.origin[axis];
    }
    ray.t_max = kFloatMax;
    const BatchRay made = list_ray<TypeParam>(ray, 2.0f);
    WorkCounters work;
    const bool passes = passes_through(made, triangle, work),
               hits = passes && ray_distance(made, triangle, work) > 0.0f;
    passed += passes ? 1u : 0u;
    for (const int mode : kRoundingModes) {
      const RoundingScope scope(mode, false);
      const LeafBits bits = Leaf<TypeParam>(triangles).test(made);
      sure += bits.unsure == 0 ? 1u : 0u;
      ASSERT_FALSE(bits.inside != 0 && !passes) << i;
      ASSERT_FALSE((bits.inside | bits.unsure) == 0 && hits) << i;
    }
  }
  EXPECT_GT(passed, 1000u);
  EXPECT_GT(sure, 1000u);
}

TYPED_TEST(LeafTest, HitsOfSmallRaysAtLongEdgesCount) {
  const VertexTriangle triangle{{{-0x1.647dcap-126f, 0x1.12586p-128f, -0x1.89e5fap-126f},
                                 {0x1.c123d8p34f, 0x1.72d738p35f, 0x1.7858ep35f},
                                 {0x1.f2598p-130f, 0x1.1076acp-126f, 0x1.5dcd7cp-126f}},
                                {},
                                0};
  OracleRay shot{};
  const float origin[3] = {-0x1.91f728p-128f, 0x1.a2db9cp-126f, 0x1.6c340cp-127f};
  const float dir[3] = {-0x1.00b774p-17f, -0x1.5e4584p-17f, -0x1.225eacp-16f};
  for (int axis = 0; axis < 3; ++axis) {
    shot.origin[axis] = origin[axis];
    shot.direction[axis] = dir[axis];
  }
  const BatchRay ray = list_ray<TypeParam>(shot, 0x1.7858ep35f);
  WorkCounters work;
  ASSERT_TRUE(passes_through(ray, triangle, work));
  const LeafBits bits = Leaf<TypeParam>({triangle}).test(ray);
  EXPECT_EQ(bits.inside | bits.unsure, 1u);
}

// Lanes prepare many rays at once as one ray is prepared: rays of all kinds, the farthest origin is that of numbers.
TYPED_TEST(LeafTest, ManyRaysAreSetUpAsOne) {
  if constexpr (TypeParam::kCount > 4) {
    constexpr bool kHasTerms = TypeParam::kRoundsOnce;
    constexpr std::uint32_t kCount = TypeParam::kCount;
    TestRandom random(5);
    for (std::uint32_t round = 0; round < 2000; ++round) {
      const float largest = round % 50 == 0 ? 0x1p100f : 1.0f;
      alignas(64) BatchRay many[kCount];
      alignas(64) RayTerms terms[kCount] = {};
      alignas(64) std::uint32_t words[kCount];
      std::vector<BatchRay> one(kCount);
      float farthest[3] = {};
      for (std::uint32_t i = 0; i < kCount; ++i) {
        BatchRay ray{};
        for (int axis = 0; axis < 3; ++axis) {
          ray.origin[axis] = random.between(-2.0f, 2.0f);
          ray.dir[axis] = random.below(8) == 0 ? 0.0f : random.between(-1.0f, 1.0f);
          if (random.below(40) == 0) ray.dir[axis] = std::ldexp(ray.dir[axis], -50);
        }
        if (random.below(30) == 0) ray.origin[random.below(3)] = std::ldexp(1.0f, 45);
        if (random.below(30) == 0) ray.origin[random.below(3)] = std::numeric_limits<float>::quiet_NaN();
        const int exponent = random.below(20) == 0 ? -30 : random.below(20) == 0 ? 50 : 0;
        for (float& component : ray.dir) component = std::ldexp(component, exponent);
        ray.t = random.unit();
        ray.id = kNoTriangle;
        for (int axis = 0; axis < 3; ++axis) farthest[axis] = std::fmax(farthest[axis], std::fabs(ray.origin[axis]));
        many[i] = one[i] = ray;
      }
      RaySetup<TypeParam, kHasTerms> setup(largest);
      setup.add(many, terms, kCount, words);
      std::uint32_t octants = 0;
      for (std::uint32_t i = 0; i < kCount; ++i) {
        const std::uint32_t octant = set_up_list_ray<TypeParam>(one[i], largest);
        octants |= 1u << octant;
        ASSERT_EQ(std::memcmp(&many[i], &one[i], sizeof(BatchRay)), 0) << i;
        ASSERT_EQ(words[i], list_word(kCount + i, octant) | (kMaskBits & ~(1u << octant)));
        if constexpr (kHasTerms) {
          RayTerms own{};
          set_up_ray_terms<TypeParam>(one[i], own);
          for (int axis = 0; axis < 3; ++axis) {
            ASSERT_EQ(terms[i].scale[axis], own.scale[axis]) << i;
            ASSERT_TRUE(terms[i].shift[axis] == own.shift[axis] || !is_finite(own.shift[axis])) << i;
          }
          ASSERT_EQ(terms[i].t, one[i].t);
        }
      }
      ASSERT_EQ(setup.octants(), octants);
      for (std::uint32_t axis = 0; axis < 3; ++axis) ASSERT_EQ(setup.farthest(axis), farthest[axis]);
    }
  }
}

// Plain scenes: floats settle nearly all, or the filter would be none.
TYPED_TEST(LeafTest, FloatsSettleNearlyAll) {
  std::uint64_t hits = 0, sure_hits = 0, misses = 0, candidates = 0;
  constexpr std::uint32_t kTriangles = 60;
  const TestMesh mesh = make_random_soup(kTriangles, 0.5f, 11);
  const Oracle oracle(mesh.view(), {.reading = Reading::kStandard});
  TestRandom random(12);
  for (std::uint32_t first = 0; first < kTriangles; first += kMaxTreeLeaf) {
    std::vector<VertexTriangle> triangles;
    for (std::uint32_t id = first; id < kTriangles && id < first + kMaxTreeLeaf; ++id) {
      triangles.push_back(triangle_of(mesh, id));
    }
    const Leaf<TypeParam> leaf(triangles);
    for (std::uint32_t round = 0; round < 1000; ++round) {
      OracleRay shot = ray_at(mesh, random_vec(random, 2.0f), Aim::kInside, random);
      shot.t_max = random.below(2) != 0 ? kFloatMax : 0.5f + 2.0f * random.unit();
      const LeafBits bits = leaf.test(batch_ray(shot));
      const std::vector<float> distances = true_distances(oracle, shot, kTriangles);
      for (std::uint32_t i = 0; i < triangles.size(); ++i) {
        const bool is_hit = distances[first + i] > 0.0f;
        const bool is_sure = (bits.inside & bits.within) >> i & 1u;
        const bool is_candidate = (bits.inside | bits.unsure) >> i & 1u;
        ASSERT_TRUE(is_hit || !is_sure);
        ASSERT_TRUE(!is_hit || is_candidate);
        hits += is_hit ? 1u : 0u;
        sure_hits += is_sure ? 1u : 0u;
        misses += is_hit ? 0u : 1u;
        candidates += is_candidate ? 1u : 0u;
      }
    }
  }
  EXPECT_GT(hits, 1000u);
  EXPECT_GT(sure_hits, hits - hits / 10);
  EXPECT_LT(candidates - hits, misses / 1000) << "triangles that floats do not rule out";
}

// Where floats are trusted: rays well inside hit, rays well outside do not, at any scale that floats reach.
TYPED_TEST(LeafTest, TrustedFloatsAreRightAwayFromEdges) {
  std::uint64_t inside = 0, outside = 0;
  TestRandom random(21);
  for (std::uint32_t round = 0; round < 3000; ++round) {
    const float scale = std::ldexp(1.0f, static_cast<int>(random.below(41)) - 20);
    const TestMesh mesh = make_random_soup(1, 1.0f, random.next());
    const Vec3 a = mesh.vertices[0] * scale, b = mesh.vertices[1] * scale, c = mesh.vertices[2] * scale;
    const Vec3 n = {(b - a).y * (c - a).z - (b - a).z * (c - a).y, (b - a).z * (c - a).x - (b - a).x * (c - a).z,
                    (b - a).x * (c - a).y - (b - a).y * (c - a).x};
    const float area = std::sqrt(n.x * n.x + n.y * n.y + n.z * n.z) / (scale * scale);
    if (area < 0.05f) continue;
    const Leaf<TypeParam> leaf({vertex_triangle(a, b, c, 0)}, /*trusts_floats=*/true);
    for (std::uint32_t i = 0; i < kRays; ++i) {
      float r = random.between(0.05f, 0.9f), s = random.between(0.05f, 0.95f - r);
      const bool hits = random.below(2) != 0;
      if (!hits) r = random.below(2) != 0 ? -0.05f - random.unit() : 1.05f + random.unit();
      const Vec3 target = a + r * (b - a) + s * (c - a);
      const Vec3 origin = target + n * (random.between(0.5f, 2.0f) / (scale * area)) + random_vec(random, 0.3f * scale);
      OracleRay ray{{origin.x, origin.y, origin.z}, {}};
      for (int axis = 0; axis < 3; ++axis) ray.direction[axis] = target[axis] - origin[axis];
      ray.t_max = random.below(2) != 0 ? 1.001f : kFloatMax;
      if (hits && random.below(4) == 0) ray.t_max = 0.999f;  // ends before it
      const LeafBits bits = leaf.test(batch_ray(ray));
      // What is unsure counts as a hit if the float distance is within t.
      const std::uint32_t expected = hits && ray.t_max > 1.0f ? 1u : 0u;
      if (expected != 0 || !hits) {
        ASSERT_EQ(bits.inside | bits.unsure, expected) << "round " << round;
      }
      ASSERT_LE(bits.within, expected) << "round " << round;
      (hits ? inside : outside) += 1;
    }
  }
  EXPECT_GT(inside, 10'000u);
  EXPECT_GT(outside, 10'000u);
}

TYPED_TEST(LeafTest, NothingIsHitWithoutADirectionOrAnArea) {
  WorkCounters work;
  const std::vector<VertexTriangle> triangles = {vertex_triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 0),
                                                 vertex_triangle({0, 0, 0}, {1, 1, 0}, {2, 2, 0}, 1),   // a line
                                                 vertex_triangle({0, 0, 0}, {0, 0, 0}, {0, 0, 0}, 2)};  // a point
  const Leaf<TypeParam> leaf(triangles);
  const struct {
    OracleRay ray;
    std::uint32_t stopping;
  } cases[] = {
      {{{0.25f, 0.25f, 1.0f}, {0, 0, 0}}, 0},  // without a direction
      {{{0, 0, 1}, {0, 0, -1}}, 1},            // at a corner
      {{{0.5f, 0.5f, 1}, {0, 0, -1}}, 1},      // at the edge, and at the line
      {{{-1, 0.25f, 0}, {1, 0, 0}}, 0},        // in the plane
      {{{0.25f, 0.25f, 0}, {0, 0, 1}}, 0},     // from within it
      {{{0.25f, 0.25f, 1}, {0, 0, 1}}, 0},     // away from it
      {{{0.25f, 0.25f, 1}, {0, 0, -1}}, 1},
  };
  for (const auto& tested : cases) {
    const BatchRay ray = batch_ray(tested.ray);
    EXPECT_EQ(stopping(ray, triangles, leaf.test(ray), work), tested.stopping) << &tested - cases;
  }
}

// A closed mesh and what lies inside it, well away from its faces.
struct Body {
  TestMesh mesh;
  std::uint32_t kind;  // box, sphere, torus

  [[nodiscard]] Vec3 inside(TestRandom& random) const {
    if (kind == 0) return random_vec(random, 0.9f);
    if (kind == 1) return random_vec(random, 0.45f);
    const float angle = 6.2831853f * random.unit();
    return Vec3(std::cos(angle), 0.0f, std::sin(angle)) + random_vec(random, 0.1f);
  }
};

TYPED_TEST(LeafTest, NoRayLeavesAClosedMesh) {
  const Body bodies[] = {
      {make_box({-1, -1, -1}, {1, 1, 1}), 0}, {make_sphere(7, 9, 1.0f), 1}, {make_torus(10, 7, 1.0f, 0.4f), 2}};
  const struct {
    int exponent;
    Vec3 offset;
  } places[] = {{0, {0, 0, 0}}, {0, {100, -37, 13}}, {-60, {0, 0, 0}}, {60, {0, 0, 0}}, {0, {3000, 3000, -3000}}};
  std::uint64_t rays_shot = 0, leaks = 0, doubles = 0;
  WorkCounters work;
  TestRandom random(31 + TypeParam::kCount);
  for (const Body& body : bodies) {
    for (const auto& place : places) {
      TestMesh mesh = body.mesh;
      const auto put = [&](const Vec3& v) { return (v + place.offset) * std::ldexp(1.0f, place.exponent); };
      for (Vec3& vertex : mesh.vertices) vertex = put(vertex);
      std::vector<std::vector<VertexTriangle>> runs;
      for (std::uint32_t id = 0; id < mesh.triangles.size(); ++id) {
        if (id % kMaxTreeLeaf == 0) runs.emplace_back();
        runs.back().push_back(triangle_of(mesh, id));
      }
      std::vector<Leaf<TypeParam>> leaves;
      for (const std::vector<VertexTriangle>& run : runs) leaves.emplace_back(run);
      for (std::uint32_t round = 0; round < 300 * kRays; ++round) {
        const int stretch = random.below(3) == 0 ? static_cast<int>(random.below(41)) - 20 : 0;
        const Aim aim = random.below(2) != 0 ? Aim::kVertex : Aim::kEdge;
        OracleRay shot = ray_at(mesh, put(body.inside(random)), aim, random);
        for (float& value : shot.direction) value = std::ldexp(value, stretch);
        const BatchRay ray = list_ray<TypeParam>(shot, largest_of(mesh));
        std::uint32_t stops = 0;
        for (std::size_t i = 0; i < runs.size(); ++i) {
          stops += static_cast<std::uint32_t>(std::popcount(stopping(ray, runs[i], leaves[i].test(ray), work)));
        }
        ++rays_shot;
        leaks += stops == 0 ? 1u : 0u;
        doubles += stops > 1 ? 1u : 0u;
      }
    }
  }
  EXPECT_GE(rays_shot, 70'000u);  // with each width of lanes
  EXPECT_EQ(leaks, 0u);
  EXPECT_GT(doubles, rays_shot / 50) << "rays at edges that more than one triangle stops";
}

}  // namespace
}  // namespace gridiron::test
