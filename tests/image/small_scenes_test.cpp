// Generated scenes, every pixel against the ground truth: the hard cases of grids, packets and predicates.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "support/check_truth.h"
#include "support/render_mesh.h"
#include "support/test_mesh.h"
#include "support/views.h"

namespace gridiron::test {
namespace {

struct SceneCase {
  std::string name;
  std::function<TestMesh()> make;
  Camera camera;
  std::uint32_t width = 50, height = 37;
  GridParameters grid = {};
  float t_far = kFloatMax;
  bool must_hit = true;
};

Camera look(Vec3 eye, Vec3 at, float tan_half_fov = 0.5f) {
  const Vec3 view = at - eye;
  const bool vertical = std::fabs(view.y) > 0.99f * (std::fabs(view.x) + std::fabs(view.z) + std::fabs(view.y));
  return {eye, at, vertical ? Vec3{0, 0, 1} : Vec3{0, 1, 0}, tan_half_fov};
}

TestMesh moved(TestMesh mesh, float scale, Vec3 offset) {
  mesh.transform(scale, offset);
  return mesh;
}

TestMesh joined(TestMesh mesh, const TestMesh& other) {
  mesh.append(other);
  return mesh;
}

TestMesh repeated(const TestMesh& mesh, int count) {
  TestMesh all;
  for (int i = 0; i < count; ++i) all.append(mesh);
  return all;
}

TestMesh with_degenerate_triangles() {
  TestMesh mesh = make_sphere(12, 16, 1.0f);
  const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), {{-1, -1, 1.5f}, {0, 0, 1.5f}, {1, 1, 1.5f}});
  // One point, a doubled edge, three points of a line: in front of the sphere, never hit, ids counted.
  mesh.triangles.insert(mesh.triangles.begin(),
                        {{base, base, base}, {base, base + 2, base}, {base, base + 1, base + 2}});
  return mesh;
}

TestMesh coplanar_stack() {
  TestMesh mesh;
  float z = 1.0f;
  for (int i = 0; i < 12; ++i) {
    mesh.append(make_triangle({-1, -1, z}, {1, -1, z}, {0, 1, z}));
    z = std::nextafter(z, 2.0f);
  }
  return mesh;
}

// A triangle on a cell face, on a cell edge and at a corner of every kind: integer coordinates in an integer grid.
TestMesh integer_lattice() {
  TestMesh mesh;
  for (int i = 0; i <= 6; ++i) {
    const auto p = static_cast<float>(i);
    mesh.append(make_triangle({p, 0, 0}, {p, 6, 0}, {p, 0, 6}));
    mesh.append(make_triangle({0, p, 6}, {6, p, 6}, {6, p, 0}));
    mesh.append(make_triangle({6, 6, p}, {0, 6, p}, {6, 0, p}));
  }
  return mesh;
}

GridParameters grid_of(float lambda, std::uint32_t macro_width) {
  GridParameters parameters;
  parameters.lambda = lambda;
  parameters.macro_width = macro_width;
  return parameters;
}

std::vector<SceneCase> make_cases() {
  const auto sphere = [] { return make_sphere(24, 32, 1.0f); };
  const auto torus = [] { return make_torus(32, 16, 1.0f, 0.4f); };
  const auto soup = [] { return make_random_soup(600, 0.3f, 5); };
  const auto field = [] { return make_height_field(24, 0.3f, 9); };
  const auto box = [] { return make_box({-1, -1, -1}, {1, 1, 1}); };
  std::vector<SceneCase> cases = {
      {"sphere", sphere, look({1, 1, 4}, {0, 0, 0})},
      {"torus", torus, look({0, 2, 3}, {0, 0, 0})},
      {"soup", soup, look({2, 2, 4}, {0, 0, 0})},
      {"height_field", field, look({0.5f, 1, 2}, {0, 0, 0})},
      {"box", box, look({3, 2, 4}, {0, 0, 0})},
      {"slivers", [] { return make_sliver_fan(300, 1e-4f); }, look({0.01f, 0.5f, 0.2f}, {0, 0.5f, 0}, 0.1f)},
      {"slivers_at_apex", [] { return make_sliver_fan(300, 1e-3f); }, look({0, 0, 1}, {0, 0, 0}, 0.01f)},

      {"size_1x1", sphere, look({1, 1, 4}, {0, 0, 0}), 1, 1},
      {"size_1x70", sphere, look({1, 1, 4}, {0, 0, 0}), 1, 70},
      {"size_97x3", sphere, look({1, 1, 4}, {0, 0, 0}), 97, 3},
      {"size_33x65", soup, look({2, 2, 4}, {0, 0, 0}), 33, 65},

      {"inside_sphere", sphere, look({0.1f, 0.2f, 0.3f}, {1, 0, 0}, 1.0f)},
      {"inside_soup", soup, look({0, 0, 0}, {1, 0.3f, 0.2f}, 2.0f)},
      {"inside_box_wide", box, look({0, 0, 0}, {1, 1, 1}, 8.0f)},
      {"on_vertex", sphere, look({0, 1, 0}, {0.3f, 0, 0}, 1.0f)},
      {"on_box_corner", box, look({1, 1, 1}, {-1, -1, -1}, 1.0f)},
      {"on_box_edge", box, look({1, 0, 1}, {0, 0, 0}, 1.0f)},
      {"on_box_face", box, look({1, 0, 0}, {-1, 0.2f, 0.1f}, 1.0f)},
      {"on_face_looking_out", box, look({1, 0, 0}, {2, 0, 0}, 0.5f), 50, 37, {}, kFloatMax, false},
      {"past_everything", box, look({0, 0, 5}, {0, 0, 9}), 50, 37, {}, kFloatMax, false},

      {"along_plus_x", soup, look({-4, 0, 0}, {0, 0, 0}), 33, 33},
      {"along_minus_x", soup, look({4, 0, 0}, {0, 0, 0}), 33, 33},
      {"along_plus_y", soup, look({0, -4, 0}, {0, 0, 0}), 33, 33},
      {"along_minus_y", soup, look({0, 4, 0}, {0, 0, 0}), 33, 33},
      {"along_plus_z", soup, look({0, 0, -4}, {0, 0, 0}), 33, 33},
      {"along_minus_z", soup, look({0, 0, 4}, {0, 0, 0}), 33, 33},
      {"along_box_edges", box, look({1, 1, 4}, {1, 1, 0}, 0.25f), 33, 33},
      {"diagonal", integer_lattice, look({9, 9, 9}, {0, 0, 0}, 0.3f), 33, 33, grid_of(10.0f, 2)},
      {"lattice_inside", integer_lattice, look({3, 3, 3}, {6, 6, 6}, 1.5f), 33, 33, grid_of(10.0f, 2)},
      {"lattice_along_faces", integer_lattice, look({-3, 3, 3}, {6, 3, 3}, 0.2f), 33, 33, grid_of(10.0f, 3)},
      {"all_axes_in_view", sphere, look({0, 0, 0}, {1, 1, 1}, 20.0f)},

      {"offset_1e6", [] { return moved(make_sphere(24, 32, 1.0f), 1.0f, {1e6f, 1e6f, -1e6f}); },
       look({1e6f + 1, 1e6f + 1, -1e6f + 4}, {1e6f, 1e6f, -1e6f})},
      {"eye_1e6_away", sphere, look({0, 0, 1e6f}, {0, 0, 0}, 1e-6f)},
      {"eye_1e4_away", soup, look({1e4f, 1e4f, 0}, {0, 0, 0}, 1e-4f)},
      {"scale_1e-15", [] { return moved(make_torus(32, 16, 1.0f, 0.4f), 1e-15f, {}); },
       look({0, 2e-15f, 3e-15f}, {0, 0, 0})},
      {"scale_1e15", [] { return moved(make_torus(32, 16, 1.0f, 0.4f), 1e15f, {}); },
       look({0, 2e15f, 3e15f}, {0, 0, 0})},
      {"scale_1e-30", [] { return moved(make_torus(32, 16, 1.0f, 0.4f), 1e-30f, {}); },
       look({0, 2e-30f, 3e-30f}, {0, 0, 0})},
      {"scale_1e30", [] { return moved(make_torus(32, 16, 1.0f, 0.4f), 1e30f, {}); },
       look({0, 2e30f, 3e30f}, {0, 0, 0})},
      {"mixed_scale",
       [] { return joined(make_height_field(16, 60.0f, 3), moved(make_sphere(8, 10, 1.0f), 1e-3f, {})); },
       look({0, 0, 0.005f}, {0, 0, 0})},

      {"flat_z", [] { return make_box({-1, -1, 0}, {1, 1, 0}); }, look({0.3f, 0.2f, 3}, {0, 0, 0})},
      {"flat_field", [] { return make_height_field(12, 0.0f, 1); }, look({0.5f, 1, 2}, {0, 0, 0})},
      {"flat_field_edge_on", [] { return make_height_field(12, 0.0f, 1); }, look({0.1f, 0, 3}, {0, 0, 0}), 33, 33, {},
       kFloatMax, false},
      {"one_triangle", [] { return make_triangle({-1, -1, 0}, {1, -1, 0}, {0, 1, 0}); }, look({0, 0, 3}, {0, 0, 0})},
      {"giant_triangle", [] {
         return joined(make_triangle({-9e3f, -3, -9e3f}, {9e3f, -3, -9e3f}, {0, 2, 9e3f}), make_sphere(16, 20, 1.0f));
       },
       look({1, 3, 4}, {0, 0, 0})},
      {"giant_behind_soup", [] {
         return joined(make_random_soup(400, 0.1f, 6), make_triangle({-50, -50, -1}, {50, -50, -1}, {0, 70, -0.5f}));
       },
       look({0, 0, 4}, {0, 0, 0})},
      {"identical_triangles", [] { return repeated(make_triangle({-1, -1, 0}, {1, -1, 0}, {0, 1, 0}), 500); },
       look({0, 0, 3}, {0, 0, 0})},
      {"identical_spheres", [] { return repeated(make_sphere(12, 16, 1.0f), 3); }, look({1, 1, 4}, {0, 0, 0})},
      {"coplanar_stack", coplanar_stack, look({0, 0, 3}, {0, 0, 0})},
      {"degenerate_in_front", with_degenerate_triangles, look({0, 0, 4}, {0, 0, 0})},
      {"everything_in_one_cell", soup, look({2, 2, 4}, {0, 0, 0}), 50, 37, grid_of(1e-6f, 6)},
      {"many_cells", soup, look({2, 2, 4}, {0, 0, 0}), 50, 37, grid_of(200.0f, 6)},
      {"macro_width_1", soup, look({2, 2, 4}, {0, 0, 0}), 50, 37, grid_of(4.0f, 1)},
      {"macro_width_8", soup, look({2, 2, 4}, {0, 0, 0}), 50, 37, grid_of(4.0f, 8)},
      {"long_lists", [] { return make_random_soup(3000, 1.0f, 8); }, look({2, 2, 4}, {0, 0, 0}), 20, 20,
       grid_of(0.01f, 6)},
      {"t_far_cuts", soup, look({2, 2, 4}, {0, 0, 0}), 50, 37, {}, 4.5f},
      {"t_far_before_all", sphere, look({0, 0, 4}, {0, 0, 0}), 20, 20, {}, 1.0f, false},
  };
  return cases;
}

FrameSettings settings_of(const SceneCase& c) {
  FrameSettings settings;
  settings.camera = c.camera;
  settings.width = c.width;
  settings.height = c.height;
  settings.t_far = c.t_far;
  return settings;
}

class SmallScenesTest : public testing::TestWithParam<std::size_t> {};

TEST_P(SmallScenesTest, EveryPixelEqualsTheTruth) {
  const SceneCase c = make_cases()[GetParam()];
  const TestMesh mesh = c.make();
  SceneInMemory scene(mesh.view(), c.grid);
  ASSERT_EQ(scene.status(), Status::kOk);
  for (const std::uint32_t lanes : {4u, sim::widest_lanes()}) {
    for (const sim::StoreSize store : {sim::StoreSize::k256KB, sim::StoreSize::k64KB}) {
      if (store == sim::StoreSize::k64KB && c.grid.macro_width > 6) continue;  // more than its cell buffers hold
      sim::ChipOptions chip;
      chip.lanes = lanes;
      chip.store = store;
      const RenderedFrame rendered = scene.render(settings_of(c), chip);
      ASSERT_EQ(rendered.result.status, Status::kOk) << lanes << " lanes";
      EXPECT_TRUE(rendered.result.violations.empty()) << rendered.result.violations.front().detail;
      const TruthReport report = check_against_truth(rendered, mesh.view(), all_pixels(rendered.frame));
      EXPECT_EQ(report.mismatches, 0u) << c.name << ", " << lanes << " lanes: " << report.first_mismatch;
      if (c.must_hit) {
        EXPECT_GT(report.hits, 0u);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Cases, SmallScenesTest, testing::Range<std::size_t>(0, make_cases().size()),
                         [](const testing::TestParamInfo<std::size_t>& tested) {
                           std::string name = make_cases()[tested.param].name;
                           for (char& letter : name) letter = letter == '-' ? 'm' : letter;
                           return name;
                         });

// Scenes, cameras and grids drawn by a seed; a failure names it.
TEST(RandomSmallScenes, EveryPixelEqualsTheTruth) {
  constexpr std::uint64_t kScenes = 60;
  for (std::uint64_t seed = 0; seed < kScenes; ++seed) {
    TestRandom random(seed);
    TestMesh mesh = make_random_soup(1 + random.below(300), random.between(0.01f, 1.0f), random.next());
    if (random.below(2) == 0) mesh.append(make_torus(3 + random.below(20), 3 + random.below(10), 1.0f, 0.3f));
    if (random.below(4) == 0) {
      for (Vec3& p : mesh.vertices) p = Vec3(std::round(p.x * 4), std::round(p.y * 4), std::round(p.z * 4)) * 0.25f;
    }
    const float spread = random.below(2) == 0 ? 0.8f : 4.0f;
    const float x = random.between(-spread, spread);
    const float y = random.between(-spread, spread);
    const float z = random.between(-spread, spread);
    const Vec3 eye = random.below(4) == 0 ? mesh.vertices[random.below(3)] : Vec3{x, y, z};
    FrameSettings settings;
    settings.camera = look(eye, eye + Vec3{-y - 0.1f, z + 0.05f, x}, random.between(0.05f, 3.0f));
    settings.width = 1 + random.below(60);
    settings.height = 1 + random.below(60);
    GridParameters grid = grid_of(random.between(0.1f, 12.0f), 1 + random.below(8));

    SceneInMemory scene(mesh.view(), grid);
    if (scene.status() == Status::kNoTriangles) continue;
    ASSERT_EQ(scene.status(), Status::kOk) << "seed " << seed;
    sim::ChipOptions chip;
    chip.lanes = random.below(2) == 0 ? 4u : sim::widest_lanes();
    chip.packet_width = 4u << random.below(3);
    chip.completion = sim::Completion::kRandom;
    chip.seed = seed;
    const RenderedFrame rendered = scene.render(settings, chip);
    ASSERT_EQ(rendered.result.status, Status::kOk) << "seed " << seed;
    EXPECT_TRUE(rendered.result.violations.empty()) << "seed " << seed;
    const TruthReport report = check_against_truth(rendered, mesh.view(), all_pixels(rendered.frame));
    EXPECT_EQ(report.mismatches, 0u) << "seed " << seed << ": " << report.first_mismatch;
  }
}

// `paper` may leak and rounds its distances, so it is held to a share of pixels only.
TEST(PaperAccuracy, AgreesWithTheTruthAlmostEverywhere) {
  const TestMesh mesh = make_torus(48, 24, 1.0f, 0.4f);
  GridParameters grid;
  grid.format = TriangleFormat::kProjection;
  SceneInMemory scene(mesh.view(), grid);
  ASSERT_EQ(scene.status(), Status::kOk);
  FrameSettings settings;
  settings.camera = look({0, 2, 3}, {0, 0, 0});
  settings.width = settings.height = 128;
  settings.accuracy = Accuracy::kPaper;
  const RenderedFrame rendered = scene.render(settings, {});
  ASSERT_EQ(rendered.result.status, Status::kOk);
  std::size_t equal = 0;
  std::size_t near = 0;
  const std::vector<std::size_t> pixels = all_pixels(rendered.frame);
  const BruteForce truth(mesh.view(), settings.camera.eye);
  std::vector<Vec3> directions;
  for (const std::size_t pixel : pixels) {
    directions.push_back(pixel_direction(rendered.frame, static_cast<std::uint32_t>(pixel % 128),
                                         static_cast<std::uint32_t>(pixel / 128)));
  }
  const std::vector<TrueHit> hits = truth.trace(directions, kFloatMax, 1);
  for (const std::size_t pixel : pixels) {
    equal += rendered.planes.ids[pixel] == hits[pixel].triangle_id;
    const float depth = depth_value(hits[pixel], directions[pixel]);
    near += std::fabs(rendered.planes.depth[pixel] - depth) <= 1e-4f * depth;
  }
  EXPECT_GE(equal, pixels.size() * 995 / 1000);
  EXPECT_GE(near, pixels.size() * 995 / 1000);
}

}  // namespace
}  // namespace gridiron::test
