// The experiment on dynamic scenes: what it costs to build a structure anew for each frame, and when a structure that
// takes longer to build pays. Memory: its own. Threads: starts its own. SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "base/ranks.h"
#include "base/words.h"
#include "experiment/bvh_system.h"
#include "experiment/experiments.h"
#include "experiment/plan.h"
#include "experiment/sections.h"
#include "files/interrupt.h"
#include "report/svg_plot.h"

namespace gridiron::experiment {
using namespace plot;
namespace {

constexpr std::uint32_t kCoreCounts[] = {1, 2, 4, 6, 8, 16};
constexpr std::uint32_t kKnotSizes[] = {600, 5'000, 50'000, 140'000};
// Frames for each build; the last stands for a scene that never moves.
constexpr double kFramesPerBuild[] = {1, 3, 10, 30, 100, 300, 1000};

// A structure and who builds it.
struct Way {
  const char* key;
  const char* title;
  std::shared_ptr<const System> system;
};
enum : std::size_t { kGrid, kBvh, kTree, kCoresTree, kWayCount };

std::vector<Way> make_ways() {
  GridVariant by_cores = grid_variant("best");
  by_cores.key = "best_by_cores";
  by_cores.builder = tool::Builder::kCores;
  return {{"grid", "grid, general core", std::make_shared<GridSystem>(grid_variant("grid"))},
          {"bvh", "BVH, general core", std::make_shared<BvhSystem>(true)},
          {"tree", "tree, general core", std::make_shared<GridSystem>(grid_variant("best"))},
          {"tree_by_cores", "tree, cores", std::make_shared<GridSystem>(std::move(by_cores))}};
}

// A mesh, and its runs on each number of cores in each way.
struct Subject {
  View view;
  std::vector<std::vector<Plan::RunId>> runs{};  // [cores][way]
  [[nodiscard]] std::uint64_t triangles() const { return view.mesh().triangles.size(); }
};

// Rising in triangles; of views of one mesh the first.
std::vector<Subject> make_subjects(const FoundViews& found, std::uint32_t largest_knot) {
  std::vector<Subject> subjects;
  const auto add = [&subjects](const View& view) {
    Subject subject{view};
    const auto place = std::ranges::upper_bound(subjects, subject.triangles(), {}, &Subject::triangles);
    subjects.insert(place, std::move(subject));
  };
  for (const std::uint32_t count : kKnotSizes) {
    tool::stop_if_interrupted();
    if (count <= largest_knot) add(make_knot_view(count));
  }
  std::set<const tool::SceneInput*> known;
  for (const View& view : found.views) {
    if (known.insert(view.scene.get()).second) add(view);
  }
  return subjects;
}

// Milliseconds; NaN where a run failed.
struct Times {
  double build = std::nan(""), frame = std::nan("");

  // Of one frame, where so many follow a build.
  [[nodiscard]] double per_frame(double frames) const { return build / frames + frame; }
  [[nodiscard]] bool is_there() const { return !std::isnan(frame); }
};

Times times_of(const RunResult& run) {
  if (run.failed()) return {};
  return {1e3 * run.build_seconds, 1e3 * run.timing.seconds};
}

// The least of what a frame takes. Precondition: one is there.
std::size_t best_of(const std::vector<Times>& ways, double frames) {
  std::size_t best = 0;
  for (std::size_t way = 1; way < ways.size(); ++way) {
    const bool is_less = !ways[best].is_there() || ways[way].per_frame(frames) < ways[best].per_frame(frames);
    if (ways[way].is_there() && is_less) best = way;
  }
  return best;
}

// From how many frames of a still scene on `slow`, which takes longer to build, takes less in all; NaN: never.
double frames_to_pay(const Times& slow, const Times& fast) {
  if (slow.build <= fast.build) return slow.frame <= fast.frame ? 1.0 : std::nan("");
  if (!(slow.frame < fast.frame)) return std::nan("");
  return std::floor((slow.build - fast.build) / (fast.frame - slow.frame)) + 1;
}

// From how many frames a build on the build takes at most a tenth of the time.
double frames_to_tenth(const Times& times) {
  return times.is_there() ? std::max(1.0, std::ceil(9 * times.build / times.frame)) : std::nan("");
}

class Results {
 public:
  Results(const Plan& plan, const std::vector<Subject>& subjects, const std::vector<Way>& ways)
      : plan_(plan), subjects_(subjects), ways_(ways) {}

  [[nodiscard]] const std::vector<Subject>& subjects() const { return subjects_; }
  [[nodiscard]] const std::vector<Way>& ways() const { return ways_; }
  [[nodiscard]] const RunResult& run(const Subject& subject, std::size_t cores, std::size_t way) const {
    return plan_.result(subject.runs[cores][way]);
  }
  [[nodiscard]] std::vector<Times> times(const Subject& subject, std::size_t cores) const {
    std::vector<Times> times;
    for (std::size_t way = 0; way < ways_.size(); ++way) times.push_back(times_of(run(subject, cores, way)));
    return times;
  }

 private:
  const Plan& plan_;
  const std::vector<Subject>& subjects_;
  const std::vector<Way>& ways_;
};

std::size_t place_of_paper_cores() {
  return static_cast<std::size_t>(std::ranges::find(kCoreCounts, kPaperCores) - std::begin(kCoreCounts));
}

// "Bunny, Horse": of which subjects something holds; "all of them", "none of them".
std::string words_of(const std::vector<const Subject*>& some, std::size_t all) {
  if (some.empty()) return "none of them";
  if (some.size() == all) return "all of them";
  std::string words;
  for (const Subject* subject : some) words += (words.empty() ? "" : ", ") + subject->view.title;
  return words;
}

// "tree, built by the cores".
std::string words_of_way(const Way& way) {
  const std::string title = way.title;
  const std::size_t comma = title.find(',');
  return title.substr(0, comma) + ", built by the" + title.substr(comma + 1);
}

// --- Sections -------------------------------------------------------------------------------------------------------

void write_rates(const Results& results, Book& book) {
  Table table = make_table("dynamic", "view", "triangles", "cores", "way", Column("build_ms", "build, ms", 3),
                           Column("frame_ms", "frame, ms", 3), Column("fps", "frames/s, each built", 1),
                           Column("still_fps", "frames/s, nothing built", 1),
                           Column("build_percent", "build, % of both", 1), "note");
  Table shown = make_table("", "view", "triangles");
  for (const Way& way : results.ways()) {
    shown.columns.emplace_back(std::string(way.key) + "_build_ms", std::string(way.title) + ": build, ms", 2);
    shown.columns.emplace_back(std::string(way.key) + "_frame_ms", "frame, ms", 2);
    shown.columns.emplace_back(std::string(way.key) + "_fps", "frames/s", 1);
  }
  const std::size_t six = place_of_paper_cores();
  Range tree_ratio, six_share;
  std::vector<const Subject*> won;
  for (const Subject& subject : results.subjects()) {
    for (std::size_t cores = 0; cores < std::size(kCoreCounts); ++cores) {
      const std::vector<Times> times = results.times(subject, cores);
      for (std::size_t way = 0; way < times.size(); ++way) {
        const Times& time = times[way];
        table.add({subject.view.key, subject.triangles(), std::uint64_t{kCoreCounts[cores]},
                   std::string(results.ways()[way].key), time.build, time.frame, 1e3 / time.per_frame(1),
                   1e3 / time.frame, 100 * ratio_of(time.build, time.per_frame(1)),
                   results.run(subject, cores, way).failure});
      }
      if (cores != six) continue;
      std::vector<Cell> row = {subject.view.title, subject.triangles()};
      for (const Times& time : times) row.insert(row.end(), {time.build, time.frame, 1e3 / time.per_frame(1)});
      shown.add(std::move(row));
      tree_ratio.add(ratio_of(times[kTree].build, times[kCoresTree].build));
      six_share.add(100 * ratio_of(times[kCoresTree].build, times[kCoresTree].per_frame(1)));
      if (best_of(times, 1) == kCoresTree) won.push_back(&subject);
    }
  }
  book.section("rates", "A structure for each frame");
  book.paragraph(
      "A scene that moves is built anew for each frame: first the structure, then the picture. The general core builds "
      "grid, BVH or tree while the cores wait; or the cores build the tree out of their local stores. " +
      std::to_string(kPaperCores) + " cores build it " + tree_ratio.text(1) +
      " times as fast as the general core; with them the build is " + six_share.percent(0) +
      " of the time of a frame. Of " + tool::words_of_count(results.subjects().size(), "scene") +
      " this way has the most frames a second, each built anew, in " + words_of(won, results.subjects().size()) + ".");
  LineChart chart{.title = "Frames a second, each built anew, " + std::to_string(kPaperCores) + " cores",
                  .x_title = "triangles",
                  .y_title = "frames/s",
                  .log_x = true,
                  .log_y = true};
  for (std::size_t way = 0; way < results.ways().size(); ++way) {
    Series series{results.ways()[way].title, {}};
    for (const Subject& subject : results.subjects()) {
      const Times time = results.times(subject, six)[way];
      if (time.is_there()) series.points.push_back({static_cast<double>(subject.triangles()), 1e3 / time.per_frame(1)});
    }
    chart.series.push_back(std::move(series));
  }
  book.figure("dynamic_triangles", line_chart_svg(chart), "All meshes, by their triangles.");
  book.shown_table(shown, "Build and frame on " + std::to_string(kPaperCores) + " cores.");
  book.linked_table(table, "build and frame of every mesh on 1 to 16 cores");
}

void write_cores(const Results& results, Book& book) {
  const Subject& largest = results.subjects().back();
  LineChart chart{.title = "Frames a second, each built anew: " + largest.view.title,
                  .x_title = "cores",
                  .y_title = "frames/s",
                  .x_ticks = {std::begin(kCoreCounts), std::end(kCoreCounts)}};
  for (std::size_t way = 0; way < results.ways().size(); ++way) {
    Series series{results.ways()[way].title, {}};
    for (std::size_t cores = 0; cores < std::size(kCoreCounts); ++cores) {
      const Times time = results.times(largest, cores)[way];
      if (time.is_there()) series.points.push_back({static_cast<double>(kCoreCounts[cores]), 1e3 / time.per_frame(1)});
    }
    chart.series.push_back(std::move(series));
  }
  Range gain_cores, gain_master;
  std::vector<const Subject*> one_core;
  for (const Subject& subject : results.subjects()) {
    const std::vector<Times> one = results.times(subject, 0), most = results.times(subject, std::size(kCoreCounts) - 1);
    gain_cores.add(ratio_of(one[kCoresTree].per_frame(1), most[kCoresTree].per_frame(1)));
    for (const std::size_t way : {kGrid, kBvh, kTree}) {
      gain_master.add(ratio_of(one[way].per_frame(1), most[way].per_frame(1)));
    }
    if (one[kCoresTree].build < one[kTree].build) one_core.push_back(&subject);
  }
  book.section("cores", "More cores");
  book.paragraph("Where the cores build, " + std::to_string(kCoreCounts[std::size(kCoreCounts) - 1]) +
                 " of them make " + gain_cores.text(1) +
                 " times the frames of one. Where the general core builds, they make " + gain_master.text(1) +
                 " times as many, because its part stays as long. One core alone builds the tree faster than the "
                 "general core in " +
                 words_of(one_core, results.subjects().size()) + ".");
  book.figure("dynamic_cores", line_chart_svg(chart), "The largest mesh, by the number of cores.");
}

// What keeps a frame and its build from being faster, by the limits of passes and the general core.
void write_bindings(const Results& results, Book& book) {
  Table passes = make_table("dynamic_passes", "view", "triangles", "cores", "pass", "items",
                            Column("ms", "time, ms", 4), "binding");
  BarChart chart{.title = "What binds build and picture, " + std::to_string(kPaperCores) + " cores",
                 .y_title = "ms",
                 .bars = {""},
                 .parts = {}};
  std::vector<std::string> limits;
  for (std::size_t i = 0; i < sim::kPassLimitCount; ++i) limits.emplace_back(name_of(static_cast<sim::PassLimit>(i)));
  limits.emplace_back("general_core");
  for (const std::string& limit : limits) chart.parts.push_back(limit);
  Table table = make_table("dynamic_bindings", "view", "triangles", "cores", "part");
  for (const std::string& limit : limits) table.columns.emplace_back(limit + "_ms", limit + ", ms", 3);
  Table shown = table;
  shown.name.clear();
  const std::size_t six = place_of_paper_cores();
  for (const Subject& subject : results.subjects()) {
    for (std::size_t cores = 0; cores < std::size(kCoreCounts); ++cores) {
      const RunResult& run = results.run(subject, cores, kCoresTree);
      if (run.failed()) continue;
      const double ms = 1e3 * run.timing.seconds / run.timing.frame_cycles;  // a cycle
      std::map<std::string, double> build, picture;
      for (const tool::PassFigures& pass : run.passes) {
        const std::string binding(pass.binding());
        passes.add({subject.view.key, subject.triangles(), std::uint64_t{kCoreCounts[cores]}, pass.name,
                    std::uint64_t{pass.items}, pass.cycles() * ms, binding});
        (&pass == &run.passes.back() ? picture : build)[binding] += pass.cycles() * ms;
      }
      for (const auto& [part, by_limit] : {std::pair{"build", &build}, std::pair{"picture", &picture}}) {
        std::vector<Cell> row = {subject.view.key, subject.triangles(), std::uint64_t{kCoreCounts[cores]},
                                 std::string(part)};
        for (const std::string& limit : limits) row.emplace_back(by_limit->contains(limit) ? by_limit->at(limit) : 0.0);
        if (cores == six) shown.add(row);
        table.add(std::move(row));
      }
      if (cores != six) continue;
      chart.groups.push_back(subject.view.title);
      for (const std::string& limit : limits) {
        chart.values.push_back((build.contains(limit) ? build[limit] : 0) +
                               (picture.contains(limit) ? picture[limit] : 0));
      }
    }
  }
  book.section("bindings", "What binds");
  book.paragraph(
      "Each pass of the build, and the picture behind them, is bound by one thing: the memory channel, the cores' "
      "computing, their waits, the longest item, which one core has alone, or begin and end. Between the passes "
      "and the picture the general core puts the check value of the image together. Tree built by the cores.");
  book.figure("dynamic_bindings", bar_chart_svg(chart), "Build and picture together, by what binds each pass.");
  book.shown_table(shown, "The same of build and picture.");
  book.linked_table(table, "what binds build and picture on 1 to 16 cores");
  book.linked_table(passes, "every pass of every build, its time and what binds it");
}

void write_choice(const Results& results, Book& book) {
  Table pays = make_table("dynamic_pays", "view", "triangles", "cores");
  for (const std::size_t way : {kGrid, kBvh}) {
    pays.columns.emplace_back(std::string(results.ways()[way].key) + "_pays_after_frames",
                              std::string(results.ways()[way].title) + ": pays from frames a build", 0);
  }
  pays.columns.emplace_back("bvh_pays_over_grid_after_frames", "BVH against grid: pays from", 0);
  for (const Way& way : results.ways()) {
    pays.columns.emplace_back(std::string(way.key) + "_tenth_after_frames",
                              std::string(way.title) + ": build a tenth from", 0);
  }
  for (const double frames : kFramesPerBuild) {
    pays.columns.emplace_back("best_of_" + number_text(frames), "best of " + number_text(frames));
  }
  pays.columns.emplace_back("best_still", "nothing built");
  Table shown = pays;
  shown.name.clear();
  const std::size_t six = place_of_paper_cores();
  std::map<std::size_t, std::vector<const Subject*>> paying, winners_new, winners_still;
  std::vector<const Subject*> hierarchy_pays;
  Range pay_grid, pay_bvh, pay_hierarchy, tenth_master, tenth_cores;
  for (const Subject& subject : results.subjects()) {
    for (std::size_t cores = 0; cores < std::size(kCoreCounts); ++cores) {
      const std::vector<Times> times = results.times(subject, cores);
      std::vector<Cell> row = {subject.view.key, subject.triangles(), std::uint64_t{kCoreCounts[cores]}};
      for (const std::size_t way : {kGrid, kBvh}) {
        const double frames = frames_to_pay(times[way], times[kCoresTree]);
        row.emplace_back(std::isnan(frames) ? Cell{} : Cell{frames});
        if (cores != six || std::isnan(frames)) continue;
        paying[way].push_back(&subject);
        (way == kGrid ? pay_grid : pay_bvh).add(frames);
      }
      const double hierarchy = frames_to_pay(times[kBvh], times[kGrid]);
      row.emplace_back(std::isnan(hierarchy) ? Cell{} : Cell{hierarchy});
      for (std::size_t way = 0; way < times.size(); ++way) {
        const double tenth = frames_to_tenth(times[way]);
        row.emplace_back(std::isnan(tenth) ? Cell{} : Cell{tenth});
        if (cores == six && way == kTree) tenth_master.add(tenth);
        if (cores == six && way == kCoresTree) tenth_cores.add(tenth);
      }
      if (cores == six && !std::isnan(hierarchy)) {
        hierarchy_pays.push_back(&subject);
        pay_hierarchy.add(hierarchy);
      }
      constexpr double kStill = 1e12;
      for (const double frames : kFramesPerBuild) row.emplace_back(results.ways()[best_of(times, frames)].key);
      // The tree is one, whoever built it.
      const std::size_t still = std::min<std::size_t>(best_of(times, kStill), kTree);
      row.emplace_back(results.ways()[still].key);
      if (cores == six) {
        winners_new[best_of(times, 1)].push_back(&subject);
        winners_still[still].push_back(&subject);
        shown.add(row);
      }
      pays.add(std::move(row));
    }
  }
  const std::size_t all = results.subjects().size();
  book.section("choice", "Where each is the right choice");
  std::string anew = "With " + std::to_string(kPaperCores) + " cores, and a build for each frame, the right choice is";
  std::string still = "If nothing is ever built, it is";
  for (std::size_t way = 0; way < kWayCount; ++way) {
    const std::string title = results.ways()[way].title, structure = title.substr(0, title.find(','));
    if (!winners_new[way].empty()) {
      anew += " the " + words_of_way(results.ways()[way]) + ", in " + words_of(winners_new[way], all) + ";";
    }
    if (!winners_still[way].empty()) still += " the " + structure + ", in " + words_of(winners_still[way], all) + ";";
  }
  anew.back() = '.';
  still.back() = '.';
  book.paragraph(anew + " " + still);
  const auto words_of_payment = [&](std::size_t way, const Range& frames) {
    std::string words = "The " + words_of_way(results.ways()[way]);
    if (paying[way].empty()) return words + ", never pays against the tree that the cores build: no frame is faster.";
    return words + ", pays against the tree that the cores build from " + frames.text(0) + " frames a build on in " +
           words_of(paying[way], all) + (paying[way].size() < all ? ", and never in the others." : ".");
  };
  book.paragraph(
      words_of_payment(kGrid, pay_grid) + " " + words_of_payment(kBvh, pay_bvh) +
      " A still scene shares its build among its frames, so a structure that takes longer to build pays only "
      "where its frames are faster. Against the grid, the structure of the paper, the BVH pays " +
      (hierarchy_pays.empty()
           ? "in none of them"
           : "from " + pay_hierarchy.text(0) + " frames a build on in " + words_of(hierarchy_pays, all)) +
      ". The general core's build of the tree takes a tenth of the time if a build serves " + tenth_master.text(0) +
      " frames, the cores' if it serves " + tenth_cores.text(0) + ".");
  // Of the largest mesh.
  const Subject& largest = results.subjects().back();
  LineChart chart{.title = "Time of a frame with its share of a build: " + largest.view.title,
                  .x_title = "frames a build",
                  .y_title = "ms",
                  .log_x = true,
                  .log_y = true};
  const std::vector<Times> times = results.times(largest, six);
  for (std::size_t way = 0; way < times.size(); ++way) {
    if (!times[way].is_there()) continue;
    Series series{results.ways()[way].title, {}};
    for (const double frames : kFramesPerBuild) series.points.push_back({frames, times[way].per_frame(frames)});
    chart.series.push_back(std::move(series));
  }
  book.figure("dynamic_frames", line_chart_svg(chart),
              "The largest mesh: time of a frame, by the number of frames that have the same structure.");
  book.shown_table(shown,
                   "From how many frames a build on a structure pays against the tree that the cores build "
                   "(empty: never), and the least time of a frame by the number of frames a build.");
  book.linked_table(pays, "the same for 1 to 16 cores");
}

void write_method(const ExperimentSettings& settings, const FoundViews& found, Book& book) {
  book.section("method", "How it is measured");
  for (const std::string& sentence : found.missing) book.paragraph(sentence);
  book.paragraph(
      "Pictures of " + std::to_string(settings.width) + "x" + std::to_string(settings.height) +
      " pixels with simple shading, rendered by the kernel's real code. Grid: configuration grid; tree: configuration "
      "best; BVH: with hyper-threading. Work of the general core is counted and priced step by step "
      "(tools/calibrate/README.md, The general core); the cores' passes are run on the simulated chip, and their "
      "traces get a time on each number of cores. One builder builds, then the cores render: nothing overlaps. "
      "Vertices lie in the order of the file for all builders. " +
      std::string(kCostTableWords) + " " + kBvhCostWords);
}

}  // namespace

std::vector<std::string> dynamic_file_names() {
  return {"dynamic.csv",       "dynamic_bindings.csv",  "dynamic_bindings.svg",
          "dynamic_cores.svg", "dynamic_frames.svg",    "dynamic_passes.csv",
          "dynamic_pays.csv",  "dynamic_triangles.svg", "index.html"};
}

ExperimentResult run_dynamic_experiment(const ExperimentSettings& settings, const ProgressCall& progress) {
  const FoundViews found = find_views(settings.scenes);
  std::vector<Subject> subjects = make_subjects(found, settings.largest_knot);
  const std::vector<Way> ways = make_ways();
  const Machine machine = built_in_machine("cell-ps3");
  Plan plan(settings.width, settings.height);
  for (Subject& subject : subjects) {
    for (const std::uint32_t cores : kCoreCounts) {
      auto& runs = subject.runs.emplace_back();
      for (const Way& way : ways) runs.push_back(plan.add(subject.view, way.system, Shading::kSimple, machine, cores));
    }
  }
  plan.execute(settings.threads, progress);
  if (!tool::ranks().is_first()) return {};
  Book book("Scenes that move",
            "Every figure below comes from one run of `gridiron experiment dynamic`: meshes of " +
                tool::words_of_count(subjects.front().triangles()) + " to " +
                tool::words_of_count(subjects.back().triangles()) +
                " triangles, their structures built by the general core or by the cores of the simulated chip " +
                machine.key + ", and pictures of them.");
  const Results results(plan, subjects, ways);
  write_rates(results, book);
  write_choice(results, book);
  write_cores(results, book);
  write_bindings(results, book);
  write_method(settings, found, book);
  return {book.finish(), plan.rendered_count(), plan.run_count(), found.missing};
}

}  // namespace gridiron::experiment
