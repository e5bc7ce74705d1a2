// Secondary rays of the accuracy experiment: every ray is noted, and leaks and self-hits are detected.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <limits>

#include "experiment/secondary_prices.h"

namespace gridiron::test {
namespace {

using experiment::Answers;
using experiment::EffectFrame;
using experiment::EffectFrameRequest;
using experiment::EffectScene;
using experiment::NamedRayKind;
using experiment::RayErrors;
using experiment::RayKind;
using experiment::Solid;
using experiment::SolidPrice;
using experiment::TracedRay;

constexpr std::uint32_t kRayEffects = kPointShadows | kAreaLights | kAmbientOcclusion | kReflection | kRefraction;
constexpr EffectFrameRequest kSmallFrame{.width = 48, .height = 48};

TEST(SecondaryScenes, CastOneKindOfRays) {
  const EffectScene gallery = experiment::make_effect_scene("gallery");
  EXPECT_EQ(experiment::called_for(experiment::with_rays_of(gallery, std::nullopt)), kSceneShading);
  for (const NamedRayKind& kind : experiment::kRayKinds) {
    const std::uint32_t called = experiment::called_for(experiment::with_rays_of(gallery, kind.kind));
    // Glass reflects; an area light casts shadows without the effect of points.
    const std::uint32_t wanted = kind.effect | (kind.kind == RayKind::kRefraction ? kReflection : 0u);
    EXPECT_EQ(called & kRayEffects & ~std::uint32_t{kPointShadows}, wanted & ~std::uint32_t{kPointShadows}) << kind.key;
    if (kind.kind == RayKind::kShadow) {
      EXPECT_NE(called & kPointShadows, 0u);
    }
  }
}

// The engine that notes rays misses none, changes no answer and knows their kinds.
TEST(SecondaryRays, AreThoseThatTheFrameCounts) {
  for (const NamedRayKind& kind : experiment::kRayKinds) {
    SCOPED_TRACE(kind.key);
    const EffectScene scene = experiment::with_rays_of(experiment::make_effect_scene("gallery"), kind.kind);
    const EffectFrame frame = experiment::render_effect_frame(scene, kSmallFrame);
    experiment::PreparedEffectFrame prepared(scene, kSmallFrame);
    std::array<std::uint64_t, std::size(experiment::kRayKinds)> counts{};
    std::size_t hits = 0;
    const std::vector<TracedRay> rays = experiment::trace_secondary_rays(prepared);
    for (const TracedRay& ray : rays) {
      ++counts[static_cast<std::size_t>(ray.kind)];
      hits += ray.has_hit() ? 1u : 0u;
    }
    const auto count_of = [&counts](RayKind each) { return counts[static_cast<std::size_t>(each)]; };
    EXPECT_EQ(count_of(RayKind::kShadow) + count_of(RayKind::kArea), frame.count(Work::kShadowRay));
    EXPECT_EQ(count_of(RayKind::kOcclusion), frame.count(Work::kOcclusionRay));
    EXPECT_EQ(count_of(RayKind::kReflection), frame.count(Work::kMirrorRay));
    EXPECT_EQ(count_of(RayKind::kRefraction), frame.count(Work::kRefractedRay));
    EXPECT_GT(count_of(kind.kind), 0u);
    EXPECT_GT(hits, 0u);
    EXPECT_LT(hits, rays.size());
    // Asked again they get the same answers.
    const experiment::RayTree tree(prepared);
    const std::vector<experiment::RayHit> again = tree.nearest(rays, kSmallFrame.accuracy);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      EXPECT_EQ(again[i].id == kNoTriangle, rays[i].id == kNoTriangle);
      if (!named(rays[i].kind).wants_any_hit) {
        EXPECT_EQ(again[i].id, rays[i].id);
      }
    }
  }
}

// Every profile without leaks has none in the solids, and nothing hits itself.
TEST(SecondaryRays, DoNotGoAstrayInSolids) {
  for (const NamedRayKind& kind : experiment::kRayKinds) {
    std::size_t far_rays = 0;
    for (const Solid& solid : experiment::make_solids(kind.kind)) {
      SCOPED_TRACE(std::string(kind.key) + " in " + solid.scene.key);
      const SolidPrice price = experiment::price_solid(solid, kSmallFrame);
      EXPECT_EQ(price.enclosed.leaks(), 0u);
      EXPECT_EQ(price.at_edges.leaks(), 0u);
      EXPECT_EQ(price.open.false_hits, 0u);
      EXPECT_EQ(price.at_edges.rays, price.enclosed.rays);
      EXPECT_GT(solid.is_room ? price.enclosed.rays : price.open.rays, 500u);
      far_rays += price.open.rays;
    }
    EXPECT_GT(far_rays, 0u);
  }
}

// A room with a hole leaks, for every kind of rays.
TEST(SecondaryRays, LeaksAreDetected) {
  for (const NamedRayKind& kind : experiment::kRayKinds) {
    SCOPED_TRACE(kind.key);
    Solid room = experiment::make_solids(kind.kind).front();
    ASSERT_TRUE(room.is_room);
    // Every tenth triangle of the walls goes.
    tool::SceneGeometry& geometry = room.scene.description.geometry;
    std::size_t kept = 0, walls = 0;
    for (std::size_t i = 0; i < geometry.triangles.size(); ++i) {
      const bool is_wall = geometry.triangle_materials[i] == geometry.triangle_materials.front();
      walls += is_wall ? 1u : 0u;
      if (is_wall && walls % 10 == 0) continue;
      geometry.triangles[kept] = geometry.triangles[i];
      geometry.triangle_materials[kept] = geometry.triangle_materials[i];
      ++kept;
    }
    geometry.triangles.resize(kept);
    geometry.triangle_materials.resize(kept);
    const SolidPrice price = experiment::price_solid(room, kSmallFrame);
    EXPECT_GT(price.enclosed.leaks(), 0u);
    EXPECT_GT(price.at_edges.leaks(), 0u);
  }
}

// Floats that are trusted leave no gap between triangles that share an edge.
TEST(SecondaryRays, FastLeaksNowhere) {
  EffectFrameRequest request = kSmallFrame;
  request.accuracy = Accuracy::kFast;
  for (const NamedRayKind& kind : experiment::kRayKinds) {
    const SolidPrice price = experiment::price_solid(experiment::make_solids(kind.kind).front(), request);
    EXPECT_GT(price.at_edges.rays, 0u) << kind.key;
    EXPECT_EQ(price.at_edges.leaks() + price.enclosed.leaks(), 0u) << kind.key;
  }
}

// A body with a dent hits itself.
TEST(SecondaryRays, SelfHitsAreDetected) {
  for (const RayKind kind : {RayKind::kOcclusion, RayKind::kReflection}) {
    Solid body = experiment::make_solids(kind)[2];
    ASSERT_FALSE(body.is_room);
    std::vector<Vec3>& vertices = body.scene.description.geometry.vertices;
    for (std::size_t i = 0; i < vertices.size(); i += 7) vertices[i] *= 0.8f;
    EXPECT_GT(experiment::price_solid(body, kSmallFrame).open.false_hits, 0u) << named(kind).key;
  }
}

TEST(SecondaryRays, ErrorsAreCountedByWhatTheyAre) {
  constexpr float kFar = std::numeric_limits<float>::infinity();
  constexpr std::uint32_t kNone = kNoTriangle;
  const struct {
    const char* words;
    std::uint32_t true_id;
    float true_distance;
    std::uint32_t id;
    float distance;
    std::uint64_t leaks, self_hits, false_hits;
  } cases[] = {
      {"right", 3, 5, 3, 5, 0, 0, 0},
      {"nothing, rightly", kNone, kFar, kNone, kFar, 0, 0, 0},
      {"through a hole", 3, 5, kNone, kFar, 1, 0, 0},
      {"through to what is behind", 3, 5, 4, 6, 1, 0, 0},
      {"a neighbour at the same distance", 3, 5, 4, 5, 0, 0, 0},
      {"itself, in the open", kNone, kFar, 4, 0.5f, 0, 1, 1},
      {"itself, before a true hit", 3, 5, 4, 0.5f, 0, 1, 0},
      {"a true hit, very near", 3, 0.5f, 3, 0.5f, 0, 0, 0},
      {"something that is not there, far away", kNone, kFar, 4, 5, 0, 0, 1},
  };
  for (const auto& each : cases) {
    const Answers truth{{}, {each.true_id}, {each.true_distance}}, answers{{}, {each.id}, {each.distance}};
    const RayErrors errors = experiment::compare_rays(truth, answers, 1.0);
    EXPECT_EQ(errors.hits.leaks(), each.leaks) << each.words;
    EXPECT_EQ(errors.self_hits, each.self_hits) << each.words;
    EXPECT_EQ(errors.hits.false_hits, each.false_hits) << each.words;
  }
}

}  // namespace
}  // namespace gridiron::test
