// Job comparison. SPDX-License-Identifier: Apache-2.0
#include "job_comparison.h"

#include <gridiron/sim/busy_cycles.h>
#include <gridiron/sim/sim_memory.h>
#include <gridiron/sim/trace_packing.h>
#include <report/device_report.h>
#include <report/report.h>

#include <algorithm>
#include <cinttypes>
#include <cstdio>
#include <cstring>
#include <utility>

#include "base/failure.h"
#include "base/words.h"
#include "gridiron/frame/chip_frame.h"
#include "gridiron/frame/frame_pictures.h"

namespace gridiron::tool {
namespace {

constexpr std::uint32_t kUsualLanes = 4;

/// A job in simulated memory.
struct MovedJob {
  explicit MovedJob(std::uint64_t bytes) : memory(bytes) {}

  sim::SimMemory memory;
  MainAddress frame{};
  std::uint64_t base_address = 0;
  FrameRecord record{};
};

// Memory begins a multiple of 4,096 further on, so that transfers are split as on the device.
constexpr std::uint64_t kMemoryAlignment = 4096;

void load_job(OpenJob& open, MovedJob& moved) {
  const std::optional<sim::MemoryRegion> region = moved.memory.allocate(open.job.memory_bytes, kMemoryAlignment);
  if (!region) throw Failure(ExitCode::kBadInput, "the simulated memory is too small for the job");
  move_bytes(open.file.bytes, region->bytes.data());
  open.file = {};
  const auto move = [&](std::uint64_t address) {
    return address == 0 ? 0 : address - open.job.base_address + region->address.value;
  };
  moved.base_address = region->address.value;
  moved.frame = {move(open.job.frame_address)};
  moved.record = open.record;
  FrameRecord& record = moved.record;
  for (std::uint64_t* address :
       {&record.color_address, &record.depth_address, &record.id_address, &record.engine.macro_table_address,
        &record.engine.cell_blocks_address, &record.engine.triangles_address, &record.effects_address,
        &record.image_address, &record.tree_address}) {
    *address = move(*address);
  }
  std::memcpy(moved.memory.bytes_at(moved.frame, sizeof record).data(), &record, sizeof record);
}

sim::ChipOptions options_of(const OpenJob& open, const OpenResult& result, const MovedJob& moved,
                            std::uint32_t threads) {
  const sim::LayoutChoice layout = open.layout();
  sim::ChipOptions options;
  options.lanes = result.frame.lane_count != 0 ? result.frame.lane_count : kUsualLanes;
  // Other lanes give other counts of groups, but the same picture.
  if (options.lanes > sim::widest_lanes() || !sim::is_built(layout, options.mode, options.lanes)) {
    options.lanes = kUsualLanes;
  }
  if (!sim::is_built(layout, options.mode, options.lanes)) {
    usage_error("--compare: the simulator has no kernel for the job's layout, a store of " +
                words_of_bytes(open.job.store_bytes) + " with tiles of " + std::to_string(layout.tile_width) +
                " and packets of " + std::to_string(layout.packet_width) + " pixels");
  }
  options.threads = threads;
  options.store = layout.store;
  options.packet_width = layout.packet_width;
  if (result.frame.queue_depth != 0) options.limits.queue_depth = result.frame.queue_depth;
  if (open.job.spill_address != 0) {
    // There are as many slices as the device has cores.
    options.threads = std::min(threads, open.job.spill_cores);
    options.spill = {.address = {open.job.spill_address - open.job.base_address + moved.base_address},
                     .bytes_per_core = open.job.spill_bytes};
  }
  return options;
}

std::string hex_word(std::uint32_t word) {
  char text[16];
  std::snprintf(text, sizeof text, "0x%08" PRIx32, word);
  return text;
}

ComparedItem compare_planes(const char* name, const FrameRecord& record, std::span<const std::byte> device,
                            std::span<const std::byte> simulated) {
  const Picture<std::uint32_t> ours = words_of_plane(record, simulated), theirs = words_of_plane(record, device);
  std::size_t different = 0, first = 0;
  for (std::size_t i = ours.pixels.size(); i-- > 0;) {
    if (ours.pixels[i] == theirs.pixels[i]) continue;
    first = i;
    ++different;
  }
  if (different == 0) return {name, true, words_of_count(ours.pixels.size(), "pixel")};
  return {name, false,
          words_of_count(different) + " of " + words_of_count(ours.pixels.size(), "pixel") + ", first " +
              std::to_string(first % ours.width) + "," + std::to_string(first / ours.width) + ": device " +
              hex_word(theirs.pixels[first]) + ", simulator " + hex_word(ours.pixels[first])};
}

std::string of_both(std::uint64_t device, std::uint64_t simulated) {
  return "device " + words_of_count(device) + ", simulator " + words_of_count(simulated);
}

sim::WorkTotals work_of(const sim::TileTrace& trace) {
  sim::WorkTotals work{};
  sim::for_each_event(trace, [&work](const sim::TraceEvent& event) {
    for (const sim::WorkAmount& amount : event.work) work[amount.kind.number()] += amount.amount;
  });
  return work;
}

struct Transfers {
  std::uint64_t count = 0, bytes = 0;
};

Transfers transfers_of(const sim::TileTrace& trace) {
  Transfers sum;
  sim::for_each_event(trace, [&sum](const sim::TraceEvent& event) {
    if (event.kind != sim::EventKind::kGet && event.kind != sim::EventKind::kPut) return;
    ++sum.count;
    sum.bytes += event.bytes;
  });
  return sum;
}

// Counters of a core wrap after 2^32 - 1.
bool is_same_count(std::uint64_t a, std::uint64_t b) {
  return static_cast<std::uint32_t>(a) == static_cast<std::uint32_t>(b);
}

void compare_work(const sim::ChipResult& simulated, const OpenResult& result, std::uint32_t lanes,
                  JobComparison& comparison) {
  const std::uint32_t device_lanes = result.frame.lane_count != 0 ? result.frame.lane_count : kUsualLanes;
  const sim::WorkTotals device = sum_of_work(result.cores());
  const sim::WorkTotals prologue = work_of(simulated.trace.prologue), epilogue = work_of(simulated.trace.epilogue);
  const sim::EngineWork& engine = *simulated.trace.engine;
  const std::size_t item = comparison.items.size();
  comparison.items.push_back({"work", true, words_of_count(engine.kind_count(), "kind")});
  for (std::uint32_t kind = 0; kind < engine.kind_count(); ++kind) {
    const std::uint64_t outside = result.frame.core_count * (prologue[kind] + epilogue[kind]);
    comparison.tile_work[kind] = device[kind] - std::min(device[kind], outside);
    if (device_lanes != lanes || is_same_count(device[kind], simulated.work[kind] + outside)) continue;
    comparison.items[item].equal = false;
    comparison.items.push_back({"work." + std::string(sim::work_kind(WorkId(kind), engine).name), false,
                                of_both(device[kind], simulated.work[kind] + outside)});
  }
  if (device_lanes != lanes) {
    comparison.items[item] = {"work", false,
                              "the device counts groups of " + words_of_count(device_lanes, "ray") +
                                  ", the simulator groups of " + std::to_string(lanes)};
  } else if (!comparison.items[item].equal) {
    comparison.items[item].detail =
        words_of_count(comparison.items.size() - item - 1) + " of " + words_of_count(engine.kind_count(), "kind");
  }
}

void compare_transfers(const sim::ChipResult& simulated, const OpenResult& result, JobComparison& comparison) {
  Transfers expected, counted;
  const Transfers prologue = transfers_of(simulated.trace.prologue), epilogue = transfers_of(simulated.trace.epilogue);
  for (const sim::TileTrace& trace : simulated.trace.tiles) {
    const Transfers tile = transfers_of(trace);
    expected.count += tile.count;
    expected.bytes += tile.bytes;
  }
  expected.count += result.frame.core_count * (prologue.count + epilogue.count);
  expected.bytes += result.frame.core_count * (prologue.bytes + epilogue.bytes);
  for (const port::CoreResult& core : result.cores()) {
    counted.count += core.transfers;
    counted.bytes += core.transfer_bytes;
  }
  const auto add = [&comparison](const char* name, std::uint64_t device, std::uint64_t simulator) {
    if (device == 0) return;
    const bool equal = device == simulator;
    comparison.items.push_back({name, equal, equal ? words_of_count(device) : of_both(device, simulator)});
  };
  add("transfers", counted.count, expected.count);
  add("transfer_bytes", counted.bytes, expected.bytes);

  const auto is_counted = [](const port::TileResult& tile) { return tile.transfers != 0; };
  if (std::ranges::none_of(result.tiles, is_counted)) return;
  ComparedItem tiles{"tiles.transfers", true, words_of_count(result.tiles.size(), "tile")};
  for (std::size_t tile = 0; tile < result.tiles.size() && tiles.equal; ++tile) {
    const std::uint64_t simulator = transfers_of(simulated.trace.tiles[tile]).count;
    if (result.tiles[tile].transfers == simulator) continue;
    tiles = {tiles.name, false,
             "tile " + std::to_string(tile) + " first: " + of_both(result.tiles[tile].transfers, simulator)};
  }
  comparison.items.push_back(std::move(tiles));
}

}  // namespace

bool JobComparison::is_equal() const {
  return std::ranges::all_of(items, [](const ComparedItem& item) { return item.equal; });
}

JobComparison compare_with_simulator(OpenJob& job, const std::filesystem::path& path, const OpenResult& result,
                                     const sim::MachineProfile* machine, std::uint32_t threads,
                                     std::function<void(std::uint32_t done, std::uint32_t total)> progress) {
  MovedJob moved(job.job.memory_bytes + kMemoryAlignment);
  name_in_shortage(path, "load it into the simulated memory", [&] { load_job(job, moved); });
  sim::ChipOptions options = options_of(job, result, moved, threads);
  options.progress = std::move(progress);
  const std::uint32_t lanes = options.lanes;
  const sim::ChipResult simulated = run_on_chip(moved.memory, moved.frame, std::move(options), path);

  JobComparison comparison;
  const auto add_plane = [&](const char* name, std::uint64_t address, std::span<const std::byte> device) {
    if (address == 0) return;
    const std::span<const std::byte> plane = moved.memory.bytes_at({address}, job.job.plane_bytes);
    comparison.items.push_back(compare_planes(name, moved.record, device, plane));
  };
  add_plane("image", moved.record.color_address, result.color);
  add_plane("depth", moved.record.depth_address, result.depth);
  add_plane("ids", moved.record.id_address, result.ids);
  compare_work(simulated, result, lanes, comparison);
  compare_transfers(simulated, result, comparison);
  if (machine != nullptr) {
    for (const sim::TileTrace& tile : simulated.trace.tiles) {
      comparison.predicted_tiles.push_back(sim::busy_cycles(tile, *machine));
    }
  }
  return comparison;
}

}  // namespace gridiron::tool
