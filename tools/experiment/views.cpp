// Views. SPDX-License-Identifier: Apache-2.0
#include "experiment/views.h"

#include <scene_makers/shapes.h>

#include <glm/geometric.hpp>
#include <map>
#include <system_error>
#include <utility>

#include "base/failure.h"
#include "base/words.h"

namespace gridiron::experiment {
namespace {

// The paper does not describe its cameras. Scans are framed; the two of the conference room are ours, in
// scenes/conference_*.camera.
struct KnownView {
  const char* key;
  const char* title;
  const char* file;
  tool::ViewRequest camera;
};

const KnownView kKnownViews[] = {
    {"bunny", "Bunny", "bunny.ply", {}},
    {"horse", "Horse", "horse.ply", {}},
    {"armadillo_standin", "Armadillo stand-in", "armadillo_standin_345944.ply", {}},
    {"conference_1",
     "Conference 1",
     "conference.ply",
     {Vec3(-73, 454, -883), Vec3(603, 128, 151), Vec3(0, 1, 0), 65.0f}},
    {"conference_2",
     "Conference 2",
     "conference.ply",
     {Vec3(1415, 389, -797), Vec3(-208, 160, -21), Vec3(0, 1, 0), 65.0f}},
};

// Shown if there is no scan.
constexpr const char* kTeapotKey = "teapot";
constexpr std::uint32_t kKnotTriangles = 20'000;

std::string knot_key(std::uint32_t triangle_count) {
  return "knot_" + std::to_string(triangle_count);
}

std::shared_ptr<const tool::SceneInput> scene_of(const scene_makers::Mesh& made, const std::string& name) {
  tool::Mesh mesh;
  mesh.vertices.reserve(made.vertices.size());
  for (const scene_makers::Point& point : made.vertices) {
    mesh.vertices.emplace_back(static_cast<float>(point[0]), static_cast<float>(point[1]),
                               static_cast<float>(point[2]));
  }
  mesh.triangles.reserve(made.triangles.size());
  for (const scene_makers::Triangle& triangle : made.triangles) {
    mesh.triangles.emplace_back(triangle[0], triangle[1], triangle[2]);
  }
  return std::make_shared<const tool::SceneInput>(tool::SceneInput{name, std::move(mesh), {}});
}

}  // namespace

std::vector<std::string> known_view_keys() {
  std::vector<std::string> keys = {kTeapotKey, knot_key(kKnotTriangles)};
  for (const KnownView& known : kKnownViews) keys.emplace_back(known.key);
  return keys;
}

FoundViews find_views(const std::filesystem::path& folder) {
  FoundViews found;
  std::map<std::string, std::shared_ptr<const tool::SceneInput>> scenes;
  for (const KnownView& known : kKnownViews) {
    std::error_code ignored;
    const std::filesystem::path path = folder / known.file;
    if (folder.empty() || !std::filesystem::exists(path, ignored)) {
      found.missing.push_back(std::string(known.title) + " is left out: " + known.file + " was not found" +
                              (folder.empty() ? ", no folder of scenes being named." : " among the scenes."));
      continue;
    }
    auto& scene = scenes[known.file];
    if (scene == nullptr) scene = std::make_shared<const tool::SceneInput>(tool::read_scene_input(path));
    found.views.push_back(with_published_camera({known.key, known.title, scene, known.camera}));
  }
  if (!found.views.empty()) return found;

  constexpr std::uint32_t kTeapotSegments = 15;  // scenes/teapot.ply
  found.generated = true;
  found.views.push_back(with_published_camera(
      {kTeapotKey, "Teapot", scene_of(scene_makers::make_teapot(kTeapotSegments), "teapot"), {}}));
  found.views.push_back(make_knot_view(kKnotTriangles));
  return found;
}

View make_knot_view(std::uint32_t triangle_count) {
  const std::string key = knot_key(triangle_count);
  return with_published_camera({key,
                                "Torus knot of " + tool::words_of_count(triangle_count),
                                scene_of(scene_makers::make_torus_knot(triangle_count), key),
                                {}});
}

View with_published_camera(View view) {
  if (view.camera.eye && view.camera.at) return view;
  // One cell: the bounds of the triangles are the same in every grid.
  GridNeed need;
  const Status status = count_scene_image(view.mesh().view(), {.lambda = 1e-6f}, need);
  if (status != Status::kOk) {
    tool::input_error(view.scene->path, tool::words_of(status));
  }
  // Double, so that bounds near the largest float neither overflow nor lose the centre.
  const float* const low = need.grid.bounds_minimum;
  const float* const high = need.grid.bounds_maximum;
  const DVec3 minimum(low[0], low[1], low[2]), maximum(high[0], high[1], high[2]);
  const DVec3 at = view.camera.at ? DVec3(*view.camera.at) : 0.5 * (minimum + maximum);
  if (!view.camera.eye) {
    view.camera.eye = Vec3(at + 1.05 * glm::length(maximum - minimum) * glm::normalize(DVec3(0.35, 0.25, 1.0)));
  }
  view.camera.at = Vec3(at);
  return view;
}

std::vector<std::uint32_t> growth_counts(std::uint32_t largest) {
  std::vector<std::uint32_t> counts;
  for (const std::uint32_t divisor : {100u, 50u, 20u, 10u, 5u, 2u, 1u}) {
    const std::uint32_t count = largest / divisor / 2 * 2;
    if (count >= scene_makers::kMinKnotTriangles) counts.push_back(count);
  }
  return counts;
}

}  // namespace gridiron::experiment
