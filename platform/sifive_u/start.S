// First instructions of every hart, and its traps. Hart 0 becomes the master. Harts 1 to 4 lock themselves in by PMP
// and sleep until the master wakes them.
// Memory: stack of the master behind its data, of a worker at the top of its arena.
// SPDX-License-Identifier: Apache-2.0
#include "memory_map.h"

// pmpcfg of an entry: locked, which binds machine mode too; naturally aligned power of two.
#define PMP_LOCKED 0x80
#define PMP_REGION (PMP_LOCKED | 0x18)
#define PMP_RW (PMP_REGION | 0x3)
#define PMP_RX (PMP_REGION | 0x5)
#ifdef GRIDIRON_ASYNC
#define PMP_CHANNEL PMP_LOCKED  /* the master moves bytes: no channel, and none can be had later */
#else
#define PMP_CHANNEL PMP_RW
#endif

        .section .text.start, "ax"
        .global _start
_start:
        csrw    mie, zero
        csrr    a0, mhartid
        lla     t0, trap_entry
        csrw    mtvec, t0
        bnez    a0, worker

        lla     sp, gridiron_master_stack_top
        lla     t0, gridiron_bss_start
        lla     t1, gridiron_bss_end
1:      bgeu    t0, t1, 2f
        sd      zero, (t0)
        addi    t0, t0, 8
        j       1b
2:      call    gridiron_master
        j       park

worker:
        li      t0, GRIDIRON_WORKERS
        bgtu    a0, t0, park
        addi    s0, a0, -1                      // core
        // Its arena. Every byte is written before it is read, since memory with ECC starts without valid codes.
        li      t0, GRIDIRON_ARENA_BYTES
        mul     t1, s0, t0
        li      s1, GRIDIRON_LIM
        add     s1, s1, t1
        add     sp, s1, t0
        mv      t1, s1
1:      sd      zero, (t1)
        addi    t1, t1, 8
        bltu    t1, sp, 1b

        li      t0, 1 << 13                     // mstatus.FS: initial
        csrs    mstatus, t0
        fscsr   zero

        // Address registers of PMP: base / 4, with one bits below that encode the size.
        li      t1, GRIDIRON_ARENA_BYTES / 8 - 1
        srli    t0, s1, 2
        or      t0, t0, t1
        csrw    pmpaddr0, t0
        li      t0, GRIDIRON_CODE / 4 + GRIDIRON_CODE_BYTES / 8 - 1
        csrw    pmpaddr1, t0
        slli    t1, s0, 12
        li      t0, GRIDIRON_PDMA
        add     t0, t0, t1
        srli    t0, t0, 2
        ori     t0, t0, 0x1000 / 8 - 1
        csrw    pmpaddr2, t0
        li      t0, GRIDIRON_SHARED / 4 + GRIDIRON_SHARED_BYTES / 8 - 1
        csrw    pmpaddr3, t0
        li      t0, GRIDIRON_CLINT / 4 + 32 / 8 - 1     // software interrupts of all harts
        csrw    pmpaddr4, t0
        li      t0, -1                                  // everything else: nothing
        csrw    pmpaddr7, t0
        li      t1, PMP_RW | PMP_LOCKED << 8 | PMP_LOCKED << 16 | PMP_REGION << 24
#ifdef GRIDIRON_DYNAMIC
        li      t0, GRIDIRON_WORKSHOP / 4 + GRIDIRON_WORKSHOP_BYTES / 8 - 1
        csrw    pmpaddr5, t0
        bnez    s0, 2f
        li      t1, PMP_RW | PMP_RW << 8 | PMP_LOCKED << 16 | PMP_REGION << 24
2:
#endif
        li      t0, PMP_RW | PMP_RX << 8 | PMP_CHANNEL << 16 | PMP_RW << 24
        slli    t1, t1, 32
        or      t0, t0, t1
        csrw    pmpcfg0, t0
        sfence.vma

        // Sleep until a software interrupt is pending, which is not taken.
sleep:  li      t0, 1 << 3
        csrw    mie, t0
3:      wfi
        csrr    t0, mip
        andi    t0, t0, 1 << 3
        beqz    t0, 3b
        li      t0, GRIDIRON_CLINT
        addi    t1, s0, 1
        slli    t1, t1, 2
        add     t0, t0, t1
        sw      zero, (t0)
        fence
        mv      a0, s0
        mv      a1, s1
        call    gridiron_worker
        j       sleep

park:   wfi
        j       park

// No trap is expected. The stack may be the cause, so it is reset.
        .balign 4
trap_entry:
        csrr    a0, mhartid
        csrr    a1, mcause
        csrr    a2, mtval
        csrr    a3, mepc
        lla     sp, gridiron_master_stack_top
        beqz    a0, 1f
        li      t0, GRIDIRON_ARENA_BYTES
        mul     t0, t0, a0
        li      sp, GRIDIRON_LIM
        add     sp, sp, t0
1:      call    gridiron_trap
        j       park
