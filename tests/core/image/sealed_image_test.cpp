// Images that were changed and sealed again with a check value of their own: what SPEC.md forbids is refused, and every
// bit that may change is one that SPEC.md leaves free. SPDX-License-Identifier: Apache-2.0
#include "core/image/image_damage.h"
#include "core/scene/test_effects.h"
#include "support/test_mesh.h"

namespace gridiron::test {
namespace {

// Seals and opens. @returns the field that was refused, "" where the image opened.
std::string refused_field(BuiltImage& built) {
  renew_check_value(built.image);
  const OpenedImage opened = open_image(built.image.bytes());
  EXPECT_EQ(opened.status == Status::kOk, opened.error.field[0] == '\0');
  return opened.error.field;
}

// --- Fields by name -------------------------------------------------------------------------------------------------

struct Field {
  const char* name;
  std::uint64_t end;  // offset in its record
};

std::string field_in(const std::vector<Field>& fields, std::uint64_t offset) {
  for (const Field& field : fields) {
    if (offset < field.end) return field.name;
  }
  return "beyond its record";
}

std::string field_of_element(const SectionEntry& entry, TriangleFormat format, std::uint64_t offset) {
  switch (static_cast<SectionKind>(entry.kind)) {
    case SectionKind::kGrid:
      return field_in({{"grid", 72}, {"grid.bounds", 96}, {"grid.lambda", 100}, {"grid.lattice", 128}}, offset);
    case SectionKind::kMacroTable:
      return "macro_table";
    case SectionKind::kCellBlocks:
      return "cell";
    case SectionKind::kTriangles:
      if (format == TriangleFormat::kLattice) {
        return field_in({{"triangle.v", 18}, {"triangle.reserved", 20}, {"triangle.triangle_id", 24}}, offset);
      }
      if (format == TriangleFormat::kVertices) {
        return field_in({{"triangle.v", 36}, {"triangle.reserved", 44}, {"triangle.triangle_id", 48}}, offset);
      }
      return field_in({{"triangle.projection", 40}, {"triangle.reserved", 44}, {"triangle.triangle_id", 48}}, offset);
    case SectionKind::kEffects:
      return field_in({{"effects", 56}, {"effects.offset", 96}, {"effects.levels", 100}, {"effects.reserved", 128}},
                      offset);
    case SectionKind::kMaterials:
      return field_in({{"material", 44}, {"material.has_colors", 48}}, offset);
    case SectionKind::kLights:
      return field_in({{"light", 44}, {"light.reserved0", 48}, {"light", 60}, {"light.reserved1", 64}}, offset);
    case SectionKind::kSurfaces:
      return field_in(
          {{"surface.v", 36}, {"surface.material", 40}, {"surface.normals", 44}, {"surface.tree_place", 48}}, offset);
    case SectionKind::kNormals:
      return field_in({{"normal.n", 36}, {"normal.colors", 48}}, offset);
    case SectionKind::kEnvironmentMap:
      return "environment.texels";
    case SectionKind::kTree:
      return field_in({{"tree", 12}, {"tree.leaf_triangles", 16}, {"tree", 128}}, offset);
    case SectionKind::kTreeNodes:
      return "node";
    case SectionKind::kTreeTriangles:
      return field_in(
          format == TriangleFormat::kLattice
              ? std::vector<Field>{{"tree_triangle.v", 18}, {"tree_triangle", 20}, {"tree_triangle.id", 24}}
              : std::vector<Field>{{"tree_triangle.v", 36}, {"tree_triangle", 44}, {"tree_triangle.id", 48}},
          offset);
    case SectionKind::kEnd:
      break;
  }
  return "unknown";
}

std::string field_at(const BuiltImage& built, std::uint64_t offset) {
  const ImageHeader& header = built.view.header;
  if (offset < sizeof(ImageHeader)) {
    return field_in({{"header", 32},
                     {"header.triangle_count", 36},
                     {"header.vertex_count", 40},
                     {"header.dropped_triangle_count", 44},
                     {"header.reserved", 64}},
                    offset);
  }
  const std::uint64_t table = header.section_table_offset_bytes;
  if (offset >= table && offset < table + header.section_count * sizeof(SectionEntry)) return "section";
  for (std::uint32_t i = 0; i < header.section_count; ++i) {
    const auto entry = read_record<SectionEntry>(built.image.bytes(), table + i * sizeof(SectionEntry));
    const std::uint64_t used = entry.element_bytes * entry.element_count;
    if (offset < entry.offset_bytes || offset >= entry.offset_bytes + used) continue;
    const auto format = static_cast<TriangleFormat>(built.view.grid.triangle_format);
    return field_of_element(entry, format, (offset - entry.offset_bytes) % entry.element_bytes);
  }
  return "padding";
}

// --- Every bit ------------------------------------------------------------------------------------------------------

// Small triangles, most of them in one cell; one that is dropped, and a zero with a sign.
TestMesh scattered_mesh() {
  TestMesh mesh = make_triangle({-0.0f, 0.1f, 0.1f}, {0.05f, 0.12f, 0.1f}, {0.06f, 0.1f, 0.15f});
  mesh.append(make_triangle({0, 0, 0}, {1, 0.5f, 0.25f}, {0.25f, 1, 0.75f}));
  for (int i = 0; i < 6; ++i) {
    const float x = std::fmod(static_cast<float>(i) * 0.618f, 1.0f);
    const float y = std::fmod(static_cast<float>(i) * 0.377f, 1.0f);
    mesh.append(make_triangle({x, y, x * y}, {x + 0.07f, y + 0.03f, x * y}, {x, y + 0.07f, x * y + 0.05f}));
  }
  mesh.append(make_triangle({0, 0, 0}, {0.5f, 0.5f, 0.5f}, {1, 1, 1}));
  return mesh;
}

BuiltImage image_with_effects(TriangleFormat format, std::uint32_t environment_width, bool has_grid = true) {
  const TestEffects scene = all_effects(environment_width);
  const EffectsView effects = scene.view();
  const GridParameters parameters{.lambda = 4.0f, .macro_width = 2, .format = format, .has_grid = has_grid};
  return build_image(scene.mesh(), parameters, std::byte{0xCD}, &effects);
}

// Makes the image again, of the triangles that it holds. @returns whether grid, cells and triangles are the same bytes.
bool is_as_built(const BuiltImage& changed) {
  const auto [status, error, view] = open_image(changed.image.bytes());
  EXPECT_EQ(status, Status::kOk) << error.field;
  TestMesh mesh;
  mesh.vertices.resize(std::max(view.header.vertex_count % 64, 3u), Vec3(0));  // those that no triangle has
  mesh.triangles.resize(view.header.triangle_count, UVec3(0));                 // dropped
  std::set<std::uint32_t> ids;
  for (std::uint32_t i = 0; i < view.grid.reference_count; ++i) {
    const auto r =
        read_record<VertexTriangle>(changed.image.bytes(), view.triangles_offset_bytes + i * sizeof(VertexTriangle));
    if (!ids.insert(r.triangle_id).second) continue;
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const auto& v : r.v) mesh.vertices.emplace_back(v[0], v[1], v[2]);
    mesh.triangles[r.triangle_id] = {first, first + 1, first + 2};
  }
  if (ids.size() + view.header.dropped_triangle_count != view.header.triangle_count) return true;  // an id of two
  const BuiltImage again =
      build_image(mesh.view(), {view.grid.lambda, view.grid.macro_width, TriangleFormat::kVertices});
  const std::size_t begin = 256;  // behind header and section table
  return again.image.bytes().size() == changed.image.bytes().size() &&
         std::memcmp(again.image.bytes().data() + begin, changed.image.bytes().data() + begin,
                     again.image.bytes().size() - begin) == 0;
}

// Flips every bit. @returns the fields in which a flipped bit was accepted.
std::set<std::string> free_fields(BuiltImage& built) {
  std::set<std::string> fields;
  const std::span<std::byte> bytes = built.image.bytes();
  const std::uint64_t check_begin = offsetof(ImageHeader, check_value);
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    if (i >= check_begin && i < check_begin + sizeof(std::uint64_t)) continue;
    for (int bit = 0; bit < 8; ++bit) {
      bytes[i] ^= std::byte{1} << bit;
      if (refused_field(built).empty()) {
        const std::string field = field_at(built, i);
        fields.insert(field);
        const bool has_vertices =
            built.view.grid.triangle_format == static_cast<std::uint32_t>(TriangleFormat::kVertices);
        if (has_vertices && built.view.has_grid && !built.view.has_effects) {
          EXPECT_TRUE(is_as_built(built)) << field << " at byte " << i << ", bit " << bit;
        }
      }
      bytes[i] ^= std::byte{1} << bit;
    }
  }
  renew_check_value(built.image);
  return fields;
}

using Names = std::set<std::string>;

TEST(SealedImage, OfVerticesOnlyWhatAnotherMeshMayHaveIsFree) {
  BuiltImage built = build_image(scattered_mesh().view(), {4.0f, 2, TriangleFormat::kVertices});
  ASSERT_FALSE(HasFailure());
  EXPECT_EQ(free_fields(built), (Names{"grid.lambda", "header.vertex_count", "triangle.triangle_id", "triangle.v"}));
}

TEST(SealedImage, OfALatticeOnlyWhatAnotherMeshMayHaveIsFree) {
  BuiltImage built = build_image(scattered_mesh().view(), {4.0f, 2, TriangleFormat::kLattice});
  ASSERT_FALSE(HasFailure());
  EXPECT_EQ(free_fields(built), (Names{"grid.lambda", "header.vertex_count", "triangle.triangle_id", "triangle.v"}));
}

TEST(SealedImage, OfProjectionsOnlyWhatTheirRecordsDoNotTellIsFree) {
  BuiltImage built = build_image(scattered_mesh().view(), {4.0f, 2, TriangleFormat::kProjection});
  ASSERT_FALSE(HasFailure());
  for (const std::string& field : free_fields(built)) {
    EXPECT_TRUE((Names{"grid.bounds", "grid.lambda", "header.dropped_triangle_count", "header.triangle_count",
                       "header.vertex_count", "triangle.projection", "triangle.triangle_id"})
                    .contains(field))
        << field;
  }
}

TEST(SealedImage, OfEffectsOnlyWhatAnotherSceneMayHaveIsFree) {
  for (const TriangleFormat format : {TriangleFormat::kVertices, TriangleFormat::kLattice}) {
    BuiltImage built = image_with_effects(format, 2);
    ASSERT_FALSE(HasFailure());
    EXPECT_EQ(free_fields(built), (Names{"effects", "effects.levels", "environment.texels", "grid.lambda",
                                         "header.vertex_count", "light", "material", "material.has_colors",
                                         "normal.colors", "normal.n", "surface.v", "tree.leaf_triangles"}));
  }
}

TEST(SealedImage, OfATreeAloneOnlyWhatAnotherMeshMayHaveIsFree) {
  for (const TriangleFormat format : {TriangleFormat::kVertices, TriangleFormat::kLattice}) {
    const GridParameters parameters{.format = format, .leaf_triangles = 2, .has_tree = true, .has_grid = false};
    BuiltImage built = build_image(scattered_mesh().view(), parameters);
    ASSERT_FALSE(HasFailure());
    EXPECT_EQ(free_fields(built),
              (Names{"header.vertex_count", "tree.leaf_triangles", "tree_triangle.id", "tree_triangle.v"}));

    built = image_with_effects(format, 2, false);
    ASSERT_FALSE(HasFailure());
    EXPECT_EQ(free_fields(built), (Names{"effects", "effects.levels", "environment.texels", "header.vertex_count",
                                         "light", "material", "material.has_colors", "normal.colors", "normal.n",
                                         "surface.v", "tree.leaf_triangles"}));
  }
}

// An id too: if no triangle was dropped, their sum is known. So one that is changed is refused.
TEST(SealedImage, OfATreeAloneAnIdIsFreeOnlyBesideDroppedTriangles) {
  const TestMesh mesh = make_sphere(5, 6, 1.0f);
  const GridParameters parameters{.has_tree = true, .has_grid = false};
  BuiltImage built = build_image(mesh.view(), parameters);
  ASSERT_FALSE(HasFailure());
  ASSERT_EQ(built.view.header.dropped_triangle_count, 0u);
  EXPECT_EQ(free_fields(built).count("tree_triangle.id"), 0u);
}

TEST(SealedImage, WithoutDroppedTrianglesAnIdIsNotFree) {
  TestMesh mesh = make_triangle({0, 0, 0}, {0.1f, 0, 0}, {0, 0.1f, 0.1f});
  for (int i = 1; i < 8; ++i) {
    const float at = static_cast<float>(i);
    mesh.append(make_triangle({at, at, at}, {at + 0.1f, at, at}, {at, at + 0.1f, at + 0.1f}));
  }
  BuiltImage built = build_image(mesh.view(), {4.0f, 2, TriangleFormat::kVertices});
  ASSERT_FALSE(HasFailure());
  EXPECT_EQ(free_fields(built).count("triangle.triangle_id"), 0u);
}

// --- Fields by place ------------------------------------------------------------------------------------------------

void expect_padding_refused(const GridParameters& parameters) {
  BuiltImage built = build_image(scattered_mesh().view(), parameters);
  ASSERT_FALSE(testing::Test::HasFailure());
  int paddings = 0;
  for (std::uint64_t i = 0; i < built.image.bytes().size(); ++i) {
    if (field_at(built, i) != "padding") continue;
    built.image.bytes()[i] = std::byte{0x10};
    expect_refused(built.image, "padding", i);
    built.image.bytes()[i] = std::byte{0};
    ++paddings;
  }
  EXPECT_GT(paddings, 64);
}

TEST(SealedImage, PaddingIsNamedWithItsPlace) {
  for (const TriangleFormat format :
       {TriangleFormat::kVertices, TriangleFormat::kProjection, TriangleFormat::kLattice}) {
    expect_padding_refused({4.0f, 3, format});
  }
  expect_padding_refused({.has_tree = true, .has_grid = false});
}

// A triangle that is in several cells.
TEST(SealedImage, CopiesOfATriangleAreEqualToTheSignOfAZero) {
  const TestMesh mesh = make_triangle({0, 0, 0}, {1, 0.5f, 0.25f}, {0.25f, 1, 0.75f});
  BuiltImage built = build_image(mesh.view(), {64.0f, 2, TriangleFormat::kVertices});
  ASSERT_FALSE(HasFailure());
  const std::uint32_t copies = built.view.grid.reference_count;
  ASSERT_GT(copies, 8u);
  for (std::uint32_t copy = 0; copy < copies; ++copy) {
    const std::uint64_t place = built.view.triangles_offset_bytes + copy * sizeof(VertexTriangle);
    edit<VertexTriangle>(built.image, place, [](VertexTriangle& r) { r.v[0][1] = -0.0f; });
    EXPECT_EQ(refused_field(built), "triangle.v") << copy;
    edit<VertexTriangle>(built.image, place, [](VertexTriangle& r) { r.v[0][1] = 0.0f; });
  }
  for (std::uint32_t copy = 0; copy < copies; ++copy) {
    const std::uint64_t place = built.view.triangles_offset_bytes + copy * sizeof(VertexTriangle);
    edit<VertexTriangle>(built.image, place, [](VertexTriangle& r) { r.v[0][1] = -0.0f; });
  }
  EXPECT_EQ(refused_field(built), "") << "all copies alike are another mesh";
}

TEST(SealedImage, CopiesOfAProjectionAreEqual) {
  const TestMesh mesh = make_triangle({0, 0, 0}, {1, 0.5f, 0.25f}, {0.25f, 1, 0.75f});
  BuiltImage built = build_image(mesh.view(), {64.0f, 2, TriangleFormat::kProjection});
  ASSERT_FALSE(HasFailure());
  for (std::uint32_t copy = 0; copy < built.view.grid.reference_count; ++copy) {
    const std::uint64_t place = built.view.triangles_offset_bytes + copy * sizeof(ProjectionTriangle);
    edit<ProjectionTriangle>(built.image, place, [](ProjectionTriangle& r) { r.c_d += 1.0f; });
    EXPECT_EQ(refused_field(built), "triangle.n_u") << copy;
    edit<ProjectionTriangle>(built.image, place, [](ProjectionTriangle& r) { r.c_d -= 1.0f; });
  }
}

TEST(SealedImage, BoundsLambdaAndCountsFollowFromTheTriangles) {
  struct Case {
    const char* field;
    std::function<void(GridRecord&)> damage;
  };
  const Case cases[] = {
      {"grid.bounds_minimum", [](GridRecord& r) { r.bounds_minimum[0] = r.minimum[0] = -0.0f; }},
      {"grid.minimum",
       [](GridRecord& r) {
         r.minimum[2] -= 1.0f;
         r.cells_per_unit[2] *= 0.25f;
       }},
      {"grid.cells_per_unit", [](GridRecord& r) { r.cells_per_unit[0] *= 0.5f; }},
      {"grid.cell_count", [](GridRecord& r) { r.lambda *= 8.0f; }},
      {"grid.lambda", [](GridRecord& r) { r.lambda = 2e6f; }},
      {"grid.lambda", [](GridRecord& r) { r.lambda = 0.5e-6f; }},
      {"grid.lattice", [](GridRecord& r) { r.lattice.origin[1] = -0.0f; }},
      {"grid.lattice", [](GridRecord& r) { r.lattice.step = -0.0f; }},
  };
  for (const Case& c : cases) {
    BuiltImage built = build_image(scattered_mesh().view(), {4.0f, 2, TriangleFormat::kVertices});
    edit<GridRecord>(built.image, 256, c.damage);
    EXPECT_EQ(refused_field(built), c.field);
  }
  // One cell: its grid also fits smaller bounds, so that only the triangles reveal the error.
  BuiltImage built = build_image(scattered_mesh().view(), {1e-6f, 1, TriangleFormat::kVertices});
  edit<ImageHeader>(built.image, 0, [](ImageHeader& r) { r.dropped_triangle_count = 0; });
  EXPECT_EQ(refused_field(built), "header.dropped_triangle_count");
  edit<ImageHeader>(built.image, 0, [](ImageHeader& r) { r.dropped_triangle_count = 1; });
  EXPECT_EQ(refused_field(built), "");
  edit<ImageHeader>(built.image, 0, [](ImageHeader& r) { r.vertex_count = 2; });
  EXPECT_EQ(refused_field(built), "header.vertex_count");
}

// A record moved to a cell that its triangle does not touch: counts and ids stay right.
TEST(SealedImage, ATriangleStandsInTheCellsThatItTouches) {
  TestMesh mesh = make_triangle({0, 0, 0}, {0.1f, 0, 0}, {0, 0.1f, 0.1f});
  mesh.append(make_triangle({4, 4, 4}, {4.1f, 4, 4}, {4, 4.1f, 4.1f}));
  BuiltImage built = build_image(mesh.view(), {8.0f, 1, TriangleFormat::kVertices});
  ASSERT_EQ(built.view.grid.reference_count, 2u);
  const std::uint64_t first = built.view.triangles_offset_bytes;
  auto a = read_record<VertexTriangle>(built.image.bytes(), first);
  auto b = read_record<VertexTriangle>(built.image.bytes(), first + sizeof(VertexTriangle));
  write_record(built.image, first, b);
  write_record(built.image, first + sizeof(a), a);
  EXPECT_EQ(refused_field(built), "grid.reference_count");
}

}  // namespace
}  // namespace gridiron::test
