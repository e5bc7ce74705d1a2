// Camera paths and turntables. SPDX-License-Identifier: Apache-2.0
#include "camera_path.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <numbers>
#include <span>
#include <string>

#include "base/failure.h"

namespace gridiron::tool {
namespace {

// The speed of a curve at a key: that of the parabola through the key and its neighbours. It is 0 beside a neighbour
// with the same value, so that a camera that waits does not drift.
template <class Value, class ValueOf>
Value speed_at(const std::vector<PathKey>& keys, std::size_t i, ValueOf value_of) {
  const auto slope = [&](std::size_t from) {
    return (value_of(keys[from + 1]) - value_of(keys[from])) / double(keys[from + 1].frame - keys[from].frame);
  };
  if (i == 0) return slope(0);
  if (i + 1 == keys.size()) return slope(i - 1);
  const Value before = slope(i - 1), after = slope(i);
  if (before == Value(0) || after == Value(0)) return Value(0);
  const double frames_before = keys[i].frame - keys[i - 1].frame, frames_after = keys[i + 1].frame - keys[i].frame;
  return (frames_after * before + frames_before * after) / (frames_before + frames_after);
}

// The cubic between key i and the next one. @param share  of the way, 0..1.
template <class Value, class ValueOf>
Value value_on_curve(const std::vector<PathKey>& keys, std::size_t i, double share, ValueOf value_of) {
  const double frames = keys[i + 1].frame - keys[i].frame;
  const Value begin = value_of(keys[i]), end = value_of(keys[i + 1]);
  const Value leave = frames * speed_at<Value>(keys, i, value_of);
  const Value arrive = frames * speed_at<Value>(keys, i + 1, value_of);
  const Value difference = end - begin;
  return begin + share * (leave + share * (3.0 * difference - 2.0 * leave - arrive +
                                           share * (leave + arrive - 2.0 * difference)));
}

// The last key that is not after a frame.
std::size_t key_before(const CameraPath& path, std::uint32_t frame) {
  const auto after = std::ranges::upper_bound(path.keys, frame, {}, &PathKey::frame);
  return static_cast<std::size_t>(after - path.keys.begin()) - 1;
}

ViewRequest turned_about(const ViewRequest& view, const DVec3& place, const DVec3& axis, double angle) {
  const auto turned_vector = [&](const DVec3& v) {  // Rodrigues' formula
    return std::cos(angle) * v + std::sin(angle) * glm::cross(axis, v) +
           (1 - std::cos(angle)) * glm::dot(axis, v) * axis;
  };
  ViewRequest turned_view = view;
  turned_view.eye = Vec3(place + turned_vector(DVec3(*view.eye) - place));
  turned_view.at = Vec3(place + turned_vector(DVec3(*view.at) - place));
  turned_view.up = Vec3(turned_vector(DVec3(*view.up)));
  return turned_view;
}

}  // namespace

ViewRequest view_of_path(const CameraPath& path, std::uint32_t frame) {
  const std::size_t i = key_before(path, frame);
  const PathKey& key = path.keys[i];
  if (key.frame == frame) return {.eye = key.eye, .at = key.at, .up = key.up, .fov_degrees = key.fov_degrees};
  const PathKey& next = path.keys[i + 1];
  const double share = double(frame - key.frame) / double(next.frame - key.frame);
  const auto place = [&](Vec3 PathKey::*part) {
    return Vec3(value_on_curve<DVec3>(path.keys, i, share, [part](const PathKey& one) { return DVec3(one.*part); }));
  };
  const DVec3 up =
      value_on_curve<DVec3>(path.keys, i, share, [](const PathKey& one) { return glm::normalize(DVec3(one.up)); });
  const double fov =
      value_on_curve<double>(path.keys, i, share, [](const PathKey& one) { return double{one.fov_degrees}; });
  const auto [least, most] = std::minmax(key.fov_degrees, next.fov_degrees);
  return {.eye = place(&PathKey::eye),
          .at = place(&PathKey::at),
          .up = Vec3(up),
          .fov_degrees = std::clamp(static_cast<float>(fov), least, most)};
}

std::vector<ViewRequest> views_of_path(const CameraPath& path, const ViewRequest& parts) {
  std::vector<ViewRequest> views;
  for (std::uint32_t frame = 0; frame < path.frame_count(); ++frame) {
    const ViewRequest view = join_view(parts, view_of_path(path, frame));
    if (const char* defect = view_defect(*view.eye, *view.at, *view.up)) {
      const PathKey& key = path.keys[key_before(path, frame)];
      const std::string where = frame == key.frame ? "" : ", between this key and the next";
      input_error(path.file, key.line, "frame " + std::to_string(frame) + where + ": " + defect);
    }
    views.push_back(view);
  }
  return views;
}

std::vector<ViewRequest> views_of_turntable(const ViewRequest& request, std::uint32_t frame_count, double aspect,
                                            const PointSource& points) {
  const Vec3 up = request.up.value_or(Vec3(0, 1, 0));
  const bool is_framed = !request.eye;
  std::vector<Vec3> swept;
  std::optional<DVec3> place;
  if (is_framed && up != Vec3(0.0f)) {
    place = request.at ? DVec3(*request.at) : middle_of(points);
    swept = swept_points(points, *place, DVec3(up));
  }
  const PointSource framed = [&](const PointVisitor& visitor) { visitor(swept); };
  const Camera camera = complete_view(request, aspect, is_framed ? framed : points);
  if (!place) place = DVec3(camera.at);
  const ViewRequest first = {.eye = camera.eye,
                             .at = camera.at,
                             .up = camera.up,
                             .fov_degrees = request.fov_degrees.value_or(kDefaultFovDegrees)};
  const DVec3 axis = glm::normalize(DVec3(up));
  std::vector<ViewRequest> views = {first};
  for (std::uint32_t frame = 1; frame < frame_count; ++frame) {
    views.push_back(turned_about(first, *place, axis, 2 * std::numbers::pi * frame / frame_count));
  }
  return views;
}

}  // namespace gridiron::tool
