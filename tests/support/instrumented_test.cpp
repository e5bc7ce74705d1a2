// Frames of tests are rendered by the instrumented kernel too where the environment says so.
// SPDX-License-Identifier: Apache-2.0
#include "support/instrumented.h"

#include <gtest/gtest-spi.h>

#include "support/render_mesh.h"
#include "support/test_mesh.h"
#include "support/views.h"

namespace gridiron::test {
namespace {

// Sets a variable of the environment for the time of a test.
class Environment {
 public:
  explicit Environment(const char* value) {
    if (const char* const before = std::getenv(kName)) before_ = before;
    setenv(kName, value, 1);
  }
  ~Environment() { setenv(kName, before_.c_str(), 1); }
  Environment(const Environment&) = delete;
  Environment& operator=(const Environment&) = delete;

 private:
  static constexpr const char* kName = "GRIDIRON_TEST_INSTRUMENTED";
  std::string before_;
};

// A torus in a small picture.
struct Shown {
  TestMesh mesh = make_torus(24, 12, 1.0f, 0.4f);
  SceneInMemory scene{mesh.view(), {}};
  FrameSettings settings;

  Shown() {
    settings.camera = framed_camera(mesh.view());
    settings.width = settings.height = 24;
  }
};

RenderedFrame render(const sim::ChipOptions& options) {
  Shown shown;
  return shown.scene.render(shown.settings, options);
}

TEST(Instrumented, IsAskedForByTheEnvironmentAlone) {
  const Environment quiet("");
  EXPECT_FALSE(is_instrumented());
  const std::uint64_t before = instrumented_frames();
  EXPECT_EQ(render({}).result.status, Status::kOk);
  EXPECT_EQ(instrumented_frames(), before);
}

TEST(Instrumented, EveryFrameOfATestIsRenderedTwiceAndIsTheSame) {
  if (!sim::has_instrumented_mode()) GTEST_SKIP() << "built with another sanitizer";
  const RenderedFrame usual = [] {
    const Environment quiet("");
    return render({});
  }();
  const Environment loud("1");
  for (const sim::Mode mode : {sim::Mode::kChecked, sim::Mode::kPlain}) {
    const std::uint64_t before = instrumented_frames();
    sim::ChipOptions options;
    options.mode = mode;
    const RenderedFrame frame = render(options);
    EXPECT_EQ(frame.result.status, Status::kOk);
    EXPECT_EQ(instrumented_frames(), before + 1);
    EXPECT_EQ(first_difference(frame, usual), "");
  }
}

// Two planes at one place: plain cores do not mind.
TEST(Instrumented, AFrameThatBreaksARuleFailsItsTest) {
  if (!sim::has_instrumented_mode()) GTEST_SKIP() << "built with another sanitizer";
  Shown shown;
  sim::ChipOptions options;
  options.mode = sim::Mode::kPlain;
  PreparedFrame frame = shown.scene.prepare(shown.settings, options);
  FrameRecord record = frame.record();
  record.id_address = record.depth_address;
  frame.set_record(record);
  const Environment loud("1");
  testing::TestPartResultArray failures;
  {
    const testing::ScopedFakeTestPartResultReporter reporter(
        testing::ScopedFakeTestPartResultReporter::INTERCEPT_ALL_THREADS, &failures);
    EXPECT_EQ(frame.render(options).status, Status::kOk);
  }
  ASSERT_GE(failures.size(), 1);
  EXPECT_NE(std::string(failures.GetTestPartResult(0).message()).find("instrumented: "), std::string::npos)
      << failures.GetTestPartResult(0).message();
}

}  // namespace
}  // namespace gridiron::test
