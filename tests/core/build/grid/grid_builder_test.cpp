// Grid builder: cells against rational arithmetic, counts, memory, errors, bytes. SPDX-License-Identifier: Apache-2.0
#include <gridiron/build/grid/grid_builder.h>

#include "core/build/grid/built_image.h"
#include "core/build/grid/exact_overlap.h"
#include "support/ply_load.h"
#include "support/scenes.h"
#include "support/test_mesh.h"

namespace gridiron::test {
namespace {

bool same_bytes(std::span<const std::byte> a, std::span<const std::byte> b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size()) == 0;
}

// --- Cells --------------------------------------------------------------------------------------------------------

struct MeshCase {
  const char* name;
  TestMesh mesh;
  float lambda = 4.0f;
  std::uint32_t macro_width = 6;
};

class MeshCells : public ::testing::TestWithParam<MeshCase> {};

TEST_P(MeshCells, HoldEveryTriangleThatTouchesThem) {
  const TestMesh& mesh = GetParam().mesh;
  const GridParameters parameters{GetParam().lambda, GetParam().macro_width, TriangleFormat::kVertices};
  const BuiltImage built = build_image(mesh.view(), parameters);
  ASSERT_FALSE(HasFailure());
  const GridRecord& grid = built.view.grid;
  const Rational grown = Rational(1, boost::multiprecision::cpp_int(1) << 34);

  std::vector<std::array<RationalPoint, 3>> triangles;
  for (const UVec3& t : mesh.triangles) {
    const auto corner_of = [&](std::uint32_t vertex) { return exact_cell_point(grid, mesh.vertices[vertex]); };
    const std::array<RationalPoint, 3> triangle = {corner_of(t.x), corner_of(t.y), corner_of(t.z)};
    for (const RationalPoint& corner : triangle) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        EXPECT_GE(corner[axis], 0);
        EXPECT_LE(corner[axis], Rational(grid.cell_count[axis])) << "outside the grid";
      }
    }
    triangles.push_back(triangle);
  }
  std::uint64_t references = 0;
  for_each_cell(grid, [&](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
    const std::vector<std::uint32_t>& ids = built.cell(x, y, z);
    references += ids.size();
    ASSERT_TRUE(std::is_sorted(ids.begin(), ids.end()));
    const std::array<int, 3> cell = {static_cast<int>(x), static_cast<int>(y), static_cast<int>(z)};
    for (std::uint32_t id = 0; id < triangles.size(); ++id) {
      if (std::binary_search(ids.begin(), ids.end(), id)) {
        EXPECT_TRUE(touches_cell(triangles[id], cell, grown)) << "extra " << id << " in " << x << ' ' << y << ' ' << z;
      } else {
        EXPECT_FALSE(touches_cell(triangles[id], cell, 0)) << "lost " << id << " in " << x << ' ' << y << ' ' << z;
      }
    }
  });
  EXPECT_EQ(references, grid.reference_count);
  EXPECT_EQ(references, built.need.grid.reference_count);
}

const MeshCase kMeshCases[] = {
    {"triangle", make_triangle({0, 0, 0}, {1, 0.5f, 0.25f}, {0.25f, 1, 0.75f})},
    {"giant", make_triangle({0, 0, 0}, {3, 0.1f, 1}, {0.5f, 3, 2}), 500.0f, 3},
    {"needle", make_triangle({0, 0, 0}, {1, 1, 1}, {1, 1, 0.999f}), 300.0f, 4},
    {"box", make_box({-1, -2, -3}, {1, 2, 3}), 12.0f, 2},
    {"box_on_cells", make_box({0, 0, 0}, {4, 4, 4}), 64.0f / 12.0f + 0.01f, 2},
    {"soup", make_random_soup(24, 0.4f, 5)},
    {"soup_m1", make_random_soup(24, 0.3f, 6), 6.0f, 1},
    {"soup_m8", make_random_soup(16, 0.9f, 7), 9.0f, 8},
    {"sphere", make_sphere(5, 6, 2.0f), 3.0f},
    {"fan", make_sliver_fan(20, 0.01f), 5.0f},
    {"huge", moved(make_random_soup(16, 0.5f, 8), 1e30f)},
    {"largest", moved(make_random_soup(16, 0.5f, 8), 8e35f)},
    {"tiny", moved(make_random_soup(16, 0.5f, 9), 1e-30f)},
    {"denormal", moved(make_random_soup(16, 0.5f, 10), 1e-42f)},
    {"moved", moved(make_random_soup(16, 0.5f, 11), 100.0f, Vec3(1e7f))},
    {"moved_far", moved(make_random_soup(16, 0.5f, 12), 1.0f, Vec3(1e6f, -1e5f, 3e6f))},
    {"mixed",
     joined(make_box({-100, 0, -100}, {100, 1, 100}), moved(make_sphere(3, 4, 1.0f), 0.05f, Vec3(0.3f, 0.5f, 0.1f)))},
    {"flat", joined(make_triangle({0, 0, 1}, {4, 0, 1}, {0, 4, 1}), make_triangle({4, 4, 1}, {4, 0, 1}, {0, 4, 1})),
     20.0f},
    {"thin", make_triangle({0, 0, 0}, {100, 0.001f, 0.001f}, {50, 0.002f, 0}), 30.0f},
    {"denormal_axis", make_triangle({0, 0, 0}, {1, 0, 1e-45f}, {0, 1, 1e-44f}), 9.0f}};
INSTANTIATE_TEST_SUITE_P(Meshes, MeshCells, ::testing::ValuesIn(kMeshCases),
                         [](const auto& test) { return test.param.name; });

// --- Eq. (1) ------------------------------------------------------------------------------------------------------

std::array<std::uint32_t, 3> cells_of(const TestMesh& mesh, float lambda) {
  GridNeed need{};
  EXPECT_EQ(count_scene_image(mesh.view(), {lambda, 6, TriangleFormat::kVertices}, need), Status::kOk);
  return {need.grid.cell_count[0], need.grid.cell_count[1], need.grid.cell_count[2]};
}

TEST(Resolution, FollowsEquationOne) {
  // N = L cbrt(lambda n / V): 12 triangles, lambda 4.5, V = 2 * 3 * 9 = 54: one cell per unit.
  EXPECT_EQ(cells_of(make_box({0, 0, 0}, {2, 3, 9}), 4.5001f), (std::array<std::uint32_t, 3>{2, 3, 9}));
  EXPECT_EQ(cells_of(make_box({5, 5, 5}, {7, 8, 14}), 4.5001f * 8), (std::array<std::uint32_t, 3>{4, 6, 18}));
  EXPECT_EQ(cells_of(make_box({5, 5, 5}, {7, 8, 14}), 4.5001f * 1000), (std::array<std::uint32_t, 3>{20, 30, 90}));
}

TEST(Resolution, AnAxisBelowOneCellLeavesTheEquation) {
  // Flat: N = L sqrt(lambda n / A). 2 triangles, A = 4 * 9, lambda 72: two cells per unit.
  TestMesh flat;
  flat.vertices = {{0, 0, 7}, {4, 0, 7}, {4, 9, 7}, {0, 9, 7}};
  flat.triangles = {{0, 1, 2}, {0, 2, 3}};
  EXPECT_EQ(cells_of(flat, 72.001f), (std::array<std::uint32_t, 3>{8, 18, 1}));
  // The same, almost flat.
  flat.vertices[0].z = 7.0001f;
  EXPECT_EQ(cells_of(flat, 72.001f), (std::array<std::uint32_t, 3>{8, 18, 1}));
  // Almost a line: N = lambda n.
  const TestMesh line = make_triangle({0, 0, 0}, {0, 1e-4f, 500}, {1e-4f, 0, 1000});
  EXPECT_EQ(cells_of(line, 37.5f), (std::array<std::uint32_t, 3>{1, 1, 37}));
}

TEST(Resolution, IsClampedToTheLargestGrid) {
  const TestMesh line = make_triangle({0, 0, 0}, {0, 1e-7f, 500}, {1e-7f, 0, 1000});
  EXPECT_EQ(cells_of(line, 1e4f), (std::array<std::uint32_t, 3>{1, 1, kMaxCellsPerAxis}));
}

// --- Counts and memory --------------------------------------------------------------------------------------------

TEST(Counting, AgreesWithTheImageForEveryMacroWidthAndLambda) {
  const TestMesh mesh = make_height_field(12, 0.3f, 3);
  for (std::uint32_t m = 1; m <= kMaxMacroWidth; ++m) {
    for (const float lambda : {0.01f, 1.0f, 4.0f, 50.0f, 3000.0f}) {
      for (const auto format : {TriangleFormat::kVertices, TriangleFormat::kProjection}) {
        const BuiltImage built = build_image(mesh.view(), {lambda, m, format});
        ASSERT_FALSE(HasFailure()) << "m " << m << " lambda " << lambda;
        EXPECT_EQ(built.view.header.image_bytes, built.need.image_bytes);
        EXPECT_EQ(std::memcmp(&built.view.grid, &built.need.grid, sizeof(GridRecord)), 0);
        std::uint64_t references = 0;
        std::set<std::uint64_t> macro_cells;
        for_each_cell(built.view.grid, [&](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
          const std::size_t in_cell = built.cell(x, y, z).size();
          references += in_cell;
          if (in_cell != 0) macro_cells.insert((std::uint64_t{z / m} << 40) + (std::uint64_t{y / m} << 20) + x / m);
        });
        EXPECT_EQ(references, built.need.grid.reference_count);
        EXPECT_EQ(macro_cells.size() + 1, built.need.grid.cell_block_count);
      }
    }
  }
}

// More macrocells than the window of one sweep holds: several sweeps must find the same ones.
TEST(Counting, SweepsAsOftenAsItMust) {
  const TestMesh mesh = joined(make_random_soup(300, 0.2f, 21), make_triangle({-1, -1, -1}, {1, 1, 1}, {1, -1, 0.5f}));
  const BuiltImage built = build_image(mesh.view(), {400.0f, 1, TriangleFormat::kVertices});
  ASSERT_FALSE(HasFailure());
  EXPECT_GT(built.cells.size(), 100000u);
  const auto occupied =
      std::count_if(built.cells.begin(), built.cells.end(), [](const auto& ids) { return !ids.empty(); });
  EXPECT_EQ(static_cast<std::uint64_t>(occupied) + 1, built.need.grid.cell_block_count);
}

TEST(Building, OneByteLessIsAnErrorAndTouchesNothing) {
  const TestMesh mesh = make_sphere(6, 8, 1.0f);
  GridNeed need{};
  ASSERT_EQ(count_scene_image(mesh.view(), {}, need), Status::kOk);
  LineBuffer image(static_cast<std::size_t>(need.image_bytes), std::byte{0xAB});
  const LineBuffer before = image;
  std::vector<std::uint64_t> scratch(static_cast<std::size_t>(need.scratch_bytes / 8 + 1));
  const auto scratch_bytes =
      std::as_writable_bytes(std::span(scratch)).first(static_cast<std::size_t>(need.scratch_bytes));
  EXPECT_EQ(build_scene_image(mesh.view(), {}, need, image.bytes().first(image.bytes().size() - 1), scratch_bytes),
            Status::kMemoryTooSmall);
  EXPECT_TRUE(same_bytes(image.bytes(), before.bytes()));
  if (need.scratch_bytes > 0) {
    EXPECT_EQ(build_scene_image(mesh.view(), {}, need, image.bytes(), scratch_bytes.first(scratch_bytes.size() - 1)),
              Status::kMemoryTooSmall);
    EXPECT_TRUE(same_bytes(image.bytes(), before.bytes()));
  }
  EXPECT_EQ(build_scene_image(mesh.view(), {}, need, image.bytes(), scratch_bytes), Status::kOk);
}

TEST(Building, WritesTheImageAndNothingBehindIt) {
  const TestMesh mesh = make_torus(6, 8, 1.0f, 0.3f);
  GridNeed need{};
  ASSERT_EQ(count_scene_image(mesh.view(), {}, need), Status::kOk);
  LineBuffer image(static_cast<std::size_t>(need.image_bytes) + 4096, std::byte{0xAB});
  ASSERT_EQ(build_scene_image(mesh.view(), {}, need, image.bytes(), {}), Status::kOk);
  for (std::size_t i = static_cast<std::size_t>(need.image_bytes); i < image.bytes().size(); ++i) {
    ASSERT_EQ(image.bytes()[i], std::byte{0xAB}) << "byte " << i;
  }
}

TEST(Building, RefusesWhatWasNotCounted) {
  const TestMesh mesh = make_torus(6, 8, 1.0f, 0.3f);
  GridNeed need{};
  ASSERT_EQ(count_scene_image(mesh.view(), {}, need), Status::kOk);
  LineBuffer image(static_cast<std::size_t>(need.image_bytes) + kLineBytes);
  EXPECT_EQ(build_scene_image(mesh.view(), {5.0f, 6, TriangleFormat::kVertices}, need, image.bytes(), {}),
            Status::kBadParameter);
  EXPECT_EQ(build_scene_image(mesh.view(), {4.0f, 5, TriangleFormat::kVertices}, need, image.bytes(), {}),
            Status::kBadParameter);
  EXPECT_EQ(build_scene_image(mesh.view(), {4.0f, 6, TriangleFormat::kProjection}, need, image.bytes(), {}),
            Status::kBadParameter);
  EXPECT_EQ(build_scene_image(mesh.view(), {}, need, image.bytes().subspan(8), {}), Status::kBadParameter);
  TestMesh fewer = mesh;
  fewer.triangles.pop_back();
  EXPECT_EQ(build_scene_image(fewer.view(), {}, need, image.bytes(), {}), Status::kBadParameter);
  TestMesh more = mesh;
  more.triangles.push_back(more.triangles.front());
  EXPECT_EQ(build_scene_image(more.view(), {}, need, image.bytes(), {}), Status::kBadParameter);
}

TEST(Building, GivesTheSameBytesWhateverTheMemoryHeld) {
  const TestMesh mesh = make_random_soup(200, 0.2f, 33);
  for (const auto format : {TriangleFormat::kVertices, TriangleFormat::kProjection}) {
    const GridParameters parameters{4.0f, 6, format};
    const BuiltImage a = build_image(mesh.view(), parameters, std::byte{0x00});
    const BuiltImage b = build_image(mesh.view(), parameters, std::byte{0xFF});
    EXPECT_TRUE(same_bytes(a.image.bytes(), b.image.bytes()));
  }
}

// These values are part of the format: an image of version 2 has the same bytes on every host and compiler.
TEST(Building, GivesTheBytesItAlwaysGave) {
  const TestMesh mesh = moved(make_random_soup(500, 0.1f, 2024), 3.7f, Vec3(12, -7, 0.5f));
  EXPECT_EQ(build_image(mesh.view(), {4.0f, 6, TriangleFormat::kVertices}).view.header.check_value,
            12290666330452620476u);
  EXPECT_EQ(build_image(mesh.view(), {2.0f, 3, TriangleFormat::kProjection}).view.header.check_value,
            15648426833417652878u);
}

TEST(Building, StoresCornersBitForBitAndZeroesTheRest) {
  TestMesh mesh = make_random_soup(40, 0.3f, 3);
  mesh.vertices[5] = {-0.0f, 1e-45f, 0.25f};
  const BuiltImage built = build_image(mesh.view());
  ASSERT_FALSE(HasFailure());
  for (std::uint64_t i = 0; i < built.view.grid.reference_count; ++i) {
    const auto record =
        read_record<VertexTriangle>(built.image.bytes(), built.view.triangles_offset_bytes + i * kTriangleRecordBytes);
    const UVec3& t = mesh.triangles[record.triangle_id];
    for (int corner = 0; corner < 3; ++corner) {
      EXPECT_EQ(std::memcmp(record.v[corner], &mesh.vertices[t[corner]], 12), 0);
    }
  }
  // Padding: between the last record and the image's end, and behind the cells of every block.
  const auto bytes = built.image.bytes();
  const std::uint64_t end =
      built.view.triangles_offset_bytes + std::uint64_t{built.view.grid.reference_count} * kTriangleRecordBytes;
  for (std::size_t i = static_cast<std::size_t>(end); i < bytes.size(); ++i) EXPECT_EQ(bytes[i], std::byte{0});
  for (std::uint64_t block = 0; block < built.view.grid.cell_block_count; ++block) {
    const std::uint64_t base = built.view.cell_blocks_offset_bytes + block * built.view.grid.cell_block_bytes;
    for (std::uint64_t i = block == 0 ? 0 : 216 * sizeof(CellRecord); i < built.view.grid.cell_block_bytes; ++i) {
      EXPECT_EQ(bytes[static_cast<std::size_t>(base + i)], std::byte{0});
    }
  }
}

// --- What is dropped, what is refused -----------------------------------------------------------------------------

TEST(ZeroAreaTriangles, AreDroppedAndCountedAndKeepTheirIds) {
  TestMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {2, 0, 0}, {50, 50, 50}, {0.25f, 0.25f, 1}};
  mesh.triangles = {{0, 1, 3}, {4, 4, 4}, {0, 1, 2}, {1, 1, 2}, {0, 1, 5}, {2, 0, 2}};
  const BuiltImage built = build_image(mesh.view());
  ASSERT_FALSE(HasFailure());
  EXPECT_EQ(built.need.dropped_triangle_count, 4u);
  EXPECT_EQ(built.view.header.dropped_triangle_count, 4u);
  EXPECT_EQ(built.view.header.triangle_count, 6u);
  EXPECT_EQ(built.view.header.vertex_count, 6u);
  std::set<std::uint32_t> ids;
  for (const auto& cell : built.cells) ids.insert(cell.begin(), cell.end());
  EXPECT_EQ(ids, (std::set<std::uint32_t>{2, 4}));
  // What is dropped does not stretch the grid.
  EXPECT_EQ(built.view.grid.bounds_maximum[0], 1.0f);
  EXPECT_EQ(built.view.grid.bounds_maximum[2], 1.0f);
}

TEST(ZeroAreaTriangles, AloneAreNothingToTrace) {
  GridNeed need{};
  TestMesh mesh;
  EXPECT_EQ(count_scene_image(mesh.view(), {}, need), Status::kNoTriangles);
  mesh.vertices = {{1, 1, 1}, {2, 2, 2}, {3, 3, 3}};
  EXPECT_EQ(count_scene_image(mesh.view(), {}, need), Status::kNoTriangles);
  mesh.triangles = {{0, 0, 0}, {0, 1, 2}};
  EXPECT_EQ(count_scene_image(mesh.view(), {}, need), Status::kNoTriangles);
}

TEST(Errors, VerticesThatAreNoNumbers) {
  GridNeed need{};
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                          -std::numeric_limits<float>::infinity()}) {
    for (int axis = 0; axis < 3; ++axis) {
      TestMesh mesh = make_sphere(4, 5, 1.0f);
      mesh.vertices[3][axis] = bad;
      EXPECT_EQ(count_scene_image(mesh.view(), {}, need), Status::kBadVertex);
    }
  }
}

TEST(Errors, IndicesBeyondTheVertices) {
  GridNeed need{};
  for (int corner = 0; corner < 3; ++corner) {
    for (const std::uint32_t beyond : {0u, 1u, 0x7FFFFFFFu}) {
      TestMesh mesh = make_sphere(4, 5, 1.0f);
      mesh.triangles.back()[corner] = static_cast<std::uint32_t>(mesh.vertices.size()) + beyond;
      EXPECT_EQ(count_scene_image(mesh.view(), {}, need), Status::kBadIndex);
    }
  }
}

TEST(Errors, Parameters) {
  GridNeed need{};
  const TestMesh mesh = make_sphere(4, 5, 1.0f);
  const auto status = [&](float lambda, std::uint32_t m, std::uint32_t format) {
    return count_scene_image(mesh.view(), {lambda, m, static_cast<TriangleFormat>(format)}, need);
  };
  EXPECT_EQ(status(0.0f, 6, 1), Status::kBadParameter);
  EXPECT_EQ(status(-1.0f, 6, 1), Status::kBadParameter);
  EXPECT_EQ(status(1.01e6f, 6, 1), Status::kBadParameter);
  EXPECT_EQ(status(std::numeric_limits<float>::quiet_NaN(), 6, 1), Status::kBadParameter);
  EXPECT_EQ(status(4.0f, 0, 1), Status::kBadParameter);
  EXPECT_EQ(status(4.0f, kMaxMacroWidth + 1, 1), Status::kBadParameter);
  EXPECT_EQ(status(4.0f, 6, 0), Status::kBadParameter);
  EXPECT_EQ(status(4.0f, 6, 4), Status::kBadParameter);
  EXPECT_EQ(status(1e-6f, 1, 1), Status::kOk);
  EXPECT_EQ(status(1e5f, 8, 2), Status::kOk);
  EXPECT_EQ(status(1e5f, 8, 3), Status::kOk);
}

TEST(Errors, MoreTrianglesThanIdsAreRefusedUnread) {
  GridNeed need{};
  const UVec3 one(0, 0, 0);
  const Vec3 vertex(0, 0, 0);
  const MeshView triangles{{&vertex, 1}, {&one, std::size_t{1} << 32}};
  EXPECT_EQ(count_scene_image(triangles, {}, need), Status::kTooManyTriangles);
  const MeshView vertices{{&vertex, std::size_t{1} << 32}, {&one, 1}};
  EXPECT_EQ(count_scene_image(vertices, {}, need), Status::kTooManyTriangles);
}

TEST(Errors, MoreReferencesThanThirtyTwoBits) {
  TestMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
  for (int i = 0; i < 2100; ++i) mesh.triangles.emplace_back(i % 2, 1 + i % 2, 2 + i % 2);
  GridNeed need{};
  EXPECT_EQ(count_scene_image(mesh.view(), {3000.0f, 8, TriangleFormat::kVertices}, need), Status::kTooManyTriangles);
  mesh.triangles.resize(1900);
  ASSERT_EQ(count_scene_image(mesh.view(), {3000.0f, 8, TriangleFormat::kVertices}, need), Status::kOk);
  EXPECT_EQ(need.grid.cell_count[0], kMaxCellsPerAxis);
  EXPECT_GT(need.grid.reference_count, 3900000000u);
  EXPECT_GT(need.image_bytes, std::uint64_t{1} << 37);
}

// --- The greatest lambda that fits --------------------------------------------------------------------------------

// Halves lambda and counts everything each time: the expected result of fit_scene_image.
GridNeed halved_need(const MeshView& mesh, GridParameters parameters, std::uint64_t most_bytes) {
  GridNeed need{};
  for (;;) {
    const Status status = count_scene_image(mesh, parameters, need);
    EXPECT_TRUE(status == Status::kOk || status == Status::kTooManyTriangles);
    const bool has_one_cell =
        need.grid.cell_count[0] == 1 && need.grid.cell_count[1] == 1 && need.grid.cell_count[2] == 1;
    if ((status == Status::kOk && need.image_bytes <= most_bytes) || has_one_cell) return need;
    if (parameters.lambda <= 1e-6f) return need;
    parameters.lambda = std::max(parameters.lambda * 0.5f, 1e-6f);
  }
}

TestMesh random_triangles(std::uint32_t count, Vec3 spread, float size) {
  TestRandom random(7);
  TestMesh mesh;
  for (std::uint32_t i = 0; i < count; ++i) {
    const Vec3 place(random.unit() * spread.x, random.unit() * spread.y, random.unit() * spread.z);
    Vec3 corners[3];
    for (Vec3& corner : corners) {
      for (int axis = 0; axis < 3; ++axis) corner[axis] = place[axis] + size * random.unit();
    }
    mesh.append(make_triangle(corners[0], corners[1], corners[2]));
  }
  return mesh;
}

TEST(Fit, FindsWhatHalvingFinds) {
  TestMesh same;
  for (int i = 0; i < 100; ++i) same.append(make_triangle({0, 0, 0}, {1, 0.25f, 0.5f}, {0.25f, 1, 0.75f}));
  TestMesh stadium = random_triangles(100, {0.01f, 0.01f, 0.01f}, 0.001f);
  stadium.append(random_triangles(3, {0, 0, 0}, 100.0f));
  TestMesh extreme = random_triangles(100, {1, 1, 1}, 1.0f);
  extreme.transform(0x1p118f, {0, 0, 0});
  const TestMesh meshes[] = {random_triangles(100, {1, 1, 1}, 0.02f),
                             random_triangles(100, {0, 0, 0}, 1.0f),
                             random_triangles(100, {1, 1, 0}, 0.1f),
                             make_sliver_fan(100, 1e-3f),
                             make_height_field(12, 0.2f, 1),
                             same,
                             stadium,
                             extreme};
  for (const TestMesh& mesh : meshes) {
    for (const TriangleFormat format :
         {TriangleFormat::kVertices, TriangleFormat::kProjection, TriangleFormat::kLattice}) {
      const GridParameters wanted{20.0f, 2, format};
      GridNeed need{};
      ASSERT_EQ(count_scene_image(mesh.view(), wanted, need), Status::kOk);
      std::set<std::uint64_t> budgets = {0, 1000, need.image_bytes, need.image_bytes - 1, ~std::uint64_t{0}};
      for (std::uint64_t bytes = need.image_bytes; bytes > 4096; bytes = bytes / 4 * 3) budgets.insert(bytes);
      for (const std::uint64_t budget : budgets) {
        const GridNeed expected = halved_need(mesh.view(), wanted, budget);
        GridNeed found{};
        ASSERT_EQ(fit_scene_image(mesh.view(), wanted, budget, found), Status::kOk);
        EXPECT_EQ(std::memcmp(&found.grid, &expected.grid, sizeof(GridRecord)), 0) << "budget " << budget;
        EXPECT_EQ(found.image_bytes, expected.image_bytes);
        EXPECT_EQ(found.dropped_triangle_count, expected.dropped_triangle_count);
        EXPECT_EQ(std::memcmp(&found.steps, &expected.steps, sizeof(GridSteps)), 0);
      }
    }
  }
}

// 30 halvings, most of them of grids with more references than 32 bits hold.
TEST(Fit, DoesNotCountWhatCannotFit) {
  TestMesh mesh = make_triangle({0, 0, 0}, {1, 0.25f, 0.5f}, {0.25f, 1, 0.75f});
  mesh.triangles.resize(100000, mesh.triangles[0]);
  GridNeed need{};
  ASSERT_EQ(fit_scene_image(mesh.view(), {1e6f, 6, TriangleFormat::kVertices}, 64u << 20, need), Status::kOk);
  EXPECT_LE(need.image_bytes, 64u << 20);
  EXPECT_GT(need.image_bytes, 16u << 20);
}

// --- Counts with a limit, and with memory of their own ------------------------------------------------------------

TEST(Count, EndsWhereTheImageCannotFit) {
  const TestMesh few[] = {random_triangles(100, {1, 1, 1}, 0.02f), random_triangles(100, {0, 0, 0}, 1.0f),
                          make_sliver_fan(100, 1e-3f)};
  for (const TestMesh& mesh : few) {
    for (const TriangleFormat format : {TriangleFormat::kVertices, TriangleFormat::kLattice}) {
      const GridParameters parameters{20.0f, 2, format};
      GridNeed exact{}, need{};
      ASSERT_EQ(count_scene_image(mesh.view(), parameters, exact), Status::kOk);
      ASSERT_EQ(count_scene_image(mesh.view(), parameters, need, nullptr, exact.image_bytes), Status::kOk);
      EXPECT_EQ(need.image_bytes, exact.image_bytes);
      for (const std::uint64_t most : {exact.image_bytes - 1, exact.image_bytes / 2, std::uint64_t{0}}) {
        ASSERT_EQ(count_scene_image(mesh.view(), parameters, need, nullptr, most), Status::kMemoryTooSmall);
        EXPECT_GT(need.image_bytes, most);
        EXPECT_LE(need.image_bytes, exact.image_bytes);
      }
    }
  }
  // Counted to the end, each of them takes minutes.
  TestMesh mesh = make_triangle({0, 0, 0}, {1, 0.25f, 0.5f}, {0.25f, 1, 0.75f});
  mesh.triangles.resize(100000, mesh.triangles[0]);
  GridNeed need{};
  const GridParameters hopeless{1e6f, 6, TriangleFormat::kVertices};
  EXPECT_EQ(count_scene_image(mesh.view(), hopeless, need, nullptr, 64u << 20), Status::kMemoryTooSmall);
  EXPECT_GT(need.image_bytes, std::uint64_t{1} << 40);
  EXPECT_EQ(count_scene_image(mesh.view(), hopeless, need), Status::kTooManyTriangles);
}

// Windows that begin with a macrocell of which every triangle lies in it alone.
TEST(Count, ASweepCountsTheMacrocellThatItBeginsWith) {
  TestMesh mesh = make_triangle({0, 0, 0}, {0.01f, 0, 0}, {0, 0.01f, 0.01f});
  for (int i = 1; i < 41; ++i) {
    const auto at = static_cast<float>(i);
    mesh.append(make_triangle({at, at, at}, {at + 0.01f, at, at}, {at, at + 0.01f, at + 0.01f}));
  }
  GridNeed need{}, swept{};
  std::uint64_t marks[1];
  ASSERT_EQ(count_scene_image(mesh.view(), {64.0f, 1}, need), Status::kOk);
  ASSERT_EQ(count_scene_image(mesh.view(), {64.0f, 1}, swept, nullptr, kAnyImageBytes, marks), Status::kOk);
  EXPECT_EQ(swept.grid.cell_block_count, need.grid.cell_block_count);
}

TEST(Count, MarksSaveSweepsAndChangeNothingElse) {
  const TestMesh mesh = make_sliver_fan(100, 1e-3f);
  const GridParameters parameters{3000.0f, 1, TriangleFormat::kVertices};
  GridNeed expected{};
  ASSERT_EQ(count_scene_image(mesh.view(), parameters, expected), Status::kOk);
  EXPECT_GT(expected.steps.sweep_count, 1u);
  for (const std::size_t words : {32u, 256u, 1u << 16}) {
    std::vector<std::uint64_t> marks(words, ~std::uint64_t{0});
    GridNeed need{};
    ASSERT_EQ(count_scene_image(mesh.view(), parameters, need, nullptr, kAnyImageBytes, marks), Status::kOk);
    EXPECT_EQ(std::memcmp(&need.grid, &expected.grid, sizeof(GridRecord)), 0);
    EXPECT_EQ(need.image_bytes, expected.image_bytes);
    EXPECT_EQ(need.steps.sweep_count > expected.steps.sweep_count, words < 256);
    EXPECT_EQ(need.steps.sweep_count == 1, words > 256);
    EXPECT_EQ(need.steps.row_count, expected.steps.row_count);
  }
}

// --- Shapes of scenes ---------------------------------------------------------------------------------------------

TEST(Scenes, IdenticalTrianglesStandInOrder) {
  TestMesh mesh = make_triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  mesh.triangles.assign(5000, mesh.triangles[0]);
  const BuiltImage built = build_image(mesh.view(), {0.001f, 6, TriangleFormat::kVertices});
  ASSERT_FALSE(HasFailure());
  int full = 0;
  for (const auto& ids : built.cells) {
    if (ids.empty()) continue;
    ++full;
    ASSERT_EQ(ids.size(), 5000u);
    for (std::uint32_t i = 0; i < 5000; ++i) ASSERT_EQ(ids[i], i);
  }
  EXPECT_GE(full, 3);
}

TEST(Scenes, ReferencesAndBytesGrowLinearly) {
  double previous = 0;
  double previous_bytes = 0;
  for (const std::uint32_t cells : {64u, 128u, 256u}) {
    const TestMesh mesh = make_height_field(cells, 0.3f, 9);
    GridNeed need{};
    ASSERT_EQ(count_scene_image(mesh.view(), {}, need), Status::kOk);
    const double per_triangle = need.grid.reference_count / static_cast<double>(mesh.triangles.size());
    const double bytes = static_cast<double>(need.image_bytes) / static_cast<double>(mesh.triangles.size());
    if (previous > 0) {
      EXPECT_NEAR(per_triangle / previous, 1.0, 0.25) << cells;
      EXPECT_NEAR(bytes / previous_bytes, 1.0, 0.35) << cells;
    }
    previous = per_triangle;
    previous_bytes = bytes;
  }
}

TEST(Scenes, ScansBuildAndOpen) {
  struct Expected {
    const char* name;
    std::uint32_t dropped;
  };
  for (const Expected& expected : {Expected{"bunny.ply", 0}, Expected{"conference.ply", 53627},
                                   Expected{"sponza_dabrovic.ply", 1}, Expected{"teapot_in_stadium.ply", 0}}) {
    const SharedFile file = find_scene(expected.name);
    GRIDIRON_SKIP_IF_MISSING(file);
    const auto mesh = load_ply(file.path);
    ASSERT_TRUE(mesh.has_value()) << expected.name;
    const BuiltImage built = build_image(mesh->view());
    ASSERT_FALSE(HasFailure()) << expected.name;
    EXPECT_EQ(built.need.dropped_triangle_count, expected.dropped) << expected.name;
    std::vector<bool> kept(mesh->triangles.size());
    for (const auto& ids : built.cells) {
      for (const std::uint32_t id : ids) kept[id] = true;
    }
    EXPECT_EQ(static_cast<std::size_t>(std::count(kept.begin(), kept.end(), false)), expected.dropped) << expected.name;
  }
}

}  // namespace
}  // namespace gridiron::test
