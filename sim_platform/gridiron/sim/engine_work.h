// The table of engines, and names and prices of their kinds of work, for reports and the clock. A new kind needs a
// value of its enumeration (base/work_counters.h or the engine's), a row here in the same order, and a price
// (tools/calibrate). A new engine needs a description like kGridEngine; in core also an EngineId and a row.
// Memory: constants. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/records.h>
#include <gridiron/base/work_counters.h>
#include <gridiron/engine/grid/grid_work.h>
#include <gridiron/engine/tree/tile_work.h>
#include <gridiron/sim/machine_profile.h>
#include <gridiron/sim/wait_levels.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <type_traits>

namespace gridiron::sim {

/// A row of a table of kinds.
struct WorkKind {
  WorkId id;                       ///< the kind
  std::string_view name;           ///< stable, snake_case
  bool is_initialisation = false;  ///< all other work is computation
};

/// What a unit of a kind costs where the machine's profile does not say it.
struct WorkPrice {
  WorkId id;      ///< the kind
  double cycles;  ///< of a unit
};

// clang-format off
/// The kinds that all engines share.
inline constexpr WorkKind kSharedWork[] = {
    {Work::kTileStart, "tile_start", true}, {Work::kRayPacket, "ray_packet", true},
    {Work::kPixelProjection, "pixel_projection", true}, {Work::kRayGenerated, "ray_generated", true},
    {Work::kRaySetWord, "ray_set_word", true}, {Work::kRecentSlot, "recent_slot", true}, {Work::kCullTest, "cull_test"},
    {Work::kPixelBoxGroup, "pixel_box_group"}, {Work::kOpenTriangle, "open_triangle"},
    {Work::kListedTriangle, "listed_triangle"}, {Work::kTriangleSetup, "triangle_setup"},
    {Work::kSlopeSetup, "slope_setup"}, {Work::kSubpacketSetup, "subpacket_setup"},
    {Work::kSubpacketGroup, "subpacket_group"}, {Work::kTriangleTest, "triangle_test"},
    {Work::kSubpacketPick, "subpacket_pick"}, {Work::kSubpacketVisit, "subpacket_visit"},
    {Work::kGroupTestStandard, "group_test_standard"}, {Work::kGroupSkip, "group_skip"},
    {Work::kInsideTest, "inside_test"}, {Work::kRowVisit, "row_visit"}, {Work::kRowTest, "row_test"},
    {Work::kRowSkip, "row_skip"}, {Work::kRowInsideTest, "row_inside_test"}, {Work::kCullTestPaper, "cull_test_paper"},
    {Work::kGroupTestPaper, "group_test_paper"}, {Work::kHitGroup, "hit_group"},
    {Work::kOpenHitGroup, "open_hit_group"}, {Work::kSettledGroup, "settled_group"},
    {Work::kHitSubpacket, "hit_subpacket"}, {Work::kTakenSubpacket, "taken_subpacket"},
    {Work::kFacingGroup, "facing_group"}, {Work::kHitGroupPaper, "hit_group_paper"}, {Work::kHitSetup, "hit_setup"},
    {Work::kDoubleSign, "double_sign"}, {Work::kExactSign, "exact_sign"}, {Work::kExactDistance, "exact_distance"},
    {Work::kShadedGroup, "shaded_group"}, {Work::kShadedSimpleGroup, "shaded_simple_group"},
    {Work::kDepthGroup, "depth_group"}, {Work::kIdGroup, "id_group"}, {Work::kRowGroup, "row_group"},
    {Work::kEstimateSetup, "estimate_setup"}, {Work::kNormalSetup, "normal_setup"}, {Work::kHitHalf, "hit_half"},
    {Work::kExactOrder, "exact_order"}, {Work::kLatticeTriangle, "lattice_triangle"}, {Work::kWaveRay, "wave_ray"},
    {Work::kQueuedRay, "queued_ray"}, {Work::kListRay, "list_ray"}, {Work::kListBeam, "list_beam"},
    {Work::kListBeamNode, "list_beam_node"}, {Work::kListChild, "list_child"},
    {Work::kListEntry, "list_entry"}, {Work::kListNode, "list_node"}, {Work::kListRun, "list_run"},
    {Work::kListRayNode, "list_ray_node"}, {Work::kListBoxQuad, "list_box_quad"},
    {Work::kListSharedBox, "list_shared_box"}, {Work::kListLeaf, "list_leaf"},
    {Work::kListTriangleGroup, "list_triangle_group"}, {Work::kListSharedLeaf, "list_shared_leaf"},
    {Work::kListSharedGroup, "list_shared_group"}, {Work::kListCandidate, "list_candidate"},
    {Work::kRayDistance, "ray_distance"},
    {Work::kSurfacePoint, "surface_point"}, {Work::kSmoothNormal, "smooth_normal"},
    {Work::kJitterSeed, "jitter_seed"}, {Work::kShadowRay, "shadow_ray"},
    {Work::kAreaPlace, "area_place"}, {Work::kLightSample, "light_sample"}, {Work::kHighlight, "highlight"},
    {Work::kOcclusionRay, "occlusion_ray"}, {Work::kMirrorRay, "mirror_ray"}, {Work::kRefractedRay, "refracted_ray"},
    {Work::kEnvironmentLookup, "environment_lookup"}, {Work::kColorAdded, "color_added"},
    {Work::kColorGroup, "color_group"}, {Work::kVertexColor, "vertex_color"}, {Work::kSrgbLevel, "srgb_level"},
    {Work::kGetIssue, "get_issue"}, {Work::kPutIssue, "put_issue"}, {Work::kWait, "wait"}};
// clang-format on

/// Whether a name stands in none of these rows.
[[nodiscard]] constexpr bool is_new_name(std::span<const WorkKind> kinds, std::string_view name) {
  for (const WorkKind& kind : kinds) {
    if (kind.name == name) return false;
  }
  return true;
}

/// Whether a table has the kinds from `first` on, in their order, each with a name of its own.
[[nodiscard]] constexpr bool lists_kinds(std::span<const WorkKind> kinds, std::uint32_t first, std::uint32_t end) {
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    if (kinds[i].id != WorkId(first + static_cast<std::uint32_t>(i)) || kinds[i].name.empty()) return false;
    if (!is_new_name(kinds.first(i), kinds[i].name)) return false;
  }
  return kinds.size() == end - first;
}
static_assert(lists_kinds(kSharedWork, 0, kSharedWorkCount), "a kind of Work lacks its row");

/// The description of an engine. A trace points to that of the engine that made it.
struct EngineWork {
  std::uint32_t id;                   ///< FrameHead::engine_id
  std::string_view name;              ///< stable, snake_case
  std::span<const WorkKind> kinds;    ///< its own, from kSharedWorkCount on
  std::span<const WorkPrice> prices;  ///< one at least for each of its own; core's engines have them in profiles
  std::array<std::string_view, kWaitLevelCount> wait_levels;  ///< by WaitLevel

  /// Whether each of its kinds has a row and a price, and the engine, each row and each wait level a name. Only core's
  /// engines have their numbers, and no prices.
  template <class Kind>
  [[nodiscard]] static consteval bool is_whole(Kind end, const EngineWork& engine) {
    constexpr bool kIsGrid = std::is_same_v<Kind, GridWork>, kIsTree = std::is_same_v<Kind, TileWork>;
    if (kIsGrid != (engine.id == static_cast<std::uint32_t>(EngineId::kGrid))) return false;
    if (kIsTree != (engine.id == static_cast<std::uint32_t>(EngineId::kTree)) || engine.name.empty()) return false;
    if (!lists_kinds(engine.kinds, kSharedWorkCount, WorkId(end).number())) return false;
    for (const std::string_view level : engine.wait_levels) {
      if (level.empty()) return false;
    }
    for (const WorkKind& kind : engine.kinds) {
      if (!is_new_name(kSharedWork, kind.name) || (!kIsGrid && !kIsTree && !engine.has_price(kind.id))) {
        return false;
      }
    }
    return true;
  }
  /// The description of an engine; one that is not whole does not compile.
  template <class Kind>
  [[nodiscard]] static consteval EngineWork make(Kind end, const EngineWork& engine) {
    if (!is_whole(end, engine)) a_row_of_the_engine_is_missing();
    return engine;
  }
  static void a_row_of_the_engine_is_missing();  ///< defined nowhere: its name stands in the compiler's message
  /// Whether it brings a price for a kind.
  [[nodiscard]] constexpr bool has_price(WorkId kind) const {
    for (const WorkPrice& price : prices) {
      if (price.id == kind) return true;
    }
    return false;
  }
  /// Its frames count the kinds 0 to kind_count() - 1.
  [[nodiscard]] constexpr std::uint32_t kind_count() const {
    return kSharedWorkCount + static_cast<std::uint32_t>(kinds.size());
  }
};

// clang-format off
/// The grid's own kinds.
inline constexpr WorkKind kGridWorkKinds[] = {
    {GridWork::kPacketStart, "packet_start", true}, {GridWork::kPassSlope, "pass_slope", true},
    {GridWork::kMailboxGroup, "mailbox_group", true}, {GridWork::kPassGroup, "pass_group", true},
    {GridWork::kPassSquare, "pass_square", true}, {GridWork::kMacroSliceStep, "macro_slice_step"},
    {GridWork::kMacroRow, "macro_row"}, {GridWork::kMacroCellStep, "macro_cell_step"},
    {GridWork::kMacroCellVisit, "macro_cell_visit"}, {GridWork::kSliceStep, "slice_step"},
    {GridWork::kCellRow, "cell_row"}, {GridWork::kCellStep, "cell_step"}, {GridWork::kCellVisit, "cell_visit"},
    {GridWork::kTriangleBatch, "triangle_batch"}, {GridWork::kMailboxProbe, "mailbox_probe"},
    {GridWork::kReachGroup, "reach_group"}, {GridWork::kReachTest, "reach_test"},
    {GridWork::kFootprintGroup, "footprint_group"}, {GridWork::kCellBoundStep, "cell_bound_step"}};
// clang-format on

/// The grid. Machine profiles have its prices.
inline constexpr EngineWork kGridEngine =
    EngineWork::make(GridWork::kEnd, {.id = static_cast<std::uint32_t>(EngineId::kGrid),
                                      .name = "grid",
                                      .kinds = kGridWorkKinds,
                                      .prices = {},
                                      .wait_levels = {"tile", "macrocell", "triangle", "setup"}});

// clang-format off
/// The kinds of tiles of eye rays through the tree.
inline constexpr WorkKind kTileWorkKinds[] = {
    {TileWork::kView, "tile_view", true}, {TileWork::kClearedBlock, "cleared_block", true},
    {TileWork::kBoxGroup, "box_group"}, {TileWork::kChild, "child"}, {TileWork::kLeaf, "leaf"},
    {TileWork::kCornerGroup, "corner_group"}, {TileWork::kKeptGroup, "kept_group"},
    {TileWork::kNormalGroup, "normal_group"}, {TileWork::kFunctionGroup, "function_group"},
    {TileWork::kTinyPlace, "tiny_place"}, {TileWork::kTinyPixel, "tiny_pixel"}, {TileWork::kDrawn, "drawn"},
    {TileWork::kLargeTriangle, "large_triangle"}, {TileWork::kBlockGroup, "block_group"}, {TileWork::kBlock, "block"},
    {TileWork::kTakenBlock, "taken_block"}, {TileWork::kCoveredBlock, "covered_block"},
    {TileWork::kFacingBlock, "facing_block"}, {TileWork::kOpenPixel, "open_pixel"},
    {TileWork::kChangedBlock, "changed_block"}};
// clang-format on

/// The tree. Machine profiles have its prices.
inline constexpr EngineWork kTreeEngine =
    EngineWork::make(TileWork::kEnd, {.id = static_cast<std::uint32_t>(EngineId::kTree),
                                      .name = "tree",
                                      .kinds = kTileWorkKinds,
                                      .prices = {},
                                      .wait_levels = {"tile", "node", "leaf", "setup"}});

/// The engines of core, by EngineId. Engines outside core, such as the cached BVH, have their description alone.
inline constexpr std::array kCoreEngines = {&kGridEngine, &kTreeEngine};
static_assert(
    [] {
      for (std::size_t i = 0; i < kCoreEngines.size(); ++i) {
        if (kCoreEngines[i]->id != i + 1) return false;
      }
      return kCoreEngines.size() + 1 == static_cast<std::size_t>(EngineId::kEnd);
    }(),
    "an engine of core lacks its row, or it is in another's place");

/// @returns the description of a frame's engine, null if core does not have it. @param id  FrameHead::engine_id.
[[nodiscard]] constexpr const EngineWork* core_engine(std::uint32_t id) {
  return id - 1 < kCoreEngines.size() ? kCoreEngines[id - 1] : nullptr;
}

/// @returns the row of a kind of an engine's frames. Precondition: it has the kind.
[[nodiscard]] constexpr const WorkKind& work_kind(WorkId id, const EngineWork& engine = kGridEngine) {
  return id.number() < kSharedWorkCount ? kSharedWork[id.number()] : engine.kinds[id.number() - kSharedWorkCount];
}

/// Whether a profile charges a kind as an event, by issue_cycles and wait_cycles; its price in work_cycles is 0.
[[nodiscard]] constexpr bool is_charged_as_event(WorkId id) {
  return id == Work::kGetIssue || id == Work::kPutIssue || id == Work::kWait;
}

/// @returns what units of an engine's kinds cost on a machine.
[[nodiscard]] constexpr std::array<double, kWorkKindCount> work_prices(const MachineProfile& machine,
                                                                       const EngineWork& engine) {
  std::array<double, kWorkKindCount> prices = machine.work_cycles;
  if (engine.id == kTreeEngine.id) {
    for (std::size_t i = 0; i < kTileWorkCount; ++i) prices[kSharedWorkCount + i] = machine.tile_work_cycles[i];
  }
  for (const WorkPrice& price : engine.prices) prices[price.id.number()] = price.cycles;
  return prices;
}

}  // namespace gridiron::sim
