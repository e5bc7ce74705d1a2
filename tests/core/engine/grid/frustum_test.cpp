// Frustum: passes take every ray once, and a slice's rectangle holds every cell that exact arithmetic says is touched.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/engine/grid/frustum.h>
#include <gridiron/ray/camera.h>

#include "core/engine/grid/frustum_cases.h"
#include "core/engine/grid/reach_of.h"
#include "core/lane_types.h"
#include "core/ray/exact_ray.h"
#include "core/ray/frame_cases.h"
#include "core/seeds.h"
#include "support/test_mesh.h"

namespace gridiron::test {
namespace {

WorkCounters pass_work;  // of take_pass, of no interest here

using SmallPacket = Packet<4>;
using Rays = RaySet<SmallPacket::kRayCount>;
constexpr std::uint32_t kRays = SmallPacket::kRayCount;
constexpr std::uint32_t kAllRays = (1u << kRays) - 1;

Rays all_waiting() {
  Rays waiting;
  waiting.words[0] = kAllRays;
  return waiting;
}

void set_direction(SmallPacket& packet, std::uint32_t ray, float x, float y, float z) {
  packet.dir[0][ray] = x;
  packet.dir[1][ray] = y;
  packet.dir[2][ray] = z;
}

// Whether a ray has no direction left in cell space.
template <class PacketType>
bool vanishes(const GridRecord& grid, const PacketType& packet, std::uint32_t ray) {
  const auto in_cells = [&](int axis) { return packet.dir[axis][ray] * grid.cells_per_unit[axis]; };
  return in_cells(0) == 0.0f && in_cells(1) == 0.0f && in_cells(2) == 0.0f;
}

template <class L>
class FrustumTest : public testing::Test {};
TYPED_TEST_SUITE(FrustumTest, LaneTypes, LaneNames);

TYPED_TEST(FrustumTest, EveryRayIsTakenOnceInAtMostSixPasses) {
  for_each_seed(3000, [&](TestRandom& random) {
    const GridRecord grid = random_grid(random, 2048, 1);
    SmallPacket packet{};
    random_packet(random, grid, packet);
    std::uint32_t vanishing = 0;
    for (std::uint32_t ray = 0; ray < kRays; ++ray) {
      for (auto& component : packet.dir) {
        if (random.below(2) != 0) component[ray] = -component[ray];  // all octants in one packet
      }
      if (vanishes(grid, packet, ray)) vanishing |= 1u << ray;
    }
    Rays waiting = all_waiting();
    std::uint32_t taken = 0;
    std::uint32_t passes = 0;
    Frustum frustum;
    while (take_pass<TypeParam>(grid, waiting, packet, frustum, pass_work)) {
      const std::uint32_t active = packet.active.words[0];
      ASSERT_EQ(active & taken, 0u) << "a ray was taken twice";
      ASSERT_EQ(active & waiting.words[0], 0u) << "a taken ray still waits";
      taken |= active;
      passes += active != 0 ? 1 : 0;
      ASSERT_LE(passes, 6u);
      // Same march axis, same sign, slopes of at most 2.
      for (std::uint32_t ray = 0; ray < kRays; ++ray) {
        if (!packet.active.contains(ray)) continue;
        const float march = packet.dir[frustum.axis_k][ray] * grid.cells_per_unit[frustum.axis_k];
        ASSERT_EQ(march < 0.0f, frustum.reverse);
        for (const std::uint32_t axis : {frustum.axis_u, frustum.axis_v}) {
          ASSERT_LE(std::fabs(packet.dir[axis][ray] * grid.cells_per_unit[axis]), 2.0f * std::fabs(march));
        }
      }
    }
    ASSERT_EQ(taken, kAllRays & ~vanishing);
    ASSERT_EQ(waiting.words[0], 0u);
  });
}

TYPED_TEST(FrustumTest, SixDirectionsNeedSixPasses) {
  const GridRecord grid = unit_grid(8);
  SmallPacket packet{};
  for (std::uint32_t ray = 0; ray < kRays; ++ray) {
    float d[3] = {0.0f, -0.0f, 0.1f};
    d[ray % 3] = ray % 2 == 0 ? 1.0f : -1.0f;
    set_direction(packet, ray, d[0], d[1], d[2]);
  }
  Rays waiting = all_waiting();
  Frustum frustum;
  std::set<std::pair<std::uint32_t, bool>> ways;
  while (take_pass<TypeParam>(grid, waiting, packet, frustum, pass_work)) {
    ways.insert({frustum.axis_k, frustum.reverse});
  }
  EXPECT_EQ(ways.size(), 6u);
}

TYPED_TEST(FrustumTest, RaysWithoutADirectionAreDroppedAndSpoilNoOther) {
  const float kNaN = std::numeric_limits<float>::quiet_NaN();
  const float kInfinity = std::numeric_limits<float>::infinity();
  const float bad[] = {kNaN, -kNaN, kInfinity, -kInfinity, 0.0f};
  std::uint64_t compared = 0;
  for_each_seed(3000, [&](TestRandom& random) {
    const GridRecord grid = random_grid(random, 100, 1);
    SmallPacket packet{};
    random_packet(random, grid, packet);
    std::uint32_t good = 0;
    for (std::uint32_t ray = 0; ray < kRays; ++ray) {
      if (random.below(2) != 0) {
        good |= vanishes(grid, packet, ray) ? 0u : 1u << ray;
        continue;
      }
      const float first = bad[random.below(5)];
      set_direction(packet, ray, first, first == 0.0f ? 0.0f : packet.dir[1][ray],
                    first == 0.0f ? -0.0f : packet.dir[2][ray]);
      if (first != 0.0f && random.below(2) != 0) packet.dir[1 + random.below(2)][ray] = bad[random.below(4)];
    }
    // What the good rays get alone, pass by pass, they get in bad company.
    Rays together = all_waiting();
    SmallPacket other = packet;
    Frustum expected{}, frustum{};
    std::uint32_t taken = 0;
    for (int pass = 0; pass < 6 + static_cast<int>(kRays); ++pass) {
      if (!take_pass<TypeParam>(grid, together, packet, frustum, pass_work)) break;
      const std::uint32_t active = packet.active.words[0];
      ASSERT_EQ(active & ~good, 0u) << "a ray without direction runs";
      ASSERT_EQ(active & taken, 0u);
      taken |= active;
      if (active == 0) continue;
      Rays same;
      same.words[0] = active;
      ASSERT_TRUE(take_pass<TypeParam>(grid, same, other, expected, pass_work));
      if (frustum.axis_k != expected.axis_k) continue;  // a bad leader chose the axis
      ++compared;
      for (int i = 0; i < 4; ++i) {
        ASSERT_EQ(frustum.start[i], expected.start[i]);
        ASSERT_EQ(frustum.slope_near[i], expected.slope_near[i]);
        ASSERT_EQ(frustum.slope_far[i], expected.slope_far[i]);
      }
    }
    ASSERT_EQ(together.words[0], 0u) << "rays wait for ever";
    ASSERT_EQ(taken, good);
  });
  if (!all_seeds_run()) return;
  EXPECT_GT(compared, 3000u);
}

// The slices worth a look: first, last, around the origin, some others; and the same as runs of several slices.
std::vector<CellSpan> slabs_of(TestRandom& random, const Frustum& frustum) {
  std::vector<CellSpan> slabs;
  const std::int32_t last = frustum.cells_k - 1;
  const auto add = [&](std::int32_t k) {
    if (k >= 0 && k <= last) slabs.push_back({k, k});
  };
  add(0);
  add(last);
  if (frustum.origin_k > -4.0f && frustum.origin_k < static_cast<float>(last + 4)) {
    for (std::int32_t offset = -2; offset <= 1; ++offset) add(static_cast<std::int32_t>(frustum.origin_k) + offset);
  }
  for (int i = 0; i < 4; ++i) {
    const auto k = static_cast<std::int32_t>(random.below(static_cast<std::uint32_t>(frustum.cells_k)));
    add(k);
    const auto end = k + 1 + static_cast<std::int32_t>(random.below(8));
    slabs.push_back({k, end < last ? end : last});
  }
  return slabs;
}

TYPED_TEST(FrustumTest, RectanglesHoldEveryCellTouched) {
  std::uint64_t checked = 0;
  std::uint64_t exact = 0;  // boxes of which an end is also the rectangle's: the bound is not just everything
  for_each_seed(1500, [&](TestRandom& random) {
    const GridRecord grid = random_grid(random, 2048, 1);
    SmallPacket packet{};
    random_packet(random, grid, packet);
    Rays waiting = all_waiting();
    Frustum frustum;
    while (take_pass<TypeParam>(grid, waiting, packet, frustum, pass_work)) {
      const std::vector<CellSpan> slabs = slabs_of(random, frustum);
      for (std::uint32_t ray = 0; ray < kRays; ++ray) {
        if (!packet.active.contains(ray)) continue;
        const ExactRay truth(grid, packet, ray);
        for (const CellSpan& slices : slabs) {
          const auto box = truth.box_between(frustum.axis_k, slices.first, slices.last);
          if (!box) continue;
          ++checked;
          const Slab slab = frustum.slab_of(slices.first, slices.last);
          ASSERT_FALSE(frustum.behind(slab)) << "ray " << ray << ", slice " << slices.first;
          const CellRect rect = frustum.rect_of(slab);
          ASSERT_TRUE(holds(rect, *box)) << "ray " << ray << ", slices " << slices.first << " to " << slices.last
                                         << ": cells u " << box->u.first << " to " << box->u.last << ", v "
                                         << box->v.first << " to " << box->v.last << " leave the rectangle u "
                                         << rect.u_first << " to " << rect.u_last << ", v " << rect.v_first << " to "
                                         << rect.v_last;
          ASSERT_GE(rect.u_first, 0);
          ASSERT_GE(rect.v_first, 0);
          ASSERT_LT(rect.u_last, frustum.cells_u);
          ASSERT_LT(rect.v_last, frustum.cells_v);
          exact += rect.u_first == box->u.first || rect.u_last == box->u.last ? 1u : 0u;
        }
      }
    }
  });
  if (!all_seeds_run()) return;
  EXPECT_GT(checked, 50000u);
  EXPECT_GT(exact, checked / 3);
}

// A packet of a frame's pixels whose eye stands somewhere around a grid; now and then over the picture's edge.
template <class L, class PacketType>
void pixel_packet(TestRandom& random, const GridRecord& grid, FrameKind kind, PacketType& packet,
                  RaySet<PacketType::kRayCount>& present) {
  FrameRecord frame = make_frame(random, kind);
  const std::uint32_t place = random.below(4);
  for (std::uint32_t axis = 0; axis < 3; ++axis) {
    const auto count = static_cast<double>(grid.cell_count[axis]);
    const double cell = place == 0                                    ? count * double{random.between(-3.0f, 4.0f)}
                        : place == 1 && kind == FrameKind::kFarOrigin ? double{random.between(-1e6f, 1e6f)}
                                                                      : random_cell(random, grid, axis);
    frame.eye[axis] = world_of(grid, axis, cell);
  }
  const std::uint32_t places = random.below(2) == 0 ? 512 : frame.width;
  const std::uint32_t left = PacketType::kWidth * random.below(places / PacketType::kWidth);
  const std::uint32_t top = PacketType::kWidth * random.below(places / PacketType::kWidth);
  if (random.below(8) == 0) {
    frame.width = left + 1 + random.below(PacketType::kWidth);
    frame.height = top + 1 + random.below(PacketType::kWidth);
  }
  WorkCounters work;
  generate_packet<L>(frame, left, top, packet, present, work);
}

// Passes over packets of pixels: each ray once, its slopes within those of its square.
template <class L, class PacketType>
void expect_slopes_of_squares(FrameKind kind) {
  constexpr std::uint32_t kSquareRays = PacketType::kRayCount / PacketType::kSquareCount;
  constexpr std::uint64_t kSeeds = 150;
  std::uint64_t taken_count = 0;
  WorkCounters work, one_by_one_work;
  for_each_seed(kSeeds, [&](std::uint64_t seed) {
    TestRandom random(seed * 64 + static_cast<std::uint64_t>(kind));
    const GridRecord grid = random_grid(random, 2048, 1);
    const auto packet = std::make_unique<PacketType>();
    RaySet<PacketType::kRayCount> present;
    pixel_packet<L>(random, grid, kind, *packet, present);
    RaySet<PacketType::kRayCount> waiting = present;
    std::vector<bool> taken(PacketType::kRayCount);
    Frustum frustum;
    std::uint32_t passes = 0;
    while (take_pass<L>(grid, waiting, *packet, frustum, work)) {
      std::uint32_t active_count = 0;
      std::vector<long double> least[2], greatest[2], farthest(PacketType::kSquareCount);
      for (int i = 0; i < 2; ++i) {
        least[i].assign(PacketType::kSquareCount, 4.0L);
        greatest[i].assign(PacketType::kSquareCount, -4.0L);
      }
      for (std::uint32_t ray = 0; ray < PacketType::kRayCount; ++ray) {
        if (!packet->active.contains(ray)) continue;
        ASSERT_TRUE(present.contains(ray)) << "ray " << ray << " has no pixel";
        ASSERT_FALSE(waiting.contains(ray)) << "ray " << ray << " still waits";
        ASSERT_FALSE(taken[ray]) << "ray " << ray << " comes again";
        taken[ray] = true;
        ++taken_count;
        ++active_count;
        const auto cells = [&](std::uint32_t axis) {
          return static_cast<long double>(packet->dir[axis][ray]) * static_cast<long double>(grid.cells_per_unit[axis]);
        };
        const long double march = frustum.reverse ? -cells(frustum.axis_k) : cells(frustum.axis_k);
        ASSERT_GT(march, 0.0L) << "ray " << ray;
        const std::uint32_t square = ray / kSquareRays;
        ASSERT_LE(march, packet->march_high[square] * (1.0L + 0x1p-23L)) << "ray " << ray;
        farthest[square] = std::fmax(farthest[square], march);
        const std::uint32_t axes[2] = {frustum.axis_u, frustum.axis_v};
        for (int i = 0; i < 2; ++i) {
          const long double slope = cells(axes[i]) / march;
          ASSERT_LE(std::fabs(slope), 2.0L * (1.0L + 0x1p-22L)) << "ray " << ray;
          // What the pads of a frustum cover, see there.
          const bool is_tiny = march < 0x1p-90L;
          const long double pad = 0x1p-21L * std::fabs(slope) + (is_tiny ? 0x1p-25L : 0.0L);
          const long double low = packet->slope_low[i][square], high = packet->slope_high[i][square];
          ASSERT_GE(slope, low - pad) << "kind " << static_cast<int>(kind) << ", ray " << ray;
          ASSERT_LE(slope, high + pad) << "kind " << static_cast<int>(kind) << ", ray " << ray;
          least[i][square] = std::fmin(least[i][square], slope);
          greatest[i][square] = std::fmax(greatest[i][square], slope);
        }
      }
      passes += active_count != 0 ? 1u : 0u;
      ASSERT_LE(passes, 6u);
      for (std::uint32_t square = 0; kind <= FrameKind::kExact && square < PacketType::kSquareCount; ++square) {
        if (least[0][square] > 2.5L) continue;  // none of its rays
        ASSERT_LT(packet->march_high[square], farthest[square] * (1.0L + 0x1p-12L));
        for (int i = 0; i < 2; ++i) {
          ASSERT_GT(packet->slope_low[i][square], least[i][square] - 0x1p-12L);
          ASSERT_LT(packet->slope_high[i][square], greatest[i][square] + 0x1p-12L);
        }
      }
    }
    for (std::uint32_t ray = 0; ray < PacketType::kRayCount; ++ray) {
      ASSERT_EQ(taken[ray], present.contains(ray) && !vanishes(grid, *packet, ray)) << "ray " << ray;
    }
    packet->is_linear = false;
    waiting = present;
    while (take_pass<L>(grid, waiting, *packet, frustum, one_by_one_work)) continue;
  });
  ASSERT_EQ(one_by_one_work[GridWork::kPassSquare], 0u);
  if (!all_seeds_run() || testing::Test::HasFailure()) return;
  EXPECT_GT(taken_count, kSeeds * PacketType::kRayCount / 2) << "kind " << static_cast<int>(kind);
  // Nearly every square is taken as a whole.
  EXPECT_GT(work[GridWork::kPassSquare], kSeeds * PacketType::kSquareCount / 2) << "kind " << static_cast<int>(kind);
  EXPECT_LT(work[GridWork::kPassGroup], one_by_one_work[GridWork::kPassGroup] / 4) << "kind " << static_cast<int>(kind);
}

TYPED_TEST(FrustumTest, SlopesOfSquaresHoldThoseOfTheirRays) {
  for (std::uint32_t kind = 0; kind < static_cast<std::uint32_t>(FrameKind::kCount); ++kind) {
    expect_slopes_of_squares<TypeParam, Packet<8>>(static_cast<FrameKind>(kind));
    expect_slopes_of_squares<TypeParam, Packet<16>>(static_cast<FrameKind>(kind));
    expect_slopes_of_squares<TypeParam, Packet<32>>(static_cast<FrameKind>(kind));
  }
}

template <class L, class PacketType>
void expect_rectangles_of_pixels() {
  std::uint64_t checked = 0, tight = 0, slab_count = 0;
  WorkCounters work;
  for_each_seed(400, [&](TestRandom& random) {
    const GridRecord grid = random_grid(random, 2048, 1);
    const auto kind = static_cast<FrameKind>(random.below(static_cast<std::uint32_t>(FrameKind::kCount)));
    const auto packet = std::make_unique<PacketType>();
    RaySet<PacketType::kRayCount> waiting;
    pixel_packet<L>(random, grid, kind, *packet, waiting);
    // The corners and some others.
    std::vector<std::uint32_t> rays;
    for (std::uint32_t ray = 0; ray < PacketType::kRayCount; ++ray) {
      const std::uint32_t column = PacketType::column_of(ray), row = PacketType::row_of(ray);
      constexpr std::uint32_t kLast = PacketType::kWidth - 1;
      const bool is_corner = (column == 0 || column == kLast) && (row == 0 || row == kLast);
      if (is_corner || random.below(PacketType::kRayCount) < 8) rays.push_back(ray);
    }
    Frustum frustum;
    while (take_pass<L>(grid, waiting, *packet, frustum, work)) {
      for (const CellSpan& slices : slabs_of(random, frustum)) {
        const Slab slab = frustum.slab_of(slices.first, slices.last);
        const CellRect rect = frustum.rect_of(slab);
        CellBox all{{frustum.cells_u, -1}, {frustum.cells_v, -1}};
        for (const std::uint32_t ray : rays) {
          if (!packet->active.contains(ray)) continue;
          const auto box = ExactRay(grid, *packet, ray).box_between(frustum.axis_k, slices.first, slices.last);
          if (!box) continue;
          ++checked;
          ASSERT_FALSE(frustum.behind(slab)) << "ray " << ray << ", slice " << slices.first;
          ASSERT_TRUE(holds(rect, *box)) << "ray " << ray << ", slices " << slices.first << " to " << slices.last;
          all.u = {std::min(all.u.first, box->u.first), std::max(all.u.last, box->u.last)};
          all.v = {std::min(all.v.first, box->v.first), std::max(all.v.last, box->v.last)};
        }
        if (all.u.empty()) continue;
        ++slab_count;
        tight += is_tight(rect, all) ? 1u : 0u;
      }
    }
  });
  if (!all_seeds_run() || testing::Test::HasFailure()) return;
  EXPECT_GT(checked, 5000u);
  EXPECT_GT(tight, slab_count / 2);
}

TYPED_TEST(FrustumTest, RectanglesOfPixelsHoldEveryCellTouched) {
  expect_rectangles_of_pixels<TypeParam, Packet<8>>();
  expect_rectangles_of_pixels<TypeParam, Packet<16>>();
}

TYPED_TEST(FrustumTest, NoSlabWithAPointInReachIsBeyond) {
  std::uint64_t near_the_limit = 0;
  for_each_seed(1500, [&](TestRandom& random) {
    const GridRecord grid = random_grid(random, 2048, 1);
    SmallPacket packet{};
    random_packet(random, grid, packet);
    Rays waiting = all_waiting();
    Frustum frustum;
    while (take_pass<TypeParam>(grid, waiting, packet, frustum, pass_work)) {
      const std::vector<CellSpan> slabs = slabs_of(random, frustum);
      for (const CellSpan& slices : slabs) {
        // Hits at about the slab's entry: nearer or farther by anything from the last digit to 1 in 256.
        const float entry = frustum.slab_of(slices.first, slices.last).entry;
        const float off = std::ldexp(random.between(-1, 1), -8 - static_cast<int>(random.below(17)));
        for (std::uint32_t ray = 0; ray < kRays; ++ray) {
          const float march = std::fabs(packet.dir[frustum.axis_k][ray]) * grid.cells_per_unit[frustum.axis_k];
          const float t = entry / march * (1.0f + off);
          packet.t[ray] = t > 0.0f && t < kFloatMax ? t : 1.0f;
        }
        const float reach = reach_of<TypeParam>(packet);
        const bool beyond = frustum.beyond(frustum.slab_of(slices.first, slices.last), reach);
        bool any = false;
        for (std::uint32_t ray = 0; ray < kRays; ++ray) {
          if (!packet.active.contains(ray)) continue;
          const bool reached =
              ExactRay(grid, packet, ray).reaches(frustum.axis_k, slices.first, slices.last, packet.t[ray]);
          any = any || reached;
          ASSERT_FALSE(reached && beyond) << "ray " << ray << ", slice " << slices.first;
        }
        near_the_limit += any ? 1u : 0u;
      }
    }
  });
  if (!all_seeds_run()) return;
  EXPECT_GT(near_the_limit, 1000u);
}

TEST(Frustum, BeyondIsBeyond) {
  // A frustum that never says "beyond" would pass the tests above.
  const GridRecord grid = unit_grid(100);
  SmallPacket packet{};
  for (std::uint32_t ray = 0; ray < kRays; ++ray) set_direction(packet, ray, 0.1f, 0.0f, -2.0f);
  packet.origin[0] = packet.origin[1] = packet.origin[2] = 50.5f;
  for (float& t : packet.t) t = 5.0f;  // to z = 40.5
  Rays waiting = all_waiting();
  Frustum frustum;
  ASSERT_TRUE(take_pass<Lanes<4>>(grid, waiting, packet, frustum, pass_work));
  const float reach = reach_of<Lanes<4>>(packet);
  EXPECT_EQ(reach, 10.0f * (1.0f + 2.0f * kEstimateError));  // t may be an estimate
  EXPECT_FALSE(frustum.beyond(frustum.slab_of(40, 40), reach));
  EXPECT_TRUE(frustum.beyond(frustum.slab_of(39, 39), reach));
  EXPECT_FALSE(frustum.behind(frustum.slab_of(50, 50)));
  EXPECT_TRUE(frustum.behind(frustum.slab_of(51, 51)));
  // x from 50.675 to 50.725
  EXPECT_EQ(ends_of(frustum.rect_of(frustum.slab_of(46, 46))), (std::array{50, 50, 50, 50}));
}

TEST(Frustum, RaysInACellFaceTouchBothSides) {
  const GridRecord grid = unit_grid(16);
  SmallPacket packet{};
  for (std::uint32_t ray = 0; ray < kRays; ++ray) set_direction(packet, ray, 1.0f, ray % 2 == 0 ? 0.0f : -0.0f, 0.0f);
  packet.origin[0] = -1.0f;
  packet.origin[1] = 3.0f;
  packet.origin[2] = 7.0f;
  Rays waiting = all_waiting();
  Frustum frustum;
  ASSERT_TRUE(take_pass<Lanes<4>>(grid, waiting, packet, frustum, pass_work));
  for (std::int32_t k = 0; k < 16; ++k) {
    EXPECT_EQ(ends_of(frustum.rect_of(frustum.slab_of(k, k))), (std::array{2, 3, 6, 7}));
  }
}

TEST(Frustum, RaysBesideTheGridTouchNothing) {
  const GridRecord grid = unit_grid(16);
  for (const float y : {-0.5f, 16.5f, 1e6f, -1e6f}) {
    SmallPacket packet{};
    for (std::uint32_t ray = 0; ray < kRays; ++ray) set_direction(packet, ray, 1.0f, 0.0f, 0.0f);
    packet.origin[0] = -1.0f;
    packet.origin[1] = y;
    packet.origin[2] = 8.0f;
    Rays waiting = all_waiting();
    Frustum frustum;
    ASSERT_TRUE(take_pass<Lanes<4>>(grid, waiting, packet, frustum, pass_work));
    for (std::int32_t k = 0; k < 16; ++k) EXPECT_TRUE(frustum.rect_of(frustum.slab_of(k, k)).empty()) << y;
  }
}

}  // namespace
}  // namespace gridiron::test
