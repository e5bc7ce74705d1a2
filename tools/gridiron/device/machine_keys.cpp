// Machine keys: see the header. SPDX-License-Identifier: Apache-2.0
#include "machine_keys.h"

#include <gridiron/sim/build_work.h>
#include <gridiron/sim/engine_work.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <span>
#include <system_error>
#include <type_traits>

#include "base/numbers.h"
#include "base/words.h"

namespace gridiron::tool {
namespace {

using sim::BuildStep;
using sim::MachineProfile;
using sim::MasterProfile;

struct Limits {
  double least, most;
};
constexpr Limits kCycles = {0, 1 << 20};  // of one step; the replay limits larger values
constexpr Limits kHertz = {1, 1e12};

using Member = std::variant<std::uint32_t MachineProfile::*, std::uint64_t MachineProfile::*, double MachineProfile::*,
                            sim::Latency MachineProfile::*>;

struct Row {
  std::string_view key;
  Member member;
  Limits limits;
  std::string_view meaning;
};
constexpr Row kRows[] = {
    {"core_count", &MachineProfile::core_count, {1, 1024}, "cores that render; --cores replaces it"},
    {"clock_hz", &MachineProfile::clock_hz, kHertz, "their clock"},
    {"main_memory_bytes", &MachineProfile::main_memory_bytes, {0x1p16, 0x1p40}, "shared by all cores"},
    {"local_store_bytes", &MachineProfile::local_store_bytes, {0x1p14, 0x1p30}, "of each core"},
    {"line_bytes", &MachineProfile::line_bytes, {1, 16384}, "a transfer costs whole lines of this size"},
    {"queue_depth", &MachineProfile::queue_depth, {1, 4096}, "commands a core may have pending"},
    {"lines_in_flight", &MachineProfile::lines_in_flight, {1, 4096}, "lines a core may have under way"},
    {"issue_cycles", &MachineProfile::issue_cycles, kCycles, "of the core, per command"},
    {"wait_cycles", &MachineProfile::wait_cycles, kCycles, "of the core, per wait, even when nothing is pending"},
    {"latency_cycles", &MachineProfile::latency_cycles, kCycles,
     "from a line's turn on the channel to its arrival; or several, with their shares: 400:0.98 5400:0.02"},
    {"latency_seed", &MachineProfile::latency_seed, {0, 0xFFFFFFFFu}, "decides which line has which of several"},
    {"channel_bytes_per_cycle", &MachineProfile::channel_bytes_per_cycle, {0.0625, 65536}, "shared by all cores"},
    {"core_line_interval_cycles", &MachineProfile::core_line_interval_cycles, kCycles,
     "least distance between two lines of one core"},
    {"claim_cycles", &MachineProfile::claim_cycles, kCycles, "from asking for an item, such as a tile, to having it"},
    {"pass_start_cycles", &MachineProfile::pass_start_cycles, kCycles,
     "from the general core's decision to begin a pass until all cores run it"},
    {"pass_barrier_cycles", &MachineProfile::pass_barrier_cycles, kCycles,
     "from the last core's end of a pass until the general core knows"},
};
constexpr const char* kWorkKey = "work_cycles.";
constexpr const char* kMasterClockKey = "master.clock_hz";
constexpr const char* kStepKey = "master.step_cycles.";

// Counts the members of an aggregate by the number of values that can initialise it.
struct AnyValue {
  template <class T>
  operator T() const;
};
template <class T, class... Values>
consteval std::size_t member_count() {
  if constexpr (requires { T{Values{}..., AnyValue{}}; }) {
    return member_count<T, Values..., AnyValue>();
  } else {
    return sizeof...(Values);
  }
}
consteval bool are_sound() {
  for (const Row& row : kRows) {
    int count = 0;
    for (const Row& other : kRows) count += other.member == row.member || other.key == row.key ? 1 : 0;
    if (count != 1 || row.limits.least >= row.limits.most) return false;
  }
  return true;
}
static_assert(are_sound(), "each row has a key and a member of its own, and limits in their order");
static_assert(member_count<MachineProfile>() == std::size(kRows) + 5,
              "each member but name, description, work_cycles, tile_work_cycles and master has a row");
static_assert(member_count<MasterProfile>() == 2, "clock_hz and step_cycles have keys");

// "2^40" instead of many digits.
std::string limit_text(double limit) {
  const int exponent = std::ilogb(limit);
  return exponent >= 30 && std::exp2(exponent) == limit ? "2^" + std::to_string(exponent) : text_of(limit);
}

MachineKeyHelp help_of(std::string key, const Limits& limits, std::string_view meaning) {
  return {std::move(key), limit_text(limits.least) + " to " + limit_text(limits.most), meaning};
}

constexpr std::string_view kBetweenNumbers = " \t";

// Takes the first word, and the blanks behind it, from `text`.
std::string_view take_word(std::string_view& text) {
  const std::string_view word = text.substr(0, text.find_first_of(kBetweenNumbers));
  text.remove_prefix(word.size());
  text.remove_prefix(std::min(text.find_first_not_of(kBetweenNumbers), text.size()));
  return word;
}

// As set_number(), of a key that is not a latency. @param quoted  its name in messages.
std::optional<std::string> set_plain(const MachineKey& key, const std::string& quoted, std::string_view text) {
  const bool is_whole = !std::holds_alternative<double*>(key.number);
  double value = 0;
  std::uint64_t count = 0;
  const char* const end = text.data() + text.size();
  const auto parsed = is_whole ? std::from_chars(text.data(), end, count) : std::from_chars(text.data(), end, value);
  const bool too_large = parsed.ec == std::errc::result_out_of_range && parsed.ptr == end;
  const auto limit_text = [is_whole](double limit) {
    return is_whole ? std::to_string(static_cast<std::uint64_t>(limit)) : text_of(limit);
  };
  const std::string range = "from " + limit_text(key.least) + " to " + limit_text(key.most);
  if (!too_large && (parsed.ec != std::errc{} || parsed.ptr != end || !std::isfinite(value))) {
    return in_quotes(text) + " is not a " + (is_whole ? "whole number " : "number ") + range;
  }
  if (is_whole) value = static_cast<double>(count);
  if (too_large || value < key.least || value > key.most) {
    return quoted + " must be " + range + ", not " + in_quotes(text);
  }
  const auto store = [&]<class Number>(Number* number) {
    if constexpr (std::is_arithmetic_v<Number>) {
      *number = is_whole ? static_cast<Number>(count) : static_cast<Number>(value);
    }
  };
  std::visit(store, key.number);
  return std::nullopt;
}

// The same of "500", or "400:0.98 5400:0.02".
std::optional<std::string> set_latency(const MachineKey& key, sim::Latency& latency, std::string_view text) {
  const std::string quoted = in_quotes(key.name);
  const auto set_real = [](double& real, MachineKey limits, const std::string& name, std::string_view word) {
    limits.number = &real;
    return set_plain(limits, name, word);
  };
  if (text.find(':') == std::string_view::npos && text.find_first_of(kBetweenNumbers) == std::string_view::npos) {
    double cycles = 0;
    const std::optional<std::string> defect = set_real(cycles, key, quoted, text);
    if (!defect) latency = cycles;
    return defect;
  }
  MachineKey share_key = key;
  share_key.least = 0x1p-32;
  share_key.most = 1;
  std::vector<sim::LatencyShare> shares;
  double sum = 0;
  while (!text.empty()) {
    const std::string_view word = take_word(text);
    const std::size_t colon = word.find(':');
    if (colon == std::string_view::npos) {
      return quoted + " takes one number, or several with shares, like 400:0.98 5400:0.02";
    }
    if (shares.size() == sim::Latency::kMaxShares) {
      return quoted + " takes at most " + std::to_string(sim::Latency::kMaxShares) + " numbers";
    }
    sim::LatencyShare& one = shares.emplace_back();
    if (auto defect = set_real(one.cycles, key, quoted, word.substr(0, colon))) return defect;
    if (auto defect = set_real(one.share, share_key, "a share of " + quoted, word.substr(colon + 1))) return defect;
    sum += one.share;
  }
  if (std::abs(sum - 1) > 1e-9) return "the shares of " + quoted + " add up to " + text_of(sum) + ", not to 1";
  latency = std::span<const sim::LatencyShare>(shares);
  return std::nullopt;
}

}  // namespace

std::optional<std::string> set_number(const MachineKey& key, std::string_view text) {
  const std::string quoted = in_quotes(key.name);
  if (text.empty()) return quoted + " has no value";
  if (sim::Latency* const* const latency = std::get_if<sim::Latency*>(&key.number)) {
    return set_latency(key, **latency, text);
  }
  if (text.find_first_of(kBetweenNumbers) != std::string_view::npos) return quoted + " takes one number";
  return set_plain(key, quoted, text);
}

std::string text_of(const MachineKey& key) {
  const auto text = []<class Number>(const Number* number) {
    if constexpr (std::is_integral_v<Number>) {
      return std::to_string(*number);
    } else {
      return text_of(*number);
    }
  };
  return std::visit(text, key.number);
}

std::vector<MachineKey> machine_keys(MachineProfile& machine) {
  std::vector<MachineKey> keys;
  for (const Row& row : kRows) {
    const auto add = [&](auto member) {
      keys.push_back({std::string(row.key), &(machine.*member), row.limits.least, row.limits.most});
    };
    std::visit(add, row.member);
  }
  for (std::uint32_t i = 0; i < sim::kGridEngine.kind_count(); ++i) {
    keys.push_back({kWorkKey + std::string(sim::work_kind(WorkId(i)).name), &machine.work_cycles[i], kCycles.least,
                    kCycles.most, !sim::is_charged_as_event(WorkId(i))});
  }
  for (std::uint32_t i = 0; i < kTileWorkCount; ++i) {
    keys.push_back({kWorkKey + std::string(sim::kTileWorkKinds[i].name), &machine.tile_work_cycles[i], kCycles.least,
                    kCycles.most});
  }
  keys.push_back({kMasterClockKey, &machine.master.clock_hz, kHertz.least, kHertz.most});
  for (std::size_t i = 0; i < sim::kBuildStepCount; ++i) {
    keys.push_back({kStepKey + std::string(sim::name_of(static_cast<BuildStep>(i))), &machine.master.step_cycles[i],
                    kCycles.least, kCycles.most});
  }
  return keys;
}

std::vector<MachineKey> file_keys(MachineProfile& machine) {
  std::vector<MachineKey> keys = machine_keys(machine);
  std::erase_if(keys, [](const MachineKey& key) { return !key.is_in_files; });
  return keys;
}

std::string text_of(double value) {
  std::string result = shortest_text(value);
  // Shortens 3.2e+09 to 3.2e9.
  const std::size_t exponent = result.find("e+");
  if (exponent != std::string::npos) {
    const std::size_t digit = result.find_first_not_of('0', exponent + 2);
    result.erase(exponent + 1, digit - exponent - 1);
  }
  return result;
}

std::string text_of(const sim::Latency& latency) {
  if (latency.shares().size() == 1) return text_of(latency.shares().front().cycles);
  std::string text;
  for (const sim::LatencyShare& one : latency.shares()) {
    if (!text.empty()) text += ' ';
    text += text_of(one.cycles);
    text += ':';
    text += text_of(one.share);
  }
  return text;
}

std::vector<MachineKeyHelp> machine_key_help() {
  std::vector<MachineKeyHelp> help;
  for (const Row& row : kRows) help.push_back(help_of(std::string(row.key), row.limits, row.meaning));
  help.push_back(
      help_of(std::string(kWorkKey).append("KIND"), kCycles, "per unit of work; a group of 4 rays is one unit"));
  help.push_back(help_of(kMasterClockKey, kHertz, "clock of the general core, which builds the grid"));
  help.push_back(help_of(std::string(kStepKey).append("STEP"), kCycles, "of its clock, per step of a build"));
  return help;
}

}  // namespace gridiron::tool
