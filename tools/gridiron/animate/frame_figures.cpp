// Frame figures. SPDX-License-Identifier: Apache-2.0
#include "frame_figures.h"

#include <gridiron/sim/build_work.h>
#include <report/report.h>

#include <algorithm>
#include <cstdio>

#include "base/numbers.h"
#include "base/words.h"

namespace gridiron::tool {
namespace {

std::string words_of_cycles(double cycles) {
  return words_of_count(static_cast<std::uint64_t>(cycles));
}

// What the sum of all frames says of builds.
std::string words_of_builds(const std::vector<NamedFrame>& frames, const std::optional<SingleBuild>& single) {
  if (single && single->structure.empty()) return "; the camera alone moves, nothing is built";
  if (single) {
    return "; the camera alone moves: the " + single->structure + " is built once" +
           (single->cost ? ", in " + words_of_cycles(single->cost->cycles) + " cycles of the general core," : "") +
           " and nothing per frame";
  }
  const bool are_counted =
      std::ranges::all_of(frames, [](const NamedFrame& frame) { return frame.figures.build.has_value(); });
  return are_counted ? " with their builds" : " without their builds; --configuration grid counts these too";
}

}  // namespace

std::optional<BuildCost> cost_of_build(const SceneInput& input, const FrameMemory& memory, const RenderPlan& plan) {
  const Mesh* const mesh = std::get_if<Mesh>(&input.content);
  if (mesh == nullptr || !memory.image.has_grid || memory.image.has_tree) return std::nullopt;
  const sim::MasterProfile& master = plan.scene.machine->master;
  const sim::BuildWork work = sim::grid_build_work(mesh->vertices.size(), mesh->triangles.size(), memory.need,
                                                   sim::count_mesh_lines(mesh->view()));
  return BuildCost{sim::build_cycles(master, work), sim::build_seconds(master, work)};
}

std::string table_of(const std::vector<NamedFrame>& frames, const sim::MachineProfile& machine) {
  std::string table =
      "frame,mesh,triangles,lambda,build_cycles,render_cycles,total_cycles,build_seconds,render_seconds,seconds,fps,"
      "hash\n";
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const FrameFigures& figures = frames[i].figures;
    // The general core may have another clock; the total is in cycles of the cores.
    const double total_cycles = (figures.build ? figures.build->seconds * machine.clock_hz : 0) + figures.render_cycles;
    const auto of_build = [&figures](double BuildCost::*value) {
      return figures.build ? shortest_text(*figures.build.*value) : std::string();
    };
    for (const std::string& field :
         {shortest_text(i), in_csv(frames[i].mesh), shortest_text(figures.triangles),
          figures.lambda ? shortest_text(*figures.lambda) : std::string(), of_build(&BuildCost::cycles),
          shortest_text(figures.render_cycles), shortest_text(total_cycles), of_build(&BuildCost::seconds),
          shortest_text(figures.render_seconds), shortest_text(figures.seconds()), shortest_text(figures.fps())}) {
      table += field + ",";
    }
    table += hash_text(figures.hash) + "\n";
  }
  return table;
}

void print_frames(const std::vector<NamedFrame>& frames, const sim::MachineProfile& machine, std::uint32_t cores,
                  const std::optional<SingleBuild>& build) {
  std::printf("%-24s %14s %14s %9s\n", "frame", "build cycles", "render cycles", "frames/s");
  double seconds = 0;
  for (const NamedFrame& frame : frames) {
    const FrameFigures& figures = frame.figures;
    std::printf("%-24s %14s %14s %9.2f\n", frame.picture.c_str(),
                build           ? "none"
                : figures.build ? words_of_cycles(figures.build->cycles).c_str()
                                : "not counted",
                words_of_cycles(figures.render_cycles).c_str(), figures.fps());
    seconds += figures.seconds();
  }
  std::printf("%s, %s: %s in %.2f ms, %.2f frames/s%s\n", std::string(machine.name).c_str(),
              words_of_count(cores, "core").c_str(), words_of_count(frames.size(), "frame").c_str(), seconds * 1e3,
              seconds > 0 ? static_cast<double>(frames.size()) / seconds : 0.0, words_of_builds(frames, build).c_str());
}

}  // namespace gridiron::tool
