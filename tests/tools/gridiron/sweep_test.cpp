// render --vary: each machine's figures are those of a render with its machine file; files, order and refusals.
// SPDX-License-Identifier: Apache-2.0
#include "gridiron/sweep/sweep_files.h"
#include "report/svg_plot.h"
#include "gridiron/sweep/machine_sweep.h"

#include <nlohmann/json.hpp>

#include "animation_table.h"
#include "gridiron/device/machine_file.h"
#include "run_program.h"
#include "temporary_folder.h"

namespace gridiron::test {
namespace {

using Json = nlohmann::json;

const std::string kEverything = GRIDIRON_SCENE_FILES "/everything.nff";  // all effects

// The figures of a report under the names of the columns.
std::map<std::string, double> figures_of_report(const Json& report) {
  std::map<std::string, double> figures;
  figures["frame_cycles"] = report["frame"]["cycles"];
  figures["milliseconds"] = double(report["frame"]["seconds"]) * 1e3;
  figures["frames_per_second"] = report["frame"]["fps"];
  for (const Json& core : report["cores"]) {
    for (const char* name : {"compute_cycles", "init_cycles", "idle_cycles"}) figures[name] += double(core[name]);
    for (const Json& wait : core["dma_wait_cycles"]) figures["dma_wait_cycles"] += double(wait);
  }
  const double all = figures["frame_cycles"] * double(report["cores"].size());
  figures["wait_percent"] = 100 * figures["dma_wait_cycles"] / all;
  return figures;
}

// Sweeps, then renders once for each machine with a file that says the same. @param base  lines of every machine file.
void expect_renders_of_files(const TemporaryFolder& folder, const Words& frame, const std::string& base,
                             const Words& varied) {
  SCOPED_TRACE(testing::PrintToString(varied));
  Words arguments = Words{"render", "-o", "a.png"} + frame;
  folder.write("base.machine", base);
  Words sweep = arguments + Words{"--machine", "base.machine", "--quiet", "--sweep", "s.csv"};
  std::vector<tool::VariedKey> keys;
  for (const std::string& text : varied) {
    sweep = sweep + Words{"--vary", text};
    keys.push_back(tool::parse_varied_key(text));
  }
  (void)run(folder, sweep);
  const std::vector<Row> rows = read_table(folder.path("s.csv"));
  ASSERT_EQ(rows.size(), tool::machine_count(keys));
  std::set<std::string> cycles;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    std::string file = base;
    const std::vector<std::size_t> places = tool::places_of(keys, i);
    for (std::size_t key = 0; key < keys.size(); ++key) {
      const std::string& value = keys[key].values[places[key]];
      EXPECT_EQ(rows[i].at(keys[key].name), value) << "row " << i;
      file += keys[key].name + " " + value + "\n";
    }
    folder.write("own.machine", file);
    (void)run(folder, arguments + Words{"--machine", "own.machine", "--quiet", "--report", "r.json"});
    const Json report = Json::parse(read_file(folder.path("r.json")));
    for (const auto& [name, figure] : figures_of_report(report)) {
      EXPECT_EQ(std::stod(rows[i].at(name)), figure) << name << ", row " << i;
    }
    cycles.insert(rows[i].at("frame_cycles") + " " + rows[i].at("milliseconds"));
  }
  EXPECT_EQ(cycles.size(), rows.size()) << "machines of which none can be told from another prove nothing";
}

const Words kSweptFrame = {"a.ply", "--size", "96x64", "--tile-width", "16"};

TEST(Sweep, MachinesAreThoseOfMachineFiles) {
  const TemporaryFolder folder("a.ply", make_torus(40, 24, 1.0f, 0.4f));
  const std::string base = "based_on cell-ps3\n";
  for (const char* varied :
       {"core_count=1,2,16", "latency_cycles=0,5000", "latency_cycles=400:0.98 5400:0.02,390:0.9 1490:0.1",
        "channel_bytes_per_cycle=0.5,7.2", "line_bytes=64,1024", "lines_in_flight=1,16", "claim_cycles=0,300.5",
        "work_cycles.triangle_batch=1,2", "clock_hz=3.2e9,1e9", "issue_cycles=0,99", "wait_cycles=0,99",
        "core_line_interval_cycles=0,700"}) {
    const Words grid = std::string(varied).starts_with("work_") ? Words{"--configuration", "reference"} : Words{};
    expect_renders_of_files(folder, kSweptFrame + grid, base, {varied});
  }
  expect_renders_of_files(folder, kSweptFrame, "based_on cell-ps3-tlb\n", {"latency_seed=0,7"});
  expect_renders_of_files(folder, kSweptFrame, base, {"work_cycles.block=1,2", "core_count=3,2"});
}

// The cores of all machines, where these do not differ in them.
TEST(Sweep, CoresAreThoseAskedFor) {
  const TemporaryFolder folder("a.ply", make_torus(40, 24, 1.0f, 0.4f));
  const Words frame = Words{"render"} + kSweptFrame + Words{"--quiet"}, latency = {"--vary", "latency_cycles=500"};
  (void)run(folder, frame + Words{"--cores", "3"} + latency + Words{"--sweep", "a.csv"});
  (void)run(folder, frame + Words{"--vary", "core_count=3"} + latency + Words{"--sweep", "b.csv"});
  const auto figures = [&folder](const char* name) {
    const std::string text = read_file(folder.path(name));
    return text.substr(text.find("500,", text.find('\n')));
  };
  EXPECT_EQ(figures("a.csv"), figures("b.csv"));
}

// A curve has the machines of its values.
TEST(Sweep, CurvesAreThoseOfTheirMachines) {
  const tool::VariedKey keys[] = {{"latency_cycles", {"100", "200", "300"}}, {"core_count", {"1", "2"}}};
  std::vector<tool::SweepFigures> figures(6);
  for (std::size_t i = 0; i < figures.size(); ++i) figures[i].seconds = 1 / (1.0 + static_cast<double>(i));
  plot::LineChart chart{.title = "t", .x_title = "latency_cycles", .y_title = "frames a second"};
  chart.series = {{"core_count 1", {{100, 1}, {200, 3}, {300, 5}}}, {"core_count 2", {{100, 2}, {200, 4}, {300, 6}}}};
  chart.x_ticks = {100, 200, 300};
  EXPECT_EQ(tool::sweep_svg(keys, figures, "t"), plot::line_chart_svg(chart));
}

// Waiting rays, each core's in a place of its own; three keys, the first slowest.
TEST(Sweep, FramesWithEffectsToo) {
  const TemporaryFolder folder;
  expect_renders_of_files(folder, {kEverything, "--size", "24x16"}, "based_on cell-ps3\n",
                          {"core_count=6,1", "latency_cycles=500,400:0.5 5400:0.5", "clock_hz=1e9,2e9"});
}

// Where memory is scarce, waiting rays of many cores leave a coarser grid to the scene: another frame.
TEST(Sweep, CoresThatChangeTheImageAreRefused) {
  const TemporaryFolder folder;
  const Words frame = {kEverything, "--size", "24x16", "--configuration", "grid"};
  const auto base = [](int megabytes) {
    return "based_on cell-ps3\nmain_memory_bytes " + std::to_string(megabytes << 20) + "\n";
  };
  expect_renders_of_files(folder, frame, base(14), {"core_count=1,6"});
  const auto expect_refusal = [&](int megabytes, const std::string& varied, const std::string& words) {
    folder.write("base.machine", base(megabytes));
    expect_failure(folder, Words{"render", "-o", "a.png", "--machine", "base.machine", "--sweep", "s.csv", "--vary"} +
                               Words{varied} + frame,
                   2, words);
  };
  expect_refusal(14, "core_count=1,24", "--vary: with 'core_count' 24 the rays that wait leave ");
  expect_refusal(11, "core_count=6,1", "--vary: with 'core_count' 1 the rays that wait leave ");
}

// Whatever a sweep varies has no part in the frame; what it refuses has, or would be no part of the time.
TEST(Sweep, KeysOfReplaysAreThoseThatChangeNoFrame) {
  const TemporaryFolder folder("a.ply", make_torus(40, 24, 1.0f, 0.4f));
  const auto report_of = [&folder](const Words& frame, const std::string& machine) {
    folder.write("own.machine", machine);
    (void)run(folder, Words{"render", "-o", "a.png", "--machine", "own.machine", "--report", "r.json"} + frame);
    return Json::parse(read_file(folder.path("r.json")));
  };
  const std::string base = "based_on cell-ps3\n";
  std::string all = base;
  const Words keys = tool::keys_of_replays();
  for (const std::string& key : keys) all += key + " 17\n";
  const Words frames[] = {kSweptFrame, kSweptFrame + Words{"--configuration", "grid"},
                          {kEverything, "--size", "24x16"}};
  for (const Words& frame : frames) {
    const Json usual = report_of(frame, base), varied = report_of(frame, all);
    EXPECT_NE(varied["frame"], usual["frame"]);
    EXPECT_EQ(varied["cores"].size(), 17u);
    EXPECT_EQ(varied["host"]["trace_bytes"], usual["host"]["trace_bytes"]);
    for (const char* part : {"configuration", "scene", "work", "local_store", "image_hash"}) {
      EXPECT_EQ(varied[part], usual[part]) << part;
    }
  }
  const std::string text = tool::machine_text(*sim::find_machine_profile("cell-ps3"));
  std::size_t refused = 0;
  for (std::istringstream lines(text); std::getline(lines, all);) {
    const std::string key = all.substr(0, all.find(' '));
    if (key == "name" || key == "description" || std::ranges::count(keys, key) != 0) continue;
    EXPECT_TRUE(key.starts_with("master.") || key.starts_with("pass_") || key == "queue_depth" ||
                key == "main_memory_bytes" || key == "local_store_bytes")
        << key;
    ++refused;
  }
  EXPECT_EQ(refused, 3 + 2 + 1 + sim::kBuildStepCount);
  const Words grid = kSweptFrame + Words{"--configuration", "grid"};
  const Json usual = report_of(grid, base);
  EXPECT_NE(report_of(grid, base + "queue_depth 1\n")["work"], usual["work"]);
  EXPECT_NE(report_of(grid, base + "local_store_bytes 65536\n")["local_store"], usual["local_store"]);
}

TEST(Sweep, FilesDoNotDependOnThreadsAndOneMayBeStandardOutput) {
  const TemporaryFolder folder("a.ply", make_torus(24, 16, 1.0f, 0.4f));
  const Words sweep = Words{"render", "-o", "a.png"} + kSweptFrame +
                      Words{"--vary", "latency_cycles=2000,100,500", "--vary", "core_count=1,2,4,6"};
  const ProgramResult one = run(folder, sweep + Words{"--threads", "1", "--sweep", "1.csv", "--sweep-plot", "1.svg"});
  (void)run(folder, sweep + Words{"--threads", "2", "--sweep", "2.csv", "--sweep-plot", "2.svg"});
  const std::string table = read_file(folder.path("1.csv")), plot = read_file(folder.path("1.svg"));
  EXPECT_EQ(read_file(folder.path("2.csv")), table);
  EXPECT_EQ(read_file(folder.path("2.svg")), plot);
  EXPECT_EQ(table.substr(0, table.find('\n')),
            "latency_cycles,core_count,frame_cycles,milliseconds,frames_per_second,compute_cycles,init_cycles,"
            "dma_wait_cycles,idle_cycles,wait_percent,channel_busy_percent");
  const std::vector<Row> rows = read_table(folder.path("1.csv"));
  ASSERT_EQ(rows.size(), 12u);
  double least = HUGE_VAL, most = 0;
  for (const Row& row : rows) {
    least = std::min(least, std::stod(row.at("frames_per_second")));
    most = std::max(most, std::stod(row.at("frames_per_second")));
    const double busy = std::stod(row.at("channel_busy_percent"));
    EXPECT_GT(busy, 0);
    EXPECT_LE(busy, 100);
  }
  char words[80];
  std::snprintf(words, sizeof words, "\n1.csv: 12 machines, %.2f to %.2f frames/s\n", least, most);
  EXPECT_NE(one.out.find(words), std::string::npos) << one.out << "lacks" << words;
  // A curve for each number of cores, from the least latency to the most, whatever their order.
  std::size_t curves = 0;
  for (std::size_t at = plot.find("<polyline"); at != std::string::npos; at = plot.find("<polyline", at + 1)) {
    ++curves;
    std::istringstream points(plot.substr(plot.find("points=\"", at) + 8));
    double before = 0, x = 0, y = 0;
    char comma = 0;
    for (int i = 0; i < 3 && points >> x >> comma >> y; ++i) EXPECT_GT(x, std::exchange(before, x));
  }
  EXPECT_EQ(curves, 4u);
  for (const char* name : {">core_count 1<", ">core_count 6<", ">latency_cycles<", ">frames a second<"}) {
    EXPECT_NE(plot.find(name), std::string::npos) << name;
  }
  const ProgramResult streamed = run(folder, sweep + Words{"--sweep", "-"});
  EXPECT_EQ(streamed.out, table);
  EXPECT_NE(streamed.err.find("12 machines"), std::string::npos) << streamed.err;
  EXPECT_EQ(run(folder, sweep + Words{"--quiet", "--sweep", "-"}).err, "");
}

TEST(Sweep, WhatCannotBeVariedIsRefused) {
  const TemporaryFolder folder("a.ply", make_box(Vec3(0), Vec3(1)));
  const auto expect_refusal = [&folder](const Words& arguments, const std::string& words) {
    expect_failure(folder, Words{"render", "a.ply", "--size", "8x8", "-o", "a.png"} + arguments, 2, words);
  };
  const Words table = {"--sweep", "s.csv"}, plot = {"--sweep-plot", "s.svg"};
  const std::pair<Words, std::string> values[] = {
      {{"core_count"}, "--vary: 'core_count' is not KEY=VALUE,VALUE,... with a key of machine files"},
      {{"core_cuont=1"}, "'core_cuont' ('gridiron machines --help' lists them); did you mean core_count?"},
      {{"work_cycles.wait=1"}, "--vary: unknown key 'work_cycles.wait'"},
      {{"core_count="}, "--vary core_count: 'core_count' has no value"},
      {{"core_count=1,,2"}, "--vary core_count: 'core_count' has no value"},
      {{"core_count=1,four"}, "--vary core_count: 'four' is not a whole number from 1 to 1024"},
      {{"core_count=1,1025"}, "--vary core_count: 'core_count' must be from 1 to 1024, not '1025'"},
      {{"latency_cycles=400:0.9 500:0.2"}, "--vary latency_cycles: the shares of 'latency_cycles' add up to 1.1"},
      {{"clock_hz=fast"}, "--vary clock_hz: 'fast' is not a number from 1 to 1e12"},
      {{"local_store_bytes=65536"}, "'local_store_bytes' changes the frame itself, not only its time: render it for"},
      {{"main_memory_bytes=65536"}, "'main_memory_bytes' changes the frame itself"},
      {{"queue_depth=4"}, "'queue_depth' changes the frame itself"},
      {{"master.clock_hz=1e9"}, "'master.clock_hz' is of builds, which a frame's time does not contain"},
      {{"pass_start_cycles=1"}, "'pass_start_cycles' is of builds"},
  };
  for (const auto& [value, words] : values) expect_refusal(table + Words{"--vary"} + value, words);
  const Words cores = {"--vary", "core_count=1,2"};
  std::string many = "clock_hz=1", most = "latency_cycles=0";
  for (int i = 2; i <= 64; ++i) many += "," + std::to_string(i);
  for (int i = 1; i <= 64; ++i) most += "," + std::to_string(i);
  const std::pair<Words, std::string> cases[] = {
      {cores, "--vary: needs --sweep or --sweep-plot"},
      {table, "--sweep: needs --vary"},
      {plot, "--sweep-plot: needs --vary"},
      {table + cores + cores, "--vary: second 'core_count'"},
      {table + cores + Words{"--vary", "clock_hz=1", "--vary", "claim_cycles=1", "--vary", "wait_cycles=1"},
       "--vary: at most 3 keys"},
      {table + Words{"--vary", many, "--vary", most}, "--vary: more than 4,096 machines"},
      {table + cores + Words{"--cores", "2"}, "--cores and --vary core_count: both say how many"},
      {table + cores + Words{"--mode", "plain"}, "--vary: --mode plain counts no cycles"},
      {table + cores + Words{"--lanes", "1"}, "--vary: cycles are counted for --lanes 4 only"},
      {table + cores + Words{"--tile", "0,0"}, "--vary: cycles are not counted for one tile alone"},
      {table + cores + Words{"--machine", "fu540"}, "--vary: the prices of fu540 are instructions"},
      {plot + Words{"--vary", "latency_cycles=5,4:0.5 6:0.5"},
       "--sweep-plot: the first key, 'latency_cycles', is the axis, which has no place for '4:0.5 6:0.5'"},
      {plot + Words{"--vary", "core_count=2,2", "--vary", "clock_hz=1,2"},
       "--sweep-plot: the first key, 'core_count', is the axis, which needs two values"},
      {plot + cores + Words{"--vary", many}, "--sweep-plot: shows at most 16 curves"},
      {plot + cores +
           Words{"--vary", "latency_cycles=1:.1 2:.1 3:.1 4:.1 5:.1 6:.1 7:.15 123456.789012345:.25", "--vary",
                 "clock_hz=3200000001"},
       "--sweep-plot: the name of a curve is too long"},
      {cores + Words{"--sweep", "a.ply"}, "--sweep a.ply: is the input"},
      {cores + plot + Words{"--sweep", "./s.svg"}, "are the same file"},
      {cores + Words{"--sweep", "-", "--report", "-"}, "are the same file"},
  };
  for (const auto& [arguments, words] : cases) expect_refusal(arguments, words);
  expect_failure(folder, Words{"render", "a.ply", "--size", "8x8", "-o", "a.png", "--sweep", "none/s.csv"} + cores, 1,
                 "none/s.csv: cannot write");
  expect_failure(folder, {"animate", "a.ply", "-o", "b", "--vary", "core_count=1"}, 2, "--vary is not an option");
}

// The machine of the last price of fu540 is fu540, whose times are instructions.
TEST(Sweep, NoMachineCountsInstructions) {
  const TemporaryFolder folder("a.ply", make_box(Vec3(0), Vec3(1)));
  const sim::MachineProfile& counted = *sim::find_machine_profile("fu540");
  const std::string price = tool::text_of(counted.work_cycles[0]);
  const std::string key = "work_cycles." + std::string(sim::work_kind(WorkId(0)).name);
  folder.write("own.machine", "based_on fu540\n" + key + " 12345\n");
  const Words sweep = {"render", "a.ply",     "--size",      "8x8",    "-o",    "a.png",
                       "--machine", "own.machine", "--sweep", "s.csv", "--vary", key + "=1," + price};
  expect_failure(folder, sweep, 2, "are instructions");
}

}  // namespace
}  // namespace gridiron::test
