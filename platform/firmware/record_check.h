// Checks that the frame record of a job agrees with the job: the fields that workers and transfers rely on.
// Memory: reads the job. Threads: the master, integers only. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/firmware/frame_job.h>

namespace gridiron::port {

/// Checks the frame record against the job and the head of its scene image: size, tiles, planes, accuracy, shading,
/// effects, and that every section that the workers fetch lies in the image. The contents of the sections are not
/// checked: the board limits what they can cause.
///
/// @param job  must have passed all other checks: record and image lie in it.
/// @returns whether it may run; if not, a line on the console names the field.
[[nodiscard]] bool check_record(const FrameJob& job);

}  // namespace gridiron::port
