// Price words. SPDX-License-Identifier: Apache-2.0
#include "experiment/price_words.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/words.h"
#include "experiment/table.h"

namespace gridiron::experiment {
namespace {

using RunOf = const RunResult& (PriceList::*)(const Price&) const;

double cycles_of(const RunResult& run) {
  return run.failed() ? std::nan("") : run.timing.frame_cycles;
}

Metric cost(std::string words, RunOf run, double (*value)(const RunResult&)) {
  return {std::move(words), true, 1, [run, value](const PriceList& list, const Price& price) {
            const RunResult& result = (list.*run)(price);
            return result.failed() ? std::nan("") : value(result);
          }};
}

Metric error(std::string words, int decimals, double (*value)(const Comparison&)) {
  return {std::move(words), false, decimals,
          [value](const PriceList&, const Price& price) { return price.errors ? value(*price.errors) : std::nan(""); }};
}

// Percent by which each view's figure changes from one profile to the other.
std::vector<double> changes_of(const PriceList& list, std::size_t configuration, std::size_t from, std::size_t to,
                               const std::function<double(const Price&)>& value) {
  std::vector<double> percents;
  for (std::size_t view = 0; view < list.views().size(); ++view) {
    percents.push_back(
        percent_more(value(list.price(view, configuration, to)), value(list.price(view, configuration, from))));
  }
  return percents;
}

std::string joined(const std::vector<std::string>& words, const char* separator) {
  std::string text;
  for (const std::string& each : words) text += (text.empty() ? "" : separator) + each;
  return text;
}

}  // namespace

std::vector<Metric> price_metrics() {
  const auto cycles = [](const RunResult& run) { return run.timing.frame_cycles; };
  const auto moved = [](const RunResult& run) { return static_cast<double>(run.moved_bytes()); };
  const auto memory = [](const RunResult& run) { return static_cast<double>(run.facts.main_memory_bytes); };
  const auto at_edges = [](std::string words, std::uint64_t HitCounts::*count) {
    return Metric{std::move(words), false, 0, [count](const PriceList&, const Price& price) {
                    const std::optional<HitCounts>& hits = price.at_edges;
                    return hits ? hits->per_million((*hits).*count) : std::nan("");
                  }};
  };
  return {
      cost("cycles a frame", &PriceList::frame, cycles),
      cost("cycles of a frame with distances", &PriceList::with_distances, cycles),
      cost("bytes moved by DMA", &PriceList::frame, moved),
      cost("bytes of main memory", &PriceList::frame, memory),
      at_edges("holes a million rays at edges", &HitCounts::holes),
      at_edges("rays at edges a million that see through", &HitCounts::seen_through),
      at_edges("false hits a million rays at edges", &HitCounts::false_hits),
      at_edges("wrong triangles a million rays at edges", &HitCounts::wrong_triangles),
      error("holes a million pixels", 1,
            [](const Comparison& found) { return found.hits.per_million(found.hits.holes); }),
      error("false hits a million pixels", 1,
            [](const Comparison& found) { return found.hits.per_million(found.hits.false_hits); }),
      error("wrong triangles a million pixels", 1,
            [](const Comparison& found) { return found.hits.per_million(found.hits.wrong_triangles); }),
      error("ulp of error of t in the median", 0, [](const Comparison& found) { return found.ulps.median; }),
      error("ulp in 99 of 100 pixels", 0, [](const Comparison& found) { return found.ulps.percentile_99; }),
      error("ulp at most", 0, [](const Comparison& found) { return found.ulps.greatest; }),
      error("pixels of another colour a million", 1,
            [](const Comparison& found) { return found.hits.per_million(found.picture.differing_pixels); }),
  };
}

std::string change_words(const Range& percents, int decimals) {
  if (percents.empty()) return "none";
  const double low = percents.least(), high = percents.greatest();
  const auto magnitudes = [decimals](double a, double b) {
    return Range(std::array{std::fabs(a), std::fabs(b)}).percent(decimals);
  };
  if (low >= 0) return magnitudes(low, high) + " more";
  if (high <= 0) return magnitudes(low, high) + " fewer";
  return "from " + magnitudes(low, low) + " fewer to " + magnitudes(high, high) + " more";
}

std::string step_words(const PriceList& list, std::size_t configuration, std::size_t from, std::size_t to) {
  std::vector<std::string> bought, paid, mixed, kept;
  for (const Metric& metric : price_metrics()) {
    Range before, after, percents;
    bool falls = false, rises = false;
    for (std::size_t view = 0; view < list.views().size(); ++view) {
      const double was = metric.value(list, list.price(view, configuration, from));
      const double is = metric.value(list, list.price(view, configuration, to));
      if (!std::isfinite(was) || !std::isfinite(is)) continue;
      before.add(was);
      after.add(is);
      percents.add(percent_more(is, was));
      falls = falls || is < was;
      rises = rises || is > was;
    }
    if (before.empty()) continue;
    // A change that rounds to zero in the text counts as none.
    const bool too_small = metric.is_cost && percents.text(metric.decimals) == fixed_text(0, metric.decimals);
    if ((!falls && !rises) || too_small) {
      kept.push_back(metric.words + (metric.is_cost ? "" : " (" + after.text(metric.decimals) + ")"));
      continue;
    }
    const std::string words = metric.is_cost ? change_words(percents, metric.decimals) + " " + metric.words
                                             : after.text(metric.decimals) + " instead of " +
                                                   before.text(metric.decimals) + " " + metric.words;
    (falls && rises ? mixed : falls ? bought : paid).push_back(words);
  }
  if (bought.empty() && paid.empty() && mixed.empty() && kept.empty()) return "Nothing could be measured.";
  std::string text = bought.empty() ? "It buys nothing." : "It buys: " + joined(bought, "; ") + ".";
  text += paid.empty() ? " It costs nothing." : " It costs: " + joined(paid, "; ") + ".";
  if (!mixed.empty()) text += " Gain or loss, as the view has it: " + joined(mixed, "; ") + ".";
  if (!kept.empty()) text += " The same: " + joined(kept, "; ") + ".";
  return text;
}

bool is_at_home(std::string_view profile, std::size_t configuration) {
  return profile != "paper" || std::string_view(kPricedConfigurations[configuration]) == "reference";
}

double Target::worst_percent() const {
  const Range range(percents);
  return range.empty() ? std::nan("") : range.greatest();
}

bool Target::is_met() const {
  return worst_percent() <= limit_percent;
}

std::string Target::limit_words() const {
  const std::string limit = fixed_text(std::fabs(limit_percent), 0) + " %";
  return limit_percent < 0 ? "at least " + limit + " fewer" : "at most " + limit + " more";
}

std::vector<Target> price_targets(const PriceList& list) {
  std::vector<Target> targets;
  const auto add = [&](const char* from, const char* to, std::string what, double limit, std::size_t configuration,
                       auto value) {
    const auto base = list.find_profile(from), changed = list.find_profile(to);
    if (!base || !changed) return;
    targets.push_back({std::move(what), from, to, kPricedConfigurations[configuration], limit,
                       changes_of(list, configuration, *base, *changed, value)});
  };
  const auto frame_cycles = [&list](const Price& price) { return cycles_of(list.frame(price)); };
  const auto distance_cycles = [&list](const Price& price) { return cycles_of(list.with_distances(price)); };
  struct Dearer {
    const char *from, *to;
    double limit_percent;
  };
  for (const Dearer& step : {Dearer{"paper", "standard", 15}, Dearer{"standard", "exact", 25}}) {
    for (std::size_t configuration = 0; configuration < std::size(kPricedConfigurations); ++configuration) {
      if (!is_at_home(step.from, configuration)) continue;
      add(step.from, step.to, "cycles a frame", step.limit_percent, configuration, frame_cycles);
      add(step.from, step.to, "cycles of a frame with distances", step.limit_percent, configuration, distance_cycles);
    }
  }
  constexpr std::size_t kGrid = 0;
  const auto bytes = [&list](auto bytes_of) {
    return [&list, bytes_of](const Price& price) {
      const RunResult& run = list.frame(price);
      return run.failed() ? std::nan("") : static_cast<double>(bytes_of(run));
    };
  };
  add("standard", "compact", "bytes of triangles in main memory", -45, kGrid,
      bytes([](const RunResult& run) { return run.facts.triangle_bytes; }));
  add("standard", "compact", "bytes of triangles fetched a frame", -45, kGrid,
      bytes([](const RunResult& run) { return run.facts.fetched_triangle_bytes; }));
  add("standard", "compact", "bytes fetched by DMA a frame", -35, kGrid,
      bytes([](const RunResult& run) { return run.bytes_in(); }));
  add("standard", "compact", "bytes moved by DMA a frame", -35, kGrid,
      bytes([](const RunResult& run) { return run.moved_bytes(); }));
  return targets;
}

std::string target_words(const PriceList& list, const Target& target) {
  const Range changes(target.percents);
  std::vector<std::string> missed;
  for (std::size_t view = 0; view < target.percents.size(); ++view) {
    const double percent = target.percents[view];
    if (!(percent > target.limit_percent)) continue;
    missed.push_back(list.views()[view].title + " (" + change_words(Range(std::array{percent}), 1) + ")");
  }
  const std::string text = "Configuration " + target.configuration + ", " + target.what + ": " + target.to + " takes " +
                           change_words(changes, 1) + " than " + target.from + "; asked for: " + target.limit_words() +
                           "; ";
  if (changes.empty()) return text + "not measured.";
  return text + (missed.empty() ? "met in every view." : "missed in " + joined(missed, ", ") + ".");
}

std::string lattice_words(const PriceList& list, std::size_t profile) {
  std::vector<std::string> views;
  for (std::size_t view = 0; view < list.views().size(); ++view) {
    const RunResult& run = list.frame(list.price(view, 0, profile));
    if (run.failed() || !run.facts.grid || !(run.facts.grid->lattice.step > 0)) continue;
    const GridRecord& grid = *run.facts.grid;
    float longest = 0;
    for (int axis = 0; axis < 3; ++axis) {
      longest = std::max(longest, grid.bounds_maximum[axis] - grid.bounds_minimum[axis]);
    }
    const RunResult& exact = list.frame(list.price(view, 0, *list.find_profile("exact")));
    const std::uint32_t lost =
        run.facts.dropped_triangles - std::min(run.facts.dropped_triangles, exact.facts.dropped_triangles);
    views.push_back(list.views()[view].title + " " + number_text(grid.lattice.step) + ", " +
                    tool::words_of_count(static_cast<std::uint64_t>(longest / grid.lattice.step)) +
                    " of them along its longest side, " + tool::words_of_count(lost, "triangle") +
                    " without area on it");
  }
  return views.empty() ? ""
                       : "Its vertices move by half a step of the scene's lattice at most, on each axis. Steps: " +
                             joined(views, "; ") + ".";
}

std::string starved_words(const PriceList& list) {
  const auto standard = list.find_profile("standard"), compact = list.find_profile("compact");
  if (!standard || !compact) return "";
  std::string text;
  for (std::size_t configuration = 0; configuration < std::size(kPricedConfigurations); ++configuration) {
    const auto changes = [&](RunOf run) {
      return Range(changes_of(list, configuration, *standard, *compact,
                              [&list, run](const Price& price) { return cycles_of((list.*run)(price)); }));
    };
    const Range here = changes(&PriceList::frame), there = changes(&PriceList::on_starved);
    text += (text.empty() ? "In configuration " : " In configuration ") +
            std::string(kPricedConfigurations[configuration]) + " compact takes " + change_words(there, 1) +
            " cycles a frame than standard there, and " + change_words(here, 1) + " at full bandwidth.";
  }
  return text;
}

}  // namespace gridiron::experiment
