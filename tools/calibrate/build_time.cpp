// Runs and replays builds: see the header. SPDX-License-Identifier: Apache-2.0
#include <build_time.h>
#include <gridiron/build/passes/build_passes.h>
#include <gridiron/build/tree/tree_builder.h>
#include <gridiron/sim/build_pass_work.h>
#include <gridiron/sim/pass_timing.h>
#include <gridiron/sim/passes.h>
#include <table_words.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstring>
#include <set>
#include <stdexcept>
#include <vector>

#include "experiment/views.h"

namespace gridiron::calibrate {
namespace {

constexpr std::uint32_t kLeafTriangles = 8;

void require(bool holds, const char* words) {
  if (!holds) throw std::runtime_error(words);
}

// A mesh in the simulated main memory, and its tree.
template <class Layout>
class SimulatedBuild {
 public:
  SimulatedBuild(std::span<const Vec3> vertices, std::span<const UVec3> triangles)
      : memory_(bytes_of(vertices.size(), triangles.size())) {
    input_ = input_of(vertices.size(), triangles.size());
    const auto place = [this](std::uint64_t bytes) {
      const auto region = memory_.allocate(bytes);
      require(region.has_value(), "a build does not fit the memory");
      regions_.push_back({region->address.value, region->address.value + region->bytes.size()});
      return *region;
    };
    const auto points = place(12 * vertices.size() + 16), corners = place(12 * triangles.size() + 16);
    std::memcpy(points.bytes.data(), vertices.data(), vertices.size_bytes());
    std::memcpy(corners.bytes.data(), triangles.data(), triangles.size_bytes());
    regions_.clear();
    input_.vertices = points.address;
    input_.triangles = corners.address;
    records_ = place(sizeof(VertexTriangle) * std::uint64_t{input_.record_room}).bytes;
    input_.records = MainAddress{regions_.back().begin};
    nodes_ = place(sizeof(TreeNode) * std::uint64_t{input_.node_room}).bytes;
    input_.nodes = MainAddress{regions_.back().begin};
    result_ = place(sizeof(BuildResult)).bytes;
    input_.result = MainAddress{regions_.back().begin};
    input_.scratch = place(build_scratch_bytes<Layout>(input_)).address;
    require(plan_build<Layout>(input_, plan_) == Status::kOk, "a build cannot be planned");
  }

  // Builds, compares with the tree of one core, and keeps the traces.
  void run(std::span<const Vec3> vertices, std::span<const UVec3> triangles) {
    std::vector<sim::Pass> passes;
    for (std::uint32_t i = 0; i < kBuildPassCount; ++i) {
      const auto kernel = [this, i](auto& core, std::span<std::byte> data) {
        auto& store = *reinterpret_cast<BuildStore<Layout>*>(data.data());
        return run_build_pass(core, store, plan_, static_cast<BuildPass>(i));
      };
      passes.push_back({.name = sim::name_of(static_cast<BuildPass>(i)),
                        .items = {.most = plan_.item_counts[i]},
                        .data_bytes = sizeof(BuildStore<Layout>),
                        .writable = regions_,
                        .kernel = sim::PassKernel(kernel),
                        .engine = &sim::work_of(static_cast<BuildPass>(i))});
    }
    sim::ChipOptions options;
    options.threads = 2;
    options.store = Layout::kArenaBytes > 65536 ? sim::StoreSize::k256KB : sim::StoreSize::k64KB;
    sim::PassesResult result = sim::run_passes(memory_, passes, options);
    require(result.status == Status::kOk, "a tree cannot be built");
    runs_ = std::move(result.passes);

    std::vector<VertexTriangle> records(triangles.size());
    std::vector<TreeNode> nodes(input_.node_room);
    std::vector<std::uint64_t> scratch(tree_scratch_bytes(triangles.size()) / 8);
    TreeSize size{};
    require(build_tree(MeshView{vertices, triangles}, kLeafTriangles, records, nodes,
                       std::as_writable_bytes(std::span(scratch)), size) == Status::kOk,
            "build_tree() cannot build a tree");
    require(std::memcmp(&size, result_.data(), sizeof size) == 0 &&
                std::memcmp(records.data(), records_.data(), size.triangle_count * sizeof records[0]) == 0 &&
                std::memcmp(nodes.data(), nodes_.data(), size.node_count * sizeof nodes[0]) == 0,
            "the passes build another tree than build_tree()");
  }

  [[nodiscard]] sim::PassesTiming timing(const sim::MachineProfile& machine, std::uint32_t cores) const {
    return sim::replay_passes(runs_, machine, cores);
  }

 private:
  [[nodiscard]] static BuildInput input_of(std::size_t vertices, std::size_t triangles) {
    BuildInput input;
    input.vertex_count = static_cast<std::uint32_t>(vertices);
    input.triangle_count = static_cast<std::uint32_t>(triangles);
    input.leaf_triangles = kLeafTriangles;
    input.record_room = input.triangle_count;
    input.node_room = static_cast<std::uint32_t>(most_tree_nodes(triangles, kLeafTriangles));
    return input;
  }
  [[nodiscard]] static std::uint64_t bytes_of(std::size_t vertices, std::size_t triangles) {
    const BuildInput input = input_of(vertices, triangles);
    return build_scratch_bytes<Layout>(input) + 12 * vertices + 60 * triangles +
           sizeof(TreeNode) * std::uint64_t{input.node_room} + (1u << 20);
  }

  sim::SimMemory memory_;
  BuildInput input_;
  BuildPlan plan_{};
  std::vector<sim::MainRange> regions_;
  std::span<std::byte> records_, nodes_, result_;
  std::vector<sim::PassRun> runs_;
};

std::string passes_text(const sim::PassesTiming& timing, std::size_t triangles, double clock_hz) {
  std::string text = format("%-9s %6s %9s %8s %8s %8s %8s %8s %8s  %-8s %6s %6s\n", "pass", "items", "cycles",
                            "channel", "compute", "waiting", "one item", "barrier", "ms", "binds", "ratio", "B/tri");
  for (const sim::PassTiming& pass : timing.passes) {
    const double channel = pass.limits[0], compute = pass.limits[1], binding = std::max(channel, compute);
    std::uint64_t bytes = 0;
    for (const sim::CoreTiming& core : pass.run.cores) bytes += core.line_bytes_in + core.line_bytes_out;
    text +=
        format("%-9s %6u %9.0f %8.0f %8.0f %8.0f %8.0f %8.0f %8.3f  %-8s %6.2f %6.1f\n", pass.name.data(), pass.items,
               pass.cycles, channel, compute, pass.limits[2], pass.limits[3], pass.limits[4],
               1e3 * pass.cycles / clock_hz, std::string(sim::name_of(pass.binding)).c_str(),
               binding == 0 ? 0 : pass.cycles / binding, static_cast<double>(bytes) / static_cast<double>(triangles));
  }
  return text;
}

template <class Layout>
void add_times(std::string& text, const experiment::View& view) {
  const tool::Mesh& mesh = view.mesh();
  const sim::MachineProfile& machine = *sim::find_machine_profile("cell-ps3");
  SimulatedBuild<Layout> build(mesh.vertices, mesh.triangles);
  build.run(mesh.vertices, mesh.triangles);
  text += format("%s, %zu triangles, cores of %u KB:", view.scene->path.stem().string().c_str(), mesh.triangles.size(),
                 Layout::kArenaBytes / 1024);
  for (const std::uint32_t cores : {1u, 6u, 16u}) {
    const sim::PassesTiming timing = build.timing(machine, cores);
    text += format(" %u: %.3f ms,", cores, 1e3 * timing.seconds);
  }
  const sim::PassesTiming timing = build.timing(machine, 6);
  text += format(" passes of one item of 6: %.3f ms\n", 1e3 * timing.one_item_cycles / machine.clock_hz);
  text += passes_text(timing, mesh.triangles.size(), machine.clock_hz) + "\n";
}

}  // namespace

std::string build_times_text(const std::filesystem::path& scenes) {
  const experiment::FoundViews found = experiment::find_views(scenes);
  std::string text;
  std::set<const tool::SceneInput*> done;
  for (const experiment::View& view : found.views) {
    if (!done.insert(view.scene.get()).second) continue;  // another view of the same mesh
    add_times<BuildLayout256K>(text, view);
    add_times<BuildLayout64K>(text, view);
  }
  return text;
}

}  // namespace gridiron::calibrate
