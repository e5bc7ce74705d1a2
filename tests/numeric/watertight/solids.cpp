// Closed meshes: see the header. SPDX-License-Identifier: Apache-2.0
#include "numeric/watertight/solids.h"

#include "support/ply_load.h"

namespace gridiron::test {
namespace {

using Edge = std::pair<std::uint32_t, std::uint32_t>;

std::vector<Edge> sorted_edges(const TestMesh& mesh) {
  std::vector<Edge> edges;
  edges.reserve(3 * mesh.triangles.size());
  for (const UVec3& t : mesh.triangles) {
    edges.emplace_back(t.x, t.y);
    edges.emplace_back(t.y, t.z);
    edges.emplace_back(t.z, t.x);
  }
  std::ranges::sort(edges);
  return edges;
}

bool holds(const std::vector<Edge>& edges, Edge edge) {
  return std::ranges::binary_search(edges, edge);
}

Edge turned(Edge edge) {
  return {edge.second, edge.first};
}

}  // namespace

std::string why_not_closed(const TestMesh& mesh) {
  if (mesh.triangles.empty()) return "it has no triangles";
  for (const UVec3& t : mesh.triangles) {
    if (t.x >= mesh.vertices.size() || t.y >= mesh.vertices.size() || t.z >= mesh.vertices.size()) {
      return "an index leads nowhere";
    }
    if (t.x == t.y || t.y == t.z || t.z == t.x) return "a face has one vertex twice";
  }
  const std::vector<Edge> edges = sorted_edges(mesh);
  std::size_t open = 0;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const bool is_repeated = (i > 0 && edges[i - 1] == edges[i]) || (i + 1 < edges.size() && edges[i + 1] == edges[i]);
    if (is_repeated || !holds(edges, turned(edges[i]))) ++open;
  }
  if (open == 0) return {};
  return std::to_string(open) + " of the " + std::to_string(edges.size()) +
         " edges of its faces have no one opposite edge";
}

TestMesh make_fan_solid(std::uint32_t count, float thickness) {
  TestMesh mesh;
  mesh.vertices = {{-0.913f, -0.871f, -0.517f}, {0.957f, -0.793f, -0.639f}};  // the apexes
  // The cut edge runs from a far end through `count` short pieces to the other; they bend and are jagged, so that no
  // two slivers lie in one plane.
  TestRandom random(1);
  mesh.vertices.push_back({0.037f, 0.941f, -0.953f});
  for (std::uint32_t i = 0; i <= count; ++i) {
    const double along = double{thickness} * (i - 0.5 * count);
    const double bend = 0.25 * along * along;
    const double jag = 0.25 * double{thickness} * (2.0 * double{random.unit()} - 1.0);
    mesh.vertices.push_back(Vec3(DVec3(0.0137 + jag, 0.9713 - bend, 0.0071 + along)));
  }
  mesh.vertices.push_back({-0.029f, 0.937f, 0.967f});
  const auto last = static_cast<std::uint32_t>(mesh.vertices.size() - 1);
  for (std::uint32_t i = 2; i < last; ++i) {
    mesh.triangles.push_back({0, i + 1, i});
    mesh.triangles.push_back({1, i, i + 1});
  }
  mesh.triangles.push_back({0, 2, 1});
  mesh.triangles.push_back({0, 1, last});
  return mesh;
}

TestMesh make_height_solid(std::uint32_t cells, float height, std::uint64_t seed) {
  TestMesh mesh = make_height_field(cells, height, seed);
  const std::vector<Edge> edges = sorted_edges(mesh);
  const float floor = -1.0f - 2.0f * height;
  const std::size_t field_vertices = mesh.vertices.size(), field_triangles = mesh.triangles.size();
  const auto below = [&](std::uint32_t vertex) { return vertex + static_cast<std::uint32_t>(field_vertices); };
  for (std::size_t i = 0; i < field_vertices; ++i) {
    mesh.vertices.push_back({mesh.vertices[i].x, floor, mesh.vertices[i].z});
  }
  for (std::size_t i = 0; i < field_triangles; ++i) {
    const UVec3 t = mesh.triangles[i];
    mesh.triangles.push_back({below(t.x), below(t.z), below(t.y)});
  }
  for (const Edge& edge : edges) {
    if (holds(edges, turned(edge))) continue;
    const auto [a, b] = edge;
    mesh.triangles.push_back({b, a, below(a)});
    mesh.triangles.push_back({b, below(a), below(b)});
  }
  return mesh;
}

void centre(TestMesh& mesh) {
  DVec3 low(mesh.vertices.front()), high = low;
  for (const Vec3& vertex : mesh.vertices) {
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = std::fmin(low[axis], double{vertex[axis]});
      high[axis] = std::fmax(high[axis], double{vertex[axis]});
    }
  }
  const DVec3 half = (high - low) * 0.5;
  const double scale = std::ldexp(1.0, -1 - std::ilogb(std::fmax(half.x, std::fmax(half.y, half.z))));
  for (Vec3& vertex : mesh.vertices) vertex = Vec3((DVec3(vertex) - (low + half)) * scale);
}

std::vector<Solid> make_solids(Detail detail) {
  const bool full = detail == Detail::kFull;
  std::vector<Solid> solids;
  solids.push_back({"sphere", full ? make_sphere(72, 71, 1.0f) : make_sphere(20, 21, 1.0f)});
  solids.push_back({"torus", full ? make_torus(96, 64, 0.7f, 0.3f) : make_torus(24, 16, 0.7f, 0.3f)});
  solids.push_back({"fan", full ? make_fan_solid(64, 1e-5f) : make_fan_solid(24, 1e-5f)});
  solids.push_back({"heights", full ? make_height_solid(192, 0.1f, 1) : make_height_solid(24, 0.1f, 1)});
  for (Solid& solid : solids) centre(solid.mesh);
  return solids;
}

std::vector<ScanSolid> load_scans(const std::filesystem::path& directory) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(directory)) {
    if (entry.is_regular_file() && entry.path().extension() == ".ply") files.push_back(entry.path());
  }
  std::ranges::sort(files);
  std::vector<ScanSolid> scans;
  for (const std::filesystem::path& file : files) {
    ScanSolid scan{{file.stem().string(), {}}, {}};
    if (auto mesh = load_ply(file)) {
      scan.left_out = why_not_closed(*mesh);
      scan.solid.mesh = std::move(*mesh);
      if (scan.left_out.empty()) centre(scan.solid.mesh);
    } else {
      scan.left_out = "it cannot be read";
    }
    scans.push_back(std::move(scan));
  }
  return scans;
}

std::vector<Placement> all_placements() {
  std::vector<Placement> placements = {{"at 0", 0, Vec3(0.0f)},
                                       {"at 16", 0, Vec3(16.0f)},
                                       {"at 1e3", 0, Vec3(1e3f)},
                                       {"at (148376, 1234, -223423)", 0, Vec3(148376.0f, 1234.0f, -223423.0f)},
                                       {"at 1e6", 0, Vec3(1e6f)}};
  for (int exponent = -50; exponent <= 50; exponent += 10) {
    if (exponent != 0) placements.push_back({"times 2^" + std::to_string(exponent), exponent, Vec3(0.0f)});
  }
  return placements;
}

}  // namespace gridiron::test
