// Scenes that cast one kind of secondary rays, and closed solids whose rays have known answers.
// Memory: owns the scenes. Threads: any, no shared state. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/effect_records.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "experiment/effect_scenes.h"
#include "experiment/views.h"

namespace gridiron::experiment {

/// Kinds of secondary rays.
enum class RayKind : std::uint8_t { kShadow, kArea, kOcclusion, kReflection, kRefraction };

struct NamedRayKind {
  RayKind kind;
  const char* key;
  const char* title;   ///< for people
  EffectBits effect;   ///< that casts them
  bool wants_any_hit;  ///< whether the question is if there is a hit, not which is the nearest
};
/// All kinds, in the order of their numbers.
inline constexpr NamedRayKind kRayKinds[] = {
    {RayKind::kShadow, "shadow", "point light", kPointShadows, true},
    {RayKind::kArea, "area", "area light", kAreaLights, true},
    {RayKind::kOcclusion, "occlusion", "ambient occlusion", kAmbientOcclusion, true},
    {RayKind::kReflection, "reflection", "reflection", kReflection, false},
    {RayKind::kRefraction, "refraction", "refraction", kRefraction, false},
};
[[nodiscard]] constexpr const NamedRayKind& named(RayKind kind) {
  return kRayKinds[static_cast<std::uint32_t>(kind)];
}

/// @returns the scene with one sample a pixel and matt materials, changed to cast no secondary rays but of one kind;
/// refraction: those of glass, which reflects too. Nothing: none at all.
///
/// Shadows are those of the scene's lights, or of one light beside the eye. Area lights stand where the points are.
/// Mirrors and glass are all materials but the first, which is the floor; a single one is all of it.
[[nodiscard]] EffectScene with_rays_of(EffectScene scene, std::optional<RayKind> kind);

/// @returns the mesh of a view as a scene of one material. Precondition: the view has a camera's eye and point.
[[nodiscard]] EffectScene scene_of_view(const View& view);

/// A closed solid. Of each of its rays it is known whether it hits anything, whatever an engine says.
struct Solid {
  EffectScene scene;
  /// The eye and all surfaces are inside, lights outside: every ray hits something. If not, the solid is convex, and
  /// seen by an eye on the side of the light: only rays refracted into it hit anything, and all of these do.
  bool is_room = true;
};

/// @returns a room and a body, each at the origin and a thousand radii away from it. They cast rays of one kind;
/// refracted rays of a body end at their first hit.
[[nodiscard]] std::vector<Solid> make_solids(RayKind kind);

}  // namespace gridiron::experiment
