// Arguments: the command line as values.
// Memory: owns strings. Threads: one. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/records.h>
#include <gridiron/sim/sim_chip.h>

#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "base/numbers.h"
#include "gridiron/device/configurations.h"
#include "gridiron/device/machine_file.h"
#include "gridiron/scene/view.h"

namespace gridiron::tool {

/// Which grid a mesh gets, and which machine's memory it has to fit. A packed scene brings its own grid.
struct SceneArguments {
  std::filesystem::path input;
  Machine machine;  ///< never null
  const Configuration* configuration = nullptr;
  std::optional<float> lambda;
  std::optional<std::uint32_t> macro_width;
  std::uint32_t most_macro_width = kMaxMacroWidth;  ///< that the store holds: a configuration's is cut to it
  std::optional<float> tolerance;  ///< of round shapes in a text scene, world units; nothing: the reader's own
  bool quiet = false;              ///< notes are not told
};

/// What the command line fixes of the kernel and its buffers; the rest is the scene's, machine's and configuration's.
struct AskedLayout {
  std::optional<sim::StoreSize> store;
  std::uint32_t tile_width = 0, packet_width = 0;  ///< 0: not asked for
  std::optional<BufferDepths> depths;
};

struct RenderArguments {
  SceneArguments scene;
  AskedLayout asked;
  bool has_size = false, has_shading = false;  ///< asked for; else they are the scene's
  std::filesystem::path output;                ///< never empty
  std::optional<std::filesystem::path> depth, ids, report, timeline;
  bool depth_plane = false, ids_plane = false;  ///< wanted without a file of them
  std::optional<std::filesystem::path> camera;
  ViewRequest view;
  std::uint32_t width = 1024, height = 1024;
  std::optional<CountPair> tile;  ///< column and row of the one tile to render
  std::uint32_t cores = 0;        ///< 0: the machine's
  std::uint32_t threads = 0;      ///< 0: the host's
  std::uint32_t lanes = 0;        ///< 0: 4 where time is told, else the widest of the host
  std::uint32_t tile_width = 0;   ///< as all that follows: settled by settle_layout(), for a stream once it is read
  std::uint32_t packet_width = 0;
  BufferDepths depths;
  BufferDepths wanted_depths;  ///< the configuration's or the command line's; `depths` where the store holds fewer
  std::uint32_t techniques = 0;
  Accuracy accuracy = Accuracy::kStandard;
  Shading shading = Shading::kSimple;
  sim::StoreSize store = sim::StoreSize::k256KB;
  sim::Mode mode = sim::Mode::kChecked;
  sim::Completion completion = sim::Completion::kEarly;
  std::uint64_t seed = 0;
  std::uint32_t repeats = 1;  ///< the frame is built and rendered so often
  bool quiet = false;

  [[nodiscard]] bool has_depth() const { return depth || depth_plane; }
  [[nodiscard]] bool has_ids() const { return ids || ids_plane; }

  /// What the kernel is made for, once nothing is 0.
  [[nodiscard]] sim::LayoutChoice layout() const {
    return {store, tile_width, packet_width, shading == Shading::kScene};
  }
};

/// A frame for each mesh, with the grid of each built for it.
struct AnimateArguments {
  RenderArguments render;                     ///< of every frame; its input is the frame's
  std::vector<std::filesystem::path> inputs;  ///< meshes, and folders of them
  std::filesystem::path output;               ///< folder, never empty
};

struct InfoArguments {
  SceneArguments scene;
  std::optional<sim::StoreSize> asked_store;          ///< nothing: the largest that fits
  sim::StoreSize store = sim::StoreSize::k256KB;      ///< whose map is told
  TriangleFormat format = TriangleFormat::kVertices;  ///< of a mesh or a text scene
  std::optional<Accuracy> accuracy;  ///< whose bounds are told; nothing: the one that the image's format is for
  std::uint32_t packet_width = 0;    ///< 0: the configuration's
  bool has_depth = false;            ///< distances are wanted too
  std::uint32_t width = 1024, height = 1024;
  bool has_size = false;  ///< asked for; else it is a text scene's own
  bool json = false;
};

struct PackArguments {
  SceneArguments scene;
  TriangleFormat format = TriangleFormat::kVertices;
  std::filesystem::path output;
};

/// A frame as a file for a device.
struct JobArguments {
  RenderArguments render;                     ///< its output is the job
  std::uint64_t base_address = 0;             ///< where the device loads it
  std::optional<std::uint64_t> memory_bytes;  ///< that the device has from there on
};

/// What a device made of a job.
struct ResultArguments {
  std::filesystem::path job, result;
  std::optional<std::filesystem::path> output, depth, ids, report;
  bool compare = false;       ///< with the simulator's frame
  Machine predict;            ///< what its tiles would take there; null: nobody asks
  std::uint32_t threads = 0;  ///< 0: the host's
  bool quiet = false;
};

struct MachinesArguments {
  Machine machine;  ///< the one to print; null: all built-in ones are listed
  bool json = false;
  bool quiet = false;  ///< accepted as everywhere: a list has nothing beside its result
};

enum class ExperimentName { kPaper, kAccuracy, kEffects };

struct ExperimentArguments {
  ExperimentName name = ExperimentName::kPaper;
  std::filesystem::path output;  ///< folder
  std::filesystem::path scenes;  ///< folder of scans; empty: none; kEffects has none
  std::uint32_t threads = 0;     ///< 0: the host's
  std::uint32_t width = 1024, height = 1024;
  std::uint32_t largest_knot = 1'000'000;  ///< kPaper: triangles of the largest mesh of Table 1
  bool quiet = false;
};

/// Help or the version was asked for: text for standard output.
struct TextRequest {
  std::string text;
};

using Command = std::variant<RenderArguments, AnimateArguments, InfoArguments, PackArguments, JobArguments,
                             ResultArguments, MachinesArguments, ExperimentArguments, TextRequest>;

/// Reads a machine file that is named, and the first bytes of a scene that is no stream. Errors: Failure, kUsage with
/// what is wrong, kBadInput of a machine file.
[[nodiscard]] Command parse_arguments(int count, const char* const* values);

}  // namespace gridiron::tool
