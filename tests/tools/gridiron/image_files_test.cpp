// Picture files, read back by OpenImageIO. SPDX-License-Identifier: Apache-2.0
#include "files/image_files.h"

#include "files/png_file.h"
#include "support/picture.h"
#include "support/test_mesh.h"
#include "temporary_folder.h"

namespace gridiron::test {
namespace {

std::filesystem::path write_bytes(const TemporaryFolder& folder, const std::string& name,
                                  const std::vector<std::byte>& bytes) {
  return folder.write(name, std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
}

constexpr struct Size {
  std::uint32_t width, height;
} kSizes[] = {{1, 1}, {33, 17}, {1, 300}, {300, 1}, {64, 64}, {16385, 3}};

using EncodePng = std::vector<std::byte> (*)(const tool::Picture<std::uint32_t>&);

void expect_every_pixel(EncodePng encode_png) {
  const TemporaryFolder folder;
  for (const Size size : kSizes) {
    tool::Picture<std::uint32_t> picture{size.width, size.height, {}};
    TestRandom random(size.width * 1000 + size.height);
    for (std::uint32_t i = 0; i < size.width * size.height; ++i) {
      picture.pixels.push_back(static_cast<std::uint32_t>(random.next()) | 0xFF000000u);
    }
    const auto read = load_picture(write_bytes(folder, "a.png", encode_png(picture)));
    ASSERT_TRUE(read) << size.width << "x" << size.height;
    ASSERT_EQ(read->width, size.width);
    ASSERT_EQ(read->height, size.height);
    ASSERT_EQ(read->channels, 4u);
    for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
      for (std::uint32_t channel = 0; channel < 4; ++channel) {
        const auto expected = static_cast<float>(picture.pixels[i] >> (8 * channel) & 0xFFu);
        ASSERT_EQ(read->values[4 * i + channel], expected) << "pixel " << i << ", channel " << channel;
      }
    }
  }
}

TEST(ImageFiles, PngHoldsEveryPixel) {
  expect_every_pixel(tool::encode_png);
}

TEST(ImageFiles, PngWithoutLibpngHoldsEveryPixel) {
  expect_every_pixel(tool::encode_stored_png);
}

TEST(ImageFiles, PfmHoldsEveryFloatWithTheFirstRowOnTop) {
  const TemporaryFolder folder;
  for (const Size size : kSizes) {
    tool::Picture<float> picture{size.width, size.height, {}};
    for (std::uint32_t i = 0; i < size.width * size.height; ++i) {
      picture.pixels.push_back(static_cast<float>(i) * 0.1f - 1.0f);
    }
    picture.pixels.back() = std::numeric_limits<float>::infinity();
    const auto read = load_picture(write_bytes(folder, "a.pfm", tool::encode_pfm(picture)));
    ASSERT_TRUE(read) << size.width << "x" << size.height;
    ASSERT_EQ(read->width, size.width);
    ASSERT_EQ(read->height, size.height);
    ASSERT_EQ(read->channels, 1u);
    EXPECT_EQ(read->values, picture.pixels);
  }
}

TEST(ImageFiles, APictureIsTheSameInBothFormats) {
  const TemporaryFolder folder;
  tool::Picture<std::uint32_t> picture{5, 3, {}};
  for (std::uint32_t i = 0; i < 15; ++i) picture.pixels.push_back(0xFF000000u | i * 0x0A1107u);
  const auto png = load_picture(write_bytes(folder, "a.png", tool::encode_picture(picture, "a.PNG")));
  const auto pfm = load_picture(write_bytes(folder, "a.pfm", tool::encode_picture(picture, "a.PFM")));
  ASSERT_TRUE(png && pfm);
  ASSERT_EQ(pfm->channels, 3u);
  for (std::size_t pixel = 0; pixel < 15; ++pixel) {
    for (std::size_t channel = 0; channel < 3; ++channel) {
      EXPECT_EQ(pfm->values[3 * pixel + channel], png->values[4 * pixel + channel] / 255) << pixel;
    }
  }
  EXPECT_EQ(tool::encode_picture(picture, "-"), tool::encode_png(picture)) << "a device has no ending";
}

TEST(ImageFiles, PfmIsLittleEndianAndBottomUp) {
  const std::vector<std::byte> file = tool::encode_pfm({1, 2, {1.0f, -2.0f}});
  const std::string text(reinterpret_cast<const char*>(file.data()), file.size());
  EXPECT_EQ(text, std::string("Pf\n1 2\n-1.0\n\x00\x00\x00\xC0\x00\x00\x80\x3F", 20));
}

}  // namespace
}  // namespace gridiron::test
