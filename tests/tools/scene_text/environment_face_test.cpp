// Faces of environment cubes from PFM and PNG. SPDX-License-Identifier: Apache-2.0
#include <png.h>

#include "base/failure.h"
#include "check_scene.h"
#include "scene_makers/procedural.h"
#include "scene_text/scene_files.h"
#include "support/test_headers.h"
#include "temporary_folder.h"

namespace gridiron::test {
namespace {

using tool::EnvironmentFace;
using tool::read_environment_face;

std::string pfm(const char* magic, std::uint32_t width, const char* scale, const std::vector<float>& values) {
  std::string bytes =
      std::string(magic) + "\n" + std::to_string(width) + " " + std::to_string(width) + "\n" + scale + "\n";
  for (const float value : values) {
    std::uint32_t bits = std::bit_cast<std::uint32_t>(value);
    if (scale[0] != '-') bits = __builtin_bswap32(bits);
    char raw[4];
    std::memcpy(raw, &bits, sizeof raw);
    bytes.append(raw, sizeof raw);
  }
  return bytes;
}

// A PNG of 2x2 pixels in one of libpng's formats.
std::string png(std::uint32_t format, const std::vector<std::uint8_t>& bytes) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = image.height = 2;
  image.format = format;
  std::string file(4096, '\0');
  png_alloc_size_t size = file.size();
  EXPECT_NE(png_image_write_to_memory(&image, file.data(), &size, 0, bytes.data(), 0, nullptr), 0) << image.message;
  file.resize(size);
  return file;
}

TEST(EnvironmentFace, ReadsPfmOfEitherByteOrder) {
  const TemporaryFolder folder;
  const std::vector<float> values = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10.5f, 0, 1e30f};
  for (const char* scale : {"-1.0", "1.0", "-3", "2e5"}) {
    const EnvironmentFace face = read_environment_face(folder.write("a.pfm", pfm("PF", 2, scale, values)));
    ASSERT_EQ(face.width, 2u);
    const std::vector<Vec3> expected = {Vec3(7, 8, 9), Vec3(10.5f, 0, 1e30f), Vec3(1, 2, 3), Vec3(4, 5, 6)};
    EXPECT_EQ(face.texels, expected) << "the file's last row is the top";
  }
  const EnvironmentFace grey = read_environment_face(folder.write("g.pfm", pfm("Pf", 1, "-1", {0.25f})));
  EXPECT_EQ(grey.texels[0], Vec3(0.25f));
}

TEST(EnvironmentFace, ReadsPngOfColourGreyAndAlpha) {
  const TemporaryFolder folder;
  const EnvironmentFace colour = read_environment_face(
      folder.write("c.png", png(PNG_FORMAT_RGB, {255, 0, 0, 0, 51, 0, 0, 0, 102, 255, 255, 255})));
  ASSERT_EQ(colour.width, 2u);
  EXPECT_EQ(colour.texels[0], Vec3(1, 0, 0));
  EXPECT_EQ(colour.texels[1], Vec3(0, 0.2f, 0)) << "51 / 255, no transfer curve";
  EXPECT_EQ(colour.texels[2], Vec3(0, 0, 0.4f));
  EXPECT_EQ(colour.texels[3], Vec3(1));
  const EnvironmentFace grey = read_environment_face(folder.write("g.png", png(PNG_FORMAT_GRAY, {0, 51, 102, 255})));
  EXPECT_EQ(grey.texels[1], Vec3(0.2f));
  const EnvironmentFace clear = read_environment_face(
      folder.write("a.png", png(PNG_FORMAT_RGBA, {255, 255, 255, 0, 9, 9, 9, 255, 0, 0, 0, 0, 0, 0, 0, 0})));
  EXPECT_EQ(clear.texels[0], Vec3(0)) << "over black";
}

TEST(EnvironmentFace, EveryTruncationIsAnError) {
  const TemporaryFolder folder;
  const std::string files[] = {pfm("PF", 2, "-1.0", std::vector<float>(12, 1.0f)),
                               png(PNG_FORMAT_RGB, std::vector<std::uint8_t>(12, 77))};
  for (const std::string& whole : files) {
    static_cast<void>(read_environment_face(folder.write("whole", whole)));
    for (std::size_t bytes = 0; bytes < whole.size(); ++bytes) {
      const auto path = folder.write("cut", whole.substr(0, bytes));
      // A PNG without its closing chunk is still a whole picture.
      if (whole.starts_with("\x89PNG") && bytes + 12 >= whole.size()) continue;
      EXPECT_THROW(static_cast<void>(read_environment_face(path)), tool::Failure) << bytes;
    }
  }
}

TEST(EnvironmentFace, ChangedBytesNeverCrash) {
  const TemporaryFolder folder;
  const std::string files[] = {pfm("PF", 2, "-1.0", std::vector<float>(12, 1.0f)),
                               png(PNG_FORMAT_RGB, std::vector<std::uint8_t>(12, 77))};
  TestRandom random(7);
  for (const std::string& whole : files) {
    for (int round = 0; round < 500; ++round) {
      std::string changed = whole;
      for (std::uint32_t i = 0; i <= random.below(3); ++i) {
        changed[random.below(static_cast<std::uint32_t>(changed.size()))] = static_cast<char>(random.below(256));
      }
      try {
        const EnvironmentFace face = read_environment_face(folder.write("changed", changed));
        EXPECT_EQ(face.texels.size(), std::size_t{face.width} * face.width);
      } catch (const tool::Failure&) {  // as good
      }
    }
  }
}

TEST(EnvironmentFace, ASceneHoldsAllSix) {
  const TemporaryFolder folder;
  for (std::uint32_t face = 0; face < 6; ++face) {
    const std::vector<char> bytes = scene_makers::make_sky_face(face, 4);
    folder.write(std::string("s_") + scene_makers::kFaceNames[face] + ".pfm", {bytes.begin(), bytes.end()});
  }
  const tool::SceneDescription scene =
      read_good(std::string(kViewAndFill) + "e s_px.pfm s_nx.pfm\ns_py.pfm s_ny.pfm s_pz.pfm s_nz.pfm s 0 0 0 1", {},
                folder.path("a.nff").string());
  ASSERT_TRUE(scene.environment);
  EXPECT_EQ(scene.environment->width, 4u);
  EXPECT_EQ(scene.environment->paths[1], folder.path("s_nx.pfm"));
  const auto texel = [&](tool::CubeFace face, std::size_t column, std::size_t row) {
    return scene.environment->texels[static_cast<std::size_t>(face)][row * 4 + column];
  };
  using enum tool::CubeFace;
  // The sky's colour depends on the direction alone, so texels beside a common edge are nearly those of each other, and
  // edges fit: right of -z is left of +x, above -z is the lower edge of +y, below it the upper edge of -y.
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_GT(texel(kPlusX, i, 0).z, 2 * texel(kPlusX, i, 3).z) << "blue above, brown below";
  }
  const auto glow = [&](tool::CubeFace face) {
    float most = 0;
    for (const Vec3& colour : scene.environment->texels[static_cast<std::size_t>(face)])
      most = std::max(most, colour.x);
    return most;
  };
  EXPECT_GT(glow(kMinusZ), 1.0f) << "the sun stands towards (2, 3, -6)";
  EXPECT_LT(glow(kPlusZ), 1.0f);
  EXPECT_GT(texel(kMinusZ, 2, 1).x, texel(kMinusZ, 1, 1).x) << "right of the middle: +x";
  EXPECT_GT(texel(kMinusZ, 2, 1).x, texel(kMinusZ, 2, 2).x) << "above the middle: +y";
}

}  // namespace
}  // namespace gridiron::test
