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
  // One packet is a whole tile, so none takes turns.
  add("rays of a packet", square(bvh::kTileWidth), square(options.packet_width), [](BvhVariant& variant) {
    variant.options.packet_width = bvh::kTileWidth;
    variant.options.hyper_threading = false;
  });
  add("packets taking turns", "1", std::to_string(options.ring_size),
      [](BvhVariant& variant) { variant.options.hyper_threading = false; });
  // The largest ring has all packets of a tile.
  for (std::uint32_t size = 2; size <= bvh::kRingOf<bvh::kPacketWidth>; ++size) {
    if (size == options.ring_size) continue;
    add("packets taking turns", std::to_string(size), std::to_string(options.ring_size),
        [size](BvhVariant& variant) { variant.options.ring_size = size; });
  }
  using Lines = std::pair<std::uint32_t, std::uint32_t>;
  for (const auto& [records, count] : {Lines{8, 64}, Lines{16, 16}, Lines{32, 16}}) {
    add("node cache", lines(records, count), lines(build.line_nodes, options.caches.node_lines),
        [records = records, count = count](BvhVariant& variant) {
          variant.build.line_nodes = records;
          variant.options.caches.node_lines = count;
        });
  }
  for (const auto& [records, count] : {Lines{32, 32}, Lines{64, 8}, Lines{128, 8}}) {
    add("triangle cache", lines(records, count), lines(build.line_triangles, options.caches.triangle_lines),
        [records = records, count = count](BvhVariant& variant) {
          variant.build.line_triangles = records;
          variant.options.caches.triangle_lines = count;
        });
  }
  add("triangles culled by", "corner rays", "subpackets",
      [](BvhVariant& variant) { variant.options.use_subpackets = false; });
  for (const std::uint32_t count : {2u, 4u, 8u, 12u, 16u, 20u, 32u, 48u, 64u}) {
    add("triangles of a leaf, at most", std::to_string(count), std::to_string(build.leaf_triangles),
        [count](BvhVariant& variant) { variant.build.leaf_triangles = count; });
  }
  for (const float cost : {0.05f, 0.1f, 0.2f, 0.25f, 0.35f, 0.5f, 1.0f}) {
    add("cost of a triangle, in boxes", number_text(cost), number_text(build.triangle_cost),
        [cost](BvhVariant& variant) { variant.build.triangle_cost = cost; });
  }
  for (const std::uint32_t count : {4u, 5u, 6u, 7u, 10u, 12u, 16u}) {
    add("bins of an axis", std::to_string(count), std::to_string(build.bin_count),
        [count](BvhVariant& variant) { variant.build.bin_count = count; });
  }
  for (const std::uint32_t count : {0u, 64u, 512u, 4096u, 32768u}) {
    add("every axis binned, from triangles of a node", std::to_string(count), "never",
        [count](BvhVariant& variant) { variant.build.every_axis_from = count; });
  }
  return changes;
}

/// The change that takes the fewest cycles in the mean over the views.
struct Fastest {
  double percent = 0;  ///< more than as tuned
  std::string words;

  void add(const Change& change, double percent_more) {
    if (percent_more >= percent) return;
    percent = percent_more;
    words = std::string(change.setting) + " " + change.value;
  }
  [[nodiscard]] std::string text() const {
    if (words.empty()) return "no other value is faster in the mean over the views.";
    return "the fastest of these values, " + words + ", takes " + fixed_text(-percent, 1) +
           " % fewer cycles in the mean over the views.";
  }
};

constexpr const char* kChoiceWords =
    "How the tuned values were chosen is told by sim_platform/README.md, \"What was tried\".";

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
    table.columns.push_back({"mean_with_build_percent", "with build: geometric mean, % more", 1});
    Fastest frame, with_build;
    for (const Row& row : rows) {
      std::vector<Cell> cells = {row.change.setting, row.change.value, row.change.tuned};
      double logarithms = 0, logarithms_with_build = 0;
      for (std::size_t view = 0; view < tuned.size(); ++view) {
        const RunResult& before = done.result(tuned[view]);
        const RunResult& after = done.result(row.runs[view]);
        const double ratio = before.fps() / after.fps();
        cells.emplace_back(100 * (ratio - 1));
        logarithms += std::log(ratio);
        logarithms_with_build += std::log(before.fps_with_build() / after.fps_with_build());
      }
      const auto percent_more_of = [&](double sum) {
        return 100 * (std::exp(sum / static_cast<double>(tuned.size())) - 1);
      };
      cells.emplace_back(percent_more_of(logarithms));
      cells.emplace_back(percent_more_of(logarithms_with_build));
      frame.add(row.change, percent_more_of(logarithms));
      with_build.add(row.change, percent_more_of(logarithms_with_build));
      table.add(std::move(cells));
    }
    book.section("bvh", "Sweep: the cached BVH's settings");
    book.paragraph(
        "Each line changes one setting of the hierarchy as the other sections show it; the hierarchy is built and "
        "rendered anew. The frame alone: " +
        frame.text() + " Build and frame together: " + with_build.text() + " " + kChoiceWords);
    book.table(table, "The hierarchy with software caches, 6 cores, no shading: cycles of a frame.");
  };
}

}  // namespace gridiron::experiment
