// What is wrong with malformed PLY inputs, and where: error, byte, line, element and row, for every chunking.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/io/ply_reader.h>

#include "core/io/ply_run.h"

namespace gridiron::test {
namespace {

using enum PlyError;

// Runs `input` in several chunkings, with and without output, which must agree.
PlyOutcome run_all(const std::string& input, const PlyRunOptions& options = {}) {
  const PlyOutcome whole = run_ply_in_pieces(input, options);
  PlyRunOptions counting = options;
  counting.vertex_batch = counting.triangle_batch = 0;
  const PlyOutcome counted = run_ply(input, chunks_of(input.size()), counting);
  EXPECT_EQ(counted.error, whole.error);
  EXPECT_EQ(counted.byte_offset, whole.byte_offset);
  return whole;
}

// Expects `error` at the place that '^' marks in `marked` (the mark itself is taken out), in element `element`, row
// `row`. Without a mark: at the end of the input.
void expect_error(std::string marked, PlyError error, const std::string& element = "", std::uint64_t row = 0,
                  const PlyRunOptions& options = {}) {
  std::size_t place = marked.find('^');
  if (place == std::string::npos) {
    place = marked.size();
  } else {
    marked.erase(place, 1);
  }
  std::uint64_t line = 1;
  for (std::size_t i = 0; i < place; ++i) {
    const bool first_half = marked[i] == '\r' && i + 1 < marked.size() && marked[i + 1] == '\n';
    if ((marked[i] == '\n' || marked[i] == '\r') && !first_half) ++line;
  }
  const PlyOutcome outcome = run_all(marked, options);
  EXPECT_STREQ(ply_error_reason(outcome.error), ply_error_reason(error)) << describe(outcome) << "\n" << marked;
  EXPECT_EQ(outcome.byte_offset, place) << describe(outcome) << "\n" << marked;
  EXPECT_EQ(outcome.line, line) << describe(outcome) << "\n" << marked;
  EXPECT_EQ(outcome.element_name, element) << describe(outcome) << "\n" << marked;
  EXPECT_EQ(outcome.row, row) << describe(outcome) << "\n" << marked;
}

const std::string kMagic = "ply\nformat ascii 1.0\n";
const std::string kVertices = "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
const std::string kFaces = "element face 2\nproperty list uchar int vertex_indices\n";
const std::string kHeader = kMagic + kVertices + kFaces + "end_header\n";
const std::string kPoints = "0 0 0\n1 0 0\n0 1 0\n";

TEST(PlyMalformed, TheBaseIsValid) {
  EXPECT_EQ(run_all(kHeader + kPoints + "3 0 1 2\n3 2 1 0\n").error, kNone);
}

TEST(PlyMalformed, Magic) {
  for (const char* text : {"^\xEF\xBB\xBFply\n", "^PLY\nformat", "p^\xFFly", "pl^Y\n", "ply^x\n", "^ ply\n", "^\nply\n",
                           "pl^\n", "ply ^y\n", "^\x89PNG", "ply^\v\n"}) {
    expect_error(text, kNotPly);
  }
  expect_error(std::string("ply^\0\n", 6), kNotPly);
  for (const char* text : {"", "p", "pl", "ply", "ply ", "ply\n", "ply\r", "ply\r\n"}) {
    expect_error(text, kTruncatedHeader);
  }
}

TEST(PlyMalformed, HeaderLines) {
  const std::string rest = kVertices + "end_header\n0 0 0\n0 0 0\n0 0 0\n";
  expect_error("ply\n" + kVertices + "^end_header\n", kMissingFormat);
  expect_error(kMagic + "^format ascii 1.0\n" + rest, kDuplicateFormat);
  expect_error("ply\nformat ^text 1.0\n" + rest, kUnknownFormat);
  expect_error("ply\nformat ^binary_middle_endian 1.0\n" + rest, kUnknownFormat);
  expect_error("ply\nformat ascii ^2.0\n" + rest, kUnknownVersion);
  expect_error("ply\nformat ascii ^1.00\n" + rest, kUnknownVersion);
  expect_error("ply\n ^format ascii\n" + rest, kMissingWord);
  expect_error("ply\nformat ascii 1.0 ^1.0\n" + rest, kExtraWord);
  expect_error(kMagic + "^element vertex\n", kMissingWord);
  expect_error(kMagic + "element vertex 3 ^4\n", kExtraWord);
  expect_error(kMagic + "^property float x\n", kPropertyWithoutElement);
  expect_error(kMagic + "element vertex 3\n^property float\n", kMissingWord, "vertex");
  expect_error(kMagic + "element vertex 3\n^property list uchar int\n", kMissingWord, "vertex");
  expect_error(kMagic + "element vertex 3\nproperty float x ^y\n", kExtraWord, "vertex");
  expect_error(kMagic + "element vertex 3\nproperty list uchar int a ^b c d e f\n", kExtraWord, "vertex");
  expect_error(kMagic + "^Created by hand, not by any of the usual ones\n" + rest, kUnknownKeyword);
  expect_error(kMagic + "^comments\n" + rest, kUnknownKeyword);
  expect_error(kMagic + "^END_HEADER\n" + rest, kUnknownKeyword);
  expect_error(kMagic + kVertices + "end_header ^now\n", kExtraWord);
  expect_error(kMagic + kVertices + "^0 0 0\n", kUnknownKeyword);
}

TEST(PlyMalformed, HeaderLinesPlaceOfControlCharacter) {
  expect_error(kMagic + "element ver^\x01tex 3\n", kBadCharacter);
  expect_error(kMagic + std::string("element v^\0x 3\n", 15), kBadCharacter);
  expect_error(kMagic + "element vertex 3\nproperty float ^\x7F\n", kBadCharacter);
  // In comments anything goes.
  EXPECT_EQ(
      run_all(kMagic + "comment \x01\x7F" + std::string(1, '\0') + "\xE4\n" + kVertices + "end_header\n" + kPoints)
          .error,
      kNone);
}

TEST(PlyMalformed, ElementCounts) {
  for (const char* count : {"-8", "-1", "+3", "twelve", "3.0", "3x", "0x3", "9223372036854775808",
                            "18446744073709551616", "99999999999999999999"}) {
    expect_error(kMagic + "element vertex ^" + count + "\nproperty float x\n", kBadElementCount);
    expect_error(kMagic + "element other ^" + count + "\n", kBadElementCount);
  }
  const std::string coordinates = "property float x\nproperty float y\nproperty float z\nend_header\n";
  // Counts that fit, of rows that do not come.
  for (const char* count : {"2147483647", "2147483648", "4294967295"}) {
    expect_error(kMagic + "element vertex " + count + "\n" + coordinates + "1 2 3\n", kTruncatedBody, "vertex", 1);
  }
  expect_error(kMagic + "element vertex ^4294967296\n" + coordinates, kTooManyVertices);
  expect_error(kMagic + "element vertex ^9223372036854775807\n" + coordinates, kTooManyVertices);
  expect_error(kMagic + "element face 9223372036854775807\nproperty list int int vertex_index\nelement vertex 1\n" +
                   coordinates + "0\n0\n0\n",
               kTruncatedBody, "face", 3);
}

TEST(PlyMalformed, Declarations) {
  const std::string end = "end_header\n";
  expect_error(kMagic + kVertices + "element ^vertex 3\n" + end, kDuplicateElement);
  expect_error(kMagic + kVertices + "element edge 0\nelement ^edge 0\n" + end, kDuplicateElement);
  expect_error(kMagic + "element vertex 3\nproperty float x\nproperty float ^x\n" + end, kDuplicateProperty, "vertex");
  expect_error(kMagic + kVertices + "property uchar c\nproperty list uchar int ^c\n" + end, kDuplicateProperty,
               "vertex");
  expect_error(kMagic + kVertices + kFaces + "property list uchar int ^vertex_index\n" + end, kDuplicateProperty,
               "face");
  expect_error(kMagic + "element vertex 3\nproperty ^float128 x\n" + end, kUnknownType, "vertex");
  expect_error(kMagic + "element vertex 3\nproperty list uchar ^long x\n" + end, kUnknownType, "vertex");
  expect_error(kMagic + "element vertex 3\nproperty list ^list int x\n" + end, kUnknownType, "vertex");
  expect_error(kMagic + "element vertex 3\nproperty list ^float int c\n" + end, kBadListCountType, "vertex");
  expect_error(kMagic + "element face 3\nproperty list ^float64 int vertex_index\n" + end, kBadListCountType, "face");
  expect_error(kMagic + "element face 3\nproperty list uchar ^float vertex_index\n" + end, kBadIndexType, "face");
  expect_error(kMagic + "element tristrips 3\nproperty list uchar ^double vertex_indices\n" + end, kBadIndexType,
               "tristrips");
  expect_error(kMagic + "element face 3\nproperty ^int vertex_indices\n" + end, kBadIndexType, "face");
  expect_error(kMagic + "element vertex 3\nproperty ^list uchar float y\n" + end, kBadCoordinateType, "vertex");
  expect_error(kMagic + kFaces + "^end_header\n", kNoVertexElement);
  expect_error("ply\nformat ascii 1.0\n^end_header\n", kNoVertexElement);
  expect_error(kMagic + "element face 0\n^element vertex 3\nproperty float x\nproperty float y\n" + end,
               kMissingCoordinate, "vertex");
  expect_error(kMagic + "^element vertex 0\n" + end, kMissingCoordinate, "vertex");
  expect_error(kMagic + kVertices + "^element face 1\nproperty uchar flags\n" + end, kMissingIndices, "face");
  expect_error(kMagic + kVertices + "^element tristrips 1\n" + end, kMissingIndices, "tristrips");
}

TEST(PlyMalformed, Limits) {
  const std::string body = "end_header\n" + kPoints + "3 0 1 2\n4 2 1 0 1\n";
  PlyRunOptions options;
  const std::string header = kMagic + kVertices + kFaces;
  options.config = {2, 4, 3, 3};  // exactly enough
  EXPECT_EQ(run_all(header + body, options).error, kNone);
  options.config = {1, 4, 3, 3};
  expect_error(kMagic + kVertices + "^" + kFaces + body, kTooManyElements, "", 0, options);
  options.config = {2, 3, 3, 3};
  expect_error(kMagic + kVertices + "element face 2\n^property list uchar int vertex_indices\n" + body,
               kTooManyProperties, "face", 0, options);
  options.config = {2, 4, 2, 3};
  expect_error(kMagic + "element vertex ^3\nproperty float x\n" + body, kTooManyVertices, "", 0, options);
  options.config = {2, 4, 3, 2};
  expect_error(header + "end_header\n" + kPoints + "3 0 1 2\n4 2 1 0 ^1\n", kTooManyTriangles, "face", 1, options);
  options.config = {2, 4, 3, 0};
  expect_error(header + "end_header\n" + kPoints + "2 0 1\n4 2 1 ^0 1\n", kTooManyTriangles, "face", 1, options);

  std::string many = kMagic;
  for (std::size_t i = 0; i < kPlyElementCapacity; ++i) many += "element e" + std::to_string(i) + " 0\n";
  options.config = {};
  options.config.max_elements = 1000000;
  expect_error(many + "^element vertex 0\n", kTooManyElements, "", 0, options);
  many = kMagic + "element vertex 0\n";
  for (std::size_t i = 0; i < kPlyPropertyCapacity; ++i) many += "property int p" + std::to_string(i) + "\n";
  options.config.max_properties = 1000000;
  expect_error(many + "^property int x\n", kTooManyProperties, "vertex", 0, options);

  const std::string long_name(200, 'n');
  many = kMagic + "element vertex 0\n";
  std::size_t used = 6;
  int count = 0;
  for (; used + long_name.size() + 2 <= kPlyNameBytes; used += long_name.size() + 2, ++count) {
    many += "property int " + std::to_string(10 + count) + long_name + "\n";
  }
  expect_error(many + "property int ^" + std::to_string(10 + count) + long_name + "\n", kNamesTooLong, "vertex", 0,
               options);
  expect_error(kMagic + "element ^" + std::string(250, 'e') + " 0\n", kLineTooLong);
  // Position names are cut, not refused.
  expect_error(kMagic + "element " + std::string(100, 'e') + " 0\nproperty ^real r\n", kUnknownType,
               std::string(kPlyShownNameBytes - 1, 'e'));
}

TEST(PlyMalformed, AsciiBodies) {
  for (const char* token : {"abc", "1.2.3", "--1", "1e", "0x10", "comment", "1,0", "\x01", "1;"}) {
    expect_error(kHeader + "0 0 0\n1 ^" + token + " 0\n0 1 0\n3 0 1 2\n3 2 1 0\n", kBadNumber, "vertex", 1);
  }
  expect_error(kHeader + "0 0 0\n1 ^" + std::string(1, '\0') + " 0\n", kBadNumber, "vertex", 1);
  expect_error(kHeader + "0 0 0\n1 ^1" + std::string(1, '\0') + "1 0\n", kBadNumber, "vertex", 1);
  for (const char* token : {"nan", "-NaN", "inf", "+Infinity", "1e39", "-1e400", "3.5e38"}) {
    expect_error(kHeader + "0 0 0\r\n1 0 ^" + token + "\r\n", kNotFinite, "vertex", 1);
  }
  expect_error(kHeader + "0 0 0\n1 0 ^" + std::string(257, '1') + "\n", kTokenTooLong, "vertex", 1);
  expect_error(kHeader + "0 0 0\n1 0 ^" + std::string(5000, '1'), kTokenTooLong, "vertex", 1);
  EXPECT_EQ(run_all(kHeader + "0 0 " + std::string(255, '0') + "1\n1 0 0\n0 1 0\n0\n0\n").error, kNone);

  const std::string start = kHeader + kPoints;
  expect_error(start + "3 0 1 2\n^-1 0\n", kNegativeListCount, "face", 1);
  expect_error(start + "3 0 1 2\n^-99999999999999999999 0\n", kValueRange, "face", 1);
  expect_error(start + "^256 0 1 2\n", kValueRange, "face", 0);
  expect_error(start + "^2147483648 0 1 2\n", kValueRange, "face", 0);
  expect_error(start + "^18446744073709551616 0 1 2\n", kValueRange, "face", 0);
  expect_error(start + "^3.0 0 1 2\n", kBadNumber, "face", 0);
  expect_error(start + "3 0 1 ^3\n", kIndexRange, "face", 0);
  expect_error(start + "3 0 ^-1 2\n", kIndexRange, "face", 0);
  expect_error(start + "3 0 1 2\n3 ^2147483648 1 2\n", kIndexRange, "face", 1);
  expect_error(start + "3 ^4294967296 1 2\n", kIndexRange, "face", 0);
  expect_error(start + "3 ^99999999999999999999 1 2\n", kIndexRange, "face", 0);
  expect_error(start + "1 ^3\n", kIndexRange, "face", 0);
  expect_error(start + "3 0 ^1.0 2\n", kBadNumber, "face", 0);
  expect_error(start + "3 0 1 2\n3 0 1", kTruncatedBody, "face", 1);
  expect_error(start + "3 0 1 2\n\n\n", kTruncatedBody, "face", 1);
  expect_error(kHeader, kTruncatedBody, "vertex", 0);
  // Integers outside the range of a coordinate's declared type, and fractions in one.
  const std::string bytes =
      kMagic + "element vertex 1\nproperty char x\nproperty uchar y\nproperty int z\nend_header\n";
  expect_error(bytes + "^128 0 0\n", kValueRange, "vertex", 0);
  expect_error(bytes + "0 ^-1 0\n", kValueRange, "vertex", 0);
  expect_error(bytes + "0 0 ^0.5\n", kBadNumber, "vertex", 0);
  EXPECT_EQ(run_all(bytes + "-128 255 -2147483648\n").error, kNone);
  // Only strips of signed indices know -1.
  const std::string strips = kMagic + kVertices + "element tristrips 1\nproperty list int ";
  expect_error(strips + "uint vertex_indices\nend_header\n" + kPoints + "2 0 ^-1\n", kIndexRange, "tristrips");
  expect_error(strips + "int vertex_indices\nend_header\n" + kPoints + "2 0 ^-2\n", kIndexRange, "tristrips");
}

TEST(PlyMalformed, LinesThatHoldMoreThanTheHeaderDeclares) {
  expect_error(kHeader + "0 0 0 9 9 9\n^1 0 0 9 9 9\n0 1 0\n3 0 1 2\n3 2 1 0\n", kRowsAndLinesDisagree, "vertex", 2);
  expect_error(kHeader + "0 0 0\n1 0 0 ^9\n0 1 0\n3 0 1 2\n", kRowsAndLinesDisagree, "vertex", 2);
  expect_error(kHeader + kPoints + "3 0 1 2 ^0\n3 2 1 0 0\n", kRowsAndLinesDisagree, "face", 1);
  expect_error(kHeader + kPoints + "3 0 1 2 ^3 2 1 0\n", kRowsAndLinesDisagree, "face", 1);
  // Seen only behind the last row: two rows came from one line, and a line is left.
  const std::string two =
      kMagic + "element vertex 2\nproperty float x\nproperty float y\nproperty float z\nend_header\n";
  expect_error(two + "0 0 0 0 1 0\n^1 0 0 0 1 0\n", kRowsAndLinesDisagree);
  EXPECT_EQ(run_all(two + "0 0 0 0 1 0 1 0 0").surplus_bytes, 3u);
  EXPECT_EQ(run_all(two + "0 0 0\n0 1 0 1 0 0\nmore\n").surplus_bytes, 7u);
}

void append(std::string& text, PlyFormat format, std::uint64_t value, std::size_t bytes) {
  for (std::size_t i = 0; i < bytes; ++i) {
    const std::size_t place = format == PlyFormat::kBinaryBigEndian ? bytes - 1 - i : i;
    text += static_cast<char>(value >> (8 * place) & 0xFF);
  }
}

TEST(PlyMalformed, BinaryBodies) {
  struct Case {
    std::vector<std::uint32_t> coordinates;  // float bits
    std::uint64_t count;
    std::vector<std::uint64_t> indices;
    PlyError error;
    std::size_t bad_value;  // among coordinates, count, indices; npos: the input's end
    const char* element;
    const char* count_type = "uchar";
    const char* index_type = "int";
  };
  constexpr std::size_t kEnd = std::string::npos;
  const std::vector<std::uint32_t> good(9, 0x3F800000u);
  auto with = [&](std::size_t place, std::uint32_t bits) {
    std::vector<std::uint32_t> values = good;
    values[place] = bits;
    return values;
  };
  const std::vector<Case> cases = {
      {with(4, 0x7F800000u), 3, {0, 1, 2}, kNotFinite, 4, "vertex"},
      {with(0, 0xFF800000u), 3, {0, 1, 2}, kNotFinite, 0, "vertex"},
      {with(8, 0x7FC00000u), 3, {0, 1, 2}, kNotFinite, 8, "vertex"},
      {with(8, 0xFFFFFFFFu), 3, {0, 1, 2}, kNotFinite, 8, "vertex"},
      {good, 3, {0, 1, 3}, kIndexRange, 12, "face"},
      {good, 3, {3, 1, 0}, kIndexRange, 10, "face"},
      {good, 3, {0, 0xFFFFFFFF, 0}, kIndexRange, 11, "face"},
      {good, 3, {0, 0x80000000, 0}, kIndexRange, 11, "face"},
      {good, 3, {0, 0xFFFFFFFF, 0}, kIndexRange, 11, "face", "uchar", "uint"},
      {good, 3, {0, 0x80000000, 0}, kIndexRange, 11, "face", "uint", "uint"},
      {good, 3, {0, 0xFF, 0}, kIndexRange, 11, "face", "uchar", "char"},
      {good, 3, {0, 0xFF, 0}, kIndexRange, 11, "face", "uchar", "uchar"},
      {good, 3, {0, 0xFFFF, 0}, kIndexRange, 11, "face", "ushort", "short"},
      {good, 3, {0, 0xFFFF, 0}, kIndexRange, 11, "face", "ushort", "ushort"},
      {good, 0xFF, {0, 1, 2}, kNegativeListCount, 9, "face", "char"},
      {good, 0xFFFF, {0, 1, 2}, kNegativeListCount, 9, "face", "short"},
      {good, 0xFFFFFFFF, {0, 1, 2}, kNegativeListCount, 9, "face", "int"},
      {good, 0x80000000, {0, 1, 2}, kNegativeListCount, 9, "face", "int"},
      {good, 0xFFFFFFFF, {0, 1, 2}, kTruncatedBody, kEnd, "face", "uint"},
      {good, 0x7FFFFFFF, {0, 1, 2}, kTruncatedBody, kEnd, "face", "int"},
      {good, 255, {0, 1, 2}, kTruncatedBody, kEnd, "face"},
      {good, 4, {0, 1, 2}, kTruncatedBody, kEnd, "face"},
  };
  for (const PlyFormat format : {PlyFormat::kBinaryLittleEndian, PlyFormat::kBinaryBigEndian}) {
    for (std::size_t i = 0; i < cases.size(); ++i) {
      const Case& test = cases[i];
      PlyMaker maker(format);
      maker.line("element vertex 3").coordinates("float");
      maker.line("element face 1");
      maker.line("property list " + std::string(test.count_type) + " " + test.index_type + " vertex_indices");
      maker.end_header();
      std::string text = maker.text();
      const auto bytes_of = [](std::string_view type) -> std::size_t {
        return type == "char" || type == "uchar" ? 1 : type == "short" || type == "ushort" ? 2 : 4;
      };
      std::vector<std::size_t> places;
      for (const std::uint32_t bits : test.coordinates) {
        places.push_back(text.size());
        append(text, format, bits, 4);
      }
      places.push_back(text.size());
      append(text, format, test.count, bytes_of(test.count_type));
      for (const std::uint64_t index : test.indices) {
        places.push_back(text.size());
        append(text, format, index, bytes_of(test.index_type));
      }
      const PlyOutcome outcome = run_all(text);
      EXPECT_STREQ(ply_error_reason(outcome.error), ply_error_reason(test.error)) << "case " << i;
      EXPECT_EQ(outcome.byte_offset, test.bad_value == kEnd ? text.size() : places[test.bad_value]) << "case " << i;
      EXPECT_EQ(outcome.line, 0u) << "case " << i;
      EXPECT_EQ(outcome.element_name, test.element) << "case " << i;
      EXPECT_EQ(outcome.row, test.bad_value < 9 ? test.bad_value / 3 : 0) << "case " << i;
    }
  }
}

TEST(PlyMalformed, TriangleLimitInQuickRows) {
  PlyMaker maker(PlyFormat::kBinaryLittleEndian);
  maker.line("element vertex 1").coordinates("float");
  maker.line("element face 100").line("property list uchar int vertex_indices").end_header();
  for (int i = 0; i < 3; ++i) maker.value("float", i);
  const std::size_t start = maker.text().size();
  for (int i = 0; i < 100; ++i) maker.value("uchar", 3).value("int", 0).value("int", 0).value("int", 0);
  PlyRunOptions options;
  options.config.max_triangles = 42;
  const PlyOutcome outcome = run_all(maker.text(), options);
  EXPECT_EQ(outcome.error, kTooManyTriangles);
  EXPECT_EQ(outcome.row, 42u);
  EXPECT_EQ(outcome.byte_offset, start + 42 * 13 + 9);
  options.config.max_triangles = 100;
  EXPECT_EQ(run_all(maker.text(), options).error, kNone);
}

// With so many vertices that a negative index, taken as unsigned, would be one of them.
TEST(PlyMalformed, NegativeIndicesAmongFourThousandMillionVertices) {
  for (const PlyFormat format : kPlyFormats) {
    for (const char* type : {"int", "uint"}) {
      PlyMaker maker(format);
      maker.line("element face 2").line(std::string("property list uchar ") + type + " vertex_indices");
      maker.line("element vertex 4294967295").coordinates("float").end_header();
      const double other = type[0] == 'i' ? -2.0 : 4294967294.0;
      for (int i = 0; i < 2; ++i) {
        maker.value("uchar", 3).value("int", 0).value("int", i).value(type, i == 0 ? 2147483647.0 : other).end_row();
      }
      const PlyOutcome outcome = run_all(maker.text());
      EXPECT_EQ(outcome.error, type[0] == 'i' ? kIndexRange : kTruncatedBody) << describe(outcome);
      EXPECT_EQ(outcome.element_name, type[0] == 'i' ? "face" : "vertex");
      EXPECT_EQ(outcome.counted_triangles, type[0] == 'i' ? 1u : 2u);
    }
  }
}

// --- Truncation at every byte ---------------------------------------------------------------------------------------

std::vector<std::string> small_files() {
  std::vector<std::string> files;
  for (const PlyFormat format : kPlyFormats) {
    for (const char* line_end : {"\n", "\r\n", "\r"}) {
      PlyMaker maker(format, line_end);
      maker.line("comment a file to cut").line("element vertex 4").line("property float x").line("property uchar c");
      maker.line("property double y").line("property short z").line("property list uchar short l");
      maker.line("element edge 1").line("property int a");
      maker.line("element face 3").line("property list uchar int vertex_indices").line("property uchar f");
      maker.line("element tristrips 1").line("property list int int vertex_indices").end_header();
      for (int i = 0; i < 4; ++i) {
        maker.value("float", -1.25 * i).value("uchar", 7).value("double", 2.5e-5 * i).value("short", -300 + i);
        maker.value("uchar", i);
        for (int j = 0; j < i; ++j) maker.value("short", 1000);
        maker.end_row();
      }
      maker.value("int", 77).end_row();
      maker.value("uchar", 3).value("int", 0).value("int", 1).value("int", 2).value("uchar", 0).end_row();
      maker.value("uchar", 4);
      for (const int index : {0, 1, 2, 3}) maker.value("int", index);
      maker.value("uchar", 10).end_row();
      maker.value("uchar", 0).value("uchar", 10).end_row();
      maker.value("int", 5);
      for (const int index : {0, 1, 2, -1, 3}) maker.value("int", index);
      maker.end_row();
      files.push_back(maker.text());

      PlyMaker plain(format, line_end);
      plain.line("element vertex 2").coordinates("float");
      plain.line("element face 2").line("property list uchar int vertex_indices").end_header();
      for (int i = 0; i < 2; ++i) plain.value("float", i).value("float", 10 + i).value("float", 0.5).end_row();
      for (int i = 0; i < 2; ++i) plain.value("uchar", 3).value("int", 0).value("int", 1).value("int", i).end_row();
      files.push_back(plain.text());
    }
  }
  return files;
}

std::size_t token_count(const std::string& text) {
  std::istringstream in(text);
  std::size_t count = 0;
  for (std::string token; in >> token;) ++count;
  return count;
}

TEST(PlyMalformed, EveryPrefixOfEverySmallFile) {
  const std::vector<std::string> files = small_files();
  for (std::size_t f = 0; f < files.size(); ++f) {
    const std::string& file = files[f];
    ASSERT_EQ(run_all(file).error, kNone) << "file " << f << ": " << describe(run_all(file));
    const std::size_t header_end = file.find("end_header") + 10;
    const bool ascii = file.find("ascii") != std::string::npos;
    for (std::size_t bytes = 0; bytes < file.size(); ++bytes) {
      const std::string prefix = file.substr(0, bytes);
      const PlyOutcome outcome = run_ply(prefix);
      const PlyOutcome pieces = run_ply(prefix, chunks_of(3));
      ASSERT_TRUE(outcome == pieces) << "file " << f << ", " << bytes << " bytes: " << describe(outcome);
      const std::string what =
          "file " + std::to_string(f) + ", " + std::to_string(bytes) + " bytes: " + describe(outcome);
      if (bytes < header_end) {
        ASSERT_EQ(outcome.error, kTruncatedHeader) << what;
        ASSERT_EQ(outcome.byte_offset, bytes) << what;
      } else if (!ascii) {
        ASSERT_EQ(outcome.error, kTruncatedBody) << what;
        ASSERT_EQ(outcome.byte_offset, bytes) << what;
      } else if (outcome.error == kNone) {
        // Only the last digits of the last number may be missing; in text this cannot be detected.
        ASSERT_EQ(token_count(prefix), token_count(file)) << what;
      } else if (outcome.error == kTruncatedBody) {
        ASSERT_EQ(outcome.byte_offset, bytes) << what;
        ASSERT_LT(token_count(prefix), token_count(file)) << what;
      } else {
        ASSERT_EQ(outcome.error, kBadNumber) << what;  // "1." is a number, "1e" and "-" are not
      }
    }
  }
}

// One byte changed anywhere: never a difference between chunkings, never an index out of range, never more than
// declared.
TEST(PlyMalformed, EveryByteOfEverySmallFileChanged) {
  const std::vector<std::string> files = small_files();
  std::set<PlyError> seen;
  for (std::size_t f = 0; f < files.size(); ++f) {
    for (std::size_t place = 0; place < files[f].size(); ++place) {
      for (const char byte : {'\0', '\xFF', '\n', '9', ' ', '-'}) {
        std::string file = files[f];
        file[place] = byte;
        const PlyOutcome whole = run_ply(file);
        const PlyOutcome pieces = run_ply(file, chunks_of(1));
        ASSERT_TRUE(whole == pieces) << "file " << f << ", byte " << place << " as " << static_cast<int>(byte) << ": "
                                     << describe(pieces) << "\ninstead of " << describe(whole);
        seen.insert(whole.error);
        for (const auto& triangle : whole.triangles) {
          for (const std::uint32_t index : triangle) ASSERT_LT(index, whole.vertex_count);
        }
        ASSERT_LE(whole.vertices.size(), whole.vertex_count);
      }
    }
  }
  EXPECT_GE(seen.size(), 15u);  // the changes reach many of the checks
}

TEST(PlyMalformed, EveryErrorHasWords) {
  std::set<std::string> words;
  for (int i = 0; i <= static_cast<int>(kTriangleSpanTooSmall); ++i) {
    const std::string reason = ply_error_reason(static_cast<PlyError>(i));
    EXPECT_TRUE(words.insert(reason).second) << reason;
    EXPECT_EQ(reason.empty(), i == 0);
    EXPECT_NE(reason, "unknown error");
  }
}

// The caller stops feeding in the middle and makes no further call.
TEST(PlyMalformed, AbandonedInTheMiddle) {
  for (const std::string& file : small_files()) {
    for (std::size_t bytes = 0; bytes < file.size(); bytes += 5) {
      PlyReader reader;
      std::span<const std::byte> rest = std::as_bytes(std::span(file)).first(bytes);
      PlyStep step;
      do {
        step = reader.feed(rest);
        rest = rest.subspan(step.consumed_bytes);
        ASSERT_NE(step.event, PlyEvent::kError);
        ASSERT_NE(step.event, PlyEvent::kEnd);
      } while (step.event != PlyEvent::kNeedInput);
      EXPECT_EQ(reader.error(), kNone);
    }
  }
}

}  // namespace
}  // namespace gridiron::test
