// Packing of traces: a frame with effects takes hundreds of steps a pixel, stored in little more than a byte each.
// Memory: the steps of one tile and about 100 KB, on the heap. Threads: one per object.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/sim/trace.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

namespace gridiron::sim {

/// Packs the steps of one tile after another. A tile's bytes do not depend on earlier tiles. A step is written as the
/// few bytes in which it differs from the prediction; once the tile has ended, bytes that repeat earlier ones become
/// references to them. Every value is read back unchanged.
class TraceWriter {
 public:
  TraceWriter();
  ~TraceWriter();
  TraceWriter(const TraceWriter&) = delete;
  TraceWriter& operator=(const TraceWriter&) = delete;

  /// Drops amounts of 0 and steps without work, puts kinds of work in order, adds up amounts of one kind in one step,
  /// and drops members that the kind of step does not use.
  void add(const TraceEvent& event);

  /// @returns the steps added since the last call, packed; no bytes if there were none.
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

  /// Goes to the first step of `trace`, which is borrowed until the next open() or the end of reading.
  void open(const TileTrace& trace);

  /// @returns the next step, valid until the next call; null after the last one.
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
