// Boxes of a node against rays: a ray that hits a triangle meets every box on the way to it, whatever its direction's
// size, its origin's distance and its components of 0; and boxes far from it are not met.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/engine/tree/box_test.h>

#include "core/lane_types.h"
#include "core/seeds.h"
#include "numeric/hard_rays.h"
#include "numeric/oracle.h"
#include "support/memory_tree.h"
#include "support/test_mesh.h"

namespace gridiron::test {
namespace {

template <class L>
class BoxTest : public testing::Test {};
TYPED_TEST_SUITE(BoxTest, ListLaneTypes, LaneNames);

// A ray of a list, and the triangles that it hits by exact arithmetic.
struct Shot {
  OracleRay ray;
  std::vector<bool> hits;  // by id
};

// How a ray is changed. The line that it runs along stays nearly the same, but for kZero.
enum class Twist : std::uint32_t { kNone, kLong, kShort, kLeast, kFar, kBeyond, kZero, kTiny, kCount };

void twist(Twist how, float largest, TestRandom& random, OracleRay& ray) {
  const auto scale = [&ray](int exponent) {
    for (float& value : ray.direction) value = std::ldexp(value, exponent);
    ray.t_max = std::ldexp(ray.t_max, -exponent);
  };
  const auto axis = random.below(3);
  const int far = how == Twist::kFar ? 10 + static_cast<int>(random.below(29)) : 41;
  switch (how) {
    case Twist::kLong:
      return scale(30 + static_cast<int>(random.below(60)));
    case Twist::kShort:
      return scale(-30 - static_cast<int>(random.below(60)));
    case Twist::kLeast:
      return scale(-149 - std::ilogb(largest));
    case Twist::kFar:
    case Twist::kBeyond:
      for (int i = 0; i < 3; ++i) ray.origin[i] = ray.origin[i] - std::ldexp(ray.direction[i], far);
      return scale(far);
    case Twist::kZero:
      ray.direction[axis] = random.below(2) != 0 ? 0.0f : -0.0f;
      return;
    case Twist::kTiny:
      ray.direction[axis] = std::ldexp(random.between(-1.0f, 1.0f), -50 - static_cast<int>(random.below(80)));
      return;
    default:
      return;
  }
}

// The triangles below a child are neighbours in the order of leaves.
struct Range {
  std::uint32_t first, end;
};
Range range_of(const MemoryTree& tree, TreeChild child) {
  if (child.is_leaf()) return {child.first(), child.first() + child.count()};
  const TreeNode* node = nullptr;
  EXPECT_EQ(tree.node(child.node_index(), node), Status::kOk);
  return {range_of(tree, node->children[0]).first, range_of(tree, node->children[node->child_count - 1]).end};
}

struct Tally {
  std::uint64_t hits = 0, pairs = 0, met = 0, by_terms = 0;
};

// All rays against all nodes, whether or not they meet their parents. @param by_terms  where lanes have terms of rays,
// and the rays can be tested by them.
template <class L>
void expect_boxes_met_by(bool by_terms, MemoryTree& tree, const std::vector<Shot>& shots, Tally& tally) {
  constexpr std::uint32_t kStep = kListStep<L>, kPartBoxes = kTreeWidth / kBoxParts<L>;
  const auto count = static_cast<std::uint32_t>(shots.size());
  std::vector<BatchRay> rays(shots.size());
  std::vector<std::uint32_t> list(shots.size());
  // A list, the parts' lists behind it, and a step to write over.
  const std::uint32_t arena_words = (1 + kListParts<L>)*(count + kStep) + 16;
  WorkCounters work;
  for (std::uint32_t i = 0; i < shots.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      rays[i].origin[axis] = shots[i].ray.origin[axis];
      rays[i].dir[axis] = shots[i].ray.direction[axis];
    }
    rays[i].t = shots[i].ray.t_max;
    list[i] = list_word(i, set_up_list_ray<L>(rays[i], tree.largest()));
  }
  std::sort(list.begin(), list.end());  // by octant
  std::vector<RayTerms> terms(shots.size());
  TermsList terms_list;
  if (by_terms) {
    float farthest[3] = {};
    for (std::uint32_t i = 0; i < shots.size(); ++i) {
      set_up_ray_terms<L>(rays[i], terms[i]);
      for (int axis = 0; axis < 3; ++axis) farthest[axis] = std::fmax(farthest[axis], std::fabs(rays[i].origin[axis]));
    }
    if (!terms_list.set_up(terms.data(), farthest, tree.largest())) return;
    ++tally.by_terms;
  }
  std::vector<TreeChild> open = {TreeChild::node(0)};
  while (!open.empty()) {
    const TreeNode* node = nullptr;
    ASSERT_EQ(tree.node(open.back().node_index(), node), Status::kOk);
    open.pop_back();
    // Places of lists are multiples of a step; words of a list that comes to a node have no masks.
    std::vector<std::uint32_t> arena(arena_words + kStep, 0xDEADBEEFu);
    for (std::uint32_t i = 0; i < count; ++i) arena[kStep + i] = list[i];
    ListLevel level{};
    const auto mark = [&](auto* tested_rays) {
      return mark_boxes<L, false>(*node, tested_rays, nullptr, arena.data(), kStep, count, level, work);
    };
    std::uint32_t any = 0;
    if constexpr (L::kRoundsOnce) {
      any = by_terms ? mark(&std::as_const(terms_list)) : mark(rays.data());
    } else {
      any = mark(rays.data());
    }
    ASSERT_LE(level.end, kStep + (1 + kListParts<L>)*(count + kStep));
    const std::uint32_t there = (2u << (node->child_count - 1)) - 1;
    std::vector<std::uint32_t> met(shots.size(), 0);  // by ray, all boxes of the node
    std::uint32_t all = 0;
    for (std::uint32_t part = 0; part < kBoxParts<L>; ++part) {
      ASSERT_LE(level.ray_counts[part], count);
      const std::uint32_t part_bits = ((1u << (kPartBoxes - 1) << 1) - 1) << part * kPartBoxes;
      for (std::uint32_t i = 0; i < level.ray_counts[part]; ++i) {
        const std::uint32_t word = arena[level.lists[part] + i];
        const auto ray = static_cast<std::uint32_t>(&ray_of(rays.data(), word) - rays.data());
        ASSERT_LT(ray, count);
        ASSERT_TRUE(std::find(list.begin(), list.end(), word & ~kMaskBits) != list.end()) << "not the ray's word";
        if (level.lists[part] != kStep) {
          ASSERT_EQ(word & kMaskBits & ~part_bits, 0u) << "boxes of another part";
        }
        met[ray] |= ~word & part_bits & there;
        all |= met[ray];
      }
    }
    ASSERT_EQ(any, all);
    for (std::uint32_t child = 0; child < node->child_count; ++child) {
      const TreeChild below = node->children[child];
      if (!below.is_leaf()) open.push_back(below);
      const Range range = range_of(tree, below);
      for (std::uint32_t place = 0; place < count; ++place) {
        const Shot& shot = shots[place];
        const bool is_met = (met[place] >> child & 1u) != 0;
        ++tally.pairs;
        tally.met += is_met ? 1u : 0u;
        for (std::uint32_t i = range.first; i < range.end; ++i) {
          const VertexTriangle* record = nullptr;
          ASSERT_EQ(tree.leaf(TreeChild::leaf(i, 1), record), Status::kOk);
          if (!shot.hits[record->triangle_id]) continue;
          ++tally.hits;
          ASSERT_TRUE(is_met) << "child " << child << ", triangle " << record->triangle_id << ", origin "
                              << shot.ray.origin[0] << " " << shot.ray.origin[1] << " " << shot.ray.origin[2]
                              << ", direction " << shot.ray.direction[0] << " " << shot.ray.direction[1] << " "
                              << shot.ray.direction[2] << ", up to " << shot.ray.t_max << ", scene of "
                              << tree.largest();
        }
      }
    }
  }
}

template <class L>
void expect_boxes_met(MemoryTree& tree, const std::vector<Shot>& shots, Tally& tally) {
  expect_boxes_met_by<L>(false, tree, shots, tally);
  if constexpr (L::kRoundsOnce) {
    if (!testing::Test::HasFatalFailure()) expect_boxes_met_by<L>(true, tree, shots, tally);
  }
}

std::vector<Shot> shots_at(const TestMesh& mesh, float largest, std::uint32_t count, Twist how, TestRandom& random) {
  const Oracle oracle(mesh.view(), {.reading = Reading::kStandard});
  std::vector<Shot> shots;
  for (std::uint32_t tries = 0; shots.size() < count && tries < 20 * count; ++tries) {
    Vec3 origin = 1.5f * random_vec(random, largest);
    if (random.below(3) == 0) origin = mesh.vertices[random.below(static_cast<std::uint32_t>(mesh.vertices.size()))];
    const auto aim = static_cast<Aim>(random.below(static_cast<std::uint32_t>(Aim::kCount)));
    OracleRay ray = ray_at(mesh, origin, aim, random);
    if (random.below(3) == 0) ray.t_max = random.below(2) != 0 ? 1.0f : random.unit();
    twist(how, largest, random, ray);
    bool is_finite_ray = is_finite(ray.t_max) && ray.t_max > 0.0f;
    for (int axis = 0; axis < 3; ++axis) {
      is_finite_ray = is_finite_ray && is_finite(ray.origin[axis]) && is_finite(ray.direction[axis]);
    }
    if (!is_finite_ray) continue;
    Shot shot{ray, std::vector<bool>(mesh.triangles.size(), false)};
    OracleRay unlimited = ray;
    unlimited.t_max = kFloatMax;
    for (const OracleHit& hit : oracle.hits(unlimited)) {
      const float t = oracle.distance(unlimited, hit.triangle_id).rounded(Reading::kStandard);
      shot.hits[hit.triangle_id] = t > 0.0f && t <= ray.t_max && t != kFloatMax;
    }
    shots.push_back(shot);
  }
  return shots;
}

TYPED_TEST(BoxTest, ARayMeetsTheBoxesOfWhatItHits) {
  const TestMesh torus = make_torus(14, 8, 1.0f, 0.35f), soup = make_random_soup(200, 0.3f, 2);
  const struct {
    const char* name;
    TestMesh mesh;
  } cases[] = {
      {"torus", torus},
      {"soup", soup},
      {"flat", make_height_field(9, 0.0f, 1)},
      {"boxes", joined(make_box({0, 0, 0}, {1, 1, 1}), make_box({1, 0, 0}, {2, 1, 1}))},
      {"slivers", make_sliver_fan(150, 1e-6f)},
      {"far", moved(torus, 1.0f, {1e5f, -1e5f, 3e4f})},
      {"tiny", moved(soup, 0x1p-60f)},
      {"huge", moved(soup, 0x1p60f)},
      {"stadium", joined(moved(torus, 1e-3f), make_box({-100, -1, -100}, {100, 50, 100}))},
  };
  TestRandom random(71);
  std::array<Tally, static_cast<std::size_t>(Twist::kCount)> tallies;
  for (const auto& tested : cases) {
    for (std::uint32_t how = 0; how < static_cast<std::uint32_t>(Twist::kCount); ++how) {
      SCOPED_TRACE(std::string(tested.name) + ", twist " + std::to_string(how));
      MemoryTree tree(tested.mesh.view(), how % 2 == 0 ? 1 : 5);
      ASSERT_EQ(tree.status(), Status::kOk);
      const std::vector<Shot> shots = shots_at(tested.mesh, tree.largest(), 60, static_cast<Twist>(how), random);
      expect_boxes_met<TypeParam>(tree, shots, tallies[how]);
      if (testing::Test::HasFatalFailure()) return;
    }
  }
  for (std::uint32_t how = 0; how < tallies.size(); ++how) {
    EXPECT_GT(tallies[how].hits, 50u) << how;
    const bool is_near = static_cast<Twist>(how) != Twist::kFar && static_cast<Twist>(how) != Twist::kBeyond;
    if (TypeParam::kRoundsOnce && is_near) {
      EXPECT_GT(tallies[how].by_terms, 3u) << how;
    }
    // Rays from beyond meet all boxes; for others most are out of the way.
    if (static_cast<Twist>(how) != Twist::kBeyond) {
      EXPECT_LT(tallies[how].met, tallies[how].pairs / 2) << how;
    }
  }
}

// The hard cases of the numeric tests, with origins on vertices and rays in planes.
TYPED_TEST(BoxTest, HardCasesMeetThem) {
  Tally tally;
  for_each_seed(300, [&](std::uint64_t seed) {
    TestRandom random(seed);
    const HardCase hard = make_hard_case(seed);
    MemoryTree tree(hard.mesh.view(), 1 + random.below(3));
    if (tree.status() != Status::kOk) return;  // of no triangle with an area
    const Oracle oracle(hard.mesh.view(), {.reading = Reading::kStandard});
    std::vector<Shot> shots;
    for (OracleRay ray : hard.rays) {
      ray.t_min = 0.0f;
      Shot shot{ray, std::vector<bool>(hard.mesh.triangles.size(), false)};
      for (const OracleHit& hit : oracle.hits(ray)) {
        const float t = oracle.distance(ray, hit.triangle_id).rounded(Reading::kStandard);
        shot.hits[hit.triangle_id] = t > 0.0f && t <= ray.t_max && t != kFloatMax;
      }
      shots.push_back(shot);
    }
    expect_boxes_met<TypeParam>(tree, shots, tally);
  });
  if (testing::Test::HasFailure() || !all_seeds_run()) return;
  EXPECT_GT(tally.hits, 1000u);
}

}  // namespace
}  // namespace gridiron::test
