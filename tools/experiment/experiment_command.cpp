// experiment: runs one experiment and writes its folder. SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

#include "base/failure.h"
#include "base/progress.h"
#include "base/ranks.h"
#include "base/stopwatch.h"
#include "base/words.h"
#include "experiment/experiments.h"
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
      input_error(path, "is of an earlier run and cannot be removed: " + error.message());
    }
  }
}

void check_scenes(const std::filesystem::path& folder) {
  std::error_code ignored;
  if (!folder.empty() && !std::filesystem::is_directory(folder, ignored)) {
    input_error(folder, "no such folder of scenes");
  }
}

// An experiment, and the size of its pictures where none is asked for.
struct Experiment {
  experiment::ExperimentResult (*run)(const experiment::ExperimentSettings&, const experiment::ProgressCall&);
  std::vector<std::string> (*file_names)();
  CountPair usual_size = kUsualPictureSize;
};

Experiment experiment_of(ExperimentName name) {
  switch (name) {
    case ExperimentName::kAccuracy:
      return {experiment::run_accuracy_experiment, experiment::accuracy_file_names};
    case ExperimentName::kEffects:
      return {experiment::run_effects_experiment, experiment::effects_file_names, {96, 96}};
    case ExperimentName::kDynamic:
      return {experiment::run_dynamic_experiment, experiment::dynamic_file_names, {512, 512}};
    case ExperimentName::kPaper:
      break;
  }
  return {experiment::run_paper_experiment, experiment::paper_file_names};
}

}  // namespace

void run_command(const ExperimentRequest& request) {
  check_scenes(request.scenes.value_or(""));
  const Experiment chosen = experiment_of(request.name);
  const auto [width, height] = request.size.value_or(chosen.usual_size);
  experiment::ExperimentSettings settings{.scenes = request.scenes.value_or(""),
                                          .threads = request.threads.value_or(this_host().threads),
                                          .width = width,
                                          .height = height};
  settings.largest_knot = request.largest_knot.value_or(settings.largest_knot);
  if (!tool::ranks().is_first()) {
    (void)chosen.run(settings, [](std::uint32_t, std::uint32_t) {});
    return;
  }
  const std::vector<std::string> names = chosen.file_names();
  OutputFolder folder(request.output, names);
  const Stopwatch stopwatch;
  experiment::ExperimentResult result;
  {
    Progress progress(!request.quiet, "runs");
    result =
        chosen.run(settings, [&progress](std::uint32_t done, std::uint32_t total) { progress.update(done, total); });
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
