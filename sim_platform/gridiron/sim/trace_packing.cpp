// Packing of traces; see the header. Steps become bytes by predictions that both sides share; repetitions are removed
// last.
// Memory: the bytes of one tile, and tables, on the heap. Threads: one per object. SPDX-License-Identifier: Apache-2.0
#include <gridiron/sim/trace_packing.h>
#include <gridiron/sim/wait_levels.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

namespace gridiron::sim {

namespace {

// --- Numbers ----------------------------------------------------------------------------------------------------

/// Seven bits a byte, the lowest first; all but the last have the eighth set.
constexpr std::size_t kMostNumberBytes = 10;

[[nodiscard]] std::byte* put_number(std::byte* to, std::uint64_t value) {
  for (; value >= 0x80; value >>= 7) *to++ = static_cast<std::byte>(value | 0x80);
  *to++ = static_cast<std::byte>(value);
  return to;
}

[[nodiscard]] std::uint64_t take_number(const std::byte*& from) {
  std::uint64_t value = 0;
  for (std::uint32_t shift = 0;; shift += 7) {
    const auto byte = std::to_integer<std::uint64_t>(*from++);
    value |= (byte & 0x7F) << shift;
    if (byte < 0x80) return value;
  }
}

/// Small for distances near 0 on both sides.
[[nodiscard]] std::uint64_t folded(std::uint64_t distance) {
  return distance << 1 ^ (0 - (distance >> 63));
}
[[nodiscard]] std::uint64_t unfolded(std::uint64_t value) {
  return value >> 1 ^ (0 - (value & 1));
}

/// Hashes keys to places of a table. A collision only makes predictions worse.
template <std::uint32_t kBits>
[[nodiscard]] std::uint32_t slot_of(std::uint64_t key) {
  return static_cast<std::uint32_t>((key * 0x9E3779B97F4A7C15u) >> (64 - kBits));
}

// --- Repetitions ------------------------------------------------------------------------------------------------

/// Bytes that occurred before are replaced by their distance (Ziv, Lempel 1977): pairs of literal bytes and of bytes to
/// repeat, after a byte with both counts; a repeat has at least kLeastRepeat.
constexpr std::uint32_t kLeastRepeat = 4, kCountBits = 4, kMostCount = (1u << kCountBits) - 1;
constexpr std::uint32_t kFar = 1u << 14;  ///< distances from here on take three bytes
constexpr std::uint32_t kMostPlaceBits = 14;

[[nodiscard]] std::uint32_t four_bytes(const std::byte* from) {
  std::uint32_t value = 0;
  std::memcpy(&value, from, sizeof value);
  return value;
}

/// Working memory of packing, reused from tile to tile.
struct RepetitionTables {
  std::vector<std::uint32_t> places;  ///< where four bytes stood last, by their hash
  std::vector<std::byte> packed;
};

[[nodiscard]] std::vector<std::byte> without_repetitions(std::span<const std::byte> bytes, RepetitionTables& tables) {
  const std::byte* const begin = bytes.data();
  const std::size_t count = bytes.size();
  const auto bits = std::clamp(static_cast<std::uint32_t>(std::bit_width(count)), 8u, kMostPlaceBits);
  tables.places.assign(std::size_t{1} << bits, 0);  // 0 stands for the beginning, a place like any other

  // Heads are fewer than a fourth of the bytes that they replace, and repeats are no longer than those.
  const std::size_t most = count + count / 4 + 4 * kMostNumberBytes;
  if (tables.packed.size() < most) tables.packed.resize(most);
  std::byte* to = put_number(tables.packed.data(), count);
  const auto put_pair = [&](std::size_t own_begin, std::size_t own_end, std::size_t repeated, std::size_t distance) {
    const std::size_t own = own_end - own_begin, more = repeated - kLeastRepeat;
    const std::size_t own_head = std::min<std::size_t>(own, kMostCount);
    const std::size_t more_head = std::min<std::size_t>(more, kMostCount);
    *to++ = static_cast<std::byte>(own_head << kCountBits | more_head);
    if (own_head == kMostCount) to = put_number(to, own - kMostCount);
    to = std::copy(begin + own_begin, begin + own_end, to);
    to = put_number(to, distance);
    if (more_head == kMostCount) to = put_number(to, more - kMostCount);
  };
  std::size_t own_begin = 0, at = 1;
  while (at + kLeastRepeat <= count) {
    const std::uint32_t four = four_bytes(begin + at);
    std::uint32_t& place = tables.places[four * 0x9E3779B1u >> (32 - bits)];
    const std::size_t earlier = place;
    place = static_cast<std::uint32_t>(at);
    const std::size_t distance = at - earlier;
    if (four_bytes(begin + earlier) != four) {
      ++at;
      continue;
    }
    std::size_t repeated = kLeastRepeat;
    while (at + repeated < count && begin[earlier + repeated] == begin[at + repeated]) ++repeated;
    if (distance >= kFar && repeated == kLeastRepeat) {  // would be as long as the bytes it replaces
      ++at;
      continue;
    }
    put_pair(own_begin, at, repeated, distance);
    at += repeated;
    own_begin = at;
  }
  // A distance of 0 ends the bytes.
  if (own_begin < count) put_pair(own_begin, count, kLeastRepeat, 0);
  return std::vector<std::byte>(tables.packed.data(), to);
}

/// Appends to `bytes` the input of without_repetitions. @returns its end.
const std::byte* with_repetitions(const std::byte* from, std::vector<std::byte>& bytes) {
  const std::size_t count = take_number(from);
  if (bytes.size() < count) bytes.resize(count);
  std::byte* to = bytes.data();
  std::byte* const end = to + count;
  while (to != end) {
    const auto head = std::to_integer<std::size_t>(*from++);
    std::size_t own = head >> kCountBits, repeated = (head & kMostCount) + kLeastRepeat;
    if (own == kMostCount) own += take_number(from);
    to = std::copy(from, from + own, to);
    from += own;
    const std::size_t distance = take_number(from);
    if (repeated == kMostCount + kLeastRepeat) repeated += take_number(from);
    if (distance == 0) break;
    for (const std::byte* earlier = to - distance; repeated > 0; --repeated) *to++ = *earlier++;
  }
  return end;
}

// --- Steps ------------------------------------------------------------------------------------------------------

/// The kinds of work in a step: a bit each.
struct Kinds {
  std::uint64_t words[2] = {};

  [[nodiscard]] bool is_empty() const { return (words[0] | words[1]) == 0; }
  [[nodiscard]] bool has(std::uint32_t kind) const { return (words[kind / 64] >> (kind % 64) & 1) != 0; }
  void insert(std::uint32_t kind) { words[kind / 64] |= std::uint64_t{1} << (kind % 64); }
  friend constexpr bool operator==(const Kinds&, const Kinds&) = default;
};
static_assert(kWorkKindCount <= 128, "two words hold all kinds");

/// In the order of their numbers.
template <class Visit>
void for_each_kind(const Kinds& kinds, Visit&& visit) {
  for (std::uint32_t first = 0; first < 128; first += 64) {
    for (std::uint64_t word = kinds.words[first / 64]; word != 0; word &= word - 1) {
      visit(first + static_cast<std::uint32_t>(std::countr_zero(word)));
    }
  }
}

/// Work, and the event after it, unless more work follows.
struct Step {
  enum class End : std::uint8_t { kNothing, kGet, kPut, kWait, kStage };

  Kinds kinds;
  std::array<std::uint32_t, kWorkKindCount> amounts{};  ///< of the kinds that there are, others are 0
  End end = End::kNothing;
  TraceEvent event;  ///< the event after it; only its own members are set

  void add(const WorkAmount& work) {
    amounts[work.kind.number()] += work.amount;
    if (work.amount != 0) kinds.insert(work.kind.number());
  }
  void clear() {
    for_each_kind(kinds, [&](std::uint32_t kind) { amounts[kind] = 0; });
    kinds = {};
  }
  [[nodiscard]] bool is_transfer() const { return end == End::kGet || end == End::kPut; }
};

/// A step without its numbers. There are few, and a tile numbers them in the order of their first use.
struct Shape {
  Kinds kinds;
  Kinds unexpected;         ///< of these: amounts are other than expected
  std::uint64_t masks = 0;  ///< kWait for other than one plain tag: the tags, rotating ones in the lower half
  std::uint32_t end = 0;    ///< Step::End, flags, and from kFirstTagBit on the tag or stage

  static constexpr std::uint32_t kEndMask = 7, kMasks = 8, kRotating = 8, kFollows = 16, kUnaligned = 32;
  static constexpr std::uint32_t kOtherBytes = 64;
  static constexpr std::uint32_t kFirstTagBit = 7;

  friend constexpr bool operator==(const Shape&, const Shape&) = default;
  [[nodiscard]] std::uint64_t key() const {
    constexpr std::uint64_t kFactor = 0xD1B54A32D192ED03u;
    std::uint64_t key = 0;
    for (const std::uint64_t part : {kinds.words[0], kinds.words[1], unexpected.words[0], unexpected.words[1], masks}) {
      key = key * kFactor + part;
    }
    return key * kFactor + end;
  }
};

[[nodiscard]] bool has_masks(const Shape& shape) {
  return (shape.end & Shape::kEndMask) == static_cast<std::uint32_t>(Step::End::kWait) &&
         (shape.end & Shape::kMasks) != 0;
}

/// The predictions for a step from those before it, the same for the writer and the reader.
class Expectations {
 public:
  /// Buffers take turns, so a tag is stored as its difference from the one last waited for.
  [[nodiscard]] std::uint8_t waited_tag() const { return waited_tag_; }

  /// Triangles follow those that arrived, other bytes follow the last ones of their buffer.
  [[nodiscard]] std::uint64_t address(std::uint32_t tag) const {
    return wait_level_of_tag(tag) == WaitLevel::kTriangle ? arrived_end_ : buffers_[tag % buffers_.size()].address;
  }
  /// Cells follow one another as before: the next address after the last get of the same bytes at this level.
  [[nodiscard]] std::uint64_t& following(std::uint32_t tag) {
    return following_[slot_of<kFollowingBits>(arrived_end_ * 4 + static_cast<std::uint64_t>(wait_level_of_tag(tag)))];
  }
  /// Each address has the same number of bytes every time.
  [[nodiscard]] std::uint32_t& bytes_at(std::uint64_t address) { return bytes_at_[slot_of<kBytesBits>(address)]; }

  /// Most kinds occur once. A mailbox is probed for every triangle that arrived.
  [[nodiscard]] std::uint32_t& amount(std::uint32_t kind) {
    if (kind == static_cast<std::uint32_t>(GridWork::kMailboxProbe))
      return probes_[arrived_bytes_ / 16 % probes_.size()];
    one_ = 1;
    return one_;
  }

  void note_end(const Step& step) {
    if (step.is_transfer()) {
      following(step.event.tag) = step.event.address;
      Buffer& buffer = buffers_[step.event.tag % buffers_.size()];
      buffer = {step.event.address, step.event.bytes};
      arrived_end_ = buffer.address + buffer.bytes;
      bytes_at(buffer.address) = buffer.bytes;
    } else if (step.end == Step::End::kWait && step.event.tags != 0) {
      waited_tag_ = static_cast<std::uint8_t>(std::bit_width(step.event.tags) - 1);
      const Buffer& buffer = buffers_[waited_tag_];
      arrived_end_ = buffer.address + buffer.bytes;
      arrived_bytes_ = buffer.bytes;
    }
  }

 private:
  static constexpr std::uint32_t kFollowingBits = 11, kBytesBits = 10;
  struct Buffer {
    std::uint64_t address = 0;
    std::uint32_t bytes = 0;
  };
  std::array<Buffer, 32> buffers_{};  ///< by tag: what was got last
  std::uint8_t waited_tag_ = 0;       ///< of the last wait
  std::uint64_t arrived_end_ = 0;     ///< of the last arrival, or got since
  std::uint32_t arrived_bytes_ = 0;
  std::uint32_t one_ = 1;
  std::array<std::uint32_t, 64> probes_{};
  std::array<std::uint32_t, 1u << kBytesBits> bytes_at_{};
  std::array<std::uint64_t, 1u << kFollowingBits> following_{};
};

}  // namespace

// --- Writer -----------------------------------------------------------------------------------------------------

struct TraceWriter::State {
  static constexpr std::uint32_t kPlaceBits = 12;
  static constexpr std::size_t kMostStepBytes = (kWorkKindCount + 8) * kMostNumberBytes;

  Step step;
  Expectations expectations;
  std::vector<Shape> shapes;                                   ///< of the tile, as they came
  std::array<std::uint32_t, 1u << kPlaceBits> shape_places{};  ///< number of a shape, from 1, by its hash
  std::vector<std::byte> bytes;
  std::size_t byte_count = 0;
  RepetitionTables repetitions;

  /// Returns `step` without its numbers, and updates what was expected of these.
  Shape take_shape() {
    Shape shape;
    shape.kinds = step.kinds;
    shape.end = static_cast<std::uint32_t>(step.end);
    for_each_kind(step.kinds, [&](std::uint32_t kind) {
      std::uint32_t& expected = expectations.amount(kind);
      if (expected != step.amounts[kind]) shape.unexpected.insert(kind);
      expected = step.amounts[kind];
    });
    const TraceEvent& event = step.event;
    const auto set_tag = [&](std::uint32_t tag) {
      shape.end |= (tag ^ expectations.waited_tag()) << Shape::kFirstTagBit;
    };
    if (step.is_transfer()) {
      set_tag(event.tag);
      if (event.rotating) shape.end |= Shape::kRotating;
      if (event.address == expectations.following(event.tag)) {
        shape.end |= Shape::kFollows;
      } else if ((event.address - expectations.address(event.tag)) % 16 != 0) {
        shape.end |= Shape::kUnaligned;
      }
      if (event.bytes != expectations.bytes_at(event.address)) shape.end |= Shape::kOtherBytes;
    } else if (step.end == Step::End::kStage) {
      shape.end |= static_cast<std::uint32_t>(event.stage) << Shape::kFirstTagBit;
    } else if (step.end == Step::End::kWait) {
      if (std::has_single_bit(event.tags) && event.rotating_tags == 0) {
        set_tag(static_cast<std::uint32_t>(std::countr_zero(event.tags)));
      } else {
        shape.end |= Shape::kMasks;
        shape.masks = std::uint64_t{event.tags} << 32 | event.rotating_tags;
      }
    }
    return shape;
  }

  void end_step(Step::End end, const TraceEvent& event) {
    if (bytes.size() < byte_count + kMostStepBytes) bytes.resize(2 * bytes.size() + kMostStepBytes);
    std::byte* to = bytes.data() + byte_count;
    step.end = end;
    step.event = event;

    const Shape shape = take_shape();
    std::uint32_t& place = shape_places[slot_of<kPlaceBits>(shape.key())];
    if (place != 0 && shapes[place - 1] == shape) {
      to = put_number(to, place);
    } else {
      *to++ = std::byte{0};
      for (const Kinds& kinds : {shape.kinds, shape.unexpected})
        to = put_number(put_number(to, kinds.words[1]), kinds.words[0]);
      to = put_number(to, shape.end);
      if (has_masks(shape)) to = put_number(to, shape.masks);
      shapes.push_back(shape);
      place = static_cast<std::uint32_t>(shapes.size());
    }
    for_each_kind(shape.unexpected, [&](std::uint32_t kind) { to = put_number(to, step.amounts[kind]); });
    if (step.is_transfer()) {
      if ((shape.end & Shape::kFollows) == 0) {
        const std::uint64_t distance = event.address - expectations.address(event.tag);
        const auto in_sixteens = static_cast<std::uint64_t>(static_cast<std::int64_t>(distance) / 16);
        to = put_number(to, folded((shape.end & Shape::kUnaligned) != 0 ? distance : in_sixteens));
      }
      if ((shape.end & Shape::kOtherBytes) != 0) to = put_number(to, event.bytes);
    }
    byte_count = static_cast<std::size_t>(to - bytes.data());
    expectations.note_end(step);
    step.clear();
  }
};

TraceWriter::TraceWriter() : state_(std::make_unique<State>()) {}
TraceWriter::~TraceWriter() = default;

void TraceWriter::add(const TraceEvent& event) {
  State& state = *state_;
  switch (event.kind) {
    case EventKind::kWork:
      if (!state.step.kinds.is_empty()) state.end_step(Step::End::kNothing, {});
      for (const WorkAmount& work : event.work) state.step.add(work);
      return;
    case EventKind::kGet:
      return state.end_step(Step::End::kGet, event);
    case EventKind::kPut:
      return state.end_step(Step::End::kPut, event);
    case EventKind::kWait:
      return state.end_step(Step::End::kWait, event);
    case EventKind::kStage:
      return state.end_step(Step::End::kStage, event);
  }
}

TileTrace TraceWriter::finish(std::uint32_t tile_id) {
  State& state = *state_;
  if (!state.step.kinds.is_empty()) state.end_step(Step::End::kNothing, {});
  TileTrace trace = {tile_id, {}};
  if (state.byte_count == 0) return trace;
  trace.packed = without_repetitions(std::span(state.bytes).first(state.byte_count), state.repetitions);
  state.expectations = {};
  state.shapes.clear();
  state.shape_places.fill(0);
  state.byte_count = 0;
  return trace;
}

// --- Reader -----------------------------------------------------------------------------------------------------

struct TraceReader::State {
  std::vector<std::byte> bytes;
  const std::byte* next = nullptr;
  const std::byte* end = nullptr;
  Expectations expectations;
  std::vector<Shape> shapes;
  Step step;
  bool is_end_next = false;  ///< the work was read; the event after it comes next
  std::array<WorkAmount, kWorkKindCount> work;
  TraceEvent work_event{.kind = EventKind::kWork};

  void take_step() {
    const std::uint64_t number = take_number(next);
    if (number == 0) {
      Shape& shape = shapes.emplace_back();
      for (Kinds* const kinds : {&shape.kinds, &shape.unexpected}) {
        kinds->words[1] = take_number(next);
        kinds->words[0] = take_number(next);
      }
      shape.end = static_cast<std::uint32_t>(take_number(next));
      if (has_masks(shape)) shape.masks = take_number(next);
    }
    const Shape& shape = number == 0 ? shapes.back() : shapes[number - 1];
    step.clear();
    step.kinds = shape.kinds;
    step.end = static_cast<Step::End>(shape.end & Shape::kEndMask);
    take_work(shape);
    take_end(shape);
    expectations.note_end(step);
  }

  void take_work(const Shape& shape) {
    WorkAmount* amount = work.data();
    for_each_kind(shape.kinds, [&](std::uint32_t kind) {
      std::uint32_t& expected = expectations.amount(kind);
      if (shape.unexpected.has(kind)) expected = static_cast<std::uint32_t>(take_number(next));
      step.amounts[kind] = expected;
      *amount++ = {WorkId(kind), expected};
    });
    work_event.work = {work.data(), amount};
  }

  void take_end(const Shape& shape) {
    const std::uint32_t tag = shape.end >> Shape::kFirstTagBit ^ expectations.waited_tag();
    TraceEvent& event = step.event;
    switch (step.end) {
      case Step::End::kNothing:
        return;
      case Step::End::kGet:
      case Step::End::kPut: {
        event = {.kind = step.end == Step::End::kGet ? EventKind::kGet : EventKind::kPut,
                 .tag = static_cast<std::uint8_t>(tag),
                 .rotating = (shape.end & Shape::kRotating) != 0};
        if ((shape.end & Shape::kFollows) != 0) {
          event.address = expectations.following(tag);
        } else {
          const std::uint64_t distance = unfolded(take_number(next));
          event.address = expectations.address(tag) + ((shape.end & Shape::kUnaligned) != 0 ? distance : distance * 16);
        }
        event.bytes = (shape.end & Shape::kOtherBytes) != 0 ? static_cast<std::uint32_t>(take_number(next))
                                                            : expectations.bytes_at(event.address);
        return;
      }
      case Step::End::kWait:
        event = {.kind = EventKind::kWait,
                 .tags = has_masks(shape) ? static_cast<std::uint32_t>(shape.masks >> 32) : 1u << tag,
                 .rotating_tags = static_cast<std::uint32_t>(shape.masks)};
        return;
      case Step::End::kStage:
        event = {.kind = EventKind::kStage, .stage = static_cast<Stage>(shape.end >> Shape::kFirstTagBit)};
        return;
    }
  }
};

TraceReader::TraceReader() : state_(std::make_unique<State>()) {}
TraceReader::~TraceReader() = default;
TraceReader::TraceReader(TraceReader&&) noexcept = default;
TraceReader& TraceReader::operator=(TraceReader&&) noexcept = default;

void TraceReader::open(const TileTrace& trace) {
  State& state = *state_;
  state.is_end_next = false;
  state.next = state.end = nullptr;
  if (trace.packed.empty()) return;
  state.end = with_repetitions(trace.packed.data(), state.bytes);
  state.next = state.bytes.data();
  state.expectations = {};
  state.shapes.clear();
}

const TraceEvent* TraceReader::next() {
  State& state = *state_;
  if (!state.is_end_next) {
    if (state.next == state.end) return nullptr;
    state.take_step();
    state.is_end_next = state.step.end != Step::End::kNothing;
    if (!state.step.kinds.is_empty()) return &state.work_event;
  }
  state.is_end_next = false;
  return &state.step.event;
}

}  // namespace gridiron::sim
