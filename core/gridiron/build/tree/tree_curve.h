// The Z curve along which triangles are sorted, and the keys that are sorted. Internal header.
// Memory: values. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/lanes.h>
#include <gridiron/build/corner_quad.h>
#include <gridiron/build/tree/tree_box.h>

#include <bit>
#include <cstdint>

namespace gridiron {

inline constexpr std::uint32_t kTreeCodeBits = 30;          ///< ten of an axis
inline constexpr std::uint32_t kTreeCodedAgain = 1u << 31;  ///< of a code that is not one of the whole mesh

/// Equal codes of more triangles are coded again, on a lattice of their own; fewer are split by their number.
inline constexpr std::uint32_t kFewTreeTriangles = 32;

/// One word, so that it is moved as one.
struct TreeKey {
  std::uint64_t bits;

  [[nodiscard]] static TreeKey of(std::uint32_t code, std::uint32_t id) { return {std::uint64_t{id} << 32 | code}; }
  // TreeKeys of triangles first to first + 3.
  static GRIDIRON_INLINE void store_four(Lanes<4>::Int codes, std::uint32_t first, TreeKey* keys) {
    using L = Lanes<4>;
    const L::Int ids = L::Int::splat(first) + words_quad(0, 1, 2, 3);
    const L::Float low = L::shuffle_quads<0, 4, 1, 5>(L::floats_of(codes), L::floats_of(ids));
    const L::Float high = L::shuffle_quads<2, 6, 3, 7>(L::floats_of(codes), L::floats_of(ids));
    store_at(low, keys);
    store_at(high, keys + 2);
  }
  // Along the Z curve.
  [[nodiscard]] std::uint32_t code() const { return static_cast<std::uint32_t>(bits); }
  // Of a triangle.
  [[nodiscard]] std::uint32_t id() const { return static_cast<std::uint32_t>(bits >> 32); }
};

/// The lattice of a Z curve: 1,024 places along each axis of a range of middles.
class TreeCurve {
 public:
  explicit TreeCurve(const QuadBox& middles) {
    for (int axis = 0; axis < 3; ++axis) {
      const float low = lane_of(middles.low, axis), extent = lane_of(middles.high, axis) - low;
      low_[axis] = CornerQuad(low);
      // The last middle falls into the last place; a smaller extent would have a scale that is no number.
      const bool has_extent = extent > 0x1p-100f;
      scale_[axis] = CornerQuad(has_extent ? 1023.9375f / extent : float{0.0f});
      is_flat_ = is_flat_ && !has_extent;
    }
  }
  // All triangles are at one place.
  [[nodiscard]] bool is_flat() const { return is_flat_; }

  // The codes of boxes, by their middles.
  [[nodiscard]] GRIDIRON_INLINE Lanes<4>::Int codes_of(const FourBoxes& boxes) const {
    const auto part_of = [this](int axis, CornerQuad low, CornerQuad high) GRIDIRON_INLINE_LAMBDA {
      return spread(Lanes<4>::truncate(((low + high) - low_[axis]) * scale_[axis]));
    };
    return part_of(0, boxes.low.x, boxes.high.x) | part_of(1, boxes.low.y, boxes.high.y) << 1 |
           part_of(2, boxes.low.z, boxes.high.z) << 2;
  }

 private:
  // Two zeros behind each of ten bits.
  [[nodiscard]] static GRIDIRON_INLINE Lanes<4>::Int spread(Lanes<4>::Int bits) {
    using Int = Lanes<4>::Int;
    bits = (bits | bits << 16) & Int::splat(0x030000FFu);
    bits = (bits | bits << 8) & Int::splat(0x0300F00Fu);
    bits = (bits | bits << 4) & Int::splat(0x030C30C3u);
    return (bits | bits << 2) & Int::splat(0x09249249u);
  }

  CornerQuad low_[3], scale_[3];
  bool is_flat_ = true;
};

/// @returns the number of the highest bit, from 1; 0 of none: from the exponent of a double that holds it exactly.
/// std::bit_width() calls a library where there is no instruction for it.
[[nodiscard]] inline std::int32_t width_of(std::uint32_t bits) {
  return static_cast<std::int32_t>(std::bit_cast<std::uint64_t>(static_cast<double>(bits) + 0.5) >> 52) - 1022;
}

/// The codes of triangles that keep their order: by their number.
[[nodiscard]] inline TreeKey numbered(std::uint32_t number, std::uint32_t id) {
  return TreeKey::of(number | kTreeCodedAgain, id);
}

}  // namespace gridiron
