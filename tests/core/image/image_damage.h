// Images that a test damages: records changed in place, the check value made right, and what opening them gives.
// Memory: a copy of the image at most. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/build/grid/built_image.h"

namespace gridiron::test {

inline constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
inline constexpr float kInfinity = std::numeric_limits<float>::infinity();
inline constexpr std::uint64_t kTableOffset = 128;
inline constexpr std::uint64_t kGridOffset = 256;

/// Where a section's entry stands in an image that has all sections up to its own.
inline std::uint64_t entry_offset(SectionKind kind) {
  // The nodes of the tree stand behind its triangles.
  const std::uint64_t number = kind == SectionKind::kTreeNodes       ? 12
                               : kind == SectionKind::kTreeTriangles ? 11
                                                                     : static_cast<std::uint64_t>(kind) - 1;
  return kTableOffset + number * sizeof(SectionEntry);
}

template <class Record>
void write_record(LineBuffer& image, std::uint64_t offset, const Record& record) {
  ASSERT_LE(offset + sizeof(Record), image.bytes().size());
  std::memcpy(image.bytes().data() + offset, &record, sizeof(Record));
}

template <class Record>
void edit(LineBuffer& image, std::uint64_t offset, const std::function<void(Record&)>& change) {
  auto record = read_record<Record>(image.bytes(), offset);
  change(record);
  write_record(image, offset, record);
}

inline void renew_check_value(LineBuffer& image) {
  write_record(image, offsetof(ImageHeader, check_value), scene_image_check_value(image.bytes()));
}

/// What opening an image gave.
struct OpenedImage {
  Status status;
  SceneImageError error;
  SceneImageView view{};
};

/// Opens bytes; a refusal must name a field and a place within them.
inline OpenedImage open_image(std::span<const std::byte> bytes) {
  OpenedImage opened;
  opened.status = open_scene_image(bytes, opened.view, opened.error);
  if (opened.status != Status::kOk) {
    EXPECT_STRNE(opened.error.field, "");
    EXPECT_EQ(opened.error.status, opened.status);
    EXPECT_LE(opened.error.byte_offset, bytes.size());
  }
  return opened;
}

/// Opens an image with a right check value: `field` must be refused, at `place` where one is given.
/// @param what  the case, for messages.
inline void expect_refused(LineBuffer image, const char* field, std::optional<std::uint64_t> place = {},
                           const std::string& what = "") {
  renew_check_value(image);
  const OpenedImage opened = open_image(image.bytes());
  EXPECT_EQ(opened.status, Status::kBadImage) << what;
  EXPECT_STREQ(opened.error.field, field) << what;
  if (place) {
    EXPECT_EQ(opened.error.byte_offset, *place) << what;
  }
}

/// A change of one field, by which an image is refused.
struct Damage {
  const char* name;
  const char* field;
  std::function<std::uint64_t(LineBuffer&, const SceneImageView&)> apply;  ///< @returns the field's byte offset
};

inline void expect_named(const Damage& damage, BuiltImage built) {
  ASSERT_FALSE(::testing::Test::HasFailure());
  const std::uint64_t place = damage.apply(built.image, built.view);
  expect_refused(built.image, damage.field, place);
}

#define DAMAGE_IN(label, field_name, record, member, base, statement)                       \
  Damage {                                                                                  \
    label, field_name, [](LineBuffer& image, [[maybe_unused]] const SceneImageView& view) { \
      const std::uint64_t offset = (base);                                                  \
      edit<record>(image, offset, [&](record& r) { statement; });                           \
      return offset + offsetof(record, member);                                             \
    }                                                                                       \
  }
#define SECTION_DAMAGE(label, kind, member, statement) \
  DAMAGE_IN(label, "section." #member, SectionEntry, member, entry_offset(kind), statement)

}  // namespace gridiron::test
