// The table of engines, and what the host knows of their kinds of work and of waits: names, which work is
// initialisation, prices that no machine profile has. Kinds of core are listed here, those of an engine in its record.
// Memory: constants. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/records.h>
#include <gridiron/base/work_counters.h>
#include <gridiron/engine/grid/grid_work.h>
#include <gridiron/sim/wait_levels.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace gridiron::sim {

/// A row of a table of kinds.
struct WorkKind {
  WorkId id;
  std::string_view name;           ///< stable, snake_case
  bool is_initialisation = false;  ///< all other work is computation
};

/// What a unit of a kind costs on a machine of which the profile does not say it.
struct WorkPrice {
  WorkId id;
  double cycles;
};

/// Whether a table has the kinds from `first` on, in their order, each with a name.
[[nodiscard]] constexpr bool lists_kinds(std::span<const WorkKind> kinds, std::uint32_t first, std::uint32_t end) {
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    if (kinds[i].id != WorkId(first + static_cast<std::uint32_t>(i)) || kinds[i].name.empty()) return false;
  }
  return kinds.size() == end - first;
}

/// An engine's record. A trace points to that of the engine that made it.
struct EngineWork {
  std::string_view name;
  std::span<const WorkKind> kinds;    ///< its own, from kSharedWorkCount on
  std::span<const WorkPrice> prices;  ///< instead of the profile's, which are those of core and of the grid
  std::array<std::string_view, kWaitLevelCount> wait_levels;  ///< by WaitLevel

  /// A kind without a row, a row without a name, or a wait level without one does not compile.
  template <class Kind>
  [[nodiscard]] static consteval EngineWork make(Kind end, const EngineWork& record) {
    bool is_whole = lists_kinds(record.kinds, kSharedWorkCount, WorkId(end).number());
    for (const std::string_view level : record.wait_levels) is_whole = is_whole && !level.empty();
    if (!is_whole) a_row_of_the_engine_is_missing();
    return record;
  }
  static void a_row_of_the_engine_is_missing();  ///< defined nowhere: its name stands in the compiler's message
  /// The kinds of its frames are those below.
  [[nodiscard]] constexpr std::uint32_t kind_count() const {
    return kSharedWorkCount + static_cast<std::uint32_t>(kinds.size());
  }
};

// clang-format off
/// The kinds that all engines share.
inline constexpr WorkKind kSharedWork[] = {
    {Work::kTileStart, "tile_start", true}, {Work::kRayGenerated, "ray_generated", true},
    {Work::kCullTest, "cull_test"}, {Work::kPixelBoxGroup, "pixel_box_group"},
    {Work::kTriangleSetup, "triangle_setup"}, {Work::kSubpacketSetup, "subpacket_setup"},
    {Work::kSubpacketGroup, "subpacket_group"}, {Work::kGroupTestStandard, "group_test_standard"},
    {Work::kGroupTestPaper, "group_test_paper"}, {Work::kHitGroup, "hit_group"},
    {Work::kHitSubpacket, "hit_subpacket"}, {Work::kHitGroupPaper, "hit_group_paper"}, {Work::kHitSetup, "hit_setup"},
    {Work::kDoubleSign, "double_sign"}, {Work::kExactSign, "exact_sign"}, {Work::kExactDistance, "exact_distance"},
    {Work::kShadedGroup, "shaded_group"}, {Work::kShadedSimpleGroup, "shaded_simple_group"},
    {Work::kDepthGroup, "depth_group"}, {Work::kIdGroup, "id_group"}, {Work::kRowGroup, "row_group"},
    {Work::kEstimateSetup, "estimate_setup"}, {Work::kNormalSetup, "normal_setup"}, {Work::kHitHalf, "hit_half"},
    {Work::kExactOrder, "exact_order"}, {Work::kLatticeTriangle, "lattice_triangle"}, {Work::kWaveRay, "wave_ray"},
    {Work::kQueuedRay, "queued_ray"}, {Work::kRayTriangleSetup, "ray_triangle_setup"},
    {Work::kRayGroupTest, "ray_group_test"}, {Work::kRayDistance, "ray_distance"},
    {Work::kSurfacePoint, "surface_point"}, {Work::kSmoothNormal, "smooth_normal"}, {Work::kShadowRay, "shadow_ray"},
    {Work::kLightSample, "light_sample"}, {Work::kHighlight, "highlight"}, {Work::kOcclusionRay, "occlusion_ray"},
    {Work::kMirrorRay, "mirror_ray"}, {Work::kRefractedRay, "refracted_ray"},
    {Work::kEnvironmentLookup, "environment_lookup"}, {Work::kColorAdded, "color_added"},
    {Work::kColorGroup, "color_group"}, {Work::kGetIssue, "get_issue"}, {Work::kPutIssue, "put_issue"},
    {Work::kWait, "wait"}};
static_assert(lists_kinds(kSharedWork, 0, kSharedWorkCount), "a kind of Work lacks its row");

inline constexpr WorkKind kGridWorkKinds[] = {
    {GridWork::kPacketStart, "packet_start", true}, {GridWork::kPassGroup, "pass_group", true},
    {GridWork::kPassSquare, "pass_square", true}, {GridWork::kMacroSliceStep, "macro_slice_step"},
    {GridWork::kMacroCellStep, "macro_cell_step"}, {GridWork::kMacroCellVisit, "macro_cell_visit"},
    {GridWork::kSliceStep, "slice_step"}, {GridWork::kCellStep, "cell_step"}, {GridWork::kCellVisit, "cell_visit"},
    {GridWork::kTriangleBatch, "triangle_batch"}, {GridWork::kMailboxProbe, "mailbox_probe"},
    {GridWork::kReachGroup, "reach_group"}, {GridWork::kFootprintGroup, "footprint_group"},
    {GridWork::kCellBoundStep, "cell_bound_step"}, {GridWork::kWalkPass, "walk_pass"},
    {GridWork::kShaftGroup, "shaft_group"}};
// clang-format on

/// The grid. Machine profiles have its prices.
inline constexpr EngineWork kGridEngine = EngineWork::make(
    GridWork::kEnd,
    {.name = "grid", .kinds = kGridWorkKinds, .prices = {}, .wait_levels = {"tile", "macrocell", "triangle", "setup"}});

/// The engines of core, by EngineId. An engine without a row does not compile.
inline constexpr std::array kCoreEngines = {&kGridEngine};
static_assert(kCoreEngines.size() + 1 == static_cast<std::size_t>(EngineId::kEnd), "an engine of core lacks its row");

/// @returns the record of a frame's engine, null if core does not have it. @param id  FrameHead::engine_id.
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

/// @returns what units of an engine's kinds cost. @param profile  MachineProfile::work_cycles.
[[nodiscard]] constexpr std::array<double, kWorkKindCount> work_prices(std::array<double, kWorkKindCount> profile,
                                                                       const EngineWork& engine) {
  for (const WorkPrice& price : engine.prices) profile[price.id.number()] = price.cycles;
  return profile;
}

}  // namespace gridiron::sim
