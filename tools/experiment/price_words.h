// Price words: the gain and cost of a step from one accuracy profile to another, and which targets are met.
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

/// A figure of a price; less is better.
struct Metric {
  std::string words;    ///< "cycles a frame"
  bool is_cost = true;  ///< shown as a share of the old value; false: an error, shown as new and old value
  int decimals = 1;
  std::function<double(const PriceList&, const Price&)> value;  ///< NaN if there is none
};

/// @returns the figures that sentences about a step mention.
[[nodiscard]] std::vector<Metric> price_metrics();

/// @returns "3.1 to 4.0 % more", "from 1.2 % fewer to 2.0 % more"; "none" for an empty range.
/// @param percents  changes, a decrease below 0.
[[nodiscard]] std::string change_words(const Range& percents, int decimals);

/// @returns the gains, costs and unchanged figures of choosing `to` instead of `from`, over all views.
[[nodiscard]] std::string step_words(const PriceList& list, std::size_t configuration, std::size_t from,
                                     std::size_t to);

/// @returns whether a profile can be judged by a configuration: `grid` culls by vertices, which the records of `paper`
/// do not have.
[[nodiscard]] bool is_at_home(std::string_view profile, std::size_t configuration);

/// A limit, set beforehand, on a change from one profile to another.
struct Target {
  std::string what;      ///< "cycles a frame"
  std::string from, to;  ///< profiles
  std::string configuration;
  double limit_percent = 0;      ///< greatest change; below 0: a fall of at least so much
  std::vector<double> percents;  ///< change by view, a decrease below 0; NaN without a figure

  /// @returns the greatest change of a view, NaN without one.
  [[nodiscard]] double worst_percent() const;
  /// @returns whether every view is within the limit, and at least one was measured.
  [[nodiscard]] bool is_met() const;
  /// @returns "at most 15 % more", "at least 45 % fewer".
  [[nodiscard]] std::string limit_words() const;
};

/// @returns the targets whose profiles exist.
[[nodiscard]] std::vector<Target> price_targets(const PriceList& list);

/// @returns measured value, target and outcome as a sentence; names the views that miss it.
[[nodiscard]] std::string target_words(const PriceList& list, const Target& target);

/// @returns the effect of a profile's lattice on each view, nothing without a lattice.
[[nodiscard]] std::string lattice_words(const PriceList& list, std::size_t profile);

/// @returns compact compared with standard where memory is slow, nothing without compact.
[[nodiscard]] std::string starved_words(const PriceList& list);

}  // namespace gridiron::experiment
