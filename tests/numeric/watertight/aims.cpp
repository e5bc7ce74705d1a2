// Aims: see the header. SPDX-License-Identifier: Apache-2.0
#include "numeric/watertight/aims.h"

namespace gridiron::test {
namespace {

using watertight::kShotRays;
using watertight::Shot;

constexpr int kAttempts = 2000;
constexpr std::uint32_t kNeighbours = 32;

class Aimer {
 public:
  Aimer(const PlacedSolid& solid, std::uint64_t seed, Shot& shot)
      : solid_(solid), mesh_(solid.mesh()), order_(solid.tree().order()), random_(seed), shot_(shot) {
    shot_ = {};
    shot_.with_distances = random_.below(2) != 0;
    middle_ = random_.below(static_cast<std::uint32_t>(order_.size()));
  }

  bool aim(RayKind kind) {
    if (kind == RayKind::kTwoEdges) return between_two_edges();
    if (kind == RayKind::kAxis) return along_axes();
    if (kind == RayKind::kJustInside) return from_just_inside();
    Surroundings around{};
    if (!find_inside(around)) return false;
    const std::uint32_t spread = random_.below(4);
    if (spread < 2) middle_ = place_of(around.seen_triangle);
    for (std::uint32_t ray = 0; ray < kShotRays; ++ray) {
      if (spread == 3) middle_ = random_.below(static_cast<std::uint32_t>(order_.size()));
      if (kind == RayKind::kRandom) {
        add(ray, direction());
      } else {
        add(ray, (kind == RayKind::kEdge ? edge_point() : vertex()) - origin_);
      }
    }
    return shot_.active != 0;
  }

 private:
  // --- Features ---

  [[nodiscard]] const UVec3& triangle() {
    const auto count = static_cast<std::uint32_t>(order_.size());
    return mesh_.triangles[order_[(middle_ + random_.below(std::min(kNeighbours, count))) % count]];
  }
  [[nodiscard]] std::uint32_t place_of(std::uint32_t triangle_id) const {
    return centred(solid_.tree().place(triangle_id));
  }
  // So that a triangle's neighbours are those on both sides of it.
  [[nodiscard]] std::uint32_t centred(std::uint32_t place) const {
    const auto count = static_cast<std::uint32_t>(order_.size());
    return (place + count - std::min(kNeighbours / 2, count - 1)) % count;
  }
  [[nodiscard]] Vec3 corner(const UVec3& t, std::uint32_t i) const {
    return mesh_.vertices[t[static_cast<int>(i % 3)]];
  }
  Vec3 vertex() { return corner(triangle(), random_.below(3)); }
  Vec3 edge_point() {
    const UVec3& t = triangle();
    const std::uint32_t first = random_.below(3);
    const Vec3 a = corner(t, first);
    return a + random_.unit() * (corner(t, first + 1) - a);
  }
  Vec3 face_point(const UVec3& t) {
    const float r = random_.unit();
    const float s = random_.unit() * (1.0f - r);
    return corner(t, 0) + r * (corner(t, 1) - corner(t, 0)) + s * (corner(t, 2) - corner(t, 0));
  }
  Vec3 direction() {
    const float x = random_.between(-1, 1), y = random_.between(-1, 1), z = random_.between(-1, 1);
    return {x, y, z};
  }

  // --- Rays ---

  void start_at(const Vec3& origin) {
    origin_ = origin;
    for (int axis = 0; axis < 3; ++axis) shot_.origin[axis] = origin[axis];
  }
  void add(std::uint32_t ray, const Vec3& direction) {
    for (int axis = 0; axis < 3; ++axis) shot_.dir[axis][ray] = direction[axis];
    if (direction.x != 0.0f || direction.y != 0.0f || direction.z != 0.0f) shot_.active |= 1u << ray;
  }
  bool is_inside(const Vec3& point, Surroundings& around) {
    around = solid_.look_around(point, random_);
    if (around.is_inside) start_at(point);
    return around.is_inside;
  }
  Vec3 point_in_bounds() {
    const DVec3 low(solid_.low()), high(solid_.high());
    const double x = double{random_.unit()}, y = double{random_.unit()}, z = double{random_.unit()};
    return Vec3(low + DVec3(x, y, z) * (high - low));
  }
  bool find_inside(Surroundings& around) {
    for (int attempt = 0; attempt < kAttempts; ++attempt) {
      if (is_inside(point_in_bounds(), around)) return true;
    }
    return false;
  }

  // From a point between two points of edges: at each of these from there, both ways along the line through both, and
  // the same with a component moved by one float.
  bool between_two_edges() {
    Surroundings around{};
    for (int attempt = 0; attempt < kAttempts; ++attempt) {
      const Vec3 p = edge_point();
      middle_ = random_.below(static_cast<std::uint32_t>(order_.size()));
      const Vec3 q = edge_point();
      if (!is_inside(p + random_.between(0.05f, 0.95f) * (q - p), around)) continue;
      const Vec3 exact[4] = {q - origin_, p - origin_, q - p, p - q};
      for (std::uint32_t ray = 0; ray < kShotRays; ++ray) {
        Vec3 moved = exact[ray % 4];
        if (ray >= 4) {
          const auto axis = static_cast<int>(random_.below(3));
          const float limit = random_.below(2) != 0 ? kFloatMax : -kFloatMax;
          // Zeros stay: their neighbouring floats are denormals.
          if (moved[axis] != 0.0f) moved[axis] = std::nextafter(moved[axis], limit);
        }
        add(ray, moved);
      }
      return shot_.active != 0;
    }
    return false;
  }

  // Six rays from one point, in random lanes, of lengths that are powers of two, with zeros of either sign.
  bool along_axes() {
    Surroundings around{};
    bool found = false;
    for (int attempt = 0; attempt < kAttempts && !found; ++attempt) {
      middle_ = random_.below(static_cast<std::uint32_t>(order_.size()));
      Vec3 point = point_in_bounds();
      const std::uint32_t shared = 1 + random_.below(7);
      for (int axis = 0; axis < 3; ++axis) {
        if ((shared >> axis & 1u) != 0) point[axis] = vertex()[axis];
      }
      if (random_.below(2) != 0) {  // of one vertex, but for the axis along which the ray goes through it
        const auto along = static_cast<int>(random_.below(3));
        const float kept = point[along];
        point = vertex();
        point[along] = kept;
      }
      found = is_inside(point, around);
    }
    if (!found) return false;
    for (std::uint32_t i = 0; i < 6; ++i) {
      std::uint32_t ray = random_.below(kShotRays);
      while ((shot_.active >> ray & 1u) != 0) ray = (ray + 1) % kShotRays;
      Vec3 along;
      for (int axis = 0; axis < 3; ++axis) along[axis] = random_.below(2) != 0 ? 0.0f : -0.0f;
      const float length = std::ldexp(1.0f, static_cast<int>(random_.below(9)) - 4);
      along[static_cast<int>(i / 2)] = i % 2 != 0 ? length : -length;
      add(ray, along);
    }
    return true;
  }

  bool from_just_inside() {
    Surroundings around{};
    for (int attempt = 0; attempt < kAttempts; ++attempt) {
      middle_ = random_.below(static_cast<std::uint32_t>(order_.size()));
      const UVec3& t = mesh_.triangles[order_[middle_]];
      const DVec3 a(corner(t, 0));
      const DVec3 u = DVec3(corner(t, 1)) - a, v = DVec3(corner(t, 2)) - a;
      const DVec3 normal(u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x);
      const double length = std::sqrt(normal.x * normal.x + normal.y * normal.y + normal.z * normal.z);
      const std::uint32_t feature = random_.below(3);
      Vec3 at = face_point(t);
      if (feature == 0) at = corner(t, random_.below(3));
      if (feature == 1) {
        const std::uint32_t first = random_.below(3);
        at = corner(t, first) + random_.unit() * (corner(t, first + 1) - corner(t, first));
      }
      // To either side: scans are there that have their faces inside out.
      const double side = random_.below(2) != 0 ? 1.0 : -1.0;
      const double step = side * double{solid_.width()} * std::ldexp(1.0, -1 - static_cast<int>(random_.below(22)));
      if (!is_inside(Vec3(DVec3(at) - normal * (step / length)), around)) continue;
      middle_ = centred(middle_);
      for (std::uint32_t ray = 0; ray < kShotRays; ++ray) {
        Vec3 to = direction();
        if (ray % 3 == 0) to = vertex() - origin_;
        if (ray % 3 == 1) to = edge_point() - origin_;
        add(ray, to);
      }
      return shot_.active != 0;
    }
    return false;
  }

  const PlacedSolid& solid_;
  const TestMesh& mesh_;
  const std::vector<std::uint32_t>& order_;
  TestRandom random_;
  Shot& shot_;
  Vec3 origin_{0.0f};
  std::uint32_t middle_ = 0;  // in the order of the tree: where features are taken from
};

}  // namespace

const char* name_of(RayKind kind) {
  constexpr const char* kNames[] = {"random", "edge", "vertex", "two edges", "axis", "just inside"};
  static_assert(std::size(kNames) == static_cast<std::size_t>(RayKind::kCount));
  return kNames[static_cast<std::size_t>(kind)];
}

std::uint32_t rays_of(RayKind kind) {
  return kind == RayKind::kAxis ? 6 : kShotRays;
}

bool aim(const PlacedSolid& solid, RayKind kind, std::uint64_t seed, Shot& shot) {
  if (solid.tree().order().empty()) return false;
  return Aimer(solid, seed, shot).aim(kind);
}

}  // namespace gridiron::test
