// Grids: faces, edges and corners of cells, ties between them, flat and crowded ones, of every resolution.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/build/triangle_records.h>
#include <gridiron/engine/grid/frustum.h>

#include "core/build/grid/built_image.h"
#include "core/ray/packet_cases.h"
#include "numeric/hard_cases/cell_walk.h"
#include "numeric/hard_cases/shapes.h"
#include "numeric/hard_cases/trial.h"

namespace gridiron::test::hard {
namespace {

// A mesh and a grid whose cells are the unit cubes of [0, 8]^3: all vertices lie on faces, edges and corners of cells,
// but for two triangles that keep the grid's last face at the float below 8.
struct UnitCells {
  static constexpr float kLast = 0x1.fffffep+2f;
  TestMesh mesh;
  GridParameters grid;

  explicit UnitCells(std::uint64_t seed, const TestMesh& more = {}) {
    TestRandom random(seed);
    mesh = make_triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    mesh.append(make_triangle(Vec3(kLast), {7, kLast, kLast}, {kLast, 7, kLast}));
    mesh.append(more);
    while (mesh.triangles.size() < 60) {
      const auto corner = [&] {
        const auto x = static_cast<float>(random.below(8)), y = static_cast<float>(random.below(8));
        return Vec3(x, y, static_cast<float>(random.below(8)));
      };
      TestMesh one = make_triangle(corner(), corner(), corner());
      // Half of them lie in a face of cells.
      if (random.below(2) == 0) {
        const auto axis = static_cast<int>(random.below(3));
        one.vertices[1][axis] = one.vertices[2][axis] = one.vertices[0][axis];
      }
      if (!has_zero_area(one.vertices[0], one.vertices[1], one.vertices[2])) mesh.append(one);
    }
    grid.lambda = 530.0f / static_cast<float>(mesh.triangles.size());
    grid.macro_width = 1 + static_cast<std::uint32_t>(seed % 6);
    GridNeed need;
    EXPECT_EQ(count_scene_image(mesh.view(), grid, need), Status::kOk);
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_EQ(need.grid.minimum[axis], 0.0f);
      EXPECT_EQ(need.grid.cells_per_unit[axis], 1.0f);
      EXPECT_EQ(need.grid.cell_count[axis], 8u);
    }
  }
};

// Multiples of a step in [low, high].
Vec3 lattice_point(TestRandom& random, float low, float high, float step) {
  const auto count = static_cast<std::uint32_t>((high - low) / step) + 1;
  const auto one = [&] { return low + step * static_cast<float>(random.below(count)); };
  const float x = one(), y = one();
  return {x, y, one()};
}

// Grids of whole powers of two, so that points intended for a face lie exactly on it.
std::vector<GridRecord> exact_grids() {
  return {grid_of(Vec3(0.0f), Vec3(1.0f), {8, 8, 8}, 1), grid_of({-16, 0, 4}, {0.5f, 2, 1}, {16, 5, 9}, 3),
          grid_of({0x1p20f, -0x1p20f, 0}, Vec3(8.0f), {32, 24, 40}, 6), grid_of(Vec3(0.0f), Vec3(1.0f), {1, 64, 7}, 8)};
}

// The rays that leave lattice points, in the units of a grid's cells.
std::vector<Rays> in_cells(const GridRecord& grid, std::vector<Rays> all) {
  for (Rays& rays : all) {
    const auto scaled = [&](Vec3& v, bool is_place) {
      for (int axis = 0; axis < 3; ++axis) {
        v[axis] = v[axis] / grid.cells_per_unit[axis] + (is_place ? grid.minimum[axis] : 0.0f);
      }
    };
    scaled(rays.origin, true);
    for (Vec3& d : rays.directions) scaled(d, false);
    for (Vec3* const d : {&rays.corner, &rays.step_x, &rays.step_y}) scaled(*d, false);
    recompute_picture(rays);
  }
  return all;
}

// Walks through every exact grid, and all of it through the unit cells.
Tally shoot_on_faces(std::uint64_t first_seed, const AimAtMesh& aim) {
  for (const GridRecord& grid : exact_grids()) {
    const WalkTally walked = walk(grid, in_cells(grid, aim({})));
    EXPECT_GT(2 * walked.touched, walked.rays) << "many leave the grid at once, not most";
  }
  Tally tally;
  for (std::uint64_t seed = first_seed; seed < first_seed + 3; ++seed) {
    const UnitCells cells(seed);
    tally += shoot({.mesh = cells.mesh, .aim = aim, .grid = cells.grid});
  }
  return tally;
}

TEST(HardCase18, OriginOnCellBoundary) {
  const auto add = [](std::vector<Rays>& all, std::uint32_t i, TestRandom& random, const TestMesh&) {
    Rays rays{lattice_point(random, 0, 8, 1)};  // a corner
    if (i % 3 >= 1) rays.origin.x += 0.375f;    // on an edge
    if (i % 3 == 2) rays.origin.y += 0.625f;    // on a face
    for (std::uint32_t k = 0; k < 24; ++k) {
      rays.directions.push_back(k % 2 == 0 ? random_vec(random, 1.0f) : lattice_point(random, -3, 3, 1));
      if (rays.directions.back() == Vec3(0.0f)) rays.directions.back().z = -1.0f;
    }
    all.push_back(rays);
    all.push_back(picture(rays.origin, {-1, -1, 1}, {0.25f, 0, 0}, {0, 0.25f, 0}, 9, 9));
  };
  const Tally tally = shoot_on_faces(18, rounds(12, 18, add));
  EXPECT_GT(tally.hits, tally.rays / 6);
}

TEST(HardCase19, RayInACellFace) {
  const auto add = [](std::vector<Rays>& all, std::uint32_t i, TestRandom& random, const TestMesh&) {
    Rays rays{lattice_point(random, -2, 10, 1)};
    const auto axis = static_cast<int>(i % 3);
    if (i % 2 == 0) rays.origin[(axis + 1) % 3] += 0.375f;
    for (std::uint32_t k = 0; k < 24; ++k) {
      Vec3 d = random_vec(random, 1.0f);
      d[axis] = k % 4 == 0 ? -0.0f : 0.0f;  // in a face
      if (k % 3 == 0) {                     // along an edge
        d = Vec3(0.0f);
        d[(axis + 1) % 3] = k % 2 == 0 ? 1.0f : -1.0f;
      }
      rays.directions.push_back(d);
    }
    all.push_back(rays);
    Vec3 along(0.0f), across(0.0f), forward(0.0f);
    forward[(axis + 1) % 3] = 1.0f;
    across[(axis + 2) % 3] = 0.125f;
    along[axis] = 0x1p-23f;  // the middle row runs in the face, the others beside it
    all.push_back(picture(rays.origin, forward - 4.0f * across - 4.0f * along, across, along, 9, 9));
  };
  const Tally tally = shoot_on_faces(19, rounds(12, 19, add));
  EXPECT_GT(tally.hits, tally.rays / 10);
}

// Through corners of cells, one after the other. Where two axes are as steep, the first of them is marched along.
TEST(HardCase20, DiagonalTies) {
  const auto add = [](std::vector<Rays>& all, std::uint32_t i, TestRandom& random, const TestMesh&) {
    Rays rays{lattice_point(random, -1, 9, i % 3 == 0 ? 0.5f : 1.0f)};
    for (std::uint32_t k = 0; k < 27; ++k) {
      const Vec3 d(static_cast<float>(k % 3) - 1.0f, static_cast<float>(k / 3 % 3) - 1.0f,
                   static_cast<float>(k / 9) - 1.0f);
      if (d != Vec3(0.0f)) rays.directions.push_back(d);
    }
    all.push_back(rays);
    const float step = i % 2 == 0 ? 0x1p-23f : 0.25f;
    all.push_back(
        picture(rays.origin, Vec3(1.0f) - Vec3(4.0f * step, 4.0f * step, 0), {step, 0, 0}, {0, step, 0}, 9, 9));
  };
  const Tally tally = shoot_on_faces(20, rounds(12, 20, add));
  EXPECT_GT(tally.hits, tally.rays / 8);
  const GridRecord grid = exact_grids()[0];
  for (std::uint32_t ties = 1; ties < 8; ++ties) {
    auto packet = std::make_unique<Packet<4>>();
    for (std::uint32_t axis = 0; axis < 3; ++axis) packet->dir[axis][0] = (ties >> axis & 1u) != 0 ? -1.0f : 0.5f;
    set_direction_bounds(*packet);
    RaySet<16> waiting;
    waiting.clear();
    waiting.insert(0);
    Frustum frustum;
    WorkCounters work;
    ASSERT_TRUE(take_pass<Lanes<4>>(grid, waiting, *packet, frustum, work));
    EXPECT_EQ(frustum.axis_k, static_cast<std::uint32_t>(std::countr_zero(ties)));
  }
}

// From outside, at the corners, edges and faces of the bounds, and past them by a float.
TEST(HardCase22, GrazingTheBounds) {
  const auto aim = [](float low, float high) {
    return rounds(300, 22, [=](std::vector<Rays>& all, std::uint32_t i, TestRandom& random, const TestMesh&) {
      const auto side = [&] { return random.below(2) == 0 ? low : high; };
      Vec3 at;
      at.x = side();
      at.y = i % 3 == 2 ? 0.5f * (low + high) : side();
      at.z = i % 3 >= 1 ? low + 0.25f * (high - low) : side();
      Vec3 d = lattice_point(random, -3, 3, 1);
      if (d == Vec3(0.0f)) d.x = 1.0f;
      Rays rays = one_ray(at - 4.0f * d, d);
      for (int axis = 0; axis < 3; ++axis) {
        Vec3 beside = d;
        beside[axis] = std::nextafter(d[axis], 9.0f);
        rays.directions.push_back(beside);
        beside[axis] = std::nextafter(d[axis], -9.0f);
        rays.directions.push_back(beside);
      }
      all.push_back(rays);
    });
  };
  Tally tally = shoot({.mesh = make_box(Vec3(-1.0f), Vec3(1.0f)), .grade = Grade::kTie, .aim = aim(-1, 1)});
  EXPECT_GT(tally.ties, 100u);
  const UnitCells cells(22, make_box(Vec3(0.0f), Vec3(UnitCells::kLast)));
  tally += shoot({.mesh = cells.mesh, .grade = Grade::kTie, .aim = aim(0, UnitCells::kLast), .grid = cells.grid});
  EXPECT_GT(tally.hits, tally.rays / 6);
  EXPECT_LT(tally.hits, tally.rays);
  for (const GridRecord& grid : exact_grids()) EXPECT_GT(walk(grid, in_cells(grid, aim(0, 8)({}))).touched, 1000u);
}

// Rays that leave by the last face, the last edge, the last corner; triangles there. No walk visits a cell beyond.
TEST(HardCase23, ExitAtTheLastFace) {
  const auto aim = [](float last) {
    return rounds(16, 23, [=](std::vector<Rays>& all, std::uint32_t, TestRandom& random, const TestMesh&) {
      Rays rays{lattice_point(random, 1, 7, 0.5f)};
      for (std::uint32_t k = 0; k < 32; ++k) {
        Vec3 at = lattice_point(random, 0, 8, 1);
        at[static_cast<int>(k % 3)] = last;
        if (k % 4 >= 1) at[static_cast<int>((k + 1) % 3)] = last;
        if (k % 4 == 2) at = Vec3(last);
        rays.directions.push_back(at - rays.origin);
      }
      all.push_back(rays);
      all.push_back(
          picture(rays.origin, (Vec3(last) - rays.origin) - Vec3(0x1p-20f), {0x1p-22f, 0, 0}, {0, 0x1p-22f, 0}, 9, 9));
    });
  };
  for (const GridRecord& grid : exact_grids()) EXPECT_GT(walk(grid, in_cells(grid, aim(8)({}))).touched, 300u);
  for (std::uint64_t seed = 23; seed < 26; ++seed) {
    const UnitCells cells(seed, make_box(Vec3(0.0f), Vec3(UnitCells::kLast)));
    const Tally tally =
        shoot({.mesh = cells.mesh, .grade = Grade::kClosed, .aim = aim(UnitCells::kLast), .grid = cells.grid});
    EXPECT_EQ(tally.hits, tally.rays);
  }
}

// Sheets without thickness, across each axis, near and far: cells that are numbers, no hole between the triangles.
TEST(HardCase25, FlatBounds) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const float height : {0.0f, 3.0f, 1e6f}) {
      SCOPED_TRACE(std::to_string(axis) + ", " + std::to_string(height));
      TestMesh sheet = make_height_field(16, 0.0f, 1);  // y = 0; x and z are eighths
      for (Vec3& v : sheet.vertices) {
        const float place[3] = {v.x, v.z, height};
        for (int i = 0; i < 3; ++i) v[(axis + 1 + i) % 3] = place[i];
      }
      const Target target(sheet, {}, kProfiles[0]);
      for (int i = 0; i < 3; ++i) {
        EXPECT_GT(target.grid().cells_per_unit[i], 0.0f);
        EXPECT_LE(target.grid().cells_per_unit[i], kGreatestCellsPerUnit);
        EXPECT_EQ(target.grid().cell_count[i] == 1, i == axis);
      }
      const auto add = [&](std::vector<Rays>& all, std::uint32_t i, TestRandom& random, const TestMesh&) {
        Rays rays{random_vec(random, 0.5f)};
        rays.origin[axis] = height + (i % 2 == 0 ? 2.0f : -1.0f);
        while (rays.directions.size() < 32) {  // at eighths, off the border: what the float aims at lies inside
          Vec3 at = lattice_point(random, -0.75f, 0.75f, 0.0625f);
          at[axis] = height;
          rays.directions.push_back(at - rays.origin);
        }
        all.push_back(rays);
      };
      const Tally tally = shoot({.mesh = sheet, .grade = Grade::kClosed, .aim = rounds(6, 25, add)});
      EXPECT_EQ(tally.hits, tally.rays);
      // Rays in the sheet: no hit, bounded.
      const auto in_the_sheet = [&](const TestMesh&) {
        TestRandom random(26);
        Rays rays;
        rays.origin[axis] = height;
        for (std::uint32_t k = 0; k < 64; ++k) {
          rays.directions.push_back(random_vec(random, 1.0f));
          rays.directions.back()[axis] = 0.0f;
        }
        return std::vector<Rays>{rays};
      };
      const Tally inside = shoot({.mesh = sheet, .grade = Grade::kBounded, .aim = in_the_sheet});
      EXPECT_EQ(inside.hits, 0u);
    }
  }
}

// All triangles in one cell: because the grid has no other, and because one triangle far away makes it coarse.
TEST(HardCase27, AllInOneCell) {
  TestMesh cluster = make_random_soup(300, 1.0f, 27);
  for (std::size_t i = 0; i < cluster.vertices.size(); i += 3) {  // one middle for all
    const Vec3 middle = (cluster.vertices[i] + cluster.vertices[i + 1] + cluster.vertices[i + 2]) / 3.0f;
    for (std::size_t k = 0; k < 3; ++k) cluster.vertices[i + k] -= middle;
  }
  const auto aim = salvo_at(Vec3(0.0f), 3.0f, {kFeatures, times(4), 24, 1}, 27);
  const GridParameters one_cell{.lambda = 1e-6f};
  EXPECT_GT(shoot({.mesh = cluster, .aim = aim, .grid = one_cell}).hits, 1000u);
  TestMesh with_far = moved(cluster, 1.0f, Vec3(5.0f));
  with_far.append(make_triangle({4000, 4000, 4000}, {4001, 4000, 4000}, {4000, 4001, 4000}));
  const Target target(with_far, {}, kProfiles[0]);
  EXPECT_GT(target.grid().cell_count[0], 8u);
  EXPECT_LT(target.grid().reference_count, 320u);
  EXPECT_LT(target.need().image_bytes, 1u << 20);
  EXPECT_GT(shoot({.mesh = with_far, .aim = salvo_at(Vec3(5.0f), 3.0f, {kFeatures, times(4), 24, 1}, 28)}).hits, 1000u);
}

// A triangle through all cells: the mailbox sees to it that a packet tests it once.
TEST(HardCase28, GiantTriangle) {
  TestMesh mesh = make_random_soup(500, 0.05f, 28);
  const auto giant = static_cast<std::uint32_t>(mesh.triangles.size());
  mesh.append(make_triangle({-4, -4, -1.5f}, {4, -4, -1.5f}, {0.1f, 6, 1.5f}));
  EXPECT_GT(shoot({.mesh = mesh, .aim = salvo_at({0, 0, 4}, 1.0f, {kFeatures, times(8), 32, 1}, 28)}).hits, 1000u);
  // The giant alone, in many cells. Rays that miss it stay in the grid to its end; all but the first test of a packet
  // are the mailbox's. Fetched it is for every cell, since a cell does not know of the others.
  const TestMesh alone =
      make_triangle(mesh.vertices[3 * giant], mesh.vertices[3 * giant + 1], mesh.vertices[3 * giant + 2]);
  const GridParameters fine{.lambda = 4096.0f};
  Target target(alone, fine, kProfiles[0]);
  ASSERT_GT(target.grid().reference_count, 200u);
  const Rays view = picture({0, 0, 4}, {-2, -2, -2}, {0.0625f, 0, 0}, {0, 0.0625f, 0}, 64, 64);
  const auto work_of = [&](std::uint32_t techniques) {
    const PipelineWay way{sim::Mode::kChecked, sim::StoreSize::k256KB, 8, 4, true, techniques};
    sim::WorkTotals work{};
    (void)target.by_pipeline(view, way, {}, &work);
    return work;
  };
  const auto of = [](const sim::WorkTotals& work, WorkId kind) { return work[kind.number()]; };
  const sim::WorkTotals with = work_of(kUseMailbox | kUseEmptySkip), without = work_of(kUseEmptySkip);
  EXPECT_LE(of(with, Work::kTriangleSetup), of(with, GridWork::kPacketStart));
  EXPECT_GT(of(without, Work::kTriangleSetup), 4 * of(with, Work::kTriangleSetup));
  EXPECT_EQ(of(with, GridWork::kTriangleBatch), of(without, GridWork::kTriangleBatch));
}

// Cells that hold a triangle, by the image that was built.
bool holds(const BuiltImage& built, std::uint32_t x, std::uint32_t y, std::uint32_t z, std::uint32_t id) {
  const std::vector<std::uint32_t>& ids = built.cell(x, y, z);
  return std::find(ids.begin(), ids.end(), id) != ids.end();
}

// A triangle in a face of cells is in the cells on both its sides.
TEST(HardCase30, TriangleOnACellFace) {
  TestMesh faces;
  for (int axis = 0; axis < 3; ++axis) {
    for (int k = 1; k < 8; ++k) {
      const auto at = [&](float u, float v) {
        Vec3 p;
        p[axis] = static_cast<float>(k);
        p[(axis + 1) % 3] = u;
        p[(axis + 2) % 3] = v;
        return p;
      };
      faces.append(make_triangle(at(1.5f, 1.5f), at(6.5f, 1.5f), at(1.5f, 6.5f)));
    }
  }
  const UnitCells cells(30, faces);
  const BuiltImage built = build_image(cells.mesh.view(), cells.grid);
  for (std::uint32_t i = 0; i < faces.triangles.size(); ++i) {
    const std::uint32_t axis = i / 7, k = 1 + i % 7;
    for (std::uint32_t u = 1; u < 7; ++u) {
      for (std::uint32_t v = 1; u + v < 8; ++v) {
        std::uint32_t cell[3];
        cell[(axis + 1) % 3] = u;
        cell[(axis + 2) % 3] = v;
        for (cell[axis] = k - 1; cell[axis] <= k; ++cell[axis]) {
          ASSERT_TRUE(holds(built, cell[0], cell[1], cell[2], 2 + i)) << "triangle " << 2 + i;
        }
      }
    }
  }
  const auto add = [](std::vector<Rays>& all, std::uint32_t, TestRandom& random, const TestMesh& mesh) {
    const Vec3 origin = lattice_point(random, -1, 9, 0.5f);
    for (const Aim aim : {Aim::kVertex, Aim::kEdge, Aim::kInside})
      all.push_back(rays_at(mesh, origin, aim, 24, random));
    Rays straight{origin};
    for (int axis = 0; axis < 6; ++axis) {
      Vec3 d(0.0f);
      d[axis % 3] = axis < 3 ? 1.0f : -1.0f;
      straight.directions.push_back(d);
    }
    all.push_back(straight);
    all.push_back(picture_at(mesh, origin, Aim::kVertex, random));
  };
  const Tally tally = shoot({.mesh = cells.mesh, .aim = rounds(16, 30, add), .grid = cells.grid});
  EXPECT_GT(tally.hits, tally.rays / 2);
}

// A triangle that meets cells in a corner of theirs alone stands in all eight around it, and rays that come to the
// corner from there find it.
TEST(HardCase31, TriangleAtACellCorner) {
  TestMesh tips;
  TestRandom places(31);
  for (std::uint32_t i = 0; i < 40; ++i) {
    const Vec3 tip = lattice_point(places, 1, 7, 1);
    const Vec3 away((i & 1u) != 0 ? 0.5f : -0.5f, (i & 2u) != 0 ? 0.5f : -0.5f, (i & 4u) != 0 ? 0.5f : -0.5f);
    tips.append(make_triangle(tip, tip + away, tip + Vec3(away.x, 0.5f * away.y, 0.25f * away.z)));
  }
  const UnitCells cells(31, tips);
  const BuiltImage built = build_image(cells.mesh.view(), cells.grid);
  for (std::uint32_t i = 0; i < tips.triangles.size(); ++i) {
    const Vec3 tip = tips.vertices[tips.triangles[i].x];
    for (std::uint32_t k = 0; k < 8; ++k) {
      const UVec3 cell(static_cast<std::uint32_t>(tip.x) - (k & 1u), static_cast<std::uint32_t>(tip.y) - (k >> 1 & 1u),
                       static_cast<std::uint32_t>(tip.z) - (k >> 2));
      ASSERT_TRUE(holds(built, cell.x, cell.y, cell.z, 2 + i)) << "triangle " << 2 + i;
    }
  }
  const auto add = [&](std::vector<Rays>& all, std::uint32_t, TestRandom& random, const TestMesh&) {
    const Vec3 tip = tips.vertices[tips.triangles[random.below(40)].x];
    const Vec3 d = lattice_point(random, -1, 1, 0.25f) + Vec3(0, 0, 0.0625f);
    all.push_back(one_ray(tip - 0.5f * d, d));
  };
  const Tally tally = shoot({.mesh = cells.mesh, .aim = rounds(400, 31, add), .grid = cells.grid});
  EXPECT_EQ(tally.hits, tally.rays);
  EXPECT_GT(tally.ties, 40u);
}

// One cell to 1024, and three axes of one, of one and of N.
TEST(HardCase42, Resolutions) {
  Tally tally;
  WalkTally walked;
  for (const std::uint32_t cells : {1u, 2u, 127u, 128u, 129u, 1024u}) {
    for (const bool is_line : {false, true}) {
      SCOPED_TRACE(std::to_string(cells) + (is_line ? " in a row" : " on each axis"));
      TestMesh mesh = moved(make_random_soup(1200, 0.02f, cells), 0.9f);
      for (const float end : {-1.0f, 1.0f}) {
        mesh.append(make_triangle(Vec3(end), {0.99f * end, end, end}, {end, 0.99f * end, end}));
      }
      const double wanted = cells + 0.5;
      double total = wanted * wanted * wanted;
      if (is_line) {
        for (Vec3& v : mesh.vertices) v *= Vec3(0x1p-12f, 0x1p-12f, 1);
        total = wanted;
      }
      GridParameters grid{.lambda = static_cast<float>(total / static_cast<double>(mesh.triangles.size())),
                          .macro_width = cells == 1024 ? 8 : 1 + cells % 8};
      const Target target(mesh, grid, kProfiles[0]);
      ASSERT_EQ(target.status(), Status::kOk);
      for (int axis = 0; axis < 3; ++axis) EXPECT_EQ(target.grid().cell_count[axis], is_line && axis < 2 ? 1 : cells);
      const auto aim = [&](const TestMesh& stored) {
        std::vector<Rays> all = salvo(stored, Vec3(0.0f), is_line ? 0x1p-12f : 1.5f, {kFeatures, times(2), 16, 0}, 42);
        // Narrow: a wide view of 1024 cells on each axis passes a billion of them.
        const float step = is_line ? 0x1p-23f : 0x1p-14f;
        const Vec3 forward = is_line ? Vec3(0, 0, 1) : Vec3(-0.3f, 0.1f, 1);
        all.push_back(picture(all[0].origin, forward, {step, 0, 0}, {0, step, 0}, 12, 8));
        return all;
      };
      tally += shoot({.mesh = mesh, .aim = aim, .grid = grid});
      std::vector<Rays> some = aim(mesh);
      some.erase(some.begin() + 2, some.end() - 1);
      const WalkTally more = walk(target.grid(), some);
      walked.rays += more.rays;
      walked.touched += more.touched;
    }
  }
  EXPECT_GT(tally.hits, tally.rays / 4);
  EXPECT_GT(walked.touched, 10000u);
}

}  // namespace
}  // namespace gridiron::test::hard
