// View. SPDX-License-Identifier: Apache-2.0
#include "view.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <utility>

#include "base/failure.h"
#include "base/numbers.h"

namespace gridiron::tool {

bool fov_is_possible(float fov_degrees) {
  return fov_degrees >= kLeastFovDegrees && fov_degrees < 180.0f;
}

const char* view_defect(const Vec3& eye, const Vec3& at, const Vec3& up) {
  const DVec3 forward = DVec3(at) - DVec3(eye);
  if (forward == DVec3(0.0)) return "eye and at are the same point";
  if (up == Vec3(0.0f)) return "up has length 0";
  if (glm::cross(forward, DVec3(up)) == DVec3(0.0)) return "up points along the view";
  return nullptr;
}

std::optional<Vec3> parse_up(std::string_view text) {
  const bool is_negative = text.starts_with('-');
  const std::string_view axis = text.substr(is_negative ? 1 : 0);
  const std::size_t index = std::string_view("xyz").find(axis);
  if (axis.size() != 1 || index == std::string_view::npos) return parse_vector(text);
  Vec3 up(0.0f);
  up[static_cast<int>(index)] = is_negative ? -1.0f : 1.0f;
  return up;
}

std::optional<ViewAngles> parse_view_angles(std::string_view text) {
  constexpr double kIsometric = 35.264389682754654;  // atan(1 / sqrt(2)): three axes are equally long
  constexpr std::pair<std::string_view, ViewAngles> kNamed[] = {
      {"front", {0, 0}}, {"right", {90, 0}},   {"back", {180, 0}},        {"left", {270, 0}},
      {"top", {0, 90}},  {"bottom", {0, -90}}, {"iso", {45, kIsometric}},
  };
  for (const auto& [name, angles] : kNamed) {
    if (text == name) return angles;
  }
  const std::size_t comma = text.find(',');
  if (comma == std::string_view::npos) return std::nullopt;
  const std::optional<float> azimuth = parse_float(text.substr(0, comma));
  const std::optional<float> elevation = parse_float(text.substr(comma + 1));
  if (!azimuth || !elevation || std::abs(*elevation) > 90.0f) return std::nullopt;
  return ViewAngles{std::fmod(double{*azimuth}, 360.0), double{*elevation}};
}

ViewRequest join_view(const ViewRequest& parts, ViewRequest base) {
  if (parts.from) {
    base.eye.reset();
    base.at.reset();
    base.from = parts.from;
  }
  if (parts.eye) base.eye = parts.eye;
  if (parts.at) base.at = parts.at;
  if (parts.up) base.up = parts.up;
  if (parts.fov_degrees) base.fov_degrees = parts.fov_degrees;
  return base;
}

Camera complete_view(const ViewRequest& request, double aspect, const PointSource& points) {
  FramingRequest framing;
  framing.up = request.up.value_or(framing.up);
  const double fov = request.fov_degrees.value_or(kDefaultFovDegrees);
  framing.tan_half_fov = std::tan(0.5 * fov * std::numbers::pi / 180.0);
  framing.aspect = aspect;
  framing.from = request.from.value_or(framing.from);
  framing.at = request.at;

  const auto require = [](const char* defect) {
    if (defect != nullptr) usage_error(std::string("view: ") + defect);
  };
  if (!request.eye) {
    require(framing.up == Vec3(0.0f) ? "up has length 0" : nullptr);
    return frame_points(framing, points);
  }
  Camera camera;
  camera.eye = *request.eye;
  camera.at = request.at ? *request.at : Vec3(middle_of(points));
  camera.up = framing.up;
  camera.tan_half_fov = static_cast<float>(framing.tan_half_fov);
  require(view_defect(camera.eye, camera.at, camera.up));
  return camera;
}

}  // namespace gridiron::tool
