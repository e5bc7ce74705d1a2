// Jobs of a wave without a kernel around them: the rays that they make, and the light that answers add.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/shade/wave_jobs.h>
#include <gridiron/store/local_store.h>

#include "support/test_headers.h"

namespace gridiron {
namespace {

using Store = LocalStore<EffectLayout64K<kAllEffects>>;
using Context = WaveContext<Store>;
constexpr std::uint32_t kPoints = 20;  // a job of 16 and one of 4
constexpr std::uint32_t kWidth = 40, kLeft = 16, kTop = 8, kSample = 2;
constexpr std::uint32_t kFirstTriangle = 300;  // of the points, one each

LightRecord point_light(Vector3 place, bool is_near, float color = 1.0f) {
  return {{place.x, place.y, place.z}, 0, {color, color, color}, is_near ? 1u : 0u, {}, 0, {}, 0};
}
LightRecord area_light(Vector3 corner, std::uint32_t samples) {
  return {{corner.x, corner.y, corner.z}, samples, {1, 1, 1}, 1, {2, 0, 0}, 0, {0, 0, 3}, 0};
}

// Points of a floor, y = 0, seen from above.
class WaveJobs : public testing::Test {
 protected:
  void SetUp() override {
    std::memset(static_cast<void*>(store.get()), 0, sizeof(Store));
    store->frame.width = kWidth;
    store->effects.scene.occlusion_samples = 5;
    store->effects.scene.occlusion_radius = 0.5f;
    for (std::uint32_t i = 0; i < kPoints; ++i) {
      WavePoint& point = store->wave.items[i].point;
      point = {};
      gridiron::store({static_cast<float>(i) * 0.25f, 0, 0}, point.point);
      gridiron::store({0, 1, 0}, point.face);
      gridiron::store({0, 1, 0}, point.shading);
      gridiron::store({0, 1, 0}, point.view);
      point.pixel = i | 1u << 16;
      point.path = 1;
      context.set_seed(point);
      point.triangle = kFirstTriangle + i;
      point.lit = {{1, 1, 1}, {0, 0, 0}, 0};
    }
  }

  struct Ray {
    Vector3 origin, dir;
    float t;
    std::uint32_t owner;
    std::uint32_t id;  // before it was traced
  };
  // All rays of a kind; every second one is answered by a hit.
  template <class Jobs>
  std::vector<Ray> run(Jobs& jobs) {
    std::vector<Ray> found;
    BatchRay rays[4 * kJobRays] = {};
    std::uint32_t owners[4 * kJobRays] = {};
    RayBatch batch{rays, owners, 0};
    for (std::uint32_t job = 0; job < 1000; ++job) {
      // Batches of up to four jobs.
      const std::uint32_t before = batch.count;
      const bool has_more = jobs.next(batch);
      EXPECT_EQ(has_more, batch.count > before) << "a job without rays, or rays without one";
      EXPECT_LE(batch.count, before + kJobRays);
      if (has_more && batch.count + kJobRays <= std::size(rays)) continue;
      for (std::uint32_t i = 0; i < batch.count; ++i) {
        EXPECT_FALSE(rays[i].has_hit());
        found.push_back({vector_of(rays[i].origin), vector_of(rays[i].dir), rays[i].t, owners[i], rays[i].id});
        if (found.size() % 2 == 0) rays[i].id = 7;
      }
      if (batch.count != 0) jobs.finish(batch);
      if (!has_more) return found;
      batch.count = 0;
    }
    ADD_FAILURE() << "no end";
    return found;
  }
  std::vector<Ray> light_rays(const std::vector<LightRecord>& lights, std::uint32_t first = 0) {
    for (std::size_t i = 0; i < lights.size(); ++i) store->effects.lights[i] = lights[i];
    LightJobs<Store, kAllEffects> jobs(context, first, static_cast<std::uint32_t>(lights.size()));
    return run(jobs);
  }
  [[nodiscard]] float sum(std::uint32_t pixel) const {
    return static_cast<float>(store->effects.sums[0][pixel]) / kSumSteps;
  }

  std::unique_ptr<Store> store = std::make_unique<Store>();
  [[nodiscard]] static std::uint32_t place_of(const Ray& ray) { return ray.owner & 0xFFFFu; }

  Context context{*store, kPoints, kSample, kLeft, kTop};
};

float length(Vector3 v) {
  return std::sqrt(dot(v, v));
}

TEST_F(WaveJobs, EveryPointAsksEveryLightOnceAlongTheSegmentBetween) {
  const Vector3 near{1, 2, 0.5f}, far{3, 4, -1};
  const std::vector<Ray> rays = light_rays({point_light(near, true), point_light(far, false)});
  ASSERT_EQ(rays.size(), 2 * kPoints);
  for (std::uint32_t i = 0; i < 2 * kPoints; ++i) {
    const Ray& ray = rays[i];
    const bool from_light = i < kPoints;
    const Vector3 point = vector_of(context.point(i % kPoints).point), light = from_light ? near : far;
    EXPECT_EQ(ray.owner & 0xFFFFu, i % kPoints);
    EXPECT_EQ(ray.t, 1.0f);
    EXPECT_EQ(length(ray.origin - (from_light ? light : point)), 0.0f) << i;
    EXPECT_LE(length(ray.origin + ray.dir - (from_light ? point : light)), 1e-6f) << i;
    // The point's own triangle, whichever end of the segment it lies at.
    EXPECT_EQ(ray.id, no_hit(kFirstTriangle + i % kPoints)) << i;
  }
}

// Engines may skip the triangle that a ray names, so a ray names its own only where it surely rises from it: with more
// than 2^-10 of its largest component.
TEST_F(WaveJobs, RaysAlongTheFaceNameNoTriangle) {
  for (const float slope : {0x1p-12f, 0x1.ffp-11f, 0x1.01p-10f, 0x1p-8f}) {
    for (const bool is_near : {true, false}) {
      for (std::uint32_t i = 0; i < kPoints; ++i) gridiron::store({0, 0, 0}, store->wave.items[i].point.point);
      const std::vector<Ray> rays = light_rays({point_light({-2, 2 * slope, 1}, is_near)});
      ASSERT_EQ(rays.size(), kPoints);
      for (std::uint32_t i = 0; i < kPoints; ++i) {
        const std::uint32_t named = slope > 0x1p-10f ? kFirstTriangle + i : std::uint32_t{kNoTriangle};
        EXPECT_EQ(rays[i].id, no_hit(named)) << slope << ", " << is_near;
      }
    }
  }
  // By the face: what the shading normal says does not matter.
  gridiron::store({1, 0, 0}, store->wave.items[1].point.face);
  EXPECT_EQ(light_rays({point_light({2, 0x1p-12f, 0}, true)})[1].id, no_hit(kFirstTriangle + 1));
}

TEST_F(WaveJobs, LightComesWhereNothingIsHitAndEitherNormalFacesIt) {
  const Vector3 place{0, 2, 0};
  // Points 1 and 2 are turned away: one by its face, one by its shading normal.
  gridiron::store({0, -1, 0}, store->wave.items[1].point.face);
  gridiron::store({0, -1, 0}, store->wave.items[2].point.shading);
  const std::vector<Ray> rays = light_rays({point_light(place, true)});
  ASSERT_EQ(rays.size(), kPoints - 2);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Vector3 point = vector_of(context.point(rays[i].owner).point);
    const bool is_lit = i % 2 == 0;
    EXPECT_NEAR(sum(rays[i].owner), is_lit ? 2 / length(place - point) : 0.0f, 1e-5f) << rays[i].owner;
  }
  EXPECT_EQ(sum(1), 0.0f);
  EXPECT_EQ(sum(2), 0.0f);
}

TEST_F(WaveJobs, WithoutShadowsEveryPointIsLitThatFacesTheLight) {
  gridiron::store({0, -1, 0}, store->wave.items[1].point.face);
  store->effects.lights[0] = point_light({0, 2, 0}, true);
  store->effects.lights[1] = point_light({0, -2, 0}, true);
  LightJobs<Store, kAllEffects> jobs(context, 0, 2);
  jobs.light_all();
  for (std::uint32_t i = 0; i < kPoints; ++i) {
    const Vector3 point = vector_of(context.point(i).point);
    EXPECT_NEAR(sum(i), i == 1 ? 0.0f : 2 / length(Vector3{0, 2, 0} - point), 1e-5f) << i;
  }
}

TEST_F(WaveJobs, AnAreaLightIsAskedAtThePlacesOfTheFormula) {
  const Vector3 corner{-1, 2, -1};
  constexpr std::uint32_t kSamples = 4, kFirst = 16;
  const std::vector<Ray> rays = light_rays({area_light(corner, kSamples)}, kFirst);
  ASSERT_EQ(rays.size(), kSamples * kPoints);
  std::vector<std::uint32_t> asked(kPoints);
  for (const Ray& ray : rays) {
    // Pixel of the picture: tiles of this layout are 8 wide.
    const std::uint32_t pixel = (kTop + ray.owner / 8) * kWidth + kLeft + ray.owner % 8;
    const Jitter jitter = jitter_of(sample_seed(1, kSample, pixel), area_light_purpose(kFirst));
    const SquarePlace place = area_light_place(asked[ray.owner]++, kSamples, jitter);
    const Vector3 wanted = corner + Vector3{2 * place.a, 0, 3 * place.b};
    EXPECT_EQ(ray.t, 1.0f);
    EXPECT_LE(length(ray.origin + ray.dir - wanted), 1e-5f) << ray.owner;
  }
}

TEST_F(WaveJobs, AmbientLightIsAskedForOnceASampleWithinTheRadius) {
  OcclusionJobs<Store> jobs(context);
  const std::vector<Ray> rays = run(jobs);
  ASSERT_EQ(rays.size(), 5 * kPoints);
  std::set<std::tuple<std::uint32_t, float, float>> directions;
  std::vector<float> open(kPoints);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Ray& ray = rays[i];
    EXPECT_EQ(ray.t, 1.0f);
    EXPECT_NEAR(length(ray.dir), 0.5f, 1e-5f);
    EXPECT_GT(ray.dir.y, 0.0f);
    EXPECT_EQ(length(ray.origin - vector_of(context.point(ray.owner).point)), 0.0f);
    const bool is_steep = ray.dir.y > 0x1p-10f * std::max(std::fabs(ray.dir.x), std::fabs(ray.dir.z));
    EXPECT_EQ(ray.id, no_hit(is_steep ? kFirstTriangle + ray.owner : std::uint32_t{kNoTriangle})) << i;
    directions.insert({ray.owner, ray.dir.x, ray.dir.z});
    if (i % 2 == 0) open[ray.owner] += kAmbientLight / 5;
  }
  EXPECT_EQ(directions.size(), rays.size());
  for (std::uint32_t i = 0; i < kPoints; ++i) EXPECT_NEAR(sum(i), open[i], 1e-5f) << i;
}

TEST_F(WaveJobs, AmbientLightIsNotAskedForBeneathTheFace) {
  gridiron::store({0, -1, 0}, store->wave.items[1].point.face);
  OcclusionJobs<Store> jobs(context);
  const std::vector<Ray> rays = run(jobs);
  EXPECT_EQ(rays.size(), 5 * (kPoints - 1));
  for (const Ray& ray : rays) EXPECT_NE(ray.owner, 1u);
}

TEST_F(WaveJobs, AHighlightIsThePowerOfTheCosineHalfWay) {
  const Vector3 place{3, 2, 0};
  for (std::uint32_t i = 0; i < kPoints; ++i) store->wave.items[i].point.lit = {{0, 0, 0}, {0.5f, 0.5f, 0.5f}, 3.0f};
  store->effects.lights[0] = point_light(place, true);
  LightJobs<Store, kAllEffects> jobs(context, 0, 1);
  jobs.light_all();
  for (std::uint32_t i = 0; i < kPoints; ++i) {
    const Vector3 to_light = place - vector_of(context.point(i).point);
    const Vector3 half = (1 / length(to_light)) * to_light + Vector3{0, 1, 0};
    EXPECT_NEAR(sum(i), 0.5f * std::pow(half.y / length(half), 3.0f), 1e-5f) << i;
  }
}

TEST_F(WaveJobs, RaysOfAWaveGetTheirOwnHits) {
  for (std::uint32_t i = 0; i < kPoints; ++i) {
    store->wave.items[i].ray = {{static_cast<float>(i), 0, 0}, {0, 0, 1}, {1, 1, 1}, i, 1, 40 + i};
  }
  WaveRayJobs<Store> jobs(*store, kPoints, 9.0f);
  BatchRay rays[3 * kJobRays] = {};
  std::uint32_t owners[3 * kJobRays] = {};
  RayBatch batch{rays, owners, 0};
  for (const std::uint32_t expected : {16u, 20u}) {
    ASSERT_TRUE(jobs.next(batch));
    ASSERT_EQ(batch.count, expected);
  }
  ASSERT_FALSE(jobs.next(batch));
  ASSERT_EQ(batch.count, kPoints);
  for (std::uint32_t i = 0; i < batch.count; ++i) {
    EXPECT_EQ(rays[i].t, 9.0f);
    EXPECT_EQ(rays[i].id, no_hit(40 + i)) << "the triangle that the ray's maker names";
    if (i == 3) continue;  // hits nothing
    rays[i].id = 100 + static_cast<std::uint32_t>(rays[i].origin[0]);
  }
  jobs.finish(batch);
  for (std::uint32_t i = 0; i < kPoints; ++i) {
    EXPECT_EQ(store->wave.ids[i], i == 3 ? std::uint32_t{kNoTriangle} : 100 + i);
  }
}

}  // namespace
}  // namespace gridiron
