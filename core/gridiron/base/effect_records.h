// Effects in main memory: what a scene calls for, its lights, materials, surfaces, normals and environment.
// core/SPEC.md has the layout, core/EFFECTS.md the meaning.
// Memory: described, not owned. Threads: read-only during a frame. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace gridiron {

/// Effects, as bits of a set. Plain light of point lights, without shadows, is no effect.
enum EffectBits : unsigned {
  kPointShadows = 1u << 0,
  kAreaLights = 1u << 1,  ///< sampled, with shadows or without
  kReflection = 1u << 2,
  kRefraction = 1u << 3,
  kAmbientOcclusion = 1u << 4,
  kEnvironment = 1u << 5,
  kSmoothNormals = 1u << 6,
  kHighlights = 1u << 7,  ///< Blinn-Phong
  kMultisampling = 1u << 8,
  kSceneShading = 1u << 9,  ///< light of point lights and the background; every scene with effects has it
  kVertexColors = 1u << 10,  ///< interpolated between a triangle's corners
};
inline constexpr std::uint32_t kEffectCount = 11;  ///< bits of EffectBits
inline constexpr std::uint32_t kAllEffects = (1u << kEffectCount) - 1u;  ///< the set of all effects

inline constexpr std::uint32_t kMaxMaterials = 65535;      ///< of a scene
inline constexpr std::uint32_t kMaxLights = 256;           ///< point and area lights together
inline constexpr std::uint32_t kMaxEffectSamples = 64;     ///< of an area light, of ambient occlusion
inline constexpr std::uint32_t kMaxRecursionDepth = 8;     ///< the eye ray is of depth 1
inline constexpr std::uint32_t kMaxEnvironmentWidth = 1024;  ///< texels of a face's edge
inline constexpr float kAmbientLight = 0.5f;               ///< what ambient occlusion darkens; core/EFFECTS.md
inline constexpr float kMaxLightColor = 1e6f;              ///< of each channel

/// How brightness 0..1 becomes the levels 0..255 of a pixel.
enum class ColorLevels : unsigned {
  kLinear = 0,  ///< in proportion
  kSrgb = 1,    ///< by the curve of IEC 61966-2-1, as screens expect it
};

/// Settings of a scene with effects; an image has one. 128 bytes.
struct EffectsRecord {
  std::uint32_t called_for;          ///< EffectBits
  std::uint32_t material_count;      ///< 1..kMaxMaterials
  std::uint32_t light_count;         ///< 0..kMaxLights, point lights first
  std::uint32_t point_light_count;   ///< of these
  std::uint32_t recursion_depth;     ///< 1..kMaxRecursionDepth
  std::uint32_t samples_per_pixel;   ///< 1, 4, 16
  std::uint32_t occlusion_samples;   ///< 0: no ambient occlusion; ..kMaxEffectSamples
  float occlusion_radius;            ///< above 0 if there are samples
  float background[3];               ///< 0..1
  std::uint32_t has_shadows;         ///< 0, 1
  std::uint32_t environment_width;   ///< texels of a face's edge, 0: no environment; ..kMaxEnvironmentWidth
  std::uint32_t smooth_triangle_count;  ///< records of the kNormals section
  // Where the sections lie, from the image's first byte. 0 where a section is empty.
  std::uint64_t materials_offset_bytes;    ///< MaterialRecord[material_count]
  std::uint64_t lights_offset_bytes;       ///< LightRecord[light_count]
  std::uint64_t surfaces_offset_bytes;     ///< SurfaceRecord[triangle_count], by triangle_id
  std::uint64_t normals_offset_bytes;      ///< NormalRecord[smooth_triangle_count]
  std::uint64_t environment_offset_bytes;  ///< EnvironmentBlock[6 * blocks * blocks], face, row, column
  std::uint32_t levels;                    ///< ColorLevels
  std::uint32_t reserved[7];
};
static_assert(sizeof(EffectsRecord) == 128);

/// What a surface does with light. diffuse and transmitted already include the shares: see core/EFFECTS.md.
struct MaterialRecord {
  float diffuse[3];      ///< kd times colour, 0..1
  float specular;        ///< ks, 0..1; of highlight and mirror
  float transmitted[3];  ///< T times colour, 0..1
  float transmittance;   ///< T, 0..1
  float shine;           ///< exponent of the highlight, 0: none; ..1e5
  float index;           ///< of refraction, of the inside to the outside; 0.1..10
  std::uint32_t is_smooth;  ///< 0, 1: triangles have normals
  std::uint32_t has_colors; ///< 0, 1: and colours at their corners; only where is_smooth is 1
};
static_assert(sizeof(MaterialRecord) == 48);

/// A point light (samples = 0) or an area light, corner + a edge_u + b edge_v.
struct LightRecord {
  float corner[3];          ///< where it is, or begins
  std::uint32_t samples;    ///< 0: a point; 1..kMaxEffectSamples
  float color[3];           ///< 0..kMaxLightColor; for an area light the colour of one sample
  std::uint32_t is_near;    ///< 0, 1; shadow rays run from the light: it is about as near to 0 as the scene is
  float edge_u[3];          ///< of an area light
  std::uint32_t reserved0;
  float edge_v[3];          ///< of an area light
  std::uint32_t reserved1;
};
static_assert(sizeof(LightRecord) == 64);

/// A point light is near where its largest coordinate is at most this times that of the scene.
inline constexpr float kNearLightFactor = 4.0f;

/// A triangle as shading needs it. Its vertices equal those of the grid's triangles: moved ones with lattice triangles.
struct SurfaceRecord {
  float v[3][3];               ///< corner, axis
  std::uint32_t material;      ///< index
  std::uint32_t normals;       ///< index in the kNormals section, or kNoNormals for a flat triangle
  std::uint32_t tree_place;    ///< index of its record in the kTreeTriangles section; kNoTriangle if it was dropped
};
static_assert(sizeof(SurfaceRecord) == 48);
inline constexpr std::uint32_t kNoNormals = 0xFFFFFFFFu;  ///< for a flat triangle

/// A linear colour as a word: of each channel the root, in steps of 1 / kColorSteps. Red lies in bits 0..9, green in
/// 10..19, blue in 20..29; the others are 0. Roots have steps about as fine for the eye in the dark as in the light.
using PackedColor = std::uint32_t;
inline constexpr std::uint32_t kColorSteps = 1023;  ///< of a channel from 0 to 1
inline constexpr std::uint32_t kColorBits = 10;     ///< of a channel

/// Normals at a triangle's corners, of length 1 to 2^-10, outwards, and the corners' colours.
struct NormalRecord {
  float n[3][3];          ///< corner, axis
  PackedColor colors[3];  ///< of each corner; 0 unless the material has_colors
};
static_assert(sizeof(NormalRecord) == 48);

/// 8 x 8 texels of a face; 7 x 7 of them are the first corner of a bilinear patch. Block (i, j) holds columns 7 i..7 i
/// + 7 and rows 7 j..7 j + 7. Columns and rows beyond the face repeat its last. 768 bytes.
struct EnvironmentBlock {
  float texels[8][8][3];  ///< row, column; finite, >= 0
};
static_assert(sizeof(EnvironmentBlock) == 768);
inline constexpr std::uint32_t kEnvironmentPatches = 7;  ///< along a block's edge

/// Blocks along a face's edge: patches begin at texels 0..width - 2; a face of one texel has one block.
[[nodiscard]] constexpr std::uint32_t environment_blocks(std::uint32_t width) {
  return width <= 2 ? std::uint32_t{1} : (width - 2) / kEnvironmentPatches + 1;
}

/// A ray that waits in a queue of the local store or in main memory.
struct QueuedRay {
  float origin[3];         ///< world space
  float dir[3];            ///< unit to rounding
  float weight[3];         ///< factor on the light that it adds, RGB
  std::uint32_t pixel;     ///< row-major index in its tile | depth << 16
  std::uint32_t path;      ///< core/EFFECTS.md
  std::uint32_t own;       ///< a triangle that it surely does not hit, kNoTriangle: there is none
};
static_assert(sizeof(QueuedRay) == 48);

/// Rays are traced in waves, the deepest first. No layout has longer waves than this.
inline constexpr std::uint32_t kMostWaveRays = 256;

inline constexpr std::uint32_t kMostEffectTilePixels = 1024;  ///< of a layout with effects

/// Rays that can wait at once on a core: two for each pixel of a tile, of depth 2, and for each further depth two for
/// each ray of a wave. The queue is a stack: if a wave leaves pushed rays below, the next wave consists only of rays
/// that it pushed itself, all of them deeper than its least deep one. So at most one wave of each depth has rays left.
[[nodiscard]] constexpr std::uint32_t most_waiting_rays(std::uint32_t recursion_depth) {
  return recursion_depth <= 1 ? std::uint32_t{0}
                              : 2 * kMostEffectTilePixels + 2 * kMostWaveRays * (recursion_depth - 2);
}

/// Bytes of main memory that each core needs for the rays that do not fit its local store. The region begins at a
/// multiple of kSpillAlignment, so that the transfers of all cores are split alike.
[[nodiscard]] constexpr std::uint64_t spill_bytes(std::uint32_t recursion_depth) {
  return (std::uint64_t{most_waiting_rays(recursion_depth)} * sizeof(QueuedRay) + 4095) / 4096 * 4096;
}
inline constexpr std::uint32_t kSpillAlignment = 4096;  ///< bytes

}  // namespace gridiron
