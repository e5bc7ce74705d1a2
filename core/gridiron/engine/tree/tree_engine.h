// The wide tree as an engine of lists: all rays but those eye rays that go through the frame's own engine.
// Source: own; core/TREE.md. Memory: its parts of the local store. Threads: one core.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/accuracies.h>
#include <gridiron/base/records.h>
#include <gridiron/base/tree_records.h>
#include <gridiron/dma/tags.h>
#include <gridiron/dma/transfers.h>
#include <gridiron/engine/tree/ray_lists.h>
#include <gridiron/engine/tree/tree_source.h>
#include <gridiron/engine/tree/tree_store.h>
#include <gridiron/platform/contract.h>
#include <gridiron/ray/ray_batch.h>

#include <cstdint>

namespace gridiron {

/// The tree on one core; see engine/engine.h for what each function promises.
template <class L, class Store, Platform P>
class TreeCore {
 public:
  TreeCore(Store& store, Transfers<P>& transfers) : store_(store), transfers_(transfers), source_(store, transfers) {}

  /// Fetches the tree's record.
  [[nodiscard]] Status begin() {
    TreeRecord& tree = store_.rays.tree;
    GRIDIRON_TRY(transfers_.get(&tree, MainAddress{store_.frame.tree_address}, sizeof tree, kSetupTag));
    GRIDIRON_TRY(transfers_.wait(kSetupTag));
    if (tree.node_count == 0 || tree.depth > kMaxTreeDepth || tree.leaf_triangles > Cache::kLeafTriangles ||
        !reads_format(store_.frame.accuracy, tree.triangle_format)) {
      return Status::kUnsupportedImage;
    }
    source_.begin();
    largest_ = 0.0f;
    for (int axis = 0; axis < 3; ++axis) {
      const float low = magnitude(tree.bounds_minimum[axis]), high = magnitude(tree.bounds_maximum[axis]);
      largest_ = low > largest_ ? low : largest_;
      largest_ = high > largest_ ? high : largest_;
    }
    return Status::kOk;
  }

  /// Eye rays have been traced in the memory that rays are traced in from now on.
  void begin_rays() { source_.forget(); }

  template <class Jobs>
  [[nodiscard]] Status trace(const RayQuestion& question, Jobs& jobs) {
    auto& lists = store_.wave.rays.lists;
    for (bool has_more = true; has_more;) {
      RayBatch batch{lists.rays, lists.owners, 0};
      bool is_asked = false;
      while (has_more && batch.count + kJobRays <= Lists::kRays) {
        has_more = jobs.next(batch);
        // The root comes while the other rays are made; if there are none, nothing is fetched.
        if (batch.count != 0 && !is_asked) GRIDIRON_TRY(source_.ahead(TreeChild::node(0)));
        is_asked = batch.count != 0;
        if constexpr (Lists::kHasBeams && requires { jobs.ends_batch(); }) {
          if (is_asked && jobs.ends_batch()) break;
        }
      }
      if (batch.count != 0) {
        GRIDIRON_TRY((RayLists<L, Lists, Source>(lists, source_, store_.work).trace(question, batch.count, largest_)));
        jobs.finish(batch);
      }
    }
    return source_.finish();
  }

 private:
  using RayStore = typename Store::RayStore;
  using Lists = typename RayStore::Lists;
  using Cache = typename RayStore::Cache;
  using Source = TreeSource<L, Store, P>;

  Store& store_;
  Transfers<P>& transfers_;
  Source source_;
  float largest_ = 0.0f;
};

/// The tree as a layout names it.
struct TreeEngine {
  using Store = TreeStore;
  template <class Layout>
  using RayStore = TreeRayStore<Layout>;
  template <class Layout>
  static constexpr std::uint32_t kMaxDepth =
      RayStore<Layout>::kBuffers < kTriangleTagCount ? RayStore<Layout>::kBuffers : std::uint32_t{kTriangleTagCount};
  template <class L, class Store, Platform P>
  using Core = TreeCore<L, Store, P>;
};

}  // namespace gridiron
