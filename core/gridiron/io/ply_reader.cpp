// PLY reader, second half: rows, polygons and strips. The header is in ply_header.cpp.
// Memory: the reader's and the caller's spans. Threads: one per reader. SPDX-License-Identifier: Apache-2.0
#include <gridiron/io/decimal.h>
#include <gridiron/io/ply_reader.h>

#include <bit>

namespace gridiron {
namespace {

constexpr std::uint32_t kExponentBits = 0x7F800000u;

bool is_blank(char c) {
  return c == ' ' || c == '\n' || c == '\t' || c == '\r';
}

bool is_finite(std::uint32_t float_bits) {
  return (float_bits & kExponentBits) != kExponentBits;
}

template <class Unsigned>
Unsigned load(const std::byte* bytes) {
  Unsigned value;
  __builtin_memcpy(&value, bytes, sizeof(value));
  return value;
}

std::uint32_t swapped(std::uint32_t value) {
  return __builtin_bswap32(value);
}

template <bool kSwap>
std::uint32_t load_word(const std::byte* bytes) {
  const std::uint32_t value = load<std::uint32_t>(bytes);
  return kSwap ? swapped(value) : value;
}

template <class Integer>
Integer smaller(Integer a, Integer b) {
  return b < a ? b : a;
}

}  // namespace

PlyReader::PlyReader(const PlyConfig& config) : config_(config) {
  config_.max_elements = smaller<std::uint32_t>(config.max_elements, kPlyElementCapacity);
  config_.max_properties = smaller<std::uint32_t>(config.max_properties, kPlyPropertyCapacity);
  config_.max_vertices = smaller<std::uint64_t>(config.max_vertices, 0xFFFFFFFFu);
  config_.max_triangles = smaller<std::uint64_t>(config.max_triangles, 0xFFFFFFFEu);
}

std::uint32_t PlyReader::type_bytes(Type type) {
  switch (type) {
    case Type::kInt8:
    case Type::kUint8:
      return 1;
    case Type::kInt16:
    case Type::kUint16:
      return 2;
    case Type::kInt32:
    case Type::kUint32:
    case Type::kFloat32:
      return 4;
    case Type::kFloat64:
      return 8;
    case Type::kNone:
      break;
  }
  return 0;
}

bool PlyReader::in_range(Type type, std::int64_t value) {
  const int bits = static_cast<int>(8 * type_bytes(type));
  const bool is_signed = type == Type::kInt8 || type == Type::kInt16 || type == Type::kInt32;
  const std::int64_t end = std::int64_t{1} << (is_signed ? bits - 1 : bits);
  return value < end && value >= (is_signed ? -end : 0);
}

bool PlyReader::fail(PlyError error, std::uint64_t byte_offset, std::uint64_t line, std::uint32_t element) {
  error_ = error;
  position_ = {};
  position_.byte_offset = byte_offset;
  position_.line = line;
  position_.element_index = element;
  if (element != kPlyNoElement) {
    const Text name = elements_[element].name;
    const std::size_t shown = smaller<std::size_t>(name.bytes, kPlyShownNameBytes - 1);
    for (std::size_t i = 0; i < shown; ++i) position_.element_name[i] = names_[name.begin + i];
  }
  stage_ = Stage::kFailed;
  return false;
}

bool PlyReader::fail_in_row(PlyError error, std::uint64_t byte_offset) {
  fail(error, byte_offset, header_.format == PlyFormat::kAscii ? line_ : 0, element_);
  position_.row = row_;
  return false;
}

PlyStep PlyReader::feed(std::span<const std::byte> bytes) {
  return run(bytes.data(), bytes.size(), false);
}

PlyStep PlyReader::finish() {
  return run(nullptr, 0, true);
}

PlyStep PlyReader::run(const std::byte* bytes, std::size_t count, bool at_end) {
  std::size_t used = 0;
  // Bytes of any kind may be looked at as characters.
  const char* text = reinterpret_cast<const char*>(bytes);

  while (stage_ < Stage::kHeaderFeed && used < count) {
    if (!header_byte(text[used], offset_ + used)) break;
    ++used;
  }
  if (stage_ == Stage::kHeaderFeed && used < count) {
    if (text[used] == '\n') ++used;
    after_return_ = false;
    begin_element(0);
    pending_ = PlyEvent::kHeader;
  }
  if (stage_ <= Stage::kHeaderFeed && at_end && header_ends_early()) pending_ = PlyEvent::kHeader;

  if (stage_ == Stage::kBody && pending_ == PlyEvent::kNeedInput) {
    const bool ascii = header_.format == PlyFormat::kAscii;
    const bool good = ascii ? ascii_body(text, count, used, at_end) : binary_body(bytes, count, used);
    if (good && at_end && stage_ == Stage::kBody && pending_ == PlyEvent::kNeedInput) {
      fail_in_row(PlyError::kTruncatedBody, offset_);
    }
  }
  if (stage_ == Stage::kTrailer && pending_ == PlyEvent::kNeedInput) {
    if (header_.format == PlyFormat::kAscii) {
      ascii_trailer(text, count, used);
    } else {
      counts_.surplus_bytes += count - used;
      used = count;
    }
    if (at_end && stage_ == Stage::kTrailer) stage_ = Stage::kDone;
  }

  offset_ += used;
  PlyStep step;
  step.consumed_bytes = used;
  if (stage_ == Stage::kFailed) {
    step.event = PlyEvent::kError;
  } else if (stage_ == Stage::kDone) {
    step.event = PlyEvent::kEnd;
  } else if (pending_ != PlyEvent::kNeedInput) {
    step.event = pending_;
    step.first_item = pending_first_;
    step.item_count = pending_count_;
    pending_ = PlyEvent::kNeedInput;
    pending_first_ = 0;
    pending_count_ = 0;
  }
  return step;
}

// Makes `element`, or the first one behind it that has anything to read, the current one.
void PlyReader::begin_element(std::uint32_t element) {
  text_bytes_ = 0;
  while (element < element_count_ && (elements_[element].row_count == 0 || elements_[element].property_count == 0)) {
    ++element;
  }
  element_ = element;
  property_ = 0;
  row_ = 0;
  in_list_ = false;
  stage_ = element < element_count_ ? Stage::kBody : Stage::kTrailer;
  if (stage_ == Stage::kBody && header_.format != PlyFormat::kAscii) lay_out_rows();
}

void PlyReader::lay_out_rows() {
  layout_ = {};
  const Element& element = elements_[element_];
  std::uint32_t bytes = 0;
  std::uint32_t list_count = 0;
  bool quick = true;
  for (std::size_t i = 0; i < element.property_count; ++i) {
    const Property& property = properties_[element.first_property + i];
    if (property.count_type == Type::kNone) {
      if (property.role != Role::kSkip) {
        const std::size_t axis = static_cast<std::size_t>(property.role) - static_cast<std::size_t>(Role::kX);
        layout_.offset_bytes[axis] = bytes;
        layout_.types[axis] = property.type;
      }
      bytes += type_bytes(property.type);
      continue;
    }
    // A list has a fixed place and size only as the one list of a face, three indices long.
    ++list_count;
    const bool small_count = property.count_type == Type::kUint8 || property.count_type == Type::kInt8;
    const bool wide_count = property.count_type == Type::kUint32 || property.count_type == Type::kInt32;
    const bool wide_index = property.type == Type::kUint32 ||
                            // A negative index, taken as unsigned, must be beyond the last vertex.
                            (property.type == Type::kInt32 && header_.vertex_count <= (std::uint64_t{1} << 31));
    quick = quick && property.role == Role::kFaceIndices && (small_count || wide_count) && wide_index;
    layout_.offset_bytes[0] = bytes;
    layout_.types[0] = small_count ? Type::kUint8 : Type::kUint32;
    bytes += type_bytes(property.count_type) + 3 * 4;
  }
  quick = quick && list_count == (element.kind == Kind::kFace ? 1u : 0u) && element.kind != Kind::kStrip;
  layout_.stride_bytes = quick ? bytes : 0;
  layout_.all_float =
      layout_.types[0] == Type::kFloat32 && layout_.types[1] == Type::kFloat32 && layout_.types[2] == Type::kFloat32;
}

void PlyReader::flush_batch() {
  if (batch_ == 0) return;
  const bool vertices = elements_[element_].kind == Kind::kVertex;
  pending_ = vertices ? PlyEvent::kVertices : PlyEvent::kTriangles;
  pending_first_ = (vertices ? counts_.vertices : counts_.triangles) - batch_;
  pending_count_ = batch_;
  batch_ = 0;
}

// `count` more rows of the current element are complete; the last ones may complete it.
void PlyReader::end_rows(std::uint64_t count) {
  const Element& element = elements_[element_];
  row_ += count;
  switch (element.kind) {
    case Kind::kVertex:
      counts_.vertices += count;
      break;
    case Kind::kFace:
      counts_.faces += count;
      break;
    case Kind::kStrip:
      counts_.strip_rows += count;
      break;
    case Kind::kOther:
      break;
  }
  const std::size_t capacity = element.kind == Kind::kVertex ? output_.vertices.size() : output_.triangles.size();
  if (row_ == element.row_count || batch_ == capacity) flush_batch();
  if (row_ == element.row_count) begin_element(element_ + 1);
}

void PlyReader::end_property() {
  in_list_ = false;
  if (++property_ < elements_[element_].property_count) return;
  property_ = 0;
  if (elements_[element_].kind == Kind::kVertex && !output_.vertices.empty()) {
    output_.vertices[batch_++] =
        Vec3(std::bit_cast<float>(coordinate_bits_[0]), std::bit_cast<float>(coordinate_bits_[1]),
             std::bit_cast<float>(coordinate_bits_[2]));
  }
  end_rows(1);
}

// --- Values ---------------------------------------------------------------------------------------------------------

bool PlyReader::list_count(std::int64_t count, std::uint64_t byte_offset) {
  if (count < 0) return fail_in_row(PlyError::kNegativeListCount, byte_offset);
  const Property& property = current_property();
  corner_ = 0;
  list_left_ = static_cast<std::uint64_t>(count);
  in_list_ = true;
  if (count == 0) {
    end_property();
  } else if (property.role == Role::kSkip && header_.format != PlyFormat::kAscii) {
    skip_bytes_ = list_left_ * type_bytes(property.type);
  }
  return true;
}

bool PlyReader::coordinate(std::uint32_t float_bits, std::uint64_t byte_offset) {
  if (!is_finite(float_bits)) return fail_in_row(PlyError::kNotFinite, byte_offset);
  // Only called for x, y, z. NOLINTNEXTLINE(clang-analyzer-alpha.security.ArrayBound)
  coordinate_bits_[static_cast<std::size_t>(current_property().role) - static_cast<std::size_t>(Role::kX)] = float_bits;
  end_property();
  return true;
}

bool PlyReader::emit_triangle(const UVec3& triangle, std::uint64_t byte_offset) {
  if (counts_.triangles >= config_.max_triangles) return fail_in_row(PlyError::kTooManyTriangles, byte_offset);
  ++counts_.triangles;
  if (output_.triangles.empty()) return true;
  output_.triangles[batch_++] = triangle;
  if (batch_ == output_.triangles.size()) flush_batch();
  return true;
}

bool PlyReader::index(std::int64_t value, std::uint64_t byte_offset) {
  const bool strip = current_property().role == Role::kStripIndices;
  if (strip && value == -1) {
    corner_ = 0;
  } else {
    if (value < 0 || static_cast<std::uint64_t>(value) >= header_.vertex_count) {
      return fail_in_row(PlyError::kIndexRange, byte_offset);
    }
    const std::uint32_t current = static_cast<std::uint32_t>(value);
    if (corner_ >= 2) {
      // Every other triangle of a strip is turned round, so that all show the same side.
      const bool turned = strip && (corner_ & 1) != 0;
      const UVec3 triangle = turned ? UVec3(previous_, first_, current) : UVec3(first_, previous_, current);
      if (!emit_triangle(triangle, byte_offset)) return false;
    }
    if (corner_ == 0 || (strip && corner_ >= 2)) first_ = corner_ == 0 ? current : previous_;
    previous_ = current;
    ++corner_;
  }
  if (--list_left_ == 0) end_property();
  return true;
}

// --- ASCII ----------------------------------------------------------------------------------------------------------

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

// --- Binary ---------------------------------------------------------------------------------------------------------

std::uint64_t PlyReader::load_bits(const std::byte* bytes, Type type) const {
  switch (type_bytes(type)) {
    case 1:
      return load<std::uint8_t>(bytes);
    case 2: {
      const std::uint16_t value = load<std::uint16_t>(bytes);
      return swap_bytes_ ? __builtin_bswap16(value) : value;
    }
    case 4: {
      const std::uint32_t value = load<std::uint32_t>(bytes);
      return swap_bytes_ ? __builtin_bswap32(value) : value;
    }
    default: {
      const std::uint64_t value = load<std::uint64_t>(bytes);
      return swap_bytes_ ? __builtin_bswap64(value) : value;
    }
  }
}

namespace {

template <class Signed>
std::int64_t sign_extended(std::uint64_t bits) {
  return static_cast<Signed>(bits);
}

}  // namespace

bool PlyReader::binary_value(std::uint64_t bits, Type type, std::uint64_t byte_offset) {
  if (type == Type::kFloat32) return coordinate(static_cast<std::uint32_t>(bits), byte_offset);
  if (type == Type::kFloat64) return coordinate(float_bits_from_double_bits(bits), byte_offset);
  std::int64_t value = static_cast<std::int64_t>(bits);
  if (type == Type::kInt8) value = sign_extended<std::int8_t>(bits);
  if (type == Type::kInt16) value = sign_extended<std::int16_t>(bits);
  if (type == Type::kInt32) value = sign_extended<std::int32_t>(bits);
  if (in_list_) return index(value, byte_offset);
  if (current_property().count_type != Type::kNone) return list_count(value, byte_offset);
  return coordinate(std::bit_cast<std::uint32_t>(static_cast<float>(value)), byte_offset);
}

bool PlyReader::binary_body(const std::byte* bytes, std::size_t count, std::size_t& used) {
  while (stage_ == Stage::kBody && pending_ == PlyEvent::kNeedInput) {
    // Whole rows at once, as long as they hold nothing unusual.
    const bool row_start = property_ == 0 && !in_list_ && carry_bytes_ == 0 && skip_bytes_ == 0;
    if (row_start && layout_.stride_bytes != 0 && count - used >= layout_.stride_bytes) {
      const std::uint64_t rows_left = elements_[element_].row_count - row_;
      const std::size_t rows_here = (count - used) / layout_.stride_bytes;
      const std::size_t stride_bytes = layout_.stride_bytes;
      const std::size_t done =
          quick_rows(bytes + used, rows_left < rows_here ? static_cast<std::size_t>(rows_left) : rows_here);
      used += done * stride_bytes;
      if (done > 0) end_rows(done);
      if (stage_ != Stage::kBody || pending_ != PlyEvent::kNeedInput) break;
      if (done > 0 && row_ == 0) continue;  // a new element
    }
    if (used == count) break;

    if (skip_bytes_ > 0) {
      const std::size_t left = count - used;
      const std::size_t skipped = skip_bytes_ < left ? static_cast<std::size_t>(skip_bytes_) : left;
      used += skipped;
      skip_bytes_ -= skipped;
      if (skip_bytes_ == 0) end_property();
      continue;
    }
    const Property& property = current_property();
    const bool is_count = property.count_type != Type::kNone && !in_list_;
    if (property.role == Role::kSkip && !is_count) {
      skip_bytes_ = type_bytes(property.type);
      continue;
    }

    // One value, which may come in pieces.
    const Type type = is_count ? property.count_type : property.type;
    const std::size_t wanted = type_bytes(type);
    const std::byte* value = bytes + used;
    if (carry_bytes_ > 0 || count - used < wanted) {
      while (carry_bytes_ < wanted && used < count) carry_[carry_bytes_++] = bytes[used++];
      if (carry_bytes_ < wanted) break;
      value = carry_;
      carry_bytes_ = 0;
    } else {
      used += wanted;
    }
    if (!binary_value(load_bits(value, type), type, offset_ + used - wanted)) return false;
  }
  return true;
}

// Items of `wanted` that fit the rest of a span; all of them where items are only counted.
std::size_t PlyReader::room(std::size_t span_items, std::size_t wanted) const {
  return span_items == 0 ? wanted : smaller(wanted, span_items - batch_);
}

std::size_t PlyReader::quick_rows(const std::byte* bytes, std::size_t row_count) {
  switch (elements_[element_].kind) {
    case Kind::kOther:
      return row_count;
    case Kind::kStrip:
      return 0;
    case Kind::kVertex: {
      const std::size_t rows = room(output_.vertices.size(), row_count);
      if (!layout_.all_float) return quick_vertices(bytes, rows);
      return swap_bytes_ ? quick_float_vertices<true>(bytes, rows) : quick_float_vertices<false>(bytes, rows);
    }
    case Kind::kFace:
      break;
  }
  const std::uint64_t allowed = config_.max_triangles - counts_.triangles;
  std::size_t rows = room(output_.triangles.size(), row_count);
  if (allowed < rows) rows = static_cast<std::size_t>(allowed);
  if (layout_.types[0] == Type::kUint8) {
    return swap_bytes_ ? quick_faces<true, std::uint8_t>(bytes, rows) : quick_faces<false, std::uint8_t>(bytes, rows);
  }
  return swap_bytes_ ? quick_faces<true, std::uint32_t>(bytes, rows) : quick_faces<false, std::uint32_t>(bytes, rows);
}

// The quick loops stop before the first row that is not plain; the general route then finds what is wrong with it.

template <bool kSwap>
std::size_t PlyReader::quick_float_vertices(const std::byte* bytes, std::size_t row_count) {
  const std::size_t stride_bytes = layout_.stride_bytes;
  const std::byte* x = bytes + layout_.offset_bytes[0];
  const std::byte* y = bytes + layout_.offset_bytes[1];
  const std::byte* z = bytes + layout_.offset_bytes[2];
  Vec3* output = output_.vertices.empty() ? nullptr : output_.vertices.data() + batch_;
  std::size_t row = 0;
  for (std::size_t place = 0; row < row_count; ++row, place += stride_bytes) {
    const std::uint32_t bits[3] = {load_word<kSwap>(x + place), load_word<kSwap>(y + place),
                                   load_word<kSwap>(z + place)};
    if (!(is_finite(bits[0]) && is_finite(bits[1]) && is_finite(bits[2]))) break;
    if (output != nullptr) {
      output[row] = Vec3(std::bit_cast<float>(bits[0]), std::bit_cast<float>(bits[1]), std::bit_cast<float>(bits[2]));
    }
  }
  if (output != nullptr) batch_ += row;
  return row;
}

std::size_t PlyReader::quick_vertices(const std::byte* bytes, std::size_t row_count) {
  std::size_t row = 0;
  for (; row < row_count; ++row, bytes += layout_.stride_bytes) {
    float values[3] = {};
    bool finite = true;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const Type type = layout_.types[axis];
      if (!is_floating(type)) return row;  // integers are rare: the general route is fine
      const std::uint64_t bits = load_bits(bytes + layout_.offset_bytes[axis], type);
      const std::uint32_t float_bits =
          type == Type::kFloat64 ? float_bits_from_double_bits(bits) : static_cast<std::uint32_t>(bits);
      finite = finite && is_finite(float_bits);
      values[axis] = std::bit_cast<float>(float_bits);
    }
    if (!finite) return row;
    if (!output_.vertices.empty()) output_.vertices[batch_++] = Vec3(values[0], values[1], values[2]);
  }
  return row;
}

template <bool kSwap, class Count>
std::size_t PlyReader::quick_faces(const std::byte* bytes, std::size_t row_count) {
  const std::size_t stride_bytes = layout_.stride_bytes;
  const std::uint64_t vertex_count = header_.vertex_count;
  const Count three = kSwap && sizeof(Count) == 4 ? static_cast<Count>(swapped(3)) : static_cast<Count>(3);
  UVec3* output = output_.triangles.empty() ? nullptr : output_.triangles.data() + batch_;
  const std::byte* list = bytes + layout_.offset_bytes[0];
  std::size_t row = 0;
  for (; row < row_count; ++row, list += stride_bytes) {
    const std::uint32_t a = load_word<kSwap>(list + sizeof(Count));
    const std::uint32_t b = load_word<kSwap>(list + sizeof(Count) + 4);
    const std::uint32_t c = load_word<kSwap>(list + sizeof(Count) + 8);
    if (!(load<Count>(list) == three && a < vertex_count && b < vertex_count && c < vertex_count)) break;
    if (output != nullptr) output[row] = UVec3(a, b, c);
  }
  if (output != nullptr) batch_ += row;
  counts_.triangles += row;
  return row;
}

// --- Whole inputs ---------------------------------------------------------------------------------------------------

namespace {

PlyResult read_whole(std::span<const std::byte> input, PlyReader& reader, PlyOutput output, bool keep) {
  PlyResult result;
  std::size_t triangle_places = output.triangles.size();
  for (;;) {  // each turn consumes bytes, ends an element, fills a span or ends
    const PlyStep step = input.empty() ? reader.finish() : reader.feed(input);
    input = input.subspan(step.consumed_bytes);
    if (step.event == PlyEvent::kEnd || step.event == PlyEvent::kError) break;
    if (!keep) continue;
    if (step.event == PlyEvent::kHeader && reader.header().vertex_count > output.vertices.size()) {
      result.error = PlyError::kVertexSpanTooSmall;
      result.header = reader.header();
      return result;
    }
    if (step.event == PlyEvent::kVertices) output.vertices = output.vertices.subspan(step.item_count);
    if (step.event == PlyEvent::kTriangles) output.triangles = output.triangles.subspan(step.item_count);
    if (step.event != PlyEvent::kNeedInput) reader.set_output(output);
  }
  result.error = reader.error();
  result.position = reader.position();
  result.header = reader.header();
  result.counts = reader.counts();
  if (keep && result.error == PlyError::kNone && result.counts.triangles > triangle_places) {
    result.error = PlyError::kTriangleSpanTooSmall;
  }
  return result;
}

}  // namespace

PlyResult count_ply(std::span<const std::byte> input, const PlyConfig& config) {
  PlyReader reader(config);
  return read_whole(input, reader, {}, false);
}

PlyResult read_ply(std::span<const std::byte> input, std::span<Vec3> vertices, std::span<UVec3> triangles,
                   const PlyConfig& config) {
  PlyReader reader(config);
  return read_whole(input, reader, {vertices, triangles}, true);
}

}  // namespace gridiron
