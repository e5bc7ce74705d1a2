// From the entities of a text scene to triangles, materials and normals. SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cfloat>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <utility>

#include "base/failure.h"
#include "base/words.h"
#include "files/interrupt.h"
#include "scene_text/mesh_normals.h"
#include "scene_text/polygon.h"
#include "scene_text/round_shapes.h"
#include "scene_text/scene_reader.h"
#include "scene_text/scene_words.h"

namespace gridiron::tool {
namespace {

struct Bounds {
  DVec3 low{DBL_MAX}, high{-DBL_MAX};

  void add(const DVec3& point, double radius = 0) {
    low = glm::min(low, point - radius);
    high = glm::max(high, point + radius);
  }
};

struct MaterialOrder {
  static auto key(const SceneMaterial& m) {
    return std::tuple(m.color.x, m.color.y, m.color.z, m.kd, m.ks, m.shine, m.transmittance, m.index_of_refraction,
                      m.smooth_normals);
  }
  bool operator()(const SceneMaterial& a, const SceneMaterial& b) const { return key(a) < key(b); }
};

// A direction at right angles to a unit vector, chosen by its smallest component.
DVec3 any_perpendicular(const DVec3& axis) {
  const DVec3 size = glm::abs(axis);
  const DVec3 other = size.x <= size.y && size.x <= size.z ? DVec3(1, 0, 0)
                      : size.y <= size.z                   ? DVec3(0, 1, 0)
                                                           : DVec3(0, 0, 1);
  return glm::normalize(glm::cross(axis, other));
}

// Largest distance between a point and the float point nearest to it, coordinates up to `reach`.
double rounding_of(double reach) {
  constexpr double kHalfUnit = 0.5 * static_cast<double>(FLT_EPSILON);
  return std::sqrt(3.0) * (reach * kHalfUnit + static_cast<double>(FLT_TRUE_MIN));
}

// @returns how many triangles a scene has at a tolerance; for what a sphere or cone cannot become more than any may.
std::uint64_t triangles_of(RoundShapes& shapes, const SceneRoundness& roundness, double tolerance) {
  std::uint64_t triangles = roundness.flat_triangles;
  for (const RoundShapeGroup& group : roundness.groups) {
    const double deviation = tolerance / group.radius;
    const std::uint64_t parts =
        group.is_sphere ? shapes.sphere_frequency(deviation) : RoundShapes::circle_segments(deviation);
    const std::uint64_t each = group.is_sphere ? 20 * parts * parts : 2 * parts;
    triangles += group.count * (parts == 0 ? kMostSceneTriangles + 1ull : each);
  }
  return triangles;
}

// Rounds up to two digits.
double two_digits(double number) {
  const double unit = std::pow(10.0, std::floor(std::log10(number)) - 1);
  return std::ceil(number / unit - 1e-9) * unit;
}

class Flattener {
 public:
  Flattener(SceneEntities entities, const std::filesystem::path& path, const SceneOptions& options)
      : entities_(std::move(entities)),
        path_(path),
        most_triangles_(std::min(options.most_triangles, kMostSceneTriangles)),
        scene_(std::move(entities_.scene)) {
    choose_tolerance(options);
    group_shapes();
    choose_picture(options);
  }

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
    SceneRoundness& roundness = scene_.roundness;
    if (roundness.rule == ToleranceRule::kPicture && !has_coarser_) {
      roundness.rule = ToleranceRule::kDiagonal;  // the picture shows every object as fine as that
      roundness.least_tolerance = roundness.most_tolerance = scene_.tolerance;
    }
    return std::move(scene_);
  }

 private:
  static constexpr std::uint32_t kUnknownMaterial = kMostSceneMaterials;

  [[noreturn]] void fail(std::uint64_t line, const std::string& reason) const {
    throw Failure(ExitCode::kBadInput, path_.string() + ":" + std::to_string(line) + ": " + reason);
  }

  void note(std::uint64_t line, std::string text) {
    if (++scene_.note_count <= kMostSceneNotes) scene_.notes.push_back({line, std::move(text)});
  }

  void choose_tolerance(const SceneOptions& options) {
    if (options.tolerance) {
      scene_.tolerance = *options.tolerance;
    } else {
      const Bounds bounds = bounds_of_shapes();
      const double diagonal = glm::length(bounds.high - bounds.low);
      scene_.tolerance = static_cast<float>(diagonal * static_cast<double>(options.relative_tolerance));
      // A scene in one point, or nearly: whether that can be rendered is said where its objects are.
      if (options.relative_tolerance > 0) scene_.tolerance = std::max(scene_.tolerance, FLT_MIN);
    }
    if (!(scene_.tolerance > 0 && std::isfinite(scene_.tolerance))) {
      fail(1, "the tolerance of round shapes must be a number greater than 0, not " +
                  text_of_number(static_cast<double>(scene_.tolerance)));
    }
  }

  // Groups radii by eighths of an octave, rounded up.
  void group_shapes() {
    constexpr double kSteps = 8;
    SceneRoundness& roundness = scene_.roundness;
    std::map<std::pair<bool, int>, std::uint64_t> groups;
    for (const SceneShape& shape : entities_.shapes) {
      if (is_round(shape)) {
        const double size = std::ceil(kSteps * std::log2(radius_of(shape)));
        ++groups[{shape.kind == ShapeKind::kSphere, static_cast<int>(size)}];
      } else if (shape.kind == ShapeKind::kMesh) {
        roundness.flat_triangles += entities_.meshes[shape.first].triangles.size();
      } else {
        roundness.flat_triangles += shape.count - 2;
      }
    }
    for (const auto& [key, count] : groups) {
      roundness.groups.push_back({key.first, std::exp2(key.second / kSteps), count});
    }
  }

  // Takes the picture's tolerances where the diagonal's make many triangles.
  void choose_picture(const SceneOptions& options) {
    SceneRoundness& roundness = scene_.roundness;
    roundness.least_tolerance = roundness.most_tolerance = scene_.tolerance;
    roundness.rule = options.tolerance ? ToleranceRule::kAsked : ToleranceRule::kDiagonal;
    if (options.tolerance || !options.picture) return;
    const std::uint64_t triangles = triangles_of(shapes_, roundness, static_cast<double>(scene_.tolerance));
    if (triangles <= options.many_triangles) return;
    const ScenePicture picture =
        options.picture(scene_.view, [this](const PointVisitor& visitor) { visit_shapes(visitor); });
    eye_ = DVec3(picture.eye);
    // To three digits: the last bits of a tangent are not the same on every host.
    constexpr double kDigits = 1000;
    int exponent = 0;
    const double fraction = std::frexp(2 * static_cast<double>(picture.tan_half_fov) / picture.height, &exponent);
    pixel_ = std::ldexp(std::round(fraction * kDigits) / kDigits, exponent);
    roundness.rule = ToleranceRule::kPicture;
    roundness.diagonal_tolerance = scene_.tolerance;
    roundness.diagonal_triangles = triangles;
    roundness.least_tolerance = FLT_MAX;
  }

  // Points around all shapes, before they are triangles.
  void visit_shapes(const PointVisitor& visitor) {
    constexpr std::uint32_t kFrequency = 2, kSegments = 12;
    std::vector<Vec3> points;
    std::uint64_t shape_count = 0;
    for (const SceneShape& shape : entities_.shapes) {
      if (++shape_count % 4096 == 0) stop_if_interrupted();
      points.clear();
      if (shape.kind == ShapeKind::kMesh) {
        visitor(entities_.meshes[shape.first].vertices);
        continue;
      }
      if (!is_round(shape)) {
        const std::size_t step = shape.kind == ShapeKind::kPatch ? 2 : 1;
        for (std::size_t i = 0; i < shape.count; ++i) points.push_back(entities_.points[shape.first + i * step]);
        visitor(points);
        continue;
      }
      const double* n = entities_.numbers.data() + shape.first;
      const DVec3 base(n[0], n[1], n[2]);
      if (shape.kind == ShapeKind::kSphere) {
        for (const DVec3& place : shapes_.sphere(kFrequency).vertices) points.emplace_back(base + n[3] * place);
      } else {
        const DVec3 apex(n[4], n[5], n[6]);
        const Frame frame = frame_of(glm::normalize(apex - base));
        for (const DVec3& place : shapes_.circle(kSegments)) {
          points.emplace_back(base + n[3] * frame.across(place));
          points.emplace_back(apex + n[7] * frame.across(place));
        }
      }
      visitor(points);
    }
  }

  // A share of a pixel at the object's nearest point; see tools/scene_text/README.md for the limits.
  [[nodiscard]] double tolerance_of(const SceneShape& shape) {
    const double least = static_cast<double>(scene_.tolerance);
    if (scene_.roundness.rule != ToleranceRule::kPicture) return least;
    constexpr double kPixelShare = 0.25, kMostCoarser = 16, kMostRadiusShare = 1.0 / 32;
    const double hidden = std::min(kPixelShare * pixel_ * distance_to(shape), kMostRadiusShare * radius_of(shape));
    const double tolerance = std::clamp(hidden, least, kMostCoarser * least);
    SceneRoundness& roundness = scene_.roundness;
    roundness.least_tolerance = std::min(roundness.least_tolerance, static_cast<float>(tolerance));
    roundness.most_tolerance = std::max(roundness.most_tolerance, static_cast<float>(tolerance));
    return tolerance;
  }

  // From the eye to a ball around the axis of the shape, which contains it.
  [[nodiscard]] double distance_to(const SceneShape& shape) const {
    const double* n = entities_.numbers.data() + shape.first;
    const DVec3 base(n[0], n[1], n[2]);
    if (shape.kind == ShapeKind::kSphere) return std::fabs(glm::length(base - eye_) - n[3]);
    const DVec3 axis = DVec3(n[4], n[5], n[6]) - base;
    const double along = std::clamp(glm::dot(eye_ - base, axis) / glm::dot(axis, axis), 0.0, 1.0);
    return std::max(0.0, glm::length(base + along * axis - eye_) - radius_of(shape));
  }

  static bool is_round(const SceneShape& shape) {
    return shape.kind == ShapeKind::kSphere || shape.kind == ShapeKind::kCone;
  }

  [[nodiscard]] double radius_of(const SceneShape& shape) const {
    const double* n = entities_.numbers.data() + shape.first;
    return shape.kind == ShapeKind::kSphere ? n[3] : std::max(n[3], n[7]);
  }

  [[nodiscard]] Bounds bounds_of_shapes() const {
    Bounds bounds;
    for (const SceneShape& shape : entities_.shapes) {
      if (shape.kind == ShapeKind::kSphere || shape.kind == ShapeKind::kCone) {
        const double* n = entities_.numbers.data() + shape.first;
        bounds.add(DVec3(n[0], n[1], n[2]), n[3]);
        if (shape.kind == ShapeKind::kCone) bounds.add(DVec3(n[4], n[5], n[6]), n[7]);
      } else if (shape.kind == ShapeKind::kMesh) {
        for (const Vec3& vertex : entities_.meshes[shape.first].vertices) bounds.add(DVec3(vertex));
      } else {
        const std::size_t step = shape.kind == ShapeKind::kPatch ? 2 : 1;
        for (std::size_t i = 0; i < shape.count; ++i) bounds.add(DVec3(entities_.points[shape.first + i * step]));
      }
    }
    return bounds;
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

  // How far facets may be from a shape of a radius once their corners' rounding has taken its part, as a share of it.
  [[nodiscard]] double allowed_deviation(const SceneShape& shape, double reach, double radius) {
    const double rounding = rounding_of(reach);
    const double tolerance = tolerance_of(shape);
    if (!(tolerance > 2 * rounding)) {
      fail(shape.line, "a tolerance of " + text_of_number(tolerance) +
                           " is finer than floats are there; they allow at least " + text_of_number(2.01 * rounding));
    }
    if (!(radius > 16 * rounding)) {
      fail(shape.line, "a radius of " + text_of_number(radius) +
                           " is finer than floats are there; they allow at least " + text_of_number(16.01 * rounding));
    }
    return (tolerance - rounding) / radius;
  }

  // Notices a shape of fewer parts than the diagonal's tolerance would make of it. @param deviation  that is allowed.
  template <class PartsOf>
  void compare_with_diagonal(const SceneShape& shape, std::uint32_t parts, double radius, double deviation,
                             const PartsOf& parts_of) {
    if (has_coarser_ || scene_.roundness.rule != ToleranceRule::kPicture) return;
    const double more = (tolerance_of(shape) - static_cast<double>(scene_.tolerance)) / radius;
    has_coarser_ = parts_of(std::max(deviation - more, DBL_MIN)) != parts;
  }

  void add_sphere(const SceneShape& shape) {
    const double* n = entities_.numbers.data() + shape.first;
    const DVec3 center(n[0], n[1], n[2]);
    const double radius = n[3];
    const DVec3 reach = glm::abs(center) + radius;
    const double deviation = allowed_deviation(shape, std::max({reach.x, reach.y, reach.z}), radius);
    const std::uint32_t frequency = shapes_.sphere_frequency(deviation);
    if (frequency == 0) {
      fail(shape.line, "a sphere of radius " + text_of_number(radius) +
                           " needs too many triangles for a tolerance of " + text_of_number(tolerance_of(shape)));
    }
    const std::uint64_t square = std::uint64_t{frequency} * frequency;
    compare_with_diagonal(shape, frequency, radius, deviation,
                          [this](double allowed) { return shapes_.sphere_frequency(allowed); });
    require_room(shape, 20 * square, 10 * square + 2, 10 * square + 2);
    const UnitSphere& unit = shapes_.sphere(frequency);
    const std::uint32_t first = next_vertex();
    for (const DVec3& vertex : unit.vertices) scene_.geometry.vertices.emplace_back(center + radius * vertex);
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
    const double* n = entities_.numbers.data() + shape.first;
    const DVec3 base(n[0], n[1], n[2]), apex(n[4], n[5], n[6]);
    const double base_radius = n[3], apex_radius = n[7];
    const double largest = std::max(base_radius, apex_radius);
    const DVec3 reach = glm::max(glm::abs(base), glm::abs(apex)) + largest;
    const double deviation = allowed_deviation(shape, std::max({reach.x, reach.y, reach.z}), largest);
    const std::uint32_t segments = RoundShapes::circle_segments(deviation);
    if (segments == 0) {
      fail(shape.line, "a cone of radius " + text_of_number(largest) + " needs too many triangles for a tolerance of " +
                           text_of_number(tolerance_of(shape)));
    }
    compare_with_diagonal(shape, segments, largest, deviation, RoundShapes::circle_segments);
    require_room(shape, 2 * std::uint64_t{segments}, 2 * std::uint64_t{segments}, 2 * std::uint64_t{segments});
    const double length = glm::length(apex - base);
    const Frame frame = frame_of((apex - base) / length);
    const Ring low = add_ring(frame, base, base_radius, segments), high = add_ring(frame, apex, apex_radius, segments);

    const bool smooth = is_smooth(shape);
    const bool is_pointed = low.step == 0 || high.step == 0;
    const std::uint32_t first_normal = next_normal();
    if (smooth) add_cone_normals(frame, length, base_radius - apex_radius, segments, is_pointed);
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

  struct Frame {
    DVec3 axis, right, up;
    [[nodiscard]] DVec3 across(const DVec3& place) const { return right * place.x + up * place.y; }
  };

  static Frame frame_of(const DVec3& axis) {
    const DVec3 right = any_perpendicular(axis);
    return {axis, right, glm::cross(axis, right)};
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
    const std::size_t step = is_patch ? 2 : 1;
    corners_.resize(shape.count);
    for (std::size_t i = 0; i < shape.count; ++i) corners_[i] = entities_.points[shape.first + i * step];
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
  DVec3 eye_{0};                                           // of the picture
  double pixel_ = 0;                                       // of the picture, at distance 1
  bool has_coarser_ = false;                               // shapes than by the tolerance of the diagonal
  std::map<std::uint32_t, std::uint32_t> sphere_normals_;  // first normal of each frequency
  std::map<SceneMaterial, std::uint32_t, MaterialOrder> material_index_;
  std::vector<std::uint32_t> material_of_fill_;  // two of each fill: flat, smooth
  std::vector<Vec3> corners_;                    // of the polygon being cut
  std::vector<UVec3> cut_;
};

}  // namespace

std::optional<float> tolerance_for(const SceneRoundness& roundness, std::uint64_t most_triangles) {
  constexpr double kStep = 1.19;   // a quarter of an octave
  constexpr int kMostSteps = 160;  // 10^12
  RoundShapes shapes;
  double tolerance = static_cast<double>(roundness.least_tolerance);
  for (int step = 0; step < kMostSteps && !roundness.groups.empty(); ++step, tolerance *= kStep) {
    const double rounded = two_digits(tolerance);
    if (triangles_of(shapes, roundness, rounded) <= most_triangles) return static_cast<float>(rounded);
  }
  return std::nullopt;
}

SceneDescription flatten_scene(SceneEntities entities, const std::filesystem::path& path, const SceneOptions& options) {
  return Flattener(std::move(entities), path, options).flatten();
}

}  // namespace gridiron::tool
