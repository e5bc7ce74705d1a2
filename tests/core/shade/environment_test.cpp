// The environment: faces, texels and blocks against a computation in doubles. SPDX-License-Identifier: Apache-2.0
#include <gridiron/shade/environment.h>

#include "support/test_headers.h"

namespace gridiron::test {
namespace {

/// The model's words, axis by axis.
struct Reference {
  std::uint32_t face;
  double column, row;
};
Reference reference_of(Vector3 direction, std::uint32_t width) {
  struct Face {
    double forward[3], right[3], up[3];
  };
  static constexpr Face kFaces[6] = {{{1, 0, 0}, {0, 0, 1}, {0, 1, 0}},  {{-1, 0, 0}, {0, 0, -1}, {0, 1, 0}},
                                     {{0, 1, 0}, {1, 0, 0}, {0, 0, 1}},  {{0, -1, 0}, {1, 0, 0}, {0, 0, -1}},
                                     {{0, 0, 1}, {-1, 0, 0}, {0, 1, 0}}, {{0, 0, -1}, {1, 0, 0}, {0, 1, 0}}};
  const double d[3] = {direction.x, direction.y, direction.z};
  const auto along = [&](const double* axis) { return axis[0] * d[0] + axis[1] * d[1] + axis[2] * d[2]; };
  // The first face that nothing is ahead of, but that of the opposite sign where it is as far, which is 0.
  std::uint32_t face = 0;
  for (std::uint32_t i = 1; i < 6; ++i) {
    if (along(kFaces[i].forward) > along(kFaces[face].forward)) face = i;
  }
  const double largest = along(kFaces[face].forward), w = width;
  const double a = largest > 0 ? along(kFaces[face].right) / largest : 0;
  const double b = largest > 0 ? along(kFaces[face].up) / largest : 0;
  return {face, std::clamp((a + 1) / 2 * w - 0.5, 0.0, w - 1), std::clamp((1 - b) / 2 * w - 0.5, 0.0, w - 1)};
}

/// An environment of random texels in blocks, and the same as faces.
class Environment {
 public:
  explicit Environment(std::uint32_t width) : width_(width), blocks_(environment_blocks(width)) {
    std::mt19937 random(width);
    std::uniform_real_distribution<float> part(0.0f, 4.0f);
    texels_.resize(std::size_t{6} * width * width);
    for (Vector3& texel : texels_) texel = {part(random), part(random), part(random)};
    records_.resize(std::size_t{6} * blocks_ * blocks_);
    for (std::uint32_t index = 0; index < records_.size(); ++index) {
      const std::uint32_t i = index % blocks_, j = index / blocks_ % blocks_, face = index / blocks_ / blocks_;
      for (std::uint32_t row = 0; row < 8; ++row) {
        for (std::uint32_t column = 0; column < 8; ++column) {
          store(texel(face, std::min(7 * i + column, width - 1), std::min(7 * j + row, width - 1)),
                records_[index].texels[row][column]);
        }
      }
    }
  }
  [[nodiscard]] const Vector3& texel(std::uint32_t face, std::uint32_t column, std::uint32_t row) const {
    return texels_[(std::size_t{face} * width_ + row) * width_ + column];
  }
  [[nodiscard]] const EnvironmentBlock& block(std::uint32_t index) const { return records_.at(index); }

  void check(Vector3 direction) const {
    const auto what = [&] {
      return testing::Message() << "width " << width_ << " direction " << direction.x << " " << direction.y << " "
                                << direction.z;
    };
    const EnvironmentPlace place = environment_place(direction, width_);
    const Reference wanted = reference_of(direction, width_);
    ASSERT_EQ(place.face, wanted.face) << what();
    ASSERT_LT(place.block_column, blocks_) << what();
    ASSERT_LT(place.block_row, blocks_) << what();
    ASSERT_LT(place.column, kEnvironmentPatches) << what();
    ASSERT_LT(place.row, kEnvironmentPatches) << what();
    for (const float part : {place.column_part, place.row_part}) {
      ASSERT_GE(part, 0.0f) << what();
      ASSERT_LE(part, 1.0f) << what();
    }
    // Rounding: of a + 1, below 2, and of what is w times as much or less, each in its last place.
    const double slack = 0x1p-22 * width_;
    const std::uint32_t column = 7 * place.block_column + place.column, row = 7 * place.block_row + place.row;
    ASSERT_NEAR(column + static_cast<double>(place.column_part), wanted.column, slack) << what();
    ASSERT_NEAR(row + static_cast<double>(place.row_part), wanted.row, slack) << what();
    if (width_ >= 2) {
      ASSERT_LE(column, width_ - 2) << what();
      ASSERT_LE(row, width_ - 2) << what();
    }

    const Vector3 colour = lookup(block(environment_block_index(place, blocks_)), place);
    const auto c = static_cast<std::uint32_t>(wanted.column), r = static_cast<std::uint32_t>(wanted.row);
    const std::uint32_t next_c = std::min(c + 1, width_ - 1), next_r = std::min(r + 1, width_ - 1);
    const double fc = wanted.column - c, fr = wanted.row - r;
    for (const auto part : {&Vector3::x, &Vector3::y, &Vector3::z}) {
      const auto value = [&](std::uint32_t i, std::uint32_t j) {
        return static_cast<double>(texel(wanted.face, i, j).*part);
      };
      const double upper = (1 - fc) * value(c, r) + fc * value(next_c, r);
      const double lower = (1 - fc) * value(c, next_r) + fc * value(next_c, next_r);
      // Texels differ by 4 at most, along either axis.
      ASSERT_NEAR(colour.*part, (1 - fr) * upper + fr * lower, 8 * slack + 0x1p-20) << what();
    }
  }

 private:
  std::uint32_t width_, blocks_;
  std::vector<Vector3> texels_;
  std::vector<EnvironmentBlock> records_;
};

class EnvironmentOfWidth : public testing::TestWithParam<std::uint32_t> {};

TEST_P(EnvironmentOfWidth, IsTheBilinearOneInRandomDirections) {
  const Environment environment(GetParam());
  std::mt19937 random(1);
  std::uniform_real_distribution<float> part(-1.0f, 1.0f);
  for (int i = 0; i < 100000; ++i) {
    const float size = std::ldexp(1.0f, static_cast<int>(random() % 230) - 110);
    environment.check({size * part(random), size * part(random), size * part(random)});
    if (HasFatalFailure()) return;
  }
}

TEST_P(EnvironmentOfWidth, HoldsAtEdgesCornersAndExtremes) {
  const Environment environment(GetParam());
  const float most = std::numeric_limits<float>::max(), least = std::numeric_limits<float>::denorm_min();
  const float below_one = 1.0f - 0x1p-24f, above_one = 1.0f + 0x1p-23f;
  std::vector<float> sizes = {0.0f, least, 0x1p-126f, 1e-20f, 0.5f, below_one, 1.0f, above_one, 1e20f, most};
  // Middles of texels, and ends of blocks.
  for (std::uint32_t i = 0; i < GetParam(); i += GetParam() / 16 + 1) {
    sizes.push_back((static_cast<float>(i) + 0.5f) / static_cast<float>(GetParam()) * 2.0f - 1.0f);
  }
  for (const float x : sizes) {
    for (const float y : sizes) {
      for (const float z : sizes) {
        for (int signs = 0; signs < 8; ++signs) {
          environment.check({(signs & 1) != 0 ? -x : x, (signs & 2) != 0 ? -y : y, (signs & 4) != 0 ? -z : z});
          if (HasFatalFailure()) return;
        }
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Widths, EnvironmentOfWidth, testing::Values(1, 2, 3, 7, 8, 9, 15, 16, 64, 255, 1024));

TEST(EnvironmentPlace, OfNoDirectionIsTheMiddleOfTheFirstFace) {
  const EnvironmentPlace place = environment_place({0.0f, -0.0f, 0.0f}, 16);
  EXPECT_EQ(place.face, 0u);
  EXPECT_EQ(7.0f * static_cast<float>(place.block_column) + static_cast<float>(place.column) + place.column_part, 7.5f);
  EXPECT_EQ(7.0f * static_cast<float>(place.block_row) + static_cast<float>(place.row) + place.row_part, 7.5f);
}

TEST(EnvironmentPlace, OfTiesIsTheEarlierAxis) {
  EXPECT_EQ(environment_place({1, 1, 1}, 4).face, 0u);
  EXPECT_EQ(environment_place({-1, 1, 1}, 4).face, 1u);
  EXPECT_EQ(environment_place({0.5f, 1, -1}, 4).face, 2u);
  EXPECT_EQ(environment_place({0.5f, -1, -1}, 4).face, 3u);
  EXPECT_EQ(environment_place({0.5f, 0.5f, 1}, 4).face, 4u);
  EXPECT_EQ(environment_place({0.5f, 0.5f, -1}, 4).face, 5u);
}

TEST(Lookup, IsExactAtTexelsAndInside) {
  EnvironmentBlock block{};
  for (std::uint32_t row = 0; row < 8; ++row) {
    for (std::uint32_t column = 0; column < 8; ++column) {
      store({static_cast<float>(row * 8 + column), 3e38f, 0.0f}, block.texels[row][column]);
    }
  }
  const Vector3 last = lookup(block, {0, 0, 0, 6, 6, 1.0f, 1.0f});
  EXPECT_EQ(last.x, 63.0f);
  EXPECT_EQ(last.y, 3e38f);
  EXPECT_EQ(last.z, 0.0f);
  EXPECT_EQ(lookup(block, {0, 0, 0, 2, 3, 0.0f, 0.0f}).x, 26.0f);
  EXPECT_EQ(lookup(block, {0, 0, 0, 2, 3, 0.5f, 0.25f}).x, 28.5f);
  EXPECT_EQ(lookup(block, {0, 0, 0, 0, 0, 0.5f, 0.5f}).y, 3e38f);
}

}  // namespace
}  // namespace gridiron::test
