// The wide tree as an engine of eye rays: a tile of the frame is made of smaller ones, each traced whole; they take
// turns, so that one is worked on while another waits for what it has fetched.
// Source: own; core/TREE.md. Memory: its parts of the local store. Threads: one core.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/accuracies.h>
#include <gridiron/base/frame_rules.h>
#include <gridiron/base/records.h>
#include <gridiron/base/tree_records.h>
#include <gridiron/dma/tags.h>
#include <gridiron/dma/transfers.h>
#include <gridiron/engine/tree/tile_memory.h>
#include <gridiron/engine/tree/tile_projection.h>
#include <gridiron/engine/tree/tile_tracer.h>
#include <gridiron/engine/tree/tree_source.h>
#include <gridiron/engine/tree/tree_store.h>
#include <gridiron/platform/contract.h>
#include <gridiron/ray/hits.h>

#include <cstddef>
#include <cstdint>

namespace gridiron {

/// The first nodes of the tree, which stay for the frame.
template <std::uint32_t Count>
struct alignas(128) TopNodes {
  TreeNode nodes[Count];
};
template <>
struct TopNodes<0> {};

/// Memory for the whole frame. @tparam TopCount  first nodes that stay.
template <std::uint32_t TopCount>
struct alignas(128) TileStore {
  static constexpr std::uint32_t kTopNodes = TopCount;

  TreeRecord tree;
  EyeProjection eye;
  [[no_unique_address]] TopNodes<TopCount> top;

  /// Calls visit(name, offset_bytes, bytes) for every region, in address order.
  template <class Visit>
  static constexpr void for_each_region(Visit&& visit) {
    visit("tree", 0, sizeof(TileStore));
  }
};

/// Memory while eye rays are traced.
template <class Layout>
struct alignas(128) TileEyeStore {
  static constexpr std::uint32_t kWidth = Layout::kEyeTileWidth;
  static constexpr std::uint32_t kTurns = Layout::kEyeTurns;
  static_assert(kTurns == 1 || kTurns == 2, "trace_eyes() has a tracer for each");
  static constexpr std::uint32_t kMostLanes = Layout::kMostLanes;
  using Tile = TileMemory<kWidth, kMostLanes>;
  using Cache = TreeCache<Layout::kEyeSlots, Layout::kLeafTriangles>;
  static_assert(Layout::kTileWidth % kWidth == 0);

  Tile tiles[kTurns];
  Cache cache;
  alignas(32) std::byte surface_bytes[kTriangleRecordBytes + 2 * kPortableCongruenceBytes];  ///< one record by itself

  /// Calls visit(name, offset_bytes, bytes) for every region, in address order.
  template <class Visit>
  static constexpr void for_each_region(Visit&& visit) {
    visit("tiles", offsetof(TileEyeStore, tiles), sizeof(TileEyeStore::tiles));
    visit("nodes_and_leaves", offsetof(TileEyeStore, cache), sizeof(TileEyeStore) - offsetof(TileEyeStore, cache));
  }
};

/// The tree on one core; see engine/engine.h for what each function promises.
template <class L, class Store, Platform P>
class TileCore {
 public:
  using Layout = typename Store::Layout;

  TileCore(Store& store, Transfers<P>& transfers) : store_(store), transfers_(transfers), source_(store, transfers) {}

  /// Fetches the tree's record.
  [[nodiscard]] Status begin() {
    const FrameHead& frame = store_.frame;
    GRIDIRON_TRY(find_tree_fault<Limits>(frame).status);
    TreeRecord& tree = store_.engine.tree;
    GRIDIRON_TRY(transfers_.get(&tree, MainAddress{frame.tree_address}, sizeof tree, kSetupTag));
    GRIDIRON_TRY(transfers_.wait(kSetupTag));
    if (tree.node_count == 0 || tree.depth > kMaxTreeDepth || tree.leaf_triangles > EyeStore::Cache::kLeafTriangles ||
        !reads_format(frame.accuracy, tree.triangle_format)) {
      return Status::kUnsupportedImage;
    }
    source_.begin();
    GRIDIRON_TRY(source_.fetch_top());
    float largest = 0.0f;
    for (int axis = 0; axis < 3; ++axis) {
      const float low = magnitude(tree.bounds_minimum[axis]), high = magnitude(tree.bounds_maximum[axis]);
      largest = low > largest ? low : largest;
      largest = high > largest ? high : largest;
    }
    store_.engine.eye = project_eye(frame, largest);
    return Status::kOk;
  }

  void begin_tile() {}

  /// Begins with an empty cache: shading uses its memory between two samples.
  [[nodiscard]] Status trace_eyes(const TileView& view, const Hits& hits) {
    source_.forget();
    if constexpr (EyeStore::kTurns == 1) {
      Tracer tracer(store_.packet.tiles[0], source_, store_.work);
      return take_turns(view, hits, &tracer);
    } else {
      Tracer tracers[2] = {{store_.packet.tiles[0], source_, store_.work},
                           {store_.packet.tiles[1], source_, store_.work}};
      return take_turns(view, hits, tracers);
    }
  }

 private:
  using EyeStore = typename Store::EyeStore;
  using Source = TreeSource<L, Store, P, EyeParts>;
  static constexpr std::uint32_t kWidth = EyeStore::kWidth, kTurns = EyeStore::kTurns;
  using Tracer = TileTracer<L, kWidth, Source, EyeStore::kMostLanes>;

  // Which tiles a core looks at next, and who.
  struct Turn {
    std::uint32_t x, y;
    bool is_busy;
  };

  [[nodiscard]] Status take_turns(const TileView& view, const Hits& hits, Tracer* tracers) {
    const FrameHead& frame = store_.frame;
    const std::uint32_t columns = least(Layout::kTileWidth, frame.width - view.left);
    const std::uint32_t rows = least(Layout::kTileWidth, frame.height - view.top);
    Turn turns[kTurns] = {};
    std::uint32_t x = 0, y = 0, busy = 0;
    // The other one is next, if it has something to do.
    const auto next_after = [&](std::uint32_t i) GRIDIRON_INLINE_LAMBDA {
      const std::uint32_t other = i + 1 == kTurns ? std::uint32_t{0} : i + 1;
      return turns[other].is_busy || y < rows ? other : i;
    };
    for (std::uint32_t i = 0; y < rows || busy != 0; i = next_after(i)) {
      Turn& turn = turns[i];
      if (!turn.is_busy) {
        turn = {x, y, true};
        ++busy;
        GRIDIRON_TRY(tracers[i].begin(frame, store_.engine.eye, {view.left + x, view.top + y, view.dx, view.dy},
                                      {hits.facing != nullptr, hits.distance != nullptr}));
        x += kWidth;
        if (x >= columns) {
          x = 0;
          y += kWidth;
        }
        continue;
      }
      if (tracers[i].has_more()) {
        GRIDIRON_TRY(tracers[i].step());
        continue;
      }
      GRIDIRON_TRY(tracers[i].finish());
      tracers[i].store_hits(turn.x, turn.y, Layout::kTileWidth, hits);
      turn.is_busy = false;
      --busy;
    }
    return source_.finish();
  }
  [[nodiscard]] static std::uint32_t least(std::uint32_t a, std::uint32_t b) { return a < b ? a : b; }

  // Limits of this store.
  struct Limits {
    static constexpr std::uint32_t kMaxFetchDepth = Layout::kEyeSlots / 2;
    static constexpr Status kBeyond = Status::kUnsupportedFrame;
  };

  Store& store_;
  Transfers<P>& transfers_;
  Source source_;
};

/// The tree as a layout names it for eye rays.
struct TileEngine {
  static constexpr std::uint32_t kId = static_cast<std::uint32_t>(EngineId::kTree);
  using Record = TreeFrame;
  template <class Layout>
  using Store = TileStore<Layout::kEyeTopNodes>;
  template <class Layout>
  using EyeStore = TileEyeStore<Layout>;
  template <class Layout>
  static constexpr bool kTracesEyes = true;
  template <class Layout>
  static constexpr std::uint32_t kMaxDepth = Layout::kEyeSlots / 2;  ///< the greatest frame.fetch_depth
  template <class L, class Store, Platform P>
  using Core = TileCore<L, Store, P>;
};

}  // namespace gridiron
