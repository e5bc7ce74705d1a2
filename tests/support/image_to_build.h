// A mesh in simulated main memory with room for the image that cores build of it.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/build/passes/build_passes.h>
#include <gridiron/sim/passes.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "support/test_mesh.h"

namespace gridiron::test {

/// A scene image without a grid. Image, result and scratch memory begin with bytes that nothing writes.
template <class Layout>
class ImageToBuild {
 public:
  static constexpr std::byte kUnwritten{0xA5};

  BuildInput input;
  sim::SimMemory memory;
  sim::MemoryRegion image, result, scratch;
  BuildPlan plan{};
  std::vector<sim::MainRange> writable;  ///< What the passes may write.

  ImageToBuild(const TestMesh& mesh, std::uint32_t leaf_triangles, TreeOrder order)
      : input(counts_of(mesh, leaf_triangles, order)), memory(bytes_of(mesh, input)) {
    const auto vertices = memory.allocate(12 * mesh.vertices.size() + 16).value();
    const auto triangles = memory.allocate(12 * mesh.triangles.size() + 16).value();
    image = memory.allocate(input.image_room).value();
    result = memory.allocate(sizeof(BuildResult)).value();
    scratch = memory.allocate(build_scratch_bytes<Layout>(input)).value();
    std::ranges::copy(std::as_bytes(std::span(mesh.vertices)), vertices.bytes.begin());
    std::ranges::copy(std::as_bytes(std::span(mesh.triangles)), triangles.bytes.begin());
    for (const auto& region : {image, result, scratch}) {
      std::ranges::fill(region.bytes, kUnwritten);
      writable.push_back({region.address.value, region.address.value + region.bytes.size()});
    }
    input.vertices = vertices.address;
    input.triangles = triangles.address;
    input.image = image.address;
    input.result = result.address;
    input.scratch = scratch.address;
    EXPECT_EQ(plan_build<Layout>(input, plan), Status::kOk);
  }

 private:
  static BuildInput counts_of(const TestMesh& mesh, std::uint32_t leaf_triangles, TreeOrder order) {
    const std::uint64_t count = mesh.triangles.size(), nodes = most_tree_nodes(count, leaf_triangles);
    BuildInput input;
    input.vertex_count = static_cast<std::uint32_t>(mesh.vertices.size());
    input.triangle_count = input.record_room = static_cast<std::uint32_t>(count);
    input.node_room = static_cast<std::uint32_t>(nodes);
    input.leaf_triangles = leaf_triangles;
    input.order = order;
    input.is_tree_image = true;
    input.image_room = kTreeImageHeadBytes + round_up<std::uint64_t>(48 * count, 128) + sizeof(TreeNode) * nodes;
    input.image = MainAddress{128};
    return input;
  }
  static std::uint64_t bytes_of(const TestMesh& mesh, const BuildInput& input) {
    return build_scratch_bytes<Layout>(input) + 12 * mesh.vertices.size() + 12 * mesh.triangles.size() +
           input.image_room + (1u << 20);
  }
};

}  // namespace gridiron::test
