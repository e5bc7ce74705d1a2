// Parts of the reference: camera, samples, jitter, environment, and how rays find triangles.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/frame/frame_setup.h>

#include <glm/geometric.hpp>

#include "effects/effect_scene.h"
#include "effects/reference/reference_renderer.h"
#include "scene_text/scene_reader.h"

namespace gridiron::test {
namespace {

using tool::SceneDescription;
using tool::SceneMaterial;

void expect_same(const glm::vec3& a, const float b[3]) {
  for (int axis = 0; axis < 3; ++axis) EXPECT_EQ(a[axis], b[axis]);
}

TEST(ReferenceCamera, IsTheFramesBitForBit) {
  tool::SceneView view;
  for (const auto& [width, height, angle] : {std::tuple{64u, 48u, 45.0f}, {511u, 767u, 3.0f}, {33u, 7u, 120.0f}}) {
    view = {{4.1f, 3.7f, 9.3f}, {0.2f, 1.1f, -0.4f}, {0.1f, 1, 0.05f}, angle, 0.0f, 1, 1};
    const FrameSettings settings{
        .camera = {view.from, view.at, view.up,
                   static_cast<float>(std::tan(0.5 * double{angle} * 3.14159265358979323846 / 180.0))},
        .width = width,
        .height = height,
        .color = MainAddress{kLineBytes}};
    SceneImageView image{};
    image.has_grid = true;
    image.grid.triangle_format = static_cast<std::uint32_t>(TriangleFormat::kVertices);
    image.grid.macro_width = 1;
    FrameRecord frame{};
    ASSERT_EQ(make_frame_record(settings, image, {}, frame), Status::kOk);
    const ReferenceCamera camera = reference_camera(view, width, height);
    expect_same(camera.eye, frame.eye);
    // One rounding of doubles that were summed up otherwise: a bit at most, and the same for these views.
    expect_same(camera.corner, frame.corner);
    expect_same(camera.step_x, frame.step_x);
    expect_same(camera.step_y, frame.step_y);
  }
}

TEST(ReferenceSamples, AreOneInEachRowAndColumn) {
  EXPECT_EQ(reference_sample_offset(0, 1), glm::vec2(0.0f));
  for (const std::uint32_t count : {4u, 16u}) {
    std::set<float> columns, rows;
    for (std::uint32_t s = 0; s < count; ++s) {
      const glm::vec2 offset = reference_sample_offset(s, count);
      columns.insert(offset.x);
      rows.insert(offset.y);
      EXPECT_LT(std::max(std::abs(offset.x), std::abs(offset.y)), 0.5f);
    }
    EXPECT_EQ(columns.size(), count);
    EXPECT_EQ(rows.size(), count);
  }
  EXPECT_EQ(reference_sample_offset(0, 4), glm::vec2(-0.375f, -0.125f));
  EXPECT_EQ(reference_sample_offset(3, 4), glm::vec2(0.375f, 0.125f));
  EXPECT_EQ(reference_sample_offset(1, 16), glm::vec2(-0.40625f, 0.03125f));
}

// Worked out by hand from the document, in integers of any length.
TEST(ReferenceJitter, IsTheDocumentsHash) {
  const auto expect = [](std::uint32_t path, std::uint32_t sample, std::uint32_t pixel, std::uint32_t purpose,
                         double j1, double j2) {
    const ReferenceJitter jitter = reference_jitter(path, sample, pixel, purpose);
    EXPECT_EQ(jitter.j1 * 16777216.0, j1);
    EXPECT_EQ(jitter.j2 * 16777216.0, j2);
  };
  expect(1, 0, 0, 0, 5089560, 4293228);
  expect(1, 0, 1, 0, 950390, 10068032);
  expect(3, 2, 1000, 5, 12114914, 11468207);
  expect(255, 15, 268435455, 257, 4794899, 1550876);
}

// A camera of 90 degrees in the middle sees a face's picture, texel by texel.
TEST(ReferenceEnvironment, ShowsEachFaceAsACameraSeesIt) {
  const Vec3 kAt[6] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  const Vec3 kUp[6] = {{0, 1, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, -1}, {0, 1, 0}, {0, 1, 0}};
  constexpr std::uint32_t kWidth = 8;
  for (std::size_t face = 0; face < 6; ++face) {
    SceneDescription scene = empty_scene({0, 0, 0}, kAt[face], kUp[face], 90);
    const Vec3 behind = -3.0f * kAt[face];
    add_triangle(scene, {behind, behind + kUp[face], behind + Vec3(0.1f)}, add_material(scene, {}));
    set_environment(scene, Vec3(0), kWidth);
    for (std::size_t f = 0; f < 6; ++f) {
      for (std::size_t i = 0; i < kWidth * kWidth; ++i) {
        scene.environment->texels[f][i] = {0.1f * static_cast<float>(f), 0.125f * static_cast<float>(i % kWidth),
                                           0.125f * static_cast<float>(i / kWidth)};
      }
    }
    const ReferencePicture picture = render_reference(scene, kWidth, kWidth);
    EXPECT_EQ(picture.counts.environment, kWidth * kWidth);
    for (std::size_t i = 0; i < kWidth * kWidth; ++i) {
      const glm::dvec3 texel(scene.environment->texels[face][i]);
      EXPECT_LT(glm::length(picture.linear[i] - texel), 1e-5) << "face " << face << " texel " << i;
    }
    // Four times as many pixels lie a quarter from the texels' middles: linear between them, cut off at the border.
    const ReferencePicture fine = render_reference(scene, 2 * kWidth, 2 * kWidth);
    for (std::uint32_t y = 0; y < 2 * kWidth; ++y) {
      for (std::uint32_t x = 0; x < 2 * kWidth; ++x) {
        const double column = std::clamp(0.5 * x - 0.25, 0.0, kWidth - 1.0);
        const double row = std::clamp(0.5 * y - 0.25, 0.0, kWidth - 1.0);
        EXPECT_NEAR(fine.linear[fine.index(x, y)].y, 0.125 * column, 1e-5);
        EXPECT_NEAR(fine.linear[fine.index(x, y)].z, 0.125 * row, 1e-5);
      }
    }
  }
}

void expect_same(const ReferencePicture& a, const ReferencePicture& b) {
  EXPECT_EQ(a.color, b.color);
  EXPECT_EQ(a.ids, b.ids);
  EXPECT_EQ(a.depth, b.depth);
  EXPECT_TRUE(a.linear == b.linear);
  EXPECT_EQ(a.counts, b.counts);
}

TEST(ReferenceGeometry, TreeAndEveryTriangleAnswerAlike) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> any(-1, 1);
  SceneDescription scene = empty_scene({0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 45);
  const std::uint16_t material = add_material(scene, {});
  for (int i = 0; i < 300; ++i) {
    const Vec3 at(any(random), any(random), any(random));
    const auto near = [&] { return at + 0.2f * Vec3(any(random), any(random), any(random)); };
    add_triangle(scene, {near(), near(), near()}, material);
  }
  add_triangle(scene, {Vec3(0), Vec3(1), Vec3(1)}, material);  // no area: never hit
  add_box(scene, Vec3(-0.5f), Vec3(0.5f), material);           // boxes without thickness in the tree
  const ReferenceGeometry geometry(scene.geometry);
  std::size_t hits = 0;
  for (int i = 0; i < 20000; ++i) {
    ReferenceRay ray{DVec3(any(random), any(random), any(random)) * 2.0,
                     DVec3(any(random), any(random), any(random))};
    if (i % 3 == 0) ray.dir[i % 9 / 3] = 0.0;
    if (i % 5 == 0) ray.most_t = 1.0;
    const auto slow = geometry.nearest(ray, ReferenceSearch::kEveryTriangle);
    const auto fast = geometry.nearest(ray, ReferenceSearch::kBoxTree);
    ASSERT_EQ(slow.has_value(), fast.has_value()) << i;
    EXPECT_EQ(geometry.is_any(ray, ReferenceSearch::kEveryTriangle), slow.has_value());
    EXPECT_EQ(geometry.is_any(ray, ReferenceSearch::kBoxTree), slow.has_value());
    if (!slow) continue;
    ++hits;
    EXPECT_EQ(slow->id, fast->id) << i;
    EXPECT_EQ(slow->t, fast->t);
    // The point by its weights is the point along the ray.
    DVec3 point(0.0);
    for (int k = 0; k < 3; ++k) point += slow->weights[k] * geometry.corner(slow->id, k);
    EXPECT_LT(glm::length(point - (ray.origin + slow->t * ray.dir)), 1e-9);
  }
  EXPECT_GT(hits, 2000u);
}

// Rays at shared edges and corners of a ball from its middle: none escapes.
TEST(ReferenceGeometry, NeighboursLeaveNoGap) {
  SceneDescription scene = empty_scene({0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 45);
  add_ball(scene, {0.1f, 0.2f, 0.3f}, 1, 5, add_material(scene, {}));
  const ReferenceGeometry geometry(scene.geometry);
  const DVec3 origin(0.15, 0.1, 0.37);
  for (const UVec3& t : scene.geometry.triangles) {
    for (int k = 0; k < 3; ++k) {
      const DVec3 a(scene.geometry.vertices[t[k]]), b(scene.geometry.vertices[t[(k + 1) % 3]]);
      for (const double s : {0.0, 0.1, 0.3, 0.5}) {
        EXPECT_TRUE(geometry.is_any({origin, a + s * (b - a) - origin}, ReferenceSearch::kBoxTree));
      }
    }
  }
}

TEST(ReferenceGeometry, OfEqualDistancesTheLowerIdIsNearer) {
  SceneDescription scene = empty_scene({0.3f, 0.2f, 5}, {0, 0, 0}, {0, 1, 0}, 20);
  const std::uint16_t material = add_material(scene, {});
  // All in one plane over the whole picture, the tree's first ones last.
  for (int i = 0; i < 40; ++i) {
    const float x = -9.1f - 0.3f * static_cast<float>(i);
    add_triangle(scene, {{x, -9.3f, 0.1f}, {9.7f, -9.1f, 0.1f}, {0.3f, 20.9f, 0.1f}}, material);
  }
  const ReferencePicture picture = render_reference(scene, 24, 24);
  for (const std::uint32_t id : picture.ids) EXPECT_EQ(id, 0u);
}

// All effects at once. Each triangle is tested for a part of the picture only.
TEST(ReferenceRenderer, TreeThreadsAndRegionsChangeNothing) {
  SceneDescription scene = tool::read_scene_text(std::filesystem::path(GRIDIRON_SOURCE_DIR) / "scenes/everything.nff",
                                                 {.tolerance = 0.05f});
  const ReferencePicture whole = render_reference(scene, 24, 24);
  ReferenceOptions options;
  options.threads = 1;
  expect_same(whole, render_reference(scene, 24, 24, options));
  options.region = ReferenceRegion{7, 13, 6, 4};
  const ReferencePicture part = render_reference(scene, 24, 24, options);
  options.search = ReferenceSearch::kEveryTriangle;
  expect_same(part, render_reference(scene, 24, 24, options));
  for (std::uint32_t y = 13; y < 17; ++y) {
    for (std::uint32_t x = 7; x < 13; ++x) {
      EXPECT_TRUE(part.linear[part.index(x, y)] == whole.linear[whole.index(x, y)]);
      EXPECT_EQ(part.ids[part.index(x, y)], whole.ids[whole.index(x, y)]);
    }
  }
  EXPECT_EQ(whole.counts.primary, 24u * 24 * 4);
  const ReferenceCounts& counts = whole.counts;
  for (const std::uint64_t count : {counts.shadow, counts.occlusion, counts.reflected, counts.refracted,
                                    counts.environment}) {
    EXPECT_GT(count, 100u);
  }
  for (const DVec3& value : whole.linear) {
    for (int channel = 0; channel < 3; ++channel) EXPECT_TRUE(std::isfinite(value[channel]));
  }
}

}  // namespace
}  // namespace gridiron::test
