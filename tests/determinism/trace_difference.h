// Where two traces of one frame part.
// Memory: borrowed. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/sim/trace.h>

#include "support/trace_steps.h"

namespace gridiron::test {

inline std::string words_of(const sim::TraceEvent& e) {
  return "kind " + std::to_string(static_cast<int>(e.kind)) + " tag " + std::to_string(e.tag) + " bytes " +
         std::to_string(e.bytes) + " address " + std::to_string(e.address);
}

// First difference of two tile traces in words, empty where there is none. Addresses count relative to the planes and
// the image, which lie at the same place in every frame here.
inline std::string first_difference(const sim::TileTrace& packed_a, const sim::TileTrace& packed_b) {
  if (packed_a.tile_id != packed_b.tile_id) return "tile ids";
  const UnpackedTrace a(packed_a), b(packed_b);
  if (a.events.size() != b.events.size()) return "event counts";
  for (std::size_t i = 0; i < a.events.size(); ++i) {
    const sim::TraceEvent& x = a.events[i];
    const sim::TraceEvent& y = b.events[i];
    if (!is_same_step(x, y)) return "event " + std::to_string(i) + ": " + words_of(x) + " or " + words_of(y);
  }
  return packed_a.packed == packed_b.packed ? "" : "packed bytes";
}

inline std::string first_difference(const sim::FrameTrace& a, const sim::FrameTrace& b) {
  if (a.tiles.size() != b.tiles.size() || a.output_depth != b.output_depth) return "shape of the traces";
  if (const std::string words = first_difference(a.prologue, b.prologue); !words.empty()) return "prologue: " + words;
  if (const std::string words = first_difference(a.epilogue, b.epilogue); !words.empty()) return "epilogue: " + words;
  for (std::size_t tile = 0; tile < a.tiles.size(); ++tile) {
    const std::string words = first_difference(a.tiles[tile], b.tiles[tile]);
    if (!words.empty()) return "tile " + std::to_string(tile) + ": " + words;
  }
  return {};
}

}  // namespace gridiron::test
