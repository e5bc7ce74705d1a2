// The effects experiment: as a program, tiny, and its checks. SPDX-License-Identifier: Apache-2.0
#include "../gridiron/failure_of.h"
#include "csv_rows.h"
#include "experiment/effect_frames.h"
#include "experiment/effect_scenes.h"
#include "experiment/experiments.h"
#include "markup.h"
#include "two_runs.h"

namespace gridiron::test {
namespace {

namespace fs = std::filesystem;
using experiment::EffectFrame;
using experiment::EffectScene;
using Rows = std::vector<std::vector<std::string>>;

// Every effect is on somewhere and off somewhere; one that is off has counts of zero, one that is on has not.
void expect_frames(const fs::path& folder) {
  const Rows rows = csv_rows(folder / "effects.csv"), off = csv_rows(folder / "off.csv");
  std::set<std::string> without;
  for (std::size_t row = 1; row < rows.size(); ++row) {
    SCOPED_TRACE(rows[row][0] + " " + rows[row][1]);
    const std::string called = text_under(rows, row, "effects"), variant = text_under(rows, row, "variant");
    const auto calls_for = [&called](const char* effect) { return called.find(effect) != std::string::npos; };
    if (variant != "all") {
      without.insert(variant);
      EXPECT_FALSE(calls_for(variant.substr(8).c_str()));
    }
    EXPECT_EQ(number_under(rows, row, "occlusion_rays") > 0, calls_for("ambient_occlusion"));
    EXPECT_EQ(number_under(rows, row, "environment_lookups") > 0, calls_for("environment"));
    EXPECT_EQ(number_under(rows, row, "refracted_rays") > 0, calls_for("refraction"));
    EXPECT_EQ(number_under(rows, row, "reflected_rays") > 0, calls_for("reflection"));
    EXPECT_EQ(number_under(rows, row, "primary_rays"), 16 * 16 * (calls_for("multisampling") ? 4 : 1));
    EXPECT_EQ(number_under(rows, row, "shadow_rays") > 0, variant != "without_point_shadows");
    EXPECT_NEAR(number_under(rows, row, "cycles") * number_under(rows, row, "fps"), 3.2e9, 1);
  }
  EXPECT_EQ(without.size(), kEffectCount - 1) << "shading itself is always on";
  EXPECT_GT(off.size(), 60u);
  for (std::size_t row = 1; row < off.size(); ++row) {
    EXPECT_EQ(number_under(off, row, "count"), 0);
    if (text_under(off, row, "stage").empty()) continue;
    EXPECT_EQ(number_under(off, row, "bytes"), 0);
    EXPECT_EQ(number_under(off, row, "cycles"), 0);
  }
}

TEST(EffectsExperiment, FilesDoNotDependOnThreads) {
  const TemporaryFolder folder;
  run_twice(folder, [](const std::string& output, const std::string& threads) {
    return Words{"experiment", "effects", "-o", output, "--size", "16x16", "--threads", threads, "--quiet"};
  });
  (void)expect_same_files(folder, experiment::effects_file_names());
  const std::string page = read_file(folder.path("out1") / "index.html");
  EXPECT_EQ(page.find("nan"), std::string::npos);

  expect_frames(folder.path("out1"));
  const Rows hiding = csv_rows(folder.path("out1") / "hiding.csv");
  ASSERT_EQ(hiding.size(), 1 + std::size(experiment::kEffectSceneKeys));
  for (std::size_t row = 1; row < hiding.size(); ++row) {
    const double single = number_under(hiding, row, "single_wait_cycles");
    EXPECT_GE(number_under(hiding, row, "hidden_percent"), 100 * experiment::kLeastHiddenShare);
    EXPECT_NEAR(number_under(hiding, row, "hidden_percent"),
                100 * (1 - number_under(hiding, row, "double_wait_cycles") / single), 1e-9);
  }

  // Waits of the stages of secondary rays are those of the table of hiding.
  const Rows stages = csv_rows(folder.path("out1") / "stages.csv");
  double waits = 0;
  for (std::size_t row = 1; row < stages.size(); ++row) {
    const std::string stage = text_under(stages, row, "stage");
    if (stages[row][0] != "gallery" || stages[row][1] != "all" || stage == "primary" || stage == "output") continue;
    waits += number_under(stages, row, "wait_cycles_single");
  }
  EXPECT_NEAR(waits, number_under(hiding, hiding.size() - 1, "single_wait_cycles"), 1e-3);
}

TEST(EffectsExperiment, HasNoScansAndNoKnots) {
  const TemporaryFolder folder;
  for (const Words& more : {Words{"--scenes", "."}, {"--largest", "6000"}}) {
    expect_failure(folder, Words{"experiment", "effects", "-o", "out"} + more, 2, more.front());
  }
}

TEST(EffectsExperiment, ASceneWithoutAnEffectDoesNotCallForIt) {
  const EffectScene gallery = experiment::make_effect_scene("gallery");
  ASSERT_EQ(experiment::called_for(gallery), kAllEffects);
  for (std::uint32_t bit = 1; bit <= kAllEffects; bit <<= 1) {
    const auto effect = static_cast<EffectBits>(bit);
    if (effect == kSceneShading) continue;
    const std::uint32_t rest = experiment::called_for(experiment::without_effect(gallery, effect));
    const std::uint32_t built_on_it = effect == kReflection      ? kRefraction
                                      : effect == kSmoothNormals ? kVertexColors
                                                                 : 0u;
    EXPECT_EQ(rest, kAllEffects & ~bit & ~built_on_it) << bit;
    EXPECT_EQ(rest, experiment::left_without(kAllEffects, effect)) << bit;
  }
}

tool::ExitCode code_of(const EffectFrame& frame, std::uint32_t expected) {
  try {
    experiment::check_absent_costs(frame, expected, "frame");
  } catch (const tool::Failure& failure) {
    return failure.code();
  }
  return tool::ExitCode::kDone;
}

// A frame that does more than its scene calls for fails, for every effect.
TEST(EffectsExperiment, WorkOfAnEffectThatIsOffFailsTheRun) {
  EffectFrame plain;
  plain.called_for = kSceneShading;
  plain.has_shadows = false;
  plain.picture = {2, 2, {0, 0, 0, 0}};
  const auto count_of = [](EffectFrame& frame, Work kind) -> std::uint64_t& {
    return frame.work[static_cast<std::size_t>(kind)];
  };
  count_of(plain, Work::kWaveRay) = 4;
  count_of(plain, Work::kSurfacePoint) = 3;
  count_of(plain, Work::kLightSample) = 6;
  plain.stages[static_cast<std::size_t>(Stage::kShadow)].compute_cycles = 100;
  ASSERT_EQ(code_of(plain, kSceneShading), tool::ExitCode::kDone);
  EXPECT_EQ(experiment::absent_costs(plain).size(), kEffectCount - 1);
  EXPECT_EQ(code_of(plain, kSceneShading | kReflection), tool::ExitCode::kCheckFailed) << "not what the scene should";

  for (const Work kind :
       {Work::kShadowRay, Work::kAreaPlace, Work::kMirrorRay, Work::kQueuedRay, Work::kRefractedRay,
        Work::kOcclusionRay, Work::kEnvironmentLookup, Work::kSmoothNormal, Work::kHighlight, Work::kWaveRay}) {
    EffectFrame frame = plain;
    ++count_of(frame, kind);
    EXPECT_EQ(code_of(frame, kSceneShading), tool::ExitCode::kCheckFailed) << static_cast<int>(kind);
  }
  for (const Stage stage : {Stage::kShadow, Stage::kOcclusion, Stage::kBounce, Stage::kEnvironment}) {
    for (int part = 0; part < 3; ++part) {
      EffectFrame frame = plain;
      sim::StageTiming& timing = frame.stages[static_cast<std::size_t>(stage)];
      if (part == 0) timing.bytes_in = 16;
      if (part == 1) timing.wait_cycles = 1;
      if (part == 2) timing.compute_cycles += 1;
      const bool is_light = stage == Stage::kShadow && part == 2;
      EXPECT_EQ(code_of(frame, kSceneShading), is_light ? tool::ExitCode::kDone : tool::ExitCode::kCheckFailed)
          << static_cast<int>(stage) << " " << part;
    }
  }

  // The same work of effects that are on is no failure.
  EffectFrame frame = plain;
  frame.called_for = kAllEffects;
  count_of(frame, Work::kMirrorRay) = count_of(frame, Work::kQueuedRay) = count_of(frame, Work::kShadowRay) = 50;
  frame.stages[static_cast<std::size_t>(Stage::kBounce)].bytes_in = 16;
  EXPECT_EQ(code_of(frame, kAllEffects), tool::ExitCode::kDone);
}

TEST(EffectsExperiment, TooLittleHidingFailsTheRun) {
  EffectFrame single, twofold;
  for (const Stage stage : {Stage::kSurface, Stage::kShadow, Stage::kOcclusion, Stage::kBounce, Stage::kEnvironment}) {
    single.stages[static_cast<std::size_t>(stage)].wait_cycles = 100;
    twofold.stages[static_cast<std::size_t>(stage)].wait_cycles = 9;
  }
  // Eye rays and output have no part in it.
  twofold.stages[static_cast<std::size_t>(Stage::kPrimary)].wait_cycles = 1000;
  EXPECT_DOUBLE_EQ(experiment::hidden_share(single, twofold), 0.91);
  EXPECT_NO_THROW(experiment::check_hiding(single, twofold, "frame"));
  twofold.stages[static_cast<std::size_t>(Stage::kBounce)].wait_cycles = 200;
  const auto check = [&] { experiment::check_hiding(single, twofold, "frame"); };  // 53 % are not enough
  const std::string words = failure_of(check, tool::ExitCode::kCheckFailed);
  EXPECT_NE(words.find("52.8"), std::string::npos) << words;
}

TEST(EffectsExperiment, TooMuchWaitingFailsTheRun) {
  EffectFrame single, twofold;
  single.stages[static_cast<std::size_t>(Stage::kBounce)].wait_cycles = 1000;
  twofold.stages[static_cast<std::size_t>(Stage::kBounce)].wait_cycles = 40;
  const auto check = [&] { experiment::check_hiding(single, twofold, "frame"); };
  twofold.core_cycles = 1340;  // 2.99 %
  EXPECT_NO_THROW(check());
  twofold.core_cycles = 1250;  // 3.2 %
  const std::string words = failure_of(check, tool::ExitCode::kCheckFailed);
  EXPECT_NE(words.find("3.2"), std::string::npos) << words;
}

// The library renders one scene as the program does; without an effect the kernel has nothing of it.
TEST(EffectsExperiment, AFrameCallsForWhatItsSceneDoes) {
  const EffectScene gallery = experiment::make_effect_scene("gallery");
  const experiment::EffectFrameRequest request{.width = 16, .height = 12};
  const EffectFrame whole = experiment::render_effect_frame(gallery, request);
  EXPECT_EQ(whole.called_for, kAllEffects);
  EXPECT_TRUE(experiment::absent_costs(whole).empty());
  EXPECT_EQ(whole.primary_rays(), 16u * 12u * 4u);
  EXPECT_EQ(whole.picture.width, 16u);
  const EffectFrame dull = experiment::render_effect_frame(experiment::without_effect(gallery, kReflection), request);
  EXPECT_GT(whole.stage(Stage::kBounce).bytes_in, 0u);
  EXPECT_EQ(dull.stage(Stage::kBounce).bytes_in, 0u);
  EXPECT_EQ(dull.stage(Stage::kBounce).compute_cycles, 0);
  EXPECT_NE(dull.picture.pixels, whole.picture.pixels);
}

}  // namespace
}  // namespace gridiron::test
