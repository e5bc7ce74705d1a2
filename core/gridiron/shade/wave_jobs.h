// Jobs of a wave: the rays that its hits send to lights and into the open, and the light that their answers add.
// Source: core/EFFECTS.md. Memory: the local store. Threads: one core. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/effect_records.h>
#include <gridiron/base/lanes.h>
#include <gridiron/base/math.h>
#include <gridiron/base/work_counters.h>
#include <gridiron/ray/ray_batch.h>
#include <gridiron/shade/color_sums.h>
#include <gridiron/shade/effect_store.h>
#include <gridiron/shade/elementary.h>
#include <gridiron/shade/sample_points.h>
#include <gridiron/shade/vectors.h>

#include <cstdint>

namespace gridiron {

/// Adds a ray to a batch. @param own  as in no_hit().
GRIDIRON_INLINE void add_ray(RayBatch& batch, Vector3 origin, Vector3 dir, float t, std::uint32_t own,
                             std::uint32_t owner) {
  BatchRay& ray = batch.rays[batch.count];
  store(origin, ray.origin);
  ray.t = t;
  store(dir, ray.dir);
  ray.id = no_hit(own);
  batch.owners[batch.count] = owner;
  ++batch.count;
}

/// @returns `triangle` where a line between the point lifted off it and one in the direction of `along` is surely on
/// the side of its face: it begins or ends at least 2 E above the plane (ray/secondary_origin.h), which rounding of the
/// direction shortens by less than sqrt(3) E, and rises with a slope far above the face's error of 2^-14. Else
/// kNoTriangle.
GRIDIRON_INLINE std::uint32_t own_triangle(std::uint32_t triangle, Vector3 along, Vector3 face) {
  const float xy = magnitude(along.x) > magnitude(along.y) ? magnitude(along.x) : magnitude(along.y);
  const float size = magnitude(along.z) > xy ? magnitude(along.z) : xy;
  return dot(along, face) > 0x1p-10f * size ? triangle : std::uint32_t{kNoTriangle};
}

/// Shared by the jobs: the hits of the wave and the pixels' sums.
///
/// @tparam Store  LocalStore of a layout with effects.
template <class Store>
struct WaveContext {
  Store& store;
  std::uint32_t point_count;  ///< hits, the first items of the wave
  std::uint32_t sample;       ///< of the pixels
  std::uint32_t left, top;    ///< of the tile, in pixels

  [[nodiscard]] const WavePoint& point(std::uint32_t i) const { return store.wave.items[i].point; }

  /// Adds a colour to a pixel's sum. @param pixel  as in QueuedRay.
  void add_color(std::uint32_t pixel, Vector3 color) const {
    store.work.add(Work::kColorAdded);
    store.work.charge_to(Work::kColorAdded);
    const std::uint32_t index = pixel & 0xFFFFu;
    add_steps(store.effects.sums[0][index], sum_steps(color.x));
    add_steps(store.effects.sums[1][index], sum_steps(color.y));
    add_steps(store.effects.sums[2][index], sum_steps(color.z));
  }

  /// Puts the seed of a point's jitter in the place of its path.
  void set_seed(WavePoint& point) const {
    store.work.add(Work::kJitterSeed);
    store.work.charge_to(Work::kJitterSeed);
    static constexpr std::uint32_t kWidth = Store::Layout::kTileWidth;
    const std::uint32_t index = point.pixel & 0xFFFFu;
    const std::uint32_t pixel = (top + index / kWidth) * store.frame.width + left + index % kWidth;
    point.path = sample_seed(point.path, sample, pixel);
  }
};

/// Rays to the lights in the local store. @tparam Built  EffectBits that the code is compiled for.
template <class Store, std::uint32_t Built>
class LightJobs {
 public:
  /// @param light_count  of store.effects.lights. @param first_light  the scene's index of the first of them.
  LightJobs(const WaveContext<Store>& context, std::uint32_t first_light, std::uint32_t light_count)
      : context_(context), first_light_(first_light), light_count_(light_count) {}

  /// The next rays of up to 16 neighbouring hits to one place. @returns whether there may be more.
  [[nodiscard]] GRIDIRON_OUTLINE bool next(RayBatch& batch) {
    context_.store.work.charge_to(Work::kShadowRay);
    const std::uint32_t before = batch.count;
    while (light_ < light_count_) {
      const std::uint32_t index = light_;
      const LightRecord& light = context_.store.effects.lights[index];
      const bool from_light = light.samples == 0 && light.is_near != 0;
      const std::uint32_t first = first_point_, sample = sample_;
      step(light);
      if constexpr (kPartsLights) ends_batch_ = from_light && light_ != index;
      std::uint32_t end = first + kJobRays;
      if (end > context_.point_count) end = context_.point_count;
      if (light.samples != 0) context_.store.work.charge_to(Work::kAreaPlace);
      for (std::uint32_t i = first; i < end; ++i) {
        const WavePoint& point = context_.point(i);
        const Vector3 from = vector_of(point.point);  // first, whatever the compiler
        const Vector3 to_light = place_of(index, sample, point) - from;
        const bool is_lit =
            dot(to_light, vector_of(point.face)) > 0.0f && dot(to_light, vector_of(point.shading)) > 0.0f;
        if (!is_lit) continue;
        context_.store.work.add(Work::kShadowRay);
        const std::uint32_t owner = i | index << kLightShift;
        const std::uint32_t own = own_triangle(point.triangle, to_light, vector_of(point.face));
        if (from_light) {
          add_ray(batch, vector_of(light.corner), -to_light, 1.0f, own, owner);
        } else {
          add_ray(batch, vector_of(point.point), to_light, 1.0f, own, owner);
        }
      }
      if (batch.count != before) return true;
      if constexpr (kPartsLights) {
        if (ends_batch_ && before != 0) return light_ < light_count_;
      }
    }
    return false;
  }

  /// Whether the next rays are better traced apart: rays of one origin, as those from a light, take less work.
  [[nodiscard]] bool ends_batch() const { return ends_batch_; }

  void finish(const RayBatch& batch) {
    for (std::uint32_t i = 0; i < batch.count; ++i) {
      context_.store.work.charge_to(Work::kShadowRay);
      const BatchRay& ray = batch.rays[i];
      if (ray.has_hit()) continue;
      const std::uint32_t owner = batch.owners[i];
      const LightRecord& light = context_.store.effects.lights[owner >> kLightShift];
      const bool from_light = light.samples == 0 && light.is_near != 0;
      const Vector3 dir = vector_of(ray.dir);
      light_point(light, context_.point(owner & (kMostWaveRays - 1)), from_light ? -dir : dir);
    }
  }

  /// The same without shadows.
  void light_all() {
    while (light_ < light_count_) {
      const std::uint32_t index = light_;
      const LightRecord& light = context_.store.effects.lights[index];
      const std::uint32_t first = first_point_, sample = sample_;
      step(light);
      std::uint32_t end = first + kJobRays;
      if (end > context_.point_count) end = context_.point_count;
      for (std::uint32_t i = first; i < end; ++i) {
        context_.store.work.charge_to(Work::kLightSample);
        const WavePoint& point = context_.point(i);
        const Vector3 to_light = place_of(index, sample, point) - vector_of(point.point);
        if (dot(to_light, vector_of(point.face)) > 0.0f) light_point(light, point, to_light);
      }
    }
  }

 private:
  static constexpr bool kPartsLights = requires { requires Store::Layout::kHasBeams; };
  static constexpr std::uint32_t kLightShift = 16;  // of a ray's owner: the light above its hit
  static_assert(kMostWaveRays <= 1u << kLightShift && (kMostWaveRays & (kMostWaveRays - 1)) == 0);

  // Hits first, then samples, then lights.
  void step(const LightRecord& light) {
    first_point_ += kJobRays;
    if (first_point_ < context_.point_count) return;
    first_point_ = 0;
    ++sample_;
    if (sample_ < light.samples) return;
    sample_ = 0;
    ++light_;
  }

  [[nodiscard]] Vector3 place_of(std::uint32_t index, std::uint32_t sample, const WavePoint& point) const {
    const LightRecord& light = context_.store.effects.lights[index];
    const Vector3 corner = vector_of(light.corner);
    if constexpr ((Built & kAreaLights) != 0) {
      if (light.samples != 0) {
        context_.store.work.add(Work::kAreaPlace);
        const Jitter jitter = jitter_of(point.path, area_light_purpose(first_light_ + index));
        const SquarePlace place = area_light_place(sample, light.samples, jitter);
        return corner + (place.a * vector_of(light.edge_u) + place.b * vector_of(light.edge_v));
      }
    }
    return corner;
  }

  // Adds the light that reaches a hit.
  GRIDIRON_OUTLINE void light_point(const LightRecord& light, const WavePoint& point, Vector3 to_light) {
    WorkCounters& work = context_.store.work;
    work.charge_to(Work::kLightSample);
    const Vector3 shading = vector_of(point.shading);
    const Vector3 along = normalized(to_light);
    const float cosine = dot(shading, along);
    if (!(cosine > 0.0f)) return;
    work.add(Work::kLightSample);
    Vector3 share = cosine * vector_of(point.lit.diffuse);
    if constexpr ((Built & kHighlights) != 0) {
      if (point.lit.shine > 0.0f) {
        work.add(Work::kHighlight);
        const float towards = dot(shading, normalized(along + vector_of(point.view)));
        share = share + power(towards > 0.0f ? towards : 0.0f, point.lit.shine) * vector_of(point.lit.specular);
        work.charge_to(Work::kLightSample);
      }
    }
    context_.add_color(point.pixel, vector_of(light.color) * share);
  }

  const WaveContext<Store>& context_;
  std::uint32_t first_light_, light_count_;
  std::uint32_t light_ = 0, sample_ = 0, first_point_ = 0;
  bool ends_batch_ = false;
};

/// Rays into the open, for ambient light.
template <class Store>
class OcclusionJobs {
 public:
  explicit OcclusionJobs(const WaveContext<Store>& context) : context_(context) {}

  [[nodiscard]] GRIDIRON_OUTLINE bool next(RayBatch& batch) {
    context_.store.work.charge_to(Work::kOcclusionRay);
    const EffectsRecord& scene = context_.store.effects.scene;
    const std::uint32_t before = batch.count;
    while (first_point_ < context_.point_count) {
      const std::uint32_t first = first_point_, sample = sample_;
      if (++sample_ == scene.occlusion_samples) {
        sample_ = 0;
        first_point_ += kJobRays;
      }
      std::uint32_t end = first + kJobRays;
      if (end > context_.point_count) end = context_.point_count;
      for (std::uint32_t i = first; i < end; ++i) {
        const WavePoint& point = context_.point(i);
        const Jitter jitter = jitter_of(point.path, kOcclusionPurpose);
        const Vector3 dir = occlusion_direction(sample, scene.occlusion_samples, jitter, vector_of(point.shading));
        if (!(dot(dir, vector_of(point.face)) > 0.0f)) continue;
        context_.store.work.add(Work::kOcclusionRay);
        const std::uint32_t own = own_triangle(point.triangle, dir, vector_of(point.face));
        add_ray(batch, vector_of(point.point), scene.occlusion_radius * dir, 1.0f, own, i);
      }
      if (batch.count != before) return true;
    }
    return false;
  }

  void finish(const RayBatch& batch) {
    const auto samples = static_cast<std::int32_t>(context_.store.effects.scene.occlusion_samples);
    const float share = kAmbientLight / static_cast<float>(samples);
    for (std::uint32_t i = 0; i < batch.count; ++i) {
      context_.store.work.charge_to(Work::kOcclusionRay);
      if (batch.rays[i].has_hit()) continue;
      const WavePoint& point = context_.point(batch.owners[i]);
      context_.add_color(point.pixel, share * vector_of(point.lit.diffuse));
    }
  }

 private:
  const WaveContext<Store>& context_;
  std::uint32_t sample_ = 0, first_point_ = 0;
};

/// The rays of a wave, neighbours together; their hits go to the wave's ids.
template <class Store>
class WaveRayJobs {
 public:
  WaveRayJobs(Store& store, std::uint32_t ray_count, float t_far)
      : store_(store), ray_count_(ray_count), t_far_(t_far) {}

  [[nodiscard]] GRIDIRON_OUTLINE bool next(RayBatch& batch) {
    store_.work.charge_to(Work::kWaveRay);
    std::uint32_t end = first_ + kJobRays;
    if (end > ray_count_) end = ray_count_;
    if (first_ == end) return false;
    for (; first_ < end; ++first_) {
      const QueuedRay& ray = store_.wave.items[first_].ray;
      add_ray(batch, vector_of(ray.origin), vector_of(ray.dir), t_far_, ray.own, first_);
    }
    return true;
  }

  void finish(const RayBatch& batch) {
    store_.work.charge_to(Work::kWaveRay);
    for (std::uint32_t i = 0; i < batch.count; ++i) {
      const BatchRay& ray = batch.rays[i];
      store_.wave.ids[batch.owners[i]] = ray.has_hit() ? ray.id : std::uint32_t{kNoTriangle};
    }
  }

 private:
  Store& store_;
  std::uint32_t ray_count_;
  float t_far_;
  std::uint32_t first_ = 0;
};

}  // namespace gridiron
