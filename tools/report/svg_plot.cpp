// SVG plots. SPDX-License-Identifier: Apache-2.0
#include "report/svg_plot.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <utility>

#include "base/numbers.h"

namespace gridiron::plot {
namespace {

// Okabe and Ito's colours, which remain distinct with red-green colour blindness.
constexpr std::array<std::string_view, 8> kColors = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                                     "#e69f00", "#56b4e9", "#6b6b6b", "#b3a400"};

std::string_view color_of(std::size_t index) {
  return kColors[index % kColors.size()];
}

std::string number_text(double number) {
  return std::isfinite(number) ? tool::shortest_text(number) : "";
}

std::string fixed_text(double number, int decimals) {
  std::array<char, 400> text{};
  const auto [end, error] =
      std::to_chars(text.data(), text.data() + text.size(), number, std::chars_format::fixed, decimals);
  std::string fixed = error == std::errc{} && std::isfinite(number) ? std::string(text.data(), end) : "";
  // No sign for a rounded zero.
  if (!fixed.empty() && fixed.front() == '-' && fixed.find_first_not_of("-0.") == std::string::npos) fixed.erase(0, 1);
  return fixed;
}

std::string units(double place) {
  return fixed_text(place, 2);
}

// Builds an SVG document.
class Drawing {
 public:
  explicit Drawing(std::string_view title, double height = kPlotHeight) {
    text_ = "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + number_text(kPlotWidth) + " " +
            number_text(height) + "\" role=\"img\" font-family=\"system-ui, sans-serif\" font-size=\"13\">\n";
    text_ += "<title>" + escape_markup(title) + "</title>\n";
    text_ +=
        "<rect width=\"" + number_text(kPlotWidth) + "\" height=\"" + number_text(height) + "\" fill=\"#ffffff\"/>\n";
    write(kPlotWidth / 2, 24, title, "middle", "font-size=\"16\" fill=\"#222222\"");
  }

  void line(double x0, double y0, double x1, double y1, std::string_view style) {
    text_ += "<line x1=\"" + units(x0) + "\" y1=\"" + units(y0) + "\" x2=\"" + units(x1) + "\" y2=\"" + units(y1) +
             "\" " + std::string(style) + "/>\n";
  }

  void write(double x, double y, std::string_view words, std::string_view anchor, std::string_view style) {
    text_ += "<text x=\"" + units(x) + "\" y=\"" + units(y) + "\" text-anchor=\"" + std::string(anchor) + "\" " +
             std::string(style) + ">" + escape_markup(words) + "</text>\n";
  }

  void bar(double x, double y, double width, double height, std::string_view color, std::string_view words) {
    text_ += "<rect x=\"" + units(x) + "\" y=\"" + units(y) + "\" width=\"" + units(width) + "\" height=\"" +
             units(height) + "\" fill=\"" + std::string(color) + "\"><title>" + escape_markup(words) +
             "</title></rect>\n";
  }

  void curve(const std::vector<Point2>& places, std::string_view style) {
    text_ += "<polyline fill=\"none\" points=\"";
    for (std::size_t i = 0; i < places.size(); ++i) {
      if (i > 0) text_ += ' ';
      text_ += units(places[i].x);
      text_ += ',';
      text_ += units(places[i].y);
    }
    text_ += "\" " + std::string(style) + "/>\n";
  }

  void dot(const Point2& place, std::string_view color, std::string_view words) {
    text_ += "<circle cx=\"" + units(place.x) + "\" cy=\"" + units(place.y) + "\" r=\"3.2\" fill=\"" +
             std::string(color) + "\"><title>" + escape_markup(words) + "</title></circle>\n";
  }

  void circle(const Point2& place, double radius, std::string_view style, std::string_view words) {
    text_ += "<circle cx=\"" + units(place.x) + "\" cy=\"" + units(place.y) + "\" r=\"" + units(radius) + "\" " +
             std::string(style) + "><title>" + escape_markup(words) + "</title></circle>\n";
  }

  [[nodiscard]] std::string finish() { return text_ + "</svg>\n"; }

 private:
  std::string text_;
};

constexpr std::string_view kLabel = "fill=\"#444444\"";
constexpr std::string_view kFrame = "stroke=\"#444444\" stroke-width=\"1\"";
constexpr std::string_view kGridLine = "stroke=\"#dddddd\" stroke-width=\"1\"";

void draw_y_axis(Drawing& drawing, const PlotArea& area, const Axis& y, std::string_view title) {
  for (const double value : tick_values(y.low, y.high, y.logarithmic)) {
    const double place = y.place(value);
    drawing.line(area.left, place, area.right, place, kGridLine);
    drawing.write(area.left - 8, place + 4.5, tick_text(value), "end", kLabel);
  }
  const double middle = (area.top + area.bottom) / 2;
  drawing.write(18, middle, title, "middle", "fill=\"#444444\" transform=\"rotate(-90 18 " + units(middle) + ")\"");
}

// Names and colours in rows below the plot.
enum class Mark : std::uint8_t { kLine, kBrokenLine, kDashes, kDot, kHollowDot, kOutlinedDot, kRing };

struct LegendEntry {
  std::string name;
  std::string_view color;
  Mark mark = Mark::kLine;
};

constexpr double kRingRadius = 9;

// By the index of ScatterChart's styles.
constexpr Mark kDotMarks[] = {Mark::kDot, Mark::kHollowDot, Mark::kOutlinedDot};

std::string dot_style(std::string_view color, Mark mark) {
  const std::string own(color);
  if (mark == Mark::kHollowDot) return "fill=\"#ffffff\" stroke=\"" + own + "\" stroke-width=\"2\"";
  return "fill=\"" + own + "\"" + (mark == Mark::kOutlinedDot ? " stroke=\"#000000\" stroke-width=\"1.6\"" : "");
}

constexpr std::string_view kRingStyle = "fill=\"none\" stroke=\"#444444\" stroke-width=\"1.3\"";

constexpr std::string_view kBroken = " stroke-dasharray=\"7 3\"";

// Where the entries are, in rows.
std::vector<Point2> legend_places(const PlotArea& area, const std::vector<LegendEntry>& entries) {
  std::vector<Point2> places;
  double x = area.left;
  double y = area.bottom + 66;
  for (const LegendEntry& entry : entries) {
    const double width = 34 + 7.2 * static_cast<double>(entry.name.size());
    if (x > area.left && x + width > kPlotWidth) {
      x = area.left;
      y += 20;
    }
    places.push_back({x, y});
    x += width + 8;
  }
  return places;
}

void draw_legend(Drawing& drawing, const PlotArea& area, const std::vector<LegendEntry>& entries) {
  const std::vector<Point2> places = legend_places(area, entries);
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const LegendEntry& entry = entries[i];
    const auto [x, y] = places[i];
    const bool dashed = entry.mark == Mark::kDashes, broken = entry.mark == Mark::kBrokenLine;
    if (dashed || broken || entry.mark == Mark::kLine) {
      const std::string dash(dashed ? " stroke-dasharray=\"5 4\"" : broken ? kBroken : "");
      drawing.line(
          x, y - 4.5, x + 18, y - 4.5,
          "stroke=\"" + std::string(entry.color) + "\" stroke-width=\"" + (dashed ? "1.5" : "4") + "\"" + dash);
    } else {
      const bool ring = entry.mark == Mark::kRing;
      drawing.circle({x + 9, y - 4.5}, ring ? kRingRadius - 2 : 5,
                     ring ? std::string(kRingStyle) : dot_style(entry.color, entry.mark), entry.name);
    }
    drawing.write(x + 24, y, entry.name, "start", kLabel);
  }
}

// A linear axis starts at 0 and ends at the first tick step above the greatest value; a logarithmic one spans them.
Axis fit_axis(double least, double greatest, bool logarithmic, double begin, double end) {
  Axis axis{.low = 0, .high = 1, .begin = begin, .end = end, .logarithmic = logarithmic};
  if (logarithmic) {
    axis.low = least > 0 ? least : 1;
    axis.high = std::max(greatest, axis.low * 1.0001);
    const double margin = std::pow(axis.high / axis.low, 0.04);
    axis.low /= margin;
    axis.high *= margin;
  } else if (greatest > 0) {
    axis.high = greatest;
    const std::vector<double> ticks = tick_values(0, greatest, false);
    const double step = ticks.size() > 1 ? ticks[1] - ticks[0] : greatest;
    axis.high = std::ceil(greatest / step - 1e-9) * step;
  }
  return axis;
}

// A linear axis from the tick step below the least value to the one above the greatest.
Axis span_axis(double least, double greatest, double begin, double end) {
  const std::vector<double> ticks = tick_values(least, greatest, false);
  const double step = ticks.size() > 1 ? ticks[1] - ticks[0] : greatest - least;
  return {.low = std::floor(least / step + 1e-9) * step,
          .high = std::ceil(greatest / step - 1e-9) * step,
          .begin = begin,
          .end = end,
          .logarithmic = false};
}

void draw_x_axis(Drawing& drawing, const PlotArea& area, const Axis& x, const std::vector<double>& ticks,
                 std::string_view title) {
  for (const double value : ticks) {
    const double place = x.place(value);
    drawing.line(place, area.bottom, place, area.bottom + 5, kFrame);
    drawing.write(place, area.bottom + 20, tick_text(value), "middle", kLabel);
  }
  drawing.write((area.left + area.right) / 2, area.bottom + 42, title, "middle", kLabel);
  drawing.line(area.left, area.bottom, area.right, area.bottom, kFrame);
  drawing.line(area.left, area.top, area.left, area.bottom, kFrame);
}

bool can_show(double value, bool logarithmic) {
  return std::isfinite(value) && (logarithmic ? value > 0 : value >= 0);
}

}  // namespace

double Axis::place(double value) const {
  const double share = logarithmic ? std::log(value / low) / std::log(high / low) : (value - low) / (high - low);
  return begin + share * (end - begin);
}

std::vector<double> tick_values(double low, double high, bool logarithmic, std::size_t most) {
  std::vector<double> ticks;
  if (!(high > low) || !std::isfinite(low) || !std::isfinite(high)) return ticks;
  const int least_power = static_cast<int>(std::floor(std::log10(logarithmic ? low : high - low))) - 1;
  if (logarithmic) {
    const double decades = std::log10(high / low);
    for (int power = least_power; power <= least_power + static_cast<int>(decades) + 3; ++power) {
      for (const int digit : {1, 2, 5}) {
        if (digit != 1 && decades > 3) continue;
        const double value = digit * std::pow(10.0, power);
        if (value >= low * (1 - 1e-9) && value <= high * (1 + 1e-9)) ticks.push_back(value);
      }
    }
    return ticks;
  }
  // The finest of 1, 2, 5 times a power of ten that makes no more than `most` ticks.
  double step = 0;
  for (int power = least_power; step == 0; ++power) {
    for (const int digit : {1, 2, 5}) {
      const double candidate = digit * std::pow(10.0, power);
      if ((high - low) / candidate + 1 <= static_cast<double>(most)) {
        step = candidate;
        break;
      }
    }
  }
  const double first = std::ceil(low / step - 1e-9);
  for (double i = first; i * step <= high + 1e-9 * step; ++i) ticks.push_back(i * step + 0.0);  // no negative zero
  return ticks;
}

std::string tick_text(double value) {
  struct Unit {
    double factor;
    const char* name;
  };
  for (const Unit unit : {Unit{1e9, "G"}, Unit{1e6, "M"}, Unit{1e3, "k"}}) {
    if (value >= unit.factor * (1 - 1e-9) && (unit.factor > 1e3 || value >= 1e4 * (1 - 1e-9))) {
      return number_text(std::round(value / unit.factor * 1e6) / 1e6) + unit.name;
    }
  }
  return number_text(std::round(value * 1e6) / 1e6);
}

std::string escape_markup(std::string_view text) {
  static constexpr std::pair<char, std::string_view> kEscapes[] = {
      {'&', "&amp;"}, {'<', "&lt;"}, {'>', "&gt;"}, {'"', "&quot;"}};
  std::string escaped;
  for (const char letter : text) {
    const auto* const found = std::ranges::find(kEscapes, letter, &std::pair<char, std::string_view>::first);
    escaped += found != std::end(kEscapes) ? found->second : std::string_view(&letter, 1);
  }
  return escaped;
}

std::string line_chart_svg(const LineChart& chart) {
  const PlotArea area;
  // 1. The axes contain every point that can be shown.
  double x_least = HUGE_VAL, x_greatest = 0, y_least = HUGE_VAL, y_greatest = 0;
  const auto shown = [&chart](const Point2& point) {
    return can_show(point.x, chart.log_x) && can_show(point.y, chart.log_y);
  };
  for (const Series& series : chart.series) {
    for (const Point2& point : series.points) {
      if (!shown(point)) continue;
      x_least = std::min(x_least, point.x);
      x_greatest = std::max(x_greatest, point.x);
      y_least = std::min(y_least, point.y);
      y_greatest = std::max(y_greatest, point.y);
    }
  }
  Axis x = fit_axis(x_least, x_greatest, chart.log_x, area.left, area.right);
  if (!chart.x_ticks.empty() && !chart.log_x) x.high = std::max(x_greatest, chart.x_ticks.back());
  const Axis y = chart.zoom_y && !chart.log_y && y_greatest > y_least
                     ? span_axis(y_least, y_greatest, area.bottom, area.top)
                     : fit_axis(y_least, y_greatest, chart.log_y, area.bottom, area.top);

  // 2. The legend decides the height. Dashed curves are grey, the others take the colours in turn.
  std::vector<LegendEntry> legend;
  std::size_t color_count = 0;
  for (const Series& series : chart.series) {
    const Mark line = color_count < kColors.size() ? Mark::kLine : Mark::kBrokenLine;
    legend.push_back(
        {series.name, series.dashed ? "#888888" : color_of(color_count++), series.dashed ? Mark::kDashes : line});
  }
  constexpr double kBelowLegend = 12;
  const double legend_end = legend.empty() ? 0 : legend_places(area, legend).back().y + kBelowLegend;

  // 3. Axes, ticks, titles.
  Drawing drawing(chart.title, std::max(kPlotHeight, legend_end));
  draw_y_axis(drawing, area, y, chart.y_title);
  const std::vector<double> ticks = chart.x_ticks.empty() ? tick_values(x.low, x.high, x.logarithmic) : chart.x_ticks;
  draw_x_axis(drawing, area, x, ticks, chart.x_title);

  // 4. Curves.
  for (std::size_t i = 0; i < chart.series.size(); ++i) {
    const Series& series = chart.series[i];
    const std::string_view color = legend[i].color;
    std::vector<Point2> places;
    for (const Point2& point : series.points) {
      if (shown(point)) places.push_back({x.place(point.x), y.place(point.y)});
    }
    const std::string stroke = "stroke=\"" + std::string(color) + "\" ";
    drawing.curve(places, stroke +
                              (series.dashed ? "stroke-width=\"1.5\" stroke-dasharray=\"5 4\""
                                             : "stroke-width=\"2.2\" stroke-linejoin=\"round\"") +
                              std::string(legend[i].mark == Mark::kBrokenLine ? kBroken : ""));
    if (!series.dashed) {
      for (const Point2& point : series.points) {
        if (!shown(point)) continue;
        drawing.dot({x.place(point.x), y.place(point.y)}, color,
                    series.name + ": " + number_text(point.x) + ", " + number_text(point.y));
      }
    }
  }
  draw_legend(drawing, area, legend);
  return drawing.finish();
}

std::string bar_chart_svg(const BarChart& chart) {
  const PlotArea area;
  const std::size_t bar_count = chart.bars.size(), part_count = chart.parts.size();
  const bool stacked = part_count > 1;
  const auto value_of = [&](std::size_t group, std::size_t bar, std::size_t part) {
    return chart.values[(group * bar_count + bar) * part_count + part];
  };
  const auto height_of = [&](std::size_t group, std::size_t bar) {
    double height = 0;
    for (std::size_t part = 0; part < part_count; ++part) height += value_of(group, bar, part);
    return height;
  };
  double greatest = 0;
  for (std::size_t group = 0; group < chart.groups.size(); ++group) {
    for (std::size_t bar = 0; bar < bar_count; ++bar) {
      if (can_show(height_of(group, bar), false)) greatest = std::max(greatest, height_of(group, bar));
    }
  }
  const Axis y = fit_axis(0, greatest, false, area.bottom, area.top);

  Drawing drawing(chart.title);
  draw_y_axis(drawing, area, y, chart.y_title);
  const double group_width =
      (area.right - area.left) / static_cast<double>(std::max<std::size_t>(1, chart.groups.size()));
  const double bar_width = group_width * 0.8 / static_cast<double>(std::max<std::size_t>(1, bar_count));
  for (std::size_t group = 0; group < chart.groups.size(); ++group) {
    const double group_left = area.left + group_width * static_cast<double>(group);
    for (std::size_t bar = 0; bar < bar_count; ++bar) {
      const double left = group_left + group_width * 0.1 + bar_width * static_cast<double>(bar);
      if (!can_show(height_of(group, bar), false)) continue;
      double below = 0;
      for (std::size_t part = 0; part < part_count; ++part) {
        const double value = value_of(group, bar, part);
        const double top = y.place(below + value);
        drawing.bar(left + bar_width * 0.06, top, bar_width * 0.88, y.place(below) - top,
                    color_of(stacked ? part : bar),
                    chart.groups[group] + ", " + chart.bars[bar] + (stacked ? ", " + chart.parts[part] : "") + ": " +
                        number_text(value));
        below += value;
      }
      if (chart.labels && bar_width > 24) {
        drawing.write(left + bar_width / 2, y.place(below) - 5,
                      fixed_text(below, below < 10    ? 2
                                        : below < 100 ? 1
                                                      : 0),
                      "middle", "font-size=\"11\" fill=\"#444444\"");
      }
      if (stacked) {
        drawing.write(left + bar_width / 2, area.bottom + 15, chart.bars[bar], "middle",
                      "font-size=\"11\" fill=\"#444444\"");
      }
    }
    drawing.write(group_left + group_width / 2, area.bottom + (stacked ? 36 : 22), chart.groups[group], "middle",
                  kLabel);
  }
  drawing.line(area.left, area.bottom, area.right, area.bottom, kFrame);
  drawing.line(area.left, area.top, area.left, area.bottom, kFrame);

  std::vector<LegendEntry> legend;
  const std::vector<std::string>& names = stacked ? chart.parts : chart.bars;
  for (std::size_t i = 0; i < names.size(); ++i) legend.push_back({names[i], color_of(i), Mark::kLine});
  draw_legend(drawing, area, legend);
  return drawing.finish();
}

std::string scatter_chart_svg(const ScatterChart& chart) {
  PlotArea area;
  constexpr double kLaneHeight = 34;
  const double lane = area.bottom - kLaneHeight / 2;
  const auto shown = [](const ScatterChart::Point& point) {
    return can_show(point.x, true) && can_show(point.y, false);
  };
  double x_least = HUGE_VAL, x_greatest = 0, y_least = HUGE_VAL, y_greatest = 0;
  for (const ScatterChart::Point& point : chart.points) {
    if (!shown(point)) continue;
    x_least = std::min(x_least, point.x);
    x_greatest = std::max(x_greatest, point.x);
    if (point.y > 0) y_least = std::min(y_least, point.y);
    y_greatest = std::max(y_greatest, point.y);
  }
  const Axis x = fit_axis(x_least, x_greatest, true, area.left, area.right);
  y_least = std::min(y_least, y_greatest / 10);  // a tick or two at least
  const Axis y = fit_axis(y_least, y_greatest, true, area.bottom - kLaneHeight, area.top + 12);
  const auto place_of = [&](const ScatterChart::Point& point) {
    return Point2{x.place(point.x), point.y > 0 ? y.place(point.y) : lane};
  };

  Drawing drawing(chart.title);
  if (y_greatest > 0) {
    draw_y_axis(drawing, area, y, chart.y_title);
  } else {
    draw_y_axis(drawing, area, {.low = 0, .high = 0, .begin = 0, .end = 0, .logarithmic = false}, chart.y_title);
  }
  drawing.line(area.left, lane, area.right, lane, kGridLine);
  drawing.write(area.left - 8, lane + 4.5, "0", "end", kLabel);
  draw_x_axis(drawing, area, x, tick_values(x.low, x.high, true), chart.x_title);

  // The front is drawn first, below the points.
  std::vector<const ScatterChart::Point*> front;
  for (const ScatterChart::Point& point : chart.points) {
    if (shown(point) && point.ringed) front.push_back(&point);
  }
  std::ranges::sort(front, {}, [](const ScatterChart::Point* point) { return std::pair(point->x, -point->y); });
  std::vector<Point2> places;
  for (const ScatterChart::Point* point : front) places.push_back(place_of(*point));
  drawing.curve(places, "stroke=\"#888888\" stroke-width=\"1.2\" stroke-dasharray=\"5 4\"");
  for (const Point2& place : places) drawing.circle(place, kRingRadius, kRingStyle, chart.ring);
  for (const ScatterChart::Point& point : chart.points) {
    if (!shown(point)) continue;
    // Later colours are drawn smaller, so that all points in one place are visible.
    const double radius = std::max(2.5, 6.5 - static_cast<double>(point.color));
    drawing.circle(place_of(point), radius, dot_style(color_of(point.color), kDotMarks[point.style]),
                   point.name + ": " + number_text(point.x) + ", " + number_text(point.y));
  }
  std::vector<LegendEntry> legend;
  for (std::size_t i = 0; i < chart.colors.size(); ++i) legend.push_back({chart.colors[i], color_of(i), Mark::kLine});
  for (std::size_t i = 0; i < chart.styles.size(); ++i) {
    legend.push_back({chart.styles[i], i == 2 ? "#bbbbbb" : "#444444", kDotMarks[i]});
  }
  if (!chart.ring.empty()) legend.push_back({chart.ring, "#444444", Mark::kRing});
  draw_legend(drawing, area, legend);
  return drawing.finish();
}

std::string histogram_chart_svg(const HistogramChart& chart) {
  const PlotArea area{.left = 84, .top = 66, .right = 452, .bottom = 342};
  constexpr double kCostLeft = 486, kCostRight = 634, kSeparation = 18;
  const auto log_of = [](double count) { return std::log10(1 + count); };
  double most = 1, dearest = 0;
  for (const HistogramChart::Row& row : chart.rows) {
    for (const double count : row.counts) most = std::max(most, count);
    for (const double cost : row.costs) dearest = can_show(cost, false) ? std::max(dearest, cost) : dearest;
  }
  const std::size_t joined = chart.bins.size() - std::min(chart.separate_bins, chart.bins.size());
  const double bin_width =
      (area.right - area.left - kSeparation) / static_cast<double>(std::max<std::size_t>(1, chart.bins.size()));
  const auto left_of = [&](std::size_t bin) {
    return area.left + bin_width * static_cast<double>(bin) + (bin >= joined ? kSeparation : 0);
  };

  // 1. Names of the bins: every fourth of the contiguous ones, and all others, upright.
  Drawing drawing(chart.title);
  drawing.write(area.left, area.top - 14, chart.bin_title, "start", kLabel);
  drawing.write(kCostLeft, area.top - 14, chart.cost_title, "start", kLabel);
  for (std::size_t bin = 0; bin < chart.bins.size(); ++bin) {
    const double middle = left_of(bin) + bin_width / 2;
    if (bin >= joined) {
      drawing.write(middle + 4, area.bottom + 8, chart.bins[bin], "end",
                    "fill=\"#444444\" font-size=\"11\" transform=\"rotate(-90 " + units(middle + 4) + " " +
                        units(area.bottom + 8) + ")\"");
    } else if (bin % 4 == 0) {
      drawing.write(middle, area.bottom + 16, chart.bins[bin], "middle", "fill=\"#444444\" font-size=\"11\"");
    }
  }

  // 2. Rows, each on a line of its own.
  const double row_height = (area.bottom - area.top) / static_cast<double>(std::max<std::size_t>(1, chart.rows.size()));
  for (std::size_t i = 0; i < chart.rows.size(); ++i) {
    const HistogramChart::Row& row = chart.rows[i];
    const double bottom = area.top + row_height * static_cast<double>(i + 1);
    drawing.write(area.left - 8, bottom - row_height * 0.35, row.name, "end", kLabel);
    drawing.line(area.left, bottom, area.right, bottom, kFrame);
    drawing.line(kCostLeft, bottom - row_height * 0.85, kCostLeft, bottom - row_height * 0.1, kFrame);
    for (std::size_t bin = 0; bin < row.counts.size(); ++bin) {
      if (!(row.counts[bin] > 0)) continue;
      const double height = row_height * 0.85 * log_of(row.counts[bin]) / log_of(most);
      drawing.bar(left_of(bin) + bin_width * 0.08, bottom - height, bin_width * 0.84, height,
                  bin >= joined ? color_of(1) : color_of(0),
                  row.name + ", " + chart.bins[bin] + ": " + number_text(row.counts[bin]));
    }
    const double part_height = row_height * 0.7 / static_cast<double>(std::max<std::size_t>(1, row.costs.size()));
    for (std::size_t part = 0; part < row.costs.size(); ++part) {
      if (!can_show(row.costs[part], false) || dearest <= 0) continue;
      const double width = (kCostRight - kCostLeft) * row.costs[part] / dearest;
      const double top = bottom - row_height * 0.82 + part_height * static_cast<double>(part);
      drawing.bar(kCostLeft, top, width, part_height * 0.86, color_of(part + 2),
                  row.name + ", " + chart.parts[part] + ": " + number_text(row.costs[part]));
      drawing.write(kCostLeft + width + 6, top + part_height * 0.43 + 4, fixed_text(row.costs[part], 1), "start",
                    "fill=\"#444444\" font-size=\"11\"");
    }
  }
  std::vector<LegendEntry> legend;
  for (std::size_t part = 0; part < chart.parts.size(); ++part) {
    legend.push_back({chart.parts[part], color_of(part + 2), Mark::kLine});
  }
  PlotArea below = area;
  below.bottom += 40;  // of the upright names
  draw_legend(drawing, below, legend);
  return drawing.finish();
}

}  // namespace gridiron::plot
