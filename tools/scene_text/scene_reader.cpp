// Reader of text scenes. SPDX-License-Identifier: Apache-2.0
#include "scene_text/scene_reader.h"

#include <gridiron/base/records.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <string>
#include <utility>

#include "base/failure.h"
#include "base/words.h"
#include "files/input_file.h"
#include "files/interrupt.h"
#include "scene_text/polygon.h"
#include "scene_text/scene_files.h"
#include "scene_text/scene_words.h"

namespace gridiron::tool {
namespace {

// Sine of the angle below which two directions count as parallel.
constexpr double kParallel = 1e-6;

bool are_parallel(const DVec3& a, const DVec3& b) {
  return !(glm::length(glm::cross(a, b)) > kParallel * glm::length(a) * glm::length(b));
}

class Parser {
 public:
  Parser(std::string_view text, const std::filesystem::path& path)
      : words_(text, path), folder_(folder_of_input(path)) {}

  SceneEntities parse() {
    while (!words_.next().is_end()) {
      read_entity(words_.take());
      if (++entity_count_ % 65536 == 0) stop_if_interrupted();
    }
    finish();
    return std::move(result_);
  }

 private:
  using Read = void (Parser::*)(SceneEntity&);

  struct Kind {
    std::string_view keyword;
    std::uint64_t numbers;  // that every entity of the kind has
    bool is_once;           // at most one in a scene
    Read read;
  };

  static constexpr std::size_t kKindCount = 16;

  // In the order of the README.
  static const std::array<Kind, kKindCount>& kinds() {
    static constexpr std::array<Kind, kKindCount> kKinds = {{
        {"v", 13, true, &Parser::read_view},
        {"b", 3, true, &Parser::read_background},
        {"l", 3, false, &Parser::read_light},
        {"f", 8, false, &Parser::read_fill},
        {"p", 1, false, &Parser::read_polygon},
        {"pp", 1, false, &Parser::read_patch},
        {"c", 8, false, &Parser::read_cone},
        {"s", 4, false, &Parser::read_sphere},
        {"m", 0, false, &Parser::read_mesh},
        {"sn", 0, false, &Parser::read_smooth_normals},
        {"la", 13, false, &Parser::read_area_light},
        {"e", 0, true, &Parser::read_environment},
        {"ao", 2, true, &Parser::read_ambient_occlusion},
        {"ms", 1, true, &Parser::read_multisampling},
        {"d", 1, true, &Parser::read_depth},
        {"sh", 0, true, &Parser::read_shadows},
    }};
    return kKinds;
  }

  void read_entity(const SceneWord& keyword) {
    for (std::size_t i = 0; i < kKindCount; ++i) {
      const Kind& kind = kinds()[i];
      if (kind.keyword != keyword.text) continue;
      if (kind.is_once && first_line_[i] != 0) {
        words_.fail(keyword.line, "second '" + std::string(keyword.text) + "'; the first is on line " +
                                      std::to_string(first_line_[i]));
      }
      first_line_[i] = keyword.line;
      SceneEntity entity{keyword, kind.numbers, 0};
      (this->*kind.read)(entity);
      last_ = keyword;
      return;
    }
    if (looks_like_number(keyword.text) && !last_.is_end()) {
      words_.fail(keyword.line, in_quotes(keyword.text) + " is one number too many: '" + std::string(last_.text) +
                                    "' of line " + std::to_string(last_.line) + " has all of its numbers");
    }
    std::string known;
    for (const Kind& kind : kinds()) known.append(" ").append(kind.keyword);
    words_.fail(keyword.line, "unknown word " + in_quotes(keyword.text) + "; expected one of" + known);
  }

  // Settings -----------------------------------------------------------------------------------------------------

  void read_view(SceneEntity& entity) {
    SceneView& view = result_.scene.view;
    view.line = entity.keyword.line;
    constexpr std::array<std::string_view, 6> kParts = {"from", "at", "up", "angle", "hither", "resolution"};
    std::array<bool, kParts.size()> is_given{};
    for (std::size_t i = 0; i < kParts.size(); ++i) {
      const SceneWord word = words_.take_word(entity, "from, at, up, angle, hither and resolution are all given");
      const auto part = static_cast<std::size_t>(std::ranges::find(kParts, word.text) - kParts.begin());
      if (part == kParts.size()) {
        words_.fail(word.line, in_quotes(word.text) +
                                   " is no part of a view, which has from, at, up, angle, hither and resolution");
      }
      if (is_given[part]) words_.fail(word.line, "second '" + std::string(word.text) + "' in a view");
      is_given[part] = true;
      read_view_part(entity, word, view);
    }
    const DVec3 forward = DVec3(view.at) - DVec3(view.from);
    if (forward == DVec3(0.0)) words_.fail(entity.keyword.line, "the view's from and at are the same point");
    if (view.up == Vec3(0.0f)) words_.fail(entity.keyword.line, "the view's up has length 0");
    if (are_parallel(forward, DVec3(view.up))) {
      words_.fail(entity.keyword.line, "the view's up is parallel to the direction from 'from' to 'at'");
    }
  }

  void read_view_part(SceneEntity& entity, const SceneWord& part, SceneView& view) {
    if (part.text == "from" || part.text == "at" || part.text == "up") {
      (part.text == "from" ? view.from : part.text == "at" ? view.at : view.up) = words_.take_point(entity);
    } else if (part.text == "angle") {
      const SceneNumber number = words_.take_number(entity);
      view.angle_degrees = static_cast<float>(number.value);
      if (!(view.angle_degrees >= 0.001f && view.angle_degrees < 180)) {
        words_.fail(number.word.line,
                    "angle must be from 0.001 to below 180 degrees, not " + in_quotes(number.word.text));
      }
    } else if (part.text == "hither") {
      view.hither = static_cast<float>(words_.take_in_range(entity, "hither", 0, kMostSceneCoordinate));
    } else {
      view.width = words_.take_count(entity, "the resolution's width", 1, kMaxPictureWidth);
      view.height = words_.take_count(entity, "the resolution's height", 1, kMaxPictureWidth);
    }
  }

  void read_background(SceneEntity& entity) { result_.scene.background = words_.take_color(entity, 1); }

  void read_light(SceneEntity& entity) {
    count_light(entity);
    PointLight light;
    light.position = words_.take_point(entity);
    if (looks_like_number(words_.next().text)) {
      entity.wanted = 6;
      light.color = words_.take_color(entity, static_cast<double>(kMostLightColor));
    } else {
      colorless_.push_back(result_.scene.point_lights.size());
    }
    result_.scene.point_lights.push_back(light);
  }

  void read_area_light(SceneEntity& entity) {
    count_light(entity);
    AreaLight light;
    light.corner = words_.take_point(entity);
    light.edge_u = words_.take_point(entity);
    light.edge_v = words_.take_point(entity);
    if (are_parallel(DVec3(light.edge_u), DVec3(light.edge_v))) {
      words_.fail(entity.keyword.line, "the edges of 'la' have length 0 or are parallel: the light has no area");
    }
    light.color = words_.take_color(entity, static_cast<double>(kMostLightColor));
    light.samples = words_.take_count(entity, "the number of samples", 1, kMostEffectSamples);
    result_.scene.area_lights.push_back(light);
  }

  void count_light(const SceneEntity& entity) {
    if (result_.scene.point_lights.size() + result_.scene.area_lights.size() >= kMostSceneLights) {
      words_.fail(entity.keyword.line, "more than " + std::to_string(kMostSceneLights) + " lights");
    }
  }

  void read_environment(SceneEntity& entity) {
    EnvironmentMap map;
    for (std::size_t i = 0; i < kCubeFaceCount; ++i) {
      const SceneWord word = words_.take_word(entity, "all six faces are named");
      map.paths[i] = folder_ / std::filesystem::path(word.text);
      EnvironmentFace face = with_line(word.line, [&] { return read_environment_face(map.paths[i]); });
      if (i != 0 && face.width != map.width) {
        const auto size = [](std::uint32_t width) { return std::to_string(width) + "x" + std::to_string(width); };
        words_.fail(word.line, map.paths[i].string() + ": is " + size(face.width) + " texels; the first face is " +
                                   size(map.width));
      }
      map.width = face.width;
      map.texels[i] = std::move(face.texels);
    }
    result_.scene.files.insert(result_.scene.files.end(), map.paths.begin(), map.paths.end());
    result_.scene.environment = std::move(map);
  }

  void read_ambient_occlusion(SceneEntity& entity) {
    AmbientOcclusion occlusion;
    occlusion.samples = words_.take_count(entity, "the number of samples", 1, kMostEffectSamples);
    occlusion.radius = static_cast<float>(take_positive(entity, "the radius"));
    result_.scene.ambient_occlusion = occlusion;
  }

  void read_multisampling(SceneEntity& entity) {
    const SceneNumber number = words_.take_number(entity);
    if (number.value != 1 && number.value != 4 && number.value != 16) {
      words_.fail(number.word.line, "'ms' takes 1, 4 or 16 samples a pixel, not " + in_quotes(number.word.text));
    }
    result_.scene.samples_per_pixel = static_cast<std::uint32_t>(number.value);
  }

  void read_depth(SceneEntity& entity) {
    result_.scene.recursion_depth = words_.take_count(entity, "the depth of recursion", 1, kMostRecursionDepth);
  }

  void read_shadows(SceneEntity& entity) { result_.scene.shadows = words_.take_switch(entity); }

  void read_smooth_normals(SceneEntity& entity) {
    smoothness_ = words_.take_switch(entity) ? Smoothness::kAll : Smoothness::kNone;
  }

  void read_fill(SceneEntity& entity) {
    SceneFill fill{{}, smoothness_};
    SceneMaterial& material = fill.material;
    const auto take = [&](const char* name, double most) {
      return static_cast<float>(words_.take_in_range(entity, name, 0, most));
    };
    material.color = words_.take_color(entity, 1);
    material.kd = take("Kd", 1);
    material.ks = take("Ks", 1);
    material.shine = take("Shine", static_cast<double>(kMostShine));
    material.transmittance = take("T", 1);
    const SceneNumber index = words_.take_number(entity);
    const auto refraction = static_cast<float>(index.value);
    // Files of the Standard Procedural Databases have 0 for opaque materials.
    const bool is_unused = material.transmittance == 0.0f;
    if (!(refraction >= kLeastRefraction && refraction <= kMostRefraction) && !(is_unused && refraction == 0.0f)) {
      words_.fail(index.word.line, "the index of refraction of 'f' must be from 0.1 to 10, not " +
                                       in_quotes(index.word.text) + (is_unused ? "; 0 only where T is 0" : ""));
    }
    material.index_of_refraction = is_unused ? 1.0f : refraction;
    result_.fills.push_back(fill);
  }

  // Objects ------------------------------------------------------------------------------------------------------

  void add_shape(const SceneEntity& entity, ShapeKind kind, std::size_t first, std::uint32_t count = 0) {
    if (result_.shapes.size() >= kMostSceneShapes) {
      words_.fail(entity.keyword.line, "more than " + words_of_count(kMostSceneShapes) + " objects");
    }
    const auto fill = static_cast<std::uint32_t>(result_.fills.size() - 1);
    result_.shapes.push_back({kind, fill, entity.keyword.line, first, count});
  }

  void require_fill(const SceneEntity& entity) const {
    if (result_.fills.empty()) {
      words_.fail(entity.keyword.line,
                  "'" + std::string(entity.keyword.text) + "' before the first 'f': it has no material");
    }
  }

  double take_positive(SceneEntity& entity, const char* name) {
    const SceneNumber number = words_.take_number(entity);
    if (!(static_cast<float>(number.value) > 0 && number.value <= kMostSceneCoordinate)) {
      words_.fail(number.word.line, std::string(name) + " of '" + std::string(entity.keyword.text) +
                                        "' must be greater than 0 and at most 1e18, not " +
                                        in_quotes(number.word.text));
    }
    return number.value;
  }

  void read_sphere(SceneEntity& entity) {
    require_fill(entity);
    add_shape(entity, ShapeKind::kSphere, result_.numbers.size());
    add_center(entity);
    result_.numbers.push_back(take_positive(entity, "the radius"));
    ++result_.scene.counts.spheres;
  }

  void add_center(SceneEntity& entity) {
    for (int axis = 0; axis < 3; ++axis) {
      result_.numbers.push_back(
          words_.take_in_range(entity, "a coordinate", -kMostSceneCoordinate, kMostSceneCoordinate));
    }
  }

  void read_cone(SceneEntity& entity) {
    require_fill(entity);
    const std::size_t first = result_.numbers.size();
    add_shape(entity, ShapeKind::kCone, first);
    for (const char* name : {"the base radius", "the apex radius"}) {
      add_center(entity);
      result_.numbers.push_back(words_.take_in_range(entity, name, 0, kMostSceneCoordinate));
    }
    const double* n = result_.numbers.data() + first;
    if (n[3] == 0 && n[7] == 0) words_.fail(entity.keyword.line, "both radii of 'c' are 0");
    if (Vec3(DVec3(n[0], n[1], n[2])) == Vec3(DVec3(n[4], n[5], n[6]))) {
      words_.fail(entity.keyword.line, "base and apex of 'c' are the same point");
    }
    ++result_.scene.counts.cones;
  }

  void read_polygon(SceneEntity& entity) { read_corners(entity, ShapeKind::kPolygon); }
  void read_patch(SceneEntity& entity) { read_corners(entity, ShapeKind::kPatch); }

  void read_corners(SceneEntity& entity, ShapeKind kind) {
    require_fill(entity);
    const std::uint32_t count = words_.take_count(entity, "the number of corners", 3, kMostPolygonCorners);
    const bool has_normals = kind == ShapeKind::kPatch;
    entity.wanted += std::uint64_t{count} * (has_normals ? 6 : 3);
    add_shape(entity, kind, result_.points.size(), count);
    for (std::uint32_t i = 0; i < count; ++i) {
      result_.points.push_back(words_.take_point(entity));
      if (!has_normals) continue;
      const std::uint64_t line = words_.next().line;
      // Not as floats in between: GCC 12 leaves out that rounding for two values at once (-O2 on x86-64).
      DVec3 normal{};
      for (int axis = 0; axis < 3; ++axis) {
        normal[axis] = words_.take_in_range(entity, "a coordinate", -kMostSceneCoordinate, kMostSceneCoordinate);
      }
      const double length = glm::length(normal);
      if (!(length > 1e-30)) words_.fail(line, "the normal of corner " + std::to_string(i + 1) + " has length 0");
      result_.points.push_back(Vec3(normal / length));
    }
    ++(has_normals ? result_.scene.counts.patches : result_.scene.counts.polygons);
  }

  void read_mesh(SceneEntity& entity) {
    require_fill(entity);
    add_shape(entity, ShapeKind::kMesh, result_.meshes.size());
    const SceneWord name = words_.take_word(entity, "the file is named");
    std::optional<SceneMatrix> matrix;
    if (looks_like_number(words_.next().text)) {
      entity.wanted = 12;
      matrix.emplace();
      for (double& number : *matrix)
        number = words_.take_in_range(entity, "the matrix", -kMostSceneCoordinate, kMostSceneCoordinate);
      if (!is_invertible(*matrix)) words_.fail(entity.keyword.line, "the matrix of 'm' flattens the mesh");
    }
    const std::filesystem::path path = folder_ / std::filesystem::path(name.text);
    result_.scene.files.push_back(path);
    result_.meshes.push_back(with_line(name.line, [&] { return read_scene_mesh(path, matrix); }));
    mesh_vertices_ += result_.meshes.back().vertices.size();
    mesh_triangles_ += result_.meshes.back().triangles.size();
    if (mesh_vertices_ > kMostSceneVertices || mesh_triangles_ > kMostSceneTriangles) {
      words_.fail(name.line, "the meshes up to here have " + words_of_count(mesh_vertices_) + " vertices and " +
                                 words_of_count(mesh_triangles_) + " triangles; a scene has at most " +
                                 words_of_count(kMostSceneTriangles) + " of each");
    }
    ++result_.scene.counts.meshes;
  }

  // Reads another file; its errors get the line that names the file.
  template <class Action>
  auto with_line(std::uint64_t line, Action action) -> decltype(action()) {
    try {
      return action();
    } catch (const Failure& failure) {
      if (failure.code() != ExitCode::kBadInput) throw;
      words_.fail(line, failure.what());
    }
  }

  void finish() {
    const std::uint64_t last_line = words_.next().line;
    if (result_.shapes.empty()) words_.fail(last_line, "the scene has no object: no p, pp, c, s or m");
    // The advice of the Standard Procedural Databases, without the factor of a half: there is no ambient light here.
    const std::size_t lights = result_.scene.point_lights.size() + result_.scene.area_lights.size();
    for (const std::size_t light : colorless_) {
      result_.scene.point_lights[light].color = Vec3(static_cast<float>(1 / std::sqrt(static_cast<double>(lights))));
    }
  }

  SceneWords words_;
  std::filesystem::path folder_;
  SceneEntities result_;
  Smoothness smoothness_ = Smoothness::kCurved;
  std::vector<std::size_t> colorless_;                  // point lights that wait for the number of lights
  std::array<std::uint64_t, kKindCount> first_line_{};  // of entities that may occur once; of others the last
  SceneWord last_{};                                    // keyword of the entity before
  std::uint64_t entity_count_ = 0, mesh_vertices_ = 0, mesh_triangles_ = 0;
};

}  // namespace

SceneEntities parse_scene_text(std::string_view text, const std::filesystem::path& path) {
  return Parser(text, path).parse();
}

SceneDescription read_scene_text(std::string_view text, const std::filesystem::path& path,
                                 const SceneOptions& options) {
  return flatten_scene(parse_scene_text(text, path), path, options);
}

SceneDescription read_scene_text(const std::filesystem::path& path, const SceneOptions& options) {
  const InputFile file = read_input_file(path, "expected a text scene", kMostSceneBytes);
  return read_scene_text({reinterpret_cast<const char*>(file.bytes.data()), file.bytes.size()}, path, options);
}

}  // namespace gridiron::tool
