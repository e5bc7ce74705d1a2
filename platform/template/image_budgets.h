// The sizes of a layout as symbols of an image; image_budgets.ld compares them with the linked sizes.
// Memory: none. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/store/local_store.h>

namespace gridiron::port {

// A number without the sign that a target puts before constants. GCC for RISC-V has no such sign, and rejects the
// modifier.
#ifdef __riscv
#define GRIDIRON_SYMBOL(name, operand) ".globl " name "\n\t.set " name ", %" operand "\n\t"
#else
#define GRIDIRON_SYMBOL(name, operand) ".globl " name "\n\t.set " name ", %c" operand "\n\t"
#endif

/// Instantiate it once in an image, for the layout of its render_tiles:
///
///     template struct gridiron::port::ImageBudgets<FirmwareLayout>;
///
/// The compiler writes the layout's constants into the object as absolute symbols; there is no code to call.
template <class Layout>
struct ImageBudgets {
  [[gnu::used, gnu::noinline]] static void define() {
    asm volatile(GRIDIRON_SYMBOL("gridiron_code_budget_bytes", "0") GRIDIRON_SYMBOL("gridiron_stack_budget_bytes", "1")
                     GRIDIRON_SYMBOL("gridiron_store_bytes", "2") GRIDIRON_SYMBOL("gridiron_arena_bytes", "3")
                         GRIDIRON_SYMBOL("gridiron_code_memory_bytes", "4")
                 :
                 : "i"(Layout::kCodeBudgetBytes), "i"(Layout::kStackBudgetBytes), "i"(sizeof(LocalStore<Layout>)),
                   "i"(Layout::kArenaBytes), "i"(kCodeMemoryBytes<Layout>));
  }
};

#undef GRIDIRON_SYMBOL

}  // namespace gridiron::port
