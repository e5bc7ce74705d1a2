// A rounding mode, and flushing of denormals, for a scope. Threads started in it inherit both.
// Memory: values. Threads: the calling one. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <cfenv>

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

namespace gridiron::test {

inline constexpr int kRoundingModes[] = {FE_TONEAREST, FE_TOWARDZERO, FE_UPWARD, FE_DOWNWARD};

/// Sets a rounding mode, and that denormals are flushed where the processor can, for as long as it lives.
class RoundingGuard {
 public:
  explicit RoundingGuard(int mode, bool flush) {
#if defined(__SSE2__)
    had_ = _mm_getcsr();
    if (flush) _mm_setcsr(had_ | 0x8040u);
#else
    (void)flush;
#endif
    EXPECT_EQ(std::fesetround(mode), 0);
  }
  ~RoundingGuard() {
    std::fesetround(FE_TONEAREST);
#if defined(__SSE2__)
    _mm_setcsr(had_);
#endif
  }
  RoundingGuard(const RoundingGuard&) = delete;
  RoundingGuard& operator=(const RoundingGuard&) = delete;

 private:
  unsigned had_ = 0;
};

}  // namespace gridiron::test
