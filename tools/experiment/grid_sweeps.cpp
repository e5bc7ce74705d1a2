// Sweeps of the grid traversal's parameters: lambda, macrocells, packets, prefetch.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <functional>
#include <numeric>

#include "experiment/sections.h"
#include "gridiron/device/store_facts.h"
#include "report/svg_plot.h"

namespace gridiron::experiment {
using namespace plot;
namespace {

const char* const kSweptConfigurations[] = {"reference", "grid"};

/// One frame of a sweep: a view, a configuration, and the parameter's value.
struct SweepStep {
  const View* view;
  std::string configuration;
  double value;
  Plan::RunId run;
};

bool is_same_curve(const SweepStep& a, const SweepStep& b) {
  return a.view == b.view && a.configuration == b.configuration;
}

// Plans each value for each swept view and configuration; `change` sets it in a variant.
template <class Change>
std::vector<SweepStep> plan_steps(Plan& plan, const Stage& stage, const std::vector<double>& values,
                                  const std::string& name, Change change) {
  std::vector<SweepStep> steps;
  for (const View* view : stage.sweep_views) {
    for (const char* configuration : kSweptConfigurations) {
      for (const double value : values) {
        GridVariant variant = grid_variant(configuration);
        change(variant, value);
        variant.key += "/" + name + "=" + number_text(value);
        const auto system = std::make_shared<GridSystem>(std::move(variant));
        steps.push_back(
            {view, configuration, value, plan.add(*view, system, Shading::kNone, stage.machine, kPaperCores)});
      }
    }
  }
  return steps;
}

Table step_table(const Plan& done, const std::vector<SweepStep>& steps, const std::string& name, Column parameter) {
  Table table =
      make_table(name, "view", "configuration", std::move(parameter), "fps", Column("wait_percent", "wait, %"),
                 Column("fetched_mb", "fetched, MB", 1), Column("scene_mb", "main memory, MB", 1), "references",
                 "traversal_steps", "intersection_tests", "note");
  for (const SweepStep& step : steps) {
    const RunResult& run = done.result(step.run);
    std::vector<Cell> row = {step.view->title, step.configuration, step.value};
    if (run.failed()) {
      row.resize(table.columns.size() - 1);
      row.emplace_back(run.failure);
    } else {
      constexpr double kMegabyte = 1 << 20;
      row.insert(row.end(), {run.fps(), run.wait_percent(), run.megabytes_in(),
                             static_cast<double>(run.facts.scene_bytes) / kMegabyte,
                             run.facts.grid ? Cell{run.facts.grid->reference_count} : Cell{}, run.facts.traversal_steps,
                             run.facts.intersection_tests, Cell{}});
    }
    table.add(std::move(row));
  }
  return table;
}

// One curve for each view and configuration.
template <class Value>
std::string step_chart(const Plan& done, const std::vector<SweepStep>& steps, LineChart chart, Value value) {
  for (const SweepStep& step : steps) {
    const std::string name = step.view->title + ", " + step.configuration;
    auto series = std::ranges::find(chart.series, name, &Series::name);
    if (series == chart.series.end()) series = chart.series.insert(series, {name, {}, false});
    const RunResult& run = done.result(step.run);
    if (!run.failed()) series->points.push_back({step.value, std::invoke(value, run)});
  }
  return line_chart_svg(chart);
}

// "3 (Bunny, reference), ...": the value with the most frames a second on each curve; marked at the ends of its range.
std::string best_values(const Plan& done, const std::vector<SweepStep>& steps) {
  std::vector<const SweepStep*> best;
  for (const SweepStep& step : steps) {
    const auto same =
        std::ranges::find_if(best, [&step](const SweepStep* other) { return is_same_curve(*other, step); });
    if (same == best.end()) {
      best.push_back(&step);
    } else if (!(done.result((*same)->run).fps() >= done.result(step.run).fps())) {  // also where that one failed
      *same = &step;
    }
  }
  std::string text;
  for (const SweepStep* step : best) {
    std::vector<double> values;
    for (const SweepStep& other : steps) {
      if (is_same_curve(other, *step)) values.push_back(other.value);
    }
    text += (text.empty() ? "" : ", ") + swept_value_words(step->value, values) + " (" + step->view->title + ", " +
            step->configuration + ")";
  }
  return text;
}

// The frames, in percent, that a configuration's own value loses against the fastest one, over the views. Floats are
// compared after rounding to float.
Range lost_frames(const Plan& done, const std::vector<SweepStep>& steps, const std::string& configuration, double own) {
  Range lost;
  for (const SweepStep& chosen : steps) {
    if (chosen.configuration != configuration || static_cast<float>(chosen.value) != static_cast<float>(own)) continue;
    double most = 0;
    for (const SweepStep& other : steps) {
      const RunResult& run = done.result(other.run);
      if (is_same_curve(other, chosen) && !run.failed()) most = std::max(most, run.fps());
    }
    lost.add(percent_less(done.result(chosen.run).fps(), most));
  }
  return lost;
}

// Waiting, in percent of core cycles, of a configuration with a value, over the views.
Range waits_at(const Plan& done, const std::vector<SweepStep>& steps, const std::string& configuration, double value) {
  Range waits;
  for (const SweepStep& step : steps) {
    if (step.configuration == configuration && step.value == value) waits.add(done.result(step.run).wait_percent());
  }
  return waits;
}

// "reference 5.5 to 30.1 %, grid 0.5 to 3.3 %": the extra bytes that the last value fetches over the first.
std::string fetched_more(const Plan& done, const std::vector<SweepStep>& steps) {
  std::string text;
  for (const char* configuration : kSweptConfigurations) {
    Range more;
    for (const SweepStep& first : steps) {
      if (first.configuration != configuration || first.value != steps.front().value) continue;
      for (const SweepStep& last : steps) {
        if (!is_same_curve(last, first) || last.value != steps.back().value) continue;
        more.add(percent_more(static_cast<double>(done.result(last.run).bytes_in()),
                              static_cast<double>(done.result(first.run).bytes_in())));
      }
    }
    text += (text.empty() ? "" : ", ") + std::string(configuration) + " " + more.percent(1);
  }
  return text;
}

std::vector<SweepStep> plan_lambdas(Plan& plan, const Stage& stage) {
  return plan_steps(
      plan, stage, {0.125, 0.25, 0.4, 0.7, 1, 2, 3, 4, 5, 6, 8, 16}, "lambda",
      [](GridVariant& variant, double value) { variant.configuration.lambda = static_cast<float>(value); });
}

std::vector<SweepStep> plan_widths(Plan& plan, const Stage& stage) {
  return plan_steps(plan, stage, {2, 3, 4, 5, 6, 7, 8}, "macro_width", [](GridVariant& variant, double value) {
    variant.configuration.macro_width = static_cast<std::uint32_t>(value);
  });
}

/// A ring of buffers whose depth is swept.
struct Ring {
  std::uint32_t tool::BufferDepths::*depth;
  const char *key, *noun;  ///< "macro_depth", "cell blocks"

  // 1 to the most that the usual store has room for.
  [[nodiscard]] std::vector<double> values() const {
    std::vector<double> depths(tool::usual_store_facts(sim::StoreSize::k256KB, 32).most_depths.*depth);
    std::iota(depths.begin(), depths.end(), 1);
    return depths;
  }
};
constexpr Ring kMacroRing = {&tool::BufferDepths::macro, "macro_depth", "cell blocks"};
constexpr Ring kTriangleRing = {&tool::BufferDepths::triangle, "triangle_depth", "triangle buffers"};

std::vector<SweepStep> plan_depths(Plan& plan, const Stage& stage, const Ring& ring) {
  return plan_steps(plan, stage, ring.values(), ring.key, [&ring](GridVariant& variant, double value) {
    variant.configuration.depths.*ring.depth = static_cast<std::uint32_t>(value);
  });
}

}  // namespace

std::string swept_value_words(double value, std::span<const double> values) {
  return number_text(value) + (value == values.front()  ? ", the first of its sweep"
                               : value == values.back() ? ", the last of its sweep"
                                                        : "");
}

ChoiceWords plan_choice_words(Plan& plan, const Stage& stage) {
  const auto lambdas = plan_lambdas(plan, stage), widths = plan_widths(plan, stage);
  const auto macros = plan_depths(plan, stage, kMacroRing), triangles = plan_depths(plan, stage, kTriangleRing);
  return [lambdas, widths, macros, triangles](const Plan& done) {
    const tool::Configuration grid = grid_variant("grid").configuration;
    const auto depth_words = [&done](const std::vector<SweepStep>& steps, std::uint32_t own, const std::string& noun) {
      return lost_frames(done, steps, "grid", own).percent(2) + " for its " + std::to_string(own) + " " + noun +
             ", with which it waits " + waits_at(done, steps, "grid", own).percent(2) +
             " of its cycles instead of the " + waits_at(done, steps, "grid", 2).percent(2) + " with 2";
    };
    return "Its packets, tiles and grid are chosen by the sweeps below for frames a second, its depths for little "
           "waiting: against the fastest value of the sweep, on the views that are swept, "
           "it loses " +
           lost_frames(done, lambdas, "grid", static_cast<double>(grid.lambda)).percent(2) + " for its lambda, " +
           lost_frames(done, widths, "grid", grid.macro_width).percent(2) + " for its width of macrocells, " +
           depth_words(macros, grid.depths.macro, "cell blocks") + ", and " +
           depth_words(triangles, grid.depths.triangle, "triangle buffers") + ".";
  };
}

Writer plan_grid_sweeps(Plan& plan, const Stage& stage) {
  const auto lambdas = plan_lambdas(plan, stage), widths = plan_widths(plan, stage);
  return [lambdas, widths](const Plan& done, Book& book) {
    book.section("lambda", "Sweep: cells per triangle");
    book.paragraph(
        "Lambda of Eq. (1). Few large cells mean more intersection tests, many small ones more steps and more "
        "duplicated triangles in main memory. Most frames a second at " +
        best_values(done, lambdas) + "; the reference uses " +
        number_text(grid_variant("reference").configuration.lambda) + ", grid " +
        number_text(grid_variant("grid").configuration.lambda) + ".");
    book.figure("sweep_lambda",
                step_chart(done, lambdas,
                           {.title = "Cells per triangle",
                            .x_title = "lambda",
                            .y_title = "frames a second",
                            .log_x = true,
                            .x_ticks = {0.125, 0.25, 0.5, 1, 2, 4, 8, 16}},
                           &RunResult::fps),
                "Frames a second against lambda, 6 cores, no shading.");
    book.linked_table(step_table(done, lambdas, "sweep_lambda", {"lambda", "lambda", 3}),
                      "every step, with work, bytes and memory.");

    book.section("macro-width", "Sweep: macrocell size");
    book.paragraph(
        "Cells along the edge of a macrocell, which one DMA command brings: a line of 128 bytes at width 2, 1,792 at "
        "6, 4,096 at 8. Wide macrocells need fewer commands and carry more cells that are not needed. Most frames a "
        "second at " +
        best_values(done, widths) +
        "; the reference uses 6, grid 4. A view whose waiting jumps at width 2 has more macrocells than the local "
        "store holds entries for (131,072), so that parts of their table are fetched again.");
    book.figure("sweep_macro_width",
                step_chart(done, widths,
                           {.title = "Macrocell size",
                            .x_title = "cells along an edge",
                            .y_title = "frames a second",
                            .x_ticks = {2, 3, 4, 5, 6, 7, 8}},
                           &RunResult::fps),
                "Frames a second against the width of macrocells, 6 cores, no shading.");
    book.linked_table(step_table(done, widths, "sweep_macro_width", {"macro_width", "width", 0}),
                      "every step, with work, bytes and memory.");
  };
}

Writer plan_packet_sweep(Plan& plan, const Stage& stage) {
  struct Row {
    const View* view;
    std::uint32_t width;
    bool subpackets;
    Plan::RunId two, deep;
  };
  std::vector<Row> rows;
  for (const View* view : stage.sweep_views) {
    for (const bool subpackets : {false, true}) {
      for (const std::uint32_t width : {4u, 8u, 16u, 32u}) {
        GridVariant two = grid_variant(subpackets ? "grid" : "reference");
        two.configuration.packet_width = width;
        GridVariant deep = two;
        two.configuration.depths = grid_variant("reference").configuration.depths;
        deep.configuration.depths = grid_variant("grid").configuration.depths;
        two.key += "/double/packet=" + std::to_string(width);
        deep.key += "/deep/packet=" + std::to_string(width);
        const auto add = [&](GridVariant variant) {
          return plan.add(*view, std::make_shared<GridSystem>(std::move(variant)), Shading::kNone, stage.machine,
                          kPaperCores);
        };
        rows.push_back({view, width, subpackets, add(std::move(two)), add(std::move(deep))});
      }
    }
  }
  return [rows](const Plan& done, Book& book) {
    Table table =
        make_table("sweep_packet", "view", "culling", "packet_width", Column("double_fps", "double buffering, fps"),
                   Column("double_wait_percent", "wait, %"), Column("double_fetched_mb", "fetched, MB", 1),
                   Column("prefetch_fps", "prefetch of grid, fps"), Column("prefetch_wait_percent", "wait, %"),
                   Column("prefetch_fetched_mb", "fetched, MB", 1));
    for (const Row& row : rows) {
      const RunResult& two = done.result(row.two);
      const RunResult& deep = done.result(row.deep);
      table.add({row.view->title, row.subpackets ? "subpackets" : "corner rays", row.width, two.fps(),
                 two.wait_percent(), two.megabytes_in(), deep.fps(), deep.wait_percent(), deep.megabytes_in()});
    }
    book.section("packets", "Sweep: packet size");
    book.paragraph(
        "Rays along a packet's edge, with the two ways of culling a triangle: by the four corner rays of the packet "
        "(reference) or by subpackets of 4x4 rays (grid). Wide packets fetch and walk less often; without subpackets "
        "every triangle that touches the packet is then tested against all of its rays. Mailboxes have 64 slots for "
        "packets of 4x4 and 8x8, 256 for those of 16x16, 1,024 for those of 32x32.");
    book.table(table, "Packet size and culling, 6 cores, no shading. Double buffering: " + buffer_words("reference") +
                          "; prefetch of grid: " + buffer_words("grid") + ".");
  };
}

Writer plan_prefetch_sweeps(Plan& plan, const Stage& stage) {
  const auto macros = plan_depths(plan, stage, kMacroRing), triangles = plan_depths(plan, stage, kTriangleRing);
  return [macros, triangles](const Plan& done, Book& book) {
    book.section("prefetch", "Sweep: prefetch depth");
    book.paragraph(
        "Buffers in rotation at one level, the other levels as the configuration has them: 1 fetches, waits and uses, "
        "2 is double buffering. Deeper prefetch fetches more than is used, because rays may end before the prefetched "
        "cell. From the least to the most cell blocks the bytes grow by: " +
        fetched_more(done, macros) +
        "; from the least to the most triangle buffers by: " + fetched_more(done, triangles) +
        ". Most frames a second with this many cell blocks: " + best_values(done, macros) +
        "; with this many triangle buffers: " + best_values(done, triangles) + ".");
    const auto write = [&](const Ring& ring, const std::vector<SweepStep>& steps, const std::string& title,
                           const std::string& buffers) {
      const std::string name = std::string("sweep_") + ring.key, nouns = ring.noun;
      book.figure(name,
                  step_chart(done, steps,
                             {.title = "Prefetch of " + title,
                              .x_title = nouns + " in rotation",
                              .y_title = "waiting, % of core cycles",
                              .x_ticks = ring.values()},
                             &RunResult::wait_percent),
                  "Share of waiting against the number of " + buffers + ", 6 cores, no shading.");
      return std::pair(step_table(done, steps, name, {ring.key, nouns, 0}), nouns + ".");
    };
    const auto macro = write(kMacroRing, macros, "cell blocks", "cell-block buffers");
    const auto triangle = write(kTriangleRing, triangles, "triangles", "triangle buffers");
    for (const auto& [table, words] : {macro, triangle}) book.linked_table(table, words);
  };
}

}  // namespace gridiron::experiment
