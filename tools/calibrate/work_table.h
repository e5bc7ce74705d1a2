// The table of what a unit of each kind of work costs: made from counted frames, written as the source file that the
// machine profiles are built with.
// Memory: owned. Threads: the caller's only. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <counted_kernel.h>
#include <pipe_model.h>

#include <cstdint>
#include <map>
#include <string>

namespace gridiron::calibrate {

/// Counts the frames that the table is made from: the teapot, 1,640 triangles on 96 x 96 pixels, as `reference`, as
/// `grid`, from near, with the paper's test, with planes and on a lattice; the teapot on a floor with every effect,
/// 12 x 12 and 20 x 20 pixels; and the exact decisions on 64 rays and triangles of it.
///
/// Each program is laid out once, for what branches usually do in all its frames.
/// @returns the sum over the frames. Errors: std::runtime_error where a counted picture differs from the kernel's.
[[nodiscard]] Totals count_frames(const PipeRules& rules = {});

/// @returns what the named one of these frames came to.
[[nodiscard]] Totals count_frame(std::string_view name);

/// @returns the generated source file, sim_platform/gridiron/sim/work_costs.h.
[[nodiscard]] std::string table_text(const Totals& totals);

/// The same for the cached BVH: the teapot and a torus knot of 12,000 triangles, whose lines exceed the caches, each
/// with packets one after another and in a ring. By Work and bvh::BvhWork.
[[nodiscard]] Totals count_bvh_frames(const PipeRules& rules = {});

/// The same for eye rays through the tree: the teapot, coarse and fine, from afar and near, without and with shading
/// and planes, and a torus knot of 12,000 triangles. By Work and TileWork.
[[nodiscard]] Totals count_tree_frames(const PipeRules& rules = {});

/// Frames of `reference`, `grid` and the cached BVH under other rules than those charged: cycles against theirs, dual
/// issue, registers. @returns a table, Markdown.
[[nodiscard]] std::string rules_text();

/// @returns what branches usually do in each program, over the frames of count_frames(), count_tree_frames() and
/// count_bvh_frames().
[[nodiscard]] std::map<CountedProgram, Branches> usual_branches();

/// @returns the generated source file, sim_platform/gridiron/bvh/bvh_costs.h.
[[nodiscard]] std::string bvh_table_text(const Totals& totals);

/// @returns the generated source file, sim_platform/gridiron/sim/tile_costs.h.
[[nodiscard]] std::string tree_table_text(const Totals& totals);

/// Writes into a folder, for second_opinion, of each frame, those apart too, and of the exact decisions, `exact`: the
/// main memory, NAME.memory, the units, NAME.units (kind, units), a line of `frames` (name, width of packets or
/// `decisions`, effects of the store) and lines of `parts` (name, kind that it stands for); and of all together `units`
/// (kind, name, units, counted operations per unit, `events`: not charged, `effects`: of frames with effects, or
/// `packets`). Errors: std::runtime_error where a file cannot be written.
void write_memories(const std::string& folder);

/// @returns the same for people: every kind with its bounds and classes, and the rate of dual issue.
[[nodiscard]] std::string report_text(const Totals& totals);
[[nodiscard]] std::string bvh_report_text(const Totals& totals);
[[nodiscard]] std::string tree_report_text(const Totals& totals);

}  // namespace gridiron::calibrate
