// Scenes with effects whose trees have several levels. Memory: std::vector. Threads: any.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/scene/test_effects.h"

namespace gridiron::test {

/// Small triangles of a matte material in the unit cube, without lights; each seventh has no area.
inline TestEffects tree_scene(std::uint32_t triangle_count) {
  TestEffects scene;
  std::uint32_t state = 12345;
  const auto next = [&state] {
    state = state * 1664525u + 1013904223u;
    return static_cast<float>(state >> 16) / 65536.0f;
  };
  for (std::uint32_t i = 0; i < triangle_count; ++i) {
    const Vec3 corner(next(), next(), next());
    for (int k = 0; k < 3; ++k) {
      const Vec3 away(next(), next(), next());
      scene.vertices.push_back(i % 7 == 6 ? corner : corner + 0.1f * away);
    }
    scene.triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
  }
  scene.materials = {Material{}};
  scene.triangle_materials.assign(triangle_count, 0);
  return scene;
}

}  // namespace gridiron::test
