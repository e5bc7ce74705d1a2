// Frame maker: the frames of an animation, one for each mesh or scene, or one for each view of a moving camera.
// Memory: a frame at a time. Threads: one; renders on the chip's. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "frame_log.h"
#include "gridiron/command_line/arguments.h"

namespace gridiron::tool {

struct MadeFrame {
  FrameSource source;
  FrameFigures figures;
  std::vector<std::byte> png;
  std::optional<std::string> note{};  ///< that no pixel shows the scene
  std::string notes{};                ///< of another rank, to be printed as they are
  std::string timeline{};             ///< if it was requested
};

/// Takes the share of a frame that is done, 0..1.
using FrameProgress = std::function<void(double share)>;

/// Errors of all functions: Failure.
class FrameMaker {
 public:
  FrameMaker() = default;
  virtual ~FrameMaker() = default;
  FrameMaker(const FrameMaker&) = delete;
  FrameMaker& operator=(const FrameMaker&) = delete;

  [[nodiscard]] virtual std::size_t count() const = 0;
  [[nodiscard]] virtual std::filesystem::path input_of(std::size_t i) const = 0;
  [[nodiscard]] virtual std::string picture_of(std::size_t i) const = 0;  ///< file name

  /// Reads what the views of all frames depend on. Called once, after the outputs were declared. All ranks call it.
  virtual void prepare() = 0;

  /// @returns what a frame is made of, without rendering it.
  [[nodiscard]] virtual FrameSource source_of(std::size_t i) = 0;

  /// Called once before frames are made, if there are any to make. All ranks call it.
  virtual void begin() {}

  /// @param has_timeline  whether to make that too.
  [[nodiscard]] virtual MadeFrame make(std::size_t i, bool has_timeline, const FrameProgress& progress) = 0;

  /// @returns the one build of all frames, where the camera alone moves.
  [[nodiscard]] virtual std::optional<SingleBuild> single_build() const { return std::nullopt; }
};

/// @returns "frame0007.png", with more digits where there are more than 10,000 frames.
[[nodiscard]] std::string numbered_picture(std::size_t i, std::size_t count);

/// @returns the maker of a request's frames; it reads folders and the camera's path, but no scene.
/// @param request  outlives it. Errors: Failure.
[[nodiscard]] std::unique_ptr<FrameMaker> make_frame_maker(const AnimateRequest& request);

// The two kinds, for make_frame_maker().
[[nodiscard]] std::unique_ptr<FrameMaker> make_series(const AnimateRequest& request,
                                                      std::vector<std::filesystem::path> inputs);
[[nodiscard]] std::unique_ptr<FrameMaker> make_camera_move(const AnimateRequest& request,
                                                           const std::filesystem::path& input);

// What both do.

/// Throws Failure (kUsage) if no frame of a scene of that kind can be rendered as requested, before it is read.
void check_foreseen(const AnimateRequest& request, const std::filesystem::path& input);

/// Says in a plan what builds the tree; without cycles the host does. Errors: Failure (kUsage) if that is not possible.
void choose_builder(const AnimateRequest& request, RenderPlan& plan);

/// @returns the hash of a camera, and of the size of its picture.
[[nodiscard]] std::uint64_t hash_of_view(const Camera& camera, std::uint32_t width, std::uint32_t height);

/// @returns the camera of a view with eye and at.
[[nodiscard]] Camera camera_of(const ViewRequest& view, std::uint32_t width, std::uint32_t height);

/// Renders a prepared frame; in plain mode it has no figures of time. @param build  for its figures; where the cores
/// build for each frame, the begin and end of the picture's pass are added to it.
[[nodiscard]] MadeFrame render_frame(FrameMemory& memory, const RenderPlan& plan, std::uint64_t content,
                                     const std::optional<BuildCost>& build, bool has_timeline,
                                     const FrameProgress& progress);

}  // namespace gridiron::tool
