// The version header agrees with the project's CMake file, in every form.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/version.h>

#include "support/test_headers.h"

#if GRIDIRON_VERSION < 100 || GRIDIRON_VERSION_MAJOR < 0
#error "the preprocessor cannot compare versions"
#endif

namespace gridiron {
namespace {

TEST(Version, IsTheProjects) {
  EXPECT_STREQ(kVersion, GRIDIRON_PROJECT_VERSION);
  EXPECT_EQ(std::to_string(kVersionMajor) + "." + std::to_string(kVersionMinor) + "." + std::to_string(kVersionPatch),
            GRIDIRON_PROJECT_VERSION);
}

TEST(Version, GrowsWithEachPart) {
  static_assert(GRIDIRON_VERSION == kVersionMajor * 10000 + kVersionMinor * 100 + kVersionPatch);
  static_assert(kVersionMinor < 100 && kVersionPatch < 100);
}

}  // namespace
}  // namespace gridiron
