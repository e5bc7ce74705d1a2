// Scene request: which scene a command reads, the grid and machine that were asked for it, and what is known of it.
// Memory: owns its path; shares the machine. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "base/numbers.h"
#include "files/file_kind.h"
#include "gridiron/device/configurations.h"
#include "gridiron/device/machine_file.h"

namespace gridiron::tool {

/// Which grid a mesh gets, and which machine's memory it has to fit. A packed scene brings its own grid.
struct SceneRequest {
  std::filesystem::path input;
  Machine machine;  ///< never null
  const Configuration* configuration = nullptr;
  std::optional<float> lambda;
  std::optional<std::uint32_t> macro_width;
  std::optional<float> tolerance;  ///< of round shapes in a text scene, world units; nothing: the reader's own
  bool quiet = false;              ///< notes are not told
};

/// What is known of a scene when what is asked of it is settled.
struct KnownScene {
  SceneKind kind = SceneKind::kUnknown;
  bool has_effects = false;         ///< it brings lights and materials
  bool is_read = false;             ///< else foreseen: of a packed scene the kind alone is known
  std::optional<CountPair> size{};  ///< of the picture, a text scene's own
};

/// Of a picture that neither the command line nor a text scene gives a size.
inline constexpr CountPair kUsualPictureSize = {1024, 1024};

}  // namespace gridiron::tool
