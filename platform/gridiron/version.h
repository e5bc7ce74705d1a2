// Version of Gridiron, the same as in the top CMakeLists.txt. What it promises: core/README.md, "Versions".
// Memory: none. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

// For the preprocessor: three numbers and, two digits each, as one number that grows.
#define GRIDIRON_VERSION_MAJOR 0  ///< changes when the interface breaks, from 1.0 on
#define GRIDIRON_VERSION_MINOR 2  ///< before 1.0: changes when the interface breaks
#define GRIDIRON_VERSION_PATCH 0  ///< changes nothing that a program can be built against
/// One number for comparisons: 10,000 major + 100 minor + patch.
#define GRIDIRON_VERSION (GRIDIRON_VERSION_MAJOR * 10000 + GRIDIRON_VERSION_MINOR * 100 + GRIDIRON_VERSION_PATCH)

namespace gridiron {

/// The version of the headers that a program is compiled with.
inline constexpr std::uint32_t kVersionMajor = GRIDIRON_VERSION_MAJOR;
inline constexpr std::uint32_t kVersionMinor = GRIDIRON_VERSION_MINOR;  ///< see GRIDIRON_VERSION_MINOR
inline constexpr std::uint32_t kVersionPatch = GRIDIRON_VERSION_PATCH;  ///< see GRIDIRON_VERSION_PATCH
inline constexpr char kVersion[] = "0.2.0";                     ///< all three, with dots

}  // namespace gridiron
