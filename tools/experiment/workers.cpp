// Workers. SPDX-License-Identifier: Apache-2.0
#include "experiment/workers.h"

#include <atomic>
#include <exception>
#include <thread>
#include <vector>

namespace gridiron::experiment {

void share_work(std::uint32_t threads, std::size_t count, const std::function<void(std::size_t)>& work) {
  std::atomic<std::size_t> next{0};
  std::atomic<bool> stop{false};
  std::vector<std::exception_ptr> errors(count);
  const auto run = [&] {
    while (!stop) {
      // What is claimed is done, whoever fails meanwhile: of pieces that fail the lowest is always among them.
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
  std::vector<std::thread> workers;
  for (std::uint32_t i = 1; i < threads; ++i) workers.emplace_back(run);
  run();
  for (std::thread& worker : workers) worker.join();
  for (const std::exception_ptr& error : errors) {
    if (error != nullptr) std::rethrow_exception(error);
  }
}

}  // namespace gridiron::experiment
