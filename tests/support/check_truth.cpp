// Compares pixels with the ground truth: see the header. SPDX-License-Identifier: Apache-2.0
#include "support/check_truth.h"

#include <numeric>
#include <thread>

#include "support/test_mesh.h"

namespace gridiron::test {
namespace {

// Keeps `count` elements of `pixels`, drawn without putting back.
void draw(std::vector<std::size_t>& pixels, std::size_t count, std::uint64_t seed) {
  TestRandom random(seed);
  count = std::min(count, pixels.size());
  for (std::size_t i = 0; i < count; ++i) {
    std::swap(pixels[i], pixels[i + random.below(static_cast<std::uint32_t>(pixels.size() - i))]);
  }
  pixels.resize(count);
}

}  // namespace

TruthReport check_against_truth(const RenderedFrame& rendered, const MeshView& mesh,
                                std::span<const std::size_t> pixels) {
  const FrameRecord& frame = rendered.frame;
  std::vector<Vec3> directions;
  for (const std::size_t pixel : pixels) {
    directions.push_back(pixel_direction(frame, static_cast<std::uint32_t>(pixel % frame.width),
                                         static_cast<std::uint32_t>(pixel / frame.width)));
  }
  TruthReport report;
  report.pixels = pixels.size();
  const bool is_exact = frame.accuracy == static_cast<std::uint32_t>(Accuracy::kExact);
  const BruteForce truth(mesh, {frame.eye[0], frame.eye[1], frame.eye[2]},
                         is_exact ? TieRule::kExactOrder : TieRule::kLeastId);
  const std::vector<TrueHit> hits =
      truth.trace(directions, frame.t_far, std::max(1u, std::thread::hardware_concurrency()), &report.work);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const std::size_t pixel = pixels[i];
    const bool hit = hits[i].triangle_id != kNoTriangle;
    report.hits += hit;
    const float depth = depth_value(hits[i], directions[i]);
    const bool same =
        rendered.planes.ids[pixel] == hits[i].triangle_id &&
        std::bit_cast<std::uint32_t>(rendered.planes.depth[pixel]) == std::bit_cast<std::uint32_t>(depth) &&
        (hit || rendered.planes.color[pixel] == frame.background_rgba);
    if (same) continue;
    if (report.mismatches++ != 0) continue;
    std::ostringstream words;
    words << "pixel (" << pixel % frame.width << ", " << pixel / frame.width << "): triangle "
          << static_cast<std::int64_t>(static_cast<std::int32_t>(rendered.planes.ids[pixel])) << " for "
          << static_cast<std::int64_t>(static_cast<std::int32_t>(hits[i].triangle_id)) << ", depth " << std::hexfloat
          << rendered.planes.depth[pixel] << " for " << depth << ", colour " << std::hex
          << rendered.planes.color[pixel];
    report.first_mismatch = words.str();
  }
  return report;
}

std::vector<std::size_t> all_pixels(const FrameRecord& frame) {
  std::vector<std::size_t> pixels(std::size_t{frame.width} * frame.height);
  std::iota(pixels.begin(), pixels.end(), std::size_t{0});
  return pixels;
}

std::vector<std::size_t> random_pixels(const FrameRecord& frame, std::size_t count, std::uint64_t seed) {
  std::vector<std::size_t> pixels = all_pixels(frame);
  draw(pixels, count, seed);
  return pixels;
}

std::vector<std::size_t> border_pixels(const RenderedFrame& rendered, std::size_t count, std::uint64_t seed) {
  const std::size_t width = rendered.frame.width;
  const std::size_t height = rendered.frame.height;
  const std::vector<std::uint32_t>& ids = rendered.planes.ids;
  std::vector<std::size_t> pixels;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const std::size_t x = i % width;
    const std::size_t y = i / width;
    const bool border = (x > 0 && ids[i - 1] != ids[i]) || (x + 1 < width && ids[i + 1] != ids[i]) ||
                        (y > 0 && ids[i - width] != ids[i]) || (y + 1 < height && ids[i + width] != ids[i]);
    if (border) pixels.push_back(i);
  }
  draw(pixels, count, seed);
  return pixels;
}

}  // namespace gridiron::test
