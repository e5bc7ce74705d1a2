// Frame figures. SPDX-License-Identifier: Apache-2.0
#include "frame_figures.h"

#include <gridiron/sim/build_work.h>
#include <gridiron/sim/pass_timing.h>
#include <gridiron/sim/tree_build_work.h>
#include <report/report.h>
#include <report/svg_plot.h>

#include <algorithm>
#include <cstdio>
#include <map>

#include "base/numbers.h"
#include "base/words.h"

namespace gridiron::tool {
namespace {

std::string words_of_cycles(double cycles) {
  return words_of_count(static_cast<std::uint64_t>(cycles));
}

PassFigures figures_of(const sim::PassTiming& pass) {
  return {.name = std::string(pass.name),
          .items = pass.items,
          .start_cycles = pass.start_cycles,
          .run_cycles = pass.run.frame_cycles,
          .barrier_cycles = pass.barrier_cycles,
          .limits = pass.limits,
          .bytes_in = pass.bytes_in,
          .bytes_out = pass.bytes_out};
}

std::string word_of_builder(const std::optional<BuildCost>& build) {
  if (!build || build->cycles == 0) return "";
  return build->builder == Builder::kCores ? "cores" : "master";
}

// All frames of one command are, or none.
bool are_timed(const std::vector<NamedFrame>& frames) {
  return std::ranges::all_of(frames, [](const NamedFrame& frame) { return frame.figures.is_timed; });
}

// What the sum of all frames says of builds.
std::string words_of_builds(const std::vector<NamedFrame>& frames, const std::optional<SingleBuild>& single) {
  if (single && single->structure.empty()) return "; the camera alone moves, nothing is built";
  if (single) {
    return "; the camera alone moves: the " + single->structure + " is built once" +
           (single->cost ? ", in " + words_of_cycles(single->cost->cycles) +
                               (single->cost->builder == Builder::kCores ? " cycles of the cores,"
                                                                         : " cycles of the general core,")
                         : "") +
           " and nothing per frame";
  }
  const bool are_counted =
      std::ranges::all_of(frames, [](const NamedFrame& frame) { return frame.figures.build.has_value(); });
  const bool are_of_cores = std::ranges::all_of(
      frames, [](const NamedFrame& frame) { return word_of_builder(frame.figures.build) == "cores"; });
  if (are_of_cores) return " with their builds by the cores";
  return are_counted ? " with their builds" : " without their builds, which are not all counted";
}

// Passes on the average of all frames.
void print_passes(const std::vector<NamedFrame>& frames) {
  struct Row {
    PassFigures sum;
    std::map<std::string_view, std::size_t> bindings;
  };
  std::vector<Row> rows;
  double count = 0;
  for (const NamedFrame& frame : frames) {
    if (!frame.figures.build || frame.figures.build->passes.empty()) continue;
    ++count;
    std::size_t i = 0;
    for (const PassFigures& pass : frame.figures.build->passes) {
      if (i == rows.size()) rows.push_back({{.name = pass.name, .items = pass.items}, {}});
      Row& row = rows[i++];
      row.sum.items = std::max(row.sum.items, pass.items);
      row.sum.start_cycles += pass.start_cycles;
      row.sum.run_cycles += pass.run_cycles;
      row.sum.barrier_cycles += pass.barrier_cycles;
      ++row.bindings[pass.binding()];
    }
  }
  if (rows.empty()) return;
  double one_core = 0;
  std::printf("%-24s %14s %9s %14s %9s  %s\n", "pass of a frame", "most items", "start", "run", "barrier", "bound by");
  for (const Row& row : rows) {
    const auto most = std::ranges::max_element(row.bindings, {}, [](const auto& entry) { return entry.second; });
    std::printf("%-24s %14s %9s %14s %9s  %s\n", row.sum.name.c_str(), words_of_count(row.sum.items).c_str(),
                words_of_cycles(row.sum.start_cycles / count).c_str(),
                words_of_cycles(row.sum.run_cycles / count).c_str(),
                words_of_cycles(row.sum.barrier_cycles / count).c_str(), std::string(most->first).c_str());
    if (row.sum.is_of_one()) one_core += row.sum.cycles();
  }
  std::printf("one core alone: %s cycles of a frame\n", words_of_cycles(one_core / count).c_str());
}

}  // namespace

std::optional<sim::BuildWork> work_of_master(const Mesh& mesh, FrameMemory& memory) {
  const SceneImageView& image = memory.image;
  const sim::MeshLines lines = sim::count_mesh_lines(mesh.view());
  if (!image.has_tree) return sim::grid_build_work(mesh.vertices.size(), mesh.triangles.size(), memory.need, lines);
  const bool has_prices = !image.has_grid && !image.has_effects &&
                          image.tree.triangle_format == static_cast<std::uint32_t>(TriangleFormat::kVertices);
  if (!has_prices) return std::nullopt;
  const std::span<const std::byte> nodes =
      memory.memory.bytes_at(memory.image_address.offset_by(image.tree.nodes_offset_bytes),
                             std::uint64_t{image.tree.node_count} * sizeof(TreeNode));
  return sim::tree_image_work(mesh.view(),
                              {image.tree.leaf_triangles,
                               TreeOrder::kByNumber,
                               {reinterpret_cast<const TreeNode*>(nodes.data()), image.tree.node_count}},
                              image.header.image_bytes, lines);
}

std::optional<BuildCost> cost_of_build(const SceneInput& input, FrameMemory& memory, const RenderPlan& plan) {
  if (!memory.cores_build.passes.empty()) return cost_of_cores(memory.cores_build, *plan.scene.machine, plan.cores);
  const Mesh* const mesh = std::get_if<Mesh>(&input.content);
  if (mesh == nullptr) return std::nullopt;
  const sim::MasterProfile& master = plan.scene.machine->master;
  const std::optional<sim::BuildWork> work = work_of_master(*mesh, memory);
  if (!work) return std::nullopt;
  return BuildCost{sim::build_cycles(master, *work), sim::build_seconds(master, *work), Builder::kMaster};
}

// The passes one after another, then the general core.
BuildCost cost_of_cores(const CoresBuild& build, const sim::MachineProfile& machine, std::uint32_t cores) {
  const sim::PassesTiming timing = sim::replay_passes(build.passes, machine, cores);
  BuildCost cost{.builder = Builder::kCores};
  for (const sim::PassTiming& pass : timing.passes) cost.passes.push_back(figures_of(pass));
  PassFigures& master = cost.passes.emplace_back();
  master.name = kMasterPass;
  master.run_cycles = cycles_of_master(build, machine);
  for (const PassFigures& pass : cost.passes) cost.cycles += pass.cycles();
  cost.seconds = cost.cycles / machine.clock_hz;
  return cost;
}

double cycles_of_master(const CoresBuild& build, const sim::MachineProfile& machine) {
  return sim::build_seconds(machine.master, sim::image_check_work(build.piece_count)) * machine.clock_hz;
}

void add_picture(const sim::FrameTiming& picture, const sim::MachineProfile& machine, BuildCost& build) {
  const sim::PassTiming pass = sim::timing_of_pass("picture", picture, machine);
  build.passes.push_back(figures_of(pass));
  build.cycles += pass.start_cycles + pass.barrier_cycles;
  build.seconds = build.cycles / machine.clock_hz;
}

std::string_view PassFigures::binding() const {
  const auto most = std::ranges::max_element(limits);
  return *most > 0 ? sim::name_of(static_cast<sim::PassLimit>(most - limits.begin())) : "general_core";
}

std::string passes_of(const std::vector<NamedFrame>& frames) {
  std::string table =
      "frame,pass,items,begin_cycles,start_cycles,run_cycles,barrier_cycles,cycles,one_core_cycles,binding";
  for (std::size_t limit = 0; limit < sim::kPassLimitCount; ++limit) {
    table.append(",").append(sim::name_of(static_cast<sim::PassLimit>(limit))).append("_limit_cycles");
  }
  table += ",bytes_in,bytes_out\n";
  bool has_passes = false;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (!frames[i].figures.build) continue;
    double begin = 0;
    for (const PassFigures& pass : frames[i].figures.build->passes) {
      has_passes = true;
      table.append(shortest_text(i)).append(",").append(pass.name).append(",").append(shortest_text(pass.items));
      const auto add = [&table](auto number) { table.append(",").append(shortest_text(number)); };
      for (const double cycles : {begin, pass.start_cycles, pass.run_cycles, pass.barrier_cycles, pass.cycles(),
                                  pass.is_of_one() ? pass.cycles() : 0}) {
        add(cycles);
      }
      table.append(",").append(pass.binding());
      for (const double cycles : pass.limits) add(cycles);
      add(pass.bytes_in);
      add(pass.bytes_out);
      table += "\n";
      begin += pass.cycles();
    }
  }
  return has_passes ? table : "";
}

std::string plot_of(const std::vector<NamedFrame>& frames) {
  constexpr std::size_t kMostBars = 24;
  if (!are_timed(frames)) return "";
  const bool has_builds = std::ranges::any_of(
      frames, [](const NamedFrame& frame) { return frame.figures.build && frame.figures.build->cycles > 0; });
  const auto build_of = [](const NamedFrame& frame) {
    return frame.figures.build ? frame.figures.build->seconds * 1e3 : 0.0;
  };
  if (frames.size() <= kMostBars) {
    plot::BarChart chart{.title = "Time of each frame", .y_title = "ms", .parts = {}};
    if (has_builds) chart.parts.push_back("build");
    chart.parts.push_back("picture");
    chart.bars = {""};
    for (std::size_t i = 0; i < frames.size(); ++i) {
      chart.groups.push_back(shortest_text(i));
      if (has_builds) chart.values.push_back(build_of(frames[i]));
      chart.values.push_back(frames[i].figures.render_seconds * 1e3);
    }
    return plot::bar_chart_svg(chart);
  }
  plot::Series whole{.name = "frame", .points = {}}, build{.name = "build", .points = {}},
      picture{.name = "picture", .points = {}};
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const auto x = static_cast<double>(i);
    whole.points.push_back({x, frames[i].figures.seconds() * 1e3});
    build.points.push_back({x, build_of(frames[i])});
    picture.points.push_back({x, frames[i].figures.render_seconds * 1e3});
  }
  plot::LineChart chart{.title = "Time of each frame", .x_title = "frame", .y_title = "ms"};
  if (has_builds) {
    chart.series = {whole, build, picture};
  } else {
    chart.series = {picture};
  }
  return plot::line_chart_svg(chart);
}

std::string table_of(const std::vector<NamedFrame>& frames, const sim::MachineProfile& machine) {
  std::string table =
      "frame,mesh,triangles,lambda,builder,build_cycles,render_cycles,total_cycles,build_seconds,render_seconds,"
      "seconds,fps,"
      "hash\n";
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const FrameFigures& figures = frames[i].figures;
    // The general core may have another clock; the total is in cycles of the cores.
    const double total_cycles = (figures.build ? figures.build->seconds * machine.clock_hz : 0) + figures.render_cycles;
    const auto of_build = [&figures](double BuildCost::*value) {
      return figures.build ? shortest_text(*figures.build.*value) : std::string();
    };
    const auto if_timed = [&figures](double value) { return figures.is_timed ? shortest_text(value) : std::string(); };
    for (const std::string& field :
         {shortest_text(i), in_csv(frames[i].mesh), shortest_text(figures.triangles),
          figures.lambda ? shortest_text(*figures.lambda) : std::string(), word_of_builder(figures.build),
          of_build(&BuildCost::cycles), if_timed(figures.render_cycles), if_timed(total_cycles),
          of_build(&BuildCost::seconds), if_timed(figures.render_seconds), if_timed(figures.seconds()),
          if_timed(figures.fps())}) {
      table += field + ",";
    }
    table += hash_text(figures.hash) + "\n";
  }
  return table;
}

void print_frames(const std::vector<NamedFrame>& frames, const sim::MachineProfile& machine, std::uint32_t cores,
                  const std::optional<SingleBuild>& build) {
  if (!are_timed(frames)) {
    for (const NamedFrame& frame : frames) {
      std::printf("%-24s hash %s\n", frame.picture.c_str(), hash_text(frame.figures.hash).c_str());
    }
    std::printf("%s; --mode plain counts no cycles\n", words_of_count(frames.size(), "frame").c_str());
    return;
  }
  std::printf("%-24s %14s %9s %14s %9s %9s\n", "frame", "build cycles", "ms", "render cycles", "ms", "frames/s");
  double seconds = 0;
  for (const NamedFrame& frame : frames) {
    const FrameFigures& figures = frame.figures;
    char build_milliseconds[32] = "";
    if (!build && figures.build) {
      std::snprintf(build_milliseconds, sizeof build_milliseconds, "%.3f", figures.build->seconds * 1e3);
    }
    std::printf("%-24s %14s %9s %14s %9.3f %9.2f\n", frame.picture.c_str(),
                build           ? "none"
                : figures.build ? words_of_cycles(figures.build->cycles).c_str()
                                : "not counted",
                build_milliseconds, words_of_cycles(figures.render_cycles).c_str(), figures.render_seconds * 1e3,
                figures.fps());
    seconds += figures.seconds();
  }
  print_passes(frames);
  std::printf("%s, %s: %s in %.2f ms, %.2f frames/s%s\n", std::string(machine.name).c_str(),
              words_of_count(cores, "core").c_str(), words_of_count(frames.size(), "frame").c_str(), seconds * 1e3,
              seconds > 0 ? static_cast<double>(frames.size()) / seconds : 0.0, words_of_builds(frames, build).c_str());
}

}  // namespace gridiron::tool
