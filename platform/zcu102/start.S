// First instructions of all four cores: down to EL1, vectors, stack, page tables, then C++. Core 0 is the first and
// starts the others (core_start.cpp); all of them enter here.
// Source: Arm Architecture Reference Manual for A-profile (DDI 0487), Cortex-A53 manual (DDI 0500).
// Memory: boot stack (zcu102.ld), fault stacks here. Threads: each core its own stacks. SPDX-License-Identifier: Apache-2.0

#define CPUECTLR_EL1 S3_1_C15_C2_1

// EL1: MMU off, caches off, reserved bits as the architecture requires.
#define SCTLR_OFF 0x30D00800
// M, C, I, WXN: writable memory is not executable.
#define SCTLR_ON 0x00081005
// 32-bit addresses from TTBR0 alone, tables of 4 KB pages, walks cached and inner shareable.
#define TCR_VALUE 0x00803520
// Attribute 0: normal, write-back, allocating. Attribute 1: device-nGnRnE.
#define MAIR_VALUE 0x00FF
// EL1 with its own stack pointer, all interrupts masked.
#define SPSR_VALUE 0x3C5
#define FAULT_STACK_BYTES 2048

  .section .text.start, "ax"
  .global _start
_start:
  msr daifset, #15
  mrs x20, mpidr_el1
  and x20, x20, #0xFF            // core
  cmp x20, #4
  b.hs park
  mrs x21, CurrentEL
  lsr x21, x21, #2               // level that the core was entered at
  adr x0, at_el1
  cmp x21, #3
  b.eq from_el3
  cmp x21, #2
  b.eq from_el2
  br x0

// Nothing ran before, so this code switches coherence between the cores on. EL1 stays secure; there is no EL2 then.
from_el3:
  mrs x1, CPUECTLR_EL1
  orr x1, x1, #(1 << 6)          // SMPEN
  msr CPUECTLR_EL1, x1
  mov x1, #0x430                 // RW: EL1 is AArch64
  msr scr_el3, x1
  msr cptr_el3, xzr
  mov x1, #(1 << 17)             // the performance monitor counts in secure state
  msr mdcr_el3, x1
  mov x1, #SPSR_VALUE
  msr spsr_el3, x1
  msr elr_el3, x0
  isb
  eret

// Other firmware owns EL3 (PSCI) and has entered in EL2, which is passed through.
from_el2:
  mov x1, #(1 << 31)             // RW
  msr hcr_el2, x1
  mov x1, #0x33FF
  msr cptr_el2, x1
  msr hstr_el2, xzr
  mrs x1, mpidr_el1
  msr vmpidr_el2, x1
  mrs x1, midr_el1
  msr vpidr_el2, x1
  mov x1, #SPSR_VALUE
  msr spsr_el2, x1
  msr elr_el2, x0
  isb
  eret

at_el1:
  ldr x1, =SCTLR_OFF
  msr sctlr_el1, x1
  mov x1, #(3 << 20)             // floating point and NEON do not trap
  msr cpacr_el1, x1
  adr x1, vectors
  msr vbar_el1, x1
  msr tpidr_el1, xzr             // no fault yet
  isb
  msr fpcr, xzr                  // to nearest, denormals kept: part of the result
  msr spsel, #1
  cbnz x20, secondary

  // Core 0, MMU off: clear what no file holds, make the page tables.
  ldr x1, =cleared_begin
  ldr x2, =cleared_end
1:
  stp xzr, xzr, [x1], #16
  cmp x1, x2
  b.lo 1b
  ldr x1, =boot_stack_end
  mov sp, x1
  mov x29, xzr
  ldr x1, =entry_level
  str w21, [x1]
  bl build_spaces
  bl master_root
  bl map_on
  bl master_entry
  b park

// The others get their own page tables first and never see the boot stack.
secondary:
  mov w0, w20
  ldr x1, =arena_stack_tops
  ldr x1, [x1, x20, lsl #3]
  mov sp, x1
  mov x29, xzr
  bl worker_root
  bl map_on
  mov w0, w20
  bl secondary_entry
park:
  wfe
  b park

// map_on(root): translation and caches on, for the first time on this core.
map_on:
  ldr x1, =MAIR_VALUE
  msr mair_el1, x1
  ldr x1, =TCR_VALUE
  msr tcr_el1, x1
  msr ttbr0_el1, x0
  isb
  tlbi vmalle1
  ic iallu
  dsb sy
  isb
  mrs x1, sctlr_el1
  ldr x2, =SCTLR_ON
  orr x1, x1, x2
  msr sctlr_el1, x1
  isb
  ret

// call_confined(function, argument, stack_top, inner_root, outer_root): calls function(argument) on another stack and
// with other page tables, then restores both.
  .section .text.call_confined, "ax"
  .global call_confined
call_confined:
  stp x29, x30, [sp, #-32]!
  stp x19, x20, [sp, #16]
  mov x29, sp
  mov x19, sp
  mov x20, x4
  mov x5, x0
  mov x0, x1
  mov sp, x2
  dsb ish
  msr ttbr0_el1, x3
  isb
  tlbi vmalle1
  dsb nsh
  isb
  blr x5
  dsb ish
  msr ttbr0_el1, x20
  isb
  tlbi vmalle1
  dsb nsh
  isb
  mov sp, x19
  ldp x19, x20, [sp, #16]
  ldp x29, x30, [sp], #32
  ret

// Sixteen vectors, none of which is expected: each reports its number.
  .section .text.vectors, "ax"
  .balign 2048
vectors:
  .set number, 0
  .rept 16
  .balign 128
  mov x0, #number
  b fault
  .set number, number + 1
  .endr

// Reports on a stack of its own, because the core's may be the cause. A fault in the report ends the core silently.
fault:
  mrs x1, tpidr_el1
  cbnz x1, park_here
  mov x1, #1
  msr tpidr_el1, x1
  mrs x1, mpidr_el1
  and x1, x1, #3
  ldr x2, =fault_stacks
  mov x3, #FAULT_STACK_BYTES
  madd x2, x1, x3, x2
  add sp, x2, x3
  mov x29, xzr
  mrs x2, esr_el1
  mrs x3, elr_el1
  mrs x4, far_el1
  bl report_fault
park_here:
  wfe
  b park_here

  .section .bss.fault_stacks, "aw", %nobits
  .balign 16
fault_stacks:
  .skip 4 * FAULT_STACK_BYTES

  .section .note.GNU-stack, "", %progbits
