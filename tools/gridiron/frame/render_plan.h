// Render plan: what was asked of a frame, and the frame that one pure function makes of it.
// Memory: owns paths; shares the machine. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/records.h>
#include <gridiron/sim/sim_chip.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "base/numbers.h"
#include "files/command_files.h"
#include "gridiron/device/configurations.h"
#include "gridiron/device/layout_choice.h"
#include "gridiron/scene/scene_request.h"
#include "gridiron/scene/view.h"

namespace gridiron::tool {

/// Files of a frame.
struct FrameOutputs {
  std::optional<std::filesystem::path> picture, depth, ids, report, timeline;

  /// For declare_outputs().
  [[nodiscard]] std::vector<Output> declared() const;
};

/// What is asked of a frame, as given. What is not given resolve() settles.
struct RenderRequest {
  SceneRequest scene;
  FrameOutputs outputs;
  bool depth_plane = false, ids_plane = false;  ///< wanted without a file of them
  std::optional<std::filesystem::path> camera;
  ViewRequest view;
  std::optional<CountPair> size;                       ///< of the picture
  std::optional<CountPair> tile;                       ///< column and row of the one tile to render
  std::optional<std::uint32_t> cores, threads, lanes;  ///< of the machine, of the host, of a SIMD group
  LayoutRequest layout;
  bool no_mailbox = false, no_culling = false, no_subpackets = false, no_empty_skip = false;  ///< the configuration's
  Accuracy accuracy = Accuracy::kStandard;
  std::optional<Shading> shading;
  sim::Mode mode = sim::Mode::kChecked;
  sim::Completion completion = sim::Completion::kEarly;
  std::optional<std::uint64_t> seed;
  std::uint32_t repeats = 1;  ///< the frame is built and rendered so often

  /// With a picture: INPUT's name with .png where none was given.
  [[nodiscard]] FrameOutputs named_outputs() const;
};

/// What frames depend on of the computer that simulates them.
struct Host {
  std::uint32_t threads = 1;
  std::uint32_t lanes = 4;  ///< of the widest kernel that it can run
  bool has_instrumented_mode = true;
};
[[nodiscard]] Host this_host();

/// A frame, settled: the commands carry it out.
struct RenderPlan {
  SceneRequest scene;
  FrameOutputs outputs;  ///< with a picture
  bool has_depth = false, has_ids = false;
  std::uint32_t width = kUsualPictureSize.x, height = kUsualPictureSize.y;
  std::optional<CountPair> tile;
  std::uint32_t cores = 1;    ///< of the machine
  std::uint32_t threads = 1;  ///< of the host, no more than there are tiles to render
  std::uint32_t lanes = 4;
  sim::LayoutChoice layout{};
  std::uint32_t most_macro_width = kMaxMacroWidth;  ///< that the store holds: a configuration's is cut to it
  BufferDepths depths{};
  std::uint32_t techniques = 0;
  Accuracy accuracy = Accuracy::kStandard;
  Shading shading = Shading::kSimple;
  sim::Mode mode = sim::Mode::kChecked;
  sim::Completion completion = sim::Completion::kEarly;
  std::uint64_t seed = 0;
  std::uint32_t repeats = 1;
};

/// Refuses what makes no sense whatever the scene is. Errors: Failure (kUsage).
void check_request(const RenderRequest& request, const Host& host);

/// Settles a frame. It opens no file and prints nothing: what it goes by is in its arguments.
///
/// The store is the one asked for, or the largest one of the machine that is built for the rest; a configuration that
/// the store has too few buffers for gets those that there are.
/// Errors: Failure (kUsage) of check_request(), where the scene cannot be rendered as asked, where no kernel is built
/// for it, or its buffers do not hold what was asked for. Precondition: the scene's kind is known.
[[nodiscard]] RenderPlan resolve(const RenderRequest& request, const KnownScene& scene, const Host& host);

}  // namespace gridiron::tool
