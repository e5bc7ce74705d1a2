// Look of a mesh. SPDX-License-Identifier: Apache-2.0
#include "look.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/failure.h"
#include "crease_normals.h"

namespace gridiron::tool {
namespace {

// --- The studio: what its parts are where they are not given ---------------------------------------------------------

constexpr LookLights kStudioLights = {.head = false, .key = true, .area = true};
constexpr std::uint32_t kStudioSamples = 4, kStudioOcclusion = 16;
constexpr float kStudioSmoothDegrees = 35.0f;
constexpr float kStudioFovDegrees = 30.0f;
constexpr std::uint32_t kKeySamples = 6, kAreaSamples = 2;  // of each sample of a pixel

// Of a mesh without materials: clay with a faint shine.
const SceneMaterial kPlain = {.color = {0.56f, 0.42f, 0.31f}, .kd = 0.86f, .ks = 0.14f, .shine = 40.0f};
const Vec3 kGroundColor = {0.42f, 0.43f, 0.44f};  // of the ground
const Vec3 kHeadColor = Vec3(0.9f);               // alone
const Vec3 kFillColor = Vec3(0.30f);              // of the head light beside others
const Vec3 kKeyColor = {1.25f, 1.21f, 1.16f};
const Vec3 kAreaColor = {0.25f, 0.27f, 0.30f};

// Where the lights stand, seen from the object: degrees from the view to the right and upwards; distance and edge in
// radii of the object. They are far, so that the ground is lit evenly.
constexpr double kKeyAzimuth = -56, kKeyElevation = 50, kKeyDistance = 2000, kKeyEdge = 200;
constexpr double kAreaAzimuth = 70, kAreaElevation = 42, kAreaDistance = 600, kAreaEdge = 420;

// The ground: rings of triangles, small below the object.
constexpr std::uint32_t kGroundSegments = 48, kGroundRings = 12;
constexpr double kGroundRadius = 24;       // in radii of the object
constexpr double kGroundGap = 1.0 / 4096;  // below the object, likewise: they never share a plane
constexpr double kOcclusionRadius = 0.7;   // likewise
constexpr double kFarRadii = 1000;         // likewise: from there on rounding is seen

double to_linear(double srgb) {
  return srgb <= 0.04045 ? srgb / 12.92 : std::pow((srgb + 0.055) / 1.055, 2.4);
}

// The directions of the first view around the object.
struct Directions {
  DVec3 up, right, front;  // unit; front leads to the viewer, without what it has of up
  DVec3 middle;
  double radius = 0;  // of the ball around the bounds

  [[nodiscard]] DVec3 toward(double azimuth, double elevation) const {
    const double a = azimuth * std::numbers::pi / 180, e = elevation * std::numbers::pi / 180;
    return std::cos(e) * (std::cos(a) * front + std::sin(a) * right) + std::sin(e) * up;
  }
};

Directions directions_of(const Camera& view, const LookBounds& bounds) {
  Directions directions;
  directions.up = bounds.up;
  const DVec3 back = DVec3(view.eye) - DVec3(view.at);
  DVec3 front = back - glm::dot(back, directions.up) * directions.up;
  if (!(glm::length(front) > 1e-6 * glm::length(back))) {  // from above: what is below in the picture is in front
    const DVec3 below = -DVec3(view.up);
    front = below - glm::dot(below, directions.up) * directions.up;
  }
  directions.front = unit_or_zero(front);
  directions.right = glm::cross(directions.up, directions.front);
  directions.middle = 0.5 * (bounds.low + bounds.high);
  directions.radius = 0.5 * glm::length(bounds.high - bounds.low);
  return directions;
}

// --- Surfaces --------------------------------------------------------------------------------------------------------

// Normals of all triangles: the file's, or those of an angle.
void give_normals(const Mesh& mesh, std::optional<float> degrees, bool is_studio, SceneEffects& effects) {
  const MeshSurface& surface = mesh.surface;
  const std::size_t count = mesh.triangles.size();
  if (!degrees && !surface.triangle_normals.empty()) {
    effects.normals = surface.normals;
    effects.triangle_normals = surface.triangle_normals;
    const bool is_whole = std::ranges::none_of(effects.triangle_normals,
                                               [](const UVec3& triangle) { return triangle == UVec3(kNoNormal); });
    if (is_whole) return;
    MeshNormals made = make_crease_normals(mesh.vertices, mesh.triangles, is_studio ? kStudioSmoothDegrees : 0.0f);
    const auto first = static_cast<std::uint32_t>(effects.normals.size());
    effects.normals.insert(effects.normals.end(), made.normals.begin(), made.normals.end());
    for (std::size_t i = 0; i < count; ++i) {
      if (effects.triangle_normals[i] == UVec3(kNoNormal)) effects.triangle_normals[i] = made.triangles[i] + first;
    }
    return;
  }
  MeshNormals made = make_crease_normals(mesh.vertices, mesh.triangles, degrees.value_or(0.0f));
  effects.normals = std::move(made.normals);
  effects.triangle_normals = std::move(made.triangles);
}

Material material_with(SceneMaterial material, bool is_smooth) {
  material.smooth_normals = is_smooth;
  return material_of(material);
}

// Materials of all triangles: each one of the file twice, the second with colours at vertices.
// @returns triangles whose colours are left out, because there are too many materials.
std::uint64_t give_materials(const Mesh& mesh, const LookRequest& request, bool is_smooth, SceneEffects& effects) {
  const MeshSurface& surface = mesh.surface;
  const std::size_t count = mesh.triangles.size();
  if (request.color || surface.is_empty() || (surface.triangle_materials.empty() && surface.triangle_colors.empty())) {
    SceneMaterial plain = kPlain;
    if (request.color) plain.color = *request.color;
    effects.materials = {material_with(plain, is_smooth)};
    effects.triangle_materials.assign(count, 0);
    return 0;
  }
  std::vector<SceneMaterial> own = surface.materials;
  if (surface.triangle_materials.empty()) own = {kPlain};
  effects.triangle_materials = surface.triangle_materials;
  effects.triangle_materials.resize(count, 0);
  for (const SceneMaterial& material : own) effects.materials.push_back(material_with(material, is_smooth));
  if (surface.triangle_colors.empty()) return 0;

  std::uint64_t left_out = 0;
  effects.colors = surface.colors;
  effects.triangle_colors = surface.triangle_colors;
  std::vector<std::uint32_t> colored(own.size(), kNoNormal);
  for (std::size_t i = 0; i < count; ++i) {
    if (effects.triangle_colors[i] == UVec3(kNoNormal)) continue;
    std::uint32_t& index = colored[effects.triangle_materials[i]];
    if (index == kNoNormal) {
      if (effects.materials.size() + 1 >= kMostSceneMaterials) {  // left with that of its material; one is the ground's
        effects.triangle_colors[i] = UVec3(kNoNormal);
        ++left_out;
        continue;
      }
      Material material = effects.materials[effects.triangle_materials[i]];
      material.color = Vec3(1);
      material.smooth_normals = material.vertex_colors = true;
      index = static_cast<std::uint32_t>(effects.materials.size());
      effects.materials.push_back(material);
    }
    effects.triangle_materials[i] = static_cast<std::uint16_t>(index);
  }
  return left_out;
}

// --- Ground and lights -----------------------------------------------------------------------------------------------

// Adds a disc of rings below the object. Rings grow by a constant factor, so that triangles are small near the object.
void add_ground(Mesh& mesh, const Directions& directions, const LookBounds& bounds, const Material& material,
                SceneEffects& effects) {
  const double radius = directions.radius;
  // Far from the origin the ground's own vertices are rounded by more than the gap.
  const double farthest = glm::length(directions.middle) + kGroundRadius * radius;
  const double gap = std::max(kGroundGap * radius, 2 * farthest * std::numeric_limits<float>::epsilon());
  const double height = bounds.lowest - gap;
  const DVec3 foot = directions.middle + (height - glm::dot(directions.middle, directions.up)) * directions.up;
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  const auto index = static_cast<std::uint16_t>(effects.materials.size());
  effects.materials.push_back(material);
  mesh.vertices.emplace_back(foot);
  constexpr double kLeast = 0.25;
  for (std::uint32_t ring = 0; ring < kGroundRings; ++ring) {
    const double share = static_cast<double>(ring) / (kGroundRings - 1);
    const double reach = radius * kLeast * std::pow(kGroundRadius / kLeast, share);
    for (std::uint32_t i = 0; i < kGroundSegments; ++i) {
      const double turn = 2 * std::numbers::pi * i / kGroundSegments;
      mesh.vertices.emplace_back(foot +
                                 reach * (std::cos(turn) * directions.front + std::sin(turn) * directions.right));
    }
  }
  const auto at = [&](std::uint32_t ring, std::uint32_t i) {
    return first + 1 + ring * kGroundSegments + i % kGroundSegments;
  };
  for (std::uint32_t i = 0; i < kGroundSegments; ++i) mesh.triangles.emplace_back(first, at(0, i), at(0, i + 1));
  for (std::uint32_t ring = 1; ring < kGroundRings; ++ring) {
    for (std::uint32_t i = 0; i < kGroundSegments; ++i) {
      mesh.triangles.emplace_back(at(ring - 1, i), at(ring, i), at(ring, i + 1));
      mesh.triangles.emplace_back(at(ring - 1, i), at(ring, i + 1), at(ring - 1, i + 1));
    }
  }
  effects.triangle_materials.resize(mesh.triangles.size(), index);
  if (!effects.triangle_normals.empty()) effects.triangle_normals.resize(mesh.triangles.size(), UVec3(kNoNormal));
  if (!effects.triangle_colors.empty()) effects.triangle_colors.resize(mesh.triangles.size(), UVec3(kNoNormal));
}

Light light_at(const DVec3& place, const Vec3& color) {
  return {.corner = Vec3(place), .color = color};
}

// A square that faces the object. @param distance, edge  in radii of the object.
Light square_light(const Directions& directions, const DVec3& toward, double distance, double edge) {
  const DVec3 across = unit_or_zero(glm::cross(directions.up, toward)), along = glm::cross(toward, across);
  const double length = edge * directions.radius;
  const DVec3 middle = directions.middle + distance * directions.radius * toward;
  return {.corner = Vec3(middle - 0.5 * length * (across + along)),
          .edge_u = Vec3(length * across),
          .edge_v = Vec3(length * along)};
}

Light key_light(const Directions& directions) {
  Light light = square_light(directions, directions.toward(kKeyAzimuth, kKeyElevation), kKeyDistance, kKeyEdge);
  light.color = kKeyColor;
  light.samples = kKeySamples;
  return light;
}

Light area_light(const Directions& directions) {
  Light light = square_light(directions, directions.toward(kAreaAzimuth, kAreaElevation), kAreaDistance, kAreaEdge);
  light.color = kAreaColor;
  light.samples = kAreaSamples;
  return light;
}

// The brightness of the ground where nothing shades it, in proportion to its colour.
Vec3 light_on_ground(const LookLights& lights, bool has_occlusion, bool has_fill) {
  const auto share = [](double elevation) { return static_cast<float>(std::sin(elevation * std::numbers::pi / 180)); };
  Vec3 light = Vec3(has_occlusion ? kAmbientLight : 0.0f);
  if (lights.key) light += share(kKeyElevation) * kKeyColor;
  if (lights.area) light += share(kAreaElevation) * kAreaColor;
  if (lights.head || has_fill) light += 0.5f * (has_fill ? kFillColor : kHeadColor);
  return light;
}

// --- Words -----------------------------------------------------------------------------------------------------------

constexpr auto kColorNames = std::to_array<std::string_view>(
    {"white", "light", "grey", "dark", "black", "clay", "red", "orange", "yellow", "green", "teal", "blue", "violet"});
constexpr auto kColorValues =
    std::to_array<std::string_view>({"ffffff", "d9dbde", "808080", "303236", "000000", "c8b49f", "c0392b", "d9822b",
                                     "e0b83c", "5a9a57", "3f9c9c", "3f72b5", "7c63b8"});
static_assert(kColorNames.size() == kColorValues.size());

}  // namespace

LookBounds look_bounds_of(const PointSource& points, const Vec3& up) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  LookBounds bounds{DVec3(kFar), DVec3(-kFar), unit_or_zero(DVec3(up)), kFar};
  points([&bounds](std::span<const Vec3> some) {
    for (const Vec3& point : some) {
      bounds.low = glm::min(bounds.low, DVec3(point));
      bounds.high = glm::max(bounds.high, DVec3(point));
      bounds.lowest = std::min(bounds.lowest, glm::dot(DVec3(point), bounds.up));
    }
  });
  return bounds;
}

std::span<const std::string_view> color_names() {
  return kColorNames;
}

std::optional<Vec3> parse_color(std::string_view text) {
  const auto name = std::ranges::find(kColorNames, text);
  if (name != kColorNames.end()) text = kColorValues[static_cast<std::size_t>(name - kColorNames.begin())];
  if (text.starts_with('#')) text.remove_prefix(1);
  if (text.size() != 6) return std::nullopt;
  Vec3 color;
  for (std::size_t channel = 0; channel < 3; ++channel) {
    std::uint32_t value = 0;
    for (const char digit : text.substr(2 * channel, 2)) {
      const std::size_t at = std::string_view("0123456789abcdefABCDEF").find(digit);
      if (at == std::string_view::npos) return std::nullopt;
      value = 16 * value + static_cast<std::uint32_t>(at < 16 ? at : at - 6);
    }
    color[static_cast<int>(channel)] = static_cast<float>(to_linear(value / 255.0));
  }
  return color;
}

std::optional<LookLights> parse_lights(std::string_view text) {
  LookLights lights;
  if (text == "none") return lights;
  while (true) {
    const std::size_t comma = text.find(',');
    const std::string_view word = text.substr(0, comma);
    bool LookLights::*const light = word == "head"   ? &LookLights::head
                                    : word == "key"  ? &LookLights::key
                                    : word == "area" ? &LookLights::area
                                                     : nullptr;
    if (light == nullptr || lights.*light) return std::nullopt;
    lights.*light = true;
    if (comma == std::string_view::npos) return lights;
    text.remove_prefix(comma + 1);
  }
}

ViewRequest look_view(const LookRequest& request, ViewRequest view) {
  if (request.is_studio && !view.eye && !view.fov_degrees) view.fov_degrees = kStudioFovDegrees;
  return view;
}

void check_look(const LookRequest& request, SceneKind kind) {
  if (!request.is_given()) return;
  if (kind == SceneKind::kPacked) {
    usage_error(
        "--look and its parts: a packed scene holds its lights and materials; they are of meshes and text scenes");
  }
  if (kind != SceneKind::kText) return;
  const std::pair<const char*, bool> of_meshes[] = {{"--look", request.is_studio},
                                                    {"--color", request.color.has_value()},
                                                    {"--ground", request.ground.has_value()},
                                                    {"--light", request.lights.has_value()},
                                                    {"--smooth", request.smooth_degrees.has_value()}};
  for (const auto& [option, is_given] : of_meshes) {
    if (is_given) usage_error(std::string(option) + ": a text scene has its own; this is for meshes");
  }
}

void apply_look(SceneInput& input, const LookRequest& request, const Camera& view, const LookBounds& bounds) {
  if (input.effects) {
    SceneEffects& own = *input.effects;
    if (request.background) {
      own.background = *request.background;
      own.environment_width = 0;
      for (std::vector<Vec3>& face : own.environment_faces) face.clear();
    }
    if (request.samples) own.samples_per_pixel = *request.samples;
    if (request.levels) own.levels = *request.levels;
    if (request.occlusion) {
      own.occlusion_samples = *request.occlusion;
      if (own.occlusion_radius == 0) own.occlusion_radius = static_cast<float>(directions_of(view, bounds).radius);
      if (own.occlusion_samples == 0) own.occlusion_radius = 0;
    }
    return;
  }
  const bool is_studio = request.is_studio;
  Mesh& mesh = std::get<Mesh>(input.content);
  const Directions directions = directions_of(view, bounds);
  const double farthest = glm::length(directions.middle) + (kKeyDistance + 1) * directions.radius;
  if (!(farthest < 0.5 * double{kCoordinateLimit})) {
    input_error(input.path, "is too large for a look: its lights would be too far away");
  }
  SceneEffects effects;
  const LookLights lights = request.lights.value_or(is_studio ? kStudioLights : LookLights{.head = true});
  const bool has_own_normals = !mesh.surface.triangle_normals.empty();
  std::optional<float> degrees = request.smooth_degrees;
  if (!degrees && is_studio && !has_own_normals) degrees = kStudioSmoothDegrees;
  const bool has_colors = !request.color && !mesh.surface.triangle_colors.empty();
  const bool is_smooth = degrees.value_or(has_own_normals ? 1.0f : 0.0f) > 0.0f || has_colors;
  if (is_smooth) give_normals(mesh, degrees, is_studio, effects);
  input.colorless_triangles = give_materials(mesh, request, is_smooth, effects);

  effects.occlusion_samples = request.occlusion.value_or(is_studio ? kStudioOcclusion : 0);
  const bool has_occlusion = effects.occlusion_samples != 0;
  if (has_occlusion) effects.occlusion_radius = static_cast<float>(kOcclusionRadius * directions.radius);
  // Without ambient light what no light reaches would be black.
  const bool has_fill = (lights.key || lights.area) && (lights.head || !has_occlusion);
  // Soft shadows and normals need places that are finer than the mesh's parts.
  if (glm::length(directions.middle) > kFarRadii * directions.radius) {
    input.look_notes.emplace_back(
        "it lies so far from the origin that floats round its places: shadows and normals may show facets; "
        "where it was made, move it to the origin");
  }
  if (request.ground.value_or(is_studio)) {
    if (glm::dot(DVec3(view.eye), directions.up) < bounds.lowest) {
      input.look_notes.emplace_back("it is seen from below the ground, which hides it; --ground off shows it");
    }
    if (effects.materials.size() >= kMostSceneMaterials)
      input_error(input.path, "has too many materials for a ground; --ground off renders it");
    input.ground_begin = static_cast<std::uint32_t>(mesh.triangles.size());
    add_ground(mesh, directions, bounds, {.color = kGroundColor}, effects);
  }
  if (lights.head || has_fill) effects.lights.push_back(light_at(DVec3(view.eye), has_fill ? kFillColor : kHeadColor));
  if (lights.key) effects.lights.push_back(key_light(directions));
  if (lights.area) effects.lights.push_back(area_light(directions));
  const Vec3 lit = kGroundColor * light_on_ground(request.lights.value_or(kStudioLights), has_occlusion, has_fill);
  effects.background = request.background.value_or(glm::min(lit, Vec3(1)));
  effects.samples_per_pixel = request.samples.value_or(is_studio ? kStudioSamples : 1);
  effects.levels = request.levels.value_or(ColorLevels::kSrgb);
  // Mirrors and glass are the file's; what shines a little does not mirror.
  const bool has_own_materials = !request.color && !mesh.surface.triangle_materials.empty();
  effects.recursion_depth = has_own_materials ? kDefaultRecursionDepth : 1;
  input.effects = std::move(effects);
}

}  // namespace gridiron::tool
