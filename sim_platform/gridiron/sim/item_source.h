// Hands out the items of one frame or pass to all cores of a chip, in rising order, each exactly once.
// Memory: borrows the abort flag. Threads: any number claim at once; progress calls are serialised.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/platform/contract.h>

#include <atomic>
#include <cstdint>
#include <functional>
#include <mutex>
#include <utility>

namespace gridiron::sim {

/// Shared claim counter of a frame or pass.
///
/// Items go out in rising order, so that when an item fails every item below it has been claimed: the lowest failing
/// item of a pass is the same however the cores interleave.
class ItemSource {
 public:
  using Progress = std::function<void(std::uint32_t done, std::uint32_t total)>;

  /// Items [first_item, end_item). `abort` may be null.
  ItemSource(std::uint32_t first_item, std::uint32_t end_item, const std::atomic<bool>* abort = nullptr,
             Progress progress = {})
      : next_(first_item),
        end_item_(end_item),
        total_(end_item - first_item),
        abort_(abort),
        progress_(std::move(progress)) {}

  /// Next item, kNone after the last, kAborted once the frame has to stop.
  [[nodiscard]] ItemClaim claim() {
    if (stopped_.load(std::memory_order_relaxed) || (abort_ != nullptr && abort_->load(std::memory_order_relaxed))) {
      return {ItemClaim::Kind::kAborted, 0};
    }
    // A core claims once more after the last item, so the counter cannot reach the end of its range.
    const std::uint64_t item = next_.fetch_add(1, std::memory_order_relaxed);
    if (item >= end_item_) return {ItemClaim::Kind::kNone, 0};
    return {ItemClaim::Kind::kItem, static_cast<std::uint32_t>(item)};
  }

  /// Reports that a claimed item is finished. Errors: whatever the progress call throws.
  void item_done();

  /// Answers every later claim with kAborted.
  void stop() { stopped_.store(true, std::memory_order_relaxed); }

 private:
  std::atomic<std::uint64_t> next_;
  std::uint64_t end_item_;
  std::uint32_t total_;
  const std::atomic<bool>* abort_;
  std::atomic<bool> stopped_{false};
  Progress progress_;
  std::mutex progress_mutex_;
  std::uint32_t done_ = 0;
};

}  // namespace gridiron::sim
