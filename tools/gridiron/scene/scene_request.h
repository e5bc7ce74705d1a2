// Scene request: the scene that a command reads, the requested grid and machine, and what is known of the scene.
// Memory: owns its path; shares the machine. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "base/numbers.h"
#include "files/file_kind.h"
#include "gridiron/device/configurations.h"
#include "gridiron/device/machine_file.h"
#include "import/model_import.h"
#include "look_request.h"

namespace gridiron::tool {

/// The grid of a mesh, and the machine whose memory must hold it. A packed scene has its own grid.
struct SceneRequest {
  std::filesystem::path input;
  Machine machine;                               ///< never null
  const Configuration* configuration = nullptr;  ///< null in a request that names none: default_configuration()
  std::optional<float> lambda;
  std::optional<std::uint32_t> macro_width;
  std::optional<float> tolerance;  ///< of round shapes in a text scene, world units; nothing: the reader's default
  ImportOptions model{};           ///< how one is read with Assimp
  LookRequest look{};              ///< of the commands that render
  bool quiet = false;              ///< notes are not told
};

/// What is known of a scene when a request is completed.
struct KnownScene {
  SceneKind kind = SceneKind::kUnknown;
  bool has_effects = false;         ///< it brings lights and materials
  bool is_read = false;             ///< else foreseen: for a packed scene only the kind is known
  bool has_tree = true;             ///< false: a packed scene that was read and has none
  bool has_projection = false;      ///< a packed scene that was read has TriangleFormat::kProjection
  std::optional<CountPair> size{};  ///< the picture's size in a text scene
  bool has_bounds = true;           ///< false: `best` has no bounds of its errors in the view
};

/// Size of a picture if neither the command line nor a text scene has one.
inline constexpr CountPair kUsualPictureSize = {1024, 1024};

}  // namespace gridiron::tool
