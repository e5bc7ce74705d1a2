// Results as bytes. SPDX-License-Identifier: Apache-2.0
#include "experiment/result_bytes.h"

#include <gridiron/bvh/bvh_engine_work.h>

#include "gridiron/animate/pass_bytes.h"

namespace gridiron::experiment {
namespace {

// An address means nothing to another process.
const sim::EngineWork* engine_with(std::uint32_t id) {
  return id == bvh::kBvhEngine.id ? &bvh::kBvhEngine : sim::core_engine(id);
}

}  // namespace

void add_run(tool::ByteWriter& writer, const RunResult& run) {
  writer.add(run.failure);
  writer.add(run.facts);
  writer.add(run.timing.engine->id);
  writer.add(run.timing.frame_cycles);
  writer.add(run.timing.seconds);
  writer.add(run.timing.channel_busy_cycles);
  writer.add(run.timing.cores);
  writer.add(run.timing.timeline);
  writer.add(run.caches);
  writer.add(run.build_cycles);
  writer.add(run.build_seconds);
  tool::add_passes(writer, run.passes);
}

void take_run(tool::ByteReader& reader, RunResult& run) {
  reader.take(run.failure);
  reader.take(run.facts);
  run.timing.engine = engine_with(reader.take<std::uint32_t>());
  reader.take(run.timing.frame_cycles);
  reader.take(run.timing.seconds);
  reader.take(run.timing.channel_busy_cycles);
  reader.take(run.timing.cores);
  reader.take(run.timing.timeline);
  reader.take(run.caches);
  reader.take(run.build_cycles);
  reader.take(run.build_seconds);
  tool::take_passes(reader, run.passes);
}

tool::Bytes bytes_of_frame(const EffectFrame& frame) {
  tool::ByteWriter writer;
  writer.add(frame.called_for);
  writer.add(frame.has_shadows);
  writer.add(frame.work);
  writer.add(frame.stages);
  for (const double value : {frame.cycles, frame.seconds, frame.core_cycles}) writer.add(value);
  writer.add(frame.scene_bytes);
  writer.add(frame.picture.width);
  writer.add(frame.picture.height);
  writer.add(frame.picture.pixels);
  return writer.take();
}

void take_frame(const tool::Bytes& bytes, EffectFrame& frame) {
  tool::ByteReader reader(bytes);
  reader.take(frame.called_for);
  reader.take(frame.has_shadows);
  reader.take(frame.work);
  reader.take(frame.stages);
  for (double* const value : {&frame.cycles, &frame.seconds, &frame.core_cycles}) reader.take(*value);
  reader.take(frame.scene_bytes);
  reader.take(frame.picture.width);
  reader.take(frame.picture.height);
  reader.take(frame.picture.pixels);
}

}  // namespace gridiron::experiment
