// BVH system. SPDX-License-Identifier: Apache-2.0
#include "experiment/bvh_system.h"

#include <gridiron/bvh/bvh_build_work.h>
#include <report/report.h>

#include <optional>

#include "base/failure.h"
#include "base/words.h"
#include "files/interrupt.h"
#include "gridiron/frame/frame_failure.h"

namespace gridiron::experiment {
namespace {

// Renders the frame on a machine. Errors: Failure; kBadInput if its main memory is too small.
bvh::BvhFrame render(const bvh::Bvh& bvh, const FrameSettings& settings, bvh::RenderOptions options,
                     const sim::MachineProfile& machine, std::uint32_t core_count) {
  options.core_count = core_count;
  options.abort = &tool::interrupt_flag();
  bvh::BvhFrame frame = bvh::render_bvh_frame(bvh, settings, machine, options);
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

TimedFrame timed(bvh::BvhFrame frame) {
  const auto switches = static_cast<std::size_t>(bvh::BvhWork::kSwitch);
  return {std::move(frame.timing),
          CacheFacts{.node_hit_percent = 100 * frame.node_cache.hit_rate(),
                     .triangle_hit_percent = 100 * frame.triangle_cache.hit_rate(),
                     .suspended_packets = frame.work[switches]},
          std::nullopt};
}

class BvhRecording : public Recording {
 public:
  BvhRecording(bvh::Bvh bvh, const sim::BuildWork& build, const FrameSettings& settings,
               const bvh::RenderOptions& options)
      : bvh_(std::move(bvh)), settings_(settings), options_(options) {
    facts_.build = build;
    // Facts without a clock come from a frame on the home machine; its time is kept for later calls.
    bvh::BvhFrame frame = render(bvh_, settings_, options_, *home_machine(), 0);
    const auto count_of = [&frame](bvh::BvhWork kind) { return frame.work[static_cast<std::size_t>(kind)]; };
    facts_.traversal_steps =
        count_of(bvh::BvhWork::kNodeStep) + count_of(bvh::BvhWork::kMixedNodeStep) + count_of(bvh::BvhWork::kLeafVisit);
    facts_.intersection_tests = frame.work[static_cast<std::size_t>(Work::kGroupTestStandard)] +
                                frame.work[static_cast<std::size_t>(Work::kRowTest)];
    facts_.scene_bytes = bvh_.nodes.size() * sizeof(bvh::BvhNode) + bvh_.triangles.size() * sizeof(VertexTriangle);
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
  bvh::Bvh bvh_;
  FrameSettings settings_;
  bvh::RenderOptions options_;
  FrameFacts facts_;
  TimedFrame at_home_;
};

}  // namespace

std::unique_ptr<Recording> BvhSystem::record(const View& view, const FrameRequest& request) const {
  const tool::Mesh& mesh = view.mesh();
  bvh::Bvh bvh;
  const Status status = bvh::build_bvh(mesh.view(), variant_.build, bvh, &tool::interrupt_flag());
  tool::stop_if_interrupted();
  if (status != Status::kOk) {
    tool::input_error(view.scene->path, tool::words_of(status));
  }
  FrameSettings settings;
  settings.camera =
      tool::complete_view(view.camera, static_cast<double>(request.width) / request.height, [](const auto&) {});
  settings.width = request.width;
  settings.height = request.height;
  settings.shading = request.shading;
  const sim::BuildWork build =
      bvh::bvh_build_work(mesh.vertices.size(), mesh.triangles.size(), bvh.counts, sim::count_mesh_lines(mesh.view()));
  return std::make_unique<BvhRecording>(std::move(bvh), build, settings, variant_.options);
}

}  // namespace gridiron::experiment
