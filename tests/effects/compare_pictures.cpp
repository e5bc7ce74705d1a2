// Comparison of pictures: see the header. SPDX-License-Identifier: Apache-2.0
#include "effects/compare_pictures.h"

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <vector>

namespace gridiron::test {
namespace {

// Red first, whatever the host's byte order.
std::vector<std::uint8_t> bytes_of(std::span<const std::uint32_t> picture) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(4 * picture.size());
  for (const std::uint32_t color : picture) {
    for (int shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<std::uint8_t>(color >> shift));
  }
  return bytes;
}

}  // namespace

std::optional<StepDifference> compare_steps(std::span<const std::uint32_t> a, std::span<const std::uint32_t> b) {
  if (a.size() != b.size()) return std::nullopt;
  StepDifference result;
  result.pixels = a.size();
  double squares = 0.0;
  for (std::size_t pixel = 0; pixel < a.size(); ++pixel) {
    int most = 0;
    for (int shift = 0; shift < 32; shift += 8) {
      const int steps = std::abs(static_cast<int>((a[pixel] >> shift) & 255u) -
                                 static_cast<int>((b[pixel] >> shift) & 255u));
      squares += double(steps) * steps;
      most = std::max(most, steps);
    }
    result.off_by_more_than_1 += most > 1 ? 1 : 0;
    result.off_by_more_than_2 += most > 2 ? 1 : 0;
    result.off_by_more_than_8 += most > 8 ? 1 : 0;
    if (most > result.largest) {
      result.largest = most;
      result.worst_pixel = pixel;
    }
  }
  if (!a.empty()) result.rmse = std::sqrt(squares / (4.0 * static_cast<double>(a.size())));
  return result;
}

std::optional<ImageComparison> compare_images(std::span<const std::uint32_t> a, std::span<const std::uint32_t> b,
                                              std::uint32_t width, std::uint32_t height,
                                              const ImageThresholds& thresholds) {
  const std::size_t pixels = std::size_t{width} * height;
  if (pixels == 0 || a.size() != pixels || b.size() != pixels) return std::nullopt;
  const OIIO::ImageSpec spec(static_cast<int>(width), static_cast<int>(height), 4, OIIO::TypeDesc::UINT8);
  std::vector<std::uint8_t> bytes_a = bytes_of(a);
  std::vector<std::uint8_t> bytes_b = bytes_of(b);
  const OIIO::ImageBuf image_a(spec, bytes_a.data());
  const OIIO::ImageBuf image_b(spec, bytes_b.data());
  const OIIO::ImageBufAlgo::CompareResults found =
      OIIO::ImageBufAlgo::compare(image_a, image_b, thresholds.fail, thresholds.warn);
  // Its own `error` says that pixels failed.
  if (image_a.has_error() || image_b.has_error()) return std::nullopt;
  ImageComparison result;
  result.mean_error = found.meanerror;
  result.rms_error = found.rms_error;
  result.peak_signal_to_noise = found.PSNR;
  result.max_error = found.maxerror;
  result.worst_x = static_cast<std::uint32_t>(found.maxx);
  result.worst_y = static_cast<std::uint32_t>(found.maxy);
  result.warned = found.nwarn;
  result.failed = found.nfail;
  return result;
}

}  // namespace gridiron::test
