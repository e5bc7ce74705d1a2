// Sweeps of the machine: latency and bandwidth of main memory. The grid's work stays the same; only the replay changes.
// SPDX-License-Identifier: Apache-2.0
#include "experiment/sections.h"
#include "experiment/svg_plot.h"

namespace gridiron::experiment {
namespace {

constexpr double kLatencies[] = {100, 200, 300, 400, 500, 750, 1000, 1500, 2000};
/// Of the built-in channel: a sixteenth of the paper's bandwidth to twice as much.
constexpr double kBandwidthFactors[] = {0.0625, 0.125, 0.25, 0.5, 1, 2};
constexpr std::uint32_t kManyCores = 16;

/// A way of hiding latency, or of not hiding it.
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
  Table table{name, {{"view", "view"}, {"cores", "cores"}, std::move(parameter)}, {}};
  for (const Curve& curve : curves) {
    table.columns.push_back({curve.key + "_fps", curve.title + ": fps", 2});
    table.columns.push_back({curve.key + "_wait_percent", "wait, %", 1});
  }
  for (const Point& point : points) {
    std::vector<Cell> row = {point.view->title, std::uint64_t{point.cores}, point.value};
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
        series.points.push_back({point.value, value(done.result(point.runs[c]))});
      }
    }
    chart.series.push_back(std::move(series));
  }
  return line_chart_svg(chart);
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
  return [&stage, curves, latencies, bandwidths](const Plan& done, Book& book) {
    book.section("latency", "Sweep: memory latency");
    book.paragraph(
        "Cycles from a line's turn on the memory channel to its arrival. The profile assumes 500, which no document "
        "that we have states; the paper's machine may well have had more or less. The grid's recorded frame is the "
        "same at every point, only the replay changes; the hierarchy is rendered anew. Without hiding every cycle of "
        "latency is waited for; double buffering "
        "hides a transfer only as long as the work beside it lasts, and deep prefetch moves that limit out. "
        "The hierarchy waits little because its caches seldom miss.");
    for (const View* view : stage.sweep_views) {
      book.figure("sweep_latency_" + view->key,
                  point_chart(done, curves, latencies, *view, kPaperCores,
                              {.title = "Latency, " + view->title,
                               .x_title = "latency, cycles",
                               .y_title = "waiting, % of core cycles",
                               .series = {},
                               .log_x = false,
                               .log_y = false,
                               .x_ticks = {}},
                              [](const RunResult& run) { return run.wait_percent(); }),
                  view->title + ": share of waiting against latency, 6 cores, no shading.");
    }
    book.table(point_table(done, curves, latencies, "sweep_latency", {"latency_cycles", "latency, cycles", 0}),
               "Latency of main memory.");

    book.section("bandwidth", "Sweep: memory bandwidth");
    book.paragraph(
        "Bandwidth that all cores share, usable part (23 GB/s in the profile, 90 % of the published 25.6), on six and "
        "on sixteen cores. Where halving it changes nothing the frame is bound by work or latency; where fps halves "
        "with it the channel is full, and only fetching fewer bytes helps.");
    for (const View* view : stage.sweep_views) {
      book.figure("sweep_bandwidth_" + view->key,
                  point_chart(done, curves, bandwidths, *view, kManyCores,
                              {.title = "Bandwidth, " + view->title,
                               .x_title = "GB/s, shared",
                               .y_title = "frames a second",
                               .series = {},
                               .log_x = true,
                               .log_y = false,
                               .x_ticks = {}},
                              [](const RunResult& run) { return run.fps(); }),
                  view->title + ": frames a second against bandwidth, 16 cores, no shading.");
    }
    book.table(point_table(done, curves, bandwidths, "sweep_bandwidth", {"gigabytes_per_second", "GB/s", 2}),
               "Bandwidth of main memory.");
  };
}

}  // namespace gridiron::experiment
