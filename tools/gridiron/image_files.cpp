// Picture files. SPDX-License-Identifier: Apache-2.0
#include "image_files.h"

#include <bit>
#include <cstring>
#include <string>

namespace gridiron::tool {

static_assert(std::endian::native == std::endian::little, "pixels and floats are written as they lie in memory");

std::vector<std::byte> encode_pfm(const Picture<float>& picture) {
  // A negative scale is the format's way to say little-endian.
  const std::string header = "Pf\n" + std::to_string(picture.width) + " " + std::to_string(picture.height) + "\n-1.0\n";
  const std::size_t row_bytes = std::size_t{picture.width} * sizeof(float);
  std::vector<std::byte> file(header.size() + row_bytes * picture.height);
  std::memcpy(file.data(), header.data(), header.size());
  std::byte* out = file.data() + header.size();
  for (std::uint32_t row = picture.height; row-- > 0; out += row_bytes) {
    std::memcpy(out, picture.pixels.data() + std::size_t{row} * picture.width, row_bytes);
  }
  return file;
}

}  // namespace gridiron::tool
