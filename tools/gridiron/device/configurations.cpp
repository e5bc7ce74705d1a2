// Configurations. SPDX-License-Identifier: Apache-2.0
#include "configurations.h"

#include <gridiron/base/records.h>

namespace gridiron::tool {
namespace {

constexpr std::uint32_t kReferenceTechniques = kUseMailbox | kUseCornerCulling | kUseEmptySkip;

// clang-format off
constexpr Configuration kConfigurations[] = {
    {.name = "best", .description = "eye rays through the wide tree, tile by tile; no grid",
     .lambda = 0.01f, .macro_width = 4, .packet_width = 0,
     .depths = {.output = 2, .macro = 1, .triangle = 1, .fetch = 2}, .techniques = 0},
    {.name = "grid", .description = "one traversal per tile for all its rays, a coarse grid, culling by pixels",
     .lambda = 0.4f, .macro_width = 4, .packet_width = 32,
     .depths = {.output = 2, .macro = 4, .triangle = 3, .fetch = 2},
     .techniques = kUseMailbox | kUseEmptySkip | kUseSubpackets},
    {.name = "reference", .description = "the reference system: double buffering at three levels",
     .lambda = 4.0f, .macro_width = 6, .packet_width = 8,
     .depths = {.output = 2, .macro = 2, .triangle = 2, .fetch = 2}, .techniques = kReferenceTechniques},
    {.name = "deep", .description = "the reference system, prefetching 4 cell blocks and 8 triangle buffers",
     .lambda = 4.0f, .macro_width = 6, .packet_width = 8,
     .depths = {.output = 2, .macro = 4, .triangle = 8, .fetch = 4}, .techniques = kReferenceTechniques},
};
// clang-format on

}  // namespace

std::span<const Configuration> configurations() {
  return kConfigurations;
}

const Configuration* find_configuration(std::string_view name) {
  const auto* found = std::ranges::find(kConfigurations, name, &Configuration::name);
  return found == std::end(kConfigurations) ? nullptr : found;
}

const Configuration& default_configuration(const ConfigurationNeed& need) {
  if (need.has_projection) return *find_configuration("reference");
  return *find_configuration(need.has_tree && need.has_kernel && need.has_bounds && need.has_prices ? "best" : "grid");
}

}  // namespace gridiron::tool
