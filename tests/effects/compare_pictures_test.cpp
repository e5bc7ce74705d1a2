// Comparison of pictures: figures that can be counted by hand. SPDX-License-Identifier: Apache-2.0
#include "effects/compare_pictures.h"

#include "support/test_headers.h"

namespace gridiron::test {
namespace {

constexpr std::uint32_t kGrey = 0xFF404040u;

TEST(CompareSteps, CountsPixelsByTheirWorstChannel) {
  const std::vector<std::uint32_t> a(8, kGrey);
  std::vector<std::uint32_t> b = a;
  b[1] = 0xFF404041u;  // one step of red
  b[2] = 0xFF403E40u;  // two of green
  b[3] = 0xFF434040u;  // three of blue
  b[5] = 0xFF50403Fu;  // sixteen of blue and one of red
  const auto found = compare_steps(a, b);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->pixels, 8u);
  EXPECT_EQ(found->off_by_more_than_1, 3u);
  EXPECT_EQ(found->off_by_more_than_2, 2u);
  EXPECT_EQ(found->off_by_more_than_8, 1u);
  EXPECT_EQ(found->largest, 16);
  EXPECT_EQ(found->worst_pixel, 5u);
  EXPECT_DOUBLE_EQ(found->rmse, std::sqrt((1.0 + 4.0 + 9.0 + 256.0 + 1.0) / 32.0));
  EXPECT_FALSE(compare_steps(a, std::vector<std::uint32_t>(7, kGrey)));
}

TEST(CompareSteps, AlphaCounts) {
  const auto found = compare_steps(std::vector<std::uint32_t>{kGrey}, std::vector<std::uint32_t>{kGrey & 0xFFFFFFu});
  ASSERT_TRUE(found);
  EXPECT_EQ(found->largest, 255);
}

TEST(CompareImages, AgreesWithSteps) {
  const std::vector<std::uint32_t> a(8, kGrey);
  std::vector<std::uint32_t> b = a;
  b[1] = 0xFF404041u;
  b[2] = 0xFF403E40u;
  b[6] = 0xFF434040u;
  const auto found = compare_images(a, b, 4, 2);
  const auto steps = compare_steps(a, b);
  ASSERT_TRUE(found && steps);
  EXPECT_EQ(found->warned, steps->off_by_more_than_1);
  EXPECT_EQ(found->failed, steps->off_by_more_than_2);
  EXPECT_NEAR(found->max_error * 255.0, 3.0, 1e-4);
  EXPECT_NEAR(found->rms_error * 255.0, steps->rmse, 1e-4);
  EXPECT_EQ(found->worst_x, 2u);
  EXPECT_EQ(found->worst_y, 1u);
  EXPECT_FALSE(compare_images(a, b, 4, 3)) << "a picture of another size";
  const auto strict = compare_images(a, b, 4, 2, {0.5f / 255.0f, 0.5f / 255.0f});
  ASSERT_TRUE(strict);
  EXPECT_EQ(strict->failed, 3u);
}

}  // namespace
}  // namespace gridiron::test
