// Price words: what a step from one accuracy profile to another buys and costs, and which targets are met.
// Memory: std::string. Threads: any may read. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "experiment/price_list.h"
#include "experiment/sections.h"

namespace gridiron::experiment {

/// A figure of a price of which less is better.
struct Metric {
  std::string words;    ///< "cycles a frame"
  bool is_cost = true;  ///< told as a share of what it was; false: an error, told as what it is and was
  int decimals = 1;
  std::function<double(const PriceList&, const Price&)> value;  ///< not a number where there is none
};

/// @returns the figures that sentences about a step go through.
[[nodiscard]] std::vector<Metric> price_metrics();

/// @returns "3.1 to 4.0 % more", "from 1.2 % fewer to 2.0 % more"; "none" of an empty range.
/// @param percents  changes, a fall below 0.
[[nodiscard]] std::string change_words(const Range& percents, int decimals);

/// @returns what is bought, what is paid and what stays by choosing `to` instead of `from`, over all views.
[[nodiscard]] std::string step_words(const PriceList& list, std::size_t configuration, std::size_t from,
                                     std::size_t to);

/// @returns whether a configuration is one that a profile can be judged by: `best` culls by vertices, which the records
/// of `paper` do not have.
[[nodiscard]] bool is_at_home(std::string_view profile, std::size_t configuration);

/// A change from one profile to another of which it was said beforehand how far it may go.
struct Target {
  std::string what;      ///< "cycles a frame"
  std::string from, to;  ///< profiles
  std::string configuration;
  double limit_percent = 0;      ///< greatest change; below 0: a fall of at least so much
  std::vector<double> percents;  ///< change by view, a fall below 0; not a number where there is none

  /// @returns the greatest change of a view, not a number where there is none.
  [[nodiscard]] double worst_percent() const;
  /// @returns whether every view keeps to the limit, and at least one was measured.
  [[nodiscard]] bool is_met() const;
  /// @returns "at most 15 % more", "at least 45 % fewer".
  [[nodiscard]] std::string limit_words() const;
};

/// @returns those whose profiles there are.
[[nodiscard]] std::vector<Target> price_targets(const PriceList& list);

/// @returns measured value, target and outcome as a sentence; the views that miss it by name.
[[nodiscard]] std::string target_words(const PriceList& list, const Target& target);

/// @returns what the lattice of a profile does to each view, nothing where it has none.
[[nodiscard]] std::string lattice_words(const PriceList& list, std::size_t profile);

/// @returns compact beside standard where memory is slow, nothing where there is no compact.
[[nodiscard]] std::string starved_words(const PriceList& list);

}  // namespace gridiron::experiment
