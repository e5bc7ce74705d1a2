// Lists of rays through the tree find what exact arithmetic finds, triangle by triangle.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/base/one_lane.h>
#include <gridiron/build/triangle_records.h>
#include <gridiron/engine/tree/ray_lists.h>

#include <cmath>

#include "core/lane_types.h"
#include "numeric/rounding_scope.h"
#include "support/memory_tree.h"
#include "support/test_mesh.h"

namespace gridiron::test {
namespace {

struct Ray {
  Vec3 origin, dir;
  float t;
};

struct Answer {
  float t = 0;
  std::uint32_t id = kNoTriangle;
  bool operator==(const Answer&) const = default;
};

BatchRay batch_ray(const Ray& ray) {
  BatchRay made{};
  for (int axis = 0; axis < 3; ++axis) {
    made.origin[axis] = ray.origin[axis];
    made.dir[axis] = ray.dir[axis];
  }
  made.t = ray.t;
  made.id = kNoTriangle;
  return made;
}

// Every triangle, by exact signs and the correctly rounded distance; of equal distances the lowest id.
Answer exact_answer(const TestMesh& mesh, const Ray& ray) {
  WorkCounters work;
  BatchRay tested = batch_ray(ray);
  for (const float component : tested.dir) tested.dir_max = std::max(tested.dir_max, std::fabs(component));
  Answer answer{ray.t, kNoTriangle};
  for (std::uint32_t id = 0; id < mesh.triangles.size(); ++id) {
    VertexTriangle triangle{};
    const UVec3& t = mesh.triangles[id];
    if (has_zero_area(mesh.vertices[t.x], mesh.vertices[t.y], mesh.vertices[t.z])) continue;
    for (int corner = 0; corner < 3; ++corner) {
      for (int axis = 0; axis < 3; ++axis) triangle.v[corner][axis] = mesh.vertices[t[corner]][axis];
    }
    if (!passes_through(tested, triangle, work)) continue;
    const float distance = ray_distance(tested, triangle, work);
    if (!(distance > 0) || distance > answer.t || (distance == answer.t && answer.id != kNoTriangle)) continue;
    answer = {distance, id};
  }
  return answer;
}

template <class L, class Memory>
std::vector<Answer> answers(MemoryTree& tree, const std::vector<Ray>& rays, bool any_hit, WorkCounters& work,
                            bool are_neighbors = false) {
  constexpr std::uint32_t Rays = Memory::kRays;
  const auto memory = std::make_unique<Memory>();
  std::vector<Answer> all;
  for (std::size_t first = 0; first < rays.size(); first += Rays) {
    const auto n = static_cast<std::uint32_t>(std::min<std::size_t>(Rays, rays.size() - first));
    for (std::uint32_t i = 0; i < n; ++i) memory->rays[i] = batch_ray(rays[first + i]);
    RayLists<L, Memory, MemoryTree> lists(*memory, tree, work);
    EXPECT_EQ(lists.trace(RayQuestion{any_hit, are_neighbors, false, false, {}}, n, tree.largest()), Status::kOk);
    for (std::uint32_t i = 0; i < n; ++i) {
      // Directions may have been scaled by a power of two, and t with them.
      float scale = 1.0f;
      for (int axis = 0; axis < 3; ++axis) {
        const float before = rays[first + i].dir[axis];
        if (before != 0.0f) scale = memory->rays[i].dir[axis] / before;
      }
      const BatchRay& ray = memory->rays[i];
      all.push_back({ray.id == kNoTriangle ? rays[first + i].t : ray.t * scale, ray.id});
    }
  }
  return all;
}

// Rays at vertices, edges and places inside triangles, along axes, in planes of triangles, from afar and from points of
// the mesh; some end where their target is.
std::vector<Ray> hard_rays(const TestMesh& mesh, std::uint32_t count, std::uint64_t seed) {
  TestRandom random(seed);
  float scale = 0;
  for (const Vec3& p : mesh.vertices) {
    for (int axis = 0; axis < 3; ++axis) scale = std::max(scale, std::fabs(p[axis]));
  }
  std::vector<Ray> rays;
  const auto pick = [&] { return mesh.triangles[static_cast<std::size_t>(random.next() % mesh.triangles.size())]; };
  const auto coordinate = [&] { return (2.0f * static_cast<float>(random.unit()) - 1.0f) * scale; };
  while (rays.size() < count) {
    const UVec3 t = pick();
    const Vec3 a = mesh.vertices[t.x], b = mesh.vertices[t.y], c = mesh.vertices[t.z];
    const float u = static_cast<float>(random.unit()), v = static_cast<float>(random.unit()) * (1 - u);
    const Vec3 targets[] = {a, 0.5f * a + 0.5f * b, a + u * (b - a), a + u * (b - a) + v * (c - a)};
    const Vec3 target = targets[random.next() % 4];
    Ray ray{{coordinate(), coordinate(), coordinate()}, {}, kFloatMax};
    switch (random.next() % 6) {
      case 0:  // along an axis
        ray.origin = target;
        ray.origin[static_cast<int>(random.next() % 3)] = 2.0f * coordinate();
        break;
      case 1: {  // from another triangle
        const UVec3 s = pick();
        ray.origin = mesh.vertices[s.x];
        break;
      }
      case 2:  // nearly along an axis
        ray.origin = target;
        ray.origin[static_cast<int>(random.next() % 3)] += scale;
        ray.origin[static_cast<int>(random.next() % 3)] += 0x1p-30f * scale;
        break;
      case 3:  // in the plane
        ray.origin = a + 2.0f * (b - a) + 3.0f * (c - a);
        break;
      default:
        break;
    }
    ray.dir = target - ray.origin;
    if (ray.dir == Vec3(0)) continue;
    if (random.next() % 3 == 0) ray.t = random.next() % 2 == 0 ? 1.0f : 0.999f;
    rays.push_back(ray);
  }
  return rays;
}

template <class L, std::uint32_t Rays, std::uint32_t Spare>
std::vector<Answer> answers(MemoryTree& tree, const std::vector<Ray>& rays, bool any_hit) {
  WorkCounters work;
  return answers<L, ListMemory<Rays, Spare, false>>(tree, rays, any_hit, work);
}

template <class L>
class RayListsTest : public testing::Test {};
// Where lanes have terms of rays, memory for them.
template <class L, std::uint32_t Rays, std::uint32_t Spare>
std::vector<Answer> answers_by_terms(MemoryTree& tree, const std::vector<Ray>& rays, bool any_hit) {
  WorkCounters work;
  return answers<L, ListMemory<Rays, Spare, false, true>>(tree, rays, any_hit, work);
}
TYPED_TEST_SUITE(RayListsTest, ListLaneTypes);

TYPED_TEST(RayListsTest, FindWhatExactArithmeticFinds) {
  const TestMesh torus = make_torus(24, 12, 1.0f, 0.35f), soup = make_random_soup(600, 0.3f, 2);
  const struct {
    const char* name;
    TestMesh mesh;
  } cases[] = {
      {"torus", torus},
      {"soup", soup},
      {"twice", joined(soup, soup)},
      {"flat", make_height_field(12, 0.0f, 1)},
      {"boxes", joined(make_box({0, 0, 0}, {1, 1, 1}), make_box({1, 0, 0}, {2, 1, 1}))},
      {"slivers", make_sliver_fan(300, 1e-6f)},
      {"far", moved(torus, 1.0f, {1e5f, -1e5f, 3e4f})},
      {"tiny", moved(soup, 0x1p-60f)},
      {"huge", moved(soup, 0x1p60f)},
      {"least", moved(soup, 0x1p-110f)},
      {"greatest", moved(soup, 0x1p118f)},
      {"stadium", joined(moved(torus, 1e-3f), make_box({-100, -1, -100}, {100, 50, 100}))},
  };
  for (const auto& tested : cases) {
    SCOPED_TRACE(tested.name);
    const std::vector<Ray> rays = hard_rays(tested.mesh, 250, 17);
    std::vector<Answer> exact;
    for (const Ray& ray : rays) exact.push_back(exact_answer(tested.mesh, ray));
    for (const std::uint32_t leaf : {1u, 8u, 16u}) {
      SCOPED_TRACE(leaf);
      MemoryTree tree(tested.mesh.view(), leaf);
      ASSERT_EQ(tree.status(), Status::kOk);
      const std::vector<Answer> closest = answers<TypeParam, 256, 512>(tree, rays, false);
      const std::vector<Answer> any = answers<TypeParam, 256, 512>(tree, rays, true);
      ASSERT_EQ((answers_by_terms<TypeParam, 256, 512>(tree, rays, false)), closest);
      const std::vector<Answer> any_by_terms = answers_by_terms<TypeParam, 256, 512>(tree, rays, true);
      for (std::size_t i = 0; i < rays.size(); ++i) {
        ASSERT_EQ(any_by_terms[i].id == kNoTriangle, exact[i].id == kNoTriangle) << i;
        ASSERT_EQ(closest[i].id, exact[i].id) << i;
        ASSERT_EQ(closest[i].t, exact[i].t) << i;
        ASSERT_EQ(any[i].id == kNoTriangle, exact[i].id == kNoTriangle) << i;
      }
    }
  }
}

// Shadow rays are as short as the scene is small. A hit of an ordinary t counts however near it is.
TYPED_TEST(RayListsTest, NearHitsOfSmallScenesCount) {
  for (const int exponent : {-40, -60, -90, -104, -110, -118}) {
    SCOPED_TRACE(exponent);
    const float s = std::ldexp(1.0f, exponent), z = s * (1.0f + 0x1p-20f);
    TestMesh mesh;
    mesh.vertices = {{-s, -s, z}, {s, -s, z}, {0, s, z}};
    mesh.triangles = {{0, 1, 2}};
    MemoryTree tree(mesh.view(), 8);
    ASSERT_EQ(tree.status(), Status::kOk);
    const std::vector<Ray> rays = {{{0, 0, s}, {0, 0, s}, 1.0f}};
    for (const bool any_hit : {false, true}) {
      EXPECT_EQ((answers<TypeParam, 64, 512>(tree, rays, any_hit))[0].id, 0u) << any_hit;
    }
  }
}

// Small triangles in scenes whose directions are small too: what floats lose must not rule a hit out.
TYPED_TEST(RayListsTest, HoldWithEveryRoundingAndFlushedDenormals) {
  const TestMesh soup = make_random_soup(60, 0x1p-7f, 5);
  for (const int exponent : {0, -14, -18, -30, -36, -38}) {
    SCOPED_TRACE(exponent);
    const TestMesh mesh = moved(soup, std::ldexp(1.0f, exponent));
    MemoryTree tree(mesh.view(), 8);
    ASSERT_EQ(tree.status(), Status::kOk);
    std::vector<Ray> rays = hard_rays(mesh, 600, 23);
    for (Ray& ray : rays) {
      ray.dir *= 1.25f;
      ray.t = 1.0f;
    }
    for (const int mode : kRoundingModes) {
      SCOPED_TRACE(mode);
      const RoundingScope scope(mode, true);
      const std::vector<Answer> closest = answers<TypeParam, 256, 512>(tree, rays, false);
      const std::vector<Answer> any = answers<TypeParam, 256, 512>(tree, rays, true);
      ASSERT_EQ((answers_by_terms<TypeParam, 256, 512>(tree, rays, false)), closest);
      const std::vector<Answer> any_by_terms = answers_by_terms<TypeParam, 256, 512>(tree, rays, true);
      for (std::size_t i = 0; i < rays.size(); ++i) {
        ASSERT_EQ(any_by_terms[i].id == kNoTriangle, any[i].id == kNoTriangle) << i;
        const Answer exact = exact_answer(mesh, rays[i]);
        ASSERT_EQ(closest[i], exact) << i;
        ASSERT_EQ(any[i].id == kNoTriangle, exact.id == kNoTriangle) << i;
      }
    }
  }
}

// The least that rays of one octant need: less than list_arena_words() by what eight octants and other lanes add.
template <class L>
struct LeastMemory : ListMemory<64, 0, false> {
  static constexpr std::uint32_t kArenaWords =
      (1 + kListParts<L>)*64 + (kMaxTreeDepth + 2) * (1 + kListParts<L>)*kListStep<L>;
  static_assert(kArenaWords < ListMemory<64, 0, false>::kArenaWords);
};

// A batch of equal rays fills the lists of every level. With the least arena they go through nodes in pieces.
TYPED_TEST(RayListsTest, PiecesOfListsFindTheSame) {
  const TestMesh mesh = joined(make_torus(96, 48, 1.0f, 0.35f), moved(make_torus(96, 48, 1.0f, 0.35f), 1e-3f));
  MemoryTree tree(mesh.view(), 1);
  ASSERT_EQ(tree.status(), Status::kOk);
  std::vector<Ray> rays;
  for (const Ray& ray : hard_rays(mesh, 40, 5)) rays.insert(rays.end(), 64, ray);
  for (const bool any_hit : {false, true}) {
    WorkCounters least, ample;
    const std::vector<Answer> pieces = answers<TypeParam, LeastMemory<TypeParam>>(tree, rays, any_hit, least);
    EXPECT_EQ(pieces, (answers<TypeParam, ListMemory<64, 8192, false>>(tree, rays, any_hit, ample)));
    EXPECT_GT(least[Work::kListNode], ample[Work::kListNode]) << "no list went in pieces";
  }
}

// Beams: rays from neighbouring places to neighbouring places, along each axis, to both sides, some of one origin, with
// targets at vertices and edges; some neighbours stray.
std::vector<Ray> neighbor_rays(const TestMesh& mesh, std::uint32_t groups, std::uint64_t seed) {
  TestRandom random(seed);
  float scale = 0;
  for (const Vec3& p : mesh.vertices) {
    for (int axis = 0; axis < 3; ++axis) scale = std::max(scale, std::fabs(p[axis]));
  }
  const auto place = [&](float size) {
    return size * Vec3(2.0f * static_cast<float>(random.unit()) - 1.0f, 2.0f * static_cast<float>(random.unit()) - 1.0f,
                       2.0f * static_cast<float>(random.unit()) - 1.0f);
  };
  std::vector<Ray> rays;
  for (std::uint32_t group = 0; group < groups; ++group) {
    const std::uint64_t kind = random.next() % 6;
    const float size = scale * std::exp2(-2.0f - static_cast<float>(random.next() % 16));
    const Vec3 start = place(kind == 5 ? 16.0f * scale : scale);
    const float t = random.next() % 2 == 0 ? kFloatMax : 1.0f;
    const std::size_t first = static_cast<std::size_t>(random.next() % mesh.triangles.size());
    for (std::uint32_t i = 0; i < kBeamRays; ++i) {
      const UVec3& corners = mesh.triangles[(first + random.next() % 4) % mesh.triangles.size()];
      const Vec3 a = mesh.vertices[corners.x], b = mesh.vertices[corners.y];
      const Vec3 target = kind < 2    ? a
                          : kind == 2 ? 0.5f * a + 0.5f * b
                                      : mesh.vertices[mesh.triangles[first].x] + place(size);
      Ray ray{kind % 2 == 0 ? start : start + place(size), {}, t};
      ray.dir = target - ray.origin;
      if (group % 16 == 15 && i == 7) ray.dir = -ray.dir;
      // Two beams side by side, or one and rays beside it.
      if (group % 16 == 11 && i >= 8) ray.origin = ray.origin + 0.5f * scale * Vec3(1, 1, -1);
      if (group % 16 == 9 && i >= 11) ray.dir = place(scale);
      if (group % 16 == 13 && i == 3) ray.dir[static_cast<int>(group / 16 % 3)] = 0.0f;
      rays.push_back(ray);
    }
  }
  return rays;
}

// The rays of a batch that all begin at one place, seen from there.
std::vector<Ray> from_one_place(std::vector<Ray> rays, std::uint32_t batch) {
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Vec3 target = rays[i].origin + rays[i].dir;
    rays[i].origin = rays[i / batch * batch].origin;
    rays[i].dir = target - rays[i].origin;
  }
  return rays;
}

// That beams, and code for rays of one origin, find what single rays do. @param work  of the beams.
template <class L, std::uint32_t Rays>
void expect_beams_find_the_same(MemoryTree& tree, const std::vector<Ray>& rays, bool any_hit, WorkCounters& work) {
  WorkCounters single;
  const auto expected = answers<L, ListMemory<Rays, 0, false>>(tree, rays, any_hit, single);
  const auto found = answers<L, ListMemory<Rays, 512, true>>(tree, rays, any_hit, work, true);
  WorkCounters groups;
  const auto by_groups = answers<L, ListMemory<Rays, 512, true, true>>(tree, rays, any_hit, groups, true);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    ASSERT_EQ(found[i].id == kNoTriangle, expected[i].id == kNoTriangle) << i;
    ASSERT_EQ(by_groups[i].id == kNoTriangle, expected[i].id == kNoTriangle) << i;
    if (!any_hit) {
      ASSERT_EQ(found[i], expected[i]) << i;
      ASSERT_EQ(by_groups[i], expected[i]) << i;
    }
  }
}

// Origins that agree on two axes are not one origin.
TYPED_TEST(RayListsTest, OriginsThatDifferOnOneAxisAreNotShared) {
  constexpr std::uint32_t kRays = 128;
  const TestMesh mesh = make_torus(48, 24, 1.0f, 0.35f);
  MemoryTree tree(mesh.view(), 8);
  ASSERT_EQ(tree.status(), Status::kOk);
  const std::vector<Ray> gathered = from_one_place(neighbor_rays(mesh, 128, 13), kRays);
  for (const int axis : {0, 1, 2}) {
    SCOPED_TRACE(axis);
    std::vector<Ray> rays = gathered;
    for (std::size_t i = 0; i < rays.size(); i += 7) rays[i].origin[axis] += 0.5f;
    for (const bool any_hit : {false, true}) {
      WorkCounters beams;
      expect_beams_find_the_same<TypeParam, kRays>(tree, rays, any_hit, beams);
      EXPECT_EQ(beams[Work::kListSharedBox], 0u);
    }
  }
}

TYPED_TEST(RayListsTest, BeamsAndSharedOriginsFindWhatSingleRaysDo) {
  constexpr std::uint32_t kRays = 128;
  const TestMesh meshes[] = {make_torus(48, 24, 1.0f, 0.35f), moved(make_torus(48, 24, 1.0f, 0.35f), 1000.0f),
                             make_height_field(24, 0.1f, 3)};
  for (const TestMesh& mesh : meshes) {
    MemoryTree tree(mesh.view(), 8);
    ASSERT_EQ(tree.status(), Status::kOk);
    const std::vector<Ray> scattered = neighbor_rays(mesh, 512, 11), gathered = from_one_place(scattered, kRays);
    for (const bool is_shared : {false, true}) {
      const std::vector<Ray>& rays = is_shared ? gathered : scattered;
      for (const bool any_hit : {false, true}) {
        WorkCounters single, beams, by_terms;
        const auto expected = answers<TypeParam, ListMemory<kRays, 0, false>>(tree, rays, any_hit, single);
        const auto found = answers<TypeParam, ListMemory<kRays, 512, true>>(tree, rays, any_hit, beams, true);
        const auto with_terms =
            answers<TypeParam, ListMemory<kRays, 512, true, true>>(tree, rays, any_hit, by_terms, true);
        ASSERT_EQ(found.size(), expected.size());
        for (std::size_t i = 0; i < rays.size(); ++i) {
          if (any_hit) {
            ASSERT_EQ(found[i].id == kNoTriangle, expected[i].id == kNoTriangle) << i;
            ASSERT_EQ(with_terms[i].id == kNoTriangle, expected[i].id == kNoTriangle) << i;
          } else {
            ASSERT_EQ(found[i], expected[i]) << i;
            ASSERT_EQ(with_terms[i], expected[i]) << i;
          }
        }
        if (TypeParam::kCount > 4) {
          EXPECT_GT(by_terms[Work::kListBeamNode], 0u);
        }
        if (!kUsesBeams<TypeParam>) continue;
        EXPECT_EQ(beams[Work::kListSharedBox] != 0, is_shared);
        EXPECT_EQ(beams[Work::kListSharedGroup] != 0, is_shared);
        EXPECT_GT(beams[Work::kListBeamNode], 0u);
        EXPECT_EQ(by_terms[Work::kListSharedGroup] != 0, is_shared);
        EXPECT_GT(by_terms[Work::kListBeamNode], 0u);
        EXPECT_LT(beams[Work::kListRayNode] + beams[Work::kListSharedBox],
                  single[Work::kListRayNode] + single[Work::kListBoxQuad]);
      }
    }
  }
}

// In the smallest scenes products of beams would fall below the least normal float, so none are made.
TYPED_TEST(RayListsTest, BeamsOfSmallScenesHoldWithFlushedDenormals) {
  constexpr std::uint32_t kRays = 128;
  const TestMesh torus = make_torus(24, 12, 1.0f, 0.35f);
  for (const int exponent : {-59, -100, -116}) {
    SCOPED_TRACE(exponent);
    const TestMesh mesh = moved(torus, std::ldexp(1.0f, exponent));
    MemoryTree tree(mesh.view(), 8);
    ASSERT_EQ(tree.status(), Status::kOk);
    const std::vector<Ray> rays = neighbor_rays(mesh, 128, 29);
    for (const int mode : kRoundingModes) {
      SCOPED_TRACE(mode);
      const RoundingScope scope(mode, true);
      for (const bool any_hit : {false, true}) {
        WorkCounters beams;
        expect_beams_find_the_same<TypeParam, kRays>(tree, rays, any_hit, beams);
        EXPECT_EQ(beams[Work::kListBeamNode] != 0, kUsesBeams<TypeParam> && exponent == -59);
      }
    }
  }
}

}  // namespace
}  // namespace gridiron::test
