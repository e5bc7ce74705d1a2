// Render plan: the request for a frame, and the plan that one pure function makes of it.
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
#include "gridiron/sweep/machine_sweep.h"

namespace gridiron::tool {

/// Files of a frame.
struct FrameOutputs {
  std::optional<std::filesystem::path> picture, depth, ids, report, timeline, sweep, sweep_plot;

  /// For declare_outputs().
  [[nodiscard]] std::vector<Output> declared() const;
};

/// The request for a frame, as given. resolve() completes it.
struct RenderRequest {
  SceneRequest scene;
  FrameOutputs outputs;
  bool depth_plane = false, ids_plane = false;  ///< requested without a file
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
  std::uint32_t repeats = 1;      ///< the frame is built and rendered so often
  bool has_bound = false;         ///< of its tiles, for its camera
  std::vector<VariedKey> varied;  ///< of the machines of a sweep; none: no sweep

  /// Adds the picture's default name if none is given: INPUT's name with .png.
  [[nodiscard]] FrameOutputs named_outputs() const;
};

/// Properties of the host that frames depend on.
struct Host {
  std::uint32_t threads = 1;
  std::uint32_t lanes = 4;  ///< of the widest kernel that it can run
  bool has_instrumented_mode = true;
};
[[nodiscard]] Host this_host();

/// What builds the tree of a scene image.
enum class Builder : std::uint8_t {
  kMaster,  ///< the general core, that is, prepare
  kCores,   ///< the cores of the simulated chip
};

/// A completed frame; the commands carry it out.
struct RenderPlan {
  SceneRequest scene;    ///< with a configuration
  FrameOutputs outputs;  ///< with a picture
  bool has_depth = false, has_ids = false;
  std::uint32_t width = kUsualPictureSize.x, height = kUsualPictureSize.y;
  std::optional<CountPair> tile;
  std::uint32_t cores = 1;    ///< of the machine
  std::uint32_t threads = 1;  ///< of the host, no more than there are tiles to render
  std::uint32_t lanes = 4;
  sim::LayoutChoice layout{};
  std::uint32_t most_macro_width = kMaxMacroWidth;  ///< of the store; a configuration's width is limited to it
  BufferDepths depths{};
  EngineId engine = EngineId::kGrid;  ///< of eye rays
  std::uint32_t techniques = 0;
  Accuracy accuracy = Accuracy::kStandard;
  Shading shading = Shading::kSimple;
  sim::Mode mode = sim::Mode::kChecked;
  sim::Completion completion = sim::Completion::kEarly;
  std::uint64_t seed = 0;
  std::uint32_t repeats = 1;
  bool has_bound = false;         ///< of tiles, for the camera
  std::vector<VariedKey> varied;  ///< of the machines of a sweep
  Builder builder = Builder::kMaster;
};

/// Rejects impossible requests, whatever the scene is. Errors: Failure (kUsage).
void check_request(const RenderRequest& request, const Host& host);

/// Completes a frame from its arguments alone; opens no file and prints nothing.
///
/// The configuration is the named one or default_configuration(). The store is the requested one, or the largest one of
/// the machine that is built for the rest. A configuration with more buffers than the store gets those that there are.
/// Errors: Failure (kUsage) of check_request(), if the scene cannot be rendered as requested, if no kernel is built for
/// it, or if its buffers do not hold what was requested. Precondition: the scene's kind is known.
[[nodiscard]] RenderPlan resolve(const RenderRequest& request, const KnownScene& scene, const Host& host);

}  // namespace gridiron::tool
