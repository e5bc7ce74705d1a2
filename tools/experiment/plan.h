// Plan: the runs that an experiment needs. Each frame is rendered once and replayed for all its machines. Memory: owns
// timings; traces exist only while their frame is worked on. Threads: execute() starts its own.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/sim/machine_profile.h>
#include <gridiron/sim/replay.h>
#include <report/report.h>

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "experiment/systems.h"
#include "experiment/views.h"

namespace gridiron::experiment {

/// A machine with a name that is unique in the plan.
struct Machine {
  std::string key;
  sim::MachineProfile profile;
};

/// @returns a built-in profile. Precondition: it exists.
[[nodiscard]] Machine built_in_machine(std::string_view name);

/// The result of a run: a time and facts, or why there are none.
struct RunResult {
  std::string failure;  ///< empty where the run went well
  FrameFacts facts;
  sim::FrameTiming timing;
  std::optional<CacheFacts> caches;
  double build_cycles = 0, build_seconds = 0;  ///< of the machine's general core; of the cores where these build
  std::vector<tool::PassFigures> passes;       ///< where the cores build; the picture's last

  [[nodiscard]] bool failed() const { return !failure.empty(); }
  /// Frames a second; NaN if the run failed.
  [[nodiscard]] double fps() const;
  /// Frames a second if each frame is built anew and then rendered; NaN if the run failed.
  [[nodiscard]] double fps_with_build() const;
  /// Core cycles stalled for transfers, all cores.
  [[nodiscard]] double wait_cycles() const { return tool::wait_cycles_of(timing); }
  /// Percent of all core cycles of the frame; NaN if the run failed.
  [[nodiscard]] double wait_percent() const;
  /// Bytes requested by gets, all cores.
  [[nodiscard]] std::uint64_t bytes_in() const;
  [[nodiscard]] double megabytes_in() const;  ///< the same in units of 2^20
  /// Bytes requested by gets and puts, all cores.
  [[nodiscard]] std::uint64_t moved_bytes() const;
};

class Plan {
 public:
  using RunId = std::size_t;

  /// @param width, height  of every frame.
  Plan(std::uint32_t width, std::uint32_t height) : width_(width), height_(height) {}

  /// Adds a run. Adding the same one again gives the same id. `view` must outlive the plan.
  [[nodiscard]] RunId add(const View& view, const std::shared_ptr<const System>& system, Shading shading,
                          const Machine& machine, std::uint32_t core_count);

  /// Runs everything, divided among the ranks by frames; each then has all results. They do not depend on `threads` or
  /// ranks.
  ///
  /// @param progress  called serialised with the runs done and all runs.
  /// A Failure kBadInput of a frame becomes the failure of its runs. Any other Failure is thrown, that of the first
  /// frame in the order of the plan.
  void execute(std::uint32_t threads, const std::function<void(std::uint32_t, std::uint32_t)>& progress);

  [[nodiscard]] const RunResult& result(RunId id) const { return results_[id]; }
  [[nodiscard]] std::size_t frame_count() const { return frames_.size(); }
  /// @returns frames rendered by execute(): one for each recorded and replayed frame, and one for each run of a system
  /// with caches, which is rendered anew for every machine.
  [[nodiscard]] std::size_t rendered_count() const;
  [[nodiscard]] std::size_t run_count() const { return results_.size(); }

 private:
  struct Run {
    RunId id;
    Machine machine;
    std::uint32_t core_count;
  };
  struct Frame {
    const View* view;
    std::shared_ptr<const System> system;
    Shading shading;
    std::vector<Run> runs;
  };

  void run_frame(const Frame& frame, const std::function<void()>& run_done);

  std::uint32_t width_, height_;
  std::vector<Frame> frames_;
  std::vector<RunResult> results_;
  std::map<std::tuple<std::string, std::string, Shading>, std::size_t> frame_of_;
  std::map<std::tuple<std::size_t, std::string, std::uint32_t>, RunId> run_of_;
};

}  // namespace gridiron::experiment
