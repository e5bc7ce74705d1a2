// Sweep of the cached BVH: each of its settings is changed by itself, to show that it is tuned.
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <functional>

#include "experiment/bvh_system.h"
#include "experiment/sections.h"

namespace gridiron::experiment {
namespace {

/// A setting with a value other than the tuned one.
struct Change {
  const char* setting;
  std::string value, tuned;
  BvhVariant variant;
};

std::vector<Change> make_changes() {
  const bvh::BvhParameters build;
  const bvh::RenderOptions options;
  std::vector<Change> changes;
  const auto add = [&](const char* setting, std::string value, std::string tuned,
                       const std::function<void(BvhVariant&)>& change) {
    BvhVariant variant{"bvh/" + std::string(setting) + "=" + value, build, options};
    change(variant);
    changes.push_back({setting, std::move(value), std::move(tuned), std::move(variant)});
  };
  const auto square = [](std::uint32_t width) { return std::to_string(width) + "x" + std::to_string(width); };
  const auto lines = [](std::uint32_t records, std::uint32_t count) {
    return std::to_string(records) + " a line, " + std::to_string(count) + " lines";
  };

  add("rays of a packet", square(8), square(options.packet_width),
      [](BvhVariant& variant) { variant.options.packet_width = 8; });
  add("packets taking turns", "1", std::to_string(options.ring_size),
      [](BvhVariant& variant) { variant.options.hyper_threading = false; });
  for (std::uint32_t size = 2; size <= bvh::kRingOf<bvh::kPacketWidth>; ++size) {
    if (size == options.ring_size) continue;
    add("packets taking turns", std::to_string(size), std::to_string(options.ring_size),
        [size](BvhVariant& variant) { variant.options.ring_size = size; });
  }
  using Lines = std::pair<std::uint32_t, std::uint32_t>;
  for (const auto& [records, count] : {Lines{8, 64}, Lines{8, 32}, Lines{16, 16}}) {
    add("node cache", lines(records, count), lines(build.line_nodes, options.caches.node_lines),
        [records = records, count = count](BvhVariant& variant) {
          variant.build.line_nodes = records;
          variant.options.caches.node_lines = count;
        });
  }
  for (const auto& [records, count] : {Lines{16, 64}, Lines{32, 32}, Lines{64, 8}}) {
    add("triangle cache", lines(records, count), lines(build.line_triangles, options.caches.triangle_lines),
        [records = records, count = count](BvhVariant& variant) {
          variant.build.line_triangles = records;
          variant.options.caches.triangle_lines = count;
        });
  }
  add("triangles culled by", "corner rays", "subpackets",
      [](BvhVariant& variant) { variant.options.use_subpackets = false; });
  for (const std::uint32_t count : {2u, 4u, 6u}) {
    add("triangles of a leaf, at most", std::to_string(count), std::to_string(build.leaf_triangles),
        [count](BvhVariant& variant) { variant.build.leaf_triangles = count; });
  }
  for (const float cost : {0.25f, 0.5f, 1.0f, 2.0f}) {
    add("cost of a triangle, in boxes", number_text(cost), number_text(build.triangle_cost),
        [cost](BvhVariant& variant) { variant.build.triangle_cost = cost; });
  }
  for (const std::uint32_t count : {4u, 8u, 16u}) {
    add("bins of an axis", std::to_string(count), std::to_string(build.bin_count),
        [count](BvhVariant& variant) { variant.build.bin_count = count; });
  }
  return changes;
}

}  // namespace

Writer plan_bvh_sweep(Plan& plan, const Stage& stage) {
  struct Row {
    Change change;
    std::vector<Plan::RunId> runs;  ///< by view
  };
  const auto runs_of = [&](const std::shared_ptr<const System>& system) {
    std::vector<Plan::RunId> runs;
    for (const View& view : stage.views()) {
      runs.push_back(plan.add(view, system, Shading::kNone, stage.machine, kPaperCores));
    }
    return runs;
  };
  const std::vector<Plan::RunId> tuned = runs_of(contender_named(stage, "bvh").system);
  std::vector<Row> rows;
  for (Change& change : make_changes()) {
    auto system = std::make_shared<BvhSystem>(change.variant);
    rows.push_back({std::move(change), runs_of(std::move(system))});
  }
  return [&stage, tuned, rows](const Plan& done, Book& book) {
    Table table = make_table("sweep_bvh", "setting", "value", Column("tuned_value", "instead of"));
    for (const View& view : stage.views()) {
      table.columns.push_back({view.key + "_cycles_percent", view.title + ": cycles, % more", 1});
    }
    table.columns.push_back({"mean_cycles_percent", "geometric mean, % more", 1});
    double fastest = 0;
    std::string fastest_words;
    for (const Row& row : rows) {
      std::vector<Cell> cells = {row.change.setting, row.change.value, row.change.tuned};
      double logarithms = 0;
      for (std::size_t view = 0; view < tuned.size(); ++view) {
        const double ratio = done.result(tuned[view]).fps() / done.result(row.runs[view]).fps();
        cells.emplace_back(100 * (ratio - 1));
        logarithms += std::log(ratio);
      }
      const double mean = 100 * (std::exp(logarithms / static_cast<double>(tuned.size())) - 1);
      cells.emplace_back(mean);
      if (mean < fastest) {
        fastest = mean;
        fastest_words = std::string(row.change.setting) + " " + row.change.value;
      }
      table.add(std::move(cells));
    }
    book.section("bvh", "Sweep: the cached BVH's settings");
    book.paragraph(
        "Each line changes one setting of the hierarchy as the other sections show it; the hierarchy is built and "
        "rendered anew. " +
        (fastest_words.empty()
             ? std::string("No other value is faster in the mean over the views.")
             : "Of these values the fastest, " + fastest_words + ", takes " + fixed_text(-fastest, 1) +
                   " % fewer cycles in the mean over the views; the "
                   "comparison with the grid is to be read with that in mind."));
    book.table(table, "The hierarchy with software caches, 6 cores, no shading: cycles of a frame.");
  };
}

}  // namespace gridiron::experiment
