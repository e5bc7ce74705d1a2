// Generated scenes, every pixel against the ground truth: the hard cases of grids, packets and predicates.
// SPDX-License-Identifier: Apache-2.0
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

std::function<TestMesh()> scaled_torus(std::uint32_t rings, float scale) {
  return [=] { return moved(make_torus(rings, rings / 2, 1.0f, 0.4f), scale, {}); };
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

// Triangles of one plane that overlap, some of them twice and turned over: whole numbers, so that it is one plane.
TestMesh overlapping_in_a_plane(bool tilted) {
  TestRandom random(21);
  TestMesh mesh;
  const auto corner = [&] {
    const auto x = static_cast<float>(random.below(17)) - 8.0f;
    const auto y = static_cast<float>(random.below(17)) - 8.0f;
    return Vec3(x, y, tilted ? -x - y : 0.0f);
  };
  for (int i = 0; i < 60; ++i) {
    const Vec3 a = corner(), b = corner(), c = corner();
    mesh.append(make_triangle(a, b, c));
    if (i % 4 == 0) mesh.append(make_triangle(a, c, b));
  }
  return mesh;
}

// Every triangle twice, its vertices a digit apart.
TestMesh almost_twice(const TestMesh& mesh) {
  TestMesh other = mesh;
  TestRandom random(22);
  for (Vec3& vertex : other.vertices) {
    const auto axis = static_cast<int>(random.below(3));
    vertex[axis] = std::nextafter(vertex[axis], random.below(2) == 0 ? 9.0f : -9.0f);
  }
  return joined(mesh, other);
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
  return {.lambda = lambda, .macro_width = macro_width};
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
      {"scale_1e-15", scaled_torus(32, 1e-15f), look({0, 2e-15f, 3e-15f}, {0, 0, 0})},
      {"scale_1e15", scaled_torus(32, 1e15f), look({0, 2e15f, 3e15f}, {0, 0, 0})},
      {"scale_1e-30", scaled_torus(32, 1e-30f), look({0, 2e-30f, 3e-30f}, {0, 0, 0})},
      {"scale_1e30", scaled_torus(32, 1e30f), look({0, 2e30f, 3e30f}, {0, 0, 0})},
      {"mixed_scale",
       [] { return joined(make_height_field(16, 60.0f, 3), moved(make_sphere(8, 10, 1.0f), 1e-3f, {})); },
       look({0, 0, 0.005f}, {0, 0, 0})},

      {"flat_z", [] { return make_box({-1, -1, 0}, {1, 1, 0}); }, look({0.3f, 0.2f, 3}, {0, 0, 0})},
      {"flat_z_denormal", [] { return make_box({-1, -1, 0}, {1, 1, 1e-40f}); }, look({0.3f, 0.2f, 3}, {0, 0, 0})},
      {"flat_z_denormal_side", [] { return make_box({-1, -1, -1e-39f}, {1, 1, 2e-39f}); },
       look({3, 0.2f, 0.4f}, {0, 0, 0})},
      {"scale_1e-38", scaled_torus(16, 1e-38f), look({0, 2e-38f, 3e-38f}, {0, 0, 0})},
      {"scale_1e35", scaled_torus(32, 1e35f), look({0, 2e35f, 3e35f}, {0, 0, 0})},
      {"scale_1e33_far", scaled_torus(16, 1e33f), look({7e35f, 5e35f, 8e35f}, {0, 0, 0}, 1.5e-3f)},
      {"grazing_1e35", scaled_torus(16, 1e35f), look({-1e29f, 0, -2e35f}, {0, 0, 3e35f}), 33, 33},
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
      {"overlapping_in_z", [] { return overlapping_in_a_plane(false); }, look({3, 4, 30}, {0, 0, 0}, 0.4f)},
      {"overlapping_tilted", [] { return overlapping_in_a_plane(true); }, look({20, 30, 12}, {0, 0, 0}, 0.4f)},
      {"almost_twice", [soup] { return almost_twice(soup()); }, look({2, 2, 4}, {0, 0, 0})},
      {"twice_and_turned", [soup] {
         TestMesh turned = soup();
         for (UVec3& triangle : turned.triangles) triangle = UVec3(triangle.z, triangle.y, triangle.x);
         return joined(turned, soup());
       },
       look({2, 2, 4}, {0, 0, 0})},
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
  return {.camera = c.camera, .width = c.width, .height = c.height, .t_far = c.t_far};
}

class SmallScenesTest : public testing::TestWithParam<std::size_t> {};

TEST_P(SmallScenesTest, EveryPixelEqualsTheTruth) {
  const SceneCase c = make_cases()[GetParam()];
  const TestMesh mesh = c.make();
  SceneInMemory scene(mesh.view(), c.grid);
  ASSERT_EQ(scene.status(), Status::kOk);
  for (std::uint32_t lanes = 4; lanes <= sim::widest_lanes(); lanes *= 2) {
    for (const sim::StoreSize store : {sim::StoreSize::k256KB, sim::StoreSize::k64KB}) {
      if (store == sim::StoreSize::k64KB && c.grid.macro_width > 6) continue;  // more than its cell buffers hold
      const sim::ChipOptions chip{.lanes = lanes, .store = store};
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

// Without requested distances, estimates are used where they decide: no pixel may differ.
TEST_P(SmallScenesTest, WithoutDepthThePictureIsTheSame) {
  const SceneCase c = make_cases()[GetParam()];
  const TestMesh mesh = c.make();
  SceneInMemory scene(mesh.view(), c.grid);
  ASSERT_EQ(scene.status(), Status::kOk);
  FrameSettings settings = settings_of(c);
  settings.shading = Shading::kSimple;
  const RenderedFrame expected = scene.render(settings, {});
  ASSERT_EQ(expected.result.status, Status::kOk);
  for (const std::uint32_t packet_width : {8u, 16u, 32u}) {
    for (const PlaneSet planes : {PlaneSet::kAll, PlaneSet::kColorAndIds}) {
      sim::ChipOptions chip;
      chip.packet_width = packet_width;
      chip.lanes = packet_width == 16 ? sim::widest_lanes() : 4;
      if (packet_width > 8) settings.techniques |= kUseSubpackets;
      const RenderedFrame rendered = scene.render(settings, chip, planes);
      ASSERT_EQ(rendered.result.status, Status::kOk) << packet_width;
      ASSERT_EQ(rendered.planes.depth.empty(), planes != PlaneSet::kAll);
      EXPECT_EQ(rendered.planes.ids, expected.planes.ids) << packet_width;
      EXPECT_EQ(rendered.planes.color, expected.planes.color) << packet_width;
    }
  }
}

TEST(SmallScenes, WithoutDepthHardlyADistanceIsExact) {
  const TestMesh mesh = joined(make_torus(60, 30, 1.0f, 0.35f), make_random_soup(800, 0.15f, 3));
  SceneInMemory scene(mesh.view(), {});
  FrameSettings settings{.camera = look({1.2f, 1.5f, 2.5f}, {0, 0, 0}), .width = 128, .height = 128};
  for (const std::uint32_t packet_width : {8u, 32u}) {
    const sim::ChipOptions chip{.packet_width = packet_width};
    if (packet_width > 8) settings.techniques |= kUseSubpackets;
    const auto exact = static_cast<std::size_t>(Work::kHitHalf);
    const RenderedFrame with = scene.render(settings, chip), without = scene.render(settings, chip, PlaneSet::kColor);
    ASSERT_EQ(with.result.status, Status::kOk);
    ASSERT_EQ(without.result.status, Status::kOk);
    EXPECT_EQ(with.planes.color, without.planes.color);
    EXPECT_GT(with.result.work[exact], 4000u) << packet_width;
    EXPECT_LT(without.result.work[exact], with.result.work[exact] / 40) << packet_width;
  }
}

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
    FrameSettings settings{.camera = look(eye, eye + Vec3{-y - 0.1f, z + 0.05f, x}, random.between(0.05f, 3.0f)),
                           .width = 1 + random.below(60),
                           .height = 1 + random.below(60)};
    GridParameters grid = grid_of(random.between(0.1f, 12.0f), 1 + random.below(8));
    constexpr Accuracy kAccuracies[] = {Accuracy::kStandard, Accuracy::kExact, Accuracy::kCompact};
    settings.accuracy = kAccuracies[random.below(3)];
    grid.format = format_of(settings.accuracy);

    SceneInMemory scene(mesh.view(), grid);
    if (scene.status() == Status::kNoTriangles) continue;
    if (settings.accuracy == Accuracy::kCompact) mesh.snap();
    ASSERT_EQ(scene.status(), Status::kOk) << "seed " << seed;
    sim::ChipOptions chip{.lanes = random.below(2) == 0 ? 4u : sim::widest_lanes(),
                          .packet_width = 4u << random.below(4)};
    if (random.below(2) == 0) settings.techniques |= kUseSubpackets;
    if (random.below(2) == 0) settings.techniques &= ~std::uint32_t{kUseCornerCulling};
    chip.completion = sim::Completion::kRandom;
    chip.seed = seed;
    const RenderedFrame rendered = scene.render(settings, chip);
    ASSERT_EQ(rendered.result.status, Status::kOk) << "seed " << seed;
    EXPECT_TRUE(rendered.result.violations.empty()) << "seed " << seed;
    const TruthReport report = check_against_truth(rendered, mesh.view(), all_pixels(rendered.frame));
    EXPECT_EQ(report.mismatches, 0u) << "seed " << seed << ": " << report.first_mismatch;
  }
}

// Sheets a few units in the last place apart, tilted against each other: rounded distances are equal nearly everywhere,
// and which sheet is nearest changes all over the picture.
TEST(SmallScenes, ExactTellsSheetsApartThatRoundAlike) {
  for (const std::uint32_t packet_width : {8u, 32u}) {
    TestMesh mesh;
    TestRandom random(packet_width);
    for (std::uint32_t sheet = 0; sheet < 40; ++sheet) {
      const std::uint32_t first = static_cast<std::uint32_t>(mesh.vertices.size());
      constexpr float kCorners[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
      for (const auto& [x, y] : kCorners) {
        const float lift = 0x1p-22f * static_cast<float>(random.below(5));
        mesh.vertices.emplace_back(x, y, 0.3f * x + 0.1f * y + 0.5f + lift);
      }
      mesh.triangles.emplace_back(first, first + 1, first + 2);
      mesh.triangles.emplace_back(first, first + 2, first + 3);
    }
    SceneInMemory scene(mesh.view(), grid_of(0.5f, 2));
    ASSERT_EQ(scene.status(), Status::kOk);
    FrameSettings settings{.camera = look({0.1f, 0.2f, 3}, {0, 0, 0}, 0.5f), .width = 48, .height = 48};
    const sim::ChipOptions chip{.packet_width = packet_width};
    if (packet_width > 8) settings.techniques |= kUseSubpackets;
    const RenderedFrame standard = scene.render(settings, chip);
    settings.accuracy = Accuracy::kExact;
    for (const PlaneSet planes : {PlaneSet::kAll, PlaneSet::kColorAndIds}) {
      const RenderedFrame exact = scene.render(settings, chip, planes);
      ASSERT_EQ(exact.result.status, Status::kOk);
      if (planes == PlaneSet::kAll) {
        const TruthReport report = check_against_truth(exact, mesh.view(), all_pixels(exact.frame));
        EXPECT_EQ(report.mismatches, 0u) << report.first_mismatch;
      } else {
        EXPECT_EQ(exact.planes.ids, scene.render(settings, chip).planes.ids);
      }
      std::size_t changed = 0;
      for (std::size_t i = 0; i < exact.planes.ids.size(); ++i)
        changed += exact.planes.ids[i] != standard.planes.ids[i];
      EXPECT_GT(changed, exact.planes.ids.size() / 8) << "ties that the test is about";
    }
  }
}

// Directions of all pixels of a frame.
std::vector<Vec3> directions_of(FrameSettings settings) {
  settings.color = MainAddress{kLineBytes};
  SceneImageView any_image{};
  any_image.has_grid = true;
  any_image.grid.triangle_format = static_cast<std::uint32_t>(TriangleFormat::kVertices);
  any_image.grid.macro_width = 1;
  FrameRecord frame{};
  EXPECT_EQ(make_frame_record(settings, any_image, {}, frame), Status::kOk);
  std::vector<Vec3> directions;
  for (std::uint32_t y = 0; y < settings.height; ++y) {
    for (std::uint32_t x = 0; x < settings.width; ++x) directions.push_back(pixel_direction(frame, x, y));
  }
  return directions;
}

// Distance of a point from the nearest cell face across x or y, in cells.
double distance_to_face(const GridRecord& grid, Vec3 p) {
  double nearest = 1.0;
  for (int axis = 0; axis < 2; ++axis) {
    const double cell = (double{p[axis]} - double{grid.minimum[axis]}) * double{grid.cells_per_unit[axis]};
    nearest = std::fmin(nearest, std::fabs(cell - std::round(cell)));
  }
  return nearest;
}

// A rim of a packet: its first or last row or column of pixels.
struct Rim {
  std::uint32_t packet_x, packet_y;
  bool last, columns;

  // Index of the pixel `along` the rim and `out` pixels beyond it.
  [[nodiscard]] std::size_t pixel(std::uint32_t along, std::uint32_t out, std::uint32_t width) const {
    const std::uint32_t x = packet_x * 8 + along;
    const std::uint32_t y = last ? packet_y * 8 + 7 + out : packet_y * 8 - out;
    return columns ? std::size_t{x} * width + y : std::size_t{y} * width + x;
  }
};

Rim random_rim(TestRandom& random, std::uint32_t width) {
  const std::uint32_t packet_x = 1 + random.below(width / 8 - 2);
  const std::uint32_t packet_y = 1 + random.below(width / 8 - 2);
  const bool last = random.below(2) == 0;
  return {packet_x, packet_y, last, random.below(2) == 0};
}

// How the cameras of these scenes stand.
enum class HungView : std::uint8_t {
  kAnyBits,  // directions of 24 bits: corners at powers of two along them
  kFewBits,  // directions of 7 bits: corners anywhere
  kFar,      // the same, almost parallel: rays run along faces of the grid
};

constexpr float kFarDistance = 4096.0f;

FrameSettings hung_settings(HungView view, TestRandom& random) {
  FrameSettings settings{.camera = look({0, 0, 0}, {0, 0, -1}, 0.5f), .width = 64, .height = 64};
  if (view == HungView::kFar) settings.camera = look({0, 0, kFarDistance}, {0, 0, 0}, 1.0f / kFarDistance);
  if (view == HungView::kAnyBits) {
    settings.camera.tan_half_fov = random.between(0.2f, 0.9f);
    settings.camera.at = {random.between(-1, 1), random.between(-1, 1), -1};
  }
  return settings;
}

// A distance along a ray at which a corner may hang.
float random_scale(HungView view, TestRandom& random) {
  switch (view) {
    case HungView::kAnyBits:
      return static_cast<float>(1u << random.below(6));
    case HungView::kFewBits:
      return static_cast<float>(1 + random.below(40 * 64)) / 64.0f;
    case HungView::kFar:
      return kFarDistance + (static_cast<float>(random.below(81)) - 40.0f) / 32.0f;
  }
  return 1.0f;
}

// Triangles whose corners lie exactly on rays at the rim of a packet, the rest of them outside of it: the last rays
// that corner rays, frusta and cell ranges may not lose. Where `grid` is given, half of them touch one ray with one
// corner, as close to a face of the grid as many draws allow. The first two triangles, out of sight, set the bounds.
TestMesh hang_on_rays(const FrameSettings& settings, HungView view, const GridRecord* grid, std::uint64_t seed) {
  const float reach = view == HungView::kFar ? 1.5f : 60.0f;
  constexpr std::size_t kTriangles = 300;
  constexpr int kDraws = 20000;
  const std::uint32_t width = settings.width;
  const Vec3 eye = settings.camera.eye;
  const std::vector<Vec3> directions = directions_of(settings);
  TestRandom random(seed);
  TestMesh mesh = make_triangle({reach, reach, reach}, {reach, reach - 0.1f, reach}, {reach - 0.1f, reach, reach});
  mesh.append(make_triangle({-reach, -reach, -reach}, {-reach, 0.1f - reach, -reach}, {0.1f - reach, -reach, -reach}));
  while (mesh.triangles.size() < kTriangles) {
    Rim rim = random_rim(random, width);
    std::uint32_t from = random.below(8);
    float scale = random_scale(view, random);
    const bool at_face = grid != nullptr && view != HungView::kAnyBits && mesh.triangles.size() % 2 == 0;
    double nearest = 2.0;
    for (int draw = 0; at_face && draw < kDraws; ++draw) {
      const Rim other_rim = random_rim(random, width);
      const std::uint32_t other_from = random.below(8);
      const float other_scale = random_scale(view, random);
      const Vec3 corner = eye + directions[other_rim.pixel(other_from, 0, width)] * other_scale;
      const double distance = distance_to_face(*grid, corner);
      if (distance >= nearest) continue;
      nearest = distance;
      rim = other_rim;
      from = other_from;
      scale = other_scale;
    }
    const std::uint32_t to = random.below(8);
    const std::uint32_t outward = 1 + random.below(5);
    const float tilt = view == HungView::kFar ? random.between(-0.2f, 0.2f) : scale * random.between(-0.1f, 0.1f);
    const Vec3 a = eye + directions[rim.pixel(from, 0, width)] * scale;
    const Vec3 b = eye + directions[rim.pixel(to, at_face ? outward : 0, width)] * scale;
    const Vec3 c = eye + directions[rim.pixel((from + to) / 2, outward, width)] * (scale + tilt);
    mesh.append(make_triangle(a, b, c));
  }
  return mesh;
}

class HungOnRaysTest : public testing::TestWithParam<HungView> {};

TEST_P(HungOnRaysTest, EveryPixelEqualsTheTruth) {
  constexpr std::uint64_t kSeeds = 8;
  const HungView view = GetParam();
  std::uint64_t exact_signs = 0;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    TestRandom random(1000 + seed);
    const FrameSettings view_settings = hung_settings(view, random);
    const GridParameters grid = grid_of(random.between(2.0f, 400.0f), 1 + random.below(6));

    GridNeed need{};
    const TestMesh anywhere = hang_on_rays(view_settings, view, nullptr, seed);
    ASSERT_EQ(count_scene_image(anywhere.view(), grid, need), Status::kOk) << "seed " << seed;
    const TestMesh mesh = hang_on_rays(view_settings, view, &need.grid, seed);
    SceneInMemory scene(mesh.view(), grid);
    ASSERT_EQ(scene.status(), Status::kOk) << "seed " << seed;
    for (const std::uint32_t packet_width : {4u, 8u, 32u}) {
      sim::ChipOptions chip;
      FrameSettings settings = view_settings;
      if (packet_width == 32) settings.techniques = kUseMailbox | kUseEmptySkip | kUseSubpackets;
      chip.packet_width = packet_width;
      chip.lanes = seed % 2 == 0 ? 4 : sim::widest_lanes();
      const RenderedFrame rendered = scene.render(settings, chip);
      ASSERT_EQ(rendered.result.status, Status::kOk) << "seed " << seed;
      const TruthReport report = check_against_truth(rendered, mesh.view(), all_pixels(rendered.frame));
      EXPECT_EQ(report.mismatches, 0u) << "seed " << seed << ", packets of " << packet_width << ": "
                                       << report.first_mismatch;
      exact_signs += report.work.exact_signs;
    }
  }
  EXPECT_GT(exact_signs, 400 * kSeeds) << "corners do not lie on rays";
}

std::string hung_view_name(const testing::TestParamInfo<HungView>& tested) {
  constexpr const char* kNames[] = {"any_bits", "few_bits", "far"};
  return kNames[static_cast<std::size_t>(tested.param)];
}

INSTANTIATE_TEST_SUITE_P(Views, HungOnRaysTest, testing::Values(HungView::kAnyBits, HungView::kFewBits, HungView::kFar),
                         hung_view_name);

// `paper` may leak and rounds its distances, so it is held to a share of pixels only.
TEST(PaperAccuracy, AgreesWithTheTruthAlmostEverywhere) {
  const TestMesh mesh = make_torus(48, 24, 1.0f, 0.4f);
  const GridParameters grid{.format = TriangleFormat::kProjection};
  SceneInMemory scene(mesh.view(), grid);
  ASSERT_EQ(scene.status(), Status::kOk);
  const FrameSettings settings{
      .camera = look({0, 2, 3}, {0, 0, 0}), .width = 128, .height = 128, .accuracy = Accuracy::kPaper};
  const RenderedFrame rendered = scene.render(settings, {});
  ASSERT_EQ(rendered.result.status, Status::kOk);
  std::size_t equal = 0;
  std::size_t near = 0;
  const std::vector<std::size_t> pixels = all_pixels(rendered.frame);
  const BruteForce truth(mesh.view(), settings.camera.eye);
  const std::vector<Vec3> directions = directions_of({.camera = settings.camera, .width = 128, .height = 128});
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
