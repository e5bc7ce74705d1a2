// Packing of traces; see the header. One function, code_step, is writer and reader alike: what it knows is the same on
// both sides, and a coder that is given a bit either stores it or replaces it by the one that was stored.
// Memory: the model of a stream, on the heap. Threads: one per object. SPDX-License-Identifier: Apache-2.0
#include <gridiron/sim/trace_packing.h>
#include <gridiron/sim/wait_levels.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

namespace gridiron::sim {

namespace {

// --- Coder ------------------------------------------------------------------------------------------------------

/// Probability that a bit is 1, in 1/65536; it follows what it sees.
struct Chance {
  static constexpr std::uint32_t kRate = 4;
  std::uint16_t one = 1 << 15;

  void learn(bool bit) {
    one = static_cast<std::uint16_t>(bit ? one + ((65535u - one) >> kRate) : one - (one >> kRate));
  }
};

/// Where the interval [low, high] is cut: the lower part means 1.
[[nodiscard]] std::uint64_t cut_of(std::uint64_t low, std::uint64_t high, std::uint32_t one) {
  return low + ((high - low) >> 16) * one;
}

[[nodiscard]] bool share_upper_half(std::uint64_t low, std::uint64_t high) {
  return ((low ^ high) >> 32) == 0;
}

/// Narrows an interval bit by bit (Witten, Neal, Cleary 1987) and stores the digits that its ends share.
class Encoder {
 public:
  bool code(bool bit, Chance& chance) {
    narrow(bit, chance.one);
    chance.learn(bit);
    return bit;
  }
  std::uint64_t code_raw(std::uint64_t value, std::uint32_t bits) {
    for (std::uint32_t i = bits; i-- > 0;) narrow((value >> i & 1) != 0, 1 << 15);
    return value;
  }

  /// Stores as many bytes as name a value in the interval when zeros follow them.
  [[nodiscard]] std::vector<std::byte> finish() {
    for (std::uint32_t kept = 8; kept < 64; kept += 8) {
      const std::uint64_t value = high_ >> (64 - kept) << (64 - kept);
      put_byte(value >> (64 - kept));
      if (value >= low_) break;
    }
    std::vector<std::byte> bytes(bytes_.begin(), bytes_.end());
    bytes_.clear();
    low_ = 0;
    high_ = ~std::uint64_t{0};
    return bytes;
  }

 private:
  void narrow(bool bit, std::uint32_t one) {
    const std::uint64_t cut = cut_of(low_, high_, one);
    (bit ? high_ : low_) = bit ? cut : cut + 1;
    if (share_upper_half(low_, high_)) {
      for (std::uint32_t shift = 64; shift > 32; shift -= 8) put_byte(high_ >> (shift - 8));
      low_ <<= 32;
      high_ = high_ << 32 | 0xFFFFFFFFu;
    }
  }
  void put_byte(std::uint64_t byte) { bytes_.push_back(static_cast<std::byte>(byte)); }

  std::vector<std::byte> bytes_;
  std::uint64_t low_ = 0;
  std::uint64_t high_ = ~std::uint64_t{0};
};

class Decoder {
 public:
  void open(std::span<const std::byte> bytes) {
    bytes_ = bytes;
    low_ = value_ = 0;
    high_ = ~std::uint64_t{0};
    take_digits();
    take_digits();
  }
  bool code(bool, Chance& chance) {
    const bool bit = narrow(chance.one);
    chance.learn(bit);
    return bit;
  }
  std::uint64_t code_raw(std::uint64_t, std::uint32_t bits) {
    std::uint64_t value = 0;
    for (std::uint32_t i = 0; i < bits; ++i) value = value << 1 | (narrow(1 << 15) ? 1 : 0);
    return value;
  }

 private:
  bool narrow(std::uint32_t one) {
    const std::uint64_t cut = cut_of(low_, high_, one);
    const bool bit = value_ <= cut;
    (bit ? high_ : low_) = bit ? cut : cut + 1;
    if (share_upper_half(low_, high_)) {
      low_ <<= 32;
      high_ = high_ << 32 | 0xFFFFFFFFu;
      take_digits();
    }
    return bit;
  }
  void take_digits() {
    const std::size_t count = std::min<std::size_t>(4, bytes_.size());
    for (std::size_t i = 0; i < 4; ++i)
      value_ = value_ << 8 | (i < count ? std::to_integer<std::uint64_t>(bytes_[i]) : 0);
    bytes_ = bytes_.subspan(count);
  }

  std::span<const std::byte> bytes_;
  std::uint64_t low_ = 0;
  std::uint64_t high_ = ~std::uint64_t{0};
  std::uint64_t value_ = 0;
};

// --- Numbers ----------------------------------------------------------------------------------------------------

/// A number of kBits bits, every bit by those above it.
template <std::uint32_t kBits>
struct Symbol {
  std::array<Chance, 1u << kBits> chances;

  template <class Coder>
  std::uint32_t code(Coder& coder, std::uint32_t value) {
    std::uint32_t path = 1;
    for (std::uint32_t i = kBits; i-- > 0;)
      path = path << 1 | (coder.code((value >> i & 1) != 0, chances[path]) ? 1 : 0);
    return path - (1u << kBits);
  }
};

/// A number below 2^32 that is small as a rule: up to kSmall in as many bits, others by their length.
struct SmallNumber {
  static constexpr std::uint32_t kSmall = 6, kLengths = 13;
  std::array<Chance, kSmall> small;
  std::array<Chance, kLengths> longer, second;

  template <class Coder>
  std::uint32_t code(Coder& coder, std::uint32_t value) {
    for (std::uint32_t i = 0; i < kSmall; ++i) {
      if (!coder.code(value > i, small[i])) return i;
    }
    // The rest plus one: its length in bits after the first, the second bit, and all others as they are.
    const std::uint64_t rest = std::uint64_t{value} - kSmall + 1;
    const auto wanted = static_cast<std::uint32_t>(std::bit_width(rest)) - 1;
    std::uint32_t length = 0;
    while (length < 32 && coder.code(length < wanted, longer[std::min(length, kLengths - 1)])) ++length;
    std::uint64_t coded = 1;
    if (length > 0)
      coded =
          coded << 1 | (coder.code((rest >> (length - 1) & 1) != 0, second[std::min(length, kLengths - 1)]) ? 1 : 0);
    if (length > 1)
      coded = coded << (length - 1) | coder.code_raw(rest & ((std::uint64_t{1} << (length - 1)) - 1), length - 1);
    return static_cast<std::uint32_t>(coded - 1 + kSmall);
  }
};

/// Any number: its length, then the three bits below the first by the length.
struct LargeNumber {
  static constexpr std::uint32_t kModelled = 3;
  Symbol<7> length;
  std::array<std::array<Chance, 1u << kModelled>, 65> upper;

  template <class Coder>
  std::uint64_t code(Coder& coder, std::uint64_t value) {
    const std::uint32_t width = std::min(length.code(coder, static_cast<std::uint32_t>(std::bit_width(value))), 64u);
    if (width <= 1) return width;
    const std::uint32_t modelled = std::min(width - 1, kModelled), raw = width - 1 - modelled;
    std::uint64_t coded = 1;
    for (std::uint32_t i = 0; i < modelled; ++i) {
      const bool bit = (value >> (width - 2 - i) & 1) != 0;
      coded = coded << 1 | (coder.code(bit, upper[width][coded]) ? 1 : 0);
    }
    return raw == 0 ? coded : coded << raw | coder.code_raw(value & ((std::uint64_t{1} << raw) - 1), raw);
  }
};

// --- Model ------------------------------------------------------------------------------------------------------

/// Keys of tables are mixed into indices; where two keys meet, predictions get worse and nothing else happens.
template <std::uint32_t kBits>
[[nodiscard]] std::uint32_t slot_of(std::uint64_t key) {
  return static_cast<std::uint32_t>((key * 0x9E3779B97F4A7C15u) >> (64 - kBits));
}
[[nodiscard]] std::uint64_t joined(std::uint64_t a, std::uint64_t b) {
  return a * 0xD1B54A32D192ED03u + b;
}

/// The last few values that were met in one situation, the latest first.
template <class Value, std::uint32_t kMost>
struct Recent {
  std::array<Value, kMost> values{};
  std::uint32_t count = 0;

  /// @returns where `value` is, count where it is not.
  [[nodiscard]] std::uint32_t find(const Value& value) const {
    std::uint32_t place = 0;
    while (place < count && !(values[place] == value)) ++place;
    return place;
  }
  /// Brings `value` to the front from `place`, as find() gave it.
  void move_to_front(const Value& value, std::uint32_t place) {
    if (place == count && count < kMost) ++count;
    place = std::min(place, kMost - 1);
    for (; place > 0; --place) values[place] = values[place - 1];
    values[0] = value;
  }
};

/// Codes where a value stands in a list, or that it does not.
template <std::uint32_t kMost>
struct ListPlace {
  std::array<std::array<Chance, kMost + 1>, kMost + 1> chances;

  template <class Coder>
  std::uint32_t code(Coder& coder, std::uint32_t place, std::uint32_t count) {
    // First whether it is there at all.
    if (count == 0 || coder.code(place == count, chances[count][kMost])) return count;
    std::uint32_t found = 0;
    while (found + 1 < count && coder.code(place > found, chances[count][found])) ++found;
    return found;
  }
};

/// What ends a step: a transfer without its extent, a wait, a change of stage, or nothing.
struct Action {
  enum class Kind : std::uint8_t { kEnd, kNothing, kGet, kPut, kWait, kStage };
  Kind kind = Kind::kEnd;
  std::uint8_t tag = 0;
  bool rotating = false;
  std::uint8_t stage = 0;
  std::uint32_t tags = 0, rotating_tags = 0;

  friend constexpr bool operator==(const Action&, const Action&) = default;
  [[nodiscard]] bool is_transfer() const { return kind == Kind::kGet || kind == Kind::kPut; }
};

/// The bytes of main memory that a transfer moves.
struct Extent {
  std::uint64_t address = 0;
  std::uint32_t bytes = 0;
  friend constexpr bool operator==(const Extent&, const Extent&) = default;
};

static_assert(kWorkKindCount <= 64, "a set of kinds of work is one word");

/// Work, and what followed it.
struct Step {
  std::uint64_t kinds = 0;                              ///< bit = kind of which there was work
  std::array<std::uint32_t, kWorkKindCount> amounts{};  ///< of the kinds that there are
  Action action;
  Extent extent;

  void add(const WorkAmount& work) {
    if (work.amount == 0) return;
    const std::uint64_t kind = std::uint64_t{1} << static_cast<std::uint32_t>(work.kind);
    std::uint32_t& amount = amounts[static_cast<std::size_t>(work.kind)];
    amount = (kinds & kind) != 0 ? amount + work.amount : work.amount;
    kinds |= kind;
  }
};

/// What is known of a stream from the steps so far: the same to the writer and to the reader.
class Model {
 public:
  template <class Coder>
  void code_step(Coder& coder, Step& step) {
    code_action(coder, step.action);
    if (step.action.kind == Action::Kind::kEnd) return;
    code_work(coder, step);
    if (step.action.is_transfer()) {
      code_extent(coder, step);
    } else if (step.action.kind == Action::Kind::kWait) {
      note_wait(step.action);
    }
  }

 private:
  static constexpr std::uint32_t kActionBits = 5, kMostActions = (1u << kActionBits) - 1;
  static constexpr std::uint32_t kUnlisted = kMostActions;

  template <class Coder>
  void code_action(Coder& coder, Action& action) {
    const std::uint32_t index = static_cast<std::uint32_t>(
        std::find(actions_.begin(), actions_.begin() + action_count_, action) - actions_.begin());
    const std::uint32_t wanted = index < action_count_ ? index : kUnlisted;
    const std::uint32_t listed = action_symbols_[slot_of<9>(history_)].code(coder, wanted);
    if (listed != kUnlisted) {
      action = actions_[listed];
    } else {
      action.kind = static_cast<Action::Kind>(coder.code_raw(static_cast<std::uint64_t>(action.kind), 3));
      action.tag = static_cast<std::uint8_t>(coder.code_raw(action.tag, 8));
      action.rotating = coder.code_raw(action.rotating ? 1 : 0, 1) != 0;
      action.stage = static_cast<std::uint8_t>(coder.code_raw(action.stage, 8));
      action.tags = static_cast<std::uint32_t>(coder.code_raw(action.tags, 32));
      action.rotating_tags = static_cast<std::uint32_t>(coder.code_raw(action.rotating_tags, 32));
      if (action_count_ < kMostActions) actions_[action_count_++] = action;
    }
    history_ = (history_ << kActionBits | listed) & ((1u << 4 * kActionBits) - 1);
    level_ = !action.is_transfer() ? static_cast<std::uint32_t>(kWaitLevelCount)
             : action.rotating     ? static_cast<std::uint32_t>(WaitLevel::kTile)
                                   : static_cast<std::uint32_t>(wait_level_of_tag(action.tag));
    situation_ = action.kind == Action::Kind::kStage ? kWaitLevelCount + 1 : level_;
  }

  template <class Coder>
  void code_work(Coder& coder, Step& step) {
    // Which kinds: as a rule a set that was met in this situation before.
    Recent<std::uint64_t, 7>& sets = kind_sets_[slot_of<10>(joined(kinds_before_, situation_ << 8 | waited_level_))];
    const std::uint32_t place = set_places_[situation_].code(coder, sets.find(step.kinds), sets.count);
    if (place < sets.count) {
      step.kinds = sets.values[place];
    } else {
      std::uint64_t kinds = 0;
      bool before = false;
      for (std::uint32_t kind = 0; kind < kWorkKindCount; ++kind) {
        before = coder.code((step.kinds >> kind & 1) != 0, kind_chances_[kind][before ? 1 : 0]);
        kinds |= std::uint64_t{before ? 1u : 0u} << kind;
      }
      step.kinds = kinds;
    }
    sets.move_to_front(step.kinds, place);
    kinds_before_ = step.kinds;

    // How much: by the two amounts in front of it, which grow together.
    std::uint32_t one_before = 0, two_before = 0;
    for (std::uint64_t rest = step.kinds; rest != 0; rest &= rest - 1) {
      const auto kind = static_cast<std::uint32_t>(std::countr_zero(rest));
      // A mailbox is asked for every triangle that arrived.
      const std::uint32_t arrived = kind == static_cast<std::uint32_t>(Work::kMailboxProbe) ? waited_bytes_ / 16 : 0;
      const std::uint64_t key = std::uint64_t{waited_level_} << 48 | std::uint64_t{arrived} << 16 |
                                std::min(two_before, 7u) << 12 | std::min(one_before, 15u) << 8 | kind;
      step.amounts[kind] = amounts_[slot_of<11>(key)].code(coder, step.amounts[kind] - 1) + 1;
      two_before = one_before;
      one_before = step.amounts[kind];
    }
  }

  template <class Coder>
  void code_extent(Coder& coder, Step& step) {
    const bool is_triangles = level_ == static_cast<std::uint32_t>(WaitLevel::kTriangle);
    // Cells follow one another as they did before: triangles of one block, blocks along a ray.
    const std::uint64_t key =
        joined(is_triangles ? joined(block_, triangles_) : last_of_level_[level_].address, level_);
    Recent<Extent, 4>& known = extents_[slot_of<10>(key)];
    const std::uint32_t found = extent_places_[level_].code(coder, known.find(step.extent), known.count);
    if (found < known.count) {
      step.extent = known.values[found];
    } else {
      code_new_extent(coder, step.extent);
    }
    known.move_to_front(step.extent, found);
    last_of_level_[level_] = step.extent;
    last_of_tag_[step.action.tag % last_of_tag_.size()] = step.extent;
    if (is_triangles) triangles_ = step.extent.address;
  }

  /// By its distance from the last one of its level, in records of triangles or lines of 16 bytes where it is so many.
  template <class Coder>
  void code_new_extent(Coder& coder, Extent& extent) {
    const std::uint64_t base = last_of_level_[level_].address;
    const bool is_back = coder.code(extent.address < base, backward_[level_]);
    std::uint64_t distance = is_back ? base - extent.address : extent.address - base;
    std::uint64_t unit = 1;
    if (coder.code(distance % 16 == 0, in_sixteens_[level_])) {
      unit = coder.code(distance % 48 == 0, in_records_[level_]) ? 48 : 16;
    }
    distance = distances_[level_ * 2 + (triangles_ == 0 ? 1 : 0)].code(coder, distance / unit) * unit;
    extent.address = is_back ? base - distance : base + distance;

    // An address is that of the same bytes each time.
    std::uint32_t& expected = bytes_at_[slot_of<12>(extent.address)];
    if (coder.code(extent.bytes == expected, expected_[expected == 0 ? 1 : 0])) {
      extent.bytes = expected;
    } else {
      unit = coder.code(extent.bytes % 16 == 0, bytes_in_sixteens_[level_]) ? 16 : 1;
      extent.bytes = static_cast<std::uint32_t>(byte_counts_[level_].code(coder, extent.bytes / unit) * unit);
      expected = extent.bytes;
    }
  }

  void note_wait(const Action& action) {
    if (action.tags == 0) {
      waited_level_ = static_cast<std::uint32_t>(WaitLevel::kTile);
      return;
    }
    const auto tag = static_cast<std::uint32_t>(std::bit_width(action.tags)) - 1;
    waited_level_ = static_cast<std::uint32_t>(wait_level_of_tag(tag));
    waited_bytes_ = last_of_tag_[tag].bytes;
    if (waited_level_ != static_cast<std::uint32_t>(WaitLevel::kMacroCell)) return;
    block_ = last_of_tag_[tag].address;
    triangles_ = 0;
  }

  // Actions that were met, numbered as they came.
  std::array<Action, kMostActions> actions_{Action{}, Action{.kind = Action::Kind::kNothing}};
  std::uint32_t action_count_ = 2;
  std::uint32_t history_ = 0;  ///< the last four
  std::array<Symbol<kActionBits>, 512> action_symbols_;

  // Where the stream stands.
  std::uint32_t level_ = 0;         ///< of the transfer at hand
  std::uint64_t situation_ = 0;     ///< the level, or what else ends the step
  std::uint32_t waited_level_ = 0;  ///< of the last wait
  std::uint32_t waited_bytes_ = 0;  ///< that arrived with it
  std::uint64_t block_ = 0;         ///< cell block that arrived last
  std::uint64_t triangles_ = 0;     ///< got last since then
  std::array<Extent, kWaitLevelCount + 1> last_of_level_{};
  std::array<Extent, 32> last_of_tag_{};

  // Work.
  std::uint64_t kinds_before_ = 0;
  std::array<Recent<std::uint64_t, 7>, 1024> kind_sets_;
  std::array<ListPlace<7>, kWaitLevelCount + 2> set_places_;
  std::array<std::array<Chance, 2>, kWorkKindCount> kind_chances_;
  std::array<SmallNumber, 2048> amounts_;

  // Extents.
  std::array<Recent<Extent, 4>, 1024> extents_;
  std::array<ListPlace<4>, kWaitLevelCount> extent_places_;
  std::array<Chance, kWaitLevelCount> backward_, in_sixteens_, in_records_, bytes_in_sixteens_;
  std::array<LargeNumber, 2 * kWaitLevelCount> distances_;  ///< the first of a block apart
  std::array<LargeNumber, kWaitLevelCount> byte_counts_;
  std::array<std::uint32_t, 4096> bytes_at_{};
  std::array<Chance, 2> expected_;
};

/// A model that knows nothing yet, to be copied: that is faster than to make one.
const Model& new_model() {
  static const Model model;
  return model;
}

}  // namespace

// --- Writer and reader ------------------------------------------------------------------------------------------

struct TraceWriter::State {
  Model model;
  Encoder encoder;
  Step step;
  bool is_empty = true;

  void end_step(const Action& action) {
    if (is_empty) model = new_model();
    is_empty = false;
    step.action = action;
    model.code_step(encoder, step);
    step.kinds = 0;
  }
};

TraceWriter::TraceWriter() : state_(std::make_unique<State>()) {}
TraceWriter::~TraceWriter() = default;

void TraceWriter::add(const TraceEvent& event) {
  State& state = *state_;
  switch (event.kind) {
    case EventKind::kWork:
      if (state.step.kinds != 0) state.end_step({.kind = Action::Kind::kNothing});
      for (const WorkAmount& work : event.work) state.step.add(work);
      return;
    case EventKind::kGet:
    case EventKind::kPut:
      state.step.extent = {event.address, event.bytes};
      state.end_step({.kind = event.kind == EventKind::kGet ? Action::Kind::kGet : Action::Kind::kPut,
                      .tag = event.tag,
                      .rotating = event.rotating});
      return;
    case EventKind::kWait:
      state.end_step({.kind = Action::Kind::kWait, .tags = event.tags, .rotating_tags = event.rotating_tags});
      return;
    case EventKind::kStage:
      state.end_step({.kind = Action::Kind::kStage, .stage = static_cast<std::uint8_t>(event.stage)});
      return;
  }
}

TileTrace TraceWriter::finish(std::uint32_t tile_id) {
  State& state = *state_;
  if (state.step.kinds != 0) state.end_step({.kind = Action::Kind::kNothing});
  if (state.is_empty) return {tile_id, {}};
  state.end_step({.kind = Action::Kind::kEnd});
  state.is_empty = true;
  return {tile_id, state.encoder.finish()};
}

struct TraceReader::State {
  static constexpr std::uint32_t kSteps = 32;  ///< read at once, while the model is in the cache

  Model model;
  Decoder decoder;
  bool is_at_end = true;
  std::uint32_t event_count = 0, next_event = 0;
  std::array<TraceEvent, 2 * kSteps> events;
  std::array<WorkAmount, kSteps * kWorkKindCount> work;

  void read_steps() {
    event_count = next_event = 0;
    WorkAmount* amounts = work.data();
    Step step;
    for (std::uint32_t i = 0; i < kSteps && !is_at_end; ++i) {
      model.code_step(decoder, step);
      const Action& action = step.action;
      is_at_end = action.kind == Action::Kind::kEnd;
      if (is_at_end) break;
      if (step.kinds != 0) {
        WorkAmount* const first = amounts;
        for (std::uint64_t rest = step.kinds; rest != 0; rest &= rest - 1) {
          const auto kind = static_cast<std::uint32_t>(std::countr_zero(rest));
          *amounts++ = {static_cast<Work>(kind), step.amounts[kind]};
        }
        events[event_count++] = {.kind = EventKind::kWork, .work = {first, amounts}};
      }
      switch (action.kind) {
        case Action::Kind::kGet:
        case Action::Kind::kPut:
          events[event_count++] = {.kind = action.kind == Action::Kind::kGet ? EventKind::kGet : EventKind::kPut,
                                   .tag = action.tag,
                                   .rotating = action.rotating,
                                   .bytes = step.extent.bytes,
                                   .address = step.extent.address};
          break;
        case Action::Kind::kWait:
          events[event_count++] = {
              .kind = EventKind::kWait, .tags = action.tags, .rotating_tags = action.rotating_tags};
          break;
        case Action::Kind::kStage:
          events[event_count++] = {.kind = EventKind::kStage, .stage = static_cast<Stage>(action.stage)};
          break;
        case Action::Kind::kNothing:
        case Action::Kind::kEnd:
          break;
      }
    }
  }
};

TraceReader::TraceReader() : state_(std::make_unique<State>()) {}
TraceReader::~TraceReader() = default;
TraceReader::TraceReader(TraceReader&&) noexcept = default;
TraceReader& TraceReader::operator=(TraceReader&&) noexcept = default;

void TraceReader::open(const TileTrace& trace) {
  State& state = *state_;
  state.event_count = state.next_event = 0;
  state.is_at_end = trace.packed.empty();
  if (state.is_at_end) return;
  state.model = new_model();
  state.decoder.open(trace.packed);
}

const TraceEvent* TraceReader::next() {
  State& state = *state_;
  if (state.next_event == state.event_count) {
    if (state.is_at_end) return nullptr;
    state.read_steps();
    if (state.event_count == 0) return nullptr;
  }
  return &state.events[state.next_event++];
}

}  // namespace gridiron::sim
