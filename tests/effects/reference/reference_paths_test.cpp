// Paths of the reference against closed forms: mirrors, glass, total reflection, furnaces.
// SPDX-License-Identifier: Apache-2.0
#include <glm/geometric.hpp>

#include "effects/effect_scene.h"
#include "effects/reference/reference_renderer.h"

namespace gridiron::test {
namespace {

using tool::SceneDescription;
using tool::SceneMaterial;

constexpr std::uint32_t kPathWidth = 65;  // odd: one ray straight down

SceneMaterial mirror(float ks = 1.0f) {
  return {.kd = 0.0f, .ks = ks};
}

SceneMaterial glass(float index, float transmittance = 1.0f) {
  return {.kd = 0.0f, .transmittance = transmittance, .index_of_refraction = index};
}

SceneMaterial black() {
  return {.kd = 0.0f};
}

void add_sheet(SceneDescription& scene, float z, std::uint16_t material) {
  add_parallelogram(scene, {-50, -50, z}, {100, 0, 0}, {0, 100, 0}, material);
}

DVec3 direction_of(const SceneDescription& scene, std::uint32_t x, std::uint32_t y) {
  const ReferenceCamera camera = reference_camera(scene.view, kPathWidth, kPathWidth);
  return glm::normalize(DVec3(camera.direction(static_cast<float>(x), static_cast<float>(y))));
}

template <class Check>
void for_each_pixel(const SceneDescription& scene, const ReferencePicture& picture, const Check& check) {
  for (std::uint32_t y = 0; y < kPathWidth; ++y) {
    for (std::uint32_t x = 0; x < kPathWidth; ++x) {
      check(picture.index(x, y), direction_of(scene, x, y));
    }
  }
}

// Fresnel's mean for both polarisations by angles, as textbooks have it (E. Hecht, Optics, 4.6).
double fresnel_by_angles(double cosine, double n1, double n2) {
  const double i = std::acos(std::min(1.0, cosine));
  const double sine = n1 / n2 * std::sin(i);
  if (sine >= 1.0) return 1.0;
  if (i < 1e-6) return std::pow((n1 - n2) / (n1 + n2), 2.0);
  const double t = std::asin(sine);
  const double s = std::sin(i - t) / std::sin(i + t), p = std::tan(i - t) / std::tan(i + t);
  return 0.5 * (s * s + p * p);
}

// A triangle at height 1 above a mirror is seen at height -1.
TEST(ReferencePaths, AMirrorShowsATriangleAtTheMirroredPlace) {
  SceneDescription scene = empty_scene({0, -4, 2}, {0, 0, 0}, {0, 0, 1}, 50);
  scene.background = {0, 0, 1};
  add_sheet(scene, 0, add_material(scene, mirror(0.5f)));
  const Vec3 corners[3] = {{-1.1f, -0.5f, 1}, {0, 1.2f, 1}, {0.9f, -0.3f, 1}};
  const std::uint32_t id = add_triangle(scene, corners, add_material(scene, {.color = {1, 0.5f, 0}}));
  // Lit from beneath, from far away: the side that the mirror sees.
  scene.shadows = false;
  scene.point_lights.push_back({{0, 0, -1e6f}, Vec3(0.8f)});
  const ReferencePicture picture = render_reference(scene, kPathWidth, kPathWidth);
  std::size_t inside = 0, outside = 0;
  for_each_pixel(scene, picture, [&](std::size_t i, const DVec3& dir) {
    if (picture.ids[i] == id || picture.ids[i] == kReferenceNoTriangle) return;
    const DVec3 at = DVec3(scene.view.from) + dir * (-3.0 / dir.z);  // in the plane z = -1
    double least = 1e9;                                              // from the edges, inside positive
    for (int k = 0; k < 3; ++k) {
      const DVec3 a(corners[k]), b(corners[(k + 1) % 3]);
      const double side = (b.x - a.x) * (at.y - a.y) - (b.y - a.y) * (at.x - a.x);
      least = std::min(least, -side);  // seen from above they are clockwise
    }
    if (std::abs(least) < 1e-4) return;
    const bool is_inside = least > 0;
    (is_inside ? inside : outside) += 1;
    const DVec3 expected = is_inside ? DVec3(0.4, 0.2, 0) : DVec3(0, 0, 0.5);
    EXPECT_LT(glm::length(picture.linear[i] - expected), 1e-5) << at.x << ' ' << at.y;
  });
  EXPECT_GT(inside, 100u);
  EXPECT_GT(outside, 500u);
  EXPECT_EQ(picture.counts.refracted, 0u);
}

// A slab moves rays aside by d (tan i - tan t) and lets (1 - F)^2 through; what is reflected inside is cut by depth.
TEST(ReferencePaths, ASlabOfGlassMovesRaysAside) {
  SceneDescription scene = empty_scene({0, 0, 3}, {0, 0, 0}, {0, 1, 0}, 80);
  scene.recursion_depth = 3;
  const std::uint16_t slab = add_material(scene, glass(1.5f));
  add_sheet(scene, 1, slab);
  add_parallelogram(scene, {-50, -50, 0.25f}, {0, 100, 0}, {100, 0, 0}, slab);  // turned down
  const std::uint16_t floor = add_material(scene, {});
  add_sheet(scene, -1, floor);
  scene.shadows = false;
  scene.point_lights.push_back({{0.5f, 0.3f, 0.2f}, Vec3(1)});
  const ReferencePicture picture = render_reference(scene, kPathWidth, kPathWidth);
  for_each_pixel(scene, picture, [&](std::size_t i, const DVec3& dir) {
    const double cosine = -dir.z;
    const double sine = std::sqrt(1.0 - cosine * cosine);
    const double inner = std::asin(sine / 1.5);
    const double aside = sine / cosine * (2.0 + 1.25) + 0.75 * std::tan(inner);
    const DVec3 at = sine > 1e-9 ? DVec3(dir.x / sine * aside, dir.y / sine * aside, -1) : DVec3(0, 0, -1);
    const DVec3 to_light = DVec3(0.5, 0.3, 0.2) - at;
    const double through = 1.0 - fresnel_by_angles(cosine, 1, 1.5);
    EXPECT_NEAR(picture.linear[i].x, through * through * to_light.z / glm::length(to_light), 1e-5);
  });
}

TEST(ReferencePaths, NormalIncidenceReflectsWhatTheIndexSays) {
  for (const float n : {1.1f, 1.5f, 2.4f, 0.7f}) {
    SceneDescription scene = empty_scene({0, 0, 3}, {0, 0, 0}, {0, 1, 0}, 60);
    scene.background = Vec3(1);
    add_sheet(scene, 0, add_material(scene, glass(n)));
    add_sheet(scene, -1, add_material(scene, black()));
    const ReferencePicture picture = render_reference(scene, kPathWidth, kPathWidth);
    const double expected = std::pow((n - 1.0) / (n + 1.0), 2.0);
    EXPECT_NEAR(picture.linear[picture.index(kPathWidth / 2, kPathWidth / 2)].x, expected, 1e-7) << n;
    for_each_pixel(scene, picture, [&](std::size_t i, const DVec3& dir) {
      EXPECT_NEAR(picture.linear[i].x, fresnel_by_angles(-dir.z, 1, n), 1e-6);
    });
  }
}

// From inside the glass: beyond the critical angle all is reflected, and no ray is refracted.
TEST(ReferencePaths, BeyondTheCriticalAngleAllIsReflected) {
  SceneDescription scene = empty_scene({0, 0, -1}, {0, 0, 0}, {0, 1, 0}, 120);
  scene.background = Vec3(1);
  scene.recursion_depth = 2;
  add_sheet(scene, 0, add_material(scene, glass(1.5f)));
  add_sheet(scene, 1, add_material(scene, black()));
  const ReferencePicture picture = render_reference(scene, kPathWidth, kPathWidth);
  std::size_t total = 0, partial = 0;
  for_each_pixel(scene, picture, [&](std::size_t i, const DVec3& dir) {
    const double sine = std::sqrt(1.0 - dir.z * dir.z);
    if (std::abs(sine - 1 / 1.5) < 1e-3) return;
    if (sine > 1 / 1.5) {
      EXPECT_EQ(picture.linear[i].x, 1.0);
      ++total;
    } else {
      EXPECT_NEAR(picture.linear[i].x, fresnel_by_angles(dir.z, 1.5, 1), 1e-6);
      ++partial;
    }
  });
  EXPECT_GT(total, 1000u);
  EXPECT_GT(partial, 500u);
  EXPECT_EQ(picture.counts.reflected, kPathWidth * kPathWidth);
  EXPECT_LE(picture.counts.refracted, kPathWidth * kPathWidth - total);
}

// Jitter of an area light tells a path's number: straight down, through glass (path 3) or glass seen from beneath
// after a mirror (paths 2, then 5).
TEST(ReferencePaths, PathsAreNumberedAsABinaryTree) {
  for (const bool is_mirrored : {false, true}) {
    SceneDescription scene = empty_scene({0, 0, 3}, {0, 0, 0}, {0, 1, 0}, 1);
    scene.shadows = false;
    const std::uint16_t clear = add_material(scene, glass(1.0f));  // index 1: nothing is reflected
    const std::uint16_t floor = add_material(scene, {});
    const std::uint16_t silver = add_material(scene, mirror());
    if (is_mirrored) add_sheet(scene, 0, silver);
    add_sheet(scene, is_mirrored ? 3.5f : 1.0f, clear);
    add_sheet(scene, is_mirrored ? 4.0f : 0.0f, floor);
    scene.area_lights.push_back({{0.5f, 0.5f, 2}, {2, 0, 0}, {0, 2, 0}, Vec3(1), 1});
    const ReferencePicture picture = render_reference(scene, 1, 1);
    const ReferenceJitter jitter = reference_jitter(is_mirrored ? 5 : 3, 0, 0, 1);
    const DVec3 light(0.5 + 2 * jitter.j1, 0.5 + 2 * jitter.j2, 2);
    EXPECT_NEAR(picture.linear[0].x, 2.0 / glm::length(light - DVec3(0, 0, is_mirrored ? 4 : 0)), 1e-9);
  }
}

TEST(ReferencePaths, DepthOfRecursionCutsAPathBetweenMirrors) {
  // Straight down between two mirrors, the upper one behind the eye: n reflections, then nothing is added.
  SceneDescription scene = empty_scene({0, 0, 1}, {0, 0, 0}, {0, 1, 0}, 5);
  const std::uint16_t material = add_material(scene, {.kd = 0.5f, .ks = 0.5f});
  add_sheet(scene, 0, material);
  add_parallelogram(scene, {-50, -50, 2}, {0, 100, 0}, {100, 0, 0}, material);
  scene.shadows = false;
  // Right above each other's lights: both sheets get cosine 1 at the middle.
  scene.point_lights.push_back({{0, 0, 1.5f}, Vec3(1)});
  for (std::uint32_t depth = 1; depth <= tool::kMostRecursionDepth; ++depth) {
    scene.recursion_depth = depth;
    const ReferencePicture picture = render_reference(scene, 1, 1);
    EXPECT_NEAR(picture.linear[0].x, 1.0 - std::pow(0.5, depth), 1e-9);
    EXPECT_EQ(picture.counts.reflected, depth - 1);
  }
}

// White all around: what keeps all light shows 1, but for what the depth of recursion cuts.
TEST(ReferenceFurnace, NothingIsBrighterThanItsSurroundings) {
  struct Case {
    const char* name;
    SceneMaterial material;
    double least_mean;
  };
  const Case cases[] = {
      {"mirror", mirror(), 1.0 - 1e-12},
      {"glass", glass(1.5f), 0.93},
      {"thin glass", glass(0.6f), 0.95},
      {"glass that mirrors", {.kd = 0, .ks = 0.3f, .transmittance = 0.7f, .index_of_refraction = 1.5f}, 0.9},
      // Is scaled.
      {"more than all", {.kd = 0, .ks = 1, .transmittance = 1, .index_of_refraction = 1.3f}, 0.85},
      {"smooth glass", {.kd = 0, .transmittance = 1, .index_of_refraction = 1.5f, .smooth_normals = true}, 0.95},
      {"smooth mirror", {.kd = 0, .ks = 1, .smooth_normals = true}, 1.0 - 1e-12}};
  for (const Case& c : cases) {
    for (const bool is_ball : {false, true}) {
      const SceneDescription scene = is_ball ? furnace_ball_scene(c.material) : furnace_box_scene(c.material);
      const ReferencePicture picture = render_reference(scene, 33, 33);
      double sum = 0.0;
      std::size_t hits = 0;
      for (std::size_t i = 0; i < picture.ids.size(); ++i) {
        const DVec3& value = picture.linear[i];
        for (int channel = 0; channel < 3; ++channel) {
          ASSERT_TRUE(std::isfinite(value[channel])) << c.name;
          EXPECT_LE(value[channel], 1.0 + 1e-12) << c.name << ' ' << i;
        }
        if (picture.ids[i] == kReferenceNoTriangle) {
          EXPECT_EQ(value, DVec3(1));
          continue;
        }
        sum += value.x;
        ++hits;
      }
      ASSERT_GT(hits, 250u);
      EXPECT_GE(sum / static_cast<double>(hits), c.least_mean) << c.name << (is_ball ? " ball" : " box");
    }
  }
}

// More depth lets more light through, and never takes any away.
TEST(ReferenceFurnace, DepthAddsLightOnly) {
  SceneDescription scene = furnace_ball_scene(glass(1.5f));
  ReferencePicture before;
  for (std::uint32_t depth = 1; depth <= 6; ++depth) {
    scene.recursion_depth = depth;
    const ReferencePicture picture = render_reference(scene, 17, 17);
    for (std::size_t i = 0; depth > 1 && i < picture.linear.size(); ++i) {
      EXPECT_GE(picture.linear[i].x, before.linear[i].x);
    }
    before = picture;
  }
}

TEST(ReferencePaths, RoomsAndGlassBallsAreFiniteAndUseTheirEffects) {
  for (int which = 0; which < 3; ++which) {
    const SceneDescription scene = which == 0 ? mirror_room_scene() : glass_ball_scene(which == 1);
    const ReferencePicture picture = render_reference(scene, 32, 32);
    for (const DVec3& value : picture.linear) {
      for (int channel = 0; channel < 3; ++channel) ASSERT_TRUE(std::isfinite(value[channel]));
    }
    EXPECT_GT(picture.counts.shadow, 300u);
    EXPECT_GT(picture.counts.reflected, 500u);
    EXPECT_EQ(picture.counts.refracted > 0, which > 0);
    if (which == 0) {
      EXPECT_EQ(std::count(picture.ids.begin(), picture.ids.end(), kReferenceNoTriangle), 0) << "a closed room";
    }
  }
}

}  // namespace
}  // namespace gridiron::test
