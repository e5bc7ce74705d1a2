// Prices of build steps from what the core model measured, by runs on standard input. Writes the header to the file of
// its argument, tables of prices and of the check to standard output.
// Memory: std::vector. Threads: one. SPDX-License-Identifier: Apache-2.0

// A line a run: ROLE NAME BUILDER FILE [HOST_SECONDS], with FILE.steps of the model and FILE.work of the program.
//   plain      prices every step that it has units of, by totals
//   shuffled   the plain run of the same name and builder before it, in an order that says nothing: prices far lines
//   special    prices the steps that no plain run has
//   check      compared with the prices
#include <gridiron/sim/build_work.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace {

using namespace gridiron::sim;

constexpr std::size_t kSteps = kBuildStepCount;
constexpr auto kGridFar = static_cast<std::size_t>(BuildStep::kFarLine);
constexpr auto kTreeFar = static_cast<std::size_t>(BuildStep::kTreeFarLine);
constexpr auto kBvhFar = static_cast<std::size_t>(BuildStep::kBvhFarLine);

constexpr auto kSurveyFar = static_cast<std::size_t>(BuildStep::kTreeSurveyFarLine);
// One that a builder has besides its own comes before it.
constexpr std::array kFarSteps = {kGridFar, kTreeFar, kSurveyFar, kBvhFar};

struct Sum {
  double units = 0, instructions = 0, cycles = 0, branch_misses = 0, lines_waited = 0, lines_streamed = 0;
};

struct Run {
  std::string role, name, builder;
  double host_seconds = 0, triangles = 0;
  std::array<Sum, kSteps> steps{};

  [[nodiscard]] double cycles() const {
    double sum = 0;
    for (const Sum& step : steps) sum += step.cycles;
    return sum;
  }
  [[nodiscard]] double lines_waited() const {
    double sum = 0;
    for (const Sum& step : steps) sum += step.lines_waited;
    return sum;
  }
  /// What its builder's shuffled runs price.
  [[nodiscard]] std::size_t far_step() const {
    if (builder == "bvh") return kBvhFar;
    if (builder == "tree") return kTreeFar;
    return builder == "tree_image" ? kSurveyFar : kGridFar;
  }
};

[[noreturn]] void fail(const std::string& text) {
  std::cerr << "price_steps: " << text << '\n';
  std::exit(1);
}

Run read_run(const std::string& line) {
  Run run;
  std::string file, word;
  std::istringstream(line) >> run.role >> run.name >> run.builder >> file >> run.host_seconds;
  std::ifstream work(file + ".work"), steps(file + ".steps");
  for (std::string text; std::getline(work, text);) {
    std::istringstream fields(text);
    std::size_t step = 0;
    fields >> word;
    if (word == "triangles") fields >> run.triangles;
    if (word == "work" && fields >> step && step < kSteps) fields >> run.steps[step].units;
  }
  for (std::string text; std::getline(steps, text);) {
    std::istringstream fields(text);
    long step = 0;
    fields >> word >> step;
    if (step < 0) continue;
    if (static_cast<std::size_t>(step) >= kSteps) fail("a step that is none in " + file);
    Sum& sum = run.steps[static_cast<std::size_t>(step)];
    fields >> sum.instructions >> sum.cycles >> sum.branch_misses >> sum.lines_waited >> sum.lines_streamed;
    if (sum.units == 0 && sum.cycles > 0)
      fail(std::string(name_of(static_cast<BuildStep>(step))) + " has no units in " + file);
  }
  if (run.cycles() == 0) fail("nothing measured in " + file);
  return run;
}

void add(const Sum& more, Sum& sum) {
  sum.units += more.units;
  sum.instructions += more.instructions;
  sum.cycles += more.cycles;
  sum.branch_misses += more.branch_misses;
  sum.lines_waited += more.lines_waited;
  sum.lines_streamed += more.lines_streamed;
}

using Prices = std::array<Sum, kSteps>;  // per unit

// Of the far lines that have a price.
double far_cycles(const Run& run, const Prices& prices) {
  double cycles = 0;
  for (const std::size_t far : kFarSteps) cycles += run.steps[far].units * prices[far].cycles;
  return cycles;
}

Prices prices_of(const std::vector<Run>& runs) {
  Prices prices{};
  // Far lines: what the same mesh in another order adds.
  for (const std::size_t far : kFarSteps) {
    double cycles = 0, lines = 0;
    for (const Run& run : runs) {
      if (run.role != "shuffled" || run.far_step() != far) continue;
      for (const Run& plain : runs) {
        if (plain.role != "plain" || plain.name != run.name || plain.builder != run.builder) continue;
        cycles += run.cycles() - far_cycles(run, prices) - (plain.cycles() - far_cycles(plain, prices));
        lines += run.steps[far].units - plain.steps[far].units;
      }
    }
    if (lines <= 0) fail("no far lines");
    prices[far] = {.units = lines, .cycles = cycles / lines, .lines_waited = 1};
  }
  // All others. The far lines of plain meshes are taken off the steps that waited for lines.
  for (const char* role : {"plain", "special"}) {
    Prices sums{};
    for (const Run& run : runs) {
      if (run.role != role) continue;
      for (std::size_t step = 0; step < kSteps; ++step) {
        Sum sum = run.steps[step];
        if (run.lines_waited() > 0) {
          sum.cycles -= far_cycles(run, prices) * sum.lines_waited / run.lines_waited();
        }
        add(sum, sums[step]);
      }
    }
    for (std::size_t step = 0; step < kSteps; ++step) {
      const Sum& sum = sums[step];
      if (std::ranges::count(kFarSteps, step) != 0 || sum.units == 0 || prices[step].units != 0) continue;
      prices[step] = {sum.units,
                      sum.instructions / sum.units,
                      sum.cycles / sum.units,
                      sum.branch_misses / sum.units,
                      sum.lines_waited / sum.units,
                      sum.lines_streamed / sum.units};
    }
  }
  for (std::size_t step = 0; step < kSteps; ++step) {
    if (!(prices[step].cycles > 0)) fail(std::string(name_of(static_cast<BuildStep>(step))) + " has no price");
    prices[step].cycles = std::round(10 * prices[step].cycles) / 10;  // as in the header
  }
  return prices;
}

double priced(const Prices& prices, const Run& run) {
  double cycles = 0;
  for (std::size_t step = 0; step < kSteps; ++step) cycles += prices[step].cycles * run.steps[step].units;
  return cycles;
}

void write_header(const Prices& prices, const char* path) {
  std::FILE* const file = std::fopen(path, "w");
  if (file == nullptr) fail(std::string("cannot write ") + path);
  std::fprintf(file, "%s",
               R"(// What a unit of each step of a build takes on the general core, in cycles of its clock. Written by
// tools/calibrate/general_core/run from the builders' own code in an emulator, through a model of the core and its
// caches; do not edit: tools/calibrate/README.md.
// Memory: constants. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

namespace gridiron::sim {

/// Per unit.
struct BuildCost {
  double cycles;         ///< charged
  double instructions;   ///< of riscv64
  double branch_misses;  ///< branches that were not guessed
  double lines;          ///< lines from memory, asked for or fetched ahead
};

/// By BuildStep.
inline constexpr auto kBuildCosts = std::to_array<BuildCost>({
)");
  for (std::size_t step = 0; step < kSteps; ++step) {
    const Sum& price = prices[step];
    const std::string_view name = name_of(static_cast<BuildStep>(step));
    std::fprintf(file, "    {%8.1f, %8.1f, %7.2f, %7.3f},  // %.*s\n", price.cycles, price.instructions,
                 price.branch_misses, price.lines_waited + price.lines_streamed, static_cast<int>(name.size()),
                 name.data());
  }
  std::fprintf(file, "%s", "});\n\n}  // namespace gridiron::sim\n");
  std::fclose(file);
}

void print_prices(const Prices& prices) {
  std::puts("| step | cycles | instructions | branch misses | lines fetched on demand | lines fetched ahead |");
  std::puts("|---|---|---|---|---|---|");
  for (std::size_t step = 0; step < kSteps; ++step) {
    const Sum& price = prices[step];
    const std::string_view name = name_of(static_cast<BuildStep>(step));
    std::printf("| `%.*s` | %.1f | %.1f | %.2f | %.3f | %.3f |\n", static_cast<int>(name.size()), name.data(),
                price.cycles, price.instructions, price.branch_misses, price.lines_waited, price.lines_streamed);
  }
}

void print_check(const Prices& prices, const std::vector<Run>& runs) {
  constexpr double kMillion = 1e6;
  std::puts("\n| mesh | builder | modelled, M cycles | priced | difference | priced, ms at 3.2 GHz | host, ms |");
  std::puts("|---|---|---|---|---|---|---|");
  for (const Run& run : runs) {
    if (run.role != "check") continue;
    const double sum = priced(prices, run);
    std::printf("| %s | %s | %.1f | %.1f | %+.1f %% | %.1f | %.1f |\n", run.name.c_str(), run.builder.c_str(),
                run.cycles() / kMillion, sum / kMillion, 100 * (sum / run.cycles() - 1), sum / 3.2e6,
                1e3 * run.host_seconds);
  }
  std::puts("\n| mesh | structure | BVH / structure: modelled | priced | host |");
  std::puts("|---|---|---|---|---|");
  for (const Run& grid : runs) {
    if (grid.role != "check" || grid.builder == "bvh" || grid.builder == "tree_image") continue;
    for (const Run& bvh : runs) {
      if (bvh.role != "check" || bvh.builder != "bvh" || bvh.name != grid.name) continue;
      std::printf("| %s | %s | %.2f | %.2f | %.2f |\n", grid.name.c_str(), grid.builder.c_str(),
                  bvh.cycles() / grid.cycles(), priced(prices, bvh) / priced(prices, grid),
                  grid.host_seconds > 0 ? bvh.host_seconds / grid.host_seconds : 0);
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) fail("HEADER < RUNS");
  std::vector<Run> runs;
  for (std::string line; std::getline(std::cin, line);) runs.push_back(read_run(line));
  const Prices prices = prices_of(runs);
  write_header(prices, argv[1]);
  print_prices(prices);
  print_check(prices, runs);
}
