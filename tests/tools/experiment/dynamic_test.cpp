// The experiment on dynamic scenes as a program: a tiny one, on generated scenes. SPDX-License-Identifier: Apache-2.0
#include "csv_rows.h"
#include "experiment/experiments.h"
#include "experiment/table.h"
#include "markup.h"
#include "two_runs.h"

namespace gridiron::test {
namespace {

namespace fs = std::filesystem;
using Rows = std::vector<std::vector<std::string>>;

const std::vector<std::string> kWays = {"grid", "bvh", "tree", "tree_by_cores"};

// A row by its view, cores and way, or cores and part.
std::size_t row_of(const Rows& rows, const std::string& view, const std::string& cores, const std::string& key,
                   const std::string& value) {
  for (std::size_t row = 1; row < rows.size(); ++row) {
    if (text_under(rows, row, "view") == view && text_under(rows, row, "cores") == cores &&
        text_under(rows, row, key) == value) {
      return row;
    }
  }
  ADD_FAILURE() << view << " on " << cores << " has no " << value;
  return 1;
}

// Frames a second follow from build and frame; what does not depend on the cores does not; a tree is one tree.
void expect_rates(const Rows& rows) {
  ASSERT_EQ(rows.size(), 1 + 4 * 6 * kWays.size()) << "two knots, the teapot and the knot of 20,000";
  for (std::size_t row = 1; row < rows.size(); ++row) {
    const std::string view = text_under(rows, row, "view"), cores = text_under(rows, row, "cores"),
                      way = text_under(rows, row, "way");
    SCOPED_TRACE(view + ", " + way + " on " + cores);
    EXPECT_EQ(way, kWays[(row - 1) % kWays.size()]);
    EXPECT_EQ(text_under(rows, row, "note"), "");
    const double build = number_under(rows, row, "build_ms"), frame = number_under(rows, row, "frame_ms");
    EXPECT_GT(build, 0);
    EXPECT_NEAR(number_under(rows, row, "fps") * (build + frame), 1e3, 1e-9);
    EXPECT_NEAR(number_under(rows, row, "still_fps") * frame, 1e3, 1e-9);
    EXPECT_NEAR(number_under(rows, row, "build_percent"), 100 * build / (build + frame), 1e-9);
    const std::size_t one = row_of(rows, view, "1", "way", way);
    if (way == "tree_by_cores") {
      EXPECT_EQ(frame, number_under(rows, row_of(rows, view, cores, "way", "tree"), "frame_ms"));
      if (cores != "1") {
        EXPECT_LT(build, number_under(rows, one, "build_ms"));
      }
    } else {
      EXPECT_EQ(build, number_under(rows, one, "build_ms")) << "the general core is one";
    }
    if (cores != "1") {
      EXPECT_LT(frame, number_under(rows, one, "frame_ms"));
    }
  }
}

// Passes add up to build and frame, and so do the parts by what binds them.
void expect_passes(const Rows& rates, const Rows& passes, const Rows& bindings) {
  std::map<std::pair<std::string, std::string>, double> sums, by_binding, of_build;
  for (std::size_t row = 1; row < passes.size(); ++row) {
    const auto key = std::pair(text_under(passes, row, "view"), text_under(passes, row, "cores"));
    sums[key] += number_under(passes, row, "ms");
  }
  for (std::size_t row = 1; row < bindings.size(); ++row) {
    const auto key = std::pair(text_under(bindings, row, "view"), text_under(bindings, row, "cores"));
    for (const char* limit : {"channel", "compute", "waiting", "one_item", "barrier", "general_core"}) {
      by_binding[key] += number_under(bindings, row, std::string(limit) + "_ms");
    }
    EXPECT_EQ(text_under(bindings, row, "part") == "picture" && number_under(bindings, row, "general_core_ms") > 0,
              false);
  }
  EXPECT_EQ(sums.size(), 4u * 6);
  EXPECT_EQ(by_binding.size(), sums.size());
  for (const auto& [key, sum] : sums) {
    SCOPED_TRACE(key.first + " on " + key.second);
    const std::size_t row = row_of(rates, key.first, key.second, "way", "tree_by_cores");
    const double both = number_under(rates, row, "build_ms") + number_under(rates, row, "frame_ms");
    EXPECT_NEAR(sum, both, 1e-9 * both);
    EXPECT_NEAR(by_binding[key], both, 1e-9 * both);
  }
}

// From the frame on that pays, and not before, a way takes less than the tree that the cores build; and the best is it.
void expect_choice(const Rows& rates, const Rows& pays, const std::string& page) {
  ASSERT_EQ(pays.size(), 1u + 4 * 6);
  std::size_t payments = 0;
  for (std::size_t row = 1; row < pays.size(); ++row) {
    const std::string view = text_under(pays, row, "view"), cores = text_under(pays, row, "cores");
    SCOPED_TRACE(view + " on " + cores);
    const auto time = [&](const std::string& way, double frames) {
      const std::size_t at = row_of(rates, view, cores, "way", way);
      return number_under(rates, at, "build_ms") / frames + number_under(rates, at, "frame_ms");
    };
    for (const std::string way : {"grid", "bvh"}) {
      const std::string text = text_under(pays, row, way + "_pays_after_frames");
      constexpr double kNever = 1e12;
      if (text.empty()) {
        EXPECT_GE(time(way, kNever), time("tree_by_cores", kNever));
        continue;
      }
      ++payments;
      const double frames = std::stod(text);
      EXPECT_LT(time(way, frames), time("tree_by_cores", frames));
      if (frames > 1) {
        EXPECT_GE(time(way, frames - 1), time("tree_by_cores", frames - 1));
      }
    }
    const std::string hierarchy = text_under(pays, row, "bvh_pays_over_grid_after_frames");
    if (hierarchy.empty()) {
      EXPECT_GE(time("bvh", 1e12), time("grid", 1e12));
    } else {
      EXPECT_LT(time("bvh", std::stod(hierarchy)), time("grid", std::stod(hierarchy)));
    }
    for (const std::string& way : kWays) {
      const double tenth = number_under(pays, row, way + "_tenth_after_frames");
      const double build = number_under(rates, row_of(rates, view, cores, "way", way), "build_ms");
      EXPECT_LE(build, 0.1 * tenth * time(way, tenth) * (1 + 1e-12));
      if (tenth > 1) {
        EXPECT_GT(build, 0.1 * (tenth - 1) * time(way, tenth - 1));
      }
    }
    for (const std::string frames : {"1", "3", "10", "30", "100", "300", "1000"}) {
      const std::string best = text_under(pays, row, "best_of_" + frames);
      for (const std::string& way : kWays) {
        EXPECT_LE(time(best, std::stod(frames)), time(way, std::stod(frames))) << way << " of " << frames;
      }
    }
  }
  EXPECT_NE(page.find("If nothing is ever built, it is"), std::string::npos);
  if (payments == 0) {
    EXPECT_NE(page.find("never pays"), std::string::npos);
  }
}

TEST(DynamicExperiment, FilesFollowFromEachOtherAndNotFromThreads) {
  const TemporaryFolder folder;
  run_twice(folder, [](const std::string& output, const std::string& threads) {
    return Words{"experiment", "dynamic",   "-o",   output,      "--scenes", ".",      "--size",
                 "256x192",    "--largest", "6000", "--threads", threads,    "--quiet"};
  });
  const std::set<std::string> names = expect_same_files(folder, experiment::dynamic_file_names());
  EXPECT_EQ(names.size(), experiment::dynamic_file_names().size());
  const fs::path out = folder.path("out1");
  const std::string page = read_file(out / "index.html");
  EXPECT_EQ(page.find("nan"), std::string::npos);
  const Rows rates = csv_rows(out / "dynamic.csv");
  expect_rates(rates);
  expect_passes(rates, csv_rows(out / "dynamic_passes.csv"), csv_rows(out / "dynamic_bindings.csv"));
  expect_choice(rates, csv_rows(out / "dynamic_pays.csv"), page);

  // What the page says of the general core's tree against the cores'.
  double least = 1e9, greatest = 0;
  for (std::size_t row = 1; row < rates.size(); ++row) {
    if (text_under(rates, row, "cores") != "6" || text_under(rates, row, "way") != "tree") continue;
    const double by_cores = number_under(rates, row + 1, "build_ms");
    const double ratio = number_under(rates, row, "build_ms") / by_cores;
    least = std::min(least, ratio);
    greatest = std::max(greatest, ratio);
  }
  EXPECT_NE(page.find("6 cores build it " + experiment::fixed_text(least, 1) + " to " +
                      experiment::fixed_text(greatest, 1) + " times as fast"),
            std::string::npos);
}

}  // namespace
}  // namespace gridiron::test
