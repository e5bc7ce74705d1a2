// Arguments: the command line as values, with one request type for each command.
// Memory: owns strings. Threads: one. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "gridiron/frame/render_plan.h"
#include "gridiron/info/info_plan.h"

namespace gridiron::tool {

/// Frames of an animation: one for each mesh or scene, or one for each view of a camera that moves.
struct AnimateRequest {
  RenderRequest render;                       ///< of every frame; its input is the frame's
  std::vector<std::filesystem::path> inputs;  ///< meshes, scenes, and folders of them
  std::filesystem::path output;               ///< folder, never empty
  std::optional<std::filesystem::path> path;  ///< of the camera
  std::optional<std::uint32_t> turntable;     ///< frames of a camera that goes around once
  std::optional<std::uint32_t> animation;     ///< frames of the input's own animation, from its begin to its end
  std::string clip;                           ///< that animation's name or number; empty: the first
  std::optional<std::filesystem::path> film;
  std::optional<std::filesystem::path> timeline;  ///< of the first frame
  std::optional<float> frames_per_second;         ///< of the film; nothing: kUsualFramesPerSecond
  std::optional<Builder> builder;                 ///< of trees; nothing: the cores where they can
  bool keeps_vertex_order = false;                ///< that of the file, where the cores build
  bool resume = false;                            ///< keeps the complete pictures of an earlier command
  std::map<std::string, std::string> options{};   ///< as given, all but those on which no picture or figure depends

  [[nodiscard]] bool has_moving_camera() const { return path || turntable; }
};
inline constexpr float kUsualFramesPerSecond = 24;

struct PackRequest {
  SceneRequest scene;
  std::optional<std::filesystem::path> camera;  ///< of a look, whose lights it places
  ViewRequest view;                             ///< likewise
  TriangleFormat format = TriangleFormat::kVertices;
  std::filesystem::path output;
};

/// A frame as a file for a device.
struct JobRequest {
  RenderRequest render;  ///< with at most port::kMostBoardCores cores
  std::filesystem::path output;
  std::uint64_t base_address = 0;             ///< where the device loads it
  std::optional<std::uint64_t> memory_bytes;  ///< that the device has from there on
};

/// The result that a device made of a job.
struct ResultRequest {
  std::filesystem::path job, result;
  FrameOutputs outputs;
  bool compare = false;                  ///< with the simulator's frame
  Machine predict;                       ///< whose prediction is compared; null: none
  std::optional<std::uint32_t> threads;  ///< nothing: the host's
  bool quiet = false;
};

struct MachinesRequest {
  Machine machine;  ///< the one to print; null: all built-in ones are listed
  bool json = false;
  bool quiet = false;  ///< accepted as everywhere: a list has no other output
};

enum class ExperimentName { kPaper, kAccuracy, kEffects, kDynamic };

struct ExperimentRequest {
  ExperimentName name = ExperimentName::kPaper;
  std::filesystem::path output;                 ///< folder
  std::optional<std::filesystem::path> scenes;  ///< folder of scans; not used by kEffects
  std::optional<std::uint32_t> threads;         ///< nothing: the host's
  std::optional<CountPair> size;
  std::optional<std::uint32_t> largest_knot;  ///< kPaper: triangles of the largest mesh of Table 1
  bool quiet = false;
};

/// Help or the version: text for standard output.
struct TextRequest {
  std::string text;
};

using Command = std::variant<RenderRequest, AnimateRequest, InfoRequest, PackRequest, JobRequest, ResultRequest,
                             MachinesRequest, ExperimentRequest, TextRequest>;

/// Opens no file but the machine file. Errors: Failure, kUsage for everything that is wrong whatever the scene is,
/// kBadInput for a machine file.
[[nodiscard]] Command parse_arguments(int count, const char* const* values);

}  // namespace gridiron::tool
