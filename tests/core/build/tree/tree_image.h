// Images whose trees have several levels. Memory: owns them. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/build/grid/built_image.h"
#include "core/build/tree/tree_scene.h"

namespace gridiron::test {

/// The image of a scene with a coarse grid.
inline BuiltImage build_tree_image(const TestEffects& scene, std::uint32_t leaf_triangles,
                                   TriangleFormat format = TriangleFormat::kVertices,
                                   std::byte fill = std::byte{0xCD}) {
  const EffectsView view = scene.view();
  return build_image(scene.mesh(),
                     {.lambda = 0.1f, .macro_width = 2, .format = format, .leaf_triangles = leaf_triangles}, fill,
                     &view);
}

}  // namespace gridiron::test
