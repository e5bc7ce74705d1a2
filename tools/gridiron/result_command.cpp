// result: what a device made of a job, as pictures and report, and held against the simulator's.
// SPDX-License-Identifier: Apache-2.0
#include <report/device_report.h>
#include <report/report.h>

#include <cstdio>
#include <optional>
#include <string>

#include "atomic_file.h"
#include "chip_frame.h"
#include "commands.h"
#include "failure.h"
#include "frame_pictures.h"
#include "image_files.h"
#include "job_comparison.h"
#include "job_file.h"
#include "progress.h"
#include "result_file.h"
#include "words.h"

namespace gridiron::tool {
namespace {

void require_planes(const ResultArguments& arguments, const OpenJob& job) {
  const auto require = [&arguments](const char* option, bool wanted, std::uint64_t address) {
    if (wanted && address == 0) {
      throw Failure(ExitCode::kUsage,
                    std::string(option) + ": " + arguments.job.string() + " was made without " + option);
    }
  };
  require("--depth", arguments.depth.has_value(), job.job.depth_address);
  require("--ids", arguments.ids.has_value(), job.job.ids_address);
  if (arguments.ids) require_exact_ids(arguments.job, job.image.header.triangle_count);
}

JobComparison compare(const ResultArguments& arguments, const OpenJob& job, const OpenResult& result) {
  Progress progress(!arguments.quiet);
  const std::uint32_t threads = arguments.threads != 0 ? arguments.threads : host_threads();
  return compare_with_simulator(job, result, threads,
                                [&progress](std::uint32_t done, std::uint32_t total) { progress.update(done, total); });
}

void print_comparison(const JobComparison& comparison) {
  for (const ComparedItem& item : comparison.items) {
    std::printf("%-24s %s: %s\n", item.name.c_str(), item.equal ? "equal" : "different", item.detail.c_str());
  }
}

void print_cores(const OpenResult& result) {
  for (std::uint32_t i = 0; i < result.frame.core_count; ++i) {
    const port::CoreResult& core = result.frame.cores[i];
    std::printf("core %u: %s", i, words_of_count(core.tiles, "tile").c_str());
    if (core.instructions != 0) std::printf(", %s", words_of_count(core.instructions, "instruction").c_str());
    if (core.transfers != 0) std::printf(", %s", words_of_count(core.transfers, "transfer").c_str());
    if (core.stack_bytes != 0) std::printf(", %s of stack", words_of_count(core.stack_bytes, "byte").c_str());
    std::printf("\n");
  }
}

}  // namespace

void run_command(const ResultArguments& arguments) {
  for (const auto* path : {&arguments.output, &arguments.depth, &arguments.ids, &arguments.report}) {
    if (*path) check_can_write(**path);
  }
  const OpenJob job = read_job_file(arguments.job);
  require_planes(arguments, job);
  const OpenResult result = read_result_file(arguments.result, job);
  std::optional<JobComparison> comparison;
  if (arguments.compare) comparison = compare(arguments, job, result);

  DeviceReportInput report;
  report.width = job.job.width;
  report.height = job.job.height;
  report.tile_width = job.job.tile_width;
  report.cores = result.cores();
  report.tiles = result.tiles;
  if (comparison) report.tile_work = comparison->tile_work;
  AtomicFiles files;
  const Picture<std::uint32_t> color = words_of_plane(job.record, result.color);
  report.image_hash = image_hash(color.pixels);
  if (arguments.output) files.add(*arguments.output, encode_png(color));
  if (!result.depth.empty()) {
    const Picture<std::uint32_t> words = words_of_plane(job.record, result.depth);
    report.depth_hash = image_hash(words.pixels);
    if (arguments.depth) files.add(*arguments.depth, encode_pfm(depth_picture(words)));
  }
  if (!result.ids.empty()) {
    const Picture<std::uint32_t> words = words_of_plane(job.record, result.ids);
    report.ids_hash = image_hash(words.pixels);
    if (arguments.ids) files.add(*arguments.ids, encode_pfm(id_picture(words)));
  }
  if (arguments.report) files.add(*arguments.report, device_report_json(report));
  files.commit();

  if (!arguments.quiet) {
    std::printf("%s: %ux%u, hash %s\n", arguments.result.c_str(), color.width, color.height,
                hash_text(report.image_hash).c_str());
    print_cores(result);
    if (comparison) print_comparison(*comparison);
  }
  if (comparison && !comparison->is_equal()) {
    std::string message = arguments.result.string() + ": the device's frame differs from the simulator's:";
    for (const ComparedItem& item : comparison->items) {
      if (!item.equal) message += " " + item.name;
    }
    (void)std::fflush(stdout);
    throw Failure(ExitCode::kCheckFailed, message);
  }
}

}  // namespace gridiron::tool
