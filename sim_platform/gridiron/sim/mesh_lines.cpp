// Lines of a mesh: see the header. SPDX-License-Identifier: Apache-2.0
#include <gridiron/sim/mesh_lines.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace gridiron::sim {
namespace {

/// The tags of the cache. Of a set's lines the one used longest ago is replaced.
class LineCache {
 public:
  LineCache() {
    for (Set& set : sets_) set.fill(kNone);
    streams_.fill(kNone);
  }

  /// Which array a line belongs to; their lines share the cache.
  enum class Array : std::uint64_t { kVertices, kTriangles, kBoxes, kCount };

  /// @returns whether the line must be waited for.
  bool must_wait(Array array, std::uint64_t place_bytes) {
    const std::uint64_t line = place_bytes / kCachedLineBytes * kArrays + static_cast<std::uint64_t>(array);
    Set& set = sets_[line % sets_.size()];
    const auto found = std::ranges::find(set, line);
    const bool held = found != set.end();
    if (!held) set.back() = line;
    std::rotate(set.begin(), held ? found : set.end() - 1, held ? found + 1 : set.end());  // the latest one first
    if (held) return false;
    const auto stream = std::ranges::find(streams_, line - kArrays);
    const bool streamed = stream != streams_.end();
    (streamed ? *stream : streams_[next_stream_++ % streams_.size()]) = line;
    return !streamed;
  }

 private:
  static constexpr std::uint64_t kNone = ~std::uint64_t{0} / 2;
  static constexpr std::uint64_t kArrays = static_cast<std::uint64_t>(Array::kCount);
  using Set = std::array<std::uint64_t, 8>;
  std::array<Set, kCachedLines / 8> sets_;
  std::array<std::uint64_t, 8> streams_;
  std::size_t next_stream_ = 0;
};

constexpr std::uint64_t kBoxBytes = 24;  // low and high corner

std::uint64_t wait_for_vertices(LineCache& cache, const UVec3& triangle) {
  std::uint64_t count = 0;
  for (int corner = 0; corner < 3; ++corner) {
    count += cache.must_wait(LineCache::Array::kVertices, std::uint64_t{triangle[corner]} * sizeof(Vec3)) ? 1u : 0u;
  }
  return count;
}

// Ten bits, two zeros behind each.
std::uint64_t spread_bits(std::uint64_t bits) {
  std::uint64_t spread = 0;
  for (int i = 0; i < 10; ++i) spread |= (bits >> i & 1) << (3 * i);
  return spread;
}

// Triangles in the order of their first corners along Morton's curve through 1024^3 cubes.
std::vector<std::uint64_t> order_in_space(const MeshView& mesh) {
  Vec3 low = mesh.vertices[0], high = low;
  for (const Vec3& vertex : mesh.vertices) {
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], vertex[axis]);
      high[axis] = std::max(high[axis], vertex[axis]);
    }
  }
  double extent = 0;
  for (int axis = 0; axis < 3; ++axis) extent = std::max(extent, double{high[axis]} - double{low[axis]});
  const double scale = std::ldexp(1.0, 9 - (extent > 0 ? std::ilogb(extent) : 0));  // exact, places below 1024
  std::vector<std::uint64_t> order(mesh.triangles.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const Vec3& corner = mesh.vertices[mesh.triangles[i].x];
    std::uint64_t code = 0;
    for (int axis = 0; axis < 3; ++axis) {
      code |= spread_bits(static_cast<std::uint64_t>((double{corner[axis]} - double{low[axis]}) * scale)) << axis;
    }
    order[i] = code << 32 | i;
  }
  std::ranges::sort(order);
  return order;
}

}  // namespace

MeshLines count_mesh_lines(const MeshView& mesh) {
  MeshLines lines;
  if (mesh.vertices.size() * sizeof(Vec3) + mesh.triangles.size() * sizeof(UVec3) <= kCachedBytes) return lines;
  LineCache in_order;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    (void)in_order.must_wait(LineCache::Array::kTriangles, i * sizeof(UVec3));
    lines.vertices_in_order += wait_for_vertices(in_order, mesh.triangles[i]);
  }
  LineCache in_space, boxes;
  std::vector<std::uint64_t> order = order_in_space(mesh);
  for (std::uint64_t& place : order) place &= 0xFFFFFFFF;
  for (const std::uint64_t i : order) {
    lines.triangles_in_space += in_space.must_wait(LineCache::Array::kTriangles, i * sizeof(UVec3)) ? 1u : 0u;
    lines.vertices_in_space += wait_for_vertices(in_space, mesh.triangles[i]);
  }
  for (std::size_t begin = 0; begin < order.size(); begin += kCachedLines) {
    const auto piece = std::span(order).subspan(begin, std::min<std::size_t>(kCachedLines, order.size() - begin));
    std::ranges::sort(piece);
    for (const std::uint64_t i : piece) {
      lines.boxes_in_space += boxes.must_wait(LineCache::Array::kBoxes, i * kBoxBytes) ? 1u : 0u;
    }
  }
  return lines;
}

}  // namespace gridiron::sim
