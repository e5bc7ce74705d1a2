// gridiron_calibrate: writes the table of work costs, or shows what it is made of.
// Memory: little. Threads: one. SPDX-License-Identifier: Apache-2.0
#include <direct_count.h>
#include <work_table.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <string>
#include <string_view>
#include <thread>
#include <utility>

#include "base/failure.h"
#include "base/progress.h"
#include "files/atomic_file.h"
#include "files/output_target.h"

namespace {

constexpr std::string_view kUsage =
    "usage: gridiron_calibrate [--bvh] [FILE | --memories FOLDER | --check SCENES | --rules]\n"
    "Counts the operations of the kernel on eight small frames and puts them through the pipeline model.\n"
    "  --bvh          of the cached BVH instead, on four frames\n"
    "  FILE           write the table there: sim_platform/gridiron/sim/work_costs.h, of the cached BVH\n"
    "                 sim_platform/gridiron/bvh/bvh_costs.h\n"
    "  --memories     write the frames' memories there, for second_opinion/run\n"
    "  --check        compare prices with direct counts of windows of the views of these scans, and print the table\n"
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
  if (argument_count == 3 && std::string_view(arguments[1]) == "--check") {
    gridiron::tool::Progress progress(true, "windows");
    auto counts = calibrate::count_windows(arguments[2], std::max(1u, std::thread::hardware_concurrency()),
                                           [&](std::size_t done, std::size_t total) { progress.update(done, total); });
    std::fputs(calibrate::direct_count_table(counts).c_str(), stdout);
    for (calibrate::DirectCount& frame : calibrate::count_effects()) counts.push_back(std::move(frame));
    std::fputs(calibrate::direct_count_kinds(counts).c_str(), stdout);
    return 0;
  }
  const bool of_bvh = argument_count > 1 && std::string_view(arguments[1]) == "--bvh";
  if (of_bvh) {
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
                  (of_bvh ? calibrate::bvh_report_text(calibrate::count_bvh_frames(rules))
                          : calibrate::report_text(calibrate::count_frames(rules)))
                      .c_str());
    }
    return 0;
  }
  // Nobody should wait for a count that cannot be written.
  (void)gridiron::tool::resolve_output(arguments[1]);
  const std::string text = of_bvh ? calibrate::bvh_table_text(calibrate::count_bvh_frames())
                                  : calibrate::table_text(calibrate::count_frames());
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
