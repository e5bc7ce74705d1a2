// Replay: a discrete-event simulation of one frame's traces. See replay.h for the model.
// Memory: std::vector. Threads: any, no shared state. SPDX-License-Identifier: Apache-2.0
#include <gridiron/dma/tags.h>
#include <gridiron/platform/tile_order.h>
#include <gridiron/sim/replay.h>
#include <gridiron/sim/trace_packing.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace gridiron::sim {

namespace {

/// Simulated time. Integers, so that no sum depends on its order; fine enough that rounding a profile value changes it
/// by less than 5e-4 cycles; exact in a double for frames below 2^43 cycles.
using Ticks = CoreClock::Ticks;
constexpr double kTicksPerCycle = CoreClock::kTicksPerCycle;
constexpr Ticks kNever = ~Ticks{0};
constexpr double kMaxConstantCycles = 1 << 20;
constexpr std::uint32_t kMaxWindow = 65536;
constexpr std::uint32_t kTagCount = 32;
static_assert(kFirstRotatingTag == kFirstOutputTag);

Ticks ticks_from_cycles(double cycles) {
  if (!(cycles > 0)) return 0;
  return static_cast<Ticks>(std::min(cycles, kMaxConstantCycles) * kTicksPerCycle + 0.5);
}

double cycles_from_ticks(Ticks ticks) {
  return static_cast<double>(ticks) / kTicksPerCycle;
}

/// A latency in ticks, ready to be drawn.
struct LatencyTicks {
  explicit LatencyTicks(const Latency& latency) {
    double sum = 0;
    for (const LatencyShare& one : latency.shares()) {
      sum += one.share;
      // The last one gets what rounding leaves.
      entries.push_back(
          {sum < 1 ? static_cast<std::uint64_t>(sum * 0x1p64) : ~std::uint64_t{0}, ticks_from_cycles(one.cycles)});
    }
  }
  [[nodiscard]] bool is_one_number() const { return entries.size() == 1; }
  [[nodiscard]] Ticks drawn(std::uint64_t draw) const {
    std::size_t i = 0;
    while (i + 1 < entries.size() && draw >= entries[i].end) ++i;
    return entries[i].ticks;
  }

  struct Entry {
    std::uint64_t end;  ///< draws below it, and not below that of the entry before
    Ticks ticks;
  };
  std::vector<Entry> entries;
};

/// A machine profile in ticks, with counts that are safe as indices.
struct Constants {
  Constants(const MachineProfile& machine, const EngineWork& engine)
      : line_bytes(std::max(1u, machine.line_bytes)),
        queue_depth(std::clamp(machine.queue_depth, 1u, kMaxWindow)),
        lines_in_flight(std::clamp(machine.lines_in_flight, 1u, kMaxWindow)),
        issue(ticks_from_cycles(machine.issue_cycles)),
        wait(ticks_from_cycles(machine.wait_cycles)),
        latency(machine.latency_cycles),
        latency_seed(machine.latency_seed),
        slot(machine.channel_bytes_per_cycle > 0 ? ticks_from_cycles(line_bytes / machine.channel_bytes_per_cycle) : 0),
        line_interval(ticks_from_cycles(machine.core_line_interval_cycles)),
        claim(ticks_from_cycles(machine.claim_cycles)) {
    const auto prices = work_prices(machine, engine);
    for (std::uint32_t kind = 0; kind < kWorkKindCount; ++kind) work[kind] = ticks_from_cycles(prices[kind]);
    for (std::uint32_t kind = 0; kind < engine.kind_count(); ++kind) {
      is_initialisation[kind] = work_kind(WorkId(kind), engine).is_initialisation;
    }
  }

  std::uint32_t line_bytes;
  std::uint32_t queue_depth;
  std::uint32_t lines_in_flight;
  Ticks issue, wait;
  LatencyTicks latency;
  std::uint32_t latency_seed;
  Ticks slot, line_interval, claim;
  std::array<Ticks, kWorkKindCount> work{};
  std::array<bool, kWorkKindCount> is_initialisation{};
};

struct Command {
  Ticks issued = 0;
  Ticks done = 0;  ///< when the last of its lines arrives; meaningful once all are granted
  std::uint64_t lines = 0;
  std::uint64_t granted = 0;  ///< of them
  std::uint32_t tag = 0;
  std::uint32_t item = 0, transfer = 0;  ///< which of its tile's transfers it is
};

/// When the lines of a core that may still be under way arrive, the earliest first.
class Arrivals {
 public:
  explicit Arrivals(std::uint32_t most) : times_(most) {}

  /// Whether as many are known as may be under way: the next one leaves no earlier than the earliest of them arrives.
  [[nodiscard]] bool are_full() const { return count_ == times_.size(); }
  [[nodiscard]] Ticks earliest() const { return times_[first_]; }

  void add(Ticks arrival) {
    if (are_full()) {
      first_ = place(1);
      --count_;
    }
    // Later ones make room; with one latency for all lines there are none.
    std::size_t i = count_++;
    for (; i > 0 && times_[place(i - 1)] > arrival; --i) times_[place(i)] = times_[place(i - 1)];
    times_[place(i)] = arrival;
  }

 private:
  [[nodiscard]] std::size_t place(std::size_t i) const {
    const std::size_t sum = first_ + i;
    return sum < times_.size() ? sum : sum - times_.size();
  }
  std::vector<Ticks> times_;  // a ring
  std::size_t first_ = 0, count_ = 0;
};

enum class Phase : std::uint8_t { kPrologue, kTile, kEpilogue, kEnded };

/// One core: the state of its program, and its transfer engine.
struct Core {
  explicit Core(const Constants& constants) : queue(constants.queue_depth), arrivals(constants.lines_in_flight) {}

  // Program.
  Phase phase = Phase::kPrologue;
  TraceReader steps;
  TileTrace arrived;                 ///< whose steps these are, where traces come one after another
  const TraceEvent* step = nullptr;  ///< that is taken next; null after the last one
  std::uint32_t tile_id = kNoTile;
  std::uint32_t ordinal = 0;      ///< of the tile: how many this core has had before it
  std::size_t next_own_tile = 0;  ///< where tiles are assigned: the first of the trace that may be its next
  Ticks now = 0;
  Ticks claim_time = kNever;        ///< when it asks for a tile
  std::uint64_t blocked_until = 0;  ///< granted_count that lets the program go on; 0: not blocked

  // Transfers, numbered from 1 in the order of issue.
  std::vector<Command> queue;  ///< command n at (n - 1) % queue_depth
  std::uint64_t issued_count = 0;
  std::uint64_t granted_count = 0;                     ///< commands whose lines have all had their turn
  std::uint32_t transfer_count = 0;                    ///< of the current tile
  std::array<std::uint64_t, kTagCount> last_of_tag{};  ///< number of the last command of a tag, 0: none
  std::array<Ticks, kTagCount> done_of_tag{};          ///< when the last granted commands of a tag are all done
  Arrivals arrivals;
  std::uint64_t line_count = 0;
  Ticks last_request = 0;
  Ticks next_request = kNever;  ///< when the next line leaves the core

  // Sums.
  CoreTiming timing;
  Ticks init = 0, compute = 0, idle = 0;
  Ticks tile_begin = 0, longest_tile = 0;
  std::array<Ticks, kWaitLevelCount> waits{};
  Stage stage = Stage::kPrimary;
  std::array<Ticks, kStageCount> stage_compute{}, stage_waits{};
  std::vector<TimelineSpan> timeline;
  std::size_t tile_span = 0;
};

/// Traces by tile that have come and not been taken.
using ArrivingTraces = std::vector<std::optional<TileTrace>>;

class Replay {
 public:
  /// @param arriving  where tiles' traces are put as they come; null: they are those of `trace`.
  Replay(const FrameTrace& trace, const MachineProfile& machine, const ReplayOptions& options,
         ArrivingTraces* arriving = nullptr)
      : trace_(trace),
        arriving_(arriving),
        tile_count_(arriving != nullptr ? arriving->size() : trace.tiles.size()),
        machine_(machine),
        constants_(machine, *trace.engine),
        output_depth_(std::clamp(trace.output_depth, 1u, std::uint32_t{kOutputTagCount})),
        with_timeline_(options.timeline),
        core_of_tile_(options.core_of_tile) {
    const std::uint32_t count = std::max(1u, options.core_count != 0 ? options.core_count : machine.core_count);
    cores_.reserve(count);
    for (std::uint32_t i = 0; i < count; ++i) cores_.emplace_back(constants_);
  }

  void begin() {
    for (Core& core : cores_) {
      begin_steps(core, trace_.prologue);
      advance(core);
    }
  }
  /// Until the end, or until the trace of the next tile has to come.
  void go_on() {
    // An event never causes an earlier one, so the earliest one is always safe to take.
    while (take_earliest_event()) {
    }
  }

  /// Of the first core, alone: takes all steps, and what they wait for.
  void run_alone(const TileTrace& trace, std::uint32_t ordinal) {
    Core& core = cores_.front();
    core.ordinal = ordinal;
    core.tile_id = trace.tile_id;
    begin_steps(core, trace);
    advance(core);
    while (core.step != nullptr) grant_line(core);
  }
  void claim_alone() { cores_.front().now += constants_.claim; }
  [[nodiscard]] Ticks now_alone() const { return cores_.front().now; }

  FrameTiming result() {
    Ticks end = 0;
    for (const Core& core : cores_) end = std::max(end, core.now);

    FrameTiming frame;
    frame.engine = trace_.engine;
    frame.frame_cycles = cycles_from_ticks(end);
    frame.seconds = machine_.clock_hz > 0 ? frame.frame_cycles / machine_.clock_hz : 0;
    frame.channel_busy_cycles = cycles_from_ticks(channel_busy_);
    for (Core& core : cores_) {
      CoreTiming& timing = core.timing;
      timing.init_cycles = cycles_from_ticks(core.init);
      timing.compute_cycles = cycles_from_ticks(core.compute);
      timing.idle_cycles = cycles_from_ticks(core.idle + (end - core.now));
      timing.end_idle_cycles = cycles_from_ticks(end - core.now);
      timing.longest_tile_cycles = cycles_from_ticks(core.longest_tile);
      for (std::size_t level = 0; level < kWaitLevelCount; ++level) {
        timing.dma_wait_cycles[level] = cycles_from_ticks(core.waits[level]);
      }
      for (std::size_t stage = 0; stage < kStageCount; ++stage) {
        timing.stages[stage].compute_cycles = cycles_from_ticks(core.stage_compute[stage]);
        timing.stages[stage].wait_cycles = cycles_from_ticks(core.stage_waits[stage]);
      }
      frame.cores.push_back(timing);
      frame.timeline.insert(frame.timeline.end(), core.timeline.begin(), core.timeline.end());
    }
    return frame;
  }

 private:
  /// Handles the earliest claim or line request; ties: claims first, then by core. @returns false if none is left, or
  /// the earliest is the claim of a tile whose trace has not come.
  bool take_earliest_event() {
    Core* claimer = nullptr;
    Core* requester = nullptr;
    Ticks claim_time = kNever;
    Ticks request_time = kNever;
    for (Core& core : cores_) {
      if (core.claim_time < claim_time) {
        claim_time = core.claim_time;
        claimer = &core;
      }
      if (core.next_request < request_time) {
        request_time = core.next_request;
        requester = &core;
      }
    }
    if (claimer != nullptr && claim_time <= request_time) {
      if (!has_come(next_tile_of(*claimer))) return false;
      grant_claim(*claimer);
    } else if (requester != nullptr) {
      grant_line(*requester);
    } else {
      return false;
    }
    return true;
  }

  void grant_claim(Core& core) {
    core.claim_time = kNever;
    core.now += constants_.claim;
    core.idle += constants_.claim;
    core.ordinal = core.timing.tiles;
    core.stage = Stage::kPrimary;
    if (const std::size_t tile = next_tile_of(core); tile != tile_count_) {
      ++(core_of_tile_.empty() ? next_tile_ : core.next_own_tile);
      core.phase = Phase::kTile;
      const TileTrace& trace = take_trace(core, tile);
      begin_steps(core, trace);
      core.tile_id = trace.tile_id;
      core.tile_begin = core.now;
      ++core.timing.tiles;
      if (with_timeline_) {
        core.tile_span = core.timeline.size();
        core.timeline.push_back(span(core, TimelineSpan::Kind::kTile, WaitLevel::kTile, core.now, core.now));
      }
    } else {
      core.phase = Phase::kEpilogue;
      begin_steps(core, trace_.epilogue);
      core.tile_id = kNoTile;
    }
    advance(core);
  }

  /// @returns the place of the tile that the core's next claim gets; tile_count_ if it gets no more.
  std::size_t next_tile_of(Core& core) const {
    if (core_of_tile_.empty()) {
      if (next_tile_ == tile_count_ || !trace_.is_middle_out) return next_tile_;
      return middle_out(static_cast<std::uint32_t>(next_tile_), static_cast<std::uint32_t>(tile_count_));
    }
    const auto index = static_cast<std::uint32_t>(&core - cores_.data());
    for (; core.next_own_tile < tile_count_; ++core.next_own_tile) {
      const std::size_t tile = core.next_own_tile;
      if (tile < core_of_tile_.size() && core_of_tile_[tile] == index) return tile;
    }
    return tile_count_;
  }

  [[nodiscard]] bool has_come(std::size_t tile) const {
    return arriving_ == nullptr || tile == tile_count_ || (*arriving_)[tile].has_value();
  }

  const TileTrace& take_trace(Core& core, std::size_t tile) {
    if (arriving_ == nullptr) return trace_.tiles[tile];
    core.arrived = std::move(*(*arriving_)[tile]);
    (*arriving_)[tile].reset();
    return core.arrived;
  }

  void grant_line(Core& core) {
    const Ticks turn = std::max(core.next_request, channel_free_);
    channel_free_ = turn + constants_.slot;
    channel_busy_ += constants_.slot;
    Command& command = core.queue[core.granted_count % constants_.queue_depth];
    const Ticks arrival = channel_free_ + latency_of(command);
    core.arrivals.add(arrival);
    ++core.line_count;
    core.last_request = core.next_request;
    command.done = std::max(command.done, arrival);
    if (++command.granted == command.lines) {
      core.done_of_tag[command.tag] = std::max(core.done_of_tag[command.tag], command.done);
      ++core.granted_count;
      if (core.blocked_until != 0 && core.blocked_until <= core.granted_count) {
        advance(core);
        return;
      }
    }
    schedule_request(core);
  }

  // Of the command's next line.
  [[nodiscard]] Ticks latency_of(const Command& command) const {
    if (constants_.latency.is_one_number()) return constants_.latency.drawn(0);
    return constants_.latency.drawn(
        line_draw(constants_.latency_seed, command.item, command.transfer, command.granted));
  }

  void schedule_request(Core& core) const {
    core.next_request = kNever;
    if (core.granted_count == core.issued_count) return;
    Ticks time = core.queue[core.granted_count % constants_.queue_depth].issued;
    if (core.line_count > 0) time = std::max(time, core.last_request + constants_.line_interval);
    if (core.arrivals.are_full()) time = std::max(time, core.arrivals.earliest());
    core.next_request = time;
  }

  static void begin_steps(Core& core, const TileTrace& trace) {
    core.steps.open(trace);
    core.step = core.steps.next();
    core.transfer_count = 0;
  }

  /// Runs a core's program until it ends, or depends on something that other cores may still change.
  void advance(Core& core) {
    core.blocked_until = 0;
    while (core.step != nullptr) {
      if (!take_step(core, *core.step)) {
        schedule_request(core);
        return;
      }
      core.step = core.steps.next();
    }
    if (core.phase == Phase::kEpilogue) {
      core.phase = Phase::kEnded;
    } else {
      if (core.phase == Phase::kTile) {
        core.longest_tile = std::max(core.longest_tile, core.now - core.tile_begin);
        if (with_timeline_) core.timeline[core.tile_span].end_cycles = cycles_from_ticks(core.now);
      }
      core.claim_time = core.now;
    }
    schedule_request(core);
  }

  /// @returns false if the core is blocked and must retry the step later.
  bool take_step(Core& core, const TraceEvent& event) {
    switch (event.kind) {
      case EventKind::kWork:
        take_work(core, event.work);
        return true;
      case EventKind::kGet:
      case EventKind::kPut:
        return take_transfer(core, event);
      case EventKind::kWait:
        return take_wait(core, event);
      case EventKind::kStage:
        core.stage = event.stage;
        return true;
    }
    return true;
  }

  void take_work(Core& core, std::span<const WorkAmount> amounts) {
    Ticks init = 0;
    Ticks compute = 0;
    for (const WorkAmount& work : amounts) {
      const Ticks ticks = constants_.work[work.kind.number()] * work.amount;
      (constants_.is_initialisation[work.kind.number()] ? init : compute) += ticks;
    }
    spend(core, TimelineSpan::Kind::kInit, WaitLevel::kTile, init);
    spend(core, TimelineSpan::Kind::kCompute, WaitLevel::kTile, compute);
  }

  bool take_transfer(Core& core, const TraceEvent& event) {
    const std::uint32_t tag = event.rotating ? rotated_tag(core, event.tag) : event.tag % kTagCount;

    // A full queue: the command queue_depth before this one must have left it.
    if (core.issued_count >= constants_.queue_depth) {
      const std::uint64_t command = core.issued_count + 1 - constants_.queue_depth;
      if (command > core.granted_count) {
        core.blocked_until = command;
        return false;
      }
      const Ticks done = core.queue[(command - 1) % constants_.queue_depth].done;
      if (done > core.now) spend(core, TimelineSpan::Kind::kWait, wait_level_of_tag(tag), done - core.now);
    }
    spend(core, TimelineSpan::Kind::kCompute, WaitLevel::kTile, constants_.issue);

    const std::uint64_t first_line = event.address / constants_.line_bytes;
    const std::uint64_t last_line = (event.address + std::max(1u, event.bytes) - 1) / constants_.line_bytes;
    const std::uint64_t lines = last_line - first_line + 1;
    core.queue[core.issued_count % constants_.queue_depth] = {.issued = core.now,
                                                              .done = 0,
                                                              .lines = lines,
                                                              .granted = 0,
                                                              .tag = tag,
                                                              .item = core.tile_id,
                                                              .transfer = core.transfer_count++};
    core.last_of_tag[tag] = ++core.issued_count;

    CoreTiming& timing = core.timing;
    const bool is_get = event.kind == EventKind::kGet;
    (is_get ? timing.gets : timing.puts) += 1;
    (is_get ? timing.bytes_in : timing.bytes_out) += event.bytes;
    (is_get ? timing.line_bytes_in : timing.line_bytes_out) += lines * constants_.line_bytes;
    StageTiming& stage = timing.stages[static_cast<std::size_t>(core.stage)];
    (is_get ? stage.gets : stage.puts) += 1;
    (is_get ? stage.bytes_in : stage.bytes_out) += event.bytes;
    return true;
  }

  bool take_wait(Core& core, const TraceEvent& event) {
    std::uint32_t tags = event.tags;
    for (std::uint32_t left = event.rotating_tags; left != 0; left &= left - 1) {
      tags |= 1u << rotated_tag(core, static_cast<std::uint32_t>(std::countr_zero(left)));
    }
    // Lines have their turns in the order of issue: once those of the last command have had theirs, all are known. The
    // command that is done last, of several the last issued, gives the wait its level.
    std::uint64_t last = 0;
    Ticks done = 0;
    std::uint64_t late_command = 0;
    std::uint32_t late_tag = 0;
    for (std::uint32_t left = tags; left != 0; left &= left - 1) {
      const auto tag = static_cast<std::uint32_t>(std::countr_zero(left));
      const std::uint64_t command = core.last_of_tag[tag];
      last = std::max(last, command);
      if (core.done_of_tag[tag] < done || (core.done_of_tag[tag] == done && command < late_command)) continue;
      done = core.done_of_tag[tag];
      late_command = command;
      late_tag = tag;
    }
    if (last > core.granted_count) {
      core.blocked_until = last;
      return false;
    }
    if (done > core.now) spend(core, TimelineSpan::Kind::kWait, wait_level_of_tag(late_tag), done - core.now);
    spend(core, TimelineSpan::Kind::kCompute, WaitLevel::kTile, constants_.wait);
    return true;
  }

  std::uint32_t rotated_tag(const Core& core, std::uint32_t relative) const {
    return kFirstOutputTag + (relative + core.ordinal) % output_depth_;
  }

  void spend(Core& core, TimelineSpan::Kind kind, WaitLevel level, Ticks ticks) {
    if (ticks == 0) return;
    const Ticks begin = core.now;
    core.now += ticks;
    const bool is_wait = kind == TimelineSpan::Kind::kWait;
    (is_wait ? core.stage_waits : core.stage_compute)[static_cast<std::size_t>(core.stage)] += ticks;
    switch (kind) {
      case TimelineSpan::Kind::kInit:
        core.init += ticks;
        break;
      case TimelineSpan::Kind::kWait:
        core.waits[static_cast<std::size_t>(level)] += ticks;
        break;
      case TimelineSpan::Kind::kCompute:
      case TimelineSpan::Kind::kTile:
        core.compute += ticks;
        break;
    }
    if (!with_timeline_) return;
    if (!core.timeline.empty()) {
      TimelineSpan& last = core.timeline.back();
      if (last.kind == kind && last.level == level && last.tile_id == core.tile_id &&
          last.end_cycles == cycles_from_ticks(begin)) {
        last.end_cycles = cycles_from_ticks(core.now);
        return;
      }
    }
    core.timeline.push_back(span(core, kind, level, begin, core.now));
  }

  TimelineSpan span(const Core& core, TimelineSpan::Kind kind, WaitLevel level, Ticks begin, Ticks end) const {
    return {.core = static_cast<std::uint32_t>(&core - cores_.data()),
            .kind = kind,
            .level = level,
            .tile_id = core.tile_id,
            .begin_cycles = cycles_from_ticks(begin),
            .end_cycles = cycles_from_ticks(end)};
  }

  const FrameTrace& trace_;
  ArrivingTraces* const arriving_;
  const std::size_t tile_count_;
  const MachineProfile& machine_;
  const Constants constants_;
  const std::uint32_t output_depth_;
  const bool with_timeline_;
  const std::span<const std::uint32_t> core_of_tile_;
  std::vector<Core> cores_;
  std::size_t next_tile_ = 0;
  Ticks channel_free_ = 0;
  Ticks channel_busy_ = 0;
};

}  // namespace

FrameTiming replay(const FrameTrace& trace, const MachineProfile& machine, const ReplayOptions& options) {
  Replay replay(trace, machine, options);
  replay.begin();
  replay.go_on();
  return replay.result();
}

struct FrameClock::State {
  const MachineProfile machine;
  const FrameTrace frame;
  ArrivingTraces arriving;
  Replay replay;

  State(FrameTrace of, std::uint32_t tile_count, const MachineProfile& on, const ReplayOptions& options)
      : machine(on), frame(std::move(of)), arriving(tile_count), replay(frame, machine, options, &arriving) {}
};

FrameClock::FrameClock(FrameTrace frame, std::uint32_t tile_count, const MachineProfile& machine,
                       const ReplayOptions& options)
    : state_(std::make_unique<State>(std::move(frame), tile_count, machine, options)) {
  state_->replay.begin();
}
FrameClock::~FrameClock() = default;

void FrameClock::take(TileTrace trace) {
  const std::uint32_t tile = trace.tile_id;
  state_->arriving[tile] = std::move(trace);
  state_->replay.go_on();
}
std::size_t FrameClock::waiting_count() const {
  return static_cast<std::size_t>(
      std::ranges::count_if(state_->arriving, [](const std::optional<TileTrace>& trace) { return trace.has_value(); }));
}
FrameTiming FrameClock::finish() {
  return state_->replay.result();
}

double rounded_cycles(double cycles) {
  return cycles_from_ticks(ticks_from_cycles(cycles));
}

struct CoreClock::State {
  const MachineProfile machine;
  const FrameTrace frame;
  Replay replay{frame, machine, {.core_count = 1}};
};

CoreClock::CoreClock(const MachineProfile& machine, const EngineWork& engine, std::uint32_t output_depth)
    : state_(new State{machine, {{}, {}, {}, output_depth, &engine}}) {}
CoreClock::~CoreClock() = default;
CoreClock::CoreClock(CoreClock&&) noexcept = default;
CoreClock& CoreClock::operator=(CoreClock&&) noexcept = default;

void CoreClock::take(const TileTrace& trace, std::uint32_t ordinal) {
  state_->replay.run_alone(trace, ordinal);
}
void CoreClock::take_claim() {
  state_->replay.claim_alone();
}
CoreClock::Ticks CoreClock::now() const {
  return state_->replay.now_alone();
}

}  // namespace gridiron::sim
