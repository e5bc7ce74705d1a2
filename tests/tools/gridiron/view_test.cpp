// View: the framing rule. SPDX-License-Identifier: Apache-2.0
#include "gridiron/view.h"

#include <gtest/gtest.h>

#include <cmath>

#include "gridiron/failure.h"

namespace gridiron::test {
namespace {

constexpr float kMinimum[3] = {-1, 0, 2}, kMaximum[3] = {3, 2, 6};

TEST(View, FramesTheBounds) {
  const Camera camera = tool::frame_view({}, kMinimum, kMaximum);
  EXPECT_EQ(camera.at, Vec3(1, 1, 4));
  EXPECT_EQ(camera.up, Vec3(0, 1, 0));
  // Diagonal 6; n = (0.35, 0.25, 1) has length sqrt(1.185).
  const double distance = 1.05 * 6 / std::sqrt(1.185);
  EXPECT_FLOAT_EQ(camera.eye.x, static_cast<float>(1 + 0.35 * distance));
  EXPECT_FLOAT_EQ(camera.eye.y, static_cast<float>(1 + 0.25 * distance));
  EXPECT_FLOAT_EQ(camera.eye.z, static_cast<float>(4 + distance));
  EXPECT_FLOAT_EQ(camera.tan_half_fov, 0.41421356f);
}

TEST(View, WhatIsAskedForReplacesTheFraming) {
  const Camera camera =
      tool::frame_view({.eye = Vec3(9, 8, 7), .at = {}, .up = Vec3(0, 0, 1), .fov_degrees = 90.0f}, kMinimum, kMaximum);
  EXPECT_EQ(camera.eye, Vec3(9, 8, 7));
  EXPECT_EQ(camera.at, Vec3(1, 1, 4));
  EXPECT_EQ(camera.up, Vec3(0, 0, 1));
  EXPECT_FLOAT_EQ(camera.tan_half_fov, 1.0f);
}

TEST(View, AnotherPointIsFramedFromTheSameSide) {
  const Camera framed = tool::frame_view({}, kMinimum, kMaximum);
  const Camera moved =
      tool::frame_view({.eye = {}, .at = Vec3(0, 0, 0), .up = {}, .fov_degrees = {}}, kMinimum, kMaximum);
  EXPECT_NEAR(moved.eye.z, framed.eye.z - framed.at.z, 1e-5);
}

TEST(View, DefectsAreUsageErrors) {
  const tool::ViewRequest defects[] = {
      {.eye = Vec3(1, 1, 4), .at = {}, .up = {}, .fov_degrees = {}},
      {.eye = Vec3(1, 9, 4), .at = {}, .up = {}, .fov_degrees = {}},
      {.eye = {}, .at = {}, .up = Vec3(0), .fov_degrees = {}},
  };
  for (const tool::ViewRequest& defect : defects) {
    try {
      (void)tool::frame_view(defect, kMinimum, kMaximum);
      ADD_FAILURE() << "accepted case " << &defect - defects;
    } catch (const tool::Failure& failure) {
      EXPECT_EQ(failure.code(), tool::ExitCode::kUsage);
    }
  }
}

}  // namespace
}  // namespace gridiron::test
