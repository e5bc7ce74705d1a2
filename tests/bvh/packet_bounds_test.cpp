// A packet's bounds leave out no box that one of its rays meets. SPDX-License-Identifier: Apache-2.0
#include <gridiron/bvh/packet_bounds.h>
#include <gridiron/ray/camera.h>

#include "support/test_mesh.h"

namespace gridiron::bvh {
namespace {

/// A frame by its camera vectors alone.
FrameRecord make_frame(test::TestRandom& random, float eye_distance, bool along_an_axis) {
  FrameRecord frame{};
  frame.width = frame.height = 64;
  frame.t_far = kFloatMax;
  double forward[3], side[3], up[3];
  const double quarter = 1.5707963267948966;
  const double angle = along_an_axis ? quarter * random.below(4) : 4 * quarter * random.unit();
  const double tilt = along_an_axis ? 0.0 : random.between(-1.5f, 1.5f);
  forward[0] = std::cos(angle) * std::cos(tilt);
  forward[1] = std::sin(tilt);
  forward[2] = std::sin(angle) * std::cos(tilt);
  side[0] = -std::sin(angle);
  side[1] = 0;
  side[2] = std::cos(angle);
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    up[i] = side[j] * forward[k] - side[k] * forward[j];
  }
  const double half = random.between(0.02f, 1.2f), pixel = 2 * half / 64;
  for (int i = 0; i < 3; ++i) {
    frame.eye[i] = static_cast<float>(-eye_distance * forward[i] + random.between(-0.2f, 0.2f));
    frame.corner[i] = static_cast<float>(forward[i] - half * side[i] + half * up[i]);
    frame.step_x[i] = static_cast<float>(pixel * side[i]);
    frame.step_y[i] = static_cast<float>(-pixel * up[i]);
  }
  return frame;
}

/// A frame that looks along -z from the origin: pixels of 0.01, from (x, y) on to the right and down.
FrameRecord frame_along_z(float x, float y) {
  FrameRecord frame{};
  frame.width = frame.height = 64;
  frame.t_far = kFloatMax;
  const float corner[3] = {x, y, -1.0f};
  std::copy(corner, corner + 3, frame.corner);
  frame.step_x[0] = 0.01f;
  frame.step_y[1] = -0.01f;
  return frame;
}

/// First t >= 0 at which a ray is in a box, in double; infinity where it never is.
double entry_of(const float origin[3], const double dir[3], const float low[3], const float high[3]) {
  double entry = 0, exit = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    const double a = (double{low[axis]} - origin[axis]) / dir[axis];
    const double b = (double{high[axis]} - origin[axis]) / dir[axis];
    entry = std::max(entry, std::min(a, b));
    exit = std::min(exit, std::max(a, b));
  }
  return entry <= exit ? entry : std::numeric_limits<double>::infinity();
}

std::uint32_t missed_of(const ChildrenMet& met, std::uint32_t child) {
  return met.missed.word(child);
}

ChildrenMet children_met(const auto& bounds, const BvhNode& node, const float* origin, const float* reach) {
  return bounds.is_mixed != 0 ? bounds.template children_met<true>(node, origin, reach)
                              : bounds.template children_met<false>(node, origin, reach);
}

struct Tally {
  std::uint32_t met = 0, left_out = 0, kept_in_vain = 0, mixed = 0;
};

// Every quarter of a packet whose rays meet a box has it, with an entry that is not behind theirs.
template <std::uint32_t Width>
void expect_boxes_met(Tally& tally) {
  constexpr std::uint32_t kRays = Width * Width;
  const auto packet = std::make_unique<Packet<Width>>();
  const auto bounds = std::make_unique<PacketBounds<Width>>();
  WorkCounters work;
  alignas(16) const float reach[kQuarterCount] = {kFloatMax, kFloatMax, kFloatMax, kFloatMax};
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    test::TestRandom random(seed);
    const float scale = seed % 3 == 0 ? 1e4f : 1.0f;
    const FrameRecord frame = make_frame(random, seed % 2 == 0 ? 0.0f : 3.0f, seed % 5 == 0);
    const std::uint32_t left = Width * random.below(64 / Width), top = Width * random.below(64 / Width);
    generate_packet<Lanes<4>>(frame, left, top, *packet, packet->active, work);
    bounds->set(frame, left, top, 0x1p-28f, work);
    tally.mixed += bounds->is_mixed;
    for (int trial = 0; trial < 20; ++trial) {
      // Boxes hung on a ray's point, so that the ray meets a corner, an edge, a face or the middle; flat ones too.
      BvhNode node{};
      node.child_count = kNodeWidth;
      for (std::uint32_t child = 0; child < kNodeWidth; ++child) {
        const std::uint32_t ray = random.below(kRays);
        const float t = scale * random.between(0.0f, 1.5f);
        for (int axis = 0; axis < 3; ++axis) {
          const float point = packet->origin[axis] + t * packet->dir[axis][ray];
          const float size = scale * (random.below(4) == 0 ? 0.5f : 0.02f) * random.unit();
          const float part = 0.5f * static_cast<float>(random.below(3));
          const bool flat = random.below(5) == 0;
          node.bounds[0][axis][child] = flat ? point : point - part * size;
          node.bounds[1][axis][child] = flat ? point : point + (1 - part) * size;
        }
      }
      const ChildrenMet met = children_met(*bounds, node, packet->origin, reach);
      for (std::uint32_t child = 0; child < kNodeWidth; ++child) {
        float low[3], high[3];
        for (int axis = 0; axis < 3; ++axis) {
          low[axis] = node.bounds[0][axis][child];
          high[axis] = node.bounds[1][axis][child];
        }
        std::uint32_t hit = 0;
        double nearest = std::numeric_limits<double>::infinity();
        for (std::uint32_t ray = 0; ray < kRays; ++ray) {
          const double dir[3] = {packet->dir[0][ray], packet->dir[1][ray], packet->dir[2][ray]};
          const double at = entry_of(packet->origin, dir, low, high);
          if (at < std::numeric_limits<double>::infinity()) hit |= 1u << (ray / (kRays / kQuarterCount));
          nearest = std::min(nearest, at);
        }
        const std::uint32_t missed = missed_of(met, child);
        ASSERT_EQ(hit & missed, 0u) << "width " << Width << ", seed " << seed << ", trial " << trial;
        if (hit != 0) {
          ASSERT_LE(met.entry.v[child], nearest) << "width " << Width << ", seed " << seed << ", trial " << trial;
        }
        tally.met += count_bits(hit);
        tally.left_out += count_bits(missed);
        tally.kept_in_vain += count_bits(~missed & ~hit & kAllQuarters);
      }
    }
  }
}

TEST(PacketBounds, BoxesThatARayMeetsAreMet) {
  Tally tally;
  expect_boxes_met<8>(tally);
  expect_boxes_met<16>(tally);
  expect_boxes_met<32>(tally);
  EXPECT_GT(tally.met, 20000u);
  EXPECT_GT(tally.mixed, 30u);
  EXPECT_GT(tally.left_out, 3 * tally.kept_in_vain);
}

TEST(PacketBounds, BoxesBesideBehindAndBeyondAreLeftOut) {
  // The packet's rays lie within 0.01..0.09 of the axis on either side. Quarters are
  // right and left of 0.05, above and below it.
  const FrameRecord frame = frame_along_z(0.01f, 0.09f);
  const auto bounds = std::make_unique<PacketBounds<8>>();
  WorkCounters work;
  bounds->set(frame, 0, 0, 0x1p-28f, work);
  EXPECT_EQ(bounds->is_mixed, 0u);
  struct Case {
    float low[3], high[3];
    std::uint32_t missed;
  };
  const Case cases[8] = {
      {{0.02f, 0.03f, -1.1f}, {0.08f, 0.08f, -1.0f}, 0b0000},      // in front
      {{0.02f, 0.03f, 1.0f}, {0.08f, 0.08f, 1.1f}, 0b1111},        // behind
      {{0.2f, 0.03f, -1.1f}, {0.3f, 0.05f, -1.0f}, 0b1111},        // right
      {{0.02f, -0.3f, -1.1f}, {0.05f, -0.1f, -1.0f}, 0b1111},      // below
      {{-1.9f, 0.03f, -1.1f}, {-0.1f, 0.05f, -1.0f}, 0b1111},      // left
      {{0.02f, 0.065f, -1.01f}, {0.035f, 0.08f, -1.0f}, 0b1110},   // in the first quarter alone
      {{0.065f, 0.025f, -1.01f}, {0.07f, 0.035f, -1.0f}, 0b0111},  // in the last
      {{0.01f, 0.01f, -0.5f}, {0.045f, 0.045f, -0.49f}, 0b0000},   // nearer
  };
  for (int half = 0; half < 2; ++half) {
    BvhNode node{};
    node.child_count = 4;
    for (int child = 0; child < 4; ++child) {
      for (int axis = 0; axis < 3; ++axis) {
        node.bounds[0][axis][child] = cases[4 * half + child].low[axis];
        node.bounds[1][axis][child] = cases[4 * half + child].high[axis];
      }
    }
    alignas(16) float reach[kQuarterCount] = {kFloatMax, kFloatMax, kFloatMax, kFloatMax};
    const ChildrenMet met = bounds->children_met<false>(node, frame.eye, reach);
    for (std::uint32_t child = 0; child < 4; ++child) {
      const std::uint32_t missed = cases[4 * half + static_cast<int>(child)].missed;
      EXPECT_EQ(missed_of(met, child), missed) << "half " << half << ", child " << child;
      EXPECT_EQ(met.none.bits() >> child & 1u, missed == kAllQuarters ? 1u : 0u);
    }
    // Two quarters have hit something nearer than all but the last box.
    reach[0] = reach[2] = 0.7f;
    const ChildrenMet behind = bounds->children_met<false>(node, frame.eye, reach);
    for (std::uint32_t child = 0; child < 4; ++child) {
      const bool is_nearer = half == 1 && child == 3;
      EXPECT_EQ(missed_of(behind, child), cases[4 * half + static_cast<int>(child)].missed | (is_nearer ? 0 : 0b0101));
    }
    // Children that are not there are not met.
    node.children[2].bits = BvhChild::kNone;
    EXPECT_EQ(missed_of(bounds->children_met<false>(node, frame.eye, reach), 2), kAllQuarters);
  }
}

// Rays to all sides of two axes: nothing is said of leaving, and still boxes behind and far to a side are left out.
TEST(PacketBounds, MixedPacketsLeaveOutWhatLiesBehindOrFarBeside) {
  const FrameRecord frame = frame_along_z(-0.075f, 0.075f);
  const auto bounds = std::make_unique<PacketBounds<16>>();
  WorkCounters work;
  bounds->set(frame, 0, 0, 0x1p-28f, work);
  ASSERT_EQ(bounds->is_mixed, 1u);
  const float boxes[4][2][3] = {{{-0.01f, -0.01f, -1.1f}, {0.01f, 0.01f, -1.0f}},
                                {{-0.01f, -0.01f, 1.0f}, {0.01f, 0.01f, 1.1f}},
                                {{0.5f, -0.01f, -1.1f}, {0.6f, 0.01f, -1.0f}},
                                {{-0.6f, -0.01f, -1.1f}, {-0.5f, 0.01f, -1.0f}}};
  BvhNode node{};
  for (int child = 0; child < 4; ++child) {
    for (int side = 0; side < 2; ++side) {
      for (int axis = 0; axis < 3; ++axis) node.bounds[side][axis][child] = boxes[child][side][axis];
    }
  }
  alignas(16) const float reach[kQuarterCount] = {kFloatMax, kFloatMax, kFloatMax, kFloatMax};
  const ChildrenMet met = bounds->children_met<true>(node, frame.eye, reach);
  EXPECT_EQ(met.none.bits(), 0b1110u);
  EXPECT_EQ(missed_of(met, 0), 0u);
}

}  // namespace
}  // namespace gridiron::bvh
