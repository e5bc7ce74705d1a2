// Shared by the checks of an image: reading records, naming the wrong field, the sections that were found.
// Internal header. Memory: borrowed. Threads: one. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/image_rules.h>
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
  ImageChecker(std::span<const std::byte> image, SceneImageError& error, const WorkSharing& sharing)
      : image_(image), error_(error), sharing_(sharing) {}

  /// Precondition: [offset, offset + sizeof(Record)) lies inside the image.
  template <class Record>
  [[nodiscard]] Record read(std::uint64_t offset) const {
    Record record;
    __builtin_memcpy(&record, image_.data() + offset, sizeof(Record));
    return record;
  }

  /// The same in place. Precondition: `offset` is a multiple of the record's alignment.
  template <class Record>
  [[nodiscard]] const Record& at(std::uint64_t offset) const {
    return *reinterpret_cast<const Record*>(image_.data() + offset);
  }

  [[nodiscard]] bool require(bool holds, std::uint64_t byte_offset, const char* field, std::uint64_t = 0) {
    if (!holds) error_ = {Status::kBadImage, byte_offset, field};
    return holds;
  }

  [[nodiscard]] bool is_intact(const ImageHeader& header) const {
    const std::span<const std::byte> image = image_.first(static_cast<std::size_t>(header.image_bytes));
    return header.check_value == scene_image_check_value(image, sharing_);
  }

  /// The triangle at `offset`, in a format that has corners. Reserved words of a lattice's record are left out.
  [[nodiscard]] VertexTriangle read_triangle(std::uint64_t offset, const GridRecord& grid) const {
    if (grid.triangle_format != static_cast<std::uint32_t>(TriangleFormat::kLattice)) {
      return read<VertexTriangle>(offset);
    }
    const auto packed = read<LatticeTriangle>(offset);
    VertexTriangle triangle{};
    triangle.triangle_id = packed.triangle_id;
    for (int corner = 0; corner < 3; ++corner) {
      for (int axis = 0; axis < 3; ++axis) {
        triangle.v[corner][axis] =
            static_cast<float>(packed.v[corner][axis]) * grid.lattice.step + grid.lattice.origin[axis];
      }
    }
    return triangle;
  }

  [[nodiscard]] std::span<const std::byte> image() const { return image_; }
  [[nodiscard]] const WorkSharing& sharing() const { return sharing_; }

 private:
  std::span<const std::byte> image_;
  SceneImageError& error_;
  const WorkSharing& sharing_;
};

/// As GRIDIRON_RULE, for fields that are not all integers.
#define GRIDIRON_REQUIRE(holds, base, record, member) GRIDIRON_RULE_OF(0, holds, base, record, member)

[[nodiscard]] inline bool is_finite(float value) {
  return (std::bit_cast<std::uint32_t>(value) & 0x7F800000u) != 0x7F800000u;
}

[[nodiscard]] inline bool finite_fields(const float* values, int count) {
  bool finite = true;
  for (int i = 0; i < count; ++i) finite = finite && is_finite(values[i]);
  return finite;
}

[[nodiscard]] inline bool same_bits(const float* a, const float* b, int count) {
  std::uint32_t differ = 0;
  for (int i = 0; i < count; ++i) differ |= std::bit_cast<std::uint32_t>(a[i]) ^ std::bit_cast<std::uint32_t>(b[i]);
  return differ == 0;
}

[[nodiscard]] inline bool is_negative_zero(float value) {
  return std::bit_cast<std::uint32_t>(value) == 0x80000000u;
}

[[nodiscard]] inline bool is_no_lattice(const Lattice& lattice) {
  const float none[3] = {0.0f, 0.0f, 0.0f};
  return same_bits(lattice.origin, none, 3) && same_bits(&lattice.step, none, 1);
}

/// With a step that is right, and an origin that is right on each axis, all values of a lattice are floats within the
/// limits of coordinates.
[[nodiscard]] inline bool is_lattice_step(float step) {
  return step >= kLeastLatticeStep && step <= kCoordinateLimit &&
         (std::bit_cast<std::uint32_t>(step) & 0x007FFFFFu) == 0;
}
[[nodiscard]] inline bool is_lattice_origin(float origin, float step) {
  const double steps = double{origin} / double{step};
  const double last = double{origin} + double{step} * (kLatticePlaces - 1);
  const bool in_range = !is_negative_zero(origin) && __builtin_fabsf(origin) <= kCoordinateLimit &&
                        last <= 8.0 * double{kCoordinateLimit} &&
                        __builtin_fabs(steps) <= double{kMostStepsFromZero} + 1.0;
  return in_range && steps == static_cast<double>(static_cast<std::int32_t>(steps));
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

/// Checks the contents of the sections of effects against header, grid and triangles.
/// Precondition: everything else in the image is right. Cost: linear.
[[nodiscard]] bool check_effect_sections(ImageChecker& checker, const SceneImageView& view);

/// Checks what the other checks need of the tree of an image without a grid: its bounds and its lattice.
[[nodiscard]] bool check_tree_space(ImageChecker& checker, const SceneImageView& view);

/// Checks the contents of the tree's sections: every kept triangle is there once, with the corners of its surface, and
/// the bounds are theirs; the nodes are numbered level by level, on paths no longer than the record says, and their
/// leaves cover the triangles in order; boxes are as built. Precondition: everything else in the image is right. Cost:
/// linear.
[[nodiscard]] bool check_tree(ImageChecker& checker, const SceneImageView& view);

}  // namespace gridiron
