// Shared traces. SPDX-License-Identifier: Apache-2.0
#include "shared_traces.h"

#include <gridiron/platform/tile_order.h>
#include <gridiron/sim/borrowed_region.h>
#include <gridiron/sim/engine_work.h>

#include <cstring>
#include <new>
#include <utility>

#include "base/ranks.h"
#include "base/value_bytes.h"

namespace gridiron::tool {

SharedTraces::SharedTraces(sim::FrameTrace& trace) {
  Ranks& all = ranks();
  ByteWriter writer;
  if (all.is_first()) {
    std::uint64_t end = 0;
    for (const sim::TileTrace& tile : trace.tiles) ends_.push_back(end += tile.packed.size());
    writer.add(trace.prologue.packed);
    writer.add(trace.epilogue.packed);
    writer.add(trace.output_depth);
    writer.add(trace.engine->id);
    writer.add(trace.is_middle_out);
    writer.add(ends_);
  }
  Bytes bytes = writer.take();
  all.broadcast(bytes);
  ByteReader reader(bytes);
  head_.prologue.tile_id = head_.epilogue.tile_id = sim::kNoTile;
  reader.take(head_.prologue.packed);
  reader.take(head_.epilogue.packed);
  reader.take(head_.output_depth);
  head_.engine = sim::core_engine(reader.take<std::uint32_t>());  // an address means nothing to another process
  reader.take(head_.is_middle_out);
  reader.take(ends_);

  const std::uint64_t byte_count = ends_.empty() ? 0 : ends_.back();
  memory_.emplace(2 * sim::SimMemory::kFirstAddress + byte_count);
  const std::optional<sim::MemoryRegion> region = memory_->allocate(byte_count);
  if (!region) throw std::bad_alloc();
  region_ = *region;
  if (all.is_first()) {
    std::byte* place = region_.bytes.data();
    for (sim::TileTrace& tile : trace.tiles) {
      const std::vector<std::byte> packed = std::exchange(tile.packed, {});
      if (!packed.empty()) std::memcpy(place, packed.data(), packed.size());
      place += packed.size();
    }
  }
  all.share_bytes(region_.bytes, "the traces", [this](std::uint64_t begin, std::span<std::byte> shared) {
    (void)sim::borrow_bytes({region_.address.offset_by(begin), region_.bytes.subspan(begin, shared.size())}, shared);
  });
}

sim::FrameTiming SharedTraces::replay(const sim::MachineProfile& machine) const {
  const auto count = static_cast<std::uint32_t>(ends_.size());
  sim::FrameClock clock(head_, count, machine, {});
  for (std::uint32_t claim = 0; claim < count; ++claim) {
    const std::uint32_t tile = head_.is_middle_out ? middle_out(claim, count) : claim;
    const std::uint64_t begin = tile == 0 ? 0 : ends_[tile - 1];
    const std::span<const std::byte> packed = region_.bytes.subspan(begin, ends_[tile] - begin);
    clock.take({tile, {packed.begin(), packed.end()}});
  }
  return clock.finish();
}

}  // namespace gridiron::tool
