// Vertex order. SPDX-License-Identifier: Apache-2.0
#include "vertex_order.h"

#include <gridiron/build/passes/build_plan.h>

#include <algorithm>
#include <array>
#include <glm/common.hpp>
#include <limits>
#include <numeric>
#include <span>
#include <utility>

#include "base/content_hash.h"

namespace gridiron::tool {
namespace {

using Places = std::vector<std::uint32_t>;  // of the mesh's vertices, by number

std::uint64_t hash_of_triangles(const Mesh& mesh) {
  return content_hash(std::as_bytes(std::span(mesh.triangles)));
}

Places as_they_are(const Mesh& mesh) {
  Places places(mesh.vertices.size());
  std::iota(places.begin(), places.end(), 0u);
  return places;
}

// As triangles come to them; at the end those of no triangle.
Places by_first_use(const Mesh& mesh) {
  constexpr std::uint32_t kNone = ~std::uint32_t{0};
  Places places(mesh.vertices.size(), kNone);
  std::uint32_t next = 0;
  const auto place = [&next](std::uint32_t& vertex) {
    if (vertex == kNone) vertex = next++;
  };
  for (const UVec3& triangle : mesh.triangles) {
    for (int corner = 0; corner < 3; ++corner) place(places[triangle[corner]]);
  }
  for (std::uint32_t& vertex : places) place(vertex);
  return places;
}

// The lowest 10 bits, each three places from the next.
std::uint32_t spread(std::uint32_t bits) {
  bits = (bits | bits << 16) & 0x030000FFu;
  bits = (bits | bits << 8) & 0x0300F00Fu;
  bits = (bits | bits << 4) & 0x030C30C3u;
  return (bits | bits << 2) & 0x09249249u;
}

// Along a Z curve.
Places by_space(const Mesh& mesh) {
  Vec3 low(std::numeric_limits<float>::max()), high(std::numeric_limits<float>::lowest());
  for (const Vec3& vertex : mesh.vertices) {
    low = glm::min(low, vertex);
    high = glm::max(high, vertex);
  }
  const Vec3 extents = high - low;
  const float largest = std::max({extents.x, extents.y, extents.z, std::numeric_limits<float>::min()});
  std::vector<std::uint32_t> codes;
  codes.reserve(mesh.vertices.size());
  for (const Vec3& vertex : mesh.vertices) {
    const Vec3 share = (vertex - low) / largest;
    std::uint32_t code = 0;
    for (int axis = 0; axis < 3; ++axis) code |= spread(static_cast<std::uint32_t>(share[axis] * 1023.0f)) << axis;
    codes.push_back(code);
  }
  Places order = as_they_are(mesh), places(order.size());
  // Not stable_sort: newer clangs warn of what libstdc++ 12 does in it.
  std::ranges::sort(order, {}, [&codes](std::uint32_t vertex) { return std::pair(codes[vertex], vertex); });
  for (std::uint32_t i = 0; i < order.size(); ++i) places[order[i]] = i;
  return places;
}

// Lines of vertices that a core of 256 KB gets while it codes triangles: each has one place in its store, and a run of
// triangles begins with none.
std::uint64_t lines_of(const Mesh& mesh, const Places& places) {
  std::array<std::uint64_t, BuildLayout256K::kCacheLines> held{};  // line + 1; 0: none
  std::uint64_t count = 0;
  const std::uint32_t run_triangles =
      run_triangles_of<BuildLayout256K>(static_cast<std::uint32_t>(mesh.triangles.size()));
  const auto take = [&held, &count](std::uint64_t line) {
    std::uint64_t& place = held[line % held.size()];
    count += place != line + 1 ? 1 : 0;
    place = line + 1;
  };
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    if (i % run_triangles == 0) held.fill(0);
    for (int corner = 0; corner < 3; ++corner) {
      const std::uint64_t begin = std::uint64_t{places[mesh.triangles[i][corner]]} * sizeof(Vec3);
      const std::uint64_t first = begin / kLineBytes, last = (begin + sizeof(Vec3) - 1) / kLineBytes;
      take(first);
      if (last != first) take(last);
    }
  }
  return count;
}

}  // namespace

VertexOrder::VertexOrder(const Mesh& mesh)
    : places_(as_they_are(mesh)), triangles_hash_(hash_of_triangles(mesh)), lines_before_(lines_of(mesh, places_)) {
  lines_ = lines_before_;
  for (auto* const find : {by_first_use, by_space}) {
    Places places = find(mesh);
    const std::uint64_t lines = lines_of(mesh, places);
    if (lines >= lines_) continue;
    lines_ = lines;
    places_ = std::move(places);
  }
}

bool VertexOrder::is_of(const Mesh& mesh) const {
  return mesh.vertices.size() == places_.size() && hash_of_triangles(mesh) == triangles_hash_;
}

void VertexOrder::place(const Mesh& mesh, Vec3* vertices, UVec3* triangles) const {
  for (std::size_t i = 0; i < places_.size(); ++i) vertices[places_[i]] = mesh.vertices[i];
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const UVec3& from = mesh.triangles[i];
    triangles[i] = UVec3(places_[from.x], places_[from.y], places_[from.z]);
  }
}

}  // namespace gridiron::tool
