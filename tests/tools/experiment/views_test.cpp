// Views: which scenes, from where. SPDX-License-Identifier: Apache-2.0
#include "experiment/views.h"

#include "../gridiron/temporary_folder.h"
#include "base/failure.h"
#include "support/test_mesh.h"

namespace gridiron::test {
namespace {

using namespace experiment;

const std::filesystem::path kScenes = std::filesystem::path(GRIDIRON_SOURCE_DIR) / "scenes";

TEST(Views, WithoutScansATeapotAndAKnotAreMade) {
  for (const std::filesystem::path& folder : {std::filesystem::path(), kScenes}) {
    const FoundViews found = find_views(folder);
    EXPECT_TRUE(found.generated);
    ASSERT_EQ(found.views.size(), 2u);
    EXPECT_EQ(found.missing.size(), 5u);
    const tool::Mesh teapot = tool::read_ply_mesh(kScenes / "teapot.ply");
    const tool::Mesh& made = found.views[0].mesh();
    ASSERT_EQ(made.vertices.size(), teapot.vertices.size());
    ASSERT_EQ(made.triangles.size(), teapot.triangles.size());
    EXPECT_EQ(std::memcmp(made.vertices.data(), teapot.vertices.data(), teapot.vertices.size() * sizeof(Vec3)), 0);
    EXPECT_EQ(std::memcmp(made.triangles.data(), teapot.triangles.data(), teapot.triangles.size() * sizeof(UVec3)), 0);
  }
}

TEST(Views, WhatIsThereIsUsedAndWhatIsNotIsNamed) {
  const TemporaryFolder folder("bunny.ply", make_torus(12, 8, 1.0f, 0.4f));
  folder.write_ply("conference.ply", make_torus(12, 8, 500.0f, 100.0f));
  const FoundViews found = find_views(folder.folder());
  EXPECT_FALSE(found.generated);
  ASSERT_EQ(found.views.size(), 3u);
  EXPECT_EQ(found.views[0].key, "bunny");
  EXPECT_EQ(found.views[1].key, "conference_1");
  EXPECT_EQ(found.views[2].key, "conference_2");
  EXPECT_EQ(found.views[1].scene, found.views[2].scene) << "one mesh for both views";
  ASSERT_EQ(found.missing.size(), 2u);
  EXPECT_NE(found.missing[0].find("horse.ply"), std::string::npos);
  EXPECT_NE(found.missing[1].find("stand-in"), std::string::npos);

  folder.write("horse.ply", "ply\nnonsense\n");
  EXPECT_THROW((void)find_views(folder.folder()), tool::Failure);
}

TEST(Views, CamerasAreThoseOfTheCameraFiles) {
  const TemporaryFolder folder("conference.ply", make_torus(12, 8, 1.0f, 0.4f));
  const FoundViews found = find_views(folder.folder());
  ASSERT_EQ(found.views.size(), 2u);
  for (const View& view : found.views) {
    const tool::ViewRequest file = tool::read_camera_file(kScenes / (view.key + ".camera"));
    EXPECT_EQ(view.camera.eye, file.eye) << view.key;
    EXPECT_EQ(view.camera.at, file.at) << view.key;
    EXPECT_EQ(view.camera.up, file.up) << view.key;
    EXPECT_EQ(view.camera.fov_degrees, file.fov_degrees) << view.key;
  }
}

// The published rule, which triangles without an area do not move.
TEST(Views, ThePublishedCameraStandsOffByTheDiagonal) {
  View view = make_knot_view(600);
  const tool::ViewRequest published = view.camera;
  view.camera = {};
  tool::Mesh mesh = view.mesh();
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), {Vec3(0, 0, 0), Vec3(50, 0, 0), Vec3(100, 0, 0)});
  mesh.triangles.emplace_back(first, first + 1, first + 2);
  view.scene = std::make_shared<const tool::SceneInput>(tool::SceneInput{"knot", std::move(mesh), {}});
  GridNeed need;
  ASSERT_EQ(count_scene_image(view.mesh().view(), {}, need), Status::kOk);
  const View fixed = with_published_camera(view);
  EXPECT_EQ(fixed.camera.eye, published.eye);
  EXPECT_EQ(fixed.camera.at, published.at);
  double squares = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double low = need.grid.bounds_minimum[axis], high = need.grid.bounds_maximum[axis];
    EXPECT_EQ((*fixed.camera.at)[axis], static_cast<float>(0.5 * (low + high)));
    squares += (high - low) * (high - low);
  }
  const double distance = 1.05 * std::sqrt(squares / 1.185);  // (0.35, 0.25, 1) has length sqrt(1.185)
  for (int axis = 0; axis < 3; ++axis) {
    const double step = axis == 0 ? 0.35 : axis == 1 ? 0.25 : 1.0;
    EXPECT_NEAR((*fixed.camera.eye)[axis], (*fixed.camera.at)[axis] + step * distance, 1e-5);
  }
  EXPECT_EQ(fixed.scene, view.scene);

  view.camera.eye = Vec3(1, 2, 30);
  EXPECT_EQ(with_published_camera(view).camera.eye, Vec3(1, 2, 30)) << "what was asked for stays";
  view.scene = std::make_shared<const tool::SceneInput>(tool::SceneInput{"nothing", tool::Mesh{}, {}});
  EXPECT_THROW((void)with_published_camera(view), tool::Failure);
}

TEST(Views, GrowthCountsAreEvenAndRise) {
  EXPECT_EQ(growth_counts(1'000'000),
            (std::vector<std::uint32_t>{10'000, 20'000, 50'000, 100'000, 200'000, 500'000, 1'000'000}));
  EXPECT_EQ(growth_counts(60'000).front(), 600u);
  EXPECT_EQ(growth_counts(6'000), (std::vector<std::uint32_t>{600, 1'200, 3'000, 6'000}));
  EXPECT_EQ(growth_counts(30'000).front(), 600u) << "300 triangles make no knot";
  for (const std::uint32_t count : growth_counts(123'457)) EXPECT_EQ(count % 2, 0u);
  EXPECT_EQ(make_knot_view(600).mesh().triangles.size(), 600u);
}

}  // namespace
}  // namespace gridiron::test
