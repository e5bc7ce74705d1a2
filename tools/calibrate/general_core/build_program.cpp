// Builds one structure over one mesh and prints the counted steps of the build. Compiled for riscv64 it is what
// general_core/run gives to the core model; compiled for the host it tells the processor time.
//   build_program MESH BUILDER [REPETITIONS]
// MESH: teapot:SEGMENTS, knot:TRIANGLES, stacked:SEGMENTS, crowded:TRIANGLES or a PLY file. BUILDER: bvh, tree,
// tree_image, or grid:LAMBDA:WIDTH:FORMAT.
// Memory: std::vector. Threads: one. SPDX-License-Identifier: Apache-2.0
#include <gridiron/build/build_step.h>
#include <gridiron/build/grid/grid_builder.h>
#include <gridiron/build/tree/tree_builder.h>
#include <gridiron/bvh/bvh.h>
#include <gridiron/bvh/bvh_build_work.h>
#include <gridiron/image/scene_image.h>
#include <gridiron/io/ply_reader.h>
#include <gridiron/sim/build_work.h>
#include <gridiron/sim/mesh_lines.h>
#include <gridiron/sim/tree_build_work.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "scene_makers/shapes.h"

namespace {

using namespace gridiron;

[[noreturn]] void fail(const std::string& text) {
  std::fprintf(stderr, "build_program: %s\n", text.c_str());
  std::exit(1);
}

struct Input {
  std::vector<Vec3> vertices;
  std::vector<UVec3> triangles;
  [[nodiscard]] MeshView view() const { return {vertices, triangles}; }
};

Input from_maker(const scene_makers::Mesh& mesh) {
  Input input;
  for (const auto& p : mesh.vertices) {
    input.vertices.emplace_back(static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2]));
  }
  for (const auto& t : mesh.triangles) input.triangles.emplace_back(t[0], t[1], t[2]);
  return input;
}

Input from_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  const std::vector<char> text{std::istreambuf_iterator<char>(file), {}};
  const std::span bytes = std::as_bytes(std::span(text));
  Input input;
  const PlyResult counted = count_ply(bytes);
  if (counted.error != PlyError::kNone) fail("cannot read " + path);
  input.vertices.resize(counted.counts.vertices);
  input.triangles.resize(counted.counts.triangles);
  if (read_ply(bytes, input.vertices, input.triangles).error != PlyError::kNone) fail("cannot read " + path);
  return input;
}

// Every triangle so often, one behind the other: more than a leaf holds, and nothing to tell them apart.
Input stacked(const Input& once) {
  constexpr int kCopies = 24;
  Input input{once.vertices, {}};
  for (const UVec3& triangle : once.triangles) input.triangles.insert(input.triangles.end(), kCopies, triangle);
  return input;
}

// A mesh in a corner of a space that is so much larger: many triangles of one code.
Input crowded(Input input) {
  constexpr float kShare = 0.25f;
  for (Vec3& vertex : input.vertices) vertex *= kShare;
  const auto first = static_cast<std::uint32_t>(input.vertices.size());
  for (const Vec3& corner : {Vec3(100, 100, 100), Vec3(101, 100, 100), Vec3(100, 101, 100)}) {
    input.vertices.push_back(corner);
  }
  input.triangles.emplace_back(first, first + 1, first + 2);
  return input;
}

// The same mesh in an order that says nothing: runs of triangles and of vertices are dealt out anew.
Input shuffled(const Input& ordered, std::uint32_t run) {
  const auto permutation = [run](std::size_t count) {
    std::vector<std::uint32_t> starts;
    for (std::size_t i = 0; i < count; i += run) starts.push_back(static_cast<std::uint32_t>(i));
    std::mt19937 random(1);
    for (std::size_t i = starts.size(); i > 1; --i) std::swap(starts[i - 1], starts[random() % i]);
    std::vector<std::uint32_t> order;
    for (const std::uint32_t start : starts) {
      for (std::uint32_t i = start; i < start + run && i < count; ++i) order.push_back(i);
    }
    return order;
  };
  Input input;
  std::vector<std::uint32_t> place(ordered.vertices.size());
  for (const std::uint32_t i : permutation(ordered.vertices.size())) {
    place[i] = static_cast<std::uint32_t>(input.vertices.size());
    input.vertices.push_back(ordered.vertices[i]);
  }
  for (const std::uint32_t i : permutation(ordered.triangles.size())) {
    const UVec3& t = ordered.triangles[i];
    input.triangles.emplace_back(place[t.x], place[t.y], place[t.z]);
  }
  return input;
}

Input input_of(const std::string& name) {
  const std::size_t colon = name.find(':');
  const std::string maker = name.substr(0, colon);
  const auto number = [&] { return static_cast<std::uint32_t>(std::stoul(name.substr(colon + 1))); };
  const std::size_t run = name.rfind('/');
  if (maker == "shuffled") {  // shuffled:MESH/RUN
    return shuffled(input_of(name.substr(colon + 1, run - colon - 1)),
                    static_cast<std::uint32_t>(std::stoul(name.substr(run + 1))));
  }
  if (maker == "teapot") return from_maker(scene_makers::make_teapot(number()));
  if (maker == "stacked") return stacked(from_maker(scene_makers::make_teapot(number())));
  if (maker == "crowded") return crowded(from_maker(scene_makers::make_torus_knot(number())));
  if (maker == "knot") return from_maker(scene_makers::make_torus_knot(number()));
  return from_file(name);
}

void leave_steps() {
#ifdef __riscv
  asm volatile("slti zero, zero, %0" : : "n"(kNoStepMark) : "memory");
#endif
}

sim::BuildWork build_hierarchy(const Input& input, const sim::MeshLines& lines) {
  bvh::Bvh bvh;
  const Status status = bvh::build_bvh(input.view(), {}, bvh);
  leave_steps();
  if (status != Status::kOk) fail("the hierarchy was not built");
  return bvh::bvh_build_work(input.vertices.size(), input.triangles.size(), bvh.counts, lines);
}

// @returns the image; it is there until the next one.
std::span<const std::byte> build_image(const Input& input, const GridParameters& parameters, GridNeed& need) {
  Status status = count_scene_image(input.view(), parameters, need);
  leave_steps();
  if (status != Status::kOk) fail("the image was not counted");
  // The caller's memory is no part of a build: all repetitions have the same.
  static std::vector<std::byte> memory, scratch;
  memory.resize(need.image_bytes + kLineBytes);
  scratch.resize(need.scratch_bytes);
  const std::size_t begin = -reinterpret_cast<std::uintptr_t>(memory.data()) % kLineBytes;
  const std::span image = std::span(memory).subspan(begin);
  status = build_scene_image(input.view(), parameters, need, image, scratch);
  leave_steps();
  if (status != Status::kOk) fail("the image was not built");
  return image;
}

sim::BuildWork build_grid(const Input& input, const sim::MeshLines& lines, const GridParameters& parameters) {
  GridNeed need{};
  build_image(input, parameters, need);
  return sim::grid_build_work(input.vertices.size(), input.triangles.size(), need, lines);
}

sim::BuildWork build_tree_alone(const Input& input, const sim::MeshLines& lines, std::uint32_t leaf_triangles) {
  const std::size_t count = input.triangles.size();
  static std::vector<VertexTriangle> records;
  static std::vector<TreeNode> nodes;
  static std::vector<std::uint64_t> scratch;
  records.resize(count);
  nodes.resize(static_cast<std::size_t>(most_tree_nodes(count, leaf_triangles)));
  scratch.resize(tree_scratch_bytes(count) / sizeof(std::uint64_t));
  TreeSize size{};
  const Status status = build_tree(input.view(), leaf_triangles, records, nodes,
                                   std::as_writable_bytes(std::span(scratch)), size, TreeOrder::kForAnyHit);
  leave_steps();
  if (status != Status::kOk) fail("the tree was not built");
  return sim::tree_build_work(input.view(),
                              {leaf_triangles, TreeOrder::kForAnyHit, std::span(nodes).first(size.node_count)}, lines);
}

sim::BuildWork build_tree_image(const Input& input, const sim::MeshLines& lines, std::uint32_t leaf_triangles) {
  GridParameters parameters;
  parameters.has_grid = false;
  parameters.has_tree = true;
  parameters.leaf_triangles = leaf_triangles;
  GridNeed need{};
  const std::span image = build_image(input, parameters, need);
  SceneImageView view{};
  SceneImageError error;
  if (open_scene_image(image, view, error) != Status::kOk) fail("the image is not valid");
  const std::span nodes(reinterpret_cast<const TreeNode*>(image.data() + view.tree.nodes_offset_bytes),
                        view.tree.node_count);
  return sim::tree_image_work(input.view(), {leaf_triangles, TreeOrder::kByNumber, nodes}, view.header.image_bytes,
                              lines);
}

GridParameters parameters_of(const std::string& text) {
  GridParameters parameters;
  char format[16] = {};
  if (std::sscanf(text.c_str(), "grid:%f:%u:%15s", &parameters.lambda, &parameters.macro_width, format) != 3) {
    fail("no builder: " + text);
  }
  const std::string name = format;
  parameters.format = name == "lattice"      ? TriangleFormat::kLattice
                      : name == "projection" ? TriangleFormat::kProjection
                                             : TriangleFormat::kVertices;
  return parameters;
}

sim::BuildWork build(const std::string& builder, const Input& input, const sim::MeshLines& lines) {
  constexpr std::uint32_t kLeafTriangles = 8, kImageLeafTriangles = 16;  // as for effects, and as `best` has it
  if (builder == "bvh") return build_hierarchy(input, lines);
  if (builder == "tree") return build_tree_alone(input, lines, kLeafTriangles);
  if (builder == "tree_image") return build_tree_image(input, lines, kImageLeafTriangles);
  return build_grid(input, lines, parameters_of(builder));
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) fail("MESH BUILDER [REPETITIONS]");
  const Input input = input_of(argv[1]);
  const std::string builder = argv[2];
  const int repetitions = argc > 3 ? std::atoi(argv[3]) : 1;
  const sim::MeshLines lines = sim::count_mesh_lines(input.view());
  sim::BuildWork work;
  double least = 1e9;
  for (int i = 0; i < repetitions; ++i) {
    const std::clock_t begin = std::clock();
    work = build(builder, input, lines);
    least = std::min(least, static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
  }
  std::printf("triangles %zu\nseconds %.6f\n", input.triangles.size(), least);
  for (std::size_t step = 0; step < sim::kBuildStepCount; ++step) {
    std::printf("work %zu %llu\n", step, static_cast<unsigned long long>(work.counts[step]));
  }
}
