// A tree of boxes, halved at the median of their middles, for the searches of the tests' references. Nothing of core's
// code. Memory: std::vector. Threads: any, once built. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <glm/vec3.hpp>
#include <limits>
#include <utility>
#include <vector>

namespace gridiron::test {

/// A closed box and the point by which it is sorted into a half: its middle times any factor that all boxes share.
struct PlacedBox {
  glm::dvec3 low{std::numeric_limits<double>::infinity()}, high{-low};
  glm::dvec3 middle{0.0};

  void add(const glm::dvec3& point) {
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], point[axis]);
      high[axis] = std::max(high[axis], point[axis]);
    }
  }
};

/// A search walks nodes() from the first one on.
class MedianTree {
 public:
  /// A leaf holds `count` boxes, from order()[first] on. Other nodes have none; their children are the next node, which
  /// is the lower one along `axis`, and `second`.
  struct Node {
    glm::dvec3 low, high;
    std::uint32_t first, count, second;
    int axis;
  };

  MedianTree() = default;
  /// @param boxes  by id. @param ids  those that the tree holds, all finite. @param leaf_count  most boxes of a leaf.
  MedianTree(const std::vector<PlacedBox>& boxes, std::vector<std::uint32_t> ids, std::uint32_t leaf_count)
      : order_(std::move(ids)) {
    if (!order_.empty()) build(boxes, 0, static_cast<std::uint32_t>(order_.size()), leaf_count);
  }

  /// Empty if the tree holds nothing.
  [[nodiscard]] const std::vector<Node>& nodes() const { return nodes_; }
  /// The ids, those of a leaf beside each other.
  [[nodiscard]] const std::vector<std::uint32_t>& order() const { return order_; }

 private:
  std::uint32_t build(const std::vector<PlacedBox>& boxes, std::uint32_t first, std::uint32_t count,
                      std::uint32_t leaf_count) {
    PlacedBox whole, middles;
    for (std::uint32_t i = first; i < first + count; ++i) {
      const PlacedBox& box = boxes[order_[i]];
      whole.add(box.low);
      whole.add(box.high);
      middles.add(box.middle);
    }
    const auto index = static_cast<std::uint32_t>(nodes_.size());
    nodes_.push_back({whole.low, whole.high, first, count, 0, 0});
    if (count <= leaf_count) return index;

    int axis = 0;
    const glm::dvec3 extent = middles.high - middles.low;
    for (int other = 1; other < 3; ++other) {
      if (extent[other] > extent[axis]) axis = other;
    }
    const std::uint32_t half = count / 2;
    const auto begin = order_.begin() + first;
    std::nth_element(begin, begin + half, begin + count, [&](std::uint32_t a, std::uint32_t b) {
      return std::pair(boxes[a].middle[axis], a) < std::pair(boxes[b].middle[axis], b);
    });
    build(boxes, first, half, leaf_count);
    const std::uint32_t second = build(boxes, first + half, count - half, leaf_count);
    nodes_[index].count = 0;
    nodes_[index].second = second;
    nodes_[index].axis = axis;
    return index;
  }

  std::vector<Node> nodes_;
  std::vector<std::uint32_t> order_;
};

}  // namespace gridiron::test
