// Mirror and glass: directions of reflected and refracted rays, and how much of the light goes either way.
// Source: core/EFFECTS.md, "Reflection and refraction". Memory: values. Threads: any.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/effect_records.h>
#include <gridiron/base/lanes.h>
#include <gridiron/shade/vectors.h>

namespace gridiron {

/// Reflects `direction` about a normal. Both are unit to rounding; so is the result.
[[nodiscard]] inline Vector3 reflect(Vector3 direction, Vector3 normal) {
  return direction - (2.0f * dot(direction, normal)) * normal;
}

/// reflect about the shading normal, or about the face's normal if that would lead beneath the face.
/// @param direction  unit. @param face  the face's normal on the side that the ray comes from.
[[nodiscard]] inline Vector3 reflect_off(Vector3 direction, Vector3 shading, Vector3 face) {
  const Vector3 about_shading = reflect(direction, shading);
  return dot(about_shading, face) > 0.0f ? about_shading : reflect(direction, face);
}

/// e of the formulas. @param index  of the inside to the outside, 0.1..10.
[[nodiscard]] inline float refraction_ratio(float index, bool enters) {
  return enters ? 1.0f / index : index;
}

struct Refraction {
  Vector3 direction;  ///< unit to rounding; meaningless, but finite, where is_total
  float fresnel;      ///< share thrown back, [0, 1]; 1 where is_total
  bool is_total;      ///< nothing goes through
};

/// Snell's law and Fresnel's share of unpolarised light.
///
/// @param direction  unit to rounding. @param normal  likewise, against the direction: if rounding makes dot(direction,
///                   normal) positive, the ray counts as grazing, c = 0.
/// @param ratio      refraction_ratio, 0.1..10.
/// No result is NaN: if c and f are both 0 (a grazing ray and no refraction) the share is 1, as for all grazing rays.
[[nodiscard]] inline Refraction refract(Vector3 direction, Vector3 normal, float ratio) {
  const float against = -dot(direction, normal);
  const float c = against > 0.0f ? against : 0.0f;
  const float k = 1.0f - ratio * ratio * (1.0f - c * c);
  const bool is_total = k < 0.0f;
  const float f = square_root(is_total ? 0.0f : k);
  const float ec = ratio * c, ef = ratio * f;
  // Numerators are no larger than denominators, rounded or not, as nothing here is below 0.
  const bool has_share = ec + f > 0.0f;
  const float rs = (ec - f) / (has_share ? ec + f : 1.0f);
  const float rp = (c - ef) / (has_share ? c + ef : 1.0f);
  const float share = (rs * rs + rp * rp) * 0.5f;
  return {ratio * direction + (ec - f) * normal, is_total || !has_share ? 1.0f : share, is_total};
}

/// refract about the shading normal, or about the face's normal if that would not lead through the face.
[[nodiscard]] inline Refraction refract_through(Vector3 direction, Vector3 shading, Vector3 face, float ratio) {
  const Refraction about_shading = refract(direction, shading, ratio);
  if (about_shading.is_total || dot(about_shading.direction, face) < 0.0f) return about_shading;
  return refract(direction, face, ratio);
}

/// R: the factor on a reflected ray's weight. @param fresnel  1 if the material is opaque.
[[nodiscard]] inline float reflected_share(const MaterialRecord& material, float fresnel) {
  return material.specular + material.transmittance * fresnel;
}
/// Q: the factor on a refracted ray's weight, RGB.
[[nodiscard]] inline Vector3 refracted_share(const MaterialRecord& material, float fresnel) {
  return (1.0f - fresnel) * vector_of(material.transmitted);
}

}  // namespace gridiron
