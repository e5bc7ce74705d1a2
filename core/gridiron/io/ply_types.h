// Vocabulary of the PLY reader: errors, where they happened, limits, counts.
// Memory: values only. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

namespace gridiron {

/// Why a PLY input was rejected. kNone is zero. ply_error_reason() describes each in a few words.
enum class [[nodiscard]] PlyError : std::uint8_t {
  kNone = 0,

  // Header.
  kNotPly,                  ///< the first line is not "ply"
  kTruncatedHeader,         ///< the input ends before end_header
  kUnknownKeyword,          ///< a header line starts with no known word
  kMissingWord,             ///< a header line has too few words
  kExtraWord,               ///< a header line has too many words
  kBadCharacter,            ///< a control character in a header line other than a comment
  kLineTooLong,             ///< the words of a header line exceed kPlyTextBytes
  kMissingFormat,           ///< no format line
  kDuplicateFormat,         ///< two format lines
  kUnknownFormat,           ///< neither ascii, binary_little_endian nor binary_big_endian
  kUnknownVersion,          ///< a version other than 1.0
  kBadElementCount,         ///< not a plain decimal number below 2^63
  kDuplicateElement,        ///< two elements of one name
  kDuplicateProperty,       ///< two properties of one name in an element, or both vertex_index and vertex_indices
  kPropertyWithoutElement,  ///< a property line before the first element line
  kUnknownType,             ///< a property type that the format does not know
  kBadListCountType,        ///< a list whose count is of a floating-point type
  kBadIndexType,            ///< vertex indices that are no list, or a list of a floating-point type
  kBadCoordinateType,       ///< x, y or z is a list
  kNoVertexElement,         ///< no element "vertex"
  kMissingCoordinate,       ///< the vertices lack x, y or z
  kMissingIndices,          ///< faces or strips, but no vertex_indices
  kTooManyElements,         ///< above PlyConfig::max_elements
  kTooManyProperties,       ///< above PlyConfig::max_properties, all elements together
  kNamesTooLong,            ///< names of elements and properties exceed kPlyNameBytes together
  kTooManyVertices,         ///< above PlyConfig::max_vertices

  // Body.
  kTruncatedBody,         ///< the input ends before the last declared row does
  kBadNumber,             ///< ASCII: a token that is not a number, or no integer where one is declared
  kTokenTooLong,          ///< ASCII: a token longer than kPlyTextBytes
  kValueRange,            ///< ASCII: an integer outside the range of its declared type
  kNotFinite,             ///< a coordinate that is NaN, infinite, or not finite as a float
  kNegativeListCount,     ///< a list with fewer than no entries
  kIndexRange,            ///< an index that is no vertex of the header's count
  kRowsAndLinesDisagree,  ///< ASCII: a row starts inside a line, though the body has several lines
  kTooManyTriangles,      ///< above PlyConfig::max_triangles

  // Memory given to read_ply.
  kVertexSpanTooSmall,    ///< fewer places than the header's vertices; nothing was written
  kTriangleSpanTooSmall,  ///< fewer places than triangles; those that fit were written
};

/// A short description of an error, for messages of tools. Never null; "" for kNone.
[[nodiscard]] const char* ply_error_reason(PlyError error);

inline constexpr std::size_t kPlyElementCapacity = 32;    ///< elements a reader can hold
inline constexpr std::size_t kPlyPropertyCapacity = 256;  ///< properties a reader can hold, all elements together
inline constexpr std::size_t kPlyNameBytes = 4096;        ///< names a reader can hold, all together
inline constexpr std::size_t kPlyTextBytes = 256;         ///< one number, or the words of one header line
inline constexpr std::size_t kPlyShownNameBytes = 32;     ///< element name in a position, cut to fit, with its NUL

inline constexpr std::uint32_t kPlyNoElement = 0xFFFFFFFFu;  ///< of an error that belongs to no element

/// Limits of one reader. Comments, list lengths and rows of skipped elements need no limit: they cost no memory.
struct PlyConfig {
  std::uint32_t max_elements = kPlyElementCapacity;     ///< more than the capacity means the capacity
  std::uint32_t max_properties = kPlyPropertyCapacity;  ///< more than the capacity means the capacity
  std::uint64_t max_vertices = 0xFFFFFFFFu;             ///< more than 2^32 - 1 means that
  std::uint64_t max_triangles = 0xFFFFFFFEu;            ///< more than 2^32 - 2 means that (see kNoTriangle)
};

/// Where an error is. Equal for every way of cutting the input into pieces.
struct PlyPosition {
  std::uint64_t byte_offset = 0;                ///< first byte of the offending word or value; the input's end if short
  std::uint64_t line = 0;                       ///< from 1, in the header and in an ASCII body; 0 in a binary body
  std::uint32_t element_index = kPlyNoElement;  ///< in the header's order; kPlyNoElement where there is none
  char element_name[kPlyShownNameBytes] = {};   ///< of that element
  std::uint64_t row = 0;                        ///< from 0, in that element; 0 in the header
};

/// How the body is written.
enum class PlyFormat : std::uint8_t {
  kAscii,               ///< decimal numbers
  kBinaryLittleEndian,  ///< least byte first
  kBinaryBigEndian      ///< greatest byte first
};

/// What the header declares. Valid from PlyEvent::kHeader on.
struct PlyHeader {
  PlyFormat format = PlyFormat::kAscii;  ///< of the body
  std::uint64_t vertex_count = 0;     ///< rows of "vertex"
  std::uint64_t face_count = 0;       ///< polygons of any size
  std::uint64_t strip_row_count = 0;  ///< rows of "tristrips"; each may hold many strips
  bool has_faces = false;             ///< an element "face" is declared, perhaps with 0 rows
  bool has_strips = false;            ///< an element "tristrips" is declared, perhaps with 0 rows
  bool has_normals = false;           ///< the vertices have nx, ny and nz
  bool has_colors = false;            ///< the vertices have red, green and blue
};

/// What was read so far; final at PlyEvent::kEnd.
struct PlyCounts {
  std::uint64_t vertices = 0;       ///< rows of "vertex"
  std::uint64_t faces = 0;          ///< rows of "face"
  std::uint64_t strip_rows = 0;     ///< rows of "tristrips"
  std::uint64_t triangles = 0;      ///< after fanning polygons and unrolling strips
  std::uint64_t surplus_bytes = 0;  ///< after the last row; blanks of an ASCII body are not counted
};

}  // namespace gridiron
