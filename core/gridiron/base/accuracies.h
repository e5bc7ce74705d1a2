// What each accuracy needs and promises, in one table. tools/gridiron/device/accuracies.cpp has the names.
// Memory: none. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/records.h>

#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>

namespace gridiron {

/// What an accuracy needs and promises; core/README.md says more.
struct AccuracyTraits {
  TriangleFormat format{};         ///< form of triangles that it reads; TriangleFormat{} marks a missing accuracy
  bool may_leak = false;           ///< a ray may pass between two triangles that share an edge
  bool has_scene_shading = false;  ///< its hits are accurate enough for secondary rays to start there
};

// A value of Accuracy that is missing here does not compile.
#pragma GCC diagnostic push
#pragma GCC diagnostic error "-Wswitch"

/// @returns the accuracy's row of the table.
[[nodiscard]] constexpr AccuracyTraits accuracy_traits(Accuracy accuracy) {
  switch (accuracy) {
    case Accuracy::kStandard:
      return {.format = TriangleFormat::kVertices, .may_leak = false, .has_scene_shading = true};
    case Accuracy::kPaper:
      return {.format = TriangleFormat::kProjection, .may_leak = true, .has_scene_shading = false};
    case Accuracy::kExact:
      return {.format = TriangleFormat::kVertices, .may_leak = false, .has_scene_shading = true};
    case Accuracy::kFast:
      return {.format = TriangleFormat::kVertices, .may_leak = true, .has_scene_shading = true};
    case Accuracy::kCompact:
      return {.format = TriangleFormat::kLattice, .may_leak = false, .has_scene_shading = true};
  }
  return {};
}
#pragma GCC diagnostic pop

/// The same for the number that a frame record has.
[[nodiscard]] constexpr AccuracyTraits accuracy_traits(std::underlying_type_t<Accuracy> number) {
  return accuracy_traits(static_cast<Accuracy>(number));
}

/// @returns the stored form that an accuracy works on.
[[nodiscard]] constexpr TriangleFormat format_of(Accuracy accuracy) {
  return accuracy_traits(accuracy).format;
}

inline constexpr std::uint32_t kAccuracyCount = 5;  ///< their numbers are 0..kAccuracyCount - 1
static_assert(accuracy_traits(Accuracy{kAccuracyCount - 1}).format != TriangleFormat{} &&
                  accuracy_traits(Accuracy{kAccuracyCount}).format == TriangleFormat{},
              "kAccuracyCount is not the number of accuracies");

/// The formats of all accuracies, four bits each: a core looks them up in a word, not in a table in its memory.
template <std::size_t... Numbers>
[[nodiscard]] consteval auto pack_formats(std::index_sequence<Numbers...>) {
  return ((static_cast<std::underlying_type_t<TriangleFormat>>(format_of(Accuracy{Numbers})) << 4 * Numbers) | ...);
}

/// @returns whether a frame of this accuracy renders triangles of this format, by the numbers of the frame record.
/// Precondition: accuracy < kAccuracyCount.
[[nodiscard]] constexpr bool reads_format(std::underlying_type_t<Accuracy> accuracy,
                                          std::underlying_type_t<TriangleFormat> format) {
  return (pack_formats(std::make_index_sequence<kAccuracyCount>()) >> 4 * accuracy & 15u) == format;
}

}  // namespace gridiron
