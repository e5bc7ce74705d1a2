// Rays in Embree: which of them hit a mesh, and where. For comparisons, by all of its calls and qualities.
// Memory: Embree's own. Threads: hits() and trace() from any number at once. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/scene/mesh.h>

#include <cstdint>
#include <memory>
#include <span>

#include "embree_peer/embree_peer.h"

namespace gridiron::peer {

/// A ray that both sides of a comparison are given. It looks for hits with t between 0 and its own.
struct PeerRay {
  float origin[3], dir[3];
  float t;
};

/// What one call takes: rtcIntersect1, rtcIntersect16 or a stream by rtcIntersect1M, and likewise rtcOccluded.
enum class EmbreeCall : std::uint8_t { kSingle, kPacket16, kStream };

/// Rays in the layout of one of Embree's calls; after EmbreeRays::trace() also their answers.
class EmbreeRayBatch {
 public:
  static constexpr std::uint32_t kNoHit = 0xFFFFFFFFu;

  /// @param any_hit  whether the question is if there is a hit, not which is the nearest.
  EmbreeRayBatch(EmbreeCall call, bool any_hit);
  ~EmbreeRayBatch();
  EmbreeRayBatch(EmbreeRayBatch&&) noexcept;
  EmbreeRayBatch& operator=(EmbreeRayBatch&&) = delete;

  /// Replaces all rays, and forgets the answers. @param rays  a multiple of 16.
  void fill(std::span<const PeerRay> rays);

  [[nodiscard]] bool is_hit(std::size_t ray) const;
  [[nodiscard]] std::uint32_t triangle(std::size_t ray) const;  ///< of the nearest hit, kNoHit without one
  [[nodiscard]] float t(std::size_t ray) const;                 ///< of the nearest hit

 private:
  friend class EmbreeRays;
  struct State;
  std::unique_ptr<State> state_;
};

/// A mesh in Embree to shoot rays at.
class EmbreeRays {
 public:
  static constexpr std::uint32_t kMostRays = 16;

  /// @param robust  with RTC_SCENE_FLAG_ROBUST.
  EmbreeRays(const MeshView& mesh, bool robust, EmbreeQuality quality = EmbreeQuality::kMedium);
  ~EmbreeRays();
  EmbreeRays(const EmbreeRays&) = delete;
  EmbreeRays& operator=(const EmbreeRays&) = delete;

  /// Shoots up to kMostRays rays of unlimited length from one origin.
  ///
  /// @param active  bit i = ray i. @param width  rays of one of Embree's calls: 1, 4, 8 or 16.
  /// @returns those that hit something.
  [[nodiscard]] std::uint32_t hits(const float origin[3], const float (&dir)[3][kMostRays], std::uint32_t active,
                                   std::uint32_t width) const;

  /// Answers all rays of a batch by its call.
  ///
  /// @param stream_rays  of one stream, at most. @param is_coherent  whether Embree is told that rays are alike; it
  ///                     makes a difference to packets and streams.
  void trace(EmbreeRayBatch& batch, std::uint32_t stream_rays, bool is_coherent) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace gridiron::peer
