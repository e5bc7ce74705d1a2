// Trace: what one tile did, in order, without any clock. The replay gives it a time on a machine.
// Memory: std::vector. Threads: a TileTrace is written by one core. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/stages.h>
#include <gridiron/base/work_counters.h>

#include <array>
#include <cstdint>
#include <vector>

namespace gridiron::sim {

/// Output buffer `slot` of a core is put under Tag{kFirstRotatingTag + slot}, slot = (tiles begun before on this core)
/// % output_depth. A trace stores such a tag as (slot - tile ordinal) mod output_depth, without kFirstRotatingTag.
inline constexpr std::uint32_t kFirstRotatingTag = 24;

/// Pseudo tile of what a core does before its first and after its last claim: prologue and epilogue.
inline constexpr std::uint32_t kNoTile = 0xFFFFFFFFu;

/// Kinds of steps.
enum class EventKind : std::uint8_t {
  kWork,   ///< work was done
  kGet,    ///< a get was issued
  kPut,    ///< a put was issued
  kWait,   ///< tags were waited for
  kStage,  ///< the core turned to another stage
};

/// One step of a core. Tags of output buffers are stored relative to the core's tile ordinal (rotated), so that a
/// trace does not depend on which core rendered the tile; all others are stored as they are. Addresses of spill memory
/// are stored as if core 0 had rendered the tile. Every tile, prologue and epilogue starts in stage kPrimary.
struct TraceEvent {
  EventKind kind;              ///< says which of the others mean something
  std::uint8_t tag;            ///< kGet, kPut: tag index
  bool rotating;               ///< kGet, kPut: tag is relative to the tile ordinal; kWait: see rotating_tags
  Stage stage = {};            ///< kStage: what the core is busy with from here on
  std::uint32_t bytes;         ///< kGet, kPut
  std::uint64_t address;       ///< kGet, kPut: main memory
  std::uint32_t tags;          ///< kWait: mask of plain tags
  std::uint32_t rotating_tags; ///< kWait: mask of tags relative to the tile ordinal
  std::uint32_t first_work;    ///< kWork: range in TileTrace::work
  std::uint32_t work_count;    ///< kWork: length of the range
};

/// Work of one kind done between two transfers.
struct WorkAmount {
  Work kind;             ///< of work
  std::uint32_t amount;  ///< how much of it
};

/// The steps of one tile.
struct TileTrace {
  std::uint32_t tile_id = 0;       ///< row-major; kNoTile of prologue and epilogue
  std::vector<TraceEvent> events;  ///< in order
  std::vector<WorkAmount> work;    ///< that kWork events name
};

/// Work of a frame, by kind.
using WorkTotals = std::array<std::uint64_t, kWorkKindCount>;

/// Everything a frame did. `prologue` is what every core does before its first claim (fetching the frame record and
/// resident tables), `epilogue` what it does after its last tile (draining output).
struct FrameTrace {
  TileTrace prologue;             ///< before the first claim
  TileTrace epilogue;             ///< after the last tile
  std::vector<TileTrace> tiles;  ///< index = tile_id; one entry where a tile was rendered alone
  std::uint32_t output_depth = 1; ///< rotation of the relative tags
};

}  // namespace gridiron::sim
