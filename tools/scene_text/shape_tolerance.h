// How far the facets of a round shape may be from it: by request, by the size of the scene, or by its picture.
// Memory: borrows the scene. Threads: one. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene_text/scene_reader.h"
#include "scene_text/scene_shapes.h"

namespace gridiron::tool {

class ShapeTolerance {
 public:
  /// Chooses the scene's tolerance and begins its roundness. All arguments but the options outlive the object.
  /// @param path  name of the text in messages. Errors: Failure (kBadInput).
  ShapeTolerance(const SceneEntities& entities, RoundShapes& shapes, const SceneOptions& options,
                 const std::filesystem::path& path, SceneDescription& scene);

  /// @returns the tolerance of a shape, and enters it into the scene's roundness.
  [[nodiscard]] double of(const RoundShape& shape);

 private:
  void choose_tolerance(const SceneOptions& options, const std::filesystem::path& path);
  void group_shapes();
  void choose_picture(const SceneOptions& options);

  const SceneEntities& entities_;
  RoundShapes& shapes_;
  SceneDescription& scene_;
  DVec3 eye_{0};      // of the picture
  double pixel_ = 0;  // of the picture, at distance 1
};

}  // namespace gridiron::tool
