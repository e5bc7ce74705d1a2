// Shared by the checks of an image: reading records, naming the wrong field, the sections that were found.
// Inside of this room. Memory: borrowed. Threads: one. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/records.h>
#include <gridiron/image/scene_image.h>

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

namespace gridiron {

/// Reads records from the image and remembers the first error and its place.
class ImageChecker {
 public:
  ImageChecker(std::span<const std::byte> image, SceneImageError& error) : image_(image), error_(error) {}

  /// Precondition: [offset, offset + sizeof(Record)) lies inside the image.
  template <class Record>
  [[nodiscard]] Record read(std::uint64_t offset) const {
    Record record;
    __builtin_memcpy(&record, image_.data() + offset, sizeof(Record));
    return record;
  }

  [[nodiscard]] bool require(bool holds, std::uint64_t byte_offset, const char* field) {
    if (!holds) error_ = {Status::kBadImage, byte_offset, field};
    return holds;
  }

  [[nodiscard]] std::span<const std::byte> image() const { return image_; }

 private:
  std::span<const std::byte> image_;
  SceneImageError& error_;
};

/// Returns false from a check that has an ImageChecker `checker` if a field of a record at `base` is wrong.
#define GRIDIRON_REQUIRE(holds, base, record_type, member, name) \
  if (!checker.require((holds), (base) + offsetof(record_type, member), (name))) return false

[[nodiscard]] inline bool is_finite(float value) {
  return (std::bit_cast<std::uint32_t>(value) & 0x7F800000u) != 0x7F800000u;
}

[[nodiscard]] inline bool finite_fields(const float* values, int count) {
  bool finite = true;
  for (int i = 0; i < count; ++i) finite = finite && is_finite(values[i]);
  return finite;
}

[[nodiscard]] inline bool all_zero(const std::uint32_t* words, int count) {
  std::uint32_t any = 0;
  for (int i = 0; i < count; ++i) any |= words[i];
  return any == 0;
}

/// The known sections by kind, and where their entries stand.
struct Sections {
  static constexpr std::uint32_t kGeometryCount = 4;  ///< in every image
  static constexpr std::uint32_t kKnownCount = 10;
  SectionEntry entries[kKnownCount] = {};
  std::uint64_t entry_offsets[kKnownCount] = {};
  bool found[kKnownCount] = {};

  [[nodiscard]] static std::uint32_t index_of(SectionKind kind) { return static_cast<std::uint32_t>(kind) - 1; }
  [[nodiscard]] const SectionEntry& entry(SectionKind kind) const { return entries[index_of(kind)]; }
  [[nodiscard]] std::uint64_t entry_offset(SectionKind kind) const { return entry_offsets[index_of(kind)]; }
  [[nodiscard]] bool has(SectionKind kind) const { return found[index_of(kind)]; }
};

/// Checks that a section was found and holds that many elements of that size, so that all of them lie inside the image.
[[nodiscard]] inline bool check_elements(ImageChecker& checker, const Sections& sections, SectionKind kind,
                                         std::uint64_t element_bytes, std::uint64_t element_count) {
  const SectionEntry& entry = sections.entry(kind);
  const std::uint64_t place = sections.entry_offset(kind);
  GRIDIRON_REQUIRE(entry.element_bytes == element_bytes, place, SectionEntry, element_bytes, "section.element_bytes");
  GRIDIRON_REQUIRE(entry.element_count == element_count, place, SectionEntry, element_count, "section.element_count");
  return true;
}

/// Checks that bytes [begin, end) of the image, multiples of 4, are padding: all zero.
[[nodiscard]] inline bool check_padding(ImageChecker& checker, std::uint64_t begin, std::uint64_t end) {
  for (std::uint64_t at = begin; at < end; at += sizeof(std::uint32_t)) {
    const auto word = checker.read<std::uint32_t>(at);
    if (word == 0) continue;
    std::uint64_t zeros = 0;
    while ((word >> 8 * zeros & 0xFFu) == 0) ++zeros;
    return checker.require(false, at + zeros, "padding");
  }
  return true;
}

/// Checks the triangles against the cells: every triangle is in the cells that the builder puts it into and in no
/// other, with the same bytes, and the grid's bounds are theirs. For projections it checks only that the records of a
/// triangle are equal. Precondition: grid, macro table and cell blocks are right, and ids ascend within each cell.
/// Cost: linear.
[[nodiscard]] bool check_geometry(ImageChecker& checker, const Sections& sections, const SceneImageView& view);

/// Checks the sections of effects, all or none, against header, grid and triangles. Fills the view's effects.
/// Precondition: everything else in the image is right. Cost: linear.
[[nodiscard]] bool check_effect_sections(ImageChecker& checker, const Sections& sections, SceneImageView& view);

}  // namespace gridiron
