// Primary rays of a packet: from the frame's eye through the centres of a square of pixels.
// Memory: inside the local store. Threads: one core. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/lanes.h>
#include <gridiron/base/records.h>
#include <gridiron/base/work_counters.h>
#include <gridiron/ray/edges.h>
#include <gridiron/ray/hits.h>
#include <gridiron/ray/packet.h>
#include <gridiron/ray/pixel_box.h>

#include <cstdint>

namespace gridiron {

/// Column and row of a subpacket's rays in it, in pixels.
struct SubpacketPixels {
  alignas(64) float column[kSubpacketRays];
  alignas(64) float row[kSubpacketRays];
};
inline constexpr SubpacketPixels kSubpacketPixels = [] {
  SubpacketPixels pixels{};
  for (std::uint32_t i = 0; i < kSubpacketRays; ++i) {
    pixels.column[i] = static_cast<float>(i % kSubpacketWidth);
    pixels.row[i] = static_cast<float>(i / kSubpacketWidth);
  }
  return pixels;
}();

/// Generates the rays of the packet whose first pixel is (left, top).
///
/// @param dx, dy   from the pixels' centres to the points that rays go through, in pixels: multiples of 1/32 within a
///                 half.
/// @param present  out: the rays whose pixels lie in the picture. Distances are exact where the frame wants depth.
/// The corner rays bound all others: each operation above is monotone in x and y, rounding included, so every component
/// lies between the corners'; corner_widening covers the distance by which rounding moves a ray out of their hull.
template <class L, class PacketType>
void generate_packet(const FrameHead& frame, std::uint32_t left, std::uint32_t top, PacketType& packet,
                     RaySet<PacketType::kRayCount>& present, WorkCounters& work, float dx = 0.0f, float dy = 0.0f) {
  using Float = typename L::Float;
  static constexpr std::uint32_t kWidth = PacketType::kWidth;
  work.add(Work::kRayPacket);
  const float x0 = static_cast<float>(left) + dx;
  const float y0 = static_cast<float>(top) + dy;
  work.add(Work::kRayGenerated, PacketType::kRayCount / L::kCount);
  for (int axis = 0; axis < 3; ++axis) {
    packet.origin[axis] = frame.eye[axis];
    for (std::uint32_t first = 0; first < PacketType::kRayCount; first += kSubpacketRays) {
      const float column = x0 + static_cast<float>(PacketType::column_of(first));
      const float row = y0 + static_cast<float>(PacketType::row_of(first));
      for (std::uint32_t i = 0; i < kSubpacketRays; i += L::kCount) {
        const Float x = Float(column) + Float::load(kSubpacketPixels.column + i);
        const Float y = Float(row) + Float::load(kSubpacketPixels.row + i);
        pixel_direction(frame, axis, x, y).store(packet.dir[axis] + first + i);
      }
    }
  }
  fill_words(packet.t, frame.t_far);
  fill_words(packet.id, kNoTriangle);
  fill_words(packet.facing, 0.0f);
  work.add(Work::kRecentSlot, PacketType::kRecentCount);
  packet.forget();
  work.add(Work::kRaySetWord, 2 * PacketType::kRayCount / 32);
  packet.unsure.clear();
  present.fill();
  work.charge_to(Work::kRayPacket);
  packet.breaks_ties = frame.accuracy == static_cast<std::uint32_t>(Accuracy::kExact);
  packet.trusts_floats = frame.accuracy == static_cast<std::uint32_t>(Accuracy::kFast);
  packet.choose(frame.depth_address != 0 && !packet.trusts_floats);
  const std::uint32_t columns = frame.width - left;
  const std::uint32_t rows = frame.height - top;
  if (columns < kWidth || rows < kWidth) [[unlikely]] {
    work.charge_to(Work::kRayGenerated);
    present.clear();
    for (std::uint32_t ray = 0; ray < PacketType::kRayCount; ++ray) {
      if (PacketType::column_of(ray) < columns && PacketType::row_of(ray) < rows) present.insert(ray);
    }
    work.charge_to(Work::kRayPacket);
  }

  static constexpr float kLast = static_cast<float>(kWidth - 1);
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
  for (int axis = 0; axis < 3; ++axis) {
    packet.first_dir[axis] = packet.corner_dir[axis][0];
    packet.step_x[axis] = frame.step_x[axis];
    packet.step_y[axis] = frame.step_y[axis];
  }
  if constexpr (PacketType::kHasBoxes) {
    work.add(Work::kPixelProjection);
    set_up_projection(packet, dir_bound);
    work.charge_to(Work::kRayPacket);
  }
  packet.is_linear = true;
  packet.linear_error = kLinearError * dir_bound;
  packet.subpacket_widening = kSubpacketErrorFactor / kEdgeErrorFactor * (dir_bound / dir_max);
}

}  // namespace gridiron
