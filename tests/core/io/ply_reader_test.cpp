// What valid PLY inputs give, for every format, type, line end, chunking and size of output.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/io/ply_reader.h>

#include "core/io/ply_run.h"

namespace gridiron::test {
namespace {

using Triple = std::array<std::uint32_t, 3>;

std::uint32_t bits_of(double value) {
  return std::bit_cast<std::uint32_t>(static_cast<float>(value));
}

// Corners of a cube and a little more, as integers that every type holds.
const std::vector<std::array<int, 3>>& corners() {
  static const std::vector<std::array<int, 3>> points = {{0, 0, 0},     {0, 0, 100},   {0, 100, 0},
                                                         {0, 100, 100}, {127, 0, 0},   {99, 0, 1},
                                                         {98, 97, 0},   {127, 127, 1}, {5, 6, 7}};
  return points;
}

const std::vector<std::vector<std::uint32_t>>& polygons() {
  static const std::vector<std::vector<std::uint32_t>> faces = {
      {0, 1, 3}, {0, 3, 2}, {4, 6, 7, 5}, {8, 0, 1, 2, 3, 4, 5, 6}, {}, {3}, {1, 2},
      {7, 7, 7}, {2, 1, 0}, {8, 7, 6, 5}};
  return faces;
}

std::vector<Triple> fanned(const std::vector<std::vector<std::uint32_t>>& faces) {
  std::vector<Triple> triangles;
  for (const auto& face : faces) {
    for (std::size_t i = 2; i < face.size(); ++i) triangles.push_back({face[0], face[i - 1], face[i]});
  }
  return triangles;
}

std::vector<Triple> corner_bits() {
  std::vector<Triple> vertices;
  for (const auto& p : corners()) vertices.push_back({bits_of(p[0]), bits_of(p[1]), bits_of(p[2])});
  return vertices;
}

void add_vertex_header(PlyMaker& maker, std::string_view type) {
  maker.line("element vertex " + std::to_string(corners().size()));
  maker.coordinates(type);
}

void add_vertices(PlyMaker& maker, std::string_view type) {
  for (const auto& p : corners()) {
    for (const int value : p) maker.value(type, value);
    maker.end_row();
  }
}

void add_face_header(PlyMaker& maker, std::string_view count_type = "uchar", std::string_view index_type = "int",
                     std::string_view name = "vertex_indices") {
  maker.line("element face " + std::to_string(polygons().size()));
  maker.line("property list " + std::string(count_type) + " " + std::string(index_type) + " " + std::string(name));
}

void add_faces(PlyMaker& maker, std::string_view count_type = "uchar", std::string_view index_type = "int") {
  for (const auto& face : polygons()) {
    maker.value(count_type, static_cast<double>(face.size()));
    for (const std::uint32_t index : face) maker.value(index_type, index);
    maker.end_row();
  }
}

struct PlainTypes {
  std::string_view coordinate = "float", count = "uchar", index = "int", indices_name = "vertex_indices";
};

std::string plain_file(PlyFormat format, const std::string& line_end = "\n", const PlainTypes& types = {}) {
  PlyMaker maker(format, line_end);
  add_vertex_header(maker, types.coordinate);
  add_face_header(maker, types.count, types.index, types.indices_name);
  maker.end_header();
  add_vertices(maker, types.coordinate);
  add_faces(maker, types.count, types.index);
  return maker.text();
}

void expect_plain(const PlyOutcome& outcome, const std::string& what) {
  EXPECT_EQ(outcome.error, PlyError::kNone) << what << ": " << describe(outcome);
  EXPECT_EQ(outcome.vertices, corner_bits()) << what;
  EXPECT_EQ(outcome.triangles, fanned(polygons())) << what;
  EXPECT_EQ(outcome.faces, polygons().size()) << what;
  EXPECT_EQ(outcome.surplus_bytes, 0u) << what;
}

PlyOutcome run_good(const std::string& input, const PlyRunOptions& options = {}) {
  PlyOutcome outcome = run_ply_in_pieces(input, options);
  EXPECT_EQ(outcome.error, PlyError::kNone) << describe(outcome);
  return outcome;
}

TEST(PlyReader, EveryFormatAndType) {
  for (const PlyFormat format : kPlyFormats) {
    for (const std::string_view coordinate : kPlyTypes) {
      for (const std::string_view count : kPlyTypes) {
        for (const std::string_view index : kPlyTypes) {
          if (count == "float" || count == "double" || index == "float" || index == "double") continue;
          const std::string input = plain_file(format, "\n", {coordinate, count, index});
          const std::string what = "format " + std::to_string(static_cast<int>(format)) + ", " +
                                   std::string(coordinate) + ", list " + std::string(count) + " " + std::string(index);
          expect_plain(run_ply(input), what);
          expect_plain(run_ply(input, random_chunks(5)), what);
        }
      }
    }
  }
}

TEST(PlyReader, SizedTypeNames) {
  for (const PlainTypes& types : {PlainTypes{"float32", "uint8", "int32", "vertex_index"},
                                  {"float64", "int8", "uint32", "vertex_index"},
                                  {"int16", "uint16", "int16", "vertex_index"},
                                  {"uint32", "int32", "uint8", "vertex_index"}}) {
    const std::string input = plain_file(PlyFormat::kAscii, "\n", types);
    expect_plain(run_ply_in_pieces(input), std::string(types.coordinate));
  }
}

TEST(PlyReader, EveryFormatInEveryChunking) {
  for (const PlyFormat format : kPlyFormats) {
    for (const char* line_end : {"\n", "\r\n", "\r"}) {
      const std::string input = plain_file(format, line_end);
      expect_plain(run_ply_in_pieces(input), input.substr(0, 40));
      for (const std::size_t batch : {1u, 2u, 9u, 16u, 1000u}) {
        PlyRunOptions options;
        options.vertex_batch = options.triangle_batch = batch;
        expect_plain(run_ply_in_pieces(input, options), "batch of " + std::to_string(batch));
      }
    }
  }
}

TEST(PlyReader, BatchesAreFullOrEndAnElement) {
  PlyRunOptions options;
  options.vertex_batch = 4;
  options.triangle_batch = 8;
  const std::uint64_t triangles = fanned(polygons()).size();
  ASSERT_EQ(triangles, 14u);
  const std::vector<PlyOutcome::Batch> wanted = {{PlyEvent::kHeader, 0, 0},    {PlyEvent::kVertices, 0, 4},
                                                 {PlyEvent::kVertices, 4, 4},  {PlyEvent::kVertices, 8, 1},
                                                 {PlyEvent::kTriangles, 0, 8}, {PlyEvent::kTriangles, 8, 6},
                                                 {PlyEvent::kEnd, 0, 0}};
  for (const PlyFormat format : kPlyFormats) EXPECT_EQ(run_ply_in_pieces(plain_file(format), options).batches, wanted);
}

TEST(PlyReader, CountingNeedsNoMemory) {
  PlyRunOptions options;
  options.vertex_batch = options.triangle_batch = 0;
  for (const PlyFormat format : kPlyFormats) {
    const PlyOutcome outcome = run_good(plain_file(format), options);
    EXPECT_EQ(outcome.counted_vertices, corners().size());
    EXPECT_EQ(outcome.counted_triangles, 14u);
    EXPECT_EQ(outcome.batches.size(), 2u);
  }
}

TEST(PlyReader, FacesBeforeVertices) {
  for (const PlyFormat format : kPlyFormats) {
    PlyMaker maker(format);
    add_face_header(maker);
    add_vertex_header(maker, "double");
    maker.end_header();
    add_faces(maker);
    add_vertices(maker, "double");
    expect_plain(run_ply_in_pieces(maker.text()), "faces first");
  }
}

// Scalars and lists of every type before, between and after the wanted properties, and unknown elements all around.
TEST(PlyReader, SkipsWhatItDoesNotKnow) {
  for (const PlyFormat format : kPlyFormats) {
    PlyMaker maker(format);
    maker.line("comment");
    maker.line("comment end_header");
    maker.line("obj_info num_cols 512");
    maker.line("comment " + std::string(65536, 'x'));
    maker.line("element material 2").line("property uchar ambient").line("property list uchar double curve");
    maker.line("element edge 3").line("property int vertex1").line("property int vertex2");
    maker.line("element nothing 7");
    maker.line("element empty 0").line("property list int int vertex_indices");
    maker.line("element vertex " + std::to_string(corners().size()));
    maker.line("property list uint short before").line("property float confidence").line("property double z");
    maker.line("property uchar red").line("property float x").line("property list uchar float texcoord");
    maker.line("property short y").line("property double nx").line("property list int char after");
    maker.line("element multi_patch 1").line("property list ushort uint vertex_indices");
    maker.line("element face " + std::to_string(polygons().size()));
    maker.line("property uchar flags").line("property list uchar float texcoord");
    maker.line("property list ushort uint vertex_indices").line("property list int double weights");
    maker.line("property double area");
    maker.line("element long 1").line("property list int double much").line("property list uint ushort vertex_indices");
    maker.line("element last 1").line("property char end");
    maker.end_header();

    const auto list = [&](std::string_view count_type, std::string_view type, int count) {
      maker.value(count_type, count);
      for (int i = 0; i < count; ++i) maker.value(type, 3 + i);
    };
    for (int row = 0; row < 2; ++row) {
      maker.value("uchar", 9);
      list("uchar", "double", row * 5);
      maker.end_row();
    }
    for (int row = 0; row < 3; ++row) maker.value("int", row).value("int", -1).end_row();
    int row = 0;
    for (const auto& p : corners()) {
      list("uint", "short", row % 3);
      maker.value("float", 0.5).value("double", p[2]).value("uchar", 200).value("float", p[0]);
      list("uchar", "float", (row + 1) % 4);
      maker.value("short", p[1]).value("double", 1e300);
      list("int", "char", row == 4 ? 300 : 0);
      maker.end_row();
      ++row;
    }
    list("ushort", "uint", 40);
    maker.end_row();
    for (const auto& face : polygons()) {
      maker.value("uchar", 1);
      list("uchar", "float", 6);
      maker.value("ushort", static_cast<double>(face.size()));
      for (const std::uint32_t index : face) maker.value("uint", index);
      list("int", "double", 2);
      maker.value("double", 0.25).end_row();
    }
    list("int", "double", 10000);
    list("uint", "ushort", 40000);
    maker.end_row().value("char", 1).end_row();
    expect_plain(run_ply_in_pieces(maker.text()), "everything unknown");
  }
}

// The quick route for whole rows, with and without scalars around the list, against the general one (1-byte pieces).
TEST(PlyReader, RowsOfTrianglesWithScalarsAround) {
  for (const PlyFormat format : kPlyFormats) {
    for (const char* count : {"uchar", "char", "int", "uint", "ushort"}) {
      for (const char* index : {"int", "uint", "ushort"}) {
        PlyMaker maker(format);
        maker.line("element vertex 300").line("property uchar a").line("property float z").line("property float x");
        maker.line("property double b").line("property float y");
        maker.line("element face 400").line("property short a");
        maker.line(std::string("property list ") + count + " " + index + " vertex_indices");
        maker.line("property float b").line("property uchar c").end_header();
        std::vector<Triple> vertices, triangles;
        for (std::uint32_t i = 0; i < 300; ++i) {
          maker.value("uchar", i % 256).value("float", i).value("float", -0.5 * i).value("double", i);
          maker.value("float", 1.0 / (i + 1)).end_row();
          // In ASCII a double's digits go to float in one rounding; here the value is the same either way.
          vertices.push_back({bits_of(-0.5 * i), bits_of(1.0 / (i + 1)), bits_of(i)});
        }
        for (std::uint32_t i = 0; i < 400; ++i) {
          const std::uint32_t corner_count = i % 50 == 49 ? 4 : 3;
          maker.value("short", i).value(count, corner_count);
          const std::uint32_t face[4] = {i % 300, (i * 7) % 300, 299 - i % 300, 5};
          for (std::uint32_t c = 0; c < corner_count; ++c) maker.value(index, face[c]);
          triangles.push_back({face[0], face[1], face[2]});
          if (corner_count == 4) triangles.push_back({face[0], face[2], face[3]});
          maker.value("float", 0).value("uchar", 255).end_row();
        }
        PlyRunOptions options;
        options.vertex_batch = 128;
        options.triangle_batch = 100;
        const PlyOutcome outcome = run_good(maker.text(), options);
        EXPECT_EQ(outcome.vertices, vertices);
        EXPECT_EQ(outcome.triangles, triangles);
      }
    }
  }
}

TEST(PlyReader, Strips) {
  for (const PlyFormat format : kPlyFormats) {
    PlyMaker maker(format);
    add_vertex_header(maker, "float");
    maker.line("element tristrips 3").line("property list int int vertex_indices").end_header();
    add_vertices(maker, "float");
    const std::vector<std::vector<int>> rows = {
        {0, 1, 2, 3, 4, -1, 5, 6, -1, -1, 7, 7, 8, 1, -1, 2}, {3, 4, 5}, {-1, 0, 2, 4, 6}};
    for (const auto& row : rows) {
      maker.value("int", static_cast<double>(row.size()));
      for (const int index : row) maker.value("int", index);
      maker.end_row();
    }
    const std::vector<Triple> wanted = {{0, 1, 2}, {2, 1, 3}, {2, 3, 4}, {7, 7, 8},
                                        {8, 7, 1}, {3, 4, 5}, {0, 2, 4}, {4, 2, 6}};
    const PlyOutcome outcome = run_good(maker.text());
    EXPECT_EQ(outcome.triangles, wanted);
    EXPECT_EQ(outcome.strip_rows, 3u);
    EXPECT_EQ(outcome.strip_row_count, 3u);
    EXPECT_EQ(outcome.faces, 0u);
  }
}

TEST(PlyReader, LongPolygons) {
  for (const PlyFormat format : kPlyFormats) {
    for (const std::uint32_t corner_count : {300u, 65535u}) {
      PlyMaker maker(format);
      maker.line("element vertex 65535")
          .coordinates("char")
          .line("element face 1")
          .line("property list ushort ushort vertex_indices")
          .end_header();
      for (int i = 0; i < 65535; ++i) maker.value("char", 1).value("char", 2).value("char", 3).end_row();
      maker.value("ushort", corner_count);
      for (std::uint32_t i = 0; i < corner_count; ++i) maker.value("ushort", i);
      maker.end_row();
      const PlyOutcome outcome = run_ply(maker.text(), chunks_of(1000));
      ASSERT_EQ(outcome.error, PlyError::kNone) << describe(outcome);
      ASSERT_EQ(outcome.triangles.size(), corner_count - 2);
      for (std::uint32_t i = 2; i < corner_count; ++i) ASSERT_EQ(outcome.triangles[i - 2], (Triple{0, i - 1, i}));
    }
  }
}

TEST(PlyReader, PointCloudsAndEmptyFiles) {
  const std::string coordinates = "property float x\nproperty float y\nproperty float z\n";
  const auto file = [&](const std::string& format, const std::string& header, const std::string& body) {
    return "ply\nformat " + format + " 1.0\n" + header + "end_header\n" + body;
  };
  PlyOutcome outcome = run_good(file("ascii", "element vertex 2\n" + coordinates, "1 2 3\n4 5 6\n"));
  EXPECT_EQ(outcome.vertices.size(), 2u);
  EXPECT_EQ(outcome.counted_triangles, 0u);
  const std::string no_faces = "element face 0\nproperty list uchar int vertex_indices\n";
  for (const char* format : {"ascii", "binary_little_endian", "binary_big_endian"}) {
    outcome = run_good(file(format, "element vertex 0\n" + coordinates + no_faces, ""));
    EXPECT_EQ(outcome.counted_vertices, 0u);
    // Faces without properties, but also without rows.
    outcome = run_good(file(format, "element face 0\nelement vertex 0\n" + coordinates, ""));
  }
  // The last line may lack its end even where it is the header's.
  std::string cut = file("binary_little_endian", "element vertex 0\n" + coordinates, "");
  cut.pop_back();
  EXPECT_EQ(run_ply_in_pieces(cut).error, PlyError::kNone);
  EXPECT_EQ(run_ply_in_pieces(cut + " ").error, PlyError::kNone);
  EXPECT_EQ(run_ply_in_pieces(cut + "\r").error, PlyError::kNone);
}

TEST(PlyReader, BlanksAndNumbersOfEveryShape) {
  const std::string header =
      "ply \n\n  format\tascii   1.0 \r\n\tcomment tabs and blanks\nelement  vertex\t3 \nproperty float x\n\n"
      "property double\ty \nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header \n";
  const std::string body = "\n \t\r\n+1. .5\t1e5 \n\n-0 1E+05   -1e-45\n\r" + ("0." + std::string(99, '9')) +
                           " 16777217 1e-400\t \n\n\n  +3 +0 01 -0  \n \n";
  const PlyOutcome outcome = run_ply_in_pieces(header + body);
  ASSERT_EQ(outcome.error, PlyError::kNone) << describe(outcome);
  const std::vector<Triple> wanted = {{bits_of(1), bits_of(0.5), bits_of(1e5)},
                                      {0x80000000u, bits_of(1e5), 0x80000001u},
                                      {bits_of(1), bits_of(16777216), 0}};
  EXPECT_EQ(outcome.vertices, wanted);
  EXPECT_EQ(outcome.triangles, (std::vector<Triple>{{0, 1, 0}}));
  EXPECT_EQ(outcome.surplus_bytes, 0u);
}

TEST(PlyReader, BodyWithoutFinalLineEndAndOnOneLine) {
  std::string input = plain_file(PlyFormat::kAscii);
  input.pop_back();
  expect_plain(run_ply_in_pieces(input), "no final line end");
  const std::size_t body = input.find("end_header\n") + 11;
  std::replace(input.begin() + static_cast<std::ptrdiff_t>(body), input.end(), '\n', ' ');
  expect_plain(run_ply_in_pieces(input), "one line");
  // One token a line, too, leaves no doubt about the rows.
  std::replace(input.begin() + static_cast<std::ptrdiff_t>(body), input.end(), ' ', '\n');
  expect_plain(run_ply_in_pieces(input), "one token a line");
}

TEST(PlyReader, SkippedAsciiValuesMayBeNanButNotWords) {
  const std::string header =
      "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
      "property float quality\nproperty list uchar float more\nend_header\n";
  EXPECT_EQ(run_ply_in_pieces(header + "1 2 3 nan 2 -inf 1e999\n").error, PlyError::kNone);
  EXPECT_EQ(run_ply_in_pieces(header + "1 2 3 none 2 1 1\n").error, PlyError::kBadNumber);
  EXPECT_EQ(run_ply_in_pieces(header + "1 2 3 4 2 1 x\n").error, PlyError::kBadNumber);
}

TEST(PlyReader, SurplusIsCounted) {
  for (const PlyFormat format : kPlyFormats) {
    const PlyOutcome outcome = run_good(plain_file(format) + "a bc\n\n");
    EXPECT_EQ(outcome.surplus_bytes, format == PlyFormat::kAscii ? 3u : 6u);
    EXPECT_EQ(outcome.triangles, fanned(polygons()));
  }
}

// The byte behind end_header may look like half of a line end.
TEST(PlyReader, PayloadThatBeginsLikeALineEnd) {
  for (const std::string line_end : {"\n", "\r\n", "\r"}) {
    for (const std::string start : {"\n", "\r", "\r\n", "\n\n", "\r\r", "\n\r", " \n"}) {
      PlyMaker maker(PlyFormat::kBinaryLittleEndian, line_end);
      maker.line("element vertex 1").line("property list uchar uchar first").line("property uchar x");
      maker.line("property uchar y").line("property uchar z").end_header();
      // The count is the first byte of the payload, and the list holds the rest of it.
      const std::size_t count = static_cast<unsigned char>(start[0]);
      std::string row = start + std::string(count + 1 - start.size(), 'q') + "\x01\x02\x03";
      const PlyOutcome outcome = run_good(maker.text() + row);
      EXPECT_EQ(outcome.vertices, (std::vector<Triple>{{bits_of(1), bits_of(2), bits_of(3)}}));
      EXPECT_EQ(outcome.surplus_bytes, 0u);
    }
  }
  // A header with line feeds, but for the last line, and with line ends of both kinds in between.
  PlyMaker maker(PlyFormat::kBinaryLittleEndian);
  maker.line("comment\r").line("element vertex 1").line("property uchar x").line("property uchar y\r");
  maker.line("property uchar z").line("end_header\r");
  const PlyOutcome outcome = run_good(maker.text() + "\n\r\n");
  EXPECT_EQ(outcome.vertices, (std::vector<Triple>{{bits_of(10), bits_of(13), bits_of(10)}}));
}

TEST(PlyReader, DoublesRoundToNearestAndOverflowIsNotFinite) {
  for (const PlyFormat format : {PlyFormat::kBinaryLittleEndian, PlyFormat::kBinaryBigEndian}) {
    const auto file = [&](double x) {
      PlyMaker maker(format);
      maker.line("element vertex 1")
          .coordinates("double")
          .end_header()
          .value("double", x)
          .value("double", 1e-310)
          .value("double", -0x1.000003p-140);
      return maker.text();
    };
    EXPECT_EQ(run_ply_in_pieces(file(0x1.FFFFFEFFFFFFFp127)).vertices[0][0], 0x7F7FFFFFu);
    EXPECT_EQ(run_ply_in_pieces(file(0x1.000001p0)).vertices[0], (Triple{0x3F800000u, 0, 0x80000200u}));
    EXPECT_EQ(run_ply_in_pieces(file(0x1.FFFFFFp127)).error, PlyError::kNotFinite);
    EXPECT_EQ(run_ply_in_pieces(file(1e300)).error, PlyError::kNotFinite);
  }
}

TEST(PlyReader, MoreThanFourGigabytes) {
  // 5 GB of a skipped element, fed from one piece of zeros.
  PlyMaker maker(PlyFormat::kBinaryLittleEndian);
  constexpr std::uint64_t kRows = 700000000;
  maker.line("element blob " + std::to_string(kRows)).line("property float a").line("property uchar b");
  maker.line("property list ushort uchar c");
  maker.line("element lump 1500000000").line("property uchar d");
  add_vertex_header(maker, "float");
  maker.end_header();
  auto reader = std::make_unique<PlyReader>();
  const auto feed = [&](std::string_view text) {
    std::span<const std::byte> rest = std::as_bytes(std::span(text));
    PlyStep step;
    do {
      step = reader->feed(rest);
      rest = rest.subspan(step.consumed_bytes);
    } while (step.event != PlyEvent::kNeedInput && step.event != PlyEvent::kError);
    return step.event;
  };
  ASSERT_EQ(feed(maker.text()), PlyEvent::kNeedInput);
  // A list of 65,535 in the rows that matter for size; the others are of 7 bytes.
  const std::string long_row = std::string(4, '\0') + "x" + "\xFF\xFF" + std::string(65535, 'y');
  std::uint64_t bytes = 0, rows = 0;
  for (; rows < 80000; ++rows, bytes += long_row.size()) ASSERT_EQ(feed(long_row), PlyEvent::kNeedInput);
  PlyOutcome truncated;
  ASSERT_EQ(reader->finish().event, PlyEvent::kError);
  EXPECT_EQ(reader->error(), PlyError::kTruncatedBody);
  EXPECT_EQ(reader->position().row, rows);
  EXPECT_EQ(reader->position().byte_offset, maker.text().size() + bytes);

  // The same size in rows of fixed size, to the end.
  PlyMaker fixed(PlyFormat::kBinaryBigEndian);
  fixed.line("element blob 5000000000").line("property uchar b");
  add_vertex_header(fixed, "float");
  fixed.end_header();
  reader = std::make_unique<PlyReader>();
  ASSERT_EQ(feed(fixed.text()), PlyEvent::kNeedInput);
  const std::string piece(1000000, 'z');
  for (int i = 0; i < 5000; ++i) ASSERT_EQ(feed(piece), PlyEvent::kNeedInput);
  PlyMaker vertices(PlyFormat::kBinaryBigEndian);
  const std::size_t before = vertices.text().size();
  add_vertices(vertices, "float");
  ASSERT_EQ(feed(vertices.text().substr(before)), PlyEvent::kNeedInput);
  EXPECT_EQ(reader->finish().event, PlyEvent::kEnd);
  EXPECT_EQ(reader->counts().vertices, corners().size());
}

TEST(PlyReader, RowsThatHoldNothingTakeNoTime) {
  const std::string input =
      "ply\nformat ascii 1.0\nelement void 9223372036854775807\nelement vertex 1\nproperty float x\nproperty float y\n"
      "property float z\nend_header\n1 2 3\n";
  EXPECT_EQ(run_ply_in_pieces(input).error, PlyError::kNone);
}

TEST(PlyReader, OutputMayChangeAtEveryEvent) {
  const std::string input = plain_file(PlyFormat::kBinaryLittleEndian);
  PlyReader reader;
  std::vector<Vec3> vertices(corners().size());
  std::vector<UVec3> triangles(14);
  std::size_t vertex_count = 0, triangle_count = 0;
  std::span<const std::byte> rest = std::as_bytes(std::span(input));
  for (;;) {
    const PlyStep step = rest.empty() ? reader.finish() : reader.feed(rest);
    rest = rest.subspan(step.consumed_bytes);
    if (step.event == PlyEvent::kEnd) break;
    ASSERT_NE(step.event, PlyEvent::kError);
    if (step.event == PlyEvent::kNeedInput) continue;
    if (step.event == PlyEvent::kVertices) vertex_count += step.item_count;
    if (step.event == PlyEvent::kTriangles) triangle_count += step.item_count;
    // One more place each time, until all is full.
    const auto some = [&](std::size_t have, std::size_t all) { return std::min(have / 2 + 1, all - have); };
    reader.set_output({std::span(vertices).subspan(vertex_count, some(vertex_count, vertices.size())),
                       std::span(triangles).subspan(triangle_count, some(triangle_count, triangles.size()))});
  }
  ASSERT_EQ(triangle_count, 14u);
  for (std::size_t i = 0; i < 14; ++i) {
    EXPECT_EQ((Triple{triangles[i].x, triangles[i].y, triangles[i].z}), fanned(polygons())[i]);
  }
  EXPECT_EQ(vertices.back(), Vec3(5, 6, 7));
}

TEST(ReadPly, FillsExactlyWhatCountPlyCounts) {
  for (const PlyFormat format : kPlyFormats) {
    const std::string input = plain_file(format);
    const auto bytes = std::as_bytes(std::span(input));
    const PlyResult counted = count_ply(bytes);
    ASSERT_EQ(counted.error, PlyError::kNone);
    EXPECT_EQ(counted.header.format, format);
    EXPECT_TRUE(counted.header.has_faces);
    EXPECT_FALSE(counted.header.has_strips);
    ASSERT_EQ(counted.counts.vertices, corners().size());
    ASSERT_EQ(counted.counts.triangles, 14u);
    std::vector<Vec3> vertices(counted.counts.vertices + 1, Vec3(-1));
    std::vector<UVec3> triangles(counted.counts.triangles + 1, UVec3(77));
    for (const std::size_t surplus : {0u, 1u}) {
      const PlyResult read = read_ply(bytes, std::span(vertices).first(counted.counts.vertices + surplus),
                                      std::span(triangles).first(counted.counts.triangles + surplus));
      EXPECT_EQ(read.error, PlyError::kNone);
      EXPECT_EQ(read.counts.triangles, 14u);
      EXPECT_EQ(vertices[8], Vec3(5, 6, 7));
      EXPECT_EQ(triangles[13], UVec3(8, 6, 5));
      EXPECT_EQ(vertices[9], Vec3(-1));
      EXPECT_EQ(triangles[14], UVec3(77));
    }
    std::fill(vertices.begin(), vertices.end(), Vec3(-1));
    EXPECT_EQ(read_ply(bytes, std::span(vertices).first(8), triangles).error, PlyError::kVertexSpanTooSmall);
    EXPECT_EQ(vertices[0], Vec3(-1));
    EXPECT_EQ(read_ply(bytes, vertices, std::span(triangles).first(13)).error, PlyError::kTriangleSpanTooSmall);
    EXPECT_EQ(read_ply(bytes, vertices, {}).error, PlyError::kTriangleSpanTooSmall);
    EXPECT_EQ(triangles[13], UVec3(8, 6, 5));
  }
}

TEST(ReadPly, SmallEnoughForAStack) {
  EXPECT_LE(sizeof(PlyReader), 8192u);
}

}  // namespace
}  // namespace gridiron::test
