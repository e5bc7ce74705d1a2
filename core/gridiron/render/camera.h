// Primary rays of a packet: from the frame's eye through the centres of a square of pixels.
// Memory: inside the local store. Threads: one core. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/lanes.h>
#include <gridiron/base/records.h>
#include <gridiron/base/work_counters.h>
#include <gridiron/ray/intersect_standard.h>
#include <gridiron/ray/packet.h>

#include <cstdint>

namespace gridiron {

/// Direction of the ray through the centre of pixel (x, y): every operation rounded to float, in this order.
[[nodiscard]] GRIDIRON_INLINE float pixel_direction(const FrameRecord& frame, int axis, float x, float y) {
  return (frame.corner[axis] + x * frame.step_x[axis]) + y * frame.step_y[axis];
}

/// Generates the rays of the packet whose first pixel is (left, top).
///
/// @param present  out: the rays whose pixels lie in the picture.
/// The corner rays bound all others: each operation above is monotone in x and y, rounding included, so every
/// component lies between the corners'; corner_widening covers what rounding moves a ray out of their hull.
template <class L, class PacketType>
void generate_packet(const FrameRecord& frame, std::uint32_t left, std::uint32_t top, PacketType& packet,
                     RaySet<PacketType::kRayCount>& present, WorkCounters& work) {
  constexpr std::uint32_t kWidth = PacketType::kWidth;
  work.add(Work::kRayGenerated, PacketType::kRayCount / L::kCount);
  const float x0 = static_cast<float>(left);
  const float y0 = static_cast<float>(top);
  for (int axis = 0; axis < 3; ++axis) {
    packet.origin[axis] = frame.eye[axis];
    for (std::uint32_t y = 0; y < kWidth; ++y) {
      for (std::uint32_t x = 0; x < kWidth; ++x) {
        packet.dir[axis][y * kWidth + x] =
            pixel_direction(frame, axis, x0 + static_cast<float>(x), y0 + static_cast<float>(y));
      }
    }
  }
  for (std::uint32_t ray = 0; ray < PacketType::kRayCount; ++ray) {
    packet.t[ray] = frame.t_far;
    packet.id[ray] = kNoTriangle;
    packet.facing[ray] = 0.0f;
  }
  present.clear();
  const std::uint32_t columns = frame.width - left < kWidth ? frame.width - left : kWidth;
  const std::uint32_t rows = frame.height - top < kWidth ? frame.height - top : kWidth;
  for (std::uint32_t y = 0; y < rows; ++y) {
    for (std::uint32_t x = 0; x < columns; ++x) present.insert(y * kWidth + x);
  }

  constexpr float kLast = static_cast<float>(kWidth - 1);
  float dir_max = 0.0f;
  float dir_bound = 0.0f;
  for (int axis = 0; axis < 3; ++axis) {
    for (int corner = 0; corner < 4; ++corner) {
      const float x = x0 + ((corner & 1) != 0 ? kLast : 0.0f);
      const float y = y0 + ((corner & 2) != 0 ? kLast : 0.0f);
      const float value = pixel_direction(frame, axis, x, y);
      packet.corner_dir[axis][corner] = value;
      dir_max = magnitude(value) > dir_max ? magnitude(value) : dir_max;
    }
    const float bound = magnitude(frame.corner[axis]) + (x0 + kLast) * magnitude(frame.step_x[axis]) +
                        (y0 + kLast) * magnitude(frame.step_y[axis]);
    dir_bound = bound > dir_bound ? bound : dir_bound;
  }
  packet.dir_max = dir_max;
  packet.range_factor = dir_max > 1.0f ? dir_max : 1.0f;
  packet.corner_widening = 1.0f + kCornerErrorFactor / kEdgeErrorFactor * (dir_bound / dir_max);
}

}  // namespace gridiron
