// The accuracy experiment as a program: a tiny one, on generated scenes. SPDX-License-Identifier: Apache-2.0
#include "csv_rows.h"
#include "experiment/experiments.h"
#include "experiment/table.h"
#include "gridiron/device/accuracies.h"
#include "markup.h"
#include "two_runs.h"

namespace gridiron::test {
namespace {

namespace fs = std::filesystem;
using Rows = std::vector<std::vector<std::string>>;

std::vector<std::string> tiny_accuracies(const std::string& output, const std::string& threads) {
  // The folder itself holds no scans, so that GRIDIRON_SCENES does not matter.
  return {"experiment", "accuracy", "-o", output, "--scenes", ".", "--size", "64x48", "--threads", threads, "--quiet"};
}

// Every view has every profile in every configuration, but paper in best, and figures follow from each other.
void expect_prices(const Rows& rows) {
  const std::size_t profiles = tool::accuracies().size(), of_view = 3 * profiles - 1;
  ASSERT_EQ(rows.size(), 1 + 2 * of_view);
  for (std::size_t row = 1; row < rows.size(); ++row) {
    SCOPED_TRACE(row);
    const std::string profile = text_under(rows, row, "profile");
    const std::size_t place = (row - 1) % of_view;
    const bool is_best = place >= 2 * profiles;
    EXPECT_EQ(profile, tool::accuracies()[(is_best ? place + 1 : place) % profiles].name);
    EXPECT_EQ(text_under(rows, row, "configuration"), is_best ? "best" : place < profiles ? "grid" : "reference");
    for (const std::string frame : {"", "with_distances_", "starved_"}) {
      EXPECT_NEAR(number_under(rows, row, frame + "cycles") * number_under(rows, row, frame + "fps"), 3.2e9, 1);
    }
    EXPECT_LT(number_under(rows, row, "cycles"), number_under(rows, row, "with_distances_cycles"));
    EXPECT_LT(number_under(rows, row, "dma_in_bytes"), number_under(rows, row, "dma_bytes"));
    if (is_best) {
      EXPECT_EQ(text_under(rows, row, "triangle_bytes"), "");
      EXPECT_EQ(text_under(rows, row, "edge_rays"), "");
    } else {
      EXPECT_LT(number_under(rows, row, "dma_triangle_bytes"), number_under(rows, row, "dma_in_bytes"));
      EXPECT_LT(number_under(rows, row, "triangle_bytes"), number_under(rows, row, "scene_bytes"));
    }
    EXPECT_LT(number_under(rows, row, "scene_bytes"), number_under(rows, row, "main_memory_bytes"));
    EXPECT_LE(number_under(rows, row, "local_store_bytes"), 256 * 1024);
    for (const std::string where : {"", "edge_"}) {
      if (is_best && where == "edge_") continue;
      const double rays = number_under(rows, row, where + "rays");
      EXPECT_GE(rays, 64 * 48);
      for (const std::string what : {"holes", "false_hits", "wrong_triangles", "seen_through"}) {
        EXPECT_NEAR(number_under(rows, row, where + what + "_per_million") * rays / 1e6,
                    number_under(rows, row, where + what), 1e-6);
      }
      if (profile == "exact") {
        EXPECT_EQ(number_under(rows, row, where + "wrong_triangles"), 0);
      }
    }
    EXPECT_LE(number_under(rows, row, "t_ulp_median"), number_under(rows, row, "t_ulp_p99"));
    EXPECT_LE(number_under(rows, row, "t_ulp_p99"), number_under(rows, row, "t_ulp_max"));
    EXPECT_LE(number_under(rows, row, "t_ulp_max"), number_under(rows, row, "t_all_hits_ulp_max"));
    const bool same = number_under(rows, row, "differing_pixels") == 0;
    EXPECT_EQ(text_under(rows, row, "psnr_db").empty(), same);
    EXPECT_EQ(number_under(rows, row, "greatest_pixel_error") == 0, same);
    if (profile == "exact" || profile == "standard") {
      EXPECT_EQ(number_under(rows, row, "t_ulp_max"), 0);
    }
  }
}

// What the page says of the targets is what their table says, and that what the prices say.
void expect_targets(const fs::path& folder, const std::string& page) {
  const Rows targets = csv_rows(folder / "targets.csv"), prices = csv_rows(folder / "prices.csv");
  EXPECT_EQ(targets.size(), 1u + 8u + 4u);
  std::size_t met = 0;
  for (std::size_t row = 1; row < targets.size(); ++row) {
    const bool is_met = number_under(targets, row, "worst_percent") <= number_under(targets, row, "limit_percent");
    EXPECT_EQ(text_under(targets, row, "met"), is_met ? "yes" : "no");
    met += is_met ? 1u : 0u;
    if (text_under(targets, row, "what") != "bytes moved by DMA a frame") continue;
    double worst = -100;
    for (std::size_t from = 1; from < prices.size(); ++from) {
      for (std::size_t to = 1; to < prices.size(); ++to) {
        const bool pair = prices[from][0] == prices[to][0] && prices[from][1] + prices[to][1] == "gridgrid" &&
                          prices[from][2] == "standard" && prices[to][2] == "compact";
        if (!pair) continue;
        const double change = number_under(prices, to, "dma_bytes") / number_under(prices, from, "dma_bytes");
        worst = std::max(worst, 100 * (change - 1));
      }
    }
    EXPECT_NEAR(number_under(targets, row, "worst_percent"), worst, 1e-9);
  }
  std::size_t said = 0;
  for (std::size_t place = page.find("met in every view"); place != std::string::npos;
       place = page.find("met in every view", place + 1)) {
    ++said;
  }
  EXPECT_EQ(said, met);
}

// Every kind of secondary rays has every profile that renders effects, and figures follow from each other.
void expect_secondary(const fs::path& folder, const std::string& page) {
  std::vector<std::string> profiles;
  for (const tool::NamedAccuracy& named : tool::accuracies()) {
    const bool renders = accuracy_traits(named.accuracy).has_scene_shading;
    if (renders) profiles.emplace_back(named.name);
    EXPECT_NE(page.find((renders ? "" : "They cannot with ") + std::string(named.name)), std::string::npos);
  }
  constexpr std::size_t kKinds = 5, kScenes = 4;
  const Rows overview = csv_rows(folder / "secondary.csv"), solids = csv_rows(folder / "secondary_solids.csv");
  const Rows frames = csv_rows(folder / "secondary_frames.csv");
  ASSERT_EQ(overview.size(), 1 + kKinds * profiles.size());
  ASSERT_EQ(solids.size(), overview.size());
  ASSERT_EQ(frames.size(), 1 + kScenes * kKinds * profiles.size());
  for (std::size_t row = 1; row < overview.size(); ++row) {
    SCOPED_TRACE(overview[row][0] + " " + overview[row][1]);
    const std::string profile = text_under(overview, row, "profile");
    EXPECT_EQ(profile, profiles[(row - 1) % profiles.size()]);
    EXPECT_EQ(text_under(solids, row, "profile"), profile);
    EXPECT_GT(number_under(overview, row, "cycles_per_ray"), 100);
    if (profile == "standard") {
      EXPECT_EQ(number_under(overview, row, "cycles_over_standard"), 1);
      EXPECT_EQ(number_under(overview, row, "cycles_per_ray_over_standard"), 1);
    }
    const bool is_fast = profile == "fast";
    EXPECT_LE(number_under(overview, row, "cycles_per_ray_over_standard"), is_fast ? 1 : 1.1);
    if (is_fast) {
      EXPECT_EQ(number_under(overview, row, "exact_per_million_rays"), 0);
    }
    EXPECT_EQ(number_under(overview, row, "self_hits_per_million"), 0);
    EXPECT_EQ(number_under(overview, row, "edge_leaks_per_million"), 0);
    EXPECT_EQ(number_under(solids, row, "edge_leaks"), 0);
    EXPECT_EQ(number_under(solids, row, "self_hits"), 0);
    EXPECT_EQ(number_under(overview, row, "differing_percent") == 0, profile != "compact");
    EXPECT_EQ(number_under(overview, row, "rms_pixel_error") == 0, profile != "compact");
  }
  for (std::size_t row = 1; row < frames.size(); ++row) {
    SCOPED_TRACE(frames[row][0] + " " + frames[row][1] + " " + frames[row][2]);
    EXPECT_GT(number_under(frames, row, "rays"), 0);
    EXPECT_EQ(number_under(frames, row, "rays_asked"), number_under(frames, row, "rays"));
    EXPECT_GT(number_under(frames, row, "cycles"), number_under(frames, row, "cycles_without"));
    for (const std::string decision : {"exact_signs", "exact_distances", "exact_orders", "double_signs"}) {
      const double extra = number_under(frames, row, decision) - number_under(frames, row, decision + "_without");
      EXPECT_NEAR(number_under(frames, row, decision + "_per_million_rays") * number_under(frames, row, "rays"),
                  1e6 * extra, 1);
    }
  }
}

TEST(AccuracyExperiment, FilesDoNotDependOnThreads) {
  const TemporaryFolder folder;
  // Files of a run with other scenes go, everything else stays: another experiment's too.
  fs::create_directory(folder.path("out3"));
  folder.write("out3/pareto_t_bunny.svg", "earlier");
  folder.write("out3/table3_fps.csv", "of another experiment");
  run_twice(folder, tiny_accuracies);
  EXPECT_TRUE(fs::remove(folder.path("out3") / "table3_fps.csv"));
  const std::vector<std::string> known = experiment::accuracy_file_names();
  const std::set<std::string> names = expect_same_files(folder, known);
  EXPECT_EQ(names.count("host_prices.csv"), 1u);
  EXPECT_EQ(known.size() - names.size(), 5u * 7u) << "what is missing is of the five views that are not there";

  const std::string page = read_file(folder.path("out1") / "index.html");
  EXPECT_NE(page.find("bunny.ply was not found"), std::string::npos);
  EXPECT_EQ(page.find("nan"), std::string::npos);
  EXPECT_EQ(page.find("none %"), std::string::npos);
  expect_prices(csv_rows(folder.path("out1") / "prices.csv"));
  expect_targets(folder.path("out1"), page);
  expect_secondary(folder.path("out1"), page);

  // The histogram holds each pixel of the true triangle once; points on a front are those that the table says.
  const Rows histogram = csv_rows(folder.path("out1") / "t_histogram.csv");
  const Rows prices = csv_rows(folder.path("out1") / "prices.csv");
  ASSERT_EQ(histogram.size(), prices.size());
  for (std::size_t row = 1; row < prices.size(); ++row) {
    double sum = 0;
    for (std::size_t column = 3; column < histogram[row].size(); ++column) sum += std::stod(histogram[row][column]);
    EXPECT_EQ(sum, number_under(prices, row, "true_hits") - number_under(prices, row, "holes") -
                       number_under(prices, row, "wrong_triangles"));
  }
  const Rows fronts = csv_rows(folder.path("out1") / "pareto.csv");
  const std::size_t priced = 3 * tool::accuracies().size() - 1, at_edges = 2 * tool::accuracies().size();
  EXPECT_EQ(fronts.size(), 1 + 3 * (2 * priced + at_edges)) << "three errors; two views, and all";
  for (std::size_t row = 1; row < fronts.size(); ++row) {
    bool beaten = false;
    for (std::size_t other = 1; other < fronts.size(); ++other) {
      if (fronts[other][0] != fronts[row][0] || fronts[other][1] != fronts[row][1]) continue;
      const double x = number_under(fronts, row, "mcycles"), other_x = number_under(fronts, other, "mcycles");
      const double y = number_under(fronts, row, "error_value"), other_y = number_under(fronts, other, "error_value");
      beaten = beaten || (other_x <= x && other_y <= y && (other_x < x || other_y < y));
    }
    EXPECT_EQ(text_under(fronts, row, "on_front"), beaten ? "no" : "yes") << row;
  }

  // The plain text is as wide as a README, and shows both tables.
  const std::string text = read_file(folder.path("out1") / "prices_teapot.txt");
  std::size_t line_begin = 0;
  for (std::size_t end = text.find('\n'); end != std::string::npos; end = text.find('\n', line_begin)) {
    EXPECT_LE(end - line_begin, 120u);
    line_begin = end + 1;
  }
  EXPECT_EQ(static_cast<std::size_t>(std::ranges::count(text, '\n')), 2 * (3 * tool::accuracies().size()) + 1);
}

TEST(AccuracyExperiment, MistakesAreTold) {
  const TemporaryFolder folder;
  const struct {
    Words arguments;
    int exit_code;
    const char* words;
  } cases[] = {
      {{"experiment", "accuracy"}, 2, "-o DIR is required"},
      {{"experiment", "accuracy", "-o", "out", "--largest", "6000"},
       2,
       "--largest: is of experiments paper and dynamic alone"},
      {{"experiment", "accuracy", "-o", "out", "--size", "0x9"}, 2, "WxH"},
      {{"experiment", "accuracy", "-o", "out", "--scenes", "nowhere"}, 1, "nowhere: no such folder"},
      {{"experiment", "accuracy", "-o", "no/such/out"}, 1, "no/such/out"},
  };
  for (const auto& [arguments, exit_code, words] : cases) expect_failure(folder, arguments, exit_code, words);
}

// Found before anything is read or rendered: the scan, which is wrong, is not even looked at.
TEST(AccuracyExperiment, AnOutputThatCannotBeIsToldFirst) {
  const TemporaryFolder folder("bunny.ply", "nonsense");
  for (const char* name : {"index.html", "host_prices.csv", "errors_grid_bunny.svg", "prices_conference_2.txt"}) {
    fs::create_directories(folder.path("out") / name);
    expect_failure(folder, tiny_accuracies("out", "1"), 1,
                   std::string("out/") + name + ": cannot write: it is a folder");
    fs::remove_all(folder.path("out"));
  }
}

// Where there is a scan nothing is made.
TEST(AccuracyExperiment, ScansAreTheViews) {
  const TemporaryFolder folder("bunny.ply", make_torus(24, 16, 1.0f, 0.4f));
  std::vector<std::string> arguments = tiny_accuracies("out", "2");
  arguments.pop_back();
  const ProgramResult result = run_program(folder.folder(), arguments);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.out.find("Horse is left out"), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("out/index.html: "), std::string::npos) << result.out;
  const std::set<std::string> names = names_in(folder.path("out"));
  EXPECT_EQ(names.count("prices_bunny.txt"), 1u);
  EXPECT_EQ(names.count("prices_teapot.txt"), 0u);
}

}  // namespace
}  // namespace gridiron::test
