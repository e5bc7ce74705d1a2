// Answers: every kind of mistake is counted where it belongs. SPDX-License-Identifier: Apache-2.0
#include "experiment/answers.h"

#include <gridiron/base/math.h>
#include <gridiron/base/records.h>

#include "support/test_headers.h"

namespace gridiron::test {
namespace {

using namespace experiment;

// n floats further.
float further(float number, int steps) {
  for (int i = 0; i < steps; ++i) number = std::nextafter(number, std::numeric_limits<float>::infinity());
  return number;
}

// Ten rays: right, right by 1 and by 5 ulp, right background, a hole, a false hit, the wrong triangle at the true
// distance, beside it, just short of behind, and behind.
struct Case {
  Answers truth, answers;
};

Case make_case() {
  constexpr std::uint32_t kNone = kNoTriangle;
  Case made;
  made.truth.ids = {7, 7, 7, kNone, 7, kNone, 7, 7, 7, 7};
  made.answers.ids = {7, 7, 7, kNone, kNone, 3, 3, 3, 3, 3};
  made.truth.depth.assign(10, 2.0f);
  made.answers.depth = {2.0f, further(2.0f, 1), further(2.0f, 5), kFloatMax, kFloatMax, 1.0f,
                        2.0f, further(2.0f, 2), 2.001f,           2.1f};
  made.truth.depth[3] = made.truth.depth[5] = kFloatMax;
  made.truth.color.assign(10, 0xFF404040u);
  made.answers.color = made.truth.color;
  return made;
}

TEST(Answers, EveryRayIsCountedOnce) {
  const Case made = make_case();
  const HitCounts counts = count_hits(made.truth, made.answers);
  EXPECT_EQ(counts.rays, 10u);
  EXPECT_EQ(counts.true_hits, 8u);
  EXPECT_EQ(counts.holes, 1u);
  EXPECT_EQ(counts.false_hits, 1u);
  EXPECT_EQ(counts.wrong_triangles, 4u);
  EXPECT_EQ(counts.seen_through, 1u) << "2.001 is 2 and half a thousandth";
  EXPECT_EQ(counts.wrong_rays(), 6u);
  EXPECT_EQ(counts.leaks(), 2u);
  EXPECT_EQ(counts.per_million(counts.holes), 1e5);
  EXPECT_EQ(HitCounts{}.per_million(0), 0);
}

TEST(Answers, ErrorsOfDistanceAreThoseOfTheTrueTriangle) {
  const Case made = make_case();
  const Comparison found = compare_answers(made.truth, made.answers);
  EXPECT_EQ(found.hits.holes, 1u);
  EXPECT_EQ(found.wrong_at_true_depth, 1u);
  EXPECT_EQ(found.ulps.count, 3u);
  EXPECT_EQ(found.ulps.median, 1);
  EXPECT_EQ(found.ulps.greatest, 5);
  EXPECT_EQ(found.relative.greatest, 5 * 0x1p-23);
  EXPECT_EQ(found.all_ulps.count, 7u);
  EXPECT_EQ(found.all_ulps.median, 2);
  EXPECT_NEAR(found.all_relative.greatest, 0.05, 1e-7);
  std::array<std::uint64_t, kUlpBinCount> histogram{};
  histogram[0] = histogram[1] = histogram[3] = 1;
  EXPECT_EQ(found.ulp_histogram, histogram);
}

TEST(Answers, BinsDouble) {
  EXPECT_EQ(ulp_bin(0), 0u);
  EXPECT_EQ(ulp_bin(1), 1u);
  EXPECT_EQ(ulp_bin(2), 2u);
  EXPECT_EQ(ulp_bin(3), 2u);
  EXPECT_EQ(ulp_bin(4), 3u);
  EXPECT_EQ(ulp_bin((1u << 23) - 1), kUlpBinCount - 2);
  EXPECT_EQ(ulp_bin(1u << 23), kUlpBinCount - 1);
  EXPECT_EQ(ulp_bin(~std::uint64_t{0}), kUlpBinCount - 1);
}

TEST(Answers, ColoursAreComparedByChannel) {
  Case made = make_case();
  Comparison found = compare_answers(made.truth, made.answers);
  EXPECT_EQ(found.picture.differing_pixels, 0u);
  EXPECT_EQ(found.picture.psnr_db(), std::numeric_limits<double>::infinity());
  EXPECT_EQ(found.picture.greatest_pixel_error, 0u);
  made.answers.color[2] = 0xFF404740u;  // green by 7
  made.answers.color[9] = 0xFF3F4041u;  // blue and red by 1
  found = compare_answers(made.truth, made.answers);
  EXPECT_EQ(found.picture.differing_pixels, 2u);
  EXPECT_EQ(found.picture.greatest_pixel_error, 7u);
  EXPECT_DOUBLE_EQ(found.picture.psnr_db(), 10 * std::log10(255.0 * 255.0 * 30 / (49 + 1 + 1)));
}

}  // namespace
}  // namespace gridiron::test
