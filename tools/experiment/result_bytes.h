// Results of runs and of frames with effects as bytes, for other ranks.
// Memory: std::vector. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/value_bytes.h"
#include "experiment/effect_frames.h"
#include "experiment/plan.h"

namespace gridiron::experiment {

void add_run(tool::ByteWriter& writer, const RunResult& run);
void take_run(tool::ByteReader& reader, RunResult& run);

[[nodiscard]] tool::Bytes bytes_of_frame(const EffectFrame& frame);
void take_frame(const tool::Bytes& bytes, EffectFrame& frame);

}  // namespace gridiron::experiment
