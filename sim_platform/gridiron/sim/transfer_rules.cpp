// The rules that a call of SimCore must keep, in the order that its header states, and how a breach is reported.
// Memory: borrowed. Threads: one per core. SPDX-License-Identifier: Apache-2.0
#include <gridiron/sim/byte_ranges.h>
#include <gridiron/sim/sim_core.h>

#include <algorithm>
#include <utility>

namespace gridiron::sim {

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

/// What an earlier tile left behind depends on the host's timing, so no tile may look at it.
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

}  // namespace gridiron::sim
