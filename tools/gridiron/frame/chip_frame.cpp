// Chip frame. SPDX-License-Identifier: Apache-2.0
#include "chip_frame.h"

#include <algorithm>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include "base/failure.h"
#include "base/words.h"
#include "files/interrupt.h"
#include "frame_failure.h"

namespace gridiron::tool {
namespace {

std::optional<std::uint32_t> chosen_tile(const RenderArguments& arguments, const FrameRecord& record) {
  if (!arguments.tile) return std::nullopt;
  if (arguments.tile->x >= record.tiles_x || arguments.tile->y >= record.tiles_y) {
    throw Failure(ExitCode::kUsage, "--tile: the picture has " + words_of_count(record.tiles_x, "column") + " and " +
                                        words_of_count(record.tiles_y, "row") + " of tiles, counted from 0,0");
  }
  return arguments.tile->y * record.tiles_x + arguments.tile->x;
}

}  // namespace

sim::ChipResult render_on_chip(FrameMemory& frame, const RenderArguments& arguments,
                               std::function<void(std::uint32_t done, std::uint32_t total)> progress) {
  sim::ChipOptions options;
  options.mode = arguments.mode;
  options.threads = arguments.threads;
  options.lanes = arguments.lanes;
  options.store = arguments.store;
  options.packet_width = arguments.packet_width;
  options.completion = arguments.completion;
  options.seed = arguments.seed;
  options.limits.queue_depth = arguments.scene.machine->queue_depth;
  options.spill = {.address = frame.spill.address, .bytes_per_core = frame.spill_bytes_per_core};
  options.only_tile = chosen_tile(arguments, frame.record);
  options.progress = std::move(progress);
  return run_on_chip(frame.memory, frame.record_address, std::move(options), arguments.scene.input);
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

std::uint32_t host_threads() {
  return std::max(1u, std::thread::hardware_concurrency());
}

void limit_threads(RenderArguments& arguments) {
  const auto tiles = [&arguments](std::uint64_t pixels) {
    return (pixels + arguments.tile_width - 1) / arguments.tile_width;
  };
  const std::uint64_t tile_count = arguments.tile ? 1 : tiles(arguments.width) * tiles(arguments.height);
  arguments.threads = static_cast<std::uint32_t>(std::min<std::uint64_t>(arguments.threads, tile_count));
}

}  // namespace gridiron::tool
