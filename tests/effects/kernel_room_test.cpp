// More than the local store can hold: materials, lights, rays that wait.
// SPDX-License-Identifier: Apache-2.0
#include "effects/effect_scene.h"
#include "effects/kernel_check.h"

namespace gridiron::test {
namespace {

using tool::SceneDescription;

// 200 materials where 64 are kept.
SceneDescription scene_of_materials() {
  SceneDescription scene = empty_scene({0, 0, 6}, {0, 0, 0}, {0, 1, 0}, 40);
  scene.point_lights.push_back({{1, 2, 5}, Vec3(1)});
  for (std::uint32_t i = 0; i < 200; ++i) {
    const tool::SceneMaterial material{
        .color = Vec3(static_cast<float>(i % 7) / 6, static_cast<float>(i % 11) / 10, static_cast<float>(i) / 199),
        .ks = i % 5 == 0 ? 0.3f : 0.0f,
        .smooth_normals = i % 3 == 0};
    // Neighbours 64 apart share a slot.
    const std::uint32_t place = i % 2 == 0 ? i / 2 : 199 - i / 2;
    const Vec3 center(static_cast<float>(place % 20) * 0.2f - 1.9f, static_cast<float>(place / 20) * 0.4f - 1.8f, 0);
    add_ball(scene, center, 0.12f, 1, add_material(scene, material));
  }
  return scene;
}

// Equal to the reference, and the same by other orders of work.
TEST(KernelRoom, MoreMaterialsThanSlots) {
  const SceneDescription scene = scene_of_materials();
  expect_reference(scene, 64, 64, {4, 2e-3, 0.1});
  const KernelOptions one_at_once{.fetch_depth = 1};
  EXPECT_EQ(render_scene(scene, 64, 64).color, render_scene(scene, 64, 64, one_at_once).color);
}

TEST(KernelRoom, MoreLightsThanSlots) {
  SceneDescription scene = mirror_room_scene();
  scene.recursion_depth = 2;
  scene.point_lights.clear();
  for (std::uint32_t i = 0; i < 37; ++i) {
    const float turn = static_cast<float>(i) * 0.17f;
    scene.point_lights.push_back({{1.5f * std::cos(turn), 1.7f - 0.05f * static_cast<float>(i), 1.5f * std::sin(turn)},
                                  Vec3(static_cast<float>(i % 3 + 1), static_cast<float>(i % 5 + 1), 3) * 0.012f});
  }
  for (std::uint32_t i = 0; i < 5; ++i) {
    scene.area_lights.push_back({{static_cast<float>(i) * 0.4f - 1, 1.8f, 0}, {0.3f, 0, 0}, {0, 0, 0.3f},
                                 Vec3(0.05f, 0.02f * static_cast<float>(i), 0.04f), 3});
  }
  // 52 rays from each point, many of them through corners of the room.
  expect_reference(scene, 48, 48, {10, 1e-3, 0.12});
}

// What a tile moves does not depend on the tile before it, so that any core may have it: of 200 materials, and of 20
// lights where 16 are at hand.
TEST(KernelRoom, TilesMoveTheSameWhicheverComesFirst) {
  SceneDescription scene = scene_of_materials();
  for (const std::size_t light_count : {1u, 20u}) {
    SCOPED_TRACE(light_count);
    scene.point_lights.resize(light_count, scene.point_lights.front());
    KernelOptions options;
    const KernelPicture forwards = render_scene(scene, 64, 64, options);
    ASSERT_EQ(forwards.status, Status::kOk) << forwards.violation;
    ASSERT_EQ(forwards.tile_bytes.size(), 4u);
    options.claims_backwards = true;
    KernelPicture backwards = render_scene(scene, 64, 64, options);
    EXPECT_EQ(backwards.color, forwards.color);
    std::reverse(backwards.tile_bytes.begin(), backwards.tile_bytes.end());
    EXPECT_EQ(backwards.tile_bytes, forwards.tile_bytes);
  }
}

TEST(KernelRoom, AllLightsThatAreAllowed) {
  SceneDescription scene = acne_scene(AcneLight::kPoint, 1, Vec3(0), 4);
  scene.point_lights.clear();
  for (std::uint32_t i = 0; i < kMaxLights; ++i) {
    const float turn = static_cast<float>(i) * 0.024543693f;
    scene.point_lights.push_back({{6 * std::cos(turn), 3, 6 * std::sin(turn)}, Vec3(0.006f)});
  }
  expect_reference(scene, 32, 32, {2, 1e-3, 0.12});
}

// Rays that wait overflow the local store, and come back: a stack of panes of glass that all reflect and refract.
TEST(KernelRoom, RaysThatWaitInMainMemory) {
  SceneDescription scene = empty_scene({0.2f, 0.3f, 4}, {0, 0, 0}, {0, 1, 0}, 30);
  const tool::SceneMaterial glass{
      .color = {0.9f, 0.95f, 1}, .kd = 0.1f, .ks = 0.2f, .transmittance = 0.7f, .index_of_refraction = 1.2f};
  const std::uint16_t index = add_material(scene, glass);
  for (int i = 0; i < 5; ++i) {
    const float z = 1.0f - 0.5f * static_cast<float>(i);
    add_box(scene, {-3, -3, z}, {3, 3, z + 0.2f}, index);
  }
  scene.recursion_depth = 8;
  scene.shadows = false;
  scene.background = {0.9f, 0.6f, 0.3f};
  scene.point_lights.push_back({{1, 2, 6}, Vec3(0.7f)});
  const KernelPicture picture = render_scene(scene, 40, 40);
  ASSERT_EQ(picture.status, Status::kOk) << picture.violation;
  ASSERT_GT(picture.spilled_bytes, 100u * 128 * sizeof(QueuedRay));
  // What was put came back, all of it.
  expect_reference(scene, 40, 40, {0, 0.0, 0.12});
  for (const std::uint32_t depth : {1u, 3u}) {
    KernelOptions options{.queue_depth = depth, .moves_late = true};
    const KernelPicture other = render_scene(scene, 40, 40, options);
    EXPECT_EQ(other.color, picture.color);
    EXPECT_EQ(other.spilled_bytes, picture.spilled_bytes);
    EXPECT_EQ(different_work(other.work, picture.work, {Work::kWait}), "");
    options.fetch_depth = depth;
    const KernelPicture shallow = render_scene(scene, 40, 40, options);
    EXPECT_EQ(shallow.color, picture.color);
    EXPECT_EQ(shallow.spilled_bytes, picture.spilled_bytes);
    EXPECT_EQ(different_but_in_transfers(shallow.work, picture.work), "");
  }
  // A room of half mirrors makes one ray of each: a picture with as few pixels as the queue holds spills nothing.
  EXPECT_EQ(render_scene(mirror_room_scene(), 16, 16).spilled_bytes, 0u);
}

}  // namespace
}  // namespace gridiron::test
