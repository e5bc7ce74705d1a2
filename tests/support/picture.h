// Picture files as numbers, read by OpenImageIO: a second opinion on what the tools write.
// Memory: std::vector. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "support/test_headers.h"

namespace gridiron::test {

/// Row-major, row 0 on top whatever the file's own order.
struct Picture {
  std::uint32_t width = 0, height = 0, channels = 0;
  std::vector<float> values;  ///< width * height * channels; 8-bit files: 0..255, not 0..1
};

/// @returns nothing where the file is missing or no picture.
std::optional<Picture> load_picture(const std::filesystem::path& path);

/// Pixel-wise difference of two pictures of the same size.
struct PictureDifference {
  std::size_t differing_pixels = 0;
  double largest = 0.0;
  std::size_t first_pixel = 0;  ///< row-major index; meaningful where differing_pixels > 0
};

/// @returns nothing where sizes or channels differ. Equal infinities are equal; a NaN equals nothing.
std::optional<PictureDifference> compare_pictures(const Picture& a, const Picture& b);

}  // namespace gridiron::test
