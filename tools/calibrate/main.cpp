// gridiron_calibrate: writes the table of work costs, or shows what it is made of.
// Memory: little. Threads: one. SPDX-License-Identifier: Apache-2.0
#include <build_count.h>
#include <build_time.h>
#include <direct_count.h>
#include <work_table.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "base/failure.h"
#include "base/progress.h"
#include "files/atomic_file.h"
#include "files/output_target.h"

namespace {

constexpr std::string_view kUsage =
    "usage: gridiron_calibrate [--bvh | --tree | --build] [FILE | --memories FOLDER | --check SCENES | --times SCENES "
    "| --rules]\n"
    "Counts the operations of the kernel on eight small frames and puts them through the pipeline model.\n"
    "  --bvh          of the cached BVH instead, on four frames\n"
    "  --tree         of eye rays through the tree, on nine frames\n"
    "  --build        of the passes that build the tree, on four meshes; FILE or --check alone\n"
    "  FILE           write the table there: sim_platform/gridiron/sim/work_costs.h, of the cached BVH\n"
    "                 sim_platform/gridiron/bvh/bvh_costs.h, of the tree sim_platform/gridiron/sim/tile_costs.h\n"
    "  --memories     write the frames' memories there, for second_opinion/run\n"
    "  --check        compare prices with direct counts of windows of the views of these scans, and print the table\n"
    "  --times        how long the passes that build trees take for these scans, and what binds\n"
    "  --rules        what other assumptions of the pipeline model would change, as a table\n"
    "Without FILE: every kind of work with its operations by class, for superblocks of 1, 2, 4 and 8 basic blocks.\n";

int run(int argument_count, char** arguments) {
  namespace calibrate = gridiron::calibrate;
  if (argument_count == 3 && std::string_view(arguments[1]) == "--memories") {
    calibrate::write_memories(arguments[2]);
    return 0;
  }
  if (argument_count == 2 && std::string_view(arguments[1]) == "--rules") {
    std::fputs(calibrate::rules_text().c_str(), stdout);
    return 0;
  }
  if (argument_count == 3 && std::string_view(arguments[1]) == "--times") {
    std::fputs(calibrate::build_times_text(arguments[2]).c_str(), stdout);
    return 0;
  }
  if (argument_count == 3 && std::string_view(arguments[1]) == "--check") {
    gridiron::tool::Progress progress(true, "windows");
    auto counts = calibrate::count_windows(arguments[2], std::max(1u, std::thread::hardware_concurrency()),
                                           [&](std::size_t done, std::size_t total) { progress.update(done, total); });
    std::fputs(calibrate::direct_count_table(counts).c_str(), stdout);
    for (calibrate::DirectCount& frame : calibrate::count_effects()) counts.push_back(std::move(frame));
    std::fputs(calibrate::direct_count_kinds(counts).c_str(), stdout);
    return 0;
  }
  if (argument_count > 1 && std::string_view(arguments[1]) == "--build") {
    if (argument_count == 4 && std::string_view(arguments[2]) == "--check") {
      const std::vector<calibrate::BuildCount> counts = calibrate::count_scans(arguments[3]);
      std::fputs((calibrate::build_count_table(counts) + "\n" + calibrate::build_count_kinds(counts)).c_str(), stdout);
      return 0;
    }
    if (argument_count == 2) {
      std::fputs(calibrate::build_report_text(calibrate::count_builds()).c_str(), stdout);
      return 0;
    }
    if (argument_count == 3 && arguments[2][0] != '-') {
      (void)gridiron::tool::resolve_output(arguments[2]);
      gridiron::tool::AtomicFile file(arguments[2]);
      file.write(calibrate::build_table_text(calibrate::count_builds()));
      file.commit();
      return 0;
    }
    std::fputs(kUsage.data(), stderr);
    return 2;
  }
  // What is counted, and the texts of it.
  struct Subject {
    std::string_view option;
    calibrate::Totals (*count)(const calibrate::PipeRules&);
    std::string (*table)(const calibrate::Totals&);
    std::string (*report)(const calibrate::Totals&);
  };
  constexpr Subject kSubjects[] = {
      {"--bvh", calibrate::count_bvh_frames, calibrate::bvh_table_text, calibrate::bvh_report_text},
      {"--tree", calibrate::count_tree_frames, calibrate::tree_table_text, calibrate::tree_report_text},
      {"", calibrate::count_frames, calibrate::table_text, calibrate::report_text}};
  const Subject& subject = *std::ranges::find_if(kSubjects, [&](const Subject& one) {
    return one.option.empty() || (argument_count > 1 && one.option == arguments[1]);
  });
  if (!subject.option.empty()) {
    --argument_count;
    ++arguments;
  }
  if (argument_count > 2 || (argument_count == 2 && arguments[1][0] == '-')) {
    std::fputs(kUsage.data(), argument_count == 2 && std::string_view(arguments[1]) == "--help" ? stdout : stderr);
    return argument_count == 2 && std::string_view(arguments[1]) == "--help" ? 0 : 2;
  }
  if (argument_count == 1) {
    for (const std::uint32_t branches : {1u, 2u, 4u, 8u}) {
      const calibrate::PipeRules rules{.superblock_branches = branches};
      std::printf("superblocks of at most %u basic blocks%s\n%s\n", branches,
                  branches == calibrate::kSuperblockBranches ? " (charged)" : "",
                  subject.report(subject.count(rules)).c_str());
    }
    return 0;
  }
  // Nobody should wait for a count that cannot be written.
  (void)gridiron::tool::resolve_output(arguments[1]);
  const std::string text = subject.table(subject.count({}));
  gridiron::tool::AtomicFile file(arguments[1]);
  file.write(text);
  file.commit();
  return 0;
}

}  // namespace

int main(int argument_count, char** arguments) {
  try {
    return run(argument_count, arguments);
  } catch (const gridiron::tool::Failure& failure) {
    std::fprintf(stderr, "%s\n", failure.what());
    return static_cast<int>(failure.code());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "gridiron_calibrate: %s\n", error.what());
    return 1;
  }
}
