// Lists of rays through the tree find what exact arithmetic finds, triangle by triangle. SPDX-License-Identifier:
// Apache-2.0
#include <gridiron/build/triangle_records.h>
#include <gridiron/build/tree/tree_builder.h>
#include <gridiron/engine/tree/ray_lists.h>

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

// Every triangle, by exact signs and the correctly rounded distance; of equal distances the lowest id.
Answer exact_answer(const TestMesh& mesh, const Ray& ray) {
  WorkCounters work;
  WalkRays rays{};
  float dir_max = 0;
  for (int axis = 0; axis < 3; ++axis) {
    rays.origin[axis][0] = ray.origin[axis];
    rays.dir[axis][0] = ray.dir[axis];
    dir_max = std::max(dir_max, std::fabs(ray.dir[axis]));
  }
  rays.dir_max[0] = dir_max;
  Answer answer{ray.t, kNoTriangle};
  for (std::uint32_t id = 0; id < mesh.triangles.size(); ++id) {
    VertexTriangle triangle{};
    const UVec3& t = mesh.triangles[id];
    if (has_zero_area(mesh.vertices[t.x], mesh.vertices[t.y], mesh.vertices[t.z])) continue;
    for (int corner = 0; corner < 3; ++corner) {
      for (int axis = 0; axis < 3; ++axis) triangle.v[corner][axis] = mesh.vertices[t[corner]][axis];
    }
    if (!passes_through(rays, 0, triangle, 0, 0, work)) continue;
    const float distance = ray_distance(rays, 0, triangle, work);
    if (!(distance > 0) || distance > answer.t || (distance == answer.t && answer.id != kNoTriangle)) continue;
    answer = {distance, id};
  }
  return answer;
}

template <class L>
std::vector<Answer> answers(const TestMesh& mesh, std::uint32_t leaf_triangles, const std::vector<Ray>& rays,
                            bool any_hit) {
  constexpr std::uint32_t kBatch = 256;
  const std::size_t count = mesh.triangles.size();
  std::vector<VertexTriangle> records(count);
  std::vector<TreeNode> nodes(most_tree_nodes(count, leaf_triangles));
  std::vector<std::uint64_t> scratch(tree_scratch_bytes(count) / 8);
  TreeSize size;
  EXPECT_EQ(build_tree(mesh.view(), leaf_triangles, records, nodes, std::as_writable_bytes(std::span(scratch)), size),
            Status::kOk);
  WorkCounters work;
  const auto lists = std::make_unique<RayLists<L, kBatch>>(nodes.data(), records.data(), work);
  std::vector<ListRays> batch(kBatch / kWalkRays);
  std::vector<Answer> all;
  for (std::size_t first = 0; first < rays.size(); first += kBatch) {
    const auto n = static_cast<std::uint32_t>(std::min<std::size_t>(kBatch, rays.size() - first));
    for (std::uint32_t i = 0; i < kBatch; ++i) {
      const Ray& ray = rays[first + std::min(i, n - 1)];
      ListRays& group = batch[i / kWalkRays];
      for (int axis = 0; axis < 3; ++axis) {
        group.origin[axis][i % kWalkRays] = ray.origin[axis];
        group.dir[axis][i % kWalkRays] = ray.dir[axis];
      }
      group.t[i % kWalkRays] = ray.t;
      group.id[i % kWalkRays] = kNoTriangle;
    }
    for (ListRays& group : batch) set_up_list_rays<L>(group);
    lists->trace(batch.data(), n, any_hit);
    for (std::uint32_t i = 0; i < n; ++i) {
      const ListRays& group = batch[i / kWalkRays];
      all.push_back({group.t[i % kWalkRays], group.id[i % kWalkRays]});
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

template <class L>
class RayListsTest : public testing::Test {};
using AllLanes = testing::Types<Lanes<4>, Lanes<8>, Lanes<16>>;
TYPED_TEST_SUITE(RayListsTest, AllLanes);

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
      {"stadium", joined(moved(torus, 1e-3f), make_box({-100, -1, -100}, {100, 50, 100}))},
  };
  for (const auto& tested : cases) {
    SCOPED_TRACE(tested.name);
    const std::vector<Ray> rays = hard_rays(tested.mesh, 1500, 17);
    std::vector<Answer> exact;
    for (const Ray& ray : rays) exact.push_back(exact_answer(tested.mesh, ray));
    for (const std::uint32_t leaf : {1u, 8u, 16u}) {
      SCOPED_TRACE(leaf);
      const std::vector<Answer> closest = answers<TypeParam>(tested.mesh, leaf, rays, false);
      const std::vector<Answer> any = answers<TypeParam>(tested.mesh, leaf, rays, true);
      for (std::size_t i = 0; i < rays.size(); ++i) {
        ASSERT_EQ(closest[i].id, exact[i].id) << i;
        ASSERT_EQ(closest[i].t, exact[i].t) << i;
        ASSERT_EQ(any[i].id == kNoTriangle, exact[i].id == kNoTriangle) << i;
      }
    }
  }
}

}  // namespace
}  // namespace gridiron::test
