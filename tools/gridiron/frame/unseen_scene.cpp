// Unseen scene. SPDX-License-Identifier: Apache-2.0
#include "unseen_scene.h"

#include <gridiron/base/math.h>
#include <gridiron/base/work_counters.h>

#include <algorithm>
#include <bit>
#include <cstdio>
#include <glm/geometric.hpp>
#include <limits>

#include "frame_pictures.h"

namespace gridiron::tool {
namespace {

// Whether all pixels miss; nothing if the planes do not determine it.
std::optional<bool> is_empty(const FrameRecord& frame, const SeenPlanes& planes) {
  const auto all_are = [&frame](std::span<const std::byte> plane, std::uint32_t wanted) {
    const Picture<std::uint32_t> words = words_of_plane(frame, plane);
    return std::ranges::all_of(words.pixels, [wanted](std::uint32_t word) { return word == wanted; });
  };
  if (planes.has_hits == false) return true;
  if (planes.ground_begin != kNoTriangle) {
    if (planes.ids.empty()) return std::nullopt;
    const Picture<std::uint32_t> ids = words_of_plane(frame, planes.ids);
    return std::ranges::all_of(ids.pixels, [&planes](std::uint32_t id) { return id >= planes.ground_begin; });
  }
  if (planes.has_hits) return false;
  if (!planes.ids.empty()) return all_are(planes.ids, kNoTriangle);
  if (!planes.depth.empty()) return all_are(planes.depth, std::bit_cast<std::uint32_t>(kFloatMax));
  if (frame.shading != static_cast<std::uint32_t>(Shading::kScene)) return all_are(planes.color, frame.background_rgba);
  if (planes.has_environment) return std::nullopt;
  // An object may have the background's colour.
  const Picture<std::uint32_t> words = words_of_plane(frame, planes.color);
  const std::uint32_t first = words.pixels.front();
  const bool is_plain = std::ranges::all_of(words.pixels, [first](std::uint32_t word) { return word == first; });
  return is_plain ? std::nullopt : std::optional(false);
}

// Extremes of the points, in pixels from the picture's top left corner, and of their depths along the view.
struct Extremes {
  double least_x = std::numeric_limits<double>::infinity(), most_x = -least_x;
  double least_y = least_x, most_y = -least_x;
  bool some_before = false, some_behind = false;
  bool all_left = true, all_right = true, all_above = true, all_below = true;
};

DVec3 vector_of(const float v[3]) {
  return {v[0], v[1], v[2]};
}

Extremes extremes_of(const FrameRecord& frame, const PointSource& points) {
  const DVec3 eye = vector_of(frame.eye), step_x = vector_of(frame.step_x), step_y = vector_of(frame.step_y);
  const DVec3 forward =
      vector_of(frame.corner) + 0.5 * (frame.width - 1.0) * step_x + 0.5 * (frame.height - 1.0) * step_y;
  const double pixel = glm::dot(step_x, step_x), row = glm::dot(step_y, step_y);
  Extremes extremes;
  points([&](std::span<const Vec3> some) {
    for (const Vec3& point : some) {
      const DVec3 offset = DVec3(point) - eye;
      const double depth = glm::dot(offset, forward);
      // Pixels from the middle, times the depth: an edge of the picture is a plane through the eye.
      const double across = glm::dot(offset, step_x) / pixel, down = glm::dot(offset, step_y) / row;
      const double half_width = 0.5 * frame.width * depth, half_height = 0.5 * frame.height * depth;
      extremes.some_before |= depth > 0;
      extremes.some_behind |= depth <= 0;
      extremes.all_left &= across < -half_width;
      extremes.all_right &= across > half_width;
      extremes.all_above &= down < -half_height;
      extremes.all_below &= down > half_height;
      if (depth <= 0) continue;
      extremes.least_x = std::min(extremes.least_x, across / depth);
      extremes.most_x = std::max(extremes.most_x, across / depth);
      extremes.least_y = std::min(extremes.least_y, down / depth);
      extremes.most_y = std::max(extremes.most_y, down / depth);
    }
  });
  return extremes;
}

// @param may_be_tiny  whether points between the centres of pixels are a reason.
const char* reason_of(const Extremes& extremes, bool may_be_tiny) {
  if (!extremes.some_before) return "it lies behind the camera";
  if (extremes.all_left) return "it lies to the left of the picture";
  if (extremes.all_right) return "it lies to the right of the picture";
  if (extremes.all_above) return "it lies above the picture";
  if (extremes.all_below) return "it lies below the picture";
  const bool is_tiny = extremes.most_x - extremes.least_x < 1 && extremes.most_y - extremes.least_y < 1;
  if (may_be_tiny && !extremes.some_behind && is_tiny) return "it is smaller than a pixel";
  return nullptr;
}

}  // namespace

std::optional<std::string> unseen_note(const FrameRecord& frame, const SeenPlanes& planes, const PointSource& points) {
  const std::optional<bool> is_missed = is_empty(frame, planes);
  if (is_missed == false) return std::nullopt;
  const bool may_be_tiny = is_missed || planes.ground_begin == kNoTriangle;
  const char* reason = reason_of(extremes_of(frame, points), may_be_tiny);
  if (reason == nullptr) {
    if (!is_missed) return std::nullopt;
    reason = "all rays miss its triangles";
  }
  return std::string("no pixel shows the scene: ") + reason;
}

std::optional<std::string> unseen_note(FrameMemory& frame, const sim::ChipResult& result, sim::Mode mode) {
  SeenPlanes planes{frame.color.bytes, frame.depth.bytes, frame.ids.bytes};
  planes.ground_begin = frame.ground_begin;
  planes.has_environment = frame.image.effects.environment_width != 0;
  if (frame.settings.shading == Shading::kScene && mode != sim::Mode::kPlain) {
    planes.has_hits = result.work[static_cast<std::size_t>(Work::kSurfacePoint)] != 0;
  }
  return unseen_note(frame.record, planes, points_of(frame));
}

void tell_note(const std::filesystem::path& file, const std::optional<std::string>& note) {
  if (note) std::fprintf(stderr, "%s: note: %s\n", file.c_str(), note->c_str());
}

}  // namespace gridiron::tool
