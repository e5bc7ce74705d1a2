// Tolerance of round shapes. SPDX-License-Identifier: Apache-2.0
#include "scene_text/shape_tolerance.h"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <map>
#include <utility>

#include "scene_text/scene_words.h"

namespace gridiron::tool {
namespace {

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

}  // namespace

ShapeTolerance::ShapeTolerance(const SceneEntities& entities, RoundShapes& shapes, const SceneOptions& options,
                               const std::filesystem::path& path, SceneDescription& scene)
    : entities_(entities), shapes_(shapes), scene_(scene) {
  choose_tolerance(options, path);
  group_shapes();
  choose_picture(options);
}

void ShapeTolerance::choose_tolerance(const SceneOptions& options, const std::filesystem::path& path) {
  if (options.tolerance) {
    scene_.tolerance = *options.tolerance;
  } else {
    const double diagonal = diagonal_of_shapes(entities_);
    scene_.tolerance = static_cast<float>(diagonal * static_cast<double>(options.relative_tolerance));
    // A scene in one point, or nearly: whether that can be rendered is said where its objects are.
    if (options.relative_tolerance > 0) scene_.tolerance = std::max(scene_.tolerance, FLT_MIN);
  }
  if (!(scene_.tolerance > 0 && std::isfinite(scene_.tolerance))) {
    input_error(path, 1,
                "the tolerance of round shapes must be a number greater than 0, not " +
                    text_of_number(static_cast<double>(scene_.tolerance)));
  }
}

// Groups radii by eighths of an octave, rounded up.
void ShapeTolerance::group_shapes() {
  constexpr double kSteps = 8;
  SceneRoundness& roundness = scene_.roundness;
  std::map<std::pair<bool, int>, std::uint64_t> groups;
  for (const SceneShape& shape : entities_.shapes) {
    if (is_round(shape)) {
      const double size = std::ceil(kSteps * std::log2(round_shape(entities_, shape).radius()));
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
void ShapeTolerance::choose_picture(const SceneOptions& options) {
  SceneRoundness& roundness = scene_.roundness;
  roundness.least_tolerance = roundness.most_tolerance = scene_.tolerance;
  roundness.rule = options.tolerance ? ToleranceRule::kAsked : ToleranceRule::kDiagonal;
  if (options.tolerance || !options.picture) return;
  const std::uint64_t triangles = triangles_of(shapes_, roundness, static_cast<double>(scene_.tolerance));
  if (triangles <= options.many_triangles) return;
  const ScenePicture picture =
      options.picture(scene_.view, [this](const PointVisitor& visitor) { visit_shapes(entities_, shapes_, visitor); });
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

// A share of a pixel at the object's nearest point; see tools/scene_text/README.md for the limits.
double ShapeTolerance::of(const RoundShape& shape) {
  const double least = static_cast<double>(scene_.tolerance);
  if (scene_.roundness.rule != ToleranceRule::kPicture) return least;
  constexpr double kPixelShare = 0.25, kMostCoarser = 16, kMostRadiusShare = 1.0 / 32;
  const double hidden = std::min(kPixelShare * pixel_ * shape.distance_to(eye_), kMostRadiusShare * shape.radius());
  const double tolerance = std::clamp(hidden, least, kMostCoarser * least);
  SceneRoundness& roundness = scene_.roundness;
  roundness.least_tolerance = std::min(roundness.least_tolerance, static_cast<float>(tolerance));
  roundness.most_tolerance = std::max(roundness.most_tolerance, static_cast<float>(tolerance));
  return tolerance;
}

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

}  // namespace gridiron::tool
