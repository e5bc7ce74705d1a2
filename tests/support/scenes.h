// Finds data that the repository does not carry: scans (GRIDIRON_SCENES) and the PLY zoo (GRIDIRON_PLY_ZOO).
// Memory: strings. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "support/test_headers.h"

namespace gridiron::test {

/// Outcome of a search: a path, or why there is none.
struct SharedFile {
  std::filesystem::path path;
  std::string missing;  ///< empty where the file exists; else a sentence for the test's message
};

/// @returns true where a missing file must fail a test rather than skip it (GRIDIRON_REQUIRE_SCANS=1).
inline bool scans_are_required() {
  const char* value = std::getenv("GRIDIRON_REQUIRE_SCANS");
  return value != nullptr && std::string_view(value) == "1";
}

/// Looks for `name` ("" for the directory itself) below the directory that environment variable `variable` names.
inline SharedFile find_shared(const char* variable, std::string_view name) {
  const char* directory = std::getenv(variable);
  if (directory == nullptr || *directory == '\0') {
    return {{},
            std::string(variable) + " is not set, so " + (name.empty() ? "its files are" : std::string(name) + " is") +
                " not available"};
  }
  const std::filesystem::path path = std::filesystem::path(directory) / name;
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) return {{}, path.string() + " does not exist"};
  return {path, {}};
}

/// Looks for a scan, e.g. "bunny.ply".
inline SharedFile find_scene(std::string_view name) {
  return find_shared("GRIDIRON_SCENES", name);
}

/// Looks for a file of the PLY zoo; "" for the zoo's directory.
inline SharedFile find_in_ply_zoo(std::string_view name) {
  return find_shared("GRIDIRON_PLY_ZOO", name);
}

}  // namespace gridiron::test

/// Leaves the test where `shared_file` is missing: as a failure where scans are required, as skipped otherwise.
#define GRIDIRON_SKIP_IF_MISSING(shared_file)                                       \
  do {                                                                              \
    const ::gridiron::test::SharedFile& gridiron_file_ = (shared_file);             \
    if (!gridiron_file_.missing.empty()) {                                          \
      if (::gridiron::test::scans_are_required()) FAIL() << gridiron_file_.missing; \
      GTEST_SKIP() << gridiron_file_.missing;                                       \
    }                                                                               \
  } while (false)
