// The committed table of work costs is the one that the kernel's operations come to today.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/bvh/bvh_engine_work.h>
#include <gridiron/bvh/bvh_renderer.h>
#include <gridiron/sim/machine_profile.h>
#include <gridiron/sim/replay.h>
#include <gridiron/sim/tile_costs.h>
#include <gridiron/sim/work_costs.h>
#include <work_table.h>

#include <regex>

#include "support/render_mesh.h"
#include "support/test_headers.h"
#include "support/test_mesh.h"

namespace gridiron::calibrate {
namespace {

// What is counted is the same with every compiler: it is compared to the last digit of the table. The schedule depends
// a little on the order in which a compiler evaluates operands: up to 1 % between GCC and clang were seen.
void expect_same(const sim::WorkCost& cost, const KindTotals& counted) {
  constexpr double kLastDigit = 0.00501;
  constexpr double kScheduleTolerance = 0.02;
  ASSERT_GT(counted.units, 0u);
  const auto per_unit = [&](auto value) { return static_cast<double>(value) / static_cast<double>(counted.units); };
  const auto count_of = [&](OpClass op) { return per_unit(counted.operations[static_cast<std::size_t>(op)]); };
  EXPECT_NEAR(per_unit(counted.even()), cost.even, kLastDigit);
  EXPECT_NEAR(count_of(OpClass::kDouble), cost.doubles, kLastDigit);
  EXPECT_NEAR(per_unit(counted.odd()), cost.odd, kLastDigit);
  EXPECT_NEAR(count_of(OpClass::kBranch), cost.branches, kLastDigit);
  EXPECT_NEAR(per_unit(counted.misses), cost.misses, kLastDigit);
  EXPECT_NEAR(per_unit(counted.cycles()), cost.cycles, kScheduleTolerance * cost.cycles + 0.05);
  EXPECT_NEAR(per_unit(counted.resource_cycles()), cost.least_cycles, 0.0501);
}

// count_frames() and count_bvh_frames() throw where the counted twin renders another picture or does other work.
TEST(WorkTable, CommittedTableIsThatOfTodaysKernel) {
  const Totals totals = count_frames();
  for (std::size_t kind = 0; kind < sim::kWorkCosts.size(); ++kind) {
    if (sim::kWorkCosts[kind].cycles == 0) continue;  // commands and waits
    SCOPED_TRACE("kind " + std::to_string(kind) +
                 ": if the kernel's operations changed, write the table anew with\n  build/host/bin/gridiron_calibrate "
                 "sim_platform/gridiron/sim/work_costs.h");
    expect_same(sim::kWorkCosts[kind], totals[kind]);
  }
}

TEST(WorkTable, CommittedTableOfTheBvhIsThatOfToday) {
  const Totals totals = count_bvh_frames();
  for (std::uint32_t i = 0; i < bvh::kBvhCosts.size(); ++i) {
    const WorkId kind = bvh::kind_of_cost(i);
    SCOPED_TRACE(std::string(sim::work_kind(kind, bvh::kBvhEngine).name) +
                 ": if the cached BVH's operations changed, or the kernel's that it calls, write the table anew with\n"
                 "  build/host/bin/gridiron_calibrate --bvh sim_platform/gridiron/bvh/bvh_costs.h");
    expect_same(bvh::kBvhCosts[i], totals[kind.number()]);
  }
}

TEST(WorkTable, CommittedTableOfTheTreeIsThatOfToday) {
  const Totals totals = count_tree_frames();
  for (std::uint32_t i = 0; i < sim::kTileCosts.size(); ++i) {
    const WorkId kind = sim::kTileWorkKinds[i].id;
    SCOPED_TRACE(std::string(sim::kTileWorkKinds[i].name) +
                 ": if the kernel's operations changed, write the table anew with\n"
                 "  build/host/bin/gridiron_calibrate --tree sim_platform/gridiron/sim/tile_costs.h");
    expect_same(sim::kTileCosts[i], totals[kind.number()]);
  }
}

/// Prices by the names that stand beside them in a table's file.
std::map<std::string, double> prices_in(const std::string& file) {
  std::ifstream in(GRIDIRON_SOURCE_DIR "/sim_platform/gridiron/" + file);
  const std::regex row(R"(^ *\{(?:WorkId\( *\d+\),)? *([0-9.]+)[,}].*// ([a-z_]+).*)");
  std::map<std::string, double> prices;
  std::smatch match;
  for (std::string line; std::getline(in, line);) {
    if (!std::regex_match(line, match, row)) continue;
    EXPECT_TRUE(prices.emplace(match[2], std::stod(match[1])).second) << match[2] << " is there twice";
  }
  EXPECT_FALSE(prices.empty()) << file;
  return prices;
}

// A frame's work at the prices that stand beside the names of its kinds, and its events.
double priced(const sim::WorkTotals& work, const sim::EngineWork& engine, const sim::MachineProfile& machine,
              const std::map<std::string, double>& prices) {
  const auto count_of = [&](Work kind) { return static_cast<double>(work[WorkId(kind).number()]); };
  double sum = machine.issue_cycles * (count_of(Work::kGetIssue) + count_of(Work::kPutIssue)) +
               machine.wait_cycles * count_of(Work::kWait);
  for (std::uint32_t i = 0; i < engine.kind_count(); ++i) {
    if (work[i] == 0 || sim::is_charged_as_event(WorkId(i))) continue;
    const auto price = prices.find(std::string(sim::work_kind(WorkId(i), engine).name));
    EXPECT_NE(price, prices.end()) << "kind " << i;
    if (price != prices.end()) sum += price->second * static_cast<double>(work[i]);
  }
  return sum;
}

double busy_cycles(const sim::FrameTiming& timing) {
  double sum = 0;
  for (const sim::CoreTiming& core : timing.cores) sum += core.init_cycles + core.compute_cycles;
  return sum;
}

// Of a frame, what the cores do before their first tile and behind their last: it is no tile's work.
constexpr double kOncePerCore = 1e-4;
constexpr Camera kCamera = {{1.2f, 1.5f, 2.5f}, {0, 0, 0}, {0, 1, 0}, 0.5f};

TEST(WorkTable, GridIsChargedWhatTheTableHasUnderTheNamesOfItsWork) {
  const std::map<std::string, const char*> tables = {{"cell-ps3", "sim/work_costs.h"},
                                                     {"fu540", "sim/instruction_costs.h"}};
  const test::TestMesh mesh = test::make_mixed_mesh();
  test::SceneInMemory scene(mesh.view(), GridParameters{});
  const test::RenderedFrame frame =
      scene.render({.camera = kCamera, .width = 96, .height = 96, .shading = Shading::kSimple}, {});
  ASSERT_EQ(frame.result.status, Status::kOk);
  for (const auto& [name, file] : tables) {
    const sim::MachineProfile& machine = *sim::find_machine_profile(name);
    const double expected = priced(frame.result.work, sim::kGridEngine, machine, prices_in(file));
    EXPECT_NEAR(busy_cycles(sim::replay(frame.result.trace, machine, {})), expected, kOncePerCore * expected) << name;
  }
}

TEST(WorkTable, BvhIsChargedItsTableAndTheKernelsForAllElse) {
  std::map<std::string, double> prices = prices_in("sim/work_costs.h");
  for (const auto& [name, price] : prices_in("bvh/bvh_costs.h")) prices[name] = price;
  const test::TestMesh mesh = test::make_mixed_mesh();
  bvh::Bvh tree;
  ASSERT_EQ(bvh::build_bvh(mesh.view(), {}, tree), Status::kOk);
  const sim::MachineProfile& machine = *sim::find_machine_profile("cell-ps3");
  const bvh::BvhFrame frame =
      bvh::render_bvh_frame(tree, {.camera = kCamera, .width = 96, .height = 96}, machine, {});
  ASSERT_EQ(frame.status, Status::kOk);
  const double expected = priced(frame.work, bvh::kBvhEngine, machine, prices);
  EXPECT_NEAR(busy_cycles(frame.timing), expected, kOncePerCore * expected);
}

// The schedule lies between its bounds.
TEST(WorkTable, ChargesAreBelowThoseOfOneInstructionACycle) {
  for (const sim::WorkCost& cost : sim::kWorkCosts) EXPECT_LE(cost.cycles, cost.most_cycles);
  for (const sim::WorkCost& cost : bvh::kBvhCosts) EXPECT_LE(cost.cycles, cost.most_cycles);
}

}  // namespace
}  // namespace gridiron::calibrate
