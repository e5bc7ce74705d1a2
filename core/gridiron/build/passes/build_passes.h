// Builds the wide tree of a mesh on the cores of a chip: the entry point of a core. Same bytes as build_tree(), for any
// number of cores and any order of items. BUILD.md describes the passes.
// Memory: a BuildStore of the core. Threads: one core. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/work_counters.h>
#include <gridiron/build/passes/bounds_pass.h>
#include <gridiron/build/passes/buckets_pass.h>
#include <gridiron/build/passes/build_plan.h>
#include <gridiron/build/passes/codes_pass.h>
#include <gridiron/build/passes/cuts_pass.h>
#include <gridiron/build/passes/image_pass.h>
#include <gridiron/build/passes/join_pass.h>
#include <gridiron/build/passes/sort_pass.h>
#include <gridiron/build/passes/subtrees_pass.h>
#include <gridiron/build/passes/top_pass.h>

namespace gridiron {

/// Memory of one core.
template <class LayoutType>
struct alignas(128) BuildStore {
  using Layout = LayoutType;
  alignas(128) WorkCounters work;  ///< of the current pass
  union {
    BoundsStore bounds;
    CodesStore<Layout> codes;
    BucketsStore<Layout> buckets;
    CutsStore<Layout> cuts;
    SortStore<Layout> sort;
    TopStore<Layout> top;
    SubtreesStore<Layout> subtrees;
    JoinStore join;
    NumbersStore numbers;
    CheckStore check;
  };
};

/// Bytes that a layout leaves for data.
template <class Layout>
inline constexpr std::uint32_t kBuildRoomBytes =
    Layout::kArenaBytes - Layout::kCodeBudgetBytes - Layout::kStackBudgetBytes;
static_assert(sizeof(BuildStore<BuildLayout256K>) <= kBuildRoomBytes<BuildLayout256K>);
static_assert(sizeof(BuildStore<BuildLayout64K>) <= kBuildRoomBytes<BuildLayout64K>);

/// Runs a core's share of a pass: claims items until there are none. Each pass begins when the one before has ended on
/// all cores; it has plan.item_counts[pass] items.
///
/// Errors: kBadVertex, kBadIndex, kNoTriangles, kMemoryTooSmall of build_tree(), each in one of the passes; kAborted,
/// kDeadline; the platform's. After an error no further pass may run. Inlined: where `pass` is a constant, the program
/// has the code of that pass alone.
template <class P, class Layout>
[[nodiscard]] GRIDIRON_INLINE Status run_build_pass(P& platform, BuildStore<Layout>& store, const BuildPlan& plan,
                                                    BuildPass pass) {
  store.work = {};
  BuildTransfers<P> transfers(platform, store.work);
  switch (pass) {
    case BuildPass::kBounds:
      return run_bounds_pass(transfers, store.bounds, plan);
    case BuildPass::kCodes:
      return run_codes_pass<Layout>(transfers, store.codes, plan);
    case BuildPass::kBuckets:
      return run_buckets_pass<Layout>(transfers, store.buckets, plan);
    case BuildPass::kCuts:
      return run_cuts_pass<Layout>(transfers, store.cuts, plan);
    case BuildPass::kSort:
      return run_sort_pass<Layout>(transfers, store.sort, plan);
    case BuildPass::kTop:
      return run_top_pass<Layout>(transfers, store.top, plan);
    case BuildPass::kSubtrees:
      return run_subtrees_pass<Layout>(transfers, store.subtrees, plan);
    case BuildPass::kJoin:
      return run_join_pass(transfers, store.join, plan);
    case BuildPass::kNumbers:
      return run_numbers_pass(transfers, store.numbers, plan);
    case BuildPass::kCheck:
      return run_check_pass(transfers, store.check, plan);
    case BuildPass::kCount:
      break;
  }
  return Status::kBadParameter;
}

}  // namespace gridiron
