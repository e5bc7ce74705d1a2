// Host team. SPDX-License-Identifier: Apache-2.0
#include <gridiron/build/shared_parts.h>
#include <gridiron/sim/host_team.h>

#include <algorithm>

namespace gridiron::sim {
namespace {

// Works follow each other within microseconds, and waking a thread takes tens of them: look a while before sleeping,
// and let others run meanwhile.
constexpr int kLooks = 5'000;

// Of the state.
constexpr std::uint64_t kNextWork = std::uint64_t{1} << 32, kOpen = kNextWork / 2, kInside = kOpen - 1;

void wait_for_change(const std::atomic<std::uint64_t>& value, std::uint64_t from) {
  for (int i = 0; i < kLooks; ++i) {
    if (value.load() != from) return;
    std::this_thread::yield();
  }
  value.wait(from);
}

}  // namespace

HostTeam::HostTeam(std::uint32_t threads, const StartThread& start) {
  const std::uint32_t most = std::min(threads, kMostSharers);
  threads_.reserve(most);
  try {
    for (std::uint32_t i = 1; i < most; ++i) {
      threads_.push_back(start ? start([this, i] { serve(i); }) : std::thread([this, i] { serve(i); }));
    }
  } catch (...) {
    // std::system_error or std::bad_alloc: the host has no more; those that run are enough.
  }
}

HostTeam::~HostTeam() {
  ends_ = true;
  state_ += kNextWork;
  state_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

WorkSharing HostTeam::sharing() {
  const auto run = [](void* team, std::uint32_t count, WorkSharing::Part part, void* work) {
    static_cast<HostTeam*>(team)->run(count, part, work);
  };
  return {size(), run, this};
}

void HostTeam::run(std::uint32_t count, WorkSharing::Part part, void* work) {
  part_ = part;
  work_ = work;
  members_ = size();
  for (std::uint32_t i = 0; i < members_; ++i) {
    const Share own = share_of(count, members_, i);
    queues_[i].next = static_cast<std::uint32_t>(own.begin);
    queues_[i].end = static_cast<std::uint32_t>(own.end);
  }
  state_ = (state_ / kNextWork + 1) * kNextWork + kOpen;
  state_.notify_all();
  take_parts(0);
  for (std::uint64_t left = state_ -= kOpen; (left & kInside) != 0; left = state_) wait_for_change(state_, left);
}

void HostTeam::take_parts(std::uint32_t member) {
  for (std::uint32_t k = 0; k < members_; ++k) {
    Queue& queue = queues_[(member + k) % members_];
    for (std::uint32_t i = queue.next++; i < queue.end; i = queue.next++) part_(work_, i);
  }
}

void HostTeam::serve(std::uint32_t member) {
  for (std::uint64_t last = 0, state = state_;; state = state_) {
    if (state / kNextWork == last) {
      wait_for_change(state_, state);
      continue;
    }
    if (ends_) return;
    last = state / kNextWork;
    while (state / kNextWork == last && (state & kOpen) != 0) {
      if (!state_.compare_exchange_weak(state, state + 1)) continue;
      take_parts(member);
      --state_;
      state_.notify_all();
      break;
    }
  }
}

}  // namespace gridiron::sim
