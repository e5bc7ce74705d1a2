// Accuracies: the accuracy profiles and the formats of triangles by name.
// Memory: two tables. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/records.h>

#include <span>
#include <string_view>

namespace gridiron::tool {

struct NamedAccuracy {
  std::string_view name;
  Accuracy accuracy;
  std::string_view description;
};

/// All accuracy profiles, `standard` (the default) first.
[[nodiscard]] std::span<const NamedAccuracy> accuracies();

struct NamedFormat {
  std::string_view name;
  TriangleFormat format;
};

/// All ways of storing triangles, the default first.
[[nodiscard]] std::span<const NamedFormat> triangle_formats();

/// @returns what the triangles must be stored as for a frame of that accuracy.
[[nodiscard]] TriangleFormat format_of(Accuracy accuracy);

/// @returns the format's name, "unknown" where it has none.
[[nodiscard]] std::string_view name_of(TriangleFormat format);

}  // namespace gridiron::tool
