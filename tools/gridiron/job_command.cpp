// job: a frame becomes the file that a device is given. SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <cstring>
#include <utility>

#include "base/failure.h"
#include "base/progress.h"
#include "base/words.h"
#include "commands.h"
#include "files/atomic_file.h"
#include "files/command_files.h"
#include "gridiron/frame/frame_memory.h"
#include "gridiron/frame/requested_frame.h"
#include "gridiron/job/job_file.h"

namespace gridiron::tool {

void run_command(const JobRequest& request) {
  const bool quiet = request.render.scene.quiet;
  const StageLines stages(!quiet);
  RequestedFrame requested = read_requested_frame(request.render, {{"-o", request.output, OutputKind::kBinary}});
  const RenderPlan& plan = requested.plan;
  FrameMemory frame(frame_memory_bytes(requested.input, plan));
  prepare_frame(frame, std::move(requested.input), plan, requested.view);
  const std::vector<std::byte> file = make_job_file(frame, plan, request.base_address);

  port::FrameJob job{};
  std::memcpy(&job, file.data(), sizeof job);
  if (request.memory_bytes && job.memory_bytes > *request.memory_bytes) {
    input_error(requested.input.path, "the job needs " + words_of_count(job.memory_bytes) +
                                          " bytes of memory, --memory allows " + words_of_count(*request.memory_bytes));
  }
  AtomicFiles files;
  files.add(request.output, file);
  files.commit_at_end();
  if (quiet) return;
  std::printf("%s: %ux%u in %s, %s to load at 0x%llx, %s of memory\n", target_of(request.output).name.c_str(),
              job.width, job.height, words_of_count(job.tile_count, "tile").c_str(),
              words_of_bytes(job.loaded_bytes).c_str(), static_cast<unsigned long long>(job.base_address),
              words_of_bytes(job.memory_bytes).c_str());
}

}  // namespace gridiron::tool
