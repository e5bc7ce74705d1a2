// From the entities of a text scene to triangles, materials and normals. SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cfloat>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <utility>

#include "base/words.h"
#include "files/interrupt.h"
#include "scene_text/mesh_normals.h"
#include "scene_text/polygon.h"
#include "scene_text/scene_words.h"
#include "scene_text/shape_tolerance.h"

namespace gridiron::tool {
namespace {

struct MaterialOrder {
  static auto key(const SceneMaterial& m) {
    return std::tuple(m.color.x, m.color.y, m.color.z, m.kd, m.ks, m.shine, m.transmittance, m.index_of_refraction,
                      m.smooth_normals);
  }
  bool operator()(const SceneMaterial& a, const SceneMaterial& b) const { return key(a) < key(b); }
};

// Largest distance between a point and the float point nearest to it, coordinates up to `reach`.
double rounding_of(double reach) {
  constexpr double kHalfUnit = 0.5 * static_cast<double>(FLT_EPSILON);
  return std::sqrt(3.0) * (reach * kHalfUnit + static_cast<double>(FLT_TRUE_MIN));
}

class Flattener {
 public:
  Flattener(SceneEntities entities, const std::filesystem::path& path, const SceneOptions& options)
      : entities_(std::move(entities)),
        path_(path),
        most_triangles_(std::min(options.most_triangles, kMostSceneTriangles)),
        scene_(std::move(entities_.scene)),
        tolerance_(entities_, shapes_, options, path_, scene_) {}

  SceneDescription flatten() {
    material_of_fill_.assign(entities_.fills.size() * 2, kUnknownMaterial);
    std::uint64_t shape_count = 0;
    for (const SceneShape& shape : entities_.shapes) {
      if (++shape_count % 4096 == 0) stop_if_interrupted();
      add_shape(shape);
    }
    SceneGeometry& geometry = scene_.geometry;
    if (geometry.triangles.empty()) {
      fail(entities_.shapes.back().line, "the scene has no triangle: none of its polygons has an area");
    }
    if (geometry.normals.empty()) geometry.triangle_normals.clear();
    if (scene_.point_lights.empty() && scene_.area_lights.empty() && !scene_.ambient_occlusion) {
      note(entities_.shapes.front().line,
           "the scene has no light: shaded by it, surfaces show only what they reflect or let through");
    }
    SceneRoundness& roundness = scene_.roundness;
    if (roundness.rule == ToleranceRule::kPicture && !has_coarser_) {
      roundness.rule = ToleranceRule::kDiagonal;  // the picture shows every object as fine as that
      roundness.least_tolerance = roundness.most_tolerance = scene_.tolerance;
    }
    return std::move(scene_);
  }

 private:
  static constexpr std::uint32_t kUnknownMaterial = kMostSceneMaterials;

  [[noreturn]] void fail(std::uint64_t line, const std::string& reason) const { input_error(path_, line, reason); }

  void note(std::uint64_t line, std::string text) {
    if (++scene_.note_count <= kMostSceneNotes) scene_.notes.push_back({line, std::move(text)});
  }

  void add_shape(const SceneShape& shape) {
    switch (shape.kind) {
      case ShapeKind::kSphere:
        return add_sphere(shape);
      case ShapeKind::kCone:
        return add_cone(shape);
      case ShapeKind::kPolygon:
      case ShapeKind::kPatch:
        return add_polygon(shape);
      case ShapeKind::kMesh:
        return add_mesh(shape);
    }
  }

  // Materials and room -------------------------------------------------------------------------------------------

  [[nodiscard]] bool is_smooth(const SceneShape& shape) const {
    const Smoothness smoothness = entities_.fills[shape.fill].smoothness;
    if (shape.kind == ShapeKind::kPolygon || smoothness == Smoothness::kNone) return false;
    return shape.kind != ShapeKind::kMesh || smoothness == Smoothness::kAll;
  }

  std::uint16_t material_of(const SceneShape& shape) {
    const bool smooth = is_smooth(shape);
    std::uint32_t& known = material_of_fill_[shape.fill * std::size_t{2} + (smooth ? 1 : 0)];
    if (known == kUnknownMaterial) {
      SceneMaterial material = entities_.fills[shape.fill].material;
      material.smooth_normals = smooth;
      const auto next = static_cast<std::uint32_t>(scene_.materials.size());
      const auto [entry, is_new] = material_index_.try_emplace(material, next);
      if (is_new && next == kMostSceneMaterials) {
        fail(shape.line, "more than " + words_of_count(kMostSceneMaterials) + " different materials in use");
      }
      if (is_new) scene_.materials.push_back(material);
      known = entry->second;
    }
    return static_cast<std::uint16_t>(known);
  }

  // Checks that a shape's triangles, vertices and normals still fit.
  void require_room(const SceneShape& shape, std::uint64_t triangles, std::uint64_t vertices, std::uint64_t normals) {
    const SceneGeometry& geometry = scene_.geometry;
    if (geometry.triangles.size() + triangles > most_triangles_) {
      const std::optional<float> coarser = tolerance_for(scene_.roundness, most_triangles_);
      fail(shape.line,
           "with this object the scene has " + words_of_count(geometry.triangles.size() + triangles) +
               " triangles at a tolerance of " + text_of_number(static_cast<double>(scene_.tolerance)) + "; at most " +
               words_of_count(most_triangles_) + " are allowed" +
               (coarser ? "; --tolerance " + text_of_number(static_cast<double>(*coarser)) + " makes fewer" : ""));
    }
    if (geometry.vertices.size() + vertices > kMostSceneVertices ||
        geometry.normals.size() + normals > kMostSceneVertices) {
      fail(shape.line,
           "with this object the scene has more than " + words_of_count(kMostSceneVertices) + " vertices or normals");
    }
  }

  void add_triangle(std::uint16_t material, const UVec3& vertices, const UVec3& normals) {
    scene_.geometry.triangles.push_back(vertices);
    scene_.geometry.triangle_normals.push_back(normals);
    scene_.geometry.triangle_materials.push_back(material);
  }

  [[nodiscard]] std::uint32_t next_vertex() const {
    return static_cast<std::uint32_t>(scene_.geometry.vertices.size());
  }
  [[nodiscard]] std::uint32_t next_normal() const { return static_cast<std::uint32_t>(scene_.geometry.normals.size()); }

  // Round shapes -------------------------------------------------------------------------------------------------

  // @returns how many parts a round shape is cut into, by its tolerance. @param parts_of  for a deviation from a shape
  // of radius 1; 0 if that needs too many.
  template <class PartsOf>
  std::uint32_t parts_of_shape(const SceneShape& shape, const RoundShape& round, const PartsOf& parts_of) {
    const double tolerance = tolerance_.of(round), radius = round.radius();
    const double deviation = allowed_deviation(shape, round, tolerance);
    const std::uint32_t parts = parts_of(deviation);
    if (parts == 0) {
      fail(shape.line, std::string(round.is_sphere ? "a sphere" : "a cone") + " of radius " + text_of_number(radius) +
                           " needs too many triangles for a tolerance of " + text_of_number(tolerance));
    }
    // Notices a shape of fewer parts than the diagonal's tolerance would make of it.
    if (!has_coarser_ && scene_.roundness.rule == ToleranceRule::kPicture) {
      const double more = (tolerance - static_cast<double>(scene_.tolerance)) / radius;
      has_coarser_ = parts_of(std::max(deviation - more, DBL_MIN)) != parts;
    }
    return parts;
  }

  // How far facets may be from a shape once their corners' rounding has taken its part, as a share of the radius.
  [[nodiscard]] double allowed_deviation(const SceneShape& shape, const RoundShape& round, double tolerance) const {
    const double radius = round.radius();
    const DVec3 reach = glm::max(glm::abs(round.base), glm::abs(round.apex)) + radius;
    const double rounding = rounding_of(std::max({reach.x, reach.y, reach.z}));
    const auto require_coarser = [&](const char* name, double value, double least) {
      if (value > least * rounding) return;
      fail(shape.line, name + text_of_number(value) + " is finer than floats are there; they allow at least " +
                           text_of_number((least + 0.01) * rounding));
    };
    require_coarser("a tolerance of ", tolerance, 2);
    require_coarser("a radius of ", radius, 16);
    return (tolerance - rounding) / radius;
  }

  void add_sphere(const SceneShape& shape) {
    const RoundShape round = round_shape(entities_, shape);
    const std::uint32_t frequency =
        parts_of_shape(shape, round, [this](double deviation) { return shapes_.sphere_frequency(deviation); });
    const std::uint64_t square = std::uint64_t{frequency} * frequency;
    require_room(shape, 20 * square, 10 * square + 2, 10 * square + 2);
    const UnitSphere& unit = shapes_.sphere(frequency);
    const std::uint32_t first = next_vertex();
    for (const DVec3& vertex : unit.vertices)
      scene_.geometry.vertices.emplace_back(round.base + round.base_radius * vertex);
    const bool smooth = is_smooth(shape);
    const std::uint32_t first_normal = smooth ? sphere_normals(frequency, unit) : 0;
    const std::uint16_t material = material_of(shape);
    for (const UVec3& triangle : unit.triangles) {
      add_triangle(material, triangle + first, smooth ? triangle + first_normal : UVec3(kNoNormal));
    }
  }

  // Spheres of one frequency share their normals. @returns the first one's index.
  std::uint32_t sphere_normals(std::uint32_t frequency, const UnitSphere& unit) {
    const auto [entry, is_new] = sphere_normals_.try_emplace(frequency, next_normal());
    if (is_new) {
      for (const DVec3& vertex : unit.vertices) scene_.geometry.normals.emplace_back(vertex);
    }
    return entry->second;
  }

  void add_cone(const SceneShape& shape) {
    const RoundShape round = round_shape(entities_, shape);
    const std::uint32_t segments = parts_of_shape(shape, round, RoundShapes::circle_segments);
    require_room(shape, 2 * std::uint64_t{segments}, 2 * std::uint64_t{segments}, 2 * std::uint64_t{segments});
    const double length = glm::length(round.apex - round.base);
    const Frame frame = frame_of((round.apex - round.base) / length);
    const Ring low = add_ring(frame, round.base, round.base_radius, segments);
    const Ring high = add_ring(frame, round.apex, round.apex_radius, segments);

    const bool smooth = is_smooth(shape);
    const bool is_pointed = low.step == 0 || high.step == 0;
    const std::uint32_t first_normal = next_normal();
    if (smooth) add_cone_normals(frame, length, round.base_radius - round.apex_radius, segments, is_pointed);
    const std::uint16_t material = material_of(shape);
    for (std::uint32_t i = 0; i < segments; ++i) {
      const std::uint32_t j = i + 1 == segments ? 0 : i + 1;
      const std::uint32_t here = first_normal + i, there = first_normal + j, middle = first_normal + segments + i;
      const auto add = [&](const UVec3& vertices, const UVec3& normals) {
        add_triangle(material, vertices, smooth ? normals : UVec3(kNoNormal));
      };
      if (low.step == 0) {
        add({low.at(0), high.at(j), high.at(i)}, {middle, there, here});
      } else if (high.step == 0) {
        add({low.at(i), low.at(j), high.at(0)}, {here, there, middle});
      } else {
        add({low.at(i), low.at(j), high.at(j)}, {here, there, there});
        add({low.at(i), high.at(j), high.at(i)}, {here, there, here});
      }
    }
  }

  // Vertices around one end; of radius 0: one.
  struct Ring {
    std::uint32_t first, step;
    [[nodiscard]] std::uint32_t at(std::uint32_t i) const { return first + i * step; }
  };

  Ring add_ring(const Frame& frame, const DVec3& center, double radius, std::uint32_t segments) {
    const Ring ring{next_vertex(), radius == 0 ? 0u : 1u};
    if (radius == 0) {
      scene_.geometry.vertices.emplace_back(center);
    } else {
      for (const DVec3& place : shapes_.circle(segments)) {
        scene_.geometry.vertices.emplace_back(center + radius * frame.across(place));
      }
    }
    return ring;
  }

  // Normals of a cone do not change from base to apex. A point has as many as facets: each that of the facet's middle.
  void add_cone_normals(const Frame& frame, double length, double taper, std::uint32_t segments, bool is_pointed) {
    const std::vector<DVec3>& circle = shapes_.circle(segments);
    const auto add = [&](const DVec3& place) {
      scene_.geometry.normals.emplace_back(glm::normalize(frame.across(place) * length + frame.axis * taper));
    };
    for (const DVec3& place : circle) add(place);
    if (!is_pointed) return;
    for (std::size_t i = 0; i < circle.size(); ++i) {
      add(glm::normalize(circle[i] + circle[(i + 1) % circle.size()]));
    }
  }

  // Polygons and meshes ------------------------------------------------------------------------------------------

  void add_polygon(const SceneShape& shape) {
    const bool is_patch = shape.kind == ShapeKind::kPatch, smooth = is_smooth(shape);
    corners_.resize(shape.count);
    for (std::size_t i = 0; i < shape.count; ++i) corners_[i] = corner_of(entities_, shape, i);
    cut_.clear();
    const PolygonResult result = triangulate_polygon(corners_, cut_);
    const std::string name = is_patch ? "patch" : "polygon";
    if (result.defect == PolygonDefect::kCrosses)
      fail(shape.line, "the outline of the " + name + " crosses or retraces itself");
    if (result.defect == PolygonDefect::kNoArea) return note(shape.line, name + " without area left out");
    if (result.plane_distance > static_cast<double>(scene_.tolerance)) {
      if (!is_patch) ++scene_.counts.non_planar_polygons;
      note(shape.line,
           name + " is not planar: a corner is " + text_of_number(result.plane_distance) + " away from its plane");
    }
    require_room(shape, cut_.size(), shape.count, smooth ? shape.count : 0);
    const std::uint16_t material = material_of(shape);
    const std::uint32_t first = next_vertex(), first_normal = next_normal();
    scene_.geometry.vertices.insert(scene_.geometry.vertices.end(), corners_.begin(), corners_.end());
    if (smooth) {
      for (std::size_t i = 0; i < shape.count; ++i) {
        scene_.geometry.normals.push_back(entities_.points[shape.first + 2 * i + 1]);
      }
    }
    for (const UVec3& triangle : cut_) {
      add_triangle(material, triangle + first, smooth ? triangle + first_normal : UVec3(kNoNormal));
    }
  }

  void add_mesh(const SceneShape& shape) {
    SceneMesh& mesh = entities_.meshes[shape.first];
    const bool smooth = is_smooth(shape);
    MeshNormals normals;
    if (smooth) normals = make_mesh_normals(mesh.vertices, mesh.triangles);
    require_room(shape, mesh.triangles.size(), mesh.vertices.size(), normals.normals.size());
    const std::uint16_t material = material_of(shape);
    SceneGeometry& geometry = scene_.geometry;
    const std::uint32_t first = next_vertex(), first_normal = next_normal();
    geometry.vertices.insert(geometry.vertices.end(), mesh.vertices.begin(), mesh.vertices.end());
    geometry.normals.insert(geometry.normals.end(), normals.normals.begin(), normals.normals.end());
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
      add_triangle(material, mesh.triangles[i] + first,
                   smooth ? normals.triangles[i] + first_normal : UVec3(kNoNormal));
    }
    mesh = {};
  }

  SceneEntities entities_;
  const std::filesystem::path& path_;
  std::uint32_t most_triangles_;
  SceneDescription scene_;
  RoundShapes shapes_;
  ShapeTolerance tolerance_;
  bool has_coarser_ = false;                               // shapes than by the tolerance of the diagonal
  std::map<std::uint32_t, std::uint32_t> sphere_normals_;  // first normal of each frequency
  std::map<SceneMaterial, std::uint32_t, MaterialOrder> material_index_;
  std::vector<std::uint32_t> material_of_fill_;  // two of each fill: flat, smooth
  std::vector<Vec3> corners_;                    // of the polygon being cut
  std::vector<UVec3> cut_;
};

}  // namespace

SceneDescription flatten_scene(SceneEntities entities, const std::filesystem::path& path, const SceneOptions& options) {
  return Flattener(std::move(entities), path, options).flatten();
}

}  // namespace gridiron::tool
