// PLY reader: its steps, rows, polygons and strips. The header is in ply_header.cpp, the two forms of a body in
// ply_ascii.cpp and ply_binary.cpp.
// Memory: the reader's and the caller's spans. Threads: one per reader. SPDX-License-Identifier: Apache-2.0
#include <gridiron/io/decimal.h>
#include <gridiron/io/ply_reader.h>

#include <bit>

namespace gridiron {
namespace {

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
  constexpr std::uint8_t kBytes[] = {1, 1, 2, 2, 4, 4, 4, 8, 0};  // in the order of Type
  static_assert(sizeof(kBytes) == static_cast<std::size_t>(Type::kNone) + 1);
  return kBytes[static_cast<std::size_t>(type)];
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
      if (property.attribute < kAttributes) {
        layout_.attribute_offset_bytes[property.attribute] = bytes;
        layout_.attribute_types[property.attribute] = property.type;
      }
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
    keep_attributes(batch_);
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
  if (!are_finite_bits(float_bits)) return fail_in_row(PlyError::kNotFinite, byte_offset);
  // Only called for x, y, z. NOLINTNEXTLINE(clang-analyzer-alpha.security.ArrayBound)
  coordinate_bits_[static_cast<std::size_t>(current_property().role) - static_cast<std::size_t>(Role::kX)] = float_bits;
  end_property();
  return true;
}

// Whether the current output has a place for a property that is otherwise skipped.
bool PlyReader::is_kept(const Property& property) const {
  if (property.attribute >= kAttributes || output_.vertices.empty()) return false;
  return property.attribute < 3 ? header_.has_normals && !output_.normals.empty()
                                : header_.has_colors && !output_.colors.empty();
}

float PlyReader::attribute_value(std::uint64_t bits, Type type, std::uint8_t attribute) {
  float value = 0.0f;
  switch (type) {
    case Type::kInt8:
      value = static_cast<float>(static_cast<std::int8_t>(bits));
      break;
    case Type::kInt16:
      value = static_cast<float>(static_cast<std::int16_t>(bits));
      break;
    case Type::kInt32:
      value = static_cast<float>(static_cast<std::int32_t>(bits));
      break;
    case Type::kFloat32:
      value = std::bit_cast<float>(static_cast<std::uint32_t>(bits));
      break;
    case Type::kFloat64:
      value = std::bit_cast<float>(float_bits_from_double_bits(bits));
      break;
    default:
      value = static_cast<float>(bits);
      break;
  }
  if (!are_finite_bits(std::bit_cast<std::uint32_t>(value))) return 0.0f;
  if (attribute < 3) return value;
  // Wider integers hold bytes too, where a writer knew no other type.
  if (!is_floating(type)) value = value / (type == Type::kUint16 ? 65535.0f : 255.0f);
  return value < 0.0f ? 0.0f : smaller(value, 1.0f);
}

void PlyReader::keep_attributes(std::size_t item) {
  if (header_.has_normals && !output_.normals.empty()) {
    output_.normals[item] = Vec3(attributes_[0], attributes_[1], attributes_[2]);
  }
  if (header_.has_colors && !output_.colors.empty()) {
    output_.colors[item] = Vec3(attributes_[3], attributes_[4], attributes_[5]);
  }
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

// --- Whole inputs ---------------------------------------------------------------------------------------------------

namespace {

bool holds(const PlyOutput& output, std::uint64_t vertex_count) {
  return vertex_count <= output.vertices.size() && (output.normals.empty() || vertex_count <= output.normals.size()) &&
         (output.colors.empty() || vertex_count <= output.colors.size());
}

PlyResult read_whole(std::span<const std::byte> input, PlyReader& reader, PlyOutput output, bool keep) {
  PlyResult result;
  std::size_t triangle_places = output.triangles.size();
  for (;;) {  // each turn consumes bytes, ends an element, fills a span or ends
    const PlyStep step = input.empty() ? reader.finish() : reader.feed(input);
    input = input.subspan(step.consumed_bytes);
    if (step.event == PlyEvent::kEnd || step.event == PlyEvent::kError) break;
    if (!keep) continue;
    if (step.event == PlyEvent::kHeader && !holds(output, reader.header().vertex_count)) {
      result.error = PlyError::kVertexSpanTooSmall;
      result.header = reader.header();
      return result;
    }
    if (step.event == PlyEvent::kVertices) {
      output.vertices = output.vertices.subspan(step.item_count);
      if (!output.normals.empty()) output.normals = output.normals.subspan(step.item_count);
      if (!output.colors.empty()) output.colors = output.colors.subspan(step.item_count);
    }
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
  return read_ply(input, PlyOutput{vertices, triangles}, config);
}

PlyResult read_ply(std::span<const std::byte> input, const PlyOutput& output, const PlyConfig& config) {
  PlyReader reader(config);
  return read_whole(input, reader, output, true);
}

}  // namespace gridiron
