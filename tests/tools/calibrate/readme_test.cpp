// The figures in tools/calibrate/README.md equal those of the tables. SPDX-License-Identifier: Apache-2.0
#include <gridiron/bvh/bvh_costs.h>
#include <gridiron/bvh/bvh_engine_work.h>
#include <gridiron/sim/build_costs.h>
#include <gridiron/sim/build_work.h>
#include <gridiron/sim/work_costs.h>
#include <report/report.h>

#include <regex>

#include "support/test_headers.h"

namespace gridiron::calibrate {
namespace {

std::string readme_text() {
  std::ifstream file(GRIDIRON_SOURCE_DIR "/tools/calibrate/README.md", std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// @returns the text between two marks; fails if one of them is missing.
std::string between(const std::string& text, const std::string& from, const std::string& to) {
  const std::size_t begin = text.find(from), end = text.find(to, begin);
  EXPECT_NE(begin, std::string::npos) << from;
  EXPECT_NE(end, std::string::npos) << to;
  return begin == std::string::npos ? "" : text.substr(begin, end - begin);
}

std::set<std::string> quoted_words(const std::string& text) {
  std::set<std::string> words;
  const std::regex quoted("`([a-z_]+)`");
  for (std::sregex_iterator match(text.begin(), text.end(), quoted), end; match != end; ++match)
    words.insert((*match)[1]);
  return words;
}

/// A row of the table "Second opinion".
struct Opinion {
  double cycles, operations, instructions, ratio;
};

std::map<std::string, Opinion> opinions(const std::string& text) {
  std::map<std::string, Opinion> rows;
  const std::regex row(R"(\| `([a-z_]+)` \| ([0-9.]+) \| ([0-9.]+) \| ([0-9.]+) \| ([0-9.]+) \|)");
  for (std::sregex_iterator match(text.begin(), text.end(), row), end; match != end; ++match) {
    rows[(*match)[1]] = {std::stod((*match)[2]), std::stod((*match)[3]), std::stod((*match)[4]),
                         std::stod((*match)[5])};
  }
  return rows;
}

// The page has one decimal, the table of operations two.
constexpr double kPageLastDigit = 0.0601;

// The instructions themselves come from tools/calibrate/second_opinion/run; that needs a cross compiler.
TEST(CalibrateReadme, SecondOpinionStandsBesideTheTableOfToday) {
  const std::string text = readme_text();
  const std::map<std::string, Opinion> rows = opinions(text.substr(0, text.find("## The general core")));
  std::set<std::string> apart, below;
  for (std::uint32_t i = 0; i < sim::kGridEngine.kind_count(); ++i) {
    const sim::WorkCost& cost = sim::kWorkCosts[i];
    if (cost.cycles == 0) continue;  // commands and waits
    const std::string name(sim::work_kind(WorkId(i)).name);
    SCOPED_TRACE(name + ": run tools/calibrate/second_opinion/run and write the README's table anew");
    const auto row = rows.find(name);
    ASSERT_NE(row, rows.end());
    EXPECT_NEAR(row->second.cycles, cost.cycles, kPageLastDigit);
    EXPECT_NEAR(row->second.operations, cost.even + cost.odd, kPageLastDigit);
    // Instructions and operations are rounded, the ratio is that of the figures behind them.
    EXPECT_NEAR(row->second.ratio, row->second.instructions / row->second.operations,
                0.006 + 0.06 * (1 + row->second.ratio) / row->second.operations);
    if (row->second.ratio > 1.5) apart.insert(name);
    if (row->second.ratio < 0.67) below.insert(name);
  }
  std::set<std::string> explained =
      quoted_words(between(text, "aarch64 takes more than 1.5 times", "These reasons are read from"));
  for (const char* word : {"issue_cycles"}) explained.erase(word);
  for (const std::string& name : apart) EXPECT_EQ(explained.count(name), 1u) << name << " has no reason";
  for (const std::string& name : explained) EXPECT_EQ(apart.count(name), 1u) << name << " is not apart";
  EXPECT_EQ(quoted_words(between(text, "Four are below 0.67", "aarch64 takes more than 1.5 times")), below);
}

// The table itself comes from tools/calibrate/general_core/run; that needs a cross compiler.
TEST(CalibrateReadme, EveryStepOfABuildHasAPrice) {
  static_assert(sim::kBuildCosts.size() == sim::kBuildStepCount);
  const std::string text = readme_text();
  const sim::MasterProfile& master = sim::find_machine_profile("cell-ps3")->master;
  for (std::size_t i = 0; i < sim::kBuildStepCount; ++i) {
    const std::string name(sim::name_of(static_cast<sim::BuildStep>(i)));
    SCOPED_TRACE(name + ": run tools/calibrate/general_core/run and write the README's table anew");
    const sim::BuildCost& cost = sim::kBuildCosts[i];
    EXPECT_GT(cost.cycles, 0);
    EXPECT_EQ(master.step_cycles[i], cost.cycles);
    const std::regex row("\\| `" + name + R"(` \| ([0-9.]+) \| ([0-9.]+) \| ([0-9.]+) \| ([0-9.]+) \| ([0-9.]+) \|)");
    std::smatch match;
    const std::string section = between(text, "## The general core", "## Limits");
    ASSERT_TRUE(std::regex_search(section, match, row));
    EXPECT_NEAR(std::stod(match[1]), cost.cycles, 1e-9);
    EXPECT_NEAR(std::stod(match[2]), cost.instructions, 1e-9);
    EXPECT_NEAR(std::stod(match[3]), cost.branch_misses, 1e-9);
    EXPECT_NEAR(std::stod(match[4]) + std::stod(match[5]), cost.lines, 0.0011);
  }
}

TEST(CalibrateReadme, KindsBelowTheirLeastAreNamed) {
  std::set<std::string> below;
  const auto add = [&below](const sim::WorkCost& cost, std::string_view name) {
    if (cost.cycles > 0 && cost.cycles < 0.98 * cost.least_cycles) below.insert(std::string(name));
  };
  for (std::uint32_t i = 0; i < sim::kWorkCosts.size(); ++i) {
    add(sim::kWorkCosts[i], sim::work_kind(WorkId(i)).name);
  }
  for (std::uint32_t i = 0; i < bvh::kBvhCosts.size(); ++i) {
    add(bvh::kBvhCosts[i], sim::work_kind(bvh::kind_of_cost(i), bvh::kBvhEngine).name);
  }
  EXPECT_EQ(quoted_words(between(readme_text(), "More than 2 % less:", "\n\n")), below);
}

}  // namespace
}  // namespace gridiron::calibrate
