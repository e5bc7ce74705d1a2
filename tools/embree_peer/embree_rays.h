// Single rays in Embree: which of them hit a mesh.
// Memory: Embree's own. Threads: hits() from any number at once. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/scene/mesh.h>

#include <cstdint>
#include <memory>

namespace gridiron::peer {

/// A mesh in Embree to shoot rays at.
class EmbreeRays {
 public:
  static constexpr std::uint32_t kMostRays = 16;

  /// @param robust  with RTC_SCENE_FLAG_ROBUST.
  EmbreeRays(const MeshView& mesh, bool robust);
  ~EmbreeRays();
  EmbreeRays(const EmbreeRays&) = delete;
  EmbreeRays& operator=(const EmbreeRays&) = delete;

  /// Shoots up to kMostRays rays of unlimited length from one origin.
  ///
  /// @param active  bit i = ray i. @param width  rays of one of Embree's calls: 1, 4, 8 or 16.
  /// @returns those that hit something.
  [[nodiscard]] std::uint32_t hits(const float origin[3], const float (&dir)[3][kMostRays], std::uint32_t active,
                                   std::uint32_t width) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace gridiron::peer
