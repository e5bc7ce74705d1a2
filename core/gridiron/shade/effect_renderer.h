// Effect renderer: shades a tile's eye rays and traces their secondary rays. Hits and the rays they cast are handled in
// waves, the deepest first; a wave fetches the surfaces it hit, lights them, and puts reflected and refracted rays into
// a queue.
// Source: core/EFFECTS.md. Memory: the local store; main memory for rays that wait. Threads: one core.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/accuracies.h>
#include <gridiron/base/effect_records.h>
#include <gridiron/base/lanes.h>
#include <gridiron/base/math.h>
#include <gridiron/base/records.h>
#include <gridiron/base/stages.h>
#include <gridiron/dma/record_gather.h>
#include <gridiron/dma/transfers.h>
#include <gridiron/engine/engine.h>
#include <gridiron/platform/contract.h>
#include <gridiron/ray/hits.h>
#include <gridiron/ray/secondary_origin.h>
#include <gridiron/ray/z_curve.h>
#include <gridiron/shade/color_sums.h>
#include <gridiron/shade/environment.h>
#include <gridiron/shade/optics.h>
#include <gridiron/shade/ray_queue.h>
#include <gridiron/shade/sample_points.h>
#include <gridiron/shade/vectors.h>
#include <gridiron/shade/wave_jobs.h>

#include <cstdint>

namespace gridiron {

/// @returns kOk; kMissingEffect if an effect called for is not built; kBadFrame if there is no such effect.
[[nodiscard]] constexpr Status check_effects_built(std::uint32_t called_for, std::uint32_t built) {
  const std::uint32_t missing = called_for & ~built;
  if (missing == 0) return Status::kOk;
  return (missing & kAllEffects) != 0 ? Status::kMissingEffect : Status::kBadFrame;
}

/// Effects of one frame on one core. Layout::kEffects are those that are built; a scene uses those that it needs.
template <class L, class Store, Platform P>
class EffectRenderer {
 public:
  using Layout = typename Store::Layout;

  EffectRenderer(Store& store, Transfers<P>& transfers, SpillRegion spill)
      : store_(store),
        transfers_(transfers),
        rays_(store, transfers),
        spill_(spill),
        queue_(store.effects, transfers, spill.address) {}

  /// Fetches what all tiles need. Errors: kMissingEffect, kSpillTooSmall, of the engine of rays, of transfers.
  [[nodiscard]] Status begin_frame() {
    GRIDIRON_TRY(rays_.begin());
    GRIDIRON_TRY(get_now(&scene(), MainAddress{store_.frame.effects_address}, sizeof(EffectsRecord)));
    GRIDIRON_TRY(check_effects_built(scene().called_for, kBuilt));
    if (scene().recursion_depth > 1 && calls_for(kReflection | kRefraction) &&
        (spill_.bytes < spill_bytes(scene().recursion_depth) || spill_.address.value % kSpillAlignment != 0)) {
      return Status::kSpillTooSmall;
    }
    // Materials that fit stay. A longer list is fetched one by one, and discarded at every tile.
    for (std::uint32_t& index : store_.effects.material_of_slot) index = Effects::kNoMaterial;
    has_all_materials_ = scene().material_count <= Effects::kMaterialSlots;
    if (has_all_materials_) {
      GRIDIRON_TRY(get_now(store_.effects.materials, section(scene().materials_offset_bytes),
                           scene().material_count * static_cast<std::uint32_t>(sizeof(MaterialRecord))));
      for (std::uint32_t i = 0; i < scene().material_count; ++i) store_.effects.material_of_slot[i] = i;
    }
    // The rounding of lights' positions adds to the lift of points that rays from lights end at, see surface_point.
    least_size_ = 0.0f;
    for (std::uint32_t first = 0; first < scene().light_count; first += Effects::kLightSlots) {
      GRIDIRON_TRY(load_lights(first));
      for (std::uint32_t i = 0; i < lights_at_hand(first); ++i) {
        const LightRecord& light = store_.effects.lights[i];
        if (light.samples != 0 || light.is_near == 0 || !has_shadows()) continue;
        for (const float coordinate : light.corner) {
          least_size_ = magnitude(coordinate) > least_size_ ? magnitude(coordinate) : least_size_;
        }
      }
    }
    return Status::kOk;
  }

  [[nodiscard]] std::uint32_t samples_per_pixel() const {
    if constexpr (has(kMultisampling)) return scene().samples_per_pixel;
    return 1;
  }

  void begin_tile(std::uint32_t left, std::uint32_t top) {
    left_ = left;
    top_ = top;
    store_.work.charge_to(Work::kColorGroup);
    for (auto& sums : store_.effects.sums) fill_words(sums, std::uint32_t{0});
    // So that a tile fetches the same whatever its core did before.
    if (scene().light_count > Effects::kLightSlots) store_.effects.first_light = Effects::kNoLight;
    if (has_all_materials_) return;
    for (std::uint32_t& index : store_.effects.material_of_slot) index = Effects::kNoMaterial;
  }

  /// Shades the hits of the eye rays of one sample of the tile.
  /// @param ids  a plane of the tile; written here if the engine has no code for eye rays.
  [[nodiscard]] Status shade_sample(std::uint32_t sample, std::uint32_t* ids) {
    const FrameHead& frame = store_.frame;
    const PixelOffset offset = pixel_offset(samples_per_pixel(), sample);
    static constexpr std::uint32_t kPixels = Store::kTilePixels, kSquareWidth = 4,
                                   kSquarePixels = kSquareWidth * kSquareWidth;
    rays_.begin_rays();
    std::uint32_t place = 0;  // along a Z curve of squares, so that neighbours go together
    while (place < kPixels) {
      store_.work.charge_to(Work::kWaveRay);
      std::uint32_t count = 0;
      for (; place < kPixels && count < Layout::kWaveRays; ++place) {
        const std::uint32_t square = place / kSquarePixels, rest = place % kSquarePixels;
        const std::uint32_t x = z_curve_column(square) * kSquareWidth + rest % kSquareWidth;
        const std::uint32_t y = z_curve_row(square) * kSquareWidth + rest / kSquareWidth;
        if (left_ + x >= frame.width || top_ + y >= frame.height) continue;
        QueuedRay& ray = store_.wave.items[count].ray;
        const float column = static_cast<float>(static_cast<std::int32_t>(left_ + x)) + offset.dx;
        const float row = static_cast<float>(static_cast<std::int32_t>(top_ + y)) + offset.dy;
        for (int axis = 0; axis < 3; ++axis) {
          ray.origin[axis] = frame.eye[axis];
          ray.dir[axis] = pixel_direction(frame, axis, column, row);
          ray.weight[axis] = 1.0f;
        }
        ray.pixel = (y * Layout::kTileWidth + x) | 1u << 16;
        ray.path = 1;
        ray.own = kNoTriangle;
        if constexpr (kTracesEyes<Layout>) {
          store_.wave.ids[count] = ids[y * Layout::kTileWidth + x];
        }
        ++count;
      }
      if constexpr (!kTracesEyes<Layout>) GRIDIRON_TRY(trace_eye_rays(count, ids));
      GRIDIRON_TRY(finish_wave(count, sample));
    }
    // Only now, so that waves are full.
    return empty_queue(sample);
  }

  /// Turns the sums into pixels.
  void finish_tile(std::uint32_t* color) {
    transfers_.note_stage(Stage::kOutput);
    static constexpr std::uint32_t kPixels = Store::kTilePixels;
    const float steps = kSumSteps * static_cast<float>(static_cast<std::int32_t>(samples_per_pixel()));
    const float per_step = 1.0f / steps;
    if (scene().levels == static_cast<std::uint32_t>(ColorLevels::kSrgb)) put_on_curve(steps);
    store_.work.add(Work::kColorGroup, kPixels / 4);
    store_.work.charge_to(Work::kColorGroup);
    for (std::uint32_t i = 0; i < kPixels; ++i) {
      const std::uint32_t red = level_of(brightness_of(store_.effects.sums[0][i], per_step));
      const std::uint32_t green = level_of(brightness_of(store_.effects.sums[1][i], per_step));
      const std::uint32_t blue = level_of(brightness_of(store_.effects.sums[2][i], per_step));
      color[i] = red | green << 8 | blue << 16 | 0xFF000000u;
    }
    transfers_.note_stage(Stage::kPrimary);
  }

 private:
  static_assert(Layout::RayEngine::template kMaxDepth<Layout> <= kTriangleTagCount, "each record gathered has a tag");
  static_assert(kIdleBufferBytes >= sizeof(EnvironmentBlock) + kPortableGranuleBytes, "the longest record gathered");
  using Effects = typename Store::Effects;
  using Context = WaveContext<Store>;
  static constexpr std::uint32_t kBuilt = Layout::kEffects;
  [[nodiscard]] static constexpr bool has(std::uint32_t effects) { return (kBuilt & effects) != 0; }
  [[nodiscard]] bool calls_for(std::uint32_t effects) const { return (scene().called_for & effects) != 0; }
  [[nodiscard]] bool has_shadows() const { return scene().has_shadows != 0; }

  [[nodiscard]] EffectsRecord& scene() { return store_.effects.scene; }
  [[nodiscard]] const EffectsRecord& scene() const { return store_.effects.scene; }
  [[nodiscard]] MainAddress section(std::uint64_t offset) const {
    return MainAddress{store_.frame.image_address + offset};
  }
  [[nodiscard]] RayQuestion question(bool any_hit, bool are_neighbors) const {
    return {any_hit, are_neighbors, store_.frame.accuracy == static_cast<std::uint32_t>(Accuracy::kFast),
            store_.frame.accuracy == static_cast<std::uint32_t>(Accuracy::kExact),
            section(scene().surfaces_offset_bytes)};
  }

  [[nodiscard]] Status get_now(void* local, MainAddress address, std::uint32_t bytes) {
    GRIDIRON_TRY(transfers_.get(local, address, bytes, kSetupTag));
    return transfers_.wait(kSetupTag);
  }

  [[nodiscard]] std::uint32_t lights_at_hand(std::uint32_t first) const {
    const std::uint32_t rest = scene().light_count - first;
    return rest < Effects::kLightSlots ? rest : Effects::kLightSlots;
  }
  [[nodiscard]] Status load_lights(std::uint32_t first) {
    store_.effects.first_light = first;
    return get_now(store_.effects.lights,
                   section(scene().lights_offset_bytes + std::uint64_t{first} * sizeof(LightRecord)),
                   lights_at_hand(first) * static_cast<std::uint32_t>(sizeof(LightRecord)));
  }

  // Makes a material available. Records and slots both lie at multiples of 48 bytes, so an odd index goes to an odd
  // slot.
  [[nodiscard]] Status find_material(std::uint32_t index, const MaterialRecord*& material) {
    const std::uint32_t slot = index % Effects::kMaterialSlots;
    material = store_.effects.materials + slot;
    if (store_.effects.material_of_slot[slot] == index) return Status::kOk;
    store_.effects.material_of_slot[slot] = index;
    return get_now(store_.effects.materials + slot,
                   section(scene().materials_offset_bytes + std::uint64_t{index} * sizeof(MaterialRecord)),
                   sizeof(MaterialRecord));
  }

  // Traces the rays that wait, wave by wave, and the rays that they cast.
  [[nodiscard]] Status empty_queue(std::uint32_t sample) {
    if constexpr (has(kReflection | kRefraction)) {
      while (!queue_.empty()) {
        transfers_.note_stage(Stage::kBounce);
        store_.work.charge_to(Work::kQueuedRay);
        std::uint32_t count = 0;
        GRIDIRON_TRY(
            queue_.pop_wave(count, [&](std::uint32_t i, const QueuedRay& ray) { store_.wave.items[i].ray = ray; }));
        WaveRayJobs<Store> jobs(store_, count, kFloatMax);
        GRIDIRON_TRY(rays_.trace(question(false, true), jobs));
        GRIDIRON_TRY(finish_wave(count, sample));
      }
    }
    transfers_.note_stage(Stage::kPrimary);
    return Status::kOk;
  }

  // Traces eye rays like all others, for engines without code for them.
  [[nodiscard]] Status trace_eye_rays(std::uint32_t ray_count, std::uint32_t* ids) {  // NOLINT: it is written to
    transfers_.note_stage(Stage::kPrimary);
    WaveRayJobs<Store> jobs(store_, ray_count, store_.frame.t_far);
    GRIDIRON_TRY(rays_.trace(question(false, true), jobs));
    store_.work.charge_to(Work::kWaveRay);
    for (std::uint32_t i = 0; i < ray_count; ++i) ids[store_.wave.items[i].ray.pixel & 0xFFFFu] = store_.wave.ids[i];
    return Status::kOk;
  }

  // Shades the rays of a wave once their hits are known.
  [[nodiscard]] GRIDIRON_OUTLINE Status finish_wave(std::uint32_t ray_count, std::uint32_t sample) {
    store_.work.add(Work::kWaveRay, ray_count);
    Context context{store_, 0, sample, left_, top_};
    GRIDIRON_TRY(shade_misses(ray_count, context));
    GRIDIRON_TRY(find_points(ray_count, context));
    if (context.point_count == 0) return Status::kOk;
    GRIDIRON_TRY(light_points(context));
    if constexpr (has(kAmbientOcclusion)) {
      if (calls_for(kAmbientOcclusion)) {
        transfers_.note_stage(Stage::kOcclusion);
        OcclusionJobs<Store> jobs(context);
        GRIDIRON_TRY(rays_.trace(question(true, false), jobs));
      }
    }
    return Status::kOk;
  }

  // Shades rays that leave the scene.
  [[nodiscard]] Status shade_misses(std::uint32_t ray_count, Context& context) {
    const auto add = [&](std::uint32_t i, Vector3 color) {
      store_.work.charge_to(Work::kColorAdded);
      const QueuedRay& ray = store_.wave.items[i].ray;
      context.add_color(ray.pixel, vector_of(ray.weight) * color);
    };
    if constexpr (has(kEnvironment)) {
      if (calls_for(kEnvironment)) {
        transfers_.note_stage(Stage::kEnvironment);
        const std::uint32_t width = scene().environment_width;
        const std::uint32_t blocks = environment_blocks(width);
        const auto place_of = [&](std::uint32_t i) {
          return environment_place(vector_of(store_.wave.items[i].ray.dir), width);
        };
        return gather_records(
            store_, transfers_, ray_count, sizeof(EnvironmentBlock),
            [&](std::uint32_t i) -> std::uint64_t {
              store_.work.charge_to(Work::kWaveRay);
              if (store_.wave.ids[i] != kNoTriangle) return 0;
              store_.work.charge_to(Work::kEnvironmentLookup);
              const std::uint32_t index = environment_block_index(place_of(i), blocks);
              return section(scene().environment_offset_bytes + std::uint64_t{index} * sizeof(EnvironmentBlock)).value;
            },
            [&](std::uint32_t i, const std::byte* record) {
              store_.work.add(Work::kEnvironmentLookup);
              store_.work.charge_to(Work::kEnvironmentLookup);
              add(i, lookup(*reinterpret_cast<const EnvironmentBlock*>(record), place_of(i)));
              return Status::kOk;
            });
      }
    }
    const Vector3 background = vector_of(scene().background);
    for (std::uint32_t i = 0; i < ray_count; ++i) {
      store_.work.charge_to(Work::kWaveRay);
      if (store_.wave.ids[i] == kNoTriangle) add(i, background);
    }
    return Status::kOk;
  }

  // Turns the rays that hit something into points, and makes the rays that leave these points.
  [[nodiscard]] Status find_points(std::uint32_t ray_count, Context& context) {
    transfers_.note_stage(Stage::kSurface);
    std::uint32_t pending_count = 0;
    GRIDIRON_TRY(gather_records(
        store_, transfers_, ray_count, sizeof(SurfaceRecord),
        [&](std::uint32_t i) -> std::uint64_t {
          store_.work.charge_to(Work::kWaveRay);
          const std::uint32_t id = store_.wave.ids[i];
          if (id == kNoTriangle) return 0;
          store_.work.charge_to(Work::kSurfacePoint);
          return section(scene().surfaces_offset_bytes + std::uint64_t{id} * sizeof(SurfaceRecord)).value;
        },
        [&](std::uint32_t i, const std::byte* record) {
          return find_point(i, *reinterpret_cast<const SurfaceRecord*>(record), context, pending_count);
        }));
    if constexpr (has(kSmoothNormals)) {
      if (pending_count != 0) return smooth_points(context);
    }
    return Status::kOk;
  }

  // Turns ray i, which hit `surface`, into the next point. The rays before it are done, so its place is free.
  [[nodiscard]] Status find_point(std::uint32_t i, const SurfaceRecord& surface, Context& context,
                                  std::uint32_t& pending_count) {
    store_.work.add(Work::kSurfacePoint);
    store_.work.charge_to(Work::kSurfacePoint);
    const MaterialRecord* material = nullptr;
    GRIDIRON_TRY(find_material(surface.material, material));
    const QueuedRay ray = store_.wave.items[i].ray;
    VertexTriangle triangle;
    for (int corner = 0; corner < 3; ++corner) {
      for (int axis = 0; axis < 3; ++axis) triangle.v[corner][axis] = surface.v[corner][axis];
    }
    const SurfacePoint found = surface_point(triangle, ray.origin, ray.dir, least_size_, store_.work);
    store_.work.charge_to(Work::kSurfacePoint);
    WavePoint& point = store_.wave.items[context.point_count].point;
    ++context.point_count;
    const Vector3 face = found.enters ? vector_of(found.normal) : -vector_of(found.normal);
    store(vector_of(found.before), point.point);
    store(face, point.face);
    store(-normalized(vector_of(ray.dir)), point.view);
    point.pixel = ray.pixel;
    point.path = ray.path;
    point.is_pending = 0;
    point.triangle = store_.wave.ids[i];
    if constexpr (has(kSmoothNormals)) {
      if (material->is_smooth != 0 && surface.normals != kNoNormals) {
        store_.work.charge_to(Work::kSmoothNormal);
        point.shading[0] = found.weights[0];
        point.shading[1] = found.weights[1];
        for (int axis = 0; axis < 3; ++axis) {
          point.pending.behind[axis] = found.behind[axis];
          point.pending.weight[axis] = ray.weight[axis];
        }
        point.pending.normals = surface.normals;
        point.pending.material = surface.material | (found.enters ? 1u << 31 : 0u);
        point.is_pending = 1;
        ++pending_count;
        return Status::kOk;
      }
    }
    return finish_point(context, point, face, vector_of(found.behind), vector_of(ray.weight), *material, found.enters);
  }

  // Gives pending points their shading normals.
  [[nodiscard]] Status smooth_points(Context& context) {
    return gather_records(
        store_, transfers_, context.point_count, sizeof(NormalRecord),
        [&](std::uint32_t i) -> std::uint64_t {
          store_.work.charge_to(Work::kSurfacePoint);
          const WavePoint& point = context.point(i);
          if (point.is_pending == 0) return 0;
          store_.work.charge_to(Work::kSmoothNormal);
          return section(scene().normals_offset_bytes + std::uint64_t{point.pending.normals} * sizeof(NormalRecord))
              .value;
        },
        [&](std::uint32_t i, const std::byte* record) {
          store_.work.add(Work::kSmoothNormal);
          store_.work.charge_to(Work::kSmoothNormal);
          const auto& normals = *reinterpret_cast<const NormalRecord*>(record);
          WavePoint& point = store_.wave.items[i].point;
          const PendingHit pending = point.pending;
          const bool enters = pending.material >> 31 != 0;
          const float w1 = point.shading[0], w2 = point.shading[1];
          const Vector3 mean = normalized((1.0f - w1 - w2) * vector_of(normals.n[0]) +
                                          (w1 * vector_of(normals.n[1]) + w2 * vector_of(normals.n[2])));
          const Vector3 smooth = enters ? mean : -mean;
          const Vector3 shading = dot(smooth, vector_of(point.view)) > 0.0f ? smooth : vector_of(point.face);
          point.is_pending = 0;
          const MaterialRecord* material = nullptr;
          GRIDIRON_TRY(find_material(pending.material & 0x7FFFFFFFu, material));
          GRIDIRON_TRY(finish_point(context, point, shading, vector_of(pending.behind), vector_of(pending.weight),
                                    *material, enters));
          if constexpr (has(kVertexColors)) {
            if (material->has_colors != 0) tint(point, normals.colors, w1, w2);
          }
          return Status::kOk;
        });
  }

  // Multiplies what a point scatters by the colour between its triangle's corners.
  void tint(WavePoint& point, const PackedColor* colors, float w1, float w2) {
    store_.work.add(Work::kVertexColor);
    store_.work.charge_to(Work::kVertexColor);
    const float w0 = 1.0f - w1 - w2;
    for (std::uint32_t channel = 0; channel < 3; ++channel) {
      const float factor = w0 * unpacked_channel(colors[0], channel) +
                           (w1 * unpacked_channel(colors[1], channel) + w2 * unpacked_channel(colors[2], channel));
      point.lit.diffuse[channel] = factor * point.lit.diffuse[channel];
    }
  }

  // Puts the sums of a tile on the curve of sRGB. @param steps  of a sum that stands for a brightness of 1.
  void put_on_curve(float steps) {
    store_.work.add(Work::kSrgbLevel, 3 * Store::kTilePixels);
    store_.work.charge_to(Work::kSrgbLevel);
    for (auto& sums : store_.effects.sums) {
      for (std::uint32_t& sum : sums) {
        const float value = srgb_of(brightness_of(sum, 1.0f / steps));
        sum = static_cast<std::uint32_t>(static_cast<std::int32_t>(value * steps + 0.5f));
      }
    }
  }

  // Finishes a point with its shading normal: makes the rays that leave it, and prepares its light.
  [[nodiscard]] GRIDIRON_OUTLINE Status finish_point(const Context& context, WavePoint& point, Vector3 shading,
                                                     Vector3 behind, Vector3 weight, const MaterialRecord& material,
                                                     bool enters) {
    store_.work.charge_to(Work::kSurfacePoint);
    store(shading, point.shading);
    if constexpr (has(kReflection | kRefraction)) {
      if (calls_for(kReflection | kRefraction)) {
        store_.work.charge_to(Work::kMirrorRay);
        GRIDIRON_TRY(cast_rays(point, shading, behind, weight, material, enters));
        store_.work.charge_to(Work::kSurfacePoint);
      }
    }
    if constexpr (has(kAreaLights | kAmbientOcclusion)) {
      if (calls_for(kAreaLights | kAmbientOcclusion)) {
        context.set_seed(point);
        store_.work.charge_to(Work::kSurfacePoint);
      }
    }
    store(weight * vector_of(material.diffuse), point.lit.diffuse);
    store(material.specular * weight, point.lit.specular);
    point.lit.shine = material.specular > 0.0f ? material.shine : 0.0f;
    return Status::kOk;
  }

  // Casts reflected and refracted rays of a point.
  [[nodiscard]] Status cast_rays(const WavePoint& point, Vector3 shading, Vector3 behind, Vector3 weight,
                                 const MaterialRecord& material, bool enters) {
    constexpr bool kRefracts = has(kRefraction);
    const bool is_glass = kRefracts && material.transmittance > 0.0f;
    if (point.pixel >> 16 >= scene().recursion_depth || !(material.specular > 0.0f || is_glass)) return Status::kOk;
    const Vector3 direction = -vector_of(point.view);
    const Vector3 face = vector_of(point.face);
    float share = material.specular;
    QueuedRay next{};
    next.pixel = point.pixel + (1u << 16);
    if constexpr (kRefracts) {
      if (is_glass) {
        store_.work.charge_to(Work::kRefractedRay);
        const Refraction through = refract_through(direction, shading, face, refraction_ratio(material.index, enters));
        share = reflected_share(material, through.fresnel);
        const Vector3 refracted = weight * refracted_share(material, through.fresnel);
        if (!through.is_total && (refracted.x > 0.0f || refracted.y > 0.0f || refracted.z > 0.0f)) {
          store_.work.add(Work::kRefractedRay);
          store(behind, next.origin);
          store(through.direction, next.dir);
          next.own = own_triangle(point.triangle, through.direction, -face);
          store(refracted, next.weight);
          next.path = 2 * point.path + 1;
          GRIDIRON_TRY(push(next));
        }
      }
    }
    store_.work.charge_to(Work::kMirrorRay);
    const Vector3 reflected = share * weight;
    if (!(reflected.x > 0.0f || reflected.y > 0.0f || reflected.z > 0.0f)) return Status::kOk;
    store_.work.add(Work::kMirrorRay);
    store(vector_of(point.point), next.origin);
    const Vector3 mirrored = reflect_off(direction, shading, face);
    store(mirrored, next.dir);
    next.own = own_triangle(point.triangle, mirrored, face);
    store(reflected, next.weight);
    next.path = 2 * point.path;
    return push(next);
  }

  [[nodiscard]] GRIDIRON_OUTLINE Status push(const QueuedRay& ray) {
    store_.work.add(Work::kQueuedRay);
    store_.work.charge_to(Work::kQueuedRay);
    return queue_.push(ray);
  }

  // Adds the light of all lights, as many at a time as fit the store.
  [[nodiscard]] GRIDIRON_INLINE Status light_points(Context& context) {
    transfers_.note_stage(Stage::kShadow);
    for (std::uint32_t first = 0; first < scene().light_count; first += Effects::kLightSlots) {
      if (store_.effects.first_light != first) GRIDIRON_TRY(load_lights(first));
      LightJobs<Store, kBuilt> jobs(context, first, lights_at_hand(first));
      if constexpr (has(kPointShadows | kAreaLights)) {
        if (has_shadows()) {
          GRIDIRON_TRY(rays_.trace(question(true, true), jobs));
          continue;
        }
      }
      jobs.light_all();
    }
    return Status::kOk;
  }

  Store& store_;
  Transfers<P>& transfers_;
  typename Layout::RayEngine::template Core<L, Store, P> rays_;
  SpillRegion spill_;
  RayQueue<Effects, P> queue_;
  std::uint32_t left_ = 0, top_ = 0;  ///< of the tile, in pixels
  float least_size_ = 0.0f;           ///< of surface_point
  bool has_all_materials_ = false;
};

}  // namespace gridiron
