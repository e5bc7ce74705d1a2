// The experiment as a program: a tiny one, on generated scenes. SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <csignal>
#include <thread>

#include "csv_rows.h"
#include "experiment/experiments.h"
#include "experiment/sections.h"
#include "markup.h"
#include "two_runs.h"

namespace gridiron::test {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> tiny_paper(const std::string& output, const std::string& threads) {
  // The folder itself holds no scans, so that GRIDIRON_SCENES does not matter.
  return {"experiment", "paper",     "-o",   output,      "--scenes", ".",      "--size",
          "64x48",      "--largest", "6000", "--threads", threads,    "--quiet"};
}

// The cached BVH: every table has it, and columns that follow from two others do follow.
void expect_bvh(const fs::path& folder) {
  const auto frames = csv_rows(folder / "fig7_frames.csv"), built = csv_rows(folder / "fig7_with_build.csv");
  const auto cycles = csv_rows(folder / "fig7_cycles.csv");
  ASSERT_EQ(frames.size(), 5u) << "two views on two machines";
  ASSERT_EQ(built.size(), frames.size());
  for (std::size_t row = 1; row < frames.size(); ++row) {
    SCOPED_TRACE(row);
    const double clock = frames[row][0] == "cell-2006" ? 2.4e9 : 3.2e9;
    for (const std::string side : {"reference", "grid", "bvh_single", "bvh"}) {
      const double fps = number_under(frames, row, side + "_fps");
      const double build_ms = number_under(built, row, (side.starts_with("bvh") ? "bvh" : side) + "_build_ms");
      EXPECT_NEAR(number_under(cycles, row, side + "_mcycles") * 1e6 * fps, clock, 1e-6 * clock);
      EXPECT_NEAR(number_under(built, row, side + "_with_build_fps") * (1 / fps + build_ms / 1e3), 1, 1e-9);
    }
    EXPECT_NEAR(number_under(frames, row, "grid_over_bvh") * number_under(frames, row, "bvh_fps"),
                number_under(frames, row, "grid_fps"), 1e-6);
    const double best = number_under(frames, row, "best_fps");
    EXPECT_NEAR(number_under(frames, row, "best_over_bvh") * number_under(frames, row, "bvh_fps"), best, 1e-6);
    EXPECT_NEAR(number_under(frames, row, "best_over_grid") * number_under(frames, row, "grid_fps"), best, 1e-6);
    EXPECT_NEAR(number_under(cycles, row, "best_mcycles") * 1e6 * best, clock, 1e-6 * clock);
  }
  EXPECT_EQ(csv_rows(folder / "fig7_caches.csv").size(), 9u) << "two views, two machines, with and without turns";
  EXPECT_NE(csv_rows(folder / "host_fig7.csv").at(0).at(5), "") << "Embree has its column";

  // The steps of the build add up to its time.
  const auto steps = csv_rows(folder / "fig7_build_steps.csv");
  double grid_mcycles = 0, bvh_mcycles = 0;
  for (std::size_t row = 1; row < steps.size(); ++row) {
    if (steps[row][0] != steps[1][0]) continue;
    grid_mcycles += number_under(steps, row, "grid_mcycles");
    bvh_mcycles += number_under(steps, row, "bvh_mcycles");
  }
  EXPECT_NEAR(grid_mcycles / 2.4e3, number_under(built, 1, "grid_build_ms") / 1e3, 1e-9);
  EXPECT_NEAR(bvh_mcycles / 2.4e3, number_under(built, 1, "bvh_build_ms") / 1e3, 1e-9);

  // A map is as long as its store; its regions follow each other.
  const auto map = csv_rows(folder / "local_store_map_bvh.csv");
  double end = 0;
  for (std::size_t row = 1; row + 4 < map.size(); ++row) {
    EXPECT_GE(number_under(map, row, "offset"), end);
    end = number_under(map, row, "offset") + number_under(map, row, "bytes");
  }
  double sum = end;
  for (std::size_t row = map.size() - 4; row + 1 < map.size(); ++row) sum += number_under(map, row, "bytes");
  EXPECT_LE(sum, number_under(map, map.size() - 1, "bytes"));
  EXPECT_GT(sum, number_under(map, map.size() - 1, "bytes") - 128) << "padding of the last region at most";
}

// Store and tiles: every value has its frame on every view, figures follow from each other, and no pixel differs.
void expect_sweeps(const fs::path& folder) {
  for (const char* name : {"sweep_local_store.csv", "sweep_tile_width.csv"}) {
    SCOPED_TRACE(name);
    const auto rows = csv_rows(folder / name);
    ASSERT_EQ(rows.size(), 1u + 2u * 3u * 4u) << "two views, three configurations, four values";
    const auto column = [&rows](const char* key) {
      return static_cast<std::size_t>(std::ranges::find(rows[0], key) - rows[0].begin());
    };
    const std::string swept = std::string(name) == "sweep_tile_width.csv" ? "tile_width" : "store_kb";
    const std::vector<std::string> values = swept == "store_kb" ? std::vector<std::string>{"64", "128", "256", "512"}
                                                                : std::vector<std::string>{"8", "16", "32", "64"};
    for (std::size_t row = 1; row < rows.size(); ++row) {
      SCOPED_TRACE(row);
      EXPECT_EQ(rows[row][column(swept.c_str())], values[(row - 1) % 4]);
      const bool is_best = rows[row][1] == "best";
      if (is_best && swept == "tile_width" && (row - 1) % 4 < 2) {
        EXPECT_EQ(rows[row][column("fps")], "");
        EXPECT_EQ(rows[row][column("note")], "not built");
        continue;
      }
      EXPECT_EQ(rows[row][column("same_picture")], "yes");
      EXPECT_GT(number_under(rows, row, "fps"), 0);
      const std::string usual = swept == "store_kb" ? "256" : is_best ? "64" : "32";
      const std::size_t usual_row = row - (row - 1) % 4 + (is_best && swept == "tile_width" ? 3 : 2);
      EXPECT_EQ(rows[usual_row][column(swept.c_str())], usual);
      EXPECT_NEAR(number_under(rows, row, "fps_over_usual") * number_under(rows, usual_row, "fps"),
                  number_under(rows, row, "fps"), 1e-6);
      const double tile = number_under(rows, row, "tile_width"), packet = number_under(rows, row, "packet_width");
      EXPECT_EQ(packet, is_best ? 0 : rows[row][1] == "reference" ? 8 : std::min(tile, 32.0));
    }
    // A frame must not be mistaken for another one: neighbours differ in time or in bytes.
    EXPECT_NE(rows[1][column("fps")], rows[3][column("fps")]);
  }
  const auto fits = csv_rows(folder / "local_store_fit.csv");
  ASSERT_EQ(fits.size(), 1u + 4u * 7u);
  for (std::size_t row = 1; row < fits.size(); ++row) {
    const bool fits_here = number_under(fits, row, "data_bytes") <= number_under(fits, row, "room_bytes");
    EXPECT_EQ(fits[row][5], fits_here ? "yes" : "no") << row;
  }
  for (const char* configuration : {"reference", "grid", "best"}) {
    const auto map = csv_rows(folder / ("local_store_map_" + std::string(configuration) + ".csv"));
    EXPECT_EQ(map.at(0).size(), 1u + 2u * 4u);
    for (const char* size : {"64", "128", "256", "512"}) {
      const std::string key = std::string("store_") + size + "_bytes";
      EXPECT_EQ(number_under(map, map.size() - 1, key), std::stod(size) * 1024) << configuration;
    }
  }
}

// Least and greatest values of rows under a key, as the page words them.
experiment::Range range_under(const std::vector<std::vector<std::string>>& rows, const std::string& key) {
  experiment::Range range;
  for (std::size_t row = 1; row < rows.size(); ++row) range.add(number_under(rows, row, key));
  return range;
}

// Rows that have a word in a column, the keys in front.
std::vector<std::vector<std::string>> rows_of(const std::vector<std::vector<std::string>>& rows, std::size_t column,
                                              const std::string& word) {
  std::vector<std::vector<std::string>> chosen = {rows.at(0)};
  for (const auto& row : rows) {
    if (row.at(column) == word) chosen.push_back(row);
  }
  return chosen;
}

// The sentences of the page follow from its tables.
void expect_words(const fs::path& folder, const std::string& page) {
  const auto expect = [&page](const std::string& words) { EXPECT_NE(page.find(words), std::string::npos) << words; };
  // Table 3: the paper's systems apart from the others.
  const auto costs = csv_rows(folder / "table3_shading_cost.csv");
  experiment::Range of_paper = range_under(costs, "reference_percent"), others = range_under(costs, "grid_percent");
  for (std::size_t row = 1; row < costs.size(); ++row) {
    of_paper.add(number_under(costs, row, "projection_percent"));
    others.add(number_under(costs, row, "bvh_percent"));
    others.add(number_under(costs, row, "best_percent"));
  }
  expect("costs the reference, with either test, " + of_paper.percent(1) +
         " of its fps, and the other systems, whose " + "frames are shorter, " + others.percent(1));
  EXPECT_EQ(page.find("For the reference that is less than the paper's") != std::string::npos,
            of_paper.greatest() < 10);

  // Fig. 6 and Table 4: computation grows by, and the paper's own test against the reference's.
  const auto bars = csv_rows(folder / "fig6_breakdown.csv");
  experiment::Range growths, work_ratios;
  for (std::size_t row = 1; row + 1 < bars.size(); row += 2) {
    ASSERT_EQ(bars[row][3] + bars[row + 1][3], "singlehidden");
    const double hidden = number_under(bars, row + 1, "compute_ms");
    growths.add(experiment::percent_more(hidden, number_under(bars, row, "compute_ms")));
    for (std::size_t other = 1; other < bars.size(); ++other) {
      const bool same = bars[other][1] == bars[row][1] && bars[other][2] == bars[row][2] && bars[other][3] == "hidden";
      if (bars[row][0] != "projection" || bars[other][0] != "reference" || !same) continue;
      work_ratios.add(hidden / number_under(bars, other, "compute_ms"));
    }
  }
  expect("computation changes by " + growths.percent(1));
  expect("times the reference's bytes and computes for " + work_ratios.text(2) + " times its cycles");

  // Best against grid.
  const auto against = csv_rows(folder / "best_against_grid.csv");
  EXPECT_EQ(rows_of(against, against.at(0).size() - 1, "yes").size(), against.size()) << "the same pictures";
  EXPECT_EQ(against.size(), 5u) << "two views, without and with shading";
  expect("it renders " + range_under(against, "fps_ratio").text(2) + " times the frames of configuration grid");
  expect("of the hierarchy with hyper-threading and " +
         range_under(csv_rows(folder / "fig7_frames.csv"), "best_over_grid").text(2) + " times those of");
  const auto growth = csv_rows(folder / "table1_growth.csv");
  EXPECT_EQ(rows_of(growth, 0, "best").size(), rows_of(growth, 0, "grid").size());

  // Grid: the costs and gains of its depths; the sweeps' tables have the same frames.
  const auto depths = rows_of(csv_rows(folder / "sweep_macro_depth.csv"), 1, "grid");
  experiment::Range lost, waits;
  for (std::size_t row = 1; row < depths.size(); ++row) {
    if (depths[row][2] != "4") continue;
    waits.add(number_under(depths, row, "wait_percent"));
    double most = 0;
    for (std::size_t other = 1; other < depths.size(); ++other) {
      if (depths[other][0] == depths[row][0]) most = std::max(most, number_under(depths, other, "fps"));
    }
    lost.add(experiment::percent_less(number_under(depths, row, "fps"), most));
  }
  expect(lost.percent(2) + " for its 4 cell blocks, with which it waits " + waits.percent(2));

  // Fig. 7: a reason where the reference is far from the paper's half.
  const auto frames = rows_of(csv_rows(folder / "fig7_frames.csv"), 0, "cell-2006");
  const experiment::Range cases = range_under(frames, "paper_case_ratio");
  expect("gives " + cases.text(2) + " of its frames");
  EXPECT_EQ(page.find("The difference is the cached BVH's") != std::string::npos, cases.greatest() < 0.4);

  // Latency: the hierarchy without and with its ring.
  const auto caches = rows_of(csv_rows(folder / "fig7_caches.csv"), 0, "cell-ps3");
  expect("for " + range_under(rows_of(caches, 2, "one at a time"), "wait_percent").percent(1) +
         " of its cycles with one packet at a time and for " +
         range_under(rows_of(caches, 2, "take turns"), "wait_percent").percent(1) + " with its ring of packets");

  // Bandwidth: double against single buffering where it is scarcest.
  const auto scarce = rows_of(rows_of(csv_rows(folder / "sweep_bandwidth.csv"), 2, "1.44"), 1, "6");
  experiment::Range gains;
  for (std::size_t row = 1; row < scarce.size(); ++row) {
    gains.add(number_under(scarce, row, "reference_fps") / number_under(scarce, row, "reference_single_fps"));
  }
  expect("gives the reference " + gains.text(2) + " times the frames of single buffering");

  // Both runs of a row of the packet sweep report their bytes; deeper prefetch never fetches less.
  const auto packets = csv_rows(folder / "sweep_packet.csv");
  for (std::size_t row = 1; row < packets.size(); ++row) {
    EXPECT_GE(number_under(packets, row, "prefetch_fetched_mb"), number_under(packets, row, "double_fetched_mb"));
  }
  // Words that a reader of the page does not know.
  for (const char* words : {"that we have", "master", "deep prefetch"}) EXPECT_EQ(page.find(words), std::string::npos);
}

TEST(Experiment, FilesDoNotDependOnThreads) {
  const TemporaryFolder folder;
  // What lies in a folder already: files of an evaluation with other scenes go, everything else stays.
  fs::create_directory(folder.path("out3"));
  folder.write("out3/sweep_latency_bunny.svg", "earlier");
  folder.write("out3/table3_fps.csv", "earlier");
  fs::create_symlink("../kept.svg", folder.path("out3") / "sweep_latency_horse.svg");
  folder.write("kept.svg", "not of the folder");
  folder.write("out3/sweep_latency_mine.svg", "somebody's");
  run_twice(folder, tiny_paper);
  EXPECT_EQ(read_file(folder.path("kept.svg")), "not of the folder");
  EXPECT_TRUE(fs::remove(folder.path("out3") / "sweep_latency_mine.svg"));
  const std::vector<std::string> known = experiment::paper_file_names();
  const std::set<std::string> names = expect_same_files(folder, known);
  const auto is_compared = [](const std::string& name) { return !name.starts_with("host_"); };
  EXPECT_GE(std::ranges::count_if(names, is_compared), 35);
  EXPECT_EQ(names.count("host_fig7.csv"), 1u);
  expect_bvh(folder.path("out1"));

  EXPECT_EQ(known.size() - names.size(), 2u * 5u + 1u) << "missing: what is of the paper's views";
  expect_sweeps(folder.path("out1"));

  const std::string page = read_file(folder.path("out1") / "index.html");
  EXPECT_NE(page.find("bunny.ply was not found"), std::string::npos);
  EXPECT_EQ(page.find("none %"), std::string::npos);
  EXPECT_EQ(page.find("nan"), std::string::npos);
  expect_words(folder.path("out1"), page);
}

TEST(Experiment, MistakesAreTold) {
  const TemporaryFolder folder;
  folder.write("file", "no folder");
  const struct {
    Words arguments;
    int exit_code;
    const char* words;
  } cases[] = {
      {{"experiment"}, 2, "NAME"},
      {{"experiment", "paper"}, 2, "-o DIR is required"},
      {{"experiment", "speed", "-o", "out"}, 2, "'speed' is not one of paper|accuracy"},
      {{"experiment", "paper", "-o", "out", "--threads", "0"}, 2, "1 to 256"},
      {{"experiment", "paper", "-o", "out", "--largest", "10"}, 2, "6000"},
      {{"experiment", "paper", "-o", "out", "--size", "64"}, 2, "WxH"},
      {{"experiment", "paper", "-o", "out", "--scenes", "nowhere"}, 1, "nowhere: no such folder"},
      {{"experiment", "paper", "-o", "no/such/out"}, 1, "no/such/out"},
      {{"experiment", "paper", "-o", "file"}, 1, "file: "},
      {{"experiment", "paper", "-o", "file/out"}, 1, "file/out: cannot make the folder"},
      {{"experiment", "paper", "-o", ""}, 2, "'' is not the name of a folder"},
  };
  for (const auto& [arguments, exit_code, words] : cases) expect_failure(folder, arguments, exit_code, words);
}

// Found before anything is read or rendered: the scan, which is wrong, is not even looked at.
TEST(Experiment, AnOutputThatCannotBeIsToldFirst) {
  const TemporaryFolder folder("bunny.ply", "nonsense");
  for (const char* name : {"index.html", "sweep_local_store.csv", "fig6_grid_6_cores.svg", "sweep_latency_bunny.svg"}) {
    const fs::path obstacle = folder.path("out") / name;
    fs::create_directories(obstacle);
    expect_failure(folder, tiny_paper("out", "1"), 1, std::string("out/") + name + ": cannot write: it is a folder");
    fs::remove_all(folder.path("out"));
  }
  // A folder that was there stays, with what lies in it.
  fs::create_directories(folder.path("out") / "index.html");
  (void)run_program(folder.folder(), tiny_paper("out", "1"));
  EXPECT_EQ(names_in(folder.path("out")), std::set<std::string>{"index.html"});
}

TEST(Experiment, AWrongScanLeavesNothing) {
  const TemporaryFolder folder("bunny.ply", "ply\nformat ascii 1.0\nnonsense\n");
  expect_failure(folder, tiny_paper("out", "1"), 1, "bunny.ply:3");
  EXPECT_EQ(folder.names(), std::vector<std::string>{"bunny.ply"});
}

TEST(Experiment, AnInterruptLeavesNothing) {
  const TemporaryFolder folder;
  RunningProgram program(folder.folder(), {"experiment", "paper", "-o", "out", "--scenes", ".", "--threads", "2"});
  while (!fs::exists(folder.path("out"))) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  program.send(SIGINT);
  const ProgramResult result = program.wait();
  EXPECT_EQ(result.exit_code, 130) << result.err;
  EXPECT_EQ(folder.names(), std::vector<std::string>{});
}

}  // namespace
}  // namespace gridiron::test
