// Compares a kernel's picture with the reference's: in steps of 1/255, and with OpenImageIO.
// Memory: borrowed. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace gridiron::test {

/// How far two pictures of 8 bits a channel are apart. A pixel is as far off as its channel that is off most, alpha
/// among them.
struct StepDifference {
  std::size_t pixels = 0;
  std::size_t off_by_more_than_1 = 0, off_by_more_than_2 = 0, off_by_more_than_8 = 0;  ///< pixels
  int largest = 0;              ///< steps
  double rmse = 0.0;            ///< steps, over the four channels of all pixels
  std::size_t worst_pixel = 0;  ///< index of the first pixel that is off by `largest`
};

/// @param a, b  0xAABBGGRR, row-major, of the same length. @returns nothing where lengths differ.
[[nodiscard]] std::optional<StepDifference> compare_steps(std::span<const std::uint32_t> a,
                                                          std::span<const std::uint32_t> b);

/// Thresholds of a channel's difference, in units of full brightness.
struct ImageThresholds {
  float fail = 2.5f / 255.0f;  ///< pixels off by more count as failed: more than 2 steps
  float warn = 1.5f / 255.0f;  ///< as warned: more than 1 step
};

/// The result of OpenImageIO::ImageBufAlgo::compare, in units of full brightness.
struct ImageComparison {
  double mean_error = 0.0, rms_error = 0.0, peak_signal_to_noise = 0.0, max_error = 0.0;
  std::uint32_t worst_x = 0, worst_y = 0;  ///< where max_error is
  std::uint64_t warned = 0, failed = 0;    ///< pixels
};

/// @returns nothing where sizes do not fit or the library finds an error.
[[nodiscard]] std::optional<ImageComparison> compare_images(std::span<const std::uint32_t> a,
                                                            std::span<const std::uint32_t> b, std::uint32_t width,
                                                            std::uint32_t height,
                                                            const ImageThresholds& thresholds = {});

}  // namespace gridiron::test
