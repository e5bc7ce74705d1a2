// Machine sweep. SPDX-License-Identifier: Apache-2.0
#include "machine_sweep.h"

#include <report/report.h>

#include <algorithm>
#include <mutex>
#include <optional>
#include <string_view>

#include "base/failure.h"
#include "base/numbers.h"
#include "base/progress.h"
#include "base/ranks.h"
#include "base/share_work.h"
#include "base/suggestion.h"
#include "base/value_bytes.h"
#include "base/words.h"
#include "files/interrupt.h"
#include "shared_traces.h"

namespace gridiron::tool {
namespace {

constexpr std::size_t kMostKeys = 3;
constexpr std::size_t kMostMachines = 4096;
constexpr std::string_view kCoreCount = "core_count";

// @returns why a replay of one trace cannot vary a key; empty if it can.
std::string_view obstacle_of(std::string_view key) {
  if (key == "main_memory_bytes" || key == "local_store_bytes" || key == "queue_depth") {
    return " changes the frame itself, not only its time: render it for each value, with --machine";
  }
  if (key.starts_with("master.") || key.starts_with("pass_")) {
    return " is of builds, which a frame's time does not contain";
  }
  return "";
}

const MachineKey& find_key(const std::vector<MachineKey>& keys, std::string_view name) {
  const auto known = std::ranges::find(keys, name, &MachineKey::name);
  if (known == keys.end()) {
    usage_error("--vary: unknown key " + in_quotes(name) + " ('gridiron machines --help' lists them)" +
                did_you_mean(name, keys_of_replays()));
  }
  return *known;
}

}  // namespace

VariedKey parse_varied_key(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos) {
    usage_error("--vary: " + in_quotes(text) + " is not KEY=VALUE,VALUE,... with a key of machine files");
  }
  VariedKey varied{text.substr(0, equals), {}};
  sim::MachineProfile scratch = sim::machine_profiles().front();
  const std::vector<MachineKey> keys = file_keys(scratch);
  const MachineKey& key = find_key(keys, varied.name);
  if (const std::string_view obstacle = obstacle_of(key.name); !obstacle.empty()) {
    usage_error("--vary: " + in_quotes(key.name) + std::string(obstacle));
  }
  for (std::string_view rest = std::string_view(text).substr(equals + 1);;) {
    const std::size_t comma = rest.find(',');
    if (const auto defect = set_number(key, rest.substr(0, comma))) usage_error("--vary " + key.name + ": " + *defect);
    varied.values.push_back(text_of(key));
    if (comma == std::string_view::npos) return varied;
    rest.remove_prefix(comma + 1);
  }
}

std::vector<std::string> keys_of_replays() {
  sim::MachineProfile scratch = sim::machine_profiles().front();
  std::vector<std::string> names;
  for (const MachineKey& key : file_keys(scratch)) {
    if (obstacle_of(key.name).empty()) names.push_back(key.name);
  }
  return names;
}

void check_varied_keys(std::span<const VariedKey> varied) {
  if (varied.size() > kMostKeys) usage_error("--vary: at most " + std::to_string(kMostKeys) + " keys can be varied");
  std::size_t count = 1;
  for (const VariedKey& key : varied) {
    if (std::ranges::count(varied, key.name, &VariedKey::name) > 1)
      usage_error("--vary: second " + in_quotes(key.name));
    count *= std::min(key.values.size(), kMostMachines + 1);
  }
  if (count > kMostMachines) {
    usage_error("--vary: more than " + words_of_count(kMostMachines) + " machines, which is the most of a sweep");
  }
}

std::size_t machine_count(std::span<const VariedKey> varied) {
  std::size_t count = 1;
  for (const VariedKey& key : varied) count *= key.values.size();
  return count;
}

std::vector<std::size_t> places_of(std::span<const VariedKey> varied, std::size_t i) {
  std::vector<std::size_t> places(varied.size());
  for (std::size_t key = varied.size(); key-- > 0;) {
    places[key] = i % varied[key].values.size();
    i /= varied[key].values.size();
  }
  return places;
}

std::vector<std::uint32_t> varied_core_counts(std::span<const VariedKey> varied) {
  std::vector<std::uint32_t> counts;
  for (const VariedKey& key : varied) {
    if (key.name != kCoreCount) continue;
    for (const std::string& value : key.values) counts.push_back(*parse_count(value));
  }
  return counts;
}

SweptMachine::SweptMachine(const sim::MachineProfile& base, std::span<const VariedKey> varied)
    : machine_(base), varied_(varied) {
  const std::vector<MachineKey> keys = file_keys(machine_);
  for (const VariedKey& key : varied) keys_.push_back(find_key(keys, key.name));
}

const sim::MachineProfile& SweptMachine::at(std::size_t i) {
  const std::vector<std::size_t> places = places_of(varied_, i);
  for (std::size_t key = 0; key < keys_.size(); ++key) {
    if (const auto defect = set_number(keys_[key], varied_[key].values[places[key]])) usage_error("--vary: " + *defect);
  }
  return machine_;
}

void require_time(const sim::MachineProfile& base, std::span<const VariedKey> varied) {
  if (varied.empty()) return;
  SweptMachine machine(base, varied);
  for (std::size_t i = 0; i < machine_count(varied); ++i) {
    if (!sim::counts_instructions(machine.at(i))) continue;
    usage_error("--vary: the prices of " + std::string(base.name) +
                " are instructions, so that it has no frames a second");
  }
}

SweepFigures figures_of(const sim::FrameTiming& timing) {
  SweepFigures figures;
  figures.frame_cycles = timing.frame_cycles;
  figures.seconds = timing.seconds;
  for (const sim::CoreTiming& core : timing.cores) {
    figures.compute_cycles += core.compute_cycles;
    figures.init_cycles += core.init_cycles;
    figures.idle_cycles += core.idle_cycles;
  }
  figures.wait_cycles = wait_cycles_of(timing);
  figures.wait_percent = wait_percent_of(timing);
  figures.channel_busy_percent = timing.frame_cycles > 0 ? 100 * timing.channel_busy_cycles / timing.frame_cycles : 0.0;
  return figures;
}

std::vector<SweepFigures> replay_sweep(sim::FrameTrace& trace, const sim::MachineProfile& base,
                                       std::span<const VariedKey> varied, std::uint32_t threads, bool quiet) {
  Ranks& all = ranks();
  std::optional<SharedTraces> shared;
  if (all.count() > 1) shared.emplace(trace);
  const std::size_t count = machine_count(varied);
  const auto own_count = static_cast<std::size_t>(all.share_of(count));
  std::vector<SweepFigures> figures(count);
  Progress progress(!quiet && all.is_first(), "machines");
  std::mutex mutex;
  std::size_t done = 0;
  share_work(threads, own_count, [&](std::size_t k) {
    stop_if_interrupted();
    SweptMachine machine(base, varied);
    const auto i = static_cast<std::size_t>(all.piece(k));
    const sim::MachineProfile& on = machine.at(i);
    figures[i] = figures_of(shared ? shared->replay(on) : sim::replay(trace, on, {}));
    const std::lock_guard lock(mutex);
    all.attend();
    progress.update(++done, own_count);
  });
  const auto pack = [&figures](std::size_t i) {
    ByteWriter writer;
    writer.add(figures[i]);
    return writer.take();
  };
  exchange_results(count, pack, [&figures](std::size_t i, const Bytes& bytes) { ByteReader(bytes).take(figures[i]); });
  return figures;
}

}  // namespace gridiron::tool
