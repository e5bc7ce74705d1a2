// Local store: every layout's regions fit its arena together with code and stack, and no region overlaps another.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/store/local_store.h>

#include "support/test_headers.h"

namespace gridiron::test {
namespace {

struct Region {
  std::string name;
  std::size_t offset_bytes, bytes;
};

template <class Layout>
class LayoutTest : public testing::Test {};

using Layouts =
    testing::Types<StoreLayout64K<4>, StoreLayout64K<8>, StoreLayout64K<16>, StoreLayout64K<8, 8>, StoreLayout128K<8>,
                   StoreLayout128K<32>, StoreLayout128K<16, 16>, StoreLayout256K<4>, StoreLayout256K<8>,
                   StoreLayout256K<16>, StoreLayout256K<32>, StoreLayout256K<8, 8>, StoreLayout256K<8, 16>,
                   StoreLayout256K<16, 16>, StoreLayout256K<8, 64>, StoreLayout256K<32, 64>, StoreLayout512K<8>,
                   StoreLayout512K<32>, StoreLayout512K<8, 64>, StoreLayout512K<32, 64>>;
TYPED_TEST_SUITE(LayoutTest, Layouts);

TYPED_TEST(LayoutTest, RegionsLieInOrderBesideCodeAndStack) {
  using Store = LocalStore<TypeParam>;
  std::vector<Region> regions;
  for_each_region<TypeParam>([&regions](const char* name, std::size_t offset_bytes, std::size_t bytes) {
    regions.push_back({name, offset_bytes, bytes});
  });
  ASSERT_EQ(regions.size(), 8u);
  std::size_t end_bytes = 0;
  for (const Region& region : regions) {
    EXPECT_GE(region.offset_bytes, end_bytes) << region.name;
    EXPECT_LT(region.offset_bytes - end_bytes, kLineBytes) << region.name << ": a hole";
    EXPECT_EQ(region.offset_bytes % kLineBytes, 0u) << region.name;
    end_bytes = region.offset_bytes + region.bytes;
  }
  EXPECT_LE(end_bytes, sizeof(Store));
  EXPECT_LE(sizeof(Store) + TypeParam::kCodeBudgetBytes + TypeParam::kStackBudgetBytes, TypeParam::kArenaBytes);
  EXPECT_TRUE(kFitsArena<TypeParam>);
}

TYPED_TEST(LayoutTest, BuffersHoldWhatTheirNamesSay) {
  using Store = LocalStore<TypeParam>;
  constexpr std::uint32_t kPixels = TypeParam::kTileWidth * TypeParam::kTileWidth;
  EXPECT_EQ(sizeof(Store::output), TypeParam::kMaxOutputDepth * kPixels * 12) << "colour, distance, triangle";
  EXPECT_EQ(TypeParam::kTileWidth % TypeParam::kPacketWidth, 0u);
  // A run of triangles starts anywhere on 16 bytes of a congruence of 32.
  constexpr std::size_t kRunBytes = TypeParam::kTrianglesPerBuffer * kTriangleRecordBytes + 16;
  EXPECT_GE(sizeof(typename Store::EyeStore::TriangleBuffer), kRunBytes);
  constexpr std::size_t kCells = TypeParam::kMaxMacroWidth * TypeParam::kMaxMacroWidth * TypeParam::kMaxMacroWidth;
  EXPECT_GE(sizeof(typename Store::EyeStore::CellBlock), kCells * sizeof(CellRecord));
  EXPECT_EQ(TypeParam::kMailboxSlots & (TypeParam::kMailboxSlots - 1), 0u) << "a power of two";
}

TEST(Layouts, WhatDoesNotFitIsTold) {
  EXPECT_FALSE((kFitsArena<StoreLayout64K<8, 32>>)) << "two tiles of 32 pixels take 24 KB";
  EXPECT_FALSE((kFitsArena<StoreLayout128K<8, 64>>)) << "two tiles of 64 pixels take 96 KB";
  EXPECT_FALSE((kFitsArena<StoreLayout128K<32, 64>>));
}

// One more wave does not fit together with the code of all effects; an unused queue costs next to nothing.
TEST(Layouts, EffectsIn64KbHaveShortWaves) {
  EXPECT_TRUE((kFitsArena<EffectLayout64K<kAllEffects>>));
  EXPECT_TRUE((kFitsArena<EffectLayout64K<kSceneShading>>));
  EXPECT_FALSE((kFitsArena<EffectLayout64K<kAllEffects, 64>>));
  EXPECT_FALSE(LocalStore<EffectLayout64K<kSceneShading>>::Effects::kHasQueue);
  EXPECT_LE(LocalStore<EffectLayout64K<kSceneShading>>::Effects::kQueueRays, 1u);
  EXPECT_EQ(LocalStore<EffectLayout64K<kSceneShading | kRefraction>>::Effects::kQueueRays, 48u);
}

// Buffers of an engine of rays that shading borrows lie apart, each as long as the longest record.
template <class Layout>
void expect_buffers_to_lend() {
  using RayStore = typename LocalStore<Layout>::RayStore;
  constexpr std::uint32_t kBuffers = Layout::RayEngine::template kMaxDepth<Layout>;
  EXPECT_GE(kBuffers, 2u);
  EXPECT_LE(kBuffers, kTriangleTagCount);
  const auto rays = std::make_unique<RayStore>();
  const auto* const begin = reinterpret_cast<const std::byte*>(rays.get());
  const std::byte* end = begin;
  for (std::uint32_t i = 0; i < kBuffers; ++i) {
    const std::byte* const buffer = rays->idle_buffer(i);
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(buffer) % kPortableCongruenceBytes, 0u);
    EXPECT_GE(buffer, end);
    end = buffer + kIdleBufferBytes;
  }
  EXPECT_LE(end, begin + sizeof(RayStore));
}
TEST(Layouts, BuffersToLendLieApart) {
  expect_buffers_to_lend<EffectLayout64K<kAllEffects>>();
  expect_buffers_to_lend<EffectLayout256K<kAllEffects, 8>>();
  expect_buffers_to_lend<EffectLayout256K<kAllEffects, 32>>();
}

TEST(Layouts, AreAsLargeAsTheirNames) {
  EXPECT_EQ(StoreLayout64K<>::kArenaBytes, 64u << 10);
  EXPECT_EQ(StoreLayout128K<>::kArenaBytes, 128u << 10);
  EXPECT_EQ(StoreLayout256K<>::kArenaBytes, 256u << 10);
  EXPECT_EQ(StoreLayout512K<>::kArenaBytes, 512u << 10);
}

// The README and users of the 256 KB layout count on these places.
TEST(Layouts, TheUsualMapStays) {
  const auto offset_of = [](std::string_view wanted) {
    std::size_t found = ~std::size_t{0};
    for_each_region<StoreLayout256K<8>>([&](std::string_view name, std::size_t offset, std::size_t) {
      if (name == wanted) found = offset;
    });
    return found;
  };
  EXPECT_EQ(offset_of("macro_table"), 896u);
  EXPECT_EQ(offset_of("triangles"), 54'528u);
  EXPECT_EQ(offset_of("output"), 93'696u);
  EXPECT_EQ(sizeof(LocalStore<StoreLayout256K<8>>), 118'272u);
}

}  // namespace
}  // namespace gridiron::test
