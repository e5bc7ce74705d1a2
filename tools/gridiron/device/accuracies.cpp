// Accuracies. SPDX-License-Identifier: Apache-2.0
#include "accuracies.h"

#include <algorithm>
#include <iterator>

namespace gridiron::tool {
namespace {

// clang-format off
constexpr NamedAccuracy kAccuracies[] = {
    {"paper", Accuracy::kPaper,
     "precomputed projection and reciprocal estimate in single precision; may leak at edges"},
    {"fast", Accuracy::kFast,
     "signs of edges and distances in single precision; may leak at edges; for numbers of 1e-12 to 1e12"},
    {"standard", Accuracy::kStandard,
     "hits what exact arithmetic hits; of triangles whose distances round alike shows the lowest id"},
    {"exact", Accuracy::kExact,
     "as standard, and of distances that round alike the exact ones decide"},
    {"compact", Accuracy::kCompact,
     "as standard, of triangles whose vertices are moved to a 16-bit lattice"},
};
// clang-format on

consteval bool have_each_one_name() {
  for (std::uint32_t number = 0; number < kAccuracyCount; ++number) {
    if (std::ranges::count(kAccuracies, Accuracy{number}, &NamedAccuracy::accuracy) != 1) return false;
  }
  return std::size(kAccuracies) == kAccuracyCount;
}
static_assert(have_each_one_name());

}  // namespace

std::span<const NamedAccuracy> accuracies() {
  return kAccuracies;
}

std::string_view accuracy_name(Accuracy accuracy) {
  return std::ranges::find(kAccuracies, accuracy, &NamedAccuracy::accuracy)->name;
}

}  // namespace gridiron::tool
