// Shapes: see the header. SPDX-License-Identifier: Apache-2.0
#include "numeric/hard_cases/shapes.h"

namespace gridiron::test::hard {
namespace {

std::array<std::uint32_t, 3> corners_of(const UVec3& t) {
  return {t.x, t.y, t.z};
}

// Replaces every triangle by three that share a new point: point(a, b, c), beside the edge from a to b.
template <class Point>
TestMesh split(const TestMesh& mesh, std::uint64_t seed, Point&& point) {
  TestRandom random(seed);
  TestMesh result;
  result.vertices = mesh.vertices;
  for (const UVec3& t : mesh.triangles) {
    const auto corners = corners_of(t);
    const std::uint32_t first = random.below(3);
    const std::uint32_t a = corners[first], b = corners[(first + 1) % 3], c = corners[(first + 2) % 3];
    const auto middle = static_cast<std::uint32_t>(result.vertices.size());
    result.vertices.push_back(point(mesh.vertices[a], mesh.vertices[b], mesh.vertices[c], random));
    result.triangles.insert(result.triangles.end(), {{a, b, middle}, {b, c, middle}, {c, a, middle}});
  }
  return result;
}

}  // namespace

bool is_closed(const TestMesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> passed;
  for (const UVec3& t : mesh.triangles) {
    const auto corners = corners_of(t);
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = corners[i], b = corners[(i + 1) % 3];
      if (a == b) continue;
      passed[{std::min(a, b), std::max(a, b)}] += a < b ? 1 : -1;
    }
  }
  for (const auto& [edge, balance] : passed) {
    if (balance != 0) return false;
  }
  return !passed.empty();
}

TestMesh on_lattice(TestMesh mesh, float step) {
  for (Vec3& p : mesh.vertices) {
    for (int axis = 0; axis < 3; ++axis) p[axis] = std::nearbyint(p[axis] / step) * step;
  }
  return mesh;
}

TestMesh make_cubes(std::uint32_t n, std::uint64_t seed) {
  TestRandom random(seed);
  std::vector<bool> filled(std::size_t{n} * n * n);
  const auto index = [n](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
    return (std::size_t{z} * n + y) * n + x;
  };
  for (std::uint32_t z = 0; z < n; ++z) {
    for (std::uint32_t y = 0; y < n; ++y) {
      for (std::uint32_t x = 0; x < n; ++x) {
        const auto is_central = [n](std::uint32_t i) { return 2 * i + 2 >= n && 2 * i <= n; };
        filled[index(x, y, z)] = (is_central(x) && is_central(y) && is_central(z)) || random.below(3) != 0;
      }
    }
  }
  TestMesh mesh;
  const std::uint32_t side = n + 1;
  for (std::uint32_t i = 0; i < side * side * side; ++i) {
    mesh.vertices.push_back(
        {static_cast<float>(i % side), static_cast<float>(i / side % side), static_cast<float>(i / side / side)});
  }
  const auto is_filled = [&](std::array<std::uint32_t, 3> cell) {  // what lies below 0 wraps
    return cell[0] < n && cell[1] < n && cell[2] < n && filled[index(cell[0], cell[1], cell[2])];
  };
  for (std::uint32_t i = 0; i < n * n * n; ++i) {
    const std::array<std::uint32_t, 3> cell = {i % n, i / n % n, i / n / n};
    if (!is_filled(cell)) continue;
    for (std::uint32_t axis = 0; axis < 3; ++axis) {
      for (const std::uint32_t side_of : {0u, 1u}) {
        std::array<std::uint32_t, 3> beyond = cell;
        beyond[axis] += side_of == 1 ? 1u : ~0u;
        if (is_filled(beyond)) continue;
        const std::uint32_t u = (axis + 1) % 3, v = (axis + 2) % 3;
        const auto vertex = [&](std::uint32_t du, std::uint32_t dv) {
          std::array<std::uint32_t, 3> p = cell;
          p[axis] += side_of;
          p[u] += du;
          p[v] += dv;
          return (p[2] * side + p[1]) * side + p[0];
        };
        const std::uint32_t a = vertex(0, 0), b = vertex(1, 0), c = vertex(1, 1), d = vertex(0, 1);
        if (side_of == 1) {
          mesh.triangles.insert(mesh.triangles.end(), {{a, b, c}, {a, c, d}});
        } else {
          mesh.triangles.insert(mesh.triangles.end(), {{a, c, b}, {a, d, c}});
        }
      }
    }
  }
  return mesh;
}

TestMesh split_by_slivers(const TestMesh& mesh, float width, std::uint64_t seed) {
  return split(mesh, seed, [width](Vec3 a, Vec3 b, Vec3 c, TestRandom& random) {
    const DVec3 along(b - a), across(c - a);
    return Vec3(DVec3(a) + double{random.between(0.1f, 0.8f)} * along + double{width} * across);
  });
}

TestMesh split_by_needles(const TestMesh& mesh, std::uint64_t seed) {
  return split(mesh, seed, [](Vec3 a, Vec3 b, Vec3 c, TestRandom& random) {
    const auto axis = static_cast<int>(random.below(3));
    Vec3 point = a;
    point[axis] = std::nextafter(a[axis], 0.5f * (b[axis] + c[axis]));
    return point;
  });
}

TestMesh cut_edges(const TestMesh& mesh) {
  TestMesh result;
  result.vertices = mesh.vertices;
  for (const UVec3& t : mesh.triangles) {
    const auto middle = static_cast<std::uint32_t>(result.vertices.size());
    result.vertices.push_back(0.5f * (mesh.vertices[t.x] + mesh.vertices[t.y]));
    result.triangles.insert(result.triangles.end(), {{t.y, middle, t.x}, {t.x, middle, t.z}, {middle, t.y, t.z}});
  }
  return result;
}

std::vector<Solid> solids() {
  return {{"sphere", make_sphere(10, 13, 1.0f), Vec3(0.0f), 0.5f},
          {"torus", make_torus(12, 9, 1.0f, 0.5f), Vec3(1, 0, 0), 0.2f},
          {"box", make_box({-1, -1, -1}, {1, 1, 1}), Vec3(0.0f), 0.9f},
          {"sphere on a lattice", on_lattice(make_sphere(8, 12, 1.0f), 0x1p-5f), Vec3(0.0f), 0.5f},
          {"cubes", make_cubes(6, 1), Vec3(3.0f), 0.875f}};
}

Rays rays_at(const TestMesh& mesh, Vec3 origin, Aim aim, std::uint32_t count, TestRandom& random) {
  Rays rays{origin};
  for (std::uint32_t i = 0; i < count; ++i) {
    OracleRay ray = ray_at(mesh, origin, aim, random);
    // What is aimed at may be where the ray starts: that is no direction.
    while (ray.direction[0] == 0 && ray.direction[1] == 0 && ray.direction[2] == 0) {
      ray = ray_at(mesh, origin, aim, random);
    }
    rays.directions.push_back({ray.direction[0], ray.direction[1], ray.direction[2]});
  }
  return rays;
}

bool are_rays(const Rays& rays) {
  return std::ranges::find(rays.directions, Vec3(0.0f)) == rays.directions.end();
}

Rays picture_at(const TestMesh& mesh, Vec3 origin, Aim aim, TestRandom& random) {
  constexpr std::uint32_t kColumns = 20, kRows = 12;
  const UVec3& t = mesh.triangles[random.below(static_cast<std::uint32_t>(mesh.triangles.size()))];
  const Vec3 center = rays_at(mesh, origin, aim, 1, random).directions[0];
  const float size = std::fmax(std::fmax(std::fabs(center.x), std::fabs(center.y)), std::fabs(center.z));
  constexpr int kExponents[] = {-4, -10, -16, -21, -23};
  const auto step = [&] {
    const Vec3 any = random_vec(random, size);
    const Vec3 along = random.below(2) == 0 ? any : mesh.vertices[t.y] - mesh.vertices[t.x];
    return std::ldexp(1.0f, kExponents[random.below(5)]) * along;
  };
  for (;;) {
    const Vec3 step_x = step(), step_y = step();
    const Vec3 corner = center - static_cast<float>(kColumns / 2) * step_x - static_cast<float>(kRows / 2) * step_y;
    Rays rays = picture(origin, corner, step_x, step_y, kColumns, kRows);
    // Steps that are whole numbers may meet the eye itself: that is no direction.
    if (are_rays(rays)) return rays;
  }
}

Rays picture_of_triangle(const TestMesh& mesh, std::uint32_t triangle, Vec3 origin) {
  constexpr std::uint32_t kColumns = 13;
  const UVec3& t = mesh.triangles[triangle];
  const Vec3 a = mesh.vertices[t.x], b = mesh.vertices[t.y], c = mesh.vertices[t.z];
  // Eighths, and two pixels more on each side.
  const Vec3 step_x = 0.125f * (b - a), step_y = 0.125f * (c - a);
  return picture(origin, (a - origin) - 2.0f * step_x - 2.0f * step_y, step_x, step_y, kColumns, kColumns);
}

Rays one_ray(Vec3 origin, Vec3 direction) {
  return {origin, {direction}};
}

std::vector<Rays> with_unit_directions(std::vector<Rays> all) {
  const auto exponent_of = [](const Vec3& d) {
    return -std::ilogb(std::fmax(std::fmax(std::fabs(d.x), std::fabs(d.y)), std::fabs(d.z)));
  };
  const auto scale = [](Vec3& d, int exponent) {
    for (int axis = 0; axis < 3; ++axis) d[axis] = std::ldexp(d[axis], exponent);
  };
  for (Rays& rays : all) {
    if (rays.columns != 0) {
      const int exponent = exponent_of(rays.corner);
      for (Vec3* const vector : {&rays.corner, &rays.step_x, &rays.step_y}) scale(*vector, exponent);
      recompute_picture(rays);
    } else {
      for (Vec3& direction : rays.directions) scale(direction, exponent_of(direction));
    }
  }
  return all;
}

std::vector<Rays> salvo(const TestMesh& mesh, Vec3 middle, float room, const Salvo& count, std::uint64_t seed) {
  TestRandom random(seed);
  std::vector<Rays> all;
  for (std::uint32_t i = 0; i < count.origins; ++i) {
    Vec3 away = random_vec(random, room);
    if (i % 4 == 3) {
      for (int axis = 0; axis < 3; ++axis) away[axis] = std::nearbyint(away[axis] / (0.125f * room)) * 0.125f * room;
    }
    const Vec3 origin = middle + away;
    for (const Aim aim : count.aims) {
      if (count.rays != 0) all.push_back(rays_at(mesh, origin, aim, count.rays, random));
      for (std::uint32_t k = 0; k < count.pictures; ++k) all.push_back(picture_at(mesh, origin, aim, random));
    }
  }
  return all;
}

AimAtMesh salvo_at(Vec3 middle, float room, const Salvo& count, std::uint64_t seed) {
  return [=](const TestMesh& mesh) { return salvo(mesh, middle, room, count, seed); };
}

AimAtMesh all_of(std::vector<AimAtMesh> aims) {
  return [aims = std::move(aims)](const TestMesh& mesh) {
    std::vector<Rays> all;
    for (const AimAtMesh& aim : aims) {
      for (Rays& rays : aim(mesh)) all.push_back(std::move(rays));
    }
    return all;
  };
}

}  // namespace gridiron::test::hard
