// Building the scene image (count and build) against Embree's low-quality build, one thread.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/build/grid/grid_builder.h>
#include <gridiron/image/scene_image.h>

#include "bench/bench.h"
#include "core/build/grid/line_buffer.h"
#include "embree_peer/embree_peer.h"
#include "support/ply_load.h"

namespace gridiron::bench {
namespace {

constexpr double kLimit = 2.5;
constexpr double kProjectionLimit = 4.0;  // precomputing costs once per reference, and the peer does none of it

bool bench_mesh(const std::string& name, const MeshView& mesh, TriangleFormat format, unsigned rounds, double limit) {
  const GridParameters parameters{4.0f, 6, format};
  GridNeed need{};
  if (count_scene_image(mesh, parameters, need) != Status::kOk) {
    std::printf("%s: cannot be counted\n", name.c_str());
    return false;
  }
  test::LineBuffer image(static_cast<std::size_t>(need.image_bytes));
  peer::EmbreeScene peer;
  peer.set_mesh(mesh);
  bool ok = true;
  const Candidate candidates[] = {
      {"count", [&] { ok = count_scene_image(mesh, parameters, need) == Status::kOk && ok; }},
      {"build", [&] { ok = build_scene_image(mesh, parameters, need, image.bytes(), {}) == Status::kOk && ok; }},
      {"open",
       [&] {
         SceneImageView view{};
         SceneImageError error;
         ok = open_scene_image(image.bytes(), view, error) == Status::kOk && ok;
       }},
      {"Embree", [&] { peer.build(peer::EmbreeQuality::kLow); }},
  };
  const std::vector<double> seconds = least_seconds(candidates, rounds);
  std::printf("%s: %u references, %.1f MB; count %.2f ms, build %.2f ms, open %.2f ms%s\n", name.c_str(),
              need.grid.reference_count, 1e-6 * static_cast<double>(need.image_bytes), 1e3 * seconds[0],
              1e3 * seconds[1], 1e3 * seconds[2], ok ? "" : "  FAILED");
  return report_ratio(name + ": count + build / Embree low", seconds[0] + seconds[1], seconds[3], limit) && ok;
}

bool bench_grid(const BenchOptions& options) {
  bool all_within = true;
  for (const std::string name : {"bunny", "conference"}) {
    const auto mesh = options.scenes.empty() ? std::nullopt : test::load_ply(options.scenes / (name + ".ply"));
    if (!mesh) {
      std::printf("%s.ply is not there: left out\n", name.c_str());
      continue;
    }
    const unsigned rounds = options.quick ? options.rounds : 5 * options.rounds;
    all_within = bench_mesh(name, mesh->view(), TriangleFormat::kVertices, rounds, kLimit) && all_within;
    all_within =
        bench_mesh(name + ", projected", mesh->view(), TriangleFormat::kProjection, rounds, kProjectionLimit) &&
        all_within;
  }
  return all_within;
}

const Registration kRegistration("grid", bench_grid);

}  // namespace
}  // namespace gridiron::bench
