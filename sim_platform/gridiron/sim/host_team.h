// A team of host threads that share the work of core's builders and checks.
// Memory: owns its threads. Threads: sharing() is for one thread at a time. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/build/work_sharing.h>
#include <gridiron/sim/host_workers.h>

#include <atomic>
#include <cstdint>
#include <thread>
#include <vector>

namespace gridiron::sim {

/// Threads that wait for parts of a work. Each begins with the parts of its own place in the order, so that what a part
/// has left in a processor's caches serves the same part of the next work; who has none left takes those of others. A
/// part must not share work with the team that it is of.
class HostTeam {
 public:
  /// Starts threads - 1 threads; fewer where the host has no more. @param start  for tests; empty: std::thread.
  explicit HostTeam(std::uint32_t threads, const StartThread& start = {});
  ~HostTeam();
  HostTeam(const HostTeam&) = delete;
  HostTeam& operator=(const HostTeam&) = delete;

  /// Of all threads and the caller's; valid as long as the team.
  [[nodiscard]] WorkSharing sharing();

 private:
  struct alignas(64) Queue {
    std::atomic<std::uint32_t> next = 0;
    std::uint32_t end = 0;
  };

  void run(std::uint32_t count, WorkSharing::Part part, void* work);
  void take_parts(std::uint32_t member);
  void serve(std::uint32_t member);
  [[nodiscard]] std::uint32_t size() const { return static_cast<std::uint32_t>(threads_.size()) + 1; }

  std::vector<std::thread> threads_;
  Queue queues_[kMostSharers];
  WorkSharing::Part part_ = nullptr;
  void* work_ = nullptr;
  std::uint32_t members_ = 1;  ///< of this work
  /// The number of the work, whether threads may still enter it, and how many are inside: nobody waits for a thread
  /// that the host has not let run.
  std::atomic<std::uint64_t> state_ = 0;
  std::atomic<bool> ends_ = false;
};

}  // namespace gridiron::sim
