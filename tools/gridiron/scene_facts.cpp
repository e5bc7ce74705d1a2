// Scene facts. SPDX-License-Identifier: Apache-2.0
#include "scene_facts.h"

#include <gridiron/frame/frame_setup.h>

#include <algorithm>

#include "store_facts.h"

namespace gridiron::tool {
namespace {

LoopBounds bounds_of(const GridRecord& grid) {
  constexpr std::uint32_t kPassesPerPacket = 6;
  const auto longest = [](const std::uint32_t counts[3]) { return std::max({counts[0], counts[1], counts[2]}); };
  const auto product = [](const std::uint32_t counts[3]) { return std::uint64_t{counts[0]} * counts[1] * counts[2]; };
  LoopBounds bounds;
  bounds.passes_per_packet = kPassesPerPacket;
  bounds.macro_slices_per_pass = longest(grid.macro_cell_count);
  bounds.macro_cells_per_pass = product(grid.macro_cell_count);
  bounds.slices_per_pass = longest(grid.cell_count);
  bounds.cells_per_pass = product(grid.cell_count);
  bounds.triangle_tests_per_pass = grid.reference_count;
  return bounds;
}

}  // namespace

SceneFacts collect_scene_facts(const InfoArguments& arguments) {
  const SceneInput input = read_scene_input(arguments.scene.input);
  const std::uint64_t budget_bytes = image_budget_bytes(*arguments.scene.machine, arguments.width, arguments.height, 1);
  SceneFacts facts;
  if (const PackedScene* packed = std::get_if<PackedScene>(&input.content)) {
    const ImageHeader& header = packed->view.header;
    facts.is_packed = true;
    facts.vertices = header.vertex_count;
    facts.triangles = header.triangle_count;
    facts.dropped_triangles = header.dropped_triangle_count;
    facts.grid = packed->view.grid;
    facts.wanted_lambda = facts.grid.lambda;
    facts.image_bytes = header.image_bytes;
    facts.fits = header.image_bytes <= budget_bytes;
  } else {
    const Mesh& mesh = std::get<Mesh>(input.content);
    const GridChoice choice = choose_grid(input, mesh, arguments.scene, arguments.format, budget_bytes);
    facts.vertices = mesh.vertices.size();
    facts.triangles = mesh.triangles.size();
    facts.dropped_triangles = choice.need.dropped_triangle_count;
    facts.grid = choice.need.grid;
    facts.wanted_lambda = choice.wanted_lambda;
    facts.image_bytes = choice.need.image_bytes;
    facts.scratch_bytes = choice.need.scratch_bytes;
    facts.fits = choice.fits();
  }
  const std::uint32_t tile_width = sim::usual_tile_width(sim::StoreSize::k256KB);
  facts.picture_bytes = output_plane_bytes(arguments.width, arguments.height, tile_width) + sizeof(FrameRecord);
  facts.bounds = bounds_of(facts.grid);
  return facts;
}

}  // namespace gridiron::tool
