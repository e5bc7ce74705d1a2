// Macrocell walk and cell walk together, against the cells that exact arithmetic says the rays touch.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/engine/grid/slice_walk.h>

#include "core/engine/grid/frustum_cases.h"
#include "core/engine/grid/reach_of.h"
#include "core/engine/grid/table_cases.h"
#include "core/ray/exact_ray.h"
#include "core/seeds.h"
#include "support/test_mesh.h"

namespace gridiron::test {
namespace {

WorkCounters pass_work;  // of take_pass, of no interest here

using SmallPacket = Packet<4>;
using Window = MacroTableWindow<16>;  // one chunk: the walk is interrupted wherever it can be
constexpr std::uint32_t kRays = SmallPacket::kRayCount;

// A grid whose cells all hold a triangle, so that every cell looked at shows; in occupied macrocells.
struct WalkScene {
  GridRecord grid;
  TableCase table;

  WalkScene(TestRandom& random, std::uint32_t percent_occupied)
      : grid(random_grid(random, 40, 1 + random.below(kMaxMacroWidth))),
        table(random, grid.macro_cell_count[0] * grid.macro_cell_count[1] * grid.macro_cell_count[2],
              percent_occupied) {}

  [[nodiscard]] std::uint32_t cell_id(const std::uint32_t cell[3]) const {
    return (cell[2] * grid.cell_count[1] + cell[1]) * grid.cell_count[0] + cell[0];
  }
  [[nodiscard]] std::uint32_t macro_cell_of(const std::uint32_t cell[3]) const {
    const std::uint32_t m = grid.macro_width;
    return (cell[2] / m * grid.macro_cell_count[1] + cell[1] / m) * grid.macro_cell_count[0] + cell[0] / m;
  }
  // The cell block of a macrocell: cell i's first_triangle is the cell's id in the grid.
  [[nodiscard]] std::vector<CellRecord> block(std::uint32_t macro_cell) const {
    const std::uint32_t m = grid.macro_width;
    std::vector<CellRecord> cells(m * m * m);
    if (table.block_of[macro_cell] == 0) return cells;
    const std::uint32_t corner[3] = {macro_cell % grid.macro_cell_count[0] * m,
                                     macro_cell / grid.macro_cell_count[0] % grid.macro_cell_count[1] * m,
                                     macro_cell / grid.macro_cell_count[0] / grid.macro_cell_count[1] * m};
    for (std::uint32_t i = 0; i < cells.size(); ++i) {
      const std::uint32_t cell[3] = {corner[0] + i % m, corner[1] + i / m % m, corner[2] + i / m / m};
      const bool inside = cell[0] < grid.cell_count[0] && cell[1] < grid.cell_count[1] && cell[2] < grid.cell_count[2];
      // Beyond the grid's end stands what no walk may find.
      cells[i] = {inside ? cell_id(cell) : 0xDEADBEEFu, 1};
    }
    return cells;
  }
};

struct Visited {
  std::vector<std::uint32_t> cells;        ///< in order
  std::vector<float> entries;              ///< of each
  std::vector<std::uint32_t> macro_cells;  ///< in order
  std::uint32_t chunks = 0;                ///< fetched
};

// Takes a frustum through the scene. What the macrocell walk found is known by its place, so that macrocells whose
// block is the empty one can be told apart.
void walk(const WalkScene& scene, const Frustum& frustum, float reach, bool skip_empty, Visited& visited) {
  Window window;
  window.forget();
  MacroWalk macro_walk{};
  macro_walk.begin(scene.grid, frustum);
  WorkCounters work;
  MacroVisit visit{};
  const std::uint32_t stride[3] = {1, scene.grid.macro_cell_count[0],
                                   scene.grid.macro_cell_count[0] * scene.grid.macro_cell_count[1]};
  const std::uint64_t steps = std::uint64_t{2} * scene.table.block_of.size() + 2;
  for (std::uint64_t step = 0;; ++step) {
    ASSERT_LE(step, steps) << "the walk does not end";
    const WalkStep answer = macro_walk.next(frustum, window, reach, skip_empty, visit, work);
    if (answer == WalkStep::kDone) break;
    if (answer == WalkStep::kNeedsChunk) {
      ++visited.chunks;
      load_chunk(scene.table, macro_walk.needed_chunk(), window);
      continue;
    }
    const std::uint32_t m = scene.grid.macro_width;
    const std::uint32_t macro_cell = static_cast<std::uint32_t>(visit.k_first) / m * stride[frustum.axis_k] +
                                     static_cast<std::uint32_t>(visit.u_first) / m * stride[frustum.axis_u] +
                                     static_cast<std::uint32_t>(visit.v_first) / m * stride[frustum.axis_v];
    ASSERT_LT(macro_cell, scene.table.block_of.size());
    ASSERT_EQ(visit.block, scene.table.block_of[macro_cell]);
    visited.macro_cells.push_back(macro_cell);
    const std::vector<CellRecord> cells = scene.block(macro_cell);
    CellWalk cell_walk{};
    cell_walk.begin(scene.grid, frustum, visit);
    CellVisit found{};
    for (std::size_t i = 0; cell_walk.next(frustum, cells.data(), reach, found, work); ++i) {
      ASSERT_LT(i, cells.size()) << "the cell walk does not end";
      ASSERT_EQ(found.triangle_count, 1u);
      visited.cells.push_back(found.first_triangle);
      visited.entries.push_back(found.entry);
    }
  }
  ASSERT_EQ(work[GridWork::kCellVisit], visited.cells.size());
}

std::uint32_t axis_of_cell(const GridRecord& grid, std::uint32_t cell, std::uint32_t axis) {
  const std::uint32_t coordinates[3] = {cell % grid.cell_count[0], cell / grid.cell_count[0] % grid.cell_count[1],
                                        cell / grid.cell_count[0] / grid.cell_count[1]};
  return coordinates[axis];
}

// One pass of a packet through a scene, with all that is promised of it.
void check_pass(const WalkScene& scene, const SmallPacket& packet, const Frustum& frustum, float reach,
                std::uint64_t& touched_count) {
  const GridRecord& grid = scene.grid;
  Visited all, some;
  walk(scene, frustum, reach, false, all);
  walk(scene, frustum, reach, true, some);
  if (testing::Test::HasFatalFailure()) return;
  // 1. Skipping empty macrocells changes nothing but what is skipped.
  ASSERT_EQ(some.cells, all.cells);
  for (const std::uint32_t macro_cell : some.macro_cells) ASSERT_NE(scene.table.block_of[macro_cell], 0u);
  std::vector<std::uint32_t> occupied;
  for (const std::uint32_t macro_cell : all.macro_cells) {
    if (scene.table.block_of[macro_cell] != 0) occupied.push_back(macro_cell);
  }
  ASSERT_EQ(some.macro_cells, occupied);
  // 2. Each cell once; cells of the grid only; front to back inside a macrocell, macro slices front to back.
  const std::set<std::uint32_t> cells(all.cells.begin(), all.cells.end());
  ASSERT_EQ(cells.size(), all.cells.size()) << "a cell was visited twice";
  const std::uint32_t cell_total = grid.cell_count[0] * grid.cell_count[1] * grid.cell_count[2];
  std::int64_t last_macro_slice = frustum.reverse ? 1 << 20 : -1;
  std::int64_t last_slice = last_macro_slice;
  std::uint32_t last_macro_cell = ~0u;
  for (std::size_t i = 0; i < all.cells.size(); ++i) {
    ASSERT_LT(all.cells[i], cell_total);
    const std::uint32_t c[3] = {axis_of_cell(grid, all.cells[i], 0), axis_of_cell(grid, all.cells[i], 1),
                                axis_of_cell(grid, all.cells[i], 2)};
    const std::int64_t slice = c[frustum.axis_k];
    const std::int64_t macro_slice = slice / grid.macro_width;
    const std::uint32_t macro_cell = scene.macro_cell_of(c);
    if (macro_cell == last_macro_cell) {
      ASSERT_TRUE(frustum.reverse ? slice <= last_slice : slice >= last_slice) << "slices out of order";
    }
    ASSERT_TRUE(frustum.reverse ? macro_slice <= last_macro_slice : macro_slice >= last_macro_slice);
    last_slice = slice;
    last_macro_slice = macro_slice;
    last_macro_cell = macro_cell;
    const auto k = static_cast<std::int32_t>(slice);
    ASSERT_EQ(all.entries[i], frustum.slab_of(k, k).entry);
  }
  // 3. Every cell that a ray touches before its hit was visited.
  for (std::uint32_t ray = 0; ray < kRays; ++ray) {
    if (!packet.active.contains(ray)) continue;
    const ExactRay truth(grid, packet, ray);
    for (std::int32_t k = 0; k < frustum.cells_k; ++k) {
      const auto box = truth.box_between(frustum.axis_k, k, k);
      if (!box || !truth.reaches(frustum.axis_k, k, k, packet.t[ray])) continue;
      for (std::int32_t v = box->v.first; v <= box->v.last; ++v) {
        for (std::int32_t u = box->u.first; u <= box->u.last; ++u) {
          std::uint32_t cell[3];
          cell[frustum.axis_k] = static_cast<std::uint32_t>(k);
          cell[frustum.axis_u] = static_cast<std::uint32_t>(u);
          cell[frustum.axis_v] = static_cast<std::uint32_t>(v);
          if (scene.table.block_of[scene.macro_cell_of(cell)] == 0) continue;
          ++touched_count;
          ASSERT_TRUE(cells.contains(scene.cell_id(cell)))
              << "ray " << ray << " touches cell " << cell[0] << ", " << cell[1] << ", " << cell[2];
        }
      }
    }
  }
}

TEST(SliceWalk, VisitsEveryCellTouchedOnceAndInOrder) {
  std::uint64_t touched = 0;
  for_each_seed(300, [&](std::uint64_t seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    TestRandom random(seed);
    const WalkScene scene(random, seed % 3 == 0 ? 100 : 30);
    SmallPacket packet{};
    random_packet(random, scene.grid, packet);
    RaySet<kRays> waiting;
    waiting.words[0] = (1u << kRays) - 1;
    Frustum frustum;
    while (take_pass<Lanes<4>>(scene.grid, waiting, packet, frustum, pass_work)) {
      check_pass(scene, packet, frustum, reach_of<Lanes<4>>(packet), touched);
      // The same with hits on the way.
      SmallPacket hit = packet;
      for (std::uint32_t ray = 0; ray < kRays; ++ray) {
        const float march = std::fabs(packet.dir[frustum.axis_k][ray]) * scene.grid.cells_per_unit[frustum.axis_k];
        const float way = random.unit() * static_cast<float>(frustum.cells_k);
        const float first = frustum.slab_of(0, frustum.cells_k - 1).entry;
        hit.t[ray] = march > 0.0f ? std::fmin((first + way) / march, kFloatMax) : 1.0f;
      }
      check_pass(scene, hit, frustum, reach_of<Lanes<4>>(hit), touched);
      if (HasFatalFailure()) return;
    }
  });
  if (!all_seeds_run()) return;
  EXPECT_GT(touched, 30000u);
}

// A packet of parallel rays along +x or -x in a grid of 24 x 8 x 8 unit cells, macrocells of 4.
class StraightWalk : public testing::TestWithParam<bool> {
 protected:
  void SetUp() override {
    TestRandom random(1);
    scene_.emplace(random, 100);
    GridRecord& grid = scene_->grid;
    grid = unit_grid(8);
    const std::uint32_t counts[3] = {24, 8, 8};
    for (int axis = 0; axis < 3; ++axis) {
      grid.cell_count[axis] = counts[axis];
      grid.macro_cell_count[axis] = counts[axis] / 4;
    }
    grid.macro_width = 4;
    scene_->table = TableCase(random, 24, 100);
    for (std::uint32_t ray = 0; ray < kRays; ++ray) {
      packet_.dir[0][ray] = GetParam() ? -1.0f : 1.0f;
      packet_.t[ray] = kFloatMax;
    }
    packet_.origin[0] = GetParam() ? 30.5f : -6.5f;
    packet_.origin[1] = 1.5f;
    packet_.origin[2] = 6.5f;
    RaySet<kRays> waiting;
    waiting.words[0] = (1u << kRays) - 1;
    ASSERT_TRUE(take_pass<Lanes<4>>(grid, waiting, packet_, frustum_, pass_work));
  }
  std::optional<WalkScene> scene_;
  SmallPacket packet_{};
  Frustum frustum_{};
};

TEST_P(StraightWalk, OneCellASlice) {
  Visited visited;
  walk(*scene_, frustum_, kFloatMax, true, visited);
  ASSERT_EQ(visited.cells.size(), 24u);
  EXPECT_EQ(visited.macro_cells.size(), 6u);
  for (std::uint32_t i = 0; i < 24; ++i) {
    const std::uint32_t cell[3] = {GetParam() ? 23 - i : i, 1, 6};
    EXPECT_EQ(visited.cells[i], scene_->cell_id(cell)) << i;
    EXPECT_EQ(visited.entries[i], 6.5f + static_cast<float>(i)) << i;
  }
}

TEST_P(StraightWalk, ReachStopsIt) {
  Visited visited;
  walk(*scene_, frustum_, 6.5f + 9.25f, true, visited);  // ten slices of 24
  EXPECT_EQ(visited.cells.size(), 10u);
  EXPECT_EQ(visited.macro_cells.size(), 3u);
  Visited nothing;
  walk(*scene_, frustum_, 6.0f, true, nothing);
  EXPECT_EQ(nothing.cells.size(), 0u);
  EXPECT_EQ(nothing.macro_cells.size(), 0u);
}

TEST_P(StraightWalk, OriginInsideStartsThere) {
  packet_.origin[0] = GetParam() ? 9.5f : 14.5f;
  RaySet<kRays> waiting;
  waiting.words[0] = (1u << kRays) - 1;
  ASSERT_TRUE(take_pass<Lanes<4>>(scene_->grid, waiting, packet_, frustum_, pass_work));
  Visited visited;
  walk(*scene_, frustum_, kFloatMax, true, visited);
  EXPECT_EQ(visited.cells.size(), 10u);
  ASSERT_FALSE(visited.entries.empty());
  EXPECT_EQ(visited.entries[0], 0.0f);
}

INSTANTIATE_TEST_SUITE_P(BothWays, StraightWalk, testing::Bool(), [](const auto& tested) {
  return tested.param ? std::string("Reverse") : std::string("Forward");
});

TEST(SliceWalk, ChunksAreFetchedOnDemandOnly) {
  TestRandom random(3);
  WalkScene scene(random, 100);
  scene.grid = unit_grid(16);
  scene.table = TableCase(random, 4096, 100);  // 8 chunks of 512, two z slices each
  SmallPacket packet{};
  for (std::uint32_t ray = 0; ray < kRays; ++ray) {
    packet.dir[2][ray] = 1.0f;
    packet.t[ray] = kFloatMax;
  }
  packet.origin[0] = packet.origin[1] = 3.5f;
  packet.origin[2] = -1.0f;
  RaySet<kRays> waiting;
  waiting.fill();
  Frustum frustum;
  ASSERT_TRUE(take_pass<Lanes<4>>(scene.grid, waiting, packet, frustum, pass_work));
  Visited visited;
  walk(scene, frustum, kFloatMax, true, visited);
  EXPECT_EQ(visited.cells.size(), 16u);
  EXPECT_EQ(visited.chunks, 8u);
  Visited part;
  walk(scene, frustum, 5.5f, true, part);
  EXPECT_EQ(part.cells.size(), 5u);
  EXPECT_EQ(part.chunks, 3u);
}

}  // namespace
}  // namespace gridiron::test
