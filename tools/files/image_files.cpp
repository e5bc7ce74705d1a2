// Picture files. SPDX-License-Identifier: Apache-2.0
#include "image_files.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <string>

#include "output_target.h"

namespace gridiron::tool {
namespace {

static_assert(std::endian::native == std::endian::little, "floats are written as they lie in memory");

// @param write_row  called with a row and the place for its floats, `channels` a pixel.
template <class WriteRow>
std::vector<std::byte> encode_floats(std::uint32_t width, std::uint32_t height, std::uint32_t channels,
                                     WriteRow write_row) {
  // In the format a negative scale means little-endian.
  const std::string header = std::string(channels == 3 ? "PF" : "Pf") + "\n" + std::to_string(width) + " " +
                             std::to_string(height) + "\n-1.0\n";
  std::vector<float> floats(std::size_t{width} * channels);
  const std::size_t row_bytes = floats.size() * sizeof(float);
  std::vector<std::byte> file(header.size() + row_bytes * height);
  std::memcpy(file.data(), header.data(), header.size());
  std::byte* out = file.data() + header.size();
  for (std::uint32_t row = height; row-- > 0; out += row_bytes) {
    write_row(row, floats.data());
    std::memcpy(out, floats.data(), row_bytes);
  }
  return file;
}

}  // namespace

std::vector<std::byte> encode_pfm(const Picture<float>& picture) {
  return encode_floats(picture.width, picture.height, 1, [&picture](std::uint32_t row, float* out) {
    std::ranges::copy_n(picture.pixels.begin() + std::ptrdiff_t{row} * picture.width, picture.width, out);
  });
}

std::vector<std::byte> encode_color_pfm(const Picture<std::uint32_t>& picture) {
  return encode_floats(picture.width, picture.height, 3, [&picture](std::uint32_t row, float* out) {
    for (std::uint32_t column = 0; column < picture.width; ++column) {
      const std::uint32_t pixel = picture.pixels[std::size_t{row} * picture.width + column];
      for (std::uint32_t shift = 0; shift < 24; shift += 8) *out++ = static_cast<float>(pixel >> shift & 0xFFu) / 255;
    }
  });
}

std::vector<std::byte> encode_picture(const Picture<std::uint32_t>& picture, const std::filesystem::path& path,
                                      std::uint32_t threads) {
  return has_ending(path, ".pfm") ? encode_color_pfm(picture) : encode_png(picture, threads);
}

}  // namespace gridiron::tool
