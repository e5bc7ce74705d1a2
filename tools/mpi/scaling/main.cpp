// gridiron_mpi_scaling: predicts commands by 1 to 4,096 ranks from files of measured costs, as a table and a plot.
// Memory: the costs. Threads: one. SPDX-License-Identifier: Apache-2.0
#include <charconv>
#include <cstdio>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/failure.h"
#include "base/numbers.h"
#include "base/words.h"
#include "files/atomic_file.h"
#include "files/command_files.h"
#include "files/input_file.h"
#include "report/svg_plot.h"
#include "scaling_model.h"

namespace {

using namespace gridiron;
using tool::shortest_text;

constexpr std::uint32_t kRanks[] = {1, 2, 4, 8, 16, 32, 64, 128, 256, 512, 1024, 2048, 4096};
constexpr double kHalf = 0.5;

double positive(const char* text, const char* name) {
  double number = 0;
  const char* const end = text + std::strlen(text);
  const auto [stop, error] = std::from_chars(text, end, number);
  if (error != std::errc{} || stop != end || !(number > 0 && number < 1e18)) {
    tool::usage_error(std::string(name) + " is no number above 0: " + tool::in_quotes(text));
  }
  return number;
}

// Of FILE, or of FILE*N.
scaling::Costs costs_of(const std::string& argument) {
  const std::size_t star = argument.rfind('*');
  const std::string path = argument.substr(0, star);
  const tool::InputFile file = tool::read_input_file(path, "expected a file of costs");
  scaling::Costs costs =
      scaling::read_costs(path, {reinterpret_cast<const char*>(file.bytes.data()), file.bytes.size()});
  if (star == std::string::npos) return costs;
  const std::optional<std::uint32_t> times = tool::parse_count(argument.substr(star + 1));
  if (!times || *times == 0) tool::usage_error(tool::in_quotes(argument) + ": how often, behind the star?");
  const std::vector<scaling::Piece> once = std::exchange(costs.pieces, {});
  for (std::uint32_t i = 0; i < *times; ++i) costs.pieces.insert(costs.pieces.end(), once.begin(), once.end());
  costs.name += ", " + std::to_string(*times) + " times";
  return costs;
}

void run(int count, char** values) {
  if (count < 5) {
    tool::usage_error(
        "gridiron_mpi_scaling OUTPUT LATENCY_SECONDS BYTES_PER_SECOND COSTS...\n"
        "writes OUTPUT.csv and OUTPUT.svg; COSTS is FILE, or FILE*N, whose pieces come N times");
  }
  const std::string output = values[1];
  const scaling::Network network{positive(values[2], "LATENCY_SECONDS"), positive(values[3], "BYTES_PER_SECOND")};
  plot::LineChart chart{.title = "Model of gridiron_mpi: " + shortest_text(network.latency_seconds * 1e6) +
                                 " us a message, " + shortest_text(network.bytes_per_second / 1e9) + " GB/s",
                        .x_title = "ranks",
                        .y_title = "times faster than 1 rank",
                        .log_x = true,
                        .log_y = true,
                        .x_ticks = {1, 2, 4, 16, 64, 256, 1024, 4096}};
  std::string table = "command,ranks,seconds,speed_up,efficiency,limit\n";
  for (int i = 4; i < count; ++i) {
    const scaling::Costs costs = costs_of(values[i]);
    plot::Series series{.name = costs.name, .points = {}};
    std::uint32_t last_good = 1;
    for (const std::uint32_t ranks : kRanks) {
      const scaling::Prediction at = scaling::predict(costs, network, ranks);
      series.points.push_back({static_cast<double>(ranks), at.speed_up});
      if (at.efficiency >= kHalf) last_good = ranks;
      table += tool::in_csv(costs.name) + "," + std::to_string(ranks) + "," + shortest_text(at.seconds) + "," +
               shortest_text(at.speed_up) + "," + shortest_text(at.efficiency) + "," + at.limit + "\n";
      std::printf("%-28s %5u ranks %10.3f s %8.2f times %6.1f %%  %s\n", costs.name.c_str(), ranks, at.seconds,
                  at.speed_up, 100 * at.efficiency, at.limit.c_str());
    }
    std::printf("%s: at least half efficient up to %u ranks\n", costs.name.c_str(), last_good);
    chart.series.push_back(std::move(series));
  }
  chart.series.push_back({.name = "ideal", .points = {{1, 1}, {4096, 4096}}, .dashed = true});
  chart.series.push_back({.name = "efficiency 50 %", .points = {{2, 1}, {4096, 2048}}, .dashed = true});
  tool::AtomicFiles files;
  files.add(output + ".csv", table);
  files.add(output + ".svg", plot::line_chart_svg(chart));
  files.commit();
}

}  // namespace

int main(int count, char** values) {
  const tool::CommandFiles files;
  try {
    run(count, values);
    return 0;
  } catch (const tool::Failure& failure) {
    std::fprintf(stderr, "gridiron_mpi_scaling: %s\n", failure.what());
    return static_cast<int>(failure.code());
  }
}
