// Workers. SPDX-License-Identifier: Apache-2.0
#include "experiment/workers.h"

#include <gridiron/sim/host_workers.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <vector>

namespace gridiron::experiment {

void share_work(std::uint32_t threads, std::size_t count, const std::function<void(std::size_t)>& work) {
  std::atomic<std::size_t> next{0};
  std::atomic<bool> stop{false};
  std::vector<std::exception_ptr> errors(count);
  const auto run = [&](std::uint32_t) {
    while (!stop) {
      // A claimed piece is always finished, so the lowest failing piece is always among the failures.
      const std::size_t i = next++;
      if (i >= count) return;
      try {
        work(i);
      } catch (...) {
        errors[i] = std::current_exception();
        stop = true;
      }
    }
  };
  const sim::WorkersEnd end = sim::run_workers(std::max(threads, 1u), 1, run, [&stop] { stop = true; });
  if (end.error != nullptr) std::rethrow_exception(end.error);
  for (const std::exception_ptr& error : errors) {
    if (error != nullptr) std::rethrow_exception(error);
  }
}

void share_work(std::uint32_t threads, std::size_t count, const std::function<void(std::size_t)>& work,
                const ResultBytes& results) {
  tool::Ranks& ranks = tool::ranks();
  if (ranks.count() == 1) return share_work(threads, count, work);
  std::mutex mutex;
  share_work(threads, static_cast<std::size_t>(ranks.share_of(count)), [&](std::size_t k) {
    work(ranks.piece(k));
    const std::lock_guard lock(mutex);
    ranks.attend();
  });
  tool::exchange_results(count, results.pack, results.unpack);
}

}  // namespace gridiron::experiment
