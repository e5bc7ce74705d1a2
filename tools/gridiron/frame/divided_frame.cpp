// Divided frame. SPDX-License-Identifier: Apache-2.0
#include "divided_frame.h"

#include <gridiron/platform/tile_order.h>

#include <algorithm>
#include <cstring>
#include <optional>
#include <utility>
#include <vector>

#include "base/failure.h"
#include "base/ranks.h"
#include "base/stopwatch.h"
#include "base/value_bytes.h"
#include "chip_frame.h"
#include "replay_thread.h"

namespace gridiron::tool {
namespace {

// Parts of output planes, which hold whole tiles one after another.
class Planes {
 public:
  explicit Planes(const FrameMemory& frame)
      : planes_{frame.color.bytes, frame.depth.bytes, frame.ids.bytes},
        tile_bytes_(std::size_t{frame.record.tile_width} * frame.record.tile_width * 4) {}

  void add_tile(ByteWriter& writer, std::uint32_t tile) const {
    for (const std::span<std::byte>& plane : planes_) {
      if (!plane.empty()) writer.add_all(std::span<const std::byte>(plane.subspan(tile * tile_bytes_, tile_bytes_)));
    }
  }
  void take_tile(ByteReader& reader, std::uint32_t tile) const {
    for (const std::span<std::byte>& plane : planes_) {
      if (plane.empty()) continue;
      const std::span<const std::byte> bytes = reader.take_bytes(reader.take<std::uint64_t>());
      std::memcpy(plane.subspan(tile * tile_bytes_, tile_bytes_).data(), bytes.data(), tile_bytes_);
    }
  }

 private:
  std::span<std::byte> planes_[3];
  std::size_t tile_bytes_;
};

// The traces of a frame on rank 0. They are kept, or replayed as they come.
class Traces {
 public:
  Traces(const RenderPlan& plan, const sim::ReplayOptions* replay, std::uint32_t tile_count)
      : plan_(plan), replay_(replay), tile_count_(tile_count) {}

  [[nodiscard]] bool has_head() const { return has_head_; }

  // What all tiles have in common, before any of them.
  void take_head(sim::FrameTrace& trace) {
    has_head_ = true;
    trace_.prologue = std::move(trace.prologue);
    trace_.epilogue = std::move(trace.epilogue);
    trace_.output_depth = trace.output_depth;
    trace_.engine = trace.engine;
    trace_.is_middle_out = trace.is_middle_out;
    bytes_ = trace_.packed_bytes();
    if (replay_ != nullptr) {
      replayed_.emplace(trace_, tile_count_, *plan_.scene.machine, *replay_, plan_.threads > 1);
    } else {
      trace_.tiles.resize(tile_count_);
    }
  }

  void take_tile(sim::TileTrace trace) {
    bytes_ += trace.packed.size();
    if (replayed_) {
      replayed_->take(std::move(trace));
    } else {
      trace_.tiles[trace.tile_id] = std::move(trace);
    }
  }

  void finish(DividedFrame& frame) {
    frame.trace_bytes = bytes_;
    if (replayed_) frame.timing = replayed_->finish();
    frame.chip.trace = std::move(trace_);
  }

 private:
  const RenderPlan& plan_;
  const sim::ReplayOptions* replay_;
  std::uint32_t tile_count_;
  bool has_head_ = false;
  sim::FrameTrace trace_;
  std::uint64_t bytes_ = 0;
  std::optional<ReplayThread> replayed_;
};

// The tiles of this rank, and on rank 0 those of all.
class Division {
 public:
  using ProgressCall = std::function<void(std::uint32_t done, std::uint32_t total)>;

  Division(FrameMemory& frame, const RenderPlan& plan, const sim::ReplayOptions* replay, const ProgressCall& progress)
      : frame_(frame),
        plan_(plan),
        planes_(frame),
        progress_(progress),
        tile_count_(frame.record.tiles_x * frame.record.tiles_y),
        has_trace_(plan.mode != sim::Mode::kPlain),
        traces_(plan, replay, tile_count_) {}

  // Renders the own tiles in the order of claims, so that traces come in the order in which a replay takes them.
  void render_own() {
    const auto own_count = static_cast<std::uint32_t>(ranks().share_of(tile_count_));
    std::uint32_t at_once = plan_.threads;
    std::vector<std::uint32_t> tiles;
    for (std::uint32_t begin = 0; begin < own_count; begin += static_cast<std::uint32_t>(tiles.size())) {
      tiles.clear();
      for (std::uint32_t k = begin; k < std::min(own_count, begin + at_once); ++k) {
        tiles.push_back(tile_of_claim(static_cast<std::uint32_t>(ranks().piece(k))));
      }
      std::ranges::sort(tiles);
      const Stopwatch stopwatch;
      sim::ChipResult part = render_tiles_on_chip(frame_, plan_, tiles, [this](std::uint32_t done, std::uint32_t) {
        ranks().attend();
        if (!ranks().is_first()) return;
        take_arrived();
        progress_(done_ + done, tile_count_);
      });
      at_once = tiles_at_once(static_cast<double>(tiles.size()) / stopwatch.seconds());
      if (ranks().is_first()) {
        take_own(std::move(part), static_cast<std::uint32_t>(tiles.size()));
      } else {
        tell(part, tiles);
      }
    }
  }

  // @returns the whole frame, on rank 0.
  [[nodiscard]] DividedFrame finish() {
    while (ranks().is_first() && done_ < tile_count_) {
      take_message(ranks().wait_message().bytes);
      progress_(done_, tile_count_);
    }
    // No message of another frame comes before all of this have been taken.
    Bytes nothing;
    ranks().broadcast(nothing);
    if (ranks().is_first()) traces_.finish(whole_);
    return std::move(whole_);
  }

 private:
  // At the end of a part threads wait for the last: a part is several tiles a thread.
  [[nodiscard]] std::uint32_t tiles_at_once(double tiles_per_second) const {
    const double least = std::min(4.0 * plan_.threads, double{kTilesAtOnce});
    return static_cast<std::uint32_t>(std::clamp(kSecondsAtOnce * tiles_per_second, least, double{kTilesAtOnce}));
  }

  [[nodiscard]] std::uint32_t tile_of_claim(std::uint32_t claim) const {
    return plan_.engine == EngineId::kTree ? middle_out(claim, tile_count_) : claim;
  }

  void add_work(const sim::WorkTotals& work) {
    for (std::size_t kind = 0; kind < work.size(); ++kind) whole_.chip.work[kind] += work[kind];
  }

  void take_own(sim::ChipResult part, std::uint32_t count) {
    add_work(part.work);
    if (!traces_.has_head()) traces_.take_head(part.trace);
    if (has_trace_) {
      for (sim::TileTrace& trace : part.trace.tiles) traces_.take_tile(std::move(trace));
    }
    done_ += count;
    take_arrived();
    progress_(done_, tile_count_);
  }

  void take_arrived() {
    if (!traces_.has_head()) return;  // it comes from the own first tiles, and is the same on all ranks
    while (const std::optional<RankMessage> message = ranks().poll()) take_message(message->bytes);
  }

  void tell(const sim::ChipResult& part, const std::vector<std::uint32_t>& tiles) const {
    ByteWriter message;
    message.add(static_cast<std::uint32_t>(tiles.size()));
    message.add(part.work);
    for (std::size_t i = 0; i < tiles.size(); ++i) {
      message.add(tiles[i]);
      planes_.add_tile(message, tiles[i]);
      if (has_trace_) message.add(part.trace.tiles[i].packed);
    }
    ranks().tell_first(message.take());
  }

  void take_message(const Bytes& bytes) {
    ByteReader reader(bytes);
    const auto count = reader.take<std::uint32_t>();
    add_work(reader.take<sim::WorkTotals>());
    for (std::uint32_t i = 0; i < count; ++i) {
      const auto tile = reader.take<std::uint32_t>();
      planes_.take_tile(reader, tile);
      if (!has_trace_) continue;
      sim::TileTrace trace{tile, {}};
      reader.take(trace.packed);
      traces_.take_tile(std::move(trace));
    }
    done_ += count;
  }

  FrameMemory& frame_;
  const RenderPlan& plan_;
  Planes planes_;
  const ProgressCall& progress_;
  std::uint32_t tile_count_;
  bool has_trace_;
  DividedFrame whole_;
  Traces traces_;
  std::uint32_t done_ = 0;  // on rank 0
};

// By this rank alone.
DividedFrame render_alone(FrameMemory& frame, const RenderPlan& plan,
                          const std::function<void(std::uint32_t done, std::uint32_t total)>& progress) {
  DividedFrame whole;
  whole.chip = render_on_chip(frame, plan, progress);
  whole.trace_bytes = whole.chip.trace.packed_bytes();
  return whole;
}

}  // namespace

DividedFrame render_divided(FrameMemory& frame, const RenderPlan& plan, const sim::ReplayOptions* replay,
                            const std::function<void(std::uint32_t done, std::uint32_t total)>& progress) {
  if (ranks().count() == 1) return render_alone(frame, plan, progress);
  if (plan.tile) return ranks().is_first() ? render_alone(frame, plan, progress) : DividedFrame{};
  Division division(frame, plan, replay, progress);
  division.render_own();
  return division.finish();
}

}  // namespace gridiron::tool
