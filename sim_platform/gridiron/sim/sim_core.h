// One simulated core in checked mode: bytes really move, every rule of the contract is checked, work is traced.
// Memory: borrows arena, main memory and tile source. Threads: one per object; SimFrame is shared.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/platform/contract.h>
#include <gridiron/sim/sim_chip.h>
#include <gridiron/sim/sim_memory.h>
#include <gridiron/sim/item_source.h>
#include <gridiron/sim/trace.h>
#include <gridiron/store/local_store.h>

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace gridiron::sim {

/// Addresses [begin, end) of main memory.
struct MainRange {
  std::uint64_t begin = 0;
  std::uint64_t end = 0;

  friend constexpr bool operator==(const MainRange&, const MainRange&) = default;
};

class TraceWriter;

/// Shared by the cores of one frame. Constant while cores run, except for the counter and the lock.
struct SimFrame {
  SimMemory* memory = nullptr;
  ItemSource* tiles = nullptr;
  std::vector<MainRange> writable;  ///< where puts may go; sorted, disjoint
  SpillMemory spill;                ///< a slice a core, apart from writable; checked by run_cores
  std::uint32_t core_count = 1;     ///< slices of spill
  PlatformLimits limits;
  Completion completion = Completion::kEarly;
  std::uint64_t seed = 0;           ///< of Completion::kRandom, mixed with the tile, so that cores do not matter
  std::uint32_t output_depth = 1;   ///< rotation of the output tags in the trace
  std::uint64_t fail_transfer = 0;  ///< the transfer that fails, counted from 1 over all cores; 0: none
  std::atomic<std::uint64_t> transfers_started{0};
  std::mutex writable_bytes;  ///< held while bytes that more than one core may write are moved
};

/// Ranges of main memory that one tile read and wrote, for the check across tiles. Only ranges that overlap writable
/// memory.
struct TileFootprint {
  std::uint32_t tile_id = 0;
  std::uint32_t core = 0;
  std::vector<MainRange> gets;
  std::vector<MainRange> puts;
};

/// The platform of Mode::kChecked and Mode::kInstrumented.
///
/// Each call checks its rules, in this order: size, tag, alignment and congruence, boundary, local range, main range,
/// queue depth, overlap with pending transfers, use of spill memory. The first broken one is recorded as a Violation
/// and returned, and nothing is started. A wait checks that neither the sources of its puts nor the destinations of its
/// gets were touched meanwhile. finish() checks that nothing is left pending.
///
/// Functions are out of line, because the kernel that calls them may be compiled with instrumentation and they are not.
class SimCore {
 public:
  /// @param arena  the core's local memory, kLineBytes-aligned; transfers may touch no other local memory.
  SimCore(SimFrame& frame, std::uint32_t core, std::span<std::byte> arena);
  ~SimCore();
  SimCore(const SimCore&) = delete;
  SimCore& operator=(const SimCore&) = delete;

  // Platform, WorkObserver, StageObserver.
  [[nodiscard]] PlatformLimits limits() const;
  Status get(void* local, MainAddress address, std::uint32_t bytes, Tag tag);
  Status put(const void* local, MainAddress address, std::uint32_t bytes, Tag tag);
  Status wait(TagMask tags);
  ItemClaim claim_item();
  void note_work(const std::uint32_t* counts, std::uint32_t count);
  void note_stage(std::uint8_t stage);

  /// The core's own slice of the frame's spill memory, if there is any.
  [[nodiscard]] SpillRegion spill() const;

  /// Ends the core's part of the frame. Pending transfers end; only Status::kTransferPending is reported for them.
  /// @param clean  false if the core gave up with an error, so that pending transfers are not a second error.
  void finish(bool clean = true);

  /// Ends the trace of the tile, or of the prologue, unless it has ended; the next claim does so too. The core makes no
  /// calls between the two.
  /// @returns the trace, valid until the next claim.
  const TileTrace& end_trace();

  /// Moves the bytes of one pending transfer at once, before its wait. With Completion::kLate the caller thereby
  /// chooses the order in which transfers complete. Rules are checked as at any other move.
  ///
  /// @param transfer  the value of transfers() after its start.
  /// @returns false if it is not pending, has moved, or fails.
  bool move_now(std::uint64_t transfer);

  /// First error of this core (rule or failed transfer), and the tile that the error belongs to.
  [[nodiscard]] Status first_error() const { return first_error_; }
  [[nodiscard]] std::uint32_t first_error_tile() const { return first_error_tile_; }
  /// The tile claimed last; kNoTile before the first and after the last.
  [[nodiscard]] std::uint32_t tile_id() const { return tile_id_; }
  [[nodiscard]] const std::vector<Violation>& violations() const { return violations_; }
  [[nodiscard]] std::uint64_t transfers() const { return transfers_; }

  // Results, complete after finish(). Moved from by render_frame.
  std::vector<TileTrace> traces;          ///< in the order of claims
  TileTrace prologue;                     ///< before the first claim
  TileTrace epilogue;                     ///< after the last tile
  WorkTotals tile_work{};                 ///< in all tiles together
  std::vector<TileFootprint> footprints;  ///< one per tile with puts, or gets from writable memory

  /// Checks every access that instrumented code of this thread makes from now on, until the end of the scope. Legal
  /// are this core's arena, the thread's stack below the frame of the caller, and read-only data of the program.
  class [[nodiscard]] AccessScope {
   public:
    /// @param stack_top  highest stack address that instrumented code may touch.
    AccessScope(SimCore& core, const void* stack_top);
    ~AccessScope();
    AccessScope(const AccessScope&) = delete;
    AccessScope& operator=(const AccessScope&) = delete;

   private:
    SimCore* outer_;
  };

  /// Called by the instrumentation for every access of `bytes` at `address`; `code` is the accessing instruction.
  static void check_access(std::uintptr_t address, std::uintptr_t bytes, bool is_store, std::uintptr_t code);

 private:
  struct Pending {
    bool is_get = false;
    bool arrived = false;  ///< the bytes have moved
    bool fails = false;    ///< the bytes never move, and the wait reports that
    bool in_use = false;
    std::uint8_t tag = 0;
    std::uint32_t bytes = 0;
    std::uint32_t tile_id = kNoTile;  ///< that started it
    std::byte* local = nullptr;
    std::uint64_t address = 0;
    std::uint64_t number = 0;     ///< transfers_ after its start
    std::vector<std::byte> copy;  ///< puts: the source at the call; gets from writable memory: what arrived
  };

  Status start(std::byte* local, MainAddress address, std::uint32_t bytes, Tag tag, bool is_get);
  Status check_rules(const std::byte* local, std::uint64_t address, std::uint32_t bytes, Tag tag, bool is_get);
  Status check_overlap(const std::byte* local, std::uint64_t address, std::uint32_t bytes, Tag tag, bool is_get);
  Status use_spill(const std::byte* local, std::uint64_t address, std::uint32_t bytes, Tag tag, bool is_get);
  Status violate(Status rule, std::uint32_t tile, std::string detail);
  void record_error(Status status, std::uint32_t tile);
  [[nodiscard]] std::string describe_local(std::uintptr_t local) const;
  [[nodiscard]] std::string describe(bool is_get, const std::byte* local, std::uint64_t address, std::uint32_t bytes,
                                     std::uint32_t tag) const;
  [[nodiscard]] std::string describe(const Pending& pending) const;
  void copy_bytes(Pending& pending);
  Status move_bytes(Pending& pending);
  void move_some();
  Status complete(Pending& pending);
  Status check_untouched(const Pending& pending);
  bool meets_writable(std::uint64_t address, std::uint32_t bytes) const;
  void note_footprint(std::uint64_t address, std::uint32_t bytes, bool is_get);
  void mark(const Pending& pending);
  void unmark(Pending& pending);
  [[nodiscard]] bool meets_spill(std::uint64_t address, std::uint32_t bytes) const;
  [[nodiscard]] bool is_own_spill(std::uint64_t address, std::uint32_t bytes) const;
  void leave_tile();
  std::uint64_t next_random();
  [[nodiscard]] std::pair<std::uint8_t, bool> traced_tag(std::uint32_t tag) const;
  void trace_transfer(EventKind kind, Tag tag, std::uint32_t bytes, std::uint64_t address);
  void bad_access(std::uintptr_t address, std::uintptr_t bytes, bool is_store, std::uintptr_t code, const char* what);

  SimFrame* frame_;
  std::uint32_t core_;
  std::span<std::byte> arena_;
  std::vector<Pending> pending_;  ///< queue_depth slots
  std::uint32_t pending_count_ = 0;
  std::uint32_t tile_id_ = kNoTile;
  std::uint32_t tile_ordinal_ = 0;  ///< tiles begun before the current one
  bool in_tile_ = false;
  bool after_last_tile_ = false;
  std::uint8_t stage_ = 0;                 ///< Stage
  std::uint32_t claims_ = 1;               ///< plus one
  std::vector<std::uint32_t> spill_puts_;  ///< per 16 bytes of the slice: claims_ when they were put last
  std::uint64_t transfers_ = 0;
  std::uint64_t random_state_ = 0;
  std::array<std::uint32_t, kWorkKindCount> last_counts_{};
  std::array<WorkAmount, kWorkKindCount> new_work_{};  // of one note_work
  std::unique_ptr<TraceWriter> writer_;  ///< of the current tile, prologue or epilogue
  bool is_trace_ended_ = false;
  Status first_error_ = Status::kOk;
  std::uint32_t first_error_tile_ = kNoTile;
  Status sticky_error_ = Status::kOk;  ///< found where no status could be returned; every later call returns it
  std::vector<Violation> violations_;
  std::vector<std::uint8_t> granule_state_;  ///< per 16 bytes of arena: is a transfer in flight there?
  std::vector<std::uintptr_t> bad_code_;     ///< instructions whose bad access was recorded
  std::uintptr_t stack_bottom_ = 0, stack_top_ = 0;
};

static_assert(Platform<SimCore>);
static_assert(WorkObserver<SimCore>);
static_assert(StageObserver<SimCore>);

/// Checks that no tile put to bytes that another tile put or got. The result depends on the footprints only, not on the
/// order in which tiles were rendered.
[[nodiscard]] std::vector<Violation> check_across_tiles(std::span<const TileFootprint> footprints);

}  // namespace gridiron::sim
