// What asks the caches for a line, as the general core's instruction does: riscv64 of today's compilers has none, so a
// load without a result stands for it. Compiled before every source of general_core.
// Memory: none. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#ifdef __riscv
#define __builtin_prefetch(address) asm volatile("lb zero, 0(%0)" : : "r"(address))
#endif
