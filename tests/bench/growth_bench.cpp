// Growth of the image's build with the number of triangles, from 10 thousand to 10 million, beside Embree's.
// At 10 million, mesh, image and Embree take 3.4 GB. SPDX-License-Identifier: Apache-2.0
#include <gridiron/build/triangle_records.h>

#include <cmath>

#include "bench/bench.h"
#include "bench/image_build.h"
#include "embree_peer/embree_peer.h"
#include "support/test_mesh.h"

namespace gridiron::bench {
namespace {

using test::TestMesh;
using test::TestRandom;

constexpr std::uint32_t kLeafTriangles = kBestParameters.leaf_triangles;
constexpr double kGrowthLimit = 2.0;  // time a triangle over that of 1 million; above 1 for caches
constexpr double kPeerLimit = 1.5;    // time over that of Embree's low-quality build
constexpr std::uint32_t kReferenceCount = 1'000'000;
constexpr double kHundredLimit = 120.0;  // time and bytes of 10 million over those of 100 thousand
constexpr std::uint32_t kHundredthCount = 100'000, kHundredCount = 10'000'000;

// --- Meshes -------------------------------------------------------------------------------------------------------

// As many triangles as `rings` times `segments`, twice.
struct Size {
  std::uint32_t rings, segments;

  [[nodiscard]] std::uint32_t count() const { return 2 * rings * segments; }
};

constexpr Size kSizes[] = {{100, 50}, {250, 200}, {1000, 500}, {2500, 2000}};

// A torus with bumps along its tube's normals: a closed surface in the order of its rings, like a scan.
TestMesh make_scan(const Size& size) {
  constexpr float kRadius = 1.0f;
  TestMesh mesh = test::make_torus(size.rings, size.segments, kRadius, 0.4f);
  TestRandom random(1);
  for (Vec3& p : mesh.vertices) {
    const float scale = kRadius / std::sqrt(p.x * p.x + p.z * p.z);
    const Vec3 middle(scale * p.x, 0.0f, scale * p.z);
    const float bump = 0.1f * std::sin(31.0f * p.x) * std::cos(37.0f * p.y) * std::sin(29.0f * p.z) +
                       0.03f * std::sin(173.0f * (p.x + p.z)) +
                       random.between(0.0f, 0.2f / static_cast<float>(size.rings));
    p = middle + (p - middle) * (1.0f + bump);
  }
  return mesh;
}

// Appends triangles with corners within `extent` of points that are drawn from a cube around `centre`.
void scatter(TestMesh& mesh, std::uint32_t count, const Vec3& centre, float radius, float extent, TestRandom& random) {
  const auto draw = [&random](const Vec3& around, float distance) {
    const float x = random.between(-distance, distance), y = random.between(-distance, distance);
    return around + Vec3(x, y, random.between(-distance, distance));
  };
  for (std::uint32_t i = 0; i < count; ++i) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    const Vec3 middle = draw(centre, radius);
    for (int corner = 0; corner < 3; ++corner) mesh.vertices.push_back(draw(middle, extent));
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
}

TestMesh with_room_for(std::uint32_t count) {
  TestMesh mesh;
  mesh.vertices.reserve(3 * std::size_t{count});
  mesh.triangles.reserve(count);
  return mesh;
}

// Small triangles at random in a cube.
TestMesh make_scattered(const Size& size) {
  TestMesh mesh = with_room_for(size.count());
  TestRandom random(2);
  scatter(mesh, size.count(), Vec3(0), 1.0f, 1.0f / std::cbrt(static_cast<float>(size.count())), random);
  return mesh;
}

// Ten huge triangles, a tenth of the others at random in the cube, a half in eight clusters each within a few places of
// the Z curve, and the rest in clusters around one point, each a thousandth as large as the one before.
TestMesh make_crowded(const Size& size) {
  TestMesh mesh = with_room_for(size.count());
  TestRandom random(3);
  constexpr float kClusterRadius = 1e-4f;
  constexpr std::uint32_t kHuge = 10, kClusters = 8, kNested = 4;
  scatter(mesh, kHuge, Vec3(0), 0.1f, 1.0f, random);
  scatter(mesh, size.count() / 10, Vec3(0), 1.0f, 1e-3f, random);
  for (std::uint32_t i = 0; i < kClusters; ++i) {
    const Vec3 centre(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1));
    scatter(mesh, size.count() / (2 * kClusters), centre, kClusterRadius, 1e-2f * kClusterRadius, random);
  }
  float radius = kClusterRadius;
  for (std::uint32_t left = kNested; left > 0; --left, radius *= 1e-3f) {
    const auto rest = size.count() - static_cast<std::uint32_t>(mesh.triangles.size());
    scatter(mesh, rest / left, Vec3(0), radius, 1e-2f * radius, random);
  }
  return mesh;
}

// --- Trees --------------------------------------------------------------------------------------------------------

// The tree of an image that was built.
struct BuiltTree {
  const TreeRecord& size;
  std::uint32_t dropped_triangle_count;
  const VertexTriangle* records;
  const TreeNode* nodes;

  explicit BuiltTree(const ImageBuild& build)
      : size(build.view().tree),
        dropped_triangle_count(build.view().header.dropped_triangle_count),
        records(reinterpret_cast<const VertexTriangle*>(build.image() + size.triangles_offset_bytes)),
        nodes(reinterpret_cast<const TreeNode*>(build.image() + size.nodes_offset_bytes)) {}
};

// Whether each triangle that has an area has one record with its corners.
bool has_each_triangle(const MeshView& mesh, const BuiltTree& tree) {
  std::vector<bool> is_there(mesh.triangles.size());
  for (std::uint32_t i = 0; i < tree.size.triangle_count; ++i) {
    const VertexTriangle& record = tree.records[i];
    if (record.triangle_id >= is_there.size() || is_there[record.triangle_id]) return false;
    is_there[record.triangle_id] = true;
    for (int corner = 0; corner < 3; ++corner) {
      const Vec3& p = mesh.vertices[mesh.triangles[record.triangle_id][corner]];
      for (int axis = 0; axis < 3; ++axis) {
        if (record.v[corner][axis] != p[axis]) return false;
      }
    }
  }
  for (std::size_t i = 0; i < is_there.size(); ++i) {
    const UVec3& t = mesh.triangles[i];
    if (!is_there[i] && !has_zero_area(mesh.vertices[t.x], mesh.vertices[t.y], mesh.vertices[t.z])) return false;
  }
  return tree.size.triangle_count + tree.dropped_triangle_count == is_there.size();
}

bool holds(const TreeNode& node, std::uint32_t child, const float low[3], const float high[3]) {
  for (int axis = 0; axis < 3; ++axis) {
    if (node.low[axis][child] > low[axis] || node.high[axis][child] < high[axis]) return false;
  }
  return true;
}

// Whether every record is in one leaf, each node has one parent, and the boxes of all children hold what is below.
bool are_nodes_sound(const BuiltTree& tree) {
  struct Part {
    std::uint32_t first, end, height;
    float low[3], high[3];
  };
  const TreeRecord& size = tree.size;
  std::vector<Part> parts(size.node_count);
  std::uint32_t next_node = size.node_count;
  for (std::uint32_t i = size.node_count; i-- > 0;) {
    const TreeNode& node = tree.nodes[i];
    Part& part = parts[i];
    part = {0, 0, 1, {kFloatMax, kFloatMax, kFloatMax}, {-kFloatMax, -kFloatMax, -kFloatMax}};
    if (node.child_count == 0 || node.child_count > kTreeWidth) return false;
    // Nodes are numbered level by level, so from the last to the first all of them come up in turn.
    for (std::uint32_t k = node.child_count; k-- > 0;) {
      if (!node.children[k].is_leaf() && (node.children[k].node_index() != --next_node || next_node <= i)) return false;
    }
    for (std::uint32_t k = 0; k < node.child_count; ++k) {
      const TreeChild child = node.children[k];
      Part below{child.first(), child.first() + child.count(), 0, {}, {}};
      if (!child.is_leaf()) {
        below = parts[child.node_index()];
        if (!holds(node, k, below.low, below.high)) return false;
      } else {
        if (child.count() > kLeafTriangles || below.end > size.triangle_count) return false;
        for (std::uint32_t t = below.first; t < below.end; ++t) {
          for (const auto& corner : tree.records[t].v) {
            if (!holds(node, k, corner, corner)) return false;
          }
        }
      }
      if (k == 0) part.first = below.first;
      if (k != 0 && below.first != part.end) return false;
      part.end = below.end;
      part.height = std::max(part.height, below.height + 1);
      for (int axis = 0; axis < 3; ++axis) {
        part.low[axis] = std::min(part.low[axis], node.low[axis][k]);
        part.high[axis] = std::max(part.high[axis], node.high[axis][k]);
      }
    }
  }
  const Part& root = parts[0];
  return next_node == 1 && root.first == 0 && root.end == size.triangle_count && root.height == size.depth;
}

// --- Results ------------------------------------------------------------------------------------------------------

struct Form {
  const char* name;
  TestMesh (*make)(const Size& size);
};

constexpr Form kForms[] = {{"scan", make_scan}, {"scattered", make_scattered}, {"crowded", make_crowded}};

struct Point {
  std::uint32_t triangle_count;
  double nanoseconds;  // a triangle
  double bytes;        // a triangle: image and working memory
};

// @returns whether the tree is sound, and built as fast as the limit says.
bool measure(const BenchOptions& options, const Form& form, const Size& size, Point& point) {
  const TestMesh mesh = form.make(size);
  const double count = size.count();
  ImageBuild image(mesh.view());
  peer::EmbreeScene embree;
  embree.set_mesh(mesh.view());
  const Candidate candidates[] = {{"image", [&] { image.run(); }},
                                  {"Embree", [&] { embree.build(peer::EmbreeQuality::kLow); }}};
  const unsigned rounds = size.count() < kReferenceCount ? 5 * options.rounds : options.rounds;
  const std::vector<double> seconds = least_seconds(candidates, rounds);
  if (image.status() != Status::kOk) {
    std::printf("%-9s %8u: status %u\n", form.name, size.count(), static_cast<unsigned>(image.status()));
    return false;
  }
  const BuiltTree tree(image);
  const bool is_sound = has_each_triangle(mesh.view(), tree) && are_nodes_sound(tree);
  const std::uint64_t image_bytes = image.view().header.image_bytes, scratch_bytes = image.need().scratch_bytes;
  const auto each = [count](std::uint64_t bytes) { return static_cast<double>(bytes) / count; };
  point = {size.count(), 1e9 * seconds[0] / count, each(image_bytes + scratch_bytes)};
  const double ratio = seconds[0] / seconds[1];
  std::printf("%-9s %8u | %7.1f %7.1f %5.2f | %7.1f %7.1f %6.1f %6.1f | %7u %5u%s%s\n", form.name, size.count(),
              point.nanoseconds, 1e9 * seconds[1] / count, ratio, each(image_bytes), each(scratch_bytes), point.bytes,
              each(image.need().image_bytes + scratch_bytes), tree.size.node_count, tree.size.depth,
              ratio > kPeerLimit ? "  EXCEEDED" : "", is_sound ? "" : "  NOT SOUND");
  std::fflush(stdout);
  return is_sound && ratio <= kPeerLimit;
}

// Prints how much more 10 million triangles take than 100 thousand. @returns whether this is within the limit.
bool report_hundred(const char* name, const std::vector<Point>& points) {
  const Point *few = nullptr, *many = nullptr;
  for (const Point& point : points) {
    if (point.triangle_count == kHundredthCount) few = &point;
    if (point.triangle_count == kHundredCount) many = &point;
  }
  if (few == nullptr || many == nullptr) return true;
  const double time = 100.0 * many->nanoseconds / few->nanoseconds, bytes = 100.0 * many->bytes / few->bytes;
  const bool within = time <= kHundredLimit && bytes <= kHundredLimit;
  std::printf("%-9s 10 million over 100 thousand: time %.1f, bytes %.1f  (limit %.0f)%s\n", name, time, bytes,
              kHundredLimit, within ? "" : "  EXCEEDED");
  return within;
}

// Prints each mesh's time a triangle over that of 1 million. @returns whether all are within the limit.
bool report_growth(const char* name, const std::vector<Point>& points) {
  double reference = 0, greatest = 0;
  for (const Point& point : points) {
    if (point.triangle_count == kReferenceCount) reference = point.nanoseconds;
  }
  std::printf("%-9s time a triangle over that of 1 million:", name);
  for (const Point& point : points) {
    std::printf(" %.2f", point.nanoseconds / reference);
    greatest = std::max(greatest, point.nanoseconds / reference);
  }
  std::printf("  (limit %.2f)%s\n", kGrowthLimit, greatest <= kGrowthLimit ? "" : "  EXCEEDED");
  return greatest <= kGrowthLimit;
}

bool bench_growth(const BenchOptions& options) {
  std::printf("leaves of %u; a bound follows from the number of triangles alone; every tree is checked\n",
              kLeafTriangles);
  std::printf("%18s | %21s | %29s | %s\n", "", "ns a triangle", "bytes a triangle", "nodes");
  std::printf("%-9s %8s | %7s %7s %5s | %7s %7s %6s %6s | %7s %5s\n", "mesh", "", "image", "Embree", "ratio", "image",
              "scratch", "all", "bound", "", "depth");
  bool within = true;
  for (const Form& form : kForms) {
    std::vector<Point> points;
    for (const Size& size : kSizes) {
      if (options.quick && size.count() > kReferenceCount) continue;
      points.emplace_back();
      within = measure(options, form, size, points.back()) && within;
    }
    within = report_growth(form.name, points) && within;
    within = report_hundred(form.name, points) && within;
  }
  return within;
}

const Registration kRegistration("growth", bench_growth);

}  // namespace
}  // namespace gridiron::bench
