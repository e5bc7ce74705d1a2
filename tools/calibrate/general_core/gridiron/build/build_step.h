// Core's steps of building with marks in the machine code: an instruction that does nothing and names the step that the
// following ones belong to. For general_core only.
// Memory: none. Threads: one. SPDX-License-Identifier: Apache-2.0
#pragma once

#define enter_step enter_no_step
#define kPricedStep kUnpricedStep
#include "../../../../../core/gridiron/build/build_step.h"
#undef enter_step
#undef kPricedStep

namespace gridiron {

/// Numbers of marks: the step's behind it; kNoStepMark where no builder runs.
inline constexpr int kFirstStepMark = 128, kNoStepMark = 127;

// slti to the register that is always 0. No access to memory may pass it: it would be charged to another step.
template <auto kStep>
[[gnu::always_inline]] inline void enter_step() {
#ifdef __riscv
  asm volatile("slti zero, zero, %0" : : "n"(kFirstStepMark + static_cast<int>(kStep)) : "memory");
#endif
}

template <auto kStep>
inline constexpr auto kPricedStep = kStep;

}  // namespace gridiron
