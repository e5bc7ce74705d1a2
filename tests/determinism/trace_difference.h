// Where two traces of one frame part.
// Memory: borrowed. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/sim/trace.h>

#include <algorithm>
#include <cstddef>
#include <string>

namespace gridiron::test {

inline std::string words_of(const sim::TraceEvent& e) {
  return "kind " + std::to_string(static_cast<int>(e.kind)) + " tag " + std::to_string(e.tag) + " bytes " +
         std::to_string(e.bytes) + " address " + std::to_string(e.address);
}

// First difference of two tile traces in words, empty where there is none. Addresses count relative to the planes and
// the image, which lie at the same place in every frame here.
inline std::string first_difference(const sim::TileTrace& a, const sim::TileTrace& b) {
  if (a.tile_id != b.tile_id) return "tile ids";
  if (a.events.size() != b.events.size()) return "event counts";
  for (std::size_t i = 0; i < a.events.size(); ++i) {
    const sim::TraceEvent& x = a.events[i];
    const sim::TraceEvent& y = b.events[i];
    const bool transfer = x.kind == sim::EventKind::kGet || x.kind == sim::EventKind::kPut;
    bool same = x.kind == y.kind;
    if (transfer) {
      same = same && x.tag == y.tag && x.rotating == y.rotating && x.bytes == y.bytes && x.address == y.address;
    } else if (x.kind == sim::EventKind::kWait) {
      same = same && x.tags == y.tags && x.rotating_tags == y.rotating_tags;
    } else if (x.kind == sim::EventKind::kStage) {
      same = same && x.stage == y.stage;
    } else {
      same = same && x.first_work == y.first_work && x.work_count == y.work_count;
    }
    if (!same) return "event " + std::to_string(i) + ": " + words_of(x) + " or " + words_of(y);
  }
  const auto same_amount = [](const sim::WorkAmount& x, const sim::WorkAmount& y) {
    return x.kind == y.kind && x.amount == y.amount;
  };
  const bool same_work = std::equal(a.work.begin(), a.work.end(), b.work.begin(), b.work.end(), same_amount);
  return same_work ? "" : "work";
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
