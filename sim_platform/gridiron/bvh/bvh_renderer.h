// The cached BVH on the grid's chip, for comparison: packets through a bounding volume hierarchy, software caches for
// nodes and triangles, with and without a ring of packets that hide each other's misses.
// Source: Benthin, Wald, Scherbaum, Friedrich 2006. Memory: owns what it makes; borrows meshes.
// Threads: starts its own, one per simulated core, one of which runs at a time. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/bvh/bvh.h>
#include <gridiron/bvh/bvh_store.h>
#include <gridiron/bvh/bvh_work.h>
#include <gridiron/bvh/soft_cache.h>
#include <gridiron/frame/frame_setup.h>
#include <gridiron/sim/machine_profile.h>
#include <gridiron/sim/replay.h>
#include <gridiron/sim/sim_chip.h>

#include <atomic>
#include <cstdint>
#include <vector>

namespace gridiron::bvh {

/// Sizes of both caches. Lines: a power of two, kCacheWays..kMaxNodeLines, kMaxTriangleLines; together at most
/// kCacheBytes. The contents of a line are fixed when the hierarchy is built (BvhParameters::line_nodes,
/// line_triangles).
struct CacheGeometry {
  std::uint32_t node_lines = 32;
  std::uint32_t triangle_lines = 16;
};

struct RenderOptions {
  std::uint32_t core_count = 0;               ///< 0: the profile's
  bool hyper_threading = true;                ///< packets take turns; else one after another
  std::uint32_t ring_size = 3;                ///< of them, 2..kRingOf; without hyper-threading not looked at
  std::uint32_t packet_width = kPacketWidth;  ///< 8, 16 or 32, which has no ring
  CacheGeometry caches = {};
  bool use_subpackets = true;                            ///< cull triangles by 4x4 pixels too
  bool all_planes = false;                               ///< depth and ids beside colour
  bool timeline = false;                                 ///< fill timing.timeline
  sim::Completion completion = sim::Completion::kEarly;  ///< changes nothing but when bytes move
  std::uint64_t seed = 0;
  const std::atomic<bool>* abort = nullptr;  ///< stop between tiles when it becomes true
};

/// A frame's planes, row-major, row 0 on top. The same bits as core's picture of the same frame.
struct BvhPicture {
  std::vector<std::uint32_t> color;  ///< 0xAABBGGRR
  std::vector<float> depth;          ///< along the unit direction, kFloatMax where nothing is hit
  std::vector<std::uint32_t> ids;    ///< triangle, kNoTriangle where nothing is hit
};

/// The results of a frame and its cost.
struct BvhFrame {
  Status status = Status::kOk;
  sim::HostShortage host_shortage = sim::HostShortage::kNone;  ///< where it is any, status is kAborted
  std::vector<sim::Violation> violations;
  BvhPicture picture;       ///< depth and ids only if requested
  sim::FrameTiming timing;  ///< with contention; waits for node lines under kMacroCell, triangles kTriangle
  sim::WorkTotals work{};   ///< by Work and BvhWork
  CacheCounts node_cache, triangle_cache;   ///< over all cores
  std::vector<std::uint32_t> core_of_tile;  ///< which core rendered tile i
  std::uint64_t main_memory_bytes = 0;      ///< nodes, triangles, planes
};

/// Writes the record that the cores of a frame need.
/// @param settings  with the addresses of the planes; tile width and output depth are set here.
/// @param nodes, triangles  addresses of bvh.nodes and bvh.triangles in main memory. Errors: kBadFrame (settings).
[[nodiscard]] Status make_bvh_record(const Bvh& bvh, FrameSettings settings, const RenderOptions& options,
                                     MainAddress nodes, MainAddress triangles, BvhFrameRecord& frame);

/// Renders a frame on the simulated chip, checking every rule of the contract.
///
/// Claims are granted by each core's clock without contention, so the run depends only on `machine` and the options,
/// not on the host; the replay then gives its steps their times with contention.
/// @param settings  camera, size, shading, t_far, background; accuracy kStandard. Settings of a grid are ignored; tile
///                  width, output depth and addresses are set here.
/// Errors: kUnsupportedFrame (accuracy; a machine with less than 256 KB of local store), kBadParameter (options),
/// kMemoryTooSmall (main memory of the machine), kBadFrame (settings), kAborted (by the options or a shortage of the
/// host: each core needs a thread), and the errors of broken rules.
[[nodiscard]] BvhFrame render_bvh_frame(const Bvh& bvh, const FrameSettings& settings,
                                        const sim::MachineProfile& machine, const RenderOptions& options);

}  // namespace gridiron::bvh
