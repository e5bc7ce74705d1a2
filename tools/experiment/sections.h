// Sections of the paper experiment: each adds its runs to a plan and returns how to write their results.
// Memory: writers share what they need. Threads: one. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "experiment/book.h"
#include "experiment/plan.h"
#include "experiment/systems.h"
#include "experiment/views.h"

namespace gridiron::experiment {

/// Inputs of all sections. Outlives the plan.
struct Stage {
  FoundViews found;
  std::vector<View> knots;               ///< of Table 1, rising
  std::vector<const View*> sweep_views;  ///< of the sweeps: fewer than all
  std::vector<Contender> contenders;
  Machine machine;  ///< of every table but Fig. 7
  std::uint32_t width = 1024, height = 1024;

  [[nodiscard]] const std::vector<View>& views() const { return found.views; }
};

/// Adds a section's tables, figures and words to the book once the plan has been executed.
using Writer = std::function<void(const Plan&, Book&)>;

inline constexpr std::uint32_t kPaperCores = 6;

/// Source of the cycles per unit of work (sim_platform/gridiron/sim/work_costs.h).
inline constexpr const char* kCostTableWords =
    "The cycles per unit of work are counted on the kernel's own code and scheduled by published pipeline rules "
    "(tools/calibrate/README.md).";

/// The same of the cached BVH (sim_platform/gridiron/bvh/bvh_costs.h).
inline constexpr const char* kBvhCostWords =
    "What only the hierarchy does (caches, boxes, stack, ring) is counted on its own code by the same tool; rays, "
    "triangle tests, hits and shading are the grid's code at the grid's prices. Of nine windows of each view of "
    "the scans, prices differ from direct counts by at most 2.2 %, of one window by up to 11.5 %. It was written for "
    "vectors and tuned under counted costs, as the grid was.";

[[nodiscard]] Writer plan_table1(Plan& plan, const Stage& stage);
[[nodiscard]] Writer plan_table2(Plan& plan, const Stage& stage);
[[nodiscard]] Writer plan_table3(Plan& plan, const Stage& stage);
[[nodiscard]] Writer plan_figure5(Plan& plan, const Stage& stage);
[[nodiscard]] Writer plan_figure6(Plan& plan, const Stage& stage);
[[nodiscard]] Writer plan_table4(Plan& plan, const Stage& stage);
[[nodiscard]] Writer plan_grid(Plan& plan, const Stage& stage);
[[nodiscard]] Writer plan_best(Plan& plan, const Stage& stage);
[[nodiscard]] Writer plan_figure7(Plan& plan, const Stage& stage);

/// Fig. 7 (b): the same kernel, and Embree, on this host's processor. One frame after another, without other work of
/// ours.
/// @param threads  host threads of the grid's second row. Errors: Failure.
void write_host_figures(const Stage& stage, std::uint32_t threads, Book& book);

[[nodiscard]] Writer plan_grid_sweeps(Plan& plan, const Stage& stage);      ///< lambda, macrocell width
[[nodiscard]] Writer plan_packet_sweep(Plan& plan, const Stage& stage);     ///< packets, subpackets
[[nodiscard]] Writer plan_prefetch_sweeps(Plan& plan, const Stage& stage);  ///< cell blocks, triangle buffers
[[nodiscard]] Writer plan_machine_sweeps(Plan& plan, const Stage& stage);   ///< latency, bandwidth
[[nodiscard]] Writer plan_tile_sweep(Plan& plan, const Stage& stage);       ///< tiles of 8 to 64 pixels
[[nodiscard]] Writer plan_store_sweep(Plan& plan, const Stage& stage);      ///< 64 to 512 KB, the maps
[[nodiscard]] Writer plan_bvh_sweep(Plan& plan, const Stage& stage);        ///< settings of the hierarchy

/// Sentences about the parameters of configuration grid: their costs and gains against the other values of their
/// sweeps.
using ChoiceWords = std::function<std::string(const Plan&)>;
[[nodiscard]] ChoiceWords plan_choice_words(Plan& plan, const Stage& stage);

/// @returns the value for a sweep's sentences: "16", or "16, the last of its sweep", because larger values are unknown.
/// @param values  the sweep's, rising, not empty.
[[nodiscard]] std::string swept_value_words(double value, std::span<const double> values);

/// @returns the machine with another latency, under the key that all sections use.
[[nodiscard]] Machine machine_with_latency(const Machine& machine, double cycles);

/// @returns the contender with that key. Precondition: it exists.
[[nodiscard]] const Contender& contender_named(const Stage& stage, std::string_view key);

/// Least and greatest of some figures, as words: "1.2 to 3.4"; one figure if both print alike; "none".
class Range {
 public:
  Range() = default;
  explicit Range(std::span<const double> values);
  void add(double value);  ///< ignores infinity and NaN
  [[nodiscard]] std::string text(int decimals) const;
  [[nodiscard]] std::string percent(int decimals) const;  ///< the same with a percent sign behind a figure
  [[nodiscard]] bool empty() const { return empty_; }
  [[nodiscard]] double least() const { return least_; }
  [[nodiscard]] double greatest() const { return greatest_; }

 private:
  bool empty_ = true;
  double least_ = 0, greatest_ = 0;
};

/// @returns part / whole; NaN unless whole is above 0.
[[nodiscard]] double ratio_of(double part, double whole);
/// @returns 100 * (1 - part / whole); NaN unless whole is above 0.
[[nodiscard]] double percent_less(double part, double whole);
/// @returns 100 * (changed / base - 1); NaN unless base is above 0.
[[nodiscard]] double percent_more(double changed, double base);

}  // namespace gridiron::experiment
