// The tree engine's part of a local store: its record for the whole frame; lists, nodes and leaves while rays other
// than eye rays are traced.
// Memory: is the memory. Threads: one core. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/effect_records.h>
#include <gridiron/base/records.h>
#include <gridiron/base/tree_records.h>
#include <gridiron/engine/engine.h>
#include <gridiron/engine/tree/list_memory.h>
#include <gridiron/platform/contract.h>

#include <cstddef>
#include <cstdint>

namespace gridiron {

/// Memory for the whole frame.
struct alignas(128) TreeStore {
  TreeRecord tree;
};

/// Nodes and leaves that were fetched: sets of four, in which the one fetched longest ago makes room, of those that no
/// one waits for.
/// @tparam Slots  4 times a power of two, at most 32. @tparam LeafTriangles  of a leaf, at most.
template <std::uint32_t Slots, std::uint32_t LeafTriangles>
struct TreeCache {
  static constexpr std::uint32_t kSlots = Slots, kWays = 4, kSets = Slots / kWays;
  static constexpr std::uint32_t kLeafTriangles = LeafTriangles;
  static constexpr std::uint32_t kLeafBytes = LeafTriangles * kTriangleRecordBytes + kPortableCongruenceBytes;
  static constexpr std::uint32_t kSlotBytes =
      ((kLeafBytes > sizeof(TreeNode) ? kLeafBytes : static_cast<std::uint32_t>(sizeof(TreeNode))) + 63) / 64 * 64;
  static constexpr std::uint32_t kNoKey = 0xFFFFFFFFu;  ///< of no child
  static_assert(Slots <= 32 && kSets * kWays == Slots && (kSets & (kSets - 1)) == 0);
  static_assert(LeafTriangles <= kMaxTreeLeaf);

  struct alignas(64) Slot {
    std::byte bytes[kSlotBytes];
  };
  Slot slots[Slots];
  alignas(16) std::uint32_t keys[Slots];  ///< TreeChild::bits of what a slot has, or will have
  std::uint8_t tags[Slots];               ///< of their transfers; unused where each slot has one
  std::uint32_t turns[kSets];             ///< of each set: the slot that makes room next
};

/// Memory while rays are traced.
template <class Layout>
struct alignas(128) TreeRayStore {
  /// Whether there is memory for groups, and for terms of rays.
  static constexpr bool kHasGroups = requires { requires Layout::kHasGroups; };
  using Lists = ListMemory<Layout::kBatchRays, Layout::kSpareListWords, Layout::kHasBeams, kHasGroups>;
  using Cache = TreeCache<Layout::kTreeSlots, Layout::kLeafTriangles>;
  /// Buffers that can be lent: as many slots each as hold one.
  static constexpr std::uint32_t kBufferSlots = (kIdleBufferBytes + Cache::kSlotBytes - 1) / Cache::kSlotBytes;
  static constexpr std::uint32_t kBuffers = Layout::kTreeSlots / kBufferSlots;

  Lists lists;
  Cache cache;
  /// Gives up the slots of the first `count` buffers.
  void lend(std::uint32_t count) {
    for (std::uint32_t slot = 0; slot < count * kBufferSlots; ++slot) cache.keys[slot] = Cache::kNoKey;
  }
  [[nodiscard]] std::byte* idle_buffer(std::uint32_t buffer) { return cache.slots[buffer * kBufferSlots].bytes; }

  alignas(32) std::byte surface_bytes[sizeof(SurfaceRecord) + kPortableCongruenceBytes];  ///< one that settles a tie
};

}  // namespace gridiron
