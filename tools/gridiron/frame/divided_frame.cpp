// Divided frame. SPDX-License-Identifier: Apache-2.0
#include "divided_frame.h"

#include <gridiron/sim/host_workers.h>

#include <algorithm>
#include <atomic>
#include <cstring>
#include <exception>
#include <mutex>
#include <optional>
#include <utility>

#include "base/failure.h"
#include "base/ranks.h"
#include "base/value_bytes.h"
#include "chip_frame.h"

namespace gridiron::tool {
namespace {

constexpr std::size_t kMessageBytes = std::size_t{4} << 20;

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

// The tiles of this rank, and on rank 0 those of all. Calls are serialised.
class Division {
 public:
  using ProgressCall = std::function<void(std::uint32_t done, std::uint32_t total)>;

  Division(const FrameMemory& frame, const RenderPlan& plan, const ProgressCall& progress)
      : planes_(frame),
        progress_(progress),
        tile_count_(frame.record.tiles_x * frame.record.tiles_y),
        has_trace_(plan.mode != sim::Mode::kPlain) {
    if (ranks().is_first() && has_trace_) whole_.trace.tiles.resize(tile_count_);
  }

  [[nodiscard]] std::uint32_t own_count() const { return static_cast<std::uint32_t>(ranks().share_of(tile_count_)); }
  [[nodiscard]] static std::uint32_t own_tile(std::uint32_t k) { return k * ranks().count() + ranks().rank(); }

  void take_own(std::uint32_t tile, sim::ChipResult result) {
    if (ranks().is_first()) {
      add_work(result.work);
      if (tile == 0) take_head(result.trace);
      if (has_trace_) whole_.trace.tiles[tile] = std::move(result.trace.tiles.front());
      ++done_;
      take_arrived();
      progress_(done_, tile_count_);
      return;
    }
    tiles_.add(tile);
    planes_.add_tile(tiles_, tile);
    if (has_trace_) tiles_.add(result.trace.tiles.front().packed);
    ++told_count_;
    add_work(result.work);
    ranks().attend();
    if (tiles_.size() >= kMessageBytes) tell();
  }

  // @returns the whole frame, on rank 0.
  [[nodiscard]] sim::ChipResult finish() {
    if (!ranks().is_first() && told_count_ > 0) tell();
    while (ranks().is_first() && done_ < tile_count_) {
      const RankMessage message = ranks().wait_message();
      take_message(message.bytes);
      progress_(done_, tile_count_);
    }
    // No message of another frame comes before all of this have been taken.
    Bytes nothing;
    ranks().broadcast(nothing);
    return std::move(whole_);
  }

 private:
  void add_work(const sim::WorkTotals& work) {
    for (std::size_t kind = 0; kind < work.size(); ++kind) whole_.work[kind] += work[kind];
  }

  // What all tiles of a frame have in common.
  void take_head(sim::FrameTrace& trace) {
    whole_.trace.prologue = std::move(trace.prologue);
    whole_.trace.epilogue = std::move(trace.epilogue);
    whole_.trace.output_depth = trace.output_depth;
    whole_.trace.engine = trace.engine;
    whole_.trace.is_middle_out = trace.is_middle_out;
  }

  void tell() {
    ByteWriter message;
    message.add(std::exchange(told_count_, 0u));
    message.add(std::exchange(whole_.work, {}));
    message.add(tiles_.take());
    ranks().tell_first(message.take());
  }

  void take_arrived() {
    ranks().attend();
    while (const std::optional<RankMessage> message = ranks().poll()) take_message(message->bytes);
  }

  void take_message(const Bytes& bytes) {
    ByteReader reader(bytes);
    const auto count = reader.take<std::uint32_t>();
    add_work(reader.take<sim::WorkTotals>());
    ByteReader tiles(reader.take_bytes(reader.take<std::uint64_t>()));
    for (std::uint32_t i = 0; i < count; ++i) {
      const auto tile = tiles.take<std::uint32_t>();
      planes_.take_tile(tiles, tile);
      if (!has_trace_) continue;
      whole_.trace.tiles[tile].tile_id = tile;
      tiles.take(whole_.trace.tiles[tile].packed);
    }
    done_ += count;
  }

  Planes planes_;
  const ProgressCall& progress_;
  std::uint32_t tile_count_;
  bool has_trace_;
  sim::ChipResult whole_;         // on other ranks only the work that is not told yet
  ByteWriter tiles_;              // not told yet
  std::uint32_t told_count_ = 0;  // tiles in it
  std::uint32_t done_ = 0;        // on rank 0
};

}  // namespace

sim::ChipResult render_divided(FrameMemory& frame, const RenderPlan& plan,
                               const std::function<void(std::uint32_t done, std::uint32_t total)>& progress) {
  if (ranks().count() == 1) return render_on_chip(frame, plan, progress);
  if (plan.tile) return ranks().is_first() ? render_on_chip(frame, plan, progress) : sim::ChipResult{};
  Division division(frame, plan, progress);
  const std::uint32_t count = division.own_count();
  const std::uint32_t threads = frame.spill_bytes_per_core != 0 ? 1 : std::clamp(plan.threads, 1u, std::max(count, 1u));
  std::atomic<std::uint32_t> next{0};
  std::atomic<bool> stop{false};
  std::mutex mutex;
  std::exception_ptr error;
  const auto render_tiles = [&](std::uint32_t) {
    while (!stop) {
      const std::uint32_t k = next++;
      if (k >= count) return;
      try {
        const std::uint32_t tile = Division::own_tile(k);
        sim::ChipResult result = render_tile(frame, plan, tile);
        const std::lock_guard lock(mutex);
        division.take_own(tile, std::move(result));
      } catch (...) {
        const std::lock_guard lock(mutex);
        if (error == nullptr) error = std::current_exception();
        stop = true;
      }
    }
  };
  const sim::WorkersEnd end = sim::run_workers(threads, 1, render_tiles, [&stop] { stop = true; });
  if (end.error != nullptr) std::rethrow_exception(end.error);
  if (error != nullptr) std::rethrow_exception(error);
  return division.finish();
}

}  // namespace gridiron::tool
