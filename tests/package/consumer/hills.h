// The mesh that both examples with a mesh show: hills on a square, their coordinates exact in floats.
// Memory: std::vector. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/math.h>
#include <gridiron/frame/frame_setup.h>

#include <cstdint>
#include <vector>

/// kWidth x kWidth squares of two triangles from (-4, 0, -4) to (4, 1, 4).
struct Hills {
  static constexpr std::uint32_t kWidth = 32;
  std::vector<gridiron::Vec3> vertices;
  std::vector<gridiron::UVec3> triangles;

  Hills() {
    const auto place = [](std::uint32_t i) { return static_cast<float>(i) * 0.25f - 4.0f; };
    for (std::uint32_t z = 0; z <= kWidth; ++z) {
      for (std::uint32_t x = 0; x <= kWidth; ++x) {
        const std::uint32_t height = (x * x * 5 + z * z * 3 + x * z) % 17;
        vertices.emplace_back(place(x), static_cast<float>(height) * 0.0625f, place(z));
      }
    }
    for (std::uint32_t z = 0; z < kWidth; ++z) {
      for (std::uint32_t x = 0; x < kWidth; ++x) {
        const std::uint32_t corner = z * (kWidth + 1) + x;
        triangles.emplace_back(corner, corner + kWidth + 1, corner + 1);
        triangles.emplace_back(corner + 1, corner + kWidth + 1, corner + kWidth + 2);
      }
    }
  }

  /// A view of them.
  static gridiron::FrameSettings settings() {
    return {.camera = {.eye = {1.3f, 4.7f, 6.1f}, .at = {0.1f, 0.2f, 0.3f}}, .width = 160, .height = 128};
  }
};
