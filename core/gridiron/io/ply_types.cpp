// Short words for the PLY reader's errors.
// Memory: read-only text. Threads: any. SPDX-License-Identifier: Apache-2.0
#include <gridiron/io/ply_types.h>

namespace gridiron {

const char* ply_error_reason(PlyError error) {
  switch (error) {
    case PlyError::kNone:
      return "";
    case PlyError::kNotPly:
      return "not a PLY file: the first line is not \"ply\"";
    case PlyError::kTruncatedHeader:
      return "the header ends before end_header";
    case PlyError::kUnknownKeyword:
      return "unknown word at the start of a header line";
    case PlyError::kMissingWord:
      return "header line has too few words";
    case PlyError::kExtraWord:
      return "header line has too many words";
    case PlyError::kBadCharacter:
      return "control character in a header line";
    case PlyError::kLineTooLong:
      return "header line is too long";
    case PlyError::kMissingFormat:
      return "header has no format line";
    case PlyError::kDuplicateFormat:
      return "second format line";
    case PlyError::kUnknownFormat:
      return "unknown format";
    case PlyError::kUnknownVersion:
      return "unknown version, expected 1.0";
    case PlyError::kBadElementCount:
      return "element count is not a number that fits";
    case PlyError::kDuplicateElement:
      return "element is declared twice";
    case PlyError::kDuplicateProperty:
      return "property is declared twice";
    case PlyError::kPropertyWithoutElement:
      return "property before the first element";
    case PlyError::kUnknownType:
      return "unknown property type";
    case PlyError::kBadListCountType:
      return "list count has a floating-point type";
    case PlyError::kBadIndexType:
      return "vertex indices are not a list of integers";
    case PlyError::kBadCoordinateType:
      return "coordinate is a list";
    case PlyError::kNoVertexElement:
      return "no vertex element";
    case PlyError::kMissingCoordinate:
      return "vertices lack x, y or z";
    case PlyError::kMissingIndices:
      return "faces or strips lack a list vertex_indices or vertex_index";
    case PlyError::kTooManyElements:
      return "too many elements";
    case PlyError::kTooManyProperties:
      return "too many properties";
    case PlyError::kNamesTooLong:
      return "names of elements and properties are too long";
    case PlyError::kTooManyVertices:
      return "too many vertices";
    case PlyError::kTruncatedBody:
      return "the data end early";
    case PlyError::kBadNumber:
      return "not a number of the declared kind";
    case PlyError::kTokenTooLong:
      return "number is too long";
    case PlyError::kValueRange:
      return "number does not fit its declared type";
    case PlyError::kNotFinite:
      return "coordinate is not finite";
    case PlyError::kNegativeListCount:
      return "list has a negative count";
    case PlyError::kIndexRange:
      return "index names no vertex";
    case PlyError::kRowsAndLinesDisagree:
      return "row starts inside a line: a line does not hold the values that the header declares for it";
    case PlyError::kTooManyTriangles:
      return "too many triangles";
    case PlyError::kVertexSpanTooSmall:
      return "more vertices than memory was given for";
    case PlyError::kTriangleSpanTooSmall:
      return "more triangles than memory was given for";
  }
  return "unknown error";
}

}  // namespace gridiron
