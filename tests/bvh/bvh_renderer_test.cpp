// The cached BVH's frames: the grid's pixels, no broken rule, the same figures every time.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/bvh/bvh_core.h>
#include <gridiron/bvh/bvh_engine_work.h>
#include <gridiron/bvh/bvh_renderer.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <numeric>

#include "support/no_threads.h"
#include "support/render_mesh.h"
#include "support/test_mesh.h"
#include "support/views.h"

namespace gridiron::bvh {
namespace {

const sim::MachineProfile& ps3() {
  return *sim::find_machine_profile("cell-ps3");
}

FrameSettings settings_of(const Camera& camera, std::uint32_t width, std::uint32_t height) {
  return {.camera = camera, .width = width, .height = height};
}

using test::make_mixed_mesh;

Bvh bvh_of(const test::TestMesh& mesh) {
  Bvh bvh;
  EXPECT_EQ(build_bvh(mesh.view(), {}, bvh), Status::kOk);
  return bvh;
}

const Camera kMixedCamera = {{1.2f, 1.5f, 2.5f}, {0, 0, 0}, {0, 1, 0}, 0.5f};

template <class Element>
bool same_bits(const std::vector<Element>& a, const std::vector<Element>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(Element)) == 0);
}

double wait_cycles(const sim::FrameTiming& timing) {
  double sum = 0;
  for (const sim::CoreTiming& core : timing.cores) {
    for (const double wait : core.dma_wait_cycles) sum += wait;
  }
  return sum;
}

/// One mesh, its hierarchy, and the grid kernel's picture of it.
struct Scene {
  test::TestMesh mesh;
  FrameSettings settings;
  BvhParameters parameters = {};
  Bvh bvh = {};
  test::RenderedFrame expected = {};

  void prepare() {
    ASSERT_EQ(build_bvh(mesh.view(), parameters, bvh), Status::kOk);
    test::SceneInMemory scene(mesh.view(), GridParameters{});
    ASSERT_EQ(scene.status(), Status::kOk);
    expected = scene.render(settings, {});
    ASSERT_EQ(expected.result.status, Status::kOk);
  }
  // With the planes of depth and ids, and without.
  void expect_same_picture(RenderOptions options, const std::string& name) const {
    for (const bool all_planes : {true, false}) {
      SCOPED_TRACE(name + (all_planes ? ", all planes" : ", colour alone"));
      options.all_planes = all_planes;
      const BvhFrame frame = render_bvh_frame(bvh, settings, ps3(), options);
      ASSERT_EQ(frame.status, Status::kOk);
      EXPECT_TRUE(frame.violations.empty()) << frame.violations.front().detail;
      EXPECT_TRUE(same_bits(frame.picture.color, expected.planes.color));
      EXPECT_TRUE(same_bits(frame.picture.depth, all_planes ? expected.planes.depth : std::vector<float>{}));
      EXPECT_TRUE(same_bits(frame.picture.ids, all_planes ? expected.planes.ids : std::vector<std::uint32_t>{}));
    }
  }
};

TEST(BvhRenderer, PicturesAreTheGridsBitForBit) {
  test::TestMesh far_away = test::make_torus(30, 20, 1, 0.4f);
  far_away.transform(1.0f, {1000, -2000, 500});
  test::TestMesh room = test::make_box({-3, -3, -3}, {3, 3, 3});
  room.append(test::make_random_soup(500, 0.8f, 11));
  test::TestMesh tiny = test::make_sphere(12, 16, 1);
  tiny.transform(1e-12f, {});
  test::TestMesh duplicates = test::make_height_field(12, 0.3f, 2);
  duplicates.append(test::TestMesh(duplicates));
  const auto framed = [](const test::TestMesh& mesh, std::uint32_t width, std::uint32_t height) {
    return Scene{mesh, settings_of(test::framed_camera(mesh.view()), width, height)};
  };
  Scene scenes[] = {
      {make_mixed_mesh(), settings_of(kMixedCamera, 150, 110)},
      framed(far_away, 96, 70),
      framed(tiny, 64, 64),
      framed(duplicates, 97, 33),
      framed(test::make_sliver_fan(200, 1e-4f), 128, 128),
      framed(test::make_triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), 33, 65),
      {room, settings_of({{0.1f, 0.2f, 0.3f}, {1, 0.5f, -2}, {0, 1, 0}, 1.0f}, 128, 96)},
      // Rays along the axes, in a room whose walls they meet at right angles.
      {room, settings_of({{0, 0, 0}, {0, 0, -1}, {0, 1, 0}, 0.7f}, 97, 97)},
  };
  for (Scene& scene : scenes) {
    ASSERT_NO_FATAL_FAILURE(scene.prepare());
    const std::string name = "scene " + std::to_string(&scene - scenes);
    for (const std::uint32_t packet_width : {8u, 16u, 32u}) {
      for (const bool hyper_threading : {false, true}) {
        if (hyper_threading && ring_of(packet_width) == 1) continue;
        for (const bool use_subpackets : {false, true}) {
          scene.expect_same_picture(
              {.hyper_threading = hyper_threading, .packet_width = packet_width, .use_subpackets = use_subpackets},
              name + ", packets of " + std::to_string(packet_width));
        }
      }
    }
  }
}

TEST(BvhRenderer, PicturesOfRandomSoupsAreTheGridsBitForBit) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    test::TestRandom random(seed);
    const float extent = seed % 2 == 0 ? 0.02f : 0.6f;
    const Camera camera = {{random.between(-3, 3), random.between(-3, 3), random.between(-3, 3)},
                           {random.between(-0.5f, 0.5f), random.between(-0.5f, 0.5f), random.between(-0.5f, 0.5f)},
                           {0.1f, 1, 0.2f},
                           random.between(0.1f, 1.0f)};
    Scene scene{test::make_random_soup(1 + random.below(1500), extent, seed), settings_of(camera, 90, 60)};
    scene.parameters.leaf_triangles = 1 + random.below(kMaxLeafTriangles);
    scene.parameters.line_triangles = std::max(8u << random.below(3), std::bit_ceil(scene.parameters.leaf_triangles));
    ASSERT_NO_FATAL_FAILURE(scene.prepare());
    RenderOptions options;
    options.packet_width = 8u << seed % 3;
    options.hyper_threading = options.packet_width < kTileWidth;
    options.ring_size = 2 + random.below(kMaxRing - 1);
    options.completion = static_cast<sim::Completion>(random.below(3));
    options.seed = seed;
    scene.expect_same_picture(options, "seed " + std::to_string(seed));
  }
}

// The smallest caches that there are: every set is fought for, and packets of the ring evict each other's lines.
TEST(BvhRenderer, FourLinesOfEachCacheAreEnough) {
  Scene scene{make_mixed_mesh(), settings_of(kMixedCamera, 150, 110)};
  scene.parameters.line_nodes = 1;
  scene.parameters.line_triangles = kMaxLineTriangles;
  ASSERT_NO_FATAL_FAILURE(scene.prepare());
  RenderOptions options;
  options.caches = {.node_lines = 4, .triangle_lines = 4};
  for (const sim::Completion completion : {sim::Completion::kEarly, sim::Completion::kLate, sim::Completion::kRandom}) {
    options.completion = completion;
    for (const std::uint32_t ring_size : {2u, 3u, 4u}) {
      options.ring_size = ring_size;
      scene.expect_same_picture(options, "ring of " + std::to_string(ring_size));
    }
    options.hyper_threading = false;
    scene.expect_same_picture(options, "no ring");
    options.hyper_threading = true;
  }
}

TEST(BvhRenderer, FiguresAreTheSameInEveryRun) {
  const Bvh bvh = bvh_of(make_mixed_mesh());
  for (const sim::MachineProfile& machine : sim::machine_profiles()) {
    if (machine.local_store_bytes < 256u << 10) continue;  // its store does not hold the caches
    RenderOptions options;
    const BvhFrame first = render_bvh_frame(bvh, settings_of(kMixedCamera, 320, 200), machine, options);
    ASSERT_EQ(first.status, Status::kOk);
    for (int run = 0; run < 5; ++run) {
      options.completion = static_cast<sim::Completion>(run % 3);
      options.seed = static_cast<std::uint64_t>(run);
      const BvhFrame again = render_bvh_frame(bvh, settings_of(kMixedCamera, 320, 200), machine, options);
      ASSERT_EQ(again.status, Status::kOk);
      EXPECT_EQ(again.timing.frame_cycles, first.timing.frame_cycles) << machine.name;
      EXPECT_EQ(again.core_of_tile, first.core_of_tile) << machine.name;
      EXPECT_EQ(again.work, first.work) << machine.name;
      EXPECT_EQ(again.node_cache.misses, first.node_cache.misses) << machine.name;
      EXPECT_EQ(again.triangle_cache.misses, first.triangle_cache.misses) << machine.name;
      for (std::size_t core = 0; core < first.timing.cores.size(); ++core) {
        EXPECT_EQ(again.timing.cores[core].compute_cycles, first.timing.cores[core].compute_cycles) << core;
        EXPECT_EQ(again.timing.cores[core].bytes_in, first.timing.cores[core].bytes_in) << core;
      }
    }
  }
}

// A claim that takes far longer than any tile's work deals the tiles out evenly.
TEST(BvhRenderer, ClaimLatencyCountsInTheOrderOfClaims) {
  const Bvh bvh = bvh_of(make_mixed_mesh());
  sim::MachineProfile machine = ps3();
  machine.claim_cycles = 1 << 20;
  for (double& cycles : machine.work_cycles) cycles /= 100;
  const BvhFrame frame = render_bvh_frame(bvh, settings_of(kMixedCamera, 320, 320), machine, RenderOptions{});
  ASSERT_EQ(frame.status, Status::kOk);
  for (const sim::CoreTiming& core : frame.timing.cores) {
    EXPECT_GE(core.tiles, 100 / machine.core_count);
    EXPECT_LE(core.tiles, 100 / machine.core_count + 1);
  }
}

TEST(BvhRenderer, HyperThreadingWaitsLess) {
  const test::TestMesh mesh = test::make_height_field(120, 0.3f, 6);
  const Bvh bvh = bvh_of(mesh);
  const FrameSettings settings = settings_of(test::framed_camera(mesh.view()), 320, 320);
  const BvhFrame with = render_bvh_frame(bvh, settings, ps3(), {});
  const BvhFrame without = render_bvh_frame(bvh, settings, ps3(), {.hyper_threading = false});
  ASSERT_EQ(with.status, Status::kOk);
  ASSERT_EQ(without.status, Status::kOk);
  EXPECT_TRUE(same_bits(with.picture.color, without.picture.color));
  EXPECT_LT(wait_cycles(with.timing), 0.5 * wait_cycles(without.timing));
  EXPECT_LT(with.timing.frame_cycles, without.timing.frame_cycles);
  const auto switches = static_cast<std::size_t>(BvhWork::kSwitch);
  EXPECT_GT(with.work[switches], 0u);
  EXPECT_EQ(without.work[switches], 0u);
  EXPECT_EQ(without.node_cache.pending_hits, 0u);
}

TEST(BvhRenderer, FiguresAddUp) {
  const Bvh bvh = bvh_of(make_mixed_mesh());
  const BvhFrame frame = render_bvh_frame(bvh, settings_of(kMixedCamera, 320, 200), ps3(), {});
  ASSERT_EQ(frame.status, Status::kOk);
  // Every tile on one core, as often as the replay says.
  ASSERT_EQ(frame.core_of_tile.size(), 70u);
  std::vector<std::uint32_t> tiles(6);
  for (const std::uint32_t core : frame.core_of_tile) ++tiles.at(core);
  double compute = 0, init = 0, charged = 0;
  std::uint64_t gets = 0;
  for (std::size_t core = 0; core < 6; ++core) {
    const sim::CoreTiming& timing = frame.timing.cores.at(core);
    EXPECT_EQ(timing.tiles, tiles[core]) << core;
    const double waits = std::accumulate(std::begin(timing.dma_wait_cycles), std::end(timing.dma_wait_cycles), 0.0);
    EXPECT_EQ(timing.init_cycles + timing.compute_cycles + waits + timing.idle_cycles, frame.timing.frame_cycles);
    compute += timing.compute_cycles;
    init += timing.init_cycles;
    gets += timing.gets;
  }
  // Cycles are work times its price in 1/1024, core's by the profile and the BVH's by its own table, and commands and
  // waits.
  const auto prices = sim::work_prices(ps3(), kBvhEngine);
  for (std::size_t kind = 0; kind < kWorkKindCount; ++kind) {
    charged += static_cast<double>(frame.work[kind]) * std::round(prices[kind] * 1024) / 1024;
  }
  const auto work = [&](WorkId kind) { return static_cast<double>(frame.work[kind.number()]); };
  charged += ps3().issue_cycles * (work(Work::kGetIssue) + work(Work::kPutIssue));
  charged += ps3().wait_cycles * work(Work::kWait);
  // Outside of tiles a core gets its frame record, waits for it, and at the end for both output buffers.
  EXPECT_EQ(compute + init, charged + 6 * (ps3().issue_cycles + 3 * ps3().wait_cycles));
  EXPECT_EQ(gets, frame.work[static_cast<std::size_t>(Work::kGetIssue)] + 6);
  // Work of the caches.
  const auto bvh_work = [&](BvhWork kind) { return frame.work[static_cast<std::size_t>(kind)]; };
  EXPECT_EQ(bvh_work(BvhWork::kCacheLookup), frame.node_cache.lookups + frame.triangle_cache.lookups);
  EXPECT_EQ(bvh_work(BvhWork::kMiss), frame.node_cache.misses + frame.node_cache.pending_hits +
                                          frame.triangle_cache.misses + frame.triangle_cache.pending_hits);
  EXPECT_EQ(bvh_work(BvhWork::kSwitch), bvh_work(BvhWork::kMiss));
  for (const CacheCounts& cache : {frame.node_cache, frame.triangle_cache}) {
    EXPECT_EQ(cache.lookups, cache.hits + cache.pending_hits + cache.misses);
    EXPECT_GT(cache.hit_rate(), 0.3);
  }
}

TEST(BvhRenderer, StopsWhenAsked) {
  const test::TestMesh mesh = make_mixed_mesh();
  Bvh bvh;
  std::atomic<bool> abort{false};
  ASSERT_EQ(build_bvh(mesh.view(), {}, bvh, &abort), Status::kOk);
  const RenderOptions options{.abort = &abort};
  EXPECT_EQ(render_bvh_frame(bvh, settings_of(kMixedCamera, 96, 96), ps3(), options).status, Status::kOk);
  abort = true;
  const BvhFrame frame = render_bvh_frame(bvh, settings_of(kMixedCamera, 96, 96), ps3(), options);
  EXPECT_EQ(frame.status, Status::kAborted);
  EXPECT_TRUE(frame.violations.empty());
  EXPECT_TRUE(frame.picture.color.empty());
  EXPECT_EQ(build_bvh(mesh.view(), {}, bvh, &abort), Status::kAborted);
}

TEST(BvhRenderer, RefusesWhatItCannotRender) {
  const test::TestMesh mesh = test::make_sphere(8, 8, 1);
  const Bvh bvh = bvh_of(mesh);
  const FrameSettings good = settings_of(test::framed_camera(mesh.view()), 64, 64);
  const auto status_of = [&](const FrameSettings& settings, const RenderOptions& options) {
    return render_bvh_frame(bvh, settings, ps3(), options).status;
  };
  EXPECT_EQ(status_of(good, {}), Status::kOk);
  FrameSettings settings = good;
  settings.accuracy = Accuracy::kPaper;
  EXPECT_EQ(status_of(settings, {}), Status::kUnsupportedFrame);
  settings = good;
  settings.width = 0;
  EXPECT_EQ(status_of(settings, {}), Status::kBadFrame);
  settings = good;
  settings.camera.at = settings.camera.eye;
  EXPECT_EQ(status_of(settings, {}), Status::kBadFrame);
  for (const std::uint32_t ring_size : {0u, 1u, ring_of(16) + 1}) {
    EXPECT_EQ(status_of(good, {.ring_size = ring_size}), Status::kBadParameter) << ring_size;
  }
  EXPECT_EQ(status_of(good, {.ring_size = ring_of(8), .packet_width = 8}), Status::kOk);
  EXPECT_EQ(status_of(good, {.ring_size = ring_of(8) + 1, .packet_width = 8}), Status::kBadParameter);
  EXPECT_EQ(status_of(good, {.ring_size = 2, .packet_width = 32}), Status::kBadParameter);
  EXPECT_EQ(status_of(good, {.hyper_threading = false, .packet_width = 32}), Status::kOk);
  for (const std::uint32_t width : {0u, 4u, 12u, 64u}) {
    EXPECT_EQ(status_of(good, {.packet_width = width}), Status::kBadParameter) << width;
  }
  for (const std::uint32_t lines : {0u, 2u, 6u, 24u, 64u, 1024u}) {
    EXPECT_EQ(status_of(good, {.caches = {.node_lines = lines}}), Status::kBadParameter) << lines;
  }
  for (const std::uint32_t lines : {0u, 2u, 12u, 128u}) {
    EXPECT_EQ(status_of(good, {.caches = {.triangle_lines = lines}}), Status::kBadParameter) << lines;
  }
  Bvh odd;
  ASSERT_EQ(build_bvh(mesh.view(), {.line_triangles = 24}, odd), Status::kOk);
  EXPECT_EQ(render_bvh_frame(odd, good, ps3(), {}).status, Status::kBadParameter);
  sim::MachineProfile small = ps3();
  small.local_store_bytes = 64 * 1024;
  EXPECT_EQ(render_bvh_frame(bvh, good, small, {}).status, Status::kUnsupportedFrame);
  small = ps3();
  small.main_memory_bytes = 16 * 1024;
  EXPECT_EQ(render_bvh_frame(bvh, good, small, {}).status, Status::kMemoryTooSmall);
}

TEST(BvhRenderer, StoreMapCoversTheStore) {
  std::size_t end = 0;
  std::size_t regions = 0;
  for_each_region<BvhStore::Layout>([&](std::string_view, std::size_t offset, std::size_t bytes) {
    EXPECT_GE(offset, end);
    EXPECT_LT(offset - end, 128u);
    end = offset + bytes;
    ++regions;
  });
  EXPECT_EQ(regions, 7u);
  EXPECT_EQ(end, sizeof(BvhStore));
}

TEST(BvhRenderer, CoresThatWaitForOneAnotherNeedAThreadEach) {
  Scene scene{make_mixed_mesh(), settings_of(kMixedCamera, 64, 64)};
  scene.prepare();
  BvhFrame frame;
  {
    const test::NoThreads no_threads;
    frame = render_bvh_frame(scene.bvh, scene.settings, ps3(), {});
    EXPECT_EQ(frame.status, Status::kAborted);
    EXPECT_EQ(frame.host_shortage, sim::HostShortage::kThreads);
    // One core is the caller's thread.
    EXPECT_EQ(render_bvh_frame(scene.bvh, scene.settings, ps3(), {.core_count = 1}).status, Status::kOk);
  }
  frame = render_bvh_frame(scene.bvh, scene.settings, ps3(), {});
  EXPECT_EQ(frame.status, Status::kOk);
  EXPECT_EQ(frame.host_shortage, sim::HostShortage::kNone);
}

}  // namespace
}  // namespace gridiron::bvh
