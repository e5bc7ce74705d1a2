// Timeline: see timeline.h.
// Memory: std::string. Threads: any, no shared state. SPDX-License-Identifier: Apache-2.0
#include "report/timeline.h"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "report/report.h"

namespace gridiron::tool {

namespace {

using sim::TimelineSpan;

constexpr double kFirstThresholdCycles = 64;
constexpr double kThresholdFactor = 4;

/// Writes the events of one frame with one threshold.
class Writer {
 public:
  Writer(const sim::MachineProfile& machine, double threshold_cycles)
      : units_per_cycle_(machine.clock_hz > 0 ? kUnitsPerSecond / machine.clock_hz : 0),
        threshold_cycles_(threshold_cycles) {}

  /// @returns false, with the text incomplete, if it exceeds max_bytes.
  bool write(const sim::FrameTiming& timing, const sim::MachineProfile& machine, std::size_t max_bytes) {
    begin(machine);
    write_names(timing.cores.size());
    return write_spans(timing, max_bytes) && end(machine, max_bytes);
  }

  /// The same.
  bool write(std::span<const sim::PassTiming> passes, const sim::MachineProfile& machine, std::size_t max_bytes) {
    begin(machine);
    std::size_t cores = 0;
    for (const sim::PassTiming& pass : passes) cores = std::max(cores, pass.run.cores.size());
    write_names(cores);
    const auto row = static_cast<std::uint32_t>(cores);
    write_name(row, "passes");
    double begin_cycles = 0;
    for (const sim::PassTiming& pass : passes) {
      offset_cycles_ = begin_cycles;
      write_part(pass.name, row, 0, pass.cycles, "\"items\":" + std::to_string(pass.items));
      const double end_of_run = pass.start_cycles + pass.run.frame_cycles;
      if (pass.start_cycles > 0) write_part("start", row, 0, pass.start_cycles, "");
      if (pass.barrier_cycles > 0) write_part("barrier", row, end_of_run, end_of_run + pass.barrier_cycles, "");
      offset_cycles_ += pass.start_cycles;
      item_ = sim::core_engine(pass.run.engine->id) != nullptr ? "tile" : "item";
      if (!write_spans(pass.run, max_bytes)) return false;
      begin_cycles += pass.cycles;
    }
    return end(machine, max_bytes);
  }

  std::string take_text() { return std::move(text_); }

 private:
  void begin(const sim::MachineProfile& machine) {
    text_ = "{\"traceEvents\":[\n{\"name\":\"process_name\",\"ph\":\"M\",\"pid\":0,\"args\":{\"name\":" +
            quoted(machine.name) + "}}";
  }

  bool end(const sim::MachineProfile& machine, std::size_t max_bytes) {
    text_ += "\n],\n\"displayTimeUnit\":\"ns\",\n\"otherData\":{\"version\":" + std::to_string(kTimelineVersion) +
             ",\"machine\":" + quoted(machine.name) +
             ",\"merged_below_cycles\":" + std::to_string(static_cast<std::uint64_t>(threshold_cycles_)) + "}}\n";
    return text_.size() <= max_bytes;
  }

  bool write_spans(const sim::FrameTiming& timing, std::size_t max_bytes) {
    engine_ = timing.engine;
    for (const TimelineSpan& span : timing.timeline) {
      if (span.kind != TimelineSpan::Kind::kTile && belongs_to_run(span)) {
        add_to_run(span);
      } else {
        write_run();
        if (span.kind != TimelineSpan::Kind::kTile && is_short(span)) {
          add_to_run(span);
        } else {
          write_span(span);
        }
      }
      if (text_.size() > max_bytes) return false;
    }
    write_run();
    return true;
  }

  // Times are rounded to 0.1 ns before they become text, so that adjacent spans stay adjacent.
  static constexpr double kUnitsPerSecond = 1e10;
  static constexpr std::uint64_t kUnitsPerMicrosecond = 10'000;

  /// Consecutive short spans of one tile.
  struct Run {
    TimelineSpan first{};
    double end_cycles = 0;
    std::uint64_t span_count = 0;
    std::array<double, 3> cycles{};  ///< by Kind: init, compute, wait
  };

  static std::string quoted(std::string_view name) {
    return nlohmann::json(std::string(name)).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  }

  bool is_short(const TimelineSpan& span) const { return span.end_cycles - span.begin_cycles < threshold_cycles_; }

  bool belongs_to_run(const TimelineSpan& span) const {
    return run_.span_count > 0 && is_short(span) && span.core == run_.first.core &&
           span.tile_id == run_.first.tile_id && span.begin_cycles == run_.end_cycles;
  }

  void add_to_run(const TimelineSpan& span) {
    if (run_.span_count++ == 0) run_.first = span;
    run_.end_cycles = span.end_cycles;
    run_.cycles[static_cast<std::size_t>(span.kind)] += span.end_cycles - span.begin_cycles;
  }

  void write_run() {
    if (run_.span_count == 1) {
      write_span(run_.first);
    } else if (run_.span_count > 1) {
      begin_event("mixed", run_.first.core, run_.first.begin_cycles, run_.end_cycles);
      write_tile(run_.first.tile_id);
      text_ += (run_.first.tile_id != sim::kNoTile ? ",\"spans\":" : "\"spans\":") + std::to_string(run_.span_count);
      constexpr std::array<std::string_view, 3> kKeys = {",\"init_us\":", ",\"compute_us\":", ",\"wait_us\":"};
      for (std::size_t kind = 0; kind < kKeys.size(); ++kind) {
        text_.append(kKeys[kind]).append(microseconds(units(run_.cycles[kind])));
      }
      text_ += "}}";
    }
    run_ = {};
  }

  void write_span(const TimelineSpan& span) {
    std::string_view name = item_;
    std::string wait_name;
    if (span.kind == TimelineSpan::Kind::kInit) {
      name = "init";
    } else if (span.kind == TimelineSpan::Kind::kCompute) {
      name = "compute";
    } else if (span.kind == TimelineSpan::Kind::kWait) {
      wait_name.append("wait ").append(engine_->wait_levels[static_cast<std::size_t>(span.level)]);
      name = wait_name;
    }
    begin_event(name, span.core, span.begin_cycles, span.end_cycles);
    write_tile(span.tile_id);
    text_ += "}}";
  }

  void write_name(std::uint32_t row, const std::string& name) {
    text_ += ",\n{\"name\":\"thread_name\",\"ph\":\"M\",\"pid\":0,\"tid\":" + std::to_string(row) +
             ",\"args\":{\"name\":\"" + name + "\"}}";
  }

  void write_names(std::size_t cores) {
    for (std::uint32_t core = 0; core < cores; ++core) write_name(core, "core " + std::to_string(core));
  }

  /// Of a row that is no core's.
  void write_part(std::string_view name, std::uint32_t row, double begin_cycles, double end_cycles,
                  const std::string& arguments) {
    begin_event(name, row, begin_cycles, end_cycles);
    text_ += arguments + "}}";
  }

  /// Leaves the text inside the event's arguments.
  void begin_event(std::string_view name, std::uint32_t core, double begin_cycles, double end_cycles) {
    const std::uint64_t begin = units(offset_cycles_ + begin_cycles);
    text_.append(",\n{\"name\":\"").append(name).append("\",\"ph\":\"X\",\"pid\":0,\"tid\":");
    text_ += std::to_string(core) + ",\"ts\":" + microseconds(begin) +
             ",\"dur\":" + microseconds(units(offset_cycles_ + end_cycles) - begin) + ",\"args\":{";
  }

  void write_tile(std::uint32_t tile_id) {
    if (tile_id != sim::kNoTile) text_.append("\"").append(item_).append("\":").append(std::to_string(tile_id));
  }

  std::uint64_t units(double cycles) const { return static_cast<std::uint64_t>(cycles * units_per_cycle_ + 0.5); }

  static std::string microseconds(std::uint64_t units) {
    // The leading 1 keeps the zeros behind the point.
    const std::string rest = std::to_string(kUnitsPerMicrosecond + units % kUnitsPerMicrosecond);
    return std::to_string(units / kUnitsPerMicrosecond) + "." + rest.substr(1);
  }

  double units_per_cycle_;
  double threshold_cycles_;
  double offset_cycles_ = 0;  // of the pass's begin
  std::string_view item_ = "tile";
  const sim::EngineWork* engine_ = nullptr;
  std::string text_;
  Run run_;
};

/// Writes `timing` with the first threshold that suffices. @param most_cycles  of a span.
template <class Timing>
std::string text_of(const Timing& timing, double most_cycles, const sim::MachineProfile& machine,
                    std::size_t max_bytes) {
  for (double threshold = 0;; threshold = threshold > 0 ? threshold * kThresholdFactor : kFirstThresholdCycles) {
    const bool is_last = threshold > most_cycles && threshold > 0;
    Writer writer(machine, threshold);
    if (writer.write(timing, machine, is_last ? static_cast<std::size_t>(-1) : max_bytes) || is_last) {
      return writer.take_text();
    }
  }
}

}  // namespace

std::string timeline_json(const sim::FrameTiming& timing, const sim::MachineProfile& machine, std::size_t max_bytes) {
  return text_of(timing, timing.frame_cycles, machine, max_bytes);
}

std::string passes_timeline_json(std::span<const sim::PassTiming> passes, const sim::MachineProfile& machine,
                                 std::size_t max_bytes) {
  double most_cycles = 0;
  for (const sim::PassTiming& pass : passes) most_cycles = std::max(most_cycles, pass.run.frame_cycles);
  return text_of(passes, most_cycles, machine, max_bytes);
}

}  // namespace gridiron::tool
