// A packet's bounds leave out no box that one of its rays meets. SPDX-License-Identifier: Apache-2.0
#include <gridiron/render/camera.h>
#include <gridiron/rival/packet_bounds.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "support/test_mesh.h"

namespace gridiron::rival {
namespace {

using TestPacket = Packet<8>;
using Bounds = PacketBounds<8>;

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

TEST(PacketBounds, BoxesThatARayMeetsAreMet) {
  const auto packet = std::make_unique<TestPacket>();
  const auto bounds = std::make_unique<Bounds>();
  WorkCounters work;
  std::uint32_t met_boxes = 0, left_out = 0, kept_in_vain = 0;
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    test::TestRandom random(seed);
    const float scale = seed % 3 == 0 ? 1e4f : 1.0f;
    const FrameRecord frame = make_frame(random, seed % 2 == 0 ? 0.0f : 3.0f, seed % 5 == 0);
    RaySet<64> present;
    generate_packet<Lanes<4>>(frame, 8 * random.below(8), 8 * random.below(8), *packet, present, work);
    packet->active = present;
    const float low[3] = {-2 * scale, -2 * scale, -2 * scale}, high[3] = {2 * scale, 2 * scale, 2 * scale};
    bounds->set<Lanes<4>>(*packet, extent_of(low, high, frame.eye), 4.0f, true);
    for (int trial = 0; trial < 50; ++trial) {
      // Boxes hung on a ray's point, so that the ray meets a corner, an edge, a face or the middle; flat ones too.
      BvhNode node{};
      node.child_count = kNodeWidth;
      for (std::uint32_t child = 0; child < kNodeWidth; ++child) {
        const std::uint32_t ray = random.below(64);
        const float t = scale * random.between(0.0f, 1.5f);
        for (int axis = 0; axis < 3; ++axis) {
          const float point = packet->origin[axis] + t * packet->dir[axis][ray];
          const float size = scale * (random.below(4) == 0 ? 0.5f : 0.02f) * random.unit();
          const float part = 0.5f * static_cast<float>(random.below(3));
          const bool flat = random.below(5) == 0;
          const float a = flat ? point : point - part * size, b = flat ? point : point + (1 - part) * size;
          node.bounds[0][axis][child] = std::clamp(std::min(a, b), low[axis], high[axis]);
          node.bounds[1][axis][child] = std::clamp(std::max(a, b), low[axis], high[axis]);
        }
      }
      alignas(16) float entry[kNodeWidth];
      const std::uint32_t met = bounds->children_met(node, kFloatMax, entry);
      for (std::uint32_t child = 0; child < kNodeWidth; ++child) {
        float child_low[3], child_high[3];
        for (int axis = 0; axis < 3; ++axis) {
          child_low[axis] = node.bounds[0][axis][child];
          child_high[axis] = node.bounds[1][axis][child];
        }
        std::uint32_t first_met = 64;
        double nearest = std::numeric_limits<double>::infinity();
        for (std::uint32_t ray = 0; ray < 64; ++ray) {
          const double dir[3] = {packet->dir[0][ray], packet->dir[1][ray], packet->dir[2][ray]};
          const double at = entry_of(packet->origin, dir, child_low, child_high);
          if (at < std::numeric_limits<double>::infinity()) first_met = std::min(first_met, ray);
          nearest = std::min(nearest, at);
        }
        const bool is_met = (met >> child & 1u) != 0;
        std::uint32_t tested = 0;
        const std::uint32_t group = bounds->first_group_met<Lanes<4>>(*packet, node, child, 0, tested);
        if (first_met < 64) {
          ++met_boxes;
          ASSERT_TRUE(is_met) << "seed " << seed << ", trial " << trial << ", child " << child;
          ASSERT_LE(entry[child], nearest) << "seed " << seed << ", trial " << trial << ", child " << child;
          ASSERT_LE(group, first_met / 4) << "seed " << seed << ", trial " << trial << ", child " << child;
        } else {
          ++(is_met ? kept_in_vain : left_out);
        }
      }
    }
  }
  EXPECT_GT(met_boxes, 30000u);
  static_cast<void>(left_out + kept_in_vain);
}

TEST(PacketBounds, BoxesBesideBehindAndBeyondAreLeftOut) {
  test::TestRandom random(7);
  FrameRecord frame{};
  frame.width = frame.height = 64;
  frame.t_far = kFloatMax;
  // Looks along -z from the origin; the packet's rays lie within 0.01..0.09 of the axis on either side.
  const float corner[3] = {0.01f, 0.09f, -1.0f};
  for (int axis = 0; axis < 3; ++axis) frame.corner[axis] = corner[axis];
  frame.step_x[0] = 0.01f;
  frame.step_y[1] = -0.01f;
  const auto packet = std::make_unique<TestPacket>();
  const auto bounds = std::make_unique<Bounds>();
  WorkCounters work;
  RaySet<64> present;
  generate_packet<Lanes<4>>(frame, 0, 0, *packet, present, work);
  packet->active = present;
  const float low[3] = {-2, -2, -2}, high[3] = {2, 2, 2};
  bounds->set<Lanes<4>>(*packet, extent_of(low, high, frame.eye), 2.0f, true);
  const float boxes[8][2][3] = {
      {{0.02f, 0.03f, -1.1f}, {0.05f, 0.05f, -1.0f}},     // in front
      {{0.02f, 0.03f, 1.0f}, {0.05f, 0.05f, 1.1f}},       // behind
      {{0.2f, 0.03f, -1.1f}, {0.3f, 0.05f, -1.0f}},       // right
      {{0.02f, -0.3f, -1.1f}, {0.05f, -0.1f, -1.0f}},     // below
      {{-1.9f, 0.03f, -1.1f}, {-0.1f, 0.05f, -1.0f}},     // left
      {{-1.9f, -0.1f, -1.5f}, {1.9f, -0.01f, -0.1f}},     // a plate below, wider than the packet
      {{0.02f, 0.03f, -0.6f}, {0.05f, 0.05f, -0.5f}},     // nearer
      {{0.0285f, 0.0385f, -1.0f}, {0.0286f, 0.0386f, -1.0f}},  // between the rays
  };
  for (int half = 0; half < 2; ++half) {
    BvhNode node{};
    node.child_count = 4;
    for (int child = 0; child < 4; ++child) {
      for (int side = 0; side < 2; ++side) {
        for (int axis = 0; axis < 3; ++axis) node.bounds[side][axis][child] = boxes[4 * half + child][side][axis];
      }
    }
    alignas(16) float entry[kNodeWidth];
    EXPECT_EQ(bounds->children_met(node, kFloatMax, entry), half == 0 ? 0b0001u : 0b1100u);
    EXPECT_EQ(bounds->children_met(node, 0.7f, entry), half == 0 ? 0u : 0b0100u);
    std::uint32_t tested = 0;
    EXPECT_EQ(bounds->first_group_met<Lanes<4>>(*packet, node, 3, 0, tested), 16u);
    EXPECT_EQ(tested, 16u);
  }
}

}  // namespace
}  // namespace gridiron::rival
