// Hands out the items of one frame or pass to all cores of a chip, in rising order, each exactly once.
// Memory: borrows the abort flag. Threads: any number claim at once; progress calls are serialised.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/platform/contract.h>

#include <atomic>
#include <cstdint>
#include <functional>
#include <mutex>
#include <span>
#include <utility>

namespace gridiron::sim {

/// Shared claim counter of a frame or pass.
///
/// Items go out in rising order, so that when an item fails every item below it has been claimed: the lowest failing
/// item of a pass is the same however the cores interleave.
class ItemSource {
 public:
  using Progress = std::function<void(std::uint32_t done, std::uint32_t total)>;

  /// Items 0 to item_count - 1, or those of `list` alone: rising, borrowed. `abort` may be null.
  explicit ItemSource(std::uint32_t item_count, std::span<const std::uint32_t> list = {},
                      const std::atomic<bool>* abort = nullptr, Progress progress = {})
      : list_(list),
        total_(list.empty() ? item_count : static_cast<std::uint32_t>(list.size())),
        abort_(abort),
        progress_(std::move(progress)) {}

  /// Next item, kNone after the last, kAborted once the frame has to stop.
  [[nodiscard]] ItemClaim claim() {
    if (stopped_.load(std::memory_order_relaxed) || (abort_ != nullptr && abort_->load(std::memory_order_relaxed))) {
      return {ItemClaim::Kind::kAborted, 0};
    }
    // A core claims once more after the last item, so the counter cannot reach the end of its range.
    const std::uint64_t claim = next_.fetch_add(1, std::memory_order_relaxed);
    if (claim >= total_) return {ItemClaim::Kind::kNone, 0};
    return {ItemClaim::Kind::kItem, list_.empty() ? static_cast<std::uint32_t>(claim) : list_[claim]};
  }

  /// Reports that a claimed item is finished. Errors: whatever the progress call throws.
  void item_done();

  /// Answers every later claim with kAborted.
  void stop() { stopped_.store(true, std::memory_order_relaxed); }

 private:
  std::atomic<std::uint64_t> next_{0};
  std::span<const std::uint32_t> list_;
  std::uint32_t total_;
  const std::atomic<bool>* abort_;
  std::atomic<bool> stopped_{false};
  Progress progress_;
  std::mutex progress_mutex_;
  std::uint32_t done_ = 0;
};

}  // namespace gridiron::sim
