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

// The fields of each struct are named once, for both directions.
template <class Run, class Visit>
void visit_run(Run& run, const Visit& visit) {
  visit(run.failure);
  visit(run.facts);
  visit(run.timing.frame_cycles);
  visit(run.timing.seconds);
  visit(run.timing.channel_busy_cycles);
  visit(run.timing.cores);
  visit(run.timing.timeline);
  visit(run.caches);
  visit(run.build_cycles);
  visit(run.build_seconds);
}

template <class Frame, class Visit>
void visit_frame(Frame& frame, const Visit& visit) {
  visit(frame.called_for);
  visit(frame.has_shadows);
  visit(frame.work);
  visit(frame.stages);
  visit(frame.cycles);
  visit(frame.seconds);
  visit(frame.core_cycles);
  visit(frame.scene_bytes);
  visit(frame.picture.width);
  visit(frame.picture.height);
  visit(frame.picture.pixels);
}

auto writing(tool::ByteWriter& writer) {
  return [&writer](const auto& field) { writer.add(field); };
}

auto reading(tool::ByteReader& reader) {
  return [&reader](auto& field) { reader.take(field); };
}

}  // namespace

void add_run(tool::ByteWriter& writer, const RunResult& run) {
  writer.add(run.timing.engine->id);
  visit_run(run, writing(writer));
  tool::add_passes(writer, run.passes);
}

void take_run(tool::ByteReader& reader, RunResult& run) {
  run.timing.engine = engine_with(reader.take<std::uint32_t>());
  visit_run(run, reading(reader));
  tool::take_passes(reader, run.passes);
}

tool::Bytes bytes_of_frame(const EffectFrame& frame) {
  tool::ByteWriter writer;
  visit_frame(frame, writing(writer));
  return writer.take();
}

void take_frame(const tool::Bytes& bytes, EffectFrame& frame) {
  tool::ByteReader reader(bytes);
  visit_frame(frame, reading(reader));
}

}  // namespace gridiron::experiment
