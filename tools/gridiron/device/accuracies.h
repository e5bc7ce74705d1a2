// Accuracies: the accuracy profiles by name.
// Memory: one table. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/accuracies.h>

#include <span>
#include <string_view>

namespace gridiron::tool {

struct NamedAccuracy {
  std::string_view name;
  Accuracy accuracy;
  std::string_view description;
};

/// All accuracy profiles, from the paper's to the exact one, then those that change the geometry.
[[nodiscard]] std::span<const NamedAccuracy> accuracies();

/// @returns the accuracy's name in --accuracy.
[[nodiscard]] std::string_view accuracy_name(Accuracy accuracy);

}  // namespace gridiron::tool
