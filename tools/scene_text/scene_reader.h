// Reader of text scenes: the Neutral File Format and the lines that tools/scene_text/README.md adds.
// Source: E. Haines, "Neutral File Format", version 3.1, in the Standard Procedural Databases.
// Memory: std::vector. Threads: one. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string_view>

#include "base/points.h"
#include "scene_text/scene_description.h"
#include "scene_text/scene_entities.h"

namespace gridiron::tool {

inline constexpr std::size_t kMostSceneBytes = std::size_t{1} << 30;
inline constexpr std::uint32_t kMostSceneShapes = 1u << 24;

/// The picture that decides the tolerance of round shapes.
struct ScenePicture {
  Vec3 eye{0};
  float tan_half_fov = 0.0f;  ///< between top and bottom edge
  std::uint32_t height = 0;   ///< pixels
};

/// @returns the picture for a scene. @param own  its view, if it has one. @param points  around its shapes, at most a
///                                               twentieth of a radius inside of round ones.
using PictureOfScene = std::function<ScenePicture(const SceneView& own, const PointSource& points)>;

/// A scene with more triangles than this, at its diagonal's tolerance, gets the tolerances of its picture.
inline constexpr std::uint64_t kManyRoundTriangles = 1u << 18;

/// How round shapes become triangles.
struct SceneOptions {
  /// Largest distance of a facet from its sphere or cone, world units, > 0. Default: relative_tolerance times the
  /// diagonal of the bounding box of all objects.
  std::optional<float> tolerance;
  float relative_tolerance = 1e-4f;
  /// Nothing: the scene is read for no picture. Otherwise, if tolerance is not given and the diagonal's makes more than
  /// many_triangles, each object gets the greatest tolerance that its distance from the eye hides.
  PictureOfScene picture{};
  std::uint64_t many_triangles = kManyRoundTriangles;
  std::uint32_t most_triangles = kMostSceneTriangles;  ///< at most kMostSceneTriangles
};

/// Reads a text scene and the files that it names, checks them and makes triangles of all shapes.
///
/// Errors: Failure (kBadInput): `file:line: reason` for errors of the text, `file: reason` if it cannot be read, is
/// empty or larger than kMostSceneBytes. Interrupts as stop_if_interrupted().
[[nodiscard]] SceneDescription read_scene_text(const std::filesystem::path& path, const SceneOptions& options = {});

/// The same for a text in memory. @param path  its name in messages; files are looked up in its folder, or in the
/// current one if it is standard input or a pipe.
[[nodiscard]] SceneDescription read_scene_text(std::string_view text, const std::filesystem::path& path,
                                               const SceneOptions& options);

/// The first half: parses and checks each entity, reads meshes and environment.
[[nodiscard]] SceneEntities parse_scene_text(std::string_view text, const std::filesystem::path& path);

/// @returns a tolerance of two digits, at least the scene's least one, with at most that many triangles; nothing if
/// there is none.
[[nodiscard]] std::optional<float> tolerance_for(const SceneRoundness& roundness, std::uint64_t most_triangles);

/// The second half: makes the triangles. @param path  name of the text in messages.
[[nodiscard]] SceneDescription flatten_scene(SceneEntities entities, const std::filesystem::path& path,
                                             const SceneOptions& options);

}  // namespace gridiron::tool
