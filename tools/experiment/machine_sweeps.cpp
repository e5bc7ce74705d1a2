// Sweeps of the machine: latency and bandwidth of main memory. The work of grid and tree stays the same; only the
// replay changes. SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <functional>
#include <utility>

#include "experiment/sections.h"
#include "report/svg_plot.h"

namespace gridiron::experiment {
using namespace plot;
namespace {

constexpr double kLatencies[] = {100, 200, 300, 400, 500, 750, 1000, 1500, 2000};
/// Factors on the built-in channel: from a sixteenth of the paper's bandwidth to twice as much.
constexpr double kBandwidthFactors[] = {0.0625, 0.125, 0.25, 0.5, 1, 2};
constexpr std::uint32_t kManyCores = 16;

/// A way of hiding latency, or none.
struct Curve {
  std::string key, title;
  std::shared_ptr<const System> system;
};

std::vector<Curve> make_curves(const Stage& stage) {
  const Contender& first = stage.contenders.front();
  std::vector<Curve> curves = {{first.key + "_single", first.title + ", single", first.unhidden}};
  for (const Contender& contender : stage.contenders)
    curves.push_back({contender.key, contender.title, contender.system});
  return curves;
}

/// One view on one machine.
struct Point {
  const View* view;
  double value;
  std::uint32_t cores;
  std::vector<Plan::RunId> runs;  ///< by curve
};

Table point_table(const Plan& done, const std::vector<Curve>& curves, const std::vector<Point>& points,
                  const std::string& name, Column parameter) {
  Table table = make_table(name, "view", "cores", std::move(parameter));
  for (const Curve& curve : curves) {
    table.columns.push_back({curve.key + "_fps", curve.title + ": fps", 2});
    table.columns.push_back({curve.key + "_wait_percent", "wait, %", 1});
  }
  for (const Point& point : points) {
    std::vector<Cell> row = {point.view->title, point.cores, point.value};
    for (const Plan::RunId run : point.runs) {
      row.emplace_back(done.result(run).fps());
      row.emplace_back(done.result(run).wait_percent());
    }
    table.add(std::move(row));
  }
  return table;
}

template <class Value>
std::string point_chart(const Plan& done, const std::vector<Curve>& curves, const std::vector<Point>& points,
                        const View& view, std::uint32_t cores, LineChart chart, Value value) {
  for (std::size_t c = 0; c < curves.size(); ++c) {
    Series series{curves[c].title, {}, false};
    for (const Point& point : points) {
      if (point.view == &view && point.cores == cores) {
        series.points.push_back({point.value, std::invoke(value, done.result(point.runs[c]))});
      }
    }
    chart.series.push_back(std::move(series));
  }
  return line_chart_svg(chart);
}

// Explains the hierarchy's short waits.
std::string ring_words(const Plan& done, const std::vector<std::pair<Plan::RunId, Plan::RunId>>& turns) {
  Range node_misses, triangle_misses, alone, in_turn;
  for (const auto& [single, ring] : turns) {
    const RunResult& run = done.result(single);
    if (run.caches) node_misses.add(100 - run.caches->node_hit_percent);
    if (run.caches) triangle_misses.add(100 - run.caches->triangle_hit_percent);
    alone.add(run.wait_percent());
    in_turn.add(done.result(ring).wait_percent());
  }
  std::string words =
      "Of the hierarchy's look-ups " + node_misses.percent(1) + " of nodes and " + triangle_misses.percent(1) +
      " of triangles miss its caches. On six cores at 500 cycles, over all views, it waits for " + alone.percent(1) +
      " of its cycles with one packet at a time and for " + in_turn.percent(1) + " with its ring of packets";
  return words + (alone.least() > in_turn.greatest() ? ": the ring is what hides its misses." : ".");
}

// Prefetch with little bandwidth: the first curve is the reference without it, the second with it.
std::string scarce_words(const Plan& done, const Stage& stage, const std::vector<Point>& points) {
  double least = points.front().value;
  for (const Point& point : points) least = std::min(least, point.value);
  Range fps, bytes;
  for (const Point& point : points) {
    if (point.value != least || point.cores != kPaperCores) continue;
    const RunResult &single = done.result(point.runs[0]), &hidden = done.result(point.runs[1]);
    fps.add(ratio_of(hidden.fps(), single.fps()));
    bytes.add(ratio_of(static_cast<double>(hidden.bytes_in()), static_cast<double>(single.bytes_in())));
  }
  return "At " + fixed_text(least, 2) + " GB/s and on six cores double buffering, which fetches " + bytes.text(2) +
         " times the bytes, gives the " + stage.contenders.front().title + " " + fps.text(2) +
         " times the frames of single buffering" +
         (fps.least() < 1 ? ": what is fetched in vain then costs more than the hidden latency brings." : ".");
}

}  // namespace

Machine machine_with_latency(const Machine& machine, double cycles) {
  Machine changed = machine;
  changed.key += "/latency=" + number_text(cycles);
  changed.profile.latency_cycles = cycles;
  return changed;
}

Writer plan_machine_sweeps(Plan& plan, const Stage& stage) {
  const std::vector<Curve> curves = make_curves(stage);
  const auto plan_points = [&](std::span<const double> values, auto change,
                               std::initializer_list<std::uint32_t> core_counts) {
    std::vector<Point> points;
    for (const View* view : stage.sweep_views) {
      for (const std::uint32_t cores : core_counts) {
        for (const double value : values) {
          Machine machine = stage.machine;
          Point point{view, change(machine, value), cores, {}};
          for (const Curve& curve : curves) {
            point.runs.push_back(plan.add(*view, curve.system, Shading::kNone, machine, cores));
          }
          points.push_back(std::move(point));
        }
      }
    }
    return points;
  };
  const auto latencies = plan_points(kLatencies,
                                     [](Machine& machine, double value) {
                                       machine = machine_with_latency(machine, value);
                                       return value;
                                     },
                                     {1, kPaperCores});
  const auto bandwidths = plan_points(kBandwidthFactors,
                                      [](Machine& machine, double factor) {
                                        machine.profile.channel_bytes_per_cycle *= factor;
                                        const double gigabytes =
                                            machine.profile.channel_bytes_per_cycle * machine.profile.clock_hz / 1e9;
                                        machine.key += "/gigabytes=" + number_text(gigabytes);
                                        return gigabytes;
                                      },
                                      {kPaperCores, kManyCores});
  const Contender& bvh = contender_named(stage, "bvh");
  std::vector<std::pair<Plan::RunId, Plan::RunId>> turns;  // without and with a ring of packets
  for (const View& view : stage.views()) {
    turns.emplace_back(plan.add(view, bvh.unhidden, Shading::kNone, stage.machine, kPaperCores),
                       plan.add(view, bvh.system, Shading::kNone, stage.machine, kPaperCores));
  }
  return [&stage, curves, latencies, bandwidths, turns](const Plan& done, Book& book) {
    const auto draw = [&](const std::string& name, const std::vector<Point>& points, std::uint32_t cores,
                          const LineChart& chart, auto value, const std::string& words) {
      for (const View* view : stage.sweep_views) {
        LineChart titled = chart;
        titled.title += ", " + view->title;
        book.figure(name + "_" + view->key, point_chart(done, curves, points, *view, cores, titled, value),
                    view->title + ": " + words);
      }
    };
    book.section("latency", "Sweep: memory latency");
    book.paragraph(
        "Cycles from the end of a line's turn on the memory channel to its arrival. The profile assumes 500; what is "
        "published is \"several hundred\", and the paper's machine may well have had more or less. A recorded "
        "frame of grid or tree is the same at every point, only the replay changes; the hierarchy is rendered anew. "
        "Without hiding "
        "every cycle of latency is waited for; double buffering hides a transfer only as long as the work beside it "
        "lasts, and more buffers, as configuration grid has them, move that limit out. " +
        ring_words(done, turns));
    draw("sweep_latency", latencies, kPaperCores,
         {.title = "Latency", .x_title = "latency, cycles", .y_title = "waiting, % of core cycles"},
         &RunResult::wait_percent, "share of waiting against latency, 6 cores, no shading.");
    book.table(point_table(done, curves, latencies, "sweep_latency", {"latency_cycles", "latency, cycles", 0}),
               "Latency of main memory.");

    book.section("bandwidth", "Sweep: memory bandwidth");
    book.paragraph(
        "Bandwidth that all cores share, usable part (23 GB/s in the profile, 90 % of the published 25.6), on six and "
        "on sixteen cores. Where halving it changes nothing the frame is bound by work or latency; where fps halves "
        "with it the channel is full, and only fetching fewer bytes helps. " +
        scarce_words(done, stage, bandwidths));
    draw("sweep_bandwidth", bandwidths, kManyCores,
         {.title = "Bandwidth", .x_title = "GB/s, shared", .y_title = "frames a second", .log_x = true},
         &RunResult::fps, "frames a second against bandwidth, 16 cores, no shading.");
    book.table(point_table(done, curves, bandwidths, "sweep_bandwidth", {"gigabytes_per_second", "GB/s", 2}),
               "Bandwidth of main memory.");
  };
}

}  // namespace gridiron::experiment
