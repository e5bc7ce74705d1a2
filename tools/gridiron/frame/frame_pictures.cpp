// Frame pictures. SPDX-License-Identifier: Apache-2.0
#include "frame_pictures.h"

#include <gridiron/base/math.h>
#include <report/report.h>

#include <bit>
#include <limits>
#include <string>
#include <tuple>

#include "base/failure.h"
#include "base/words.h"
#include "untile.h"

namespace gridiron::tool {
namespace {

template <class Convert>
Picture<float> convert_words(const Picture<std::uint32_t>& words, Convert convert) {
  Picture<float> picture{words.width, words.height, {}};
  picture.pixels.reserve(words.pixels.size());
  for (const std::uint32_t word : words.pixels) picture.pixels.push_back(convert(word));
  return picture;
}

}  // namespace

Picture<std::uint32_t> words_of_plane(const FrameRecord& frame, std::span<const std::byte> plane,
                                      std::optional<CountPair> tile) {
  return untile<std::uint32_t>(frame, plane, tile, [](std::uint32_t word) { return word; });
}

Picture<float> depth_picture(const Picture<std::uint32_t>& words) {
  return convert_words(words, [](std::uint32_t word) {
    // A chip may have no infinity, so its plane has the largest float without a hit.
    const float depth = std::bit_cast<float>(word);
    return depth >= kFloatMax ? std::numeric_limits<float>::infinity() : depth;
  });
}

Picture<float> id_picture(const Picture<std::uint32_t>& words) {
  return convert_words(words,
                       [](std::uint32_t word) { return word == kNoTriangle ? -1.0f : static_cast<float>(word); });
}

void require_exact_ids(const std::filesystem::path& input, std::uint64_t triangle_count) {
  constexpr std::uint64_t kMostExactIds = 1u << 24;
  if (triangle_count <= kMostExactIds) return;
  throw Failure(ExitCode::kBadInput, input.string() + ": --ids: " + words_of_count(triangle_count) +
                                         " triangles; the floats of a PFM file distinguish at most 16,777,216");
}

void require_same_planes(const PlaneHashes& first, const PlaneHashes& again, std::uint32_t repeat) {
  if (again == first) return;
  const auto& [plane, before, now] = again.color != first.color ? std::tuple("picture", first.color, again.color)
                                     : again.depth != first.depth
                                         ? std::tuple("plane of distances", first.depth, again.depth)
                                         : std::tuple("plane of triangle ids", first.ids, again.ids);
  throw Failure(ExitCode::kCheckFailed, "--repeat: render " + std::to_string(repeat) + " made another " + plane +
                                            " than the first: hash " + hash_text(now) + ", not " + hash_text(before));
}

}  // namespace gridiron::tool
