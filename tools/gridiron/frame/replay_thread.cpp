// Replay thread. SPDX-License-Identifier: Apache-2.0
#include "replay_thread.h"

#include <system_error>
#include <utility>

namespace gridiron::tool {

ReplayThread::ReplayThread(sim::FrameTrace frame, std::uint32_t tile_count, const sim::MachineProfile& machine,
                           const sim::ReplayOptions& options, bool is_asked_for)
    : clock_(std::move(frame), tile_count, machine, options) {
  if (!is_asked_for) return;
  try {
    thread_ = std::thread([this] { run(); });
  } catch (const std::system_error&) {  // the caller's then
  }
}

ReplayThread::~ReplayThread() {
  end();
}

void ReplayThread::take(sim::TileTrace trace) {
  if (!thread_.joinable()) return clock_.take(std::move(trace));
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return waiting_bytes_ < kMostWaitingBytes || error_ != nullptr; });
  if (error_ != nullptr) return;  // finish() throws it
  waiting_bytes_ += trace.packed.size();
  waiting_.push_back(std::move(trace));
  changed_.notify_all();
}

sim::FrameTiming ReplayThread::finish() {
  end();
  if (error_ != nullptr) std::rethrow_exception(error_);
  return clock_.finish();
}

void ReplayThread::run() {
  try {
    while (true) {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [this] { return !waiting_.empty() || has_ended_; });
      if (waiting_.empty()) return;
      std::vector<sim::TileTrace> traces = std::exchange(waiting_, {});
      waiting_bytes_ = 0;
      changed_.notify_all();
      lock.unlock();
      for (sim::TileTrace& trace : traces) clock_.take(std::move(trace));
    }
  } catch (...) {
    const std::lock_guard lock(mutex_);
    error_ = std::current_exception();
    changed_.notify_all();
  }
}

void ReplayThread::end() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    has_ended_ = true;
    changed_.notify_all();
  }
  thread_.join();
}

}  // namespace gridiron::tool
