// Counted builds: see the header. SPDX-License-Identifier: Apache-2.0
#include <build_count.h>
#include <copy_core.h>
#include <counted_kernel.h>
#include <gridiron/build/passes/build_passes.h>
#include <gridiron/build/tree/tree_builder.h>
#include <gridiron/sim/build_pass_work.h>
#include <scene_makers/shapes.h>
#include <table_words.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <random>
#include <set>
#include <thread>

#include "experiment/views.h"
#include "experiment/workers.h"

namespace gridiron::calibrate {
namespace {

using Layout = BuildLayout256K;
constexpr std::uint32_t kLeafTriangles = 8;
// The last pass checks an image, which there is none of here.
constexpr std::uint32_t kPasses = static_cast<std::uint32_t>(BuildPass::kCheck);

void check(bool holds, const char* words) {
  if (!holds) throw std::runtime_error(words);
}

struct PlainMesh {
  std::vector<Vec3> vertices;
  std::vector<UVec3> triangles;
};

// A mesh in main memory, and the tree that the passes make of it there.
class BuildInMemory {
 public:
  BuildInMemory(std::span<const Vec3> vertices, std::span<const UVec3> triangles)
      : vertices_(vertices), triangles_(triangles) {
    BuildInput input;
    std::uint64_t end = kLineBytes;
    const auto place = [&end](std::uint64_t bytes) {
      const MainAddress address{end};
      end += round_up<std::uint64_t>(bytes, kLineBytes);
      return address;
    };
    input.vertex_count = static_cast<std::uint32_t>(vertices.size());
    input.triangle_count = static_cast<std::uint32_t>(triangles.size());
    input.leaf_triangles = kLeafTriangles;
    input.record_room = input.triangle_count;
    input.node_room = static_cast<std::uint32_t>(most_tree_nodes(triangles.size(), kLeafTriangles));
    input.vertices = place(vertices.size_bytes() + 16);
    input.triangles = place(triangles.size_bytes() + 16);
    input.records = place(sizeof(VertexTriangle) * std::uint64_t{input.record_room});
    input.nodes = place(sizeof(TreeNode) * std::uint64_t{input.node_room});
    input.result = place(sizeof(BuildResult));
    input.scratch = place(build_scratch_bytes<Layout>(input));
    check(plan_build<Layout>(input, plan_) == Status::kOk, "calibration: a build cannot be planned");
    bytes_ = LineBytes(end);
    std::memcpy(at(input.vertices), vertices.data(), vertices.size_bytes());
    std::memcpy(at(input.triangles), triangles.data(), triangles.size_bytes());
  }

  [[nodiscard]] CountedPass pass(std::uint32_t number) {
    items_.resize(plan_.item_counts[number]);
    std::iota(items_.begin(), items_.end(), 0u);
    return {bytes_.bytes(), std::as_bytes(std::span(&plan_, 1)), number, items_};
  }
  // The pass itself. @returns its work.
  [[nodiscard]] WorkCounters run(std::uint32_t number) {
    const CountedPass all = pass(number);
    const LineBytes bytes(sizeof(BuildStore<Layout>));
    auto& store = *reinterpret_cast<BuildStore<Layout>*>(bytes.bytes().data());
    CopyCore core(all.memory, all.items);
    require(run_build_pass(core, store, plan_, static_cast<BuildPass>(number)));
    return store.work;
  }
  void compare() const {
    std::vector<VertexTriangle> records(triangles_.size());
    std::vector<TreeNode> nodes(plan_.input.node_room);
    std::vector<std::uint64_t> scratch(tree_scratch_bytes(triangles_.size()) / 8);
    TreeSize size{};
    require(build_tree(MeshView{vertices_, triangles_}, kLeafTriangles, records, nodes,
                       std::as_writable_bytes(std::span(scratch)), size));
    check(std::memcmp(&size, at(plan_.input.result), sizeof size) == 0 &&
              std::memcmp(records.data(), at(plan_.input.records), size.triangle_count * sizeof records[0]) == 0 &&
              std::memcmp(nodes.data(), at(plan_.input.nodes), size.node_count * sizeof nodes[0]) == 0,
          "calibration: the counted tree is another one");
  }

 private:
  [[nodiscard]] std::byte* at(MainAddress address) const { return bytes_.bytes().data() + address.value; }

  std::span<const Vec3> vertices_;
  std::span<const UVec3> triangles_;
  BuildPlan plan_{};
  LineBytes bytes_{0};
  std::vector<std::uint32_t> items_;
};

// What the branches of each pass do.
using PassBranches = std::array<Branches, kBuildPassCount>;

PassBranches branches_of_build(std::span<const Vec3> vertices, std::span<const UVec3> triangles) {
  BuildInMemory build(vertices, triangles);
  PassBranches branches;
  for (std::uint32_t i = 0; i < kPasses; ++i) branches[i] = branches_of(build.pass(i));
  return branches;
}

BuildTotals totals_of_build(std::span<const Vec3> vertices, std::span<const UVec3> triangles,
                            const PassBranches& usual) {
  BuildInMemory build(vertices, triangles), plain(vertices, triangles);
  BuildTotals totals{};
  for (std::uint32_t i = 0; i < kPasses; ++i) {
    totals[i] = run_counted(build.pass(i), usual[i], {}).totals;
    const WorkCounters work = plain.run(i);
    for (std::uint32_t kind = 0; kind < kWorkKindCount; ++kind) {
      if (is_charged(kind))
        check(totals[i][kind].units == work.counts[kind], "calibration: a counted pass did other work");
    }
  }
  build.compare();
  return totals;
}

// --- Meshes of the calibration --------------------------------------------------------------------------------------

PlainMesh mesh_of(const scene_makers::Mesh& made, float scale, const Vec3& offset) {
  PlainMesh mesh;
  for (const scene_makers::Point& p : made.vertices) {
    mesh.vertices.push_back(Vec3(static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])) * scale +
                            offset);
  }
  for (const scene_makers::Triangle& t : made.triangles) mesh.triangles.emplace_back(t[0], t[1], t[2]);
  return mesh;
}

void append(PlainMesh& mesh, const PlainMesh& more) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), more.vertices.begin(), more.vertices.end());
  for (const UVec3& t : more.triangles) mesh.triangles.emplace_back(t.x + first, t.y + first, t.z + first);
}

template <class Element>
std::vector<std::uint32_t> shuffle(std::vector<Element>& elements, std::mt19937& random) {
  std::vector<std::uint32_t> places(elements.size());
  std::iota(places.begin(), places.end(), 0u);
  for (std::size_t i = places.size(); i > 1; --i) std::swap(places[i - 1], places[random() % i]);
  std::vector<Element> moved(elements.size());
  for (std::size_t i = 0; i < places.size(); ++i) moved[places[i]] = elements[i];
  elements = std::move(moved);
  return places;
}

std::vector<PlainMesh> calibration_meshes() {
  constexpr std::uint32_t kSegments = 20, kKnot = 50'000, kSmallKnot = 2'000, kSmallKnots = 12, kCrowd = 6'000;
  std::vector<PlainMesh> meshes;
  meshes.push_back(mesh_of(scene_makers::make_teapot(kSegments), 1, {}));
  meshes.push_back(mesh_of(scene_makers::make_torus_knot(kKnot / 2), 1, {}));
  PlainMesh mixed = mesh_of(scene_makers::make_torus_knot(kKnot), 1, {});
  std::mt19937 random(1);
  const std::vector<std::uint32_t> places = shuffle(mixed.vertices, random);
  for (UVec3& t : mixed.triangles) t = UVec3(places[t.x], places[t.y], places[t.z]);
  (void)shuffle(mixed.triangles, random);
  meshes.push_back(std::move(mixed));
  // As chairs in a room: 5 mm in 100 m.
  PlainMesh room = meshes[0];
  for (Vec3& vertex : room.vertices) vertex *= 10.0f;
  for (std::uint32_t i = 0; i < kSmallKnots; ++i) {
    const Vec3 offset(static_cast<float>(i % 4) * 7.0f, static_cast<float>(i / 4) * 3.0f, static_cast<float>(i) * 2.0f);
    append(room, mesh_of(scene_makers::make_torus_knot(kSmallKnot), i % 3 == 0 ? 0.0005f : 0.02f, offset));
  }
  // More of one code than the store holds with their records.
  append(room, mesh_of(scene_makers::make_torus_knot(kCrowd), 0.0005f, Vec3(1.0f, 9.0f, -3.0f)));
  meshes.push_back(std::move(room));
  return meshes;
}

void for_each_index(std::size_t count, const std::function<void(std::size_t)>& work) {
  experiment::share_work(std::max(1u, std::thread::hardware_concurrency()), count, work);
}

PassBranches usual_of(std::span<const PlainMesh> meshes) {
  std::vector<PassBranches> all(meshes.size());
  for_each_index(meshes.size(),
                 [&](std::size_t i) { all[i] = branches_of_build(meshes[i].vertices, meshes[i].triangles); });
  PassBranches usual;
  for (const PassBranches& one : all) {
    for (std::uint32_t pass = 0; pass < kPasses; ++pass) add(usual[pass], one[pass]);
  }
  return usual;
}

// --- Tables ---------------------------------------------------------------------------------------------------------

Totals sum_of(const BuildTotals& totals) {
  Totals sum{};
  for (const Totals& pass : totals) {
    for (std::uint32_t kind = 0; kind < kWorkKindCount; ++kind) add(sum[kind], pass[kind]);
  }
  return sum;
}

constexpr std::string_view kTableHead =
    R"(// What a unit of each kind of work of the passes that build a tree costs on a core of two in-order pipes.
// Written by gridiron_calibrate from counted operations of the passes; do not edit. tools/calibrate/README.md says how.
// Memory: constants. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/build/passes/build_work.h>
#include <gridiron/sim/work_cost.h>

#include <array>

namespace gridiron::sim {

/// By kind of BuildWork, from kFirst on.
inline constexpr std::array<WorkCost, kBuildWorkCount> kBuildPassCosts = {{
    //  cycles    least     most     even  doubles      odd branches   misses
)";

double per_unit(const KindTotals& totals, double value) {
  return totals.units == 0 ? 0 : value / static_cast<double>(totals.units);
}
double per_unit(const KindTotals& totals, std::uint64_t value) {
  return per_unit(totals, static_cast<double>(value));
}

}  // namespace

BuildTotals count_builds() {
  const std::vector<PlainMesh> meshes = calibration_meshes();
  const PassBranches usual = usual_of(meshes);
  std::vector<BuildTotals> all(meshes.size());
  for_each_index(meshes.size(),
                 [&](std::size_t i) { all[i] = totals_of_build(meshes[i].vertices, meshes[i].triangles, usual); });
  BuildTotals sum{};
  for (const BuildTotals& one : all) {
    for (std::uint32_t pass = 0; pass < kPasses; ++pass) {
      for (std::uint32_t kind = 0; kind < kWorkKindCount; ++kind) add(sum[pass][kind], one[pass][kind]);
    }
  }
  return sum;
}

std::string build_table_text(const BuildTotals& totals) {
  const Totals sum = sum_of(totals);
  std::string text(kTableHead);
  for (const sim::WorkKind& kind : sim::kBuildPassKinds) {
    const KindTotals& t = sum[kind.id.number()];
    check(t.units != 0, "calibration: a kind of work of the passes does not occur");
    text += format("    {%7.1f, %7.1f, %7.1f, %7.2f, %7.2f, %7.2f, %7.2f, %7.2f},  // %s\n", per_unit(t, t.cycles()),
                   per_unit(t, t.resource_cycles()), per_unit(t, t.single_issue_cycles()), per_unit(t, t.even()),
                   per_unit(t, t.operations[static_cast<std::size_t>(OpClass::kDouble)]), per_unit(t, t.odd()),
                   per_unit(t, t.operations[static_cast<std::size_t>(OpClass::kBranch)]), per_unit(t, t.misses),
                   std::string(kind.name).c_str());
  }
  return text + "}};\n\n}  // namespace gridiron::sim\n";
}

std::string build_report_text(const BuildTotals& totals) {
  const Totals sum = sum_of(totals);
  std::string text = format("%-20s %8s %8s", "kind", "units", "cycles");
  for (const ClassFacts& facts : kClassFacts) text += format(" %8s", facts.name);
  text += format(" %8s\n", "misses");
  for (const sim::WorkKind& kind : sim::kBuildPassKinds) {
    const KindTotals& t = sum[kind.id.number()];
    text += format("%-20s %8llu %8.1f", std::string(kind.name).c_str(), static_cast<unsigned long long>(t.units),
                   per_unit(t, t.cycles()));
    for (const std::uint64_t count : t.operations) text += format(" %8.2f", per_unit(t, count));
    text += format(" %8.2f\n", per_unit(t, t.misses));
  }
  return text;
}

double BuildCount::all_counted() const {
  return std::accumulate(counted.begin(), counted.end(), 0.0);
}
double BuildCount::all_priced() const {
  return std::accumulate(priced.begin(), priced.end(), 0.0);
}

std::vector<BuildCount> count_scans(const std::filesystem::path& scenes) {
  const PassBranches usual = usual_of(calibration_meshes());
  const experiment::FoundViews found = experiment::find_views(scenes);
  std::vector<const experiment::View*> views;
  std::set<const tool::SceneInput*> known;
  for (const experiment::View& view : found.views) {
    if (known.insert(view.scene.get()).second) views.push_back(&view);
  }
  const auto prices = sim::work_prices(*sim::find_machine_profile("cell-ps3"), sim::kBuildPassesWork);
  std::vector<BuildCount> counts(views.size());
  for_each_index(views.size(), [&](std::size_t i) {
    BuildCount& count = counts[i];
    const tool::Mesh& mesh = views[i]->mesh();
    count.scan = views[i]->scene->path.stem().string();
    count.totals = totals_of_build(mesh.vertices, mesh.triangles, usual);
    for (std::uint32_t pass = 0; pass < kPasses; ++pass) {
      for (std::uint32_t kind = 0; kind < kWorkKindCount; ++kind) {
        if (!is_charged(kind)) continue;
        const KindTotals& t = count.totals[pass][kind];
        count.counted[pass] += t.cycles();
        count.priced[pass] += prices[kind] * static_cast<double>(t.units);
      }
    }
  });
  return counts;
}

std::string build_count_table(const std::vector<BuildCount>& counts) {
  std::string text = "| build | counted, M cycles | priced | difference |";
  for (std::uint32_t i = 0; i < kPasses; ++i) {
    text += format(" %s |", std::string(sim::name_of(static_cast<BuildPass>(i))).c_str());
  }
  text += "\n|---|---|---|---|";
  for (std::uint32_t i = 0; i < kPasses; ++i) text += "---|";
  text += "\n";
  for (const BuildCount& one : counts) {
    text += format("| %s | %.2f | %.2f | %+.1f %% |", one.scan.c_str(), one.all_counted() / 1e6, one.all_priced() / 1e6,
                   100 * one.error());
    for (std::uint32_t i = 0; i < kPasses; ++i) {
      text += format(" %.2f, %+.1f %% |", one.counted[i] / 1e6, 100 * (one.priced[i] / one.counted[i] - 1));
    }
    text += "\n";
  }
  return text;
}

std::string build_count_kinds(const std::vector<BuildCount>& counts) {
  const auto prices = sim::work_prices(*sim::find_machine_profile("cell-ps3"), sim::kBuildPassesWork);
  std::string text = format("%-17s %8s", "kind", "price");
  for (const BuildCount& one : counts) text += format(" %24.24s", one.scan.c_str());
  text += "   (cycles a unit, share of all cycles, what the price adds to the error)\n";
  for (const sim::WorkKind& kind : sim::kBuildPassKinds) {
    const std::uint32_t number = kind.id.number();
    text += format("%-17s %8.1f", std::string(kind.name).c_str(), prices[number]);
    for (const BuildCount& one : counts) {
      const Totals sum = sum_of(one.totals);
      const KindTotals& t = sum[number];
      const double units = static_cast<double>(t.units);
      text +=
          format(" %10.1f %5.1f %+6.2f", units == 0 ? t.cycles() : t.cycles() / units,
                 100 * t.cycles() / one.all_counted(), 100 * (prices[number] * units - t.cycles()) / one.all_counted());
    }
    text += "\n";
  }
  return text;
}

}  // namespace gridiron::calibrate
