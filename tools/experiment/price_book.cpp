// Price book. SPDX-License-Identifier: Apache-2.0
#include "experiment/price_book.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "experiment/price_words.h"
#include "files/interrupt.h"
#include "report/svg_plot.h"

namespace gridiron::experiment {
using namespace plot;
namespace {

constexpr double kMegabyte = 1 << 20;

/// A column, and its value for a price.
struct Field {
  Column column;
  std::function<Cell(const Price&)> cell;
};

using RunOf = const RunResult& (PriceList::*)(const Price&) const;

// Fields of runs and of errors; empty without a result.
class Fields {
 public:
  explicit Fields(const PriceList& list) : list_(list) {}

  void add(Column column, std::function<Cell(const Price&)> cell) {
    fields_.push_back({std::move(column), std::move(cell)});
  }
  template <class Value>
  void add_run(Column column, RunOf run, Value value) {
    add(std::move(column), [&list = list_, run, value](const Price& price) -> Cell {
      const RunResult& result = (list.*run)(price);
      return result.failed() ? Cell{} : Cell{value(result)};
    });
  }
  template <class Value>
  void add_error(Column column, Value value) {
    add(std::move(column),
        [value](const Price& price) -> Cell { return price.errors ? Cell{value(*price.errors)} : Cell{}; });
  }
  void add_names(bool with_view) {
    if (with_view)
      add({"view", "view"}, [&list = list_](const Price& price) { return list.views()[price.view].title; });
    add({"configuration", with_view ? "configuration" : "config"},
        [](const Price& price) { return kPricedConfigurations[price.configuration]; });
    add({"profile", "profile"}, [&list = list_](const Price& price) { return list.profiles()[price.profile].key; });
  }

  /// @param keep  which prices become rows.
  [[nodiscard]] Table table(std::string name, const std::function<bool(const Price&)>& keep) const {
    Table table{std::move(name), {}, {}};
    for (const Field& field : fields_) table.columns.push_back(field.column);
    for (const Price& price : list_.prices()) {
      if (!price.is_possible() || !keep(price)) continue;
      std::vector<Cell> row;
      for (const Field& field : fields_) row.push_back(field.cell(price));
      table.add(std::move(row));
    }
    return table;
  }

 private:
  const PriceList& list_;
  std::vector<Field> fields_;
};

struct NamedCount {
  const char* name;
  std::uint64_t HitCounts::*count;
};
constexpr NamedCount kHitCounts[] = {{"rays", &HitCounts::rays},
                                     {"true_hits", &HitCounts::true_hits},
                                     {"holes", &HitCounts::holes},
                                     {"false_hits", &HitCounts::false_hits},
                                     {"wrong_triangles", &HitCounts::wrong_triangles},
                                     {"seen_through", &HitCounts::seen_through}};
constexpr std::span<const NamedCount> kWrongCounts = std::span(kHitCounts).subspan(2);

// Nothing where there are none.
using HitsOf = const HitCounts* (*)(const Price&);
const HitCounts* of_pixels(const Price& price) {
  return price.errors ? &price.errors->hits : nullptr;
}
const HitCounts* at_edges(const Price& price) {
  return price.at_edges ? &*price.at_edges : nullptr;
}
double edges_per_million(const Price& price, std::uint64_t HitCounts::*count) {
  return price.at_edges ? price.at_edges->per_million((*price.at_edges).*count) : std::nan("");
}

double million_cycles(const RunResult& run) {
  return run.timing.frame_cycles / 1e6;
}

double fps(const RunResult& run) {
  return run.fps();
}

// Everything of every price.
Table all_prices(const PriceList& list) {
  Fields fields(list);
  fields.add_names(true);
  const auto cycles = [](const RunResult& run) { return run.timing.frame_cycles; };
  const auto add_time = [&](const std::string& prefix, RunOf run) {
    fields.add_run({prefix + "cycles", ""}, run, cycles);
    fields.add_run({prefix + "fps", ""}, run, fps);
    fields.add_run({prefix + "wait_percent", ""}, run, [](const RunResult& result) { return result.wait_percent(); });
  };
  add_time("", &PriceList::frame);
  add_time("with_distances_", &PriceList::with_distances);
  add_time("starved_", &PriceList::on_starved);
  const auto add_of_grid = [&](const char* key, std::uint64_t FrameFacts::*bytes) {
    fields.add({key, ""}, [&list, bytes](const Price& price) -> Cell {
      const FrameFacts& facts = list.frame(price).facts;
      return facts.grid ? Cell{facts.*bytes} : Cell{};
    });
  };
  const auto add_bytes = [&fields](const char* key, RunOf run, std::uint64_t (*bytes)(const RunResult&)) {
    fields.add_run({key, ""}, run, bytes);
  };
  add_bytes("dma_bytes", &PriceList::frame, [](const RunResult& run) { return run.moved_bytes(); });
  add_bytes("dma_in_bytes", &PriceList::frame, [](const RunResult& run) { return run.bytes_in(); });
  add_of_grid("dma_triangle_bytes", &FrameFacts::fetched_triangle_bytes);
  add_bytes("with_distances_dma_bytes", &PriceList::with_distances,
            [](const RunResult& run) { return run.moved_bytes(); });
  add_bytes("local_store_bytes", &PriceList::frame, [](const RunResult& run) { return run.facts.local_store_bytes; });
  add_bytes("main_memory_bytes", &PriceList::frame, [](const RunResult& run) { return run.facts.main_memory_bytes; });
  add_bytes("scene_bytes", &PriceList::frame, [](const RunResult& run) { return run.facts.scene_bytes; });
  add_of_grid("triangle_bytes", &FrameFacts::triangle_bytes);

  const auto add_hits = [&fields](const std::string& prefix, HitsOf hits_of) {
    for (const auto& [name, count] : kHitCounts) {
      fields.add({prefix + name, ""}, [hits_of, count = count](const Price& price) -> Cell {
        const HitCounts* const hits = hits_of(price);
        return hits != nullptr ? Cell{hits->*count} : Cell{};
      });
    }
    for (const auto& [name, count] : kWrongCounts) {
      fields.add({prefix + name + "_per_million", ""}, [hits_of, count = count](const Price& price) -> Cell {
        const HitCounts* const hits = hits_of(price);
        return hits != nullptr ? Cell{hits->per_million(hits->*count)} : Cell{};
      });
    }
  };
  add_hits("", of_pixels);
  add_hits("edge_", at_edges);
  fields.add_error({"wrong_triangles_at_true_distance", ""},
                   [](const Comparison& found) { return found.wrong_at_true_depth; });
  const auto add_spread = [&fields](const std::string& key, Spread Comparison::*spread) {
    fields.add_error({key + "_median", ""}, [spread](const Comparison& found) { return (found.*spread).median; });
    fields.add_error({key + "_p99", ""}, [spread](const Comparison& found) { return (found.*spread).percentile_99; });
    fields.add_error({key + "_max", ""}, [spread](const Comparison& found) { return (found.*spread).greatest; });
  };
  add_spread("t_ulp", &Comparison::ulps);
  add_spread("t_relative", &Comparison::relative);
  add_spread("t_all_hits_ulp", &Comparison::all_ulps);
  add_spread("t_all_hits_relative", &Comparison::all_relative);
  fields.add_error({"differing_pixels", ""}, [](const Comparison& found) { return found.picture.differing_pixels; });
  fields.add_error({"psnr_db", ""}, [](const Comparison& found) { return found.picture.psnr_db(); });
  fields.add_error({"greatest_pixel_error", ""},
                   [](const Comparison& found) { return found.picture.greatest_pixel_error; });
  return fields.table("prices", [](const Price&) { return true; });
}

std::string bin_name(std::size_t bin) {
  if (bin == 0) return "0";
  constexpr std::size_t kPlain = 11;
  const std::string least =
      bin <= kPlain ? std::to_string(std::uint64_t{1} << (bin - 1)) : "2^" + std::to_string(bin - 1);
  return bin + 1 == kUlpBinCount ? least + "+" : least;
}

Table histogram_table(const PriceList& list) {
  Fields fields(list);
  fields.add_names(true);
  for (std::size_t bin = 0; bin < kUlpBinCount; ++bin) {
    const std::uint64_t least = bin == 0 ? 0 : std::uint64_t{1} << (bin - 1);
    fields.add_error({"from_" + std::to_string(least) + "_ulp", ""},
                     [bin](const Comparison& found) { return found.ulp_histogram[bin]; });
  }
  return fields.table("t_histogram", [](const Price&) { return true; });
}

// The figure of a view's errors and costs.
std::string histogram_svg(const PriceList& list, std::size_t view, std::size_t configuration) {
  HistogramChart chart;
  chart.title = list.views()[view].title + ", configuration " + kPricedConfigurations[configuration];
  chart.bin_title = "pixels by error of t, ulp (log heights)";
  chart.cost_title = "million cycles a frame";
  for (std::size_t bin = 0; bin < kUlpBinCount; ++bin) chart.bins.push_back(bin_name(bin));
  for (const char* name : {"wrong triangle", "hole", "false hit"}) chart.bins.emplace_back(name);
  chart.separate_bins = 3;
  chart.parts = {"frame", "frame with distances"};
  for (std::size_t profile = 0; profile < list.profiles().size(); ++profile) {
    const Price& price = list.price(view, configuration, profile);
    if (!price.is_possible()) continue;
    HistogramChart::Row row{list.profiles()[profile].key, {}, {}};
    const Comparison errors = price.errors.value_or(Comparison{});
    for (const std::uint64_t count : errors.ulp_histogram) row.counts.push_back(static_cast<double>(count));
    for (const std::uint64_t count : {errors.hits.wrong_triangles, errors.hits.holes, errors.hits.false_hits}) {
      row.counts.push_back(static_cast<double>(count));
    }
    for (const RunResult* run : {&list.frame(price), &list.with_distances(price)}) {
      row.costs.push_back(run->failed() ? std::nan("") : million_cycles(*run));
    }
    chart.rows.push_back(std::move(row));
  }
  return histogram_chart_svg(chart);
}

/// An error against a time.
struct Front {
  std::string key;  ///< of files
  std::string error, time;
  RunOf run;
  double (*value)(const Price&);  ///< of a price that has errors
};

std::vector<Front> make_fronts() {
  return {{"pixels", "wrong pixels of a million", "million cycles a frame", &PriceList::frame,
           [](const Price& price) { return price.errors->hits.per_million(price.errors->hits.wrong_rays()); }},
          {"edges", "leaks of a million rays at edges", "million cycles a frame", &PriceList::frame,
           [](const Price& price) {
             return price.at_edges ? price.at_edges->per_million(price.at_edges->leaks()) : std::nan("");
           }},
          {"t", "error of t in 99 of 100 pixels, ulp", "million cycles a frame with distances",
           &PriceList::with_distances, [](const Price& price) { return price.errors->ulps.percentile_99; }}};
}

/// One profile in one configuration, in one view or over all.
struct FrontPoint {
  std::size_t configuration, profile;
  Point2 point;
  bool on_front = false;
};

// @param view  nothing: all views, with the geometric mean of the times and the greatest of the errors.
std::vector<FrontPoint> front_points(const PriceList& list, const Front& front, std::optional<std::size_t> view) {
  std::vector<FrontPoint> points;
  std::vector<Point2> places;
  for (std::size_t configuration = 0; configuration < std::size(kPricedConfigurations); ++configuration) {
    for (std::size_t profile = 0; profile < list.profiles().size(); ++profile) {
      double log_sum = 0, greatest = 0;
      std::size_t count = 0;
      bool whole = true;
      for (std::size_t each = 0; each < list.views().size(); ++each) {
        if (view && each != *view) continue;
        const Price& price = list.price(each, configuration, profile);
        const RunResult& run = (list.*front.run)(price);
        const double error = price.errors ? front.value(price) : std::nan("");
        if (run.failed() || !std::isfinite(error)) {
          whole = false;
          continue;
        }
        log_sum += std::log(million_cycles(run));
        greatest = std::max(greatest, error);
        ++count;
      }
      const Point2 point = whole && count > 0 ? Point2{std::exp(log_sum / static_cast<double>(count)), greatest}
                                              : Point2{std::nan(""), std::nan("")};
      places.push_back(point);
      points.push_back({configuration, profile, point});
    }
  }
  const std::vector<bool> on_front = pareto_front(places);
  for (std::size_t i = 0; i < points.size(); ++i) points[i].on_front = on_front[i];
  return points;
}

std::string name_of(const PriceList& list, const FrontPoint& point) {
  return list.profiles()[point.profile].key + " in " + kPricedConfigurations[point.configuration];
}

std::string front_svg(const PriceList& list, const Front& front, const std::string& place,
                      const std::vector<FrontPoint>& points) {
  ScatterChart chart;
  chart.title = "Error against time, " + place;
  chart.x_title = front.time;
  chart.y_title = front.error;
  for (const Profile& profile : list.profiles()) chart.colors.push_back(profile.key);
  chart.styles.assign(std::begin(kPricedConfigurations), std::end(kPricedConfigurations));
  chart.ring = "Pareto front";
  for (const FrontPoint& point : points) {
    chart.points.push_back(
        {point.point.x, point.point.y, name_of(list, point), point.profile, point.configuration, point.on_front});
  }
  return scatter_chart_svg(chart);
}

// Lists the points on the front, and for the others the points that beat them.
std::string front_words(const PriceList& list, const std::vector<FrontPoint>& points) {
  std::string front, beaten;
  for (const FrontPoint& point : points) {
    if (point.on_front) front += (front.empty() ? "" : ", ") + name_of(list, point);
    if (point.on_front || !std::isfinite(point.point.x)) continue;
    // Beaten by the fastest that is no worse in either coordinate.
    const FrontPoint* by = nullptr;
    for (const FrontPoint& other : points) {
      const bool beats = other.on_front && other.point.x <= point.point.x && other.point.y <= point.point.y;
      if (beats && (by == nullptr || other.point.x < by->point.x)) by = &other;
    }
    beaten += (beaten.empty() ? "" : ", ") + name_of(list, point);
    if (by != nullptr) beaten += " (by " + name_of(list, *by) + ")";
  }
  return "On the front: " + (front.empty() ? "none" : front) + "." + (beaten.empty() ? "" : " Beaten: " + beaten + ".");
}

// Geometric mean over the views, NaN if a view has none.
double mean_mcycles(const PriceList& list, RunOf run, std::size_t configuration, std::size_t profile) {
  double sum = 0;
  for (std::size_t view = 0; view < list.views().size(); ++view) {
    const RunResult& result = (list.*run)(list.price(view, configuration, profile));
    sum += result.failed() ? std::nan("") : std::log(million_cycles(result));
  }
  return std::exp(sum / static_cast<double>(list.views().size()));
}

}  // namespace

std::string price_text_name(const std::string& view_key) {
  return "prices_" + view_key + ".txt";
}

Table view_costs(const PriceList& list, std::size_t view) {
  Fields fields(list);
  fields.add_names(false);
  const auto add_bytes = [&fields](const char* title, double (*bytes)(const RunResult&)) {
    fields.add_run({"", title, 1}, &PriceList::frame, [bytes](const RunResult& run) { return bytes(run) / kMegabyte; });
  };
  fields.add_run({"", "Mcycles"}, &PriceList::frame, million_cycles);
  fields.add_run({"", "fps", 1}, &PriceList::frame, fps);
  fields.add_run({"", "with t"}, &PriceList::with_distances, million_cycles);
  fields.add_run({"", "starved"}, &PriceList::on_starved, million_cycles);
  add_bytes("DMA MB", [](const RunResult& run) { return static_cast<double>(run.moved_bytes()); });
  fields.add({"", "triangle MB", 1}, [&list](const Price& price) -> Cell {
    const FrameFacts& facts = list.frame(price).facts;
    return facts.grid ? Cell{static_cast<double>(facts.fetched_triangle_bytes) / kMegabyte} : Cell{};
  });
  add_bytes("main MB", [](const RunResult& run) { return static_cast<double>(run.facts.main_memory_bytes); });
  fields.add_run({"", "local KB", 0}, &PriceList::frame,
                 [](const RunResult& run) { return static_cast<double>(run.facts.local_store_bytes) / 1024; });
  return fields.table("", [view](const Price& price) { return price.view == view; });
}

Table view_errors(const PriceList& list, std::size_t view, bool split_leaks) {
  Fields fields(list);
  fields.add_names(false);
  const auto add_shares = [&fields, split_leaks](const std::string& where, HitsOf hits_of) {
    const auto add = [&](const std::string& title, std::uint64_t (*count)(const HitCounts&), int decimals = 0) {
      fields.add({"", where + title, decimals}, [hits_of, count](const Price& price) -> Cell {
        const HitCounts* const hits = hits_of(price);
        return hits != nullptr ? Cell{hits->per_million(count(*hits))} : Cell{};
      });
    };
    if (split_leaks) {
      add("holes", [](const HitCounts& hits) { return hits.holes; });
      add("through", [](const HitCounts& hits) { return hits.seen_through; });
    } else {
      add("leak", [](const HitCounts& hits) { return hits.leaks(); });
    }
    add("false", [](const HitCounts& hits) { return hits.false_hits; });
    add(
        "wrong", [](const HitCounts& hits) { return hits.wrong_triangles; }, where.empty() ? 1 : 0);
  };
  add_shares("edge ", at_edges);
  add_shares("", of_pixels);
  fields.add_error({"", "ulp 50%", 0}, [](const Comparison& found) { return found.ulps.median; });
  fields.add_error({"", "99%", 0}, [](const Comparison& found) { return found.ulps.percentile_99; });
  fields.add_error({"", "max", 0}, [](const Comparison& found) { return found.ulps.greatest; });
  fields.add_error({"", "t 99%", -2}, [](const Comparison& found) { return found.relative.percentile_99; });
  fields.add_error({"", "PSNR", 1}, [](const Comparison& found) { return found.picture.psnr_db(); });
  fields.add_error({"", "pixel"}, [](const Comparison& found) { return found.picture.greatest_pixel_error; });
  return fields.table("", [view](const Price& price) { return price.view == view; });
}

void write_overview(const PriceList& list, Book& book) {
  Table table = make_table("overview", "configuration", "profile");
  struct Time {
    const char *key, *title;
    RunOf run;
  };
  const Time times[] = {{"mean_mcycles", "Mcycles", &PriceList::frame},
                        {"with_distances_mean_mcycles", "with t", &PriceList::with_distances},
                        {"starved_mean_mcycles", "starved", &PriceList::on_starved}};
  struct Worst {
    Column column;
    double (*value)(const Price&);  ///< of a price that has errors
    bool least = false;             ///< less is worse
  };
  const Worst worsts[] = {
      {{"most_edge_holes_per_million", "edges: holes", 0},
       [](const Price& price) { return edges_per_million(price, &HitCounts::holes); }},
      {{"most_edge_seen_through_per_million", "through", 0},
       [](const Price& price) { return edges_per_million(price, &HitCounts::seen_through); }},
      {{"most_edge_false_hits_per_million", "false", 0},
       [](const Price& price) { return edges_per_million(price, &HitCounts::false_hits); }},
      {{"most_edge_wrong_triangles_per_million", "wrong", 0},
       [](const Price& price) { return edges_per_million(price, &HitCounts::wrong_triangles); }},
      {{"most_holes_per_million", "pixels: holes", 0},
       [](const Price& price) { return price.errors->hits.per_million(price.errors->hits.holes); }},
      {{"most_seen_through_per_million", "through", 0},
       [](const Price& price) { return price.errors->hits.per_million(price.errors->hits.seen_through); }},
      {{"most_false_hits_per_million", "false", 0},
       [](const Price& price) { return price.errors->hits.per_million(price.errors->hits.false_hits); }},
      {{"most_wrong_triangles_per_million", "wrong", 1},
       [](const Price& price) { return price.errors->hits.per_million(price.errors->hits.wrong_triangles); }},
      {{"most_t_ulp_median", "t: ulp, median", 0}, [](const Price& price) { return price.errors->ulps.median; }},
      {{"most_t_ulp_p99", "99 %", 0}, [](const Price& price) { return price.errors->ulps.percentile_99; }},
      {{"most_t_ulp_max", "most", 0}, [](const Price& price) { return price.errors->ulps.greatest; }},
      {{"most_t_relative_p99", "99 %, relative", -2},
       [](const Price& price) { return price.errors->relative.percentile_99; }},
      {{"least_psnr_db", "PSNR, dB", 1}, [](const Price& price) { return price.errors->picture.psnr_db(); }, true},
      {{"greatest_pixel_error", "colour", 0},
       [](const Price& price) { return static_cast<double>(price.errors->picture.greatest_pixel_error); }},
  };
  for (const Time& time : times) table.columns.push_back({time.key, time.title});
  for (const Worst& worst : worsts) table.columns.push_back(worst.column);
  for (std::size_t configuration = 0; configuration < std::size(kPricedConfigurations); ++configuration) {
    for (std::size_t profile = 0; profile < list.profiles().size(); ++profile) {
      if (!list.price(0, configuration, profile).is_possible()) continue;
      std::vector<Cell> row = {kPricedConfigurations[configuration], list.profiles()[profile].key};
      for (const Time& time : times) row.emplace_back(mean_mcycles(list, time.run, configuration, profile));
      for (const Worst& worst : worsts) {
        Range range;
        for (std::size_t view = 0; view < list.views().size(); ++view) {
          const Price& price = list.price(view, configuration, profile);
          if (price.errors) range.add(worst.value(price));
        }
        row.emplace_back(range.empty() ? std::nan("") : worst.least ? range.least() : range.greatest());
      }
      table.add(std::move(row));
    }
  }
  book.section("prices", "The price list");
  for (std::size_t profile = 0; profile < list.profiles().size(); ++profile) {
    const std::string lattice = lattice_words(list, profile);
    book.paragraph(list.profiles()[profile].key + ": " + list.profiles()[profile].words + "." +
                   (lattice.empty() ? "" : " " + lattice));
  }
  book.table(table,
             "Over all views: geometric means of the million cycles of a frame without distances, with them (with t), "
             "and without them on the starved machine; the errors of the worst view. Holes, what is seen through them, "
             "false hits and wrong triangles are of a million rays, those aimed at edges and those of the picture's "
             "pixels; PSNR is empty where no pixel differs in any view; colour: the greatest difference of a channel, "
             "of 255.");
  book.linked_table(all_prices(list), "every view, profile and configuration with every figure.");
  book.linked_table(histogram_table(list),
                    "pixels that show the true triangle by their error of t: a column holds those from its ulp up to "
                    "the next column's.");
}

void write_targets(const PriceList& list, Book& book) {
  Table table = make_table("targets", "configuration", "what", "from", "to",
                           Column("worst_percent", "change in the worst view, %", 1),
                           Column("limit_percent", "limit, %", 0), "met");
  book.section("targets", "What was asked for");
  for (const Target& target : price_targets(list)) {
    book.paragraph(target_words(list, target));
    table.add({target.configuration, target.what, target.from, target.to, target.worst_percent(), target.limit_percent,
               target.is_met() ? "yes" : "no"});
  }
  book.table(table, "Changes from one profile to another, and how far they may go.");
}

void write_steps(const PriceList& list, Book& book) {
  book.section("steps", "What each step buys, and what it costs");
  const std::pair<const char*, const char*> steps[] = {
      {"paper", "fast"}, {"fast", "standard"}, {"standard", "exact"}, {"standard", "compact"}};
  for (const auto& [from, to] : steps) {
    const auto base = list.find_profile(from), changed = list.find_profile(to);
    if (!base || !changed) continue;
    for (std::size_t configuration = 0; configuration < std::size(kPricedConfigurations); ++configuration) {
      if (!is_at_home(from, configuration)) continue;
      book.paragraph("From " + std::string(from) + " to " + to + ", configuration " +
                     kPricedConfigurations[configuration] + ". " + step_words(list, configuration, *base, *changed));
    }
  }
}

void write_fronts(const PriceList& list, Book& book) {
  Table table = make_table("pareto", "view", "error", "configuration", "profile", Column("mcycles", "Mcycles"),
                           Column("error_value", "error", 1), Column("on_front", "on the front"));
  book.section("fronts", "Error against time");
  book.paragraph(
      "Who is on a Pareto front is not beaten: no other profile, in any configuration, is as fast and as accurate "
      "and better in one of them. Three errors are shown: wrong pixels (a hole, a false hit or another triangle) and "
      "leaks of rays aimed at edges (a hole, or something farther away seen through it), both against the time of a "
      "frame that gives a picture alone, and the error of t against that of a frame that gives distances too. Times "
      "are geometric means over the views, errors those of the worst view.");
  for (const Front& front : make_fronts()) {
    const std::vector<FrontPoint> over_all = front_points(list, front, std::nullopt);
    book.figure("pareto_" + front.key, front_svg(list, front, "all views", over_all),
                "All views: " + front.error + ", against " + front.time + ". " + front_words(list, over_all));
    const auto add_rows = [&](const std::string& view, const std::vector<FrontPoint>& points) {
      for (const FrontPoint& point : points) {
        if (!std::isfinite(point.point.x)) continue;
        table.add({view, front.error, kPricedConfigurations[point.configuration], list.profiles()[point.profile].key,
                   point.point.x, point.point.y, point.on_front ? "yes" : "no"});
      }
    };
    add_rows("all", over_all);
    for (std::size_t view = 0; view < list.views().size(); ++view) {
      add_rows(list.views()[view].title, front_points(list, front, view));
    }
  }
  book.linked_table(table, "every point of these plots and of those of each view.");
}

void write_starved(const PriceList& list, Book& book) {
  Fields fields(list);
  fields.add_names(true);
  fields.add_run({"mcycles", "Mcycles"}, &PriceList::on_starved, million_cycles);
  fields.add_run({"fps", "fps", 1}, &PriceList::on_starved, fps);
  fields.add_run({"wait_percent", "waiting, %", 1}, &PriceList::on_starved,
                 [](const RunResult& run) { return run.wait_percent(); });
  fields.add({"over_full", "times the cycles at full bandwidth"}, [&list](const Price& price) -> Cell {
    return ratio_of(list.on_starved(price).timing.frame_cycles, list.frame(price).timing.frame_cycles);
  });
  fields.add({"over_standard", "times those of standard"}, [&list](const Price& price) -> Cell {
    const Price& standard = list.price(price.view, price.configuration, *list.find_profile("standard"));
    return ratio_of(list.on_starved(price).timing.frame_cycles, list.on_starved(standard).timing.frame_cycles);
  });
  const Table table = fields.table("starved", [](const Price&) { return true; });
  const double gigabytes = list.starved().profile.channel_bytes_per_cycle * list.starved().profile.clock_hz / 1e9;
  book.section("starved", "Where memory is slow");
  book.paragraph("The same frames without distances, replayed on " + std::string(list.machine().profile.name) +
                 " with an eighth of its bandwidth: " + fixed_text(gigabytes, 2) + " GB/s for all cores together. " +
                 starved_words(list));
  book.table(table, "Frames without distances at an eighth of the bandwidth.");
}

void write_views(const PriceList& list, Book& book) {
  for (std::size_t view = 0; view < list.views().size(); ++view) {
    const View& shown = list.views()[view];
    const Table costs = view_costs(list, view), errors = view_errors(list, view, true);
    book.section("view_" + shown.key, shown.title);
    book.shown_table(
        costs,
        "Million cycles and frames a second without distances, million cycles with them (with t) and "
        "without them on the starved machine; MB moved by DMA, of these MB of triangles, MB of main memory "
        "and KB of local store, all without distances.");
    book.shown_table(
        errors,
        "Holes, rays that see through, false hits and wrong triangles of a million rays aimed at edges; the same of a "
        "million pixels; error of t where the true triangle is shown: median, 99th percentile and greatest in ulp, "
        "99th percentile as a share; PSNR in dB (empty where no pixel differs) and the greatest difference of a "
        "channel, of 255.");
    book.text(price_text_name(shown.key), aligned_text(costs) + "\n" + aligned_text(view_errors(list, view, false)),
              "both tables as plain text, leaks being holes and what is seen through.");
    for (std::size_t configuration = 0; configuration < std::size(kPricedConfigurations); ++configuration) {
      const std::string name = kPricedConfigurations[configuration];
      book.figure("errors_" + name + "_" + shown.key, histogram_svg(list, view, configuration),
                  shown.title + ", configuration " + name + ": pixels by the error of their t, next to their costs.");
    }
    for (const Front& front : make_fronts()) {
      const std::vector<FrontPoint> points = front_points(list, front, view);
      book.figure("pareto_" + front.key + "_" + shown.key, front_svg(list, front, shown.title, points),
                  shown.title + ": " + front.error + ", against " + front.time + ". " + front_words(list, points));
    }
  }
}

void write_host_prices(const PriceList& list, Book& book) {
  constexpr std::uint32_t kRepeats = 3;
  Table table = make_table("host_prices", "view", "configuration", "profile", "lanes", "frame_ms", "frame_processor_ms",
                           "with_distances_ms", "with_distances_processor_ms");
  for (const Price& price : list.prices()) {
    tool::stop_if_interrupted();
    if (list.frame(price).failed()) continue;
    std::vector<Cell> row = {list.views()[price.view].title, kPricedConfigurations[price.configuration],
                             list.profiles()[price.profile].key, sim::widest_lanes()};
    for (const bool depth : {false, true}) {
      GridVariant variant = price.variant;
      variant.depth = depth;
      const HostFrame frame = render_on_host(variant, list.views()[price.view], list.request(), 1, kRepeats);
      row.emplace_back(frame.seconds.wall * 1e3);
      row.emplace_back(frame.seconds.processor * 1e3);
    }
    table.add(std::move(row));
  }
  book.section("host", "This host");
  book.paragraph(
      "The same kernel directly on this host, without checks or a simulated clock, on one thread and in the widest "
      "SIMD groups that the host has. Those are times of one machine, whatever else it was doing: they are kept in a "
      "file whose name begins with host_, which alone differs from run to run, and are not repeated on this page.");
  book.linked_table(table, "milliseconds of a frame, the least of three, by the wall clock and of its processor.");
}

}  // namespace gridiron::experiment
