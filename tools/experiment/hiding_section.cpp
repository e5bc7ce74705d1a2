// Fig. 6, Table 4, configurations grid and best: where the time goes, and the share of the waiting that is hidden.
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <map>
#include <memory>
#include <string>

#include "experiment/paper_values.h"
#include "experiment/sections.h"
#include "report/svg_plot.h"

namespace gridiron::experiment {
using namespace plot;
namespace {

constexpr std::uint32_t kPaperCoreCounts[] = {1, kPaperCores};

/// A view on some cores, without and with hiding.
struct Pair {
  const View* view;
  std::size_t cores_index;
  std::vector<Plan::RunId> unhidden, hidden;  ///< by contender

  [[nodiscard]] std::uint32_t cores() const { return kPaperCoreCounts[cores_index]; }
};

std::vector<Pair> plan_pairs(Plan& plan, const Stage& stage, Shading shading) {
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < std::size(kPaperCoreCounts); ++i) {
    for (const View& view : stage.views()) {
      Pair& pair = pairs.emplace_back(Pair{&view, i, {}, {}});
      for (const Contender& contender : stage.contenders) {
        pair.unhidden.push_back(plan.add(view, contender.unhidden, shading, stage.machine, kPaperCoreCounts[i]));
        pair.hidden.push_back(plan.add(view, contender.system, shading, stage.machine, kPaperCoreCounts[i]));
      }
    }
  }
  return pairs;
}

/// Milliseconds of a mean core.
struct Breakdown {
  double init = 0, compute = 0, wait[sim::kWaitLevelCount] = {}, idle = 0;

  explicit Breakdown(const RunResult& run) {
    const sim::FrameTiming& timing = run.timing;
    if (timing.frame_cycles <= 0 || timing.cores.empty()) return;
    const double ms_per_cycle = 1e3 * timing.seconds / timing.frame_cycles / static_cast<double>(timing.cores.size());
    for (const sim::CoreTiming& core : timing.cores) {
      init += core.init_cycles * ms_per_cycle;
      compute += core.compute_cycles * ms_per_cycle;
      idle += core.idle_cycles * ms_per_cycle;
      for (std::size_t level = 0; level < sim::kWaitLevelCount; ++level) {
        wait[level] += core.dma_wait_cycles[level] * ms_per_cycle;
      }
    }
  }
  [[nodiscard]] double wait_of(sim::WaitLevel level) const { return wait[static_cast<std::size_t>(level)]; }
  [[nodiscard]] double all_waits() const {
    double sum = 0;
    for (const double level : wait) sum += level;
    return sum;
  }
};

}  // namespace

Writer plan_figure6(Plan& plan, const Stage& stage) {
  const std::vector<Pair> pairs = plan_pairs(plan, stage, Shading::kNone);
  return [&stage, pairs](const Plan& done, Book& book) {
    Table table = make_table(
        "fig6_breakdown", "system", "cores", "view", "latency", Column("init_ms", "initialisation, ms"),
        Column("compute_ms", "computation, ms"), Column("wait_tile_ms", "wait: tiles, ms", 3),
        Column("wait_macrocell_ms", "cell blocks, ms", 3), Column("wait_triangle_ms", "triangles, ms", 3),
        Column("wait_setup_ms", "set-up, ms", 3), Column("idle_ms", "idle, ms", 3), Column("frame_ms", "frame, ms"));
    std::map<std::string, std::string> hidden_by;
    for (const Contender& contender : stage.contenders) {
      std::string& titles = hidden_by[contender.hiding];
      titles += (titles.empty() ? "" : "; ") + contender.title;
    }
    std::string hidings;
    for (const auto& [hiding, titles] : hidden_by) {
      hidings += (hidings.empty() ? "" : ", ") + hiding + " (" + titles + ")";
    }
    Range growths;  // of computation, which hiding does not make less
    for (const Pair& pair : pairs) {
      for (std::size_t c = 0; c < stage.contenders.size(); ++c) {
        growths.add(percent_more(Breakdown(done.result(pair.hidden[c])).compute,
                                 Breakdown(done.result(pair.unhidden[c])).compute));
      }
    }
    book.section("fig6", "Fig. 6: where the time goes");
    book.paragraph(
        "The time of a frame, split as in the paper: initialisation (starting tiles and packets, generating rays), "
        "computation (traversal, intersection, issuing commands) and waiting for DMA. The left bar of each pair "
        "fetches, waits and uses at all levels that it fetches at; of the output, the left bars of grid and tree wait "
        "for every tile to be written, while the hierarchy writes from two buffers in both of its bars, as two tiles "
        "of best take turns in both of its bars. Cell blocks and triangles are, of best and the hierarchy, nodes and "
        "the triangles of leaves. The right bar hides latency: " +
        hidings + ". As in the paper it is the waiting that shrinks; computation changes by " + growths.percent(1) +
        ": prefetch also walks cells that turn out not to be needed, and packets that take turns cost their "
        "switching. A fourth part, idle, is what the dynamic distribution of tiles leaves at the end of a frame; the "
        "paper does not show it. All values are of the mean core, without shading.");
    for (std::size_t c = 0; c < stage.contenders.size(); ++c) {
      for (std::size_t i = 0; i < std::size(kPaperCoreCounts); ++i) {
        BarChart chart{.title = stage.contenders[c].title + (i == 0 ? ", 1 core" : ", 6 cores"),
                       .y_title = "milliseconds of a frame",
                       .bars = {"single", "hidden"},
                       .parts = {"initialisation", "computation", "waiting for DMA", "idle"}};
        for (const Pair& pair : pairs) {
          if (pair.cores_index != i) continue;
          chart.groups.push_back(pair.view->title);
          for (const Plan::RunId run : {pair.unhidden[c], pair.hidden[c]}) {
            const Breakdown ms(done.result(run));
            chart.values.insert(chart.values.end(), {ms.init, ms.compute, ms.all_waits(), ms.idle});
            table.add({stage.contenders[c].key, pair.cores(), pair.view->title,
                       run == pair.unhidden[c] ? "single" : "hidden", ms.init, ms.compute,
                       ms.wait_of(sim::WaitLevel::kTile), ms.wait_of(sim::WaitLevel::kMacroCell),
                       ms.wait_of(sim::WaitLevel::kTriangle), ms.wait_of(sim::WaitLevel::kSetup), ms.idle,
                       done.result(run).timing.seconds * 1e3});
          }
        }
        book.figure("fig6_" + stage.contenders[c].key + (i == 0 ? "_1_core" : "_6_cores"), bar_chart_svg(chart),
                    "Single buffering against hidden latency, " + chart.title + ".");
      }
    }
    book.linked_table(table, "every bar, waiting split by level.");
  };
}

namespace {

/// The reference without hiding, on six cores, with faster and slower memory.
struct LatencyRun {
  const View* view;
  double cycles;
  Plan::RunId run;
};

std::vector<LatencyRun> plan_latencies(Plan& plan, const Stage& stage) {
  std::vector<LatencyRun> runs;
  for (const View* view : stage.sweep_views) {
    for (const double cycles : {300.0, 1000.0}) {
      runs.push_back({view, cycles,
                      plan.add(*view, contender_named(stage, "reference").unhidden, Shading::kNone,
                               machine_with_latency(stage.machine, cycles), kPaperCores)});
    }
  }
  return runs;
}

std::string latency_words(const Plan& done, const std::vector<LatencyRun>& runs) {
  std::string words;
  for (const LatencyRun& run : runs) {
    words += (words.empty() ? "" : ", ") + fixed_text(done.result(run.run).wait_percent(), 1) + " % at " +
             fixed_text(run.cycles, 0) + " (" + run.view->title + ")";
  }
  return words;
}

}  // namespace

namespace {

/// The reference, but for one thing that the paper does not tell.
struct Lever {
  std::string title;
  struct Frames {
    const PaperView* paper;
    std::size_t cores_index;
    Plan::RunId single, hidden;
  };
  std::vector<Frames> frames;
};

std::vector<Lever> plan_levers(Plan& plan, const Stage& stage) {
  std::vector<Lever> levers;
  const auto add = [&](std::string title, const GridVariant& variant, Shading shading, const Machine& machine) {
    GridVariant single = variant;
    single.key += "_single";
    single.configuration.depths = {.output = 1, .macro = 1, .triangle = 1};
    const auto system = std::make_shared<GridSystem>(variant);
    const auto unhidden = std::make_shared<GridSystem>(single);
    Lever& lever = levers.emplace_back(Lever{std::move(title), {}});
    for (const View& view : stage.views()) {
      const PaperView* const paper = find_paper_view(view.key);
      if (paper == nullptr) continue;
      for (std::size_t i = 0; i < std::size(kPaperCoreCounts); ++i) {
        lever.frames.push_back({paper, i, plan.add(view, unhidden, shading, machine, kPaperCoreCounts[i]),
                                plan.add(view, system, shading, machine, kPaperCoreCounts[i])});
      }
    }
  };
  const GridVariant reference = grid_variant("reference");
  add("reference", reference, Shading::kNone, stage.machine);
  GridVariant wide = reference;
  wide.configuration.macro_width = 8;
  wide.key += "_macro8";
  add("macrocells 8 cells wide, not " + std::to_string(reference.configuration.macro_width), wide, Shading::kNone,
      stage.machine);
  for (const char* name : {"cell-ps3-dram", "cell-ps3-tlb"}) {
    const Machine machine = built_in_machine(name);
    add("latency as of " + std::string(name), reference, Shading::kNone, machine);
  }
  add("simple shading", reference, Shading::kSimple, stage.machine);
  GridVariant late = reference;
  late.late_normals = true;
  late.key += "_late_normals";
  add("simple shading, normals fetched after traversal", late, Shading::kSimple, stage.machine);
  return levers;
}

/// The root of the mean square.
class Distance {
 public:
  void add(double a, double b) {
    sum_ += (a - b) * (a - b);
    ++count_;
  }
  [[nodiscard]] double points() const { return count_ == 0 ? 0 : std::sqrt(sum_ / count_); }

 private:
  double sum_ = 0;
  std::uint32_t count_ = 0;
};

void write_levers(const Plan& done, const std::vector<Lever>& levers, Book& book) {
  if (levers.front().frames.empty()) return;  // no view of the paper
  Table table = make_table(
      "table4_levers", Column("lever", "changed"), Column("hidden_percent", "waiting removed, %", 1),
      Column("hidden_distance", "from the paper's, points", 1), Column("single_wait_percent", "waiting, single, %", 1),
      Column("single_wait_distance", "from the paper's, points", 1),
      Column("hidden_wait_percent", "waiting, double, %", 1),
      Column("hidden_wait_distance", "from the paper's, points", 1),
      Column("fps_gain_distance", "fps gain: from the paper's, points", 1));
  for (const Lever& lever : levers) {
    Distance removed, single, hidden, gain;
    double removed_sum = 0, single_sum = 0, hidden_sum = 0;
    for (const Lever::Frames& frames : lever.frames) {
      const RunResult& before = done.result(frames.single);
      const RunResult& after = done.result(frames.hidden);
      const std::size_t i = frames.cores_index;
      const double removed_percent = percent_less(after.wait_cycles(), before.wait_cycles());
      removed.add(removed_percent, frames.paper->hidden[i]);
      single.add(before.wait_percent(), derived_single_wait_percent(*frames.paper, i));
      hidden.add(after.wait_percent(), derived_double_wait_percent(*frames.paper, i));
      gain.add(percent_more(after.fps(), before.fps()), frames.paper->fps_gain[i]);
      removed_sum += removed_percent;
      single_sum += before.wait_percent();
      hidden_sum += after.wait_percent();
    }
    const auto count = static_cast<double>(lever.frames.size());
    table.add({lever.title, removed_sum / count, removed.points(), single_sum / count, single.points(),
               hidden_sum / count, hidden.points(), gain.points()});
  }
  book.paragraph(
      "Some things that move these shares the paper does not tell: how wide its macrocells are, how its memory's "
      "latency "
      "is distributed, when its shading fetches a triangle's normal. Each row changes one of them in the reference, "
      "the last one in the row above it. "
      "Shares are means over the paper's views on one and six cores; their distance from the paper's is the root of "
      "the "
      "mean square, in percentage points. Normals fetched after traversal are added to the frame's steps: each packet "
      "fetches that of every triangle that it shows, one after another, with either buffering.");
  book.table(table, "What single assumptions do to the distance from the paper's Table 4.");
}

}  // namespace

Writer plan_table4(Plan& plan, const Stage& stage) {
  const std::vector<Pair> pairs = plan_pairs(plan, stage, Shading::kNone);
  const std::vector<LatencyRun> latencies = plan_latencies(plan, stage);
  const std::vector<Lever> levers = plan_levers(plan, stage);
  return [&stage, pairs, latencies, levers](const Plan& done, Book& book) {
    Table hiding = make_table("table4_hiding", "view", "cores");
    Table wait = make_table("table4_wait_share", "view", "cores");
    for (const Contender& contender : stage.contenders) {
      hiding.columns.push_back({contender.key + "_hidden_percent", contender.title + ": waiting removed, %", 1});
      wait.columns.push_back({contender.key + "_single_wait_percent", contender.title + ": waiting, single, %", 1});
    }
    hiding.columns.push_back({"paper_hidden_percent_printed", "paper: waiting removed, % [P]", 1});
    wait.columns.push_back({"paper_single_wait_percent_derived", "paper: waiting, single, % [D]", 1});
    for (const Contender& contender : stage.contenders) {
      hiding.columns.push_back({contender.key + "_fps_gain_percent", contender.title + ": fps gain, %", 1});
      wait.columns.push_back({contender.key + "_hidden_wait_percent", contender.title + ": waiting, hidden, %", 1});
    }
    hiding.columns.push_back({"paper_fps_gain_percent_printed", "paper: fps gain, % [P]", 1});
    wait.columns.push_back({"paper_hidden_wait_percent_derived", "paper: waiting, hidden, % [D]", 1});

    // Ranges for sentences: of the reference, of the same with the paper's own test, and of the paper.
    struct Ranges {
      Range hidden, gain, single, hidden_wait;
    };
    Ranges reference, projection, of_paper;
    Range growth_range, byte_ratios, work_ratios;  // the last two: projection over reference
    for (const Pair& pair : pairs) {
      const PaperView* paper = find_paper_view(pair.view->key);
      std::vector<Cell> hidden = {pair.view->title, pair.cores()};
      std::vector<Cell> shares = hidden;
      std::vector<Cell> gains, hidden_shares;
      for (std::size_t c = 0; c < stage.contenders.size(); ++c) {
        const RunResult& before = done.result(pair.unhidden[c]);
        const RunResult& after = done.result(pair.hidden[c]);
        const double hidden_percent = percent_less(after.wait_cycles(), before.wait_cycles());
        const double gain_percent = percent_more(after.fps(), before.fps());
        hidden.emplace_back(hidden_percent);
        gains.emplace_back(gain_percent);
        shares.emplace_back(before.wait_percent());
        hidden_shares.emplace_back(after.wait_percent());
        const std::string& key = stage.contenders[c].key;
        if (key != "reference" && key != "projection") continue;
        Ranges& ranges = key == "reference" ? reference : projection;
        ranges.hidden.add(hidden_percent);
        ranges.gain.add(gain_percent);
        ranges.single.add(before.wait_percent());
        ranges.hidden_wait.add(after.wait_percent());
        if (key != "projection") continue;
        const RunResult& other = done.result(pair.hidden[c - 1]);
        byte_ratios.add(ratio_of(static_cast<double>(after.bytes_in()), static_cast<double>(other.bytes_in())));
        work_ratios.add(ratio_of(Breakdown(after).compute, Breakdown(other).compute));
      }
      if (paper != nullptr) {
        of_paper.single.add(derived_single_wait_percent(*paper, pair.cores_index));
        of_paper.hidden_wait.add(derived_double_wait_percent(*paper, pair.cores_index));
      }
      const auto paper_cell = [&](auto value) { return paper != nullptr ? Cell{value(*paper)} : Cell{}; };
      hidden.emplace_back(paper_cell([&](const PaperView& view) { return view.hidden[pair.cores_index]; }));
      hidden.insert(hidden.end(), gains.begin(), gains.end());
      hidden.emplace_back(paper_cell([&](const PaperView& view) { return view.fps_gain[pair.cores_index]; }));
      shares.emplace_back(
          paper_cell([&](const PaperView& view) { return derived_single_wait_percent(view, pair.cores_index); }));
      shares.insert(shares.end(), hidden_shares.begin(), hidden_shares.end());
      shares.emplace_back(
          paper_cell([&](const PaperView& view) { return derived_double_wait_percent(view, pair.cores_index); }));
      hiding.add(std::move(hidden));
      wait.add(std::move(shares));
    }
    const std::size_t view_count = stage.views().size();
    for (std::size_t v = 0; v < view_count; ++v) {
      growth_range.add(done.result(pairs[view_count + v].unhidden[0]).wait_percent() -
                       done.result(pairs[v].unhidden[0]).wait_percent());
    }
    book.section("table4", "Table 4: waiting hidden by double buffering");
    book.paragraph("Double buffering removes " + reference.hidden.percent(1) +
                   " of the reference configuration's waiting (paper: " + std::string(kPaperHidden) +
                   " [P]) and gains " + reference.gain.percent(1) + " fps (paper: " + std::string(kPaperFpsGain) +
                   " [P]); with the paper's own intersection test it removes " + projection.hidden.percent(1) +
                   " and gains " + projection.gain.percent(1) +
                   ". The hidden share depends on how transfers and work interleave; the gain also depends on how "
                   "much there was to hide, which is the next table.");
    book.table(
        hiding,
        "Share of the waiting that hiding removes, and the fps it gains, against the same system without hiding.");
    // Views outside of the paper have no figure to compare with.
    const std::string paper_words =
        of_paper.single.empty()
            ? ""
            : "; the paper's frames waited " + of_paper.single.percent(1) + " and " + of_paper.hidden_wait.percent(1) +
                  ", derived [D] from its Table 4: that follows from hidden share and gain if nothing but the waiting "
                  "changes";
    book.paragraph("A frame of the reference waits " + reference.single.percent(1) +
                   " of its core cycles single-buffered and " + reference.hidden_wait.percent(1) + " double-buffered" +
                   paper_words + ". The share grows by " + growth_range.text(1) +
                   " percentage points from one core to six" +
                   (growth_range.least() > -1 && growth_range.greatest() < 3
                        ? ": here, as in the paper, latency binds and not bandwidth."
                        : "."));
    book.paragraph(
        "What moves these shares can be measured. What is computed beside the transfers: with the paper's own test, "
        "which fetches " +
        byte_ratios.text(3) + " times the reference's bytes and computes for " + work_ratios.text(2) +
        " times its cycles, the shares are " + projection.single.percent(1) + " and " +
        projection.hidden_wait.percent(1) +
        ". The latency, an assumption of 500 cycles: single-buffered on six cores, the reference waits " +
        latency_words(done, latencies) +
        ". The view: how far the shares are apart within a column shows what it can do, and the paper does not tell "
        "its views. " +
        kCostTableWords);
    book.table(wait, "Share of core cycles spent waiting for DMA.");
    write_levers(done, levers, book);
  };
}

Writer plan_grid(Plan& plan, const Stage& stage) {
  struct Row {
    const View* view;
    Shading shading;
    Plan::RunId single, reference, grid, grid_one_core;
  };
  const Contender& reference = contender_named(stage, "reference");
  const Contender& grid = contender_named(stage, "grid");
  std::vector<Row> rows;
  for (const Shading shading : {Shading::kNone, Shading::kSimple}) {
    for (const View& view : stage.views()) {
      rows.push_back({&view, shading, plan.add(view, reference.unhidden, shading, stage.machine, kPaperCores),
                      plan.add(view, reference.system, shading, stage.machine, kPaperCores),
                      plan.add(view, grid.system, shading, stage.machine, kPaperCores),
                      plan.add(view, grid.system, shading, stage.machine, 1)});
    }
  }
  const ChoiceWords choice_words = plan_choice_words(plan, stage);
  return [rows, choice_words](const Plan& done, Book& book) {
    Table table = make_table("grid_against_reference", "shading", "view", Column("reference_fps", "reference, fps"),
                             Column("grid_fps", "grid, fps"), Column("fps_ratio", "ratio", 2),
                             Column("grid_wait_percent", "grid: wait, %"),
                             Column("single_wait_gone_percent", "of reference's single-buffered wait gone, %", 1),
                             Column("grid_speedup_6_cores", "grid: speed-up on 6", 2),
                             Column("fetched_ratio", "bytes fetched, grid / reference", 2), "same_picture");
    Range ratios, waits, gone;
    bool all_same = true;
    for (const Row& row : rows) {
      const RunResult& single = done.result(row.single);
      const RunResult& reference_run = done.result(row.reference);
      const RunResult& grid_run = done.result(row.grid);
      const double one = done.result(row.grid_one_core).fps();
      const double ratio = reference_run.fps() > 0 ? grid_run.fps() / reference_run.fps() : 0;
      const double gone_percent = percent_less(grid_run.wait_cycles(), single.wait_cycles());
      const bool same = grid_run.facts.picture_hash == reference_run.facts.picture_hash &&
                        single.facts.picture_hash == reference_run.facts.picture_hash;
      all_same = all_same && same;
      ratios.add(ratio);
      waits.add(grid_run.wait_percent());
      gone.add(gone_percent);
      const auto fetched = static_cast<double>(reference_run.bytes_in());
      table.add({row.shading == Shading::kSimple ? "simple" : "none", row.view->title, reference_run.fps(),
                 grid_run.fps(), ratio, grid_run.wait_percent(), gone_percent, one > 0 ? grid_run.fps() / one : 0.0,
                 fetched > 0 ? static_cast<double>(grid_run.bytes_in()) / fetched : 0.0, same ? "yes" : "no"});
    }
    book.section("grid", "Configuration grid against the reference");
    book.paragraph(
        "Configuration grid has the same exact test and a coarser grid. It traverses the grid once per tile instead of "
        "once per 8x8 packet, so that what was fetched serves 1,024 rays, culls by the pixels that a triangle can "
        "cover and by subpackets of 4x4 rays, and keeps " +
        buffer_words("grid") +
        " in rotation. As it tests a triangle cheaply and walks for 1,024 rays at once, large "
        "cells cost it little: " +
        number_text(grid_variant("grid").configuration.lambda) +
        " cells per triangle need less memory, fewer transfers and a shorter build than the reference's " +
        number_text(grid_variant("reference").configuration.lambda) + ". " + choice_words(done) +
        " Records are the reference's, 48 bytes a triangle and 8 a cell, and a cell's triangles come in one run. On "
        "six cores it renders " +
        ratios.text(2) + " times the frames of the reference, waits " + waits.percent(2) + " of its cycles, and " +
        gone.percent(1) + " of the reference's single-buffered waiting (in core cycles) is gone. " +
        (all_same ? "All three runs of every row render the same picture, pixel for pixel."
                  : "NOT all runs render the same picture: see the last column."));
    book.table(table, "Six cores; speed-up against one core.");
  };
}

Writer plan_best(Plan& plan, const Stage& stage) {
  struct Row {
    const View* view;
    Shading shading;
    Plan::RunId grid, best, best_one_core;
  };
  const Contender& grid = contender_named(stage, "grid");
  const Contender& best = contender_named(stage, "best");
  std::vector<Row> rows;
  for (const Shading shading : {Shading::kNone, Shading::kSimple}) {
    for (const View& view : stage.views()) {
      rows.push_back({&view, shading, plan.add(view, grid.system, shading, stage.machine, kPaperCores),
                      plan.add(view, best.system, shading, stage.machine, kPaperCores),
                      plan.add(view, best.system, shading, stage.machine, 1)});
    }
  }
  return [rows](const Plan& done, Book& book) {
    Table table = make_table("best_against_grid", "shading", "view", Column("grid_fps", "grid, fps"),
                             Column("best_fps", "best, fps"), Column("fps_ratio", "ratio", 2),
                             Column("best_wait_percent", "best: wait, %", 2),
                             Column("best_speedup_6_cores", "best: speed-up on 6", 2),
                             Column("fetched_ratio", "bytes fetched, best / grid", 2), "same_picture");
    Range ratios, waits, speedups;
    bool all_same = true;
    for (const Row& row : rows) {
      const RunResult &grid_run = done.result(row.grid), &best_run = done.result(row.best);
      const double ratio = ratio_of(best_run.fps(), grid_run.fps());
      const double speedup = ratio_of(best_run.fps(), done.result(row.best_one_core).fps());
      const bool same = best_run.facts.picture_hash == grid_run.facts.picture_hash;
      all_same = all_same && same;
      ratios.add(ratio);
      waits.add(best_run.wait_percent());
      speedups.add(speedup);
      const double fetched =
          ratio_of(static_cast<double>(best_run.bytes_in()), static_cast<double>(grid_run.bytes_in()));
      table.add({row.shading == Shading::kSimple ? "simple" : "none", row.view->title, grid_run.fps(), best_run.fps(),
                 ratio, best_run.wait_percent(), speedup, fetched, same ? "yes" : "no"});
    }
    book.section("best", "Configuration best against grid");
    book.paragraph(
        "Configuration best has no grid. Its eye rays go through the wide tree, tile by tile: the boxes of a node are "
        "tested against the tile, and the triangles of its leaves are drawn (core/TREE.md). Two tiles take turns, so "
        "that one is worked on while the other waits. On six cores it renders " +
        ratios.text(2) + " times the frames of configuration grid, waits " + waits.percent(2) +
        " of its cycles, and is " + speedups.text(2) + " times as fast as on one core. " +
        (all_same ? "Both render the same picture, pixel for pixel."
                  : "NOT all runs render the same picture: see the last column."));
    book.table(table, "Six cores; speed-up against one core.");
  };
}

}  // namespace gridiron::experiment
