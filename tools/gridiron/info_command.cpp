// info: prints the contents and needs of a scene, as text or JSON. SPDX-License-Identifier: Apache-2.0
#include <report/report.h>

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "base/words.h"
#include "commands.h"
#include "gridiron/device/accuracies.h"
#include "gridiron/device/store_facts.h"
#include "gridiron/info/loop_table.h"
#include "gridiron/info/scene_facts.h"
#include "gridiron/scene/effect_names.h"

namespace gridiron::tool {
namespace {

using Json = nlohmann::ordered_json;

template <class Number>
Json json_of(const Number (&vector)[3]) {
  return {vector[0], vector[1], vector[2]};
}

Json json_of(const StoreFacts& store) {
  Json regions = Json::array();
  for (const LocalStoreRegion& region : store.regions) {
    regions.push_back({{"name", region.name}, {"offset", region.offset_bytes}, {"bytes", region.bytes}});
  }
  return {{"arena_bytes", store.arena_bytes},
          {"regions", regions},
          {"code_bytes", store.code_bytes},
          {"stack_bytes", store.stack_bytes}};
}

// Whether the requested store has a renderer of effects.
bool has_effect_store(const InfoPlan& plan) {
  return plan.store != sim::StoreSize::k128KB && plan.store != sim::StoreSize::k16KB;
}

Json json_of(const LoopBounds& bounds) {
  return {{"passes_per_packet", bounds.passes_per_packet},
          {"macro_slices_per_pass", bounds.macro_slices_per_pass},
          {"macro_cells_per_pass", bounds.macro_cells_per_pass},
          {"slices_per_pass", bounds.slices_per_pass},
          {"cells_per_pass", bounds.cells_per_pass},
          {"triangle_tests_per_pass", bounds.triangle_tests_per_pass}};
}

// A count of a bound; null if 64 bits do not hold it.
Json json_of_count(std::uint64_t count) {
  return count == ~std::uint64_t{0} ? Json() : Json(count);
}

// Kinds of work that a bound has any of.
Json work_json(const TileBound& bound, const sim::EngineWork& engine) {
  Json work = Json::object();
  for (std::uint32_t kind = 0; kind < engine.kind_count(); ++kind) {
    if (sim::is_charged_as_event(WorkId(kind)) || bound.work[kind] == 0) continue;
    work[std::string(sim::work_kind(WorkId(kind), engine).name)] = json_of_count(bound.work[kind]);
  }
  return work;
}

// The unit of a bound's cycles.
const char* unit_of(const WorstTile& worst) {
  return worst.are_instructions ? "instructions" : "cycles";
}

Json json_of(const WorstTile& worst) {
  return {{"accuracy", accuracy_name(worst.frame.accuracy)},
          {"depth", worst.frame.has_depth},
          {"lanes", worst.layout.lanes},
          {"tile_width", worst.layout.tile_width},
          {"packet_width", worst.layout.packet_width},
          {"occupied_macro_cells", worst.scene.occupied_macro_cells},
          {"filled_cells", worst.scene.filled_cells},
          {"triangle_runs", worst.scene.runs},
          {"most_cell_triangles", worst.scene.most_cell_triangles},
          {"most_macro_cell_triangles", worst.scene.most_macro_triangles},
          {"work", work_json(worst.bound, sim::kGridEngine)},
          {"dma",
           {{"gets", json_of_count(worst.bound[Work::kGetIssue])},
            {"puts", json_of_count(worst.bound[Work::kPutIssue])},
            {"waits", json_of_count(worst.bound[Work::kWait])},
            {"get_bytes", json_of_count(worst.bound.get_bytes)},
            {"put_bytes", json_of_count(worst.bound.put_bytes)}}},
          {"cycles_are", unit_of(worst)},
          {"cycles",
           {{"work", worst.cycles.work},
            {"commands", worst.cycles.commands},
            {"transfers", worst.cycles.transfers},
            {"total", worst.cycles.total()}}}};
}

Json json_of(const InfoPlan& plan, const WorstOfView& worst) {
  return {{"accuracy", accuracy_name(plan.accuracy.value_or(Accuracy::kStandard))},
          {"depth", false},
          {"lanes", 4},
          {"tile_width", worst.tile_width},
          {"tile", {worst.tile % worst.tiles_x, worst.tile / worst.tiles_x}},
          {"work", work_json(worst.bound, sim::kTreeEngine)},
          {"dma",
           {{"gets", worst.most_gets},
            {"puts", worst.bound[Work::kPutIssue]},
            {"waits", worst.bound[Work::kWait]},
            {"get_bytes", worst.most_get_bytes},
            {"put_bytes", worst.bound.put_bytes}}},
          {"cycles_are", "cycles"},
          {"cycles",
           {{"work", worst.cycles.work},
            {"commands", worst.cycles.commands},
            {"transfers", worst.cycles.transfers},
            {"total", worst.cycles.total()}}},
          {"tiles", worst.tile_cycles},
          {"seconds", worst.seconds.wall},
          {"processor_seconds", worst.seconds.processor}};
}

std::uint64_t tiles_across(std::uint32_t pixels, std::uint32_t tile_width) {
  return (std::uint64_t{pixels} + tile_width - 1) / tile_width;
}

// What cores make the image's tree from; nothing where there is none that they can make.
std::optional<BuildInput> build_input_of(const SceneFacts& facts) {
  const TreeRecord& tree = facts.tree;
  if (tree.node_count == 0 || tree.triangle_format != static_cast<std::uint32_t>(TriangleFormat::kVertices)) return {};
  BuildInput input;
  input.vertex_count = static_cast<std::uint32_t>(facts.vertices);
  input.triangle_count = static_cast<std::uint32_t>(facts.triangles);
  input.leaf_triangles = tree.leaf_triangles;
  input.image = MainAddress{kLineBytes};
  // Of one that is not built yet: room for the most nodes.
  const std::uint64_t room = kTreeImageHeadBytes +
                             round_up<std::uint64_t>(sizeof(VertexTriangle) * facts.triangles, kLineBytes) +
                             sizeof(TreeNode) * most_tree_nodes(facts.triangles, tree.leaf_triangles);
  input.image_room = std::max(facts.image_bytes, room);
  return input;
}

// Every loop on a core without a constant bound, with its bound for this scene, store and picture; null where none is
// known but constants.
Json loops_json(const InfoPlan& plan, const SceneFacts& facts) {
  LoopFacts loops;
  if (facts.worst) {
    const std::uint64_t tiles =
        tiles_across(plan.size.x, plan.layout.tile_width) * tiles_across(plan.size.y, plan.layout.tile_width);
    loops = loop_facts_of(*facts.worst, facts.grid.macro_width, tiles);
  }
  if (const std::optional<BuildInput> build = build_input_of(facts)) {
    loops.add_build(*build, sim::arena_bytes(plan.layout.store));
  }
  if (!loops.has_tile && !loops.has_build) return {};
  Json rows = Json::array();
  for (const LoopRow& row : loops.rows()) {
    rows.push_back({{"file", std::string(row.file)},
                    {"function", std::string(row.function)},
                    {"loop", std::string(row.loop)},
                    {"kind", std::string(row.kind)},
                    {"bound", std::string(row.bound)},
                    {"most_turns", row.value ? Json(*row.value) : Json()}});
  }
  return rows;
}

// The local store and packets of the renderer that suffices.
std::string renderer_of(const InfoPlan& plan, const SceneFacts& facts) {
  return renderer_type(facts.effects.record.called_for, sim::arena_bytes(plan.store) >> 10, plan.layout.packet_width);
}

Json effects_json(const InfoPlan& plan, const SceneFacts& facts) {
  const EffectFacts& effects = facts.effects;
  Json json = {{"called_for", Json(effect_names(effects.record.called_for))}, {"renderer", renderer_of(plan, facts)}};
  if (!effects.has_effects) return json;
  const EffectsRecord& record = effects.record;
  json["materials"] = record.material_count;
  json["point_lights"] = record.point_light_count;
  json["area_lights"] = record.light_count - record.point_light_count;
  json["smooth_triangles"] = record.smooth_triangle_count;
  json["recursion_depth"] = record.recursion_depth;
  json["samples_per_pixel"] = record.samples_per_pixel;
  json["occlusion_samples"] = record.occlusion_samples;
  json["environment_width"] = record.environment_width;
  json["environment_bytes"] = effects.bytes_of("environment");
  json["section_bytes"] = effects.section_bytes;
  Json sections = Json::array();
  for (const EffectSectionFact& section : effects.sections) {
    sections.push_back({{"name", section.name}, {"bytes", section.bytes}});
  }
  json["sections"] = sections;
  json["spill_bytes_per_core"] = effects.spill_bytes_per_core;
  json["has_room"] = has_effect_store(plan);
  return json;
}

// Null where there is no grid.
Json grid_json(const SceneFacts& facts) {
  const GridRecord& grid = facts.grid;
  if (!facts.has_grid) return {};
  return {{"lambda", grid.lambda},
          {"wanted_lambda", facts.wanted_lambda},
          {"macro_width", grid.macro_width},
          {"cell_count", json_of(grid.cell_count)},
          {"macro_cell_count", json_of(grid.macro_cell_count)},
          {"cells", facts.bounds.cells_per_pass},
          {"macrocells", facts.bounds.macro_cells_per_pass},
          {"cell_blocks", grid.cell_block_count},
          {"references", grid.reference_count},
          {"triangle_format", word_of(static_cast<TriangleFormat>(grid.triangle_format))},
          {"lattice_step", grid.lattice.step}};
}

// Null where there is no tree.
Json tree_json(const SceneFacts& facts) {
  const TreeRecord& tree = facts.tree;
  if (tree.node_count == 0) return {};
  return {{"nodes", tree.node_count},
          {"triangles", tree.triangle_count},
          {"depth", tree.depth},
          {"leaf_triangles", tree.leaf_triangles},
          {"bytes", facts.structures.tree},
          {"triangle_format", word_of(static_cast<TriangleFormat>(tree.triangle_format))},
          {"lattice_step", tree.lattice.step}};
}

// What the mesh's file holds; null for other scenes.
Json model_json(const SceneInput& input) {
  if (!input.model) return {};
  const ImportReport& report = *input.model;
  const MeshSurface& surface = std::get<Mesh>(input.content).surface;
  const auto or_null = [](bool is_known, const Json& value) { return is_known ? value : Json(); };
  Json animations = Json::array();
  for (const ImportedAnimation& animation : report.animations) {
    animations.push_back({{"name", animation.name}, {"seconds", animation.seconds}});
  }
  return {{"format", report.format},
          {"reader", or_null(!report.reader.empty(), report.reader)},
          {"meshes", report.meshes},
          {"materials", surface.materials.size()},
          {"textures", report.textures},
          {"normals", !surface.triangle_normals.empty()},
          {"colors", !surface.triangle_colors.empty()},
          {"unit_metres", or_null(report.unit_metres > 0, report.unit_metres)},
          {"up", or_null(!report.up.empty(), report.up)},
          {"animations", animations},
          {"ignored", Json(report.ignored)}};
}

void print_json(const InfoPlan& plan, const SceneInput& input, const SceneFacts& facts) {
  const GridRecord& grid = facts.grid;
  Json document = {
      {"version", 1},
      {"input", plan.scene.input.string()},
      {"packed", facts.is_packed},
      {"configuration", std::string(plan.scene.configuration->name)},
      {"scene",
       {{"vertices", facts.vertices},
        {"triangles", facts.triangles},
        {"dropped_triangles", facts.dropped_triangles},
        {"bounds", {{"minimum", json_of(grid.bounds_minimum)}, {"maximum", json_of(grid.bounds_maximum)}}}}},
      {"model", model_json(input)},
      {"grid", grid_json(facts)},
      {"tree", tree_json(facts)},
      {"main_memory",
       {{"machine", plan.scene.machine->name},
        {"capacity_bytes", plan.scene.machine->main_memory_bytes},
        {"image_bytes", facts.image_bytes},
        {"grid_bytes", facts.structures.grid},
        {"tree_bytes", facts.structures.tree},
        {"effect_bytes", facts.structures.effects},
        {"scratch_bytes", facts.scratch_bytes},
        {"picture_bytes", facts.picture_bytes},
        {"fits", facts.fits}}},
      {"local_store", json_of(plan.local_store)},
      {"effects", effects_json(plan, facts)},
      {"loop_bounds", facts.has_grid ? json_of(facts.bounds) : Json()}};
  if (!facts.roundness.groups.empty()) {
    const char* rules[] = {"asked", "diagonal", "picture"};
    document["scene"]["tolerance"] = {{"rule", rules[static_cast<std::size_t>(facts.roundness.rule)]},
                                      {"least", facts.roundness.least_tolerance},
                                      {"most", facts.roundness.most_tolerance}};
  }
  document["worst_tile"] = facts.worst           ? json_of(*facts.worst)
                           : facts.worst_of_view ? json_of(plan, *facts.worst_of_view)
                                                 : Json();
  document["loops"] = loops_json(plan, facts);
  std::printf("%s\n", document.dump(2, ' ', false, Json::error_handler_t::replace).c_str());
}

std::string words_of_most(std::uint64_t count) {
  return count == ~std::uint64_t{0} ? "more than 2^64" : words_of_count(count);
}

std::string joined(const std::uint32_t (&counts)[3]) {
  return std::to_string(counts[0]) + " x " + std::to_string(counts[1]) + " x " + std::to_string(counts[2]);
}

void print_line(const char* name, const std::string& text) {
  std::printf("%-14s %s\n", name, text.c_str());
}

void print_effects(const InfoPlan& plan, const SceneFacts& facts) {
  const EffectFacts& effects = facts.effects;
  const EffectsRecord& record = effects.record;
  print_line("effects", effects.has_effects ? words_of_effects(record.called_for) : "the scene calls for none");
  print_line("renderer", renderer_of(plan, facts));
  if (!effects.has_effects) return;
  if (!has_effect_store(plan)) {
    print_line("", "does NOT fit the local store of " + std::string(plan.scene.machine->name) +
                       ": effects need one of 64 or of 256 KB");
  }
  const std::uint32_t area_lights = record.light_count - record.point_light_count;
  print_line("materials", words_of_count(record.material_count) + ", " +
                              words_of_count(record.smooth_triangle_count, "triangle") + " with normals");
  print_line("lights", words_of_count(record.point_light_count, "point") + ", " + words_of_count(area_lights, "area"));
  print_line("rays", "depth of recursion " + std::to_string(record.recursion_depth) + ", " +
                         words_of_count(record.samples_per_pixel, "sample") + " a pixel" +
                         (record.occlusion_samples == 0
                              ? ""
                              : ", " + words_of_count(record.occlusion_samples, "ray") + " of ambient occlusion"));
  if (record.environment_width != 0) {
    const std::string width = std::to_string(record.environment_width);
    print_line("environment",
               "6 faces of " + width + "x" + width + ", " + words_of_bytes(effects.bytes_of("environment")));
  }
  std::string parts;
  for (const EffectSectionFact& section : effects.sections) {
    parts += (parts.empty() ? "" : ", ") + std::string(section.name) + " " + words_of_bytes(section.bytes);
  }
  print_line("effect memory", words_of_bytes(effects.section_bytes) + " of the image: " + parts);
  print_line("", words_of_bytes(effects.spill_bytes_per_core) + " a core for rays that wait");
}

// What the mesh's file holds; nothing for a PLY of triangles alone.
void print_model(const SceneInput& input) {
  if (!input.model) return;
  const ImportReport& report = *input.model;
  const Mesh& mesh = std::get<Mesh>(input.content);
  if (report.reader.empty() && mesh.surface.is_empty()) return;
  print_line("model", words_of_model(report, mesh, std::nullopt));
  std::vector<std::string> animations;
  for (const ImportedAnimation& animation : report.animations) {
    char seconds[32];
    std::snprintf(seconds, sizeof seconds, "%.4g s", animation.seconds);
    animations.push_back((animation.name.empty() ? "" : in_quotes(animation.name) + " ") + seconds);
  }
  if (!animations.empty()) {
    print_line("animations", words_of_count(animations.size()) + ": " + words_of_list(animations));
  }
  if (!report.ignored.empty()) print_line("ignored", words_of_list(report.ignored));
}

void print_text(const InfoPlan& plan, const SceneInput& input, const SceneFacts& facts) {
  const GridRecord& grid = facts.grid;
  const StoreFacts& store = plan.local_store;
  print_line("scene", words_of_count(facts.triangles) + " triangles (" + words_of_count(facts.dropped_triangles) +
                          " of zero area dropped), " + words_of_count(facts.vertices) + " vertices");
  print_model(input);
  char text[160];
  std::snprintf(text, sizeof text, "%g %g %g to %g %g %g", static_cast<double>(grid.bounds_minimum[0]),
                static_cast<double>(grid.bounds_minimum[1]), static_cast<double>(grid.bounds_minimum[2]),
                static_cast<double>(grid.bounds_maximum[0]), static_cast<double>(grid.bounds_maximum[1]),
                static_cast<double>(grid.bounds_maximum[2]));
  print_line("bounds", text);
  const std::string format = " stored as " + word_of(static_cast<TriangleFormat>(grid.triangle_format));
  if (facts.has_grid) {
    std::snprintf(text, sizeof text, ", lambda %g", static_cast<double>(grid.lambda));
    print_line("grid", joined(grid.cell_count) + " cells" + text + ", " + words_of_count(grid.reference_count) +
                           " references" + format);
  }
  if (const TreeRecord& tree = facts.tree; tree.node_count != 0) {
    print_line("tree", words_of_count(tree.node_count, "node") + ", " + std::to_string(tree.depth) +
                           " on the longest path, " + words_of_count(tree.triangle_count, "triangle") +
                           " in leaves of " + std::to_string(tree.leaf_triangles) + format);
  }
  if (!facts.roundness.groups.empty()) {
    const char* rules[] = {"as requested", "1e-4 of the scene's diagonal", "chosen by the picture"};
    print_line("tolerance", words_of_tolerance(facts.roundness) + ", " +
                                rules[static_cast<std::size_t>(facts.roundness.rule)] +
                                ": facets are no farther from their spheres and cones");
  }
  if (grid.lattice.step > 0.0f) {
    float longest = 0.0f;
    for (int axis = 0; axis < 3; ++axis) {
      longest = std::max(longest, grid.bounds_maximum[axis] - grid.bounds_minimum[axis]);
    }
    const double places = static_cast<double>(longest) / static_cast<double>(grid.lattice.step);
    std::snprintf(text, sizeof text, "step %g, ", static_cast<double>(grid.lattice.step));
    print_line("lattice", text + words_of_count(static_cast<std::uint64_t>(places)) +
                              " of them along the longest side; triangles without area there are dropped");
  }
  if (facts.has_grid && grid.lambda != facts.wanted_lambda) {
    std::snprintf(text, sizeof text, "reduced from lambda %g to fit the main memory",
                  static_cast<double>(facts.wanted_lambda));
    print_line("", text);
  }
  if (facts.has_grid) {
    print_line("macrocells", joined(grid.macro_cell_count) + " of width " + std::to_string(grid.macro_width) + ", " +
                                 words_of_count(grid.cell_block_count - 1) + " of them hold triangles");
  }
  const std::string structures = words_of_structures(facts.structures);
  if (!structures.empty()) print_line("holds", structures);
  print_line("main memory", words_of_bytes(facts.image_bytes) + " scene image, " + words_of_bytes(facts.scratch_bytes) +
                                " while it is built, " + words_of_bytes(facts.picture_bytes) + " picture of " +
                                std::to_string(plan.size.x) + "x" + std::to_string(plan.size.y) +
                                (plan.has_depth ? " with distances" : ""));
  print_line("", std::string(facts.fits ? "fits" : "does NOT fit") + " the " +
                     words_of_bytes(plan.scene.machine->main_memory_bytes) + " of " +
                     std::string(plan.scene.machine->name));
  print_line("configuration", std::string(plan.scene.configuration->name));
  const std::string code_words = words_of_bytes(store.code_bytes) + " code";
  const std::string data_words =
      words_of_bytes(store.stack_bytes) + " stack, " + words_of_bytes(store.data_bytes()) + " data";
  print_line("local store", words_of_bytes(store.arena_bytes) + ": " +
                                (store.code_memory_bytes == 0 ? code_words + ", " + data_words
                                                              : data_words + "; " + code_words + " in a memory of " +
                                                                    words_of_bytes(store.code_memory_bytes)));
  const std::uint32_t called_for = facts.effects.record.called_for;
  if (called_for != 0 && called_for != kAllEffects) {
    print_line("", "of a renderer with all effects; one with the effects called for takes less");
  }
  for (const LocalStoreRegion& region : store.regions) {
    std::printf("%14s %8s  %s\n", "", words_of_count(region.bytes).c_str(),
                (region.name + " at " + words_of_count(region.offset_bytes)).c_str());
  }
  print_effects(plan, facts);
  if (facts.worst) {
    print_line("loop bounds", "per packet " + std::to_string(facts.bounds.passes_per_packet) +
                                  " passes; twice as many where estimates leave hits open;"
                                  " with exact one more for each ray");
    print_line("", "per pass " + words_of_count(facts.bounds.macro_slices_per_pass) + " macro slices, " +
                       words_of_count(facts.bounds.macro_cells_per_pass) + " macrocells, " +
                       words_of_count(facts.bounds.slices_per_pass) + " slices, " +
                       words_of_count(facts.bounds.cells_per_pass) + " cells, " +
                       words_of_count(facts.bounds.triangle_tests_per_pass) + " triangle tests");
    const WorstTile& worst = *facts.worst;
    std::snprintf(text, sizeof text, " at most %.3g %s of work, %.3g with all waits; ", worst.cycles.work,
                  unit_of(worst), worst.cycles.total());
    const std::string asked = plan.accuracy ? ", accuracy " + std::string(accuracy_name(*plan.accuracy)) + "," : "";
    const std::string gets = words_of_most(worst.bound[Work::kGetIssue]) + " gets of ";
    print_line("worst tile", "for any camera" + asked + text + gets + words_of_most(worst.bound.get_bytes) + " bytes");
  }
  if (facts.worst_of_view) {
    const WorstOfView& worst = *facts.worst_of_view;
    const auto words = [](double cycles) { return words_of_count(static_cast<std::uint64_t>(cycles)); };
    print_line("worst tile", "for this camera at most " + words(worst.cycles.work) + " cycles of work, " +
                                 words(worst.cycles.total()) + " with all waits: tile " +
                                 std::to_string(worst.tile % worst.tiles_x) + "," +
                                 std::to_string(worst.tile / worst.tiles_x));
    print_line("", "of any tile at most " + words_of_count(worst.most_gets, "get") + " of " +
                       words_of_count(worst.most_get_bytes, "byte"));
  }
}

}  // namespace

void run_command(const InfoRequest& request) {
  const KnownScene foreseen = foreseen_scene(request.scene);
  if (foreseen.kind != SceneKind::kUnknown) (void)resolve(request, foreseen);
  std::optional<ViewRequest> view;
  if (request.camera) view = read_camera_file(*request.camera);
  const SceneInput input = read_scene_input(request.scene.input, request.scene.tolerance,
                                            PictureRequest{.size = request.size}, kSceneExpected, request.scene.model);
  const InfoPlan plan = resolve(request, known_scene(input));
  if (!request.scene.quiet) tell_notes(input, /*tells_model=*/false);  // it is part of the result
  const SceneFacts facts = collect_scene_facts(plan, input, view);
  plan.json ? print_json(plan, input, facts) : print_text(plan, input, facts);
}

}  // namespace gridiron::tool
