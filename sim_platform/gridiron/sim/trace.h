// Trace: the steps of one tile, in order, without any clock. The replay gives them times on a machine.
// Memory: std::vector. Threads: a TileTrace is written by one core. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/stages.h>
#include <gridiron/base/work_counters.h>
#include <gridiron/sim/engine_work.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace gridiron::sim {

/// Output buffer `slot` of a core is put under Tag{kFirstRotatingTag + slot}, slot = (tiles begun before on this core)
/// % output_depth. A trace stores such a tag as (slot - tile ordinal) mod output_depth, without kFirstRotatingTag.
inline constexpr std::uint32_t kFirstRotatingTag = 24;

/// Pseudo tile of a core's steps before its first and after its last claim: prologue and epilogue.
inline constexpr std::uint32_t kNoTile = 0xFFFFFFFFu;

/// Kinds of steps.
enum class EventKind : std::uint8_t {
  kWork,   ///< work was done
  kGet,    ///< a get was issued
  kPut,    ///< a put was issued
  kWait,   ///< tags were waited for
  kStage,  ///< the core turned to another stage
};

/// Work of one kind done between two transfers.
struct WorkAmount {
  WorkId kind;           ///< of work
  std::uint32_t amount;  ///< how much of it, above 0

  friend constexpr bool operator==(const WorkAmount&, const WorkAmount&) = default;  ///< of all members
};

/// One step of a core. Tags of output buffers are stored relative to the core's tile ordinal (rotated), so that a trace
/// does not depend on the core that rendered the tile; all others are stored unchanged. Addresses of spill memory are
/// stored as if core 0 had rendered the tile. Every tile, prologue and epilogue starts in stage kPrimary.
struct TraceEvent {
  EventKind kind = {};              ///< decides which of the others are used; unused ones are zero
  std::uint8_t tag = 0;             ///< kGet, kPut: tag index
  bool rotating = false;            ///< kGet, kPut: tag is relative to the tile ordinal
  Stage stage = {};                 ///< kStage: the core's stage from here on
  std::uint32_t bytes = 0;          ///< kGet, kPut
  std::uint64_t address = 0;        ///< kGet, kPut: main memory
  std::uint32_t tags = 0;           ///< kWait: mask of plain tags
  std::uint32_t rotating_tags = 0;  ///< kWait: mask of tags relative to the tile ordinal
  std::span<const WorkAmount> work{};  ///< kWork: by rising kind, at least one
};

/// The steps of one tile as TraceWriter packs them and TraceReader (trace_packing.h) reads them. The bytes depend on
/// nothing else and hold no pointers: a program of the same version may move, store and read them anywhere.
struct TileTrace {
  std::uint32_t tile_id = 0;      ///< row-major; kNoTile of prologue and epilogue
  std::vector<std::byte> packed;  ///< no bytes: no steps
};

/// Work of a frame, by kind.
using WorkTotals = std::array<std::uint64_t, kWorkKindCount>;

/// The trace of a frame. `prologue` is each core's steps before its first claim (fetching the frame record and resident
/// tables), `epilogue` those after its last tile (draining output).
struct FrameTrace {
  TileTrace prologue;             ///< before the first claim
  TileTrace epilogue;             ///< after the last tile
  std::vector<TileTrace> tiles;   ///< index = tile_id, where all were rendered
  std::uint32_t output_depth = 1; ///< rotation of the relative tags
  const EngineWork* engine = &kGridEngine;  ///< whose kinds of work these are; outlives the trace
  bool is_middle_out = false;  ///< whether cores claim in the order of middle_out(), not by rising number

  /// @returns bytes of all packed steps.
  [[nodiscard]] std::uint64_t packed_bytes() const {
    std::uint64_t bytes = prologue.packed.size() + epilogue.packed.size();
    for (const TileTrace& tile : tiles) bytes += tile.packed.size();
    return bytes;
  }
};

}  // namespace gridiron::sim
