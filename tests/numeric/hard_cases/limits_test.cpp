// Limits: nothing to see, vertices that are no numbers, counts that no integer holds.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/build/grid/grid_builder.h>
#include <gridiron/frame/frame_setup.h>
#include <gridiron/image/scene_image.h>
#include <gridiron/io/ply_reader.h>
#include <gridiron/ray/intersect_standard.h>

#include "core/build/grid/built_image.h"
#include "core/ray/packet_cases.h"
#include "numeric/hard_cases/shapes.h"
#include "numeric/hard_cases/trial.h"

namespace gridiron::test::hard {
namespace {

constexpr TriangleFormat kFormats[] = {TriangleFormat::kVertices, TriangleFormat::kProjection,
                                       TriangleFormat::kLattice};

Status count(const MeshView& mesh, TriangleFormat format, GridNeed& need) {
  const GridParameters parameters{.format = format};
  return count_scene_image(mesh, parameters, need);
}

// Nothing, points, and triangles of no area make no scene; one triangle makes one.
TEST(HardCase26, NothingOnePointOneTriangle) {
  TestMesh nothing, points = make_random_soup(4, 1.0f, 26), one_point, line;
  points.triangles.clear();
  one_point.vertices.resize(3, Vec3(1, 2, 3));
  one_point.triangles = {{0, 1, 2}, {0, 0, 0}};
  line.vertices = {{0, 0, 0}, {1, 2, 3}, {2, 4, 6}};
  line.triangles = {{0, 1, 2}};
  for (const TriangleFormat format : kFormats) {
    for (const TestMesh* mesh : {&nothing, &points, &one_point, &line}) {
      GridNeed need{};
      EXPECT_EQ(count(mesh->view(), format, need), Status::kNoTriangles);
    }
  }
  Tally tally;
  for (const float scale : {1e-30f, 1.0f, 1e30f}) {
    const TestMesh triangle =
        make_triangle(scale * Vec3(-1, -1, 0.5f), scale * Vec3(1, -0.5f, 0.25f), scale * Vec3(0, 1, -0.5f));
    tally += shoot({.mesh = triangle,
                    .grade = Grade::kBounded,
                    .aim = salvo_at(scale * Vec3(0, 0, 2), scale, {kFeatures, times(6), 24, 1}, 26)});
  }
  EXPECT_GT(tally.hits, tally.rays / 4);
}

// Should one come as far as the intersector, it may be hit or not; triangles that share a batch with it are tested as
// ever.
void test_neighbours_of_poison() {
  const TestMesh mesh = make_sphere(6, 8, 1.0f);
  constexpr std::uint32_t kPoisoned = 1000;
  std::vector<VertexTriangle> clean, poisoned;
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    clean.push_back(triangle_of(mesh, i));
    poisoned.push_back(clean.back());
    poisoned.push_back(vertex_triangle(Vec3(std::numeric_limits<float>::quiet_NaN()), {1, 0, 0}, {0, 1, 0}, kPoisoned));
  }
  TestRandom random(32);
  const Rays rays = rays_at(mesh, {0.1f, 0.2f, 0.3f}, Aim::kVertex, 64, random);
  const auto trace = [&](std::span<const VertexTriangle> triangles) {
    auto packet = std::make_unique<Packet<8>>();
    for (std::uint32_t ray = 0; ray < 64; ++ray) {
      for (int axis = 0; axis < 3; ++axis) packet->dir[axis][ray] = rays.directions[ray][axis];
      packet->t[ray] = kFloatMax;
      packet->id[ray] = kNoTriangle;
    }
    for (int axis = 0; axis < 3; ++axis) packet->origin[axis] = rays.origin[axis];
    packet->active.fill();
    set_direction_bounds(*packet);
    WorkCounters work;
    using L = Lanes<16>;
    for (std::size_t first = 0; first < triangles.size(); first += L::kCount) {
      const auto in_batch = static_cast<std::uint32_t>(std::min<std::size_t>(L::kCount, triangles.size() - first));
      OpenTriangle open[L::kCount];
      for (std::uint32_t i = 0; i < in_batch; ++i)
        open[i] = {&triangles[first + i], Packet<8>::kAllSubpackets, ~0u, false};
      (void)intersect_standard_batch<L, false>(*packet, open, in_batch, {}, work);
    }
    return packet;
  };
  const auto wanted = trace(clean), found = trace(poisoned);
  for (std::uint32_t ray = 0; ray < 64; ++ray) {
    if (found->id[ray] == kPoisoned) continue;
    EXPECT_EQ(found->id[ray], wanted->id[ray]) << "ray " << ray;
    EXPECT_EQ(found->t[ray], wanted->t[ray]) << "ray " << ray;
  }
}

// A vertex that is no number is refused, used or not, by the builder and again by who opens an image.
TEST(HardCase32, VertexIsNoNumber) {
  constexpr std::uint32_t kPatterns[] = {0x7FC00000u, 0xFFC00000u, 0x7F800001u, 0xFFFFFFFFu, 0x7F800000u, 0xFF800000u};
  TestMesh mesh = make_sphere(6, 8, 1.0f);
  mesh.vertices.push_back({0, 0, 0});  // not used
  BuiltImage built = build_image(mesh.view());
  for (const std::uint32_t pattern : kPatterns) {
    const float odd = std::bit_cast<float>(pattern);
    for (const std::size_t vertex : {std::size_t{0}, std::size_t{17}, mesh.vertices.size() - 1}) {
      for (int axis = 0; axis < 3; ++axis) {
        TestMesh poisoned = mesh;
        poisoned.vertices[vertex][axis] = odd;
        for (const TriangleFormat format : kFormats) {
          GridNeed need{};
          EXPECT_EQ(count(poisoned.view(), format, need), Status::kBadVertex);
        }
      }
    }
    // Poison in an image whose check value is right.
    const std::span<std::byte> bytes = built.image.bytes();
    const std::uint64_t place = built.view.triangles_offset_bytes + 5 * kTriangleRecordBytes + 16;
    std::byte kept[4];
    std::memcpy(kept, bytes.data() + place, 4);
    const auto seal = [&] {
      const std::uint64_t value = scene_image_check_value(bytes);
      std::memcpy(bytes.data() + offsetof(ImageHeader, check_value), &value, sizeof value);
    };
    std::memcpy(bytes.data() + place, &pattern, 4);
    seal();
    SceneImageView view;
    SceneImageError error;
    EXPECT_EQ(open_scene_image(bytes, view, error), Status::kBadImage);
    EXPECT_STREQ(error.field, "triangle.v");
    std::memcpy(bytes.data() + place, kept, 4);
    seal();
    EXPECT_EQ(open_scene_image(bytes, view, error), Status::kOk);
  }
  // The reader counts rows and says which one it was.
  const std::string text =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 nan 0\n0 1 0\n3 0 1 2\n";
  PlyReader reader;
  PlyStep step = reader.feed(std::as_bytes(std::span(text)));
  EXPECT_EQ(step.event, PlyEvent::kHeader);
  step = reader.feed(std::as_bytes(std::span(text)).subspan(step.consumed_bytes));
  EXPECT_EQ(step.event, PlyEvent::kError);
  EXPECT_EQ(reader.position().row, 1u);
  test_neighbours_of_poison();
}

// A scene image: every count of its grid and sections, one after the other, made absurd and sealed again.
void refuse_absurd_images(const TestMesh& mesh) {
  BuiltImage built = build_image(mesh.view());
  const std::span<std::byte> bytes = built.image.bytes();
  const auto header = read_record<ImageHeader>(bytes, 0);
  std::uint64_t grid_offset = 0;
  std::vector<std::uint64_t> words32, words64;
  for (std::uint32_t i = 0; i < header.section_count; ++i) {
    const std::uint64_t entry = header.section_table_offset_bytes + i * sizeof(SectionEntry);
    words64.push_back(entry + offsetof(SectionEntry, element_count));
    words64.push_back(entry + offsetof(SectionEntry, section_bytes));
    words64.push_back(entry + offsetof(SectionEntry, offset_bytes));
    if (read_record<SectionEntry>(bytes, entry).kind == 1) {
      grid_offset = read_record<SectionEntry>(bytes, entry).offset_bytes;
    }
  }
  ASSERT_NE(grid_offset, 0u);
  for (std::uint64_t axis = 0; axis < 3; ++axis) {
    words32.push_back(grid_offset + offsetof(GridRecord, cell_count) + 4 * axis);
    words32.push_back(grid_offset + offsetof(GridRecord, macro_cell_count) + 4 * axis);
  }
  for (const std::uint64_t field : {offsetof(GridRecord, reference_count), offsetof(GridRecord, cell_block_count),
                                    offsetof(GridRecord, macro_width), offsetof(GridRecord, cell_block_bytes)}) {
    words32.push_back(grid_offset + field);
  }
  const std::vector<std::byte> kept(bytes.begin(), bytes.end());
  const auto is_refused = [&] {
    const std::uint64_t value = scene_image_check_value(bytes);
    std::memcpy(bytes.data() + offsetof(ImageHeader, check_value), &value, sizeof value);
    SceneImageView view;
    SceneImageError error;
    const Status status = open_scene_image(bytes, view, error);
    std::memcpy(bytes.data(), kept.data(), kept.size());
    return status == Status::kBadImage;
  };
  for (const std::uint32_t absurd : {0xFFFFFFFFu, 0x80000000u, 0x10000u, 2049u}) {
    for (const std::uint64_t place : words32) {
      std::memcpy(bytes.data() + place, &absurd, 4);
      EXPECT_TRUE(is_refused()) << absurd << " at " << place;
    }
    // All three axes at once: products that wrap to what is there.
    for (std::uint64_t axis = 0; axis < 3; ++axis) {
      std::memcpy(bytes.data() + grid_offset + offsetof(GridRecord, cell_count) + 4 * axis, &absurd, 4);
      std::memcpy(bytes.data() + grid_offset + offsetof(GridRecord, macro_cell_count) + 4 * axis, &absurd, 4);
    }
    EXPECT_TRUE(is_refused()) << absurd;
  }
  for (const std::uint64_t absurd :
       {~std::uint64_t{0}, std::uint64_t{1} << 63, (std::uint64_t{1} << 61) + 1, ~std::uint64_t{0} - 127}) {
    for (const std::uint64_t place : words64) {
      std::memcpy(bytes.data() + place, &absurd, 8);
      EXPECT_TRUE(is_refused()) << absurd << " at " << place;
    }
  }
}

// A frame: sizes whose product wraps, macrocells whose product wraps.
void refuse_absurd_frames(const TestMesh& mesh) {
  SceneInMemory scene(mesh.view(), {});
  FrameSettings settings{.camera = {.eye = {0, 0, 4}}, .width = 8, .height = 8};
  PreparedFrame frame = scene.prepare(settings, {});
  ASSERT_EQ(frame.status(), Status::kOk);
  ASSERT_EQ(frame.render({}).status, Status::kOk);
  const FrameRecord good = frame.record();
  for (const std::uint32_t absurd : {0xFFFFFFFFu, 0x80000000u, 0x10001u, 0u}) {
    for (std::uint32_t FrameRecord::*const member :
         {&FrameRecord::width, &FrameRecord::height, &FrameRecord::tile_width, &FrameRecord::tiles_x,
          &FrameRecord::tiles_y}) {
      FrameRecord bad = good;
      bad.*member = absurd;
      frame.set_record(bad);
      EXPECT_NE(frame.render({}).status, Status::kOk) << absurd;
    }
    FrameRecord bad = good;
    for (std::uint32_t& cells : bad.engine.grid.macro_cell_count) cells = absurd;
    frame.set_record(bad);
    EXPECT_TRUE(absurd == 0 || frame.render({}).status != Status::kOk) << absurd;
  }
  frame.set_record(good);
  settings.color = MainAddress{kLineBytes};
  FrameRecord refused;
  EXPECT_EQ(make_frame_record(settings, scene.image(), MainAddress{}, refused), Status::kOk);
  settings.width = 0xFFFFFFFFu;
  EXPECT_EQ(make_frame_record(settings, scene.image(), MainAddress{}, refused), Status::kBadFrame);
  EXPECT_EQ(output_plane_bytes(0xFFFFFFFFu, 1, 32), (std::uint64_t{1} << 32) * 32 * 4);
}

// Counts in headers without data behind them: an error each, before a byte is read.
TEST(HardCase43, CountsOverflow) {
  const TestMesh mesh = make_sphere(6, 8, 1.0f);
  const std::span<const Vec3> vertices = mesh.vertices;
  const std::span<const UVec3> triangles = mesh.triangles;
  constexpr std::size_t kTooMany = std::size_t{1} << 32;
  for (const TriangleFormat format : kFormats) {
    GridNeed need{};
    EXPECT_EQ(count({vertices, {triangles.data(), kTooMany}}, format, need), Status::kTooManyTriangles);
    EXPECT_EQ(count({{vertices.data(), kTooMany}, triangles}, format, need), Status::kTooManyTriangles);
  }
  // References: two thousand triangles, each in two million cells.
  TestMesh sheets;
  for (std::uint32_t i = 0; i < 2200; ++i) sheets.append(make_triangle({-1, -1, 0}, {1, -1, 0}, {-1, 1, 0}));
  const GridParameters fine{.lambda = 2000.0f, .macro_width = 8};
  GridNeed need{};
  EXPECT_EQ(count_scene_image(sheets.view(), fine, need), Status::kTooManyTriangles);
  // Ids beyond those that a float can distinguish.
  auto packet = std::make_unique<Packet<4>>();
  for (const std::uint32_t id : {(1u << 24) + 1, (1u << 24) + 2, 0x7FFFFFFFu, 0xFFFFFFFEu}) {
    for (std::uint32_t ray = 0; ray < 16; ++ray) {
      packet->dir[2][ray] = -1.0f;
      packet->t[ray] = kFloatMax;
      packet->id[ray] = kNoTriangle;
    }
    packet->origin[2] = 1.0f;
    packet->active.fill();
    set_direction_bounds(*packet);
    WorkCounters work;
    for (const std::uint32_t which : {id, id - 1, id}) {
      const VertexTriangle triangle = vertex_triangle({-1, -1, 0}, {1, -1, 0}, {0, 1, 0}, which);
      (void)intersect_standard<Lanes<4>, false>(*packet, triangle, false, work);
    }
    for (std::uint32_t ray = 0; ray < 16; ++ray) ASSERT_EQ(packet->id[ray], id - 1);
  }
  refuse_absurd_images(mesh);
  refuse_absurd_frames(mesh);
  // A PLY header.
  for (const char* absurd : {"4294967296", "18446744073709551615", "18446744073709551616", "99999999999999999999999"}) {
    const std::string text = std::string("ply\nformat binary_little_endian 1.0\nelement vertex ") + absurd +
                             "\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
                             "property list uchar int vertex_indices\nend_header\n";
    PlyReader reader;
    EXPECT_EQ(reader.feed(std::as_bytes(std::span(text))).event, PlyEvent::kError) << absurd;
  }
}

}  // namespace
}  // namespace gridiron::test::hard
