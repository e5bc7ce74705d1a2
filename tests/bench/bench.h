// What the benchmarks of one program share: options, interleaved timing, ratios with limits.
// Memory: std::vector. Threads: one. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace gridiron::bench {

struct BenchOptions {
  std::filesystem::path scenes;  ///< directory of scans; empty: benchmarks that need one say so and pass
  unsigned rounds = 7;           ///< interleaved rounds; the least time of each candidate counts
  bool quick = false;            ///< leave out what takes minutes
  unsigned batch_rays = 2048;    ///< secondary rays that are traced together: a multiple of 16, at most 2,048
};

/// One way of doing a job.
struct Candidate {
  std::string name;
  std::function<void()> run;
  std::function<void()> prepare = {};  ///< before each run, not timed; may be empty
};

/// What is measured of a run. The processor's time is that of all threads together: for one thread it is the wall
/// clock's time on an idle host, and on a busy one it leaves out the others' turns.
enum class Clock : std::uint8_t { kProcessor, kWall };

/// Runs all candidates once to warm up, then `rounds` times in turn, so that a slow moment of the host hits all alike.
/// @returns the least seconds of each.
std::vector<double> least_seconds(std::span<const Candidate> candidates, unsigned rounds,
                                  Clock clock = Clock::kProcessor);

/// Prints "label: ours / peer = ratio (limit)". @returns whether the ratio is within the limit.
bool report_ratio(std::string_view label, double ours_seconds, double peer_seconds, double limit);

/// One benchmark. @returns whether all of its limits hold.
using BenchFunction = bool (*)(const BenchOptions& options);

/// Enters a benchmark into the program; benchmarks run in the order of their names.
struct Registration {
  Registration(std::string_view name, BenchFunction function);
};

}  // namespace gridiron::bench
