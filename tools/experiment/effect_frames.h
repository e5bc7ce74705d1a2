// Frames of the effects experiment: their counts, and the cost of the effects that a frame does not call for.
// Memory: a frame owns its picture. Threads: any, no shared state. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/effect_records.h>
#include <gridiron/base/records.h>
#include <gridiron/base/stages.h>
#include <gridiron/base/work_counters.h>
#include <gridiron/sim/replay.h>
#include <gridiron/sim/trace.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "experiment/effect_scenes.h"
#include "files/image_files.h"
#include "gridiron/device/configurations.h"
#include "gridiron/frame/frame_memory.h"
#include "gridiron/frame/render_plan.h"
#include "gridiron/scene/scene_input.h"

namespace gridiron::experiment {

struct EffectFrameRequest {
  std::uint32_t width = 96, height = 96;
  float lambda = 4;  ///< grid cells per triangle
  tool::BufferDepths depths = tool::kDoubleBuffering;
  Accuracy accuracy = Accuracy::kStandard;
};

/// A frame in main memory, ready to be rendered with configuration grid on the home machine.
struct PreparedEffectFrame {
  /// Errors: tool::Failure.
  PreparedEffectFrame(const EffectScene& scene, const EffectFrameRequest& request);

  tool::SceneInput input;
  tool::RenderPlan plan;
  tool::FrameMemory memory;
};

/// The counts of a frame.
struct EffectFrame {
  std::uint32_t called_for = 0;  ///< EffectBits, as the scene image has them
  bool has_shadows = true;
  sim::WorkTotals work{};
  std::array<sim::StageTiming, kStageCount> stages{};  ///< sums over the cores
  double cycles = 0, seconds = 0;                      ///< of the whole frame
  double core_cycles = 0;                              ///< frame's cycles times cores
  std::uint64_t scene_bytes = 0;                       ///< of the scene image
  tool::Picture<std::uint32_t> picture;                ///< 0xAABBGGRR

  [[nodiscard]] std::uint64_t count(WorkId kind) const { return work[kind.number()]; }
  [[nodiscard]] const sim::StageTiming& stage(gridiron::Stage stage) const {
    return stages[static_cast<std::size_t>(stage)];
  }
  [[nodiscard]] std::uint64_t primary_rays() const;
  [[nodiscard]] double wait_cycles() const;            ///< of all stages and cores
  [[nodiscard]] double secondary_wait_cycles() const;  ///< of stages surface, shadow, occlusion, bounce, environment
};

/// Renders on the calling thread with configuration grid on six cores of the home machine. Errors: tool::Failure.
[[nodiscard]] EffectFrame render_effect_frame(const EffectScene& scene, const EffectFrameRequest& request);

/// The counts of a frame for an effect that it does not call for.
struct AbsentCost {
  EffectBits effect{};
  std::string_view what{};  ///< that was counted
  std::uint64_t count = 0;
  std::string_view stages{};  ///< with `bytes` and `cycles`; empty: the effect has none of its own
  std::uint64_t bytes = 0;    ///< moved, in and out
  double cycles = 0;          ///< computing and waiting; for shadows waiting alone, as light has the same stage

  [[nodiscard]] bool is_nothing() const { return count == 0 && bytes == 0 && cycles == 0; }
};

/// @returns one for each effect that the frame does not call for, in the order of their bits.
[[nodiscard]] std::vector<AbsentCost> absent_costs(const EffectFrame& frame);

/// Errors: tool::Failure (kCheckFailed) if an effect that is not called for cost anything, or the effects called for
/// are not `expected`. @param name  of the frame, for messages.
void check_absent_costs(const EffectFrame& frame, std::uint32_t expected, const std::string& name);

/// A node's first child is asked for when its rays are known, and taken at once: that wait stays, but it is little of
/// the cores' time.
inline constexpr double kLeastHiddenShare = 0.6, kMostWaitShare = 0.03;

/// @returns the share of waits for secondary rays that buffering hides; 1 without such waits.
[[nodiscard]] double hidden_share(const EffectFrame& single, const EffectFrame& buffered);

/// @returns the share of the cores' time that they wait for secondary rays; 0 for a frame of no time.
[[nodiscard]] double secondary_wait_share(const EffectFrame& frame);

/// Errors: tool::Failure (kCheckFailed) if less than kLeastHiddenShare is hidden or more than kMostWaitShare is left.
void check_hiding(const EffectFrame& single, const EffectFrame& buffered, const std::string& name);

}  // namespace gridiron::experiment
