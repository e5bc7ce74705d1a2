// Look request: the parts of a look that a command line names. Apart from look.h, since every scene's request has it.
// Memory: plain values. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/effect_records.h>
#include <gridiron/base/math.h>

#include <cstdint>
#include <optional>

namespace gridiron::tool {

/// Lights of a look.
struct LookLights {
  bool head = false;  ///< a point at the first view's eye: its shadows are not seen from there
  bool key = false;   ///< a small square: its shadows have a soft edge
  bool area = false;  ///< a large square
};

/// The parts of a look. Those that are not given have the studio's values with is_studio; else there are a light at the
/// eye, facets, one sample and no ground.
struct LookRequest {
  bool is_studio = false;
  std::optional<Vec3> background{};  ///< linear
  std::optional<Vec3> color{};       ///< of the mesh, in place of its own; linear
  std::optional<bool> ground{};
  std::optional<LookLights> lights{};
  std::optional<std::uint32_t> samples{};    ///< of a pixel: 1, 4, 16
  std::optional<std::uint32_t> occlusion{};  ///< rays a point: 0..kMostEffectSamples
  std::optional<float> smooth_degrees{};     ///< edges that bend by at most this are smooth; 0..180
  std::optional<ColorLevels> levels{};

  /// Whether a mesh gets effects.
  [[nodiscard]] bool is_given() const {
    return is_studio || background || color || ground || lights || samples || occlusion || smooth_degrees || levels;
  }
};

}  // namespace gridiron::tool
