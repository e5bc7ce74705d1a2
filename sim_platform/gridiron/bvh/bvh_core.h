// The cached BVH as an engine: takes the packets of a tile through the hierarchy.
// Source: Benthin, Wald, Scherbaum, Friedrich 2006 (software caches, a ring of packets that hide each other's misses);
// Wald, Boulos, Shirley 2007 (packets). Memory: the local store. Threads: one core.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/bvh/bvh_store.h>
#include <gridiron/bvh/bvh_work.h>
#include <gridiron/bvh/child_order.h>
#include <gridiron/bvh/four_words.h>
#include <gridiron/dma/transfers.h>
#include <gridiron/engine/engine.h>
#include <gridiron/platform/contract.h>
#include <gridiron/ray/camera.h>
#include <gridiron/ray/hits.h>
#include <gridiron/ray/intersect_standard.h>
#include <gridiron/ray/packet_hits.h>
#include <gridiron/store/local_store.h>

#include <cstdint>
#include <type_traits>

namespace gridiron::bvh {

/// The cached BVH on one core; see core/gridiron/engine/engine.h. It traces eye rays only. The caches outlive a tile.
///
/// A packet runs until it needs a line that is not cached. It then starts the get, and the next packet of the ring
/// runs. A packet without others waits at once.
/// @tparam L  Lanes<4>, as on the chip. @tparam Store  LocalStore of a BvhLayout.
template <class L, class Store, Platform P>
class BvhCore {
  static constexpr std::uint32_t kWidth = Store::Layout::kPacketWidth;
  static_assert(EdgeBatch<L>::kTriangles == 1 && (kWidth == 8 || kWidth == 16 || kWidth == 32));
  static_assert(Store::Layout::kEffects == 0, "all its eye rays go through the centres of pixels");

 public:
  BvhCore(Store& store, Transfers<P>& transfers) : store_(store), transfers_(transfers) {}

  /// Errors: kBadFrame for a record that this store cannot serve, kUnsupportedFrame.
  [[nodiscard]] Status begin() {
    GRIDIRON_TRY(check_record());
    caches().node_cache.reset(settings().node_lines);
    caches().triangle_cache.reset(settings().triangle_lines);
    log_line_nodes_ = settings().log_line_nodes;
    log_line_triangles_ = settings().log_line_triangles;
    node_mask_ = (1u << log_line_nodes_) - 1u;
    triangle_mask_ = (1u << log_line_triangles_) - 1u;
    triangle_lines_ = caches().lines + (settings().node_lines << (log_line_nodes_ + kLogNodeBytes));
    least_direction_ = kLeastDirection * direction_bound(frame());
    return Status::kOk;
  }

  void begin_tile() {}

  [[nodiscard]] Status trace_eyes(const TileView& view, const Hits& hits) {
    left_ = view.left;
    top_ = view.top;
    next_x_ = next_y_ = 0;
    hits_ = hits;
    return hits.facing != nullptr ? trace_tile<true>() : trace_tile<false>();
  }

 private:
  using Four = Lanes<4>;
  using StorePacket = Packet<kWidth>;
  using Context = PacketContext<kWidth>;
  /// Subpackets of all quarters: 64 bits only where a packet has so many, since a core's words have 32.
  using QuarterSets = std::conditional_t<(StorePacket::kSubpacketCount > 32), SubpacketSet, std::uint32_t>;
  static constexpr std::uint32_t kLogNodeBytes = 7;
  static_assert(sizeof(BvhNode) == 1u << kLogNodeBytes && kTriangleRecordBytes == 48);
  static constexpr float kLeastDirection = 0x1p-30f;

  [[nodiscard]] const FrameHead& frame() const { return store_.frame; }
  [[nodiscard]] const CoreSettings& settings() const { return store_.frame.engine.settings; }
  [[nodiscard]] typename Store::EngineStore& caches() { return store_.engine; }
  void charge_to(BvhWork kind) { store_.work.charge_to(kind); }
  void count(BvhWork kind, std::uint32_t amount = 1) { store_.work.add(kind, amount); }

  // --- Tiles ------------------------------------------------------------------------------------------------------

  // Runs the packets of the ring in turn until the tile has none left.
  template <bool kWantFacing>
  [[nodiscard]] Status trace_tile() {
    const std::uint32_t ring_size = settings().ring_size;
    std::uint32_t live = 0;
    for (std::uint32_t i = 0; i < ring_size; ++i) {
      if (start_packet(store_.packet.contexts[i])) ++live;
    }
    for (std::uint32_t i = 0; live != 0; i = i + 1 == ring_size ? std::uint32_t{0} : i + 1) {
      Context& context = store_.packet.contexts[i];
      if (context.state == Context::kIdle) continue;
      GRIDIRON_TRY(run_packet<kWantFacing>(context, i));
      if (context.state == Context::kIdle) --live;
    }
    return Status::kOk;
  }

  // Starts the context's next packet of the tile. @returns false if there is none.
  [[nodiscard]] bool start_packet(Context& context) {
    store_.work.charge_to(Work::kTileStart);
    context.state = Context::kIdle;
    if (next_y_ >= kTileWidth || top_ + next_y_ >= frame().height) return false;
    count(BvhWork::kPacketStart);
    const std::uint32_t left = left_ + next_x_;
    const std::uint32_t top = top_ + next_y_;
    context.x = next_x_;
    context.y = next_y_;
    next_x_ += kWidth;
    if (next_x_ >= kTileWidth || left_ + next_x_ >= frame().width) {
      next_x_ = 0;
      next_y_ += kWidth;
    }
    context.child = BvhChild::node(0);
    context.missed = 0;
    context.stack_count = 0;
    context.state = Context::kRunning;
    Four::Float(frame().t_far).store(context.reach);
    context.bounds.set(frame(), left, top, least_direction_, store_.work);
    generate_packet<L>(frame(), left, top, context.packet, context.packet.active, store_.work);
    return true;
  }

  // --- One packet -------------------------------------------------------------------------------------------------

  // State of a running packet.
  struct Cursor {
    BvhChild child;        // to be visited
    std::uint32_t missed;  // quarters that do not meet it
    std::uint32_t top;     // entries on the stack
  };

  // Runs a packet, and those of the tile that follow it in its context, until one is suspended or none is left.
  template <bool kWantFacing>
  [[nodiscard]] Status run_packet(Context& context, std::uint32_t ring_index) {
    Cursor cursor{context.child, context.missed, context.stack_count};
    std::uint32_t slot = kNoSlot;
    if (context.state == Context::kWaiting) {
      context.state = Context::kRunning;
      GRIDIRON_TRY(resume(context, cursor.child, slot));
    }
    for (;;) {
      bool goes_on = false;
      if (cursor.child.is_leaf()) {
        if (slot == kNoSlot) {
          count(BvhWork::kCacheLookup);
          const std::uint32_t line = triangle_line(cursor.child);
          slot = caches().triangle_cache.find(line, ++now_);
          if (slot == kNoSlot) [[unlikely]] {
            GRIDIRON_TRY(fetch_triangles(line, ring_index, slot));
            if (settings().ring_size > 1) return suspend(context, cursor, slot);
          }
        }
        test_leaf<kWantFacing>(context, cursor, slot);
        goes_on = pop(context, cursor);
      } else {
        if (slot == kNoSlot) {
          count(BvhWork::kCacheLookup);
          const std::uint32_t line = node_line(cursor.child);
          slot = caches().node_cache.find(line, ++now_);
          if (slot == kNoSlot) [[unlikely]] {
            GRIDIRON_TRY(fetch_nodes(line, ring_index, slot));
            if (settings().ring_size > 1) return suspend(context, cursor, slot);
          }
        }
        goes_on = step_down(context, cursor, slot);
        if (!goes_on) goes_on = pop(context, cursor);
      }
      slot = kNoSlot;
      if (goes_on) [[likely]]
        continue;
      if (take_unsure_rays(context.packet, frame().t_far, context.packet.active, store_.work)) {
        cursor = {BvhChild::node(0), 0, 0};
        Four::Float(frame().t_far).store(context.reach);
        continue;
      }
      store_hits<L>(context.packet, context.x, context.y, kTileWidth, hits_, store_.work);
      if (!start_packet(context)) return Status::kOk;
      cursor = {BvhChild::node(0), 0, 0};
    }
  }

  // --- Caches -----------------------------------------------------------------------------------------------------

  [[nodiscard]] std::uint32_t node_line(BvhChild child) const { return child.node_index() >> log_line_nodes_; }
  [[nodiscard]] std::uint32_t triangle_line(BvhChild child) const {
    return child.first_triangle() >> log_line_triangles_;
  }

  // Starts the get of a missing line, unless it is on its way already. A packet without others waits for it.
  [[nodiscard]] Status fetch_nodes(std::uint32_t line, std::uint32_t ring_index, std::uint32_t& slot) {
    count(BvhWork::kMiss);
    const auto claim = caches().node_cache.claim(line, now_, ring_index);
    slot = claim.slot;
    if (claim.is_on_its_way) return Status::kOk;
    const std::uint32_t log_bytes = log_line_nodes_ + kLogNodeBytes;
    const MainAddress address{store_.frame.engine.nodes_address + (std::uint64_t{line} << log_bytes)};
    return fetch(caches().node_cache, caches().lines + (slot << log_bytes), address, 1u << log_bytes,
                 kFirstMacroTag + ring_index, slot);
  }
  [[nodiscard]] Status fetch_triangles(std::uint32_t line, std::uint32_t ring_index, std::uint32_t& slot) {
    count(BvhWork::kMiss);
    const auto claim = caches().triangle_cache.claim(line, now_, ring_index);
    slot = claim.slot;
    if (claim.is_on_its_way) return Status::kOk;
    const std::uint64_t first = std::uint64_t{line} << log_line_triangles_;
    const MainAddress address{store_.frame.engine.triangles_address + ((first << 4) + (first << 5))};
    return fetch(caches().triangle_cache, triangle_lines_ + record_bytes(slot << log_line_triangles_), address,
                 record_bytes(1u << log_line_triangles_), kFirstTriangleTag + ring_index, slot);
  }
  template <class Cache>
  [[nodiscard]] Status fetch(Cache& cache, std::byte* target, MainAddress address, std::uint32_t bytes,
                             std::uint32_t tag, std::uint32_t slot) {
    GRIDIRON_TRY(transfers_.get(target, address, bytes, static_cast<std::uint8_t>(tag)));
    if (settings().ring_size > 1) return Status::kOk;
    GRIDIRON_TRY(transfers_.wait(static_cast<std::uint8_t>(tag)));
    cache.end_fill(slot);
    return Status::kOk;
  }
  [[nodiscard]] static std::uint32_t record_bytes(std::uint32_t records) { return (records << 4) + (records << 5); }

  // Suspends the packet in favour of the next one of the ring.
  [[nodiscard]] Status suspend(Context& context, const Cursor& cursor, std::uint32_t slot) {
    count(BvhWork::kSwitch);
    context.child = cursor.child;
    context.missed = cursor.missed;
    context.stack_count = cursor.top;
    context.slot = slot;
    context.state = Context::kWaiting;
    return Status::kOk;
  }

  // Waits for the line that the packet was suspended for, unless another packet has. @param slot  out: kNoSlot if the
  // line has arrived and been replaced.
  [[nodiscard]] Status resume(const Context& context, BvhChild child, std::uint32_t& slot) {
    if (child.is_leaf()) {
      return resume(caches().triangle_cache, triangle_line(child), kFirstTriangleTag, context.slot, slot);
    }
    return resume(caches().node_cache, node_line(child), kFirstMacroTag, context.slot, slot);
  }
  template <class Cache>
  [[nodiscard]] Status resume(Cache& cache, std::uint32_t line, std::uint8_t first_tag, std::uint32_t waited_for,
                              std::uint32_t& slot) {
    const auto arrival = cache.arrival(waited_for, line);
    if (arrival == Cache::Arrival::kReplaced) return Status::kOk;
    slot = waited_for;
    if (arrival == Cache::Arrival::kThere) return Status::kOk;
    GRIDIRON_TRY(transfers_.wait(static_cast<std::uint8_t>(first_tag + cache.filler_of(slot))));
    cache.end_fill(slot);
    return Status::kOk;
  }

  // --- Traversal --------------------------------------------------------------------------------------------------

  // Tests the children of the current node against the packet. The nearest becomes the current one, the others go on
  // the stack, the nearer the higher. @returns false if none is met.
  [[nodiscard]] bool step_down(Context& context, Cursor& cursor, std::uint32_t slot) {
    const std::uint32_t place = (slot << log_line_nodes_) + (cursor.child.node_index() & node_mask_);
    if (context.bounds.is_mixed == 0) [[likely]] {
      count(BvhWork::kNodeStep);
      const BvhNode& node = *reinterpret_cast<const BvhNode*>(caches().lines + (place << kLogNodeBytes));
      return take_nearest(context, cursor, node,
                          context.bounds.template children_met<false>(node, context.packet.origin, context.reach));
    }
    count(BvhWork::kMixedNodeStep);
    const BvhNode& node = *reinterpret_cast<const BvhNode*>(caches().lines + (place << kLogNodeBytes));
    return take_nearest(context, cursor, node,
                        context.bounds.template children_met<true>(node, context.packet.origin, context.reach));
  }

  [[nodiscard]] bool take_nearest(Context& context, Cursor& cursor, const BvhNode& node, const ChildrenMet& met) {
    const std::uint32_t children = met.none.bits() ^ kAllChildren;
    if (children == 0) return false;
    count(BvhWork::kChildren);
    const OrderedChildren ordered(met.entry, met.none, FourWords::load(&node.children[0].bits), met.missed);
    // Children that are not met land above the top.
    ordered.store(reinterpret_cast<float*>(context.stack + cursor.top));
    const std::uint32_t nearest = count_bits(children) - 1u;
    cursor.child.bits = ordered.child.word(nearest);
    cursor.missed = ordered.missed.word(nearest);
    cursor.top += nearest;
    return true;
  }

  // Takes the next entry that is not behind all hits so far. @returns false if none is left.
  [[nodiscard]] bool pop(const Context& context, Cursor& cursor) {
    charge_to(BvhWork::kStackPop);
    while (cursor.top != 0) {
      count(BvhWork::kStackPop);
      --cursor.top;
      const StackEntry& entry = context.stack[cursor.top];
      const std::uint32_t behind = (Four::Float(entry.entry) > Four::Float::load(context.reach)).bits();
      cursor.child = entry.child;
      cursor.missed = entry.missed | behind;
      if (cursor.missed != kAllQuarters) [[likely]]
        return true;
    }
    return false;
  }

  template <bool kWantFacing>
  void test_leaf(Context& context, const Cursor& cursor, std::uint32_t slot) {
    count(BvhWork::kLeafVisit);
    const std::uint32_t first = (slot << log_line_triangles_) + (cursor.child.first_triangle() & triangle_mask_);
    const auto* triangle = reinterpret_cast<const VertexTriangle*>(triangle_lines_ + record_bytes(first));
    // Subpackets do the work of corner rays, and cheaper (as in configuration grid).
    const bool by_subpackets = settings().use_subpackets != 0;
    const Culling culling{.corner_rays = !by_subpackets, .subpackets = by_subpackets};
    const SubpacketSet open = subpackets_of(cursor.missed ^ kAllQuarters);
    SubpacketSet changed = 0;
    static constexpr std::uint32_t kBatch = L::kCount;
    for (std::uint32_t left = cursor.child.triangle_count(); left != 0;) {
      std::uint32_t in_batch = left;
      if (in_batch > kBatch) in_batch = kBatch;
      count(BvhWork::kLeafTriangle, in_batch);
      OpenTriangle touching[kBatch];
      const std::uint32_t touching_count =
          open_triangles<L>(context.packet, triangle, in_batch, open, culling, touching, store_.work);
      changed |=
          intersect_standard_batch<L, kWantFacing>(context.packet, touching, touching_count, culling, store_.work);
      charge_to(BvhWork::kLeafTriangle);
      triangle += in_batch;
      left -= in_batch;
    }
    if (changed != 0) update_reach(context, static_cast<QuarterSets>(changed));
  }

  // The subpackets of some quarters.
  [[nodiscard]] static SubpacketSet subpackets_of(std::uint32_t quarters) {
    if constexpr (kWidth == 8) return quarters;
    if constexpr (kWidth == 32) return subpackets_of_squares(subpackets_of_squares(quarters));
    // Each bit becomes four.
    const std::uint32_t pairs = (quarters | quarters << 6) & 0x0303u;
    const std::uint32_t apart = (pairs | pairs << 3) & 0x1111u;
    return (apart << 4) - apart;
  }

  // The farthest of the rays' nearest hits, of all quarters. Rays beyond the picture's edge stay at t_far.
  void update_reach(Context& context, QuarterSets changed) {
    using Float = Four::Float;
    static constexpr std::uint32_t kQuarterRays = StorePacket::kRayCount / kQuarterCount;
    static constexpr std::uint32_t kQuarterSubpackets = StorePacket::kSubpacketCount / kQuarterCount;
    static constexpr std::uint32_t kSubpacketsOfQuarter = (1u << kQuarterSubpackets) - 1u;
    for (std::uint32_t quarter = 0; quarter < kQuarterCount; ++quarter) {
      if ((changed >> (quarter * kQuarterSubpackets) & kSubpacketsOfQuarter) == 0) continue;
      count(BvhWork::kReach);
      const float* const t = context.packet.t + quarter * kQuarterRays;
      Float farthest = Float::load(t);
      for (std::uint32_t ray = 4; ray < kQuarterRays; ray += 4) farthest = Four::max(farthest, Float::load(t + ray));
      context.reach[quarter] = Four::horizontal_max(farthest) * (1.0f + 2.0f * kEstimateError);
    }
  }

  // --- The frame ---------------------------------------------------------------------------------------------------

  [[nodiscard]] Status check_record() const {
    const CoreSettings& core = settings();
    // At equal distances another accuracy may require the truly nearer triangle; two rays could fetch for that without
    // end.
    if (frame().accuracy != static_cast<std::uint32_t>(Accuracy::kStandard)) return Status::kUnsupportedFrame;
    if (core.packet_width != kWidth || core.ring_size < 1 || core.ring_size > kRingOf<kWidth>) return Status::kBadFrame;
    return are_caches_valid(core) ? Status::kOk : Status::kBadFrame;
  }

  // The largest sum of magnitudes that goes into a direction's component, over the whole picture.
  [[nodiscard]] static float direction_bound(const FrameHead& frame) {
    float bound = 0.0f;
    for (int axis = 0; axis < 3; ++axis) {
      const float width = static_cast<float>(frame.width + kTileWidth);
      const float height = static_cast<float>(frame.height + kTileWidth);
      const float sum = magnitude(frame.corner[axis]) + width * magnitude(frame.step_x[axis]) +
                        height * magnitude(frame.step_y[axis]);
      bound = sum > bound ? sum : bound;
    }
    return bound;
  }

  static constexpr std::uint32_t kAllChildren = (1u << kNodeWidth) - 1u;
  Store& store_;
  Transfers<P>& transfers_;
  std::byte* triangle_lines_ = nullptr;
  std::uint32_t log_line_nodes_ = 0, log_line_triangles_ = 0, node_mask_ = 0, triangle_mask_ = 0;
  float least_direction_ = 0.0f;           ///< directions below this count as zero
  std::uint32_t now_ = 0;                  ///< look-ups
  std::uint32_t left_ = 0, top_ = 0;       ///< of the tile, in pixels
  std::uint32_t next_x_ = 0, next_y_ = 0;  ///< of its next packet
  Hits hits_{};
};

/// The cached BVH as a layout names it.
struct BvhEngine {
  static constexpr std::uint32_t kId = kFirstOtherEngine;
  using Record = BvhRecord;
  template <class Layout>
  using Store = CacheStore<Layout>;
  template <class Layout>
  using EyeStore = RingStore<Layout>;
  template <class Layout>
  using RayStore = void;
  template <class Layout>
  static constexpr bool kTracesEyes = true;
  template <class Layout>
  static constexpr std::uint32_t kMaxRayDepth = 0;
  template <class L, class Store, Platform P>
  using Core = BvhCore<L, Store, P>;
};

/// Sizes of a 256 KB core with the cached BVH. @tparam Width  of a packet, 8, 16 or 32.
template <std::uint32_t Width>
struct BvhLayout {
  using Engine = BvhEngine;
  static constexpr std::uint32_t kEffects = 0;
  static constexpr std::uint32_t kArenaBytes = 256 * 1024;
  static constexpr std::uint32_t kCodeBudgetBytes = 48 * 1024;
  static constexpr std::uint32_t kStackBudgetBytes = 8 * 1024;
  static constexpr std::uint32_t kTileWidth = bvh::kTileWidth;
  static constexpr std::uint32_t kPacketWidth = Width;
  static constexpr std::uint32_t kMaxOutputDepth = kOutputDepth;
};
static_assert(kFitsArena<BvhLayout<8>> && kFitsArena<BvhLayout<16>> && kFitsArena<BvhLayout<32>>);

using BvhStore = LocalStore<BvhLayout<kPacketWidth>>;

}  // namespace gridiron::bvh
