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

// Noise. Opaque, for OpenImageIO multiplies colours by their alpha.
tool::Picture<std::uint32_t> noise_picture(Size size) {
  tool::Picture<std::uint32_t> picture{size.width, size.height, {}};
  TestRandom random(size.width * 1000 + size.height);
  for (std::size_t i = 0; i < std::size_t{size.width} * size.height; ++i) {
    picture.pixels.push_back(static_cast<std::uint32_t>(random.next()) | 0xFF000000u);
  }
  return picture;
}

// Flat rows, ramps across, noise, ramps in both directions and curved ones in turn: every row filter has rows where it
// is the best one.
tool::Picture<std::uint32_t> smooth_picture(Size size) {
  tool::Picture<std::uint32_t> picture{size.width, size.height, {}};
  for (std::uint32_t y = 0; y < size.height; ++y) {
    const std::uint32_t kind = y / 3 % 5;
    for (std::uint32_t x = 0; x < size.width; ++x) {
      const std::uint32_t value = kind == 0   ? 40
                                  : kind == 1 ? 3 * x
                                  : kind == 2 ? x * x * 2654435761u + 5 * y
                                  : kind == 3 ? 2 * x + 3 * y
                                              : (x * x + y * y) / 64;
      picture.pixels.push_back(0xFF000000u | (value & 0xFFu) << 16 | (2 * value & 0xFFu) << 8 | ((value / 3) & 0xFFu));
    }
  }
  return picture;
}

void expect_pixels(const TemporaryFolder& folder, const tool::Picture<std::uint32_t>& picture,
                   const std::vector<std::byte>& png) {
  SCOPED_TRACE(std::to_string(picture.width) + "x" + std::to_string(picture.height));
  const auto read = load_picture(write_bytes(folder, "a.png", png));
  ASSERT_TRUE(read);
  ASSERT_EQ(read->width, picture.width);
  ASSERT_EQ(read->height, picture.height);
  ASSERT_EQ(read->channels, 4u);
  for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
    for (std::uint32_t channel = 0; channel < 4; ++channel) {
      const auto expected = static_cast<float>(picture.pixels[i] >> (8 * channel) & 0xFFu);
      ASSERT_EQ(read->values[4 * i + channel], expected) << "pixel " << i << ", channel " << channel;
    }
  }
}

// Reads a PNG file by its specification: checks every CRC. OpenImageIO reads past wrong ones of some chunks.
std::string data_of_png(const std::vector<std::byte>& png) {
  std::string data;
  const auto word = [&png](std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i) value = value << 8 | static_cast<std::uint32_t>(png.at(at + i));
    return value;
  };
  for (std::size_t at = 8; at < png.size();) {
    const std::uint32_t bytes = word(at);
    std::uint32_t crc = 0xFFFFFFFFu;
    for (std::size_t i = at + 4; i < at + 8 + bytes; ++i) {
      crc ^= static_cast<std::uint32_t>(png.at(i));
      for (int bit = 0; bit < 8; ++bit) crc = (crc & 1u) != 0 ? 0xEDB88320u ^ crc >> 1 : crc >> 1;
    }
    EXPECT_EQ(word(at + 8 + bytes), ~crc) << "of the chunk at byte " << at;
    const auto* begin = reinterpret_cast<const char*>(png.data()) + at;
    if (std::string_view(begin + 4, 4) == "IDAT") data.append(begin + 8, bytes);
    at += 12 + bytes;
  }
  return data;
}

TEST(ImageFiles, PngHoldsEveryPixel) {
  const TemporaryFolder folder;
  for (const Size size : kSizes) {
    for (const auto& picture : {noise_picture(size), smooth_picture(size)}) {
      expect_pixels(folder, picture, tool::encode_png(picture));
      expect_pixels(folder, picture, tool::encode_stored_png(picture));
    }
  }
}

// One pixel wide; several bands, the last one short; one whole band; one and a row; a row a band.
constexpr Size kBandSizes[] = {{1, 450000}, {700, 1000}, {1023, 256}, {1023, 257}, {262144, 3}};

TEST(ImageFiles, ThePngOfSeveralBandsIsTheSameForEveryNumberOfThreads) {
  const TemporaryFolder folder;
  for (const Size size : kBandSizes) {
    const std::uint32_t rows = tool::png_band_rows(size.width), count = tool::png_band_count(size.width, size.height);
    EXPECT_EQ(count, size.height / rows + (size.height % rows != 0));
    EXPECT_EQ(count > 1, size.height != 256);
    for (const auto& picture : {noise_picture(size), smooth_picture(size)}) {
      const std::vector<std::byte> png = tool::encode_png(picture);
      expect_pixels(folder, picture, png);
      EXPECT_TRUE(tool::encode_png(picture, 2) == png);
      EXPECT_TRUE(tool::encode_png(picture, 3) == png);
      expect_pixels(folder, picture, tool::encode_stored_png(picture));
    }
  }
  EXPECT_EQ(tool::png_band_rows(262144), 1u);
}

TEST(ImageFiles, EveryChunkOfAPngHasItsCrcAndTheStreamItsAdler) {
  const tool::Picture<std::uint32_t> picture = noise_picture({700, 1000});
  // The stored blocks are left out, but for the filter of each row, which is 0.
  std::uint32_t low = 1, high = 0;
  const auto add = [&low, &high](std::uint32_t byte) {
    low = (low + byte) % 65521;
    high = (high + low) % 65521;
  };
  for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
    if (i % 700 == 0) add(0);
    for (std::uint32_t shift = 0; shift < 32; shift += 8) add(picture.pixels[i] >> shift & 0xFFu);
  }
  const std::string stored = data_of_png(tool::encode_stored_png(picture));
  std::uint32_t adler = 0;
  for (const char byte : stored.substr(stored.size() - 4)) adler = adler << 8 | static_cast<unsigned char>(byte);
  EXPECT_EQ(adler, high << 16 | low);
  EXPECT_EQ(stored.substr(0, 2), "\x78\x01");
  EXPECT_EQ(data_of_png(tool::encode_png(picture)).substr(0, 2), "\x78\x9C");
}

TEST(ImageFiles, BandsMadeElsewhereMakeTheSamePng) {
  const tool::Picture<std::uint32_t> picture = smooth_picture({700, 1000});
  std::vector<tool::PngBand> bands(tool::png_band_count(700, 1000));
  ASSERT_EQ(bands.size(), 3u);
  for (std::uint32_t i = 3; i-- > 0;) {
    // Another process has these rows and the one above, and nothing else of the picture.
    const tool::PngRows rows = tool::png_rows_of_band(picture, i);
    EXPECT_EQ(rows.above.empty(), i == 0);
    EXPECT_EQ(rows.is_last, i == 2);
    const std::vector<std::uint32_t> pixels(rows.rows.begin(), rows.rows.end());
    const std::vector<std::uint32_t> above(rows.above.begin(), rows.above.end());
    bands[i] = tool::encode_png_band({700, pixels, above, rows.is_last});
    EXPECT_EQ(bands[i].raw_bytes, pixels.size() / 700 * (1 + 4 * 700));
  }
  EXPECT_TRUE(tool::join_png_bands(700, 1000, std::move(bands)) == tool::encode_png(picture));
}

TEST(ImageFiles, BandsAfterTheFirstBeginFromTheRowAboveThem) {
  tool::Picture<std::uint32_t> picture = noise_picture({8192, 1});
  const std::size_t row_bytes = tool::encode_png(picture).size();
  const std::vector<std::uint32_t> row = picture.pixels;
  for (picture.height = 1; picture.height < 310; ++picture.height) {
    picture.pixels.insert(picture.pixels.end(), row.begin(), row.end());
  }
  ASSERT_EQ(tool::png_band_count(8192, 310), 10u);
  EXPECT_LT(tool::encode_png(picture).size(), 2 * row_bytes) << "one row, repeated: no band stores it again";
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
