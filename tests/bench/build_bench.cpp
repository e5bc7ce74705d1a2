// The build of the image of configuration `best` beside Embree's low-quality build, and what its parts take.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/build/tree/tree_builder.h>

#include <algorithm>
#include <cmath>

#include "bench/bench.h"
#include "bench/image_build.h"
#include "embree_peer/embree_peer.h"
#include "support/ply_load.h"
#include "support/views.h"

namespace gridiron::bench {
namespace {

constexpr double kLimit = 1.8;  // Embree's time over ours

const test::SceneView kScenes[] = {test::kBunnyView,      test::kHorseView,  test::kArmadilloView,
                                   test::kConferenceView, test::kSponzaView, test::kDragonView};

// Prints a scene's times. @returns Embree's time over ours; 0 where there is none.
double measure(const BenchOptions& options, const test::SceneView& scene) {
  const auto mesh = test::load_ply(options.scenes / scene.file);
  if (!mesh) {
    std::printf("%s: %s cannot be read; left out\n", scene.name, (options.scenes / scene.file).c_str());
    return 0;
  }
  const MeshView view = mesh->view();
  ImageBuild image(view);
  peer::EmbreeScene embree;
  embree.set_mesh(view);
  const Candidate candidates[] = {{"ours", [&] { image.run(); }},
                                  {"count", [&] { image.count(); }},
                                  {"build", [&] { image.build(); }},
                                  {"open", [&] { image.open(); }},
                                  {"low", [&] { embree.build(peer::EmbreeQuality::kLow); }}};
  const std::vector<double> seconds = least_seconds(candidates, options.rounds);
  if (image.status() != Status::kOk) {
    std::printf("%s: status %u\n", scene.name, static_cast<unsigned>(image.status()));
    return 0;
  }
  const double ratio = seconds[4] / seconds[0];
  const auto count = static_cast<double>(view.triangles.size());
  std::printf("%-17s %7zu | %7.2f %7.2f |", scene.name, view.triangles.size(), 1e3 * seconds[0], 1e3 * seconds[4]);
  for (const double part : seconds) std::printf(" %6.1f", 1e9 * part / count);
  std::printf(" | %5.2f%s\n", ratio, ratio >= kLimit ? "" : "!");
  std::fflush(stdout);
  return ratio;
}

bool bench_build(const BenchOptions& options) {
  if (options.scenes.empty()) {
    std::printf("GRIDIRON_SCENES is not set; left out\n");
    return true;
  }
  std::printf(
      "one thread; milliseconds: ours, Embree low; nanoseconds a triangle: ours, of it count, build, open; "
      "Embree low; Embree's time over ours (limit %.1f)\n",
      kLimit);
  bool within = true;
  for (const test::SceneView& scene : kScenes) {
    const double ratio = measure(options, scene);
    within = within && (ratio == 0 || ratio >= kLimit);
  }
  return within;
}

const Registration kRegistration("build", bench_build);

}  // namespace
}  // namespace gridiron::bench
