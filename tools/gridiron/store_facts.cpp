// Store facts. SPDX-License-Identifier: Apache-2.0
#include "store_facts.h"

#include <gridiron/store/local_store.h>

namespace gridiron::tool {
namespace {

template <class Layout>
StoreFacts facts_of() {
  StoreFacts facts;
  facts.arena_bytes = Layout::kArenaBytes;
  facts.code_bytes = Layout::kCodeBudgetBytes;
  facts.stack_bytes = Layout::kStackBudgetBytes;
  facts.tile_width = Layout::kTileWidth;
  facts.max_macro_width = Layout::kMaxMacroWidth;
  facts.max_output_depth = Layout::kMaxOutputDepth;
  facts.max_macro_depth = Layout::kMaxMacroDepth;
  facts.max_triangle_depth = Layout::kMaxTriangleDepth;
  facts.triangles_per_buffer = Layout::kTrianglesPerBuffer;
  for_each_region<Layout>([&facts](const char* name, std::size_t offset_bytes, std::size_t bytes) {
    facts.regions.push_back({name, offset_bytes, bytes});
  });
  return facts;
}

template <template <std::uint32_t> class Layout>
StoreFacts facts_of_width(std::uint32_t packet_width) {
  switch (packet_width) {
    case 4:
      return facts_of<Layout<4>>();
    case 16:
      return facts_of<Layout<16>>();
    case 32:
      if constexpr (Layout<32>::kTileWidth >= 32) return facts_of<Layout<32>>();
      return facts_of<Layout<16>>();
    default:
      return facts_of<Layout<8>>();
  }
}

}  // namespace

std::uint64_t StoreFacts::data_bytes() const {
  return regions.empty() ? 0 : regions.back().offset_bytes + regions.back().bytes;
}

StoreFacts store_facts(sim::StoreSize size, std::uint32_t packet_width) {
  return size == sim::StoreSize::k64KB ? facts_of_width<StoreLayout64K>(packet_width)
                                       : facts_of_width<StoreLayout256K>(packet_width);
}

}  // namespace gridiron::tool
