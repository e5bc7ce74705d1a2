# Vectors, start, the way into the worker and out of it, and the way into the master that calls and faults take.
# Memory: the master's stack. Threads: one core. SPDX-License-Identifier: Apache-2.0

  .syntax unified
  .thumb

  .section .vectors, "a"
  .globl board_vectors
board_vectors:
  .word master_stack_end
  .word _start
  .word fault_entry             @ NMI
  .word fault_entry             @ hard fault
  .word fault_entry             @ memory management
  .word fault_entry             @ bus
  .word fault_entry             @ usage
  .rept 4
  .word fault_entry
  .endr
  .word call_entry              @ SVC
  .rept 4
  .word fault_entry
  .endr

  .section .text.start, "ax"
  .globl _start
  .thumb_func
_start:
  movw    r0, #0xED88           @ CPACR: floating point on
  movt    r0, #0xE000
  ldr     r1, [r0]
  orr     r1, r1, #0xF00000
  str     r1, [r0]
  dsb
  isb
  ldr     r0, =bss_begin
  ldr     r1, =bss_end
  movs    r2, #0
1:
  cmp     r0, r1
  bhs     2f
  str     r2, [r0], #4
  b       1b
2:
  ldr     r0, =data_begin
  ldr     r1, =data_end
  ldr     r3, =data_source
3:
  cmp     r0, r1
  bhs     4f
  ldr     r2, [r3], #4
  str     r2, [r0], #4
  b       3b
4:
  bl      board_main
5:
  b       5b
  .ltorg

@ void board_start_worker(r0 stack top): the master's registers stay on its stack, below which handlers work meanwhile.
  .section .text.worker, "ax"
  .globl board_start_worker
  .thumb_func
board_start_worker:
  push    {r3-r11, lr}
  vpush   {d8-d15}
  msr     psp, r0
  movs    r1, #3                @ CONTROL: no privileges, the process stack
  msr     control, r1
  isb
  bl      board_render
  b       .
  .thumb_func
worker_has_ended:               @ with privileges: call_entry has given them back
  movs    r1, #0
  msr     control, r1
  isb
  vpop    {d8-d15}
  pop     {r3-r11, pc}

@ uint32_t board_call(r0 argument, r1 which)
  .section .text.call, "ax"
  .globl board_call
  .thumb_func
board_call:
  svc     #0
  bx      lr

  .thumb_func
call_entry:
  push    {r4, lr}
  mrs     r4, psp               @ what the core has pushed: r0 to r3, r12, lr, pc, psr
  ldmia   r4, {r0, r1}
  bl      board_serve
  ldr     r1, [r4, #4]
  str     r0, [r4]
  cmp     r1, #2                @ kBoardEnd: go on at worker_has_ended, with privileges
  bne     1f
  ldr     r1, =worker_has_ended
  bic     r1, r1, #1
  str     r1, [r4, #24]
  mrs     r1, control
  bic     r1, r1, #1
  msr     control, r1
1:
  pop     {r4, pc}
  .ltorg

@ A fault does not return. r0: the frame that the core has pushed.
  .thumb_func
fault_entry:
  tst     lr, #4
  ite     eq
  mrseq   r0, msp
  mrsne   r0, psp
  ldr     r1, =master_stack_end
  mov     sp, r1
  bl      board_fault
  b       .
  .ltorg
