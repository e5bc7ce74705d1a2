// Core's work counters with marks in the machine code: an instruction that does nothing and names the kind of work that
// the following ones belong to. For second_opinion only.
// Memory: inside the local store. Threads: one core. SPDX-License-Identifier: Apache-2.0
#pragma once

#define WorkCounters PlainWorkCounters
#include "../../../../../core/gridiron/base/work_counters.h"
#undef WorkCounters

#include <cstdint>

// A mark: aarch64 moves a number to the register that is always 0; riscv64 compares that register with a number.
#ifdef __riscv
#define GRIDIRON_MARK_TEXT "slti zero, zero, %0"
#else
#define GRIDIRON_MARK_TEXT "movz xzr, #%0"
#endif

namespace gridiron {

/// Numbers of marks: of kinds of work first, of what else there is at the end.
inline constexpr int kFirstMark = 128, kEndOfKindMarks = kFirstMark + 104;
static_assert(kFirstMark + kWorkKindCount <= kEndOfKindMarks, "each kind has a mark");

struct WorkCounters : PlainWorkCounters {
  [[gnu::always_inline]] constexpr void add(WorkId kind, std::uint32_t amount = 1) {
    mark(kind);
    PlainWorkCounters::add(kind, amount);
  }
  [[gnu::always_inline]] constexpr void charge_to(WorkId kind) const { mark(kind); }

 private:
  // A switch, as the number is part of the instruction; where the kind is known, and it nearly always is, one case is
  // left of it.
  [[gnu::always_inline]] static constexpr void mark(WorkId kind) {
    if (!__builtin_is_constant_evaluated()) {
      switch (kind.number()) {
#define GRIDIRON_MARK(i)                                      \
  case i:                                                     \
    asm volatile(GRIDIRON_MARK_TEXT : : "n"(kFirstMark + i)); \
    break;
#define GRIDIRON_MARKS(i)                                                                                  \
  GRIDIRON_MARK(i)                                                                                         \
  GRIDIRON_MARK(i + 1)                                                                                     \
  GRIDIRON_MARK(i + 2) GRIDIRON_MARK(i + 3) GRIDIRON_MARK(i + 4) GRIDIRON_MARK(i + 5) GRIDIRON_MARK(i + 6) \
      GRIDIRON_MARK(i + 7)
        GRIDIRON_MARKS(0)
        GRIDIRON_MARKS(8)
        GRIDIRON_MARKS(16) GRIDIRON_MARKS(24) GRIDIRON_MARKS(32) GRIDIRON_MARKS(40) GRIDIRON_MARKS(48)
            GRIDIRON_MARKS(56) GRIDIRON_MARKS(64) GRIDIRON_MARKS(72) GRIDIRON_MARKS(80) GRIDIRON_MARKS(88)
                GRIDIRON_MARKS(96)
#undef GRIDIRON_MARKS
#undef GRIDIRON_MARK
                default : break;
      }
    }
  }
};

}  // namespace gridiron
