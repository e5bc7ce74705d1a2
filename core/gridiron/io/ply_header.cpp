// PLY reader, first half: the header, byte by byte. The body is in ply_reader.cpp.
// Memory: the reader's. Threads: one per reader. SPDX-License-Identifier: Apache-2.0
#include <gridiron/io/ply_reader.h>

#include <bit>

namespace gridiron {
namespace {

constexpr char kMagic[] = {'p', 'l', 'y'};

bool is_blank(char c) {
  return c == ' ' || c == '\t';
}
bool is_line_end(char c) {
  return c == '\n' || c == '\r';
}
bool is_control(char c) {
  const auto code = static_cast<unsigned char>(c);
  return code < 0x20 || code == 0x7F;
}

}  // namespace

bool PlyReader::header_byte(char c, std::uint64_t byte_offset) {
  if (first_line_return_) {
    first_line_return_ = false;
    return_only_ = c != '\n';
  }
  if (after_return_) {
    after_return_ = false;
    if (c == '\n') return true;  // second half of a line end
  }

  if (is_line_end(c)) {
    if (stage_ == Stage::kMagic) {
      if (magic_bytes_ < sizeof(kMagic)) return fail(PlyError::kNotPly, byte_offset, line_, kPlyNoElement);
      first_line_return_ = c == '\r';
    }
    after_return_ = c == '\r';
    if (stage_ == Stage::kHeaderLine && !end_line()) return false;
    ++line_;
    if (stage_ == Stage::kMagic || stage_ == Stage::kHeaderComment) stage_ = Stage::kHeaderLine;
    word_count_ = 0;
    text_bytes_ = 0;
    return true;
  }

  if (stage_ == Stage::kHeaderComment) return true;
  if (stage_ == Stage::kMagic) {
    if (magic_bytes_ == sizeof(kMagic) ? is_blank(c) : c == kMagic[magic_bytes_]) {
      if (magic_bytes_ < sizeof(kMagic)) ++magic_bytes_;
      return true;
    }
    return fail(PlyError::kNotPly, byte_offset, line_, kPlyNoElement);
  }

  if (is_blank(c)) {
    end_word();
    return true;
  }
  if (is_control(c)) return fail(PlyError::kBadCharacter, byte_offset, line_, kPlyNoElement);
  if (!in_word_) {
    in_word_ = true;
    if (word_count_ <= kWordCapacity) {
      words_[word_count_] = {byte_offset, text_bytes_, 0};
      ++word_count_;
    }
  }
  if (word_count_ > kWordCapacity) return true;  // only its place is wanted, for the error
  if (text_bytes_ == kPlyTextBytes) return fail_at_word(PlyError::kLineTooLong, word_count_ - 1u);
  text_[text_bytes_++] = c;
  ++words_[word_count_ - 1u].bytes;
  return true;
}

// The input ends inside the header. Right only where its last line is end_header without a line end.
bool PlyReader::header_ends_early() {
  if (stage_ == Stage::kHeaderFeed) {
    begin_element(0);
    return true;
  }
  if (stage_ == Stage::kHeaderLine && word_count_ == 1 && word_is(0, "end_header")) return end_line();
  return fail(PlyError::kTruncatedHeader, offset_, line_, kPlyNoElement);
}

void PlyReader::end_word() {
  if (!in_word_) return;
  in_word_ = false;
  if (word_count_ == 1 && (word_is(0, "comment") || word_is(0, "obj_info"))) stage_ = Stage::kHeaderComment;
}

bool PlyReader::end_line() {
  end_word();
  if (word_count_ == 0 || stage_ == Stage::kHeaderComment) return true;
  if (word_is(0, "property")) return property_line();
  if (word_is(0, "element")) return element_line();
  if (word_is(0, "format")) return format_line();
  if (word_is(0, "end_header")) return end_header();
  return fail_at_word(PlyError::kUnknownKeyword, 0);
}

bool PlyReader::word_is(std::size_t word, const char* expected) const {
  const char* text = text_ + words_[word].begin;
  std::size_t i = 0;
  while (i < words_[word].bytes && expected[i] != '\0' && text[i] == expected[i]) ++i;
  return i == words_[word].bytes && expected[i] == '\0';
}

bool PlyReader::require_words(std::size_t count) {
  if (word_count_ < count) return fail_at_word(PlyError::kMissingWord, 0);
  if (word_count_ > count) return fail_at_word(PlyError::kExtraWord, count);
  return true;
}

bool PlyReader::fail_at_word(PlyError error, std::size_t word) {
  const bool in_element = element_count_ > 0 && word_is(0, "property");
  return fail(error, words_[word].byte_offset, line_, in_element ? element_count_ - 1 : kPlyNoElement);
}

bool PlyReader::format_line() {
  if (!require_words(3)) return false;
  if (has_format_) return fail_at_word(PlyError::kDuplicateFormat, 0);
  if (word_is(1, "ascii")) {
    header_.format = PlyFormat::kAscii;
  } else if (word_is(1, "binary_little_endian")) {
    header_.format = PlyFormat::kBinaryLittleEndian;
  } else if (word_is(1, "binary_big_endian")) {
    header_.format = PlyFormat::kBinaryBigEndian;
  } else {
    return fail_at_word(PlyError::kUnknownFormat, 1);
  }
  if (!word_is(2, "1.0")) return fail_at_word(PlyError::kUnknownVersion, 2);
  has_format_ = true;
  swap_bytes_ = (header_.format == PlyFormat::kBinaryBigEndian) != (std::endian::native == std::endian::big);
  return true;
}

bool PlyReader::keep_name(std::size_t word, Text& name) {
  const Word& source = words_[word];
  if (source.bytes > kPlyNameBytes - name_bytes_) return fail_at_word(PlyError::kNamesTooLong, word);
  name = {static_cast<std::uint16_t>(name_bytes_), source.bytes};
  for (std::size_t i = 0; i < source.bytes; ++i) names_[name_bytes_ + i] = text_[source.begin + i];
  name_bytes_ += source.bytes;
  return true;
}

bool PlyReader::same_name(Text name, std::size_t word) const {
  if (name.bytes != words_[word].bytes) return false;
  std::size_t i = 0;
  while (i < name.bytes && names_[name.begin + i] == text_[words_[word].begin + i]) ++i;
  return i == name.bytes;
}

bool PlyReader::element_line() {
  if (!require_words(3)) return false;
  std::uint64_t count = 0;
  for (std::size_t i = 0; i < words_[2].bytes; ++i) {
    const char c = text_[words_[2].begin + i];
    constexpr std::uint64_t kLimit = (std::uint64_t{1} << 63) - 1;
    if (c < '0' || c > '9') return fail_at_word(PlyError::kBadElementCount, 2);
    const std::uint64_t digit = static_cast<std::uint64_t>(c - '0');
    if (count > (kLimit - digit) / 10) return fail_at_word(PlyError::kBadElementCount, 2);
    count = count * 10 + digit;
  }
  for (std::uint32_t i = 0; i < element_count_; ++i) {
    if (same_name(elements_[i].name, 1)) return fail_at_word(PlyError::kDuplicateElement, 1);
  }
  if (element_count_ >= config_.max_elements) return fail_at_word(PlyError::kTooManyElements, 0);

  Element element;
  if (!keep_name(1, element.name)) return false;
  element.row_count = count;
  element.byte_offset = words_[0].byte_offset;
  element.line = static_cast<std::uint32_t>(line_ < 0xFFFFFFFFu ? line_ : 0xFFFFFFFFu);
  element.first_property = static_cast<std::uint16_t>(property_total_);
  if (word_is(1, "vertex")) {
    element.kind = Kind::kVertex;
    if (count > config_.max_vertices) return fail_at_word(PlyError::kTooManyVertices, 2);
    header_.vertex_count = count;
  } else if (word_is(1, "face")) {
    element.kind = Kind::kFace;
    header_.has_faces = true;
    header_.face_count = count;
  } else if (word_is(1, "tristrips")) {
    element.kind = Kind::kStrip;
    header_.has_strips = true;
    header_.strip_row_count = count;
  }
  elements_[element_count_++] = element;
  return true;
}

PlyReader::Type PlyReader::type_from(std::size_t word) const {
  struct Spelling {
    const char* name;
    Type type;
  };
  const Spelling spellings[] = {
      {"char", Type::kInt8},     {"int8", Type::kInt8},       {"uchar", Type::kUint8},    {"uint8", Type::kUint8},
      {"short", Type::kInt16},   {"int16", Type::kInt16},     {"ushort", Type::kUint16},  {"uint16", Type::kUint16},
      {"int", Type::kInt32},     {"int32", Type::kInt32},     {"uint", Type::kUint32},    {"uint32", Type::kUint32},
      {"float", Type::kFloat32}, {"float32", Type::kFloat32}, {"double", Type::kFloat64}, {"float64", Type::kFloat64}};
  for (const Spelling& spelling : spellings) {
    if (word_is(word, spelling.name)) return spelling.type;
  }
  return Type::kNone;
}

PlyReader::Role PlyReader::role_of(std::size_t word, Kind kind) const {
  if (kind == Kind::kVertex) {
    if (word_is(word, "x")) return Role::kX;
    if (word_is(word, "y")) return Role::kY;
    if (word_is(word, "z")) return Role::kZ;
  } else if (kind == Kind::kFace || kind == Kind::kStrip) {
    if (word_is(word, "vertex_indices") || word_is(word, "vertex_index")) {
      return kind == Kind::kFace ? Role::kFaceIndices : Role::kStripIndices;
    }
  }
  return Role::kSkip;
}

std::uint8_t PlyReader::attribute_of(std::size_t word, Kind kind) const {
  const char* const names[kAttributes] = {"nx", "ny", "nz", "red", "green", "blue"};
  std::uint8_t attribute = 0;
  while (attribute < kAttributes && !(kind == Kind::kVertex && word_is(word, names[attribute]))) ++attribute;
  return attribute;
}

bool PlyReader::property_line() {
  const bool is_list = word_count_ > 1 && word_is(1, "list");
  const std::size_t name_word = is_list ? 4 : 2;
  if (!require_words(name_word + 1)) return false;
  if (element_count_ == 0) return fail_at_word(PlyError::kPropertyWithoutElement, 0);
  Element& element = elements_[element_count_ - 1];

  Property property;
  if (is_list) {
    property.count_type = type_from(2);
    if (property.count_type == Type::kNone) return fail_at_word(PlyError::kUnknownType, 2);
    if (is_floating(property.count_type)) return fail_at_word(PlyError::kBadListCountType, 2);
  }
  property.type = type_from(name_word - 1);
  if (property.type == Type::kNone) return fail_at_word(PlyError::kUnknownType, name_word - 1);
  property.role = role_of(name_word, element.kind);
  property.attribute = is_list ? kNoAttribute : attribute_of(name_word, element.kind);
  const bool is_coordinate = element.kind == Kind::kVertex && property.role != Role::kSkip;
  const bool is_index = element.kind != Kind::kVertex && property.role != Role::kSkip;
  for (std::size_t i = 0; i < element.property_count; ++i) {
    const Property& other = properties_[element.first_property + i];
    if (same_name(other.name, name_word) || (is_index && other.role != Role::kSkip)) {
      return fail_at_word(PlyError::kDuplicateProperty, name_word);
    }
  }
  if (is_coordinate && is_list) return fail_at_word(PlyError::kBadCoordinateType, 1);
  if (is_index && (!is_list || is_floating(property.type))) {
    return fail_at_word(PlyError::kBadIndexType, name_word - 1);
  }
  if (property_total_ >= config_.max_properties) return fail_at_word(PlyError::kTooManyProperties, 0);
  if (!keep_name(name_word, property.name)) return false;
  properties_[property_total_++] = property;
  ++element.property_count;
  return true;
}

bool PlyReader::check_element(std::uint32_t element_index) {
  const Element& element = elements_[element_index];
  std::uint32_t wanted = 0;  // properties that are neither skipped nor missing
  for (std::size_t i = 0; i < element.property_count; ++i) {
    if (properties_[element.first_property + i].role != Role::kSkip) ++wanted;
  }
  if (element.kind == Kind::kVertex && wanted < 3) {
    return fail(PlyError::kMissingCoordinate, element.byte_offset, element.line, element_index);
  }
  // Writers of point clouds declare faces without properties: no row, no index.
  const bool needs_indices = element.kind == Kind::kFace || element.kind == Kind::kStrip;
  if (needs_indices && element.row_count > 0 && wanted == 0) {
    return fail(PlyError::kMissingIndices, element.byte_offset, element.line, element_index);
  }
  return true;
}

// A normal or a colour counts if all three parts of it are there.
void PlyReader::note_attributes(const Element& element) {
  std::uint32_t found = 0;
  for (std::size_t i = 0; i < element.property_count; ++i) {
    const std::uint8_t attribute = properties_[element.first_property + i].attribute;
    if (attribute < kAttributes) found |= 1u << attribute;
  }
  constexpr std::uint32_t kNormal = 7, kColor = 7u << 3;
  header_.has_normals = (found & kNormal) == kNormal;
  header_.has_colors = (found & kColor) == kColor;
}

bool PlyReader::end_header() {
  if (!require_words(1)) return false;
  if (!has_format_) return fail_at_word(PlyError::kMissingFormat, 0);
  bool has_vertices = false;
  for (std::uint32_t i = 0; i < element_count_; ++i) {
    if (!check_element(i)) return false;
    if (elements_[i].kind != Kind::kVertex) continue;
    has_vertices = true;
    note_attributes(elements_[i]);
  }
  if (!has_vertices) return fail_at_word(PlyError::kNoVertexElement, 0);

  pending_ = PlyEvent::kHeader;
  if (after_return_ && !return_only_) {
    // The line feed that may follow is part of the line end; what else follows is data.
    stage_ = Stage::kHeaderFeed;
    pending_ = PlyEvent::kNeedInput;
  } else {
    begin_element(0);
  }
  return true;
}

}  // namespace gridiron
