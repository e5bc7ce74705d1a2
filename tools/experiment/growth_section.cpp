// Tables 1 and 2: how work grows with the number of triangles, and the scenes. SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "experiment/paper_values.h"
#include "experiment/sections.h"
#include "report/svg_plot.h"

namespace gridiron::experiment {
using namespace plot;
namespace {

// One quantity of Table 1: its name, and the paper's statement.
struct Quantity {
  const char* title;
  std::string_view (*paper)(const Contender&);
  double (*value)(const RunResult&);
};

std::string_view not_in_paper(const Contender&) {
  return "";
}

const Quantity kQuantities[] = {
    {"build steps", [](const Contender& contender) { return contender.paper_growth.build; },
     [](const RunResult& run) { return static_cast<double>(run.facts.build_steps()); }},
    {"build cycles of the general core", not_in_paper,
     [](const RunResult& run) { return static_cast<double>(run.build_cycles); }},
    {"traversal steps", [](const Contender& contender) { return contender.paper_growth.traversal; },
     [](const RunResult& run) { return static_cast<double>(run.facts.traversal_steps); }},
    {"intersection tests", not_in_paper,
     [](const RunResult& run) { return static_cast<double>(run.facts.intersection_tests); }},
    {"frame cycles", not_in_paper, [](const RunResult& run) { return run.timing.frame_cycles; }},
    {"bytes fetched", not_in_paper, [](const RunResult& run) { return static_cast<double>(run.bytes_in()); }},
    {"bytes of main memory", not_in_paper,
     [](const RunResult& run) { return static_cast<double>(run.facts.scene_bytes); }},
};
constexpr std::size_t kBuildSteps = 0, kTraversalSteps = 2;

// The exponent that a fit over the same triangle counts gives for a function in the paper's notation; NaN for functions
// outside of Table 1.
double exponent_of(std::string_view growth, const std::vector<Point2>& points) {
  if (growth.empty()) return std::nan("");
  std::vector<Point2> values;
  for (const Point2& point : points) {
    const double n = point.x;
    double value = std::nan("");
    if (growth == kPaperGridGrowth.build) value = n;
    if (growth == kPaperGridGrowth.traversal) value = std::cbrt(n);
    if (growth == kPaperBvhGrowth.build) value = n * std::log(n);
    if (growth == kPaperBvhGrowth.traversal) value = std::log(n);
    values.push_back({n, value});
  }
  return fit_power(values).exponent;
}

// "8x8 rays": the packets of a configuration.
std::string packet_words(std::string_view configuration) {
  const std::string width = std::to_string(grid_variant(configuration).configuration.packet_width);
  return width + "x" + width + " rays";
}

// Systems with the same counts share a curve.
void add_curve(LineChart& chart, const std::string& title, const std::vector<Point2>& points) {
  for (Series& series : chart.series) {
    if (!std::ranges::equal(series.points, points, [](Point2 a, Point2 b) { return a.x == b.x && a.y == b.y; }))
      continue;
    series.name += "; " + title;
    return;
  }
  chart.series.push_back({title, points, false});
}

}  // namespace

Writer plan_table1(Plan& plan, const Stage& stage) {
  std::vector<const Contender*> contenders;
  std::vector<std::vector<Plan::RunId>> runs;  // [contender][knot]
  for (const Contender& contender : stage.contenders) {
    contenders.push_back(&contender);
    auto& row = runs.emplace_back();
    for (const View& knot : stage.knots) {
      row.push_back(plan.add(knot, contender.system, Shading::kNone, stage.machine, kPaperCores));
    }
  }
  return [&stage, contenders, runs](const Plan& done, Book& book) {
    Table growth =
        make_table("table1_growth", "system", "triangles", "vertices", "cells", "references", "build_steps",
                   Column("build_cycles", "build cycles of the general core", 0), "traversal_steps",
                   "intersection_tests", Column("frame_cycles", "frame cycles", 0),
                   Column("fetched_bytes", "bytes fetched"), Column("scene_bytes", "bytes of main memory"), "note");
    Table exponents = make_table("table1_exponents", "system", "quantity", Column("exponent", "fitted exponent", 3),
                                 Column("r_squared", "r squared", 4), Column("paper_printed", "paper [P]"),
                                 Column("paper_exponent_derived", "fitted alike, paper [D]", 3));
    LineChart build{.title = "Build: cycles of the general core",
                    .x_title = "triangles",
                    .y_title = "cycles",
                    .log_x = true,
                    .log_y = true};
    LineChart walk{.title = "Traversal: steps of a frame",
                   .x_title = "triangles",
                   .y_title = "steps",
                   .log_x = true,
                   .log_y = true};
    Range grid_build, grid_walk, bvh_build, bvh_walk, tree_build, tree_walk;
    for (std::size_t c = 0; c < contenders.size(); ++c) {
      const Contender& contender = *contenders[c];
      std::vector<std::vector<Point2>> points(std::size(kQuantities));
      for (std::size_t k = 0; k < stage.knots.size(); ++k) {
        const RunResult& run = done.result(runs[c][k]);
        const std::uint64_t count = stage.knots[k].mesh().triangles.size();
        std::vector<Cell> row = {contender.key, count, stage.knots[k].mesh().vertices.size()};
        if (run.failed()) {
          row.resize(growth.columns.size() - 1);
          row.emplace_back(run.failure);
          growth.add(std::move(row));
          continue;
        }
        if (run.facts.grid) {
          const GridRecord& grid = *run.facts.grid;
          row.emplace_back(std::uint64_t{grid.cell_count[0]} * grid.cell_count[1] * grid.cell_count[2]);
          row.emplace_back(grid.reference_count);
        } else {
          row.resize(5);
        }
        row.insert(row.end(),
                   {run.facts.build_steps(), run.build_cycles, run.facts.traversal_steps, run.facts.intersection_tests,
                    run.timing.frame_cycles, run.bytes_in(), run.facts.scene_bytes, Cell{}});
        growth.add(std::move(row));
        for (std::size_t q = 0; q < std::size(kQuantities); ++q) {
          points[q].push_back({static_cast<double>(count), kQuantities[q].value(run)});
        }
      }
      for (std::size_t q = 0; q < std::size(kQuantities); ++q) {
        const PowerFit fit = fit_power(points[q]);
        const std::string_view paper = kQuantities[q].paper(contender);
        exponents.add({contender.key, kQuantities[q].title, fit.exponent, fit.r_squared, std::string(paper),
                       exponent_of(paper, points[q])});
      }
      const bool is_tree = contender.key == "best";
      (contender.is_grid ? grid_build : is_tree ? tree_build : bvh_build).add(fit_power(points[kBuildSteps]).exponent);
      (contender.is_grid ? grid_walk : is_tree ? tree_walk : bvh_walk).add(fit_power(points[kTraversalSteps]).exponent);
      add_curve(build, contender.title, points[kBuildSteps + 1]);
      add_curve(walk, contender.title, points[kTraversalSteps]);
    }

    book.section("table1", "Table 1: work against the number of triangles");
    book.paragraph(
        "The paper states growth without measuring it: O(n) to build a grid and O(n^(1/3)) to traverse it, O(n log n) "
        "and O(log n) for a hierarchy [P]. Here all four are counted on one torus knot, made at several sizes and seen "
        "by the same camera. Build steps are the counted steps that the machine's general core is priced by (a vertex "
        "checked, a row of cells met, a reference sorted, a triangle entered into a bin, ...); their cycles weigh "
        "them. A traversal step of the grid is one macro slice, macrocell, slice or cell, one of the hierarchy a node "
        "or a leaf; both are summed over all packets of a frame. Where the paper names a function, the last column is "
        "the exponent that a fit of that function over the same triangle counts gives [D]. Of the tree of "
        "configuration best the paper says nothing.");
    book.paragraph("Building the grid grows with exponent " + grid_build.text(2) + ", building the hierarchy with " +
                   bvh_build.text(2) + ", building the tree with " + tree_build.text(2) +
                   "; traversing the grid with " + grid_walk.text(2) + ", traversing the hierarchy with " +
                   bvh_walk.text(2) + ", traversing the tree with " + tree_walk.text(2) +
                   ". The printed growth is that of one ray. A packet also visits what its other rays need, the more "
                   "the narrower cells and boxes become beside it; how much that is shows in two configurations, "
                   "reference with packets of " +
                   packet_words("reference") + " and grid with " + packet_words("grid") +
                   ". Skipping what is empty and stopping behind the last hit take steps away. The fits are "
                   "least squares of the logarithms; they hold for this mesh and this range only, and r squared says "
                   "how far from a power law the counts are.");
    book.table(exponents, "Fitted exponents: quantity ~ n^exponent.");
    book.figure("table1_build", line_chart_svg(build),
                "Cycles of the machine's general core to build the structure. The projection test needs another form "
                "of the grid's triangles.");
    book.figure("table1_traversal", line_chart_svg(walk),
                "Steps through the structure for one frame: cells and slices of the grid, nodes and leaves of the "
                "hierarchy. Steps of different structures cost differently.");
    book.table(growth, "The counts behind the fit.");
  };
}

Writer plan_table2(Plan& plan, const Stage& stage) {
  std::vector<Plan::RunId> runs;
  for (const View& view : stage.views()) {
    runs.push_back(plan.add(view, stage.contenders.front().system, Shading::kNone, stage.machine, kPaperCores));
  }
  return [&stage, runs](const Plan& done, Book& book) {
    Table table = make_table(
        "table2_scenes", "view", "vertices", Column("paper_vertices_printed", "paper [P]"), "triangles",
        Column("paper_triangles_printed", "paper [P]"), Column("dropped_triangles", "of zero area"), "cells_x",
        Column("cells_y", "y"), Column("cells_z", "z"), Column("references_per_triangle", "references per triangle", 2),
        Column("macrocells_used_percent", "macrocells used, %", 1), Column("scene_mb", "main memory, MB", 1));
    for (std::size_t v = 0; v < runs.size(); ++v) {
      const View& view = stage.views()[v];
      const RunResult& run = done.result(runs[v]);
      const PaperView* paper = find_paper_view(view.key);
      std::vector<Cell> row = {view.title, view.mesh().vertices.size(),
                               paper != nullptr ? Cell{paper->vertices} : Cell{}, view.mesh().triangles.size(),
                               paper != nullptr ? Cell{paper->triangles} : Cell{}};
      if (run.failed() || !run.facts.grid) {
        row.resize(table.columns.size());
        table.add(std::move(row));
        continue;
      }
      const GridRecord& grid = *run.facts.grid;
      const double macro_cells =
          static_cast<double>(grid.macro_cell_count[0]) * grid.macro_cell_count[1] * grid.macro_cell_count[2];
      const double kept = static_cast<double>(view.mesh().triangles.size()) - run.facts.dropped_triangles;
      row.insert(row.end(), {run.facts.dropped_triangles, grid.cell_count[0], grid.cell_count[1], grid.cell_count[2],
                             grid.reference_count / kept, 100 * (grid.cell_block_count - 1) / macro_cells,
                             static_cast<double>(run.facts.scene_bytes) / (1 << 20)});
      table.add(std::move(row));
    }
    book.section("table2", "Table 2: the scenes");
    for (const std::string& sentence : stage.found.missing) book.paragraph(sentence);
    if (stage.found.generated) {
      book.paragraph(
          "No scan was found, so every table below is about a generated teapot and torus knot, and no figure of the "
          "paper is next to ours. tools/fetch_scenes gets the scans.");
    }
    book.paragraph(
        "Bunny and Horse are the models that the paper names. The armadillo is a stand-in wherever it appears: a scan "
        "of half the resolution whose edges were split until its counts were those of the paper. The conference room "
        "is the public version with more triangles than the paper's, many of them of zero area, which are dropped. The "
        "paper does not say from where it looks at its scenes; the views are ours, so single figures may differ from "
        "the paper's for that reason alone.");
    book.table(
        table,
        "Scenes and the grid of the reference configuration. Of the paper's counts only the bunny's are whole in its "
        "text: the first digits of the horse and the last of the armadillo are there, completed from the models "
        "that it names, and of the conference room, one model in two columns, the first digits of one column "
        "and the last of the other.");
  };
}

}  // namespace gridiron::experiment
