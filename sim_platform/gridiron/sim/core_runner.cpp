// Runs one program on every core of a simulated chip and puts the cores' results together.
// Memory: owns local stores for the time of the frame. Threads: starts its own. SPDX-License-Identifier: Apache-2.0
#include <gridiron/base/records.h>
#include <gridiron/sim/core_runner.h>
#include <gridiron/sim/host_workers.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <exception>
#include <iterator>
#include <memory>
#include <new>
#include <utility>

namespace gridiron::sim {

namespace {

// Bytes before and after a core's arena. A multiple of any boundary, so that the arena stays aligned.
constexpr std::size_t kGuardBytes = 4096;
constexpr std::byte kGuardPattern{0xC9};

/// Local memory of one core between two guards; everything but the data carries the guard's pattern.
class GuardedArena {
 public:
  GuardedArena(std::size_t arena_bytes, std::size_t data_bytes)
      : total_bytes_(arena_bytes + 2 * kGuardBytes),
        data_bytes_(data_bytes),
        bytes_(static_cast<std::byte*>(::operator new (total_bytes_, std::align_val_t{kGuardBytes}))) {
    std::memset(bytes_, static_cast<int>(kGuardPattern), total_bytes_);
    std::memset(bytes_ + kGuardBytes, 0, data_bytes);
  }
  ~GuardedArena() { ::operator delete (bytes_, std::align_val_t{kGuardBytes}); }
  GuardedArena(const GuardedArena&) = delete;
  GuardedArena& operator=(const GuardedArena&) = delete;

  [[nodiscard]] std::span<std::byte> data() const { return {bytes_ + kGuardBytes, data_bytes_}; }

  /// @returns offset from the arena's start of a changed byte outside the data; 0 if there is none (0 is data).
  [[nodiscard]] std::ptrdiff_t find_damage() const {
    const auto damaged = [](std::byte b) { return b != kGuardPattern; };
    const std::byte* const data_begin = bytes_ + kGuardBytes;
    const std::byte* const data_end = data_begin + data_bytes_;
    const std::byte* const front = std::find_if(static_cast<const std::byte*>(bytes_), data_begin, damaged);
    if (front != data_begin) return front - data_begin;
    const std::byte* const end = bytes_ + total_bytes_;
    const std::byte* const back = std::find_if(data_end, end, damaged);
    return back != end ? back - data_begin : 0;
  }

 private:
  std::size_t total_bytes_;
  std::size_t data_bytes_;
  std::byte* bytes_;
};

/// One core, its memory, and how it ended.
struct CoreRun {
  std::unique_ptr<SimCore> core;
  Status status = Status::kOk;
  std::uint32_t tile = kNoTile;  ///< that the status belongs to
};

/// The tiles of a run, by their place: all of a frame, or those of ChipOptions::only_tiles.
class TileList {
 public:
  TileList(std::span<const std::uint32_t> only_tiles, std::uint32_t tile_count) : only_(only_tiles), all_(tile_count) {}

  [[nodiscard]] std::uint32_t count() const { return only_.empty() ? all_ : static_cast<std::uint32_t>(only_.size()); }
  [[nodiscard]] std::uint32_t at(std::uint32_t place) const { return only_.empty() ? place : only_[place]; }
  [[nodiscard]] std::uint32_t place_of(std::uint32_t tile) const {
    if (only_.empty()) return tile;
    return static_cast<std::uint32_t>(std::lower_bound(only_.begin(), only_.end(), tile) - only_.begin());
  }

 private:
  std::span<const std::uint32_t> only_;
  std::uint32_t all_;
};

void run_core(CoreRun& run, const GuardedArena& arena, const CoreProgram& program, ItemSource& tiles) {
  SimCore& core = *run.core;
  const Status returned = program(core, arena.data());
  const std::uint32_t last_tile = core.tile_id();
  core.finish(returned == Status::kOk);

  // The core's own record is earlier and more exact; a program may even have dropped the status.
  run.status = core.first_error() != Status::kOk ? core.first_error() : returned;
  run.tile = core.first_error() != Status::kOk ? core.first_error_tile() : last_tile;
  if (run.status != Status::kOk) tiles.stop();
}

/// A failure outranks an abort (which it causes on the other cores); of two failures the lower tile is reported.
[[nodiscard]] bool outranks(const CoreRun& a, const CoreRun& b) {
  const auto rank = [](const CoreRun& run) { return run.status == Status::kOk ? 2 : run.status == Status::kAborted; };
  return rank(a) != rank(b) ? rank(a) < rank(b) : a.tile < b.tile;
}

[[nodiscard]] std::uint64_t covered_bytes(std::vector<MainRange> ranges) {
  std::sort(ranges.begin(), ranges.end(), [](const MainRange& a, const MainRange& b) { return a.begin < b.begin; });
  std::uint64_t bytes = 0, end = 0;
  for (const MainRange& range : ranges) {
    if (range.end <= end) continue;
    bytes += range.end - std::max(range.begin, end);
    end = range.end;
  }
  return bytes;
}

/// Checks that all planes are complete. A core that ends early, or puts less than its tile, would leave old bytes of
/// main memory in the picture.
///
/// @param tile_bytes  of each tile, over all planes; tiles are known not to overlap, so that many bytes are all of
///                    them.
[[nodiscard]] std::vector<Violation> check_complete(const std::vector<CoreRun>& runs, std::uint64_t tile_bytes,
                                                    const TileList& tiles) {
  std::vector<bool> is_claimed(tiles.count());
  std::vector<std::uint64_t> put_bytes(tiles.count());
  for (const CoreRun& run : runs) {
    for (const TileTrace& trace : run.core->traces) is_claimed[tiles.place_of(trace.tile_id)] = true;
    for (const TileFootprint& footprint : run.core->footprints) {
      if (footprint.tile_id != kNoTile) put_bytes[tiles.place_of(footprint.tile_id)] += covered_bytes(footprint.puts);
    }
  }
  for (std::uint32_t i = 0; i < is_claimed.size(); ++i) {
    if (!is_claimed[i]) return {{Status::kIncompleteFrame, 0, tiles.at(i), "no core claimed the tile"}};
    if (put_bytes[i] < tile_bytes) {
      return {{Status::kIncompleteFrame, 0, tiles.at(i),
               std::to_string(put_bytes[i]) + " of the tile's " + std::to_string(tile_bytes) + " bytes were put"}};
    }
  }
  return {};
}

}  // namespace

bool are_limits_valid(const PlatformLimits& limits) {
  const auto is_power_of_two_or_zero = [](std::uint32_t value) { return value == 0 || std::has_single_bit(value); };
  return is_power_of_two_or_zero(limits.alignment_bytes) && is_power_of_two_or_zero(limits.congruence_bytes) &&
         is_power_of_two_or_zero(limits.boundary_bytes) && limits.max_transfer_bytes > 0 && limits.tag_count >= 1 &&
         limits.tag_count <= 32 && limits.queue_depth >= 1 && limits.congruence_bytes <= kLineBytes;
}

bool are_tiles_valid(std::span<const std::uint32_t> only_tiles, std::uint32_t tile_count) {
  const auto out_of_order = std::adjacent_find(only_tiles.begin(), only_tiles.end(), std::greater_equal<>());
  return only_tiles.empty() || (out_of_order == only_tiles.end() && only_tiles.back() < tile_count);
}

bool is_spill_valid(SimMemory& memory, const SpillMemory& spill, std::uint32_t cores,
                    std::span<const MainRange> writable) {
  if (spill.bytes_per_core == 0) return true;
  // Rejects more than the memory holds before anything is multiplied or rounded.
  if (spill.bytes_per_core > memory.capacity_bytes() || cores == 0) return false;
  const std::uint64_t begin = spill.address.value, slice_bytes = spill.slice_bytes();
  if (begin == 0 || begin % kSpillAlignment != 0 || slice_bytes > memory.capacity_bytes() / cores) return false;
  const std::uint64_t end = begin + slice_bytes * cores;
  if (memory.bytes_at(spill.address, end - begin).empty()) return false;
  return std::none_of(writable.begin(), writable.end(),
                      [&](const MainRange& range) { return range.begin < end && begin < range.end; });
}

namespace {

/// As run_cores. Errors: throws shortages of the host, and whatever the program throws.
[[nodiscard]] ChipResult run_on_host(SimMemory& memory, const FrameShape& shape, const ChipOptions& options,
                                     const CoreProgram& program) {
  ChipResult result;
  if (!are_limits_valid(options.limits) || options.threads == 0 || shape.output_depth == 0 || shape.data_bytes == 0 ||
      shape.data_bytes > shape.arena_bytes || !is_spill_valid(memory, options.spill, options.threads, shape.writable) ||
      !are_tiles_valid(options.only_tiles, shape.tile_count)) {
    result.status = Status::kBadParameter;
    return result;
  }
  const TileList list(options.only_tiles, shape.tile_count);
  ItemSource tiles(shape.tile_count, options.only_tiles, options.abort, options.progress);

  SimFrame frame;
  frame.memory = &memory;
  frame.tiles = &tiles;
  frame.writable = shape.writable;
  frame.spill = options.spill;
  frame.core_count = options.threads;
  frame.limits = options.limits;
  frame.completion = options.completion;
  frame.seed = options.seed;
  frame.output_depth = shape.output_depth;
  frame.fail_transfer = options.fail_transfer;

  // Run: the calling thread is core 0.
  std::vector<std::unique_ptr<GuardedArena>> arenas;
  std::vector<CoreRun> runs(options.threads);
  for (std::uint32_t i = 0; i < options.threads; ++i) {
    arenas.push_back(std::make_unique<GuardedArena>(shape.arena_bytes, shape.data_bytes));
    runs[i].core = std::make_unique<SimCore>(frame, i, arenas[i]->data());
  }
  const WorkersEnd end = run_workers(
      options.threads, shape.cores_meet ? options.threads : 1,
      [&](std::uint32_t i) { run_core(runs[i], *arenas[i], program, tiles); }, [&] { tiles.stop(); });
  if (end.error != nullptr) std::rethrow_exception(end.error);
  if (end.started == 0) return ended_by(HostShortage::kThreads);

  // Status: that of the lowest failing tile, with its violations.
  const auto worst = std::min_element(runs.begin(), runs.end(), outranks);
  result.status = worst->status;
  if (result.status != Status::kOk) {
    result.failed_core = static_cast<std::uint32_t>(worst - runs.begin());
    result.failed_tile = worst->tile;
    std::copy_if(worst->core->violations().begin(), worst->core->violations().end(),
                 std::back_inserter(result.violations), [&](const Violation& v) { return v.tile_id == worst->tile; });
  }
  const auto fail = [&](const Violation& violation) {
    if (result.status == Status::kOk) {
      result.status = violation.rule;
      result.failed_core = violation.core;
      result.failed_tile = violation.tile_id;
    }
    result.violations.push_back(violation);
  };
  for (std::uint32_t i = 0; i < options.threads; ++i) {
    const std::ptrdiff_t damage = arenas[i]->find_damage();
    if (damage == 0) continue;
    fail({Status::kBadAccess, i, kNoTile, "byte " + std::to_string(damage) + " from the arena's start was written to"});
  }

  // Across tiles: only complete frames have the same footprints in every run.
  if (result.status == Status::kOk) {
    std::vector<TileFootprint> footprints;
    for (const CoreRun& run : runs) {
      footprints.insert(footprints.end(), run.core->footprints.begin(), run.core->footprints.end());
    }
    for (const Violation& violation : check_across_tiles(footprints)) fail(violation);
    if (shape.is_picture && result.status == Status::kOk) {
      std::uint64_t picture_bytes = 0;
      for (const MainRange& range : shape.writable) picture_bytes += range.end - range.begin;
      const std::uint64_t tile_bytes = picture_bytes / shape.tile_count;
      for (const Violation& violation : check_complete(runs, tile_bytes, list)) fail(violation);
    }
    if (shape.claims_all && result.status == Status::kOk) {
      for (const Violation& violation : check_complete(runs, 0, list)) fail(violation);
    }
  }

  // Trace and totals.
  result.trace.output_depth = shape.output_depth;
  result.trace.engine = shape.engine;
  result.trace.is_middle_out = shape.engine == &kTreeEngine;
  result.trace.tiles.resize(list.count());
  for (std::uint32_t i = 0; i < list.count(); ++i) result.trace.tiles[i].tile_id = list.at(i);
  for (CoreRun& run : runs) {
    result.transfers += run.core->transfers();
    for (std::uint32_t kind = 0; kind < kWorkKindCount; ++kind) result.work[kind] += run.core->tile_work[kind];
    for (TileTrace& trace : run.core->traces) {
      result.trace.tiles[list.place_of(trace.tile_id)] = std::move(trace);
    }
  }
  result.trace.prologue = std::move(runs[0].core->prologue);
  result.trace.epilogue = std::move(runs[0].core->epilogue);
  return result;
}

}  // namespace

ChipResult run_cores(SimMemory& memory, const FrameShape& shape, const ChipOptions& options,
                     const CoreProgram& program) {
  try {
    return run_on_host(memory, shape, options, program);
  } catch (const std::bad_alloc&) {
    return ended_by(HostShortage::kMemory);
  }
}

ChipResult run_plain_cores(SimMemory& memory, const FrameShape& shape, const ChipOptions& options,
                           const PlainProgram& program) {
  ChipResult result;
  ItemSource tiles(shape.tile_count, options.only_tiles, options.abort, options.progress);

  struct FreeArena {
    void operator()(std::byte* bytes) const { ::operator delete (bytes, std::align_val_t{kLineBytes}); }
  };
  struct Run {
    std::unique_ptr<std::byte, FreeArena> arena;
    std::unique_ptr<PlainCore> core;
    Status status = Status::kOk;
  };
  std::vector<Run> runs(options.threads);
  const std::uint64_t slice_bytes = options.spill.slice_bytes();
  for (std::uint32_t i = 0; i < options.threads; ++i) {
    Run& run = runs[i];
    run.arena.reset(static_cast<std::byte*>(::operator new (shape.data_bytes, std::align_val_t{kLineBytes})));
    std::memset(run.arena.get(), 0, shape.data_bytes);
    const SpillRegion spill =
        slice_bytes == 0 ? SpillRegion{} : SpillRegion{options.spill.address.offset_by(i * slice_bytes), slice_bytes};
    run.core = std::make_unique<PlainCore>(memory.base(), options.limits, tiles, spill);
  }
  const auto run_one = [&](std::uint32_t i) {
    Run& run = runs[i];
    run.status = program(*run.core, std::span(run.arena.get(), shape.data_bytes));
    if (run.status != Status::kOk) tiles.stop();
  };
  const WorkersEnd end = run_workers(options.threads, 1, run_one, [&] { tiles.stop(); });
  if (end.error != nullptr) std::rethrow_exception(end.error);

  for (std::uint32_t i = 0; i < options.threads; ++i) {
    const Run& run = runs[i];
    result.transfers += run.core->transfers();
    if (run.status == Status::kOk) continue;
    // A failure outranks the abort that it causes on other cores; of two failures the lower tile is reported.
    const bool is_first = result.status == Status::kOk;
    const bool was_abort = result.status == Status::kAborted, is_abort = run.status == Status::kAborted;
    if (is_first || (was_abort && !is_abort) || (was_abort == is_abort && run.core->tile_id() < result.failed_tile)) {
      result.status = run.status;
      result.failed_core = i;
      result.failed_tile = run.core->tile_id();
    }
  }
  if (shape.claims_all && result.status == Status::kOk) {
    const ItemClaim left = tiles.claim();
    if (left.kind == ItemClaim::Kind::kItem) {
      result.status = Status::kIncompleteFrame;
      result.failed_tile = left.item;
    }
  }
  return result;
}

}  // namespace gridiron::sim
