// Shafts: every cell that a ray touches on its way lies in them, by exact arithmetic; passes: who goes with whom.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/engine/grid/shaft.h>

#include "core/engine/grid/frustum_cases.h"
#include "core/lane_types.h"
#include "core/ray/exact_ray.h"
#include "core/seeds.h"
#include "support/test_mesh.h"

namespace gridiron::test {
namespace {

constexpr std::uint32_t kAll = (1u << kWalkRays) - 1;
constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

template <class L>
class ShaftTest : public testing::Test {};
TYPED_TEST_SUITE(ShaftTest, WalkLaneTypes, LaneNames);

void set_ray(WalkRays& rays, std::uint32_t ray, Vec3 origin, Vec3 dir, float t = kFloatMax) {
  for (int axis = 0; axis < 3; ++axis) {
    rays.origin[axis][ray] = origin[axis];
    rays.dir[axis][ray] = dir[axis];
  }
  rays.t[ray] = t;
  rays.id[ray] = kNoTriangle;
}

// A direction, in cells: at a point of the grid, often on a face; anywhere; along axes; diagonal; almost along an axis.
void aim(TestRandom& random, const GridRecord& grid, const float origin[3], float dir[3]) {
  const std::uint32_t kind = random.below(6);
  const std::uint32_t special = random.below(3);
  const float sign = random.below(2) != 0 ? 1.0f : -1.0f;
  for (std::uint32_t axis = 0; axis < 3; ++axis) {
    const float unit = 1.0f / grid.cells_per_unit[axis];
    switch (kind) {
      case 0:
        dir[axis] = random.between(-1, 1) * unit;
        break;
      case 1:
        dir[axis] = axis == special ? sign * unit : random.below(2) != 0 ? 0.0f : -0.0f;
        break;
      case 2:
        dir[axis] = (random.below(2) != 0 ? unit : -unit) * (random.below(3) == 0 ? 0.0f : 1.0f);
        break;
      case 3:
        dir[axis] = axis == special ? sign * unit : unit * std::ldexp(random.between(-1, 1), -10);
        break;
      default:
        dir[axis] = world_of(grid, axis, random_cell(random, grid, axis)) - origin[axis];
        break;
    }
  }
}

// Rays that are hard for a shaft, `count` of them, the first ones.
void random_rays(TestRandom& random, const GridRecord& grid, std::uint32_t count, WalkRays& rays) {
  std::memset(static_cast<void*>(&rays), 0, sizeof(rays));
  const std::uint32_t place = random.below(5), together = random.below(4);
  double first[3];
  for (std::uint32_t axis = 0; axis < 3; ++axis) {
    first[axis] = random_cell(random, grid, axis);
    if (place == 1) first[axis] = static_cast<double>(grid.cell_count[axis]) * double{random.between(-3.0f, 4.0f)};
    if (place == 2) first[axis] = double{random.between(-1e6f, 1e6f)};
  }
  constexpr int kExponents[] = {0, 0, 0, -60, 60, -20, 20};
  const int exponent = kExponents[random.below(7)];
  float common[3] = {};
  for (std::uint32_t ray = 0; ray < count; ++ray) {
    float origin[3], dir[3];
    for (std::uint32_t axis = 0; axis < 3; ++axis) {
      double cell = first[axis];
      if (together == 1) cell += double{random.between(-3.0f, 3.0f)};
      if (together == 2) cell += static_cast<double>(random.below(4)) - 1.0;
      if (together == 3 && random.below(3) == 0) cell = random_cell(random, grid, axis);
      origin[axis] = world_of(grid, axis, cell);
    }
    aim(random, grid, origin, dir);
    if (ray == 0) std::copy(dir, dir + 3, common);
    if (random.below(4) != 0) {  // like the first
      for (int axis = 0; axis < 3; ++axis) dir[axis] = common[axis] * (1.0f + 0.1f * random.unit());
    }
    float size = 0.0f;
    for (int axis = 0; axis < 3; ++axis) size = std::fmax(size, std::fabs(dir[axis] * grid.cells_per_unit[axis]));
    for (int axis = 0; axis < 3; ++axis) {
      rays.origin[axis][ray] = origin[axis];
      rays.dir[axis][ray] = std::ldexp(dir[axis], exponent);
    }
    if (random.below(16) == 0) rays.dir[random.below(3)][ray] = random.below(2) != 0 ? 0x1p-140f : -0x1p-149f;
    rays.t[ray] = kFloatMax;
    const std::uint32_t length = random.below(4);
    // To a face of a cell, or just before or behind.
    if (length == 1) rays.t[ray] = std::ldexp(static_cast<float>(1 + random.below(8)) / size, -exponent);
    if (length == 2) rays.t[ray] = std::ldexp(64.0f * random.unit() / size, -exponent);
    if (!(rays.t[ray] > 0.0f && rays.t[ray] <= kFloatMax)) rays.t[ray] = kFloatMax;
    rays.id[ray] = kNoTriangle;
  }
}

ExactRay exact_ray(const GridRecord& grid, const WalkRays& rays, std::uint32_t ray) {
  const float o[3] = {rays.origin[0][ray], rays.origin[1][ray], rays.origin[2][ray]};
  const float d[3] = {rays.dir[0][ray], rays.dir[1][ray], rays.dir[2][ray]};
  return {grid, o, d};
}

// The closed cells that a ray touches at 0..t with first <= k <= last + 1, as the box around them.
std::optional<CellBox> touched(const ExactRay& ray, const Shaft& shaft, const CellSpan& slices, float t) {
  const ExactRay::Parameter zero{0, 1}, most = ray.parameter(t);
  ExactRay::Parameter from = ray.crossing(shaft.axis_k, shaft.reverse ? slices.last + 1 : slices.first);
  ExactRay::Parameter to = ray.crossing(shaft.axis_k, shaft.reverse ? slices.first : slices.last + 1);
  if (ExactRay::compare(from, zero) < 0) from = zero;
  if (ExactRay::compare(most, to) < 0) to = most;
  if (ExactRay::compare(to, from) < 0) return std::nullopt;
  const auto span = [&](std::uint32_t axis, std::int32_t count) {
    const CellSpan a = ray.cells_at(axis, from), b = ray.cells_at(axis, to);
    return CellSpan{std::max(std::min(a.first, b.first), 0), std::min(std::max(a.last, b.last), count - 1)};
  };
  const CellBox box{span(shaft.axis_u, shaft.cells_u), span(shaft.axis_v, shaft.cells_v)};
  if (box.u.empty() || box.v.empty()) return std::nullopt;
  return box;
}

// Slabs of one slice and of several: at both ends, anywhere, around a place.
std::vector<CellSpan> some_slabs(TestRandom& random, const Shaft& shaft) {
  std::vector<CellSpan> slabs;
  const std::int32_t count = shaft.cells_k;
  const auto add = [&](double cell, std::int32_t width) {
    const double clipped = std::fmin(std::fmax(cell, 0.0), static_cast<double>(count - 1));
    const auto first = static_cast<std::int32_t>(clipped);
    slabs.push_back({first, std::min(first + width - 1, count - 1)});
  };
  const auto start = static_cast<double>(shaft.reverse ? -shaft.least_start : shaft.least_start);
  add(start, 1);
  add(std::floor(start) - 1.0, 1);
  add(std::ceil(start), 1);
  add(start + static_cast<double>(random.below(5)) - 2.0, 1);
  add(static_cast<double>(random.below(static_cast<std::uint32_t>(count))), 1);
  add(static_cast<double>(random.below(static_cast<std::uint32_t>(count))), 6);
  add(0.0, 1);
  add(static_cast<double>(count - 1), 1);
  return slabs;
}

// The shaft of one of the rays alone.
Shaft alone(const Shaft& shaft, std::uint32_t ray) {
  Shaft result = shaft;
  for (std::uint32_t other = 0; other < kWalkRays; ++other) {
    if (other != ray) result.drop(other);
  }
  return result;
}

TYPED_TEST(ShaftTest, HoldEveryCellTouched) {
  std::uint64_t checked = 0, tight = 0, single = 0, shortened = 0;
  WorkCounters work;
  for_each_seed(4000, [&](TestRandom& random) {
    const GridRecord grid = random_grid(random, random.below(2) != 0 ? 2048 : 24, 1);
    WalkRays rays;
    const std::uint32_t count = 1 + random.below(kWalkRays);
    random_rays(random, grid, count, rays);
    std::uint32_t waiting = (1u << count) - 1;
    Shaft shaft;
    while (const std::uint32_t active = take_walk_pass<TypeParam>(grid, rays, waiting, shaft, work)) {
      const std::vector<CellSpan> slabs = some_slabs(random, shaft);
      for (std::uint32_t rest = active; rest != 0; rest &= rest - 1) {
        const auto ray = static_cast<std::uint32_t>(std::countr_zero(rest));
        const ExactRay exact = exact_ray(grid, rays, ray);
        Shaft own = alone(shaft, ray);
        for (const CellSpan& slices : slabs) {
          const Slab slab = shaft.slab_of(slices.first, slices.last);
          float t = rays.t[ray];
          // A hit at about the slab's entry: what a ray still has to look at ends there.
          if (random.below(3) == 0) {
            const float off = std::ldexp(random.between(-1, 1), -8 - static_cast<int>(random.below(17)));
            t = (slab.entry - own.start[ray]) / own.march[ray] * (1.0f + off);
            t = t > 0.0f && t < rays.t[ray] ? t : rays.t[ray];
            own.shorten(ray, t);
            ++shortened;
          }
          const auto box = touched(exact, shaft, slices, t);
          if (box) {
            ++checked;
            ASSERT_FALSE(shaft.behind(slab)) << "ray " << ray << " slice " << slices.first;
            ASSERT_FALSE(shaft.beyond(slab, own.end[ray])) << "ray " << ray;
            ASSERT_FALSE(shaft.beyond(slab, shaft.reach<TypeParam>())) << "ray " << ray;
            const CellRect rect = own.rect_of<TypeParam>(slab, work);
            ASSERT_TRUE(holds(rect, *box)) << "ray " << ray << " slice " << slices.first;
            ASSERT_TRUE(holds(shaft.rect_of<TypeParam>(slab, work), *box)) << "ray " << ray;
            // A shaft that held the whole grid would hold them too.
            const auto whole = touched(exact, shaft, slices, kFloatMax);
            if (whole && std::fabs(own.place[0][ray]) < 4096.0f && std::fabs(own.place[1][ray]) < 4096.0f) {
              ++single;
              tight += is_tight(rect, *whole) ? 1u : 0u;
            }
          }
          own.shorten(ray, rays.t[ray]);
        }
      }
    }
  });
  if (testing::Test::HasFailure() || !all_seeds_run()) return;
  EXPECT_GT(checked, 50'000u);
  EXPECT_GT(shortened, 25'000u);
  EXPECT_GT(tight, single - single / 20);
}

// What decides whether a ray can be in a pass at all.
bool can_be_traced(const GridRecord& grid, const WalkRays& rays, std::uint32_t ray) {
  float largest = 0.0f;
  for (int axis = 0; axis < 3; ++axis) {
    if (!is_finite(rays.origin[axis][ray]) || !is_finite(rays.dir[axis][ray])) return false;
    largest = std::fmax(largest, std::fabs(rays.dir[axis][ray] * grid.cells_per_unit[axis]));
  }
  return largest > 0.0f && largest <= 0.5f * kFloatMax;
}

TYPED_TEST(ShaftTest, EveryRayIsInOnePass) {
  std::uint64_t passes = 0, joined = 0, dropped = 0;
  for_each_seed(1500, [&](TestRandom& random) {
    const GridRecord grid = random_grid(random, 100, 1);
    WalkRays rays;
    const std::uint32_t count = 1 + random.below(kWalkRays);
    random_rays(random, grid, count, rays);
    for (std::uint32_t ray = 0; ray < count; ++ray) {
      const float specials[] = {kNaN, kInfinity, -kInfinity, 3e38f};
      const std::uint32_t special = random.below(20);
      if (special < 4) rays.dir[random.below(3)][ray] = specials[special];
      if (special == 4) rays.origin[random.below(3)][ray] = specials[random.below(3)];
      if (special == 5) rays.dir[0][ray] = rays.dir[1][ray] = rays.dir[2][ray] = random.below(2) != 0 ? 0.0f : -0.0f;
    }
    const std::uint32_t all = (1u << count) - 1;
    std::uint32_t waiting = all, taken = 0, pass_count = 0;
    Shaft shaft;
    WorkCounters work;
    for (;;) {
      const std::uint32_t before = waiting;
      const std::uint32_t active = take_walk_pass<TypeParam>(grid, rays, waiting, shaft, work);
      if (active == 0) break;
      ASSERT_LE(++pass_count, kWalkRays);
      ASSERT_EQ(active & taken, 0u) << "a ray twice";
      ASSERT_EQ(active & ~before, 0u) << "a ray that did not wait";
      ASSERT_EQ(waiting & active, 0u);
      taken |= active;
      const auto leader = static_cast<std::uint32_t>(std::countr_zero(active));
      const std::uint32_t axes[3] = {shaft.axis_k, shaft.axis_u, shaft.axis_v};
      ASSERT_EQ(1u << axes[0] | 1u << axes[1] | 1u << axes[2], 7u);
      for (std::uint32_t ray = 0; ray < kWalkRays; ++ray) {
        if ((active >> ray & 1u) == 0) {
          ASSERT_EQ(shaft.end[ray], -kFloatMax) << "ray " << ray << " is not in the pass";
          continue;
        }
        // In doubles: what the floats decided, to rounding.
        double along[3], place[3], leads[3], leader_place[3];
        float largest = 0.0f;
        for (int i = 0; i < 3; ++i) {
          const double scale = double{grid.cells_per_unit[axes[i]]};
          const auto in_cells = [&](std::uint32_t r) {
            return (double{rays.origin[axes[i]][r]} - double{grid.minimum[axes[i]]}) * scale;
          };
          along[i] = double{rays.dir[axes[i]][ray]} * scale;
          leads[i] = double{rays.dir[axes[i]][leader]} * scale;
          place[i] = in_cells(ray);
          leader_place[i] = in_cells(leader);
          largest = std::fmax(largest, std::fabs(rays.dir[i][ray]));
        }
        ASSERT_EQ(along[0] < 0.0, shaft.reverse) << "ray " << ray;
        ASSERT_NE(along[0], 0.0);
        for (int i = 1; i < 3; ++i) {
          ASSERT_LE(std::fabs(along[i]), 2.000001 * std::fabs(along[0])) << "ray " << ray;
          ASSERT_LE(std::fabs(along[i] / std::fabs(along[0]) - leads[i] / std::fabs(leads[0])), kTogetherSlope + 1e-5)
              << "ray " << ray;
        }
        for (int i = 0; i < 3; ++i) {
          ASSERT_LE(std::fabs(place[i] - leader_place[i]), kTogetherCells + 1e-6 * (std::fabs(place[i]) + 3.0))
              << "ray " << ray;
        }
        ASSERT_EQ(rays.dir_max[ray], largest) << "ray " << ray;
        joined += ray != leader ? 1u : 0u;
      }
      ++passes;
    }
    EXPECT_EQ(waiting, 0u);
    for (std::uint32_t ray = 0; ray < count; ++ray) {
      ASSERT_EQ((taken >> ray & 1u) != 0, can_be_traced(grid, rays, ray)) << "ray " << ray;
    }
    dropped += static_cast<std::uint32_t>(std::popcount(all & ~taken));
  });
  if (testing::Test::HasFailure() || !all_seeds_run()) return;
  EXPECT_GT(joined, passes / 4);
  EXPECT_GT(passes, 2000u);
  EXPECT_GT(dropped, 500u);
}

// Passes and bounds of 16 rays, everything that a walk reads of them.
template <class L>
std::vector<std::uint32_t> transcript(std::uint64_t seed) {
  std::vector<std::uint32_t> words;
  const auto note = [&](float value) { words.push_back(std::bit_cast<std::uint32_t>(value)); };
  TestRandom random(seed);
  const GridRecord grid = random_grid(random, 500, 1);
  WalkRays rays;
  random_rays(random, grid, kWalkRays, rays);
  std::uint32_t waiting = kAll & static_cast<std::uint32_t>(random.next() | random.next());
  Shaft shaft;
  WorkCounters work;
  while (const std::uint32_t active = take_walk_pass<L>(grid, rays, waiting, shaft, work)) {
    words.insert(words.end(), {active, waiting, shaft.axis_k, shaft.axis_u, shaft.axis_v, shaft.reverse ? 1u : 0u});
    for (const float value : {shaft.least_start, shaft.pad_k, shaft.pad_u, shaft.pad_v}) note(value);
    note(shaft.template reach<L>());
    for (std::uint32_t ray = 0; ray < kWalkRays; ++ray) {
      note(shaft.end[ray]);
      if ((active >> ray & 1u) == 0) continue;
      for (const float value : {shaft.start[ray], shaft.march[ray], shaft.place[0][ray], shaft.place[1][ray],
                                shaft.slope[0][ray], shaft.slope[1][ray], rays.dir_max[ray]}) {
        note(value);
      }
    }
    for (const CellSpan& slices : some_slabs(random, shaft)) {
      const Slab slab = shaft.slab_of(slices.first, slices.last);
      const CellRect rect = shaft.template rect_of<L>(slab, work);
      for (const std::int32_t cell : ends_of(rect)) words.push_back(static_cast<std::uint32_t>(cell));
    }
  }
  return words;
}

TYPED_TEST(ShaftTest, LanesChangeNothing) {
  for_each_seed(400, [](std::uint64_t seed) {
    const auto words = transcript<TypeParam>(seed);
    ASSERT_FALSE(words.empty());
    ASSERT_EQ(words, transcript<Lanes<4>>(seed));
  });
}

TYPED_TEST(ShaftTest, RaysInACellFaceTouchBothSides) {
  const GridRecord grid = unit_grid(16);
  WalkRays rays{};
  for (std::uint32_t ray = 0; ray < 4; ++ray) {
    set_ray(rays, ray, {-1, 3, 7}, {1.0f, ray % 2 == 0 ? 0.0f : -0.0f, 0.0f});
  }
  std::uint32_t waiting = 15;
  Shaft shaft;
  WorkCounters work;
  ASSERT_EQ(take_walk_pass<TypeParam>(grid, rays, waiting, shaft, work), 15u);
  for (std::int32_t k = 0; k < 16; ++k) {
    EXPECT_EQ(ends_of(shaft.rect_of<TypeParam>(shaft.slab_of(k, k), work)), (std::array{2, 3, 6, 7}));
  }
}

TYPED_TEST(ShaftTest, EndsAndDropsShrinkIt) {
  const GridRecord grid = unit_grid(100);
  WalkRays rays{};
  set_ray(rays, 0, {50.5f, 50.5f, 50.5f}, {0, 0, -2}, 5.0f);  // to z = 40.5
  set_ray(rays, 1, {52.5f, 48.5f, 51.5f}, {0, 0, -4}, 5.0f);  // to z = 31.5
  std::uint32_t waiting = 3;
  Shaft shaft;
  WorkCounters work;
  ASSERT_EQ(take_walk_pass<TypeParam>(grid, rays, waiting, shaft, work), 3u);
  EXPECT_TRUE(shaft.reverse);
  EXPECT_EQ(shaft.reach<TypeParam>(), -31.5f);
  EXPECT_FALSE(shaft.behind(shaft.slab_of(51, 51)));
  EXPECT_TRUE(shaft.behind(shaft.slab_of(52, 52)));
  EXPECT_FALSE(shaft.beyond(shaft.slab_of(31, 31), shaft.reach<TypeParam>()));
  EXPECT_TRUE(shaft.beyond(shaft.slab_of(30, 30), shaft.reach<TypeParam>()));
  const auto expect_rect = [&](std::int32_t k, std::int32_t u0, std::int32_t u1, std::int32_t v0, std::int32_t v1) {
    EXPECT_EQ(ends_of(shaft.rect_of<TypeParam>(shaft.slab_of(k, k), work)), (std::array{u0, u1, v0, v1})) << k;
  };
  expect_rect(51, 52, 52, 48, 48);  // the second alone has begun
  expect_rect(50, 50, 52, 48, 50);
  expect_rect(40, 50, 52, 48, 50);
  expect_rect(39, 52, 52, 48, 48);  // the first has ended
  EXPECT_TRUE(shaft.rect_of<TypeParam>(shaft.slab_of(30, 30), work).empty());
  shaft.shorten(1, 0.5f);  // to z = 49.5
  EXPECT_EQ(shaft.reach<TypeParam>(), -40.5f);
  expect_rect(48, 50, 50, 50, 50);
  shaft.drop(0);
  EXPECT_EQ(shaft.reach<TypeParam>(), -49.5f);
  expect_rect(50, 52, 52, 48, 48);
  shaft.drop(1);
  EXPECT_EQ(shaft.reach<TypeParam>(), -kFloatMax);
  EXPECT_TRUE(shaft.rect_of<TypeParam>(shaft.slab_of(50, 50), work).empty());
  EXPECT_TRUE(shaft.beyond(shaft.slab_of(99, 99), shaft.reach<TypeParam>()));
}

TYPED_TEST(ShaftTest, RaysBesideTheGridTouchNothing) {
  const GridRecord grid = unit_grid(16);
  for (const float y : {-0.5f, 16.5f, 1e6f, -1e6f}) {
    WalkRays rays{};
    set_ray(rays, 7, {-1, y, 8}, {1, 0, 0});
    std::uint32_t waiting = 1u << 7;
    Shaft shaft;
    WorkCounters work;
    ASSERT_EQ(take_walk_pass<TypeParam>(grid, rays, waiting, shaft, work), 1u << 7);
    for (std::int32_t k = 0; k < 16; ++k) {
      EXPECT_TRUE(shaft.rect_of<TypeParam>(shaft.slab_of(k, k), work).empty()) << y;
    }
  }
}

TYPED_TEST(ShaftTest, NeighboursThatRunAlikeGoTogether) {
  const GridRecord grid = unit_grid(64);
  WalkRays rays{};
  for (std::uint32_t ray = 0; ray < kWalkRays; ++ray) {
    set_ray(rays, ray, {30.0f + 0.1f * static_cast<float>(ray), 30, 30}, {1, 0.2f, 0.01f * static_cast<float>(ray)});
  }
  rays.origin[1][3] = 30.25f + kTogetherCells;  // too far off
  rays.dir[2][5] = 0.05f + kTogetherSlope;      // turned too far
  rays.dir[0][9] = -1.0f;                       // the other way
  std::uint32_t waiting = kAll;
  Shaft shaft;
  WorkCounters work;
  EXPECT_EQ(take_walk_pass<TypeParam>(grid, rays, waiting, shaft, work), kAll & ~(1u << 3 | 1u << 5 | 1u << 9));
  EXPECT_EQ(take_walk_pass<TypeParam>(grid, rays, waiting, shaft, work), 1u << 3);
  EXPECT_EQ(take_walk_pass<TypeParam>(grid, rays, waiting, shaft, work), 1u << 5);
  EXPECT_EQ(take_walk_pass<TypeParam>(grid, rays, waiting, shaft, work), 1u << 9);
  EXPECT_EQ(take_walk_pass<TypeParam>(grid, rays, waiting, shaft, work), 0u);
}

}  // namespace
}  // namespace gridiron::test
