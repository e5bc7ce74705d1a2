// Plan. SPDX-License-Identifier: Apache-2.0
#include "experiment/plan.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <utility>

#include "base/failure.h"
#include "experiment/result_bytes.h"
#include "experiment/workers.h"
#include "files/interrupt.h"

namespace gridiron::experiment {

Machine built_in_machine(std::string_view name) {
  return {std::string(name), *sim::find_machine_profile(name)};
}

double RunResult::fps() const {
  return timing.seconds > 0 ? 1 / timing.seconds : std::nan("");
}

double RunResult::fps_with_build() const {
  return timing.seconds > 0 ? 1 / (timing.seconds + build_seconds) : std::nan("");
}

double RunResult::wait_percent() const {
  const double all = timing.frame_cycles * static_cast<double>(timing.cores.size());
  return all > 0 ? 100 * wait_cycles() / all : std::nan("");
}

double RunResult::megabytes_in() const {
  return static_cast<double>(bytes_in()) / (1 << 20);
}

std::uint64_t RunResult::bytes_in() const {
  std::uint64_t bytes = 0;
  for (const sim::CoreTiming& core : timing.cores) bytes += core.bytes_in;
  return bytes;
}

std::uint64_t RunResult::moved_bytes() const {
  std::uint64_t bytes = bytes_in();
  for (const sim::CoreTiming& core : timing.cores) bytes += core.bytes_out;
  return bytes;
}

Plan::RunId Plan::add(const View& view, const std::shared_ptr<const System>& system, Shading shading,
                      const Machine& machine, std::uint32_t core_count) {
  const auto [frame, is_new_frame] = frame_of_.try_emplace({view.key, system->key(), shading}, frames_.size());
  if (is_new_frame) frames_.push_back({&view, system, shading, {}});
  const auto [run, is_new_run] = run_of_.try_emplace({frame->second, machine.key, core_count}, results_.size());
  if (is_new_run) {
    frames_[frame->second].runs.push_back({run->second, machine, core_count});
    results_.emplace_back();
  }
  return run->second;
}

void Plan::run_frame(const Frame& frame, const std::function<void()>& run_done) {
  std::unique_ptr<Recording> recording;
  std::string failure;
  try {
    recording = frame.system->record(*frame.view, {.width = width_, .height = height_, .shading = frame.shading});
  } catch (const tool::Failure& reason) {
    if (reason.code() != tool::ExitCode::kBadInput) throw;
    failure = reason.what();
  }
  for (const Run& run : frame.runs) {
    tool::stop_if_interrupted();
    RunResult& result = results_[run.id];
    if (recording == nullptr) {
      result.failure = failure;
    } else {
      result.facts = recording->facts();
      TimedFrame timed = recording->time(run.machine.profile, run.core_count);
      result.timing = std::move(timed.timing);
      result.caches = timed.caches;
      result.build_cycles = sim::build_cycles(run.machine.profile.master, result.facts.build);
      result.build_seconds = sim::build_seconds(run.machine.profile.master, result.facts.build);
      if (timed.cores_build) {
        result.build_cycles = timed.cores_build->cycles;
        result.build_seconds = timed.cores_build->seconds;
        result.passes = std::move(timed.cores_build->passes);
      }
    }
    run_done();
  }
}

std::size_t Plan::rendered_count() const {
  std::size_t count = 0;
  for (const Frame& frame : frames_) {
    std::size_t anew = 0;
    bool failed = false;
    for (const Run& run : frame.runs) {
      anew += results_[run.id].caches ? 1u : 0u;
      failed = results_[run.id].failed();
    }
    count += anew > 0 ? anew : failed ? 0u : 1u;
  }
  return count;
}

void Plan::execute(std::uint32_t threads, const std::function<void(std::uint32_t, std::uint32_t)>& progress) {
  std::mutex mutex;
  std::uint32_t done = 0, own = 0;
  const auto total = static_cast<std::uint32_t>(results_.size());
  const auto show = [&] { progress(std::min(total, std::max(done, own * tool::ranks().count())), total); };
  const auto run_done = [&] {
    const std::lock_guard lock(mutex);
    ++done;
    ++own;  // other ranks have done about as many
    show();
  };
  const auto pack = [this](std::size_t i) {
    tool::ByteWriter writer;
    for (const Run& run : frames_[i].runs) add_run(writer, results_[run.id]);
    return writer.take();
  };
  const auto unpack = [&](std::size_t i, const tool::Bytes& bytes) {
    tool::ByteReader reader(bytes);
    for (const Run& run : frames_[i].runs) {
      take_run(reader, results_[run.id]);
      ++done;
      show();
    }
  };
  share_work(threads, frames_.size(), [&](std::size_t i) { run_frame(frames_[i], run_done); }, {pack, unpack});
}

}  // namespace gridiron::experiment
