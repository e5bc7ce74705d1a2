// SVG plots: well formed, and values land where they should. SPDX-License-Identifier: Apache-2.0
#include "report/svg_plot.h"

#include "../experiment/markup.h"
#include "support/test_headers.h"

namespace gridiron::test {
namespace {

using namespace plot;

std::vector<Point2> points_of(const MarkupElement& polyline) {
  std::vector<Point2> points;
  std::istringstream text(polyline.attributes.at("points"));
  Point2 point;
  char comma = 0;
  while (text >> point.x >> comma >> point.y) points.push_back(point);
  return points;
}

const MarkupElement* text_element(const std::vector<MarkupElement>& elements, const std::string& words) {
  for (const MarkupElement& element : elements) {
    if (element.name == "text" && element.text == words) return &element;
  }
  ADD_FAILURE() << "no text '" << words << "'";
  return nullptr;
}

TEST(SvgPlot, TicksAreRoundAndInside) {
  EXPECT_EQ(tick_values(0, 10, false), (std::vector<double>{0, 2, 4, 6, 8, 10}));
  EXPECT_EQ(tick_values(0, 1, false, 6), (std::vector<double>{0, 0.2, 0.4, 0.6000000000000001, 0.8, 1}));
  EXPECT_EQ(tick_values(1, 100, true), (std::vector<double>{1, 2, 5, 10, 20, 50, 100}));
  EXPECT_EQ(tick_values(1e4, 1e8, true).size(), 5u);
  EXPECT_FALSE(std::signbit(tick_values(0, 10, false).front()));
  EXPECT_TRUE(tick_values(1, 1, false).empty());
  for (const double high : {0.003, 0.7, 3.0, 86.0, 12'345.0, 9.9e8}) {
    const std::vector<double> ticks = tick_values(0, high, false);
    EXPECT_GE(ticks.size(), 3u) << high;
    EXPECT_LE(ticks.size(), 8u) << high;
    for (const double tick : ticks) EXPECT_LE(tick, high * 1.0001);
  }
}

TEST(SvgPlot, TickLabelsAreShort) {
  EXPECT_EQ(tick_text(0), "0");
  EXPECT_EQ(tick_text(0.6000000000000001), "0.6");
  EXPECT_EQ(tick_text(2000), "2000");
  EXPECT_EQ(tick_text(50'000), "50k");
  EXPECT_EQ(tick_text(1e6), "1M");
  EXPECT_EQ(tick_text(2.5e9), "2.5G");
}

// The ninth curve has the first's colour, but not its stroke; a long legend makes the picture higher.
TEST(SvgPlot, ManyCurvesCanBeToldApart) {
  LineChart chart = {.title = "t", .x_title = "x", .y_title = "y"};
  std::set<std::string> strokes;
  for (std::size_t i = 0; i < kMostSeries; ++i) {
    chart.series.push_back({std::string(kMostNameLetters - 2, 'n') + std::to_string(10 + i), {{0, 1}, {9, double(i)}}});
  }
  const auto elements = parse_markup(line_chart_svg(chart));
  for (const MarkupElement& curve : elements_named(elements, "polyline")) {
    strokes.insert(curve.attributes.at("stroke") +
                   (curve.attributes.count("stroke-dasharray") != 0 ? curve.attributes.at("stroke-dasharray") : ""));
  }
  EXPECT_EQ(strokes.size(), kMostSeries);
  const double height = elements_named(elements, "rect").front().number("height");
  std::set<double> rows;
  for (const Series& series : chart.series) {
    const MarkupElement* name = text_element(elements, series.name);
    ASSERT_NE(name, nullptr);
    rows.insert(name->number("y"));
    EXPECT_LT(name->number("y"), height);
  }
  EXPECT_EQ(rows.size(), kMostSeries) << "a row each";
  chart.series.resize(3);
  EXPECT_EQ(elements_named(parse_markup(line_chart_svg(chart)), "rect").front().number("height"), kPlotHeight);
}

TEST(SvgPlot, LinesGoThroughTheirPoints) {
  const PlotArea area;
  const LineChart chart = {.title = "A < B & \"C\"",
                           .x_title = "x",
                           .y_title = "y",
                           .series = {{"one", {{0, 0}, {5, 5}, {10, 10}}, false}, {"two", {{0, 10}, {10, 0}}, true}},
                           .x_ticks = {0, 5, 10}};
  const auto elements = parse_markup(line_chart_svg(chart));
  text_element(elements, "A < B & \"C\"");
  const auto curves = elements_named(elements, "polyline");
  ASSERT_EQ(curves.size(), 2u);
  const auto rising = points_of(curves[0]), falling = points_of(curves[1]);
  ASSERT_EQ(rising.size(), 3u);
  EXPECT_NEAR(rising[0].x, area.left, 0.01);
  EXPECT_NEAR(rising[0].y, area.bottom, 0.01);
  EXPECT_NEAR(rising[1].x, (area.left + area.right) / 2, 0.01);
  EXPECT_NEAR(rising[1].y, (area.top + area.bottom) / 2, 0.01);
  EXPECT_NEAR(rising[2].x, area.right, 0.01);
  EXPECT_NEAR(rising[2].y, area.top, 0.01);
  ASSERT_EQ(falling.size(), 2u);
  EXPECT_NEAR(falling[0].y, area.top, 0.01);
  EXPECT_EQ(curves[1].attributes.count("stroke-dasharray"), 1u);
  EXPECT_EQ(elements_named(elements, "circle").size(), 3u) << "a dashed line has no markers";
  // A label is under its value.
  const MarkupElement* five = text_element(elements, "5");
  ASSERT_NE(five, nullptr);
  EXPECT_NEAR(five->number("x"), rising[1].x, 0.01);
  text_element(elements, "one");
  text_element(elements, "two");
}

// Curves that lie close together far from 0.
TEST(SvgPlot, AZoomedAxisSpansItsValues) {
  const PlotArea area;
  LineChart chart = {.title = "t",
                     .x_title = "x",
                     .y_title = "y",
                     .series = {{"s", {{1, 100}, {2, 99.5}, {3, 97.2}}, false}},
                     .zoom_y = true};
  const auto elements = parse_markup(line_chart_svg(chart));
  const auto points = points_of(elements_named(elements, "polyline").at(0));
  EXPECT_NEAR(points[0].y, area.top, 0.01);
  EXPECT_NEAR(points[2].y, area.bottom - (97.2 - 97) / 3 * (area.bottom - area.top), 0.01) << "97 is the tick below";
  text_element(elements, "97");
  chart.series[0].points = {{1, 100}, {2, 100}};
  EXPECT_FALSE(parse_markup(line_chart_svg(chart)).empty()) << "nothing to span";
}

TEST(SvgPlot, LogarithmicAxesSpaceFactorsEvenly) {
  const LineChart chart = {.title = "t",
                           .x_title = "x",
                           .y_title = "y",
                           .series = {{"s", {{1, 10}, {10, 100}, {100, 1000}, {-1, 5}, {5, 0}}, false}},
                           .log_x = true,
                           .log_y = true};
  const auto elements = parse_markup(line_chart_svg(chart));
  const auto points = points_of(elements_named(elements, "polyline").at(0));
  ASSERT_EQ(points.size(), 3u) << "what has no logarithm is left out";
  EXPECT_NEAR(points[1].x - points[0].x, points[2].x - points[1].x, 0.02);
  EXPECT_NEAR(points[1].y - points[0].y, points[2].y - points[1].y, 0.02);
  EXPECT_LT(points[2].y, points[0].y);
}

TEST(SvgPlot, BarsStandOnTheAxisAndStack) {
  const PlotArea area;
  const BarChart chart = {.title = "t",
                          .y_title = "y",
                          .groups = {"g", "h"},
                          .bars = {"a", "b"},
                          .parts = {"p", "q"},
                          .values = {1, 2, 4, 0, std::nan(""), 1, 10, 0}};
  const auto elements = parse_markup(bar_chart_svg(chart));
  std::vector<MarkupElement> bars;
  for (const MarkupElement& rect : elements_named(elements, "rect")) {
    if (rect.attributes.count("x") == 1) bars.push_back(rect);
  }
  ASSERT_EQ(bars.size(), 6u) << "three bars of two parts; the one without a value is left out";
  const double unit = (area.bottom - area.top) / 10;
  EXPECT_NEAR(bars[0].number("height"), unit, 0.02);
  EXPECT_NEAR(bars[0].number("y") + bars[0].number("height"), area.bottom, 0.02);
  EXPECT_NEAR(bars[1].number("height"), 2 * unit, 0.02);
  EXPECT_NEAR(bars[1].number("y") + bars[1].number("height"), bars[0].number("y"), 0.02);
  EXPECT_NEAR(bars[2].number("height"), 4 * unit, 0.02);
  EXPECT_NEAR(bars[4].number("y"), area.top, 0.02) << "10 is the top of the axis";
  EXPECT_NE(bars[0].attributes.at("fill"), bars[1].attributes.at("fill"));
  EXPECT_EQ(bars[0].attributes.at("fill"), bars[2].attributes.at("fill")) << "parts have the colours";
  EXPECT_LT(bars[0].number("x") + bars[0].number("width"), bars[2].number("x"));
  for (const MarkupElement& bar : bars) {
    EXPECT_GE(bar.number("x"), area.left);
    EXPECT_LE(bar.number("x") + bar.number("width"), area.right);
  }
}

// What is had for nothing has a lane of its own below a logarithmic axis.
TEST(SvgPlot, PointsLieWhereTheirValuesAre) {
  const PlotArea area;
  const ScatterChart chart = {.title = "t",
                              .x_title = "x",
                              .y_title = "y",
                              .colors = {"one", "two"},
                              .styles = {"full", "empty", "lined"},
                              .ring = "front",
                              .points = {{10, 1000, "a", 0, 0, true},
                                         {100, 10, "b", 1, 1, false},
                                         {1000, 0, "c", 0, 2, true},
                                         {-1, 5, "left out", 0, 0, true},
                                         {5, std::nan(""), "left out", 0, 0, false}}};
  const auto elements = parse_markup(scatter_chart_svg(chart));
  std::vector<MarkupElement> dots, rings;
  for (const MarkupElement& circle : elements_named(elements, "circle")) {
    if (circle.number("cy") > area.bottom) continue;  // of the legend
    (circle.attributes.at("fill") == "none" ? rings : dots).push_back(circle);
  }
  ASSERT_EQ(dots.size(), 3u);
  ASSERT_EQ(rings.size(), 2u);
  EXPECT_NEAR(dots[1].number("cx") - dots[0].number("cx"), dots[2].number("cx") - dots[1].number("cx"), 0.02);
  EXPECT_LT(dots[0].number("cy"), dots[1].number("cy"));
  EXPECT_LT(dots[1].number("cy"), dots[2].number("cy") - 15) << "below every positive value";
  EXPECT_LT(dots[2].number("cy"), area.bottom);
  EXPECT_EQ(dots[1].attributes.at("fill"), "#ffffff") << "hollow";
  EXPECT_NE(dots[0].attributes.at("fill"), "#ffffff");
  EXPECT_EQ(dots[0].attributes.count("stroke"), 0u);
  EXPECT_EQ(dots[2].attributes.at("stroke"), "#000000") << "outlined";
  EXPECT_EQ(rings[0].attributes.at("cx"), dots[0].attributes.at("cx"));
  EXPECT_EQ(rings[1].attributes.at("cy"), dots[2].attributes.at("cy"));
  const auto front = points_of(elements_named(elements, "polyline").at(0));
  ASSERT_EQ(front.size(), 2u) << "the ringed ones, joined";
  EXPECT_NEAR(front[1].x, dots[2].number("cx"), 0.01);
  for (const char* words : {"0", "one", "two", "full", "empty", "lined", "front"}) text_element(elements, words);
}

TEST(SvgPlot, PointsOfNoErrorAtAllNeedNoAxis) {
  ScatterChart chart;
  chart.points = {{10, 0, "a", 0, 0, true}, {20, 0, "b", 1, 0, false}};
  const auto elements = parse_markup(scatter_chart_svg(chart));
  int dots = 0;
  for (const MarkupElement& circle : elements_named(elements, "circle")) {
    EXPECT_TRUE(std::isfinite(circle.number("cx")) && std::isfinite(circle.number("cy")));
    ++dots;
  }
  EXPECT_EQ(dots, 3);
  EXPECT_FALSE(parse_markup(scatter_chart_svg({})).empty());
}

TEST(SvgPlot, HistogramsStandBesideCosts) {
  const HistogramChart chart = {
      .title = "t",
      .bin_title = "bins",
      .cost_title = "cost",
      .bins = {"0", "1", "2", "far"},
      .separate_bins = 1,
      .parts = {"p", "q"},
      .rows = {{"first", {99, 9, 0, 0}, {10, 20}}, {"second", {9, 0, 0, 9}, {5, std::nan("")}}}};
  const auto elements = parse_markup(histogram_chart_svg(chart));
  std::vector<MarkupElement> bars;
  for (const MarkupElement& rect : elements_named(elements, "rect")) {
    if (rect.attributes.count("x") == 1) bars.push_back(rect);
  }
  ASSERT_EQ(bars.size(), 2u + 2u + 2u + 1u) << "no bar for no count and no cost";
  EXPECT_NEAR(bars[0].number("height"), 2 * bars[1].number("height"), 0.02) << "logarithms of 100 and of 10";
  EXPECT_NEAR(bars[0].number("y") + bars[0].number("height"), bars[1].number("y") + bars[1].number("height"), 0.02);
  EXPECT_NEAR(bars[3].number("width"), 2 * bars[2].number("width"), 0.02) << "costs are linear";
  EXPECT_NEAR(bars[2].number("width"), 2 * bars[6].number("width"), 0.02) << "and have one scale in all rows";
  EXPECT_NEAR(bars[4].number("height"), bars[1].number("height"), 0.02) << "so have counts";
  EXPECT_EQ(bars[4].attributes.at("x"), bars[0].attributes.at("x")) << "a bin is a column";
  EXPECT_LT(bars[1].number("x") + 2 * bars[1].number("width"), bars[5].number("x"));
  EXPECT_GT(bars[5].number("y"), bars[0].number("y")) << "rows lie below each other";
  EXPECT_NE(bars[5].attributes.at("fill"), bars[0].attributes.at("fill"));
  for (const char* words : {"first", "second", "bins", "cost", "far", "p", "q", "20.0"}) text_element(elements, words);
  EXPECT_FALSE(parse_markup(histogram_chart_svg({})).empty());
}

TEST(SvgPlot, ChartsOfNothingAreStillDocuments) {
  EXPECT_FALSE(
      parse_markup(line_chart_svg({.title = "t", .x_title = "", .y_title = "", .log_x = true, .log_y = true})).empty());
  EXPECT_FALSE(parse_markup(bar_chart_svg({})).empty());
}

}  // namespace
}  // namespace gridiron::test
