// The paper experiment. SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "base/ranks.h"
#include "experiment/experiments.h"
#include "experiment/plan.h"
#include "experiment/sections.h"
#include "files/interrupt.h"
#include "report/svg_plot.h"

namespace gridiron::experiment {
using namespace plot;
namespace {

Stage make_stage(const ExperimentSettings& settings) {
  Stage stage;
  stage.found = find_views(settings.scenes);
  for (const std::uint32_t count : growth_counts(settings.largest_knot)) {
    tool::stop_if_interrupted();
    stage.knots.push_back(make_knot_view(count));
  }
  stage.contenders = make_contenders();
  stage.machine = built_in_machine("cell-ps3");
  stage.width = settings.width;
  stage.height = settings.height;
  return stage;
}

// Bunny and the first view of the conference room; the first and the last of other views.
std::vector<const View*> choose_sweep_views(const std::vector<View>& views) {
  std::vector<const View*> chosen;
  for (const View& view : views) {
    if (view.key == "bunny" || view.key == "conference_1") chosen.push_back(&view);
  }
  if (chosen.empty()) chosen.push_back(&views.front());
  if (chosen.size() == 1 && chosen.front() != &views.back()) chosen.push_back(&views.back());
  return chosen;
}

}  // namespace

const Contender& contender_named(const Stage& stage, std::string_view key) {
  return *std::ranges::find(stage.contenders, key, &Contender::key);
}

Range::Range(std::span<const double> values) {
  for (const double value : values) add(value);
}

void Range::add(double value) {
  if (!std::isfinite(value)) return;
  least_ = empty_ ? value : std::min(least_, value);
  greatest_ = empty_ ? value : std::max(greatest_, value);
  empty_ = false;
}

std::string Range::text(int decimals) const {
  if (empty_) return "none";
  const std::string low = fixed_text(least_, decimals), high = fixed_text(greatest_, decimals);
  return low == high ? low : low + " to " + high;
}

std::string Range::percent(int decimals) const {
  return empty_ ? "none" : text(decimals) + " %";
}

double ratio_of(double part, double whole) {
  return whole > 0 ? part / whole : std::nan("");
}

double percent_less(double part, double whole) {
  return whole > 0 ? 100 * (1 - part / whole) : std::nan("");
}

double percent_more(double changed, double base) {
  return base > 0 ? 100 * (changed / base - 1) : std::nan("");
}

std::vector<std::string> paper_file_names() {
  // clang-format off
  std::vector<std::string> names = {
      "best_against_grid.csv", "grid_against_reference.csv", "fig5_speedup.csv", "fig6_breakdown.csv",
      "fig7_build_steps.csv",
      "fig7_caches.csv", "fig7_cell_2006.svg", "fig7_cycles.csv", "fig7_frames.csv", "fig7_with_build.csv",
      "fig7_with_build.svg", "host_fig7.csv", "index.html", "local_store_fit.csv", "local_store_layouts.csv",
      "local_store_map_best.csv", "local_store_map_grid.csv", "local_store_map_bvh.csv",
      "local_store_map_reference.csv", "sweep_bandwidth.csv",
      "sweep_lambda.csv", "sweep_lambda.svg", "sweep_latency.csv", "sweep_local_store.csv",
      "sweep_local_store_best.svg", "sweep_local_store_grid.svg", "sweep_local_store_reference.svg",
      "sweep_macro_depth.csv", "sweep_macro_depth.svg", "sweep_macro_width.csv", "sweep_macro_width.svg",
      "sweep_packet.csv", "sweep_bvh.csv",
      "sweep_tile_width.csv", "sweep_tile_width_best.svg", "sweep_tile_width_grid.svg",
      "sweep_tile_width_reference.svg", "sweep_triangle_depth.csv", "sweep_triangle_depth.svg",
      "table1_build.svg", "table1_exponents.csv",
      "table1_growth.csv", "table1_traversal.svg", "table2_scenes.csv", "table3_fps.csv", "table3_shading_cost.csv",
      "table4_hiding.csv", "table4_levers.csv", "table4_wait_share.csv"};
  // clang-format on
  for (const Contender& contender : make_contenders()) {
    for (const char* kind : {"", "_efficiency"}) names.push_back("fig5_" + contender.key + kind + ".svg");
    for (const char* cores : {"_1_core", "_6_cores"}) names.push_back("fig6_" + contender.key + cores + ".svg");
  }
  for (const std::string& view : known_view_keys()) {
    for (const char* sweep : {"sweep_bandwidth_", "sweep_latency_"}) names.push_back(sweep + view + ".svg");
  }
  return names;
}

ExperimentResult run_paper_experiment(const ExperimentSettings& settings, const ProgressCall& progress) {
  Stage stage = make_stage(settings);
  stage.sweep_views = choose_sweep_views(stage.found.views);

  // 1. Plan the runs.
  Plan plan(settings.width, settings.height);
  std::vector<Writer> before_host, after_host;
  for (const auto section : {plan_table1, plan_table2, plan_table3, plan_figure5, plan_figure6, plan_table4, plan_grid,
                             plan_best, plan_figure7}) {
    before_host.push_back(section(plan, stage));
  }
  for (const auto section : {plan_grid_sweeps, plan_packet_sweep, plan_tile_sweep, plan_prefetch_sweeps,
                             plan_machine_sweeps, plan_store_sweep, plan_bvh_sweep}) {
    after_host.push_back(section(plan, stage));
  }

  // 2. Render and replay.
  plan.execute(settings.threads, progress);
  if (!tool::ranks().is_first()) return {};

  // 3. Write the tables, plots and sentences.
  const std::string size = std::to_string(settings.width) + "x" + std::to_string(settings.height);
  Book book(
      "Grid ray tracing from small local stores: the evaluation, run again",
      "Every figure below comes from one run of `gridiron experiment paper`: pictures of " + size +
          " rendered by the kernel's real code on the simulated chip " + stage.machine.key +
          ", their recorded transfers and work replayed on the machine's clock. " + kCostTableWords +
          " Nothing is fitted to the paper's figures. [P] marks what the paper prints, as far as its text shows it: "
          "the "
          "copy that these figures were taken from has lost digits of Table 2, all of Table 3 and the plots of Figs. 5 "
          "to 7. [D] marks what follows from what it prints. MB are 2^20 bytes, GB/s 10^9 bytes a second; an "
          "intersection test is one of a SIMD group of four rays with a triangle. Paper: Cho, Kim, Han, Enhancing "
          "Visual Rendering on Multicore Accelerators "
          "with Explicitly Managed Memories, Journal of Information Science and Engineering 28 (2012), 895-909.");
  for (const Writer& write : before_host) write(plan, book);
  write_host_figures(stage, settings.threads, book);
  for (const Writer& write : after_host) write(plan, book);
  return {book.finish(), plan.rendered_count(), plan.run_count(), stage.found.missing};
}

}  // namespace gridiron::experiment
