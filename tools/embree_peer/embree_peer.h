// Embree as the peer: scenes and frames with the same work as ours, single-threaded.
// Memory: Embree's own. Threads: one. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/records.h>
#include <gridiron/scene/mesh.h>

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace gridiron::peer {

inline constexpr std::uint32_t kEmbreePacketWidth = 4;  ///< pixels along a packet's edge

/// How much time Embree takes to build its hierarchy.
enum class EmbreeQuality : std::uint8_t { kLow, kMedium, kHigh };

/// What one call takes of the eye rays of a frame: a ray, a packet, a stream of 256 rays in 16x16 pixels, alone or in
/// packets.
enum class EmbreeEyeCall : std::uint8_t { kSingle, kPacket8, kPacket16, kStream, kStream8, kStream16 };

/// A mesh in Embree. Vertices and indices are shared buffers, so that building copies only what Embree itself copies.
class EmbreeScene {
 public:
  EmbreeScene();
  ~EmbreeScene();
  EmbreeScene(const EmbreeScene&) = delete;
  EmbreeScene& operator=(const EmbreeScene&) = delete;

  /// Passes the mesh to Embree; build() builds its hierarchy. The view's arrays are copied once, with Embree's padding.
  void set_mesh(const MeshView& mesh);
  /// @param robust  with RTC_SCENE_FLAG_ROBUST.
  void build(EmbreeQuality quality, bool robust = false);

  /// Renders `frame` (camera, size, background, facing-ratio shading) with coherent packets of 16 rays, 4x4 pixels
  /// each, tile by tile of frame.tile_width pixels, into tile-major RGBA8. Sizes must be multiples of
  /// kEmbreePacketWidth.
  void render(const FrameRecord& frame, std::vector<std::uint32_t>& color) const;

  /// Finds the triangle of every pixel of `frame` by one of Embree's calls. @param is_coherent  whether Embree is told
  /// that rays are alike. @param ids  row-major, 2^32 - 1 where nothing is hit. Sizes must be multiples of 32.
  void find_triangles(const FrameRecord& frame, EmbreeEyeCall call, bool is_coherent,
                      std::span<std::uint32_t> ids) const;

  /// @returns how many pixels of `frame` hit anything.
  [[nodiscard]] std::uint64_t hit_count(const FrameRecord& frame) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace gridiron::peer
