# Start of every hart, entry to a worker, and the way into machine mode that a worker's calls and all traps take.
# Memory: a stack of 4 KB for each hart's machine mode. Threads: all harts. SPDX-License-Identifier: Apache-2.0

  .equ kHarts, 7
  .equ kHartStackShift, 12

  .section .text.start, "ax"
  .globl _start
_start:
  csrr    s0, mhartid
  li      t0, kHarts
  bgeu    s0, t0, 4f
  lla     sp, hart_stacks_begin
  addi    t0, s0, 1
  slli    t0, t0, kHartStackShift
  add     sp, sp, t0
  csrw    mscratch, sp
  lla     t0, trap_entry
  csrw    mtvec, t0
  csrw    mie, zero
  li      t0, 1 << 13           # mstatus.FS: floating point on
  csrs    mstatus, t0
  bnez    s0, 2f

  lla     t0, bss_begin
  lla     t1, bss_end
1:
  bgeu    t0, t1, 3f
  sd      zero, 0(t0)
  addi    t0, t0, 8
  j       1b
3:
  call    gridiron_master
2:
  mv      a0, s0
  call    gridiron_boot_worker
4:
  wfi
  j       4b

# void gridiron_enter_worker(a0 core, a1 stack top): user mode, for good.
  .text
  .globl gridiron_enter_worker
gridiron_enter_worker:
  lla     t0, gridiron_worker
  csrw    mepc, t0
  li      t0, 3 << 11           # mstatus.MPP: to user mode
  csrc    mstatus, t0
  mv      sp, a1
  li      ra, 0
  mret

# std::uint64_t gridiron_call(a0..a2 arguments, a3 which): a worker's call of machine mode. To the compiler it is an
# ordinary function, so only its return address has to be kept.
  .globl gridiron_call
gridiron_call:
  ecall
  ret

  .balign 4
trap_entry:
  csrrw   sp, mscratch, sp
  csrr    t0, mcause
  li      t1, 8                 # a call from user mode
  bne     t0, t1, 5f
  addi    sp, sp, -16
  sd      ra, 0(sp)
  call    gridiron_serve
  ld      ra, 0(sp)
  addi    sp, sp, 16
  csrr    t0, mepc
  addi    t0, t0, 4
  csrw    mepc, t0
  csrrw   sp, mscratch, sp
  mret
5:
  # Anything else does not return; the hart's stack is reset, whatever mode it came from.
  csrr    t0, mhartid
  addi    t0, t0, 1
  slli    t0, t0, kHartStackShift
  lla     sp, hart_stacks_begin
  add     sp, sp, t0
  csrr    a0, mcause
  csrr    a1, mtval
  csrr    a2, mepc
  call    gridiron_trapped
  j       4b

  .section .hart_stacks, "aw", @nobits
hart_stacks_begin:
  .skip   kHarts << kHartStackShift
