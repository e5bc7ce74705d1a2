// Camera paths and turntables: through their keys, smooth between them, strict about their text.
// SPDX-License-Identifier: Apache-2.0
#include "gridiron/scene/camera_path.h"

#include <glm/geometric.hpp>

#include "failure_of.h"
#include "temporary_folder.h"

namespace gridiron::test {
namespace {

using tool::CameraPath;
using tool::ViewRequest;

CameraPath path_of(const TemporaryFolder& folder, const std::string& text) {
  return tool::read_camera_path(folder.write("a.path", text));
}

TEST(CameraPath, KeysTakeWhatTheyLeaveOutFromTheKeyBefore) {
  const TemporaryFolder folder;
  const CameraPath path =
      path_of(folder,
              "# a flight\nframe 0  # begins here\neye 0 0 8\nat 0 0 3\r\n\nframe 10\ndirection 0 0 -2\n"
              "fov 30\nframe 12\neye 1 0 0\nup 0 2 1\n frame 13\n");
  ASSERT_EQ(path.keys.size(), 4u);
  EXPECT_EQ(path.frame_count(), 14u);
  EXPECT_EQ(path.keys[0].up, Vec3(0, 1, 0));
  EXPECT_EQ(path.keys[0].fov_degrees, 45.0f);
  EXPECT_EQ(path.keys[1].eye, Vec3(0, 0, 8));
  EXPECT_EQ(path.keys[1].at, Vec3(0, 0, 3)) << "a direction is from the eye, as far as the last at";
  EXPECT_EQ(path.keys[2].at, Vec3(1, 0, -5)) << "and stays one";
  EXPECT_EQ(path.keys[2].fov_degrees, 30.0f);
  EXPECT_EQ(path.keys[3].up, Vec3(0, 2, 1));
  EXPECT_EQ(path.keys[3].line, 12u);
}

TEST(CameraPath, ErrorsNameTheLine) {
  const TemporaryFolder folder;
  const std::pair<const char*, const char*> cases[] = {
      {"", ": is empty; expected a camera path"},
      {"# nothing\n", ":1: the file ends without a line 'frame 0'"},
      {"eye 0 0 1\n", ":1: begins with 'eye'; expected 'frame 0'"},
      {"frame 1\n", ":1: the first key is 'frame 0', not 1"},
      {"frame -1\n", ":1: 'frame' takes a whole number below 1000000"},
      {"frame 1000000\n", ":1: 'frame' takes a whole number below 1000000"},
      {"frame 0 1\n", ":1: 'frame' takes a whole number"},
      {"frame 0\nat 0 0 0\nframe 1\neye 0 0 1\n", ":1: the first key has no line 'eye x y z'"},
      {"frame 0\neye 0 0 1\n", ":1: the first key has no line 'at x y z' or 'direction x y z'"},
      {"frame 0\neye 0 0 1\nat 0 0 0\nframe 5\n\nframe 5\n", ":6: frame 5 does not come after frame 5 of line 4"},
      {"frame 0\neye 0 0\n", ":2: 'eye' takes 3 numbers, not 2"},
      {"frame 0\neye 0 0 x\n", ":2: 'x' is not a finite number"},
      {"frame 0\neye 0 0 1\neye 0 0 2\n", ":3: second 'eye'"},
      {"frame 0\nat 0 0 1\ndirection 0 0 2\n", ":3: at and direction: both say where this key looks"},
      {"frame 0\neye 0 0 1\ndirection 0 0 0\n", ":1: direction has length 0"},
      {"frame 0\nfov 180\n", ":2: fov must be from 0.001 to below 180 degrees"},
      {"frame 0\nzoom 2\n", ":2: unknown word 'zoom'; expected frame, eye, at, direction, up or fov"},
      {"frame 0\neye 0 0 1\nat 0 0 0\nframe 9\nat 0 0 1\n", ":4: eye and at are the same point"},
  };
  for (const auto& [bad, words] : cases) {
    const std::string text = bad;
    SCOPED_TRACE(text);
    const std::string message = failure_of([&] { return path_of(folder, text); }, tool::ExitCode::kBadInput);
    EXPECT_NE(message.find(std::string("a.path") + words), std::string::npos) << message << "\nlacks: " << words;
  }
}

TEST(CameraPath, GoesThroughItsKeysWithoutJumps) {
  const TemporaryFolder folder;
  const CameraPath path = path_of(folder,
                                  "frame 0\neye 0 0 8\nat 0 0 0\nfov 60\nframe 20\neye 8 0 0\nframe 100\neye 0 4 -8\n"
                                  "at 0 2 0\nfov 20\nframe 120\neye -8 0 0\nup 1 1 0\n");
  const std::vector<ViewRequest> views = tool::views_of_path(path, {});
  ASSERT_EQ(views.size(), 121u);
  for (const tool::PathKey& key : path.keys) {
    EXPECT_EQ(views[key.frame].eye, key.eye);
    EXPECT_EQ(views[key.frame].at, key.at);
    EXPECT_EQ(views[key.frame].fov_degrees, key.fov_degrees);
  }
  const auto step = [&views](std::size_t frame) { return *views[frame].eye - *views[frame - 1].eye; };
  for (std::size_t frame = 2; frame < views.size(); ++frame) {
    EXPECT_LT(glm::length(step(frame) - step(frame - 1)), 0.15f) << "the speed jumps at frame " << frame;
    EXPECT_LE(*views[frame].fov_degrees, 60.0f);
    EXPECT_GE(*views[frame].fov_degrees, 20.0f);
  }
  EXPECT_GT(glm::length(step(10)), 0.3f);
  const ViewRequest middle = views[10];
  EXPECT_GT(middle.eye->x + middle.eye->z, 8.05f) << "curved, not straight";
}

// With keys at even distances the speed at a key is half the way between its neighbours: Catmull and Rom's.
TEST(CameraPath, IsTheCurveOfCatmullAndRom) {
  const TemporaryFolder folder;
  const CameraPath path =
      path_of(folder, "frame 0\neye 0 0 9\nat 0 0 0\nframe 4\neye 4 0 9\nframe 8\neye 5 6 9\nframe 12\neye 1 7 9\n");
  for (std::uint32_t frame = 4; frame <= 8; ++frame) {
    const double t = (frame - 4) / 4.0;
    const DVec3 p[] = {{0, 0, 9}, {4, 0, 9}, {5, 6, 9}, {1, 7, 9}};
    const DVec3 wanted = 0.5 * (2.0 * p[1] + t * (p[2] - p[0]) + t * t * (2.0 * p[0] - 5.0 * p[1] + 4.0 * p[2] - p[3]) +
                                t * t * t * (3.0 * p[1] - p[0] - 3.0 * p[2] + p[3]));
    EXPECT_LT(glm::length(DVec3(*tool::view_of_path(path, frame).eye) - wanted), 1e-5) << frame;
  }
}

TEST(CameraPath, StandsStillBetweenEqualKeys) {
  const TemporaryFolder folder;
  const CameraPath path =
      path_of(folder, "frame 0\neye 0 0 8\nat 0 0 0\nframe 10\neye 4 0 8\nframe 20\nframe 30\neye 9 0 8\n");
  for (std::uint32_t frame = 10; frame <= 20; ++frame) EXPECT_EQ(tool::view_of_path(path, frame).eye, Vec3(4, 0, 8));
}

TEST(CameraPath, ADirectionLooksAsFarAsOtherKeys) {
  const TemporaryFolder folder;
  const CameraPath before = path_of(folder, "frame 0\neye 0 0 8\ndirection 0 0 -3\nframe 4\neye 0 0 9\nat 0 0 4\n");
  EXPECT_EQ(before.keys[0].at, Vec3(0, 0, 3));
  const CameraPath alone = path_of(folder, "frame 0\neye 0 0 8\ndirection 0 0 -3\nframe 4\ndirection 0.1 0 0\n");
  EXPECT_EQ(alone.keys[0].at, Vec3(0, 0, 0));
  EXPECT_EQ(alone.keys[1].at, Vec3(8, 0, 8));
  const CameraPath last =
      path_of(folder, "frame 0\neye 0 0 8\nat 0 0 3\nframe 4\nat 0 0 6\nframe 8\ndirection 0.1 0 0\n");
  EXPECT_EQ(last.keys[2].at, Vec3(2, 0, 8)) << "as far as the last one, not the first";
}

TEST(CameraPath, PartsOfTheCommandLineReplaceAllOfIts) {
  const TemporaryFolder folder;
  const CameraPath path = path_of(folder, "frame 0\neye 0 0 8\nat 0 0 0\nframe 4\neye 0 0 -8\nat 0 0 -10\n");
  const ViewRequest parts = {.eye = {}, .at = Vec3(0, 5, 0), .up = Vec3(0, 0, 1), .fov_degrees = 20.0f};
  for (const ViewRequest& view : tool::views_of_path(path, parts)) {
    EXPECT_EQ(view.at, parts.at);
    EXPECT_EQ(view.up, parts.up);
    EXPECT_EQ(view.fov_degrees, parts.fov_degrees);
  }
  const std::string message =
      failure_of([&] { return tool::views_of_path(path, {.eye = {}, .at = Vec3(0), .up = {}, .fov_degrees = {}}); },
                 tool::ExitCode::kBadInput);
  EXPECT_NE(message.find("a.path:1: frame 2, between this key and the next: eye and at are the same point"),
            std::string::npos)
      << message;
}

// A box that is not around the axis, long and flat.
void box(const tool::PointVisitor& visitor) {
  const Vec3 corners[] = {{-1, 0, 2}, {9, 2, 2}, {-1, 2, 4}, {9, 0, 4}, {-1, 0, 4}, {9, 2, 4}, {-1, 2, 2}, {9, 0, 2}};
  visitor(corners);
}

TEST(Turntable, NoFrameCutsTheSceneOffAndNoneIsFarther) {
  constexpr double kAspect = 1.5;
  for (const Vec3& up : {Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(1, 2, 0)}) {
    ViewRequest request;
    request.up = up;
    const std::vector<ViewRequest> views = tool::views_of_turntable(request, 24, kAspect, box);
    ASSERT_EQ(views.size(), 24u);
    double most = 0;
    for (const ViewRequest& view : views) {
      const Camera camera = tool::complete_view(view, kAspect, box);
      const DVec3 eye(camera.eye), forward = glm::normalize(DVec3(camera.at) - eye);
      const DVec3 right = glm::normalize(glm::cross(forward, DVec3(camera.up))), above = glm::cross(right, forward);
      EXPECT_NEAR(glm::length(DVec3(*view.eye) - DVec3(4, 1, 3)), glm::length(DVec3(*views[0].eye) - DVec3(4, 1, 3)),
                  1e-4);
      EXPECT_NEAR(glm::dot(DVec3(*view.eye), DVec3(up)), glm::dot(DVec3(*views[0].eye), DVec3(up)), 1e-4);
      box([&](std::span<const Vec3> points) {
        for (const Vec3& point : points) {
          const DVec3 offset = DVec3(point) - eye;
          const double scale = glm::dot(offset, forward) * camera.tan_half_fov;
          most = std::max(
              {most, std::abs(glm::dot(offset, right)) / (scale * kAspect), std::abs(glm::dot(offset, above)) / scale});
        }
      });
    }
    EXPECT_LE(most, 0.9001) << "5 % are free on each side";
    EXPECT_GT(most, 0.87) << "and not much more";
  }
}

TEST(Turntable, GoesOnceAroundToTheRight) {
  const ViewRequest request = {.eye = Vec3(0, 3, 5), .at = Vec3(0, 1, 0), .up = {}, .fov_degrees = 30.0f};
  const std::vector<ViewRequest> views = tool::views_of_turntable(request, 4, 1.0, box);
  const Vec3 eyes[] = {{0, 3, 5}, {5, 3, 0}, {0, 3, -5}, {-5, 3, 0}};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_LT(glm::length(*views[i].eye - eyes[i]), 1e-5f) << i;
    EXPECT_EQ(views[i].at, request.at);
    EXPECT_LT(glm::length(*views[i].up - Vec3(0, 1, 0)), 1e-6f);
    EXPECT_EQ(views[i].fov_degrees, 30.0f);
  }
  const std::vector<ViewRequest> framed = tool::views_of_turntable(
      {.eye = {}, .at = Vec3(0, 1, 0), .up = {}, .fov_degrees = {}, .from = tool::ViewAngles{0, 0}}, 4, 1.0, box);
  EXPECT_LT(std::abs(framed[0].eye->x), 1e-5f) << "from the front";
  EXPECT_GT(framed[1].eye->x, 9.0f) << "then from the right";
  EXPECT_LT(glm::length(*framed[1].at - Vec3(0, 1, 0)), 1e-5f);
  (void)failure_of(
      [&] { return tool::views_of_turntable({.eye = {}, .at = {}, .up = Vec3(0), .fov_degrees = {}}, 4, 1.0, box); },
      tool::ExitCode::kUsage);
}

}  // namespace
}  // namespace gridiron::test
