// What a call complains of. Memory: a string. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/failure.h"
#include "support/test_headers.h"

namespace gridiron::test {

/// @returns the message of a call that must fail; a test failure if it does not, or has another exit code.
template <class Action>
std::string failure_of(Action action, tool::ExitCode code = tool::ExitCode::kBadInput) {
  try {
    static_cast<void>(action());
  } catch (const tool::Failure& failure) {
    EXPECT_EQ(failure.code(), code);
    return failure.what();
  }
  ADD_FAILURE() << "accepted";
  return "";
}

}  // namespace gridiron::test
