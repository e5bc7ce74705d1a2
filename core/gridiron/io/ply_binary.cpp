// PLY reader: binary bodies, value by value, or quickly by whole rows.
// Memory: the reader's and the caller's spans. Threads: one per reader. SPDX-License-Identifier: Apache-2.0
#include <gridiron/io/decimal.h>
#include <gridiron/io/ply_reader.h>

#include <bit>

namespace gridiron {
namespace {

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

template <class Signed>
std::int64_t sign_extended(std::uint64_t bits) {
  return static_cast<Signed>(bits);
}

}  // namespace

std::uint64_t PlyReader::load_bits(const std::byte* bytes, Type type) const {
  const std::uint32_t byte_count = type_bytes(type);
  const std::uint64_t bits = byte_count == 1   ? load<std::uint8_t>(bytes)
                             : byte_count == 2 ? load<std::uint16_t>(bytes)
                             : byte_count == 4 ? load<std::uint32_t>(bytes)
                                               : load<std::uint64_t>(bytes);
  return swap_bytes_ ? __builtin_bswap64(bits) >> (64 - 8 * byte_count) : bits;
}

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
    if (property.role == Role::kSkip && !is_count && !is_kept(property)) {
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
    if (property.attribute < kAttributes) {
      attributes_[property.attribute] = attribute_value(load_bits(value, type), type, property.attribute);
      end_property();
      continue;
    }
    if (!binary_value(load_bits(value, type), type, offset_ + used - wanted)) return false;
  }
  return true;
}

// Items of `wanted` that fit the rest of a span; all of them where items are only counted.
std::size_t PlyReader::room(std::size_t span_items, std::size_t wanted) const {
  return span_items == 0 || wanted < span_items - batch_ ? wanted : span_items - batch_;
}

std::size_t PlyReader::quick_rows(const std::byte* bytes, std::size_t row_count) {
  switch (elements_[element_].kind) {
    case Kind::kOther:
      return row_count;
    case Kind::kStrip:
      return 0;
    case Kind::kVertex: {
      const std::size_t rows = room(output_.vertices.size(), row_count);
      const std::size_t first_item = batch_;
      const std::size_t done = !layout_.all_float ? quick_vertices(bytes, rows)
                               : swap_bytes_      ? quick_float_vertices<true>(bytes, rows)
                                                  : quick_float_vertices<false>(bytes, rows);
      quick_attributes(bytes, done, first_item);
      return done;
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
    if (!(are_finite_bits(bits[0]) && are_finite_bits(bits[1]) && are_finite_bits(bits[2]))) break;
    if (output != nullptr) {
      output[row] = Vec3(std::bit_cast<float>(bits[0]), std::bit_cast<float>(bits[1]), std::bit_cast<float>(bits[2]));
    }
  }
  if (output != nullptr) batch_ += row;
  return row;
}

void PlyReader::quick_attributes(const std::byte* bytes, std::size_t row_count, std::size_t first_item) {
  const bool has_normals = header_.has_normals && !output_.normals.empty();
  const bool has_colors = header_.has_colors && !output_.colors.empty();
  if (output_.vertices.empty() || (!has_normals && !has_colors)) return;
  const std::uint8_t begin = has_normals ? 0 : 3, end = has_colors ? 6 : 3;
  for (std::size_t row = 0; row < row_count; ++row, bytes += layout_.stride_bytes) {
    for (std::uint8_t i = begin; i < end; ++i) {
      const Type type = layout_.attribute_types[i];
      attributes_[i] = attribute_value(load_bits(bytes + layout_.attribute_offset_bytes[i], type), type, i);
    }
    keep_attributes(first_item + row);
  }
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
      finite = finite && are_finite_bits(float_bits);
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

}  // namespace gridiron
