// Frame pictures. SPDX-License-Identifier: Apache-2.0
#include "frame_pictures.h"

#include <gridiron/base/math.h>
#include <gridiron/frame/frame_setup.h>
#include <report/report.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>
#include <string>
#include <tuple>

#include "base/failure.h"
#include "base/words.h"

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
  const std::uint32_t first_x = tile ? tile->x * frame.tile_width : 0;
  const std::uint32_t first_y = tile ? tile->y * frame.tile_width : 0;
  Picture<std::uint32_t> picture;
  picture.width = tile ? std::min(frame.tile_width, frame.width - first_x) : frame.width;
  picture.height = tile ? std::min(frame.tile_width, frame.height - first_y) : frame.height;
  picture.pixels.resize(std::size_t{picture.width} * picture.height);
  std::uint32_t* words = picture.pixels.data();
  const std::uint32_t end_x = first_x + picture.width;
  for (std::uint32_t y = first_y; y < first_y + picture.height; ++y) {
    // A row of a tile lies in one piece. first_x is a tile's edge.
    for (std::uint32_t x = first_x; x < end_x; x += frame.tile_width) {
      const std::uint32_t count = std::min(frame.tile_width, end_x - x);
      const std::uint64_t index = output_plane_index(frame.width, frame.tile_width, x, y);
      std::memcpy(words, plane.data() + index * sizeof *words, count * sizeof *words);
      words += count;
    }
  }
  return picture;
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
  input_error(input, "--ids: " + words_of_count(triangle_count) +
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
