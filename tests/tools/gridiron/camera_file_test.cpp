// Camera files: strict, every complaint with its line. SPDX-License-Identifier: Apache-2.0
#include "failure_of.h"
#include "gridiron/scene/view.h"
#include "temporary_folder.h"

namespace gridiron::test {
namespace {

using tool::ViewRequest;

TEST(CameraFile, ReadsAView) {
  const TemporaryFolder folder;
  const auto path =
      folder.write("a.camera", "# a view\n\n  eye -73 454 -883  # where\r\nat 603 128 1.5e2\nup 0 1 0\nfov 65");
  const ViewRequest view = tool::read_camera_file(path);
  EXPECT_EQ(view.eye, Vec3(-73, 454, -883));
  EXPECT_EQ(view.at, Vec3(603, 128, 150));
  EXPECT_EQ(view.up, Vec3(0, 1, 0));
  EXPECT_EQ(view.fov_degrees, 65.0f);
}

TEST(CameraFile, UpAndFovMayBeLeftOut) {
  const TemporaryFolder folder;
  const ViewRequest view = tool::read_camera_file(folder.write("a.camera", "at 0 0 0\neye 0 0 1\n"));
  EXPECT_FALSE(view.up);
  EXPECT_FALSE(view.fov_degrees);
}

TEST(CameraFile, NamesTheLineOfEveryDefect) {
  struct Case {
    const char* content;
    const char* line_and_reason;
  };
  const Case cases[] = {
      {"eye 1 2 3\nat 1 2\n", ":2: 'at' takes 3 numbers, not 2"},
      {"eye 1 2 3 4\n", ":1: 'eye' takes 3 numbers, not 4"},
      {"eye 1 2 3\nat 0 0 0\nfov 45 46\n", ":3: 'fov' takes 1 number, not 2"},
      {"eye 1 2 3\nat 0 0 zero\n", ":2: 'zero' is not a finite number"},
      {"eye 1 2 3x\n", ":1: '3x' is not a finite number"},
      {"eye 1 nan 3\n", ":1: 'nan' is not a finite number"},
      {"eye 1 inf 3\n", ":1: 'inf' is not a finite number"},
      {"eye 1 1e99 3\n", ":1: '1e99' is not a finite number"},
      {"\n\neye 1 2 3\neye 1 2 3\n", ":4: second 'eye'"},
      {"eye 1 2 3\nat 0 0 0\nfov 45\nfov 45\n", ":4: second 'fov'"},
      {"eye 1 2 3\nlook 0 0 0\n", ":2: unknown word 'look'"},
      {"\x1B[2J\xFF 0 0 0\n", ":1: unknown word '\\x1b[2J\\xff'"},
      {"eye 1 2 0123456789012345678901234567890123456789012345678901234567890123456789a\n",
       ":1: '0123456789012345678901234567890123456789012345678901234567890123...' is not"},
      {"Eye 1 2 3\n", ":1: unknown word 'Eye'"},
      {"eye 1 2 3\nat 0 0 0\nfov 180\n", ":3: fov must be from 0.001 to below 180 degrees"},
      {"eye 1 2 3\nat 0 0 0\nfov 0.0009\n", ":3: fov must be from 0.001 to below 180 degrees"},
      {"eye 1 2 3\nfov 45\n", ":2: the file ends without a line 'at x y z'"},
      {"", ": is empty; expected a camera file"},
      {"\n", ":1: the file ends without a line 'eye x y z'"},
      {"eye 1 2 3\nat 1 2 3\n", ":2: eye and at are the same point"},
      {"eye 1 2 3\nat 0 0 0\nup 0 0 0\n", ":3: up has length 0"},
      {"eye 0 2 0\nat 0 0 0\n", ":2: up points along the view"},
  };
  const TemporaryFolder folder;
  for (const Case& defect : cases) {
    const auto path = folder.write("a.camera", defect.content);
    const std::string words = failure_of([&] { return tool::read_camera_file(path); });
    EXPECT_EQ(words.find(path.string() + defect.line_and_reason), 0u) << words << "\nfor: " << defect.content;
  }
}

TEST(CameraFile, EndsReadingWhatHasNoEnd) {
  const std::string words = failure_of([] { return tool::read_camera_file("/dev/zero"); });
  EXPECT_NE(words.find("/dev/zero: File too large"), std::string::npos) << words;
}

}  // namespace
}  // namespace gridiron::test
