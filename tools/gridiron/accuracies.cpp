// Accuracies. SPDX-License-Identifier: Apache-2.0
#include "accuracies.h"

#include <algorithm>

namespace gridiron::tool {
namespace {

// clang-format off
constexpr NamedAccuracy kAccuracies[] = {
    {"standard", Accuracy::kStandard, "the triangles that exact arithmetic hits; where distances round alike, the lower id"},
    {"paper", Accuracy::kPaper, "precomputed projection in single precision; may leak"},
    {"exact", Accuracy::kExact, "as standard, and of distances that round alike the exact ones decide"},
    {"fast", Accuracy::kFast, "edges and distances as single precision gives them; may leak at edges"},
};

constexpr NamedFormat kFormats[] = {
    {"vertices", TriangleFormat::kVertices},
    {"projection", TriangleFormat::kProjection},
};
// clang-format on

}  // namespace

std::span<const NamedAccuracy> accuracies() {
  return kAccuracies;
}

std::span<const NamedFormat> triangle_formats() {
  return kFormats;
}

TriangleFormat format_of(Accuracy accuracy) {
  switch (accuracy) {
    case Accuracy::kPaper:
      return TriangleFormat::kProjection;
    case Accuracy::kCompact:
      return TriangleFormat::kLattice;
    case Accuracy::kStandard:
    case Accuracy::kExact:
    case Accuracy::kFast:
      break;
  }
  return TriangleFormat::kVertices;
}

std::string_view name_of(TriangleFormat format) {
  const NamedFormat* const found = std::ranges::find(kFormats, format, &NamedFormat::format);
  return found == std::end(kFormats) ? "unknown" : found->name;
}

}  // namespace gridiron::tool
