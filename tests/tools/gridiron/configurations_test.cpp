// Configurations: what the names promise. SPDX-License-Identifier: Apache-2.0
#include "gridiron/device/configurations.h"

#include <gridiron/base/records.h>

#include "gridiron/device/store_facts.h"
#include "support/test_headers.h"

namespace gridiron::test {
namespace {

TEST(Configurations, ReferenceIsTheReferenceSystem) {
  const tool::Configuration* reference = tool::find_configuration("reference");
  ASSERT_NE(reference, nullptr);
  EXPECT_EQ(reference->lambda, 4.0f);
  EXPECT_EQ(reference->macro_width, 6u);
  EXPECT_EQ(reference->packet_width, 8u);
  EXPECT_EQ(reference->depths.output, 2u);
  EXPECT_EQ(reference->depths.macro, 2u);
  EXPECT_EQ(reference->depths.triangle, 2u);
  EXPECT_EQ(reference->techniques, std::uint32_t{kUseMailbox} | kUseCornerCulling | kUseEmptySkip);
}

TEST(Configurations, BestAloneHasNoGrid) {
  EXPECT_EQ(tool::find_configuration("best"), &tool::configurations().front());
  EXPECT_EQ(tool::find_configuration("tree"), nullptr);
  for (const tool::Configuration& configuration : tool::configurations()) {
    EXPECT_EQ(configuration.has_grid(), configuration.name != "best") << configuration.name;
  }
}

// `best`, unless it cannot render the frame.
TEST(Configurations, TheDefaultFollowsTheFrame) {
  const auto name = [](const tool::ConfigurationNeed& need) { return tool::default_configuration(need).name; };
  EXPECT_EQ(name({}), "best");
  EXPECT_EQ(name({.has_projection = true}), "reference");
  EXPECT_EQ(name({.has_tree = false}), "grid");
  EXPECT_EQ(name({.has_kernel = false}), "grid");
  EXPECT_EQ(name({.has_bounds = false}), "grid");
  EXPECT_EQ(name({.has_prices = false}), "grid");
}

// More children at once delay the one that is next, and push others out of the cache.
TEST(Configurations, FetchSoManyChildrenForEffects) {
  const auto fetch = [](const char* name) { return tool::find_configuration(name)->depths.fetch; };
  EXPECT_EQ(fetch("reference"), 2u);
  EXPECT_EQ(fetch("deep"), 4u);
  EXPECT_EQ(fetch("grid"), 2u);
  EXPECT_EQ(fetch("best"), 2u);
}

TEST(Configurations, EachFitsAStoreWithEffects) {
  for (const tool::Configuration& configuration : tool::configurations()) {
    const tool::StoreFacts store = tool::effect_store_facts(sim::StoreSize::k256KB, configuration.packet_width);
    EXPECT_EQ(store.packet_width, configuration.packet_width);
    EXPECT_LE(configuration.macro_width, store.max_macro_width) << configuration.name;
    EXPECT_LE(configuration.depths.macro, store.most_depths.macro) << configuration.name;
    EXPECT_LE(configuration.depths.triangle, store.most_depths.triangle) << configuration.name;
    EXPECT_LE(store.data_bytes() + store.code_bytes + store.stack_bytes, store.arena_bytes);
  }
}

TEST(Configurations, EachFitsTheDefaultStore) {
  for (const tool::Configuration& configuration : tool::configurations()) {
    const tool::StoreFacts store = tool::usual_store_facts(sim::StoreSize::k256KB, configuration.packet_width);
    EXPECT_LE(configuration.macro_width, store.max_macro_width) << configuration.name;
    EXPECT_LE(configuration.depths.output, store.most_depths.output) << configuration.name;
    EXPECT_LE(configuration.depths.macro, store.most_depths.macro) << configuration.name;
    EXPECT_LE(configuration.depths.triangle, store.most_depths.triangle) << configuration.name;
    EXPECT_EQ(tool::find_configuration(configuration.name), &configuration);
  }
}

TEST(Configurations, UnknownNamesAreNone) {
  EXPECT_EQ(tool::find_configuration("fastest"), nullptr);
  EXPECT_EQ(tool::find_configuration(""), nullptr);
}

TEST(StoreFacts, RegionsFillTheStoreInOrderWithinTheArena) {
  const std::vector<sim::LayoutChoice> layouts = tool::built_layouts();
  EXPECT_EQ(layouts.size(), 28u);
  for (const sim::LayoutChoice& layout : layouts) {
    const std::optional<tool::StoreFacts> store = tool::find_store_facts(layout);
    ASSERT_TRUE(store.has_value());
    ASSERT_FALSE(store->regions.empty());
    std::uint64_t end_bytes = 0;
    for (const tool::LocalStoreRegion& region : store->regions) {
      EXPECT_GE(region.offset_bytes, end_bytes) << region.name;
      EXPECT_GT(region.bytes, 0u) << region.name;
      end_bytes = region.offset_bytes + region.bytes;
    }
    EXPECT_EQ(store->data_bytes(), end_bytes);
    const bool has_code_memory = store->code_memory_bytes != 0;
    EXPECT_EQ(has_code_memory, layout.store == sim::StoreSize::k16KB);
    EXPECT_LE(store->data_bytes() + store->stack_bytes + (has_code_memory ? 0 : store->code_bytes), store->arena_bytes);
    EXPECT_LE(has_code_memory ? store->code_bytes : 0, store->code_memory_bytes);
    EXPECT_EQ(store->arena_bytes, sim::arena_bytes(layout.store));
    EXPECT_EQ(store->tile_width, layout.tile_width);
    EXPECT_EQ(store->packet_width, layout.packet_width);
    EXPECT_TRUE(sim::is_built(layout, sim::Mode::kChecked, 4));
  }
}

TEST(StoreFacts, EveryStoreHasTheConfigurationsPackets) {
  for (const sim::StoreSize size : sim::kStoreSizes) {
    for (const tool::Configuration& configuration : tool::configurations()) {
      if (configuration.packet_width == 0) continue;  // below
      const tool::StoreFacts store = tool::usual_store_facts(size, configuration.packet_width);
      EXPECT_EQ(store.engine, EngineId::kGrid);
      EXPECT_EQ(store.arena_bytes, sim::arena_bytes(size));
      EXPECT_EQ(store.tile_width, size == sim::StoreSize::k64KB ? 16u : 32u);
      EXPECT_EQ(store.packet_width, std::min(configuration.packet_width, store.tile_width));
    }
  }
  EXPECT_FALSE(tool::find_store_facts({sim::StoreSize::k128KB, 64, 8}).has_value());
  for (const sim::StoreSize size : sim::kEveryStoreSize) {
    const tool::StoreFacts store = tool::usual_store_facts(size, 0);
    EXPECT_EQ(store.engine, EngineId::kTree);
    EXPECT_EQ(store.arena_bytes, sim::arena_bytes(size));
    EXPECT_EQ(store.tile_width, tool::tree_tile_width(size));
  }
  EXPECT_EQ(tool::effect_store_facts(sim::StoreSize::k256KB, 0).engine, EngineId::kTree);
}

TEST(StoreFacts, FitsTellRoomAndNeed) {
  const std::vector<tool::LayoutFit> fits = tool::layout_fits();
  ASSERT_EQ(fits.size(), 4u * 7u);
  std::size_t misfits = 0;
  for (const tool::LayoutFit& fit : fits) {
    EXPECT_EQ(fit.fits, fit.data_bytes <= fit.room_bytes);
    EXPECT_LT(fit.room_bytes, sim::arena_bytes(fit.layout.store));
    const std::optional<tool::StoreFacts> built = tool::find_store_facts(fit.layout);
    EXPECT_TRUE(fit.fits || !built) << fit.layout.tile_width;
    misfits += fit.fits ? 0u : 1u;
  }
  EXPECT_EQ(misfits, 6u) << "tiles of 32 and 64 in 64 KB, of 64 in 128 KB";
}

}  // namespace
}  // namespace gridiron::test
