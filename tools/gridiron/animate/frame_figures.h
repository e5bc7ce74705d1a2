// Frame figures: what a frame of an animation costs, and the table of all frames.
// Memory: std::string. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/sim/machine_profile.h>
#include <gridiron/sim/replay.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "gridiron/frame/frame_memory.h"
#include "gridiron/frame/render_plan.h"
#include "gridiron/scene/scene_input.h"

namespace gridiron::tool {

/// Work of the machine's general core.
struct BuildCost {
  double cycles = 0, seconds = 0;
};

struct FrameFigures {
  std::uint64_t triangles = 0;
  std::optional<float> lambda;     ///< with a grid
  std::optional<BuildCost> build;  ///< nothing: not counted; 0 where nothing is built for the frame
  double render_cycles = 0, render_seconds = 0;
  std::uint64_t hash = 0;  ///< of the picture

  [[nodiscard]] double seconds() const { return (build ? build->seconds : 0) + render_seconds; }
  [[nodiscard]] double fps() const { return seconds() > 0 ? 1 / seconds() : 0; }
};

/// @returns the cost of building a frame's scene image; nothing where it is not counted: a tree's, and that of a packed
/// scene, which somebody else has built. Other ways of building (on the cores) belong here.
[[nodiscard]] std::optional<BuildCost> cost_of_build(const SceneInput& input, const FrameMemory& memory,
                                                     const RenderPlan& plan);

/// A frame as the table and the figures on standard output name it.
struct NamedFrame {
  std::string mesh;     ///< file name of the mesh or scene
  std::string picture;  ///< file name
  FrameFigures figures;
};

/// @returns animation.csv. Fields of a build that is not counted are empty.
[[nodiscard]] std::string table_of(const std::vector<NamedFrame>& frames, const sim::MachineProfile& machine);

/// Where the camera alone moves, the scene image is built once.
struct SingleBuild {
  std::string structure;          ///< "tree"; empty: it was packed
  std::optional<BuildCost> cost;  ///< nothing: not counted
};

/// Prints each frame and all of them together on standard output.
void print_frames(const std::vector<NamedFrame>& frames, const sim::MachineProfile& machine, std::uint32_t cores,
                  const std::optional<SingleBuild>& build);

}  // namespace gridiron::tool
