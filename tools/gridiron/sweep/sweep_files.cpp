// Sweep files. SPDX-License-Identifier: Apache-2.0
#include "sweep_files.h"

#include <report/svg_plot.h>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <optional>
#include <vector>

#include "base/failure.h"
#include "base/words.h"

namespace gridiron::tool {
namespace {

struct Column {
  const char* name;
  double (*value)(const SweepFigures& figures);
};
constexpr Column kColumns[] = {
    {"frame_cycles", [](const SweepFigures& one) { return one.frame_cycles; }},
    {"milliseconds", [](const SweepFigures& one) { return one.seconds * 1e3; }},
    {"frames_per_second", [](const SweepFigures& one) { return one.frames_per_second(); }},
    {"compute_cycles", [](const SweepFigures& one) { return one.compute_cycles; }},
    {"init_cycles", [](const SweepFigures& one) { return one.init_cycles; }},
    {"dma_wait_cycles", [](const SweepFigures& one) { return one.wait_cycles; }},
    {"idle_cycles", [](const SweepFigures& one) { return one.idle_cycles; }},
    {"wait_percent", [](const SweepFigures& one) { return one.wait_percent; }},
    {"channel_busy_percent", [](const SweepFigures& one) { return one.channel_busy_percent; }},
};

// Of a value of a key; nothing for a latency of several numbers.
std::optional<double> plain_number(const std::string& text) {
  double number = 0;
  const char* const end = text.data() + text.size();
  return std::from_chars(text.data(), end, number).ptr == end ? std::optional(number) : std::nullopt;
}

std::vector<double> numbers_of(const VariedKey& key) {
  std::vector<double> numbers;
  for (const std::string& value : key.values) numbers.push_back(*plain_number(value));
  return numbers;
}

// "core_count 4, claim_cycles 300": what all machines of one curve have.
std::string name_of_curve(std::span<const VariedKey> others, std::size_t i) {
  const std::vector<std::size_t> places = places_of(others, i);
  std::string name;
  for (std::size_t key = 0; key < others.size(); ++key) {
    name += (key == 0 ? "" : ", ") + others[key].name + " " + others[key].values[places[key]];
  }
  return name;
}

}  // namespace

std::string sweep_csv(std::span<const VariedKey> varied, std::span<const SweepFigures> figures) {
  std::string text;
  const auto add = [&text](const std::string& field) {
    text += in_csv(field);
    text += ',';
  };
  const auto end_row = [&text] { text.back() = '\n'; };
  for (const VariedKey& key : varied) add(key.name);
  for (const Column& column : kColumns) add(column.name);
  end_row();
  for (std::size_t i = 0; i < figures.size(); ++i) {
    const std::vector<std::size_t> places = places_of(varied, i);
    for (std::size_t key = 0; key < varied.size(); ++key) add(varied[key].values[places[key]]);
    for (const Column& column : kColumns) add(text_of(column.value(figures[i])));
    end_row();
  }
  return text;
}

void check_sweep_plot(std::span<const VariedKey> varied) {
  const VariedKey& first = varied.front();
  for (const std::string& value : first.values) {
    if (plain_number(value)) continue;
    usage_error("--sweep-plot: the first key, " + in_quotes(first.name) + ", is the axis, which has no place for " +
                in_quotes(value));
  }
  if (std::ranges::count(first.values, first.values.front()) == std::ssize(first.values)) {
    usage_error("--sweep-plot: the first key, " + in_quotes(first.name) + ", is the axis, which needs two values");
  }
  const std::size_t curves = machine_count(varied.subspan(1));
  if (curves > plot::kMostSeries) {
    usage_error("--sweep-plot: shows at most " + std::to_string(plot::kMostSeries) +
                " curves, one for each combination of the keys behind the first; here are " + words_of_count(curves));
  }
  for (std::size_t i = 0; i < curves; ++i) {
    const std::string name = name_of_curve(varied.subspan(1), i);
    if (name.size() > plot::kMostNameLetters) usage_error("--sweep-plot: the name of a curve is too long: " + name);
  }
}

std::string sweep_svg(std::span<const VariedKey> varied, std::span<const SweepFigures> figures,
                      const std::string& title) {
  constexpr double kLogarithmicSpan = 20;
  const std::span<const VariedKey> others = varied.subspan(1);
  const std::vector<double> numbers = numbers_of(varied.front());
  const auto [least, most] = std::ranges::minmax(numbers);
  plot::LineChart chart{.title = title,
                        .x_title = varied.front().name,
                        .y_title = "frames a second",
                        .log_x = least > 0 && most > kLogarithmicSpan * least};
  constexpr std::size_t kMostTicks = 12;  // that have room for their labels
  if (numbers.size() <= kMostTicks) {
    chart.x_ticks = numbers;
    std::ranges::sort(chart.x_ticks);
  }
  const std::size_t curves = machine_count(others);
  for (std::size_t i = 0; i < curves; ++i) {
    plot::Series& series =
        chart.series.emplace_back(plot::Series{others.empty() ? "frames a second" : name_of_curve(others, i), {}});
    for (std::size_t place = 0; place < numbers.size(); ++place) {
      series.points.push_back({numbers[place], figures[place * curves + i].frames_per_second()});
    }
    std::ranges::sort(series.points, {}, &plot::Point2::x);
  }
  return plot::line_chart_svg(chart);
}

std::string words_of_sweep(std::span<const SweepFigures> figures) {
  const auto [least, most] = std::ranges::minmax_element(figures, {}, &SweepFigures::frames_per_second);
  char range[80];
  std::snprintf(range, sizeof range, ", %.2f to %.2f frames/s", least->frames_per_second(), most->frames_per_second());
  return words_of_count(figures.size(), "machine") + range;
}

}  // namespace gridiron::tool
