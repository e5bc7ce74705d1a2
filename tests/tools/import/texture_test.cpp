// Textures: wrap modes, filtering, footprints, damaged pictures. SPDX-License-Identifier: Apache-2.0
#include "import/texture.h"

#include "model_files.h"

#ifdef GRIDIRON_HAS_JPEG
#include <jpeglib.h>
#endif

namespace gridiron::test {
namespace {

using tool::Texture;
using tool::Wrap;

float red(const Texture& texture, float u, Wrap wrap, float texels = 0) {
  return texture.sample(u, 0.5f, wrap, wrap, texels).x;
}

// Black and white columns.
Texture stripes(std::uint32_t width) {
  std::vector<std::uint8_t> rgb;
  for (std::uint32_t i = 0; i < width; ++i) rgb.insert(rgb.end(), 3, i % 2 == 0 ? 0 : 255);
  return {width, 1, rgb};
}

TEST(Texture, SamplesAreBilinearAndLinear) {
  const Texture two = stripes(2);
  EXPECT_EQ(red(two, 0.25f, Wrap::kClamp), 0.0f);
  EXPECT_EQ(red(two, 0.75f, Wrap::kClamp), 1.0f);
  EXPECT_NEAR(red(two, 0.5f, Wrap::kClamp), 0.5f, 1e-4f);  // of light, not of sRGB
  const std::uint8_t grey[] = {128, 128, 128};
  EXPECT_NEAR(red(Texture(1, 1, grey), 0.3f, Wrap::kRepeat), 0.2158605f, 2e-5f);  // IEC 61966-2-1
}

TEST(Texture, CoordinatesOutsideAreWrapped) {
  const Texture four(4, 1, std::vector<std::uint8_t>{0, 0, 0, 0, 0, 0, 0, 0, 0, 255, 255, 255});
  const float last = 0.875f;
  EXPECT_EQ(red(four, last + 1, Wrap::kRepeat), 1.0f);
  EXPECT_EQ(red(four, last - 3, Wrap::kRepeat), 1.0f);
  EXPECT_EQ(red(four, 5.0f, Wrap::kClamp), 1.0f);
  EXPECT_EQ(red(four, -5.0f, Wrap::kClamp), 0.0f);
  EXPECT_EQ(red(four, 1.125f, Wrap::kMirror), 1.0f);
  EXPECT_EQ(red(four, 1.875f, Wrap::kMirror), 0.0f);
  EXPECT_NEAR(red(four, 0.0f, Wrap::kRepeat), 0.5f, 1e-4f);  // across the seam
  for (const float wild : {1e30f, -1e30f, std::numeric_limits<float>::infinity(), std::nanf("")}) {
    EXPECT_LE(red(four, wild, Wrap::kRepeat), 1.0f);
  }
}

TEST(Texture, LargeFootprintsAreAveraged) {
  const Texture many = stripes(64);
  EXPECT_NEAR(red(many, 0.3f, Wrap::kRepeat, 4.0f), 0.5f, 1e-3f);
  EXPECT_NEAR(red(many, 0.3f, Wrap::kRepeat, 1e9f), 0.5f, 1e-3f);
}

TEST(Texture, RowsRunDownwards) {
  const Texture tall(1, 2, std::vector<std::uint8_t>{255, 255, 255, 0, 0, 0});
  EXPECT_EQ(tall.sample(0.5f, 0.75f, Wrap::kClamp, Wrap::kClamp, 0).x, 1.0f);
  EXPECT_EQ(tall.sample(0.5f, 0.25f, Wrap::kClamp, Wrap::kClamp, 0).x, 0.0f);
}

#ifdef GRIDIRON_HAS_JPEG
// A picture of one colour as a JPEG file.
std::string jpeg_bytes(std::uint32_t width, std::uint32_t height, std::array<std::uint8_t, 3> color) {
  jpeg_compress_struct jpeg{};
  jpeg_error_mgr errors{};
  jpeg.err = jpeg_std_error(&errors);
  jpeg_create_compress(&jpeg);
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&jpeg, &bytes, &size);
  jpeg.image_width = width;
  jpeg.image_height = height;
  jpeg.input_components = 3;
  jpeg.in_color_space = JCS_RGB;
  jpeg_set_defaults(&jpeg);
  jpeg_start_compress(&jpeg, TRUE);
  std::vector<std::uint8_t> row;
  for (std::uint32_t i = 0; i < width; ++i) row.insert(row.end(), color.begin(), color.end());
  JSAMPROW rows[] = {row.data()};
  while (jpeg.next_scanline < height) (void)jpeg_write_scanlines(&jpeg, rows, 1);
  jpeg_finish_compress(&jpeg);
  jpeg_destroy_compress(&jpeg);
  std::string file(reinterpret_cast<const char*>(bytes), size);
  std::free(bytes);
  return file;
}

TEST(Texture, JpegFilesAreDecoded) {
  const std::string file = jpeg_bytes(19, 7, {200, 100, 50});
  const auto decode = [](std::string_view bytes) { return Texture::decode(std::as_bytes(std::span(bytes))); };
  const std::optional<Texture> texture = decode(file);
  ASSERT_TRUE(texture.has_value());
  EXPECT_EQ(texture->width(), 19u);
  EXPECT_EQ(texture->height(), 7u);
  const Vec3 color = texture->sample(0.5f, 0.5f, Wrap::kRepeat, Wrap::kRepeat, 0);
  EXPECT_NEAR(color.x, tool::linear_of_srgb(200.0f / 255.0f), 0.02f);
  EXPECT_NEAR(color.y, tool::linear_of_srgb(100.0f / 255.0f), 0.02f);
  EXPECT_NEAR(color.z, tool::linear_of_srgb(50.0f / 255.0f), 0.02f);
  for (std::size_t size = 0; size < 100; ++size) (void)decode(file.substr(0, size));
}
#endif

TEST(Texture, DamagedPicturesAreNone) {
  const std::string png = png_bytes(2, 2, std::vector<std::array<std::uint8_t, 3>>(4, {10, 20, 30}));
  const auto decode = [](std::string_view bytes) { return Texture::decode(std::as_bytes(std::span(bytes))); };
  ASSERT_TRUE(decode(png).has_value());
  for (std::size_t size = 0; size < 40; ++size) EXPECT_FALSE(decode(png.substr(0, size)).has_value()) << size;
  EXPECT_FALSE(decode("\xFF\xD8\xFF\xE0 and nothing").has_value());
  EXPECT_FALSE(decode("GIF89a").has_value());
}

}  // namespace
}  // namespace gridiron::test
