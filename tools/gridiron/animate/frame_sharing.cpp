// Frame sharing. SPDX-License-Identifier: Apache-2.0
#include "frame_sharing.h"

#include <numeric>
#include <optional>
#include <utility>

#include "base/failure.h"
#include "base/kept_notes.h"
#include "base/ranks.h"
#include "base/stopwatch.h"
#include "base/value_bytes.h"
#include "files/input_file.h"
#include "pass_bytes.h"

namespace gridiron::tool {
namespace {

enum class FrameMessage : std::uint8_t {
  kPart,   ///< of the frame under way
  kWhole,  ///< a complete frame
};

constexpr double kSecondsBetweenParts = 0.25;

Bytes bytes_of_part(double part) {
  ByteWriter writer;
  writer.add(FrameMessage::kPart);
  writer.add(part);
  return writer.take();
}

void add_figures(ByteWriter& writer, const FrameFigures& figures) {
  writer.add(figures.triangles);
  writer.add(figures.lambda);
  writer.add(figures.build.has_value());
  if (figures.build) {
    writer.add(figures.build->cycles);
    writer.add(figures.build->seconds);
    writer.add(figures.build->builder);
    add_passes(writer, figures.build->passes);
  }
  writer.add(figures.is_timed);
  writer.add(figures.render_cycles);
  writer.add(figures.render_seconds);
  writer.add(figures.hash);
}

void take_figures(ByteReader& reader, FrameFigures& figures) {
  reader.take(figures.triangles);
  reader.take(figures.lambda);
  if (reader.take<bool>()) {
    BuildCost& build = figures.build.emplace();
    reader.take(build.cycles);
    reader.take(build.seconds);
    reader.take(build.builder);
    take_passes(reader, build.passes);
  }
  reader.take(figures.is_timed);
  reader.take(figures.render_cycles);
  reader.take(figures.render_seconds);
  reader.take(figures.hash);
}

Bytes bytes_of_frame(std::size_t i, const MadeFrame& made) {
  ByteWriter writer;
  writer.add(FrameMessage::kWhole);
  writer.add(std::uint64_t{i});
  writer.add(made.source);
  add_figures(writer, made.figures);
  writer.add(made.png);
  writer.add(made.note.has_value());
  if (made.note) writer.add(*made.note);
  writer.add(made.notes);
  writer.add(made.timeline);
  return writer.take();
}

MadeFrame take_frame(ByteReader& reader) {
  MadeFrame made;
  reader.take(made.source);
  take_figures(reader, made.figures);
  reader.take(made.png);
  if (reader.take<bool>()) reader.take(made.note.emplace());
  reader.take(made.notes);
  reader.take(made.timeline);
  return made;
}

}  // namespace

std::vector<std::size_t> share_frame_numbers(std::vector<std::size_t> numbers) {
  ByteWriter writer;
  writer.add(numbers);
  Bytes bytes = writer.take();
  ranks().broadcast(bytes);
  ByteReader(bytes).take(numbers);
  return numbers;
}

void require_shared_inputs(const AnimateRequest& request) {
  if (ranks().count() == 1 || request.has_moving_camera()) return;
  for (const std::filesystem::path& input : request.inputs) {
    if (!is_stream(input)) continue;
    usage_error(input.string() + ": each process reads the frames that it renders, so they must be files");
  }
}

void render_frames_for_first(const AnimateRequest& request) {
  Ranks& all = ranks();
  const std::unique_ptr<FrameMaker> maker = make_frame_maker(request);
  maker->prepare();
  const std::vector<std::size_t> numbers = share_frame_numbers({});
  if (!numbers.empty()) maker->begin();
  (void)take_notes();  // so far rank 0 has said the same
  Stopwatch since_part;
  const auto tell_part = [&](double part) {
    all.attend();
    if (since_part.seconds() < kSecondsBetweenParts || !all.has_told()) return;
    since_part = {};
    all.tell_first(bytes_of_part(part));
  };
  for (std::uint64_t k = 0; k < all.share_of(numbers.size()); ++k) {
    const std::size_t i = numbers[all.piece(k)];
    MadeFrame made = maker->make(i, request.timeline && i == 0, tell_part);
    made.notes = take_notes();
    all.tell_first(bytes_of_frame(i, made));
  }
}

FrameArrivals::FrameArrivals(Take take) : take_(std::move(take)), parts_(ranks().count()) {}

void FrameArrivals::take_arrived() {
  ranks().attend();
  while (const std::optional<RankMessage> message = ranks().poll()) take_message(message->rank, message->bytes);
}

void FrameArrivals::take_next() {
  const RankMessage message = ranks().wait_message();
  take_message(message.rank, message.bytes);
}

void FrameArrivals::take_message(std::size_t rank, const std::vector<std::byte>& bytes) {
  ByteReader reader(bytes);
  if (reader.take<FrameMessage>() == FrameMessage::kPart) {
    reader.take(parts_[rank]);
    return;
  }
  parts_[rank] = 0;
  const auto i = static_cast<std::size_t>(reader.take<std::uint64_t>());
  take_(i, take_frame(reader));
}

double FrameArrivals::parts() const {
  return std::accumulate(parts_.begin(), parts_.end(), 0.0);
}

}  // namespace gridiron::tool
