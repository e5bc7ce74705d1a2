// Scene facts. SPDX-License-Identifier: Apache-2.0
#include "scene_facts.h"

#include <gridiron/base/math.h>
#include <gridiron/build/effects/effect_sections.h>
#include <gridiron/frame/frame_setup.h>
#include <gridiron/sim/sim_memory.h>

#include <algorithm>
#include <span>
#include <utility>

#include "base/failure.h"
#include "base/words.h"

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

std::string_view name_of(SectionKind kind) {
  static constexpr std::pair<SectionKind, std::string_view> kNames[] = {
      {SectionKind::kEffects, "effects"}, {SectionKind::kMaterials, "materials"},
      {SectionKind::kLights, "lights"},   {SectionKind::kSurfaces, "surfaces"},
      {SectionKind::kNormals, "normals"}, {SectionKind::kEnvironmentMap, "environment"}};
  for (const auto& [named, name] : kNames) {
    if (named == kind) return name;
  }
  return "other";
}

EffectFacts effects_of(const EffectsRecord& record, std::uint32_t triangle_count) {
  EffectFacts facts;
  facts.has_effects = true;
  facts.record = record;
  const EffectSections sections = place_effect_sections(record, triangle_count, 0);
  for (std::uint32_t i = 0; i < sections.section_count; ++i) {
    const SectionEntry& entry = sections.entries[i];
    facts.sections.push_back({name_of(static_cast<SectionKind>(entry.kind)), entry.section_bytes});
  }
  facts.section_bytes = sections.end_bytes - sections.begin_bytes;
  const bool rays_wait = (record.called_for & (kReflection | kRefraction)) != 0;
  facts.spill_bytes_per_core = rays_wait ? spill_bytes(record.recursion_depth) : 0;
  return facts;
}

// Of a frame whose image lies where `render` places it.
WorstOfView bound_view(const InfoPlan& plan, const std::filesystem::path& path, std::span<const std::byte> image,
                       const SceneImageView& view, const ViewRequest& request) {
  FrameSettings settings;
  // A camera's file has eye and at, so that no point is asked for.
  settings.camera = complete_view(request, static_cast<double>(plan.size.x) / plan.size.y, [](const PointVisitor&) {});
  settings.width = plan.size.x;
  settings.height = plan.size.y;
  settings.tile_width = plan.layout.tile_width;
  settings.accuracy = plan.accuracy.value_or(Accuracy::kStandard);
  settings.shading = plan.shading;
  settings.engine = EngineId::kTree;
  settings.output_depth = plan.depths.output;
  settings.fetch_depth = plan.depths.fetch;
  constexpr MainAddress kImage{sim::SimMemory::kFirstAddress};
  settings.color = kImage.offset_by(kLineBytes);  // across as many boundaries as may be
  FrameRecord record;
  const Status status = make_frame_record(settings, view, kImage, record);
  if (status == Status::kBadFrame) usage_error("--camera: no camera can be made of it for " + path.string());
  if (status != Status::kOk) input_error(path, words_of(status));
  return find_worst_of_view({record, image, plan.layout.store}, *plan.scene.machine);
}

void add_structures(const SceneImageView& view, SceneFacts& facts) {
  facts.tree = view.tree;
  facts.structures = structures_of(view);
}

}  // namespace

std::uint64_t EffectFacts::bytes_of(std::string_view section) const {
  const auto found = std::ranges::find(sections, section, &EffectSectionFact::name);
  return found == sections.end() ? 0 : found->bytes;
}

SceneFacts collect_scene_facts(const InfoPlan& plan, const SceneInput& input,
                               const std::optional<ViewRequest>& view_request) {
  SceneFacts facts;
  const StoreFacts store = *find_store_facts(plan.layout);
  const EngineId engine = store.engine;
  const sim::MachineProfile& machine = *plan.scene.machine;
  const std::uint32_t tile_width = sim::usual_tile_width(sim::StoreSize::k256KB);
  const std::uint32_t planes = plan.has_depth ? 2 : 1;
  const std::uint64_t budget_bytes = image_budget_bytes(machine, plan.size.x, plan.size.y, planes, tile_width,
                                                        spill_bytes_of(machine.core_count, recursion_depth(input)));
  if (const PackedScene* packed = std::get_if<PackedScene>(&input.content)) {
    const ImageHeader& header = packed->view.header;
    if (plan.accuracy) require_format(input, *packed, format_of(*plan.accuracy));
    facts.is_packed = true;
    facts.vertices = header.vertex_count;
    facts.triangles = header.triangle_count;
    facts.dropped_triangles = header.dropped_triangle_count;
    facts.has_grid = packed->view.has_grid;
    facts.grid = packed->view.grid;
    facts.wanted_lambda = facts.grid.lambda;
    facts.image_bytes = header.image_bytes;
    facts.fits = header.image_bytes <= budget_bytes;
    // Tiles of eye rays through the tree have bounds for one camera alone.
    if (engine == EngineId::kGrid && facts.has_grid) {
      facts.worst = find_worst_tile(plan, packed->file.bytes, packed->view);
    }
    if (view_request) {
      facts.worst_of_view = bound_view(plan, input.path, packed->file.bytes, packed->view, *view_request);
    }
    add_structures(packed->view, facts);
    if (packed->view.has_effects) facts.effects = effects_of(packed->view.effects, header.triangle_count);
  } else {
    const Mesh& mesh = std::get<Mesh>(input.content);
    const EffectsView view = input.effects ? input.effects->view() : EffectsView{};
    const EffectsView* effects = input.effects ? &view : nullptr;
    const ImageLimits limits = {plan.format, budget_bytes, plan.most_macro_width, engine, store.leaf_triangles};
    const GridChoice choice = choose_grid(input, mesh, plan.scene, limits, effects);
    facts.vertices = mesh.vertices.size();
    facts.triangles = mesh.triangles.size();
    facts.dropped_triangles = choice.need.dropped_triangle_count;
    facts.has_grid = choice.parameters.has_grid;
    facts.grid = choice.need.grid;
    facts.wanted_lambda = choice.wanted_lambda;
    facts.image_bytes = choice.need.image_bytes;
    facts.scratch_bytes = choice.need.scratch_bytes;
    facts.fits = choice.fits();
    if (choice.fits()) {
      const AlignedBytes storage = name_in_shortage(input.path, "build its scene image",
                                                    [&] { return allocate_aligned(choice.need.image_bytes); });
      const std::span<std::byte> image(storage.get(), choice.need.image_bytes);
      const SceneImageView built = build_image(input, mesh, choice, image, effects);
      facts.image_bytes = built.header.image_bytes;
      add_structures(built, facts);
      if (engine == EngineId::kGrid) facts.worst = find_worst_tile(plan, image, built);
      if (view_request) facts.worst_of_view = bound_view(plan, input.path, image, built, *view_request);
    }
    if (input.text) facts.roundness = input.text->roundness;
    if (effects != nullptr) {
      facts.effects = effects_of(count_effects(view), static_cast<std::uint32_t>(mesh.triangles.size()));
    }
  }
  facts.picture_bytes = planes * output_plane_bytes(plan.size.x, plan.size.y, tile_width) + sizeof(FrameRecord);
  if (facts.has_grid) facts.bounds = bounds_of(facts.grid);
  return facts;
}

}  // namespace gridiron::tool
