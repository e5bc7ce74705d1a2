// Pictures of the kernel against the reference's: scenes of the repository, scenes in code, scenes of the makers. And
// against those whose eye rays go through the tree.
// SPDX-License-Identifier: Apache-2.0
#include <ostream>

#include "effects/effect_scene.h"
#include "effects/kernel_check.h"
#include "effects/kernel_chip.h"
#include "scene_makers/procedural.h"
#include "scene_text/scene_reader.h"

namespace gridiron::test {
namespace {

using tool::SceneDescription;

SceneDescription made(const std::string& text, float tolerance) {
  tool::SceneOptions options;
  options.relative_tolerance = tolerance;
  return tool::read_scene_text(text, "made.nff", options);
}

struct PictureCase {
  std::string_view name;
  SceneDescription (*scene)(float tolerance);  ///< of round shapes
  std::uint32_t size;
  PictureTolerance tolerance;  ///< at that size

  friend void PrintTo(const PictureCase& picture, std::ostream* out) { *out << picture.name; }
};

template <std::size_t Index>
SceneDescription shipped(float tolerance) {
  return shipped_scene(kShippedScenes[Index], tolerance);
}

// A pixel may be off by more than a step only beside a discontinuity. The kernel's secondary rays begin at points that
// are off by some 1e-6 of the scene's size, lifted and drawn away from edges (ray/secondary_origin.h), and run along
// directions off by 1e-7; the reference begins at the hit itself. So a ray that passes an edge, the foot of a box or
// the rim of a shadow that near sees something else. Rays of a regular picture do so in one pixel of some thousands;
// where 16 or 64 rays are cast from each pixel in proportion more, but then by a 16th of the light each. Flat mirrors
// and glass keep deviations as they are; each reflection off a curved one of radius r at distance d multiplies them by
// 2 d / r or more: of `rings`, tubes of 1/50 of the scene that mirror one another five times over, 2 pixels in 100 are
// off, with depth 2 two in 1,000, and with flat triangles one in 1,000. The numbers are those measured, and half of
// that more. Numbers of rays are equal but where a ray that sees something else goes on.
const PictureCase kCases[] = {
    {"shadow", shipped<0>, 96, {}},
    {"area_light", shipped<1>, 64, {2, 0.0, 0.1}},
    {"mirror", shipped<2>, 96, {}},
    {"glass", shipped<3>, 96, {}},
    {"ambient_occlusion", shipped<4>, 64, {2, 0.0, 0.1}},
    {"environment", shipped<5>, 96, {}},
    {"smooth_normals", shipped<6>, 96, {}},
    {"highlight", shipped<7>, 96, {}},
    {"multisampling", shipped<8>, 64, {}},
    {"everything", shipped<9>, 32, {5, 2e-4, 0.12}},
    {"mirror_room", [](float) { return mirror_room_scene(); }, 64, {6, 2e-4, 0.1}},
    {"glass_ball_flat", [](float) { return glass_ball_scene(false); }, 64, {2, 3e-4, 0.1}},
    {"glass_ball_smooth", [](float) { return glass_ball_scene(true); }, 64, {1, 2e-4, 0.1}},
    // Its colours have 10 bits, and the curve of sRGB makes more of what is dark.
    {"colored_ball", [](float) { return colored_ball_scene(); }, 64, {2, 1.2e-4, 0.2}},
    {"acne_point", [](float) { return acne_scene(AcneLight::kPoint, 1, Vec3(0)); }, 64, {}},
    {"acne_area", [](float) { return acne_scene(AcneLight::kArea, 1, Vec3(0)); }, 64, {}},
    {"acne_ambient", [](float) { return acne_scene(AcneLight::kAmbient, 1, Vec3(0)); }, 64, {}},
    {"occlusion_corner", [](float) { return occlusion_corner_scene(3, 1, 16); }, 64, {4, 0.0, 0.1}},
    {"balls", [](float tolerance) { return made(scene_makers::make_balls(1), tolerance); }, 64, {6, 2e-4, 0.1}},
    {"tetra", [](float tolerance) { return made(scene_makers::make_tetra(3), tolerance); }, 64, {}},
    {"mount", [](float tolerance) { return made(scene_makers::make_mount(3), tolerance); }, 64, {3, 6e-4, 0.1}},
    {"rings", [](float) { return made(scene_makers::make_rings(1), 2e-3f); }, 64, {108, 0.008, 0.12}},
    {"rings_once",
     [](float) {
       SceneDescription scene = made(scene_makers::make_rings(1), 2e-3f);
       scene.recursion_depth = 2;
       return scene;
     },
     64,
     {10, 5e-3, 0.1}},
    {"rings_flat",
     [](float) {
       SceneDescription scene = made(scene_makers::make_rings(1), 2e-3f);
       for (tool::SceneMaterial& material : scene.materials) material.smooth_normals = false;
       scene.geometry.normals.clear();
       scene.geometry.triangle_normals.clear();
       return scene;
     },
     64,
     {6, 2e-3, 0.1}},
};

class KernelPictures : public testing::TestWithParam<PictureCase> {};

// GRIDIRON_EFFECTS_SIZE: pixels along an edge in place of those above, with round shapes as readers make them.
TEST_P(KernelPictures, AreTheReferencesPictures) {
  const PictureCase& picture = GetParam();
  const char* const wanted = std::getenv("GRIDIRON_EFFECTS_SIZE");
  if (wanted == nullptr) return expect_reference(picture.scene(1e-3f), picture.size, picture.size, picture.tolerance);
  const auto size = static_cast<std::uint32_t>(std::atoi(wanted));
  const double pixels = static_cast<double>(size) * size / (static_cast<double>(picture.size) * picture.size);
  PictureTolerance tolerance = picture.tolerance;
  // What one pixel in thousands does, one of many does even where few show none.
  tolerance.off_by_more_than_1 =
      static_cast<std::size_t>(pixels * static_cast<double>(tolerance.off_by_more_than_1 + 2));
  tolerance.ray_share += 1e-4;
  expect_reference(picture.scene(1e-4f), size, size, tolerance);
}

// Colours, distances and triangles, bit by bit: eye rays by packets through the grid, and tile by tile through the
// tree.
TEST_P(KernelPictures, EyeRaysThroughTheTreeGiveTheSameBits) {
  constexpr std::uint32_t kWidth = 49, kHeight = 37;  // 2 x 2 tiles, cut
  const SceneDescription description = GetParam().scene(1e-3f);
  const Camera camera = camera_of(description.view);
  for (const Accuracy accuracy : {Accuracy::kStandard, Accuracy::kExact, Accuracy::kCompact}) {
    KernelOptions options{.accuracy = accuracy, .fetch_depth = 4, .wants_planes = true};
    KernelScene scene = build_kernel_scene(description, options);
    const auto render = [&](const sim::ChipOptions& chip) {
      return render_on_chip(scene, camera, kWidth, kHeight, options, chip);
    };
    const std::uint32_t widest = sim::widest_lanes();
    const KernelPicture packets = render({.mode = sim::Mode::kPlain, .lanes = widest, .packet_width = 8});
    ASSERT_EQ(packets.status, Status::kOk);
    ASSERT_TRUE(std::any_of(packets.ids.begin(), packets.ids.end(), [](auto id) { return id != kNoTriangle; }));
    options.engine = EngineId::kTree;
    const sim::ChipOptions chips[] = {
        {.mode = sim::Mode::kPlain, .lanes = 4, .packet_width = 0},
        {.mode = sim::Mode::kPlain, .lanes = widest, .packet_width = 0},
        {.mode = sim::Mode::kChecked, .lanes = 4, .packet_width = 0, .completion = sim::Completion::kLate}};
    for (const sim::ChipOptions& chip : chips) {
      SCOPED_TRACE(testing::Message() << "accuracy " << static_cast<unsigned>(accuracy) << ", mode "
                                      << static_cast<unsigned>(chip.mode) << ", lanes " << chip.lanes);
      const KernelPicture tiles = render(chip);
      ASSERT_EQ(tiles.status, Status::kOk) << tiles.violation;
      EXPECT_EQ(tiles.violation, "");
      EXPECT_EQ(tiles.color, packets.color);
      EXPECT_EQ(tiles.ids, packets.ids);
      ASSERT_EQ(tiles.depth.size(), packets.depth.size());
      EXPECT_EQ(std::memcmp(tiles.depth.data(), packets.depth.data(), 4 * packets.depth.size()), 0);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, KernelPictures, testing::ValuesIn(kCases),
                         [](const auto& picture) { return std::string(picture.param.name); });

}  // namespace
}  // namespace gridiron::test
