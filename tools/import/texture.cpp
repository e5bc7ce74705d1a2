// Texture. SPDX-License-Identifier: Apache-2.0
#include "import/texture.h"

#ifdef GRIDIRON_HAS_PNG
#include <png.h>
#endif

#include <algorithm>
#include <array>
#include <cmath>
#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <string_view>

#ifdef GRIDIRON_HAS_JPEG
#include <jpeglib.h>
#endif

namespace gridiron::tool {
namespace {

constexpr std::string_view kPngMagic = "\x89PNG", kJpegMagic = "\xFF\xD8\xFF";

bool starts_with(std::span<const std::byte> file, std::string_view magic) {
  return file.size() > magic.size() && std::memcmp(file.data(), magic.data(), magic.size()) == 0;
}

[[maybe_unused]] bool is_fit(std::uint64_t width, std::uint64_t height) {
  return width >= 1 && height >= 1 && width <= Texture::kMostWidth && height <= Texture::kMostWidth;
}

#ifdef GRIDIRON_HAS_PNG
std::optional<Texture> decode_png(std::span<const std::byte> file) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  if (png_image_begin_read_from_memory(&image, file.data(), file.size()) == 0) return std::nullopt;
  std::optional<Texture> texture;
  if (is_fit(image.width, image.height)) {
    // Alpha is left out here: of a transparent texel only the colour counts.
    image.format = PNG_FORMAT_RGBA;
    std::vector<std::uint8_t> rgba(PNG_IMAGE_SIZE(image));
    if (png_image_finish_read(&image, nullptr, rgba.data(), 0, nullptr) != 0) {
      const std::size_t count = rgba.size() / 4;
      for (std::size_t i = 0; i < count; ++i) std::memmove(rgba.data() + 3 * i, rgba.data() + 4 * i, 3);
      texture.emplace(image.width, image.height, std::span(rgba).first(3 * count));
    }
  }
  png_image_free(&image);
  return texture;
}
#endif

#ifdef GRIDIRON_HAS_JPEG
struct JpegErrors : jpeg_error_mgr {
  std::jmp_buf back;
};

// No C++ object with a destructor lives between setjmp and a jump back; the caller owns the rows.
bool read_jpeg_rows(std::span<const std::byte> file, std::vector<std::uint8_t>& rgb, std::uint32_t& width,
                    std::uint32_t& height) {
  jpeg_decompress_struct jpeg{};
  JpegErrors errors{};
  jpeg.err = jpeg_std_error(&errors);
  errors.error_exit = [](j_common_ptr common) { std::longjmp(static_cast<JpegErrors*>(common->err)->back, 1); };
  errors.output_message = [](j_common_ptr) {};
  if (setjmp(errors.back) != 0) {
    jpeg_destroy_decompress(&jpeg);
    return false;
  }
  jpeg_create_decompress(&jpeg);
  jpeg_mem_src(&jpeg, reinterpret_cast<const unsigned char*>(file.data()), static_cast<unsigned long>(file.size()));
  (void)jpeg_read_header(&jpeg, TRUE);
  if (!is_fit(jpeg.image_width, jpeg.image_height)) {
    jpeg_destroy_decompress(&jpeg);
    return false;
  }
  jpeg.out_color_space = JCS_RGB;
  (void)jpeg_start_decompress(&jpeg);
  width = jpeg.output_width;
  height = jpeg.output_height;
  rgb.resize(std::size_t{3} * width * height);
  while (jpeg.output_scanline < jpeg.output_height) {
    JSAMPROW row = rgb.data() + std::size_t{3} * width * jpeg.output_scanline;
    (void)jpeg_read_scanlines(&jpeg, &row, 1);
  }
  (void)jpeg_finish_decompress(&jpeg);
  jpeg_destroy_decompress(&jpeg);
  return true;
}

std::optional<Texture> decode_jpeg(std::span<const std::byte> file) {
  std::vector<std::uint8_t> rgb;
  std::uint32_t width = 0, height = 0;
  if (!read_jpeg_rows(file, rgb, width, height)) return std::nullopt;
  return Texture(width, height, rgb);
}
#endif

std::int64_t wrapped(std::int64_t index, std::int64_t count, Wrap wrap) {
  if (wrap == Wrap::kClamp) return std::clamp<std::int64_t>(index, 0, count - 1);
  const std::int64_t period = wrap == Wrap::kMirror ? 2 * count : count;
  const std::int64_t place = ((index % period) + period) % period;
  return place < count ? place : period - 1 - place;
}

}  // namespace

std::optional<Texture> Texture::decode([[maybe_unused]] std::span<const std::byte> file) {
#ifdef GRIDIRON_HAS_PNG
  if (starts_with(file, kPngMagic)) return decode_png(file);
#endif
#ifdef GRIDIRON_HAS_JPEG
  if (starts_with(file, kJpegMagic)) return decode_jpeg(file);
#endif
  return std::nullopt;
}

std::optional<std::string_view> Texture::missing_option([[maybe_unused]] std::span<const std::byte> file) {
#ifndef GRIDIRON_HAS_PNG
  if (starts_with(file, kPngMagic)) return "GRIDIRON_WITH_PNG";
#endif
#ifndef GRIDIRON_HAS_JPEG
  if (starts_with(file, kJpegMagic)) return "GRIDIRON_WITH_JPEG";
#endif
  return std::nullopt;
}

Texture::Texture(std::uint32_t width, std::uint32_t height, std::span<const std::uint8_t> rgb) {
  std::array<std::uint16_t, 256> linear{};
  for (std::size_t i = 0; i < linear.size(); ++i) {
    linear[i] = static_cast<std::uint16_t>(std::lround(65535.0f * linear_of_srgb(static_cast<float>(i) / 255.0f)));
  }
  Level level{width, height, std::vector<std::uint16_t>(rgb.size())};
  std::ranges::transform(rgb, level.rgb.begin(), [&linear](std::uint8_t value) { return linear[value]; });
  levels_.push_back(std::move(level));
  add_coarser_levels();
}

void Texture::add_coarser_levels() {
  while (levels_.back().width > 1 || levels_.back().height > 1) {
    const Level& fine = levels_.back();
    Level coarse{std::max(fine.width / 2, 1u), std::max(fine.height / 2, 1u), {}};
    coarse.rgb.resize(std::size_t{3} * coarse.width * coarse.height);
    const auto fine_texel = [&fine](std::size_t x, std::size_t y, std::size_t channel) -> std::uint32_t {
      x = std::min<std::size_t>(x, fine.width - 1);
      y = std::min<std::size_t>(y, fine.height - 1);
      return fine.rgb[3 * (y * fine.width + x) + channel];
    };
    for (std::size_t y = 0; y < coarse.height; ++y) {
      for (std::size_t x = 0; x < coarse.width; ++x) {
        for (std::size_t c = 0; c < 3; ++c) {
          const std::uint32_t sum = fine_texel(2 * x, 2 * y, c) + fine_texel(2 * x + 1, 2 * y, c) +
                                    fine_texel(2 * x, 2 * y + 1, c) + fine_texel(2 * x + 1, 2 * y + 1, c);
          coarse.rgb[3 * (y * coarse.width + x) + c] = static_cast<std::uint16_t>((sum + 2) / 4);
        }
      }
    }
    levels_.push_back(std::move(coarse));
  }
}

Vec3 Texture::Level::texel(std::int64_t x, std::int64_t y, Wrap wrap_u, Wrap wrap_v) const {
  const auto column = static_cast<std::size_t>(wrapped(x, width, wrap_u));
  const auto row = static_cast<std::size_t>(wrapped(y, height, wrap_v));
  const std::uint16_t* const value = rgb.data() + 3 * (row * width + column);
  constexpr float kUnit = 1.0f / 65535.0f;
  return {kUnit * static_cast<float>(value[0]), kUnit * static_cast<float>(value[1]),
          kUnit * static_cast<float>(value[2])};
}

Vec3 Texture::sample(float u, float v, Wrap wrap_u, Wrap wrap_v, float texels) const {
  if (!std::isfinite(u) || !std::isfinite(v)) u = v = 0.0f;
  // Far outside only the place within a period counts, and rounding leaves little of that.
  constexpr float kFarthest = 1e6f;
  u = std::clamp(u, -kFarthest, kFarthest);
  v = std::clamp(v, -kFarthest, kFarthest);
  const int wanted = texels > 1.0f ? std::ilogb(texels) : 0;
  const Level& level = levels_[std::min(static_cast<std::size_t>(wanted), levels_.size() - 1)];
  const double x = static_cast<double>(u) * level.width - 0.5;
  const double y = (1.0 - static_cast<double>(v)) * level.height - 0.5;
  const double left = std::floor(x), top = std::floor(y);
  const auto x0 = static_cast<std::int64_t>(left), y0 = static_cast<std::int64_t>(top);
  const auto a = static_cast<float>(x - left), b = static_cast<float>(y - top);
  const Vec3 upper = (1.0f - a) * level.texel(x0, y0, wrap_u, wrap_v) + a * level.texel(x0 + 1, y0, wrap_u, wrap_v);
  const Vec3 lower =
      (1.0f - a) * level.texel(x0, y0 + 1, wrap_u, wrap_v) + a * level.texel(x0 + 1, y0 + 1, wrap_u, wrap_v);
  return (1.0f - b) * upper + b * lower;
}

}  // namespace gridiron::tool
