// Packing of traces: a frame with effects takes hundreds of steps a pixel, kept in little more than a byte each.
// Memory: the steps of one tile and about 100 KB, on the heap. Threads: one per object.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/sim/trace.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

namespace gridiron::sim {

/// Packs the steps of one tile after another. Every tile is packed by itself: its bytes say the same whatever was
/// packed before. A step is written as the few bytes in which it differs from what was expected, and once the tile has
/// ended, bytes that repeat earlier ones become references to them. Any value of any member comes out as it went in.
class TraceWriter {
 public:
  TraceWriter();
  ~TraceWriter();
  TraceWriter(const TraceWriter&) = delete;
  TraceWriter& operator=(const TraceWriter&) = delete;

  /// Amounts of 0 and steps of no work are left out, kinds of work are put in order, and amounts of one kind in one
  /// step are added up. Members that mean nothing for the kind of step are not kept.
  void add(const TraceEvent& event);

  /// @returns the steps added since the last call, packed; no bytes where there were none.
  [[nodiscard]] TileTrace finish(std::uint32_t tile_id);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Reads the steps of a tile in order.
class TraceReader {
 public:
  TraceReader();
  explicit TraceReader(const TileTrace& trace) : TraceReader() { open(trace); }
  ~TraceReader();
  TraceReader(const TraceReader&) = delete;
  TraceReader& operator=(const TraceReader&) = delete;
  TraceReader(TraceReader&&) noexcept;
  TraceReader& operator=(TraceReader&&) noexcept;

  /// Goes to the first step of `trace`, which is borrowed until the next call or the end of reading.
  void open(const TileTrace& trace);

  /// @returns the next step, good until the next call; null after the last one.
  [[nodiscard]] const TraceEvent* next();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Calls `visit(const TraceEvent&)` for every step of `trace`.
template <class Visit>
void for_each_event(const TileTrace& trace, Visit&& visit) {
  TraceReader reader(trace);
  while (const TraceEvent* const event = reader.next()) visit(*event);
}

}  // namespace gridiron::sim
