// Table 3 and Fig. 5: frames a second. SPDX-License-Identifier: Apache-2.0
#include "experiment/paper_values.h"
#include "experiment/sections.h"
#include "report/svg_plot.h"

namespace gridiron::experiment {
using namespace plot;
namespace {

std::string shading_name(Shading shading) {
  return shading == Shading::kSimple ? "simple" : "none";
}

constexpr Shading kShadings[] = {Shading::kNone, Shading::kSimple};
constexpr std::uint32_t kPaperCoreCounts[] = {1, kPaperCores};
constexpr std::uint32_t kMostCores = 16;

}  // namespace

Writer plan_table3(Plan& plan, const Stage& stage) {
  struct Row {
    const View* view;
    Shading shading;
    std::uint32_t cores;
    std::vector<Plan::RunId> runs;
  };
  std::vector<Row> rows;
  for (const Shading shading : kShadings) {
    for (const std::uint32_t cores : kPaperCoreCounts) {
      for (const View& view : stage.views()) {
        Row& row = rows.emplace_back(Row{&view, shading, cores, {}});
        for (const Contender& contender : stage.contenders) {
          row.runs.push_back(plan.add(view, contender.system, shading, stage.machine, cores));
        }
      }
    }
  }
  return [&stage, rows](const Plan& done, Book& book) {
    Table fps = make_table("table3_fps", "shading", "cores", "view");
    Table cost = make_table("table3_shading_cost", "view", "cores");
    for (const Contender& contender : stage.contenders) {
      fps.columns.push_back({contender.key + "_fps", contender.title, 2});
      cost.columns.push_back({contender.key + "_percent", contender.title + ", %", 1});
    }
    cost.columns.push_back({"paper_printed", "paper [P]"});
    // Costs of the paper's systems and of the others; cycles a pixel of the former.
    Range paper_like_costs, other_costs, pixel_cycles, paper_cycles;
    const double pixels = static_cast<double>(stage.width) * stage.height;
    const auto core_cycles_a_pixel = [&](const RunResult& run) {
      return run.timing.frame_cycles * static_cast<double>(run.timing.cores.size()) / pixels;
    };
    for (const Row& row : rows) {
      std::vector<Cell> cells = {shading_name(row.shading), row.cores, row.view->title};
      for (const Plan::RunId run : row.runs) cells.emplace_back(done.result(run).fps());
      fps.add(std::move(cells));
      if (row.shading != Shading::kSimple) continue;
      std::vector<Cell> drops = {row.view->title, row.cores};
      for (const Row& bare : rows) {
        if (bare.shading != Shading::kNone || bare.view != row.view || bare.cores != row.cores) continue;
        for (std::size_t c = 0; c < row.runs.size(); ++c) {
          const double drop = percent_less(done.result(row.runs[c]).fps(), done.result(bare.runs[c]).fps());
          drops.emplace_back(drop);
          const std::string& key = stage.contenders[c].key;
          const bool is_of_paper = key == "reference" || key == "projection";
          (is_of_paper ? paper_like_costs : other_costs).add(drop);
          if (!is_of_paper) continue;
          const double bare_cycles = core_cycles_a_pixel(done.result(bare.runs[c]));
          pixel_cycles.add(core_cycles_a_pixel(done.result(row.runs[c])) - bare_cycles);
          // A cost of 10 % of the fps makes a frame 1 / 0.9 times as long, one of 20 % 1 / 0.8 times.
          if (c == 0) paper_cycles.add(bare_cycles * (1 / 0.9 - 1));
          if (c == 0) paper_cycles.add(bare_cycles * (1 / 0.8 - 1));
        }
      }
      drops.emplace_back(std::string(kPaperShadingCost));
      cost.add(std::move(drops));
    }
    book.section("table3", "Table 3: frames a second");
    book.paragraph(
        "Frames a second on " + std::string(stage.machine.profile.name) +
        ", one core and six. There is no column of the paper's fps, for the copy of its text lacks the figures of "
        "Table 3; it says that simple shading costs 10-20 % [P]. \"Projection test\" is the "
        "reference configuration with the paper's own intersection test (precomputed projection, single precision, may "
        "leak); the others use the exact default.");
    book.table(fps, "Frames a second.");
    std::string words = "Here simple shading costs the reference, with either test, " + paper_like_costs.percent(1) +
                        " of its fps, and the other systems, whose frames are shorter, " + other_costs.percent(1) +
                        ". ";
    if (paper_like_costs.greatest() < 10) {
      words += "For the reference that is less than the paper's 10-20 %. In cycles it is " + pixel_cycles.text(1) +
               " a pixel; 10 to 20 % of the reference's fps would be " + paper_cycles.text(0) +
               ". Ours is a facing ratio: the cosine comes from the intersection test, what is left is a length and a "
               "division for each ray. The paper does not say what its simple shading computes.";
    }
    book.paragraph(words);
    book.table(cost, "Share of the fps that simple shading costs.");
  };
}

Writer plan_figure5(Plan& plan, const Stage& stage) {
  std::vector<std::vector<std::vector<Plan::RunId>>> runs;  // [contender][view][cores - 1]
  for (const Contender& contender : stage.contenders) {
    auto& of_contender = runs.emplace_back();
    for (const View& view : stage.views()) {
      auto& of_view = of_contender.emplace_back();
      for (std::uint32_t cores = 1; cores <= kMostCores; ++cores) {
        of_view.push_back(plan.add(view, contender.system, Shading::kNone, stage.machine, cores));
      }
    }
  }
  return [&stage, runs](const Plan& done, Book& book) {
    Table table = make_table("fig5_speedup", "system", "view", "cores", "fps", Column("projected_fps", "projected"),
                             Column("speedup", "speed-up"), Column("wait_percent", "wait, %"));
    Table at_six = make_table("", "view");
    for (const Contender& contender : stage.contenders) {
      at_six.columns.push_back({"", contender.title + ", 6 cores", 2});
      at_six.columns.push_back({"", "16 cores", 2});
    }
    Range speedups;
    std::vector<LineChart> charts, efficiencies;
    for (std::size_t c = 0; c < stage.contenders.size(); ++c) {
      LineChart& chart = charts.emplace_back();
      chart.title = "Speed-up, " + stage.contenders[c].title;
      chart.x_title = "cores";
      chart.y_title = "fps over fps of one core";
      chart.x_ticks = {1, 2, 4, 6, 8, 10, 12, 14, 16};
      Series linear{"linear projection", {}, true};
      for (std::uint32_t cores = 1; cores <= kMostCores; ++cores) {
        linear.points.push_back({static_cast<double>(cores), static_cast<double>(cores)});
      }
      chart.series.push_back(std::move(linear));
      LineChart& efficiency = efficiencies.emplace_back();
      efficiency.title = "Speed-up a core, " + stage.contenders[c].title;
      efficiency.x_title = "cores";
      efficiency.y_title = "speed-up / cores, %";
      efficiency.x_ticks = chart.x_ticks;
      efficiency.zoom_y = true;
      efficiency.series.push_back({"linear projection", {{1, 100}, {kMostCores, 100}}, true});
      for (std::size_t v = 0; v < stage.views().size(); ++v) {
        Series series{stage.views()[v].title, {}, false}, shares = series;
        const double one = done.result(runs[c][v][0]).fps();
        for (std::uint32_t cores = 1; cores <= kMostCores; ++cores) {
          const RunResult& run = done.result(runs[c][v][cores - 1]);
          const double speedup = one > 0 ? run.fps() / one : 0;
          table.add({stage.contenders[c].key, stage.views()[v].title, cores, run.fps(), one * cores, speedup,
                     run.wait_percent()});
          series.points.push_back({static_cast<double>(cores), speedup});
          shares.points.push_back({static_cast<double>(cores), 100 * speedup / cores});
          if (cores == kPaperCores) speedups.add(speedup);
        }
        chart.series.push_back(std::move(series));
        efficiency.series.push_back(std::move(shares));
      }
    }
    for (std::size_t v = 0; v < stage.views().size(); ++v) {
      std::vector<Cell> row = {stage.views()[v].title};
      for (std::size_t c = 0; c < stage.contenders.size(); ++c) {
        const double one = done.result(runs[c][v][0]).fps();
        for (const std::uint32_t cores : {kPaperCores, kMostCores}) {
          row.emplace_back(one > 0 ? done.result(runs[c][v][cores - 1]).fps() / one : 0.0);
        }
      }
      at_six.add(std::move(row));
    }
    book.section("fig5", "Fig. 5: scaling with cores");
    book.paragraph(
        "1 to 16 cores of the same machine; the paper stops at six. Frames of grid and tree are recorded once and "
        "replayed; "
        "the hierarchy, whose caches outlive a tile, is rendered anew for each number of cores. The "
        "dashed line projects one core's fps, as the paper's dotted line does. On six cores the speed-up is " +
        speedups.text(2) +
        "; the paper reads \"only slightly lower than the projected\" [P]. What is missing to the projection is the "
        "end of the frame, when some cores have no tile left, and the memory that all share.");
    book.shown_table(at_six, "Speed-up over one core.");
    for (std::size_t c = 0; c < charts.size(); ++c) {
      book.figure("fig5_" + stage.contenders[c].key, line_chart_svg(charts[c]),
                  "Speed-up of " + stage.contenders[c].title + ", 1 to 16 cores, no shading.");
      book.figure("fig5_" + stage.contenders[c].key + "_efficiency", line_chart_svg(efficiencies[c]),
                  "The same over the number of cores: 100 % is the projection. The axis does not begin at 0.");
    }
    book.linked_table(table, "all core counts, with fps, projection and wait share.");
  };
}

}  // namespace gridiron::experiment
