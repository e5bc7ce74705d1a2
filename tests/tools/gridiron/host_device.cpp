// Host device. SPDX-License-Identifier: Apache-2.0
#include "host_device.h"

#include <gridiron/base/records.h>
#include <gridiron/firmware/frame_job.h>
#include <gridiron/sim/compiled_layouts.h>
#include <gridiron/sim/plain_core.h>
#include <gridiron/sim/render_entry.h>
#include <gridiron/sim/sim_memory.h>
#include <gridiron/sim/item_source.h>

#include <new>
#include <numeric>
#include <vector>

#include "support/test_headers.h"

namespace gridiron::test {
namespace {

struct FreeArena {
  void operator()(std::byte* bytes) const { ::operator delete[](bytes, std::align_val_t{kLineBytes}); }
};

// One core's frame: its arena, and where the kernel left its counters.
class DeviceCore {
 public:
  DeviceCore(const port::FrameJob& job, sim::SimMemory& memory, std::uint32_t index)
      : job_(job), memory_(memory), index_(index) {
    layout_.tile_width = job.tile_width;
    layout_.packet_width = job.packet_width;
    layout_.has_effects = job.effects != 0;
    for (const sim::StoreSize store : sim::kStoreSizes) {
      if (sim::arena_bytes(store) == job.store_bytes) layout_.store = store;
    }
    arena_.reset(new (std::align_val_t{kLineBytes}) std::byte[job.store_bytes]);
  }

  // Claims tiles [first, end). @param tile_transfers  index = tile id.
  void render(std::uint32_t first, std::uint32_t end, port::CoreResult& result, port::TileResult* tiles) {
    const std::uint64_t outside = run(0, 0, result, nullptr);  // what no tile is charged with
    result.transfers = static_cast<std::uint32_t>(run(first, end, result, tiles));
    if (end > first) tiles[first].transfers -= static_cast<std::uint32_t>(outside);
    result.tiles = end - first;
    result.stack_bytes = 1 + index_;
    result.instructions = 1000 + index_;
    take_work(result);
  }

 private:
  // @returns transfers; tiles get those from their claim, or the start, to the next claim.
  std::uint64_t run(std::uint32_t first, std::uint32_t end, port::CoreResult& result, port::TileResult* tiles) {
    std::memset(arena_.get(), 0, job_.store_bytes);
    sim::PlainCore* claiming = nullptr;
    std::uint64_t told = 0;
    std::vector<std::uint32_t> own(end - first);
    std::iota(own.begin(), own.end(), first);
    sim::ItemSource source(0, own, nullptr, [&](std::uint32_t done, std::uint32_t) {
      const std::uint32_t tile = first + done - 1;
      tiles[tile] = {index_, static_cast<std::uint32_t>(claiming->transfers() - told), 1 + std::uint64_t{tile}};
      told = claiming->transfers();
    });
    sim::PlainCore core(memory_.base(), {}, source);
    core.copy_all();
    claiming = &core;
    const SpillRegion spill = job_.spill_address == 0
                                  ? SpillRegion{}
                                  : SpillRegion{{job_.spill_address + index_ * job_.spill_bytes}, job_.spill_bytes};
    const auto entry =
        layout_.has_effects ? gridiron_sim_render_plain_effects_lanes4 : gridiron_sim_render_plain_lanes4;
    result.status = static_cast<std::uint32_t>(entry(layout_, arena_.get(), core, {job_.frame_address}, spill));
    return core.transfers();
  }

  void take_work(port::CoreResult& result) const {
    const auto take = [&]<class Layout>() {
      const auto* store = reinterpret_cast<const LocalStore<Layout>*>(arena_.get());
      std::memcpy(result.work, store->work.counts, sizeof store->work.counts);
    };
    EXPECT_TRUE(sim::visit_layout(sim::CommonLayouts{}, layout_, take) ||
                sim::visit_layout(sim::EffectLayouts{}, layout_, take));
  }

  const port::FrameJob& job_;
  sim::SimMemory& memory_;
  std::uint32_t index_;
  sim::LayoutChoice layout_;
  std::unique_ptr<std::byte[], FreeArena> arena_;
};

}  // namespace

std::string render_on_host_device(const std::string& file, std::uint32_t core_count) {
  port::FrameJob job{};
  std::memcpy(&job, file.data(), sizeof job);
  // Memory below the job that must not be accessed, and that the host does not commit.
  sim::SimMemory memory(job.base_address + job.memory_bytes);
  const auto below = memory.allocate(job.base_address - sim::SimMemory::kFirstAddress, 1);
  const auto region = memory.allocate(job.memory_bytes, 4096);
  if (!below || !region || region->address.value != job.base_address) {
    ADD_FAILURE() << "no memory for a job at " << job.base_address;
    return {};
  }
  // What is not loaded need not be zero.
  std::memset(region->bytes.data(), 0xA5, region->bytes.size());
  std::memcpy(region->bytes.data(), file.data(), file.size());

  port::FrameResult frame{};
  std::vector<port::TileResult> tiles(job.tile_count);
  frame.magic = port::kFrameResultMagic;
  frame.version = port::kFrameJobVersion;
  frame.core_count = core_count;
  frame.work_kinds = kWorkKindCount;
  const std::uint32_t share = (job.tile_count + core_count - 1) / core_count;
  for (std::uint32_t i = 0; i < core_count; ++i) {
    const std::uint32_t first = std::min(i * share, job.tile_count), end = std::min(first + share, job.tile_count);
    DeviceCore(job, memory, i).render(first, end, frame.cores[i], tiles.data());
    if (frame.status == 0) frame.status = frame.cores[i].status;
  }

  std::byte* const result = region->bytes.data() + (job.result_address - job.base_address);
  std::memcpy(result, &frame, sizeof frame);
  std::memcpy(result + sizeof frame, tiles.data(), tiles.size() * sizeof tiles[0]);
  return {reinterpret_cast<const char*>(result), job.result_bytes};
}

}  // namespace gridiron::test
