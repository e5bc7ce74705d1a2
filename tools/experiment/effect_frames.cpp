// Frames of the effects experiment. SPDX-License-Identifier: Apache-2.0
#include "experiment/effect_frames.h"

#include <report/report.h>

#include "base/failure.h"
#include "experiment/systems.h"
#include "experiment/table.h"
#include "gridiron/frame/chip_frame.h"
#include "gridiron/frame/frame_pictures.h"
#include "gridiron/scene/effect_names.h"

namespace gridiron::experiment {
namespace {

constexpr Stage kSecondaryStages[] = {Stage::kSurface, Stage::kShadow, Stage::kOcclusion, Stage::kBounce,
                                      Stage::kEnvironment};

tool::RenderPlan plan_of(const EffectScene& scene, const EffectFrameRequest& request) {
  tool::RenderRequest asked;
  asked.scene.input = scene.key;
  asked.scene.machine = home_machine();
  asked.scene.configuration = tool::find_configuration("grid");
  asked.scene.lambda = request.lambda;
  asked.layout.depths = request.depths;
  asked.size = {request.width, request.height};
  asked.threads = 1;
  asked.accuracy = request.accuracy;
  return tool::resolve(asked, {.kind = tool::SceneKind::kText, .has_effects = true, .is_read = true}, {});
}

[[noreturn]] void fail_check(const std::string& message) {
  throw tool::Failure(tool::ExitCode::kCheckFailed, message);
}

AbsentCost counted(EffectBits effect, std::string_view what, std::uint64_t count) {
  return {.effect = effect, .what = what, .count = count};
}

AbsentCost with_stage(AbsentCost cost, std::string_view name, const sim::StageTiming& stage, bool computes = true) {
  cost.stages = name;
  cost.bytes = stage.bytes_in + stage.bytes_out;
  cost.cycles = stage.wait_cycles + (computes ? stage.compute_cycles : 0.0);
  return cost;
}

std::uint64_t excess(std::uint64_t count, std::uint64_t most) {
  return count > most ? count - most : 0;
}

AbsentCost absent_cost(const EffectFrame& frame, EffectBits effect) {
  switch (effect) {
    case kPointShadows:
      // Only area lights cast shadows of their own.
      if (frame.has_shadows && (frame.called_for & kAreaLights) != 0)
        return counted(effect, "shadow rays of points", 0);
      return with_stage(counted(effect, "shadow rays", frame.count(Work::kShadowRay)), "shadow",
                        frame.stage(Stage::kShadow), false);
    case kAreaLights:
      return counted(effect, "places on area lights", frame.count(Work::kAreaPlace));
    case kReflection:
      return with_stage(
          counted(effect, "reflected and queued rays", frame.count(Work::kMirrorRay) + frame.count(Work::kQueuedRay)),
          "bounce", frame.stage(Stage::kBounce));
    case kRefraction:
      return counted(effect, "refracted rays", frame.count(Work::kRefractedRay));
    case kAmbientOcclusion:
      return with_stage(counted(effect, "occlusion rays", frame.count(Work::kOcclusionRay)), "occlusion",
                        frame.stage(Stage::kOcclusion));
    case kEnvironment:
      return with_stage(counted(effect, "environment lookups", frame.count(Work::kEnvironmentLookup)), "environment",
                        frame.stage(Stage::kEnvironment));
    case kSmoothNormals:
      return counted(effect, "normals interpolated", frame.count(Work::kSmoothNormal));
    case kVertexColors:
      return counted(effect, "colours interpolated", frame.count(Work::kVertexColor));
    case kHighlights:
      return counted(effect, "highlights", frame.count(Work::kHighlight));
    case kMultisampling:
      return counted(effect, "eye rays beyond one a pixel", excess(frame.primary_rays(), frame.picture.pixels.size()));
    case kSceneShading:
      break;
  }
  return counted(effect, "points shaded", frame.count(Work::kSurfacePoint));
}

}  // namespace

std::uint64_t EffectFrame::primary_rays() const {
  return count(Work::kWaveRay) - count(Work::kQueuedRay);
}

double EffectFrame::wait_cycles() const {
  double sum = 0;
  for (const sim::StageTiming& stage : stages) sum += stage.wait_cycles;
  return sum;
}

double EffectFrame::secondary_wait_cycles() const {
  double sum = 0;
  for (const Stage kind : kSecondaryStages) sum += stage(kind).wait_cycles;
  return sum;
}

PreparedEffectFrame::PreparedEffectFrame(const EffectScene& scene, const EffectFrameRequest& request)
    : input(input_of(scene)), plan(plan_of(scene, request)), memory(tool::frame_memory_bytes(input, plan)) {
  const tool::SceneView& view = input.text->view;
  tool::prepare_frame(memory, input, plan,
                      {.eye = view.from, .at = view.at, .up = view.up, .fov_degrees = view.angle_degrees});
}

EffectFrame render_effect_frame(const EffectScene& scene, const EffectFrameRequest& request) {
  PreparedEffectFrame prepared(scene, request);
  tool::FrameMemory& memory = prepared.memory;
  const tool::RenderPlan& plan = prepared.plan;
  const sim::ChipResult result = tool::render_on_chip(memory, plan, {});
  const sim::FrameTiming timing = sim::replay(result.trace, *plan.scene.machine, {.core_count = 6});

  EffectFrame frame;
  frame.called_for = memory.image.effects.called_for;
  frame.has_shadows = memory.image.effects.has_shadows != 0;
  frame.work = result.work;
  frame.stages = tool::stage_sums(timing.cores);
  frame.cycles = timing.frame_cycles;
  frame.seconds = timing.seconds;
  frame.core_cycles = timing.frame_cycles * static_cast<double>(timing.cores.size());
  frame.scene_bytes = memory.image.header.image_bytes;
  frame.picture = tool::words_of_plane(memory.record, memory.color.bytes);
  return frame;
}

std::vector<AbsentCost> absent_costs(const EffectFrame& frame) {
  std::vector<AbsentCost> costs;
  for (std::uint32_t bit = 1; bit <= kAllEffects; bit <<= 1) {
    if ((frame.called_for & bit) == 0) costs.push_back(absent_cost(frame, static_cast<EffectBits>(bit)));
  }
  return costs;
}

void check_absent_costs(const EffectFrame& frame, std::uint32_t expected, const std::string& name) {
  if (frame.called_for != expected) {
    fail_check(name + ": calls for " + tool::words_of_effects(frame.called_for) + " in place of " +
               tool::words_of_effects(expected));
  }
  for (const AbsentCost& cost : absent_costs(frame)) {
    if (cost.is_nothing()) continue;
    fail_check(name + ": " + tool::words_of_effects(cost.effect) + " is not called for and cost " +
               std::to_string(cost.count) + " " + std::string(cost.what) + ", " + std::to_string(cost.bytes) +
               " bytes and " + number_text(cost.cycles) + " cycles");
  }
}

double hidden_share(const EffectFrame& single, const EffectFrame& buffered) {
  const double before = single.secondary_wait_cycles();
  return before > 0 ? 1 - buffered.secondary_wait_cycles() / before : 1.0;
}

double secondary_wait_share(const EffectFrame& frame) {
  return frame.core_cycles > 0 ? frame.secondary_wait_cycles() / frame.core_cycles : 0.0;
}

void check_hiding(const EffectFrame& single, const EffectFrame& buffered, const std::string& name) {
  const double share = hidden_share(single, buffered), left = secondary_wait_share(buffered);
  if (share < kLeastHiddenShare) {
    fail_check(name + ": " + fixed_text(100 * share, 1) + " % of the waits for secondary rays are hidden, fewer than " +
               fixed_text(100 * kLeastHiddenShare, 0) + " %");
  }
  if (left > kMostWaitShare) {
    fail_check(name + ": cores wait for secondary rays for " + fixed_text(100 * left, 1) +
               " % of their time, more than " + fixed_text(100 * kMostWaitShare, 1) + " %");
  }
}

}  // namespace gridiron::experiment
