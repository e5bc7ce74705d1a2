// Host workers. SPDX-License-Identifier: Apache-2.0
#include <gridiron/sim/host_workers.h>

#include <atomic>
#include <utility>
#include <vector>

namespace gridiron::sim {

WorkersEnd run_workers(std::uint32_t count, std::uint32_t least, const std::function<void(std::uint32_t)>& work,
                       const std::function<void()>& stop, const StartThread& start) {
  WorkersEnd end;
  std::vector<std::exception_ptr> errors(count);
  std::vector<std::thread> threads;
  threads.reserve(count);
  enum Gate : std::uint32_t { kClosed, kOpen, kGivenUp };
  std::atomic<std::uint32_t> gate{kClosed};
  const auto run = [&](std::uint32_t worker) {
    gate.wait(kClosed);
    if (gate.load() == kGivenUp) return;
    try {
      work(worker);
    } catch (...) {
      errors[worker] = std::current_exception();
      stop();
    }
  };

  try {
    for (std::uint32_t i = 1; i < count; ++i) {
      threads.push_back(start ? start([&run, i] { run(i); }) : std::thread(run, i));
    }
  } catch (...) {
    // The host has no more threads or memory: std::system_error or std::bad_alloc. The caller decides whether those
    // that run are enough.
  }
  const std::uint32_t started = count == 0 ? 0 : static_cast<std::uint32_t>(threads.size()) + 1;
  const bool goes_on = started >= least;
  gate.store(goes_on ? kOpen : kGivenUp);
  gate.notify_all();
  if (goes_on && count != 0) run(0);
  for (std::thread& thread : threads) thread.join();

  if (!goes_on) return end;
  end.started = started;
  for (std::exception_ptr& error : errors) {
    if (error == nullptr) continue;
    end.error = std::move(error);
    break;
  }
  return end;
}

}  // namespace gridiron::sim
