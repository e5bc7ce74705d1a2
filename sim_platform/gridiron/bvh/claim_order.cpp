// Clocks without contention and the turns they decide. SPDX-License-Identifier: Apache-2.0
#include <gridiron/bvh/claim_order.h>
#include <gridiron/dma/tags.h>

#include <algorithm>

namespace gridiron::bvh {

CoreClock::CoreClock(const sim::MachineProfile& machine, std::uint32_t output_depth)
    : issue_(ticks_of(machine.issue_cycles)),
      wait_(ticks_of(machine.wait_cycles)),
      latency_(ticks_of(machine.latency_cycles)),
      slot_(machine.channel_bytes_per_cycle > 0
                ? ticks_of(std::max(1u, machine.line_bytes) / machine.channel_bytes_per_cycle)
                : 0),
      interval_(ticks_of(machine.core_line_interval_cycles)),
      claim_(ticks_of(machine.claim_cycles)),
      line_bytes_(std::max(1u, machine.line_bytes)),
      output_depth_(std::max(1u, output_depth)),
      done_(std::clamp(machine.queue_depth, 1u, 65536u)),
      arrivals_(std::clamp(machine.lines_in_flight, 1u, 65536u)) {
  for (std::uint32_t kind = 0; kind < kWorkKindCount; ++kind) work_[kind] = ticks_of(machine.work_cycles[kind]);
}

CoreClock::Ticks CoreClock::ticks_of(double cycles) {
  if (!(cycles > 0)) return 0;
  return static_cast<Ticks>(std::min(cycles, double{1 << 20}) * kTicksPerCycle + 0.5);
}

void CoreClock::issue(std::uint64_t address, std::uint32_t bytes, std::uint32_t tag) {
  // A full queue: the command queue-depth before this one must have left it.
  if (command_count_ >= done_.size()) wait_until(done_[command_count_ % done_.size()]);
  now_ += issue_;
  const std::uint64_t lines = (address + std::max(1u, bytes) - 1) / line_bytes_ - address / line_bytes_ + 1;
  // Commands are served one after another, so a line never leaves before the one in front of it.
  Ticks arrival = 0;
  for (std::uint64_t line = 0; line < lines; ++line) {
    Ticks request = now_;
    if (line_count_ > 0) request = std::max(request, last_request_ + interval_);
    if (line_count_ >= arrivals_.size()) request = std::max(request, arrivals_[line_count_ % arrivals_.size()]);
    last_request_ = request;
    channel_free_ = std::max(request, channel_free_) + slot_;
    arrival = channel_free_ + latency_;
    arrivals_[line_count_++ % arrivals_.size()] = arrival;
  }
  done_[command_count_++ % done_.size()] = arrival;
  done_of_tag_[tag] = arrival;
}

void CoreClock::take(const sim::TileTrace& trace, std::uint32_t ordinal) {
  const auto rotated = [&](std::uint32_t relative) { return kFirstOutputTag + (relative + ordinal) % output_depth_; };
  steps_.open(trace);
  while (const sim::TraceEvent* const step = steps_.next()) {
    const sim::TraceEvent& event = *step;
    switch (event.kind) {
      case sim::EventKind::kWork:
        for (const sim::WorkAmount& work : event.work) {
          now_ += work_[static_cast<std::size_t>(work.kind)] * work.amount;
        }
        break;
      case sim::EventKind::kGet:
      case sim::EventKind::kPut:
        issue(event.address, event.bytes, event.rotating ? rotated(event.tag) : event.tag % 32);
        break;
      case sim::EventKind::kStage:
        break;
      case sim::EventKind::kWait:
        for (std::uint32_t tag = 0; tag < 32; ++tag) {
          if ((event.tags >> tag & 1u) != 0) wait_until(done_of_tag_[tag]);
          if ((event.rotating_tags >> tag & 1u) != 0) wait_until(done_of_tag_[rotated(tag)]);
        }
        now_ += wait_;
        break;
    }
  }
}

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

TileClaim OrderedCore::claim_tile() {
  // The core's steps since its last claim.
  const sim::TileTrace& trace = inner_.end_trace();
  clock_.take(trace, in_tile_ ? tiles_++ : 0);
  order_.wait_for_turn(index_, clock_.now());
  const TileClaim claim = inner_.claim_tile();
  clock_.take_claim();
  in_tile_ = claim.kind == TileClaim::Kind::kTile;
  if (in_tile_ && claim.tile_id < core_of_tile_.size()) core_of_tile_[claim.tile_id] = index_;
  return claim;
}

}  // namespace gridiron::bvh
