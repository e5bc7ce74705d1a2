// PNG files: by libpng if the build has it, else with the format's stored blocks.
// Source: PNG specification, third edition; RFC 1950 and RFC 1951. SPDX-License-Identifier: Apache-2.0
#include "png_file.h"

#ifdef GRIDIRON_HAS_PNG
#include <png.h>
#endif

#include <algorithm>
#include <array>
#include <cstring>
#include <iterator>
#include <new>
#include <span>
#include <string>
#include <string_view>

#include "base/failure.h"

namespace gridiron::tool {
namespace {

constexpr std::array<std::uint32_t, 256> kCrcTable = [] {
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t i = 0; i < table.size(); ++i) {
    std::uint32_t value = i;
    for (int bit = 0; bit < 8; ++bit) value = (value & 1u) != 0 ? 0xEDB88320u ^ (value >> 1) : value >> 1;
    table[i] = value;
  }
  return table;
}();

std::uint32_t crc_of(std::span<const std::byte> bytes) {
  std::uint32_t crc = 0xFFFFFFFFu;
  for (const std::byte byte : bytes) crc = kCrcTable[(crc ^ static_cast<std::uint32_t>(byte)) & 0xFFu] ^ (crc >> 8);
  return ~crc;
}

// Adler-32 of zlib streams, over several calls.
class Adler {
 public:
  void add(std::span<const std::byte> bytes) {
    constexpr std::uint32_t kPrime = 65521;
    for (const std::byte byte : bytes) {
      low_ = (low_ + static_cast<std::uint32_t>(byte)) % kPrime;
      high_ = (high_ + low_) % kPrime;
    }
  }
  [[nodiscard]] std::uint32_t value() const { return high_ << 16 | low_; }

 private:
  std::uint32_t low_ = 1, high_ = 0;
};

void append_big_endian(std::vector<std::byte>& file, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) file.push_back(static_cast<std::byte>(value >> shift & 0xFFu));
}

void append_chunk(std::vector<std::byte>& file, std::string_view type, std::span<const std::byte> data) {
  append_big_endian(file, static_cast<std::uint32_t>(data.size()));
  const std::size_t begin = file.size();
  for (const char letter : type) file.push_back(static_cast<std::byte>(letter));
  file.insert(file.end(), data.begin(), data.end());
  append_big_endian(file, crc_of(std::span(file).subspan(begin)));
}

}  // namespace

std::vector<std::byte> encode_stored_png(const Picture<std::uint32_t>& picture) {
  constexpr std::size_t kMostBlockBytes = 65535;
  const std::size_t row_bytes = 1 + std::size_t{picture.width} * sizeof(std::uint32_t);
  std::size_t left = row_bytes * picture.height;

  std::vector<std::byte> file;
  append_big_endian(file, 0x89504E47u);  // 0x89 PNG
  append_big_endian(file, 0x0D0A1A0Au);
  std::vector<std::byte> header;
  append_big_endian(header, picture.width);
  append_big_endian(header, picture.height);
  constexpr std::byte kRgba8[] = {std::byte{8}, std::byte{6}, std::byte{0}, std::byte{0}, std::byte{0}};
  header.insert(header.end(), std::begin(kRgba8), std::end(kRgba8));
  append_chunk(file, "IHDR", header);

  // Each row is a filter byte, 0, and its pixels. Each chunk is one stored block.
  std::vector<std::byte> row(row_bytes);
  std::size_t row_used = row_bytes;
  std::uint32_t next_row = 0;
  Adler adler;
  std::vector<std::byte> chunk = {std::byte{0x78}, std::byte{0x01}};  // a zlib stream
  while (left > 0) {
    const std::size_t block_bytes = std::min(left, kMostBlockBytes);
    left -= block_bytes;
    const auto length = static_cast<std::uint32_t>(block_bytes);
    chunk.push_back(std::byte{left == 0});
    for (const std::uint32_t half : {length, ~length}) {
      chunk.push_back(static_cast<std::byte>(half & 0xFFu));
      chunk.push_back(static_cast<std::byte>(half >> 8 & 0xFFu));
    }
    for (std::size_t taken = 0; taken < block_bytes;) {
      if (row_used == row_bytes) {
        std::memcpy(row.data() + 1, picture.pixels.data() + std::size_t{next_row} * picture.width, row_bytes - 1);
        adler.add(row);
        ++next_row;
        row_used = 0;
      }
      const std::size_t count = std::min(row_bytes - row_used, block_bytes - taken);
      const std::span piece = std::span(row).subspan(row_used, count);
      chunk.insert(chunk.end(), piece.begin(), piece.end());
      row_used += count;
      taken += count;
    }
    if (left == 0) append_big_endian(chunk, adler.value());
    append_chunk(file, "IDAT", chunk);
    chunk.clear();
  }
  append_chunk(file, "IEND", {});
  return file;
}

#ifdef GRIDIRON_HAS_PNG
std::vector<std::byte> encode_png(const Picture<std::uint32_t>& picture) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = picture.width;
  image.height = picture.height;
  image.format = PNG_FORMAT_RGBA;
  std::vector<std::byte> file(PNG_IMAGE_PNG_SIZE_MAX(image));
  png_alloc_size_t file_bytes = file.size();
  if (png_image_write_to_memory(&image, file.data(), &file_bytes, 0, picture.pixels.data(), 0, nullptr) == 0) {
    if (std::string_view(image.message).find("memory") != std::string_view::npos) throw std::bad_alloc();
    throw Failure(ExitCode::kBadInput, std::string("cannot encode the picture: ") + image.message);
  }
  file.resize(file_bytes);
  return file;
}
#else
std::vector<std::byte> encode_png(const Picture<std::uint32_t>& picture) {
  return encode_stored_png(picture);
}
#endif

}  // namespace gridiron::tool
