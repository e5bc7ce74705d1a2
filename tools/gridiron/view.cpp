// View. SPDX-License-Identifier: Apache-2.0
#include "view.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "failure.h"

namespace gridiron::tool {

bool fov_is_possible(float fov_degrees) {
  return fov_degrees > 0.0f && fov_degrees < 180.0f;
}

const char* view_defect(const Vec3& eye, const Vec3& at, const Vec3& up) {
  const DVec3 forward = DVec3(at) - DVec3(eye);
  if (forward == DVec3(0.0)) return "eye and at are the same point";
  if (up == Vec3(0.0f)) return "up has length 0";
  if (glm::cross(forward, DVec3(up)) == DVec3(0.0)) return "up points along the view";
  return nullptr;
}

ViewRequest join_view(const ViewRequest& parts, ViewRequest base) {
  if (parts.eye) base.eye = parts.eye;
  if (parts.at) base.at = parts.at;
  if (parts.up) base.up = parts.up;
  if (parts.fov_degrees) base.fov_degrees = parts.fov_degrees;
  return base;
}

Camera frame_view(const ViewRequest& request, const float bounds_minimum[3], const float bounds_maximum[3]) {
  // Double, so that bounds near the largest float neither overflow nor lose the centre.
  const DVec3 minimum(bounds_minimum[0], bounds_minimum[1], bounds_minimum[2]);
  const DVec3 maximum(bounds_maximum[0], bounds_maximum[1], bounds_maximum[2]);
  const double diagonal = glm::length(maximum - minimum);
  const DVec3 at = request.at ? DVec3(*request.at) : 0.5 * (minimum + maximum);
  const DVec3 eye = request.eye ? DVec3(*request.eye) : at + 1.05 * diagonal * glm::normalize(DVec3(0.35, 0.25, 1.0));

  Camera camera;
  camera.eye = Vec3(eye);
  camera.at = Vec3(at);
  camera.up = request.up.value_or(Vec3(0, 1, 0));
  const double fov = request.fov_degrees.value_or(kDefaultFovDegrees);
  camera.tan_half_fov = static_cast<float>(std::tan(0.5 * fov * std::numbers::pi / 180.0));
  if (const char* defect = view_defect(camera.eye, camera.at, camera.up)) {
    throw Failure(ExitCode::kUsage, std::string("view: ") + defect);
  }
  return camera;
}

}  // namespace gridiron::tool
