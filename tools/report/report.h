// Report: where every cycle and byte of a frame went, as JSON. Keys and units: tools/README.md, "Report".
// Memory: std::string. Threads: any, no shared state. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/records.h>
#include <gridiron/base/stages.h>
#include <gridiron/base/work_counters.h>
#include <gridiron/sim/machine_profile.h>
#include <gridiron/sim/replay.h>
#include <gridiron/sim/trace.h>

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace gridiron::tool {

/// Grows when a key changes its meaning or goes away; not for new keys.
inline constexpr int kReportVersion = 1;

/// One named part of the local store.
struct LocalStoreRegion {
  std::string name;
  std::uint64_t offset_bytes = 0;  ///< from the start of the arena
  std::uint64_t bytes = 0;
};

/// Rays of one kind that a frame traced.
struct RayCount {
  std::string kind;  ///< snake_case: primary
  std::uint64_t count = 0;
};

/// Time of a part of the work on this host.
struct HostTime {
  double seconds = 0, processor_seconds = 0;  ///< processor: of all threads
};

/// The most of any tile: what was done, and its bound for the frame's camera.
struct WorstTiles {
  std::uint32_t tile[2] = {}, bound_tile[2] = {};  ///< column and row of the one with most cycles
  double cycles = 0, bound_cycles = 0;
  std::uint64_t gets = 0, bound_gets = 0;
  std::uint64_t get_bytes = 0, bound_get_bytes = 0;
  HostTime time;  ///< of finding the bounds
};

/// The contents of a report.
struct ReportInput {
  std::string mode = "checked";  ///< of the simulator
  std::string configuration;     ///< its name
  bool is_timed = true;          ///< false: machine, frame, cores, work and rays are left out

  std::optional<float> least_tolerance, most_tolerance;  ///< of a text scene with round shapes

  std::uint64_t triangle_count = 0;  ///< of the input, dropped ones included
  std::uint64_t vertex_count = 0;
  std::uint64_t dropped_triangle_count = 0;  ///< zero area
  bool has_grid = true;
  GridRecord grid{};              ///< with a grid
  float wanted_lambda = 0;        ///< more than the grid's where that was reduced to fit the main memory
  std::uint64_t image_bytes = 0;  ///< the whole scene image

  sim::MachineProfile machine{};
  sim::FrameTiming timing;
  sim::WorkTotals work{};

  std::vector<std::string> effects_called_for;
  bool is_scene_shaded = false;  ///< Shading::kScene: the report has rays of effects and stages
  std::vector<RayCount> rays;    ///< primary rays; those of effects are taken from `work`

  std::uint64_t arena_bytes = 0;
  std::vector<LocalStoreRegion> regions;
  std::uint64_t code_bytes = 0, stack_bytes = 0;  ///< committed budgets

  HostTime load, build, render;
  std::uint32_t host_threads = 1, lanes = 4, repeats = 1;
  std::optional<WorstTiles> worst_tiles;  ///< where bounds are requested
  std::uint64_t trace_bytes = 0;          ///< packed, as stored for the replay; 0 in plain mode

  std::uint64_t image_hash = 0;
  std::optional<std::uint64_t> depth_hash, ids_hash;  ///< of planes that the frame has
};

/// @returns the report as JSON text, two spaces of indentation, keys in the documented order, newline at the end.
[[nodiscard]] std::string report_json(const ReportInput& input);

/// @returns the sums over the cores, by Stage.
[[nodiscard]] std::array<sim::StageTiming, kStageCount> stage_sums(std::span<const sim::CoreTiming> cores);

/// @returns core cycles stalled for transfers, all cores.
[[nodiscard]] double wait_cycles_of(const sim::FrameTiming& timing);

/// @returns the same in % of the cycles of all cores.
[[nodiscard]] double wait_percent_of(const sim::FrameTiming& timing);

/// @returns the stable snake_case name of a stage of a frame with effects.
[[nodiscard]] std::string_view stage_name(Stage stage);

/// FNV-1a, 64 bits, over the bytes of each pixel's word, lowest first: R, G, B, A of a colour.
///
/// @param pixels  0xAABBGGRR, bits of a distance, or triangle ids; row-major, top row first.
[[nodiscard]] std::uint64_t image_hash(std::span<const std::uint32_t> pixels);

/// @returns 16 lower-case hexadecimal digits.
[[nodiscard]] std::string hash_text(std::uint64_t hash);

}  // namespace gridiron::tool
