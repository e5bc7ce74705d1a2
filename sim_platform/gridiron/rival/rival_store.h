// The rival's local store: every byte a core works in, one struct, in address order.
// Memory: is the memory. Threads: one core. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/records.h>
#include <gridiron/base/work_counters.h>
#include <gridiron/ray/packet.h>
#include <gridiron/rival/bvh_node.h>
#include <gridiron/rival/packet_bounds.h>
#include <gridiron/rival/soft_cache.h>
#include <gridiron/store/dma_tags.h>

#include <cstddef>
#include <cstdint>

namespace gridiron::rival {

inline constexpr std::uint32_t kArenaBytes = 256 * 1024;
inline constexpr std::uint32_t kCodeBudgetBytes = 48 * 1024;
inline constexpr std::uint32_t kStackBudgetBytes = 8 * 1024;
inline constexpr std::uint32_t kTileWidth = 32;
inline constexpr std::uint32_t kPacketWidth = 8;
inline constexpr std::uint32_t kTilePixels = kTileWidth * kTileWidth;
inline constexpr std::uint32_t kMaxRing = 4;             ///< packets of the ring
inline constexpr std::uint32_t kOutputDepth = 2;         ///< tiles in rotation
inline constexpr std::uint32_t kCacheBytes = 144 * 1024; ///< both caches' lines
inline constexpr std::uint32_t kMaxNodeLines = 512;
inline constexpr std::uint32_t kMaxTriangleLines = 256;

// The tags that the replay tells apart: node lines as cell blocks, triangle lines as triangle buffers.
static_assert(kMaxRing <= kMacroTagCount && kMaxRing <= kTriangleTagCount && kOutputDepth <= kOutputTagCount);

/// Which boxes are also held against the rays, four at a time, until one of them meets it.
enum class RayTests : std::uint32_t { kNone, kLeaves, kAll };

/// How a core runs; part of the frame's record.
struct CoreSettings {
  std::uint32_t ring_size;        ///< packets that take turns, 1..kMaxRing; 1: none
  std::uint32_t node_lines;       ///< lines of the node cache, a multiple of kCacheWays
  std::uint32_t triangle_lines;   ///< of the triangle cache
  std::uint32_t line_nodes;       ///< nodes of a line
  std::uint32_t line_triangles;   ///< records of a line
  RayTests ray_tests;
  std::uint32_t use_subpackets;   ///< cull triangles by subpackets too, as kUseSubpackets does for the grid
  std::uint32_t reserved;
};

/// Everything a core needs to know. 128-byte aligned.
struct alignas(128) RivalFrameRecord {
  FrameRecord frame;
  float low[3], high[3];            ///< bounds of the scene
  std::uint64_t nodes_address;      ///< BvhNode[], node 0 is the root
  std::uint64_t triangles_address;  ///< VertexTriangle[]
  CoreSettings settings;
};
static_assert(sizeof(RivalFrameRecord) == 512);

/// Where a packet stands: what it is about to visit and what it has still to visit.
struct StackEntry {
  BvhChild child;
  float entry;                ///< no ray meets it before this t
  std::uint32_t first_group;  ///< groups before this one do not meet it
};

/// One packet of the ring. Its stack never overflows: kStackEntries is the bound of the deepest tree.
struct alignas(128) PacketContext {
  using StorePacket = Packet<kPacketWidth>;
  StorePacket packet;
  PacketBounds<kPacketWidth> bounds;
  float reach[StorePacket::kSubpacketCount];  ///< per subpacket, the farthest of its rays' nearest hits
  float largest_reach;
  std::uint32_t x, y;                         ///< its first pixel in the tile
  StackEntry current;
  StackEntry stack[kStackEntries];
  std::uint32_t stack_count;
  std::uint32_t slot;                         ///< of the line it waits for
  std::uint32_t state;                        ///< kIdle, kRunning or kWaiting
  static constexpr std::uint32_t kIdle = 0, kRunning = 1, kWaiting = 2;
};

/// Memory of one core.
struct alignas(128) RivalStore {
  struct alignas(128) TileOutput {
    std::uint32_t color[kTilePixels];
    float depth[kTilePixels];
    std::uint32_t id[kTilePixels];
  };
  RivalFrameRecord record;
  alignas(128) WorkCounters work;
  SoftCache<kMaxNodeLines> node_cache;
  SoftCache<kMaxTriangleLines> triangle_cache;
  alignas(128) std::byte lines[kCacheBytes];  ///< node lines, then triangle lines
  PacketContext contexts[kMaxRing];
  TileOutput output[kOutputDepth];
};
static_assert(sizeof(RivalStore) + kCodeBudgetBytes + kStackBudgetBytes <= kArenaBytes);

/// Calls visit(name, offset_bytes, bytes) for every region of the store, in address order.
template <class Visit>
constexpr void for_each_region(Visit&& visit) {
  visit("frame", offsetof(RivalStore, record), sizeof(RivalStore::record));
  visit("work", offsetof(RivalStore, work), sizeof(RivalStore::work));
  visit("node_directory", offsetof(RivalStore, node_cache), sizeof(RivalStore::node_cache));
  visit("triangle_directory", offsetof(RivalStore, triangle_cache), sizeof(RivalStore::triangle_cache));
  visit("cache_lines", offsetof(RivalStore, lines), sizeof(RivalStore::lines));
  visit("packets", offsetof(RivalStore, contexts), sizeof(RivalStore::contexts));
  visit("output", offsetof(RivalStore, output), sizeof(RivalStore::output));
}

}  // namespace gridiron::rival
