// Frames of the reference configuration against Embree's packets. SPDX-License-Identifier: Apache-2.0
#include "bench/bench.h"
#include "embree_peer/embree_peer.h"
#include "support/ply_load.h"
#include "support/render_mesh.h"
#include "support/views.h"

namespace gridiron::bench {
namespace {

constexpr double kLimit = 2.5;  // times Embree's frame

// One view: ours in plain mode with the widest lanes against the better of Embree's two hierarchies.
bool bench_view(const BenchOptions& options, const test::SceneView& view) {
  const auto mesh = test::load_ply(options.scenes / view.file);
  if (!mesh) {
    std::printf("%s: %s cannot be read; left out\n", view.name, (options.scenes / view.file).c_str());
    return true;
  }
  test::SceneInMemory scene(mesh->view(), GridParameters{});
  const FrameSettings settings{.camera = view.camera ? *view.camera : test::framed_camera(mesh->view())};
  const sim::ChipOptions plain{.mode = sim::Mode::kPlain, .lanes = sim::widest_lanes()};
  test::PreparedFrame frame = scene.prepare(settings, plain, test::PlaneSet::kColor);
  sim::ChipOptions checked = plain;
  checked.mode = sim::Mode::kChecked;
  if (frame.status() != Status::kOk) {
    std::printf("%s: status %u\n", view.name, static_cast<unsigned>(frame.status()));
    return false;
  }

  peer::EmbreeScene low;
  peer::EmbreeScene medium;
  low.set_mesh(mesh->view());
  low.build(peer::EmbreeQuality::kLow);
  medium.set_mesh(mesh->view());
  medium.build(peer::EmbreeQuality::kMedium);
  std::vector<std::uint32_t> color;

  bool rendered = true;
  const auto render = [&](const sim::ChipOptions& chip) {
    rendered = frame.render(chip).status == Status::kOk && rendered;
  };
  const Candidate candidates[] = {{"plain", [&] { render(plain); }},
                                  {"embree low", [&] { low.render(frame.record(), color); }},
                                  {"embree medium", [&] { medium.render(frame.record(), color); }}};
  const std::vector<double> seconds = least_seconds(candidates, options.rounds);
  const Candidate slow[] = {{"checked", [&] { render(checked); }}};
  const double checked_seconds = least_seconds(slow, 1)[0];

  const std::vector<std::uint32_t> ids = scene.render(settings, plain).planes.ids;
  const auto hits = static_cast<std::size_t>(
      std::count_if(ids.begin(), ids.end(), [](std::uint32_t id) { return id != kNoTriangle; }));
  std::printf(
      "%s: %ux%u, %u lanes; plain %.2f ms, checked %.2f ms, embree low %.2f ms, medium %.2f ms; "
      "pixels hit %zu, embree %llu\n",
      view.name, settings.width, settings.height, plain.lanes, 1e3 * seconds[0], 1e3 * checked_seconds,
      1e3 * seconds[1], 1e3 * seconds[2], hits, static_cast<unsigned long long>(medium.hit_count(frame.record())));
  return report_ratio(std::string("frame ") + view.name + " / embree rtcIntersect16", seconds[0],
                      std::min(seconds[1], seconds[2]), kLimit) &&
         rendered;
}

bool bench_frames(const BenchOptions& options) {
  if (options.scenes.empty()) {
    std::printf("GRIDIRON_SCENES is not set; left out\n");
    return true;
  }
  bool within = bench_view(options, test::kBunnyView);
  within = bench_view(options, test::kConferenceView) && within;
  within = bench_view(options, test::kConferenceView2) && within;
  return within;
}

const Registration kRegistration("frame", bench_frames);

}  // namespace
}  // namespace gridiron::bench
