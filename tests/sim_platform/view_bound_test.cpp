// The bound of a view's tiles: no tile of its frame exceeds it in any count, nor in cycles on any machine.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/build/grid/grid_builder.h>
#include <gridiron/frame/frame_setup.h>
#include <gridiron/sim/replay.h>
#include <gridiron/sim/sim_chip.h>
#include <gridiron/sim/trace_packing.h>
#include <gridiron/sim/view_bound.h>

#include "support/instrumented.h"
#include "support/ply_load.h"
#include "support/render_mesh.h"
#include "support/test_mesh.h"

namespace gridiron::test {
namespace {

constexpr std::uint32_t kMostPixels = 150;

// What one tile did.
struct TileCounts {
  std::array<std::uint64_t, kWorkKindCount> work{};
  std::uint64_t get_bytes = 0, put_bytes = 0;
};

TileCounts counts_of(const sim::TileTrace& tile) {
  TileCounts counts;
  const auto of = [&](WorkId kind) -> std::uint64_t& { return counts.work[kind.number()]; };
  sim::for_each_event(tile, [&](const sim::TraceEvent& event) {
    if (event.kind == sim::EventKind::kGet) {
      ++of(Work::kGetIssue);
      counts.get_bytes += event.bytes;
    } else if (event.kind == sim::EventKind::kPut) {
      ++of(Work::kPutIssue);
      counts.put_bytes += event.bytes;
    } else if (event.kind == sim::EventKind::kWait) {
      ++of(Work::kWait);
    } else if (event.kind == sim::EventKind::kWork) {
      for (const sim::WorkAmount& amount : event.work) {
        if (!sim::is_charged_as_event(amount.kind)) of(amount.kind) += amount.amount;
      }
    }
  });
  return counts;
}

// How a frame is rendered, but for its camera.
struct Way {
  const char* name;
  sim::StoreSize store = sim::StoreSize::k256KB;
  Accuracy accuracy = Accuracy::kStandard;
  Shading shading = Shading::kNone;
  bool has_ids = false;
  std::uint32_t output_depth = 2, fetch_depth = 3, queue_depth = 16;

  [[nodiscard]] bool is_small() const { return store == sim::StoreSize::k64KB; }
};
const Way kWays[] = {
    {.name = "standard"},
    {.name = "simple, ids, short queue", .shading = Shading::kSimple, .has_ids = true, .queue_depth = 2},
    {.name = "exact", .accuracy = Accuracy::kExact, .output_depth = 1, .fetch_depth = 1},
    {.name = "fast", .accuracy = Accuracy::kFast, .shading = Shading::kSimple, .fetch_depth = 8},
    {.name = "64 KB", .store = sim::StoreSize::k64KB},
    {.name = "64 KB, exact", .store = sim::StoreSize::k64KB, .accuracy = Accuracy::kExact, .shading = Shading::kSimple},
};

// A scene's image in simulated memory, with space for frames.
class ViewedScene {
 public:
  ViewedScene(const MeshView& mesh, std::uint32_t leaf_triangles) {
    GridParameters parameters;
    parameters.leaf_triangles = leaf_triangles;
    parameters.has_tree = true;
    parameters.has_grid = false;
    GridNeed need;
    EXPECT_EQ(count_scene_image(mesh, parameters, need), Status::kOk);
    memory_ = std::make_unique<sim::SimMemory>(need.image_bytes + (std::uint64_t{1} << 20));
    // Records that begin anywhere between two boundaries.
    (void)memory_->allocate(7 * kLineBytes);
    image_ = *memory_->allocate(need.image_bytes);
    std::vector<std::uint64_t> scratch(need.scratch_bytes / 8 + 1);
    EXPECT_EQ(build_scene_image(mesh, parameters, need, image_.bytes, std::as_writable_bytes(std::span(scratch))),
              Status::kOk);
    SceneImageError error;
    EXPECT_EQ(open_scene_image(image_.bytes, view_, error), Status::kOk);
    (void)memory_->allocate(kLineBytes);
    for (sim::MemoryRegion& plane : planes_)
      plane = *memory_->allocate(output_plane_bytes(kMostPixels, kMostPixels, 64));
    record_ = *memory_->allocate(sizeof(FrameRecord));
  }

  // @returns nothing where the camera is refused.
  [[nodiscard]] std::optional<FrameRecord> frame_of(const Way& way, const Camera& camera, std::uint32_t width,
                                                    std::uint32_t height, float t_far) {
    FrameSettings settings;
    settings.camera = camera;
    settings.width = width;
    settings.height = height;
    settings.tile_width = way.is_small() ? 16 : 64;
    settings.accuracy = way.accuracy;
    settings.shading = way.shading;
    settings.engine = EngineId::kTree;
    settings.output_depth = way.output_depth;
    settings.fetch_depth = way.fetch_depth;
    settings.t_far = t_far;
    settings.color = planes_[0].address;
    if (way.has_ids) settings.ids = planes_[1].address;
    FrameRecord record;
    if (make_frame_record(settings, view_, image_.address, record) != Status::kOk) return {};
    return record;
  }
  [[nodiscard]] std::vector<TileBound> bounds(const Way& way, const FrameRecord& record) const {
    EXPECT_TRUE(sim::has_view_bound(record, way.store));
    sim::ViewBound view({record, image_.bytes, way.store});
    std::vector<TileBound> bounds;
    for (std::uint32_t tile = 0; tile < record.tiles_x * record.tiles_y; ++tile) bounds.push_back(view.of(tile));
    return bounds;
  }
  [[nodiscard]] sim::FrameTrace render(const Way& way, const FrameRecord& record) {
    std::memcpy(record_.bytes.data(), &record, sizeof record);
    sim::ChipOptions chip;
    chip.store = way.store;
    chip.packet_width = 0;
    chip.limits.queue_depth = way.queue_depth;
    sim::ChipResult result = render_in_test(*memory_, record_.address, chip);
    EXPECT_EQ(result.status, Status::kOk);
    return std::move(result.trace);
  }

 private:
  std::unique_ptr<sim::SimMemory> memory_;
  sim::MemoryRegion image_{}, planes_[2], record_{};
  SceneImageView view_{};
};

std::string_view name_of(std::uint32_t kind) {
  return sim::work_kind(WorkId(kind), sim::kTreeEngine).name;
}

// The greatest of a frame: what it did and its bound.
struct Worst {
  double cycles = 0, most_cycles = 0;
  std::uint64_t gets = 0, most_gets = 0, bytes = 0, most_bytes = 0;
};

Worst expect_within(ViewedScene& scene, const Way& way, const FrameRecord& record, const std::string& name) {
  const std::vector<TileBound> bounds = scene.bounds(way, record);
  const sim::FrameTrace trace = scene.render(way, record);
  Worst worst;
  for (const sim::TileTrace& tile : trace.tiles) {
    const TileCounts counts = counts_of(tile);
    const TileBound& bound = bounds[tile.tile_id];
    for (std::uint32_t kind = 0; kind < sim::kTreeEngine.kind_count(); ++kind) {
      EXPECT_LE(counts.work[kind], bound.work[kind]) << name << ", tile " << tile.tile_id << ", " << name_of(kind);
    }
    EXPECT_LE(counts.get_bytes, bound.get_bytes) << name << ", tile " << tile.tile_id;
    EXPECT_LE(counts.put_bytes, bound.put_bytes) << name << ", tile " << tile.tile_id;
    worst.gets = std::max(worst.gets, counts.work[WorkId(Work::kGetIssue).number()]);
    worst.most_gets = std::max(worst.most_gets, bound[Work::kGetIssue]);
    worst.bytes = std::max(worst.bytes, counts.get_bytes);
    worst.most_bytes = std::max(worst.most_bytes, bound.get_bytes);
  }
  // A machine with few lines on their way, and most of the latency here and there.
  sim::MachineProfile slow = *sim::find_machine_profile("cell-ps3-tlb");
  slow.lines_in_flight = 3;
  slow.queue_depth = way.queue_depth;
  sim::MachineProfile usual = sim::machine_profiles().front();
  usual.queue_depth = way.queue_depth;
  for (const sim::MachineProfile& machine : {slow, usual}) {
    worst.cycles = worst.most_cycles = 0;
    const sim::FrameTiming timing = sim::replay(trace, machine, {.timeline = true});
    for (const sim::TimelineSpan& span : timing.timeline) {
      if (span.kind != sim::TimelineSpan::Kind::kTile) continue;
      const double cycles = span.end_cycles - span.begin_cycles;
      const double most = sim::view_tile_cycles(bounds[span.tile_id], machine, way.output_depth).total();
      EXPECT_LE(cycles, most) << name << ", tile " << span.tile_id << ", " << machine.name;
      worst.cycles = std::max(worst.cycles, cycles);
      worst.most_cycles = std::max(worst.most_cycles, most);
    }
  }
  return worst;
}

// Inside, outside and far away; close to a corner; along an axis, so that walls are seen along their planes; with
// narrow and wide views.
Camera any_camera(const TestMesh& mesh, TestRandom& random) {
  const auto coordinate = [&] { return random.between(-1.0f, 1.0f); };
  const auto corner = [&] { return mesh.vertices[random.below(static_cast<std::uint32_t>(mesh.vertices.size()))]; };
  Camera camera;
  camera.up = {0.1f, 1, 0.2f};
  camera.at = 0.5f * Vec3(coordinate(), coordinate(), coordinate());
  camera.tan_half_fov = std::pow(10.0f, random.between(-2.5f, 1.0f));
  switch (random.below(6)) {
    case 0:
      camera.eye = corner() + std::pow(10.0f, random.between(-6.0f, -1.0f)) * Vec3(coordinate(), coordinate(), 1);
      break;
    case 1:
      camera.eye = corner();
      camera.at = corner() + 0.25f * Vec3(1, 1, 0);
      break;
    case 2:
      camera.eye = Vec3(0, 0, random.between(1.0f, 4.0f));
      camera.at = Vec3(0);
      camera.up = {0, 1, 0};
      break;
    case 3:
      camera.eye = random.between(2.0f, 60.0f) * Vec3(coordinate(), coordinate(), coordinate());
      break;
    default:
      camera.eye = random.between(0.0f, 1.5f) * Vec3(coordinate(), coordinate(), coordinate());
      camera.tan_half_fov = std::pow(10.0f, random.between(-1.0f, 0.5f));
  }
  return camera;
}

struct NamedMesh {
  const char* name;
  TestMesh mesh;
};

// Surfaces with and without gaps, one on another, through one another; triangles of all sizes; walls across the axes.
std::vector<NamedMesh> make_meshes() {
  std::vector<NamedMesh> meshes;
  meshes.push_back({"mixed", make_mixed_mesh()});
  meshes.push_back(
      {"two skins", joined(make_torus(40, 24, 0.8f, 0.35f), moved(make_torus(40, 24, 0.8f, 0.35f), 1.000001f))});
  meshes.push_back({"soup", make_random_soup(400, 0.7f, 5)});
  meshes.push_back({"fan", joined(make_sliver_fan(300, 1e-4f), make_height_field(24, 0.2f, 3))});
  TestMesh boxes = make_box(Vec3(-1), Vec3(1));
  for (int i = 0; i < 6; ++i) {
    const float low = 0.25f * static_cast<float>(i) - 0.9f;
    boxes.append(make_box(Vec3(low, -1, low), Vec3(low + 0.4f, -0.5f, low + 0.25f)));
  }
  meshes.push_back({"boxes", boxes});
  TestMesh far = moved(make_sphere(24, 40, 0.9f), 1.0f, Vec3(0));
  far.append(moved(make_sphere(60, 80, 0.02f), 1.0f, Vec3(0.3f, 0.2f, 0.95f)));
  meshes.push_back({"spheres", far});
  return meshes;
}

TEST(ViewBound, NoTileOfAnyFrameExceedsIt) {
  std::uint64_t seed = 1;
  std::uint32_t frames = 0;
  for (const NamedMesh& named : make_meshes()) {
    for (const Way& way : kWays) {
      ViewedScene scene(named.mesh.view(), way.is_small() ? 8 : 16);
      TestRandom random(seed);
      for (std::uint32_t i = 0; i < 10; ++i) {
        const Camera camera = any_camera(named.mesh, random);
        const std::uint32_t width = 1 + random.below(kMostPixels), height = 1 + random.below(kMostPixels);
        const float t_far = random.below(4) == 0 ? random.between(0.5f, 3.0f) : kFloatMax;
        const auto record = scene.frame_of(way, camera, width, height, t_far);
        if (!record) continue;
        ++frames;
        (void)expect_within(scene, way, *record,
                            std::string(named.name) + ", " + way.name + ", seed " + std::to_string(seed) + ", frame " +
                                std::to_string(i));
        if (HasFailure()) return;
      }
      ++seed;
    }
  }
  EXPECT_GT(frames, 300u);
}

// Where exact arithmetic decides every pixel.
TEST(ViewBound, HoldsWhereNoFloatIsTrusted) {
  const TestMesh mesh = joined(make_box(Vec3(-1), Vec3(1)), make_sphere(6, 8, 0.5f));
  for (const Way& way : kWays) {
    ViewedScene scene(mesh.view(), way.is_small() ? 8 : 16);
    Camera camera;
    camera.eye = {0, 0, 3};
    camera.at = {0, 0.2f, 0};
    camera.tan_half_fov = 1e-5f;
    const auto record = scene.frame_of(way, camera, 20, 18, kFloatMax);
    ASSERT_TRUE(record);
    (void)expect_within(scene, way, *record, way.name);
  }
}

// Hits as far away as hits may be: exact distances decide which of them count.
TEST(ViewBound, HoldsAtTheFarthestDistance) {
  TestMesh wall;
  for (int i = 0; i < 64; ++i) {
    const float x = 0.25f * static_cast<float>(i % 8) - 1.0f, y = 0.25f * static_cast<float>(i / 8) - 1.0f;
    wall.append(make_triangle(Vec3(x, y, 0), Vec3(x + 0.25f, y, 0), Vec3(x, y + 0.25f, 0)));
  }
  for (const Way& way : kWays) {
    ViewedScene scene(wall.view(), way.is_small() ? 8 : 16);
    // A ray's t is that of the plane.
    const auto record = scene.frame_of(way, {{0, 0, 2.3f}, {0, 0, 0}, {0, 1, 0}, 0.4f}, 70, 50, 2.3f);
    ASSERT_TRUE(record);
    (void)expect_within(scene, way, *record, way.name);
  }
}

// The bound is of use: of frames that fill the picture, at most ten times what the worst tile does.
TEST(ViewBound, IsWithinTenTimesTheWorstTile) {
  const NamedMesh scenes[] = {{"mixed", make_mixed_mesh()},
                              {"torus", make_torus(60, 30, 0.8f, 0.35f)},
                              {"hills", make_height_field(70, 0.3f, 2)}};
  const Camera cameras[] = {{{0.3f, 0.9f, 2.0f}, {0, 0, 0}, {0, 1, 0}, 0.45f},
                            {{0.9f, 0.8f, 0.7f}, {0, 0, 0}, {0, 1, 0}, 0.5f}};
  for (const NamedMesh& named : scenes) {
    for (const Way* const way : {&kWays[0], &kWays[4]}) {
      ViewedScene scene(named.mesh.view(), way->is_small() ? 8 : 16);
      for (const Camera& camera : cameras) {
        const auto record = scene.frame_of(*way, camera, kMostPixels, kMostPixels, kFloatMax);
        ASSERT_TRUE(record);
        const Worst worst = expect_within(scene, *way, *record, named.name);
        EXPECT_LE(worst.most_cycles, 10 * worst.cycles) << named.name << ", " << way->name;
        EXPECT_LE(worst.most_gets, 10 * worst.gets) << named.name << ", " << way->name;
        EXPECT_LE(worst.most_bytes, 10 * worst.bytes) << named.name << ", " << way->name;
      }
    }
  }
}

TEST(ViewBound, IsForEyeRaysThroughTheTreeAlone) {
  FrameHead head{};
  head.engine_id = static_cast<std::uint32_t>(EngineId::kTree);
  head.tile_width = 64;
  EXPECT_TRUE(sim::has_view_bound(head, sim::StoreSize::k256KB));
  EXPECT_FALSE(sim::has_view_bound(head, sim::StoreSize::k64KB));
  const auto with = [&](auto change) {
    FrameHead changed = head;
    change(changed);
    return sim::has_view_bound(changed, sim::StoreSize::k256KB);
  };
  EXPECT_FALSE(with([](FrameHead& frame) { frame.engine_id = static_cast<std::uint32_t>(EngineId::kGrid); }));
  EXPECT_FALSE(with([](FrameHead& frame) { frame.depth_address = 4096; }));
  EXPECT_FALSE(with([](FrameHead& frame) { frame.shading = static_cast<std::uint32_t>(Shading::kScene); }));
  EXPECT_FALSE(with([](FrameHead& frame) { frame.accuracy = static_cast<std::uint32_t>(Accuracy::kCompact); }));
  EXPECT_FALSE(with([](FrameHead& frame) { frame.tile_width = 32; }));
}

}  // namespace
}  // namespace gridiron::test
