// Names and prices of the kinds of work of the passes that build the tree. The prices are ESTIMATES: operations of the
// source counted by hand, on a core of two in-order pipes, by the rules of tools/calibrate/README.md. They are not
// calibrated yet.
// Memory: constants. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/build/passes/build_plan.h>
#include <gridiron/build/passes/build_work.h>
#include <gridiron/sim/engine_work.h>

#include <iterator>
#include <string_view>

namespace gridiron::sim {

/// Numbers of descriptions that are no engine's; above those of engines.
inline constexpr std::uint32_t kBuildPassesId = 200;

// clang-format off
inline constexpr WorkKind kBuildPassKinds[] = {
    {BuildWork::kVertex, "bounded_vertex"}, {BuildWork::kCorner, "corner"}, {BuildWork::kMissedCorner, "missed_corner"},
    {BuildWork::kCodedGroup, "coded_group"}, {BuildWork::kDroppedTriangle, "dropped_triangle"},
    {BuildWork::kSortCount, "sort_count"}, {BuildWork::kMovedKey, "moved_key"},
    {BuildWork::kExchangedKey, "exchanged_key"}, {BuildWork::kCut, "cut"}, {BuildWork::kGatheredKey, "gathered_key"},
    {BuildWork::kMiddleGroup, "middle_group"}, {BuildWork::kAgainGroup, "again_group"},
    {BuildWork::kAskedRecord, "asked_record"}, {BuildWork::kTakenRecord, "taken_record"},
    {BuildWork::kLeaf, "built_leaf"},
    {BuildWork::kPart, "part"}, {BuildWork::kWeighedPart, "weighed_part"}, {BuildWork::kSearchStep, "search_step"},
    {BuildWork::kNode, "built_node"}, {BuildWork::kNumberedNode, "numbered_node"}};

inline constexpr WorkPrice kBuildPassPrices[] = {
    {BuildWork::kVertex, 8},         // 2 loads, a shuffle; 2 + 2 + 3 even operations, unrolled
    {BuildWork::kCorner, 10},        // in lanes; of each a load, a compare and a store of words
    {BuildWork::kMissedCorner, 60},  // two lines looked for; without the command
    {BuildWork::kCodedGroup, 175},   // 12 corners and 12 quadwords of records: 105 odd; boxes, areas, codes: 155 even
    {BuildWork::kDroppedTriangle, 40},   // two equal corners; a triangle that has none takes some 260
    {BuildWork::kSortCount, 5},
    {BuildWork::kMovedKey, 22},      // counted and moved: 11 even, 16 odd
    {BuildWork::kExchangedKey, 14},  // with a branch that goes the rarer way one time in three
    {BuildWork::kCut, 120},          // nine steps
    {BuildWork::kGatheredKey, 8},
    {BuildWork::kMiddleGroup, 80},
    {BuildWork::kAgainGroup, 130},
    {BuildWork::kAskedRecord, 20},   // without the command
    {BuildWork::kTakenRecord, 45},   // box, six quadwords copied
    {BuildWork::kLeaf, 60},
    {BuildWork::kPart, 250},         // two levels by way of doubles, parts behind it moved
    {BuildWork::kWeighedPart, 15},   // 64 bits
    {BuildWork::kSearchStep, 24},    // one chain: load, compare, select
    {BuildWork::kNode, 1300},        // 16 densities, 60 exchanges of their order
    {BuildWork::kNumberedNode, 190}};

inline constexpr WorkKind kCheckPassKinds[] = {{CheckWork::kCheckedLine, "checked_line"}};

// Eight times two words of 64 bits in lanes: exclusive or, and a product by 2^40 + 435 of two products of 16 bits,
// shifts, a carry and sums: 11 even.
inline constexpr WorkPrice kCheckPassPrices[] = {{CheckWork::kCheckedLine, 92}};
// clang-format on

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
