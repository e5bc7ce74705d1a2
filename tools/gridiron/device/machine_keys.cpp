// Machine keys: see the header. SPDX-License-Identifier: Apache-2.0
#include "machine_keys.h"

#include <gridiron/sim/build_work.h>
#include <gridiron/sim/engine_work.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>

#include "base/numbers.h"

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

}  // namespace

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
