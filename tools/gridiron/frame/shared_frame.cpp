// Shared frame. SPDX-License-Identifier: Apache-2.0
#include "shared_frame.h"

#include <gridiron/sim/borrowed_region.h>

#include <algorithm>
#include <cstring>
#include <string>

#include "base/ranks.h"

namespace gridiron::tool {
namespace {

// Where things lie in main memory.
struct FramePlaces {
  std::uint64_t capacity_bytes = 0, used_bytes = 0;
  MainAddress image{}, record{}, color{}, depth{}, ids{}, spill{};
  std::uint64_t image_bytes = 0, plane_bytes = 0, spill_bytes = 0, spill_bytes_per_core = 0;
  bool has_depth = false, has_ids = false;
  std::uint32_t ground_begin = kNoTriangle;
};

FramePlaces places_of(const FrameMemory& frame) {
  FramePlaces places;
  places.capacity_bytes = frame.memory.capacity_bytes();
  places.used_bytes = frame.memory.used_bytes();
  places.image = frame.image_address;
  places.record = frame.record_address;
  places.color = frame.color.address;
  places.depth = frame.depth.address;
  places.ids = frame.ids.address;
  places.spill = frame.spill.address;
  places.image_bytes = frame.image.header.image_bytes;
  places.plane_bytes = frame.color.bytes.size();
  places.spill_bytes = frame.spill.bytes.size();
  places.spill_bytes_per_core = frame.spill_bytes_per_core;
  places.ground_begin = frame.ground_begin;
  places.has_depth = !frame.depth.bytes.empty();
  places.has_ids = !frame.ids.bytes.empty();
  return places;
}

// The same main memory as on rank 0; nothing lies there yet.
void make_places(FrameMemory& frame, const FramePlaces& places) {
  const auto region = [&frame](MainAddress address, std::uint64_t bytes) {
    return sim::MemoryRegion{address, frame.memory.bytes_at(address, bytes)};
  };
  if (!frame.memory.allocate(places.used_bytes, 1)) {
    throw Failure(ExitCode::kBadInput, "the main memory of a frame is too small on this host");
  }
  frame.image_address = places.image;
  frame.ground_begin = places.ground_begin;
  frame.record_address = places.record;
  frame.color = region(places.color, places.plane_bytes);
  if (places.has_depth) frame.depth = region(places.depth, places.plane_bytes);
  if (places.has_ids) frame.ids = region(places.ids, places.plane_bytes);
  if (places.spill_bytes != 0) frame.spill = region(places.spill, places.spill_bytes);
  frame.spill_bytes_per_core = places.spill_bytes_per_core;
  std::memcpy(region(places.record, sizeof(FrameRecord)).bytes.data(), &frame.record, sizeof(FrameRecord));
}

}  // namespace

void add_plan(ByteWriter& writer, const RenderPlan& plan) {
  writer.add(std::string(plan.scene.configuration->name));
  writer.add(plan.has_depth);
  writer.add(plan.has_ids);
  writer.add(plan.width);
  writer.add(plan.height);
  writer.add(plan.tile);
  writer.add(plan.cores);
  writer.add(plan.threads);
  writer.add(plan.lanes);
  writer.add(plan.layout);
  writer.add(plan.most_macro_width);
  writer.add(plan.depths);
  writer.add(plan.engine);
  writer.add(plan.techniques);
  writer.add(plan.accuracy);
  writer.add(plan.shading);
  writer.add(plan.mode);
  writer.add(plan.completion);
  writer.add(plan.seed);
  writer.add(plan.repeats);
  writer.add(plan.has_bound);
  writer.add(plan.builder);
}

RenderPlan take_plan(ByteReader& reader, const RenderRequest& request) {
  RenderPlan plan;
  plan.scene = request.scene;
  std::string configuration;
  reader.take(configuration);
  plan.scene.configuration = find_configuration(configuration);
  const Host host = this_host();
  plan.threads = request.threads.value_or(host.threads);
  reader.take(plan.has_depth);
  reader.take(plan.has_ids);
  reader.take(plan.width);
  reader.take(plan.height);
  reader.take(plan.tile);
  reader.take(plan.cores);
  const auto threads_of_first = reader.take<std::uint32_t>();
  reader.take(plan.lanes);
  reader.take(plan.layout);
  reader.take(plan.most_macro_width);
  reader.take(plan.depths);
  reader.take(plan.engine);
  reader.take(plan.techniques);
  reader.take(plan.accuracy);
  reader.take(plan.shading);
  reader.take(plan.mode);
  reader.take(plan.completion);
  reader.take(plan.seed);
  reader.take(plan.repeats);
  reader.take(plan.has_bound);
  reader.take(plan.builder);
  // The frame has memory for waiting rays of as many threads as rank 0 has.
  if (plan.shading == Shading::kScene) plan.threads = std::min(plan.threads, threads_of_first);
  // Lanes change no picture; those of rank 0's host may not be here.
  if (plan.mode == sim::Mode::kPlain && !request.lanes) plan.lanes = std::min(plan.lanes, host.lanes);
  return plan;
}

void share_frame(std::optional<FrameMemory>& frame) {
  Ranks& all = ranks();
  if (all.count() == 1) return;
  Bytes head;
  if (all.is_first()) {
    ByteWriter writer;
    writer.add(places_of(*frame));
    writer.add(frame->image);
    writer.add(frame->settings);
    writer.add(frame->record);
    head = writer.take();
  }
  all.broadcast(head);
  ByteReader reader(head);
  const auto places = reader.take<FramePlaces>();
  if (!all.is_first()) {
    frame.reset();
    frame.emplace(places.capacity_bytes);
    reader.take(frame->image);
    reader.take(frame->settings);
    reader.take(frame->record);
    make_places(*frame, places);
  }
  const sim::MemoryRegion image{places.image, frame->memory.bytes_at(places.image, places.image_bytes)};
  all.share_bytes(image.bytes, "the scene", [&image](std::uint64_t begin, std::span<std::byte> shared) {
    (void)sim::borrow_bytes({image.address.offset_by(begin), image.bytes.subspan(begin, shared.size())}, shared);
  });
}

}  // namespace gridiron::tool
