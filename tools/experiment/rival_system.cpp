// Rival system. SPDX-License-Identifier: Apache-2.0
#include "experiment/rival_system.h"

#include <gridiron/rival/bvh_build_work.h>
#include <gridiron/rival/bvh_renderer.h>
#include <report/report.h>

#include <optional>
#include <utility>

#include "gridiron/failure.h"
#include "gridiron/frame_failure.h"
#include "gridiron/interrupt.h"
#include "gridiron/words.h"

namespace gridiron::experiment {
namespace {

// Renders the frame on a machine. Errors: Failure; kBadInput where its main memory is too small.
rival::BvhFrame render(const rival::Bvh& bvh, const FrameSettings& settings, rival::RenderOptions options,
                       const sim::MachineProfile& machine, std::uint32_t core_count) {
  options.core_count = core_count;
  options.abort = &tool::interrupt_flag();
  rival::BvhFrame frame = rival::render_bvh_frame(bvh, settings, machine, options);
  tool::stop_if_interrupted();
  if (frame.status == Status::kMemoryTooSmall) {
    throw tool::Failure(tool::ExitCode::kBadInput, "the hierarchy does not fit the machine's main memory");
  }
  sim::ChipResult outcome;
  outcome.status = frame.status;
  outcome.host_shortage = frame.host_shortage;
  outcome.violations = std::move(frame.violations);
  if (const std::optional<tool::Failure> failure = tool::frame_failure(outcome)) throw *failure;
  return frame;
}

TimedFrame timed(rival::BvhFrame frame) {
  const auto switches = static_cast<std::size_t>(rival::RivalWork::kSwitch);
  return {std::move(frame.timing), CacheFacts{.node_hit_percent = 100 * frame.node_cache.hit_rate(),
                                              .triangle_hit_percent = 100 * frame.triangle_cache.hit_rate(),
                                              .suspended_packets = frame.rival_work[switches]}};
}

class RivalRecording : public Recording {
 public:
  RivalRecording(rival::Bvh bvh, const sim::BuildWork& build, const FrameSettings& settings,
                 const rival::RenderOptions& options)
      : bvh_(std::move(bvh)), settings_(settings), options_(options) {
    facts_.build = build;
    // What is known without a clock comes from a frame at home; its time is kept for whoever asks for it.
    rival::BvhFrame frame = render(bvh_, settings_, options_, *home_machine(), 0);
    const auto count_of = [&frame](rival::RivalWork kind) { return frame.rival_work[static_cast<std::size_t>(kind)]; };
    facts_.traversal_steps = count_of(rival::RivalWork::kNodeStep) + count_of(rival::RivalWork::kMixedNodeStep) +
                             count_of(rival::RivalWork::kLeafVisit);
    facts_.intersection_tests = frame.work[static_cast<std::size_t>(Work::kGroupTestStandard)];
    facts_.scene_bytes = bvh_.nodes.size() * sizeof(rival::BvhNode) + bvh_.triangles.size() * sizeof(VertexTriangle);
    facts_.dropped_triangles = bvh_.triangle_count - static_cast<std::uint32_t>(bvh_.counts.records_written);
    facts_.picture_hash = tool::image_hash(frame.picture.color);
    at_home_ = timed(std::move(frame));
  }

  [[nodiscard]] const FrameFacts& facts() const override { return facts_; }
  [[nodiscard]] TimedFrame time(const sim::MachineProfile& machine, std::uint32_t core_count) const override {
    const sim::MachineProfile& home = *home_machine();
    if (machine == home && (core_count == 0 || core_count == home.core_count)) return at_home_;
    return timed(render(bvh_, settings_, options_, machine, core_count));
  }

 private:
  rival::Bvh bvh_;
  FrameSettings settings_;
  rival::RenderOptions options_;
  FrameFacts facts_;
  TimedFrame at_home_;
};

}  // namespace

std::unique_ptr<Recording> RivalSystem::record(const View& view, const FrameRequest& request) const {
  const tool::Mesh& mesh = view.mesh();
  rival::Bvh bvh;
  const Status status = rival::build_bvh(mesh.view(), variant_.build, bvh, &tool::interrupt_flag());
  tool::stop_if_interrupted();
  if (status != Status::kOk) {
    throw tool::Failure(tool::ExitCode::kBadInput, view.scene->path.string() + ": " + tool::words_of(status));
  }
  FrameSettings settings;
  settings.camera =
      tool::complete_view(view.camera, static_cast<double>(request.width) / request.height, [](const auto&) {});
  settings.width = request.width;
  settings.height = request.height;
  settings.shading = request.shading;
  const sim::BuildWork build = rival::bvh_build_work(mesh.vertices.size(), mesh.triangles.size(), bvh.counts);
  return std::make_unique<RivalRecording>(std::move(bvh), build, settings, variant_.options);
}

}  // namespace gridiron::experiment
