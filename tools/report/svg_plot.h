// SVG plots: line charts and stacked or grouped bars as text, with axes, ticks and legend.
// Memory: std::string. Threads: any, no shared state. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace gridiron::plot {

struct Point2 {
  double x = 0, y = 0;
};

/// Area of the plot inside the picture, in SVG units; y grows downwards.
struct PlotArea {
  double left = 72, top = 44, right = 700, bottom = 352;
};
inline constexpr double kPlotWidth = 720, kPlotHeight = 470;

/// What a line chart shows clearly: its legend grows, and so does the picture, but a name has one row.
inline constexpr std::size_t kMostSeries = 16, kMostNameLetters = 80;

/// One axis: its end values, and their positions in the picture.
struct Axis {
  double low = 0, high = 1;   ///< values; 0 < low on a logarithmic axis
  double begin = 0, end = 1;  ///< places of low and high
  bool logarithmic = false;

  [[nodiscard]] double place(double value) const;
};

/// @returns rising round values from `low` to `high`, at most about `most`: 1, 2 or 5 times a power of ten apart; on a
/// logarithmic axis the powers themselves, with 2 and 5 between if they are few.
[[nodiscard]] std::vector<double> tick_values(double low, double high, bool logarithmic, std::size_t most = 8);

/// @returns "0.5", "20", "10k", "1M": a tick's label.
[[nodiscard]] std::string tick_text(double value);

struct Series {
  std::string name;
  std::vector<Point2> points;
  bool dashed = false;  ///< a projection or a limit: thin, without markers
};

struct LineChart {
  std::string title, x_title, y_title;
  std::vector<Series> series{};
  bool log_x = false, log_y = false;  ///< linear axes start at 0
  bool zoom_y = false;                ///< the linear y axis spans its values instead
  std::vector<double> x_ticks{};      ///< empty: chosen
};

/// Bars in groups; a bar is a stack of parts.
struct BarChart {
  std::string title, y_title;
  std::vector<std::string> groups{};  ///< along the axis
  std::vector<std::string> bars{};  ///< of each group, side by side; named under them where there is more than one part
  std::vector<std::string> parts;   ///< of each bar, from the axis upwards; one part: bars have the colours
  std::vector<double> values{};     ///< [group][bar][part], not negative; NaN: no bar
  bool labels = false;              ///< the bar's height in figures above it, where bars are wide enough
};

/// Single points: the amount of one quantity against another.
struct ScatterChart {
  struct Point {
    double x = 0, y = 0;
    std::string name;       ///< shown where the pointer rests
    std::size_t color = 0;  ///< index into `colors`
    std::size_t style = 0;  ///< index into `styles`
    bool ringed = false;
  };
  std::string title, x_title, y_title;
  std::vector<std::string> colors;    ///< what each colour stands for
  std::vector<std::string> styles{};  ///< what filled, hollow and outlined points stand for, up to three
  std::string ring;                   ///< of the legend; an empty one has no entry
  std::vector<Point> points;
};

/// Rows, each with a histogram on the left and bars of a cost on the right.
struct HistogramChart {
  struct Row {
    std::string name;
    std::vector<double> counts;  ///< by bin
    std::vector<double> costs;   ///< by part, one bar below the other; NaN: no bar
  };
  std::string title, bin_title, cost_title;
  std::vector<std::string> bins;   ///< names
  std::size_t separate_bins = 0;   ///< number of last bins that are drawn apart, with upright names
  std::vector<std::string> parts;  ///< of the cost
  std::vector<Row> rows;
};

/// @returns a whole SVG document, both axes logarithmic; a y of 0 has a lane of its own below. Points that cannot be
/// shown are left out; ringed points are joined in the order of x.
[[nodiscard]] std::string scatter_chart_svg(const ScatterChart& chart);

/// @returns a whole SVG document. Counts are drawn by their logarithms, costs from 0. Precondition: each row has a
/// count for each bin and a cost for each part.
[[nodiscard]] std::string histogram_chart_svg(const HistogramChart& chart);

/// @returns a whole SVG document. Points that the axes cannot show are left out. There are eight colours; the curves
/// behind the eighth have them again, broken.
[[nodiscard]] std::string line_chart_svg(const LineChart& chart);

/// @returns a whole SVG document. Precondition: values has groups x bars x parts elements.
[[nodiscard]] std::string bar_chart_svg(const BarChart& chart);

/// @returns the text with &, <, > and quotes as entities.
[[nodiscard]] std::string escape_markup(std::string_view text);

}  // namespace gridiron::plot
