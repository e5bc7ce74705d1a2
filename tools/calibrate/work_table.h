// The table of what a unit of each kind of work costs: made from counted frames, written as the source file that the
// machine profiles are built with.
// Memory: owned. Threads: the caller's only. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pipe_model.h>

#include <cstdint>
#include <string>

namespace gridiron::calibrate {

/// Counts the frames that the table is made from: the teapot, 1,640 triangles on 96 x 96 pixels, as `reference`, as
/// `best`, from near, with the paper's test, with planes and on a lattice; the teapot on a floor with every effect,
/// 12 x 12 and 20 x 20 pixels; and the exact decisions on 64 rays and triangles of it.
///
/// @returns the sum over the frames. Errors: std::runtime_error where a counted picture differs from the kernel's.
[[nodiscard]] Totals count_frames(std::uint32_t superblock_branches = kSuperblockBranches);

/// @returns the generated source file, sim_platform/gridiron/sim/work_costs.h.
[[nodiscard]] std::string table_text(const Totals& totals);

/// The same for the cached BVH: the teapot and a torus knot of 12,000 triangles, whose lines exceed the caches, each
/// with packets one after another and in a ring. By Work and bvh::BvhWork.
[[nodiscard]] Totals count_bvh_frames(std::uint32_t superblock_branches = kSuperblockBranches);

/// @returns the generated source file, sim_platform/gridiron/bvh/bvh_costs.h.
[[nodiscard]] std::string bvh_table_text(const Totals& totals);

/// Writes into a folder, for second_opinion: of each frame and of `dense`, which is `reference` of a teapot of 16 times
/// the triangles, the main memory, NAME.memory, and the units, NAME.units (kind, units); of the exact decisions their
/// numbers, exact.memory, and units; and of all but `dense` together a file `units` (kind, name, units, counted
/// operations per unit, `effects` where frames with effects stand for the kind, else `packets`).
/// Errors: std::runtime_error where a file cannot be written.
void write_memories(const std::string& folder);

/// @returns the same for people: every kind with its bounds and classes, and the rate of dual issue.
[[nodiscard]] std::string report_text(const Totals& totals);
[[nodiscard]] std::string bvh_report_text(const Totals& totals);

}  // namespace gridiron::calibrate
