// One simulated core in checked mode; see the header. Sections: rules, bytes, claims and trace, instrumentation.
// Memory: borrows arena and main memory; own book-keeping in std::vector. Threads: one per object.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/dma/tags.h>
#include <gridiron/sim/sim_core.h>
#include <gridiron/sim/trace_packing.h>
#include <link.h>
#include <pthread.h>

#include <algorithm>
#include <cinttypes>
#include <cstdio>
#include <cstring>
#include <iterator>
#include <tuple>
#include <utility>

namespace gridiron::sim {

static_assert(kFirstRotatingTag == kFirstOutputTag);

namespace {

// A poisoned float is a NaN and a poisoned index is far out of any range.
constexpr std::byte kPoison[2] = {std::byte{0xA5}, std::byte{0xFF}};

constexpr std::uint32_t kGranuleBytes = 16;
constexpr std::uint8_t kFree = 0, kGetInFlight = 1, kPutInFlight = 2;

// A stray loop makes millions of bad accesses; the first few say it all.
constexpr std::size_t kMaxViolations = 16;

[[nodiscard]] bool overlap(std::uint64_t a, std::uint64_t a_bytes, std::uint64_t b, std::uint64_t b_bytes) {
  return a < b + b_bytes && b < a + a_bytes;
}

[[nodiscard]] std::uint64_t address_of(const std::byte* local) {
  return reinterpret_cast<std::uintptr_t>(local);
}

[[nodiscard]] std::string hex(std::uint64_t value) {
  char text[24];
  std::snprintf(text, sizeof text, "0x%" PRIx64, value);
  return text;
}

void add_range(std::vector<MainRange>& ranges, std::uint64_t begin, std::uint64_t end) {
  if (!ranges.empty() && ranges.back().end == begin) {
    ranges.back().end = end;
  } else {
    ranges.push_back({begin, end});
  }
}

thread_local SimCore* current_core = nullptr;

}  // namespace

SimCore::SimCore(SimFrame& frame, std::uint32_t core, std::span<std::byte> arena)
    : frame_(&frame), core_(core), arena_(arena), pending_(std::max(frame.limits.queue_depth, 1u)) {
  prologue.tile_id = kNoTile;
  epilogue.tile_id = kNoTile;
  writer_ = std::make_unique<TraceWriter>();
  random_state_ = frame.seed ^ 0x9E3779B97F4A7C15u;
  spill_puts_.assign(frame.spill.slice_bytes() / kGranuleBytes, 0);
}

SimCore::~SimCore() = default;

PlatformLimits SimCore::limits() const {
  return frame_->limits;
}

SpillRegion SimCore::spill() const {
  const std::uint64_t bytes = frame_->spill.slice_bytes();
  return bytes == 0 ? SpillRegion{} : SpillRegion{frame_->spill.address.offset_by(core_ * bytes), bytes};
}

// --- Rules ------------------------------------------------------------------------------------------------------

Status SimCore::get(void* local, MainAddress address, std::uint32_t bytes, Tag tag) {
  return start(static_cast<std::byte*>(local), address, bytes, tag, true);
}

Status SimCore::put(const void* local, MainAddress address, std::uint32_t bytes, Tag tag) {
  // The source is only ever read; one member serves both directions.
  return start(const_cast<std::byte*>(static_cast<const std::byte*>(local)), address, bytes, tag, false);
}

Status SimCore::check_rules(const std::byte* local, std::uint64_t address, std::uint32_t bytes, Tag tag, bool is_get) {
  const PlatformLimits& limits = frame_->limits;
  const auto broken = [&](Status rule, const std::string& why) {
    return violate(rule, tile_id_, describe(is_get, local, address, bytes, tag.index) + ": " + why);
  };
  if (bytes == 0) return broken(Status::kTransferSize, "the size is 0");
  if (bytes > limits.max_transfer_bytes) {
    return broken(Status::kTransferSize, "the size is above " + std::to_string(limits.max_transfer_bytes));
  }
  if (limits.alignment_bytes > 1 && bytes % limits.alignment_bytes != 0) {
    return broken(Status::kTransferSize, "the size is not a multiple of " + std::to_string(limits.alignment_bytes));
  }
  if (tag.index >= limits.tag_count) {
    return broken(Status::kTransferTag, "there are " + std::to_string(limits.tag_count) + " tags");
  }
  const std::uint64_t local_address = address_of(local);
  if (limits.alignment_bytes > 1) {
    const std::string multiple = " is not a multiple of " + std::to_string(limits.alignment_bytes);
    if (local_address % limits.alignment_bytes != 0) {
      return broken(Status::kTransferAlignment, "the local address" + multiple);
    }
    if (address % limits.alignment_bytes != 0) return broken(Status::kTransferAlignment, "the main address" + multiple);
  }
  if (limits.congruence_bytes > 1 && local_address % limits.congruence_bytes != address % limits.congruence_bytes) {
    return broken(Status::kTransferAlignment,
                  "the ends are not congruent modulo " + std::to_string(limits.congruence_bytes));
  }
  if (limits.boundary_bytes != 0 && address % limits.boundary_bytes + bytes > limits.boundary_bytes) {
    return broken(Status::kTransferBoundary,
                  "the main side crosses a multiple of " + std::to_string(limits.boundary_bytes));
  }
  const std::uint64_t arena_begin = address_of(arena_.data());
  if (local_address < arena_begin || local_address - arena_begin > arena_.size() ||
      bytes > arena_.size() - (local_address - arena_begin)) {
    return broken(Status::kTransferLocalRange,
                  "the local side is not inside the arena of " + std::to_string(arena_.size()) + " bytes");
  }
  if (frame_->memory->bytes_at(MainAddress{address}, bytes).empty()) {
    return broken(Status::kTransferMainRange, "the main side is not inside allocated memory");
  }
  if (meets_spill(address, bytes)) {
    if (!is_own_spill(address, bytes)) {
      return broken(Status::kTransferMainRange, "the main side is not inside the core's own slice of spill memory");
    }
  } else if (!is_get) {
    const auto& writable = frame_->writable;
    const auto inside = [&](const MainRange& range) { return range.begin <= address && address + bytes <= range.end; };
    if (std::none_of(writable.begin(), writable.end(), inside)) {
      return broken(Status::kTransferMainRange, "the main side is not inside memory that the frame may write");
    }
  }
  if (pending_count_ == pending_.size()) {
    return broken(Status::kTransferQueueFull, std::to_string(pending_count_) + " commands are pending already");
  }
  GRIDIRON_TRY(check_overlap(local, address, bytes, tag, is_get));
  return is_own_spill(address, bytes) ? use_spill(local, address, bytes, tag, is_get) : Status::kOk;
}

bool SimCore::meets_spill(std::uint64_t address, std::uint32_t bytes) const {
  const std::uint64_t all_bytes = frame_->spill.slice_bytes() * frame_->core_count;
  return all_bytes != 0 && overlap(frame_->spill.address.value, all_bytes, address, bytes);
}

bool SimCore::is_own_spill(std::uint64_t address, std::uint32_t bytes) const {
  const SpillRegion own = spill();
  return own.bytes != 0 && own.address.value <= address && address + bytes <= own.address.value + own.bytes;
}

/// An earlier tile's bytes depend on the host's timing, so no tile may read them.
Status SimCore::use_spill(const std::byte* local, std::uint64_t address, std::uint32_t bytes, Tag tag, bool is_get) {
  const std::uint64_t offset = address - spill().address.value;
  const std::uint64_t end = (offset + bytes + kGranuleBytes - 1) / kGranuleBytes;
  for (std::uint64_t granule = offset / kGranuleBytes; granule < end; ++granule) {
    if (!is_get) {
      spill_puts_[granule] = claims_;
    } else if (spill_puts_[granule] != claims_) {
      return violate(Status::kTransferMainRange, tile_id_,
                     describe(is_get, local, address, bytes, tag.index) + ": the tile has not put byte " +
                         std::to_string(std::max(offset, granule * kGranuleBytes) - offset) + " of it to spill memory");
    }
  }
  return Status::kOk;
}

Status SimCore::check_overlap(const std::byte* local, std::uint64_t address, std::uint32_t bytes, Tag tag,
                              bool is_get) {
  for (const Pending& other : pending_) {
    if (!other.in_use) continue;
    // A get writes the local side and reads the main side, a put the other way round.
    const bool local_conflict =
        (is_get || other.is_get) && overlap(address_of(local), bytes, address_of(other.local), other.bytes);
    const bool main_conflict = (!is_get || !other.is_get) && overlap(address, bytes, other.address, other.bytes);
    if (!local_conflict && !main_conflict) continue;
    return violate(Status::kTransferOverlap, tile_id_,
                   describe(is_get, local, address, bytes, tag.index) + ": overlaps, on the " +
                       (local_conflict ? "local" : "main") + " side, the pending " + describe(other));
  }
  return Status::kOk;
}

Status SimCore::violate(Status rule, std::uint32_t tile, std::string detail) {
  if (violations_.size() < kMaxViolations) violations_.push_back({rule, core_, tile, std::move(detail)});
  record_error(rule, tile);
  return rule;
}

void SimCore::record_error(Status status, std::uint32_t tile) {
  if (first_error_ != Status::kOk) return;
  first_error_ = status;
  first_error_tile_ = tile;
}

std::string SimCore::describe_local(std::uintptr_t local) const {
  const std::uintptr_t begin = reinterpret_cast<std::uintptr_t>(arena_.data());
  // Host addresses differ from run to run, distances from the arena do not.
  constexpr std::uintptr_t kNear = std::uintptr_t{1} << 20;
  if (local >= begin && local - begin <= arena_.size() + kNear) return "arena+" + hex(local - begin);
  if (local < begin && begin - local <= kNear) return "arena-" + hex(begin - local);
  return "an address far from the arena";
}

std::string SimCore::describe(bool is_get, const std::byte* local, std::uint64_t address, std::uint32_t bytes,
                              std::uint32_t tag) const {
  return std::string(is_get ? "get" : "put") + " of " + std::to_string(bytes) + " bytes, local " +
         describe_local(reinterpret_cast<std::uintptr_t>(local)) + ", main " + hex(address) + ", tag " +
         std::to_string(tag);
}

std::string SimCore::describe(const Pending& pending) const {
  return describe(pending.is_get, pending.local, pending.address, pending.bytes, pending.tag);
}

// --- Bytes ------------------------------------------------------------------------------------------------------

Status SimCore::start(std::byte* local, MainAddress address, std::uint32_t bytes, Tag tag, bool is_get) {
  if (sticky_error_ != Status::kOk) return sticky_error_;
  move_some();
  GRIDIRON_TRY(check_rules(local, address.value, bytes, tag, is_get));

  Pending& pending = *std::find_if(pending_.begin(), pending_.end(), [](const Pending& p) { return !p.in_use; });
  ++pending_count_;
  ++transfers_;
  pending.in_use = true;
  pending.is_get = is_get;
  pending.arrived = false;
  pending.fails = frame_->transfers_started.fetch_add(1, std::memory_order_relaxed) + 1 == frame_->fail_transfer;
  pending.tag = tag.index;
  pending.bytes = bytes;
  pending.tile_id = tile_id_;
  pending.local = local;
  pending.address = address.value;
  pending.number = transfers_;
  trace_transfer(is_get ? EventKind::kGet : EventKind::kPut, tag, bytes, address.value);
  note_footprint(address.value, bytes, is_get);
  mark(pending, is_get ? kGetInFlight : kPutInFlight);

  if (!is_get) pending.copy.assign(local, local + bytes);
  if (is_get && (frame_->completion != Completion::kEarly || pending.fails)) {
    for (std::uint32_t i = 0; i < bytes; ++i) local[i] = kPoison[i & 1];
  }
  if (frame_->completion == Completion::kEarly && !pending.fails) {
    copy_bytes(pending);
  }
  return Status::kOk;
}

void SimCore::copy_bytes(Pending& pending) {
  std::byte* const main = frame_->memory->base() + pending.address;
  // Cores of a wrong program may write the same bytes, which must not become a data race of the host.
  std::unique_lock lock(frame_->writable_bytes, std::defer_lock);
  if (meets_writable(pending.address, pending.bytes)) lock.lock();
  std::memcpy(pending.is_get ? pending.local : main, pending.is_get ? main : pending.local, pending.bytes);
  pending.arrived = true;
  // What has arrived from memory that other cores may write cannot be looked up again.
  if (pending.is_get && lock.owns_lock()) pending.copy.assign(pending.local, pending.local + pending.bytes);
}

Status SimCore::move_bytes(Pending& pending) {
  Status status = Status::kOk;
  if (pending.is_get) {
    for (std::uint32_t i = 0; i < pending.bytes; ++i) {
      if (pending.local[i] == kPoison[i & 1]) continue;
      status = violate(
          Status::kTransferOverlap, pending.tile_id,
          describe(pending) + ": the core wrote to byte " + std::to_string(i) + " of the destination before the wait");
      break;
    }
  }
  // What a source holds now is what goes out, as on a chip whose transfers run late.
  copy_bytes(pending);
  return status;
}

void SimCore::move_some() {
  if (frame_->completion != Completion::kRandom || pending_count_ == 0) return;
  const std::size_t slots = pending_.size();
  const std::uint64_t choice = next_random();
  for (std::size_t i = 0; i < slots; ++i) {
    Pending& pending = pending_[(i + choice) % slots];
    if (!pending.in_use || pending.arrived || pending.fails || (next_random() & 1) != 0) continue;
    if (move_bytes(pending) != Status::kOk && sticky_error_ == Status::kOk) sticky_error_ = first_error_;
  }
}

bool SimCore::move_now(std::uint64_t transfer) {
  for (Pending& pending : pending_) {
    if (!pending.in_use || pending.number != transfer) continue;
    if (pending.arrived || pending.fails) return false;
    if (move_bytes(pending) != Status::kOk && sticky_error_ == Status::kOk) sticky_error_ = first_error_;
    return true;
  }
  return false;
}

Status SimCore::check_untouched(const Pending& pending) {
  const std::byte* expected = nullptr;
  if (!pending.is_get || (pending.arrived && meets_writable(pending.address, pending.bytes))) {
    expected = pending.copy.data();
  } else if (pending.arrived) {
    expected = frame_->memory->base() + pending.address;
  }
  if (expected == nullptr || std::memcmp(expected, pending.local, pending.bytes) == 0) return Status::kOk;
  const auto difference = std::mismatch(expected, expected + pending.bytes, pending.local).first - expected;
  return violate(Status::kTransferOverlap, pending.tile_id,
                 describe(pending) + ": the core changed byte " + std::to_string(difference) + " of the " +
                     (pending.is_get ? "destination" : "source") + " before the wait");
}

Status SimCore::complete(Pending& pending) {
  Status status = Status::kOk;
  if (pending.fails) {
    record_error(Status::kTransferFailed, pending.tile_id);
    status = Status::kTransferFailed;
  } else {
    // The order matters: a changed source is detected by its copy, a late get by the poison.
    status = check_untouched(pending);
    if (!pending.arrived) {
      const Status moved = move_bytes(pending);
      if (status == Status::kOk) status = moved;
    }
  }
  unmark(pending);
  pending.in_use = false;
  --pending_count_;
  return status;
}

Status SimCore::wait(TagMask tags) {
  if (sticky_error_ != Status::kOk) return sticky_error_;
  move_some();
  const std::uint32_t tag_count = frame_->limits.tag_count;
  if (tag_count < 32 && (tags.bits >> tag_count) != 0) {
    return violate(Status::kTransferTag, tile_id_,
                   "wait for tags " + hex(tags.bits) + ": there are " + std::to_string(tag_count) + " tags");
  }

  // Trace: output tags relative to the tile, all others as they are.
  TraceEvent event{.kind = EventKind::kWait};
  for (std::uint32_t tag = 0; tag < 32; ++tag) {
    if ((tags.bits >> tag & 1) == 0) continue;
    const std::uint32_t depth = frame_->output_depth;
    if (tag >= kFirstRotatingTag && tag - kFirstRotatingTag < depth) {
      const std::uint32_t slot = tag - kFirstRotatingTag;
      event.rotating_tags |= 1u << ((slot + depth - tile_ordinal_ % depth) % depth);
    } else {
      event.tags |= 1u << tag;
    }
  }
  writer_->add(event);

  Status status = sticky_error_;
  const std::size_t slots = pending_.size();
  const std::uint64_t choice = frame_->completion == Completion::kRandom ? next_random() : 0;
  for (std::size_t i = 0; i < slots; ++i) {
    Pending& pending = pending_[(i + choice) % slots];
    if (!pending.in_use || (tags.bits >> pending.tag & 1) == 0) continue;
    const Status ended = complete(pending);
    if (status == Status::kOk) status = ended;
  }
  return status;
}

bool SimCore::meets_writable(std::uint64_t address, std::uint32_t bytes) const {
  return std::any_of(frame_->writable.begin(), frame_->writable.end(), [&](const MainRange& range) {
    return overlap(range.begin, range.end - range.begin, address, bytes);
  });
}

void SimCore::note_footprint(std::uint64_t address, std::uint32_t bytes, bool is_get) {
  if (!meets_writable(address, bytes)) return;
  if (footprints.empty() || footprints.back().tile_id != tile_id_) footprints.push_back({tile_id_, core_, {}, {}});
  TileFootprint& footprint = footprints.back();
  add_range(is_get ? footprint.gets : footprint.puts, address, address + bytes);
}

std::uint64_t SimCore::next_random() {
  // splitmix64 (Steele, Lea, Flood 2014): a counter and a mix.
  random_state_ += 0x9E3779B97F4A7C15u;
  std::uint64_t z = random_state_;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
  return z ^ (z >> 31);
}

// --- Claims and trace -------------------------------------------------------------------------------------------

void SimCore::leave_tile() {
  if (!in_tile_) return;
  in_tile_ = false;
  ++tile_ordinal_;
  frame_->tiles->tile_done();
}

TileClaim SimCore::claim_tile() {
  if (!after_last_tile_) {
    static_cast<void>(end_trace());
    is_trace_ended_ = false;
  }
  leave_tile();
  ++claims_;
  TileClaim claim = sticky_error_ == Status::kOk ? frame_->tiles->claim() : TileClaim{TileClaim::Kind::kAborted, 0};
  if (claim.kind == TileClaim::Kind::kTile) {
    in_tile_ = true;
    tile_id_ = claim.tile_id;
    stage_ = 0;
    random_state_ = frame_->seed ^ (0xD1B54A32D192ED03u * (std::uint64_t{claim.tile_id} + 1));
  } else {
    tile_id_ = kNoTile;
    stage_ = 0;
    after_last_tile_ = true;
  }
  return claim;
}

const TileTrace& SimCore::end_trace() {
  if (after_last_tile_) {
    if (!is_trace_ended_) epilogue = writer_->finish(kNoTile);
    is_trace_ended_ = true;
    return epilogue;
  }
  if (!is_trace_ended_) {
    if (in_tile_) {
      traces.push_back(writer_->finish(tile_id_));
    } else {
      prologue = writer_->finish(kNoTile);
    }
  }
  is_trace_ended_ = true;
  return in_tile_ ? traces.back() : prologue;
}

void SimCore::note_work(const std::uint32_t* counts, std::uint32_t count) {
  std::array<WorkAmount, kWorkKindCount> work;
  std::uint32_t done = 0;
  const std::uint32_t known = std::min(count, kWorkKindCount);
  for (std::uint32_t kind = 0; kind < known; ++kind) {
    const std::uint32_t amount = counts[kind] - last_counts_[kind];
    if (amount == 0) continue;
    work[done++] = {static_cast<Work>(kind), amount};
    last_counts_[kind] = counts[kind];
    if (in_tile_) tile_work[kind] += amount;
  }
  writer_->add({.kind = EventKind::kWork, .work = std::span(work).first(done)});
}

void SimCore::note_stage(std::uint8_t stage) {
  if (stage == stage_) return;
  if (stage >= kStageCount) {
    const Status status = violate(Status::kBadParameter, tile_id_, "there is no stage " + std::to_string(stage));
    if (sticky_error_ == Status::kOk) sticky_error_ = status;
    return;
  }
  stage_ = stage;
  writer_->add({.kind = EventKind::kStage, .stage = static_cast<Stage>(stage)});
}

void SimCore::trace_transfer(EventKind kind, Tag tag, std::uint32_t bytes, std::uint64_t address) {
  TraceEvent event{.kind = kind};
  event.tag = tag.index;
  event.bytes = bytes;
  event.address = is_own_spill(address, bytes) ? address - core_ * frame_->spill.slice_bytes() : address;
  const std::uint32_t depth = frame_->output_depth;
  if (tag.index >= kFirstRotatingTag && tag.index - kFirstRotatingTag < depth) {
    const std::uint32_t slot = tag.index - kFirstRotatingTag;
    event.tag = static_cast<std::uint8_t>((slot + depth - tile_ordinal_ % depth) % depth);
    event.rotating = true;
  }
  writer_->add(event);
}

void SimCore::finish(bool clean) {
  static_cast<void>(end_trace());
  for (Pending& pending : pending_) {
    if (!pending.in_use) continue;
    if (clean) {
      static_cast<void>(
          violate(Status::kTransferPending, pending.tile_id, describe(pending) + ": was never waited for"));
    }
    static_cast<void>(complete(pending));
  }
}

std::vector<Violation> check_across_tiles(std::span<const TileFootprint> footprints) {
  struct Interval {
    std::uint64_t begin, end;
    std::uint64_t owner;  // tile, or the core for what lies outside any tile
    bool is_put;
    const TileFootprint* footprint;
  };
  std::vector<Interval> intervals;
  for (const TileFootprint& footprint : footprints) {
    const std::uint64_t owner =
        footprint.tile_id == kNoTile ? (std::uint64_t{1} << 32) + footprint.core : footprint.tile_id;
    for (const MainRange& range : footprint.gets)
      intervals.push_back({range.begin, range.end, owner, false, &footprint});
    for (const MainRange& range : footprint.puts)
      intervals.push_back({range.begin, range.end, owner, true, &footprint});
  }
  const auto key = [](const Interval& i) { return std::tuple(i.begin, i.end, i.owner, i.is_put); };
  std::sort(intervals.begin(), intervals.end(), [&](const Interval& a, const Interval& b) { return key(a) < key(b); });

  // Sweep over rising begins. Of the intervals seen, only the one that reaches furthest can matter, and, where that
  // belongs to the same owner, the one that reaches furthest among all other owners.
  struct Reach {
    const Interval* first = nullptr;
    const Interval* other = nullptr;

    void add(const Interval& interval) {
      if (first == nullptr || interval.owner == first->owner) {
        if (first == nullptr || interval.end > first->end) first = &interval;
      } else if (interval.end > first->end) {
        other = std::exchange(first, &interval);
      } else if (other == nullptr || interval.end > other->end) {
        other = &interval;
      }
    }
    [[nodiscard]] const Interval* hit(const Interval& interval) const {
      const Interval* candidate = first != nullptr && first->owner == interval.owner ? other : first;
      return candidate != nullptr && candidate->end > interval.begin ? candidate : nullptr;
    }
  };
  std::vector<Violation> violations;
  Reach puts, gets;
  for (const Interval& interval : intervals) {
    const Interval* clash = puts.hit(interval);
    if (clash == nullptr && interval.is_put) clash = gets.hit(interval);
    if (clash != nullptr && violations.size() < kMaxViolations) {
      const auto name = [](const Interval& i) {
        const std::string who = i.footprint->tile_id == kNoTile ? "core " + std::to_string(i.footprint->core)
                                                                : "tile " + std::to_string(i.footprint->tile_id);
        return who + (i.is_put ? " puts" : " gets") + " main " + hex(i.begin) + ".." + hex(i.end);
      };
      // The core that rendered a tile depends on the host, so it is not reported.
      const bool in_tile = interval.footprint->tile_id != kNoTile;
      violations.push_back({Status::kTransferOverlap, in_tile ? 0 : interval.footprint->core,
                            interval.footprint->tile_id, name(interval) + ", " + name(*clash)});
    }
    (interval.is_put ? puts : gets).add(interval);
  }
  return violations;
}

// --- Instrumentation --------------------------------------------------------------------------------------------

namespace {

// Read-only data of the program and its libraries, and where the program itself was loaded.
struct ReadOnlyData {
  std::vector<std::pair<std::uintptr_t, std::uintptr_t>> ranges;
  std::uintptr_t load_address = 0;

  ReadOnlyData() {
    dl_iterate_phdr(
        [](dl_phdr_info* info, std::size_t, void* self) {
          auto& data = *static_cast<ReadOnlyData*>(self);
          if (data.ranges.empty()) data.load_address = info->dlpi_addr;
          for (int i = 0; i < info->dlpi_phnum; ++i) {
            const auto& header = info->dlpi_phdr[i];
            const bool constant = header.p_type == PT_LOAD && (header.p_flags & PF_W) == 0;
            if (!constant && header.p_type != PT_GNU_RELRO) continue;
            const std::uintptr_t begin = info->dlpi_addr + header.p_vaddr;
            data.ranges.emplace_back(begin, begin + header.p_memsz);
          }
          return 0;
        },
        this);
  }
};

const ReadOnlyData& read_only_data() {
  static const ReadOnlyData data;
  return data;
}

std::uintptr_t stack_bottom() {
  pthread_attr_t attributes;
  void* address = nullptr;
  std::size_t bytes = 0;
  if (pthread_getattr_np(pthread_self(), &attributes) != 0) return 0;
  pthread_attr_getstack(&attributes, &address, &bytes);
  pthread_attr_destroy(&attributes);
  return reinterpret_cast<std::uintptr_t>(address);
}

}  // namespace

SimCore::AccessScope::AccessScope(SimCore& core, const void* stack_top) : outer_(current_core) {
  static_cast<void>(read_only_data());
  core.granule_state_.assign(core.arena_.size() / kGranuleBytes + 1, kFree);
  core.stack_bottom_ = stack_bottom();
  core.stack_top_ = reinterpret_cast<std::uintptr_t>(stack_top);
  current_core = &core;
}

SimCore::AccessScope::~AccessScope() {
  current_core = outer_;
}

void SimCore::mark(const Pending& pending, std::uint8_t state) {
  if (granule_state_.empty()) return;
  const auto offset = static_cast<std::size_t>(pending.local - arena_.data());
  const std::size_t first = offset / kGranuleBytes;
  const std::size_t end = (offset + pending.bytes + kGranuleBytes - 1) / kGranuleBytes;
  for (std::size_t i = first; i < end; ++i) granule_state_[i] = state;
}

void SimCore::unmark(const Pending& pending) {
  if (granule_state_.empty()) return;
  mark(pending, kFree);
  // Sources of two puts may share granules, and small transfers too.
  for (const Pending& other : pending_) {
    if (other.in_use && &other != &pending) mark(other, other.is_get ? kGetInFlight : kPutInFlight);
  }
}

void SimCore::bad_access(std::uintptr_t address, std::uintptr_t bytes, bool is_store, std::uintptr_t code,
                         const char* what) {
  // A loop repeats itself; each instruction is reported once.
  if (std::find(bad_code_.begin(), bad_code_.end(), code) != bad_code_.end()) return;
  if (bad_code_.size() == kMaxViolations / 2) return;
  bad_code_.push_back(code);
  sticky_error_ = violate(Status::kBadAccess, tile_id_,
                          std::string(is_store ? "store" : "load") + " of " + std::to_string(bytes) + " bytes at " +
                              describe_local(address) + ": " + what + " (instruction " +
                              hex(code - read_only_data().load_address) + ")");
}

void SimCore::check_access(std::uintptr_t address, std::uintptr_t bytes, bool is_store, std::uintptr_t code) {
  SimCore* const core = current_core;
  if (core == nullptr || bytes == 0) return;
  const std::uintptr_t arena = reinterpret_cast<std::uintptr_t>(core->arena_.data());
  const std::size_t arena_bytes = core->arena_.size();
  const std::uintptr_t offset = address - arena;
  if (offset < arena_bytes && bytes <= arena_bytes - offset) {
    const std::size_t first = offset / kGranuleBytes;
    const std::size_t last = (offset + bytes - 1) / kGranuleBytes;
    for (std::size_t i = first; i <= last; ++i) {
      if (core->granule_state_[i] == kFree) continue;
      // A granule can be larger than a transfer: ask the transfers themselves.
      for (const Pending& pending : core->pending_) {
        if (!pending.in_use || !(pending.is_get || is_store)) continue;
        if (!overlap(address, bytes, address_of(pending.local), pending.bytes)) continue;
        core->bad_access(address, bytes, is_store, code,
                         pending.is_get ? "destination of a get that was not waited for"
                                        : "source of a put that was not waited for");
        return;
      }
    }
    return;
  }
  if (address >= core->stack_bottom_ && address < core->stack_top_ && bytes <= core->stack_top_ - address) return;
  if (!is_store) {
    for (const auto& [begin, end] : read_only_data().ranges) {
      if (address >= begin && address < end && bytes <= end - address) return;
    }
  }
  core->bad_access(address, bytes, is_store, code, "outside the arena, the stack and constant data");
}

}  // namespace gridiron::sim
