// Turns of cores. SPDX-License-Identifier: Apache-2.0
#include <gridiron/bvh/claim_order.h>

namespace gridiron::bvh {

bool ClaimOrder::is_next(std::uint32_t core) const {
  for (std::uint32_t other = 0; other < turns_.size(); ++other) {
    if (other == core || turns_[other].state == State::kLeft) continue;
    if (turns_[other].state == State::kRunning) return false;
    if (turns_[other].now < turns_[core].now) return false;
    if (turns_[other].now == turns_[core].now && other < core) return false;
  }
  return true;
}

void ClaimOrder::wait_for_turn(std::uint32_t core, CoreClock::Ticks now) {
  std::unique_lock lock(mutex_);
  turns_[core] = {State::kWaiting, now};
  changed_.notify_all();
  changed_.wait(lock, [&] { return is_next(core); });
  turns_[core].state = State::kRunning;
}

void ClaimOrder::leave(std::uint32_t core) {
  const std::scoped_lock lock(mutex_);
  turns_[core].state = State::kLeft;
  changed_.notify_all();
}

ItemClaim OrderedCore::claim_item() {
  // The core's steps since its last claim.
  const sim::TileTrace& trace = inner_.end_trace();
  clock_.take(trace, in_tile_ ? tiles_++ : 0);
  order_.wait_for_turn(index_, clock_.now());
  const ItemClaim claim = inner_.claim_item();
  clock_.take_claim();
  in_tile_ = claim.kind == ItemClaim::Kind::kItem;
  if (in_tile_ && claim.item < core_of_tile_.size()) core_of_tile_[claim.item] = index_;
  return claim;
}

}  // namespace gridiron::bvh
