// Windows, prices and words: see the header. SPDX-License-Identifier: Apache-2.0
#include <counted_frame.h>
#include <direct_count.h>
#include <gridiron/bvh/bvh_engine_work.h>
#include <gridiron/sim/machine_profile.h>
#include <work_table.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <mutex>
#include <span>

#include "experiment/views.h"
#include "experiment/workers.h"
#include "gridiron/scene/view.h"

namespace gridiron::calibrate {
namespace {

constexpr std::uint32_t kWidth = 1024, kTilesX = kWidth / 32;
constexpr std::array<std::uint32_t, 3> kWindowTiles = {6, 14, 23};  // the first of three, on both axes
constexpr std::size_t kWindows = kWindowTiles.size() * kWindowTiles.size();
constexpr std::uint32_t kRing = 3;

std::array<std::uint32_t, 9> tiles_of(std::size_t window) {
  const std::uint32_t x = kWindowTiles[window % 3], y = kWindowTiles[window / 3];
  std::array<std::uint32_t, 9> tiles{};
  for (std::uint32_t i = 0; i < 9; ++i) tiles[i] = (y + i / 3) * kTilesX + x + i % 3;
  return tiles;
}

const sim::EngineWork& engine_of(const std::string& configuration) {
  if (configuration == "bvh") return bvh::kBvhEngine;
  return configuration == "best" ? sim::kTreeEngine : sim::kGridEngine;
}

std::array<double, kWorkKindCount> prices_of(const std::string& configuration) {
  const sim::EngineWork& engine = engine_of(configuration);
  return sim::work_prices(*sim::find_machine_profile("cell-ps3"), engine);
}

bool is_charged(std::uint32_t kind) {
  return !sim::is_charged_as_event(WorkId(kind));
}

DirectCount priced_count(const std::string& view, const std::string& configuration, const Totals& totals) {
  DirectCount count{.view = view, .configuration = configuration, .totals = totals};
  const std::array<double, kWorkKindCount> prices = prices_of(configuration);
  for (std::uint32_t kind = 0; kind < kWorkKindCount; ++kind) {
    if (!is_charged(kind)) continue;
    count.counted += totals[kind].cycles();
    count.priced += prices[kind] * static_cast<double>(totals[kind].units);
  }
  return count;
}

// A view in one configuration, its windows counted on all threads.
DirectCount count_view(const experiment::View& view, const CountedFrame& frame, const std::string& configuration,
                       const std::map<CountedProgram, Branches>& usual, std::uint32_t threads,
                       const std::function<void()>& done) {
  const FrameInMemory memory(frame);
  std::array<Totals, kWindows> windows{};
  experiment::share_work(threads, kWindows, [&](std::size_t window) {
    windows[window] = memory.count(usual.at(memory.program()), tiles_of(window)).counts.totals;
    done();
  });
  DirectCount sum = priced_count(view.key, configuration, windows[0]);
  sum.worst_x = sum.worst_y = 32 * kWindowTiles[0];
  sum.worst = sum.error();
  for (std::size_t window = 1; window < kWindows; ++window) {
    const DirectCount one = priced_count(view.key, configuration, windows[window]);
    for (std::uint32_t kind = 0; kind < kWorkKindCount; ++kind) add(sum.totals[kind], one.totals[kind]);
    sum.counted += one.counted;
    sum.priced += one.priced;
    if (std::abs(one.error()) <= std::abs(sum.worst)) continue;
    sum.worst = one.error();
    sum.worst_x = 32 * kWindowTiles[window % 3];
    sum.worst_y = 32 * kWindowTiles[window / 3];
  }
  return sum;
}

template <class... Values>
std::string format(const char* pattern, Values... values) {
  char text[400];
  const int length = std::snprintf(text, sizeof(text), pattern, values...);
  return std::string(text, static_cast<std::size_t>(length));
}

}  // namespace

std::vector<DirectCount> count_windows(const std::filesystem::path& scenes, std::uint32_t threads,
                                       const std::function<void(std::size_t, std::size_t)>& done) {
  const experiment::FoundViews found = experiment::find_views(scenes);
  const std::span<const tool::Configuration> configurations = tool::configurations();
  const std::size_t total = found.views.size() * (configurations.size() + 1) * kWindows;
  const std::map<CountedProgram, Branches> usual = usual_branches();
  std::size_t finished = 0;
  std::mutex one_at_a_time;
  const auto count_one = [&] {
    const std::lock_guard lock(one_at_a_time);
    done(++finished, total);
  };
  std::vector<DirectCount> counts;
  for (const experiment::View& view : found.views) {
    const tool::Mesh& mesh = view.mesh();
    CountedFrame frame{.vertices = mesh.vertices, .triangles = mesh.triangles};
    frame.camera = tool::complete_view(view.camera, 1.0, [](const auto&) {});
    frame.width = kWidth;
    frame.shading = Shading::kNone;
    for (const tool::Configuration& configuration : configurations) {
      frame.configuration = &configuration;
      counts.push_back(count_view(view, frame, std::string(configuration.name), usual, threads, count_one));
    }
    frame.ring_size = kRing;
    counts.push_back(count_view(view, frame, "bvh", usual, threads, count_one));
  }
  return counts;
}

std::vector<DirectCount> count_effects() {
  return {priced_count("near_lights", "effects", count_frame("lamp")),
          priced_count("far_lights", "effects", count_frame("sun"))};
}

std::string direct_count_table(const std::vector<DirectCount>& counts) {
  std::string text =
      "| view | configuration | counted, M cycles | priced | difference | worst window |\n|---|---|---|---|---|---|\n";
  double sum = 0;
  const DirectCount* worst = nullptr;
  for (const DirectCount& one : counts) {
    text += format("| %s | %s | %.2f | %.2f | %+.1f %% | %+.1f %% at %u, %u |\n", one.view.c_str(),
                   one.configuration.c_str(), one.counted / 1e6, one.priced / 1e6, 100 * one.error(), 100 * one.worst,
                   one.worst_x, one.worst_y);
    sum += std::abs(one.error());
    if (worst == nullptr || std::abs(one.error()) > std::abs(worst->error())) worst = &one;
  }
  return text + format("\nMean of the differences' magnitudes: %.1f %%. Largest: %s in %s, %+.1f %%.\n",
                       100 * sum / static_cast<double>(counts.size()), worst->view.c_str(),
                       worst->configuration.c_str(), 100 * worst->error());
}

std::string direct_count_kinds(const std::vector<DirectCount>& counts) {
  std::vector<std::string> configurations;
  for (const DirectCount& one : counts) {
    if (configurations.empty() || std::ranges::find(configurations, one.configuration) == configurations.end()) {
      configurations.push_back(one.configuration);
    }
  }
  std::string text;
  for (const std::string& configuration : configurations) {
    const std::array<double, kWorkKindCount> prices = prices_of(configuration);
    const sim::EngineWork& engine = engine_of(configuration);
    text += format("\n%s\n%-20s %9s", configuration.c_str(), "kind", "price");
    for (const DirectCount& one : counts) {
      if (one.configuration == configuration) text += format(" %17.17s", one.view.c_str());
    }
    text += "   (cycles a unit, share of all cycles, what the price adds to the error)\n";
    for (std::uint32_t kind = 0; kind < engine.kind_count(); ++kind) {
      std::string row;
      bool occurs = false;
      for (const DirectCount& one : counts) {
        if (one.configuration != configuration) continue;
        const KindTotals& totals = one.totals[kind];
        const double units = static_cast<double>(totals.units);
        const double off = (prices[kind] * units - totals.cycles()) / one.counted;
        occurs = occurs || (totals.operations != decltype(totals.operations){} && is_charged(kind));
        row += format(" %6.1f%5.1f%+6.2f", units == 0 ? totals.cycles() : totals.cycles() / units,
                      100 * totals.cycles() / one.counted, 100 * off);
      }
      if (occurs) {
        text += format("%-20s %9.1f", std::string(sim::work_kind(WorkId(kind), engine).name).c_str(), prices[kind]);
        text += row + "\n";
      }
    }
  }
  return text;
}

}  // namespace gridiron::calibrate
