// The reference's light against closed forms: Lambert, highlights, shadows, area lights, occlusion, normals, samples.
// SPDX-License-Identifier: Apache-2.0
#include <glm/geometric.hpp>
#include <numbers>

#include "effects/effect_scene.h"
#include "effects/reference/reference_renderer.h"

namespace gridiron::test {
namespace {

using tool::SceneDescription;
using tool::SceneMaterial;

constexpr std::uint32_t kWidth = 33;  // odd: one ray straight down
constexpr double kNear = 1e-5;        // floats of the camera

// From (0, 0, height) down at the plane z = 0, y up in the picture.
SceneDescription scene_from_above(float height, float angle = 60) {
  return empty_scene({0, 0, height}, {0, 0, 0}, {0, 1, 0}, angle);
}

SceneMaterial matt(Vec3 color, float kd = 1.0f) {
  return {.color = color, .kd = kd};
}

std::uint32_t add_floor(SceneDescription& scene, std::uint16_t material, float size = 50) {
  return add_parallelogram(scene, {-size, -size, 0}, {2 * size, 0, 0}, {0, 2 * size, 0}, material);
}

// Where the ray of a pixel of scene_from_above meets the plane z = 0.
DVec3 seen_point(const SceneDescription& scene, double x, double y, std::uint32_t width = kWidth) {
  const double half = std::tan(0.5 * scene.view.angle_degrees * std::numbers::pi / 180.0) * scene.view.from.z;
  return {half * (2.0 * (x + 0.5) / width - 1.0), half * (1.0 - 2.0 * (y + 0.5) / width), 0.0};
}

template <class Check>
void for_each_pixel(const ReferencePicture& picture, const Check& check) {
  for (std::uint32_t y = 0; y < picture.region.height; ++y) {
    for (std::uint32_t x = 0; x < picture.region.width; ++x) check(x, y, picture.linear[picture.index(x, y)]);
  }
}

// Calls check(pixel, at) for each pixel that shows the floor, the first two triangles: `at` on it, where axis is 0.
template <class Check>
void for_each_floor_point(const SceneDescription& scene, const ReferencePicture& picture, int axis,
                          const Check& check) {
  const ReferenceCamera camera = reference_camera(scene.view, picture.region.width, picture.region.height);
  for_each_pixel(picture, [&](std::uint32_t x, std::uint32_t y, const DVec3&) {
    const std::size_t pixel = picture.index(x, y);
    if (picture.ids[pixel] > 1) return;
    const DVec3 dir(camera.direction(static_cast<float>(x), static_cast<float>(y)));
    check(pixel, DVec3(scene.view.from) - dir * (double{scene.view.from[axis]} / dir[axis]));
  });
}

TEST(ReferenceLight, PlaneUnderAPointLightFollowsLambert) {
  SceneDescription scene = scene_from_above(4);
  add_floor(scene, add_material(scene, matt({0.9f, 0.5f, 0.1f}, 0.8f)));
  scene.point_lights.push_back({{1, 0.5f, 2}, {1.0f, 0.9f, 3.0f}});
  const ReferencePicture picture = render_reference(scene, kWidth, kWidth);
  for_each_pixel(picture, [&](std::uint32_t x, std::uint32_t y, const DVec3& value) {
    const DVec3 to_light = DVec3(1, 0.5, 2) - seen_point(scene, x, y);
    const DVec3 expected = DVec3(0.9, 0.5 * 0.9, 0.1 * 3.0) * (0.8 * to_light.z / glm::length(to_light));
    EXPECT_LT(glm::length(value - expected), kNear) << x << ' ' << y;
  });
  EXPECT_EQ(picture.counts.shadow, kWidth * kWidth);
  // Rounding, of the pixel under the light.
  const DVec3 value = picture.linear[picture.index(20, 14)];
  const std::uint32_t color = picture.color[picture.index(20, 14)];
  EXPECT_EQ(color & 255u, static_cast<std::uint32_t>(std::floor(255.0 * value.x + 0.5)));
  EXPECT_EQ(color >> 24, 255u);
}

TEST(ReferenceLight, NoneComesFromBehindTheSideThatIsSeen) {
  SceneDescription scene = scene_from_above(4);
  add_floor(scene, add_material(scene, matt(Vec3(1))));
  scene.point_lights.push_back({{0, 0, -2}, Vec3(1)});
  const ReferencePicture above = render_reference(scene, 5, 5);
  for (const DVec3& value : above.linear) EXPECT_EQ(value, DVec3(0));
  scene.view.from = {0, 0, -4};
  const ReferencePicture below = render_reference(scene, 5, 5);
  for (const DVec3& value : below.linear) EXPECT_GT(value.x, 0.3) << "both sides are seen";
  EXPECT_NEAR(below.linear[12].x, 1.0, kNear);
}

TEST(ReferenceLight, WhatLiesBeyondALightCastsNoShadow) {
  SceneDescription scene = scene_from_above(4);
  const std::uint16_t white = add_material(scene, matt(Vec3(1)));
  add_floor(scene, white);
  add_parallelogram(scene, {1, -9, 0}, {0, 18, 0}, {0, 0, 18}, white);  // a wall, x = 1
  scene.point_lights.push_back({{0.9f, 0, 1}, Vec3(1)});
  const ReferencePicture picture = render_reference(scene, kWidth, kWidth);
  for (std::size_t i = 0; i < picture.ids.size(); ++i) {
    if (picture.ids[i] < 2) {
      EXPECT_GT(picture.linear[i].x, 0.0) << i;
    }
  }
}

TEST(ReferenceLight, HighlightsAreBlinnsAndSharesAreScaled) {
  SceneDescription scene = scene_from_above(4, 40);
  SceneMaterial shiny = matt(Vec3(0.5f), 0.9f);
  shiny.ks = 0.7f;  // of 1.6 in all
  shiny.shine = 25;
  scene.recursion_depth = 1;
  add_floor(scene, add_material(scene, shiny));
  scene.point_lights.push_back({{1, 0, 3}, Vec3(1)});
  const ReferencePicture picture = render_reference(scene, kWidth, kWidth);
  for_each_pixel(picture, [&](std::uint32_t x, std::uint32_t y, const DVec3& value) {
    const DVec3 at = seen_point(scene, x, y);
    const DVec3 l = glm::normalize(DVec3(1, 0, 3) - at);
    const DVec3 h = glm::normalize(l + glm::normalize(DVec3(0, 0, 4) - at));
    EXPECT_NEAR(value.x, 0.9 / 1.6 * 0.5 * l.z + 0.7 / 1.6 * std::pow(h.z, 25.0), kNear);
  });
}

TEST(ReferenceLight, NormalsAreInterpolatedAndTurnedToTheEye) {
  SceneDescription scene = scene_from_above(4, 40);
  SceneMaterial smooth = matt(Vec3(1));
  smooth.smooth_normals = true;
  const Vec3 corners[3] = {{-5, -5, 0}, {5, -5, 0}, {0, 5, 0}};
  const Vec3 normals[3] = {{-0.6f, 0, 0.8f}, {0.6f, 0, 0.8f}, {0, 0.6f, 0.8f}};
  add_triangle(scene, corners, normals, add_material(scene, smooth));
  scene.point_lights.push_back({{0, 0, 4000}, Vec3(1)});
  for (const float side : {1.0f, -1.0f}) {
    scene.view.from.z = 4 * side;
    scene.point_lights[0].position.z = 4000 * side;
    const ReferencePicture picture = render_reference(scene, kWidth, kWidth);
    for (std::uint32_t y = 0; y < kWidth; ++y) {
      for (std::uint32_t x = 0; x < kWidth; ++x) {
        DVec3 at = seen_point(scene, x, y);
        if (side < 0) at.y = -at.y;  // from below x is mirrored, y is not
        const double w2 = (at.y + 5) / 10, w1 = (at.x + 5 - 5 * w2) / 10, w0 = 1 - w1 - w2;
        const DVec3 m = w0 * DVec3(normals[0]) + w1 * DVec3(normals[1]) + w2 * DVec3(normals[2]);
        EXPECT_NEAR(picture.linear[picture.index(x, y)].x, m.z / glm::length(m), 1e-3) << side;
      }
    }
  }
}

// A square of edge 2 at height 1, a light at height 3: by similar triangles the shadow's edge is 3.
TEST(ReferenceLight, ShadowOfASquareHasTheRightSize) {
  SceneDescription scene = empty_scene({0, -6, 0.6f}, {0, 0, 0}, {0, 0, 1}, 50);
  const std::uint16_t white = add_material(scene, matt(Vec3(1)));
  add_floor(scene, white);
  add_parallelogram(scene, {-1, -1, 1}, {2, 0, 0}, {0, 2, 0}, white);
  scene.point_lights.push_back({{0.2f, 0.1f, 3}, Vec3(1)});
  const ReferencePicture picture = render_reference(scene, 120, 120);
  scene.shadows = false;
  const ReferencePicture unshadowed = render_reference(scene, 120, 120);
  EXPECT_EQ(unshadowed.counts.shadow, 0u);
  std::size_t dark = 0, lit = 0;
  for_each_floor_point(scene, picture, 2, [&](std::size_t i, const DVec3& at) {
    EXPECT_GT(unshadowed.linear[i].x, 0.0);
    // Light + (corner - light) * 3 / 2.
    const double across = std::abs(at.x - 0.2 * -0.5), along = std::abs(at.y - 0.1 * -0.5);
    if (std::abs(across - 1.5) < 1e-4 || std::abs(along - 1.5) < 1e-4) return;
    const bool is_dark = across < 1.5 && along < 1.5;
    (is_dark ? dark : lit) += 1;
    EXPECT_EQ(picture.linear[i].x == 0.0, is_dark) << at.x << ' ' << at.y;
  });
  EXPECT_GT(dark, 300u);
  EXPECT_GT(lit, 300u);
}

// The light's edge is 2 wide at height 2, a half plane x < 0 hangs at height 1, y is far longer: of the light
// that floor point x sees the part beyond -x: (1 + x) / 2 of it, in [0, 1].
TEST(ReferenceLight, HalfAnAreaLightIsSeenUnderAnEdge) {
  constexpr std::uint32_t kSamples = 32;
  SceneDescription scene = empty_scene({0, -3, 0.5f}, {0, 0, 0}, {0, 0, 1}, 50);
  const std::uint16_t white = add_material(scene, matt(Vec3(1)));
  add_floor(scene, white);
  add_parallelogram(scene, {-50, -50, 1}, {50, 0, 0}, {0, 100, 0}, white);
  scene.area_lights.push_back({{-1, -0.001f, 2}, {2, 0, 0}, {0, 0.002f, 0}, Vec3(1), kSamples});
  const ReferencePicture picture = render_reference(scene, 64, 64);
  scene.shadows = false;
  const ReferencePicture all = render_reference(scene, 64, 64);
  std::size_t umbra = 0, penumbra = 0, full = 0;
  for_each_floor_point(scene, picture, 2, [&](std::size_t i, const DVec3& at) {
    if (std::abs(at.y) > 1 || std::abs(std::abs(at.x) - 1) < 1e-4) return;
    // Lambert over the part of the light that is seen: the mean over u of h / (h^2 + (u - x)^2 + y^2)^(1/2).
    const auto integral = [&](double u) { return 0.5 * 2.0 * std::asinh((u - at.x) / std::hypot(2.0, at.y)); };
    const double from = std::min(1.0, std::max(-1.0, -at.x));
    EXPECT_NEAR(all.linear[i].x, integral(1) - integral(-1), 1.0 / kSamples);
    EXPECT_NEAR(picture.linear[i].x, integral(1) - integral(from), 1.5 / kSamples) << at.x;
    if (at.x < -1) {
      EXPECT_EQ(picture.linear[i].x, 0.0);
      ++umbra;
    } else if (at.x > 1) {
      EXPECT_EQ(picture.linear[i].x, all.linear[i].x);
      ++full;
    } else {
      ++penumbra;
    }
  });
  EXPECT_GT(umbra, 20u);
  EXPECT_GT(penumbra, 100u);
  EXPECT_GT(full, 20u);
}

// Wall x = 0 of height h beside the floor: of the light on floor point x the wall's share is (1 - x / |(x, h)|) / 2.
TEST(ReferenceAmbient, CornerOfTwoPlanesHasTheFormFactor) {
  SceneDescription scene = occlusion_corner_scene(3, 1000, 64);
  scene.view.from = {1.5f, 2.5f, 0.01f};
  scene.view.at = {0, 0, 0};
  // Very long along the edge, so that the wall is a strip.
  for (Vec3& v : scene.geometry.vertices) v.z *= 1000;
  const ReferencePicture picture = render_reference(scene, 48, 48);
  double sum = 0.0, expected_sum = 0.0;
  std::size_t floor_pixels = 0, at_the_edge = 0;
  for_each_floor_point(scene, picture, 1, [&](std::size_t i, const DVec3& at) {
    const DVec3& value = picture.linear[i];
    const double expected = 0.5 * (1.0 - 0.5 * (1.0 - at.x / std::hypot(at.x, 3.0)));
    EXPECT_NEAR(value.x, expected, 0.5 * 5.0 / 64.0) << at.x;
    if (at.x < 0.05) {
      EXPECT_NEAR(value.x, 0.25, 0.5 * 4.0 / 64.0) << "half of 0.5";
      ++at_the_edge;
    }
    sum += value.x;
    expected_sum += expected;
    ++floor_pixels;
  });
  ASSERT_GT(floor_pixels, 400u);
  EXPECT_GT(at_the_edge, 10u);
  const double pixels = static_cast<double>(floor_pixels);
  EXPECT_NEAR(sum / pixels, expected_sum / pixels, 0.5 * 0.1 / 64.0) << "jitter has no bias";
}

TEST(ReferenceAmbient, NothingBeyondTheRadiusOccludes) {
  const SceneDescription scene = occlusion_corner_scene(4, 0.25f, 32);
  const ReferencePicture picture = render_reference(scene, 48, 48);
  const ReferenceCamera camera = reference_camera(scene.view, 48, 48);
  std::size_t open = 0, occluded = 0;
  for_each_pixel(picture, [&](std::uint32_t x, std::uint32_t y, const DVec3& value) {
    const std::size_t i = picture.index(x, y);
    if (picture.ids[i] == kReferenceNoTriangle) return;
    const DVec3 dir(camera.direction(static_cast<float>(x), static_cast<float>(y)));
    const DVec3 at = DVec3(scene.view.from) + glm::normalize(dir) * picture.depth[i];
    const double from_edge = picture.ids[i] < 2 ? at.x : at.y;
    if (from_edge > 0.25) {
      EXPECT_EQ(value.x, 0.5);
      ++open;
    } else if (from_edge < 0.1) {
      EXPECT_LT(value.x, 0.5);
      ++occluded;
    }
  });
  EXPECT_GT(open, 500u);
  EXPECT_GT(occluded, 50u);
}

// A half plane's edge through a pixel: its samples outside of the edge count.
TEST(ReferenceSamples, APixelIsTheMeanOfItsSamples) {
  for (const std::uint32_t samples : {1u, 4u, 16u}) {
    for (const bool is_row : {false, true}) {
      for (std::uint32_t k = 0; k <= samples; ++k) {
        SceneDescription scene = scene_from_above(1, 90);
        scene.samples_per_pixel = samples;
        scene.background = Vec3(1);
        scene.recursion_depth = 1;
        // The picture's one pixel goes from -1 to 1; k samples lie on the plane's side.
        const float edge = -1 + 2 * static_cast<float>(k) / static_cast<float>(samples);
        const std::uint16_t black = add_material(scene, matt(Vec3(0)));
        if (is_row) {
          add_parallelogram(scene, {-9, -9 + edge, 0}, {18, 0, 0}, {0, 9, 0}, black);
        } else {
          add_parallelogram(scene, {-9 + edge, -9, 0}, {9, 0, 0}, {0, 18, 0}, black);
        }
        const ReferencePicture picture = render_reference(scene, 1, 1);
        EXPECT_EQ(picture.linear[0].x, 1.0 - static_cast<double>(k) / samples) << samples << ' ' << is_row;
      }
    }
  }
}

}  // namespace
}  // namespace gridiron::test
