// View: given parts, and defaults. SPDX-License-Identifier: Apache-2.0
#include "gridiron/scene/view.h"

#include "failure_of.h"

namespace gridiron::test {
namespace {

// A view needs only the corners of a box.
void box(const tool::PointVisitor& visitor) {
  const Vec3 corners[] = {{-1, 0, 2}, {3, 2, 6}, {-1, 2, 2}, {3, 0, 6}};
  visitor(corners);
}

TEST(View, FramesWhatIsNotAskedFor) {
  const Camera camera = tool::complete_view({}, 1.0, box);
  EXPECT_EQ(camera.up, Vec3(0, 1, 0));
  EXPECT_FLOAT_EQ(camera.tan_half_fov, 0.41421356f);
  EXPECT_GT(camera.eye.z, 6.0f);
  EXPECT_GT(camera.eye.x, camera.at.x) << "a little from the right";
  EXPECT_GT(camera.eye.y, camera.at.y) << "a little from above";
}

TEST(View, WhatIsAskedForStays) {
  const Camera camera =
      tool::complete_view({.eye = Vec3(9, 8, 7), .at = {}, .up = Vec3(0, 0, 1), .fov_degrees = 90.0f}, 1.0, box);
  EXPECT_EQ(camera.eye, Vec3(9, 8, 7));
  EXPECT_EQ(camera.at, Vec3(1, 1, 4));
  EXPECT_EQ(camera.up, Vec3(0, 0, 1));
  EXPECT_FLOAT_EQ(camera.tan_half_fov, 1.0f);
}

TEST(View, DefectsAreUsageErrors) {
  const tool::ViewRequest defects[] = {
      {.eye = Vec3(1, 1, 4), .at = {}, .up = {}, .fov_degrees = {}},
      {.eye = Vec3(1, 9, 4), .at = {}, .up = {}, .fov_degrees = {}},
      {.eye = {}, .at = {}, .up = Vec3(0), .fov_degrees = {}},
  };
  for (const tool::ViewRequest& defect : defects) {
    SCOPED_TRACE(&defect - defects);
    (void)failure_of([&] { return tool::complete_view(defect, 1.0, box); }, tool::ExitCode::kUsage);
  }
}

}  // namespace
}  // namespace gridiron::test
