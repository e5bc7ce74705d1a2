// The reader of picture files, on a file made by hand. SPDX-License-Identifier: Apache-2.0
#include "support/picture.h"

#include <unistd.h>

namespace gridiron::test {
namespace {

// A PFM's first row of bytes is the picture's lowest.
TEST(PictureTest, PfmRowsComeTopFirst) {
  const std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("gridiron_picture_test_" + std::to_string(getpid()) + ".pfm");
  {
    std::ofstream file(path, std::ios::binary);
    const float values[6] = {1, 2, std::numeric_limits<float>::infinity(), 4, 5, 6};
    file << "Pf\n2 3\n-1.0\n";
    file.write(reinterpret_cast<const char*>(values), sizeof values);
  }
  const auto picture = load_picture(path);
  std::filesystem::remove(path);
  ASSERT_TRUE(picture);
  EXPECT_EQ(picture->width, 2u);
  EXPECT_EQ(picture->height, 3u);
  ASSERT_EQ(picture->channels, 1u);
  EXPECT_EQ(picture->values, (std::vector<float>{5, 6, std::numeric_limits<float>::infinity(), 4, 1, 2}));
}

TEST(PictureTest, CountsDifferingPixels) {
  const Picture a{2, 1, 2, {1, 2, 3, 4}};
  Picture b = a;
  EXPECT_EQ(compare_pictures(a, b)->differing_pixels, 0u);
  b.values[2] = 3.5f;
  b.values[3] = 2.0f;
  const auto difference = compare_pictures(a, b);
  ASSERT_TRUE(difference);
  EXPECT_EQ(difference->differing_pixels, 1u);
  EXPECT_EQ(difference->first_pixel, 1u);
  EXPECT_EQ(difference->largest, 2.0);
  b.values[0] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(compare_pictures(a, b)->differing_pixels, 2u);
  EXPECT_FALSE(compare_pictures(a, Picture{1, 2, 2, {1, 2, 3, 4}}));
}

}  // namespace
}  // namespace gridiron::test
