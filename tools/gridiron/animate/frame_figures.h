// Frame figures: what a frame of an animation costs, and the table of all frames.
// Memory: std::string. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/sim/build_work.h>
#include <gridiron/sim/machine_profile.h>
#include <gridiron/sim/pass_timing.h>
#include <gridiron/sim/replay.h>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gridiron/frame/frame_memory.h"
#include "gridiron/frame/render_plan.h"
#include "gridiron/scene/scene_input.h"

namespace gridiron::tool {

/// The time of one pass, or of what the general core does between two, in cycles of the cores.
struct PassFigures {
  std::string name;
  std::uint32_t items = 0;  ///< 1: one core works while the others are idle; 0 of the general core
  double start_cycles = 0, run_cycles = 0, barrier_cycles = 0;
  std::array<double, sim::kPassLimitCount> limits{};  ///< cycles by PassLimit; none of the general core
  std::uint64_t bytes_in = 0, bytes_out = 0;          ///< of all cores, as requested

  [[nodiscard]] double cycles() const { return start_cycles + run_cycles + barrier_cycles; }
  [[nodiscard]] bool is_of_one() const { return items <= 1; }
  /// What keeps it from being faster: the name of a PassLimit, or "general_core".
  [[nodiscard]] std::string_view binding() const;
};

/// What a build takes: cycles of the machine's general core, or of the cores where these build.
struct BuildCost {
  double cycles = 0, seconds = 0;
  Builder builder = Builder::kMaster;
  std::vector<PassFigures> passes{};  ///< where the cores build; with the picture's, whose run is not part of the cost
};

struct FrameFigures {
  std::uint64_t triangles = 0;
  std::optional<float> lambda;     ///< with a grid
  std::optional<BuildCost> build;  ///< nothing: not counted; 0 where nothing is built for the frame
  bool is_timed = true;            ///< false: rendered without cycles; then nothing of the times is known
  double render_cycles = 0, render_seconds = 0;
  std::uint64_t hash = 0;  ///< of the picture

  [[nodiscard]] double seconds() const { return (build ? build->seconds : 0) + render_seconds; }
  [[nodiscard]] double fps() const { return seconds() > 0 ? 1 / seconds() : 0; }
};

/// @returns the cost of building a frame's scene image; nothing where it is not counted: an image with effects or a
/// tree on a lattice that the general core builds, and a packed scene, which somebody else has built. Of a build by the
/// cores all passes count, one after another, and what the general core does behind them; of a scene with effects only
/// the tree and the check value.
[[nodiscard]] std::optional<BuildCost> cost_of_build(const SceneInput& input, FrameMemory& memory,
                                                     const RenderPlan& plan);

/// @returns what the general core does for the image of a mesh; nothing where it is not counted.
[[nodiscard]] std::optional<sim::BuildWork> work_of_master(const Mesh& mesh, FrameMemory& memory);

/// @returns the cost of a build by so many cores.
[[nodiscard]] BuildCost cost_of_cores(const CoresBuild& build, const sim::MachineProfile& machine, std::uint32_t cores);

/// What the general core does behind the passes of a build, by its name and in cycles of the cores.
inline constexpr const char* kMasterPass = "check_value";
[[nodiscard]] double cycles_of_master(const CoresBuild& build, const sim::MachineProfile& machine);

/// Adds the pass of the picture, which follows a build by the cores, to its figures and its start and barrier to the
/// cost. @param picture  its trace on the machine.
void add_picture(const sim::FrameTiming& picture, const sim::MachineProfile& machine, BuildCost& build);

/// A frame as the table and the figures on standard output name it.
struct NamedFrame {
  std::string mesh;     ///< file name of the mesh or scene
  std::string picture;  ///< file name
  FrameFigures figures;
};

/// @returns animation.csv. Fields of what is not counted are empty.
[[nodiscard]] std::string table_of(const std::vector<NamedFrame>& frames, const sim::MachineProfile& machine);

/// @returns animation_passes.csv: the passes of all frames that the cores build for; empty if there are none.
[[nodiscard]] std::string passes_of(const std::vector<NamedFrame>& frames);

/// @returns animation.svg: the milliseconds of each frame, of its build and of its picture; empty if no frame is timed.
[[nodiscard]] std::string plot_of(const std::vector<NamedFrame>& frames);

/// Where the camera alone moves, the scene image is built once.
struct SingleBuild {
  std::string structure;          ///< "tree"; empty: it was packed
  std::optional<BuildCost> cost;  ///< nothing: not counted
};

/// Prints each frame and all of them together on standard output.
void print_frames(const std::vector<NamedFrame>& frames, const sim::MachineProfile& machine, std::uint32_t cores,
                  const std::optional<SingleBuild>& build);

}  // namespace gridiron::tool
