// Accuracies. SPDX-License-Identifier: Apache-2.0
#include "accuracies.h"

#include <algorithm>

namespace gridiron::tool {
namespace {

// clang-format off
constexpr NamedAccuracy kAccuracies[] = {
    {"paper", Accuracy::kPaper,
     "precomputed projection and reciprocal estimate in single precision; may leak at edges"},
    {"fast", Accuracy::kFast,
     "signs of edges and distances as single precision gives them; may leak at edges; for numbers of 1e-12 to 1e12"},
    {"standard", Accuracy::kStandard,
     "hits what exact arithmetic hits; of triangles whose distances round alike shows the lowest id"},
    {"exact", Accuracy::kExact,
     "as standard, and of distances that round alike the exact ones decide"},
    {"compact", Accuracy::kCompact,
     "as standard, of triangles whose vertices are moved to a 16-bit lattice"},
};
// clang-format on

}  // namespace

std::span<const NamedAccuracy> accuracies() {
  return kAccuracies;
}

std::string_view accuracy_name(Accuracy accuracy) {
  return std::ranges::find(kAccuracies, accuracy, &NamedAccuracy::accuracy)->name;
}

}  // namespace gridiron::tool
