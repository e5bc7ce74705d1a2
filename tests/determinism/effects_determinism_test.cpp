// A frame with every effect, however it is made: the same picture, the same work, the same trace.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/build/grid/grid_builder.h>
#include <gridiron/frame/frame_setup.h>
#include <gridiron/image/scene_image.h>
#include <gridiron/sim/sim_chip.h>
#include <gridiron/store/local_store.h>

#include "determinism/trace_difference.h"
#include "support/instrumented.h"
#include "support/test_mesh.h"

namespace gridiron::test {
namespace {

using EffectsStore = LocalStore<EffectLayout256K<kAllEffects, 8>>::Effects;
constexpr std::uint32_t kLightsAtHand = EffectsStore::kLightSlots;

// A torus of glass and a ball of mirror, both smooth, above a matt floor.
struct EffectsSubject {
  TestMesh mesh;
  std::vector<std::uint16_t> materials;
  std::vector<Vec3> normals;
  std::vector<UVec3> triangle_normals;
  std::vector<Vec3> face;
  std::vector<Material> material_list;
  std::vector<Light> lights;

  explicit EffectsSubject(bool many_lights = false) {
    append(make_torus(16, 8, 1.0f, 0.35f), 0);
    append(make_sphere(8, 12, 0.5f), 1);
    append(make_triangle({-4, -0.8f, -4}, {4, -0.8f, -4}, {0, -0.8f, 5}), 2);
    Material glass{.color = {1, 0.9f, 0.8f}, .kd = 0.1f, .ks = 0.2f, .shine = 20.0f, .transmittance = 0.7f};
    glass.index = 1.5f;
    material_list = {glass, {.kd = 0.3f, .ks = 0.7f, .shine = 60.0f}, {.color = {0.8f, 0.7f, 0.6f}}};
    material_list[0].smooth_normals = material_list[1].smooth_normals = true;
    lights = {{.corner = {2, 3, 2}, .color = {0.6f, 0.6f, 0.6f}},
              {.corner = {-2, 3, 1}, .edge_u = {1, 0, 0}, .edge_v = {0, 0, 1}, .color = {0.5f, 0.5f, 0.4f},
               .samples = 3}};
    for (std::uint32_t i = 0; many_lights && i < kLightsAtHand; ++i) {
      lights.insert(lights.begin(), {.corner = {static_cast<float>(i) - 8, 3, 2}, .color = {0.03f, 0.03f, 0.03f}});
    }
    face.assign(4, Vec3{0.2f, 0.3f, 0.5f});
  }

  void append(const TestMesh& part, std::uint16_t material) {
    const auto first = static_cast<std::uint32_t>(mesh.triangles.size());
    mesh.append(part);
    for (std::size_t i = first; i < mesh.triangles.size(); ++i) {
      materials.push_back(material);
      if (material == 2) {
        triangle_normals.push_back(UVec3(kNoNormals));
        continue;
      }
      // Any unit normals do.
      triangle_normals.push_back(UVec3(static_cast<std::uint32_t>(normals.size())));
      normals.push_back(i % 2 == 0 ? Vec3{0, 1, 0} : Vec3{0.6f, 0, 0.8f});
    }
  }

  [[nodiscard]] EffectsView view() const {
    EffectsView effects;
    effects.materials = material_list;
    effects.triangle_materials = materials;
    effects.normals = normals;
    effects.triangle_normals = triangle_normals;
    effects.lights = lights;
    effects.background = {0.1f, 0.1f, 0.1f};
    effects.recursion_depth = 4;
    effects.samples_per_pixel = 4;
    effects.occlusion_samples = 2;
    effects.occlusion_radius = 1.5f;
    effects.environment_width = 2;
    for (auto& texels : effects.environment_faces) texels = face;
    return effects;
  }
};

struct EffectsFrame {
  sim::ChipResult result;
  std::vector<std::byte> color;
};

EffectsFrame render(const EffectsSubject& subject,
                    const std::function<void(FrameSettings&, sim::ChipOptions&)>& apply) {
  const EffectsView effects = subject.view();
  FrameSettings settings{.camera = {{1.2f, 1.5f, 3.5f}, {0, 0, 0}, {0, 1, 0}, 0.5f},
                         .width = 50,
                         .height = 36,
                         .shading = Shading::kScene,
                         .fetch_depth = 4};
  sim::ChipOptions chip;
  apply(settings, chip);
  EffectsFrame frame;
  GridNeed need;
  const GridParameters grid{.lambda = 2.0f, .macro_width = 4};
  frame.result.status = count_scene_image(subject.mesh.view(), grid, need, &effects);
  if (frame.result.status != Status::kOk) return frame;
  sim::SimMemory memory(need.image_bytes + (std::uint64_t{4} << 20));
  const auto image = *memory.allocate(need.image_bytes);
  std::vector<std::uint64_t> scratch(need.scratch_bytes / 8 + 1);
  frame.result.status = build_scene_image(subject.mesh.view(), grid, need, image.bytes,
                                          std::as_writable_bytes(std::span(scratch)), &effects);
  SceneImageView view{};
  SceneImageError error;
  if (frame.result.status != Status::kOk || open_scene_image(image.bytes, view, error) != Status::kOk) return frame;
  // Planes of every tile width at the same place, so that traces can be compared.
  const auto color = *memory.allocate(std::uint64_t{64} * 64 * 4);
  const auto record = *memory.allocate(sizeof(FrameRecord));
  chip.spill.bytes_per_core = spill_bytes(effects.recursion_depth);
  const auto spill = *memory.allocate(chip.threads * chip.spill.slice_bytes() + kSpillAlignment);
  chip.spill.address = MainAddress{round_up(spill.address.value, std::uint64_t{kSpillAlignment})};
  settings.color = color.address;
  FrameRecord filled;
  frame.result.status = make_frame_record(settings, view, image.address, filled);
  if (frame.result.status != Status::kOk) return frame;
  std::memcpy(record.bytes.data(), &filled, sizeof filled);
  frame.result = render_in_test(memory, record.address, chip);
  for (std::uint32_t y = 0; y < settings.height; ++y) {
    for (std::uint32_t x = 0; x < settings.width; ++x) {
      const auto* const pixel =
          color.bytes.data() + 4 * output_plane_index(settings.width, settings.tile_width, x, y);
      frame.color.insert(frame.color.end(), pixel, pixel + 4);
    }
  }
  return frame;
}

EffectsFrame render(const std::function<void(FrameSettings&, sim::ChipOptions&)>& apply) {
  static const EffectsSubject subject;
  return render(subject, apply);
}

const EffectsFrame& first_frame() {
  static const EffectsFrame frame = render([](FrameSettings&, sim::ChipOptions&) {});
  return frame;
}

TEST(EffectsDeterminism, TheSceneHasRaysOfEveryKind) {
  const EffectsFrame& frame = first_frame();
  ASSERT_EQ(frame.result.status, Status::kOk);
  for (const Work kind : {Work::kShadowRay, Work::kOcclusionRay, Work::kMirrorRay, Work::kRefractedRay,
                          Work::kEnvironmentLookup, Work::kSmoothNormal, Work::kHighlight}) {
    EXPECT_GT(frame.result.work[static_cast<std::size_t>(kind)], 0u) << static_cast<int>(kind);
  }
}

// Steps of a frame with effects are many; they are packed tile by tile, and this is the memory that they take. The
// count is the same on every host, so that growth of any size is seen here.
TEST(EffectsDeterminism, TracesTakeFewBytes) {
  const sim::FrameTrace& trace = first_frame().result.trace;
  std::uint64_t steps = 0;
  for (const sim::TileTrace& tile : trace.tiles) sim::for_each_event(tile, [&](const sim::TraceEvent&) { ++steps; });
  const std::uint64_t bytes = trace.packed_bytes();
  RecordProperty("steps", std::to_string(steps));
  RecordProperty("bytes", std::to_string(bytes));
  EXPECT_GT(steps, 90000u) << "of 1,800 pixels";
  EXPECT_LT(bytes, 230000u);
}

TEST(EffectsDeterminism, ThreadsAndOrderOfTransfersChangeNothing) {
  const auto expect_same = [](const std::string& name, const std::function<void(sim::ChipOptions&)>& apply) {
    const EffectsFrame frame = render([&](FrameSettings&, sim::ChipOptions& chip) { apply(chip); });
    ASSERT_EQ(frame.result.status, Status::kOk) << name;
    EXPECT_TRUE(frame.result.violations.empty()) << name << ": " << frame.result.violations.front().detail;
    EXPECT_EQ(frame.color, first_frame().color) << name;
    EXPECT_EQ(frame.result.work, first_frame().result.work) << name;
    EXPECT_EQ(first_difference(frame.result.trace, first_frame().result.trace), "") << name;
  };
  for (const std::uint32_t threads : {2u, 3u, 6u}) {
    expect_same("threads " + std::to_string(threads), [threads](sim::ChipOptions& chip) { chip.threads = threads; });
  }
  expect_same("late", [](sim::ChipOptions& chip) { chip.completion = sim::Completion::kLate; });
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    expect_same("seed " + std::to_string(seed), [seed](sim::ChipOptions& chip) {
      chip.completion = sim::Completion::kRandom;
      chip.seed = seed;
      chip.threads = seed % 2 == 0 ? 2 : 1;
    });
  }
}

// Lights are fetched in turns: what a tile fetches must not depend on the tile that its core had before.
TEST(EffectsDeterminism, MoreLightsThanAtHandAreFetchedAlikeByAnyCore) {
  const EffectsSubject subject(true);
  ASSERT_GT(subject.lights.size(), kLightsAtHand);
  const auto on_threads = [&](std::uint32_t threads) {
    return render(subject, [threads](FrameSettings&, sim::ChipOptions& chip) { chip.threads = threads; });
  };
  const EffectsFrame first = on_threads(1);
  ASSERT_EQ(first.result.status, Status::kOk);
  for (const std::uint32_t threads : {2u, 3u, 6u}) {
    const EffectsFrame frame = on_threads(threads);
    ASSERT_EQ(frame.result.status, Status::kOk) << threads;
    EXPECT_EQ(frame.color, first.color) << threads;
    EXPECT_EQ(frame.result.work, first.result.work) << threads;
    EXPECT_EQ(first_difference(frame.result.trace, first.result.trace), "") << threads;
  }
}

TEST(EffectsDeterminism, BuffersQueuesLanesAndStoresChangeNoPixel) {
  const auto expect_same = [](const std::string& name,
                              const std::function<void(FrameSettings&, sim::ChipOptions&)>& apply) {
    const EffectsFrame frame = render(apply);
    ASSERT_EQ(frame.result.status, Status::kOk) << name;
    EXPECT_TRUE(frame.result.violations.empty()) << name << ": " << frame.result.violations.front().detail;
    EXPECT_EQ(frame.color, first_frame().color) << name;
  };
  for (const std::uint32_t depth : {1u, 2u, 8u, 15u}) {
    expect_same("ray depth " + std::to_string(depth), [depth](FrameSettings& settings, sim::ChipOptions& chip) {
      settings.fetch_depth = depth;
      settings.output_depth = settings.macro_depth = settings.triangle_depth = depth == 1 ? 1 : 2;
      chip.completion = sim::Completion::kLate;
    });
  }
  for (const std::uint32_t depth : {1u, 2u}) {
    expect_same("queue " + std::to_string(depth),
                [depth](FrameSettings&, sim::ChipOptions& chip) { chip.limits.queue_depth = depth; });
  }
  expect_same("packets of 32", [](FrameSettings& settings, sim::ChipOptions& chip) {
    settings.techniques |= kUseSubpackets;
    chip.packet_width = 32;
  });
  expect_same("64 KB", [](FrameSettings& settings, sim::ChipOptions& chip) {
    settings.tile_width = 8;
    settings.fetch_depth = 2;
    chip.store = sim::StoreSize::k64KB;
    chip.packet_width = 0;
    chip.completion = sim::Completion::kLate;
  });
  for (const std::uint32_t lanes : {4u, 8u, 16u}) {
    if (lanes > sim::widest_lanes()) continue;
    expect_same("plain, lanes " + std::to_string(lanes), [lanes](FrameSettings&, sim::ChipOptions& chip) {
      chip.mode = sim::Mode::kPlain;
      chip.lanes = lanes;
      chip.threads = 2;
    });
  }
  if (sim::has_instrumented_mode()) {
    expect_same("instrumented", [](FrameSettings& settings, sim::ChipOptions& chip) {
      settings.fetch_depth = 8;
      chip.mode = sim::Mode::kInstrumented;
    });
  }
}

}  // namespace
}  // namespace gridiron::test
