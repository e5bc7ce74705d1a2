// Configurations: what the names promise. SPDX-License-Identifier: Apache-2.0
#include "gridiron/configurations.h"

#include <gridiron/base/records.h>
#include <gtest/gtest.h>

#include "gridiron/store_facts.h"

namespace gridiron::test {
namespace {

TEST(Configurations, ReferenceIsTheReferenceSystem) {
  const tool::Configuration* reference = tool::find_configuration("reference");
  ASSERT_NE(reference, nullptr);
  EXPECT_EQ(reference, &tool::configurations().front()) << "the default";
  EXPECT_EQ(reference->lambda, 4.0f);
  EXPECT_EQ(reference->macro_width, 6u);
  EXPECT_EQ(reference->packet_width, 8u);
  EXPECT_EQ(reference->depths.output, 2u);
  EXPECT_EQ(reference->depths.macro, 2u);
  EXPECT_EQ(reference->depths.triangle, 2u);
  EXPECT_EQ(reference->techniques, std::uint32_t{kUseMailbox} | kUseCornerCulling | kUseEmptySkip);
}

TEST(Configurations, EachFitsTheDefaultStore) {
  for (const tool::Configuration& configuration : tool::configurations()) {
    const tool::StoreFacts store = tool::store_facts(sim::StoreSize::k256KB, configuration.packet_width);
    EXPECT_LE(configuration.macro_width, store.max_macro_width) << configuration.name;
    EXPECT_LE(configuration.depths.output, store.max_output_depth) << configuration.name;
    EXPECT_LE(configuration.depths.macro, store.max_macro_depth) << configuration.name;
    EXPECT_LE(configuration.depths.triangle, store.max_triangle_depth) << configuration.name;
    EXPECT_EQ(tool::find_configuration(configuration.name), &configuration);
  }
}

TEST(Configurations, UnknownNamesAreNone) {
  EXPECT_EQ(tool::find_configuration("fastest"), nullptr);
  EXPECT_EQ(tool::find_configuration(""), nullptr);
}

TEST(StoreFacts, RegionsFillTheStoreInOrderWithinTheArena) {
  for (const sim::StoreSize size : {sim::StoreSize::k64KB, sim::StoreSize::k256KB}) {
    for (const std::uint32_t packet_width : {4u, 8u, 16u}) {
      const tool::StoreFacts store = tool::store_facts(size, packet_width);
      ASSERT_FALSE(store.regions.empty());
      std::uint64_t end_bytes = 0;
      for (const tool::LocalStoreRegion& region : store.regions) {
        EXPECT_GE(region.offset_bytes, end_bytes) << region.name;
        EXPECT_GT(region.bytes, 0u) << region.name;
        end_bytes = region.offset_bytes + region.bytes;
      }
      EXPECT_EQ(store.data_bytes(), end_bytes);
      EXPECT_LE(store.data_bytes() + store.code_bytes + store.stack_bytes, store.arena_bytes);
    }
  }
  EXPECT_EQ(tool::store_facts(sim::StoreSize::k64KB, 8).arena_bytes, 64u << 10);
  EXPECT_EQ(tool::store_facts(sim::StoreSize::k256KB, 8).arena_bytes, 256u << 10);
}

}  // namespace
}  // namespace gridiron::test
