// Nodes and leaves of the wide tree, fetched into a core's cache ahead of their use.
// Memory: the local store. Threads: one core. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/lanes.h>
#include <gridiron/base/records.h>
#include <gridiron/base/tree_records.h>
#include <gridiron/dma/tags.h>
#include <gridiron/dma/transfers.h>
#include <gridiron/engine/tree/tree_store.h>
#include <gridiron/platform/contract.h>
#include <gridiron/ray/lattice_run.h>

#include <cstdint>

namespace gridiron {

/// A source of RayLists.
/// @tparam Store  LocalStore of a layout whose rays this engine traces.
template <class Store, Platform P>
class TreeSource {
 public:
  TreeSource(Store& store, Transfers<P>& transfers) : store_(store), transfers_(transfers) {}

  /// Discards what the cache has. Precondition: nothing is pending.
  void forget() {
    for (std::uint32_t i = 0; i < Cache::kSlots; ++i) {
      cache().keys[i] = Cache::kNoKey;
      cache().uses[i] = 0;
      cache().is_pending[i] = 0;
    }
    clock_ = 0;
    surface_ = kNoTriangle;
  }

  /// Children under way at once.
  [[nodiscard]] std::uint32_t window() const { return store_.frame.walk_depth; }

  [[nodiscard]] Status ahead(TreeChild child) {
    const std::uint32_t slot = find(child);
    if (slot != Cache::kSlots) return Status::kOk;
    std::uint32_t started = 0;
    return start(child, started);
  }

  [[nodiscard]] Status node(std::uint32_t index, const TreeNode*& node) {
    std::uint32_t slot = 0;
    GRIDIRON_TRY(take(TreeChild::node(index), slot));
    node = reinterpret_cast<const TreeNode*>(cache().slots[slot].bytes);
    return Status::kOk;
  }

  [[nodiscard]] Status leaf(TreeChild child, const VertexTriangle*& records) {
    std::uint32_t slot = 0;
    GRIDIRON_TRY(take(child, slot));
    const std::uint32_t first_byte = is_on_lattice() ? std::uint32_t{0} : place_of(child).first_byte;
    records = reinterpret_cast<const VertexTriangle*>(cache().slots[slot].bytes + first_byte);
    return Status::kOk;
  }

  /// Waits for what was asked for and not taken.
  [[nodiscard]] Status finish() {
    for (std::uint32_t i = 0; i < Cache::kSlots; ++i) {
      if (cache().is_pending[i] != 0) GRIDIRON_TRY(arrive(i));
    }
    return Status::kOk;
  }

  [[nodiscard]] Status triangle_of(MainAddress surfaces, std::uint32_t id, VertexTriangle& triangle) {
    const MainAddress address{surfaces.value + std::uint64_t{id} * sizeof(SurfaceRecord)};
    std::byte* const place = store_.wave.rays.surface_bytes + address.value % kPortableCongruenceBytes;
    // Where one tie is, its neighbours are.
    if (id != surface_) {
      GRIDIRON_TRY(transfers_.get(place, address, sizeof(SurfaceRecord), kSetupTag));
      GRIDIRON_TRY(transfers_.wait(kSetupTag));
      surface_ = id;
    }
    const auto& surface = *reinterpret_cast<const SurfaceRecord*>(place);
    for (int corner = 0; corner < 3; ++corner) {
      for (int axis = 0; axis < 3; ++axis) triangle.v[corner][axis] = surface.v[corner][axis];
    }
    return Status::kOk;
  }

 private:
  using RayStore = typename Store::RayStore;
  using Cache = typename RayStore::Cache;

  // Where a child lies in main memory, and in its slot.
  struct Place {
    MainAddress begin;  // of the transfer
    std::uint32_t bytes, first_byte, slack;
  };
  [[nodiscard]] Place place_of(TreeChild child) const {
    const TreeRecord& tree = store_.rays.tree;
    if (!child.is_leaf()) {
      const std::uint64_t offset = tree.nodes_offset_bytes + std::uint64_t{child.node_index()} * sizeof(TreeNode);
      return {MainAddress{store_.frame.image_address + offset}, sizeof(TreeNode), 0, 0};
    }
    // Records of half the length start and end between the multiples of 16 bytes that a transfer moves.
    static constexpr std::uint32_t kStep = kPortableGranuleBytes;
    const std::uint64_t begin = store_.frame.image_address + tree.triangles_offset_bytes +
                                std::uint64_t{child.first()} * tree.triangle_bytes;
    const std::uint32_t slack = static_cast<std::uint32_t>(begin % kStep);
    const std::uint32_t bytes = (slack + child.count() * tree.triangle_bytes + (kStep - 1)) & ~(kStep - 1);
    return {MainAddress{begin - slack}, bytes, static_cast<std::uint32_t>(begin % kPortableCongruenceBytes), slack};
  }

  [[nodiscard]] Cache& cache() { return store_.wave.rays.cache; }
  [[nodiscard]] bool is_on_lattice() const {
    return store_.rays.tree.triangle_format == static_cast<std::uint32_t>(TriangleFormat::kLattice);
  }
  [[nodiscard]] static std::uint32_t set_of(TreeChild child) {
    const std::uint32_t bits = child.bits;
    return (bits ^ bits >> 4 ^ bits >> 8 ^ bits >> 27) & (Cache::kSets - 1);
  }
  // Waits for nodes count as those for cell blocks do, waits for leaves as those for triangles.
  [[nodiscard]] std::uint8_t tag_of(std::uint32_t slot) {
    return static_cast<std::uint8_t>((cache().keys[slot] & TreeChild::kLeaf) != 0
                                         ? kFirstTriangleTag + slot % kTriangleTagCount
                                         : kFirstMacroTag + slot % kMacroTagCount);
  }

  // @returns the child's slot, or kSlots.
  [[nodiscard]] std::uint32_t find(TreeChild child) {
    const std::uint32_t first = set_of(child) * Cache::kWays;
    const std::uint32_t* const keys = cache().keys + first;
    if (keys[0] == child.bits) return first;
    if (keys[1] == child.bits) return first + 1;
    if (keys[2] == child.bits) return first + 2;
    return keys[3] == child.bits ? first + 3 : std::uint32_t{Cache::kSlots};
  }

  [[nodiscard]] Status start(TreeChild child, std::uint32_t& slot) {
    slot = set_of(child) * Cache::kWays;
    const std::uint32_t end = slot + Cache::kWays;
    for (std::uint32_t i = slot + 1; i < end; ++i) {
      if (cache().uses[i] < cache().uses[slot]) slot = i;
    }
    if (cache().is_pending[slot] != 0) GRIDIRON_TRY(arrive(slot));
    cache().keys[slot] = child.bits;
    cache().uses[slot] = ++clock_;
    cache().is_pending[slot] = 1;
    const Place place = place_of(child);
    return transfers_.get(cache().slots[slot].bytes + (place.first_byte - place.slack), place.begin, place.bytes,
                          tag_of(slot));
  }

  [[nodiscard]] Status take(TreeChild child, std::uint32_t& slot) {
    slot = find(child);
    if (slot == Cache::kSlots) GRIDIRON_TRY(start(child, slot));
    cache().uses[slot] = ++clock_;
    return cache().is_pending[slot] != 0 ? arrive(slot) : Status::kOk;
  }

  [[nodiscard]] GRIDIRON_OUTLINE Status arrive(std::uint32_t slot) {
    GRIDIRON_TRY(transfers_.wait(tag_of(slot)));
    cache().is_pending[slot] = 0;
    const TreeChild child{cache().keys[slot]};
    if (!child.is_leaf() || !is_on_lattice()) return Status::kOk;
    store_.work.add(Work::kLatticeTriangle, child.count());
    store_.work.charge_to(Work::kLatticeTriangle);
    spread_lattice_run(store_.rays.tree.lattice, cache().slots[slot].bytes, place_of(child).first_byte, child.count());
    return Status::kOk;
  }

  Store& store_;
  Transfers<P>& transfers_;
  std::uint32_t clock_ = 0;
  std::uint32_t surface_ = kNoTriangle;  ///< the triangle that was fetched last for a tie
};

}  // namespace gridiron
