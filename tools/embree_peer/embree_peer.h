// Embree as the peer: scenes and frames with the same work as ours, single-threaded.
// Memory: Embree's own. Threads: one. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/records.h>
#include <gridiron/scene/mesh.h>

#include <cstdint>
#include <memory>
#include <vector>

namespace gridiron::peer {

inline constexpr std::uint32_t kEmbreePacketWidth = 4;  ///< pixels along a packet's edge

/// How much time Embree takes to build its hierarchy.
enum class EmbreeQuality : std::uint8_t { kLow, kMedium, kHigh };

/// A mesh in Embree. Vertices and indices are shared buffers, so that building copies only what Embree itself copies.
class EmbreeScene {
 public:
  EmbreeScene();
  ~EmbreeScene();
  EmbreeScene(const EmbreeScene&) = delete;
  EmbreeScene& operator=(const EmbreeScene&) = delete;

  /// Passes the mesh to Embree; build() builds its hierarchy. The view's arrays are copied once, with Embree's padding.
  void set_mesh(const MeshView& mesh);
  void build(EmbreeQuality quality);

  /// Renders `frame` (camera, size, background, facing-ratio shading) with coherent packets of 16 rays, 4x4 pixels
  /// each, tile by tile of frame.tile_width pixels, into tile-major RGBA8. Sizes must be multiples of
  /// kEmbreePacketWidth.
  void render(const FrameRecord& frame, std::vector<std::uint32_t>& color) const;

  /// @returns how many pixels of `frame` hit anything.
  [[nodiscard]] std::uint64_t hit_count(const FrameRecord& frame) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace gridiron::peer
