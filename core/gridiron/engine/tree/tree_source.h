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

/// Where a LocalStore keeps the tree's parts while rays of lists are traced.
struct RayParts {
  /// @cond
  template <class Store>
  using Memory = typename Store::RayStore;
  template <class Store>
  static constexpr std::uint32_t kTopNodes = 0;
  template <class Store>
  [[nodiscard]] static GRIDIRON_INLINE const TreeRecord& tree(const Store& store) {
    return store.rays.tree;
  }
  template <class Store>
  [[nodiscard]] static GRIDIRON_INLINE Memory<Store>& memory(Store& store) {
    return store.wave.rays;
  }
  /// @endcond
};
/// And while eye rays are.
struct EyeParts {
  /// @cond
  template <class Store>
  using Memory = typename Store::EyeStore;
  template <class Store>
  static constexpr std::uint32_t kTopNodes = decltype(Store::engine)::kTopNodes;
  template <class Store>
  [[nodiscard]] static GRIDIRON_INLINE const TreeRecord& tree(const Store& store) {
    return store.engine.tree;
  }
  template <class Store>
  [[nodiscard]] static GRIDIRON_INLINE Memory<Store>& memory(Store& store) {
    return store.packet;
  }
  /// @endcond
};

/// A source of RayLists and TileTracer.
/// @tparam Store  LocalStore of a layout whose rays this engine traces. @tparam Parts  RayParts or EyeParts.
template <class L, class Store, Platform P, class Parts = RayParts>
class TreeSource {
 public:
  TreeSource(Store& store, Transfers<P>& transfers) : store_(store), transfers_(transfers) {}

  /// The store has another tree's record.
  void begin() {
    const TreeRecord& tree = Parts::tree(store_);
    nodes_ = store_.frame.image_address + tree.nodes_offset_bytes;
    triangles_ = store_.frame.image_address + tree.triangles_offset_bytes;
    is_on_lattice_ = tree.triangle_format == static_cast<std::uint32_t>(TriangleFormat::kLattice);
    if constexpr (InPlaceReader<P>) {
      is_in_place_ = !is_on_lattice_ && transfers_.in_place(MainAddress{nodes_}) != nullptr;
    }
  }

  /// Fetches the first nodes, if the store has a place for them. After begin().
  [[nodiscard]] Status fetch_top() {
    if constexpr (Parts::template kTopNodes<Store> != 0) {
      if (is_in_place_) return Status::kOk;
      const std::uint32_t there = Parts::tree(store_).node_count;
      top_count_ = there < Parts::template kTopNodes<Store> ? there : Parts::template kTopNodes<Store>;
      GRIDIRON_TRY(transfers_.get(store_.engine.top.nodes, MainAddress{nodes_},
                                  top_count_ * std::uint32_t{sizeof(TreeNode)}, kSetupTag));
      return transfers_.wait(kSetupTag);
    }
    return Status::kOk;
  }

  /// Discards what the cache has. Precondition: nothing is pending.
  void forget() {
    for (std::uint32_t i = 0; i < Cache::kSlots; ++i) cache().keys[i] = Cache::kNoKey;
    for (std::uint32_t i = 0; i < Cache::kSets; ++i) cache().turns[i] = 0;
    pending_ = wanted_ = fetched_ = 0;
    surface_ = kNoTriangle;
  }

  /// Children under way at once.
  [[nodiscard]] std::uint32_t window() const { return store_.frame.fetch_depth; }

  [[nodiscard]] Status ahead(TreeChild child) {
    if constexpr (InPlaceReader<P>) {
      if (is_in_place_) {
        const std::byte* const bytes = in_place<std::byte>(child);
        const std::uint32_t count =
            child.is_leaf() ? child.count() * kTriangleRecordBytes : std::uint32_t{sizeof(TreeNode)};
        for (std::uint32_t offset = 0; offset < count; offset += 64) __builtin_prefetch(bytes + offset);
        return Status::kOk;
      }
    }
    if constexpr (Parts::template kTopNodes<Store> != 0) {
      if (!child.is_leaf() && child.node_index() < top_count_) return Status::kOk;
    }
    std::uint32_t slot = 0;
    if (find(child, slot) != 0) return Status::kOk;
    return start(child, slot);
  }

  [[nodiscard]] Status node(std::uint32_t index, const TreeNode*& node) {
    if constexpr (InPlaceReader<P>) {
      if (is_in_place_) {
        node = in_place<TreeNode>(TreeChild::node(index));
        return Status::kOk;
      }
    }
    if constexpr (Parts::template kTopNodes<Store> != 0) {
      if (index < top_count_) {
        node = &store_.engine.top.nodes[index];
        return Status::kOk;
      }
    }
    std::uint32_t slot = 0;
    GRIDIRON_TRY(take(TreeChild::node(index), slot));
    node = reinterpret_cast<const TreeNode*>(cache().slots[slot].bytes);
    return Status::kOk;
  }

  [[nodiscard]] Status leaf(TreeChild child, const VertexTriangle*& records) {
    if constexpr (InPlaceReader<P>) {
      if (is_in_place_) {
        records = in_place<VertexTriangle>(child);
        return Status::kOk;
      }
    }
    std::uint32_t slot = 0;
    GRIDIRON_TRY(take(child, slot));
    records = records_of(slot, child);
    return Status::kOk;
  }

  /// A record by its number in the tree: mostly of a leaf that is still at hand.
  [[nodiscard]] GRIDIRON_OUTLINE Status record(std::uint32_t number, VertexTriangle& triangle) {
    if constexpr (InPlaceReader<P>) {
      if (is_in_place_) {
        triangle = *in_place<VertexTriangle>(TreeChild::leaf(number, 1));
        return Status::kOk;
      }
    }
    for (std::uint32_t slot = 0; slot < Cache::kSlots; ++slot) {
      const TreeChild leaf{cache().keys[slot]};
      const std::uint32_t place = number - leaf.first();
      if (!leaf.is_leaf() || leaf.bits == Cache::kNoKey || place >= leaf.count()) continue;
      if ((pending_ >> slot & 1u) != 0) GRIDIRON_TRY(arrive(slot));
      triangle = records_of(slot, leaf)[place];
      return Status::kOk;
    }
    std::byte* const bytes = Parts::memory(store_).surface_bytes;
    const TreeChild child = TreeChild::leaf(number, 1);
    const std::uint64_t address = leaf_address(child);
    // Where one open pixel is, its neighbours are.
    const std::uint32_t first_byte = is_on_lattice_ ? std::uint32_t{0} : first_byte_of(address);
    if (number != surface_) {
      const Moved moved = moved_of(address, child);
      GRIDIRON_TRY(transfers_.get(bytes + (first_byte_of(address) - moved.slack), MainAddress{address - moved.slack},
                                  moved.bytes, kSetupTag));
      GRIDIRON_TRY(transfers_.wait(kSetupTag));
      if (is_on_lattice_) {
        store_.work.add(Work::kLatticeTriangle);
        spread_lattice_run(Parts::tree(store_).lattice, bytes, first_byte_of(address), 1);
      }
      surface_ = number;
    }
    triangle = *reinterpret_cast<const VertexTriangle*>(bytes + first_byte);
    return Status::kOk;
  }

  /// Waits for what was asked for and not taken.
  [[nodiscard]] Status finish() {
    while (pending_ != 0) GRIDIRON_TRY(arrive(lowest_bit(pending_)));
    return Status::kOk;
  }

  [[nodiscard]] Status triangle_of(MainAddress surfaces, std::uint32_t id, VertexTriangle& triangle) {
    const MainAddress address{surfaces.value + std::uint64_t{id} * sizeof(SurfaceRecord)};
    std::byte* const place = Parts::memory(store_).surface_bytes + address.value % kPortableCongruenceBytes;
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
  using Cache = typename Parts::template Memory<Store>::Cache;

  // A child where it lies. Triangles of a lattice are made of what is fetched, and nodes beside them go the same way.
  template <class Element>
  [[nodiscard]] GRIDIRON_INLINE const Element* in_place(TreeChild child) const {
    const std::uint64_t address = child.is_leaf() ? leaf_address(child) : node_address(child);
    return reinterpret_cast<const Element*>(transfers_.in_place(MainAddress{address}));
  }

  [[nodiscard]] Cache& cache() { return Parts::memory(store_).cache; }

  [[nodiscard]] const VertexTriangle* records_of(std::uint32_t slot, TreeChild leaf) {
    const std::uint32_t first_byte = is_on_lattice_ ? std::uint32_t{0} : first_byte_of(leaf_address(leaf));
    return reinterpret_cast<const VertexTriangle*>(cache().slots[slot].bytes + first_byte);
  }

  // Where they lie in main memory.
  [[nodiscard]] std::uint64_t node_address(TreeChild child) const {
    return nodes_ + std::uint64_t{child.node_index()} * sizeof(TreeNode);
  }
  [[nodiscard]] std::uint64_t leaf_address(TreeChild child) const {
    static_assert(sizeof(VertexTriangle) == 48 && sizeof(LatticeTriangle) == 24);
    const std::uint64_t thirds = child.first() * std::uint32_t{3};
    return triangles_ + (thirds << (is_on_lattice_ ? 3 : 4));
  }
  // And in its slot, if it is a leaf.
  [[nodiscard]] static std::uint32_t first_byte_of(std::uint64_t address) {
    return static_cast<std::uint32_t>(address) % kPortableCongruenceBytes;
  }
  // Waits for nodes count as those for cell blocks do, waits for leaves as those for triangles. Where slots are more
  // than tags, these go round, so that a wait for one child hardly ever is for another that was asked for later.
  static constexpr std::uint32_t kTags = kMacroTagCount;
  static_assert(kTags <= kTriangleTagCount);
  static constexpr bool kHasTagOfEachSlot = Cache::kSlots <= kTags;
  [[nodiscard]] static std::uint8_t tag_of(std::uint32_t number, TreeChild child) {
    const std::uint32_t first = child.is_leaf() ? std::uint32_t{kFirstTriangleTag} : std::uint32_t{kFirstMacroTag};
    return static_cast<std::uint8_t>(first + number);
  }
  [[nodiscard]] std::uint8_t next_tag(std::uint32_t slot, TreeChild child) {
    if constexpr (kHasTagOfEachSlot) return tag_of(slot, child);
    const std::uint8_t tag = tag_of(fetched_ % kTags, child);
    ++fetched_;
    cache().tags[slot] = tag;
    return tag;
  }

  // Finds the ways that have a child, as bits: one or none. @param slot  gets that of the first way.
  [[nodiscard]] GRIDIRON_INLINE std::uint32_t find(TreeChild child, std::uint32_t& slot) {
    slot = ((child.bits ^ child.bits >> 3) & (Cache::kSets - 1)) * Cache::kWays;
    const std::uint32_t* const keys = cache().keys + slot;
    std::uint32_t found = 0;
    if constexpr (L::kCount == 1) {
      for (std::uint32_t way = 0; way < Cache::kWays; ++way) {
        if (keys[way] == child.bits) found = 1u << way;
      }
    } else {
      found = Lanes<4>::equal(child.bits, keys).bits();
    }
    return found;
  }

  // @param first_then_taken  the slot of the first way, as find() left it; gets the child's.
  [[nodiscard]] GRIDIRON_OUTLINE Status start(TreeChild child, std::uint32_t& first_then_taken) {
    const std::uint32_t first = first_then_taken;
    std::uint32_t& turn = cache().turns[first / Cache::kWays];
    // Of those that were taken, or of all, the one that was fetched longest ago makes room.
    std::uint32_t way = turn;
    for (std::uint32_t i = 0; i < Cache::kWays && (wanted_ >> (first + way) & 1u) != 0; ++i) {
      way = (way + 1) % Cache::kWays;
    }
    turn = (way + 1) % Cache::kWays;
    const std::uint32_t slot = first + way;
    first_then_taken = slot;
    wanted_ |= 1u << slot;
    if ((pending_ >> slot & 1u) != 0) GRIDIRON_TRY(arrive(slot));
    cache().keys[slot] = child.bits;
    pending_ |= 1u << slot;
    if (!child.is_leaf()) {
      return transfers_.get(cache().slots[slot].bytes, MainAddress{node_address(child)}, sizeof(TreeNode),
                            next_tag(slot, child));
    }
    const std::uint64_t address = leaf_address(child);
    const Moved moved = moved_of(address, child);
    return transfers_.get(cache().slots[slot].bytes + (first_byte_of(address) - moved.slack),
                          MainAddress{address - moved.slack}, moved.bytes, next_tag(slot, child));
  }
  // Records of half the length start and end between the multiples of 16 bytes that a transfer moves.
  struct Moved {
    std::uint32_t slack, bytes;
  };
  [[nodiscard]] GRIDIRON_INLINE Moved moved_of(std::uint64_t address, TreeChild child) const {
    static constexpr std::uint32_t kStep = kPortableGranuleBytes;
    const std::uint32_t slack = static_cast<std::uint32_t>(address) % kStep;
    const std::uint32_t length = child.count() * (is_on_lattice_ ? std::uint32_t{24} : std::uint32_t{48});
    return {slack, (slack + length + (kStep - 1)) & ~(kStep - 1)};
  }

  [[nodiscard]] GRIDIRON_OUTLINE Status take(TreeChild child, std::uint32_t& slot) {
    const std::uint32_t found = find(child, slot);
    if (found == 0) {
      GRIDIRON_TRY(start(child, slot));
    } else {
      slot += lowest_bit(found);
    }
    wanted_ &= ~(1u << slot);
    return (pending_ >> slot & 1u) != 0 ? arrive(slot) : Status::kOk;
  }

  [[nodiscard]] GRIDIRON_OUTLINE Status arrive(std::uint32_t slot) {
    const TreeChild child{cache().keys[slot]};
    GRIDIRON_TRY(transfers_.wait(kHasTagOfEachSlot ? tag_of(slot, child) : cache().tags[slot]));
    pending_ &= ~(1u << slot);
    return is_on_lattice_ && child.is_leaf() ? spread(slot, child) : Status::kOk;
  }
  [[nodiscard]] GRIDIRON_OUTLINE Status spread(std::uint32_t slot, TreeChild child) {
    store_.work.add(Work::kLatticeTriangle, child.count());
    store_.work.charge_to(Work::kLatticeTriangle);
    spread_lattice_run(Parts::tree(store_).lattice, cache().slots[slot].bytes, first_byte_of(leaf_address(child)),
                       child.count());
    return Status::kOk;
  }

  Store& store_;
  Transfers<P>& transfers_;
  std::uint64_t nodes_ = 0, triangles_ = 0;  ///< where they begin in main memory
  std::uint32_t top_count_ = 0;              ///< nodes that stay for the frame
  std::uint32_t wanted_ = 0;                 ///< slots that were asked for and not taken yet, as bits
  std::uint32_t pending_ = 0;                ///< slots whose transfers were not waited for yet, as bits
  std::uint32_t fetched_ = 0;                ///< children since forget()
  std::uint32_t surface_ = kNoTriangle;      ///< the triangle that was fetched last for a tie
  bool is_on_lattice_ = false;
  bool is_in_place_ = false;  ///< where the platform is an InPlaceReader
};

}  // namespace gridiron
