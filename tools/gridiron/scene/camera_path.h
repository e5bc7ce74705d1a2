// Camera path: a view that moves through key views. Camera moves: the views of all frames of a path, or of a turntable.
// Source of the curve: E. Catmull, R. Rom, "A class of local interpolating splines", 1974.
// Memory: std::vector. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "view.h"

namespace gridiron::tool {

/// Frames of an animation, at most.
inline constexpr std::uint32_t kMostFrames = 1'000'000;

/// A view that a path passes through.
struct PathKey {
  std::uint32_t frame = 0;
  std::uint64_t line = 0;  ///< of the file, from 1
  Vec3 eye{}, at{};
  Vec3 up{0, 1, 0};
  float fov_degrees = kDefaultFovDegrees;
};

/// Keys in the order of their frames; the first is frame 0, the last one is the last frame.
struct CameraPath {
  std::filesystem::path file;
  std::vector<PathKey> keys;

  [[nodiscard]] std::uint32_t frame_count() const { return keys.back().frame + 1; }
};

/// Reads a path: keys of a line `frame N` and lines `eye x y z`, `at x y z` or `direction x y z`, `up x y z`, `fov
/// degrees`. What a key leaves out is that of the key before; the first has eye and at, or direction. # opens a
/// comment. Errors: Failure (kBadInput), `file:line: reason`.
[[nodiscard]] CameraPath read_camera_path(const std::filesystem::path& path);

/// @returns the view of a frame, every part of it. Eye, at and up follow Catmull-Rom curves, so that their speed has no
/// jump at a key; so does the field of view, limited to those of the two keys around the frame. Between two keys with
/// the same value it does not change.
/// Precondition: frame < path.frame_count().
[[nodiscard]] ViewRequest view_of_path(const CameraPath& path, std::uint32_t frame);

/// @returns the views of all frames, `parts` in place of the path's own. Errors: Failure (kBadInput), `file:line:
/// reason`, if a view between two keys has a defect; the line is the earlier key's.
[[nodiscard]] std::vector<ViewRequest> views_of_path(const CameraPath& path, const ViewRequest& parts);

/// @returns the views of frames whose camera goes once around the up axis, to the right; the first is that of
/// `request`. If an eye is given, it goes around `at`. Otherwise no frame cuts off a part of the scene: the solid that
/// the scene's points sweep is framed, and the axis leads through their middle, or through a given `at`.
///
/// @param aspect, points  as for complete_view(). Errors: Failure (kUsage) if the request has a defect.
[[nodiscard]] std::vector<ViewRequest> views_of_turntable(const ViewRequest& request, std::uint32_t frame_count,
                                                          double aspect, const PointSource& points);

}  // namespace gridiron::tool
