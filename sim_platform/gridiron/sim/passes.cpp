// Passes: what the master does between them, and the run of each; see the header.
// Memory: owns local stores for the time of a pass. Threads: starts its own. SPDX-License-Identifier: Apache-2.0
#include <gridiron/sim/passes.h>

#include <algorithm>
#include <new>
#include <optional>

namespace gridiron::sim {

namespace {

/// @returns nothing if the count is not in memory, or above its bound.
[[nodiscard]] std::optional<std::uint32_t> count_items(SimMemory& memory, const ItemCount& items) {
  if (items.address.value == 0) return items.most;
  const std::span<const std::byte> bytes = memory.bytes_at(items.address, 4);
  if (bytes.empty() || items.per_item == 0) return std::nullopt;
  std::uint32_t things = 0;
  for (std::uint32_t i = 0; i < 4; ++i) things |= std::to_integer<std::uint32_t>(bytes[i]) << (8 * i);
  const std::uint32_t count = things / items.per_item + (things % items.per_item != 0 ? 1 : 0);
  if (count > items.most) return std::nullopt;
  return count;
}

/// @returns the same bytes, in rising order, those that touch or overlap put together.
[[nodiscard]] std::vector<MainRange> in_order(std::vector<MainRange> ranges) {
  std::erase_if(ranges, [](const MainRange& range) { return range.begin >= range.end; });
  std::sort(ranges.begin(), ranges.end(), [](const MainRange& a, const MainRange& b) { return a.begin < b.begin; });
  std::vector<MainRange> result;
  for (const MainRange& range : ranges) {
    if (!result.empty() && range.begin <= result.back().end) {
      result.back().end = std::max(result.back().end, range.end);
    } else {
      result.push_back(range);
    }
  }
  return result;
}

/// @param index           of the pass in its list.
/// @param transfers_done  of the passes before it.
[[nodiscard]] ChipResult run_pass(SimMemory& memory, const Pass& pass, std::uint32_t items, std::size_t index,
                                  std::uint64_t transfers_done, const ChipOptions& asked) {
  FrameShape shape(*pass.engine);
  shape.tile_count = items;
  shape.output_depth = pass.output_depth;
  shape.arena_bytes = arena_bytes(asked.store);
  shape.data_bytes = pass.data_bytes;
  shape.writable = in_order(pass.writable);
  shape.claims_all = true;

  ChipOptions options = asked;
  options.threads = std::min(asked.threads, items);  // the others would find none
  options.seed = asked.seed ^ (index * 0x9FB21C651E98DF25u);
  options.fail_transfer = asked.fail_transfer > transfers_done ? asked.fail_transfer - transfers_done : 0;
  return options.mode == Mode::kPlain ? run_plain_cores(memory, shape, options, pass.kernel.plain())
                                      : run_cores(memory, shape, options, pass.kernel.checked());
}

/// What is the same for all passes. Passes check the rest.
[[nodiscard]] bool is_valid(SimMemory& memory, const Pass& pass, const ChipOptions& options) {
  return options.only_tiles.empty() && options.threads != 0 && are_limits_valid(options.limits) &&
         pass.output_depth != 0 && pass.data_bytes != 0 && pass.data_bytes <= arena_bytes(options.store) &&
         is_spill_valid(memory, options.spill, options.threads, in_order(pass.writable));
}

}  // namespace

PassesResult run_passes(SimMemory& memory, std::span<const Pass> passes, const ChipOptions& options) {
  PassesResult all;
  for (std::size_t i = 0; i < passes.size() && all.status == Status::kOk; ++i) {
    const Pass& pass = passes[i];
    PassRun& run = all.passes.emplace_back();
    run.name = pass.name;
    run.result.trace.engine = pass.engine;
    const std::optional<std::uint32_t> items = count_items(memory, pass.items);
    if (!items || !is_valid(memory, pass, options)) {
      run.result.status = Status::kBadParameter;
    } else if (options.abort != nullptr && options.abort->load(std::memory_order_relaxed)) {
      run.result.status = Status::kAborted;
    } else if (*items != 0) {
      run.items = *items;
      try {
        run.result = run_pass(memory, pass, *items, i, all.transfers, options);
      } catch (const std::bad_alloc&) {
        run.result = ended_by(HostShortage::kMemory);
      }
    }
    all.status = run.result.status;
    all.host_shortage = run.result.host_shortage;
    all.transfers += run.result.transfers;
  }
  return all;
}

}  // namespace gridiron::sim
