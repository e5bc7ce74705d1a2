// Whether the frame record of a job is that of the job: what workers read and transfers go by.
// Memory: reads the job. Threads: the master, integers only. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/firmware/frame_job.h>

namespace gridiron::port {

/// Holds the frame record against the job and the head of its scene image: size, tiles, planes, accuracy, shading,
/// effects, and every section of the image that the workers fetch from, which must lie in the image. What the sections
/// hold is not looked at: a board bounds what follows from it.
///
/// @param job  all of it checked otherwise: record and image lie in it.
/// @returns whether it may run; if not, a line on the console names the field.
[[nodiscard]] bool check_record(const FrameJob& job);

}  // namespace gridiron::port
