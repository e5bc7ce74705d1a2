// Chip frame. SPDX-License-Identifier: Apache-2.0
#include "chip_frame.h"

#include <optional>
#include <utility>

#include "base/failure.h"
#include "base/words.h"
#include "files/interrupt.h"
#include "frame_failure.h"

namespace gridiron::tool {
namespace {

std::optional<std::uint32_t> chosen_tile(const RenderPlan& plan, const FrameRecord& record) {
  if (!plan.tile) return std::nullopt;
  if (plan.tile->x >= record.tiles_x || plan.tile->y >= record.tiles_y) {
    usage_error("--tile: the picture has " + words_of_count(record.tiles_x, "column") + " and " +
                words_of_count(record.tiles_y, "row") + " of tiles, counted from 0,0");
  }
  return plan.tile->y * record.tiles_x + plan.tile->x;
}

sim::ChipOptions options_of(const FrameMemory& frame, const RenderPlan& plan) {
  sim::ChipOptions options;
  options.mode = plan.mode;
  options.threads = plan.threads;
  options.lanes = plan.lanes;
  options.store = plan.layout.store;
  options.packet_width = plan.layout.packet_width;
  options.completion = plan.completion;
  options.seed = plan.seed;
  options.limits.queue_depth = plan.scene.machine->queue_depth;
  options.spill = {.address = frame.spill.address, .bytes_per_core = frame.spill_bytes_per_core};
  return options;
}

}  // namespace

sim::ChipResult render_on_chip(FrameMemory& frame, const RenderPlan& plan,
                               std::function<void(std::uint32_t done, std::uint32_t total)> progress) {
  const std::optional<std::uint32_t> tile = chosen_tile(plan, frame.record);
  const std::span<const std::uint32_t> all;
  return render_tiles_on_chip(frame, plan, tile ? std::span(&*tile, 1) : all, std::move(progress));
}

sim::ChipResult render_tiles_on_chip(FrameMemory& frame, const RenderPlan& plan, std::span<const std::uint32_t> tiles,
                                     std::function<void(std::uint32_t done, std::uint32_t total)> progress) {
  sim::ChipOptions options = options_of(frame, plan);
  options.only_tiles = tiles;
  options.progress = std::move(progress);
  return run_on_chip(frame.memory, frame.record_address, std::move(options), plan.scene.input);
}

sim::ChipResult run_on_chip(sim::SimMemory& memory, MainAddress frame, sim::ChipOptions options,
                            const std::filesystem::path& input) {
  options.abort = &interrupt_flag();
  stop_if_interrupted();
  sim::ChipResult result = sim::render_frame(memory, frame, options);
  stop_if_interrupted();
  if (const std::optional<Failure> failure = frame_failure(result, input)) throw *failure;
  return result;
}

}  // namespace gridiron::tool
