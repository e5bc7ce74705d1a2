// Shared work. SPDX-License-Identifier: Apache-2.0
#include "share_work.h"

#include <gridiron/sim/host_workers.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <vector>

namespace gridiron::tool {

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
  const auto workers = static_cast<std::uint32_t>(std::clamp<std::size_t>(count, 1, std::max(threads, 1u)));
  const sim::WorkersEnd end = sim::run_workers(workers, 1, run, [&stop] { stop = true; });
  if (end.error != nullptr) std::rethrow_exception(end.error);
  for (const std::exception_ptr& error : errors) {
    if (error != nullptr) std::rethrow_exception(error);
  }
}

}  // namespace gridiron::tool
