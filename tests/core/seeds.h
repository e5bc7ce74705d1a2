// Seeds of property tests: as many as the test requests, or the one in GRIDIRON_TEST_SEED.
// Memory: none. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "support/test_mesh.h"

namespace gridiron::test {

/// Whether a test runs with all of its seeds, so that what it counted says something.
inline bool all_seeds_run() {
  return std::getenv("GRIDIRON_TEST_SEED") == nullptr;
}

/// Calls body(seed), or body(random) with its random numbers, for the seeds 1..count until one fails, and then says
/// which one that was and how to run it alone.
template <class Body>
void for_each_seed(std::uint64_t count, Body&& body) {
  const char* wanted = std::getenv("GRIDIRON_TEST_SEED");
  const std::uint64_t only = wanted != nullptr ? std::strtoull(wanted, nullptr, 10) : 0;
  const std::uint64_t first = only != 0 ? only : 1;
  const std::uint64_t last = only != 0 ? only : count;
  for (std::uint64_t seed = first; seed <= last; ++seed) {
    if constexpr (std::is_invocable_v<Body&, TestRandom&>) {
      TestRandom random(seed);
      body(random);
    } else {
      body(seed);
    }
    if (testing::Test::HasFailure()) {
      ADD_FAILURE() << "rerun with GRIDIRON_TEST_SEED=" << seed;
      return;
    }
  }
}

}  // namespace gridiron::test
