// The procedural scenes: as many objects as published, the same bytes everywhere, closed and turned outwards.
// Memory: std::vector. Threads: one. SPDX-License-Identifier: Apache-2.0
#include <glm/geometric.hpp>
#include <tuple>

#include "check_scene.h"
#include "scene_makers/procedural.h"
#include "support/test_headers.h"

namespace gridiron::test {
namespace {

using namespace scene_makers;
using tool::SceneDescription;
using tool::SceneEntities;
using tool::ShapeKind;

std::uint64_t hash_of(std::string_view text) {
  std::uint64_t hash = 0xCBF29CE484222325u;  // FNV-1a
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001B3u;
  return hash;
}

TEST(ProceduralScenes, BallsHaveNineTimesAsManyEachTime) {
  std::uint64_t spheres = 0, power = 1;
  for (std::uint32_t size = 0; size <= 4; ++size, power *= 9) {
    spheres += power;
    const SceneEntities read = tool::parse_scene_text(make_balls(size), "balls.nff");
    EXPECT_EQ(read.scene.counts.spheres, spheres);
    EXPECT_EQ(read.scene.counts.polygons, 1u);
    EXPECT_EQ(read.scene.point_lights.size(), 3u);
  }
  EXPECT_EQ(spheres, 7381u) << "published";
}

TEST(ProceduralScenes, BallsTouchTheirParentsAndStayAboveTheFloor) {
  const SceneEntities read = tool::parse_scene_text(make_balls(3), "balls.nff");
  std::vector<std::pair<DVec3, double>> balls;
  for (std::size_t i = 0; i < read.numbers.size(); i += 4) {
    balls.emplace_back(DVec3(read.numbers[i], read.numbers[i + 1], read.numbers[i + 2]), read.numbers[i + 3]);
  }
  std::size_t touching = 0;
  for (std::size_t i = 1; i < balls.size(); ++i) {
    EXPECT_GT(balls[i].first.z - balls[i].second, -0.5);
    for (std::size_t j = 0; j < i; ++j) {
      const double gap = glm::length(balls[i].first - balls[j].first) - balls[i].second - balls[j].second;
      if (std::fabs(balls[j].second - 3 * balls[i].second) < 1e-6 && std::fabs(gap) < 1e-5) {
        ++touching;
        break;
      }
    }
  }
  EXPECT_EQ(touching, balls.size() - 1) << "each hangs on one of three times its radius";
}

TEST(ProceduralScenes, TetraHasFourTimesAsManyEachTimeAllClosed) {
  std::uint64_t triangles = 1;
  for (std::uint32_t size = 1; size <= 6; ++size) {
    triangles *= 4;
    const SceneDescription scene = read_good(make_tetra(size));
    EXPECT_EQ(scene.geometry.triangles.size(), triangles);
    EXPECT_EQ(scene.counts.polygons, triangles);
    EXPECT_NEAR(signed_volume(scene.geometry.vertices, scene.geometry.triangles), 8.0 / 3 / std::pow(2, size - 1), 1e-9)
        << "half of it each time, turned outwards";
  }
  EXPECT_EQ(triangles, 4096u) << "published";
}

TEST(ProceduralScenes, MountIsASheetBehindFourBallsThatTouch) {
  std::uint64_t triangles = 2;
  for (std::uint32_t size = 1; size <= 6; ++size) {
    triangles *= 4;
    const SceneEntities read = tool::parse_scene_text(make_mount(size), "mount.nff");
    EXPECT_EQ(read.scene.counts.polygons, triangles);
    EXPECT_EQ(read.scene.counts.spheres, 4u);
    EXPECT_EQ(read.scene.point_lights.size(), 1u);
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const auto center = [&](std::size_t k) {
          return DVec3(read.numbers[4 * k], read.numbers[4 * k + 1], read.numbers[4 * k + 2]);
        };
        EXPECT_NEAR(glm::length(center(i) - center(j)), 2 * 0.17, 1e-6);
      }
    }
    // Places of corners are equal to the last bit, so that the sheet has its rim as its only open edges.
    std::map<std::tuple<float, float, float>, std::uint32_t> places;
    std::vector<UVec3> sheet;
    for (std::size_t i = 0; i < read.points.size(); i += 3) {
      UVec3 triangle;
      for (int corner = 0; corner < 3; ++corner) {
        const Vec3& p = read.points[i + static_cast<std::size_t>(corner)];
        triangle[corner] = places.try_emplace({p.x, p.y, p.z}, static_cast<std::uint32_t>(places.size())).first->second;
      }
      const Vec3 &a = read.points[i], &b = read.points[i + 1], &c = read.points[i + 2];
      ASSERT_GT(glm::cross(DVec3(b) - DVec3(a), DVec3(c) - DVec3(a)).z, 0) << "seen from above";
      sheet.push_back(triangle);
    }
    EXPECT_EQ(count_open_edges(sheet), 4u << size);
  }
  EXPECT_EQ(triangles, 8192u) << "published";
}

TEST(ProceduralScenes, MountOfALargerSizeIsTheSameMountain) {
  const auto heights = [](std::uint32_t size) {
    std::map<std::pair<float, float>, float> of;
    for (const Vec3& p : tool::parse_scene_text(make_mount(size), "mount.nff").points) of[{p.x, p.y}] = p.z;
    return of;
  };
  const auto fine = heights(5);
  for (const auto& [place, height] : heights(3)) EXPECT_EQ(fine.at(place), height);
}

TEST(ProceduralScenes, LatticeAndShellsHaveAsManyObjectsAsSaid) {
  for (std::uint32_t size = 1; size <= 4; ++size) {
    const SceneEntities lattice = tool::parse_scene_text(make_lattice(size), "lattice.nff");
    EXPECT_EQ(lattice.scene.counts.spheres, (size + 1) * (size + 1) * (size + 1));
    EXPECT_EQ(lattice.scene.counts.cones, 3 * size * (size + 1) * (size + 1));
    const SceneEntities shells = tool::parse_scene_text(make_shells(size), "shells.nff");
    EXPECT_EQ(shells.scene.counts.spheres, 288 * size * size);
    EXPECT_EQ(shells.scene.counts.polygons, 1u);
  }
}

TEST(ProceduralScenes, RingsAreLinkedPentagonsInAPyramid) {
  for (std::uint32_t size = 1; size <= 7; ++size) {
    const SceneEntities read = tool::parse_scene_text(make_rings(size), "rings.nff");
    const std::uint64_t each = 5 * size * (size + 1) * (2 * size + 1);
    EXPECT_EQ(read.scene.counts.spheres, each);
    EXPECT_EQ(read.scene.counts.cones, each);
    EXPECT_EQ(read.scene.counts.polygons, 1u);
    EXPECT_EQ(read.scene.point_lights.size(), 3u);
    EXPECT_TRUE(size != 7 || each == 4200u) << "published";
  }
  const SceneEntities one = tool::parse_scene_text(make_rings(1), "rings.nff");
  std::set<std::tuple<float, float, float>> joints;
  for (const tool::SceneShape& shape : one.shapes) {
    const double* n = one.numbers.data() + shape.first;
    if (shape.kind == ShapeKind::kSphere) {
      EXPECT_NEAR(glm::length(DVec3(n[0], n[1], n[2])), 1, 1e-6) << "the midpoint of an edge";
      joints.emplace(static_cast<float>(n[0]), static_cast<float>(n[1]), static_cast<float>(n[2]));
    } else if (shape.kind == ShapeKind::kCone) {
      const double side = glm::length(DVec3(n[0], n[1], n[2]) - DVec3(n[4], n[5], n[6]));
      EXPECT_NEAR(side, 2 * std::sin(std::acos(-1.0) / 5), 1e-6) << "side of a pentagon in the unit circle";
    }
  }
  EXPECT_EQ(joints.size(), 30u) << "each joint once";
}

// Recorded once: another value is another scene, and every figure measured on it is void.
TEST(ProceduralScenes, BytesNeverChange) {
  EXPECT_EQ(hash_of(make_balls(3)), 14023299833685127943u);
  EXPECT_EQ(hash_of(make_tetra(4)), 16486446167248363741u);
  EXPECT_EQ(hash_of(make_mount(5)), 7012613737257862563u);
  EXPECT_EQ(hash_of(make_rings(3)), 15989258830967330359u);
  std::string sky;
  for (std::uint32_t face = 0; face < 6; ++face) {
    const std::vector<char> bytes = make_sky_face(face, 16);
    sky.append(bytes.begin(), bytes.end());
  }
  EXPECT_EQ(hash_of(sky), 11464604944890586587u);
}

TEST(ProceduralScenes, TheTrianglesNeverChangeEither) {
  const auto hash = [](const std::string& text) {
    const tool::SceneGeometry geometry = read_good(text).geometry;
    const auto bytes = [](const auto& of) {
      return std::string_view(reinterpret_cast<const char*>(of.data()), of.size() * sizeof of[0]);
    };
    return hash_of(std::string(bytes(geometry.vertices)) + std::string(bytes(geometry.triangles)) +
                   std::string(bytes(geometry.normals)) + std::string(bytes(geometry.triangle_normals)) +
                   std::string(bytes(geometry.triangle_materials)));
  };
  EXPECT_EQ(hash(make_balls(2)), 17922869464965404846u);
  EXPECT_EQ(hash(make_mount(3)), 2518556967666453232u);
  EXPECT_EQ(hash(make_rings(2)), 16321691841855407055u);
}

TEST(ProceduralScenes, MillionsOfTriangles) {
  tool::SceneOptions coarse;
  coarse.relative_tolerance = 1.5e-5f;
  const SceneDescription scene = read_good(make_balls(5), coarse);
  EXPECT_EQ(scene.counts.spheres, 66430u);
  EXPECT_GT(scene.geometry.triangles.size(), 2'000'000u);
  EXPECT_LT(scene.geometry.triangles.size(), 5'000'000u);
  EXPECT_EQ(scene.materials.size(), 2u);
}

}  // namespace
}  // namespace gridiron::test
