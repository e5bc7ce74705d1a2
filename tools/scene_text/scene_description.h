// Scene description: a text scene after reading: checked, tessellated, flat. What effects and image builders start
// from. Memory: std::vector. Threads: any may read. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/effect_records.h>
#include <gridiron/base/math.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace gridiron::tool {

// Ranges of the values below; a reader rejects others.
inline constexpr std::uint32_t kMostSceneMaterials = 65535;     ///< index 65535 is never used
inline constexpr std::uint32_t kMostSceneTriangles = 1u << 26;  ///< after tessellation
inline constexpr std::uint32_t kMostSceneVertices = 1u << 26;   ///< and as many normals
inline constexpr std::uint32_t kMostSceneLights = 256;          ///< point and area lights together
inline constexpr std::uint32_t kMostEffectSamples = 64;         ///< of an area light, of ambient occlusion
inline constexpr std::uint32_t kMostRecursionDepth = 8;         ///< the eye ray is of depth 1
inline constexpr std::uint32_t kDefaultRecursionDepth = 5;      ///< the readers' customary default for NFF
inline constexpr std::uint32_t kMostEnvironmentWidth = 1024;    ///< texels of a face's edge
inline constexpr double kMostSceneCoordinate = 1e18;            ///< |x|, so that squares of lengths stay finite
inline constexpr float kLeastRefraction = 0.1f, kMostRefraction = 10.0f;
inline constexpr float kMostShine = 1e5f;
inline constexpr float kMostLightColor = 1e6f;

/// A pinhole view. World space; not normalised; from != at, up neither 0 nor along at - from. A text need not have one.
struct SceneView {
  Vec3 from{0, 0, 1}, at{0, 0, 0}, up{0, 1, 0};
  float angle_degrees = 45.0f;          ///< between the top and the bottom edge of the picture, in (0, 180)
  float hither = 0.0f;                  ///< >= 0: nearer parts along at - from are invisible
  std::uint32_t width = 0, height = 0;  ///< pixels, 1..kMaxPictureWidth; 0 without a view
  std::uint64_t line = 0;               ///< of the text; 0: it has no view

  [[nodiscard]] bool is_given() const { return line != 0; }
};

/// Light from a point. It does not fall off with distance.
struct PointLight {
  Vec3 position{0, 0, 0};
  Vec3 color{1, 1, 1};  ///< 0..kMostLightColor
};

/// Light from a parallelogram corner + a edge_u + b edge_v, a and b in [0, 1], on both sides; never seen itself. Its
/// samples together are as bright as one point light of `color`.
struct AreaLight {
  Vec3 corner{0, 0, 0};
  Vec3 edge_u{1, 0, 0}, edge_v{0, 1, 0};  ///< neither 0 nor parallel
  Vec3 color{1, 1, 1};                    ///< 0..kMostLightColor
  std::uint32_t samples = 16;             ///< shadow rays from each point lit, 1..kMostEffectSamples
};

/// The properties of a surface. The names are NFF's.
struct SceneMaterial {
  Vec3 color{1, 1, 1};            ///< 0..1 each, of diffuse and of transmitted light
  float kd = 1.0f;                ///< diffuse share, 0..1
  float ks = 0.0f;                ///< specular share, 0..1: highlight and mirror reflection
  float shine = 0.0f;             ///< exponent of the Blinn-Phong highlight, 0..kMostShine; 0: no highlight
  float transmittance = 0.0f;     ///< T, share of light let through, 0..1
  float index_of_refraction = 1;  ///< of the inside to the outside, kLeastRefraction..kMostRefraction; 1 where T is 0
  bool smooth_normals = false;    ///< true: every triangle of this material has normals; false: none has
  bool vertex_colors = false;     ///< likewise colours, which the diffuse share is multiplied by; with normals only

  friend bool operator==(const SceneMaterial&, const SceneMaterial&) = default;
};

/// Faces of an environment cube, in the order of the `e` line. A face is the view of a camera in the middle, with 90
/// degrees and up y; for the faces of y up is z (kPlusY) and -z (kMinusY). So right is z, -z, x, x, -x, x.
enum class CubeFace : std::uint8_t { kPlusX, kMinusX, kPlusY, kMinusY, kPlusZ, kMinusZ };
inline constexpr std::uint32_t kCubeFaceCount = 6;

/// The background for rays that leave the scene, instead of a colour.
struct EnvironmentMap {
  std::array<std::filesystem::path, kCubeFaceCount> paths;  ///< resolved against the scene's folder
  std::uint32_t width = 0;                                  ///< texels of each face's edge, 1..kMostEnvironmentWidth
  std::array<std::vector<Vec3>, kCubeFaceCount> texels;     ///< width * width each, first row on top; >= 0, linear
};

struct AmbientOcclusion {
  std::uint32_t samples = 16;  ///< rays from each point, 1..kMostEffectSamples
  float radius = 1.0f;         ///< > 0, world units: farther surfaces do not occlude
};

/// Value of triangle_normals and triangle_colors for a triangle without them.
inline constexpr std::uint32_t kNoNormal = std::numeric_limits<std::uint32_t>::max();

/// All geometry. Triangles are counter-clockwise seen from outside, in the file's order. Closed shapes share vertices.
struct SceneGeometry {
  std::vector<Vec3> vertices;                     ///< finite, |x| <= 2 kMostSceneCoordinate
  std::vector<UVec3> triangles;                   ///< of indices into vertices
  std::vector<std::uint16_t> triangle_materials;  ///< one per triangle, of SceneDescription::materials
  std::vector<Vec3> normals;                      ///< unit to float rounding, outwards
  std::vector<UVec3> triangle_normals;  ///< empty where no material is smooth, else one per triangle: indices into
                                        ///< normals, or kNoNormal three times
  std::vector<Vec3> colors;             ///< linear, 0..1 each
  std::vector<UVec3> triangle_colors;   ///< likewise of the materials with colours: indices into colors
};

/// Where the tolerance of round shapes comes from.
enum class ToleranceRule : std::uint8_t {
  kAsked,     ///< SceneOptions::tolerance
  kDiagonal,  ///< a share of the diagonal of the box around all objects
  kPicture,   ///< coarser than that where the picture does not show it: a share of a pixel, an object at a time
};

/// Round shapes of similar radius: gives the number of triangles for a tolerance without making them.
struct RoundShapeGroup {
  bool is_sphere = true;
  double radius = 0;  ///< that of none is greater
  std::uint64_t count = 0;
};

/// How round shapes became triangles, with the data to predict other tolerances.
struct SceneRoundness {
  float least_tolerance = 0.0f, most_tolerance = 0.0f;  ///< of all objects, world units; equal but for kPicture
  ToleranceRule rule = ToleranceRule::kDiagonal;
  float diagonal_tolerance = 0.0f;       ///< kPicture: that of kDiagonal
  std::uint64_t diagonal_triangles = 0;  ///< kPicture: that kDiagonal would have made, an estimate
  std::vector<RoundShapeGroup> groups;   ///< spheres and cones by their size
  std::uint64_t flat_triangles = 0;      ///< of all other objects, including those without area
};

/// Counts of the text, before tessellation.
struct SceneCounts {
  std::uint64_t spheres = 0, cones = 0, polygons = 0, patches = 0, meshes = 0;
  std::uint64_t non_planar_polygons = 0;  ///< of polygons: corners off their plane by more than the tolerance
};

/// Accepted input that deserves a note.
struct SceneNote {
  std::uint64_t line = 0;
  std::string text;  ///< without capital or full stop
};
inline constexpr std::size_t kMostSceneNotes = 20;  ///< later ones are only counted

/// A complete scene: checked, and independent of the text.
struct SceneDescription {
  SceneView view;
  Vec3 background{0, 0, 0};  ///< 0..1 each
  std::vector<PointLight> point_lights;
  std::vector<AreaLight> area_lights;
  std::vector<SceneMaterial> materials;  ///< 1..kMostSceneMaterials, those in use, in order of first use
  std::optional<EnvironmentMap> environment;
  std::optional<AmbientOcclusion> ambient_occlusion;
  std::uint32_t samples_per_pixel = 1;                     ///< 1, 4 or 16
  std::uint32_t recursion_depth = kDefaultRecursionDepth;  ///< of a path of rays; the eye ray is of depth 1: 1..8
  bool shadows = true;
  ColorLevels levels = ColorLevels::kLinear;
  SceneGeometry geometry;  ///< at least one triangle

  float tolerance = 0.0f;  ///< world units: no facet is farther than this, or than its object's in roundness, from the
                           ///< sphere or cone that it stands for
  SceneRoundness roundness;
  SceneCounts counts;
  std::vector<std::filesystem::path> files;  ///< that the text names: meshes, faces
  std::vector<SceneNote> notes;              ///< at most kMostSceneNotes
  std::uint64_t note_count = 0;
};

}  // namespace gridiron::tool
