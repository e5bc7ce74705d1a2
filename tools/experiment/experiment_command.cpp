// experiment: runs one experiment and writes its folder. SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "base/failure.h"
#include "base/progress.h"
#include "base/stopwatch.h"
#include "base/words.h"
#include "experiment/accuracy_experiment.h"
#include "experiment/effects_experiment.h"
#include "experiment/paper_experiment.h"
#include "files/atomic_file.h"
#include "files/interrupt.h"
#include "files/output_folder.h"
#include "gridiron/commands.h"

namespace gridiron::tool {
namespace {

// Removes files of an earlier run whose names this experiment could have written and did not; nothing else.
void remove_stale_files(const std::filesystem::path& folder, const std::vector<std::string>& names,
                        const std::vector<experiment::BookFile>& written) {
  for (const std::string& name : names) {
    if (std::ranges::find(written, name, &experiment::BookFile::name) != written.end()) continue;
    const std::filesystem::path path = folder / name;
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::symlink_status(path, error);
    if (!std::filesystem::is_regular_file(status) && !std::filesystem::is_symlink(status)) continue;
    if (!std::filesystem::remove(path, error) && error) {
      throw Failure(ExitCode::kBadInput,
                    path.string() + ": is of an earlier run and cannot be removed: " + error.message());
    }
  }
}

void check_scenes(const std::filesystem::path& folder) {
  std::error_code ignored;
  if (!folder.empty() && !std::filesystem::is_directory(folder, ignored)) {
    throw Failure(ExitCode::kBadInput, folder.string() + ": no such folder of scenes");
  }
}

std::vector<std::string> file_names_of(ExperimentName name) {
  if (name == ExperimentName::kEffects) return experiment::effects_file_names();
  return name == ExperimentName::kPaper ? experiment::paper_file_names() : experiment::accuracy_file_names();
}

experiment::ExperimentResult run(const ExperimentRequest& request, const experiment::ProgressCall& progress) {
  const std::uint32_t threads = request.threads.value_or(this_host().threads);
  const std::filesystem::path scenes = request.scenes.value_or("");
  const CountPair usual = request.name == ExperimentName::kEffects ? CountPair{96, 96} : kUsualPictureSize;
  const auto [width, height] = request.size.value_or(usual);
  if (request.name == ExperimentName::kAccuracy) {
    return experiment::run_accuracy_experiment({.scenes = scenes, .threads = threads, .width = width, .height = height},
                                               progress);
  }
  if (request.name == ExperimentName::kEffects) {
    return experiment::run_effects_experiment({.threads = threads, .width = width, .height = height}, progress);
  }
  return experiment::run_paper_experiment({.scenes = scenes,
                                           .threads = threads,
                                           .width = width,
                                           .height = height,
                                           .largest_knot = request.largest_knot.value_or(1'000'000)},
                                          progress);
}

}  // namespace

void run_command(const ExperimentRequest& request) {
  check_scenes(request.scenes.value_or(""));
  const std::vector<std::string> names = file_names_of(request.name);
  OutputFolder folder(request.output, names);
  const Stopwatch stopwatch;
  experiment::ExperimentResult result;
  {
    Progress progress(!request.quiet, "runs");
    result = run(request, [&progress](std::uint32_t done, std::uint32_t total) { progress.update(done, total); });
  }
  experiment::write_files(request.output, result.files);
  folder.keep();
  remove_stale_files(request.output, names, result.files);
  if (request.quiet) return;
  for (const std::string& sentence : result.missing) std::printf("%s\n", sentence.c_str());
  std::printf("%s: %s, %s rendered, %s of the machine, %.1f s\n", (request.output / "index.html").c_str(),
              words_of_count(result.files.size(), "file").c_str(), words_of_count(result.frame_count, "frame").c_str(),
              words_of_count(result.run_count, "run").c_str(), stopwatch.seconds());
}

}  // namespace gridiron::tool
