// Names and prices of the kinds of work of the passes that build the tree.
// Memory: constants. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/build/passes/build_plan.h>
#include <gridiron/build/passes/build_work.h>
#include <gridiron/sim/build_pass_costs.h>
#include <gridiron/sim/engine_work.h>

#include <array>
#include <cstdint>
#include <iterator>
#include <string_view>

namespace gridiron::sim {

/// Numbers of descriptions that are no engine's; above those of engines.
inline constexpr std::uint32_t kBuildPassesId = 200;

// clang-format off
inline constexpr WorkKind kBuildPassKinds[] = {
    {BuildWork::kVertex, "bounded_vertex"}, {BuildWork::kCorner, "corner"}, {BuildWork::kMissedCorner, "missed_corner"},
    {BuildWork::kCodedGroup, "coded_group"}, {BuildWork::kSortedRecord, "sorted_record"},
    {BuildWork::kSortCount, "sort_count"}, {BuildWork::kMovedKey, "moved_key"},
    {BuildWork::kExchangedKey, "exchanged_key"}, {BuildWork::kGatheredKey, "gathered_key"},
    {BuildWork::kAgainGroup, "again_group"},
    {BuildWork::kAskedRecord, "asked_record"}, {BuildWork::kRecordSpan, "record_span"},
    {BuildWork::kTakenRecord, "taken_record"},
    {BuildWork::kLeaf, "built_leaf"},
    {BuildWork::kPart, "part"}, {BuildWork::kWeighedPart, "weighed_part"}, {BuildWork::kSearchStep, "search_step"},
    {BuildWork::kCutStep, "cut_step"},
    {BuildWork::kNode, "built_node"}, {BuildWork::kNumberedNode, "numbered_node"}};

inline constexpr WorkKind kCheckPassKinds[] = {{CheckWork::kCheckedLine, "checked_line"}};

// Eight times two words of 64 bits in lanes: exclusive or, and a product by 2^40 + 435 of two products of 16 bits,
// shifts, a carry and sums: 11 even.
inline constexpr WorkPrice kCheckPassPrices[] = {{CheckWork::kCheckedLine, 92}};
// clang-format on

/// Of the table of calibrated costs.
inline constexpr auto kBuildPassPrices = [] {
  std::array<WorkPrice, kBuildWorkCount> prices{};
  for (std::uint32_t i = 0; i < kBuildWorkCount; ++i) {
    prices[i] = {WorkId(kSharedWorkCount + i), kBuildPassCosts[i].cycles};
  }
  return prices;
}();

/// The passes that build the tree.
inline constexpr EngineWork kBuildPassesWork =
    EngineWork::make(BuildWork::kEnd, {.id = kBuildPassesId,
                                       .name = "build",
                                       .kinds = kBuildPassKinds,
                                       .prices = kBuildPassPrices,
                                       .wait_levels = {"output", "window", "record", "setup"}});

/// The pass that checks an image.
inline constexpr EngineWork kCheckPassWork =
    EngineWork::make(CheckWork::kEnd, {.id = kBuildPassesId + 1,
                                       .name = "check",
                                       .kinds = kCheckPassKinds,
                                       .prices = kCheckPassPrices,
                                       .wait_levels = {"output", "window", "record", "setup"}});

/// @returns the stable snake_case name of a pass.
[[nodiscard]] constexpr std::string_view name_of(BuildPass pass) {
  constexpr std::string_view kNames[] = {"bounds", "codes",    "buckets", "cuts",    "sort",
                                         "top",    "subtrees", "join",    "numbers", "check"};
  static_assert(std::size(kNames) == kBuildPassCount);
  return kNames[static_cast<std::uint32_t>(pass)];
}

/// @returns the kinds of work of a pass.
[[nodiscard]] constexpr const EngineWork& work_of(BuildPass pass) {
  return pass == BuildPass::kCheck ? kCheckPassWork : kBuildPassesWork;
}

}  // namespace gridiron::sim
