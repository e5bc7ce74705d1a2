// Tiles of eye rays through the tree show, pixel by pixel, what exact arithmetic finds triangle by triangle.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/base/one_lane.h>
#include <gridiron/build/triangle_records.h>
#include <gridiron/engine/tree/tile_tracer.h>
#include <gridiron/frame/frame_setup.h>

#include <cmath>

#include "core/lane_types.h"
#include "numeric/rounding_scope.h"
#include "support/memory_tree.h"
#include "support/test_mesh.h"

namespace gridiron::test {
namespace {

constexpr std::uint32_t kWidth = 32;

struct View {
  FrameHead frame{};
  float dx = 0, dy = 0;
};

View view_of(const Camera& camera, std::uint32_t width, std::uint32_t height) {
  FrameSettings settings;
  settings.camera = camera;
  settings.width = width;
  settings.height = height;
  settings.color = MainAddress{4096};
  View view;
  EXPECT_EQ(make_frame_head(settings, view.frame), Status::kOk);
  return view;
}

// What a pixel shows.
struct Shown {
  std::uint32_t id = kNoTriangle;
  float distance = kFloatMax;  // times the direction's length
  float facing = 0;
  bool operator==(const Shown&) const = default;
};
std::ostream& operator<<(std::ostream& out, const Shown& shown) {
  return out << shown.id << " at " << shown.distance << " facing " << shown.facing;
}

std::vector<VertexTriangle> triangles_of(const TestMesh& mesh) {
  std::vector<VertexTriangle> triangles;
  for (std::uint32_t id = 0; id < mesh.triangles.size(); ++id) {
    const UVec3& t = mesh.triangles[id];
    if (has_zero_area(mesh.vertices[t.x], mesh.vertices[t.y], mesh.vertices[t.z])) continue;
    VertexTriangle triangle{};
    triangle.triangle_id = id;
    for (int corner = 0; corner < 3; ++corner) {
      for (int axis = 0; axis < 3; ++axis) triangle.v[corner][axis] = mesh.vertices[t[corner]][axis];
    }
    triangles.push_back(triangle);
  }
  return triangles;
}

BatchRay ray_of(const View& view, std::uint32_t x, std::uint32_t y) {
  BatchRay ray{};
  for (int axis = 0; axis < 3; ++axis) {
    ray.origin[axis] = view.frame.eye[axis];
    ray.dir[axis] = pixel_direction(view.frame, axis, static_cast<float>(x) + view.dx, static_cast<float>(y) + view.dy);
    ray.dir_max = std::max(ray.dir_max, std::fabs(ray.dir[axis]));
  }
  return ray;
}

Shown shown_by(const BatchRay& ray, const VertexTriangle& triangle, float t) {
  const float length = square_root((ray.dir[0] * ray.dir[0] + ray.dir[1] * ray.dir[1]) + ray.dir[2] * ray.dir[2]);
  float normal[3];
  set_up_normal(triangle, normal);
  return {triangle.triangle_id, t * length,
          std::fabs(normal[0] * ray.dir[0] + normal[1] * ray.dir[1] + normal[2] * ray.dir[2]) / length};
}

// Every triangle, by exact signs and correctly rounded distances; of equal ones the lowest id, or the nearer one.
Shown exact_pixel(const std::vector<VertexTriangle>& triangles, const View& view, std::uint32_t x, std::uint32_t y) {
  WorkCounters work;
  const BatchRay ray = ray_of(view, x, y);
  const VertexTriangle* nearest = nullptr;
  float t = view.frame.t_far;
  for (const VertexTriangle& triangle : triangles) {
    if (!passes_through(ray, triangle, work)) continue;
    const float distance = ray_distance(ray, triangle, work);
    if (!(distance > 0) || distance > t) continue;
    if (nearest != nullptr && distance == t) {
      const bool is_exact = view.frame.accuracy == static_cast<std::uint32_t>(Accuracy::kExact);
      if (!is_exact || !comes_first_exactly(ray.origin, ray.dir, triangle, *nearest, false, work)) continue;
    }
    nearest = &triangle;
    t = distance;
  }
  return nearest == nullptr ? Shown{} : shown_by(ray, *nearest, t);
}

struct Planes {
  alignas(128) std::uint32_t id[kWidth * kWidth];
  alignas(128) float distance[kWidth * kWidth];
  alignas(128) float facing[kWidth * kWidth];
};

// Two tracers take turns, each with every other tile.
template <class L>
std::vector<Shown> traced(MemoryTree& tree, const View& view, WorkCounters& work, bool has_planes = true) {
  // No more memory than the lanes take.
  static constexpr std::uint32_t kMostLanes = L::kCount < 4 ? 4 : L::kCount;
  using Tracer = TileTracer<L, kWidth, MemoryTree, kMostLanes>;
  const auto memories = std::make_unique<std::array<TileMemory<kWidth, kMostLanes>, 2>>();
  const auto planes = std::make_unique<Planes>();
  Tracer tracers[2] = {{(*memories)[0], tree, work}, {(*memories)[1], tree, work}};
  const FrameHead& frame = view.frame;
  const EyeProjection eye = project_eye(frame, tree.largest());
  std::vector<Shown> shown(std::size_t{frame.width} * frame.height);
  std::vector<TileView> tiles;
  for (std::uint32_t y = 0; y < frame.height; y += kWidth) {
    for (std::uint32_t x = 0; x < frame.width; x += kWidth) tiles.push_back({x, y, view.dx, view.dy});
  }
  for (std::size_t first = 0; first < tiles.size(); first += 2) {
    const std::size_t count = std::min<std::size_t>(2, tiles.size() - first);
    for (std::size_t i = 0; i < count; ++i) {
      EXPECT_EQ(tracers[i].begin(frame, eye, tiles[first + i], {has_planes, has_planes}), Status::kOk);
    }
    for (bool goes_on = true; goes_on;) {
      goes_on = false;
      for (std::size_t i = 0; i < count; ++i) {
        if (!tracers[i].has_more()) continue;
        EXPECT_EQ(tracers[i].step(), Status::kOk);
        goes_on = true;
      }
    }
    for (std::size_t i = 0; i < count; ++i) {
      EXPECT_EQ(tracers[i].finish(), Status::kOk);
      tracers[i].store_hits(
          0, 0, kWidth, {planes->id, has_planes ? planes->distance : nullptr, has_planes ? planes->facing : nullptr});
      const TileView& tile = tiles[first + i];
      for (std::uint32_t y = 0; y < kWidth && tile.top + y < frame.height; ++y) {
        for (std::uint32_t x = 0; x < kWidth && tile.left + x < frame.width; ++x) {
          const std::uint32_t pixel = y * kWidth + x;
          Shown& to = shown[std::size_t{tile.top + y} * frame.width + tile.left + x];
          to.id = planes->id[pixel];
          if (!has_planes || to.id == kNoTriangle) continue;
          to.distance = planes->distance[pixel];
          to.facing = planes->facing[pixel];
        }
      }
    }
  }
  return shown;
}

template <class L>
void expect_exact(const TestMesh& mesh, const View& view, std::uint32_t leaf = 8) {
  MemoryTree tree(mesh.view(), leaf);
  ASSERT_EQ(tree.status(), Status::kOk);
  const std::vector<VertexTriangle> triangles = triangles_of(mesh);
  WorkCounters work;
  const std::vector<Shown> shown = traced<L>(tree, view, work);
  const std::vector<Shown> ids = traced<L>(tree, view, work, false);
  for (std::uint32_t y = 0; y < view.frame.height; ++y) {
    for (std::uint32_t x = 0; x < view.frame.width; ++x) {
      const std::size_t pixel = std::size_t{y} * view.frame.width + x;
      const Shown exact = exact_pixel(triangles, view, x, y);
      ASSERT_EQ(shown[pixel], exact) << x << ", " << y;
      ASSERT_EQ(ids[pixel].id, exact.id) << x << ", " << y;
    }
  }
}

struct NamedMesh {
  const char* name;
  TestMesh mesh;
};
std::vector<NamedMesh> hard_meshes() {
  const TestMesh torus = make_torus(24, 12, 1.0f, 0.35f), soup = make_random_soup(300, 0.3f, 2);
  // Vertices lie on rays of the pixels of a camera that looks along z with steps of 1 / 16.
  TestMesh grid = make_height_field(16, 0.0f, 1);
  for (Vec3& p : grid.vertices) p = {p.x * 2.0f, p.z * 2.0f, -4.0f};
  return {{"torus", torus},
          {"soup", soup},
          {"twice", joined(soup, soup)},
          {"flat", make_height_field(12, 0.0f, 1)},
          {"boxes", joined(make_box({0, 0, 0}, {1, 1, 1}), make_box({1, 0, 0}, {2, 1, 1}))},
          {"slivers", make_sliver_fan(200, 1e-6f)},
          {"on rays", grid},
          {"crossing", make_random_soup(60, 40.0f, 5)},
          {"stadium", joined(moved(torus, 1e-2f), make_box({-100, -1, -100}, {100, 50, 100}))}};
}

const Camera kCameras[] = {
    {.eye = {0.0f, 0.0f, 4.0f}, .at = {0.0f, 0.0f, 0.0f}, .up = {0.0f, 1.0f, 0.0f}, .tan_half_fov = 0.5f},
    {.eye = {1.3f, 2.1f, -1.7f}, .at = {0.1f, 0.0f, 0.2f}, .up = {0.0f, 1.0f, 0.0f}, .tan_half_fov = 0.7f},
    {.eye = {0.2f, 0.0f, 0.1f}, .at = {1.0f, 0.0f, 0.3f}, .up = {0.0f, 1.0f, 0.0f}, .tan_half_fov = 2.0f},
    {.eye = {300.0f, 40.0f, 77.0f}, .at = {0.0f, 0.0f, 0.0f}, .up = {0.3f, 1.0f, 0.1f}, .tan_half_fov = 0.004f}};

template <class L>
class TileTracerTest : public testing::Test {};
TYPED_TEST_SUITE(TileTracerTest, ListLaneTypes);

TYPED_TEST(TileTracerTest, EveryPixelIsThatOfExactArithmetic) {
  for (const NamedMesh& tested : hard_meshes()) {
    SCOPED_TRACE(tested.name);
    for (const Camera& camera : kCameras) {
      SCOPED_TRACE(camera.eye.x);
      expect_exact<TypeParam>(tested.mesh, view_of(camera, 45, 37));
    }
  }
}

// So large or so small that w has a unit of its own.
TYPED_TEST(TileTracerTest, EveryPixelOfExtremeScenesToo) {
  for (const float scale : {0x1p28f, 0x1p-40f}) {
    for (const NamedMesh& tested : hard_meshes()) {
      SCOPED_TRACE(tested.name);
      for (const int number : {0, 3}) {
        Camera camera = kCameras[number];
        camera.eye *= scale;
        camera.at *= scale;
        expect_exact<TypeParam>(moved(tested.mesh, scale), view_of(camera, 45, 37));
      }
    }
  }
}

TYPED_TEST(TileTracerTest, AnyScalePlaceLeafAndPointOfThePixel) {
  const TestMesh soup = make_random_soup(120, 0.4f, 7);
  for (const float scale : {1.0f, 0x1p-20f, 0x1p18f, 0x1p26f, 0x1p-60f, 0x1p50f}) {
    SCOPED_TRACE(scale);
    Camera camera = kCameras[0];
    camera.eye *= scale;
    View view = view_of(camera, 33, 20);
    const EyeProjection eye = project_eye(view.frame, 2.0f * scale);
    EXPECT_TRUE(eye.is_trusted);
    EXPECT_EQ(eye.unit == 1.0f, scale > 0x1p-22f && scale < 0x1p20f);
    view.frame.t_far = 4.0f * scale;
    expect_exact<TypeParam>(moved(soup, scale), view);
  }
  for (const float scale : {0x1p-90f, 0x1p90f}) {
    EXPECT_FALSE(project_eye(view_of({.eye = {0, 0, 4.0f * scale}}, 33, 20).frame, scale).has_bounds) << scale;
  }
  const Vec3 place(4e4f, -3e4f, 1e4f);
  Camera camera = kCameras[0];
  camera.eye += place;
  camera.at += place;
  View view = view_of(camera, 33, 20);
  expect_exact<TypeParam>(moved(soup, 1.0f, place), view);
  view.dx = 0.28125f;
  view.dy = -0.46875f;
  for (const std::uint32_t leaf : {1u, 3u, 16u}) expect_exact<TypeParam>(moved(soup, 1.0f, place), view, leaf);
}

TYPED_TEST(TileTracerTest, RoundingModesAndFlushedDenormalsChangeNoHit) {
  const TestMesh torus = make_torus(16, 8, 1.0f, 0.35f);
  for (const int mode : kRoundingModes) {
    for (const bool flushes : {false, true}) {
      SCOPED_TRACE(mode);
      const RoundingScope scope(mode, flushes);
      expect_exact<TypeParam>(torus, view_of(kCameras[1], 40, 32));
      expect_exact<TypeParam>(hard_meshes()[6].mesh, view_of(kCameras[0], 32, 32));
    }
  }
}

// Of triangles at one rounded distance the lowest id is hit, or with kExact the one that is nearer.
TYPED_TEST(TileTracerTest, TiesAreBroken) {
  TestMesh mesh = make_triangle({-1, -1, -1}, {1, -1, -1}, {0, 1, -1});
  const float behind = -1.0f - 0x1p-24f;  // rounds to the same distance
  TestMesh close = make_triangle({-1, -1, -1}, {1, -1, -1}, {0, 1, behind});
  View view = view_of({.eye = {0, 0, 4}, .at = {0, 0, 0}, .up = {0, 1, 0}, .tan_half_fov = 0.3f}, 32, 32);
  for (const Accuracy accuracy : {Accuracy::kStandard, Accuracy::kExact}) {
    view.frame.accuracy = static_cast<std::uint32_t>(accuracy);
    expect_exact<TypeParam>(joined(mesh, close), view);
    expect_exact<TypeParam>(joined(close, mesh), view);
  }
}

// All at one distance: what was drawn before in a triangle's blocks does not hide it.
TYPED_TEST(TileTracerTest, OfFlatPatchesTheLowestIdIsHit) {
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    TestMesh mesh = joined(make_random_soup(300, 0.9f, seed), make_random_soup(1500, 0.4f, seed + 10));
    for (Vec3& p : mesh.vertices) p.z = 0;
    expect_exact<TypeParam>(mesh, view_of(kCameras[0], 45, 37));
    mesh = joined(make_random_soup(1500, 0.4f, seed), make_random_soup(300, 0.9f, seed + 10));
    for (Vec3& p : mesh.vertices) p.z = 0;
    expect_exact<TypeParam>(mesh, view_of(kCameras[0], 45, 37));
  }
}

// Walls of a few blocks hide triangles behind them, and no others.
TYPED_TEST(TileTracerTest, BlocksHideWhatIsBehindThem) {
  TestMesh walls = make_random_soup(40, 1.5f, 4);
  for (Vec3& p : walls.vertices) p.z = 1.5f + 0.1f * p.z;
  const TestMesh mesh = joined(walls, make_random_soup(2000, 0.35f, 5));
  for (const Camera& camera : kCameras) expect_exact<TypeParam>(mesh, view_of(camera, 45, 37));
}

// Every box of a tile's pixels.
TYPED_TEST(TileTracerTest, BoxesAreAsNearAsTheLeastOfTheirBlocks) {
  if constexpr (TypeParam::kCount != 1) {
    using Int = typename TypeParam::Int;
    constexpr std::uint32_t kLanes = TypeParam::kCount, kRow = kWidth / kBlockWidth;
    const auto memory = std::make_unique<TileMemory<kWidth, kLanes < 4 ? 4 : kLanes>>();
    for (std::uint32_t block = 0; block < kRow * kRow; ++block) {
      memory->least_near[block] = static_cast<float>(block * 37 % 64 + 2);
    }
    alignas(64) std::uint32_t box[4][kLanes] = {};
    alignas(64) float wanted[kLanes] = {}, found[kLanes];
    std::uint32_t count = 0;
    const auto check = [&] {
      least_near_of_boxes<TypeParam>(*memory, Int::load(box[0]), Int::load(box[1]), Int::load(box[2]),
                                     Int::load(box[3]), 1.0f)
          .store(found);
      for (std::uint32_t i = 0; i < count; ++i) {
        ASSERT_EQ(found[i], wanted[i]) << box[0][i] << ", " << box[1][i] << " to " << box[2][i] << ", " << box[3][i];
      }
      count = 0;
    };
    for (std::uint32_t y0 = 0; y0 < kWidth; ++y0) {
      for (std::uint32_t y1 = y0; y1 < kWidth; ++y1) {
        for (std::uint32_t x0 = 0; x0 < kWidth; ++x0) {
          for (std::uint32_t x1 = x0; x1 < kWidth; ++x1) {
            const std::uint32_t bx0 = x0 / kBlockWidth, by0 = y0 / kBlockWidth, bx1 = x1 / kBlockWidth,
                                by1 = y1 / kBlockWidth;
            float least = kFloatMax;
            for (std::uint32_t by = by0; by <= by1; ++by) {
              for (std::uint32_t bx = bx0; bx <= bx1; ++bx) {
                least = std::min(least, memory->least_near[by * kRow + bx]);
              }
            }
            const std::uint32_t sides[4] = {x0, y0, x1, y1};
            for (int i = 0; i < 4; ++i) box[i][count] = sides[i];
            wanted[count] = bx1 - bx0 < 2 && by1 - by0 < 2 ? least : 1.0f;
            if (++count == kLanes) check();
            if (testing::Test::HasFatalFailure()) return;
          }
        }
      }
    }
    check();
  }
}

TYPED_TEST(TileTracerTest, HitsBeyondTheFarEndDoNotCount) {
  View view = view_of(kCameras[0], 32, 32);
  for (const float t_far : {3.2f, 4.0f, 4.5f}) {
    view.frame.t_far = t_far;
    expect_exact<TypeParam>(make_torus(16, 8, 1.0f, 0.35f), view);
  }
}

// A wall of squares of a pixel each, whose sides are a little beside the pixels' centres, at t = 1 from the eye on.
TestMesh wall_of_pixels(const View& view) {
  TestMesh mesh;
  const auto side = [](std::uint32_t i) { return i + (i % 2 == 0 ? -0.06 : 0.06); };
  const std::uint32_t columns = view.frame.width + 2, rows = view.frame.height + 2;
  for (std::uint32_t row = 0; row < rows; ++row) {
    for (std::uint32_t column = 0; column < columns; ++column) {
      Vec3 place;
      for (int axis = 0; axis < 3; ++axis) {
        const double direction = double{view.frame.corner[axis]} +
                                 (side(column) - 1) * double{view.frame.step_x[axis]} +
                                 (side(row) - 1) * double{view.frame.step_y[axis]};
        place[axis] = static_cast<float>(double{view.frame.eye[axis]} + direction * 312.0);
      }
      mesh.vertices.push_back(place);
    }
  }
  for (std::uint32_t row = 0; row + 1 < rows; ++row) {
    for (std::uint32_t column = 0; column + 1 < columns; ++column) {
      const std::uint32_t first = row * columns + column;
      mesh.triangles.emplace_back(first, first + 1, first + columns);
      mesh.triangles.emplace_back(first + columns, first + 1, first + columns + 1);
    }
  }
  return mesh;
}

// A view whose pixels are `step` apart at w = 1, somewhere off the z axis; what it sees lies around the origin, its
// boxes along columns and rows.
View narrow_view(double step) {
  View view = view_of(kCameras[0], 45, 37);
  const double corner[3] = {-1.1, -0.7, -1.0}, steps[2] = {step, -step};
  for (int axis = 0; axis < 3; ++axis) {
    view.frame.corner[axis] = static_cast<float>(corner[axis]);
    view.frame.eye[axis] = -312.0f * view.frame.corner[axis];
    view.frame.step_x[axis] = axis == 0 ? static_cast<float>(steps[0]) : 0.0f;
    view.frame.step_y[axis] = axis == 1 ? static_cast<float>(steps[1]) : 0.0f;
  }
  return view;
}

// Views so narrow that roundings move directions by a good part of a pixel: from where the usual margins are too narrow
// to where no bound is worth it.
TYPED_TEST(TileTracerTest, NarrowViewsHaveWiderMargins) {
  const TestMesh soup = make_random_soup(90, 0.4f, 7);
  const auto moved_by = [](const View& view) {
    return moved_pixels(view.frame, project_eye(view.frame, 1.0f)).pixels;
  };
  for (const double largest : {0.012, 0.1, 1.4}) {
    SCOPED_TRACE(largest);
    double step = 1e-3;
    while (moved_by(narrow_view(step)) < largest) step *= 0.95;
    const View view = narrow_view(step);
    const EyeProjection eye = project_eye(view.frame, 1.0f);
    ASSERT_TRUE(eye.has_bounds && !eye.is_trusted) << moved_by(view);
    const float scale = 312.0f * 22.0f * static_cast<float>(step);
    const Vec3 middle(scale, -0.8f * scale, 0.0f);
    for (const TestMesh& mesh :
         {moved(make_torus(16, 8, 1.0f, 0.4f), scale, middle), moved(soup, scale, middle),
          joined(moved(soup, 0.5f * scale, middle), moved(soup, 0.5f * scale, middle)),
          joined(moved(soup, scale, middle), make_box(Vec3(-40.0f), Vec3(40.0f)))}) {
      expect_exact<TypeParam>(mesh, view, 1);
      MemoryTree tree(mesh.view(), 8);
      WorkCounters work;
      static_cast<void>(traced<TypeParam>(tree, view, work));
      const std::uint32_t open = work.counts[WorkId(TileWork::kOpenPixel).number()];
      EXPECT_LT(4u * open, mesh.triangles.size() * view.frame.width * view.frame.height);
    }
  }
}

// Sides of triangles between where directions are and where they should be, at tiles' sides too.
TYPED_TEST(TileTracerTest, NarrowViewsHaveNoHoles) {
  for (double step = 4.2e-7; step > 3.7e-7; step *= 0.985) {
    View view = narrow_view(step);
    view.frame.width = view.frame.height = 34;
    ASSERT_TRUE(project_eye(view.frame, 1.0f).has_bounds);
    expect_exact<TypeParam>(wall_of_pixels(view), view, 1);
  }
}

// A camera whose pixels nearly lie on a line has no bound that is worth it: every pixel is decided exactly.
TYPED_TEST(TileTracerTest, WithoutBoundsExactArithmeticDecides) {
  View view = view_of(kCameras[0], 12, 9);
  for (int axis = 0; axis < 3; ++axis) view.frame.step_y[axis] = view.frame.step_x[axis] * 1.0001f;
  ASSERT_FALSE(project_eye(view.frame, 1.0f).has_bounds);
  expect_exact<TypeParam>(make_random_soup(40, 0.5f, 3), view);
}

// Large pictures have bounds too, and no tile's directions are off by more than they allow.
TEST(EyeProjection, IsTrustedWhereEveryTilesDirectionsAre) {
  for (const Camera& camera : kCameras) {
    for (const std::uint32_t size : {8u, 45u, 1024u, 4096u, 16'384u}) {
      const FrameHead frame = view_of(camera, size, size).frame;
      const EyeProjection eye = project_eye(frame, 2.0f);
      EXPECT_TRUE(eye.is_trusted || size > 4096 || (size > 45 && camera.tan_half_fov < 0.1f)) << size;
      const MovedPixels most = moved_pixels(frame, eye);
      EXPECT_EQ(eye.is_trusted, most.pixels < kUsuallyMoved) << size;
      EXPECT_EQ(eye.has_bounds, most.pixels < kMostMoved) << size;
      float greatest = 0;
      for (std::uint32_t width = 8; width <= kMostTileWidth; width *= 2) {
        for (const std::uint32_t left : {0u, size / 2 / width * width, size - 1 - (size - 1) % width}) {
          for (const std::uint32_t top : {0u, size - 1 - (size - 1) % width}) {
            TileProjection tile;
            project_tile(frame, eye, {left, top, -0.5f, 0.5f}, width, tile);
            greatest = std::max(greatest, tile.direction_error);
            ASSERT_LE(tile.w_error, most.w);
          }
        }
      }
      EXPECT_LE(greatest, most.pixels);
      EXPECT_GT(greatest, 0.2 * most.pixels) << size;
    }
  }
}

// Accuracy::kFast leaves no gap: a closed surface hides what is in it.
TYPED_TEST(TileTracerTest, FastHasNoLeaks) {
  const TestMesh mesh = joined(make_box({-0.1f, -0.1f, -0.1f}, {0.1f, 0.1f, 0.1f}), make_sphere(24, 24, 1.0f));
  MemoryTree tree(mesh.view(), 8);
  ASSERT_EQ(tree.status(), Status::kOk);
  View view = view_of(kCameras[0], 64, 64);
  view.frame.accuracy = static_cast<std::uint32_t>(Accuracy::kFast);
  WorkCounters work;
  for (const Shown& shown : traced<TypeParam>(tree, view, work)) {
    EXPECT_TRUE(shown.id == kNoTriangle || shown.id >= 12) << shown;
  }
  EXPECT_EQ(work[TileWork::kOpenPixel], 0u);
}

// Exact decisions are rare, nodes behind hits are left out, and work is what it is said to be.
TYPED_TEST(TileTracerTest, WorkIsCounted) {
  const TestMesh sphere = make_sphere(60, 60, 1.0f);
  const auto work_of = [](const TestMesh& mesh) {
    MemoryTree tree(mesh.view(), 8);
    EXPECT_EQ(tree.status(), Status::kOk);
    WorkCounters work;
    (void)traced<TypeParam>(tree, view_of(kCameras[0], 256, 256), work, false);
    return work;
  };
  const WorkCounters work = work_of(sphere);
  EXPECT_EQ(work[TileWork::kView], 64u);
  EXPECT_LT(work[TileWork::kOpenPixel], 500u);  // of 65,536
  EXPECT_GT(work[TileWork::kBlock], 1000u);
  EXPECT_EQ(work[TileWork::kNormalGroup], 0u);
  // A wall hides what is behind it.
  const TestMesh soup = make_random_soup(3000, 0.05f, 9);
  const WorkCounters hidden = work_of(joined(make_box({-9, -9, 1.5f}, {9, 9, 1.6f}), soup));
  EXPECT_LT(2 * hidden[TileWork::kLeaf], work_of(soup)[TileWork::kLeaf]);
}

// Boxes of pixels come from estimates and have a margin: a triangle between pixel centres is left out, one that touches
// a centre stays.
TYPED_TEST(TileTracerTest, LargeTrianglesAreCoveredBlockByBlock) {
  TestMesh mesh = make_triangle({-50, -50, -3}, {50, -50, -3}, {0, 80, -3});
  mesh.append(make_triangle({-50, -50, -2}, {50, -40, -4}, {0, 80, -3}));
  mesh.append(make_triangle({-200, -1, 200}, {200, -1, 200}, {0, -1, -400}));  // crosses the eye's plane
  for (const Camera& camera : kCameras) expect_exact<TypeParam>(mesh, view_of(camera, 70, 50));
}

}  // namespace
}  // namespace gridiron::test
