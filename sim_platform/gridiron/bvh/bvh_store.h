// The cached BVH's parts of a local store and of a frame's record.
// Memory: is the memory. Threads: one core. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/records.h>
#include <gridiron/bvh/bvh_node.h>
#include <gridiron/bvh/packet_bounds.h>
#include <gridiron/bvh/soft_cache.h>
#include <gridiron/dma/tags.h>
#include <gridiron/ray/packet.h>

#include <cstddef>
#include <cstdint>

namespace gridiron::bvh {

inline constexpr std::uint32_t kTileWidth = 32;
inline constexpr std::uint32_t kTilePixels = kTileWidth * kTileWidth;
inline constexpr std::uint32_t kPacketWidth = 16;  ///< of the settings that render fastest
inline constexpr std::uint32_t kMaxRing = 4;       ///< packets of the ring: a set of a cache has a way for each
inline constexpr std::uint32_t kOutputDepth = 2;   ///< tiles in rotation
inline constexpr std::uint32_t kMaxNodeLines = 256;
inline constexpr std::uint32_t kMaxTriangleLines = 256;
inline constexpr std::uint32_t kMaxLogLineNodes = 5;      ///< 32 nodes, 4 KB
inline constexpr std::uint32_t kMaxLogLineTriangles = 7;  ///< 128 records, 6 KB

/// Packets of 16x16 and 32x32 rays leave less memory for caches than those of 8x8.
template <std::uint32_t Width>
inline constexpr std::uint32_t kCacheBytes = (Width == 8 ? 144 : 112) * 1024;
/// Packets of the ring at most: those of a tile, if there are fewer than kMaxRing. One of 32x32 is the tile.
template <std::uint32_t Width>
inline constexpr std::uint32_t kRingOf = Width == kTileWidth ? std::uint32_t{1} : kMaxRing;

[[nodiscard]] inline bool is_packet_width(std::uint32_t width) {
  return width == 8 || width == 16 || width == 32;
}
[[nodiscard]] inline std::uint32_t ring_of(std::uint32_t packet_width) {
  return packet_width == kTileWidth ? kRingOf<kTileWidth> : kRingOf<8>;
}

// Tags by which the replay classifies waits: node lines count as cell blocks, triangle lines as triangle buffers.
static_assert(kMaxRing <= kMacroTagCount && kMaxRing <= kTriangleTagCount && kOutputDepth <= kOutputTagCount);
static_assert(kMaxRing <= kCacheWays);

/// Settings of a core; part of the frame's record. Sizes are powers of two.
struct CoreSettings {
  std::uint32_t packet_width;        ///< 8, 16 or 32
  std::uint32_t ring_size;           ///< packets that take turns, 1..kRingOf<packet_width>; 1: none
  std::uint32_t node_lines;          ///< lines of the node cache, at least kCacheWays
  std::uint32_t triangle_lines;      ///< of the triangle cache
  std::uint32_t log_line_nodes;      ///< nodes of a line
  std::uint32_t log_line_triangles;  ///< records of a line
  std::uint32_t use_subpackets;      ///< cull triangles by subpackets too, as kUseSubpackets does for the grid
  std::uint32_t reserved;
};

/// @returns whether both caches have a valid number of lines, and fit.
[[nodiscard]] inline bool are_caches_valid(const CoreSettings& core) {
  if (core.log_line_nodes > kMaxLogLineNodes || core.log_line_triangles > kMaxLogLineTriangles) return false;
  const auto lines_ok = [](std::uint32_t lines, std::uint32_t most) {
    return lines >= kCacheWays && lines <= most && (lines & (lines - 1u)) == 0;
  };
  if (!lines_ok(core.node_lines, kMaxNodeLines) || !lines_ok(core.triangle_lines, kMaxTriangleLines)) return false;
  const std::uint32_t node_bytes = core.node_lines * kNodeBytes << core.log_line_nodes;
  const std::uint32_t triangle_bytes = core.triangle_lines * kTriangleRecordBytes << core.log_line_triangles;
  return node_bytes + triangle_bytes <= (core.packet_width == 8 ? kCacheBytes<8> : kCacheBytes<16>);
}

/// The BVH's part of a frame.
struct BvhRecord {
  std::uint64_t nodes_address;      ///< BvhNode[], node 0 is the root
  std::uint64_t triangles_address;  ///< VertexTriangle[]
  CoreSettings settings;
};
using BvhFrameRecord = Frame<BvhRecord>;

/// A quad of the stack: the node or leaf to visit, and the known results about it.
struct alignas(16) StackEntry {
  float entry;  ///< no ray meets it before this t
  BvhChild child;
  std::uint32_t missed;  ///< quarters of the packet that do not meet it, a bit each
  std::uint32_t reserved;
};

/// One packet of the ring. Its stack never overflows: kStackEntries is the bound of the deepest tree.
template <std::uint32_t Width>
struct alignas(128) PacketContext {
  using StorePacket = Packet<Width, Width == 8 ? 4 : 64>;
  StorePacket packet;
  PacketBounds<Width> bounds;
  alignas(16) float reach[kQuarterCount];  ///< per quarter, the farthest of its rays' nearest hits
  std::uint32_t x, y;                      ///< its first pixel in the tile
  BvhChild child;                          ///< what it is about to visit
  std::uint32_t missed;                    ///< quarters that do not
  std::uint32_t slot;                      ///< where the line it waits for will be
  std::uint32_t stack_count;
  std::uint32_t state;  ///< kIdle, kRunning or kWaiting
  StackEntry stack[kStackEntries];
  static constexpr std::uint32_t kIdle = 0, kRunning = 1, kWaiting = 2;
};

/// Memory for the whole frame.
template <class Layout>
struct alignas(128) CacheStore {
  SoftCache<kMaxNodeLines> node_cache;
  SoftCache<kMaxTriangleLines> triangle_cache;
  alignas(128) std::byte lines[kCacheBytes<Layout::kPacketWidth>];  ///< node lines, then triangle lines

  /// Calls visit(name, offset_bytes, bytes) for every region, in address order.
  template <class Visit>
  static constexpr void for_each_region(Visit&& visit) {
    visit("node_directory", offsetof(CacheStore, node_cache), sizeof(CacheStore::node_cache));
    visit("triangle_directory", offsetof(CacheStore, triangle_cache), sizeof(CacheStore::triangle_cache));
    visit("cache_lines", offsetof(CacheStore, lines), sizeof(CacheStore::lines));
  }
};

/// Memory while the eye rays of a tile are traced.
template <class Layout>
struct RingStore {
  PacketContext<Layout::kPacketWidth> contexts[kRingOf<Layout::kPacketWidth>];
};

}  // namespace gridiron::bvh
