// What runs on a core of the rival: claims tiles, takes their packets through the hierarchy, puts the pixels.
// Source: Benthin, Wald, Scherbaum, Friedrich 2006 (software caches, a ring of packets that hide each other's misses);
// Wald, Boulos, Shirley 2007 (packets). Memory: the local store. Threads: one core.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/platform/contract.h>
#include <gridiron/ray/intersect_standard.h>
#include <gridiron/render/camera.h>
#include <gridiron/render/shading.h>
#include <gridiron/rival/rival_store.h>
#include <gridiron/rival/rival_work.h>
#include <gridiron/store/transfers.h>

#include <cstdint>

namespace gridiron::rival {

/// Renders tiles of one frame on one core. The caches outlive a tile.
///
/// A packet runs until a line that it needs is not there; it starts the get and the next packet of the ring runs. A
/// packet alone waits at once. A line stays while a packet waits for it.
/// @tparam L  Lanes<4>, as on the chip.
template <class L, Platform P>
class BvhCore {
 public:
  BvhCore(RivalStore& store, P& platform) : store_(store), transfers_(platform, store.work) {}

  /// Renders every tile this core can claim of the frame whose RivalFrameRecord lies at `record`.
  ///
  /// Errors: kBadFrame for a record that this store cannot serve; kAborted, kDeadline between tiles; whatever the
  /// platform's transfers report. All transfers have been waited for when kOk is returned.
  [[nodiscard]] Status run(MainAddress record) {
    store_.work = WorkCounters{};
    GRIDIRON_TRY(transfers_.get(&store_.record, record, sizeof(RivalFrameRecord), kSetupTag));
    GRIDIRON_TRY(transfers_.wait(kSetupTag));
    GRIDIRON_TRY(check_record());
    store_.node_cache.reset(settings().node_lines);
    store_.triangle_cache.reset(settings().triangle_lines);
    triangle_lines_ = store_.lines + settings().node_lines * node_line_bytes();
    extent_ = extent_of(store_.record.low, store_.record.high, frame().eye);
    dir_bound_ = direction_bound(frame());
    reserve_output();
    for (TileClaim claim = transfers_.claim_tile();; claim = transfers_.claim_tile()) {
      if (claim.kind == TileClaim::Kind::kAborted) return finish(Status::kAborted);
      if (claim.kind == TileClaim::Kind::kDeadline) return finish(Status::kDeadline);
      if (claim.kind == TileClaim::Kind::kNone) return finish(Status::kOk);
      GRIDIRON_TRY(render_tile(claim.tile_id));
    }
  }

 private:
  using StorePacket = PacketContext::StorePacket;
  static constexpr std::uint32_t kPlaneBytes = kTilePixels * sizeof(std::uint32_t);

  [[nodiscard]] const FrameRecord& frame() const { return store_.record.frame; }
  [[nodiscard]] const CoreSettings& settings() const { return store_.record.settings; }
  [[nodiscard]] std::uint32_t node_line_bytes() const {
    return settings().line_nodes * static_cast<std::uint32_t>(sizeof(BvhNode));
  }
  [[nodiscard]] std::uint32_t triangle_line_bytes() const { return settings().line_triangles * kTriangleRecordBytes; }
  void charge_to(RivalWork kind) { store_.work.charge_to(carrier_of(kind)); }
  void count(RivalWork kind, std::uint32_t amount = 1) { store_.work.add(carrier_of(kind), amount); }

  // --- Tiles ------------------------------------------------------------------------------------------------------

  [[nodiscard]] Status render_tile(std::uint32_t tile_id) {
    if (tile_id >= frame().tiles_x * frame().tiles_y) return Status::kBadFrame;
    store_.work.add(Work::kTileStart);
    left_ = tile_id % frame().tiles_x * kTileWidth;
    top_ = tile_id / frame().tiles_x * kTileWidth;
    next_x_ = next_y_ = 0;

    // The output buffer's last tile must have left.
    output_slot_ = (output_slot_ + 1) % kOutputDepth;
    const auto tag = static_cast<std::uint8_t>(kFirstOutputTag + output_slot_);
    GRIDIRON_TRY(transfers_.wait(tag));
    if (frame().shading == static_cast<std::uint32_t>(Shading::kSimple)) {
      GRIDIRON_TRY(trace_tile<true>());
    } else {
      GRIDIRON_TRY(trace_tile<false>());
    }
    store_.work.charge_to(Work::kTileStart);
    GRIDIRON_TRY(put_tile(tile_id, tag));
    return waits_for_output_ ? transfers_.wait(tag) : Status::kOk;
  }

  // Lets the packets of the ring take turns until the tile has none left.
  template <bool kWantFacing>
  [[nodiscard]] Status trace_tile() {
    const std::uint32_t ring_size = settings().ring_size;
    std::uint32_t live = 0;
    for (std::uint32_t i = 0; i < ring_size; ++i) live += start_packet(store_.contexts[i]) ? 1u : 0u;
    std::uint32_t last = 0;
    for (std::uint32_t i = 0; live != 0; i = i + 1 == ring_size ? 0 : i + 1) {
      PacketContext& context = store_.contexts[i];
      if (context.state == PacketContext::kIdle) continue;
      if (i != last) count(RivalWork::kSwitch);
      last = i;
      GRIDIRON_TRY(run_packet<kWantFacing>(context, i));
      if (context.state == PacketContext::kIdle) --live;
    }
    return Status::kOk;
  }

  // The context's next packet of the tile. @returns false where there is none.
  [[nodiscard]] bool start_packet(PacketContext& context) {
    store_.work.charge_to(Work::kPacketStart);
    context.state = PacketContext::kIdle;
    if (next_y_ >= kTileWidth || top_ + next_y_ >= frame().height) return false;
    context.x = next_x_;
    context.y = next_y_;
    next_x_ += kPacketWidth;
    if (next_x_ >= kTileWidth || left_ + next_x_ >= frame().width) {
      next_x_ = 0;
      next_y_ += kPacketWidth;
    }
    generate_packet<L>(frame(), left_ + context.x, top_ + context.y, context.packet, context.packet.active,
                       store_.work);
    store_.work.add(Work::kPacketStart);
    const bool ray_tests = settings().ray_tests != RayTests::kNone;
    context.bounds.template set<L>(context.packet, extent_, dir_bound_, ray_tests);
    if (ray_tests) count(RivalWork::kReciprocalGroup, StorePacket::kRayCount / L::kCount);
    for (float& reach : context.reach) reach = frame().t_far;
    context.largest_reach = frame().t_far;
    context.stack_count = 0;
    context.current = {BvhChild::node(0), 0.0f, 0};
    context.state = PacketContext::kRunning;
    return true;
  }

  // --- One packet -------------------------------------------------------------------------------------------------

  // Runs a packet, and those of the tile that follow it in its context, until one has to wait or none is left.
  template <bool kWantFacing>
  [[nodiscard]] Status run_packet(PacketContext& context, std::uint32_t ring_index) {
    for (;;) {
      bool arrived = false;
      if (context.state == PacketContext::kWaiting) {
        context.state = PacketContext::kRunning;
        arrived = context.slot != kNoSlot;
        if (arrived) GRIDIRON_TRY(take_line(context));
      }
      if (!arrived) {
        bool is_there = false;
        GRIDIRON_TRY(look_up(context, ring_index, is_there));
        if (!is_there) {
          context.state = PacketContext::kWaiting;
          if (settings().ring_size > 1) return Status::kOk;
          continue;
        }
      }
      if (context.current.child.is_leaf()) {
        test_leaf<kWantFacing>(context);
        if (pop(context)) continue;
      } else if (step_down(context) || pop(context)) {
        continue;
      }
      shade_packet<L>(frame(), context.packet, context.x, context.y, store_.output[output_slot_], store_.work);
      if (!start_packet(context)) return Status::kOk;
    }
  }

  // Looks for the line of context.current. Where it is not there, context.slot is the one to wait for, or kNoSlot.
  [[nodiscard]] Status look_up(PacketContext& context, std::uint32_t ring_index, bool& is_there) {
    count(RivalWork::kCacheLookup);
    const BvhChild child = context.current.child;
    if (child.is_leaf()) {
      return look_up(store_.triangle_cache, child.first_triangle() / settings().line_triangles, triangle_lines_,
                     triangle_line_bytes(), store_.record.triangles_address, kFirstTriangleTag + ring_index, context,
                     is_there);
    }
    return look_up(store_.node_cache, child.node_index() / settings().line_nodes, store_.lines, node_line_bytes(),
                   store_.record.nodes_address, kFirstMacroTag + ring_index, context, is_there);
  }

  template <class Cache>
  [[nodiscard]] Status look_up(Cache& cache, std::uint32_t line, std::byte* lines, std::uint32_t line_bytes,
                               std::uint64_t address, std::uint32_t tag, PacketContext& context, bool& is_there) {
    const auto found = cache.find(line);
    context.slot = found.slot;
    is_there = found.answer == Cache::Answer::kHit;
    if (is_there || found.answer == Cache::Answer::kFull) return Status::kOk;
    cache.pin(found.slot);
    if (found.answer == Cache::Answer::kPending) return Status::kOk;
    count(RivalWork::kRefill);
    cache.begin_fill(found.slot, tag);
    return transfers_.get(lines + found.slot * line_bytes, MainAddress{address + std::uint64_t{line} * line_bytes},
                          line_bytes, static_cast<std::uint8_t>(tag));
  }

  // Waits for the line that the packet was suspended for, unless another packet has.
  [[nodiscard]] Status take_line(PacketContext& context) {
    return context.current.child.is_leaf() ? take_line(store_.triangle_cache, context.slot)
                                           : take_line(store_.node_cache, context.slot);
  }
  template <class Cache>
  [[nodiscard]] Status take_line(Cache& cache, std::uint32_t slot) {
    if (cache.is_pending(slot)) {
      GRIDIRON_TRY(transfers_.wait(static_cast<std::uint8_t>(cache.tag_of(slot))));
      cache.end_fill(slot);
    }
    cache.unpin(slot);
    return Status::kOk;
  }

  // Holds the children of the current node against the packet; the nearest becomes the current one, the others go on
  // the stack, the nearer the higher. @returns false where none is met.
  [[nodiscard]] bool step_down(PacketContext& context) {
    const std::uint32_t place = context.current.child.node_index() % settings().line_nodes;
    const BvhNode& node =
        reinterpret_cast<const BvhNode*>(store_.lines + context.slot * node_line_bytes())[place];
    count(RivalWork::kNodeStep);
    alignas(16) float entry[kNodeWidth];
    std::uint32_t met = context.bounds.children_met(node, context.largest_reach, entry);
    StackEntry sorted[kNodeWidth];
    std::uint32_t met_count = 0;
    for (; met != 0; met &= met - 1) {
      const auto i = lowest_bit(met);
      const BvhChild child = node.children[i];
      std::uint32_t group = context.current.first_group;
      const RayTests tests = settings().ray_tests;
      if (tests == RayTests::kAll || (tests == RayTests::kLeaves && child.is_leaf())) {
        std::uint32_t tested = 0;
        count(RivalWork::kBoxSetup);
        group = context.bounds.template first_group_met<L>(context.packet, node, i, group, tested, store_.work);
        if (group == PacketContext::StorePacket::kRayCount / L::kCount) continue;
      }
      count(RivalWork::kChildPush);
      std::uint32_t position = met_count;
      ++met_count;
      for (; position > 0 && sorted[position - 1].entry < entry[i]; --position) sorted[position] = sorted[position - 1];
      sorted[position] = {child, entry[i], group};
    }
    charge_to(RivalWork::kChildPush);
    if (met_count == 0) return false;
    for (std::uint32_t i = 0; i + 1 < met_count; ++i) {
      context.stack[context.stack_count] = sorted[i];
      ++context.stack_count;
    }
    context.current = sorted[met_count - 1];
    return true;
  }

  // Takes the next entry that is not behind everything hit so far. @returns false where none is left.
  [[nodiscard]] bool pop(PacketContext& context) {
    charge_to(RivalWork::kStackPop);
    while (context.stack_count != 0) {
      count(RivalWork::kStackPop);
      --context.stack_count;
      context.current = context.stack[context.stack_count];
      if (context.current.entry <= context.largest_reach) return true;
    }
    return false;
  }

  template <bool kWantFacing>
  void test_leaf(PacketContext& context) {
    const BvhChild child = context.current.child;
    const auto* const line =
        reinterpret_cast<const VertexTriangle*>(triangle_lines_ + context.slot * triangle_line_bytes());
    const VertexTriangle* const triangles = line + child.first_triangle() % settings().line_triangles;
    count(RivalWork::kLeafVisit);
    // Subpackets do what corner rays would, and cheaper (as in the grid's configuration best).
    const bool by_subpackets = settings().use_subpackets != 0;
    const Culling culling{.corner_rays = !by_subpackets, .subpackets = by_subpackets};
    // Subpackets that the leaf's box may be met by, and that have not hit anything nearer.
    SubpacketSet open = 0;
    store_.work.add(Work::kReachGroup);
    for (std::uint32_t i = context.current.first_group * L::kCount / kSubpacketRays; i < StorePacket::kSubpacketCount;
         ++i) {
      if (context.current.entry <= context.reach[i]) open |= SubpacketSet{1} << i;
    }
    SubpacketSet changed = 0;
    constexpr std::uint32_t kBatch = EdgeBatch<L>::kTriangles;
    charge_to(RivalWork::kLeafVisit);
    for (std::uint32_t i = 0; i < child.triangle_count(); i += kBatch) {
      const VertexTriangle* batch[kBatch];
      SubpacketSet subpackets[kBatch];
      std::uint32_t in_batch = 0;
      for (; in_batch < kBatch && i + in_batch < child.triangle_count(); ++in_batch) {
        batch[in_batch] = triangles + i + in_batch;
        subpackets[in_batch] = open;
      }
      changed |= intersect_standard_batch<L, kWantFacing>(context.packet, batch, subpackets, in_batch, culling,
                                                          store_.work);
      charge_to(RivalWork::kLeafVisit);
    }
    if (changed != 0) update_reach(context, changed);
  }

  void update_reach(PacketContext& context, SubpacketSet changed) {
    using Float = typename L::Float;
    for_each_subpacket<StorePacket::kSubpacketCount>(changed, [&](std::uint32_t subpacket) {
      Float farthest(0.0f);
      const std::uint32_t first_ray = subpacket * kSubpacketRays;
      for (std::uint32_t base = first_ray; base < first_ray + kSubpacketRays; base += L::kCount) {
        store_.work.add(Work::kReachGroup);
        const auto active = L::mask_from_bits(context.packet.active.template group<L>(base));
        farthest = L::max(farthest, L::select(active, Float::load(context.packet.t + base), Float(0.0f)));
      }
      context.reach[subpacket] = L::horizontal_max(farthest);
    });
    store_.work.add(Work::kReachGroup);
    context.largest_reach = 0.0f;
    for (const float reach : context.reach) {
      context.largest_reach = reach > context.largest_reach ? reach : context.largest_reach;
    }
  }

  // --- Output -----------------------------------------------------------------------------------------------------

  // As the grid's tile renderer does: tiles on their way have places of their own in the queue, or have left before the
  // next one begins.
  void reserve_output() {
    constexpr std::uint32_t kLeastInputCommands = 4;
    std::uint32_t commands = 0;
    for (const std::uint64_t plane : {frame().color_address, frame().depth_address, frame().id_address}) {
      constexpr std::uint32_t kPieces = (kPlaneBytes + kPortableBoundaryBytes - 1) / kPortableBoundaryBytes;
      if (plane != 0) commands += kPieces + (plane % kPortableBoundaryBytes != 0 ? 1 : 0);
    }
    commands *= kOutputDepth;
    waits_for_output_ = commands + kLeastInputCommands > transfers_.queue_depth();
    if (!waits_for_output_) transfers_.reserve_for_output(commands);
  }

  [[nodiscard]] Status put_tile(std::uint32_t tile_id, std::uint8_t tag) {
    const RivalStore::TileOutput& output = store_.output[output_slot_];
    const std::uint64_t offset = std::uint64_t{tile_id} * kPlaneBytes;
    GRIDIRON_TRY(transfers_.put(output.color, MainAddress{frame().color_address + offset}, kPlaneBytes, tag));
    if (frame().depth_address != 0) {
      GRIDIRON_TRY(transfers_.put(output.depth, MainAddress{frame().depth_address + offset}, kPlaneBytes, tag));
    }
    if (frame().id_address != 0) {
      GRIDIRON_TRY(transfers_.put(output.id, MainAddress{frame().id_address + offset}, kPlaneBytes, tag));
    }
    return Status::kOk;
  }

  // Waits for the tiles still on their way, the oldest first.
  [[nodiscard]] Status finish(Status outcome) {
    for (std::uint32_t i = 0; i < kOutputDepth; ++i) {
      output_slot_ = (output_slot_ + 1) % kOutputDepth;
      GRIDIRON_TRY(transfers_.wait(static_cast<std::uint8_t>(kFirstOutputTag + output_slot_)));
    }
    return outcome;
  }

  [[nodiscard]] Status check_record() const {
    const CoreSettings& core = settings();
    if (frame().magic != kFrameMagic || frame().version != kFrameVersion) return Status::kBadFrame;
    if (frame().tile_width != kTileWidth || frame().output_depth != kOutputDepth) return Status::kBadFrame;
    if (core.ring_size < 1 || core.ring_size > kMaxRing) return Status::kBadFrame;
    const auto lines_ok = [](std::uint32_t lines, std::uint32_t most) {
      return lines >= kCacheWays && lines <= most && lines % kCacheWays == 0;
    };
    if (!lines_ok(core.node_lines, kMaxNodeLines) || !lines_ok(core.triangle_lines, kMaxTriangleLines) ||
        core.line_nodes == 0 || core.line_triangles == 0) {
      return Status::kBadFrame;
    }
    const std::uint64_t bytes = std::uint64_t{core.node_lines} * node_line_bytes() +
                                std::uint64_t{core.triangle_lines} * triangle_line_bytes();
    return bytes <= kCacheBytes ? Status::kOk : Status::kBadFrame;
  }

  // The largest sum of magnitudes that goes into a component of a direction, over the whole picture.
  [[nodiscard]] static float direction_bound(const FrameRecord& frame) {
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

  static constexpr std::uint32_t kNoSlot = 0xFFFFFFFFu;
  RivalStore& store_;
  Transfers<P> transfers_;
  std::byte* triangle_lines_ = nullptr;
  SceneExtent extent_{};
  float dir_bound_ = 0.0f;
  std::uint32_t output_slot_ = kOutputDepth - 1;
  bool waits_for_output_ = true;
  std::uint32_t left_ = 0, top_ = 0;       ///< of the tile, in pixels
  std::uint32_t next_x_ = 0, next_y_ = 0;  ///< of its next packet
};

}  // namespace gridiron::rival
