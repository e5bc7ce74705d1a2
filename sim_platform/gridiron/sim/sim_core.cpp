// One simulated core in checked mode; see the header. Here: the bytes of transfers, claims and the trace.
// Memory: borrows arena and main memory; own book-keeping in std::vector. Threads: one per object.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/dma/tags.h>
#include <gridiron/sim/byte_ranges.h>
#include <gridiron/sim/sim_core.h>
#include <gridiron/sim/trace_packing.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <iterator>
#include <tuple>
#include <utility>

namespace gridiron::sim {

static_assert(kFirstRotatingTag == kFirstOutputTag);

namespace {

// A poisoned float is a NaN and a poisoned index is far out of any range.
constexpr std::byte kPoison[2] = {std::byte{0xA5}, std::byte{0xFF}};

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

// --- Bytes ------------------------------------------------------------------------------------------------------

Status SimCore::get(void* local, MainAddress address, std::uint32_t bytes, Tag tag) {
  return start(static_cast<std::byte*>(local), address, bytes, tag, true);
}

Status SimCore::put(const void* local, MainAddress address, std::uint32_t bytes, Tag tag) {
  // The source is only ever read; one member serves both directions.
  return start(const_cast<std::byte*>(static_cast<const std::byte*>(local)), address, bytes, tag, false);
}

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
  mark(pending);

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

  TraceEvent event{.kind = EventKind::kWait};
  for (std::uint32_t left = tags.bits; left != 0; left &= left - 1) {
    const auto tag = static_cast<std::uint32_t>(std::countr_zero(left));
    const auto [traced, rotating] = traced_tag(tag);
    (rotating ? event.rotating_tags : event.tags) |= 1u << traced;
  }
  writer_->add(event);

  Status status = sticky_error_;
  const std::size_t slots = pending_.size();
  const std::size_t first = frame_->completion == Completion::kRandom ? next_random() % slots : 0;
  for (std::size_t i = 0; i < slots; ++i) {
    Pending& pending = pending_[first + i < slots ? first + i : first + i - slots];
    if (!pending.in_use || (tags.bits >> pending.tag & 1) == 0) continue;
    const Status ended = complete(pending);
    if (status == Status::kOk) status = ended;
  }
  return status;
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
  frame_->tiles->item_done();
}

ItemClaim SimCore::claim_item() {
  if (!after_last_tile_) {
    static_cast<void>(end_trace());
    is_trace_ended_ = false;
  }
  leave_tile();
  ++claims_;
  ItemClaim claim = sticky_error_ == Status::kOk ? frame_->tiles->claim() : ItemClaim{ItemClaim::Kind::kAborted, 0};
  if (claim.kind == ItemClaim::Kind::kItem) {
    in_tile_ = true;
    tile_id_ = claim.item;
    stage_ = 0;
    random_state_ = frame_->seed ^ (0xD1B54A32D192ED03u * (std::uint64_t{claim.item} + 1));
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
  constexpr std::uint32_t kKindsAtOnce = 8;
  // Of as many as a compiler compares without a loop or a call.
  const auto are_equal = [](const std::uint32_t* a, const std::uint32_t* b) {
    std::uint32_t difference = 0;
    for (std::uint32_t i = 0; i < kKindsAtOnce; ++i) difference |= a[i] ^ b[i];
    return difference == 0;
  };
  std::uint32_t done = 0;
  const std::uint32_t known = std::min(count, kWorkKindCount);
  for (std::uint32_t first = 0; first < known; first += kKindsAtOnce) {
    const std::uint32_t end = std::min(first + kKindsAtOnce, known);
    // From one call to the next few kinds change.
    if (end - first == kKindsAtOnce && are_equal(counts + first, &last_counts_[first])) continue;
    for (std::uint32_t kind = first; kind < end; ++kind) {
      const std::uint32_t amount = counts[kind] - last_counts_[kind];
      if (amount == 0) continue;
      new_work_[done++] = {WorkId(kind), amount};
      last_counts_[kind] = counts[kind];
      if (in_tile_) tile_work[kind] += amount;
    }
  }
  writer_->add({.kind = EventKind::kWork, .work = std::span(new_work_).first(done)});
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

/// In the trace, output tags are relative to the tile, all others as they are. @returns the tag, and whether it is one.
std::pair<std::uint8_t, bool> SimCore::traced_tag(std::uint32_t tag) const {
  const std::uint32_t depth = frame_->output_depth;
  if (tag < kFirstRotatingTag || tag - kFirstRotatingTag >= depth) return {static_cast<std::uint8_t>(tag), false};
  return {static_cast<std::uint8_t>((tag - kFirstRotatingTag + depth - tile_ordinal_ % depth) % depth), true};
}

void SimCore::trace_transfer(EventKind kind, Tag tag, std::uint32_t bytes, std::uint64_t address) {
  TraceEvent event{.kind = kind};
  event.bytes = bytes;
  event.address = is_own_spill(address, bytes) ? address - core_ * frame_->spill.slice_bytes() : address;
  std::tie(event.tag, event.rotating) = traced_tag(tag.index);
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

}  // namespace gridiron::sim
