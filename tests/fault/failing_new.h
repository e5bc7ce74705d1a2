// Failing new: operator new of the whole program, which can fail at any allocation.
// Memory: counters. Threads: any; one at a time decides what fails. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace gridiron::test {

/// Lets the n-th allocation from now on, of all threads, throw std::bad_alloc. Those after it do not fail.
void fail_allocation(std::uint64_t n);

/// Lets no allocation fail any more. @returns how many there were since fail_allocation().
std::uint64_t end_of_failing();

}  // namespace gridiron::test
