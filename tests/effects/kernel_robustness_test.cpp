// Implausible numbers, energy that must not grow, pictures of odd sizes.
// SPDX-License-Identifier: Apache-2.0
#include <ostream>

#include "effects/effect_scene.h"
#include "effects/kernel_check.h"

namespace gridiron::test {
namespace {

using tool::SceneDescription;
using tool::SceneMaterial;

constexpr std::uint32_t kSize = 48;

SceneMaterial shares(float kd, float ks, float transmittance, float index, bool is_smooth = false) {
  return {.kd = kd,
          .ks = ks,
          .transmittance = transmittance,
          .index_of_refraction = transmittance > 0 ? index : 1.0f,
          .smooth_normals = is_smooth};
}

// --- Furnaces: in an environment of one half nothing is brighter than that.

TEST(KernelFurnace, EnergyNeverGrows) {
  const SceneMaterial materials[] = {
      shares(0, 1, 0, 1),          shares(0, 1, 0, 1, true),          shares(0, 0, 1, 1.5f),
      shares(0, 0.1f, 0.9f, 1.5f), shares(0, 0, 1, 1.5f, true),       shares(0, 0.5f, 0.5f, 10.0f),
      shares(0, 0, 1, 0.1f),       shares(0, 0.3f, 0.7f, 0.1f, true), shares(0, 1, 1, 1.3f),
      shares(0, 0.9f, 0.6f, 2.4f), shares(1, 1, 1, 1.5f),             shares(0, 0, 1, 1),
  };
  for (std::size_t i = 0; i < std::size(materials); ++i) {
    for (const bool is_ball : {false, true}) {
      const SceneMaterial& material = materials[i];
      if (!is_ball && material.smooth_normals) continue;
      SCOPED_TRACE("material " + std::to_string(i) + (is_ball ? ", ball" : ", box"));
      SceneDescription scene = is_ball ? furnace_ball_scene(material, 3) : furnace_box_scene(material);
      set_environment(scene, Vec3(0.502f), 3);  // 128.01 steps, so that rounding does not tip
      const KernelPicture picture = render_scene(scene, kSize, kSize);
      ASSERT_EQ(picture.status, Status::kOk);
      std::uint32_t most = 0;
      for (const std::uint32_t color : picture.color) most = std::max(most, brightest(color));
      EXPECT_EQ(most, 128u);  // around the body; on it not above
      // A mirror keeps all of it, in one reflection off a convex body.
      if (material.ks == 1 && material.transmittance == 0) {
        for (const std::uint32_t color : picture.color) ASSERT_EQ(color, 0xFF808080u);
      }
      // Glass of index 1 reflects nothing, or what rounding makes of it: rays of share 0 are not made.
      const bool is_air = material.transmittance > 0 && material.index_of_refraction == 1;
      expect_reference(scene, kSize, kSize, {4, is_air ? 0.1 : 2e-3, 0.15});
    }
  }
}

// --- Hostile scenes.

SceneDescription floor_scene() {
  SceneDescription scene = empty_scene({0.5f, 1.5f, 4}, {0, 0, 0}, {0, 1, 0}, 45);
  scene.background = {0.1f, 0.2f, 0.3f};
  const std::uint16_t white = add_material(scene, {});
  add_parallelogram(scene, {-2, 0, 2}, {4, 0, 0}, {0, 0, -4}, white);
  add_box(scene, {-0.5f, 0, -0.5f}, {0.5f, 1, 0.5f}, white);
  return scene;
}

constexpr std::size_t kAny = ~std::size_t{0};
struct HostileCase {
  std::string_view name;
  SceneDescription (*scene)();
  std::size_t off = kAny;  ///< pixels that may differ from the reference; kAny: rounding decides what is seen

  friend void PrintTo(const HostileCase& hostile, std::ostream* out) { *out << hostile.name; }
};

template <int Kind>
SceneDescription point_lit() {
  SceneDescription scene = floor_scene();
  constexpr Vec3 kPlaces[] = {{1, 0, 1}, {0.5f, 1, 0.5f}, {0, 1, 0}, {0.5f, 1.5f, 4}, {0, 0.5f, 0}, {-2, 0, 2}};
  scene.point_lights.push_back({kPlaces[Kind], Vec3(0.8f)});
  return scene;
}

SceneDescription glass_around_the_eye(float index, bool is_smooth) {
  SceneDescription scene = floor_scene();
  add_ball(scene, scene.view.from, 0.8f, 3, add_material(scene, shares(0, 0.1f, 0.9f, index, is_smooth)));
  scene.point_lights.push_back({{2, 4, 3}, Vec3(1)});
  scene.recursion_depth = 6;
  return scene;
}

SceneDescription turned_normals(bool is_zero) {
  SceneDescription scene = empty_scene({0.1f, 0.2f, 3}, {0, 0, 0}, {0, 1, 0}, 45);
  SceneMaterial material = shares(0.6f, 0.3f, 0.1f, 1.5f, true);
  material.shine = 30;
  const std::uint16_t smooth = add_material(scene, material);
  const Vec3 out(0, 0, is_zero ? 1.0f : -1.0f), other = is_zero ? -out : Vec3(0.6f, 0, -0.8f);
  const Vec3 corners[2][3] = {{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}}, {{-1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}};
  for (const auto& triangle : corners) add_triangle(scene, triangle, {out, other, other}, smooth);
  set_environment(scene, {0.2f, 0.3f, 0.1f}, 2);
  scene.point_lights.push_back({{1, 1, 3}, Vec3(0.7f)});
  scene.ambient_occlusion = tool::AmbientOcclusion{4, 1};
  return scene;
}

const HostileCase kHostile[] = {
    {"light_on_a_surface", point_lit<0>},  // is the surface between? Of rays from lights, t there is 0, else 1.
    {"light_at_a_vertex", point_lit<1>},
    {"light_on_a_face", point_lit<2>},
    {"light_at_the_eye", point_lit<3>, 8},
    {"light_in_a_box", point_lit<4>, 8},
    {"light_at_a_corner_of_the_floor", point_lit<5>},
    {"area_light_through_what_it_lights",
     [] {
       SceneDescription scene = floor_scene();
       scene.area_lights.push_back({{1, -0.5f, 0.2f}, {0, 1, 0.3f}, {0.5f, 0, 1}, Vec3(1), 16});
       scene.area_lights.push_back({{-0.8f, 0.5f, 0}, {1.6f, 0, 0}, {0, 0.2f, 0.7f}, Vec3(1), 16});
       return scene;
     },
     64},
    {"area_light_in_the_floor",
     [] {
       SceneDescription scene = floor_scene();
       scene.area_lights.push_back({{0.6f, 0, 0.6f}, {1, 0, 0}, {0, 0, 1}, Vec3(1), 16});
       return scene;
     }},
    {"normals_turned_away", [] { return turned_normals(false); }, 4},
    {"normals_of_no_length", [] { return turned_normals(true); }, 40},
    {"eye_in_glass", [] { return glass_around_the_eye(1.5f, false); }, 24},
    {"eye_in_smooth_glass", [] { return glass_around_the_eye(1.5f, true); }, 60},
    {"eye_in_glass_of_index_10", [] { return glass_around_the_eye(10, false); }, 24},
    {"eye_in_glass_of_index_a_tenth", [] { return glass_around_the_eye(0.1f, false); }, 24},
    {"grazing_eye",
     [] {
       SceneDescription scene = floor_scene();
       scene.view.from = {0.1f, 1e-4f, 30};
       scene.view.at = {0, 0, 0};
       scene.view.angle_degrees = 4;
       scene.point_lights.push_back({{0, 1e-3f, 10}, Vec3(1)});
       scene.materials[0] = shares(0.5f, 0.5f, 0, 1);
       return scene;
     },
     24},
    {"eye_in_the_plane_of_the_floor",
     [] {
       SceneDescription scene = floor_scene();
       scene.view.from = {0, 0, 4};
       scene.view.at = {0, 0, 0};
       scene.point_lights.push_back({{2, 2, 2}, Vec3(1)});
       return scene;
     }},
    {"environment_of_1e30",
     [] {
       SceneDescription scene = furnace_ball_scene(shares(0, 0.3f, 0.7f, 1.5f, true), 3);
       set_environment(scene, Vec3(0.25f), 4);
       for (auto& face : scene.environment->texels) face[5] = Vec3(1e30f, 0, 1e-30f);
       scene.samples_per_pixel = 16;
       return scene;
     },
     24},
    {"lights_of_1e6",
     [] {
       SceneDescription scene = floor_scene();
       scene.materials[0] = shares(0.5f, 0.5f, 0, 1);
       scene.materials[0].shine = 1e5f;
       for (int i = 0; i < 8; ++i) scene.point_lights.push_back({{2, 1 + 0.1f * static_cast<float>(i), 3}, Vec3(1e6f)});
       scene.area_lights.push_back({{-2, 3, 2}, {0.1f, 0, 0}, {0, 0, 0.1f}, Vec3(1e6f), 64});
       return scene;
     },
     8},
    {"light_far_away",
     [] {
       SceneDescription scene = floor_scene();
       scene.point_lights.push_back({{3e5f, 4e5f, 2e5f}, Vec3(0.8f)});
       return scene;
     },
     8},
    {"occlusion_of_any_radius",
     [] {
       SceneDescription scene = floor_scene();
       scene.ambient_occlusion = tool::AmbientOcclusion{16, 1e4f};
       return scene;
     },
     8},
};

class KernelHostile : public testing::TestWithParam<HostileCase> {};

TEST_P(KernelHostile, ScenesGiveTheSamePictureAlways) {
  const SceneDescription scene = GetParam().scene();
  const KernelPicture picture = render_scene(scene, kSize, kSize);
  ASSERT_EQ(picture.status, Status::kOk) << picture.violation;
  EXPECT_EQ(picture.violation, "");
  for (const std::uint32_t color : picture.color) ASSERT_EQ(color >> 24, 255u);
  KernelOptions other{.queue_depth = 5, .moves_late = true};
  const KernelPicture again = render_scene(scene, kSize, kSize, other);
  EXPECT_EQ(again.color, picture.color);
  EXPECT_EQ(different_work(again.work, picture.work, {Work::kWait}), "");
  other.fetch_depth = 3;
  const KernelPicture shallow = render_scene(scene, kSize, kSize, other);
  EXPECT_EQ(shallow.color, picture.color);
  EXPECT_EQ(different_but_in_transfers(shallow.work, picture.work), "");
  other.lambda = 0.7f;
  EXPECT_EQ(render_scene(scene, kSize, kSize, other).color, picture.color);
  if (GetParam().off != kAny) expect_reference(scene, kSize, kSize, {GetParam().off, 0.01, 0.25});
}

INSTANTIATE_TEST_SUITE_P(Scenes, KernelHostile, testing::ValuesIn(kHostile),
                         [](const auto& hostile) { return std::string(hostile.param.name); });

// --- Odd sizes: jitter and places are those of the pixel, whatever its tile.

TEST(KernelSizes, OddPicturesAreTheReferencesPictures) {
  SceneDescription scene = glass_ball_scene(/*is_smooth=*/false, 4);
  scene.area_lights.push_back({{1, 4, 1}, {1, 0, 0}, {0, 0, 1}, Vec3(0.5f), 4});
  scene.ambient_occlusion = tool::AmbientOcclusion{4, 1};
  scene.samples_per_pixel = 4;
  constexpr std::pair<std::uint32_t, std::uint32_t> kSizes[] = {{1, 1},  {2, 1},   {1, 100}, {100, 1}, {33, 17},
                                                                {31, 33}, {32, 32}, {65, 3},  {64, 1},  {1, 64}};
  for (const auto& [width, height] : kSizes) {
    SCOPED_TRACE(std::to_string(width) + " x " + std::to_string(height));
    expect_reference(scene, width, height, {width * height / 50 + 2, 5e-3, 0.6});
  }
}

TEST(KernelSizes, ScenesOfOneTriangle) {
  SceneDescription scene = empty_scene({0, 0, 3}, {0, 0, 0}, {0, 1, 0}, 45);
  add_triangle(scene, {{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}}, add_material(scene, shares(0.5f, 0.5f, 0, 1)));
  scene.point_lights.push_back({{1, 1, 2}, Vec3(1)});
  scene.ambient_occlusion = tool::AmbientOcclusion{8, 2};
  set_environment(scene, {0.1f, 0.7f, 0.4f});
  expect_reference(scene, 40, 40, {});
}

}  // namespace
}  // namespace gridiron::test
