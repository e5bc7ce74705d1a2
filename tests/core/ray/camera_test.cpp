// Packet generation: the rays of the pixels, those that exist, and corners that bound them.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/ray/camera.h>

#include "core/seeds.h"
#include "support/test_mesh.h"

namespace gridiron::test {
namespace {

TEST(Camera, RaysGoThroughThePixelsOfThePicture) {
  using WidePacket = Packet<8>;
  for_each_seed(300, [&](TestRandom& random) {
    FrameRecord frame{};
    frame.width = 1 + random.below(100);
    frame.height = 1 + random.below(100);
    frame.t_far = random.between(1, 10);
    for (int axis = 0; axis < 3; ++axis) {
      frame.eye[axis] = random.between(-5, 5);
      frame.corner[axis] = random.between(-1, 1);
      frame.step_x[axis] = random.between(-0.02f, 0.02f);
      frame.step_y[axis] = random.between(-0.02f, 0.02f);
    }
    const std::uint32_t left = random.below((frame.width + 7) / 8) * 8;
    const std::uint32_t top = random.below((frame.height + 7) / 8) * 8;
    WidePacket packet{};
    RaySet<64> present;
    WorkCounters work;
    generate_packet<Lanes<4>>(frame, left, top, packet, present, work);
    EXPECT_EQ(work[Work::kRayGenerated], 16u);
    for (std::uint32_t ray = 0; ray < 64; ++ray) {
      const std::uint32_t x = left + WidePacket::column_of(ray);
      const std::uint32_t y = top + WidePacket::row_of(ray);
      ASSERT_EQ(present.contains(ray), x < frame.width && y < frame.height) << "ray " << ray;
      ASSERT_EQ(packet.t[ray], frame.t_far);
      ASSERT_EQ(packet.id[ray], kNoTriangle);
      ASSERT_EQ(packet.facing[ray], 0.0f);
      for (int axis = 0; axis < 3; ++axis) {
        const float across = static_cast<float>(x) * frame.step_x[axis];
        const float down = static_cast<float>(y) * frame.step_y[axis];
        const float expected = (frame.corner[axis] + across) + down;
        ASSERT_EQ(packet.dir[axis][ray], expected) << "ray " << ray;
        // The bounds that culling and the edge filter rely on.
        const auto [least, most] = std::minmax_element(packet.corner_dir[axis], packet.corner_dir[axis] + 4);
        ASSERT_GE(packet.dir[axis][ray], *least) << "ray " << ray;
        ASSERT_LE(packet.dir[axis][ray], *most) << "ray " << ray;
        ASSERT_LE(magnitude(packet.dir[axis][ray]), packet.dir_max);
      }
    }
    for (int axis = 0; axis < 3; ++axis) {
      ASSERT_EQ(packet.origin[axis], frame.eye[axis]);
      ASSERT_EQ(packet.corner_dir[axis][0], packet.dir[axis][0]);
      for (std::uint32_t ray = 0; ray < 64; ++ray) {
        const std::uint32_t column = WidePacket::column_of(ray), row = WidePacket::row_of(ray);
        if (column % 7 != 0 || row % 7 != 0) continue;
        ASSERT_EQ(packet.corner_dir[axis][column / 7 + 2 * (row / 7)], packet.dir[axis][ray]);
      }
      ASSERT_EQ(packet.first_dir[axis], packet.dir[axis][0]);
      ASSERT_EQ(packet.step_x[axis], frame.step_x[axis]);
      ASSERT_EQ(packet.step_y[axis], frame.step_y[axis]);
    }
    ASSERT_GE(packet.range_factor, packet.dir_max);
    ASSERT_GE(packet.range_factor, 1.0f);
    float bound = 0.0f;
    for (int axis = 0; axis < 3; ++axis) {
      bound = std::fmax(bound, std::fabs(frame.corner[axis]) +
                                   static_cast<float>(left + 7) * std::fabs(frame.step_x[axis]) +
                                   static_cast<float>(top + 7) * std::fabs(frame.step_y[axis]));
    }
    ASSERT_FLOAT_EQ(packet.linear_error, kLinearError * bound);
    ASSERT_GT(packet.corner_widening, 1.0f);
    ASSERT_GT(packet.subpacket_widening, packet.corner_widening);
  });
}

}  // namespace
}  // namespace gridiron::test
