// result: a device's result as pictures and report, and compared with the simulator's.
// SPDX-License-Identifier: Apache-2.0
#include <report/device_report.h>
#include <report/report.h>

#include <algorithm>
#include <cstdio>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/failure.h"
#include "base/progress.h"
#include "base/words.h"
#include "commands.h"
#include "files/atomic_file.h"
#include "files/command_files.h"
#include "files/image_files.h"
#include "gridiron/frame/chip_frame.h"
#include "gridiron/frame/frame_pictures.h"
#include "gridiron/frame/unseen_scene.h"
#include "gridiron/job/job_comparison.h"
#include "gridiron/job/job_file.h"
#include "gridiron/job/prediction.h"
#include "gridiron/job/result_file.h"
#include "gridiron/scene/scene_points.h"

namespace gridiron::tool {
namespace {

void require_planes(const ResultRequest& request, const OpenJob& job) {
  const auto require = [&request](const char* option, bool wanted, std::uint64_t address) {
    if (wanted && address == 0) {
      usage_error(std::string(option) + ": " + request.job.string() + " was made without " + option);
    }
  };
  require("--depth", request.outputs.depth.has_value(), job.job.depth_address);
  require("--ids", request.outputs.ids.has_value(), job.job.ids_address);
  if (request.outputs.ids) require_exact_ids(request.job, job.image.header.triangle_count);
}

JobComparison compare(const ResultRequest& request, OpenJob& job, const OpenResult& result) {
  Progress progress(!request.quiet);
  const std::uint32_t threads = request.threads.value_or(this_host().threads);
  return compare_with_simulator(job, request.job, result, request.predict.get(), threads,
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

void print_prediction(const ResultRequest& request, std::span<const double> predicted,
                      std::span<const port::TileResult> tiles) {
  std::vector<double> counted;
  for (const port::TileResult& tile : tiles) counted.push_back(static_cast<double>(tile.instructions));
  const PredictionQuality quality = quality_of(counted, predicted);
  std::printf("%s: %s instructions counted, %s predicted: %+.1f %%\n", std::string(request.predict->name).c_str(),
              words_of_count(static_cast<std::uint64_t>(quality.counted)).c_str(),
              words_of_count(static_cast<std::uint64_t>(quality.predicted)).c_str(), 100 * quality.frame_error());
  std::printf("tiles: rank correlation %.3f, a tile off by %.1f %% at most\n", quality.rank_correlation,
              100 * quality.largest_tile_error);
}

auto find_unseen(const OpenJob& job, const OpenResult& result) {
  SeenPlanes planes{result.color, result.depth, result.ids};
  planes.has_environment = job.image.effects.environment_width != 0;
  const auto image =
      std::span(job.file.bytes).subspan(job.job.image_address - job.job.base_address, job.job.image_bytes);
  return unseen_note(job.record, planes,
                     [&job, image](const PointVisitor& visitor) { visit_points(job.image, image, visitor); });
}

}  // namespace

void run_command(const ResultRequest& request) {
  const FrameOutputs& outputs = request.outputs;
  declare_outputs(outputs.declared());
  OpenJob job = read_job_file(request.job);
  require_planes(request, job);
  const OpenResult result = read_result_file(request.result, job);
  if (request.predict && job.record.engine_id != sim::kGridEngine.id && sim::counts_instructions(*request.predict)) {
    usage_error("--predict: " + std::string(request.predict->name) +
                " counts instructions, which are not known of the tree's eye rays");
  }
  const auto is_counted = [](const port::TileResult& tile) { return tile.instructions != 0; };
  if (request.predict && !std::ranges::all_of(result.tiles, is_counted)) {
    usage_error("--predict: " + request.result.string() + " has no counted instructions");
  }
  const auto unseen = find_unseen(job, result);  // before the comparison takes the job's bytes
  std::optional<JobComparison> comparison;
  if (request.compare) comparison = compare(request, job, result);

  DeviceReportInput report;
  report.width = job.job.width;
  report.height = job.job.height;
  report.tile_width = job.job.tile_width;
  report.engine = sim::core_engine(job.record.engine_id);
  report.cores = result.cores();
  report.tiles = result.tiles;
  if (comparison) report.tile_work = comparison->tile_work;
  if (comparison) report.predicted_tiles = comparison->predicted_tiles;
  AtomicFiles files;
  const Picture<std::uint32_t> color = words_of_plane(job.record, result.color);
  report.image_hash = image_hash(color.pixels);
  if (outputs.picture) files.add(*outputs.picture, encode_picture(color, *outputs.picture));
  if (!result.depth.empty()) {
    const Picture<std::uint32_t> words = words_of_plane(job.record, result.depth);
    report.depth_hash = image_hash(words.pixels);
    if (outputs.depth) files.add(*outputs.depth, encode_pfm(depth_picture(words)));
  }
  if (!result.ids.empty()) {
    const Picture<std::uint32_t> words = words_of_plane(job.record, result.ids);
    report.ids_hash = image_hash(words.pixels);
    if (outputs.ids) files.add(*outputs.ids, encode_pfm(id_picture(words)));
  }
  if (outputs.report) files.add(*outputs.report, device_report_json(report));
  files.commit_at_end();

  if (!request.quiet) {
    tell_note(request.result, unseen);
    std::printf("%s: %ux%u, hash %s\n", request.result.c_str(), color.width, color.height,
                hash_text(report.image_hash).c_str());
    print_cores(result);
    if (comparison) print_comparison(*comparison);
    if (request.predict) print_prediction(request, comparison->predicted_tiles, result.tiles);
  }
  if (comparison && !comparison->is_equal()) {
    std::string message = request.result.string() + ": the device's frame differs from the simulator's:";
    for (const ComparedItem& item : comparison->items) {
      if (!item.equal) message += " " + item.name;
    }
    (void)std::fflush(stdout);
    throw Failure(ExitCode::kCheckFailed, message);
  }
}

}  // namespace gridiron::tool
