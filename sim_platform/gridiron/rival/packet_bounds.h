// What a packet can touch: four planes around it, the nearest way along each axis, and reciprocals of its rays.
// Source: Wald, Boulos, Shirley 2007, section 3 (frustum test, first active ray). Memory: inside the local store.
// Threads: one core. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/lanes.h>
#include <gridiron/base/math.h>
#include <gridiron/base/records.h>
#include <gridiron/ray/packet.h>
#include <gridiron/rival/bvh_node.h>
#include <gridiron/rival/rival_work.h>

#include <cstdint>

namespace gridiron::rival {

/// Extents of the scene as seen from the eye, for bounds of rounding. Largest components.
struct SceneExtent {
  float coordinate;  ///< |p| of any point of the scene, plus |eye|
  float distance;    ///< |p - eye|
};

[[nodiscard]] inline SceneExtent extent_of(const float low[3], const float high[3], const float eye[3]) {
  const auto larger = [](float a, float b) { return a > b ? a : b; };
  SceneExtent extent{0.0f, 0.0f};
  float point = 0.0f, origin = 0.0f;
  for (int axis = 0; axis < 3; ++axis) {
    point = larger(point, larger(magnitude(low[axis]), magnitude(high[axis])));
    origin = larger(origin, magnitude(eye[axis]));
    extent.distance = larger(extent.distance, magnitude(low[axis] - eye[axis]));
    extent.distance = larger(extent.distance, magnitude(high[axis] - eye[axis]));
  }
  extent.coordinate = point + origin;
  return extent;
}

/// Conservative bound of a packet of primary rays, held against boxes.
///
/// Planes: with c the direction at a corner of the packet and s a pixel step, n = c x s is the plane through one side
/// of the packet. With e = 2^-23, D the largest sum of magnitudes that goes into a direction's component, S the largest
/// |component| of a step: a component of n carries 4 e D S; a direction differs from the linear form of its pixel by
/// less than 6 e D, from that seen from another corner by 12 e D. So n . d >= -(3 * 2 D S * 12 e D + 3 D * 4 e D S) =
/// -84 e D^2 S for every ray. A direction is at least 1 long, its largest component above 0.57; a ray reaches a point
/// of the scene at t < 1.76 R, R the extent from the eye: there n . (p - o) >= -148 e D^2 S R. The sum n . p - n . o
/// of magnitudes below 6 D S (P + O) has less than 5 roundings: 30 e D S (P + O). A plane is passed on the outside
/// where the sum is below -e S D (160 D R + 32 (P + O)).
///
/// Ways: along each axis on which all rays run the same way, t >= (near_k - o_k) / max |d_k| and, where a box is not
/// behind the eye, t <= (far_k - o_k) / min |d_k|, give or take 4 roundings of magnitudes below P + O.
template <std::uint32_t Width>
struct alignas(128) PacketBounds {
  using StorePacket = Packet<Width>;
  static constexpr float kRayFactor = 0x1p-20f;  ///< covers the 4 roundings of a ray's distance to a plane

  float plane[4][4];               ///< n and the constant: outside where n . p + constant < 0
  std::uint32_t plane_side[4][3];  ///< bound that is farthest along n: 0 low, 1 high
  float entry_scale[3];            ///< t >= near_k * scale + offset
  float entry_offset[3];
  float exit_scale[3];             ///< t <= far_k * scale + offset
  float exit_offset[3];
  std::uint32_t near_side[3];      ///< bound that the rays meet first
  float far_bias[3];               ///< 0, or kFloatMax on an axis that says nothing about single rays
  alignas(64) float reciprocal[3][StorePacket::kRayCount];  ///< 1 / direction; 0 on such an axis

  /// @param dir_bound  D of the frame. @param ray_tests  whether the reciprocals are wanted.
  template <class L>
  void set(const StorePacket& packet, const SceneExtent& extent, float dir_bound, bool ray_tests) {
    set_planes(packet, extent, dir_bound);
    constexpr float kUnit = 0x1p-23f;
    for (int axis = 0; axis < 3; ++axis) {
      float low = packet.corner_dir[axis][0], high = low;
      for (int corner = 1; corner < 4; ++corner) {
        const float value = packet.corner_dir[axis][corner];
        low = value < low ? value : low;
        high = value > high ? value : high;
      }
      const float least = low > 0.0f ? low : high < 0.0f ? -high : 0.0f;
      const float largest = high < 0.0f ? -low : high;
      near_side[axis] = high < 0.0f ? 1u : 0u;
      entry_scale[axis] = entry_offset[axis] = exit_scale[axis] = 0.0f;
      exit_offset[axis] = kFloatMax;
      if (least > 0x1p-30f * dir_bound) {
        const float sign = high < 0.0f ? -1.0f : 1.0f;
        const float slowest = (1.0f - 4.0f * kUnit) / largest;
        const float fastest = (1.0f + 4.0f * kUnit) / least;
        const float slack = 8.0f * kUnit * extent.coordinate;
        entry_scale[axis] = sign * slowest;
        entry_offset[axis] = -(packet.origin[axis] * entry_scale[axis]) - slack * slowest;
        exit_scale[axis] = sign * fastest;
        exit_offset[axis] = slack * fastest - packet.origin[axis] * exit_scale[axis];
      }
      if (!ray_tests) continue;
      const bool usable = least > 0x1p-30f * dir_bound;
      far_bias[axis] = usable ? 0.0f : kFloatMax;
      using Float = typename L::Float;
      for (std::uint32_t base = 0; base < StorePacket::kRayCount; base += L::kCount) {
        const Float value = usable ? Float(1.0f) / Float::load(packet.dir[axis] + base) : Float(0.0f);
        value.store(reciprocal[axis] + base);
      }
    }
  }

  /// Holds the children of a node against the packet. @param reach  the farthest hit that is still of interest.
  /// @param entry  out: per child, a bound of t below which no ray meets it. @returns the children that may be met.
  [[nodiscard]] std::uint32_t children_met(const BvhNode& node, float reach, float entry[kNodeWidth]) const {
    using Float = Lanes<4>::Float;
    std::uint32_t outside = 0;
    for (int i = 0; i < 4; ++i) {
      const Float x = Float(plane[i][0]) * Float::load(node.bounds[plane_side[i][0]][0]);
      const Float y = Float(plane[i][1]) * Float::load(node.bounds[plane_side[i][1]][1]);
      const Float z = Float(plane[i][2]) * Float::load(node.bounds[plane_side[i][2]][2]);
      outside |= (x + y + z + Float(plane[i][3]) < Float(0.0f)).bits();
    }
    Float nearest(0.0f), farthest(reach);
    for (int axis = 0; axis < 3; ++axis) {
      const Float way_in = Float(entry_scale[axis]) * Float::load(node.bounds[near_side[axis]][axis]);
      nearest = Lanes<4>::max(nearest, way_in + Float(entry_offset[axis]));
      const Float way_out = Float(exit_scale[axis]) * Float::load(node.bounds[1u - near_side[axis]][axis]);
      farthest = Lanes<4>::min(farthest, way_out + Float(exit_offset[axis]));
    }
    nearest.store(entry);
    return ~outside & (nearest <= farthest).bits() & ((1u << node.child_count) - 1u);
  }

  /// @returns the first group of rays, from `first_group` on, of which one meets the box before its nearest hit;
  /// kGroupCount where none does. @param tested  out: groups that were looked at.
  template <class L>
  [[nodiscard]] std::uint32_t first_group_met(const StorePacket& packet, const BvhNode& node, std::uint32_t child,
                                              std::uint32_t first_group, std::uint32_t& tested,
                                              WorkCounters& work) const {
    using Float = typename L::Float;
    float near[3], far[3];
    for (int axis = 0; axis < 3; ++axis) {
      near[axis] = node.bounds[near_side[axis]][axis][child] - packet.origin[axis];
      far[axis] = node.bounds[1u - near_side[axis]][axis][child] - packet.origin[axis];
    }
    tested = 0;
    for (std::uint32_t group = first_group; group < kGroupCount<L>; ++group) {
      const std::uint32_t base = group * L::kCount;
      const std::uint32_t active = packet.active.template group<L>(base);
      if (active == 0) continue;
      ++tested;
      work.add(carrier_of(RivalWork::kBoxGroup));
      Float entry(0.0f), exit(kFloatMax);
      for (int axis = 0; axis < 3; ++axis) {
        const Float scale = Float::load(reciprocal[axis] + base);
        entry = L::max(entry, Float(near[axis]) * scale);
        exit = L::min(exit, Float(far[axis]) * scale + Float(far_bias[axis]));
      }
      const Float last = L::min(exit + exit * Float(kRayFactor), Float::load(packet.t + base));
      if (((entry - entry * Float(kRayFactor) <= last).bits() & active) != 0) return group;
    }
    return kGroupCount<L>;
  }

  template <class L>
  static constexpr std::uint32_t kGroupCount = StorePacket::kRayCount / L::kCount;

 private:
  void set_planes(const StorePacket& packet, const SceneExtent& extent, float dir_bound) {
    constexpr float kUnit = 0x1p-23f;
    float step_max = 0.0f;
    for (int axis = 0; axis < 3; ++axis) {
      const float x = magnitude(packet.step_x[axis]), y = magnitude(packet.step_y[axis]);
      step_max = x > step_max ? x : step_max;
      step_max = y > step_max ? y : step_max;
    }
    const auto cross = [](const float a[3], const float b[3], float out[3]) {
      out[0] = a[1] * b[2] - a[2] * b[1];
      out[1] = a[2] * b[0] - a[0] * b[2];
      out[2] = a[0] * b[1] - a[1] * b[0];
    };
    // Inside is where column and row grow from the first corner and fall from the others, up to the sign of the volume.
    float normal[3];
    cross(packet.step_x, packet.step_y, normal);
    float volume = 0.0f;
    for (int axis = 0; axis < 3; ++axis) volume += normal[axis] * packet.first_dir[axis];
    const bool sure = magnitude(volume) > 64.0f * kUnit * dir_bound * step_max * step_max;
    const float slack =
        kUnit * step_max * dir_bound * (160.0f * dir_bound * extent.distance + 32.0f * extent.coordinate);
    for (int i = 0; i < 4; ++i) {
      // 0: row 0, d . (c x s_x) grows with the row; 1: the last row; 2: column 0; 3: the last column.
      const int corner_index = i == 0 || i == 2 ? 0 : i == 1 ? 2 : 1;
      const float corner[3] = {packet.corner_dir[0][corner_index], packet.corner_dir[1][corner_index],
                               packet.corner_dir[2][corner_index]};
      if (i < 2) {
        cross(corner, packet.step_x, normal);
      } else {
        cross(packet.step_y, corner, normal);
      }
      const bool flip = (volume < 0.0f) != (i == 1 || i == 3);
      float constant = slack;
      for (int axis = 0; axis < 3; ++axis) {
        const float value = sure ? (flip ? -normal[axis] : normal[axis]) : 0.0f;
        plane[i][axis] = value;
        plane_side[i][axis] = value > 0.0f ? 1u : 0u;
        constant -= value * packet.origin[axis];
      }
      plane[i][3] = constant;
    }
  }
};

}  // namespace gridiron::rival
