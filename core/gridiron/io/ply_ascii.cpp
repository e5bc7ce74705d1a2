// PLY reader: bodies of text. Memory: the reader's and the caller's spans. Threads: one per reader.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/io/decimal.h>
#include <gridiron/io/ply_reader.h>

#include <bit>

namespace gridiron {
namespace {

bool is_blank(char c) {
  return c == ' ' || c == '\n' || c == '\t' || c == '\r';
}

}  // namespace

bool PlyReader::ascii_body(const char* text, std::size_t count, std::size_t& used, bool at_end) {
  while (stage_ == Stage::kBody && pending_ == PlyEvent::kNeedInput) {
    if (text_bytes_ == 0) {
      if (!skip_blanks(text, count, used)) return true;
      if (!token_begins(offset_ + used, property_ == 0 && !in_list_)) return false;
    }
    std::size_t end = used;
    while (end < count && !is_blank(text[end])) ++end;
    if (text_bytes_ == 0 && end < count) {
      if (end - used > kPlyTextBytes) return fail_in_row(PlyError::kTokenTooLong, offset_ + used);
      if (!token(text + used, end - used, offset_ + used)) return false;
      used = end;
      continue;
    }
    // The piece ends inside the token, or began inside it: gather it.
    if (text_bytes_ == 0) token_offset_ = offset_ + used;
    if (end - used > kPlyTextBytes - text_bytes_) return fail_in_row(PlyError::kTokenTooLong, token_offset_);
    for (; used < end; ++used) text_[text_bytes_++] = text[used];
    if (end == count && !at_end) return true;
    const std::size_t bytes = text_bytes_;
    text_bytes_ = 0;
    if (!token(text_, bytes, token_offset_)) return false;
  }
  return true;
}

// Steps over blanks and counts lines. Returns false at the end of the piece.
bool PlyReader::skip_blanks(const char* text, std::size_t count, std::size_t& used) {
  for (; used < count && is_blank(text[used]); ++used) {
    const char c = text[used];
    if (c == '\r' || (c == '\n' && !after_return_)) {
      ++line_;
      line_has_token_ = false;
    }
    after_return_ = c == '\r';
  }
  if (used == count) return false;
  after_return_ = false;
  return true;
}

// Rows are lines, or the whole body is one line. Anything between the two is what a header that declares fewer values
// than the lines hold looks like; read as a stream it would give a wrong mesh without an error.
bool PlyReader::token_begins(std::uint64_t byte_offset, bool row_start) {
  if (line_has_token_) {
    row_inside_line_ = row_inside_line_ || row_start;
  } else {
    body_spans_lines_ = body_has_token_;
  }
  line_has_token_ = true;
  body_has_token_ = true;
  if (!row_inside_line_ || !body_spans_lines_) return true;
  if (stage_ == Stage::kBody) return fail_in_row(PlyError::kRowsAndLinesDisagree, byte_offset);
  return fail(PlyError::kRowsAndLinesDisagree, byte_offset, line_, kPlyNoElement);
}

// Counts what follows the last row.
bool PlyReader::ascii_trailer(const char* text, std::size_t count, std::size_t& used) {
  while (skip_blanks(text, count, used)) {
    if (!token_begins(offset_ + used, false)) return false;
    for (; used < count && !is_blank(text[used]); ++used) ++counts_.surplus_bytes;
  }
  return true;
}

bool PlyReader::token(const char* text, std::size_t bytes, std::uint64_t byte_offset) {
  const Property& property = current_property();
  const bool is_count = property.count_type != Type::kNone && !in_list_;
  if (property.role == Role::kSkip && !is_count) {
    if (!is_number(text, bytes)) return fail_in_row(PlyError::kBadNumber, byte_offset);
    if (is_kept(property)) {
      std::uint32_t float_bits = 0;
      if (parse_float(text, bytes, float_bits) != DecimalStatus::kOk) float_bits = 0;
      // A colour of an integer type is scaled as in a binary body.
      const float value = std::bit_cast<float>(float_bits);
      const bool is_scaled = property.attribute >= 3 && !is_floating(property.type);
      const float scaled = is_scaled ? value / (property.type == Type::kUint16 ? 65535.0f : 255.0f) : value;
      attributes_[property.attribute] =
          attribute_value(std::bit_cast<std::uint32_t>(scaled), Type::kFloat32, property.attribute);
    }
    if (!in_list_ || --list_left_ == 0) end_property();
    return true;
  }

  const Type type = is_count ? property.count_type : property.type;
  if (is_floating(type)) {
    std::uint32_t float_bits = 0;
    const DecimalStatus status = parse_float(text, bytes, float_bits);
    if (status == DecimalStatus::kNotFinite) return fail_in_row(PlyError::kNotFinite, byte_offset);
    if (status != DecimalStatus::kOk) return fail_in_row(PlyError::kBadNumber, byte_offset);
    return coordinate(float_bits, byte_offset);
  }
  std::int64_t value = 0;
  const DecimalStatus status = parse_integer(text, bytes, value);
  if (status == DecimalStatus::kSyntax) return fail_in_row(PlyError::kBadNumber, byte_offset);
  if (is_count && status == DecimalStatus::kOk && value < 0) return list_count(value, byte_offset);
  if (status == DecimalStatus::kRange || !in_range(type, value)) {
    return fail_in_row(in_list_ ? PlyError::kIndexRange : PlyError::kValueRange, byte_offset);
  }
  if (is_count) return list_count(value, byte_offset);
  if (in_list_) return index(value, byte_offset);
  return coordinate(std::bit_cast<std::uint32_t>(static_cast<float>(value)), byte_offset);
}

}  // namespace gridiron
