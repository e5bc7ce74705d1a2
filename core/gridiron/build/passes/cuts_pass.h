// Fourth pass of a build: finds where each bucket begins in each sorted run.
// Memory: the pass's store. Threads: one core. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/build/passes/build_plan.h>
#include <gridiron/build/passes/pass_tools.h>

namespace gridiron {

template <class Layout>
struct CutsStore {
  static constexpr std::uint32_t kSplitters = Layout::kSortsRecords ? 1024 : 256;  // at once
  static constexpr std::uint32_t kKeys = Layout::kSortsRecords ? 512 : 128;

  alignas(128) std::byte keys[2 * window_bytes<TreeKey>(kKeys)];
  alignas(128) std::byte splitters[window_bytes<std::uint32_t>(kSplitters)];
  alignas(128) std::uint32_t cuts[kSplitters][kRunGroup];
  alignas(128) RunPart parts[kRunGroup];
  alignas(128) BuildState state;
};

/// Writes cuts: of bucket and run, the number of the run's keys below the bucket. Items: groups of runs.
template <class Layout, class P>
[[nodiscard]] Status run_cuts_pass(BuildTransfers<P>& transfers, CutsStore<Layout>& store, const BuildPlan& plan) {
  using Store = CutsStore<Layout>;
  const auto cut_group = [&](std::uint32_t group) -> Status {
    const std::uint32_t first_run = group * kRunGroup, rest = plan.run_count - first_run;
    const std::uint32_t runs = rest < kRunGroup ? rest : kRunGroup;
    GRIDIRON_TRY(transfers.get(store.parts, plan.run_parts.offset_by(first_run * std::uint64_t{sizeof(RunPart)}),
                               runs * static_cast<std::uint32_t>(sizeof(RunPart)), kSetupTag));
    // Of all rows: one for each bucket, and the end.
    const std::uint32_t rows = store.state.bucket_count + 1;
    for (std::uint32_t first = 0; first < rows; first += Store::kSplitters) {
      const std::uint32_t left = rows - first;
      const std::uint32_t count = left < Store::kSplitters ? left : Store::kSplitters;
      const Window<std::uint32_t> window(store.splitters, plan.splitters, first);
      GRIDIRON_TRY(window.get(transfers, count, kSetupTag));
      GRIDIRON_TRY(transfers.wait(kSetupTag));
      GRIDIRON_TRY(transfers.wait(kFirstOutputTag));
      const std::uint32_t* const splitters = window.elements();
      for (std::uint32_t i = 0; i < count; ++i) {
        for (std::uint32_t k = runs; k < kRunGroup; ++k) store.cuts[i][k] = 0;
      }
      for (std::uint32_t k = 0; k < runs; ++k) {
        const std::uint32_t key_count = store.parts[k].count;
        const std::uint64_t base = std::uint64_t{first_run + k} * plan.run_triangles;
        std::uint32_t next = 0;  // splitter
        GRIDIRON_TRY((for_each_window<TreeKey, Store::kKeys>(
            transfers, store.keys, plan.run_keys, base, base + key_count, kFirstMacroTag,
            [&](const TreeKey* keys, std::uint64_t at, std::uint32_t n) {
              const auto before = static_cast<std::uint32_t>(at - base);
              const std::uint32_t last = keys[n - 1].code();
              transfers.charge_to(BuildWork::kCutStep);
              // At most all splitters, in all windows of a run together.
              for (; next < count && splitters[next] <= last; ++next) {
                std::uint32_t low = 0;
                for (std::uint32_t size = n; size > 0;) {
                  const std::uint32_t half = (size + 1) / 2;
                  transfers.add_work(BuildWork::kCutStep);
                  low += keys[low + half - 1].code() < splitters[next] ? half : std::uint32_t{0};
                  size -= half;
                }
                store.cuts[next][k] = before + low;
              }
              return Status::kOk;
            })));
        for (; next < count; ++next) store.cuts[next][k] = key_count;
      }
      for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint64_t place = std::uint64_t{first + i} * plan.run_stride + first_run;
        GRIDIRON_TRY(
            transfers.put(store.cuts[i], plan.cuts.offset_by(place * 4), sizeof store.cuts[i], kFirstOutputTag));
      }
    }
    return transfers.wait(kFirstOutputTag);
  };
  GRIDIRON_TRY(fetch(transfers, store.state, plan.state));
  return for_each_item(transfers, plan.run_stride / kRunGroup, cut_group);
}

}  // namespace gridiron
