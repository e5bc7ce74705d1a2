// Frames, table and words: see the header. SPDX-License-Identifier: Apache-2.0
#include <counted_frame.h>
#include <gridiron/base/lanes.h>
#include <gridiron/bvh/bvh_engine_work.h>
#include <scene_makers/shapes.h>
#include <table_words.h>
#include <work_table.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <fstream>
#include <functional>
#include <numeric>
#include <span>
#include <stdexcept>
#include <string_view>
#include <thread>
#include <vector>

#include "experiment/workers.h"

namespace gridiron::calibrate {

namespace {

struct Scene {
  std::vector<Vec3> vertices;
  std::vector<UVec3> triangles;
};

Scene scene_of(const scene_makers::Mesh& mesh) {
  Scene scene;
  for (const auto& p : mesh.vertices) {
    scene.vertices.emplace_back(static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2]));
  }
  for (const auto& t : mesh.triangles) scene.triangles.emplace_back(t[0], t[1], t[2]);
  return scene;
}

Scene make_scene() {
  constexpr std::uint32_t kSegments = 5;
  return scene_of(scene_makers::make_teapot(kSegments));
}

constexpr std::uint32_t kFineSegments = 20;  // triangles as small as a scan's

constexpr Vec3 kEye{2.0f, 3.0f, 8.0f};

/// The teapot on a floor, under a lamp, with every effect.
struct EffectScene {
  Scene mesh;
  std::vector<Material> materials;
  std::vector<std::uint16_t> triangle_materials;
  std::vector<Vec3> normals;
  std::vector<UVec3> triangle_normals;
  std::vector<Vec3> colors;
  std::vector<UVec3> triangle_colors;
  std::vector<Light> lights;
  std::vector<Vec3> environment;
  EffectsView view;
};

constexpr std::uint32_t kEnvironmentWidth = 16;

// Not moved once it is made: the view points into it.
void make_effect_scene(const Scene& teapot, bool with_environment, EffectScene& scene) {
  scene.mesh = teapot;
  scene.materials = {
      {.color = {0.8f, 0.7f, 0.5f},
       .kd = 0.7f,
       .ks = 0.3f,
       .shine = 30.0f,
       .smooth_normals = true,
       .vertex_colors = true},
      {.color = {0.9f, 0.9f, 1.0f}, .kd = 0.1f, .ks = 0.1f, .shine = 60.0f, .transmittance = 0.8f, .index = 1.5f},
      {.color = {0.6f, 0.6f, 0.6f}, .kd = 0.8f, .ks = 0.2f},
  };
  // Corners' normals: of all triangles around a vertex.
  scene.normals.assign(teapot.vertices.size(), Vec3(0.0f));
  for (const UVec3& t : teapot.triangles) {
    const Vec3 a = teapot.vertices[t.y] - teapot.vertices[t.x], b = teapot.vertices[t.z] - teapot.vertices[t.x];
    const Vec3 normal{a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
    for (int corner = 0; corner < 3; ++corner) scene.normals[t[corner]] += normal;
  }
  for (Vec3& normal : scene.normals) {
    const float length = square_root(normal.x * normal.x + normal.y * normal.y + normal.z * normal.z);
    normal = length > 0.0f ? normal / length : Vec3{0.0f, 1.0f, 0.0f};
  }
  for (const Vec3& place : teapot.vertices) scene.colors.emplace_back(place.y * 0.2f, 0.9f, 0.4f);
  // A third of the triangles is glass, by height: the lid.
  for (const UVec3& t : teapot.triangles) {
    const bool is_glass = teapot.vertices[t.x].y > 2.2f;
    scene.triangle_materials.push_back(is_glass ? 1 : 0);
    scene.triangle_normals.push_back(is_glass ? UVec3(kNoNormals) : t);
    scene.triangle_colors.push_back(scene.triangle_normals.back());
  }
  // The floor, 8 by 8 squares.
  constexpr std::uint32_t kSquares = 8;
  const auto base = static_cast<std::uint32_t>(scene.mesh.vertices.size());
  for (std::uint32_t i = 0; i <= kSquares; ++i) {
    for (std::uint32_t k = 0; k <= kSquares; ++k) {
      scene.mesh.vertices.emplace_back(-6.0f + 1.5f * static_cast<float>(i), -0.02f,
                                       -6.0f + 1.5f * static_cast<float>(k));
    }
  }
  for (std::uint32_t i = 0; i < kSquares * kSquares; ++i) {
    const std::uint32_t corner = base + i / kSquares * (kSquares + 1) + i % kSquares;
    scene.mesh.triangles.emplace_back(corner, corner + 1, corner + kSquares + 1);
    scene.mesh.triangles.emplace_back(corner + 1, corner + kSquares + 2, corner + kSquares + 1);
    scene.triangle_materials.insert(scene.triangle_materials.end(), 2, std::uint16_t{2});
    scene.triangle_normals.insert(scene.triangle_normals.end(), 2, UVec3(kNoNormals));
    scene.triangle_colors.insert(scene.triangle_colors.end(), 2, UVec3(kNoNormals));
  }
  EffectsView& view = scene.view;
  if (with_environment) {
    scene.lights = {{.corner = {4.0f, 6.0f, 5.0f}, .color = {0.6f, 0.6f, 0.6f}},
                    {.corner = {-3.0f, 7.0f, 2.0f},
                     .edge_u = {2.0f, 0.0f, 0.0f},
                     .edge_v = {0.0f, 0.5f, 2.0f},
                     .color = {0.5f, 0.5f, 0.4f},
                     .samples = 2}};
    for (std::uint32_t i = 0; i < 6 * kEnvironmentWidth * kEnvironmentWidth; ++i) {
      scene.environment.emplace_back(0.1f + 0.05f * static_cast<float>(i % 7), 0.3f, 0.7f);
    }
    view.environment_width = kEnvironmentWidth;
    for (std::size_t face = 0; face < 6; ++face) {
      constexpr std::size_t kTexels = kEnvironmentWidth * kEnvironmentWidth;
      view.environment_faces[face] = std::span<const Vec3>(scene.environment).subspan(face * kTexels, kTexels);
    }
    view.occlusion_samples = 16;
    view.occlusion_radius = 1.5f;
    view.samples_per_pixel = 4;
    view.levels = ColorLevels::kSrgb;
  } else {
    scene.lights = {{.corner = {400.0f, 600.0f, 500.0f}, .color = {0.9f, 0.9f, 0.9f}},
                    {.corner = {-300.0f, 700.0f, 200.0f}, .color = {0.4f, 0.4f, 0.4f}}};
    view.background = {0.1f, 0.2f, 0.4f};
  }
  view.recursion_depth = 3;
  view.materials = scene.materials;
  view.triangle_materials = scene.triangle_materials;
  view.normals = scene.normals;
  view.triangle_normals = scene.triangle_normals;
  view.colors = scene.colors;
  view.triangle_colors = scene.triangle_colors;
  view.lights = scene.lights;
}

// Work that only frames with effects have.
bool is_of_effects(std::size_t kind) {
  return kind >= WorkId(Work::kWaveRay).number() && kind <= WorkId(Work::kSrgbLevel).number();
}

// Work that only frames with exact distances have, or hardly any other.
bool is_of_planes(std::size_t kind) {
  const WorkId work(static_cast<std::uint32_t>(kind));
  return work == Work::kHitSetup || work == Work::kHitHalf || work == Work::kDepthGroup;
}

template <class Takes>
void add(Totals& sum, const Totals& more, const Takes& takes) {
  for (std::size_t kind = 0; kind < kWorkKindCount; ++kind) {
    if (takes(kind)) add(sum[kind], more[kind]);
  }
}

// Which rays need an exact decision depends on the scene, and hardly any does: rays through the vertices of triangles
// all over the scene are decided here.
constexpr std::size_t kDecisions = 64;

std::vector<ExactDecision> decisions_of(const Scene& scene) {
  std::vector<ExactDecision> decisions(kDecisions);
  const auto set = [](float(&to)[3], const Vec3& from) { std::copy_n(&from[0], 3, to); };
  for (std::size_t i = 0; i < kDecisions; ++i) {
    const UVec3& triangle = scene.triangles[i * scene.triangles.size() / kDecisions];
    const Vec3& a = scene.vertices[triangle.x];
    set(decisions[i].eye, kEye);
    set(decisions[i].direction, a - kEye);
    set(decisions[i].a, a);
    set(decisions[i].b, scene.vertices[triangle.y]);
    set(decisions[i].c, scene.vertices[triangle.z]);
  }
  return decisions;
}

double per_unit(const KindTotals& totals, double value) {
  return totals.units == 0 ? 0 : value / static_cast<double>(totals.units);
}
double per_unit(const KindTotals& totals, std::uint64_t value) {
  return per_unit(totals, static_cast<double>(value));
}

struct NamedFrame {
  std::string_view name;
  CountedFrame frame;
  bool is_apart = false;  ///< counted for second_opinion alone
  bool is_wide = false;   ///< has packets that need two passes
  /// Whether the frame stands for a kind of work: frames with planes, on a lattice, wide or with effects, for what only
  /// they do, the others for the rest.
  [[nodiscard]] bool operator()(std::size_t kind) const {
    const WorkId work(static_cast<std::uint32_t>(kind));
    const bool is_of_lattice = work == Work::kLatticeTriangle || work == GridWork::kCellBoundStep;
    const bool is_of_passes = work == Work::kGroupSkip || work == GridWork::kPassGroup;
    if (is_apart) return false;
    if ((frame.effects != nullptr) != is_of_effects(kind)) return false;
    if (frame.effects != nullptr) return true;
    return frame.has_planes == is_of_planes(kind) && (frame.accuracy == Accuracy::kCompact) == is_of_lattice &&
           is_wide == is_of_passes;
  }
};

/// What the frames show.
struct Scenes {
  Scene teapot = make_scene();
  Scene fine = scene_of(scene_makers::make_teapot(kFineSegments));
  EffectScene lamp, sun;
  Scenes() {
    make_effect_scene(teapot, true, lamp);
    make_effect_scene(teapot, false, sun);
  }
};

CountedFrame teapot_frame(const Scene& scene) {
  return {.vertices = scene.vertices, .triangles = scene.triangles, .camera = {.eye = kEye, .at = {0.25f, 1.5f, 0.0f}}};
}

CountedFrame of_mesh(CountedFrame frame, const Scene& scene) {
  frame.vertices = scene.vertices;
  frame.triangles = scene.triangles;
  return frame;
}

// Few pixels, but as dense as those of a larger picture.
CountedFrame effect_frame(CountedFrame frame, const EffectScene& scene, std::uint32_t width) {
  frame.camera.tan_half_fov = 0.25f;
  frame.vertices = scene.mesh.vertices;
  frame.triangles = scene.mesh.triangles;
  frame.effects = &scene.view;
  frame.shading = Shading::kScene;
  frame.width = width;
  return frame;
}

// A part of a picture ten times as wide.
CountedFrame close_up(CountedFrame frame, Vec3 at) {
  frame.camera.at = at;
  frame.camera.tan_half_fov = 0.04f;
  return frame;
}

constexpr std::size_t kFrameCount = 14;

std::array<NamedFrame, kFrameCount> frames_of(const Scenes& scenes) {
  const CountedFrame reference = teapot_frame(scenes.teapot);
  CountedFrame grid = reference;
  grid.configuration = tool::find_configuration("grid");
  CountedFrame near = grid;  // triangles as large as subpackets and larger
  near.camera.tan_half_fov = 0.06f;
  // Triangles as large as a scan's, cells as full and as empty: a body, and its edge before empty cells.
  const Vec3 body{0.25f, 1.5f, 0.0f}, spout{3.0f, 2.2f, 0.0f};
  const CountedFrame fine = of_mesh(reference, scenes.fine), fine_grid = of_mesh(grid, scenes.fine);
  CountedFrame paper = reference;
  paper.accuracy = Accuracy::kPaper;
  paper.shading = Shading::kNone;
  paper.width = 90;               // packets at the border are not whole
  CountedFrame wide = reference;  // rays of a packet march along two axes
  wide.camera = {.eye = {3.5f, 2.5f, 2.5f}, .at = {0.3f, 1.5f, 0.0f}, .tan_half_fov = 3.0f};
  CountedFrame planes = grid;
  planes.has_planes = true;
  CountedFrame compact = grid;
  compact.accuracy = Accuracy::kCompact;
  return {{{"reference", reference},
           {"grid", grid},
           {"near", near},
           {"body", close_up(fine, body)},
           {"spout", close_up(fine, spout)},
           {"body_grid", close_up(fine_grid, body)},
           {"spout_grid", close_up(fine_grid, spout)},
           {"dense", fine, true},
           {"wide", wide, false, true},
           {"paper", paper},
           {"planes", planes},
           {"compact", compact},
           {"lamp", effect_frame(grid, scenes.lamp, 12)},
           {"sun", effect_frame(grid, scenes.sun, 20)}}};
}

constexpr std::string_view kTableHead =
    R"(// What a unit of each kind of work costs on a core of two in-order pipes. Written by gridiron_calibrate from
// counted operations of the kernel itself; do not edit. tools/calibrate/README.md says how, and where each constant
// comes from.
// Memory: constants. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/sim/engine_work.h>
#include <gridiron/sim/work_cost.h>

#include <array>

namespace gridiron::sim {

/// By kind of work of core and of the grid. Commands and waits are charged where they happen, see MachineProfile.
inline constexpr std::array<WorkCost, kGridEngine.kind_count()> kWorkCosts = {{
    //  cycles    least     most     even  doubles      odd branches   misses
)";

constexpr std::string_view kBvhTableHead =
    R"(// What a unit of each of the cached BVH's kinds of work costs on a core of two in-order pipes. Written by
// gridiron_calibrate from counted operations of the cached BVH itself; do not edit. tools/calibrate/README.md says how.
// Memory: constants. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/lanes.h>
#include <gridiron/bvh/bvh_work.h>
#include <gridiron/sim/work_costs.h>

#include <array>

namespace gridiron::bvh {

/// Of core's tile_start, as the cached BVH does it, and of each of its own kinds of work.
inline constexpr std::array<sim::WorkCost, kBvhWorkCount + 1> kBvhCosts = {{
    //  cycles    least     most     even  doubles      odd branches   misses
)";

constexpr std::string_view kTreeTableHead =
    R"(// What a unit of each kind of work of eye rays through the tree costs on a core of two in-order pipes. Written
// by gridiron_calibrate from counted operations of the kernel itself; do not edit. tools/calibrate/README.md says how.
// Memory: constants. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/engine/tree/tile_work.h>
#include <gridiron/sim/work_cost.h>

#include <array>

namespace gridiron::sim {

/// By kind of TileWork, from kFirst on.
inline constexpr std::array<WorkCost, kTileWorkCount> kTileCosts = {{
    //  cycles    least     most     even  doubles      odd branches   misses
)";

std::string name_of(std::uint32_t kind, const sim::EngineWork& engine) {
  return std::string(sim::work_kind(WorkId(kind), engine).name);
}

std::string table_row(const KindTotals& t, const std::string& name) {
  if (t.units == 0) throw std::runtime_error("calibration: no unit of " + name + " in the frames");
  return format("    {%7.1f, %7.1f, %7.1f, %7.2f, %7.2f, %7.2f, %7.2f, %7.2f},  // %s\n", per_unit(t, t.cycles()),
                per_unit(t, t.resource_cycles()), per_unit(t, t.single_issue_cycles()), per_unit(t, t.even()),
                per_unit(t, t.operations[static_cast<std::size_t>(OpClass::kDouble)]), per_unit(t, t.odd()),
                per_unit(t, t.operations[static_cast<std::size_t>(OpClass::kBranch)]), per_unit(t, t.misses),
                name.c_str());
}

}  // namespace

namespace {

// On all threads.
void for_each_index(std::size_t count, const std::function<void(std::size_t)>& work) {
  experiment::share_work(std::max(1u, std::thread::hardware_concurrency()), count, work);
}

/// Frames in memory, and what their branches do.
struct FramesInMemory {
  std::vector<FrameInMemory> frames;
  std::map<CountedProgram, Branches> usual;

  /// @param counted  those for which `teaches` is false do not say which way a branch usually goes.
  template <class Teaches>
  FramesInMemory(std::span<const CountedFrame> counted, const Teaches& teaches) {
    for (const CountedFrame& frame : counted) frames.emplace_back(frame);
    std::vector<Branches> branches(counted.size());
    for_each_index(counted.size(), [&](std::size_t i) { branches[i] = frames[i].branches(); });
    for (std::size_t i = 0; i < counted.size(); ++i) {
      if (teaches(i)) calibrate::add(usual[frames[i].program()], branches[i]);
    }
  }
  [[nodiscard]] std::vector<Totals> count(const PipeRules& rules = {}) const {
    std::vector<Totals> totals(frames.size());
    for_each_index(frames.size(), [&](std::size_t i) {
      totals[i] = frames[i].count(usual.at(frames[i].program()), {}, rules).counts.totals;
    });
    return totals;
  }
};

FramesInMemory grid_frames(std::span<const NamedFrame> named) {
  std::vector<CountedFrame> frames;
  for (const NamedFrame& one : named) frames.push_back(one.frame);
  // Where distances have to be exact, hits go another way; few frames ask for it. Few packets need two passes.
  return {frames, [&](std::size_t i) { return !named[i].frame.has_planes && !named[i].is_wide && !named[i].is_apart; }};
}

constexpr std::uint32_t kKnotTriangles = 12'000;
constexpr Camera kKnotCamera = {.eye = {3.0f, 2.0f, 8.0f}};

FramesInMemory tree_frames() {
  const Scene teapot = make_scene(), fine = scene_of(scene_makers::make_teapot(kFineSegments));
  const Scene knot = scene_of(scene_makers::make_torus_knot(kKnotTriangles));
  CountedFrame frame = teapot_frame(teapot);
  frame.configuration = tool::find_configuration("best");
  std::vector<CountedFrame> frames = {frame};
  frame.has_planes = true;
  frames.push_back(frame);
  frame.has_planes = false;
  frame.shading = Shading::kNone;
  frames.push_back(frame);
  frames.push_back(of_mesh(frame, fine));
  frames.push_back(close_up(of_mesh(frame, fine), {0.25f, 1.5f, 0.0f}));
  frames.push_back(close_up(of_mesh(frame, fine), {3.0f, 2.2f, 0.0f}));
  CountedFrame near = frame;
  near.camera.tan_half_fov = 0.06f;
  frames.push_back(near);
  near.camera.tan_half_fov = 0.02f;
  frames.push_back(near);
  frame.camera = kKnotCamera;
  frames.push_back(of_mesh(frame, knot));
  return {frames, [](std::size_t) { return true; }};
}

FramesInMemory bvh_frames() {
  constexpr std::uint32_t kRing = 3;
  const Scene teapot = make_scene(), fine = scene_of(scene_makers::make_teapot(kFineSegments));
  const Scene knot = scene_of(scene_makers::make_torus_knot(kKnotTriangles));
  std::vector<CountedFrame> frames;
  for (const std::uint32_t ring_size : {1u, kRing}) {
    CountedFrame frame = teapot_frame(teapot);
    frame.ring_size = ring_size;
    frames.push_back(frame);
    frames.push_back(close_up(of_mesh(frame, fine), {0.25f, 1.5f, 0.0f}));
    frame.camera = kKnotCamera;
    frames.push_back(of_mesh(frame, knot));
  }
  return {frames, [](std::size_t) { return true; }};
}

}  // namespace

Totals count_frames(const PipeRules& rules) {
  const Scenes scenes;
  const auto named = frames_of(scenes);
  const FramesInMemory memory = grid_frames(named);
  Totals sum = count_decisions(decisions_of(scenes.teapot), rules);
  const std::vector<Totals> counted = memory.count(rules);
  for (std::size_t i = 0; i < named.size(); ++i) add(sum, counted[i], named[i]);
  return sum;
}

Totals count_frame(std::string_view name) {
  const Scenes scenes;
  const auto named = frames_of(scenes);
  const auto found = std::ranges::find(named, name, &NamedFrame::name);
  if (found == named.end()) throw std::runtime_error("calibration: no frame " + std::string(name));
  const FramesInMemory memory = grid_frames(named);
  const FrameInMemory& frame = memory.frames[static_cast<std::size_t>(found - named.begin())];
  return frame.count(memory.usual.at(frame.program())).counts.totals;
}

namespace {

// Registers that a share of the superblocks does with.
std::uint32_t registers_of(const Pressure& pressure, double share) {
  double left = share * static_cast<double>(std::accumulate(pressure.begin(), pressure.end(), std::uint64_t{0}));
  std::uint32_t registers = 0;
  for (; registers + 1 < pressure.size(); ++registers) {
    left -= static_cast<double>(pressure[registers]);
    if (left <= 0) break;
  }
  return registers;
}

struct RuledCycles {
  double cycles = 0, pairs = 0;
  Pressure pressure{};
};
RuledCycles cycles_under(const PipeRules& rules, const FrameInMemory& frame, const Branches& usual) {
  const Counts counts = frame.count(usual, {}, rules).counts;
  RuledCycles sum{.pressure = counts.pressure};
  for (std::size_t kind = 0; kind < kWorkKindCount; ++kind) {
    if (!is_charged(kind)) continue;
    sum.cycles += counts.totals[kind].cycles();
    sum.pairs += static_cast<double>(counts.totals[kind].pairs) / 2;
  }
  return sum;
}

}  // namespace

std::string rules_text() {
  struct Row {
    const char* name;
    PipeRules rules;
  };
  constexpr auto kCharged = kSuperblockBranches;
  const Row rows[] = {{"charged", {}},
                      {"superblocks of 1", {.superblock_branches = 1}},
                      {"of 2", {.superblock_branches = 2}},
                      {"of 8", {.superblock_branches = 8}},
                      {"of 16", {.superblock_branches = 16}},
                      {"hints", {.has_hints = true}},
                      {"fused multiply-add", {.fuses = true}},
                      {"spills", {.has_spills = true}},
                      {"spills, superblocks of 8", {.superblock_branches = 8, .has_spills = true}},
                      {"spills, of 16", {.superblock_branches = 16, .has_spills = true}}};
  static_assert(kCharged == 4, "rows name the lengths beside the charged one");
  const Scenes scenes;
  const auto named = frames_of(scenes);
  const FramesInMemory grid = grid_frames(named), of_bvh = bvh_frames();
  struct Column {
    const FrameInMemory& frame;
    const Branches& usual;
  };
  const auto column = [](const FramesInMemory& memory, std::size_t i) {
    return Column{memory.frames[i], memory.usual.at(memory.frames[i].program())};
  };
  const Column columns[] = {column(grid, 0), column(grid, 1), column(of_bvh, 4)};
  double charged[std::size(columns)] = {};
  std::string text =
      "| rule | reference | grid | cached BVH | dual issue | registers of half the superblocks | of 99 % |\n"
      "|---|---|---|---|---|---|---|\n";
  for (const Row& row : rows) {
    text += format("| %s |", row.name);
    RuledCycles sum;
    for (std::size_t i = 0; i < std::size(columns); ++i) {
      const RuledCycles one = cycles_under(row.rules, columns[i].frame, columns[i].usual);
      if (charged[i] == 0) charged[i] = one.cycles;
      text += format(" %+.1f %% |", 100 * (one.cycles / charged[i] - 1));
      sum.cycles += one.cycles;
      sum.pairs += one.pairs;
      for (std::size_t k = 0; k < sum.pressure.size(); ++k) sum.pressure[k] += one.pressure[k];
    }
    text += format(" %.1f %% |", 100 * sum.pairs / sum.cycles);
    text += row.rules.has_spills
                ? format(" %u | %u |\n", registers_of(sum.pressure, 0.5), registers_of(sum.pressure, 0.99))
                : " | |\n";
  }
  return text;
}

Totals count_bvh_frames(const PipeRules& rules) {
  const FramesInMemory memory = bvh_frames();
  Totals sum{};
  for (const Totals& totals : memory.count(rules)) add(sum, totals, [](std::size_t) { return true; });
  return sum;
}

Totals count_tree_frames(const PipeRules& rules) {
  const FramesInMemory memory = tree_frames();
  Totals sum{};
  for (const Totals& totals : memory.count(rules)) add(sum, totals, [](std::size_t) { return true; });
  return sum;
}

std::map<CountedProgram, Branches> usual_branches() {
  const Scenes scenes;
  std::map<CountedProgram, Branches> usual = grid_frames(frames_of(scenes)).usual;
  usual.merge(tree_frames().usual);
  usual.merge(bvh_frames().usual);
  return usual;
}

std::string table_text(const Totals& totals) {
  std::string text(kTableHead);
  for (std::uint32_t kind = 0; kind < sim::kGridEngine.kind_count(); ++kind) {
    const std::string name = name_of(kind, sim::kGridEngine);
    if (!is_charged(kind)) {
      text += format("    {%7d, %7d, %7d, %7d, %7d, %7d, %7d, %7d},  // %s\n", 0, 0, 0, 0, 0, 0, 0, 0, name.c_str());
    } else {
      text += table_row(totals[kind], name);
    }
  }
  return text + "}};\n\n}  // namespace gridiron::sim\n";
}

std::string bvh_table_text(const Totals& totals) {
  std::string text(kBvhTableHead);
  for (const sim::WorkPrice& price : bvh::kBvhPrices) {
    text += table_row(totals[price.id.number()], name_of(price.id.number(), bvh::kBvhEngine));
  }
  return text + "}};\n\n}  // namespace gridiron::bvh\n";
}

std::string tree_table_text(const Totals& totals) {
  std::string text(kTreeTableHead);
  for (const sim::WorkKind& kind : sim::kTileWorkKinds) {
    text += table_row(totals[kind.id.number()], std::string(kind.name));
  }
  return text + "}};\n\n}  // namespace gridiron::sim\n";
}

namespace {

void write_file(const std::string& path, std::span<const std::byte> bytes) {
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (!file.flush()) throw std::runtime_error("calibration: cannot write " + path);
}

}  // namespace

void write_memories(const std::string& folder) {
  const Scenes scenes;
  const auto frames = frames_of(scenes);
  const std::vector<ExactDecision> decisions = decisions_of(scenes.teapot);
  Totals totals = count_decisions(decisions, PipeRules{});
  std::ofstream frame_list(folder + "/frames"), parts(folder + "/parts"), kinds(folder + "/units");
  const std::uint32_t kind_count = sim::kGridEngine.kind_count();
  const auto write_frame = [&](const std::string& name, const Totals& counted, const auto& stands_for) {
    std::ofstream units(folder + "/" + name + ".units");
    for (std::uint32_t kind = 0; kind < kind_count; ++kind) {
      units << kind << ' ' << counted[kind].units << '\n';
      if (stands_for(kind)) parts << name << ' ' << kind << '\n';
    }
    if (!units.flush()) throw std::runtime_error("calibration: cannot write into " + folder);
  };
  write_file(folder + "/exact.memory", std::as_bytes(std::span(decisions)));
  frame_list << "exact decisions 0\n";
  write_frame("exact", totals, [&](std::uint32_t kind) { return totals[kind].units != 0; });
  const std::vector<Totals> counted = grid_frames(frames).count();
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const CountedFrame& frame = frames[i].frame;
    const std::string name(frames[i].name);
    write_file(folder + "/" + name + ".memory", FrameInMemory(frame).bytes());
    const std::uint32_t effects = frame.effects == nullptr ? 0 : kAllEffects;
    frame_list << name << ' ' << frame.configuration->packet_width << ' ' << effects << '\n';
    write_frame(name, counted[i], frames[i]);
    add(totals, counted[i], frames[i]);
  }
  for (std::uint32_t kind = 0; kind < kind_count; ++kind) {
    const KindTotals& t = totals[kind];
    const char* group = !is_charged(kind) ? "events" : is_of_effects(kind) ? "effects" : "packets";
    kinds << kind << ' ' << name_of(kind, sim::kGridEngine) << ' ' << t.units << ' ' << per_unit(t, t.even() + t.odd())
          << ' ' << group << '\n';
  }
  for (std::ofstream* file : {&frame_list, &parts, &kinds}) {
    if (!file->flush()) throw std::runtime_error("calibration: cannot write into " + folder);
  }
}

namespace {

// Kinds of which the engine has a price of its own are marked as its own.
std::string report_of(const Totals& totals, const sim::EngineWork& engine) {
  std::string text = format("%-20s %8s %8s", "kind", "units", "cycles");
  for (const ClassFacts& facts : kClassFacts) text += format(" %8s", facts.name);
  text += format(" %8s\n", "misses");
  double cycles = 0;
  double pairs = 0;
  for (std::uint32_t kind = 0; kind < engine.kind_count(); ++kind) {
    const KindTotals& t = totals[kind];
    if (t.units == 0 || !is_charged(kind)) continue;
    std::string name = name_of(kind, engine);
    const bool is_of_tiles = engine.id == sim::kTreeEngine.id && kind >= kSharedWorkCount;
    if (is_of_tiles || engine.has_price(WorkId(kind))) name = std::string(engine.name) + ":" + name;
    text +=
        format("%-20s %8llu %8.1f", name.c_str(), static_cast<unsigned long long>(t.units), per_unit(t, t.cycles()));
    for (const std::uint64_t count : t.operations) text += format(" %8.2f", per_unit(t, count));
    text += format(" %8.2f\n", per_unit(t, t.misses));
    cycles += t.cycles();
    pairs += static_cast<double>(t.pairs) / 2;
  }
  return text + format("dual issue in %.1f %% of all cycles\n", 100 * pairs / cycles);
}

}  // namespace

std::string report_text(const Totals& totals) {
  return report_of(totals, sim::kGridEngine);
}

std::string tree_report_text(const Totals& totals) {
  return report_of(totals, sim::kTreeEngine);
}

std::string bvh_report_text(const Totals& totals) {
  return report_of(totals, bvh::kBvhEngine);
}

}  // namespace gridiron::calibrate
