// Shading: grey levels, which pixels a packet writes, and their colours. SPDX-License-Identifier: Apache-2.0
#include <gridiron/ray/packet_hits.h>
#include <gridiron/shade/shading.h>
#include <gridiron/store/local_store.h>

#include "support/test_headers.h"

namespace gridiron::test {
namespace {

std::uint32_t grey_of(float brightness) {
  return static_cast<std::uint32_t>(grey<Lanes<4>>(Lanes<4>::Float(brightness))[2]);
}

TEST(Grey, IsTheNearestOf256Levels) {
  EXPECT_EQ(grey_of(0.0f), 0xFF000000u);
  EXPECT_EQ(grey_of(1.0f), 0xFFFFFFFFu);
  EXPECT_EQ(grey_of(1.5f), 0xFFFFFFFFu);
  EXPECT_EQ(grey_of(0.5f), 0xFF808080u);
  for (std::uint32_t level = 0; level < 256; ++level) {
    EXPECT_EQ(grey_of(static_cast<float>(level) / 255.0f), 0xFF000000u | level * 0x010101u) << level;
  }
}

class ShadeHits : public testing::TestWithParam<Shading> {
 protected:
  using Layout = StoreLayout64K<8>;
  using Output = LocalStore<Layout>::TileOutput;

  ShadeHits() : output_(std::make_unique<Output>()) {
    frame_.shading = static_cast<std::uint32_t>(GetParam());
    frame_.background_rgba = 0x12345678u;
    for (std::uint32_t ray = 0; ray < 64; ++ray) {
      ray_at_[Packet<8>::row_of(ray)][Packet<8>::column_of(ray)] = ray;
      packet_.dir[0][ray] = 0.25f * static_cast<float>(ray % 8);
      packet_.dir[2][ray] = -2.0f;
      packet_.t[ray] = 1.0f + static_cast<float>(ray);
      packet_.id[ray] = ray % 3 == 0 ? kNoTriangle : 1000 + ray;
      packet_.facing[ray] = ray % 2 == 0 ? 2.0f : 0.5f;
    }
    std::memset(static_cast<void*>(output_.get()), 0x77, sizeof(Output));
  }

  FrameHead frame_{};
  Packet<8> packet_{};
  std::uint32_t ray_at_[8][8] = {};
  std::unique_ptr<Output> output_;
};

TEST_P(ShadeHits, PacketWritesItsPixelsAndNoOther) {
  WorkCounters work;
  const bool simple = GetParam() == Shading::kSimple;
  Hits hits{output_->id, output_->depth, simple ? reinterpret_cast<float*>(output_->color) : nullptr};
  store_hits<Lanes<4>>(packet_, 8, 4, Layout::kTileWidth, hits, work);
  EXPECT_EQ(work[Work::kDepthGroup], 16u);
  EXPECT_EQ(work[Work::kIdGroup], 16u);
  shade_hits<Lanes<4>>(frame_, hits, Layout::kTileWidth * Layout::kTileWidth, output_->color, work);
  EXPECT_EQ(work[Work::kShadedSimpleGroup], simple ? 64u : 0u);
  EXPECT_EQ(work[Work::kShadedGroup], simple ? 0u : 64u);
  for (std::uint32_t y = 0; y < Layout::kTileWidth; ++y) {
    for (std::uint32_t x = 0; x < Layout::kTileWidth; ++x) {
      const std::uint32_t pixel = y * Layout::kTileWidth + x;
      if (x < 8 || y < 4 || y >= 12) {
        ASSERT_EQ(output_->id[pixel], 0x77777777u) << x << ", " << y;
        continue;
      }
      const std::uint32_t ray = ray_at_[y - 4][x - 8];
      ASSERT_EQ(output_->id[pixel], packet_.id[ray]);
      if (packet_.id[ray] == kNoTriangle) {
        ASSERT_EQ(output_->color[pixel], 0x12345678u);
        ASSERT_EQ(output_->depth[pixel], kFloatMax);
        continue;
      }
      const float length = std::sqrt(packet_.dir[0][ray] * packet_.dir[0][ray] + 4.0f);
      ASSERT_EQ(output_->depth[pixel], packet_.t[ray] * length);
      ASSERT_EQ(output_->color[pixel], simple ? grey_of(packet_.facing[ray] / length) : 0xFFFFFFFFu);
    }
  }
}

TEST_P(ShadeHits, PlanesThatAreOffStayAsTheyAre) {
  WorkCounters work;
  const Hits hits{output_->id, nullptr, nullptr};
  store_hits<Lanes<4>>(packet_, 0, 0, Layout::kTileWidth, hits, work);
  std::uint32_t depth_bits = 0;
  std::memcpy(&depth_bits, &output_->depth[0], sizeof(depth_bits));
  EXPECT_EQ(depth_bits, 0x77777777u);
  EXPECT_EQ(output_->color[0], 0x77777777u);
  EXPECT_EQ(work[Work::kDepthGroup], 0u);
}

INSTANTIATE_TEST_SUITE_P(Both, ShadeHits, testing::Values(Shading::kNone, Shading::kSimple), [](const auto& tested) {
  return tested.param == Shading::kNone ? std::string("None") : std::string("Simple");
});

}  // namespace
}  // namespace gridiron::test
