// View bound: the most work and transfers of each tile of a frame through the tree, for its camera, without its hits.
// Source: own; each count is derived where it is made. core/README.md, "The worst tile of a view".
// Memory: std::vector, by the triangles that a tile may draw. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/records.h>
#include <gridiron/frame/tile_bound.h>
#include <gridiron/sim/machine_profile.h>
#include <gridiron/sim/sim_chip.h>
#include <gridiron/sim/tile_cycles.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

namespace gridiron::sim {

/// What a frame's tiles are bounded from.
struct ViewFrame {
  FrameHead head;                    ///< of EngineId::kTree, as make_frame_record() filled it
  std::span<const std::byte> image;  ///< the scene image that it names
  StoreSize store = StoreSize::k256KB;  ///< of the cores
};

/// @returns whether there is a bound for such frames: eye rays of the whole tree's engine with 4 lanes, of triangles by
/// their vertices, without the scene's shading and without a plane of distances.
[[nodiscard]] bool has_view_bound(const FrameHead& head, StoreSize store);

/// Bounds the tiles of one frame, one after another.
///
/// A tile goes down the tree with the kernel's own tests, but nothing is hidden: no node, leaf, triangle or block is
/// left out for what was hit before. What is kept depends on the tile alone, whatever hits there are, and
/// every count of the kernel is one of things that are kept here too. Floats may leave open those of a triangle's
/// pixels that lie near an edge, or where another triangle of the block is as near; of such pixels alone doubles and
/// integers are counted by asking them.
class ViewBound {
 public:
  /// Borrows the image. Precondition: has_view_bound().
  explicit ViewBound(const ViewFrame& frame);
  ~ViewBound();
  ViewBound(ViewBound&&) noexcept;  ///< leaves a bound that can only be destroyed

  /// The most of one tile. @param tile_id  below tiles_x * tiles_y.
  /// Errors: throws std::bad_alloc. Cost: linear in what lies in the tile, but quadratic in up to
  /// 512 triangles of one block of 4 x 4 pixels.
  [[nodiscard]] TileBound of(std::uint32_t tile_id);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// The most cycles of a tile from the grant of its claim to the next claim, as TileCycles.
///
/// A core stands still only while one of its commands is under way. Lines of one command leave at most
/// core_line_interval_cycles after one another, unless as many of the core's lines are under way as may be; then those
/// are accounted for where they belong. A line is served after those that left before it, at most lines_in_flight of
/// each core, and arrives a latency later. So each command takes a line's longest way, and an interval for each
/// further line; a longer one than lines_in_flight takes a way for each so many lines. A tile may also wait for
/// earlier ones that are leaving the core, as many as output buffers.
///
/// @param bound  of ViewBound. @param machine  provides prices of 4 lanes, lines and channel.
[[nodiscard]] TileCycles view_tile_cycles(const TileBound& bound, const MachineProfile& machine,
                                          std::uint32_t output_depth);

}  // namespace gridiron::sim
