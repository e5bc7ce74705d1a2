// Scene image: every hostile byte is refused or harmless. SPDX-License-Identifier: Apache-2.0
#include <gridiron/base/check_value.h>

#include "core/image/image_damage.h"
#include "support/test_mesh.h"

namespace gridiron::test {
namespace {

// Opens; where that succeeds, reads everything as the kernel would, with every read checked.
OpenedImage open_and_read(const LineBuffer& image) {
  const OpenedImage opened = open_image(image.bytes());
  if (opened.status != Status::kOk) return opened;
  std::uint64_t references = 0;
  for (const auto& ids : read_cells(image.bytes(), opened.view)) {
    references += ids.size();
    for (const std::uint32_t id : ids) EXPECT_LT(id, opened.view.header.triangle_count);
  }
  EXPECT_EQ(references, opened.view.grid.reference_count);
  return opened;
}

BuiltImage small_image(TriangleFormat format, std::uint32_t macro_width = 2) {
  TestMesh mesh = make_triangle({0, 0, 0}, {1, 0.5f, 0.25f}, {0.25f, 1, 0.75f});
  mesh.append(make_triangle({0.5f, 0.5f, 0.5f}, {1, 0.5f, 1}, {0.25f, 0.75f, 0.125f}));
  return build_image(mesh.view(), {4.0f, macro_width, format});
}

class Formats : public ::testing::TestWithParam<TriangleFormat> {};

TEST_P(Formats, EveryFlippedBitIsSeenByTheCheckValue) {
  BuiltImage built = small_image(GetParam());
  ASSERT_FALSE(HasFailure());
  for (std::size_t i = 0; i < built.image.bytes().size(); ++i) {
    for (int bit = 0; bit < 8; ++bit) {
      built.image.bytes()[i] ^= std::byte{1} << bit;
      ASSERT_EQ(open_image(built.image.bytes()).status, Status::kBadImage) << "byte " << i << " bit " << bit;
      built.image.bytes()[i] ^= std::byte{1} << bit;
    }
  }
}

TEST_P(Formats, EveryChangedByteIsRefusedOrHarmless) {
  const BuiltImage built = small_image(GetParam());
  ASSERT_FALSE(HasFailure());
  int refused = 0;
  for (std::size_t i = 0; i < built.image.bytes().size(); ++i) {
    for (const int change : {1, 2, 0x10, 0x80, 0xFF}) {
      LineBuffer image = built.image;
      image.bytes()[i] ^= static_cast<std::byte>(change);
      renew_check_value(image);
      if (open_and_read(image).status != Status::kOk) ++refused;
      ASSERT_FALSE(HasFailure()) << "byte " << i << " change " << change;
    }
  }
  EXPECT_GT(refused, 500);
}

INSTANTIATE_TEST_SUITE_P(All, Formats,
                         ::testing::Values(TriangleFormat::kVertices, TriangleFormat::kProjection,
                                           TriangleFormat::kLattice));

TEST(SceneImage, EveryTruncationIsRefused) {
  const BuiltImage built = small_image(TriangleFormat::kVertices);
  for (std::size_t bytes = 0; bytes < built.image.bytes().size(); ++bytes) {
    ASSERT_EQ(open_image(built.image.bytes().first(bytes)).status, Status::kBadImage) << bytes;
  }
  // A prefix that claims to be whole, with a check value to match.
  for (std::size_t bytes = kLineBytes; bytes < built.image.bytes().size(); bytes += kLineBytes) {
    LineBuffer image(bytes);
    std::memcpy(image.bytes().data(), built.image.bytes().data(), bytes);
    edit<ImageHeader>(image, 0, [&](ImageHeader& header) { header.image_bytes = bytes; });
    renew_check_value(image);
    ASSERT_EQ(open_image(image.bytes()).status, Status::kBadImage) << bytes;
  }
}

TEST(SceneImage, BytesBehindTheImageDoNotMatter) {
  const BuiltImage built = small_image(TriangleFormat::kVertices);
  LineBuffer longer(built.image.bytes().size() + 333, std::byte{0x5A});
  std::memcpy(longer.bytes().data(), built.image.bytes().data(), built.image.bytes().size());
  EXPECT_EQ(open_image(longer.bytes()).status, Status::kOk);
}

TEST(SceneImage, MisalignedIsRefused) {
  const BuiltImage built = small_image(TriangleFormat::kVertices);
  LineBuffer moved(built.image.bytes().size() + 64);
  std::memcpy(moved.bytes().data() + 64, built.image.bytes().data(), built.image.bytes().size());
  const OpenedImage opened = open_image(moved.bytes().subspan(64));
  EXPECT_EQ(opened.status, Status::kBadImage);
  EXPECT_STREQ(opened.error.field, "image");
}

TEST(SceneImage, AFailureLeavesTheViewAlone) {
  const BuiltImage built = small_image(TriangleFormat::kVertices);
  SceneImageView view{};
  view.cell_blocks_offset_bytes = 77;
  SceneImageError error;
  EXPECT_EQ(open_scene_image(built.image.bytes().first(200), view, error), Status::kBadImage);
  EXPECT_EQ(view.cell_blocks_offset_bytes, 77u);
}

// --- Errors by name -----------------------------------------------------------------------------------------------

#define HEADER_DAMAGE(label, member, statement) DAMAGE_IN(label, "header." #member, ImageHeader, member, 0, statement)
#define GRID_DAMAGE(label, member, statement) \
  DAMAGE_IN(label, "grid." #member, GridRecord, member, kGridOffset, statement)

const Damage kDamages[] = {
    HEADER_DAMAGE("magic", magic, r.magic ^= 1),
    HEADER_DAMAGE("version", version, r.version = 1),
    HEADER_DAMAGE("odd_image_bytes", image_bytes, r.image_bytes -= 64),
    HEADER_DAMAGE("no_image_bytes", image_bytes, r.image_bytes = 0),
    HEADER_DAMAGE("too_many_image_bytes", image_bytes, r.image_bytes += kLineBytes),
    HEADER_DAMAGE("enormous_image_bytes", image_bytes, r.image_bytes = ~std::uint64_t{127}),
    HEADER_DAMAGE("no_sections", section_count, r.section_count = 0),
    HEADER_DAMAGE("a_section_missing", section_count, r.section_count = 3),
    HEADER_DAMAGE("too_many_sections", section_count, r.section_count = kMaxSectionCount + 1),
    HEADER_DAMAGE("section_table_in_header", section_table_offset_bytes, r.section_table_offset_bytes = 56),
    HEADER_DAMAGE("section_table_misaligned", section_table_offset_bytes, r.section_table_offset_bytes = 132),
    HEADER_DAMAGE("section_table_beyond", section_table_offset_bytes, r.section_table_offset_bytes = 0xFFFFFFF8u),
    HEADER_DAMAGE("section_table_ends_beyond", section_table_offset_bytes,
                  r.section_table_offset_bytes = static_cast<std::uint32_t>(r.image_bytes) - 8),
    HEADER_DAMAGE("no_triangles", triangle_count, r.triangle_count = 0),
    HEADER_DAMAGE("all_dropped", dropped_triangle_count, r.dropped_triangle_count = r.triangle_count),
    HEADER_DAMAGE("reserved", reserved, r.reserved[4] = 1),
    SECTION_DAMAGE("section_misaligned", SectionKind::kGrid, offset_bytes, r.offset_bytes += 64),
    SECTION_DAMAGE("section_in_header", SectionKind::kGrid, offset_bytes, r.offset_bytes = 0),
    SECTION_DAMAGE("section_on_table", SectionKind::kGrid, offset_bytes, r.offset_bytes = kTableOffset),
    SECTION_DAMAGE("section_beyond", SectionKind::kTriangles, offset_bytes, r.offset_bytes = ~std::uint64_t{127}),
    SECTION_DAMAGE("section_on_another", SectionKind::kCellBlocks, offset_bytes, r.offset_bytes = kGridOffset),
    SECTION_DAMAGE("section_too_long", SectionKind::kTriangles, section_bytes, r.section_bytes += kLineBytes),
    SECTION_DAMAGE("section_wraps", SectionKind::kTriangles, section_bytes, r.section_bytes = ~std::uint64_t{127}),
    SECTION_DAMAGE("section_odd", SectionKind::kTriangles, section_bytes, r.section_bytes -= 16),
    SECTION_DAMAGE("elements_exceed", SectionKind::kTriangles, element_count, r.element_count = ~std::uint64_t{0}),
    SECTION_DAMAGE("element_count_off", SectionKind::kTriangles, element_count, r.element_count -= 1),
    SECTION_DAMAGE("element_bytes_off", SectionKind::kTriangles, element_bytes, r.element_bytes = 32),
    SECTION_DAMAGE("blocks_off", SectionKind::kCellBlocks, element_count, r.element_count -= 1),
    SECTION_DAMAGE("macro_entries_off", SectionKind::kMacroTable, element_count, r.element_count += 1),
    SECTION_DAMAGE("kind_twice", SectionKind::kMacroTable, kind, r.kind = 1),
    GRID_DAMAGE("minimum_nan", minimum, r.minimum[2] = kNan),
    GRID_DAMAGE("scale_zero", cells_per_unit, r.cells_per_unit[0] = 0.0f),
    GRID_DAMAGE("scale_negative", cells_per_unit, r.cells_per_unit[1] = -1.0f),
    GRID_DAMAGE("scale_infinite", cells_per_unit, r.cells_per_unit[2] = kInfinity),
    GRID_DAMAGE("scale_nan", cells_per_unit, r.cells_per_unit[2] = kNan),
    GRID_DAMAGE("no_cells", cell_count, r.cell_count[0] = 0),
    GRID_DAMAGE("too_many_cells", cell_count, r.cell_count[1] = kMaxCellsPerAxis + 1),
    GRID_DAMAGE("macro_cells_off", macro_cell_count, r.macro_cell_count[2] += 1),
    GRID_DAMAGE("macro_width_zero", macro_width, r.macro_width = 0),
    GRID_DAMAGE("macro_width_nine", macro_width, r.macro_width = 9),
    GRID_DAMAGE("block_bytes", cell_block_bytes, r.cell_block_bytes += kLineBytes),
    GRID_DAMAGE("no_blocks", cell_block_count, r.cell_block_count = 0),
    GRID_DAMAGE("format", triangle_format, r.triangle_format = 4),
    GRID_DAMAGE("another_format", triangle_bytes, r.triangle_format = 3),
    GRID_DAMAGE("triangle_bytes", triangle_bytes, r.triangle_bytes = 64),
    GRID_DAMAGE("bounds_below", bounds_minimum, r.bounds_minimum[0] = r.minimum[0] - 1),
    GRID_DAMAGE("bounds_nan", bounds_maximum, r.bounds_maximum[0] = kNan),
    GRID_DAMAGE("bounds_above", bounds_maximum, r.bounds_maximum[1] *= 1.5f),
    GRID_DAMAGE("bounds_reversed", bounds_maximum, r.bounds_maximum[1] = r.bounds_minimum[1] - 1),
    GRID_DAMAGE("lambda", lambda, r.lambda = kNan),
    GRID_DAMAGE("lattice_of_vertices", lattice, r.lattice.step = 1.0f),
    GRID_DAMAGE("lattice_origin_of_vertices", lattice, r.lattice.origin[2] = kNan),
    GRID_DAMAGE("grid_reserved", reserved, r.reserved[2] = 1),
    DAMAGE_IN("first_block", "macro_table.first_block", MacroTableEntry, first_block, view.macro_table_offset_bytes,
              r.first_block = 2),
    DAMAGE_IN("occupied_beyond", "macro_table.occupied", MacroTableEntry, occupied, view.macro_table_offset_bytes,
              r.occupied |= 0x80000000u),
    DAMAGE_IN("block_zero_first", "cell.first_triangle", CellRecord, first_triangle, view.cell_blocks_offset_bytes + 8,
              r.first_triangle = 1),
    DAMAGE_IN("block_zero_count", "cell.triangle_count", CellRecord, triangle_count, view.cell_blocks_offset_bytes + 8,
              r.triangle_count = 1),
    DAMAGE_IN("cell_first", "cell.first_triangle", CellRecord, first_triangle,
              view.cell_blocks_offset_bytes + view.grid.cell_block_bytes, r.first_triangle += 1),
    DAMAGE_IN("cell_count", "cell.triangle_count", CellRecord, triangle_count,
              view.cell_blocks_offset_bytes + view.grid.cell_block_bytes, r.triangle_count = 0xFFFFFFFFu),
    DAMAGE_IN("triangle_nan", "triangle.v", VertexTriangle, v, view.triangles_offset_bytes + 48, r.v[2][1] = kNan),
    DAMAGE_IN("triangle_infinite", "triangle.v", VertexTriangle, v, view.triangles_offset_bytes,
              r.v[0][0] = -kInfinity),
    DAMAGE_IN("triangle_reserved", "triangle.reserved", VertexTriangle, reserved, view.triangles_offset_bytes,
              r.reserved[1] = 5),
    DAMAGE_IN("triangle_id", "triangle.triangle_id", VertexTriangle, triangle_id, view.triangles_offset_bytes,
              r.triangle_id = view.header.triangle_count),
};

class Damages : public ::testing::TestWithParam<Damage> {};

TEST_P(Damages, AreNamedWithTheirPlace) {
  expect_named(GetParam(), small_image(TriangleFormat::kVertices));
}
INSTANTIATE_TEST_SUITE_P(All, Damages, ::testing::ValuesIn(kDamages), [](const auto& test) { return test.param.name; });

TEST(SceneImage, ProjectionAxisAboveTwoIsRefused) {
  BuiltImage built = small_image(TriangleFormat::kProjection);
  edit<ProjectionTriangle>(built.image, built.view.triangles_offset_bytes, [](auto& r) { r.axis_k = 3; });
  expect_refused(built.image, "triangle.axis_k");
}

TEST(SceneImage, LatticesWhoseValuesAreNoFloatsAreRefused) {
  struct Case {
    const char* field;
    std::function<void(Lattice&)> damage;
  };
  const Case cases[] = {
      {"grid.lattice.step", [](Lattice& l) { l.step = 0.0f; }},
      {"grid.lattice.step", [](Lattice& l) { l.step = kNan; }},
      {"grid.lattice.step", [](Lattice& l) { l.step = -l.step; }},
      {"grid.lattice.step", [](Lattice& l) { l.step *= 1.5f; }},
      {"grid.lattice.step", [](Lattice& l) { l.step = 0x1p-127f; }},
      {"grid.lattice.step", [](Lattice& l) { l.step = 0x1p121f; }},
      {"grid.lattice.origin", [](Lattice& l) { l.origin[0] += 0.5f * l.step; }},
      {"grid.lattice.origin", [](Lattice& l) { l.origin[1] = 0x1p24f * l.step; }},
      {"grid.lattice.origin", [](Lattice& l) { l.origin[2] = -0x1p24f * l.step; }},
      {"grid.lattice.origin", [](Lattice& l) { l.origin[2] = kInfinity; }},
      {"grid.lattice.origin", [](Lattice& l) { l.origin[2] = kNan; }},
  };
  for (const Case& c : cases) {
    BuiltImage built = small_image(TriangleFormat::kLattice);
    edit<GridRecord>(built.image, kGridOffset, [&](GridRecord& grid) { c.damage(grid.lattice); });
    expect_refused(built.image, c.field);
  }
  BuiltImage built = small_image(TriangleFormat::kLattice);
  edit<LatticeTriangle>(built.image, built.view.triangles_offset_bytes + 24, [](auto& r) { r.reserved = 1; });
  expect_refused(built.image, "triangle.reserved",
                 built.view.triangles_offset_bytes + 24 + offsetof(LatticeTriangle, reserved));
}

TEST(SceneImage, CellsOnALatticeMustEndWhereTheNextOneBegins) {
  const std::uint64_t block = small_image(TriangleFormat::kLattice).view.grid.cell_block_bytes / sizeof(CellBound);
  struct Case {
    const char* what;
    const char* field;
    std::uint64_t bound;  // of the section
    std::uint32_t value;
  };
  const Case cases[] = {
      {"a triangle in the empty block", "cell.triangle_count", 1, 1},
      {"a first cell that begins later", "cell.first_triangle", block, 1},
      {"a cell that ends behind all triangles", "cell.triangle_count", block + 1, 1000},
      {"a last cell that ends before it begins", "cell.triangle_count", block + 8, 0},
  };
  for (const Case& c : cases) {
    BuiltImage built = small_image(TriangleFormat::kLattice);
    const std::uint64_t place = built.view.cell_blocks_offset_bytes + c.bound * sizeof(CellBound);
    edit<CellBound>(built.image, place, [&](auto& r) { r.first_triangle = c.value; });
    expect_refused(built.image, c.field, place, c.what);
  }
}

TEST(SceneImage, IdsMustAscendWithinACell) {
  TestMesh mesh = make_triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  mesh.triangles.push_back(mesh.triangles[0]);
  BuiltImage built = build_image(mesh.view(), {0.01f, 1, TriangleFormat::kVertices});
  ASSERT_EQ(built.view.grid.reference_count, 2u);
  edit<VertexTriangle>(built.image, built.view.triangles_offset_bytes, [](auto& r) { r.triangle_id = 1; });
  expect_refused(built.image, "triangle.triangle_id");
}

// --- Sections of kinds yet to come --------------------------------------------------------------------------------

// The image with its section table moved behind it and one more section of an unknown kind at the very end.
LineBuffer with_unknown_section(const BuiltImage& built, std::uint64_t unknown_offset_from_end) {
  const std::size_t size = built.image.bytes().size();
  LineBuffer image(size + 3 * kLineBytes);
  std::memcpy(image.bytes().data(), built.image.bytes().data(), size);
  std::memcpy(image.bytes().data() + size, built.image.bytes().data() + kTableOffset, 4 * sizeof(SectionEntry));
  std::memset(image.bytes().data() + kTableOffset, 0, 4 * sizeof(SectionEntry));  // a gap now
  const SectionEntry unknown{1000, 1, size + 3 * kLineBytes - unknown_offset_from_end, kLineBytes, kLineBytes};
  write_record(image, size + 4 * sizeof(SectionEntry), unknown);
  edit<ImageHeader>(image, 0, [&](ImageHeader& header) {
    header.image_bytes = size + 3 * kLineBytes;
    header.section_count = 5;
    header.section_table_offset_bytes = static_cast<std::uint32_t>(size);
  });
  renew_check_value(image);
  return image;
}

TEST(SceneImage, UnknownSectionsAreSkipped) {
  const BuiltImage built = small_image(TriangleFormat::kVertices);
  const OpenedImage opened = open_and_read(with_unknown_section(built, kLineBytes));
  EXPECT_EQ(opened.status, Status::kOk) << opened.error.field;
}

TEST(SceneImage, UnknownSectionsMayNotOverlapEither) {
  const BuiltImage built = small_image(TriangleFormat::kVertices);
  expect_refused(with_unknown_section(built, 2 * kLineBytes), "section.offset_bytes", {}, "on the table");
  expect_refused(with_unknown_section(built, 4 * kLineBytes), "section.offset_bytes", {}, "on the triangles");
  expect_refused(with_unknown_section(built, 0), "section.section_bytes", {}, "beyond the end");
}

// --- Layout ---------------------------------------------------------------------------------------------------------

// The offsets that core/SPEC.md prints.
TEST(Layout, FieldsStandWhereTheSpecificationSays) {
  EXPECT_EQ(offsetof(ImageHeader, image_bytes), 8u);
  EXPECT_EQ(offsetof(ImageHeader, check_value), 16u);
  EXPECT_EQ(offsetof(ImageHeader, section_table_offset_bytes), 28u);
  EXPECT_EQ(offsetof(ImageHeader, dropped_triangle_count), 40u);
  EXPECT_EQ(offsetof(SectionEntry, offset_bytes), 8u);
  EXPECT_EQ(offsetof(SectionEntry, section_bytes), 24u);
  EXPECT_EQ(offsetof(GridRecord, cells_per_unit), 12u);
  EXPECT_EQ(offsetof(GridRecord, cell_count), 24u);
  EXPECT_EQ(offsetof(GridRecord, macro_cell_count), 36u);
  EXPECT_EQ(offsetof(GridRecord, macro_width), 48u);
  EXPECT_EQ(offsetof(GridRecord, triangle_format), 60u);
  EXPECT_EQ(offsetof(GridRecord, reference_count), 68u);
  EXPECT_EQ(offsetof(GridRecord, bounds_maximum), 84u);
  EXPECT_EQ(offsetof(GridRecord, lambda), 96u);
  EXPECT_EQ(offsetof(VertexTriangle, triangle_id), 44u);
  EXPECT_EQ(offsetof(ProjectionTriangle, b_u), 12u);
  EXPECT_EQ(offsetof(ProjectionTriangle, c_u), 24u);
  EXPECT_EQ(offsetof(ProjectionTriangle, axis_k), 36u);
  EXPECT_EQ(offsetof(ProjectionTriangle, triangle_id), 44u);
  EXPECT_EQ(offsetof(FrameHead, tile_width), 16u);
  EXPECT_EQ(offsetof(FrameHead, accuracy), 28u);
  EXPECT_EQ(offsetof(FrameHead, engine_id), 36u);
  EXPECT_EQ(offsetof(FrameHead, t_far), 52u);
  EXPECT_EQ(offsetof(FrameHead, eye), 64u);
  EXPECT_EQ(offsetof(FrameHead, step_y), 100u);
  EXPECT_EQ(offsetof(FrameHead, color_address), 112u);
  EXPECT_EQ(offsetof(GridFrame, grid), 0u);
  EXPECT_EQ(offsetof(GridFrame, triangles_address), 144u);
  EXPECT_EQ(offsetof(GridFrame, triangle_depth), 156u);
  EXPECT_EQ(offsetof(GridFrame, techniques), 160u);
}

// --- Check value --------------------------------------------------------------------------------------------------

// The definition of SPEC.md, word by word.
std::uint64_t check_value_by_the_book(std::span<const std::byte> bytes) {
  std::uint64_t value = 0xcbf29ce484222325u;
  for (std::size_t begin = 0; begin < bytes.size(); begin += 16384) {
    std::vector<std::uint64_t> streams(8, 0xcbf29ce484222325u);
    for (std::size_t i = begin / 8; i < std::min(bytes.size(), begin + 16384) / 8; ++i) {
      std::uint64_t word = 0;
      for (std::size_t k = 0; k < 8; ++k) word |= std::to_integer<std::uint64_t>(bytes[8 * i + k]) << (8 * k);
      if (i == 2) word = 0;  // the field itself
      streams[i % 8] = (streams[i % 8] ^ word) * 0x100000001b3u;
    }
    std::uint64_t piece = 0xcbf29ce484222325u;
    for (const std::uint64_t stream : streams) piece = (piece ^ stream) * 0x100000001b3u;
    value = (value ^ piece) * 0x100000001b3u;
  }
  return value;
}

TEST(CheckValue, IsWhatTheSpecificationSays) {
  const BuiltImage built = small_image(TriangleFormat::kVertices);
  EXPECT_EQ(built.view.header.check_value, check_value_by_the_book(built.image.bytes()));
  EXPECT_EQ(scene_image_check_value(built.image.bytes()), built.view.header.check_value);
}

// Wherever the bytes are cut before they are added.
TEST(CheckValue, OfAnImageDoesNotDependOnItsParts) {
  LineBuffer image(5 * 16384 + 128);
  for (std::size_t i = 0; i < image.bytes().size(); ++i) image.bytes()[i] = static_cast<std::byte>(i * i / 7);
  for (const std::size_t end : {std::size_t{64}, std::size_t{16384}, std::size_t{16448}, image.bytes().size()}) {
    const auto bytes = image.bytes().first(end);
    ImageCheckValue once, parts, pieces;
    once.add(bytes);
    for (std::size_t at = 0, step = 64; at < end; at += step, step = (step * 5 + 64) % 40960 + 64) {
      step = std::min(step, end - at);
      parts.add(bytes.subspan(at, step));
    }
    for (std::size_t at = 0; at < end; at += ImageCheckValue::kPieceBytes) {
      CheckValue piece;
      piece.add(bytes.subspan(at, std::min<std::size_t>(end - at, ImageCheckValue::kPieceBytes)));
      pieces.add_piece(piece.value());
    }
    EXPECT_EQ(parts.value(), once.value()) << end;
    EXPECT_EQ(pieces.value(), once.value()) << end;
  }
}

}  // namespace
}  // namespace gridiron::test
