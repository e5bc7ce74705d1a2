// No shadows in open space, and no light through walls: over scales and places, for balls, boxes, rooms and closed
// scans.
// SPDX-License-Identifier: Apache-2.0
#include <glm/common.hpp>
#include <ostream>

#include "effects/compare_pictures.h"
#include "effects/effect_scene.h"
#include "effects/kernel_check.h"
#include "scene_text/scene_files.h"
#include "support/scenes.h"

namespace gridiron::test {
namespace {

using tool::SceneDescription;

constexpr std::uint32_t kSize = 64;
constexpr std::uint32_t kBlack = 0xFF000000u;

// For bodies of radius 1: their scales, then their places.
struct Place {
  float scale;
  Vec3 offset;
};
std::vector<Place> places() {
  std::vector<Place> all;
  for (int power = -20; power <= 20; power += 5) all.push_back({std::ldexp(1.0f, power), Vec3(0)});
  for (const float distance : {3.0f, 100.0f, 1e3f, 1e4f}) {
    all.push_back({1, Vec3(distance)});
    all.push_back({1, {distance, -0.3f * distance, 7}});
  }
  // Farther away a float's steps are as large as the triangles of a body of radius 1.
  for (const float distance : {1e5f, 1e6f}) all.push_back({100, {distance, 0.1f * distance, -distance}});
  return all;
}
std::string words_of(const Place& place) {
  return "scale " + std::to_string(place.scale) + " at " + std::to_string(place.offset.x) + " " +
         std::to_string(place.offset.y) + " " + std::to_string(place.offset.z);
}

std::size_t lit_pixels(const KernelPicture& picture) {
  return static_cast<std::size_t>(std::ranges::count_if(picture.color, [](auto color) { return color != kBlack; }));
}

// --- Acne.

TEST(KernelAcne, NothingLiesBetweenAConvexBodyAndALightThatItFaces) {
  for (const Place& place : places()) {
    for (const AcneLight light : {AcneLight::kPoint, AcneLight::kArea}) {
      SCOPED_TRACE(words_of(place) + ", light " + std::to_string(static_cast<int>(light)));
      // Rounded to places a float's step apart, only a ball of few facets stays convex.
      const bool is_far = std::abs(place.offset.x) > 300;
      SceneDescription scene = acne_scene(light, place.scale, place.offset, is_far ? 4 : 12);
      const KernelPicture shadowed = render_scene(scene, kSize, kSize);
      ASSERT_EQ(shadowed.status, Status::kOk);
      scene.shadows = false;
      const KernelPicture plain = render_scene(scene, kSize, kSize);
      EXPECT_GT(lit_pixels(plain), kSize * kSize / 4);
      EXPECT_GT(shadowed.work[Work::kShadowRay], 0u);
      // A step apart: the lift of points depends on whether rays come from lights.
      const auto steps = compare_steps(shadowed.color, plain.color);
      ASSERT_TRUE(steps.has_value());
      EXPECT_EQ(steps->off_by_more_than_1, 0u) << "by up to " << steps->largest << " at " << steps->worst_pixel;
    }
  }
}

// The rounding of the light's place decides, on either side of 0: far beyond the body, near by the scene's size.
TEST(KernelAcne, NothingLiesBetweenASmallBodyAndALightFarOff) {
  for (const float sign : {1.0f, -1.0f}) {
    SceneDescription scene = empty_scene(sign * Vec3(3, 2, 3.5f), {0, 0, 0}, {0, 1, 0}, 32);
    const std::uint16_t white = add_material(scene, {});
    add_ball(scene, Vec3(0), 1, 12, white);
    add_triangle(scene, {-sign * Vec3(1e4f), -sign * Vec3(1e4f, 9e3f, 1e4f), -sign * Vec3(9e3f, 1e4f, 1e4f)}, white);
    scene.point_lights.push_back({sign * Vec3(3e4f, 2e4f, 3.5e4f), Vec3(1)});
    const KernelPicture shadowed = render_scene(scene, kSize, kSize);
    scene.shadows = false;
    const auto steps = compare_steps(shadowed.color, render_scene(scene, kSize, kSize).color);
    EXPECT_EQ(steps.value().off_by_more_than_1, 0u) << sign;
  }
}

TEST(KernelAcne, AConvexBodyOccludesNothingOfItself) {
  for (const Place& place : places()) {
    SCOPED_TRACE(words_of(place));
    const bool is_far = std::abs(place.offset.x) > 300;
    const SceneDescription scene =
        acne_scene(AcneLight::kAmbient, place.scale, place.offset, is_far ? 4 : 12);
    const KernelPicture picture = render_scene(scene, kSize, kSize);
    ASSERT_EQ(picture.status, Status::kOk);
    std::size_t open = 0;
    for (const std::uint32_t color : picture.color) {
      EXPECT_TRUE(color == kBlack || color == 0xFF808080u) << std::hex << color;
      open += color == 0xFF808080u;
    }
    EXPECT_GT(open, kSize * kSize / 4u);
  }
}

// Scans that are closed, and bodies of needles: a light at the eye sees what the eye sees.
struct Body {
  const char* name;
  bool is_shared;  ///< of GRIDIRON_SCENES; else of scenes/
  bool has_needles = false;
};
void PrintTo(const Body& body, std::ostream* out) {
  *out << body.name;
}
class KernelAcneOfScans : public testing::TestWithParam<Body> {};

TEST_P(KernelAcneOfScans, NothingLiesBetweenWhatIsSeenAndALightAtTheEye) {
  const Body& body = GetParam();
  std::filesystem::path path = std::filesystem::path(GRIDIRON_SOURCE_DIR) / "scenes" / body.name;
  if (body.is_shared) {
    const SharedFile file = find_scene(body.name);
    GRIDIRON_SKIP_IF_MISSING(file);
    path = file.path;
  }
  const tool::SceneMesh mesh = tool::read_scene_mesh(path, std::nullopt);
  Vec3 low = mesh.vertices[0], high = low;
  for (const Vec3& vertex : mesh.vertices) {
    low = glm::min(low, vertex);
    high = glm::max(high, vertex);
  }
  const Vec3 extent = high - low;
  const float size = std::max({extent.x, extent.y, extent.z});
  for (const Place& place : {Place{1, Vec3(0)}, {1, Vec3(1e3f)}, {100, Vec3(1e3f)}, {100, Vec3(1e6f)}}) {
    SCOPED_TRACE(words_of(place));
    SceneDescription scene = empty_scene({0.7f, 0.5f, 2}, {0, 0, 0}, {0, 1, 0}, 32);
    const std::uint16_t white = add_material(scene, {});
    for (const Vec3& vertex : mesh.vertices) {
      scene.geometry.vertices.push_back((vertex - 0.5f * (low + high)) / size);
    }
    scene.geometry.triangles.assign(mesh.triangles.begin(), mesh.triangles.end());
    scene.geometry.triangle_materials.assign(scene.geometry.triangles.size(), white);
    scene.point_lights.push_back({scene.view.from, Vec3(1)});
    transform_scene(scene, place.scale, place.offset);
    const KernelOptions planes{.wants_planes = true};
    const KernelPicture shadowed = render_scene(scene, 2 * kSize, 2 * kSize, planes);
    ASSERT_EQ(shadowed.status, Status::kOk);
    scene.shadows = false;
    const KernelPicture plain = render_scene(scene, 2 * kSize, 2 * kSize, planes);
    std::size_t facing = 0, dark = 0, inner = 0, inner_dark = 0;
    for (std::size_t i = 0; i < plain.color.size(); ++i) {
      if (brightest(plain.color[i]) < 26) continue;  // n.l of 0.1
      ++facing;
      const bool is_dark = brightest(shadowed.color[i]) + 1 < brightest(plain.color[i]);
      dark += is_dark;
      // Beside a rim that hides something behind it the lifted point may lie on the rim's other side: those pixels are
      // left aside whose surroundings are not at one depth.
      const std::size_t x = i % (2 * kSize), y = i / (2 * kSize);
      if (x < 2 || y < 2 || x + 2 >= 2 * kSize || y + 2 >= 2 * kSize) continue;
      float nearest = plain.depth[i], farthest = nearest;
      for (std::size_t v = y - 2; v <= y + 2; ++v) {
        for (std::size_t u = x - 2; u <= x + 2; ++u) {
          nearest = std::min(nearest, plain.depth[v * 2 * kSize + u]);
          farthest = std::max(farthest, plain.depth[v * 2 * kSize + u]);
        }
      }
      if (!(farthest - nearest < 0.05f * place.scale)) continue;
      ++inner;
      inner_dark += is_dark;
    }
    EXPECT_GT(facing, 1000u);
    if (std::getenv("GRIDIRON_TELL_PICTURES") != nullptr) {
      std::printf("%s, %s: %zu pixels, %zu dark; inner ones: %zu, %zu\n", body.name, words_of(place).c_str(), facing,
                  dark, inner, inner_dark);
    }
    if (body.has_needles) {
      // Triangles lower than 48 E (ray/secondary_origin.h): nothing is promised, the less the farther away.
      EXPECT_LE(dark, place.offset.x == 0 ? facing / 100 : facing);
      continue;
    }
    EXPECT_EQ(inner_dark, 0u) << "of " << inner;
    EXPECT_LE(dark, facing / 200);
  }
}

INSTANTIATE_TEST_SUITE_P(Closed, KernelAcneOfScans,
                         testing::Values(Body{"teapot.ply", false}, Body{"needles.ply", false, true},
                                         Body{"horse.ply", true},
                                         Body{"armadillo_standin_345944.ply", true}),
                         [](const auto& body) {
                           const std::string name = body.param.name;
                           return name.substr(0, name.find_first_of("_."));
                         });

// --- Leaks.

// A light in a closed body, above a floor that the body does not touch: no part of the floor is lit.
TEST(KernelLeaks, NoLightGetsOutOfAClosedBody) {
  for (const Place& place : places()) {
    for (const bool is_ball : {false, true}) {
      for (const Vec3 light : {Vec3(0), Vec3(0.1f, -0.3f, 0.05f), Vec3(0.3f, 0.3f, 0.3f), Vec3(-0.39f, 0, 0.2f)}) {
        SCOPED_TRACE(words_of(place) + (is_ball ? ", ball" : ", box") + ", light " + std::to_string(light.x));
        SceneDescription scene = empty_scene({0.3f, 2.2f, 2.5f}, {0, 0, 0}, {0, 1, 0}, 50);
        const std::uint16_t white = add_material(scene, {});
        if (is_ball) {
          add_ball(scene, Vec3(0), 0.7f, 6, white);
        } else {
          add_box(scene, Vec3(-0.4f), Vec3(0.4f), white);
        }
        add_parallelogram(scene, {-2, -1, 2}, {4, 0, 0}, {0, 0, -4}, white);
        scene.point_lights.push_back({light, Vec3(1)});
        scene.area_lights.push_back({light - Vec3(0.005f), {0.01f, 0, 0}, {0, 0, 0.01f}, Vec3(1), 4});
        transform_scene(scene, place.scale, place.offset);
        const KernelPicture picture = render_scene(scene, kSize, kSize);
        ASSERT_EQ(picture.status, Status::kOk);
        EXPECT_GT(picture.work[Work::kShadowRay], kSize * kSize / 8u);
        EXPECT_EQ(lit_pixels(picture), 0u);
        if (place.scale != 1 || place.offset.x != 0) continue;
        scene.shadows = false;  // the floor would be lit
        EXPECT_GT(lit_pixels(render_scene(scene, kSize, kSize)), kSize * kSize / 8u);
      }
    }
  }
}

// A room without windows: light from outside, the environment and any ambient light stay out.
TEST(KernelLeaks, NoLightGetsIntoAClosedRoom) {
  for (const Place& place : places()) {
    SCOPED_TRACE(words_of(place));
    const auto room = [&](const tool::SceneMaterial& material) {
      SceneDescription scene = empty_scene({0.8f, 0.5f, 0.9f}, {-0.5f, -0.4f, -0.6f}, {0, 1, 0}, 95);
      add_box(scene, Vec3(-1), Vec3(1), add_material(scene, material), /*is_inwards=*/true);
      return scene;
    };
    // Lights outside: behind the walls, one above an edge, one above a corner.
    SceneDescription lit = room({});
    for (const Vec3 light : {Vec3(0, 3, 0), Vec3(1.01f, 1.01f, 0.2f), Vec3(-1.5f, -1.5f, -1.5f), Vec3(0, 0, -1.01f)}) {
      lit.point_lights.push_back({light, Vec3(1)});
    }
    lit.area_lights.push_back({{-1.5f, -0.5f, -0.5f}, {0, 1, 0}, {0, 0, 1}, Vec3(1), 4});
    transform_scene(lit, place.scale, place.offset);
    EXPECT_EQ(lit_pixels(render_scene(lit, kSize, kSize)), 0u) << "lights";

    SceneDescription ambient = room({});
    ambient.ambient_occlusion = tool::AmbientOcclusion{8, 5.0f};
    transform_scene(ambient, place.scale, place.offset);
    const KernelPicture closed = render_scene(ambient, kSize, kSize);
    EXPECT_GT(closed.work[Work::kOcclusionRay], 4 * kSize * kSize);
    EXPECT_EQ(lit_pixels(closed), 0u) << "ambient occlusion";

    // Mirrors all around: seven reflections of each eye ray, and none gets out.
    SceneDescription mirrors = room({.kd = 0, .ks = 1});
    set_environment(mirrors, Vec3(1));
    mirrors.recursion_depth = 8;
    transform_scene(mirrors, place.scale, place.offset);
    const KernelPicture reflected = render_scene(mirrors, kSize, kSize);
    EXPECT_EQ(reflected.work[Work::kMirrorRay], 7 * kSize * kSize);
    EXPECT_EQ(reflected.work[Work::kEnvironmentLookup], 0u) << "mirrors";
  }
}

}  // namespace
}  // namespace gridiron::test
